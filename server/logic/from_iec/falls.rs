//! Falling edges, which no block of the standard finds as a contact of a falling edge does: F_TRIG is on in its first
//! call if its input is off. So two variables find them, and what they find is an edge contact or a coil of an edge:
//!
//! ```text
//! LD   Was1        LD   a           the power of the coil
//! ANDN a           ST   PLF_y
//! ST   Fall1       LD   Was1
//! LD   a           ANDN PLF_y
//! ST   Was1        ST   y
//! LD   Fall1       LD   PLF_y
//! …                ST   Was1
//! ```

use super::loose::Helper;
use super::{Source, end_of_line};
use crate::document::{DeclaredType, Scopes};
use crate::il::iec::SectionKind;
use crate::ladder::{CoilKind, ContactKind};
use crate::logic::{Action, Contact, Deed, Drive, Expression, Gate, Path, Rung, Storage, Term, Test};
use crate::target::Operand;
use crate::target::iec::ElementaryType;
use crate::text::{Span, folded};
use rustc_hash::FxHashMap;

/// What the names of variables begin with that keep what a bit was, and of those that are on at its falling edge.
pub const FALLS: [&str; 2] = ["Was", "Fall"];

/// What the names of variables begin with that keep the power of a coil of a falling edge.
const COIL: &str = "PLF_";

/// Whether a variable is named as those that find falling edges.
pub fn is_fall_name(name: &str) -> bool {
    let behind = |stem: &str| {
        let own = name.get(..stem.len()).filter(|own| own.eq_ignore_ascii_case(stem));
        own.map(|_| &name[stem.len()..]).filter(|rest| !rest.is_empty())
    };
    let is_number = |rest: &str| rest.bytes().all(|byte| byte.is_ascii_digit());
    FALLS.into_iter().any(|stem| behind(stem).is_some_and(is_number)) || behind(COIL).is_some()
}

/// Whether a variable is named and declared as those that find falling edges: a plain BOOL that is off at first, and
/// that nobody outside of its program unit knows.
pub(in crate::logic) fn is_declared_fall(scopes: &Scopes, pou: Option<usize>, name: &str) -> bool {
    is_fall_name(name)
        && scopes.variable(pou, name).is_some_and(|variable| {
            variable.declared == DeclaredType::Elementary(ElementaryType::Bool)
                && variable.section == SectionKind::Local
                && variable.address.is_none()
                && !variable.is_retained()
                && !variable.has_value()
        })
}

/// A falling edge that two rungs find.
struct Fall {
    /// The bit.
    of: Term,
    /// The variable that is on at its edge, or the coil.
    found: Action,
}

