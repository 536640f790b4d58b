//! What a check has to say about a place in a text.

use super::{Message, Span, TextEdit};

/// How grave a diagnostic is, gravest first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Severity {
    /// The program cannot run, or does something else than drawn.
    Error,
    /// The program runs, a machine may not.
    Warning,
    /// Better done otherwise.
    Hint,
}

impl Severity {
    /// The word for it in `rungwise.toml` and in results for programs.
    pub fn word(self) -> &'static str {
        match self {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Hint => "hint",
        }
    }
}

/// A finding at a place, plain data.
///
/// Parsers and rules make it with offsets into the chunk they saw; the document shifts it to its place.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Diagnostic {
    /// The rule's code, such as `open-circuit`.
    pub code: &'static str,
    /// Set by the check room from the rule's default and the project's settings.
    pub severity: Severity,
    /// The exact cells or words.
    pub span: Span,
    /// What is wrong, and what was expected.
    pub message: Message,
    /// Other places that belong to it.
    pub related: Vec<Related>,
    /// What would mend it, best first.
    pub fixes: Vec<Fix>,
}

/// A place that belongs to a diagnostic, and why.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Related {
    /// The file of the project, by its number there, if it is another one.
    pub file: Option<usize>,
    /// Where.
    pub span: Span,
    /// What is there.
    pub message: Message,
}

/// A change that mends a diagnostic.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Fix {
    /// What it does, as an imperative.
    pub title: Message,
    /// Edits that do not overlap.
    pub edits: Vec<TextEdit>,
}

impl Diagnostic {
    /// An error `code` at `span`; the check room puts the rule's severity in.
    pub fn new(code: &'static str, span: Span, message: Message) -> Diagnostic {
        Diagnostic { code, severity: Severity::Error, span, message, related: Vec::new(), fixes: Vec::new() }
    }

    /// With another place that belongs to it.
    pub fn related(mut self, span: Span, message: Message) -> Diagnostic {
        self.related.push(Related { file: None, span, message });
        self
    }

    /// With a change that mends it.
    pub fn fix(mut self, title: Message, edits: Vec<TextEdit>) -> Diagnostic {
        self.fixes.push(Fix { title, edits });
        self
    }

    /// The same finding in a text in which `by` bytes stand before this one's text.
    pub fn shifted(&self, by: usize) -> Diagnostic {
        self.mapped(|span| span.shifted(by))
    }

    /// The same finding after a change in which the text from `old` on came to start at `new`; places before `old`
    /// stay. Fixes are left out: they were made for the text as it was.
    pub fn moved(&self, old: usize, new: usize) -> Diagnostic {
        let place =
            |offset: u32| if (offset as usize) < old { offset as usize } else { offset as usize - old + new };
        let without_fixes = Diagnostic { fixes: Vec::new(), ..self.clone() };
        without_fixes.mapped(|span| Span::new(place(span.start), place(span.end).max(place(span.start))))
    }

    fn mapped(&self, place: impl Fn(Span) -> Span) -> Diagnostic {
        let related = self.related.iter().map(|r| {
            // Other files stay where they are.
            let span = if r.file.is_none() { place(r.span) } else { r.span };
            Related { file: r.file, span, message: r.message.clone() }
        });
        let fixes = self.fixes.iter().map(|fix| Fix {
            title: fix.title.clone(),
            edits: fix.edits.iter().map(|edit| TextEdit::new(place(edit.span), edit.text.clone())).collect(),
        });
        Diagnostic {
            code: self.code,
            severity: self.severity,
            span: place(self.span),
            message: self.message.clone(),
            related: related.collect(),
            fixes: fixes.collect(),
        }
    }
}
