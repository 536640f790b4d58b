//! What an IEC document declares: POUs with their variables, global variables, types.
//!
//! It holds no place in the text, so it stays valid while other chunks move; places are found through the mentions.

use super::mention::of_operand;
use super::{Chunk, Document, Mention, Symbol, Tree, Use};
use crate::il::iec::{
    Direction, IecTree, ItemKind, MentionRole, OperandId, ParameterValue, PouKind, SectionKind, TypeId,
    TypeSpec, words,
};
use crate::target::iec::{ElementaryType, FunctionBlock, LiteralValue, OperatorRole, ParameterType};
use crate::target::{DirectAddress, Operand};
use crate::text::{Span, folded};
use rustc_hash::{FxHashMap, FxHasher};
use smol_str::{SmolStr, format_smolstr};
use std::collections::BTreeMap;
use std::collections::hash_map::Entry;
use std::hash::{Hash, Hasher};
use std::sync::Arc;

/// Everything that a document declares.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Scopes {
    /// Differs whenever a declaration differs: the key for what was found with these scopes.
    pub key: u64,
    /// The POUs, in the order of the text; behind them those of the other files of the project.
    pub pous: Vec<Arc<Pou>>,
    /// Variables of VAR_GLOBAL, by folded name; those of the other files, too, as with the types.
    pub globals: FxHashMap<SmolStr, Variable>,
    /// Data types, by folded name.
    pub types: FxHashMap<SmolStr, DeclaredType>,
    /// What is said of each data type behind its name, in [one spelling](words), by folded name.
    pub type_words: FxHashMap<SmolStr, SmolStr>,
    /// What VAR_CONFIG says of variables of instances, in one spelling, by their folded paths, in order.
    pub configured: BTreeMap<SmolStr, SmolStr>,
    /// Whether there is a CONFIGURATION.
    pub has_configuration: bool,
    /// The number of the first POU with each folded name.
    pou_numbers: FxHashMap<SmolStr, usize>,
    /// How many of the POUs are declared here.
    own_pous: usize,
    /// The folded names of the global variables and types that are declared here, in order.
    pub(super) own_globals: Vec<SmolStr>,
    pub(super) own_types: Vec<SmolStr>,
    pub(super) own_configuration: bool,
    pub(super) own_configured: BTreeMap<SmolStr, SmolStr>,
    /// Whether there are variables that may lie in one place with others, at addresses or where a caller says, or that
    /// may be changed elsewhere, by functions and function blocks.
    pub shares_storage: bool,
}

/// A program organisation unit.
#[derive(Clone, PartialEq, Debug)]
pub struct Pou {
    /// Its name as written; empty where it is missing.
    pub name: SmolStr,
    /// What it is.
    pub kind: PouKind,
    /// The type of a function's result.
    pub result: Option<DeclaredType>,
    /// Its variables in the order of the declaration.
    pub variables: Vec<Variable>,
    index: FxHashMap<SmolStr, usize>,
}

/// A declared variable.
#[derive(Clone, PartialEq, Debug)]
pub struct Variable {
    /// Its name as written.
    pub name: SmolStr,
    /// The section in which it stands.
    pub section: SectionKind,
    /// Declared CONSTANT.
    pub constant: bool,
    /// Its type.
    pub declared: DeclaredType,
    /// Where it lies, if it is located.
    pub address: Option<DirectAddress>,
    /// What is said of it beside its name, in [one spelling](words): the type, the address, the value at first.
    pub words: SmolStr,
}

impl Variable {
    /// Whether it is declared RETAIN, so that it is kept while the PLC is off.
    pub fn is_retained(&self) -> bool {
        self.words.starts_with("retain ")
    }

    /// Whether its declaration says what it is at first.
    pub fn has_value(&self) -> bool {
        self.words.contains(":=")
    }
}

/// A type, resolved as far as the declaration goes.
#[derive(Clone, PartialEq, Debug)]
pub enum DeclaredType {
    /// An elementary type.
    Elementary(ElementaryType),
    /// The numbers of a type from one to another. The [type itself](Scopes::resolved) is the one they are cut from.
    Subrange(Box<DeclaredType>, Limits),
    /// A data type, function block or program of this folded name.
    Named(SmolStr),
    /// An array of these elements.
    Array(Box<DeclaredType>),
    /// An enumeration with these folded names.
    Enumeration(Vec<SmolStr>),
    /// A structure.
    Structure(Vec<(SmolStr, DeclaredType)>),
    /// It could not be read.
    Unknown,
}

/// The least and the greatest number of a subrange; nothing where names of constants stand for them.
pub type Limits = Option<(i128, i128)>;

