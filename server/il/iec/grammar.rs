//! The grammar of declarations, types, initial values, tasks and program instances, written with chumsky.
//!
//! It runs over the kinds of the tokens only, one declaration at a time, and gives small trees of token ranges, which
//! the reader of declarations flattens. The grammar has no recursion that the text can drive deep: the reader rejects
//! a declaration with more nesting than [`MOST_NESTING`] before it comes here.

use super::token::TokenKind::{self, *};
use chumsky::DefaultExpected;
use chumsky::error::{Error, LabelError};
use chumsky::prelude::*;
use chumsky::util::MaybeRef;

/// Parentheses, brackets and structures inside each other in one declaration. Programs have three or four.
pub const MOST_NESTING: usize = 64;

/// The tokens of one declaration, without comments and ends of lines.
pub type Kinds<'s> = &'s [TokenKind];

type Extra = extra::Err<Mismatch>;

/// A range of tokens.
pub type Tokens = SimpleSpan<usize>;

/// A place where the grammar could not go on: cheap, for most are made while alternatives are tried.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Mismatch {
    /// Index of the token that does not fit; the number of tokens at their end.
    pub at: usize,
    /// What would have fitted, one bit for each kind of token.
    expected: u128,
}

impl Mismatch {
    /// What would have fitted.
    pub fn expected(&self) -> impl Iterator<Item = TokenKind> + '_ {
        TokenKind::ALL.into_iter().filter(|kind| self.expected & (1 << *kind as u32) != 0)
    }

    /// Whether `kind` would have fitted.
    pub fn expects(&self, kind: TokenKind) -> bool {
        self.expected & (1 << kind as u32) != 0
    }
}

impl<'s> Error<'s, Kinds<'s>> for Mismatch {
    fn merge(mut self, other: Mismatch) -> Mismatch {
        self.expected |= other.expected;
        self
    }
}

impl<'s> LabelError<'s, Kinds<'s>, DefaultExpected<'s, TokenKind>> for Mismatch {
    fn expected_found<E: IntoIterator<Item = DefaultExpected<'s, TokenKind>>>(
        expected: E,
        _found: Option<MaybeRef<'s, TokenKind>>,
        span: Tokens,
    ) -> Mismatch {
        let bits = expected.into_iter().map(|expected| match expected {
            DefaultExpected::Token(kind) => 1u128 << *kind as u32,
            _ => 0,
        });
        Mismatch { at: span.start, expected: bits.fold(0, |all, bit| all | bit) }
    }
}

/// One declaration of a section, or of a TYPE block, or a field.
#[derive(Debug, Clone)]
pub struct DeclarationNode {
    pub tokens: Tokens,
    /// Names, one token each.
    pub names: Vec<usize>,
    pub address: Option<usize>,
    pub path: Option<Tokens>,
    pub spec: Option<SpecNode>,
    /// R_EDGE, F_EDGE, READ_ONLY, READ_WRITE.
    pub suffix: Option<TokenKind>,
    /// More than one value stands for an array without brackets.
    pub initial: Vec<ValueNode>,
}

/// A type.
#[derive(Debug, Clone)]
pub struct SpecNode {
    pub tokens: Tokens,
    pub kind: SpecKind,
}

/// What a type is.
#[derive(Debug, Clone)]
pub enum SpecKind {
    /// One word, or a path of words.
    Named,
    /// STRING or WSTRING with its length.
    Text {
        length: Option<Tokens>,
    },
    Subrange {
        base: Tokens,
        least: Tokens,
        greatest: Tokens,
    },
    Enumeration {
        values: Vec<usize>,
    },
    Array {
        bounds: Vec<(Tokens, Tokens)>,
        element: Box<SpecNode>,
    },
    Structure {
        fields: Vec<DeclarationNode>,
    },
    Reference {
        target: Box<SpecNode>,
    },
}

/// An initial value.
#[derive(Debug, Clone)]
pub struct ValueNode {
    pub tokens: Tokens,
    /// The name of the field.
    pub field: Option<usize>,
    pub kind: ValueNodeKind,
}

