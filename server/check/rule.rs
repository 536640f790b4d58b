//! What a rule is.

use super::proof::Prover;
use super::{ChunkContext, ProgramContext};
use crate::text::{self, Book, Diagnostic, Language, Severity};

/// One rule: a row of [`RULES`](super::RULES), one file each, whose `//!` text is its page.
pub struct Rule {
    /// Kebab-case, equal to the file's name.
    pub code: &'static str,
    /// Unless `rungwise.toml` says otherwise.
    pub severity: Severity,
    /// How it is found.
    pub run: Run,
    /// The source file, of which [`Rule::page`] shows the head.
    pub(super) source: &'static str,
}

/// Finds what is wrong in a chunk.
pub(super) type ChunkJudge = fn(&ChunkContext<'_>, &mut Vec<Diagnostic>);

/// How and when a rule is judged.
pub enum Run {
    /// By the reader of the text, which knows best what it could not read. Real-time tier.
    WhileReading,
    /// Together with the rule of this code, whose judge sees both. Same tier as that one.
    With(&'static str),
    /// On a chunk, as soon as an edit touched it. Real-time tier.
    Chunk(fn(&ChunkContext<'_>, &mut Vec<Diagnostic>)),
    /// On the whole program, when typing stops. Batch tier.
    Program(fn(&ProgramContext<'_>, &mut Vec<Diagnostic>)),
    /// On each chunk with rungs that are worth a proof, behind all others. Batch tier.
    Proof(fn(&ChunkContext<'_>, &mut Prover<'_>)),
    /// On what all others have found.
    Last,
    /// On each chunk, and on the whole program: each tier sees a part of it.
    Both(fn(&ChunkContext<'_>, &mut Vec<Diagnostic>), fn(&ProgramContext<'_>, &mut Vec<Diagnostic>)),
}

impl Rule {
    /// The rule with this code.
    pub fn named(code: &str) -> Option<&'static Rule> {
        super::RULES.iter().copied().find(|rule| rule.code == code)
    }

    /// Its page, Markdown: what it is, why it matters on a machine, a failing and a fixed example.
    ///
    /// Fences say their notation: `lad`, `fx` or `iec`, and perhaps a target (`fx fx1n`). `^^^` marks the characters
    /// in the line above which are reported; a fence without marks is clean. All fences run as tests.
    pub fn page(&self) -> String {
        self.page_in(Language::English)
    }

    /// The page in `language`; the examples are the same in all of them.
    pub fn page_in(&self, language: Language) -> String {
        match text::prose(Book::Rules, self.code, language) {
            Some(_) => {
                let page = text::page(Book::Rules, self.code, &self.english(), language).into_owned();
                format!("# {}\n\n{page}", self.code)
            }
            None => self.english(),
        }
    }

    fn english(&self) -> String {
        let head = self.source.lines().take_while(|line| line.starts_with("//!"));
        let mut page = String::new();
        for line in head {
            let text = &line[3..];
            page.push_str(text.strip_prefix(' ').unwrap_or(text));
            page.push('\n');
        }
        page
    }

    /// The first sentence of its page in `language`.
    pub fn summary(&self, language: Language) -> String {
        let page = self.page_in(language);
        let text = page.split_once("\n\n").map_or("", |(_, text)| text);
        let paragraph = text.split("\n\n").next().unwrap_or("").replace('\n', " ");
        let end = match language {
            Language::English => paragraph.find(". ").map(|end| end + 1),
            Language::SimplifiedChinese => paragraph.find('。').map(|end| end + '。'.len_utf8()),
        };
        match end {
            Some(end) => paragraph[..end].to_string(),
            None => paragraph.trim().to_string(),
        }
    }
}
