//! Fields of a table in text, with their places.

use crate::text::{Diagnostic, Message, Span};
use csv_core::{ReadFieldResult, ReaderBuilder};

/// One field without quotes and surrounding blanks, and the cells it covers, quotes included.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub(super) struct Field {
    pub text: String,
    pub span: Span,
}

/// The fields of one line.
pub(super) type Record = Vec<Field>;

/// More than this are not read: no PLC has so many devices.
const MOST_RECORDS: usize = 200_000;

/// A quote that nothing closes swallows the rest of the text; so many of them are read past.
const MOST_OPEN_QUOTES: usize = 10;

/// What parts the fields: the separator that comes first in most lines. A device has none in its name, so the text of
/// comments does not mislead.
pub(super) fn separator_of(text: &str) -> u8 {
    const SEPARATORS: [u8; 3] = [b',', b';', b'\t'];
    let mut counts = [0usize; 3];
    for line in text.lines().take(200) {
        let mut quoted = false;
        let first = line.bytes().find_map(|byte| {
            quoted ^= byte == b'"';
            SEPARATORS.iter().position(|separator| !quoted && *separator == byte)
        });
        if let Some(first) = first {
            counts[first] += 1;
        }
    }
    let most = counts.iter().copied().max().unwrap_or(0);
    counts.iter().position(|count| *count == most).map_or(b',', |number| SEPARATORS[number])
}

/// The records of `text` and what was wrong on the way.
pub(super) fn records(text: &str, separator: u8) -> (Vec<Record>, Vec<Diagnostic>) {
    let (mut records, mut problems) = (Vec::new(), Vec::new());
    let mark = if text.starts_with('\u{feff}') { 3 } else { 0 };
    let mut start = mark;
    let problem = |span: Span, message: Message| Diagnostic::new(super::CODE, span, message);
    loop {
        match read(text, start, separator, &mut records) {
            End::OfText => break,
            End::OfPatience(at) => {
                let message = Message::new("device-comments.too-many").with("limit", MOST_RECORDS);
                problems.push(problem(Span::new(at, line_end(text, at)), message));
                break;
            }
            End::InQuote(quote) => {
                let end = line_end(text, quote);
                problems.push(problem(Span::new(quote, end), Message::new("device-comments.open-quote")));
                start = end;
            }
        }
        if problems.len() >= MOST_OPEN_QUOTES {
            break;
        }
    }
    (records, problems)
}

/// Where reading ended.
enum End {
    OfText,
    /// With the first place that was not read.
    OfPatience(usize),
    /// With the place of a quote that is open at the end of the text; its record is left out.
    InQuote(usize),
}

/// Reads from `start` on.
fn read(text: &str, start: usize, separator: u8, records: &mut Vec<Record>) -> End {
    let bytes = text.as_bytes();
    let mut reader = ReaderBuilder::new().delimiter(separator).build();
    let mut buffer = vec![0; 256];
    let mut record = Record::new();
    let mut at = start;
    loop {
        if records.len() >= MOST_RECORDS {
            let rest = text.get(at..).unwrap_or("");
            let blank = rest.len() - rest.trim_start().len();
            return if blank == rest.len() { End::OfText } else { End::OfPatience(at + blank) };
        }
        let (mut field_start, mut length) = (at, 0);
        let result = loop {
            let (result, read, written) = reader.read_field(&bytes[at..], &mut buffer[length..]);
            at += read;
            length += written;
            match result {
                ReadFieldResult::OutputFull => buffer.resize(buffer.len() * 2, 0),
                // At the end of the input the reader wants to be told that nothing follows.
                ReadFieldResult::InputEmpty => {}
                result => break result,
            }
        };
        if matches!(result, ReadFieldResult::End) {
            break;
        }
        // The reader passes over empty lines before a record.
        if record.is_empty() {
            field_start +=
                bytes[field_start..at].iter().take_while(|byte| matches!(byte, b'\r' | b'\n')).count();
        }
        let raw = text.get(field_start..at).unwrap_or("");
        let inner = raw.trim_end_matches(['\r', '\n']);
        let inner =
            inner.strip_suffix(char::from(separator)).filter(|_| raw.len() == inner.len()).unwrap_or(inner);
        if at == bytes.len() && inner.starts_with('"') && !is_closed(inner) {
            return End::InQuote(field_start);
        }
        record.push(field(inner, field_start, &buffer[..length]));
        if matches!(result, ReadFieldResult::Field { record_end: true }) {
            records.push(std::mem::take(&mut record));
        }
    }
    End::OfText
}

fn field(raw: &str, start: usize, content: &[u8]) -> Field {
    let lead = raw.len() - raw.trim_start().len();
    let text = String::from_utf8_lossy(content).trim().to_string();
    let span = Span::new(start + lead, start + lead + raw.trim().len());
    Field { text, span }
}

/// Whether the quote with which `raw` starts is closed: two quotes in it stand for one.
fn is_closed(raw: &str) -> bool {
    raw.bytes().filter(|byte| *byte == b'"').count() % 2 == 0
}

fn line_end(text: &str, from: usize) -> usize {
    text.get(from..).and_then(|rest| rest.find(['\r', '\n'])).map_or(text.len(), |end| from + end)
}
