//! (room: logic)
