//! FNC 224–246: comparisons that act as contacts.

use super::specs::{applied, source};
use crate::target::{Execution, Fault, Instruction, OperandSpec, Role};

const OPERANDS: &[OperandSpec] = &[source("S1", "first value"), source("S2", "second value")];

const fn compare(
    function: u16,
    mnemonic: &'static str,
    title: &'static str,
    role: Role,
    page: &'static str,
) -> Instruction {
    applied(function, mnemonic, title, OPERANDS, page).wide().role(role).testing(test(function))
}

type Holds = fn(&mut dyn Execution) -> Result<bool, Fault>;

/// The comparison that a function number stands for: the six are in the same order for LD, AND and OR.
const fn test(function: u16) -> Holds {
    match function % 8 {
        0 => |execution| Ok(execution.value(0)? == execution.value(1)?),
        1 => |execution| Ok(execution.value(0)? > execution.value(1)?),
        2 => |execution| Ok(execution.value(0)? < execution.value(1)?),
        4 => |execution| Ok(execution.value(0)? != execution.value(1)?),
        5 => |execution| Ok(execution.value(0)? <= execution.value(1)?),
        _ => |execution| Ok(execution.value(0)? >= execution.value(1)?),
    }
}

/// What the page of each comparison says of its own (where it stands, when it conducts, a trap), then what is true of
/// all of them, then the example.
macro_rules! page {
    ($own:literal, $wide:literal, $example:literal) => {
        concat!(
            $own,
            " Both values are signed: `H8000` to `HFFFF` are negative in the 16-bit form. `",
            $wide,
            "` compares pairs of registers, and only that form can read a 32-bit counter (`C200` and above).",
            "\n\n```il\n",
            $example,
            "\nEND\n```\n"
        )
    };
}

