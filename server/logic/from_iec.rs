//! Reads instruction list of IEC 61131-3 as rungs.
//!
//! A rung begins with a load outside of parentheses, with an unconditional call, jump or return, or with a label before
//! one of these, and goes on for as long as its current result is used: `LD a / ST y / AND b / ST z` is one rung with
//! two outputs. A chunk of the document can hold several, for it goes on up to the next load. Some things make one
//! rung of several loads, unless a comment or a blank line stands between them:
//!
//! - A call of a function block and the load of its output, `--[TON]--( )`, if the output is only gone on from.
//! - Calls of R_TRIG and the rung behind them, if nobody else asks for their output: contacts of rising edges.
//! - The call of `PLS_M7` and the store of its output in `M7`: a coil of a rising edge.
//! - Two variables `Was1` and `Fall1` that find a falling edge, and the rung behind them: contacts of falling edges, or
//!   a coil of one, see [`falls`].
//! - A helper `Held1` that is stored and loaded again: the rung branches there.
//! - A jump over calculations: they are done under its condition.

mod computing;
mod falls;
mod loose;
mod reader;

use self::computing::Skips;
pub(super) use self::falls::is_declared_fall;
pub use self::falls::{FALLS, is_fall_name};
use self::loose::Helper;
use self::reader::Reader;
pub(super) use self::reader::detects_rise;
use super::{Callee, Declared, Elsewhere, Path, Refusal, Rung, Term};
use crate::document::{DeclaredType, Scopes};
use crate::il::iec::{Condition, IecTree, Item, ItemKind, ListForm, OperandId, SectionKind};
use crate::ladder::CoilKind;
use crate::target::Operand;
use crate::target::Width;
use crate::target::iec::{ElementaryType, LiteralValue, OperatorRole};
use crate::text::{Severity, Span, folded};
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::{SmolStr, format_smolstr};
use std::ops::Range;

/// The rungs of a piece of a file, of which `elsewhere` is what the rest of its program unit says of its names.
pub(super) fn rungs(text: &str, tree: &IecTree, declared: Declared<'_>, elsewhere: &Elsewhere) -> Vec<Rung> {
    read_all(&Source::new(text, tree, declared, elsewhere))
}

/// The helpers, by program unit and folded name, that a piece of a file uses for more than to keep power.
pub(super) fn loose_helpers(
    text: &str,
    tree: &IecTree,
    declared: Declared<'_>,
    elsewhere: &Elsewhere,
) -> FxHashSet<Helper> {
    Source::new(text, tree, declared, elsewhere).shown
}

fn read_all(source: &Source<'_>) -> Vec<Rung> {
    let (text, tree) = (source.text, source.tree);
    let mut comments = Comments::of(text, tree);
    let mut rungs = Vec::new();
    let mut first = 0;
    for region in &source.regions {
        comments.skip_to(region.start);
        let segments = &source.segments[first..region.segments];
        first = region.segments;
        let own = rungs.len();
        source.read(segments, &mut comments, &mut rungs);
        source.join_falls(segments.first().and_then(|first| first.pou), own, &mut rungs);
    }
    let rest = comments.rest();
    if !source.ends_declared && !rest.is_empty() {
        let span = Span::at(text.len());
        let path = Ok(None);
        let rung = Rung { labels: Vec::new(), network: None, comments: rest, span, is_list: true, path };
        rungs.push(rung);
    }
    rungs
}

/// The declarations of a piece of a file: each with what stands around it up to whole lines, comments among them.
/// Between them are the rungs.
pub fn declarations(text: &str, tree: &IecTree) -> Vec<Span> {
    let mut spans: Vec<Span> = Vec::new();
    // Where the last rung ends, and whether the last item is a declaration.
    let (mut end, mut is_open) = (0, false);
    for item in &tree.items {
        let line_end = end_of_line(text, item.span.end as usize);
        match (declares(&item.kind), spans.last_mut()) {
            (true, Some(last)) if is_open => last.end = last.end.max(line_end as u32),
            (true, _) => spans.push(Span::new(end, line_end)),
            (false, _) => end = end.max(line_end),
        }
        is_open = declares(&item.kind);
    }
    if is_open && let Some(last) = spans.last_mut() {
        last.end = text.len() as u32;
    }
    spans
}