/// What an initial value is.
#[derive(Debug, Clone)]
pub enum ValueNodeKind {
    Constant,
    Array(Vec<ValueNode>),
    Repeat { count: usize, values: Vec<ValueNode> },
    Structure(Vec<ValueNode>),
}

/// `TASK name (word := source, …)`.
#[derive(Debug, Clone)]
pub struct TaskNode {
    pub name: usize,
    pub settings: Vec<(usize, Tokens)>,
}

/// `PROGRAM name WITH task : type (…)`.
#[derive(Debug, Clone)]
pub struct InstanceNode {
    pub retain: Option<TokenKind>,
    pub name: usize,
    pub task: Option<usize>,
    pub program: Tokens,
    pub elements: Vec<ElementNode>,
}

/// One element in the parentheses of a program instance.
#[derive(Debug, Clone)]
pub struct ElementNode {
    pub tokens: Tokens,
    pub name: Tokens,
    /// `:=`, `=>` or WITH.
    pub sign: TokenKind,
    pub value: Tokens,
}

/// `a, b AT %IX0.0 : INT := 5`. Without the semicolon, which the caller looks for.
pub fn variables<'s>() -> impl Parser<'s, Kinds<'s>, DeclarationNode, Extra> + Clone {
    variable(spec()).boxed()
}

/// `name : spec := value` of a TYPE block.
pub fn type_definition<'s>() -> impl Parser<'s, Kinds<'s>, DeclarationNode, Extra> + Clone {
    let name = just(Word).to_span().map(|name: Tokens| vec![name.start]);
    name.then_ignore(just(Colon))
        .then(spec())
        .then(initial().or_not())
        .map_with(|((names, spec), initial), extra| DeclarationNode {
            initial: initial.unwrap_or_default(),
            ..DeclarationNode::of(extra.span(), names, Some(spec))
        })
        .boxed()
}

/// `name : path : type READ_WRITE` of VAR_ACCESS.
pub fn access_path<'s>() -> impl Parser<'s, Kinds<'s>, DeclarationNode, Extra> + Clone {
    let name = just(Word).to_span().map(|name: Tokens| vec![name.start]);
    let target = variable_path().or(just(Address).to_span());
    name.then_ignore(just(Colon))
        .then(target)
        .then_ignore(just(Colon))
        .then(spec())
        .then(one_of([ReadOnly, ReadWrite]).or_not())
        .map_with(|(((names, path), spec), suffix), extra| DeclarationNode {
            path: Some(path),
            suffix,
            ..DeclarationNode::of(extra.span(), names, Some(spec))
        })
        .boxed()
}

/// `path AT %IX0.0 : type := value` of VAR_CONFIG.
pub fn instance_setting<'s>() -> impl Parser<'s, Kinds<'s>, DeclarationNode, Extra> + Clone {
    variable_path()
        .then(address().or_not())
        .then_ignore(just(Colon))
        .then(spec())
        .then(initial().or_not())
        .map_with(|(((path, address), spec), initial), extra| DeclarationNode {
            path: Some(path),
            address,
            initial: initial.unwrap_or_default(),
            ..DeclarationNode::of(extra.span(), Vec::new(), Some(spec))
        })
        .boxed()
}

/// A task, from the word TASK on.
pub fn task<'s>() -> impl Parser<'s, Kinds<'s>, TaskNode, Extra> + Clone {
    let setting = index(Word).then_ignore(just(Assign)).then(source());
    just(Task)
        .ignore_then(index(Word))
        .then(list(setting, LeftParenthesis, RightParenthesis))
        .map(|(name, settings)| TaskNode { name, settings })
        .boxed()
}