impl Chunk {
    /// How many POUs start in it.
    pub fn pou_starts(&self) -> usize {
        if !self.is_iec() {
            return 0;
        }
        match self.tree() {
            Tree::Iec(tree) => {
                tree.items.iter().filter(|item| matches!(item.kind, ItemKind::Pou { .. })).count()
            }
            _ => 0,
        }
    }

    /// Whether the scopes of the document depend on it.
    pub(super) fn declares(&self) -> bool {
        let declares = |kind: &ItemKind| {
            matches!(
                kind,
                ItemKind::Pou { .. }
                    | ItemKind::Section { .. }
                    | ItemKind::Types { .. }
                    | ItemKind::Configuration { .. }
                    | ItemKind::End(_)
                    | ItemKind::PouEnd(_)
            )
        };
        self.is_iec()
            && matches!(self.tree(), Tree::Iec(tree) if tree.items.iter().any(|item| declares(&item.kind)))
    }
}

impl Pou {
    pub(super) fn new(
        name: SmolStr,
        kind: PouKind,
        result: Option<DeclaredType>,
        variables: impl Iterator<Item = Variable>,
    ) -> Pou {
        let mut pou = Pou { name, kind, result, variables: Vec::new(), index: FxHashMap::default() };
        variables.for_each(|variable| pou.declare(variable));
        pou
    }

    /// The first declaration of a name holds; a rule reports the others.
    fn declare(&mut self, variable: Variable) {
        if let Entry::Vacant(free) = self.index.entry(folded(&variable.name)) {
            free.insert(self.variables.len());
            self.variables.push(variable);
        }
    }

    /// Its variable with the folded name `name`.
    pub fn variable(&self, name: &str) -> Option<&Variable> {
        self.variables.get(*self.index.get(name)?)
    }
}

impl Scopes {
    pub(super) fn of(document: &Document) -> Scopes {
        let mut scopes = Scopes::default();
        let mut hasher = FxHasher::default();
        for (at, _) in document.iec_chunks().filter(|(at, _)| at.chunk.declares()) {
            at.chunk.text().hash(&mut hasher);
            if let Tree::Iec(tree) = at.chunk.tree() {
                scopes.add(at.chunk.text(), tree);
            }
        }
        scopes.own_pous = scopes.pous.len();
        scopes.own_configuration = scopes.has_configuration;
        scopes.own_configured = scopes.configured.clone();
        if let Some((outer, own)) = document.outer() {
            scopes.add_outer(outer, own, &mut hasher);
        }
        scopes.shares_storage = scopes.has_shared_storage();
        scopes.key = hasher.finish();
        scopes
    }

    /// The POUs that are declared in the document itself.
    pub fn own_pous(&self) -> &[Arc<Pou>] {
        &self.pous[..self.own_pous.min(self.pous.len())]
    }

    /// Takes in a POU behind the others.
    pub(super) fn add_pou(&mut self, pou: Arc<Pou>) {
        self.pou_numbers.entry(folded(&pou.name)).or_insert(self.pous.len());
        self.pous.push(pou);
    }

    /// The number of the POU called `name`, letter case aside.
    pub fn pou_number(&self, name: &str) -> Option<usize> {
        self.pou_numbers.get(&folded(name)).copied()
    }

    /// The POU called `name`, letter case aside.
    pub fn pou_named(&self, name: &str) -> Option<&Pou> {
        self.pous.get(self.pou_number(name)?).map(|pou| &**pou)
    }

    fn has_shared_storage(&self) -> bool {
        let locals = self.pous.iter().flat_map(|pou| &pou.variables);
        let calls = |pou: &Arc<Pou>| pou.kind != PouKind::Program;
        self.pous.iter().any(calls)
            || locals
                .chain(self.globals.values())
                .any(|variable| variable.address.is_some() || variable.section == SectionKind::InOut)
    }

    /// Whether `name` is a global variable that another file of the project declares.
    pub fn is_global_elsewhere(&self, name: &str) -> bool {
        let name = folded(name);
        self.globals.contains_key(&name) && !self.own_globals.contains(&name)
    }

    /// The folded names of the global variables that are declared here, in the order of the text.
    pub fn own_globals(&self) -> impl Iterator<Item = &SmolStr> {
        self.own_globals.iter()
    }

    /// Whether a variable called `name`, of whichever unit, is declared CONSTANT.
    pub fn is_constant(&self, name: &str) -> bool {
        let mut all = self.pous.iter().flat_map(|pou| &pou.variables).chain(self.globals.values());
        all.any(|variable| variable.constant && variable.name.eq_ignore_ascii_case(name))
    }

