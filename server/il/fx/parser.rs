//! Tokens to records, line by line. A line is a mnemonic and words, so there is no grammar to combine.

use super::lexer::Token;
use super::{FxLine, FxTree, LineKind};
use crate::target::{Accepts, Form, Model, Operand, OperandProblem, Target};
use crate::text::{Diagnostic, Message, Span, Spanned, TextEdit};
use logos::Logos;

const SYNTAX_ERROR: &str = "syntax-error";
const UNCLOSED_COMMENT: &str = "unclosed-comment";

/// Reads one chunk of a program for `target`. Never fails: what cannot be read is in [`FxTree::problems`], or
/// stands in the records as [`LineKind::Unknown`] and [`Operand::Invalid`].
///
/// Operands are parted by blanks or commas. Comments are `;` and `//` to the end of the line and `(* … *)`, which
/// may span lines; one that does ends the line that it began on. A step number or a label may stand before an
/// instruction, a colon after a label, blanks before the sign of a comparing contact.
pub fn parse(chunk: &str, target: &Target) -> FxTree {
    let mut parser = Parser::new(chunk, target);
    let mut lexer = Token::lexer(chunk);
    // The lexer stops at each character that it does not know; a run of them is one finding.
    let mut stray: Option<Span> = None;
    while let Some(token) = lexer.next() {
        let range = lexer.span();
        let span = Span::new(range.start, range.end);
        if let Some(run) = stray {
            if token.is_err() && run.end == span.start {
                stray = Some(run.to(span));
                continue;
            }
            parser.stray(run);
            stray = None;
        }
        match token {
            Ok(Token::Newline) => parser.end_line(),
            Ok(Token::Comma) => parser.comma(span),
            Ok(Token::Colon) => parser.colon(span),
            Ok(Token::Word) => parser.word(span),
            Ok(Token::Compare) => parser.compare(span),
            Ok(Token::Text) => parser.text(span),
            Ok(Token::OpenText) => {
                parser.problem(span, "fx-syntax.open-text");
                parser.text(span);
            }
            Ok(Token::LineComment) => parser.tree.comments.push(span),
            Ok(Token::BlockComment(closed)) => parser.block_comment(span, closed),
            Err(()) => stray = Some(span),
        }
    }
    stray.into_iter().for_each(|run| parser.stray(run));
    parser.end_line();
    parser.tree
}

/// How far the line has been read.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    /// At its beginning, or behind a label.
    Start,
    /// Directly behind a label, where a colon may stand.
    Label,
    /// Behind a mnemonic.
    Operands,
    /// Behind something that no instruction can begin with; waits for a word that is an instruction.
    Lost,
}

struct Parser<'a> {
    chunk: &'a str,
    target: &'a Target,
    tree: FxTree,
    place: Place,
    step: Option<Spanned<u32>>,
    /// The comma after the last operand.
    comma: Option<Span>,
    /// Where the last word ended that a stray character may be glued to; never 0 behind a word.
    glue: u32,
}

