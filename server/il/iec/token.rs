//! The words of the language, and a scanner that knows in what kind of text it is.

use crate::target::iec::Operator;
use crate::text::Span;
use logos::{Lexer, Logos};

/// What a token is. Fewer than 128, so that a set of them fits into one number.
#[derive(Logos, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[logos(skip r"[ \t\r\x0B\x0C\u{A0}\u{FEFF}]+")]
#[rustfmt::skip]
#[allow(missing_docs, reason = "the keywords are the standard's, the others are named after their characters")]
pub enum TokenKind {
    #[regex(r"\r?\n")] Newline,
    /// An identifier, an operator, the name of a type.
    #[regex(r"[\p{XID_Start}_]\p{XID_Continue}*")]
    #[regex(r"&\p{XID_Continue}*")]
    Word,
    /// `12`, `-5`, `16#FF`, `1.5E-3`.
    #[regex(r"[+-]?[0-9][0-9A-Za-z_#]*(\.[0-9][0-9A-Za-z_]*)?")]
    #[regex(r"[+-]?[0-9][0-9_]*(\.[0-9][0-9_]*)?[eE][+-][0-9][0-9_]*")]
    Number,
    /// `T#5s`, `INT#5`, `Colour#Red`, `STRING#'abc'`.
    #[regex(r"[\p{XID_Start}_]\p{XID_Continue}*#[+-]?(\p{XID_Continue}|#|[.:+-][0-9])*")]
    #[regex(r"[\p{XID_Start}_]\p{XID_Continue}*#'([^'$\r\n]|\$[^\r\n])*'?")]
    #[regex(r#"[\p{XID_Start}_]\p{XID_Continue}*#"([^"$\r\n]|\$[^\r\n])*"?"#)]
    Typed,
    /// `'text'`, `"text"`; one that does not end on its line lacks the last quote.
    #[regex(r"'([^'$\r\n]|\$[^\r\n])*'?")]
    #[regex(r#""([^"$\r\n]|\$[^\r\n])*"?"#)]
    Text,
    /// `%IX0.0`, `%I*`.
    #[regex(r"%[A-Za-z0-9]*(\.[0-9A-Za-z]+)*(\.?\*)?")]
    Address,

    #[token("(")] LeftParenthesis,
    #[token(")")] RightParenthesis,
    #[token("[")] LeftBracket,
    #[token("]")] RightBracket,
    #[token(",")] Comma,
    #[token(";")] Semicolon,
    #[token(":")] Colon,
    #[token(":=")] Assign,
    #[token("=>")] Arrow,
    #[token("..")] Dots,
    #[token(".")] Dot,
    #[token("^")] Caret,
    #[token("?")] Question,

    #[token("PROGRAM", ignore(case))] Program,
    #[token("END_PROGRAM", ignore(case))] EndProgram,
    #[token("FUNCTION_BLOCK", ignore(case))] FunctionBlock,
    #[token("END_FUNCTION_BLOCK", ignore(case))] EndFunctionBlock,
    #[token("FUNCTION", ignore(case))] Function,
    #[token("END_FUNCTION", ignore(case))] EndFunction,
    #[token("VAR", ignore(case))] Var,
    #[token("VAR_INPUT", ignore(case))] VarInput,
    #[token("VAR_OUTPUT", ignore(case))] VarOutput,
    #[token("VAR_IN_OUT", ignore(case))] VarInOut,
    #[token("VAR_EXTERNAL", ignore(case))] VarExternal,
    #[token("VAR_TEMP", ignore(case))] VarTemp,
    #[token("VAR_GLOBAL", ignore(case))] VarGlobal,
    #[token("VAR_ACCESS", ignore(case))] VarAccess,
    #[token("VAR_CONFIG", ignore(case))] VarConfig,
    #[token("END_VAR", ignore(case))] EndVar,
    #[token("CONSTANT", ignore(case))] Constant,
    #[token("RETAIN", ignore(case))] Retain,
    #[token("NON_RETAIN", ignore(case))] NonRetain,
    #[token("AT", ignore(case))] At,
    #[token("R_EDGE", ignore(case))] RisingEdge,
    #[token("F_EDGE", ignore(case))] FallingEdge,
    #[token("READ_ONLY", ignore(case))] ReadOnly,
    #[token("READ_WRITE", ignore(case))] ReadWrite,
    #[token("TYPE", ignore(case))] Type,
    #[token("END_TYPE", ignore(case))] EndType,
    #[token("STRUCT", ignore(case))] Struct,
    #[token("END_STRUCT", ignore(case))] EndStruct,
    #[token("ARRAY", ignore(case))] Array,
    #[token("OF", ignore(case))] Of,
    #[token("REF_TO", ignore(case))] RefTo,
    #[token("STRING", ignore(case))] String,
    #[token("WSTRING", ignore(case))] Wstring,
    #[token("CONFIGURATION", ignore(case))] Configuration,
    #[token("END_CONFIGURATION", ignore(case))] EndConfiguration,
    #[token("RESOURCE", ignore(case))] Resource,
    #[token("END_RESOURCE", ignore(case))] EndResource,
    #[token("ON", ignore(case))] On,
    #[token("TASK", ignore(case))] Task,
    #[token("WITH", ignore(case))] With,