/// Where the line of `offset` ends, its line feed included.
pub(super) fn end_of_line(text: &str, offset: usize) -> usize {
    let rest = text.as_bytes().get(offset..).unwrap_or(&[]);
    rest.iter().position(|byte| *byte == b'\n').map_or(text.len(), |length| offset + length + 1)
}

fn declares(kind: &ItemKind) -> bool {
    use ItemKind::*;
    matches!(
        kind,
        Pou { .. }
            | PouEnd(_)
            | Section { .. }
            | Types { .. }
            | Configuration { .. }
            | Resource { .. }
            | Task(_)
            | Instance(_)
            | End(_)
    )
}

/// Comments and pragmas that wait for their rung.
struct Comments {
    spans: Vec<Span>,
    next: usize,
}

impl Comments {
    fn of(text: &str, tree: &IecTree) -> Comments {
        let own = |span: &Span| !span.of(text).is_empty();
        let mut spans: Vec<Span> = tree.comments.iter().chain(&tree.pragmas).copied().filter(own).collect();
        spans.sort_unstable();
        Comments { spans, next: 0 }
    }

    /// Those that start before `offset` belong to declarations.
    fn skip_to(&mut self, offset: usize) {
        self.up_to(offset);
    }

    /// The next ones, as far as they start before `offset`.
    fn up_to(&mut self, offset: usize) -> Vec<Span> {
        let rest = &self.spans[self.next..];
        let count = rest.partition_point(|comment| (comment.start as usize) < offset);
        self.next += count;
        rest[..count].to_vec()
    }

    fn rest(&mut self) -> Vec<Span> {
        self.up_to(usize::MAX)
    }
}

/// A stretch of instructions that may be a rung, or the beginning or end of one.
struct Segment {
    labels: Vec<Span>,
    /// Its instructions; empty where only labels stand before a declaration.
    items: Range<usize>,
    /// The program unit.
    pou: Option<usize>,
    /// Whether it may go on with the rung of the segment before.
    goes_on: bool,
}

/// Segments between two declarations.
struct Region {
    /// Where the declarations before it end.
    start: usize,
    /// How many segments there are up to its end.
    segments: usize,
}

/// How the instance of an edge detector is used.
#[derive(Clone, Default)]
pub(super) struct Detector {
    /// Its name standing alone: in a call, or handed over.
    bare: u32,
    /// Its input stored to.
    fed: u32,
    /// Its output read: how often, first and last place.
    read: u32,
    reads: Option<Span>,
    /// Whether another part of it is used.
    is_opened: bool,
}

impl Detector {
    /// Counts a use of it, or of one of its parts, at a place.
    fn count(&mut self, member: Option<&str>, place: Span) {
        match member {
            None => self.bare += 1,
            Some(member) if member.eq_ignore_ascii_case("Q") => {
                self.read += 1;
                self.reads = Some(self.reads.map_or(place, |reads| reads.to(place)));
            }
            Some(member) if member.eq_ignore_ascii_case("CLK") => self.fed += 1,
            Some(_) => self.is_opened = true,
        }
    }

    /// The same for a use outside of the text: no rung reaches from there to any place in it.
    pub(super) fn count_elsewhere(&mut self, member: Option<&str>) {
        self.count(member, Span { start: 0, end: u32::MAX });
    }
}

struct Source<'a> {
    text: &'a str,
    tree: &'a IecTree,
    scopes: &'a Scopes,
    segments: Vec<Segment>,
    regions: Vec<Region>,
    /// Whether the last item is a declaration.
    ends_declared: bool,
    /// By program unit and folded name.
    detectors: FxHashMap<(Option<usize>, SmolStr), Detector>,
    /// The places of mistakes, in order.
    mistakes: Vec<u32>,
    /// Helpers that are used in other ways than to keep the power of a rung.
    shown: FxHashSet<Helper>,
    /// How often variables are named that may find falling edges.
    falls: FxHashMap<Helper, usize>,
    skips: Skips,
}

