//! The debug adapter: a program on the simulated PLC, stopped, stepped and looked into over the Debug Adapter Protocol.
//!
//! `launch` takes, and `docs/debugging.md` explains:
//!
//! ```text
//! { program: file or folder, scanTime?: ms | "10ms", speed?: number = 1 (0: no limit), stopOnEntry?: boolean,
//!   set?: { NAME: value } | "NAME=VALUE@TIME"[], noDebug?: boolean }
//! ```
//!
//! There is one thread, the PLC, which stops at instructions: they have seen what reaches them and have not acted yet.
//! `stepIn` goes to the next instruction, `next` to the next rung (to the next instruction with that granularity),
//! `stepOut` behind the routine or to the next scan; `stepBack` and `reverseContinue` go back. Requests of the console
//! are words, see `console`.

mod adapter;

mod back;

mod breakpoints;

mod console;

mod debuggee;

mod going;

mod launch;

mod program;

mod requests;

mod stack;

mod variables;

mod wire;

use crate::text::Language;
use adapter::Adapter;
use std::io::{BufReader, Read, Write};
use std::sync::mpsc::channel;

/// Serves a client until it goes; `language` is spoken unless the client asks for another, and always if `is_asked`.
pub fn serve(input: impl Read + Send + 'static, output: impl Write, language: Language, is_asked: bool) {
    let (sender, receiver) = channel();
    // The thread ends with the process: who reads standard input cannot be woken.
    std::thread::spawn(move || {
        let mut input = BufReader::new(input);
        while let Some(request) = wire::read(&mut input) {
            if sender.send(request).is_err() {
                return;
            }
        }
    });
    Adapter::new(output, language, is_asked).run(&receiver);
}