impl<'a> Parser<'a> {
    fn new(chunk: &'a str, target: &'a Target) -> Parser<'a> {
        // An FX program in a project for another target is still read with the FX spelling of devices.
        let target = if target.is_fx() { target } else { Target::of(Model::Fx2n) };
        // Programs have about a record and an operand a line, so the vectors seldom grow.
        let lines = chunk.bytes().filter(|byte| *byte == b'\n').count() + 1;
        let (lines, operands) = (Vec::with_capacity(lines), Vec::with_capacity(lines));
        let tree = FxTree { lines, operands, ..FxTree::default() };
        Parser { chunk, target, tree, place: Place::Start, step: None, comma: None, glue: 0 }
    }

    fn problem(&mut self, span: Span, key: &'static str) {
        let message = Message::new(key).with("word", span.of(self.chunk));
        self.tree.problems.push(Diagnostic::new(SYNTAX_ERROR, span, message));
    }

    fn end_line(&mut self) {
        if let Some(comma) = self.comma.take() {
            self.problem(comma, "fx-syntax.nothing-after-comma");
        }
        if let Some(step) = self.step.take() {
            self.problem(step.span, "fx-syntax.step-alone");
        }
        self.place = Place::Start;
        self.glue = 0;
    }

    fn word(&mut self, span: Span) {
        match self.place {
            Place::Operands if span.start == self.glue && self.is_glued() => self.extend(span),
            Place::Operands => self.operand(span),
            Place::Lost if Form::named(span.of(self.chunk)).is_some() => self.instruction(span),
            Place::Lost => {}
            Place::Start | Place::Label => self.first_word(span),
        }
    }

    fn first_word(&mut self, span: Span) {
        let word = span.of(self.chunk);
        if self.step.is_none() && word.bytes().all(|byte| byte.is_ascii_digit()) {
            match word.parse() {
                Ok(step) => self.step = Some(Spanned::new(step, span)),
                Err(_) => self.problem(span, "fx-syntax.step-too-large"),
            }
            return;
        }
        match label(word, self.target.model) {
            Some(kind) => {
                self.record(span, kind);
                self.place = Place::Label;
            }
            None => self.instruction(span),
        }
    }

    fn instruction(&mut self, span: Span) {
        let kind = Form::named(span.of(self.chunk)).map_or(LineKind::Unknown, LineKind::Instruction);
        self.record(span, kind);
        self.place = Place::Operands;
        self.glue = span.end;
    }

    fn record(&mut self, span: Span, kind: LineKind) {
        let first = self.tree.operands.len() as u32;
        let step = self.step.take();
        self.tree.lines.push(FxLine { span, step, mnemonic: span, kind, operands: (first, first) });
    }

    fn operand(&mut self, span: Span) {
        let word = span.of(self.chunk);
        if self.takes_text_only() {
            return self.push_operand(span, Operand::Text);
        }
        let operand = self.target.read(word);
        if matches!(operand, Operand::Invalid(_)) && Form::named(word).is_some() {
            return self.second_instruction(span);
        }
        self.push_operand(span, operand);
    }

    fn push_operand(&mut self, span: Span, operand: Operand) {
        self.tree.operands.push(Spanned::new(operand, span));
        let end = self.tree.operands.len() as u32;
        if let Some(line) = self.tree.lines.last_mut() {
            line.operands.1 = end;
            line.span.end = span.end;
        }
        self.comma = None;
        self.glue = span.end;
    }

    /// Whether the next operand is a text, which then needs no quotes (`ASC ABCDEFGH D300`).
    fn takes_text_only(&self) -> bool {
        let Some(FxLine { kind: LineKind::Instruction(form), operands, .. }) = self.tree.lines.last() else {
            return false;
        };
        let place = (operands.1 - operands.0) as usize;
        form.instruction.operands.get(place).is_some_and(|spec| spec.accepts == Accepts::TEXT)
    }

    /// An instruction where an operand should be: reported, and read as if it stood on its own line.
    fn second_instruction(&mut self, span: Span) {
        self.comma = None;
        let message = Message::new("fx-syntax.second-instruction").with("word", span.of(self.chunk));
        let first_line = self.chunk.split_inclusive('\n').next().unwrap_or("");
        let newline = if first_line.ends_with("\r\n") { "\r\n" } else { "\n" };
        let gap = self.tree.lines.last().map_or(span.start, |line| line.span.end);
        let is_blank = Span { start: gap, end: span.start }.of(self.chunk).trim().is_empty();
        let gap = Span { start: if is_blank { gap } else { span.start }, end: span.start };
        self.tree.problems.push(
            Diagnostic::new(SYNTAX_ERROR, span, message)
                .fix(Message::new("fx-syntax.on-its-own-line"), vec![TextEdit::new(gap, newline)]),
        );
        self.instruction(span);
    }

    fn comma(&mut self, span: Span) {
        let has_operand = self.tree.lines.last().is_some_and(|line| line.operands.0 < line.operands.1);
        match self.place {
            Place::Operands if self.comma.is_none() && has_operand => self.comma = Some(span),
            Place::Operands => self.problem(span, "fx-syntax.nothing-before-comma"),
            _ => self.not_an_instruction(span),
        }
    }

    fn colon(&mut self, span: Span) {
        match self.place {
            Place::Label => self.place = Place::Start,
            Place::Operands => self.problem(span, "fx-syntax.unexpected"),
            _ => self.not_an_instruction(span),
        }
    }

    /// A comparison sign: the second half of a mnemonic (`LD =` is `LD=`), or out of place.
    fn compare(&mut self, span: Span) {
        if self.place != Place::Operands {
            return self.not_an_instruction(span);
        }
        let Some(line) = self.tree.lines.last_mut() else { return };
        let is_first = line.operands.0 == line.operands.1 && self.comma.is_none();
        let form = Form::named(&[line.mnemonic.of(self.chunk), span.of(self.chunk)].concat());
        let touches = line.mnemonic.end == span.start;
        if !is_first || form.is_none() && !touches {
            return self.problem(span, "fx-syntax.unexpected");
        }
        line.kind = form.map_or(LineKind::Unknown, LineKind::Instruction);
        line.mnemonic.end = span.end;
        line.span.end = span.end;
        self.glue = span.end;
    }

    fn text(&mut self, span: Span) {
        match self.place {
            Place::Operands => {
                self.push_operand(span, Operand::Text);
                self.glue = 0;
            }
            _ => self.not_an_instruction(span),
        }
    }

    fn not_an_instruction(&mut self, span: Span) {
        if self.place != Place::Lost {
            self.problem(span, "fx-syntax.instruction-expected");
        }
        self.step = None;
        self.place = Place::Lost;
    }

    fn block_comment(&mut self, span: Span, closed: bool) {
        self.tree.comments.push(span);
        let comment = span.of(self.chunk);
        if !closed {
            let opener = Span { start: span.start, end: span.start + 2 };
            let first_line = comment.lines().next().unwrap_or("").trim_end();
            let close = TextEdit::new(Span::at(span.start as usize + first_line.len().max(2)), " *)");
            self.tree.problems.push(
                Diagnostic::new(UNCLOSED_COMMENT, opener, Message::new("fx-syntax.unclosed-comment"))
                    .fix(Message::new("fx-syntax.close-comment"), vec![close]),
            );
        }
        if comment.contains(['\n', '\r']) {
            self.end_line();
        }
    }
}