impl Source<'_> {
    /// How often each variable is named that may find falling edges.
    pub(super) fn count_falls(&self, starts: &[u32], pous: usize) -> FxHashMap<Helper, usize> {
        let mut named: FxHashMap<Helper, usize> = FxHashMap::default();
        for operand in self.tree.operands.iter().filter(|operand| operand.value == Operand::Variable) {
            let name = operand.span.of(self.text);
            if is_fall_name(name) {
                let before = starts.partition_point(|start| *start <= operand.span.start);
                *named.entry(((pous + before).checked_sub(1), folded(name))).or_default() += 1;
            }
        }
        named.retain(|(pou, name), _| is_declared_fall(self.scopes, *pou, name));
        named
    }

    /// Makes edge contacts and coils of edges of the rungs from number `first` on, all of one program unit, that find
    /// falling edges.
    pub(super) fn join_falls(&self, pou: Option<usize>, first: usize, rungs: &mut Vec<Rung>) {
        if self.falls.is_empty() {
            return;
        }
        let own = rungs.split_off(first);
        let mut at = 0;
        while at < own.len() {
            let (count, rung) = self.with_falls(pou, &own[at..]);
            rungs.push(rung);
            at += count;
        }
    }

    /// The rung that the first ones make, and how many they are.
    fn with_falls(&self, pou: Option<usize>, rungs: &[Rung]) -> (usize, Rung) {
        let mut falls = Vec::new();
        let mut count = 0;
        while let [one, two, rest @ ..] = &rungs[count..]
            && let Some((fall, [])) = self.fall(pou, one, two)
            && rest.first().is_some_and(|next| self.goes_on(two, next))
        {
            falls.push(fall);
            count += 2;
        }
        let joined = match &rungs[count].path {
            Ok(Some(path)) => self.edges(pou, path, &falls, rungs[count].span),
            _ => None,
        };
        let mut rung = match joined {
            Some(path) => joined_rung(&rungs[..=count], path),
            None => {
                count = 0;
                rungs[0].clone()
            }
        };
        while let [before, one, two, ..] = &rungs[count..]
            && self.goes_on(before, one)
            && let Some((fall, others)) = self.fall(pou, one, two)
            && let Ok(Some(path)) = &rung.path
            && let Some(path) = self.with_coil(pou, path, &fall, others)
        {
            let last = two.span;
            rung = Rung { path: Ok(Some(path)), span: rung.span.to(last), ..rung };
            count += 2;
        }
        (count + 1, rung)
    }

    /// How often a variable that may find falling edges is named in its unit; nothing for another one.
    fn mentions(&self, pou: Option<usize>, term: &Term) -> Option<usize> {
        self.falls.get(&(pou, term.key())).copied()
    }

    /// Whether a rung belongs to the one before: nothing stands between them.
    fn goes_on(&self, before: &Rung, rung: &Rung) -> bool {
        let between = Span { start: before.span.end, end: rung.span.start.max(before.span.end) };
        let line_end = end_of_line(self.text, before.span.end as usize) as u32;
        let is_behind = |comment: &Span| comment.start >= before.span.end && comment.start < line_end;
        rung.labels.is_empty()
            && rung.comments.is_empty()
            && !before.comments.iter().any(is_behind)
            && between.of(self.text).matches('\n').count() <= 1
    }

    /// The falling edge that two rungs find: `LD Was1 / ANDN a / ST Fall1` and `LD a / ST Was1`. What else the second
    /// one drives has the power that is looked at.
    fn fall<'r>(&self, pou: Option<usize>, one: &Rung, two: &'r Rung) -> Option<(Fall, &'r [Drive])> {
        let (Ok(Some(finds)), Ok(Some(keeps))) = (&one.path, &two.path) else { return None };
        let ([Gate::Pass(Expression::And(parts))], [found]) = (&finds.gates[..], &finds.drives[..]) else {
            return None;
        };
        let ([Gate::Pass(kept)], [keeper, others @ ..]) = (&keeps.gates[..], &keeps.drives[..]) else {
            return None;
        };
        let ([was, is], (found, action), (keeper, _)) = (&parts[..], plain(found)?, plain(keeper)?) else {
            return None;
        };
        let of = bit(is, ContactKind::NormallyClosed)?;
        let was = bit(was, ContactKind::NormallyOpen)?;
        let is_it = bit(kept, ContactKind::NormallyOpen)? == of && keeper == was && found != was && of != was;
        let fall = || (Fall { of: of.clone(), found: action.clone() }, others);
        (is_it && self.mentions(pou, was) == Some(2) && self.goes_on(one, two)).then(fall)
    }

    /// `path`, which stands in `span`, with edge contacts for the variables that find the edges; nothing where these
    /// are used in another way, or where the bit may have changed since.
    fn edges(&self, pou: Option<usize>, path: &Path, falls: &[Fall], span: Span) -> Option<Path> {
        for fall in falls {
            let found = fall.found.terms.first()?;
            let inside = self.tree.operands.iter().filter(|operand| {
                let own = operand.span;
                span.start <= own.start
                    && own.end <= span.end
                    && own.of(self.text).eq_ignore_ascii_case(&found.text)
            });
            let count = inside.count();
            if count == 0 || self.mentions(pou, found) != Some(count + 1) {
                return None;
            }
        }
        let changes = |fall: &Fall| {
            path.actions().into_iter().any(|action| {
                action.changes().iter().any(|term| term.may_cover(&fall.of))
                    || action.runs_unit() && fall.of.storage != Storage::Local
            })
        };
        let is_late: Vec<bool> = falls.iter().map(changes).collect();
        replaced(path, (falls, &is_late), false)
    }

    /// `path`, the last thing that it does being to keep its power for a coil of an edge, with that coil and the others
    /// behind it.
    fn with_coil(&self, pou: Option<usize>, path: &Path, fall: &Fall, others: &[Drive]) -> Option<Path> {
        let mut path = path.clone();
        // The coil is no variable that finds an edge for others.
        fall.found.terms.first().filter(|coil| self.mentions(pou, coil).is_none())?;
        change_last(&mut path, |drives| {
            // Behind NOT it is a negated coil that keeps the power.
            let Drive::Action(keeper) = drives.last()? else { return None };
            let is_inverse = keeper.deed == Deed::Coil(CoilKind::Negated);
            let ([power], true) = (&keeper.terms[..], is_inverse || plain(drives.last()?).is_some()) else {
                return None;
            };
            (*power == fall.of && self.mentions(pou, power) == Some(3)).then_some(())?;
            drives.pop();
            let coil = Drive::Action(Action { deed: Deed::Coil(CoilKind::Falling), ..fall.found.clone() });
            let behind = std::iter::once(coil).chain(others.iter().cloned());
            match is_inverse {
                true => {
                    drives.push(Drive::Path(Path { gates: vec![Gate::Invert], drives: behind.collect() }));
                }
                false => drives.extend(behind),
            }
            Some(())
        })?;
        Some(path)
    }
}

