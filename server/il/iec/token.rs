//! The words of the language.

use crate::text::Span;
use logos::Logos;

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
    pub fn quoted(self) -> String {
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