impl<'a> Source<'a> {
    fn new(text: &'a str, tree: &'a IecTree, declared: Declared<'a>, elsewhere: &Elsewhere) -> Source<'a> {
        let Declared { scopes, pous } = declared;
        let mut mistakes: Vec<u32> = tree
            .problems
            .iter()
            .filter(|problem| problem.severity == Severity::Error)
            .map(|problem| problem.span.start)
            .collect();
        mistakes.sort_unstable();
        let mut source = Source {
            text,
            tree,
            scopes,
            segments: Vec::new(),
            regions: Vec::new(),
            ends_declared: tree.items.last().is_some_and(|item| declares(&item.kind)),
            detectors: FxHashMap::default(),
            mistakes,
            shown: FxHashSet::default(),
            falls: FxHashMap::default(),
            skips: Skips::default(),
        };
        let pou = pous.checked_sub(1);
        source.skips = source.find_skips(pous, elsewhere);
        let starts = source.cut(pous);
        let detectors = elsewhere.detectors.iter();
        source.detectors.extend(detectors.map(|(name, detector)| ((pou, name.clone()), detector.clone())));
        source.find_detectors(&starts, pous);
        source.shown = source.loose_helpers(&starts, pous);
        source.falls = source.count_falls(&starts, pous);
        source.falls.retain(|(_, name), _| !elsewhere.loose.contains(name));
        source.shown.extend(elsewhere.loose.iter().map(|name| (pou, name.clone())));
        source
    }

    /// Cuts the items into segments. Gives the offsets at which program units start.
    fn cut(&mut self, pous: usize) -> Vec<u32> {
        let mut starts = Vec::new();
        let mut is_open = false;
        let mut region = 0;
        for (index, item) in self.tree.items.iter().enumerate() {
            if declares(&item.kind) {
                if self.regions.last().is_none_or(|last| last.segments < self.segments.len()) {
                    self.regions.push(Region { start: region, segments: self.segments.len() });
                }
                region = end_of_line(self.text, item.span.end as usize);
                starts.extend(matches!(item.kind, ItemKind::Pou { .. }).then_some(item.span.start));
                is_open = false;
                continue;
            }
            let pou = (pous + starts.len()).checked_sub(1);
            let label = match item.kind {
                ItemKind::Label { .. } if self.skips.covers(index) => None,
                ItemKind::Label { name } if item.depth == 0 && !self.needs_result(index) => Some(name),
                _ => None,
            };
            let last = self.segments.last().filter(|_| is_open);
            let only_labels = last.is_some_and(|last| last.items.is_empty());
            let begins = match last {
                None => true,
                Some(_) if only_labels => false,
                Some(last) => label.is_some() || item.depth == 0 && self.begins(last, index),
            };
            if begins {
                let goes_on =
                    is_open && label.is_none() && (self.skips.covers(index) || self.may_go_on(index, pou));
                self.segments.push(Segment { labels: Vec::new(), items: index..index, pou, goes_on });
                is_open = true;
            }
            let Some(segment) = self.segments.last_mut() else { continue };
            match label {
                Some(name) => segment.labels.push(name),
                None if segment.items.is_empty() => segment.items = index..index + 1,
                None => segment.items.end = index + 1,
            }
        }
        self.regions.push(Region { start: region, segments: self.segments.len() });
        starts
    }

    /// Whether the instruction behind the label at `index` uses a current result that comes from before.
    fn needs_result(&self, index: usize) -> bool {
        let rest = &self.tree.items[index..];
        let next = rest.iter().find(|item| !matches!(item.kind, ItemKind::Label { .. }));
        next.is_some_and(|next| !declares(&next.kind) && !self.starts_afresh(&next.kind))
    }

    /// Whether an instruction needs no current result.
    fn starts_afresh(&self, kind: &ItemKind) -> bool {
        match kind {
            ItemKind::Operation { operation, .. } => operation.operator.role == OperatorRole::Load,
            ItemKind::Call { condition, .. }
            | ItemKind::Jump { condition, .. }
            | ItemKind::Return { condition, .. } => *condition == Condition::Always,
            ItemKind::Function { form, .. } => *form != ListForm::None,
            _ => false,
        }
    }

    /// Whether item `index`, outside of parentheses, begins a segment behind `last`.
    fn begins(&self, last: &Segment, index: usize) -> bool {
        let is_fed = index
            .checked_sub(1)
            .is_some_and(|before| last.items.contains(&before) && self.feeds(last.pou, before));
        self.starts_afresh(&self.tree.items[index].kind) && !is_fed
    }

    /// Whether the segment that begins with item `index` may go on with the rung before: it asks for the output of a
    /// block that was just called, or detectors of edges were.
    fn may_go_on(&self, index: usize, pou: Option<usize>) -> bool {
        let [before, item] = [index.wrapping_sub(1), index].map(|index| self.tree.items.get(index));
        let (Some(before), Some(item)) = (before, item) else { return false };
        let helper = self.helper_loaded(index);
        if let Some(name) = &helper
            && !self.is_helper(pou, name)
        {
            return false;
        }
        let between = Span { start: before.span.end, end: item.span.start.max(before.span.end) };
        let is_commented = {
            let after = self.tree.comments.partition_point(|comment| comment.start < between.start);
            self.tree.comments.get(after).is_some_and(|comment| comment.start < between.end)
                || between.of(self.text).matches('\n').count() > 1
        };
        if is_commented {
            return false;
        }
        if helper.is_some() {
            return true;
        }
        let ItemKind::Call { condition: Condition::Always, callee: Some(callee), .. } = before.kind else {
            return false;
        };
        let instance = self.tree.operand(callee).span.of(self.text);
        let Some(block) = self.block(pou, instance) else { return false };
        let detects = detects_rise(&block);
        let asks = match item.kind {
            ItemKind::Operation { operation, operand: Some(id) } => {
                operation.operator.role == OperatorRole::Load
                    && self
                        .tree
                        .operand(id)
                        .span
                        .of(self.text)
                        .eq_ignore_ascii_case(&output_of(&block, instance))
            }
            _ => false,
        };
        let is_load = matches!(item.kind, ItemKind::Operation { .. });
        let is_call = matches!(item.kind, ItemKind::Call { .. });
        asks || detects && (is_load || is_call)
    }

    /// The helper, by its folded name, that is loaded at `index`, or behind the calls there.
    fn helper_loaded(&self, index: usize) -> Option<SmolStr> {
        let rest = self.tree.items.get(index..)?.iter().take(JOINED_MAX);
        let load = rest.into_iter().find(|item| !matches!(item.kind, ItemKind::Call { .. }))?;
        let ItemKind::Operation { operation, operand: Some(id) } = load.kind else { return None };
        let name = self.tree.operand(id).span.of(self.text);
        let loads = operation.operator.role == OperatorRole::Load && !operation.negated && load.depth == 0;
        (loads && is_helper_name(name)).then(|| folded(name))
    }

    /// Whether the variable with this folded name keeps the power of a rung and nothing else: a translation from a
    /// drawing made it.
    fn is_helper(&self, pou: Option<usize>, name: &str) -> bool {
        is_declared_helper(self.scopes, pou, name) && !self.shown.contains(&(pou, SmolStr::from(name)))
    }

    /// Whether item `index` stores the power of the call that follows it: `ST T1.IN` before `CAL T1`. What is stored to
    /// other inputs is stored like anything else.
    fn feeds(&self, pou: Option<usize>, index: usize) -> bool {
        let item = &self.tree.items[index];
        let (ItemKind::Operation { operation, operand: Some(id) }, Some(next)) =
            (item.kind, self.tree.items.get(index + 1))
        else {
            return false;
        };
        let ItemKind::Call { condition: Condition::Always, callee: Some(callee), .. } = next.kind else {
            return false;
        };
        let [stored, called] = [id, callee].map(|id| self.tree.operand(id).span.of(self.text));
        let is_power = |input: &str| match self.block(pou, called) {
            Some(block) => block.power_in().is_some_and(|power| folded(power) == folded(input)),
            None => true,
        };
        operation.operator.role == OperatorRole::Store
            && item.depth == 0
            && stored
                .rsplit_once('.')
                .is_some_and(|(instance, input)| folded(instance) == folded(called) && is_power(input))
    }

    /// Counts the uses of instances that may be detectors of edges.
    fn find_detectors(&mut self, starts: &[u32], pous: usize) {
        for operand in &self.tree.operands {
            if operand.value != Operand::Variable {
                continue;
            }
            let before = starts.partition_point(|start| *start <= operand.span.start);
            let pou = (pous + before).checked_sub(1);
            let path = operand.span.of(self.text);
            let (instance, member) =
                path.split_once('.').map_or((path, None), |(root, rest)| (root, Some(rest)));
            if self.block(pou, instance).is_none_or(|block| !detects_rise(&block)) {
                continue;
            }
            self.detectors.entry((pou, folded(instance))).or_default().count(member, operand.span);
        }
    }

    /// The function block that a variable is an instance of.
    fn block(&self, pou: Option<usize>, instance: &str) -> Option<Callee> {
        block_of(self.scopes, pou, instance)
    }

    /// Whether nobody but the instructions in `span` asks for the output of this detector, which is called once with
    /// its input.
    fn is_edge(&self, pou: Option<usize>, instance: &str, span: Span) -> bool {
        self.detector(pou, instance).is_some_and(|detector| {
            let inside = |reads: Span| span.start <= reads.start && reads.end <= span.end;
            detector.fed == 0 && detector.reads.is_some_and(inside)
        })
    }

    /// Whether this detector is stored to once, called once, and asked once.
    fn is_pulse(&self, pou: Option<usize>, instance: &str) -> bool {
        self.detector(pou, instance).is_some_and(|detector| detector.fed == 1 && detector.read == 1)
    }

    /// A detector that is called in one place, that nobody outside of its program unit knows, and that begins with
    /// nothing remembered.
    fn detector(&self, pou: Option<usize>, instance: &str) -> Option<&Detector> {
        let name = folded(instance);
        let is_own = pou.is_none()
            || self.scopes.variable(pou, &name).is_some_and(|found| {
                found.section == SectionKind::Local && !found.is_retained() && !found.has_value()
            });
        let detector = self.detectors.get(&(pou, name));
        detector.filter(|detector| is_own && detector.bare == 1 && !detector.is_opened)
    }

    /// What an operand can be, as far as it is declared.
    fn value_kind(&self, pou: Option<usize>, operand: &Operand, word: &str) -> ValueKind {
        match operand {
            Operand::Literal(literal) => match literal.value {
                LiteralValue::Bool(_) => ValueKind::Bit,
                LiteralValue::Integer(0 | 1) if literal.named_type.is_none() => ValueKind::Unknown,
                _ => ValueKind::Word,
            },
            Operand::Direct(address) if address.width == Width::Bit => ValueKind::Bit,
            Operand::Direct(_) => ValueKind::Word,
            Operand::Variable => match self.scopes.type_of(pou, word) {
                Some(DeclaredType::Elementary(ElementaryType::Bool)) => ValueKind::Bit,
                Some(DeclaredType::Unknown) | None => ValueKind::Unknown,
                Some(_) => ValueKind::Word,
            },
            _ => ValueKind::Invalid,
        }
    }

    /// Reads segments, joined where they make one rung.
    fn read(&self, segments: &[Segment], comments: &mut Comments, rungs: &mut Vec<Rung>) {
        let mut at = 0;
        while let Some(first) = segments.get(at) {
            let rest = segments[at + 1..].iter().take(JOINED_MAX + 1);
            let more = rest.take_while(|segment| segment.goes_on).count();
            // What a helper keeps goes on to the end, so a part of them is no rung.
            let joined = (1..=JOINED_MAX)
                .contains(&more)
                .then(|| self.path(first.pou, first.items.start..segments[at + more].items.end));
            // What a jump skips stays with it.
            let skipped = segments[at + 1..]
                .iter()
                .take_while(|segment| self.skips.covers(segment.items.start) && !segment.items.is_empty());
            let least = skipped.count();
            let (count, path) = match joined {
                Some(Ok(path)) => (more + 1, Ok(path)),
                _ => {
                    let end = segments[at + least].items.end;
                    (least + 1, self.path(first.pou, first.items.start..end))
                }
            };
            let items = &self.tree.items[first.items.start..segments[at + count - 1].items.end];
            let label = || first.labels.last().copied().unwrap_or_default();
            let span = items.iter().map(|item| item.span).reduce(Span::to).unwrap_or_else(label);
            let rung = Rung {
                labels: first.labels.iter().map(|label| label.of(self.text).into()).collect(),
                network: None,
                comments: comments.up_to(end_of_line(self.text, span.end as usize)),
                span,
                is_list: true,
                path,
            };
            rungs.push(rung);
            at += count;
        }
    }

    fn path(&self, pou: Option<usize>, items: Range<usize>) -> Result<Option<Path>, Refusal> {
        let Some((first, rest)) = self.tree.items[items.clone()].split_first() else { return Ok(None) };
        let span = rest.iter().fold(first.span, |span, item| span.to(item.span));
        let mistake = self.mistakes.partition_point(|mistake| *mistake < span.start);
        if self.mistakes.get(mistake).is_some_and(|mistake| *mistake <= span.end) {
            return Err(Refusal::Unreadable);
        }
        Reader::new(self, pou, span).read(items).map(Some)
    }

    /// The term that an operand is, where it lies as declared.
    fn term(&self, pou: Option<usize>, id: OperandId) -> Term {
        let operand = self.tree.operand(id);
        Term::new(operand.value, operand.span.of(self.text), operand.span).located(self.scopes, pou)
    }

    fn item(&self, index: usize) -> &'a Item {
        &self.tree.items[index]
    }
}

