//! The encodings of program files: read as text, written back as they were.

use encoding_rs::{GB18030, UTF_16BE, UTF_16LE};

/// How a file is written.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Encoding {
    /// UTF-8; a byte order mark is the first character of its text.
    Utf8,
    /// UTF-16 with a byte order mark.
    Utf16 {
        /// Whether the low byte comes first.
        little: bool,
    },
    /// GBK, as Chinese Windows writes it, with what GB 18030 adds.
    Gbk,
}

/// The text in `bytes` and how it is written; `None` for text that cannot be written back as it was, in which what
/// means nothing is replaced.
pub fn read(bytes: Vec<u8>) -> (String, Option<Encoding>) {
    let marked = [(&[0xff, 0xfe][..], UTF_16LE, true), (&[0xfe, 0xff], UTF_16BE, false)];
    for (mark, encoding, little) in marked {
        if let Some(rest) = bytes.strip_prefix(mark) {
            let text = encoding.decode_without_bom_handling(rest).0.into_owned();
            return kept(text, Encoding::Utf16 { little }, &bytes);
        }
    }
    match String::from_utf8(bytes) {
        Ok(text) => (text, Some(Encoding::Utf8)),
        Err(broken) => {
            let bytes = broken.into_bytes();
            match GB18030.decode_without_bom_handling_and_without_replacement(&bytes) {
                Some(text) => kept(text.into_owned(), Encoding::Gbk, &bytes),
                None => (String::from_utf8_lossy(&bytes).into_owned(), None),
            }
        }
    }
}

fn kept(text: String, encoding: Encoding, bytes: &[u8]) -> (String, Option<Encoding>) {
    let same = write(&text, encoding).is_some_and(|written| written == bytes);
    (text, same.then_some(encoding))
}

/// The bytes of `text`; nothing if it has a character that the encoding lacks.
pub fn write(text: &str, encoding: Encoding) -> Option<Vec<u8>> {
    match encoding {
        Encoding::Utf8 => Some(text.as_bytes().to_vec()),
        Encoding::Utf16 { little } => {
            let bytes = |unit: u16| if little { unit.to_le_bytes() } else { unit.to_be_bytes() };
            Some(std::iter::once(0xfeff).chain(text.encode_utf16()).flat_map(bytes).collect())
        }
        Encoding::Gbk => {
            let (bytes, _, lacks) = GB18030.encode(text);
            (!lacks).then(|| bytes.into_owned())
        }
    }
}