    /// `(* *)`, `/* */`, `//`, found by the scanner at its first characters.
    #[token("(*")] #[token("/*")] #[token("//")] Comment,
    /// A block comment that ends with the text.
    UnclosedComment,
    /// `;` to the end of the line, where that cannot be anything else than a comment.
    SemicolonComment,
    /// `{ }`.
    #[token("{")] Pragma,
    /// A pragma that ends with the text.
    UnclosedPragma,
    /// Characters that start nothing.
    Unexpected,
}

/// The kind of text that a token stands in.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Region {
    /// Instructions, and the lines between program units.
    Body,
    /// `VAR` to `END_VAR` in a program unit.
    Section,
    /// `TYPE` to `END_TYPE`.
    Types,
    /// `CONFIGURATION` to `END_CONFIGURATION`.
    Configuration,
}

/// One token with its place.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Token {
    /// What it is.
    pub kind: TokenKind,
    /// Where, in the scanned text.
    pub span: Span,
    /// In what kind of text; the words that open and close a region are inside it.
    pub region: Region,
}

impl TokenKind {
    /// Every kind, in the order in which messages list what they expect.
    pub const ALL: [TokenKind; 65] = {
        use TokenKind::*;
        [
            Newline,
            Word,
            Number,
            Typed,
            Text,
            Address,
            LeftParenthesis,
            RightParenthesis,
            LeftBracket,
            RightBracket,
            Comma,
            Semicolon,
            Colon,
            Assign,
            Arrow,
            Dots,
            Dot,
            Caret,
            Question,
            Program,
            EndProgram,
            FunctionBlock,
            EndFunctionBlock,
            Function,
            EndFunction,
            Var,
            VarInput,
            VarOutput,
            VarInOut,
            VarExternal,
            VarTemp,
            VarGlobal,
            VarAccess,
            VarConfig,
            EndVar,
            Constant,
            Retain,
            NonRetain,
            At,
            RisingEdge,
            FallingEdge,
            ReadOnly,
            ReadWrite,
            Type,
            EndType,
            Struct,
            EndStruct,
            Array,
            Of,
            RefTo,
            String,
            Wstring,
            Configuration,
            EndConfiguration,
            Resource,
            EndResource,
            On,
            Task,
            With,
            Comment,
            UnclosedComment,
            SemicolonComment,
            Pragma,
            UnclosedPragma,
            Unexpected,
        ]
    };

    /// Comments and pragmas, which stand anywhere a blank may stand.
    pub fn is_trivia(self) -> bool {
        use TokenKind::*;
        matches!(self, Comment | UnclosedComment | SemicolonComment | Pragma | UnclosedPragma)
    }

    /// `VAR` and its kin.
    pub fn opens_section(self) -> bool {
        (TokenKind::Var..=TokenKind::VarConfig).contains(&self)
    }