/// So many segments are tried as one rung.
const JOINED_MAX: usize = 64;

/// Whether a variable is named and declared as those that keep the power of a rung.
pub(super) fn is_declared_helper(scopes: &Scopes, pou: Option<usize>, name: &str) -> bool {
    is_helper_name(name)
        && scopes.variable(pou, name).is_some_and(|variable| {
            variable.declared == DeclaredType::Elementary(ElementaryType::Bool)
                && variable.section == SectionKind::Local
                && variable.address.is_none()
        })
}

/// The function block that a variable is an instance of.
pub(super) fn block_of(scopes: &Scopes, pou: Option<usize>, instance: &str) -> Option<Callee> {
    match scopes.type_of(pou, instance)? {
        DeclaredType::Named(name) => Callee::block(&name, scopes),
        _ => None,
    }
}

/// `Held1`: so the translation from drawings names the helpers that keep power.
pub fn is_helper_name(name: &str) -> bool {
    let number = name.get(..HELPER.len()).filter(|stem| stem.eq_ignore_ascii_case(HELPER));
    number.is_some()
        && name.len() > HELPER.len()
        && name[HELPER.len()..].bytes().all(|byte| byte.is_ascii_digit())
}

/// What the names of helpers begin with that keep the power of a rung.
pub const HELPER: &str = "Held";

