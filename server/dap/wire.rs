//! The framing of the Debug Adapter Protocol, and the members that every message has.

use serde::Deserialize;
use serde_json::Value;
use std::io::{self, BufRead, Read, Write};

/// A longer message is passed over: nothing that a client asks is so long.
const MOST_BYTES: usize = 64 << 20;

/// What a client asks.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Request {
    /// The client's number of it.
    pub(super) seq: i64,
    /// What is asked for.
    pub(super) command: String,
    /// By the request; `null` where there is none.
    #[serde(default)]
    pub(super) arguments: Value,
}

/// Reads what the client asks next; nothing at the end. What is no request is passed over.
pub(super) fn read(input: &mut impl BufRead) -> Option<Request> {
    loop {
        let body = body(input)?;
        match serde_json::from_slice(&body) {
            Ok(request) => return Some(request),
            Err(reason) => tracing::warn!("not a request of the debug adapter protocol: {reason}"),
        }
    }
}

/// The content of the next message.
fn body(input: &mut impl BufRead) -> Option<Vec<u8>> {
    let mut length = None;
    loop {
        let mut line = Vec::new();
        // A line without an end is no header, however long it goes on.
        if input.by_ref().take(4096).read_until(b'\n', &mut line).ok()? == 0 {
            return None;
        }
        let line = String::from_utf8_lossy(&line);
        let line = line.trim();
        if let Some((name, value)) = line.split_once(':')
            && name.trim().eq_ignore_ascii_case("content-length")
        {
            length = value.trim().parse::<usize>().ok();
        }
        if !line.is_empty() {
            continue;
        }
        match length.take() {
            Some(length) if length <= MOST_BYTES => {
                let mut body = vec![0; length];
                input.read_exact(&mut body).ok()?;
                return Some(body);
            }
            Some(length) => {
                io::copy(&mut input.by_ref().take(length as u64), &mut io::sink()).ok()?;
            }
            None => {}
        }
    }
}

/// Writes a message.
pub(super) fn write(output: &mut impl Write, message: &Value) -> io::Result<()> {
    let body = message.to_string();
    write!(output, "Content-Length: {}\r\n\r\n{body}", body.len())?;
    output.flush()
}
