//! Timers and counters of the FX family, and the blocks of IEC 61131-3 that stand for them.
//!
//! A counter of the FX family stops at its preset, and its contact stays on whatever becomes of that; CTU counts on,
//! and its output compares anew in each call. They do the same where one constant is the preset in all scans, the count
//! is compared with nothing beyond it, and one coil or call counts. RST calls the block, too, so that its preset must
//! be known by then, for which its declaration says it: `C0 : CTU := (PV := 10)`.

use super::super::source::Source;
use super::{Lack, guarded};
use crate::document::{Document, Variable};
use crate::ladder::{CoilKind, CompareOperator};
use crate::logic::{Action, Call, Deed, Path, Term};
use crate::target::iec::LiteralValue;
use crate::target::{Constant, Device, Operand};
use crate::text::folded;
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::{SmolStr, ToSmolStr};

/// The coils that the timers and counters of a program of the FX family have.
#[derive(Default, Debug)]
pub(super) struct Coils {
    presets: FxHashMap<Device, Preset>,
    /// The counters that are reset.
    reset: FxHashSet<Device>,
}

/// What the coils of a timer or counter say.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Preset {
    Constant(i64),
    Register,
    /// There are several coils.
    Several,
}

impl Coils {
    /// Those of all rungs of a program.
    pub fn of(sources: &[Source]) -> Coils {
        let mut coils = Coils::default();
        coils.read(sources);
        coils
    }

    fn read(&mut self, sources: &[Source]) {
        for action in sources.iter().filter_map(Source::path).flat_map(Path::actions) {
            let Some(Operand::Device(device)) = action.terms.first().map(|term| term.operand) else {
                continue;
            };
            match (&action.deed, &action.terms[..]) {
                (Deed::Coil(CoilKind::Plain), [_, preset]) => {
                    let own = match preset.operand {
                        Operand::Constant { value: Constant::Decimal(value), index: None } => {
                            Preset::Constant(value)
                        }
                        _ => Preset::Register,
                    };
                    let known = self.presets.entry(device);
                    known.and_modify(|known| *known = Preset::Several).or_insert(own);
                }
                (Deed::Coil(CoilKind::Reset), [_]) => _ = self.reset.insert(device),
                _ => {}
            }
        }
    }

    /// Whether one coil drives a timer or counter, or none.
    pub fn one(&self, device: Device) -> Result<(), Lack> {
        match self.presets.get(&device) {
            Some(Preset::Several) => Err(Lack::Reason("translate.several-coils", device.to_smolstr())),
            _ => Ok(()),
        }
    }

    /// The preset of a counter that is one constant. K0 works as K1 does (FX programming manuals, on counters).
    pub fn preset(&self, device: Device) -> Result<i64, Lack> {
        self.one(device)?;
        match self.presets.get(&device) {
            Some(Preset::Constant(preset @ 0..)) => Ok((*preset).max(1)),
            _ => Err(Lack::Reason("translate.preset", device.to_smolstr())),
        }
    }

    /// The presets that the declarations of the blocks for counters have to say, by their names, because a reset may
    /// call these first.
    pub fn declared(&self) -> FxHashMap<SmolStr, i64> {
        let known = |device: &Device| Some((device.to_smolstr(), self.preset(*device).ok()?));
        self.reset.iter().filter_map(known).collect()
    }
}

/// What a comparison of a count is that stops at its preset.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Reached {
    /// Always or never true.
    Constant(bool),
    /// The same of a count that goes on.
    Count(CompareOperator, i64),
}

/// A comparison of the count of a counter of the FX family with a number, where `preset` is where it stops, as one of
/// a count that goes on.
pub(super) fn stopping(operator: CompareOperator, number: i64, preset: i64) -> Reached {
    use CompareOperator::{Equal, Greater, GreaterOrEqual, Less, LessOrEqual, NotEqual};
    use Reached::{Constant, Count};
    let wide = false;
    match operator {
        GreaterOrEqual { .. } if number > preset => Constant(false),
        Less { .. } if number > preset => Constant(true),
        Greater { .. } if number >= preset => Constant(false),
        LessOrEqual { .. } if number >= preset => Constant(true),
        Equal { .. } if number > preset => Constant(false),
        NotEqual { .. } if number > preset => Constant(true),
        Equal { .. } if number == preset => Count(GreaterOrEqual { wide }, number),
        NotEqual { .. } if number == preset => Count(Less { wide }, number),
        _ => Count(operator.in_width(wide), number),
    }
}

/// The same the other way round: whether a comparison of a count that goes on is that of one that stops.
pub(super) fn is_alike(operator: CompareOperator, number: i64, preset: i64) -> bool {
    stopping(operator, number, preset) == Reached::Count(operator.in_width(false), number)
}

