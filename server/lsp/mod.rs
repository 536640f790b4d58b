//! (room: lsp)
