//! Comparison with three relays as the answer: CMP, ZCP.

use super::specs::{applied, bits_out, source};
use crate::target::{Execution, Fault, Instruction, OperandSpec};

const ANSWER: OperandSpec = bits_out("D", "first of three relays for the answer").covering(3);

/// CMP ZCP.
pub const ROWS: &[Instruction] = &[
    applied(
        10,
        "CMP",
        "compare",
        &[source("S1", "compared value"), source("S2", "value compared with it"), ANSWER],
        "Compares two signed numbers and switches on one of three relays in a row: the first if S1 is \
         greater than S2, the second if they are equal, the third if S1 is less. It is executed in \
         each scan in which the result is on; when the result goes off, the relays keep their last \
         state, so reset them with ZRST where that matters.\n\n\
         ```il\n\
         LD X0\n\
         CMP K100 D0 M0\n\
         LD M0\n\
         OUT Y0\n\
         LD M1\n\
         OUT Y1\n\
         LD M2\n\
         OUT Y2\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .doing(compare),
    applied(
        11,
        "ZCP",
        "compare with a zone",
        &[source("S1", "lower limit"), source("S2", "upper limit"), source("S", "compared value"), ANSWER],
        "Compares a signed number with a zone and switches on one of three relays in a row: the first \
         if it lies below S1, the second if it lies from S1 to S2, the third if it lies above S2. If \
         S1 is greater than S2, S2 counts as equal to it. When the result goes off, the relays keep \
         their last state.\n\n\
         ```il\n\
         LD X0\n\
         ZCP K20 K80 D0 M3\n\
         LD M3\n\
         OUT Y0\n\
         LD M4\n\
         OUT Y1\n\
         LD M5\n\
         OUT Y2\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .doing(compare_zone),
];

fn compare(execution: &mut dyn Execution) -> Result<(), Fault> {
    let ordering = execution.value(0)?.cmp(&execution.value(1)?);
    execution.answer(2, ordering)
}

fn compare_zone(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (lower, upper, value) = (execution.value(0)?, execution.value(1)?, execution.value(2)?);
    let upper = upper.max(lower);
    execution.set_relays(3, &[value < lower, (lower..=upper).contains(&value), value > upper])
}
