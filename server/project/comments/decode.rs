//! Bytes to text, in the encodings that spreadsheets and programming tools write.

use encoding_rs::{Encoding, GB18030, UTF_8, UTF_16BE, UTF_16LE};

/// So many bytes decide whether a text without a mark is UTF-16.
const LOOKED_AT: usize = 400;

/// The text: UTF-8 or UTF-16 by their byte order mark, UTF-16 without a mark where every other byte is 0, UTF-8 where
/// the bytes are so, else GBK, in which Chinese Windows saves such files. Bytes that mean nothing become U+FFFD.
pub fn decode(bytes: &[u8]) -> String {
    if let Some((encoding, mark)) = Encoding::for_bom(bytes) {
        return encoding.decode_without_bom_handling(&bytes[mark..]).0.into_owned();
    }
    if let Some(encoding) = without_mark(bytes) {
        return encoding.decode_without_bom_handling(bytes).0.into_owned();
    }
    let encoding = if std::str::from_utf8(bytes).is_ok() { UTF_8 } else { GB18030 };
    encoding.decode_without_bom_handling(bytes).0.into_owned()
}

/// Device names are ASCII, so in UTF-16 a good part of either the even or the odd bytes is 0.
fn without_mark(bytes: &[u8]) -> Option<&'static Encoding> {
    let head = &bytes[..bytes.len().min(LOOKED_AT)];
    let zeros = |first: usize| head.iter().skip(first).step_by(2).filter(|byte| **byte == 0).count();
    let (even, odd) = (zeros(0), zeros(1));
    let enough = head.len() / 8;
    match (even > enough, odd > enough) {
        (false, true) => Some(UTF_16LE),
        (true, false) => Some(UTF_16BE),
        _ => None,
    }
}