    /// `PROGRAM`, `FUNCTION_BLOCK`, `FUNCTION`.
    pub fn opens_unit(self) -> bool {
        matches!(self, TokenKind::Program | TokenKind::FunctionBlock | TokenKind::Function)
    }

    /// The word that ends a unit.
    pub fn closes_unit(self) -> bool {
        matches!(self, TokenKind::EndProgram | TokenKind::EndFunctionBlock | TokenKind::EndFunction)
    }

    /// `END_…` of anything but a structure.
    pub fn closes(self) -> bool {
        use TokenKind::*;
        self.closes_unit() || matches!(self, EndVar | EndType | EndConfiguration | EndResource)
    }

    /// Reserved words.
    pub fn is_keyword(self) -> bool {
        (TokenKind::Program..=TokenKind::With).contains(&self)
    }

    /// What can start an operand of an instruction.
    pub fn starts_operand(self) -> bool {
        matches!(
            self,
            TokenKind::Word | TokenKind::Number | TokenKind::Typed | TokenKind::Text | TokenKind::Address
        )
    }

    /// How a message names it: kinds in words, others as they are written, in backticks.
    pub fn quoted(self) -> std::string::String {
        use TokenKind::*;
        match self {
            Newline | Word | Number | Typed | Text | Address => self.name().to_string(),
            _ => format!("`{}`", self.name()),
        }
    }

    /// As it is written, or what it is.
    pub fn name(self) -> &'static str {
        use TokenKind::*;
        match self {
            Newline => "end of line",
            Word => "identifier",
            Number | Typed | Text => "constant",
            Address => "%address",
            LeftParenthesis => "(",
            RightParenthesis => ")",
            LeftBracket => "[",
            RightBracket => "]",
            Comma => ",",
            Semicolon => ";",
            Colon => ":",
            Assign => ":=",
            Arrow => "=>",
            Dots => "..",
            Dot => ".",
            Caret => "^",
            Question => "?",
            Program => "PROGRAM",
            EndProgram => "END_PROGRAM",
            FunctionBlock => "FUNCTION_BLOCK",
            EndFunctionBlock => "END_FUNCTION_BLOCK",
            Function => "FUNCTION",
            EndFunction => "END_FUNCTION",
            Var => "VAR",
            VarInput => "VAR_INPUT",
            VarOutput => "VAR_OUTPUT",
            VarInOut => "VAR_IN_OUT",
            VarExternal => "VAR_EXTERNAL",
            VarTemp => "VAR_TEMP",
            VarGlobal => "VAR_GLOBAL",
            VarAccess => "VAR_ACCESS",
            VarConfig => "VAR_CONFIG",
            EndVar => "END_VAR",
            Constant => "CONSTANT",
            Retain => "RETAIN",
            NonRetain => "NON_RETAIN",
            At => "AT",
            RisingEdge => "R_EDGE",
            FallingEdge => "F_EDGE",
            ReadOnly => "READ_ONLY",
            ReadWrite => "READ_WRITE",
            Type => "TYPE",
            EndType => "END_TYPE",
            Struct => "STRUCT",
            EndStruct => "END_STRUCT",
            Array => "ARRAY",
            Of => "OF",
            RefTo => "REF_TO",
            String => "STRING",
            Wstring => "WSTRING",
            Configuration => "CONFIGURATION",
            EndConfiguration => "END_CONFIGURATION",
            Resource => "RESOURCE",
            EndResource => "END_RESOURCE",
            On => "ON",
            Task => "TASK",
            With => "WITH",
            Comment | UnclosedComment | SemicolonComment => "comment",
            Pragma | UnclosedPragma => "pragma",
            Unexpected => "character",
        }
    }
}

/// Reads tokens and keeps track of the region, which decides what a semicolon means.
///
/// A scanner that starts at the end of a chunk is in the state of one that came there: outside of everything.
#[derive(Clone)]
pub struct Scanner<'a> {
    lexer: Lexer<'a, TokenKind>,
    region: Region,
    /// Whether the region ends with the token just read.
    leaves: bool,
    /// Whether no word of the line stands before the next token, words that close a region aside.
    fresh: bool,
    /// The last token that is no comment.
    previous: Option<(TokenKind, usize)>,
}