/// The name of the detector that stands for a coil of an edge, `--(P)--`: `PLS_M7` or `PLF_M7` for the variable `M7`,
/// whose dots and brackets are underscores there. Several for one variable get numbers.
pub fn pulse_name(coil: CoilKind, variable: &str) -> SmolStr {
    let prefix = if coil == CoilKind::Rising { "PLS_" } else { "PLF_" };
    let words = variable.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|word| !word.is_empty());
    format_smolstr!("{prefix}{}", words.collect::<Vec<_>>().join("_"))
}

/// Whether `name` is that of a detector for a coil of an edge of `variable`: `PLS_M7`, `PLS_M7_2`.
fn is_pulse_name(name: &str, coil: CoilKind, variable: &str) -> bool {
    let (name, stem) = (folded(name), folded(&pulse_name(coil, variable)));
    let is_number = |rest: &str| !rest.is_empty() && rest.bytes().all(|byte| byte.is_ascii_digit());
    match name.strip_prefix(stem.as_str()) {
        Some("") => true,
        Some(rest) => rest.strip_prefix('_').is_some_and(is_number),
        None => false,
    }
}

/// What an operand can be.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum ValueKind {
    Bit,
    /// Anything else with a type.
    Word,
    /// It is not declared; what is done with it tells.
    Unknown,
    /// No operand at all.
    Invalid,
}

/// The output of an instance from which power goes on.
fn output_of(block: &Callee, instance: &str) -> String {
    format!("{instance}.{}", block.power_out().unwrap_or_default())
}