/// LD= … OR>=, in the order of their function numbers.
pub const ROWS: &[Instruction] = &[
    compare(
        224,
        "LD=",
        "load compare equal",
        Role::Load,
        page!(
            "Starts a rung or a block with a contact that conducts while `S1` is equal to `S2`. It is \
             evaluated in every scan. A counted or measured value can jump over the one number that you \
             wait for: prefer `LD>=` for these.",
            "LDD=",
            "LD= D0 K3\nOUT Y0"
        ),
    ),
    compare(
        225,
        "LD>",
        "load compare greater",
        Role::Load,
        page!(
            "Starts a rung or a block with a contact that conducts while `S1` is greater than `S2`. It \
             is evaluated in every scan. A measured value near the limit makes the output flutter: \
             switch off at a lower value than you switch on.",
            "LDD>",
            "LD> D0 K1000\nSET Y0\nLD< D0 K950\nRST Y0"
        ),
    ),
    compare(
        226,
        "LD<",
        "load compare less",
        Role::Load,
        page!(
            "Starts a rung or a block with a contact that conducts while `S1` is less than `S2`. It is \
             evaluated in every scan. A register that nothing has written yet holds 0, so it conducts \
             from the first scan on.",
            "LDD<",
            "LD< D0 K200\nOUT Y0"
        ),
    ),
    compare(
        228,
        "LD<>",
        "load compare not equal",
        Role::Load,
        page!(
            "Starts a rung or a block with a contact that conducts while `S1` and `S2` differ. It is \
             evaluated in every scan. Compare a value with a copy of it from the scan before, and the \
             contact shows each change for one scan.",
            "LDD<>",
            "LD<> D0 D1\nALTP M0\nLD M8000\nMOV D0 D1\nLD M0\nOUT Y0"
        ),
    ),
    compare(
        229,
        "LD<=",
        "load compare less or equal",
        Role::Load,
        page!(
            "Starts a rung or a block with a contact that conducts while `S1` is less than `S2` or \
             equal to it. It is evaluated in every scan. With the current value of a timer it gives a \
             time window without a second timer.",
            "LDD<=",
            "LD X0\nOUT T0 K100\nLD<= T0 K50\nAND X0\nOUT Y0"
        ),
    ),
    compare(
        230,
        "LD>=",
        "load compare greater or equal",
        Role::Load,
        page!(
            "Starts a rung or a block with a contact that conducts while `S1` is greater than `S2` or \
             equal to it. It is evaluated in every scan. It is the safe way to see that a count has \
             been reached, even if the count goes on by more than one.",
            "LDD>=",
            "LD X0\nOUT C0 K100\nLD>= C0 K80\nOUT Y0\nLD X1\nRST C0"
        ),
    ),
    compare(
        232,
        "AND=",
        "and compare equal",
        Role::Series,
        page!(
            "A contact in series that conducts while `S1` is equal to `S2`. It is evaluated in every \
             scan, and passes power only if the contacts before it do. It suits numbers that a program \
             sets itself, such as modes and step numbers.",
            "ANDD=",
            "LD X0\nAND= D0 K2\nOUT Y0"
        ),
    ),
    compare(
        233,
        "AND>",
        "and compare greater",
        Role::Series,
        page!(
            "A contact in series that conducts while `S1` is greater than `S2`. It is evaluated in \
             every scan, and passes power only if the contacts before it do. Leave a gap between \
             switching on and off where a measured value wavers.",
            "ANDD>",
            "LD X0\nAND> D0 K500\nOUT Y0"
        ),
    ),
    compare(
        234,
        "AND<",
        "and compare less",
        Role::Series,
        page!(
            "A contact in series that conducts while `S1` is less than `S2`. It is evaluated in every \
             scan, and passes power only if the contacts before it do. A sensor with a broken wire \
             mostly reads 0 and so counts as *less*: test for that first.",
            "ANDD<",
            "LD> D0 K10\nAND< D0 K200\nOUT Y0"
        ),
    ),
    compare(
        236,
        "AND<>",
        "and compare not equal",
        Role::Series,
        page!(
            "A contact in series that conducts while `S1` and `S2` differ. It is evaluated in every \
             scan, and passes power only if the contacts before it do. Typical is a lock: everything \
             except one mode.",
            "ANDD<>",
            "LD X0\nAND<> D0 K0\nOUT Y0"
        ),
    ),
    compare(
        237,
        "AND<=",
        "and compare less or equal",
        Role::Series,
        page!(
            "A contact in series that conducts while `S1` is less than `S2` or equal to it. It is \
             evaluated in every scan, and passes power only if the contacts before it do. After `LD>=` \
             it makes a window whose two limits belong to it.",
            "ANDD<=",
            "LD>= D0 K100\nAND<= D0 K200\nOUT Y0"
        ),
    ),
    compare(
        238,
        "AND>=",
        "and compare greater or equal",
        Role::Series,
        page!(
            "A contact in series that conducts while `S1` is greater than `S2` or equal to it. It is \
             evaluated in every scan, and passes power only if the contacts before it do. With the \
             current value of a timer it switches a second output later.",
            "ANDD>=",
            "LD X0\nOUT T0 K100\nAND>= T0 K50\nOUT Y0"
        ),
    ),
    compare(
        240,
        "OR=",
        "or compare equal",
        Role::Parallel,
        page!(
            "A contact in parallel to everything since the last load that conducts while `S1` is equal \
             to `S2`. It is evaluated in every scan. Several in a row collect the numbers of the steps \
             in which an output is on.",
            "ORD=",
            "LD= D0 K1\nOR= D0 K4\nOUT Y0"
        ),
    ),
    compare(
        241,
        "OR>",
        "or compare greater",
        Role::Parallel,
        page!(
            "A contact in parallel to everything since the last load that conducts while `S1` is \
             greater than `S2`. It is evaluated in every scan. With `LD<` it signals a value outside of \
             its window; the limits themselves count as inside.",
            "ORD>",
            "LD< D0 K100\nOR> D0 K200\nOUT Y0"
        ),
    ),
    compare(
        242,
        "OR<",
        "or compare less",
        Role::Parallel,
        page!(
            "A contact in parallel to everything since the last load that conducts while `S1` is less \
             than `S2`. It is evaluated in every scan. A register that nothing has written yet holds 0, \
             so an alarm like this is on at start: release it after the first value.",
            "ORD<",
            "LD X0\nOR< D0 K50\nOUT Y0"
        ),
    ),
    compare(
        244,
        "OR<>",
        "or compare not equal",
        Role::Parallel,
        page!(
            "A contact in parallel to everything since the last load that conducts while `S1` and `S2` \
             differ. It is evaluated in every scan. Do not join two of them for *neither A nor B*: a \
             number always differs from one of the two, so that is always on.",
            "ORD<>",
            "LD X0\nOR<> D0 D1\nOUT Y0"
        ),
    ),
    compare(
        245,
        "OR<=",
        "or compare less or equal",
        Role::Parallel,
        page!(
            "A contact in parallel to everything since the last load that conducts while `S1` is less \
             than `S2` or equal to it. It is evaluated in every scan. A series contact after it belongs \
             to the whole block, not to the comparison alone.",
            "ORD<=",
            "LD X0\nOR<= D0 K50\nANI X1\nOUT Y0"
        ),
    ),
    compare(
        246,
        "OR>=",
        "or compare greater or equal",
        Role::Parallel,
        page!(
            "A contact in parallel to everything since the last load that conducts while `S1` is \
             greater than `S2` or equal to it. It is evaluated in every scan. It can end a batch either \
             by the count or by a button.",
            "ORD>=",
            "LD X0\nOR>= C0 K50\nOUT Y0\nLD X1\nOUT C0 K100\nLD X2\nRST C0"
        ),
    ),
];
