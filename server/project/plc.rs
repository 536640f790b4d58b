//! What a project says of the parameters of its PLC: `[plc]` in `rungwise.toml`.

use crate::machine_code::ParameterBlock;
use crate::target::{Device, Latch, Latches, Model, Operand};
use crate::text::Message;
use serde::Deserialize;
use toml::Spanned;

/// What a download writes into the parameters. What is left out stays as it is in the PLC.
#[derive(Clone, PartialEq, Eq, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PlcSettings {
    /// At most 32 characters of ASCII.
    pub title: Option<Spanned<String>>,
    /// Which devices keep their values without power, as `M500-M1023`: at most one range each of M, S, D, counters of
    /// 16 and counters of 32 bits; FX2N only.
    pub latch: Vec<Spanned<String>>,
}

impl PlcSettings {
    /// Whether nothing is said.
    pub fn is_empty(&self) -> bool {
        self.title.is_none() && self.latch.is_empty()
    }

    /// The parameters with what the project says of them.
    pub fn applied(&self, block: ParameterBlock, model: Model) -> ParameterBlock {
        let titled = self.title.as_ref().and_then(|title| block.with_title(title.get_ref()));
        let ranges = self.latch.iter().filter(|_| model == Model::Fx2n);
        ranges.filter_map(|words| range(words.get_ref())).fold(titled.unwrap_or(block), |block, range| {
            let (latch, first, last) = range;
            block.with_latched(latch, first, last).unwrap_or(block)
        })
    }

    /// Which devices keep their values without power in a PLC of this project.
    pub fn latches(&self) -> Latches {
        let ranges = self.latch.iter().filter_map(|words| range(words.get_ref()));
        ranges.fold(Latches::default(), |latches, (latch, first, last)| latches.with(latch, first, last))
    }

    /// What is wrong, and where, of a project for this model.
    pub(super) fn problem(&self, model: Option<Model>) -> Option<(Message, std::ops::Range<usize>)> {
        let unfit =
            |title: &&Spanned<String>| ParameterBlock::new(Model::Fx2n).with_title(title.get_ref()).is_none();
        if let Some(title) = self.title.as_ref().filter(unfit) {
            return Some((Message::new("manifest.title"), title.span()));
        }
        let mut known = Vec::new();
        for words in &self.latch {
            let wrong = |key| Some((Message::new(key).with("word", words.get_ref()), words.span()));
            if model.is_some_and(|model| model != Model::Fx2n) {
                return wrong("manifest.latch-model");
            }
            match range(words.get_ref()) {
                None => return wrong("manifest.latch"),
                Some((latch, ..)) if known.contains(&latch) => return wrong("manifest.latch-twice"),
                Some((latch, ..)) => known.push(latch),
            }
        }
        None
    }
}

/// The range that words such as `M500-M1023` name.
fn range(words: &str) -> Option<(Latch, Device, Device)> {
    let (first, last) = words.split_once('-')?;
    let device = |name: &str| match Operand::read(name.trim(), Model::Fx2n) {
        Operand::Device(device) => Some(device),
        _ => None,
    };
    let (first, last) = (device(first)?, device(last)?);
    let latch =
        Latch::of(first).filter(|own| Latch::of(last) == Some(*own) && first.number <= last.number)?;
    Some((latch, first, last))
}
