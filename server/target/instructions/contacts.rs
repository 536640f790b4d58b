//! Contacts: LD, AND, OR and their kin.

use super::specs::{ALL_FX, operand};
use crate::target::{Accepts, Access, Instruction, Opcode, OperandSpec, Role, Semantics, Steps, Wide};

const CONTACT: &[OperandSpec] = &[operand("S", "bit device", Access::Read, Accepts::CONTACT)];

/// A contact that is coded in one word where its device fits.
const fn contact(
    class: u8,
    extended: u16,
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
        operands: CONTACT,
        steps: Steps::ByDevice,
        opcode: Opcode::Contact { class, extended },
        semantics: Semantics::Basic,
        models: ALL_FX,
        page,
    }
}

/// A contact that conducts for one scan at an edge; always two words.
const fn edge(
    code: u16,
    mnemonic: &'static str,
    title: &'static str,
    role: Role,
    page: &'static str,
) -> Instruction {
    contact(0, 0, mnemonic, title, role, page).coded(Opcode::Device(code))
}

/// LD LDI LDP LDF AND ANI ANDP ANDF OR ORI ORP ORF.
pub const ROWS: &[Instruction] = &[
    contact(
        2,
        0x01C2,
        "LD",
        "load",
        Role::Load,
        "Begins a rung, or a block inside a rung, with a normally open contact: the result is on \
         while the device is on. For a timer or a counter this reads the contact, not the current \
         value. A second LD before an output starts a new block, which ANB or ORB must join to the \
         one before; at most eight blocks may wait.\n\n\
         ```il\n\
         LD X0\n\
         OUT Y0\n\
         END\n\
         ```\n",
    ),
    contact(
        3,
        0x01C3,
        "LDI",
        "load inverse",
        Role::Load,
        "Begins a rung or a block with a normally closed contact: the result is on while the device \
         is off. Stop buttons and limit switches are wired so that a broken wire stops the machine, \
         so in the program they appear as LD, not as LDI: the input is on while all is well.\n\n\
         ```il\n\
         LDI X0\n\
         OUT Y0\n\
         END\n\
         ```\n",
    ),
    edge(
        0x01CA,
        "LDP",
        "load rising edge",
        Role::Load,
        "Begins a rung or a block with a contact that is on for a single scan when its device goes \
         from off to on. Use it where something must happen once for each press of a button. The edge \
         is measured from one execution to the next, so inside code that a jump or a subroutine skips \
         it can be missed or come late.\n\n\
         ```il\n\
         LDP X0\n\
         SET Y0\n\
         LD X1\n\
         RST Y0\n\
         END\n\
         ```\n",
    ),
    edge(
        0x01CB,
        "LDF",
        "load falling edge",
        Role::Load,
        "Begins a rung or a block with a contact that is on for a single scan when its device goes \
         from on to off, for instance when a button is released or a part has left a sensor.\n\n\
         ```il\n\
         LDF X0\n\
         SET Y0\n\
         LD X1\n\
         RST Y0\n\
         END\n\
         ```\n",
    ),
    contact(
        4,
        0x01C4,
        "AND",
        "contact in series",
        Role::Series,
        "Puts a normally open contact in series: the result stays on only while this device is on as \
         well. Any number of them may follow each other, though the maker's drawing tool shows eleven \
         contacts in a line.\n\n\
         ```il\n\
         LD X0\n\
         AND X1\n\
         OUT Y0\n\
         END\n\
         ```\n",
    ),
    contact(
        5,
        0x01C5,
        "ANI",
        "inverse contact in series",
        Role::Series,
        "Puts a normally closed contact in series: the result stays on only while this device is off. \
         This is the usual way to interlock two outputs that must never be on together, such as \
         forward and reverse.\n\n\
         ```il\n\
         LD X0\n\
         ANI Y1\n\
         OUT Y0\n\
         LD X1\n\
         ANI Y0\n\
         OUT Y1\n\
         END\n\
         ```\n",
    ),
    edge(
        0x01CC,
        "ANDP",
        "rising edge in series",
        Role::Series,
        "Puts a contact in series that is on for one scan when its device goes from off to on. The \
         edge is seen even while the contacts before it are off; it then passes without effect and is \
         not remembered.\n\n\
         ```il\n\
         LD X0\n\
         ANDP X1\n\
         SET Y0\n\
         LD X2\n\
         RST Y0\n\
         END\n\
         ```\n",
    ),
    edge(
        0x01CD,
        "ANDF",
        "falling edge in series",
        Role::Series,
        "Puts a contact in series that is on for one scan when its device goes from on to off. As \
         with ANDP, an edge that comes while the contacts before it are off is lost.\n\n\
         ```il\n\
         LD X0\n\
         ANDF X1\n\
         SET Y0\n\
         LD X2\n\
         RST Y0\n\
         END\n\
         ```\n",
    ),
    contact(
        6,
        0x01C6,
        "OR",
        "contact in parallel",
        Role::Parallel,
        "Puts a normally open contact in parallel with everything since the last LD: the result is on \
         if it was on or if this device is on. With the output's own contact it makes a seal-in \
         circuit. To put more than one contact into the parallel branch, begin the branch with LD and \
         join it with ORB.\n\n\
         ```il\n\
         LD X0\n\
         OR Y0\n\
         AND X1\n\
         OUT Y0\n\
         END\n\
         ```\n",
    ),
    contact(
        7,
        0x01C7,
        "ORI",
        "inverse contact in parallel",
        Role::Parallel,
        "Puts a normally closed contact in parallel with everything since the last LD: the result is \
         on if it was on or if this device is off.\n\n\
         ```il\n\
         LD X0\n\
         ORI X1\n\
         OUT Y0\n\
         END\n\
         ```\n",
    ),
    edge(
        0x01CE,
        "ORP",
        "rising edge in parallel",
        Role::Parallel,
        "Puts a contact in parallel that is on for one scan when its device goes from off to on, so \
         that one of several buttons can start the same action once.\n\n\
         ```il\n\
         LDP X0\n\
         ORP X1\n\
         SET Y0\n\
         LD X2\n\
         RST Y0\n\
         END\n\
         ```\n",
    ),
    edge(
        0x01CF,
        "ORF",
        "falling edge in parallel",
        Role::Parallel,
        "Puts a contact in parallel that is on for one scan when its device goes from on to off.\n\n\
         ```il\n\
         LDF X0\n\
         ORF X1\n\
         SET Y0\n\
         LD X2\n\
         RST Y0\n\
         END\n\
         ```\n",
    ),
];