    /// Whether `name` is a declared data type.
    pub fn is_type(&self, name: &str) -> bool {
        self.types.contains_key(&folded(name))
    }

    /// The folded names of the data types, in no order.
    pub fn type_names(&self) -> impl Iterator<Item = &str> {
        self.types.keys().map(SmolStr::as_str)
    }

    /// The variable called `name` in POU number `pou`, or else the global one.
    pub fn variable(&self, pou: Option<usize>, name: &str) -> Option<&Variable> {
        let name = folded(name);
        let local = pou
            .and_then(|number| self.pous.get(number))
            .and_then(|pou| pou.index.get(&name).and_then(|position| pou.variables.get(*position)));
        local.or_else(|| self.globals.get(&name))
    }

    /// The type of a path such as `a`, `T1.Q`, `matrix[1,2].x`, seen from POU number `pou`.
    /// `None` where some part of it is not declared.
    pub fn type_of(&self, pou: Option<usize>, path: &str) -> Option<DeclaredType> {
        self.resolved(self.declared_of(pou, path)?)
    }

    /// The numbers that a path such as `a`, `matrix[1,2].x`, seen from POU number `pou`, is declared to be among, if
    /// that is a subrange with known limits.
    pub fn limits_of(&self, pou: Option<usize>, path: &str) -> Limits {
        let mut declared = self.declared_of(pou, path)?;
        for _ in 0..CHAIN_MAX {
            declared = match declared {
                DeclaredType::Subrange(_, limits) => return limits,
                DeclaredType::Named(name) => self.types.get(&name)?.clone(),
                _ => return None,
            };
        }
        None
    }

    /// The type of a path as it is declared, which may be a name or a subrange.
    fn declared_of(&self, pou: Option<usize>, path: &str) -> Option<DeclaredType> {
        let end = path.find(['.', '[']).unwrap_or(path.len());
        let (root, mut rest) = path.split_at(end);
        let mut declared = match self.variable(pou, root) {
            Some(variable) => variable.declared.clone(),
            None => {
                let own = pou.and_then(|number| self.pous.get(number))?;
                own.result.clone().filter(|_| own.name.eq_ignore_ascii_case(root))?
            }
        };
        while !rest.is_empty() {
            if let Some(after) = rest.strip_prefix('[') {
                let close = after.find(']')?;
                declared = match self.resolved(declared)? {
                    DeclaredType::Array(element) => *element,
                    _ => return None,
                };
                rest = &after[close + 1..];
            } else {
                let after = rest.strip_prefix('.')?;
                let end = after.find(['.', '[']).unwrap_or(after.len());
                declared = self.member(declared, &after[..end])?;
                rest = &after[end..];
            }
        }
        Some(declared)
    }

    /// The type itself where `declared` is the name of a data type, or a subrange.
    pub fn resolved(&self, declared: DeclaredType) -> Option<DeclaredType> {
        let mut declared = declared;
        for _ in 0..CHAIN_MAX {
            match declared {
                DeclaredType::Named(name) => match self.types.get(&name) {
                    Some(next) => declared = next.clone(),
                    None => return Some(DeclaredType::Named(name)),
                },
                DeclaredType::Subrange(base, _) => declared = *base,
                _ => return Some(declared),
            }
        }
        None
    }

    /// The type of a member of a structure, of a function block's parameter, or of a bit.
    fn member(&self, declared: DeclaredType, name: &str) -> Option<DeclaredType> {
        match self.resolved(declared)? {
            DeclaredType::Structure(fields) => {
                let name = folded(name);
                fields.into_iter().find(|(field, _)| *field == name).map(|(_, declared)| declared)
            }
            DeclaredType::Elementary(kind) if kind.bits().is_some() => {
                let digits = name.trim_start_matches(['%', 'x', 'X']);
                digits.parse::<u32>().is_ok().then_some(DeclaredType::Elementary(ElementaryType::Bool))
            }
            // A block that is declared hides one of the standard.
            DeclaredType::Named(block) => match self.standard_block(&block) {
                Some(row) => {
                    let pins = row.inputs.iter().chain(row.outputs);
                    let pin = pins.into_iter().find(|pin| pin.name.eq_ignore_ascii_case(name))?;
                    match pin.kind {
                        ParameterType::Elementary(kind) => Some(DeclaredType::Elementary(kind)),
                        ParameterType::Generic(_) => Some(DeclaredType::Unknown),
                    }
                }
                None => {
                    let pou = self.pou_named(&block)?;
                    let name = folded(name);
                    pou.index
                        .get(&name)
                        .and_then(|at| pou.variables.get(*at))
                        .map(|found| found.declared.clone())
                }
            },
            DeclaredType::Unknown => Some(DeclaredType::Unknown),
            _ => None,
        }
    }