/// What a plain coil drives, and the coil.
fn plain(drive: &Drive) -> Option<(&Term, &Action)> {
    match drive {
        Drive::Action(action) if action.deed == Deed::Coil(CoilKind::Plain) => match &action.terms[..] {
            [term] => Some((term, action)),
            _ => None,
        },
        _ => None,
    }
}

/// The bit that a contact of this kind asks for.
fn bit(expression: &Expression, kind: ContactKind) -> Option<&Term> {
    match expression {
        Expression::Contact(contact) if contact.test == Test::Bit(kind) => contact.terms.first(),
        _ => None,
    }
}

/// Changes what the path drives that does the last thing, of this one and those that leave it.
fn change_last(path: &mut Path, change: impl FnOnce(&mut Vec<Drive>) -> Option<()>) -> Option<()> {
    match path.drives.last_mut() {
        Some(Drive::Path(last)) => change_last(last, change),
        _ => change(&mut path.drives),
    }
}

/// The path with edge contacts for variables that find edges; `is_late` says of which the bits change on the way, and
/// `is_behind` that they may have changed already.
fn replaced(path: &Path, (falls, is_late): (&[Fall], &[bool]), is_behind: bool) -> Option<Path> {
    let mut is_behind = is_behind;
    let number = |term: &Term| falls.iter().position(|fall| fall.found.terms.first() == Some(term));
    let is_clear = |action: &Action| !action.terms.iter().any(|term| number(term).is_some());
    let mut written = Path::default();
    for gate in &path.gates {
        written.gates.push(match gate {
            Gate::Pass(expression) => Gate::Pass(
                expression
                    .mapped(&mut |contact| {
                        let Some(fall) = contact.terms.iter().find_map(number) else {
                            return Ok(Expression::Contact(contact.clone()));
                        };
                        let edge = Expression::Contact(Contact {
                            test: Test::Bit(ContactKind::Falling),
                            terms: vec![falls[fall].of.clone()],
                            span: contact.span,
                        });
                        match contact.test {
                            _ if is_behind && is_late[fall] => Err(()),
                            Test::Bit(ContactKind::NormallyOpen) => Ok(edge),
                            Test::Bit(ContactKind::NormallyClosed) => Ok(Expression::Not(Box::new(edge))),
                            _ => Err(()),
                        }
                    })
                    .ok()?,
            ),
            Gate::Invert => Gate::Invert,
            Gate::Through(action) => {
                is_behind = true;
                is_clear(action).then(|| Gate::Through(action.clone()))?
            }
        });
    }
    for drive in &path.drives {
        written.drives.push(match drive {
            Drive::Action(action) => is_clear(action).then(|| Drive::Action(action.clone()))?,
            Drive::Path(path) => Drive::Path(replaced(path, (falls, is_late), is_behind)?),
        });
        is_behind = true;
    }
    Some(written)
}

/// What these rungs are if they are one that does what `path` says.
fn joined_rung(rungs: &[Rung], path: Path) -> Rung {
    let span = rungs.iter().map(|rung| rung.span).reduce(Span::to).unwrap_or_default();
    let comments = rungs.iter().flat_map(|rung| rung.comments.iter().copied()).collect();
    Rung { span, comments, path: Ok(Some(path)), ..rungs[0].clone() }
}
