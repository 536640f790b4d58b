//! (room: il)