/// A program instance, from the word PROGRAM on.
pub fn instance<'s>() -> impl Parser<'s, Kinds<'s>, InstanceNode, Extra> + Clone {
    let sign = one_of([Assign, Arrow, With]);
    let element = variable_path()
        .then(sign)
        .then(source())
        .map_with(|((name, sign), value), extra| ElementNode { tokens: extra.span(), name, sign, value });
    just(Program)
        .ignore_then(one_of([Retain, NonRetain]).or_not())
        .then(index(Word))
        .then(just(With).ignore_then(index(Word)).or_not())
        .then_ignore(just(Colon))
        .then(path())
        .then(list(element, LeftParenthesis, RightParenthesis).or_not())
        .map(|((((retain, name), task), program), elements)| InstanceNode {
            retain,
            name,
            task,
            program,
            elements: elements.unwrap_or_default(),
        })
        .boxed()
}

impl DeclarationNode {
    /// Names with a type.
    pub fn of(tokens: Tokens, names: Vec<usize>, spec: Option<SpecNode>) -> DeclarationNode {
        DeclarationNode { tokens, names, address: None, path: None, spec, suffix: None, initial: Vec::new() }
    }
}

fn variable<'s>(
    spec: impl Parser<'s, Kinds<'s>, SpecNode, Extra> + Clone,
) -> impl Parser<'s, Kinds<'s>, DeclarationNode, Extra> + Clone {
    let names = index(Word).separated_by(just(Comma)).at_least(1).collect::<Vec<_>>();
    // A located variable needs no name of its own.
    let named = names.then(address().or_not());
    let nameless = address().map(|address| (Vec::new(), Some(address)));
    named
        .or(nameless)
        .then_ignore(just(Colon))
        .then(spec)
        .then(one_of([RisingEdge, FallingEdge]).or_not())
        .then(initial().or_not())
        .map_with(|((((names, address), spec), suffix), initial), extra| DeclarationNode {
            address,
            suffix,
            initial: initial.unwrap_or_default(),
            ..DeclarationNode::of(extra.span(), names, Some(spec))
        })
}

fn spec<'s>() -> impl Parser<'s, Kinds<'s>, SpecNode, Extra> + Clone {
    recursive(|spec| {
        let bounds = bound().then_ignore(just(Dots)).then(bound());
        let subrange = path()
            .then(bounds.clone().delimited_by(just(LeftParenthesis), just(RightParenthesis)).or_not())
            .map(|(base, range)| match range {
                Some((least, greatest)) => SpecKind::Subrange { base, least, greatest },
                None => SpecKind::Named,
            });
        let length = bound()
            .delimited_by(just(LeftBracket), just(RightBracket))
            .or(bound().delimited_by(just(LeftParenthesis), just(RightParenthesis)));
        let text =
            one_of([String, Wstring]).ignore_then(length.or_not()).map(|length| SpecKind::Text { length });
        // The third edition lets an enumerator have a value.
        let enumerator = index(Word).then_ignore(just(Assign).then(bound()).or_not());
        let enumeration = list(enumerator, LeftParenthesis, RightParenthesis)
            .map(|values| SpecKind::Enumeration { values });
        let array = just(Array)
            .ignore_then(list(bounds, LeftBracket, RightBracket))
            .then_ignore(just(Of))
            .then(spec.clone())
            .map(|(bounds, element)| SpecKind::Array { bounds, element: Box::new(element) });
        let reference = just(RefTo)
            .ignore_then(spec.clone())
            .map(|target| SpecKind::Reference { target: Box::new(target) });
        choice((subrange, text, enumeration, array, reference, structure(spec)))
            .map_with(|kind, extra| SpecNode { tokens: extra.span(), kind })
    })
}

fn structure<'s>(
    spec: impl Parser<'s, Kinds<'s>, SpecNode, Extra> + Clone + 's,
) -> impl Parser<'s, Kinds<'s>, SpecKind, Extra> + Clone {
    // A field that cannot be read is skipped, so that the others are still declared.
    let rest = none_of([Semicolon, EndStruct]).repeated().at_least(1);
    let skipped = rest.then(just(Semicolon).or_not()).map(|_| None);
    let field = variable(spec).boxed().then_ignore(just(Semicolon)).map(Some);
    let fields = field.recover_with(via_parser(skipped)).repeated().collect::<Vec<_>>();
    fields
        .delimited_by(just(Struct), just(EndStruct))
        .map(|fields| SpecKind::Structure { fields: fields.into_iter().flatten().collect() })
}