impl<'a> Scanner<'a> {
    /// A scanner of `text`.
    pub fn new(text: &'a str) -> Scanner<'a> {
        let lexer = TokenKind::lexer(text);
        Scanner { lexer, region: Region::Body, leaves: false, fresh: true, previous: None }
    }

    fn complete(&mut self, kind: TokenKind) -> TokenKind {
        use TokenKind::*;
        let start = self.lexer.span().start;
        let rest = self.lexer.remainder();
        match kind {
            Comment => match comment_length(self.lexer.slice(), rest) {
                Some(length) => self.bump(length, Comment),
                None => self.bump(rest.len(), UnclosedComment),
            },
            Pragma => match rest.find('}') {
                Some(close) => self.bump(close + 1, Pragma),
                None => self.bump(rest.len(), UnclosedPragma),
            },
            Semicolon if self.region == Region::Body && self.semicolon_starts_comment(start, rest) => {
                let end = rest.find(['\r', '\n']).unwrap_or(rest.len());
                self.bump(end, SemicolonComment)
            }
            // `1.` and `.5` are no reals, but they are one word, which the reader of literals rejects.
            Number if rest.starts_with('.') && !rest.starts_with("..") => self.bump(1, Number),
            Dot if self.previous.is_none_or(|(_, end)| end != start) && starts_with_digit(rest) => {
                let digits = rest.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(rest.len());
                self.bump(digits, Number)
            }
            kind => kind,
        }
    }

    fn bump(&mut self, length: usize, kind: TokenKind) -> TokenKind {
        self.lexer.bump(length);
        kind
    }

    /// Instructions have no terminator, so a semicolon behind a blank starts a comment in the texts of many tools.
    /// One that is glued to an operand, or with nothing behind it, is a stray terminator.
    fn semicolon_starts_comment(&self, start: usize, rest: &str) -> bool {
        let line = rest.trim_start_matches([' ', '\t', '\r']);
        let blank =
            line.is_empty() || ["\n", "(*", "//", "/*", "{"].iter().any(|open| line.starts_with(open));
        let glued = self.previous.is_some_and(|(kind, end)| end == start || kind.closes());
        !blank && !glued
    }

    /// The kind of the next token that is no comment.
    fn peek(&self) -> Option<TokenKind> {
        let mut ahead = self.clone();
        std::iter::from_fn(move || ahead.next_kind()).find(|kind| !kind.is_trivia())
    }

    fn next_kind(&mut self) -> Option<TokenKind> {
        let kind = self.lexer.next()?.unwrap_or(TokenKind::Unexpected);
        Some(self.complete(kind))
    }

    /// Whether `kind`, the first word of its line, cannot belong to the region, which therefore lacks its end.
    fn ends_region(&self, kind: TokenKind) -> bool {
        use TokenKind::*;
        match self.region {
            Region::Body => false,
            Region::Section => {
                let loads = || {
                    let word = self.lexer.slice();
                    (word.eq_ignore_ascii_case("LD") || word.eq_ignore_ascii_case("LDN"))
                        && self.peek().is_some_and(TokenKind::starts_operand)
                };
                kind.opens_section()
                    || kind.opens_unit()
                    || kind.closes_unit()
                    || matches!(kind, Type | Configuration)
                    || (kind == Word && loads())
            }
            Region::Types => {
                kind.opens_section()
                    || kind.opens_unit()
                    || kind.closes_unit()
                    || matches!(kind, Type | Configuration)
            }
            Region::Configuration => match kind {
                Program => !self.is_instance(),
                VarGlobal | VarAccess | VarConfig => false,
                Configuration | Type | Function | FunctionBlock => true,
                kind => kind.opens_section() || kind.closes_unit(),
            },
        }
    }

    /// Whether the `PROGRAM` just read is one of a configuration: `PROGRAM name WITH`, `PROGRAM name :`.
    fn is_instance(&self) -> bool {
        let mut ahead = self.clone();
        let mut kinds = std::iter::from_fn(move || ahead.next_kind())
            .filter(|kind| !kind.is_trivia() && !matches!(kind, TokenKind::Retain | TokenKind::NonRetain));
        // While the name is still being typed, the configuration goes on.
        match kinds.next() {
            Some(TokenKind::Word) => matches!(kinds.next(), Some(TokenKind::With | TokenKind::Colon)),
            _ => true,
        }
    }

    fn enter_region(&mut self, kind: TokenKind) {
        use TokenKind::*;
        let member = matches!(self.previous, Some((Dot, end)) if end == self.lexer.span().start);
        self.region = match kind {
            _ if member => Region::Body,
            kind if kind.opens_section() => Region::Section,
            Type if self.fresh => Region::Types,
            Configuration if self.fresh => Region::Configuration,
            _ => Region::Body,
        };
    }
}

impl Iterator for Scanner<'_> {
    type Item = Token;