/// `a < b` as `b > a`.
pub(super) fn turned(operator: CompareOperator) -> CompareOperator {
    use CompareOperator::{Greater, GreaterOrEqual, Less, LessOrEqual};
    match operator {
        GreaterOrEqual { wide } => LessOrEqual { wide },
        LessOrEqual { wide } => GreaterOrEqual { wide },
        Greater { wide } => Less { wide },
        Less { wide } => Greater { wide },
        same => same,
    }
}

/// How a program of IEC 61131-3 calls the instances of function blocks, by their folded names.
#[derive(Default, Debug)]
pub(super) struct Instances {
    uses: FxHashMap<SmolStr, Instance>,
}

/// How an instance is called.
#[derive(Default, Debug)]
struct Instance {
    /// Calls but those of resets alone.
    calls: u32,
    /// The constant preset of a counter.
    preset: Option<i64>,
    /// Whether one of them is done in each scan, before what stands behind it.
    is_sure: bool,
    /// Whether a reset alone may be the first call, when the preset is 0.
    may_begin_reset: bool,
    /// Whether a call may be left out, or done again.
    is_guarded: bool,
}

impl Instances {
    /// Those of all rungs of a program.
    pub fn of(document: &Document, sources: &[Source]) -> Instances {
        let mut instances = Instances::default();
        let guarded = guarded::are(sources);
        let mut unit = None;
        // Whether each rung of the unit so far is executed in each scan.
        let mut is_straight = true;
        for (source, is_guarded) in sources.iter().zip(guarded) {
            if unit.replace(source.pou) != Some(source.pou) {
                is_straight = true;
            }
            is_straight &= !is_guarded && source.rung.labels.is_empty() && source.rung.path.is_ok();
            for action in source.path().map(Path::actions).unwrap_or_default() {
                if let (Deed::Call(call), Some(instance)) = (&action.deed, action.terms.first()) {
                    let own = instances.uses.entry(folded(&instance.text)).or_default();
                    own.is_guarded |= is_guarded;
                    match call.is_input_operator() && call.power_in() == "R" {
                        true => {
                            let is_known = own.is_sure || has_preset(document, source.pou, instance);
                            own.may_begin_reset |= !is_known;
                        }
                        false => own.call(call, action, is_straight),
                    }
                }
            }
        }
        instances
    }

    /// Whether an instance is called in one place, and in each scan if `always`.
    pub fn is_called_once(&self, instance: &str, always: bool) -> bool {
        let own = self.uses.get(&folded(instance));
        own.is_some_and(|own| own.calls == 1 && !(always && own.is_guarded))
    }

    /// Whether a call of an instance may be left out, or done again.
    pub fn may_be_left_out(&self, instance: &str) -> bool {
        self.uses.get(&folded(instance)).is_some_and(|own| own.is_guarded)
    }

    /// Whether an instance is called at all.
    pub fn is_called(&self, instance: &str) -> bool {
        self.uses.contains_key(&folded(instance))
    }

    /// Whether one call or none has an instance.
    pub fn one(&self, instance: &str) -> Result<(), Lack> {
        match self.uses.get(&folded(instance)) {
            Some(own) if own.calls > 1 => Err(Lack::Reason("translate.several-calls", instance.into())),
            _ => Ok(()),
        }
    }

    /// The constant preset of the counter that an instance is.
    pub fn preset(&self, instance: &str) -> Result<i64, Lack> {
        let reason = |key| Err(Lack::Reason(key, instance.into()));
        self.one(instance)?;
        match self.uses.get(&folded(instance)) {
            Some(own) if own.may_begin_reset => reason("translate.reset-first"),
            Some(Instance { preset: Some(preset), .. }) => Ok(*preset),
            _ => reason("translate.preset"),
        }
    }
}

impl Instance {
    fn call(&mut self, call: &Call, action: &Action, is_straight: bool) {
        self.calls += 1;
        self.preset = match &call.arguments(&action.terms)[..] {
            [one] if one.name == "PV" => constant(&one.term).filter(|preset| *preset > 0),
            _ => None,
        };
        self.is_sure |= is_straight;
    }
}

/// The whole number that a literal is.
pub(super) fn constant(term: &Term) -> Option<i64> {
    match term.operand {
        Operand::Literal(literal) => match literal.value {
            LiteralValue::Integer(value) => i64::try_from(value).ok(),
            _ => None,
        },
        _ => None,
    }
}

fn has_preset(document: &Document, unit: Option<usize>, instance: &Term) -> bool {
    document.scopes().variable(unit, &instance.text).is_some_and(declares_preset)
}

/// Whether the declaration of a counter gives it a preset above 0 and nothing else.
pub(super) fn declares_preset(variable: &Variable) -> bool {
    let words: Vec<&str> = variable.words.split(' ').collect();
    match &words[..] {
        [.., "ctu", ":=", "(", "pv", ":=", preset, ")"] => {
            preset.parse::<i16>().is_ok_and(|preset| preset > 0)
        }
        _ => false,
    }
}