    /// The same where program unit number `pou` declares these variables, too; outside of any unit they are known
    /// everywhere.
    pub fn declaring(&self, pou: Option<usize>, variables: impl IntoIterator<Item = Variable>) -> Scopes {
        let mut scopes = self.clone();
        for variable in variables {
            match pou.and_then(|pou| scopes.pous.get_mut(pou)) {
                Some(pou) => Arc::make_mut(pou).declare(variable),
                None => _ = scopes.globals.entry(folded(&variable.name)).or_insert(variable),
            }
        }
        scopes
    }

    fn standard_block(&self, name: &str) -> Option<&'static FunctionBlock> {
        let is_declared = self.pou_named(name).is_some_and(|pou| pou.kind == PouKind::FunctionBlock);
        FunctionBlock::named(name).filter(|_| !is_declared)
    }

    fn add(&mut self, text: &str, tree: &IecTree) {
        for item in &tree.items {
            match item.kind {
                ItemKind::Pou { kind, name, result } => {
                    let name = name.map_or(SmolStr::default(), |span| SmolStr::from(span.of(text)));
                    let result = result.map(|id| declared_type(text, tree, id));
                    self.add_pou(Arc::new(Pou::new(name, kind, result, std::iter::empty())));
                }
                ItemKind::Section { kind, constant, retain, declarations } => {
                    for declaration in declarations.of(&tree.declarations) {
                        let declared = declaration
                            .declared
                            .map_or(DeclaredType::Unknown, |id| declared_type(text, tree, id));
                        let address = match declaration.address.map(|id| tree.operand(id).value) {
                            Some(Operand::Direct(address)) => Some(address),
                            _ => None,
                        };
                        let names = declaration.names.of(&tree.names);
                        let said = kept(retain, words(text, behind(names, declaration.span)));
                        if let (SectionKind::Config, Some(path)) = (kind, declaration.path) {
                            let said = words(text, Span { start: path.end, ..declaration.span });
                            self.configured.entry(words(text, path)).or_insert(said);
                        }
                        for name in names {
                            let name = SmolStr::from(name.of(text));
                            let (declared, words) = (declared.clone(), said.clone());
                            self.declare(Variable {
                                name,
                                section: kind,
                                constant,
                                declared,
                                address,
                                words,
                            });
                        }
                    }
                }
                ItemKind::Types { declarations } => {
                    for declaration in declarations.of(&tree.declarations) {
                        let names = declaration.names.of(&tree.names);
                        if let (Some(name), Some(id)) = (names.first(), declaration.declared) {
                            let name = folded(name.of(text));
                            let said = words(text, behind(names, declaration.span));
                            self.type_words.insert(name.clone(), said);
                            if self.types.insert(name.clone(), declared_type(text, tree, id)).is_none() {
                                self.own_types.push(name);
                            }
                        }
                    }
                }
                ItemKind::Configuration { .. } => self.has_configuration = true,
                _ => {}
            }
        }
    }

    fn declare(&mut self, variable: Variable) {
        match self.pous.last_mut() {
            // Nobody else has this POU yet, so nothing is copied.
            Some(pou) if variable.section != SectionKind::Global => Arc::make_mut(pou).declare(variable),
            _ => {
                let name = folded(&variable.name);
                if let Entry::Vacant(free) = self.globals.entry(name.clone()) {
                    free.insert(variable);
                    self.own_globals.push(name);
                }
            }
        }
    }
}

impl DeclaredType {
    /// The type that record `id` of `tree`, which was read from `text`, declares.
    pub fn of(text: &str, tree: &IecTree, id: TypeId) -> DeclaredType {
        declared_type(text, tree, id)
    }
}

/// Types that name each other in a circle end after so many, not in an endless loop.
const CHAIN_MAX: usize = 16;

/// What is said in a section that says whether its variables keep their values without power.
fn kept(retain: Option<bool>, words: SmolStr) -> SmolStr {
    match retain {
        None => words,
        Some(true) => format_smolstr!("retain {words}"),
        Some(false) => format_smolstr!("non_retain {words}"),
    }
}

/// What a declaration says behind its names.
fn behind(names: &[Span], declaration: Span) -> Span {
    Span { start: names.last().map_or(declaration.start, |last| last.end), ..declaration }
}