    fn next(&mut self) -> Option<Token> {
        use TokenKind::*;
        if std::mem::take(&mut self.leaves) {
            self.region = Region::Body;
        }
        let kind = self.next_kind()?;
        let span = Span::new(self.lexer.span().start, self.lexer.span().end);
        if kind.is_trivia() {
            return Some(Token { kind, span, region: self.region });
        }
        if self.fresh && self.ends_region(kind) {
            self.region = Region::Body;
        }
        if self.region == Region::Body {
            self.enter_region(kind);
        }
        self.leaves = match self.region {
            Region::Body => false,
            Region::Section => kind == EndVar,
            Region::Types => kind == EndType,
            Region::Configuration => kind == EndConfiguration,
        };
        self.fresh = match kind {
            Newline => true,
            Semicolon => self.fresh,
            kind => kind.closes(),
        };
        // A line starts as a text does, so that a chunk reads alone as it reads in its file.
        self.previous = (kind != Newline).then_some((kind, span.end as usize));
        Some(Token { kind, span, region: self.region })
    }
}

/// How many bytes of `rest` belong to the comment that starts with `open`, or nothing if it does not end.
///
/// Comments of one kind nest, as the third edition has it.
fn comment_length(open: &str, rest: &str) -> Option<usize> {
    let (open, close) = match open {
        "(*" => (b"(*", b"*)"),
        "/*" => (b"/*", b"*/"),
        _ => return Some(rest.find(['\r', '\n']).unwrap_or(rest.len())),
    };
    let bytes = rest.as_bytes();
    let (mut depth, mut at) = (1, 0);
    while let Some(pair) = bytes.get(at..at + 2) {
        at += 2;
        if pair == close {
            depth -= 1;
            if depth == 0 {
                return Some(at);
            }
        } else if pair == open {
            depth += 1;
        } else {
            at -= 1;
        }
    }
    None
}

fn starts_with_digit(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_digit())
}

/// Whether the line that starts with `line` shows that the list of parameters around it lacks its parenthesis: two
/// words side by side, or a label. `before` is the token before the line.
///
/// While a call is being typed, the instructions below it must not be swallowed as its parameters.
pub fn ends_open_list(line: &[Token], text: &str) -> bool {
    let [first, second, ..] = line else { return false };
    let negation = first.span.of(text).eq_ignore_ascii_case("NOT");
    first.kind == TokenKind::Word
        && !negation
        && (second.kind.starts_operand() || second.kind == TokenKind::Colon)
}

/// Whether the line that starts with `line` cannot stand inside parentheses of any kind: a jump, a call, a return or
/// a label.
pub fn leaves_parentheses(line: &[Token], text: &str) -> bool {
    use crate::target::iec::OperatorRole::{Call, Jump, Return};
    let Some(first) = line.first().filter(|token| token.kind == TokenKind::Word) else { return false };
    let second = line.get(1).map(|token| token.kind);
    match second {
        Some(TokenKind::Colon) => true,
        // A parameter may be called `RET`.
        Some(TokenKind::Assign | TokenKind::Arrow) => false,
        _ => Operator::written(first.span.of(text))
            .is_some_and(|written| matches!(written.operator.role, Jump | Call | Return)),
    }
}
