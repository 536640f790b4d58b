//! (room: ide)
