//! `rungwise decode`

use super::Outcome;
use super::check::target_named;
use super::input::{complain, put, remark};
use crate::machine_code::{BLANK, Image, decode};
use crate::target::{Model, Target};
use crate::text::{Language, Message};
use serde_json::Value;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// What `rungwise encode` wrote, or program memory in bytes, the low byte of each word first.
    file: PathBuf,
    /// The FX model that the words are for [default: the one in the file, or fx2n].
    #[arg(long, value_parser = target_named)]
    target: Option<&'static Target>,
    /// Write the result to this file, not to standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// The words in a file, and the model that it names.
struct Code {
    words: Vec<u16>,
    model: Option<Model>,
}

/// Words that are no instructions are told and are no failure, for the list says all of the file.
pub(super) fn run(arguments: &Arguments, language: Language) -> Outcome {
    let say = |key: &'static str| Message::new(key).render(language);
    if let Some(asked) = arguments.target.filter(|asked| !asked.is_fx()) {
        let reason = Message::new("cli.no-words").with("target", asked.name).render(language);
        complain("target-refused", &reason, &say("cli.name-fx-model"), language);
        return Outcome::Unusable;
    }
    let path = arguments.file.display();
    let bytes = match std::fs::read(&arguments.file) {
        Ok(bytes) => bytes,
        Err(reason) => {
            complain("unreadable-input", &format!("{path}: {reason}"), &say("cli.check-path"), language);
            return Outcome::Unusable;
        }
    };
    let code = match read(&bytes) {
        Ok(code) => code,
        Err(key) => {
            let reason = Message::new(key).with("path", &path).render(language);
            complain("unreadable-input", &reason, &say("cli.give-words"), language);
            return Outcome::Unusable;
        }
    };
    let model = arguments.target.map(|target| target.model).or(code.model).unwrap_or(Model::Fx2n);
    let listing = decode(&code.words, model);
    if !put(&listing.text, arguments.output.as_deref(), language) {
        return Outcome::Unusable;
    }
    let unread = listing.lines.iter().filter(|line| !line.is_read).count();
    if unread > 0 {
        let told = Message::new("cli.unread-words").with("path", &path).with("count", unread);
        remark(&told.with("target", Target::of(model).title).render(language));
    }
    Outcome::Clean
}

/// The words in hexadecimal digits, in JSON, or else in bytes.
///
/// # Errors
/// With the key of the reason.
fn read(bytes: &[u8]) -> Result<Code, &'static str> {
    let is_text = |text: &&str| !text.chars().any(|c| c.is_control() && !c.is_ascii_whitespace());
    let text =
        std::str::from_utf8(bytes).ok().map(|text| text.trim_start_matches('\u{feff}')).filter(is_text);
    match text {
        Some(text) if text.trim_start().starts_with('{') => read_json(text).ok_or("cli.no-words-json"),
        Some(text) => read_hex(text).ok_or("cli.no-words-hex"),
        None => read_memory(bytes).ok_or("cli.half-a-word"),
    }
}

/// Words of four digits, parted by blanks and line ends.
fn read_hex(text: &str) -> Option<Code> {
    let word = |word: &str| (word.len() == 4).then(|| u16::from_str_radix(word, 16).ok()).flatten();
    let words = text.split_whitespace().map(word).collect::<Option<_>>()?;
    Some(Code { words, model: None })
}

fn read_json(text: &str) -> Option<Code> {
    let document: Value = serde_json::from_str(text).ok()?;
    let word = |word: &Value| u16::try_from(word.as_u64()?).ok();
    let words = document.get("words")?.as_array()?.iter().map(word).collect::<Option<_>>()?;
    let target = document.get("model").and_then(Value::as_str).and_then(Target::named);
    Some(Code { words, model: target.filter(|target| target.is_fx()).map(|target| target.model) })
}

/// Memory from step 0 on, or with the parameter block before it if it is as long as that says. The blank memory behind
/// a program is left out, and in a whole image what an older program left behind END.
fn read_memory(bytes: &[u8]) -> Option<Code> {
    if let Some(image) = Image::from_bytes(bytes).filter(|image| image.to_bytes().len() == bytes.len()) {
        return Some(Code { words: image.program().to_vec(), model: None });
    }
    let (pairs, rest) = bytes.as_chunks::<2>();
    let mut words: Vec<u16> =
        rest.is_empty().then(|| pairs.iter().map(|pair| u16::from_le_bytes(*pair)).collect())?;
    let used = words.iter().rposition(|word| *word != BLANK).map_or(0, |last| last + 1);
    words.truncate(used);
    Some(Code { words, model: None })
}
