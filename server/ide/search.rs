//! Names in a whole workspace by a few of their letters: POUs, variables, types, labels, networks.

use super::SymbolKind;
use super::names::PouWalk;
use crate::document::{ChunkRef, Document, Mention, ProjectView, Scopes, Symbol, Tree, Use};
use crate::text::Span;

/// No editor shows more of them.
const MOST_FOUND: usize = 500;

/// A name that matches.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct FoundSymbol {
    /// The number of its file.
    pub file: usize,
    /// As written; `Network 3: Start` for a network.
    pub name: String,
    /// The POU in which it stands, or nothing.
    pub container: String,
    /// What it is.
    pub kind: SymbolKind,
    /// The name's cells.
    pub span: Span,
    /// Better matches have more.
    score: i32,
}

/// The names in the files of `view` that contain the letters of `query` in their order, best matches first.
pub(super) fn symbols(view: &ProjectView<'_>, query: &str) -> Vec<FoundSymbol> {
    let query: Vec<char> =
        query.chars().filter(|c| !c.is_whitespace()).flat_map(char::to_lowercase).collect();
    let mut found = Vec::new();
    for (file, member) in view.members().iter().enumerate() {
        Search { file, document: member.document, query: &query, found: &mut found }.run(view);
    }
    // Those that fell behind the best are forgotten at once, the rest is in the order of the files.
    found.sort_by_key(|symbol: &FoundSymbol| {
        (std::cmp::Reverse(symbol.score), symbol.name.len(), symbol.file, symbol.span)
    });
    found.truncate(MOST_FOUND);
    found
}

struct Search<'a> {
    file: usize,
    document: &'a Document,
    query: &'a [char],
    found: &'a mut Vec<FoundSymbol>,
}

impl Search<'_> {
    fn run(&mut self, view: &ProjectView<'_>) {
        let scopes = self.document.scopes();
        let mut walk = PouWalk::default();
        let mut start = 0;
        for page in self.document.pages() {
            if view.is_cancelled() {
                return;
            }
            for chunk in page.chunks() {
                let pou = walk.enter(chunk);
                self.chunk(ChunkRef { start, chunk }, pou, scopes);
                start += chunk.len();
            }
        }
    }

    fn chunk(&mut self, at: ChunkRef<'_>, pou: Option<usize>, scopes: &Scopes) {
        let container = || pou.and_then(|number| scopes.pous.get(number)).map_or("", |pou| pou.name.as_str());
        for mention in at.chunk.mentions().iter().filter(|mention| mention.usage == Use::Declare) {
            let name = mention.span.of(at.chunk.text()).trim_end_matches(':');
            let (Some(kind), Some(score)) = (kind_of(mention, scopes), score(name, self.query)) else {
                continue;
            };
            let is_inside = !matches!(mention.symbol, Symbol::Pou(_) | Symbol::Type(_));
            let container = if is_inside { container().to_string() } else { String::new() };
            self.add(name.to_string(), container, kind, mention.span.shifted(at.start), score);
        }
        if !has_network(at.chunk.text()) {
            return;
        }
        let reading = at.chunk.reading();
        let Tree::Ladder(tree) = reading.tree() else { return };
        let Some(header) = &tree.header else { return };
        let title = header.title.map_or("", |title| title.of(at.chunk.text()));
        let number = header.number.map(|number| number.value.to_string()).unwrap_or_default();
        if header.number.is_none() && title.is_empty() {
            return;
        }
        let name = format!("NETWORK {number} {title}").trim_end().to_string();
        if let Some(score) = score(&name, self.query) {
            let container = container().to_string();
            self.add(name, container, SymbolKind::Network, header.span.shifted(at.start), score);
        }
    }

    fn add(&mut self, name: String, container: String, kind: SymbolKind, span: Span, score: i32) {
        // An empty query matches everything; a client asks again with letters.
        if self.found.len() < MOST_FOUND || !self.query.is_empty() {
            self.found.push(FoundSymbol { file: self.file, name, container, kind, span, score });
        }
    }
}

/// Whether a network may begin in the text; drawings are read only for that.
fn has_network(text: &str) -> bool {
    const WORD: &[u8] = b"network";
    text.as_bytes().windows(WORD.len()).any(|part| part.eq_ignore_ascii_case(WORD))
}

fn kind_of(mention: &Mention, scopes: &Scopes) -> Option<SymbolKind> {
    Some(match &mention.symbol {
        Symbol::Pou(name) => scopes.pou_named(name).map_or(SymbolKind::Program, |pou| pou.kind.into()),
        Symbol::Variable(_) => SymbolKind::Variable,
        Symbol::Type(_) => SymbolKind::Type,
        Symbol::Label(_) | Symbol::Device(_) => SymbolKind::Label,
        Symbol::Direct(_) | Symbol::Connector(_) => return None,
    })
}

/// How well `name` has the letters of `query`, which are in lower case; nothing if it does not have them in order.
///
/// Letters count more at the start of the name and of its parts (`_`, a capital behind a small letter), and right
/// behind each other.
fn score(name: &str, query: &[char]) -> Option<i32> {
    let mut wanted = query.iter();
    let mut next = wanted.next();
    let (mut score, mut run) = (0, 0);
    let mut before: Option<char> = None;
    for character in name.chars() {
        let Some(letter) = next else { break };
        if character.to_lowercase().eq([*letter]) {
            let starts_part = before.is_none_or(|before| {
                !before.is_alphanumeric() || before.is_lowercase() && character.is_uppercase()
            });
            run += 1;
            score += run + if starts_part { 8 } else { 0 } + if before.is_none() { 8 } else { 0 };
            next = wanted.next();
        } else {
            run = 0;
        }
        before = Some(character);
    }
    next.is_none().then_some(score)
}

#[cfg(test)]
mod tests {
    use super::score;

    fn of(name: &str, query: &str) -> Option<i32> {
        score(name, &query.chars().collect::<Vec<_>>())
    }

    #[test]
    fn better_matches_score_higher() {
        assert_eq!(of("Motor", "x"), None);
        assert_eq!(of("Motor", "rm"), None, "the order counts");
        assert_eq!(of("Motor", ""), Some(0));
        assert!(of("MotorOn", "mo") > of("AlarmOn", "mo"));
        assert!(of("StartMotor", "sm") > of("Steam", "sm"));
        assert!(of("start_motor", "sm") > of("steam", "sm"));
        assert!(of("Übergabe", "üb").is_some());
    }
}
