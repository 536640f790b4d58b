//! Pages and the phrases of tables in other languages than English.
//!
//! The English text of an instruction, a function or a rule stands where the thing itself is declared; what other
//! languages say stands in `server/text/pages/<language>/`: a book of Markdown for each kind of page, and
//! `phrases.toml` for titles and meanings of a few words. Examples are shared: a translated page has prose only.

use super::Language;
use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::LazyLock;

/// The pages of one kind.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Book {
    /// Rules, by their codes.
    Rules,
    /// FX instructions, by their mnemonics.
    Instructions,
    /// Operators of IEC Instruction List, by their names.
    Operators,
    /// Standard functions that are no conversions, by their names.
    Functions,
    /// Standard function blocks, by their names.
    Blocks,
}

impl Book {
    /// All of them.
    pub const ALL: [Book; 5] =
        [Book::Rules, Book::Instructions, Book::Operators, Book::Functions, Book::Blocks];
}

/// A line of a translated page at which the next code block of the English page stands. Blocks without such a line
/// follow at the end.
pub const EXAMPLE: &str = "{example}";

/// `english`, a page of `book`, with its prose in `language`; the English page where there is no translation.
pub fn page<'p>(book: Book, name: &str, english: &'p str, language: Language) -> Cow<'p, str> {
    match prose(book, name, language) {
        Some(prose) => Cow::Owned(with_blocks(prose, &code_blocks(english))),
        None => Cow::Borrowed(english),
    }
}

/// The translated prose of a page; nothing in English, which needs none.
pub fn prose(book: Book, name: &str, language: Language) -> Option<&'static str> {
    match language {
        Language::English => None,
        Language::SimplifiedChinese => CHINESE_PAGES.get(&(book, name)).copied(),
    }
}

/// The names of all translated pages of `book`.
pub fn sections(book: Book, language: Language) -> Vec<&'static str> {
    match language {
        Language::English => Vec::new(),
        Language::SimplifiedChinese => {
            let names = CHINESE_PAGES.keys().filter(|(of, _)| *of == book);
            names.map(|(_, name)| *name).collect()
        }
    }
}

/// A few words of a table (a title, the meaning of an operand or of a device) in `language`; as they are where there
/// is no translation.
pub fn phrase(english: &str, language: Language) -> &str {
    match language {
        Language::English => english,
        Language::SimplifiedChinese => CHINESE_PHRASES.get(english).map_or(english, String::as_str),
    }
}

/// Whether `english` is translated.
pub fn has_phrase(english: &str, language: Language) -> bool {
    match language {
        Language::English => true,
        Language::SimplifiedChinese => CHINESE_PHRASES.contains_key(english),
    }
}

/// All translated phrases: the English words and those of `language`.
pub fn phrases(language: Language) -> impl Iterator<Item = (&'static str, &'static str)> {
    let table = (language == Language::SimplifiedChinese).then(|| CHINESE_PHRASES.iter());
    table.into_iter().flatten().map(|(english, words)| (english.as_str(), words.as_str()))
}

/// The fenced blocks of a page, fences included.
fn code_blocks(page: &str) -> Vec<&str> {
    let mut blocks = Vec::new();
    let (mut offset, mut open) = (0, None);
    for line in page.split_inclusive('\n') {
        let start = offset;
        offset += line.len();
        if line.starts_with("```") {
            match open.take() {
                Some(first) => blocks.push(&page[first..offset]),
                None => open = Some(start),
            }
        }
    }
    blocks
}

fn with_blocks(prose: &str, blocks: &[&str]) -> String {
    let mut blocks = blocks.iter();
    let mut page = String::with_capacity(2 * prose.len());
    for line in prose.lines() {
        if line == EXAMPLE {
            page.push_str(blocks.next().unwrap_or(&""));
        } else {
            page.push_str(line);
            page.push('\n');
        }
    }
    for block in blocks {
        page.push('\n');
        page.push_str(block);
    }
    page
}

type Pages = HashMap<(Book, &'static str), &'static str>;

static CHINESE_PAGES: LazyLock<Pages> = LazyLock::new(|| {
    let mut pages = Pages::new();
    for (book, text) in [
        (Book::Rules, include_str!("pages/zh-CN/rules.md")),
        (Book::Instructions, include_str!("pages/zh-CN/instructions.md")),
        (Book::Operators, include_str!("pages/zh-CN/operators.md")),
        (Book::Functions, include_str!("pages/zh-CN/functions.md")),
        (Book::Blocks, include_str!("pages/zh-CN/blocks.md")),
    ] {
        read_book(book, text, &mut pages);
    }
    pages
});

/// Each page begins with a line `# NAME`, or with several names for pages with one text; what stands before the first
/// is for whoever edits the book.
fn read_book(book: Book, text: &'static str, pages: &mut Pages) {
    for section in text.split("\n# ").skip(1) {
        let (names, prose) = section.split_once('\n').unwrap_or((section, ""));
        for name in names.split_whitespace() {
            pages.insert((book, name), prose.trim_matches('\n'));
        }
    }
}

/// A file that is not TOML yields nothing; the test of the phrases fails on it.
static CHINESE_PHRASES: LazyLock<HashMap<String, String>> = LazyLock::new(|| {
    let tables: HashMap<String, HashMap<String, String>> =
        toml::from_str(include_str!("pages/zh-CN/phrases.toml")).unwrap_or_default();
    tables.into_values().flatten().collect()
});
