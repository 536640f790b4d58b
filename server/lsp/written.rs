//! Long answers on their way out: written as JSON by the handler, and put into the message after the protocol library.
//!
//! The library makes a tree of values of each answer, which for all tokens of a long document takes tens of MiB, and
//! writes it on the task that also reads `$/cancelRequest`. So a handler whose answer may be long writes it by itself,
//! on its own thread; the library gets a ticket for it, and [`Written::redeem`] puts the answer in the ticket's place.

use rustc_hash::FxHashMap;
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;
use std::cell::RefCell;
use std::future::Future;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tower_lsp::jsonrpc::Response;

tokio::task_local! {
    /// What the handler of this task wrote instead of an answer.
    static ANSWER: RefCell<Option<Box<RawValue>>>;
}

/// Starts the result of a response for which a written answer waits; its number follows.
const TICKET: &str = "rungwise-written-answer:";

/// So a message with a ticket starts, and no other.
const HEAD: &str = r#"{"jsonrpc":"2.0","result":"rungwise-written-answer:"#;

/// The answers that were written and are not sent yet.
#[derive(Clone, Default)]
pub(super) struct Written {
    waiting: Arc<Mutex<Waiting>>,
}

#[derive(Default)]
struct Waiting {
    answers: FxHashMap<u64, Box<RawValue>>,
    next: u64,
}

/// A response of the library.
#[derive(Serialize, Deserialize)]
struct Envelope<'m, R> {
    jsonrpc: &'m str,
    result: R,
    #[serde(borrow)]
    id: &'m RawValue,
}

/// `answer` as JSON; nothing if it cannot be written.
pub(super) fn write(answer: &impl Serialize) -> Option<Box<RawValue>> {
    serde_json::value::to_raw_value(answer)
        .inspect_err(|reason| tracing::error!("an answer could not be written: {reason}"))
        .ok()
}

/// Takes what was written, if anything was, as the answer of the handler that runs, and gives what it is to return.
pub(super) fn given<T>(answer: Option<Option<Box<RawValue>>>) -> Option<T> {
    if let Some(answer) = answer.flatten() {
        // There is no such place outside of a request, where nobody waits for an answer.
        let _ = ANSWER.try_with(|place| place.replace(Some(answer)));
    }
    None
}

impl Written {
    /// Runs a handler; a ticket is the result in its response if it wrote its answer.
    pub(super) async fn scope<E>(
        self,
        handler: impl Future<Output = Result<Option<Response>, E>>,
    ) -> Result<Option<Response>, E> {
        let place = RefCell::new(None);
        let run = async {
            let response = handler.await;
            (response, ANSWER.with(RefCell::take))
        };
        match ANSWER.scope(place, run).await {
            (Ok(Some(response)), Some(answer)) if response.is_ok() => {
                let (id, _) = response.into_parts();
                Ok(Some(Response::from_ok(id, self.ticket(answer).into())))
            }
            (response, _) => response,
        }
    }

    fn ticket(&self, answer: Box<RawValue>) -> String {
        let mut waiting = self.lock();
        let number = waiting.next;
        waiting.next += 1;
        waiting.answers.insert(number, answer);
        format!("{TICKET}{number}")
    }

    /// The message `body` with the answer in the place of its ticket, if it has one.
    pub(super) fn redeem(&self, body: Vec<u8>) -> Vec<u8> {
        if !body.starts_with(HEAD.as_bytes()) {
            return body;
        }
        let Ok(Envelope { jsonrpc, result, id }) = serde_json::from_slice::<Envelope<'_, &str>>(&body) else {
            return body;
        };
        let number = result.strip_prefix(TICKET).and_then(|number| number.parse().ok());
        let Some(result) = number.and_then(|number: u64| self.lock().answers.remove(&number)) else {
            return body;
        };
        serde_json::to_vec(&Envelope { jsonrpc, result, id }).unwrap_or(body)
    }

    fn lock(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::{TICKET, Written, given, write};
    use serde_json::json;
    use tower_lsp::jsonrpc::{Error, Id, Response};

    /// What the client gets of the answer `[1,2]` that a handler wrote before it came to `result`.
    async fn sent(written: &Written, id: Id, result: Result<serde_json::Value, Error>) -> String {
        let handler = async {
            assert_eq!(given::<()>(Some(write(&[1, 2]))), None);
            Ok::<_, ()>(Some(Response::from_parts(id, result)))
        };
        let response = written.clone().scope(handler).await.unwrap().unwrap();
        let body = serde_json::to_vec(&response).unwrap();
        String::from_utf8(written.redeem(body)).unwrap()
    }

    #[tokio::test]
    async fn a_written_answer_takes_the_place_of_its_ticket_once() {
        let written = Written::default();
        let named = Id::String("a \"b\" é".into());
        let message = sent(&written, named, Ok(json!(null))).await;
        assert_eq!(message, r#"{"jsonrpc":"2.0","result":[1,2],"id":"a \"b\" é"}"#);
        assert!(written.lock().answers.is_empty());
        let unknown = format!(r#"{{"jsonrpc":"2.0","result":"{TICKET}0","id":1}}"#).into_bytes();
        assert_eq!(written.redeem(unknown.clone()), unknown);
    }

    #[tokio::test]
    async fn a_request_that_failed_keeps_its_error() {
        let written = Written::default();
        let message = sent(&written, Id::Number(3), Err(Error::request_cancelled())).await;
        assert!(message.contains("-32800"), "{message}");
        assert!(written.lock().answers.is_empty());
    }
}