fn declared_type(text: &str, tree: &IecTree, id: TypeId) -> DeclaredType {
    let written = tree.type_spec(id);
    match written.value {
        TypeSpec::Elementary(kind) => DeclaredType::Elementary(kind),
        TypeSpec::Named => DeclaredType::Named(folded(written.span.of(text))),
        TypeSpec::Text { wide: false, .. } => DeclaredType::Elementary(ElementaryType::String),
        TypeSpec::Text { wide: true, .. } => DeclaredType::Elementary(ElementaryType::Wstring),
        TypeSpec::Subrange { base, least, greatest } => {
            let limit = |id: OperandId| match tree.operand(id).value {
                Operand::Literal(literal) => match literal.value {
                    LiteralValue::Integer(number) => Some(number),
                    _ => None,
                },
                _ => None,
            };
            let base = Box::new(declared_type(text, tree, base));
            DeclaredType::Subrange(base, limit(least).zip(limit(greatest)))
        }
        TypeSpec::Enumeration { values } => DeclaredType::Enumeration(
            values.of(&tree.names).iter().map(|name| folded(name.of(text))).collect(),
        ),
        TypeSpec::Array { element, .. } => DeclaredType::Array(Box::new(declared_type(text, tree, element))),
        TypeSpec::Reference { .. } => DeclaredType::Unknown,
        TypeSpec::Structure { fields } => {
            let declarations = fields.of(&tree.declarations).iter();
            let fields = declarations.flat_map(|declaration| {
                let declared =
                    declaration.declared.map_or(DeclaredType::Unknown, |id| declared_type(text, tree, id));
                let names = declaration.names.of(&tree.names).iter();
                names.map(move |name| (folded(name.of(text)), declared.clone()))
            });
            DeclaredType::Structure(fields.collect())
        }
    }
}

/// What is done with each operand, as far as direct addresses can stand there.
fn direct_uses(tree: &IecTree) -> Vec<Use> {
    let mut uses = vec![Use::Read; tree.operands.len()];
    let mut set = |id: OperandId, usage: Use| {
        if let Some(slot) = uses.get_mut(id.0 as usize) {
            *slot = usage;
        }
    };
    for item in &tree.items {
        if let ItemKind::Operation { operation, operand: Some(id) } = item.kind
            && matches!(operation.operator.role, OperatorRole::Store | OperatorRole::Latch { .. })
        {
            set(id, Use::Write);
        }
    }
    for parameter in &tree.parameters {
        if let (Direction::Out { .. }, ParameterValue::Operand(id)) = (parameter.direction, parameter.value) {
            set(id, Use::Write);
        }
    }
    for id in tree.declarations.iter().filter_map(|declaration| declaration.address) {
        set(id, Use::Declare);
    }
    uses
}

/// The mentions of an IEC chunk; operands that are direct addresses are among them.
pub(super) fn mentions(text: &str, tree: &IecTree, mentions: &mut Vec<Mention>) {
    let uses = direct_uses(tree);
    for (operand, usage) in tree.operands.iter().zip(uses) {
        if matches!(operand.value, Operand::Direct(_)) {
            of_operand(text, &operand.value, operand.span, usage, mentions);
        }
    }
    for mention in tree.mentions(text) {
        let name = mention.span.of(text);
        let (symbol, usage) = match mention.role {
            MentionRole::DeclaresPou(_) => (Symbol::Pou(folded(name)), Use::Declare),
            MentionRole::DeclaresVariable => (Symbol::variable(name), Use::Declare),
            MentionRole::DeclaresType => (Symbol::Type(folded(name)), Use::Declare),
            MentionRole::DeclaresLabel => (Symbol::Label(folded(name)), Use::Declare),
            MentionRole::Reads => (Symbol::variable(name), Use::Read),
            MentionRole::Writes => (Symbol::variable(name), Use::Write),
            MentionRole::Calls => (Symbol::variable(name), Use::ReadWrite),
            MentionRole::CallsFunction => (Symbol::Pou(folded(name)), Use::Read),
            MentionRole::Jumps => (Symbol::Label(folded(name)), Use::Jump),
            MentionRole::NamesType => (Symbol::Type(folded(name)), Use::Read),
            // These have meaning only together with what stands before them; nothing asks for them by name.
            MentionRole::DeclaresField
            | MentionRole::DeclaresEnumerator
            | MentionRole::DeclaresRuntime
            | MentionRole::NamesRuntime
            | MentionRole::NamesParameter
            | MentionRole::NamesMember => continue,
        };
        mentions.push(Mention { symbol, span: mention.span, usage, count: 1 });
    }
}
