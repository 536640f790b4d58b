//! Short ways to write rows: what most operands and most applied instructions have in common.
//!
//! A row is a `const`, so everything here is a `const fn`. The shapes that the manuals repeat have a name
//! (`source`, `destination`, `bits`, `count`); a place that differs says so with `.accepting`, `.within`, `.covering`.
//!
//! ```
//! use rungwise::target::{Instruction, instructions::specs::*};
//! const ROWS: &[Instruction] = &[applied(
//!     12,
//!     "MOV",
//!     "move",
//!     &[source("S", "value to copy"), destination("D", "where it goes")],
//!     "Copies a value.\n\n```il\nLD X0\nMOV K100 D0\nEND\n```\n",
//! )
//! .wide()
//! .pulse()];
//! assert_eq!(ROWS[0].operands.len(), 2);
//! ```

use crate::target::semantics::{Deed, Execution, Fault, Semantics};
use crate::target::{
    Accepts, Access, Drive, Extent, Instruction, Model, Opcode, OperandSpec, Role, Steps, Wide,
};

/// Every model of the family.
pub const ALL_FX: &[Model] = &[Model::Fx1s, Model::Fx1n, Model::Fx2n, Model::Fx3u];
/// Without the compact FX1S.
pub const FX1N_UP: &[Model] = &[Model::Fx1n, Model::Fx2n, Model::Fx3u];
/// The full instruction set.
pub const FX2N_UP: &[Model] = &[Model::Fx2n, Model::Fx3u];
/// Only the third generation.
pub const FX3U_ONLY: &[Model] = &[Model::Fx3u];

/// An operand with everything said.
pub const fn operand(
    name: &'static str,
    meaning: &'static str,
    access: Access,
    accepts: Accepts,
) -> OperandSpec {
    OperandSpec {
        name,
        meaning,
        access,
        accepts,
        range: None,
        wide_range: None,
        count: 1,
        extent: Extent::Fixed,
        drive: Drive::Value,
        optional: false,
    }
}

/// A value that is read: any word, bits as a word (`K4M0`), a constant.
pub const fn source(name: &'static str, meaning: &'static str) -> OperandSpec {
    operand(name, meaning, Access::Read, Accepts::WORD_SOURCE)
}

/// A word that is written: KnY KnM KnS T C D R V Z.
pub const fn destination(name: &'static str, meaning: &'static str) -> OperandSpec {
    operand(name, meaning, Access::Write, Accepts::WORD_DESTINATION)
}

/// A word that is read and written back, as by INC and XCH.
pub const fn changed(name: &'static str, meaning: &'static str) -> OperandSpec {
    operand(name, meaning, Access::ReadWrite, Accepts::WORD_DESTINATION)
}

/// Bit devices that are read: X Y M S.
pub const fn bits(name: &'static str, meaning: &'static str) -> OperandSpec {
    operand(name, meaning, Access::Read, Accepts::BIT_SOURCE)
}

/// Bit devices that are written: Y M S.
pub const fn bits_out(name: &'static str, meaning: &'static str) -> OperandSpec {
    operand(name, meaning, Access::Write, Accepts::BIT_DESTINATION)
}

/// A number of things: a constant from `least` to `most`, or a register where `.or_register()` is added.
pub const fn count(name: &'static str, meaning: &'static str, (least, most): (i64, i64)) -> OperandSpec {
    operand(name, meaning, Access::Read, Accepts::K).within(least, most)
}

impl OperandSpec {
    /// Takes exactly `accepts` instead.
    pub const fn accepting(self, accepts: Accepts) -> OperandSpec {
        OperandSpec { accepts, ..self }
    }

    /// Takes `accepts` as well.
    pub const fn also(self, accepts: Accepts) -> OperandSpec {
        OperandSpec { accepts: self.accepts.or(accepts), ..self }
    }

    /// Does not take `accepts`.
    pub const fn except(self, accepts: Accepts) -> OperandSpec {
        OperandSpec { accepts: self.accepts.without(accepts), ..self }
    }

    /// Takes D and R as well.
    pub const fn or_register(self) -> OperandSpec {
        self.also(Accepts::D.or(Accepts::R))
    }

