//! Takes in only whole, readable messages.
//!
//! The protocol library stops reading for good at the first frame that it cannot decode, which would make one broken
//! message of a client the end of its session. So frames are read here first: what is no message is dropped with a
//! line in the log, and the next frame is looked for.

use serde::de::{IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;
use tokio::io::{AsyncBufReadExt, AsyncRead, AsyncReadExt, AsyncWriteExt, BufReader, DuplexStream};

/// Bytes that are read at once.
const READ_BYTES: usize = 1 << 16;

/// Bytes under way between here and the library: a long text should not take hundreds of steps.
const PIPE_BYTES: usize = 1 << 18;

/// So much room is made for a message before its bytes have come; a header may promise anything.
const MOST_ROOM: usize = 16 << 20;

/// No honest message is longer; a length beyond it is a broken header.
const MESSAGE_LIMIT: usize = 256 << 20;

/// A header line that is longer is no header.
const HEADER_LIMIT: u64 = 4096;

/// What tells a message from other JSON.
#[derive(Deserialize)]
struct Shape {
    #[serde(rename = "jsonrpc")]
    _version: Version,
    #[serde(rename = "id")]
    _id: Option<Id>,
    method: Option<String>,
    params: Option<Params>,
    result: Option<IgnoredAny>,
    error: Option<IgnoredAny>,
}

/// Whether parameters are of a kind that the protocol allows. They are read as strictly as the library will read them,
/// and not kept: the text of a document is long.
struct Params {
    allowed: bool,
}

impl<'de> Deserialize<'de> for Params {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Params, D::Error> {
        deserializer.deserialize_any(ParamsVisitor)
    }
}

struct ParamsVisitor;

impl<'de> Visitor<'de> for ParamsVisitor {
    type Value = Params;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("parameters")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Params, A::Error> {
        while map.next_entry::<Params, Params>()?.is_some() {}
        Ok(Params { allowed: true })
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Params, A::Error> {
        while sequence.next_element::<Params>()?.is_some() {}
        Ok(Params { allowed: true })
    }

    fn visit_unit<E>(self) -> Result<Params, E> {
        Ok(Params { allowed: false })
    }

    fn visit_bool<E>(self, _: bool) -> Result<Params, E> {
        Ok(Params { allowed: false })
    }

    fn visit_i64<E>(self, _: i64) -> Result<Params, E> {
        Ok(Params { allowed: false })
    }

    fn visit_u64<E>(self, _: u64) -> Result<Params, E> {
        Ok(Params { allowed: false })
    }

    fn visit_f64<E>(self, _: f64) -> Result<Params, E> {
        Ok(Params { allowed: false })
    }

    fn visit_str<E>(self, _: &str) -> Result<Params, E> {
        Ok(Params { allowed: false })
    }
}

#[derive(Deserialize)]
enum Version {
    #[serde(rename = "2.0")]
    Two,
}

#[derive(Deserialize)]
#[serde(untagged)]
#[allow(dead_code, reason = "the variants say what an id may be")]
enum Id {
    Number(i64),
    Text(String),
}

/// The messages of `input`, re-framed; ends when `input` does.
///
/// `translate` gives the messages that stand for one of the client's.
pub(super) fn sound(
    input: impl AsyncRead + Send + Unpin + 'static,
    mut translate: impl FnMut(Vec<u8>) -> Vec<Vec<u8>> + Send + 'static,
) -> DuplexStream {
    let (mut writer, reader) = tokio::io::duplex(PIPE_BYTES);
    tokio::spawn(async move {
        let mut input = BufReader::with_capacity(READ_BYTES, input);
        while let Some(length) = next_length(&mut input).await {
            let mut body = Vec::with_capacity(length.min(MOST_ROOM));
            let read = (&mut input).take(length as u64).read_to_end(&mut body).await;
            if read.is_err() || body.len() < length {
                return;
            }
            if !is_message(&body) {
                tracing::error!("a message of {length} bytes is no JSON-RPC message and was dropped");
                continue;
            }
            for body in translate(body) {
                let header = header_of(&body);
                if writer.write_all(header.as_bytes()).await.is_err()
                    || writer.write_all(&body).await.is_err()
                {
                    return;
                }
            }
        }
    });
    reader
}

/// The length of the next frame's body, the header read; `None` at the end of the input.
async fn next_length(input: &mut (impl AsyncBufReadExt + Unpin)) -> Option<usize> {
    let mut length = None;
    loop {
        let mut line = Vec::new();
        if (&mut *input).take(HEADER_LIMIT).read_until(b'\n', &mut line).await.ok()? == 0 {
            return None;
        }
        let line = String::from_utf8_lossy(&line);
        let line = line.trim_end_matches(['\r', '\n']);
        match (line.is_empty(), length) {
            (true, Some(length)) => return Some(length),
            // Blank lines and noise between frames are passed over until a length comes.
            (true, None) => {}
            (false, _) => length = content_length(line).or(length),
        }
    }
}

/// A body behind its header.
pub(super) fn framed(body: &[u8]) -> Vec<u8> {
    [header_of(body).as_bytes(), body].concat()
}

fn header_of(body: &[u8]) -> String {
    format!("Content-Length: {}\r\n\r\n", body.len())
}

/// Start and end of the body of the first frame in `bytes`, if it is there as a whole.
pub(super) fn whole_frame(bytes: &[u8]) -> Option<(usize, usize)> {
    let head = bytes.windows(4).position(|part| part == b"\r\n\r\n")?;
    let lines = String::from_utf8_lossy(&bytes[..head]);
    let length = lines.lines().filter_map(content_length).next_back().unwrap_or(0);
    let end = head + 4 + length;
    (bytes.len() >= end).then_some((head + 4, end))
}

fn content_length(line: &str) -> Option<usize> {
    let (name, value) = line.split_once(':')?;
    // After a frame whose length was wrong the header may stand behind the rest of a body.
    let length = value.trim().parse().ok().filter(|length| *length <= MESSAGE_LIMIT)?;
    name.to_ascii_lowercase().ends_with("content-length").then_some(length)
}

fn is_message(body: &[u8]) -> bool {
    let Ok(shape) = serde_json::from_slice::<Shape>(body) else { return false };
    if shape.method.is_some() {
        return shape.params.is_none_or(|params| params.allowed);
    }
    // A result may be `null`, which reads like none.
    shape.result.is_some() || shape.error.is_some() || body.windows(8).any(|part| part == b"\"result\"")
}

#[cfg(test)]
mod tests {
    use super::sound;
    use tokio::io::AsyncReadExt;

    fn check(input: &[u8], passed: &[&str]) {
        let runtime = tokio::runtime::Builder::new_current_thread().build().unwrap();
        let input = std::io::Cursor::new(input.to_vec());
        let mut text = String::new();
        runtime.block_on(async { sound(input, |body| vec![body]).read_to_string(&mut text).await.unwrap() });
        let expected: String = passed.iter().map(|body| frame(body)).collect();
        assert_eq!(text, expected);
    }

    fn frame(body: &str) -> String {
        format!("Content-Length: {}\r\n\r\n{body}", body.len())
    }

    const GOOD: &str = r#"{"jsonrpc":"2.0","method":"initialized","params":{}}"#;
    const ANSWER: &str = r#"{"jsonrpc":"2.0","id":1,"result":null}"#;

    #[test]
    fn messages_pass() {
        check(format!("{}{}", frame(GOOD), frame(ANSWER)).as_bytes(), &[GOOD, ANSWER]);
        let many_headers = format!("A: b\r\nC: d\r\nE: f\r\ncontent-length: {}\r\n\r\n{GOOD}", GOOD.len());
        check(many_headers.as_bytes(), &[GOOD]);
    }

    #[test]
    fn what_is_none_is_dropped_and_the_next_passes() {
        for bad in [
            "{",
            "[]",
            "7",
            "{}",
            r#"{"jsonrpc":"1.0","method":"x"}"#,
            r#"{"jsonrpc":"2.0","method":7}"#,
            r#"{"jsonrpc":"2.0","method":"x","params":7}"#,
            r#"{"jsonrpc":"2.0","id":{},"method":"x"}"#,
            r#"{"jsonrpc":"2.0","method":"x","params":["\ud800"]}"#,
            r#"{"jsonrpc":"2.0","method":"x","params":[1e999]}"#,
        ] {
            check(format!("{}{}", frame(bad), frame(GOOD)).as_bytes(), &[GOOD]);
        }
        check(&[b"Content-Length: 3\r\n\r\n\xff\xfe\x00", frame(GOOD).as_bytes()].concat(), &[GOOD]);
        let broken = b"{\"jsonrpc\":\"2.0\",\"method\":\"x\",\"params\":[\"\xff\"]}";
        let header = format!("Content-Length: {}\r\n\r\n", broken.len());
        check(&[header.as_bytes(), broken, frame(GOOD).as_bytes()].concat(), &[GOOD]);
        check(format!("noise\r\n\r\nContent-Length: x\r\n\r\n{}", frame(GOOD)).as_bytes(), &[GOOD]);
        check(format!("Content-Length: 99999999999\r\n\r\n{}", frame(GOOD)).as_bytes(), &[GOOD]);
    }

    #[test]
    fn a_frame_cut_off_by_the_end_is_no_message() {
        // What there is would be a message, were it not one byte short.
        check(format!("Content-Length: {}\r\n\r\n{GOOD}", GOOD.len() + 1).as_bytes(), &[]);
        check(b"", &[]);
    }
}
