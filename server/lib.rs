//! Rungwise: PLC programs as text.
//!
//! Data takes one way through the rooms below, from keystrokes to diagnostics and answers:
//! `text` and `target` are plain data, `il` and `ladder` turn text into structure, `document` keeps that structure
//! up to date edit by edit, `check` judges it, `ide` answers editor questions about it, `lsp` speaks the protocol.
//! `ARCHITECTURE.md` has the picture and the invariants, and `tests/tidy.rs` holds the walls.

pub mod text;

pub mod target;

pub mod il;

pub mod ladder;

pub mod machine_code;

pub mod document;

pub mod logic;

pub mod translate;

pub mod check;

pub mod simulate;

pub mod scenario;

pub mod project;

pub mod link;

pub mod ide;

pub mod lsp;

pub mod dap;

pub mod cli;
