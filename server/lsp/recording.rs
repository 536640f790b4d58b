//! Recordings of what a client sends, for bug reports: one line of JSON a message, `{"ms": 12, "message": {…}}`, with
//! the milliseconds since the start of the server.

use super::frames::{framed, whole_frame};
use super::serve_between;
use crate::text::Language;
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Instant;
use tokio::io::{AsyncRead, AsyncWrite, AsyncWriteExt, ReadBuf};
use tokio::sync::Notify;

/// A message of a recording.
#[derive(Serialize, Deserialize)]
struct Entry<'m> {
    ms: u64,
    #[serde(borrow)]
    message: &'m RawValue,
}

/// Why a recording cannot be replayed: this line, from 1, is no entry.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct NoEntry(pub usize);

/// Serves one client on standard input and output, as [`serve`](super::serve) does, and writes its messages to `log`.
pub async fn serve_mirrored(
    log: impl std::io::Write + Send + Unpin + 'static,
    asked: Option<Language>,
    otherwise: Language,
) -> u8 {
    let input = Mirror { input: tokio::io::stdin(), recorder: Recorder::new(log) };
    serve_between(input, tokio::io::stdout(), asked, otherwise).await
}

/// Plays `recording` to a server, as fast as it takes it, and writes what the server says to `output`. A server that
/// the recording does not shut down ends with it.
///
/// # Errors
/// Where a line is no message of a recording; nothing is played then.
pub async fn replay(
    recording: &str,
    output: impl AsyncWrite + Send + Unpin,
    asked: Option<Language>,
    otherwise: Language,
) -> Result<u8, NoEntry> {
    let mut messages = Vec::new();
    for (number, line) in (1..).zip(recording.lines()) {
        if !line.trim().is_empty() {
            let entry: Entry<'_> = serde_json::from_str(line).map_err(|_| NoEntry(number))?;
            messages.push(entry.message.get().to_string());
        }
    }
    let says = |method: &str| messages.iter().any(|message| method_of(message).as_deref() == Some(method));
    if says("initialize") && !says("shutdown") {
        messages.push(r#"{"jsonrpc":"2.0","id":"replay","method":"shutdown"}"#.to_string());
    }
    let (mut client, input) = tokio::io::duplex(1 << 16);
    let spoken = Arc::new(Notify::new());
    let output = Tap { output, spoken: spoken.clone() };
    tokio::spawn(async move {
        let exit = r#"{"jsonrpc":"2.0","method":"exit"}"#;
        for message in messages {
            let method = method_of(&message);
            if method.as_deref() == Some("exit") {
                break;
            }
            if client.write_all(&framed(message.as_bytes())).await.is_err() {
                return;
            }
            // A client waits for the answer, and the server refuses what comes before it.
            if method.as_deref() == Some("initialize") {
                let _ = tokio::time::timeout(PATIENCE, spoken.notified()).await;
            }
        }
        // What is under way is answered and published before the server ends.
        tokio::time::sleep(SETTLING).await;
        let _ = client.write_all(&framed(exit.as_bytes())).await;
        let _ = client.shutdown().await;
    });
    Ok(serve_between(input, output, asked, otherwise).await)
}

/// How long the server has for its last answers.
const SETTLING: std::time::Duration = std::time::Duration::from_millis(500);

/// How long the first answer may take.
const PATIENCE: std::time::Duration = std::time::Duration::from_secs(10);

/// Hands bytes on and tells that the server spoke.
struct Tap<W> {
    output: W,
    spoken: Arc<Notify>,
}

impl<W: AsyncWrite + Unpin> AsyncWrite for Tap<W> {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<std::io::Result<usize>> {
        self.spoken.notify_one();
        Pin::new(&mut self.output).poll_write(context, bytes)
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<std::io::Result<()>> {
        Pin::new(&mut self.output).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<std::io::Result<()>> {
        Pin::new(&mut self.output).poll_shutdown(context)
    }
}

fn method_of(message: &str) -> Option<String> {
    #[derive(Deserialize)]
    struct Named {
        method: Option<String>,
    }
    serde_json::from_str::<Named>(message).ok()?.method
}

/// Hands bytes on and shows them to the recorder.
struct Mirror<I, W> {
    input: I,
    recorder: Recorder<W>,
}

impl<I: AsyncRead + Unpin, W: std::io::Write + Unpin> AsyncRead for Mirror<I, W> {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<std::io::Result<()>> {
        let before = buffer.filled().len();
        let polled = Pin::new(&mut self.input).poll_read(context, buffer);
        if let Poll::Ready(Ok(())) = polled {
            let read = buffer.filled().get(before..).unwrap_or(&[]).to_vec();
            self.recorder.take(&read);
        }
        polled
    }
}

/// Cuts the client's bytes into messages and writes them down.
struct Recorder<W> {
    log: W,
    started: Instant,
    bytes: Vec<u8>,
    failed: bool,
}

impl<W: std::io::Write> Recorder<W> {
    fn new(log: W) -> Recorder<W> {
        Recorder { log, started: Instant::now(), bytes: Vec::new(), failed: false }
    }

    fn take(&mut self, read: &[u8]) {
        self.bytes.extend_from_slice(read);
        while let Some((start, end)) = whole_frame(&self.bytes) {
            let ms = u64::try_from(self.started.elapsed().as_millis()).unwrap_or(u64::MAX);
            let body = std::str::from_utf8(&self.bytes[start..end]).ok();
            // What is no JSON is dropped by the server, too.
            let message = body.and_then(|body| serde_json::from_str::<&RawValue>(body).ok());
            if let Some(line) = message.and_then(|message| one_line(ms, message))
                && writeln!(self.log, "{line}").and_then(|()| self.log.flush()).is_err()
                && !std::mem::replace(&mut self.failed, true)
            {
                tracing::error!("the recording cannot be written; the server goes on without it");
            }
            self.bytes.drain(..end);
        }
    }
}

/// An entry on a line of its own, whatever line ends the client put into its JSON.
fn one_line(ms: u64, message: &RawValue) -> Option<String> {
    let value: serde_json::Value = serde_json::from_str(message.get()).ok()?;
    serde_json::to_string(&serde_json::json!({"ms": ms, "message": value})).ok()
}
