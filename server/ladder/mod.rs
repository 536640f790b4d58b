//! (room: ladder)
