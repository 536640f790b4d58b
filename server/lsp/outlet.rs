//! The way out: whole messages of the server pass the translator before they are written.

use super::fences::Translator;
use super::frames::{framed, whole_frame};
use super::written::Written;
use std::pin::Pin;
use std::task::{Context, Poll, ready};
use tokio::io::AsyncWrite;

/// Takes the server's bytes, and writes what the translator makes of each message.
pub(super) struct Outlet<W> {
    output: W,
    translator: Translator,
    written: Written,
    /// The part of a message that has come so far.
    taken: Vec<u8>,
    /// What is to be written, from `sent` on.
    waiting: Vec<u8>,
    sent: usize,
}

impl<W> Outlet<W> {
    /// Long answers wait in `written` for their messages.
    pub(super) fn new(output: W, translator: Translator, written: Written) -> Outlet<W> {
        Outlet { output, translator, written, taken: Vec::new(), waiting: Vec::new(), sent: 0 }
    }

    fn take(&mut self, bytes: &[u8]) {
        self.taken.extend_from_slice(bytes);
        while let Some((start, end)) = whole_frame(&self.taken) {
            let rest = self.taken.split_off(end);
            let body = self.taken.split_off(start);
            self.taken = rest;
            for body in self.translator.outgoing(self.written.redeem(body)) {
                self.waiting.extend_from_slice(&framed(&body));
            }
        }
    }
}

impl<W: AsyncWrite + Unpin> Outlet<W> {
    fn poll_drain(&mut self, context: &mut Context<'_>) -> Poll<std::io::Result<()>> {
        while self.sent < self.waiting.len() {
            let rest = &self.waiting[self.sent..];
            let count = ready!(Pin::new(&mut self.output).poll_write(context, rest))?;
            if count == 0 {
                return Poll::Ready(Err(std::io::ErrorKind::WriteZero.into()));
            }
            self.sent += count;
        }
        // A long answer leaves no room behind.
        self.waiting = Vec::new();
        self.sent = 0;
        Poll::Ready(Ok(()))
    }
}

impl<W: AsyncWrite + Unpin> AsyncWrite for Outlet<W> {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<std::io::Result<usize>> {
        ready!(self.poll_drain(context))?;
        self.take(bytes);
        // What cannot be written at once waits for the flush.
        if let Poll::Ready(Err(reason)) = self.poll_drain(context) {
            return Poll::Ready(Err(reason));
        }
        Poll::Ready(Ok(bytes.len()))
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<std::io::Result<()>> {
        ready!(self.poll_drain(context))?;
        Pin::new(&mut self.output).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<std::io::Result<()>> {
        ready!(self.poll_drain(context))?;
        Pin::new(&mut self.output).poll_shutdown(context)
    }
}