    /// A constant here lies in `least..=most`.
    pub const fn within(self, least: i64, most: i64) -> OperandSpec {
        OperandSpec { range: Some((least, most)), ..self }
    }

    /// A constant in the 32-bit form lies in `least..=most`, where that differs.
    pub const fn within_wide(self, least: i64, most: i64) -> OperandSpec {
        OperandSpec { wide_range: Some((least, most)), ..self }
    }

    /// Covers `count` consecutive devices.
    pub const fn covering(self, count: u8) -> OperandSpec {
        OperandSpec { count, ..self }
    }

    /// Reaches as far as `extent` says.
    pub const fn reaching(self, extent: Extent) -> OperandSpec {
        OperandSpec { extent, ..self }
    }

    /// So many times its count as the operand at `place` says, from 0.
    pub const fn counted_by(self, place: u8) -> OperandSpec {
        self.reaching(Extent::Counted(place))
    }

    /// Is written in this way.
    pub const fn driven(self, drive: Drive) -> OperandSpec {
        OperandSpec { drive, ..self }
    }

    /// Reads and writes it.
    pub const fn read_and_written(self) -> OperandSpec {
        OperandSpec { access: Access::ReadWrite, ..self }
    }

    /// May be left out.
    pub const fn left_out(self) -> OperandSpec {
        OperandSpec { optional: true, ..self }
    }
}

/// An applied instruction, driven by contacts, 16 bit, executed each scan, on every model, unless the calls
/// that follow say otherwise.
pub const fn applied(
    function: u16,
    mnemonic: &'static str,
    title: &'static str,
    operands: &'static [OperandSpec],
    page: &'static str,
) -> Instruction {
    Instruction {
        mnemonic,
        title,
        role: Role::Output,
        wide: Wide::No,
        pulse: false,
        operands,
        steps: Steps::ByOperands,
        opcode: Opcode::Function(function),
        semantics: Semantics::Basic,
        models: ALL_FX,
        page,
    }
}

/// A basic instruction without operands: one word, one step.
pub const fn plain(
    word: u16,
    mnemonic: &'static str,
    title: &'static str,
    role: Role,
    page: &'static str,
) -> Instruction {
    Instruction {
        mnemonic,
        title,
        role,
        wide: Wide::No,
        pulse: false,
        operands: &[],
        steps: Steps::Fixed(1),
        opcode: Opcode::Word(word),
        semantics: Semantics::Basic,
        models: ALL_FX,
        page,
    }
}

impl Instruction {
    /// Has a 32-bit form with `D`.
    pub const fn wide(self) -> Instruction {
        Instruction { wide: Wide::Yes, ..self }
    }

    /// Has only the 32-bit form.
    pub const fn wide_only(self) -> Instruction {
        Instruction { wide: Wide::Only, ..self }
    }

    /// Has a pulse form with `P`.
    pub const fn pulse(self) -> Instruction {
        Instruction { pulse: true, ..self }
    }

    /// Exists on `models` only.
    pub const fn on(self, models: &'static [Model]) -> Instruction {
        Instruction { models, ..self }
    }

    /// Does something else to the current result than an output.
    pub const fn role(self, role: Role) -> Instruction {
        Instruction { role, ..self }
    }

    /// Takes this many steps, whatever its operands.
    pub const fn taking(self, steps: u8) -> Instruction {
        Instruction { steps: Steps::Fixed(steps), ..self }
    }

    /// Conducts while this holds.
    pub const fn testing(self, holds: fn(&mut dyn Execution) -> Result<bool, Fault>) -> Instruction {
        Instruction { semantics: Semantics::Test(holds), ..self }
    }

    /// Does this in each scan in which it has power; the pulse form when power arrives.
    pub const fn doing(self, deed: Deed) -> Instruction {
        Instruction { semantics: Semantics::Powered(deed), ..self }
    }

    /// Does this in each scan, with power and without.
    pub const fn always(self, deed: Deed) -> Instruction {
        Instruction { semantics: Semantics::Always(deed), ..self }
    }

    /// Is coded like this.
    pub const fn coded(self, opcode: Opcode) -> Instruction {
        Instruction { opcode, ..self }
    }
}