/// Characters that no token contains.
impl Parser<'_> {
    /// A run of them, which is one problem or belongs to the word before.
    fn stray(&mut self, span: Span) {
        let problem = stray_problem(span, self.chunk);
        if problem.message.key() == STRAY && self.place == Place::Operands && span.start == self.glue {
            return self.extend(span);
        }
        // Letters of other scripts begin the name of a variable or a symbol; the words behind them are part of it.
        if self.place == Place::Operands && span.of(self.chunk).chars().all(char::is_alphanumeric) {
            return self.push_operand(span, self.read_glued(span));
        }
        self.tree.problems.push(problem);
    }

    /// Makes `span` part of the word before it: `X(0)` is one unreadable operand, not three findings.
    fn extend(&mut self, span: Span) {
        self.glue = span.end;
        let Some(line) = self.tree.lines.last_mut() else { return };
        line.span.end = span.end;
        let has_operand = line.operands.0 < line.operands.1;
        match self.tree.operands.last_mut().filter(|_| has_operand) {
            Some(operand) => {
                operand.span.end = span.end;
                if operand.value != Operand::Text {
                    let whole = operand.span;
                    let value = self.read_glued(whole);
                    if let Some(operand) = self.tree.operands.last_mut() {
                        operand.value = value;
                    }
                }
            }
            None => {
                line.mnemonic.end = span.end;
                line.kind = LineKind::Unknown;
            }
        }
    }

    /// A word with characters that no token contains: a symbol of the project, or unreadable.
    fn read_glued(&self, span: Span) -> Operand {
        match self.target.read(span.of(self.chunk)) {
            Operand::Invalid(problem @ (OperandProblem::SymbolForm(_) | OperandProblem::SymbolTwice)) => {
                Operand::Invalid(problem)
            }
            Operand::Invalid(_) => Operand::Invalid(OperandProblem::Unreadable),
            operand => operand,
        }
    }

    /// Whether the last word ends with a stray character, so that a word right behind it belongs to it.
    fn is_glued(&self) -> bool {
        self.tree.lines.last().is_some_and(|line| {
            match self.tree.operands.last().filter(|_| line.operands.0 < line.operands.1) {
                Some(operand) => {
                    operand.value == Operand::Invalid(OperandProblem::Unreadable)
                        || operand.span.of(self.chunk).ends_with(|last: char| !last.is_ascii())
                }
                None => {
                    line.kind == LineKind::Unknown && !line.mnemonic.of(self.chunk).ends_with(['=', '<', '>'])
                }
            }
        })
    }
}

/// A label: the letter of a pointer and a number.
fn label(word: &str, model: Model) -> Option<LineKind> {
    let digits = word.strip_prefix(['P', 'p', 'I', 'i'])?;
    if digits.is_empty() || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    match Operand::read(word, model) {
        Operand::Device(device) if device.kind.is_pointer() => Some(LineKind::Label(device)),
        _ => None,
    }
}

const STRAY: &str = "fx-syntax.stray";

/// What to say about characters that no token contains.
fn stray_problem(span: Span, chunk: &str) -> Diagnostic {
    let text = span.of(chunk);
    let Some(plain) = text.chars().map(plain_form).collect::<Option<String>>() else {
        return Diagnostic::new(SYNTAX_ERROR, span, Message::new(STRAY).with("word", visible(text)));
    };
    let blank = plain.trim().is_empty();
    let key = if blank { "fx-syntax.wide-blank" } else { "fx-syntax.wide-character" };
    let title = if blank { "fx-syntax.write-blank" } else { "fx-syntax.write-plain" };
    Diagnostic::new(SYNTAX_ERROR, span, Message::new(key).with("word", text).with("plain", &plain))
        .fix(Message::new(title).with("plain", &plain), vec![TextEdit::new(span, plain)])
}

/// The ASCII character that a full-width one or a typographic blank stands for; input methods produce these.
fn plain_form(character: char) -> Option<char> {
    match character {
        '\u{a0}' | '\u{2000}'..='\u{200b}' | '\u{3000}' => Some(' '),
        '\u{ff01}'..='\u{ff5e}' => char::from_u32(character as u32 - 0xff01 + '!' as u32),
        _ => None,
    }
}

/// The first characters, control characters by their number.
fn visible(text: &str) -> String {
    const SHOWN: usize = 20;
    let mut visible = String::new();
    for (place, character) in text.chars().enumerate() {
        match character {
            _ if place == SHOWN => {
                visible.push('…');
                break;
            }
            _ if character.is_control() => visible += &format!("U+{:04X}", character as u32),
            _ => visible.push(character),
        }
    }
    visible
}
