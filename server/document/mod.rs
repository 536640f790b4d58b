//! (room: document)