fn initial<'s>() -> impl Parser<'s, Kinds<'s>, Vec<ValueNode>, Extra> + Clone {
    let value = value();
    let element = repeated_value(value.clone()).or(value);
    just(Assign).ignore_then(element.separated_by(just(Comma)).at_least(1).collect())
}

fn value<'s>() -> impl Parser<'s, Kinds<'s>, ValueNode, Extra> + Clone {
    recursive(|value| {
        let element = repeated_value(value.clone()).or(value.clone());
        let array = list(element, LeftBracket, RightBracket).map(ValueNodeKind::Array);
        let field = index(Word)
            .then_ignore(just(Assign))
            .then(value)
            .map(|(name, value)| ValueNode { field: Some(name), ..value });
        let structure = list(field, LeftParenthesis, RightParenthesis).map(ValueNodeKind::Structure);
        let constant = constant().ignored().or(path().ignored()).to(ValueNodeKind::Constant);
        choice((constant, array, structure)).map_with(|kind, extra| ValueNode {
            tokens: extra.span(),
            field: None,
            kind,
        })
    })
}

/// `3(0)`; the values may be left out.
fn repeated_value<'s>(
    value: impl Parser<'s, Kinds<'s>, ValueNode, Extra> + Clone,
) -> impl Parser<'s, Kinds<'s>, ValueNode, Extra> + Clone {
    let values = value
        .separated_by(just(Comma))
        .collect::<Vec<_>>()
        .delimited_by(just(LeftParenthesis), just(RightParenthesis));
    index(Number).then(values).map_with(|(count, values), extra| ValueNode {
        tokens: extra.span(),
        field: None,
        kind: ValueNodeKind::Repeat { count, values },
    })
}

/// The index of one token of a kind.
fn index<'s>(kind: TokenKind) -> impl Parser<'s, Kinds<'s>, usize, Extra> + Clone {
    just(kind).to_span().map(|token: Tokens| token.start)
}

fn address<'s>() -> impl Parser<'s, Kinds<'s>, usize, Extra> + Clone {
    just(At).ignore_then(index(Address))
}

/// `name`, `name.name`.
fn path<'s>() -> impl Parser<'s, Kinds<'s>, Tokens, Extra> + Clone {
    just(Word).separated_by(just(Dot)).at_least(1).to_span()
}

/// `resource.program.block[1].variable`; resources and instances may end in an address.
fn variable_path<'s>() -> impl Parser<'s, Kinds<'s>, Tokens, Extra> + Clone {
    let subscript = bound()
        .separated_by(just(Comma))
        .at_least(1)
        .delimited_by(just(LeftBracket), just(RightBracket))
        .ignored();
    let member = just(Dot).ignore_then(one_of([Word, Address, Number])).ignored();
    just(Word).then(member.or(subscript).repeated()).to_span()
}

fn constant<'s>() -> impl Parser<'s, Kinds<'s>, Tokens, Extra> + Clone {
    one_of([Number, Typed, Text]).to_span()
}

/// A limit of an array or a subrange: a constant, or the name of one.
fn bound<'s>() -> impl Parser<'s, Kinds<'s>, Tokens, Extra> + Clone {
    constant().or(path())
}

fn source<'s>() -> impl Parser<'s, Kinds<'s>, Tokens, Extra> + Clone {
    choice((constant(), variable_path(), just(Address).to_span()))
}

fn list<'s, T>(
    element: impl Parser<'s, Kinds<'s>, T, Extra> + Clone,
    open: TokenKind,
    close: TokenKind,
) -> impl Parser<'s, Kinds<'s>, Vec<T>, Extra> + Clone {
    element.separated_by(just(Comma)).at_least(1).collect().delimited_by(just(open), just(close))
}
