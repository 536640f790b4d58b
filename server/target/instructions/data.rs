//! Working on data: FNC 40 to 49.

use super::specs::{FX2N_UP, applied, bits_out, count, destination, operand, source};
use crate::target::{Accepts, Access, Drive, Extent, Instruction};

/// What can be reset as a range.
const RESETTABLE: Accepts =
    Accepts::Y.or(Accepts::M).or(Accepts::S).or(Accepts::T).or(Accepts::C).or(Accepts::D).or(Accepts::R);

/// The word devices T C D R V Z, without groups of bits.
const REGISTERS: Accepts =
    Accepts::T.or(Accepts::C).or(Accepts::D).or(Accepts::R).or(Accepts::V).or(Accepts::Z);

/// Single relays.
const RELAYS: Accepts = Accepts::X.or(Accepts::Y).or(Accepts::M).or(Accepts::S);

/// ZRST DECO ENCO SUM BON MEAN ANS ANR SQR FLT.
pub const ROWS: &[Instruction] = &[
    applied(
        40,
        "ZRST",
        "reset a range",
        &[
            operand("D1", "first device", Access::Write, RESETTABLE)
                .reaching(Extent::Through(1))
                .driven(Drive::Reset),
            operand("D2", "last device", Access::Write, RESETTABLE).driven(Drive::Reset),
        ],
        "Resets all devices from D1 to D2: relays and states go off, registers become 0, timers and \
         counters lose value and contact. Both must be of the same kind and D1 must not be above D2, \
         or only D1 is reset. 32-bit counters cannot be mixed with the others.\n\n\
         ```il\n\
         LD M8002\n\
         ZRST M0 M99\n\
         ZRST D0 D9\n\
         END\n\
         ```\n",
    )
    .pulse(),
    applied(
        41,
        "DECO",
        "decode",
        &[
            source("S", "number").accepting(RELAYS.or(REGISTERS).or(Accepts::K)),
            operand("D", "first device of the row", Access::Write, RESETTABLE).reaching(Extent::Onwards),
            count("n", "number of bits that are read", (1, 8)),
        ],
        "Switches on one of 2 to the power of n bits: the one whose place, counted from 0, is the \
         number in the lowest n bits of S, or in n relays from S on; all others go off. With a relay \
         as destination, n of 8 takes 256 relays, so keep the row free; with a word as destination n \
         is at most 4. When the result goes off, the last state stays.\n\n\
         ```il\n\
         LD X0\n\
         DECO D0 M0 K3\n\
         LD M5\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .pulse(),
    applied(
        42,
        "ENCO",
        "encode",
        &[
            source("S", "first device of the row").accepting(RELAYS.or(REGISTERS)).reaching(Extent::Onwards),
            destination("D", "place of the highest bit that is on").accepting(REGISTERS),
            count("n", "number of bits that are written", (1, 8)),
        ],
        "Writes to D the place, counted from 0, of the highest bit that is on among 2 to the power of \
         n bits from S on. If none is on, it is an execution error and D keeps its value. With a word \
         as source, n is at most 4.\n\n\
         ```il\n\
         LD X0\n\
         ENCO M0 D0 K3\n\
         END\n\
         ```\n",
    )
    .pulse(),
    applied(
        43,
        "SUM",
        "count bits that are on",
        &[source("S", "word"), destination("D", "number of bits that are on")],
        "Counts how many bits of a word are on, for instance how many of sixteen sensors see \
         something. If none is on, the zero flag M8020 goes on.\n\n\
         ```il\n\
         LD X0\n\
         SUM K4X0 D0\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP),
    applied(
        44,
        "BON",
        "test a bit",
        &[
            source("S", "word"),
            bits_out("D", "relay for the answer"),
            count("n", "bit, 0 is the lowest", (0, 15)).within_wide(0, 31).or_register(),
        ],
        "Copies one bit of a word to a relay. Bit 15 is the sign, so BON tells whether a number is \
         negative. When the result goes off, the relay keeps its state.\n\n\
         ```il\n\
         LD M8000\n\
         BON D0 M0 K15\n\
         LD M0\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP),
    applied(
        45,
        "MEAN",
        "mean value",
        &[
            source("S", "first value")
                .accepting(Accepts::WORD_SOURCE.without(Accepts::K.or(Accepts::V).or(Accepts::Z)))
                .counted_by(2),
            destination("D", "mean value"),
            count("n", "number of values", (1, 64)).or_register(),
        ],
        "Writes the mean of n words from S on to D; the fraction is dropped. Together with a shift of \
         words it smooths the values of an analog input.\n\n\
         ```il\n\
         LD M8013\n\
         MEAN D10 D0 K8\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP),
    applied(
        46,
        "ANS",
        "set an annunciator",
        &[
            operand("S", "timer", Access::Write, Accepts::T),
            source("m", "time in 100 ms")
                .accepting(Accepts::K.or(Accepts::D).or(Accepts::R))
                .within(1, 32767),
            operand("D", "annunciator", Access::Write, Accepts::S),
        ],
        "Switches an annunciator, one of the states S900 to S999, on when the result has been on for \
         longer than m times 100 ms, and leaves it on. The timer is one of T0 to T199 and goes back \
         when the result goes off. While M8049 is on, M8048 shows that an annunciator is on and D8049 \
         has the lowest one. ANR switches them off again.\n\n\
         ```il\n\
         LD M8000\n\
         OUT M8049\n\
         LD Y0\n\
         ANI X0\n\
         ANS T0 K10 S900\n\
         LD X1\n\
         OUT Y0\n\
         LD X2\n\
         ANRP\n\
         LD M8048\n\
         OUT Y1\n\
         END\n\
         ```\n",
    )
    .on(FX2N_UP),
    applied(
        47,
        "ANR",
        "reset an annunciator",
        &[],
        "Switches off the annunciator that is on and has the lowest number; each execution takes the \
         next one, so use ANRP with a button. It takes no operands.\n\n\
         ```il\n\
         LD Y0\n\
         ANI X0\n\
         ANS T0 K10 S900\n\
         LD X1\n\
         OUT Y0\n\
         LD X2\n\
         ANRP\n\
         LD S900\n\
         OUT Y1\n\
         END\n\
         ```\n",
    )
    .pulse()
    .on(FX2N_UP),
    applied(
        48,
        "SQR",
        "square root",
        &[
            source("S", "value")
                .accepting(Accepts::K.or(Accepts::D).or(Accepts::R))
                .within(0, 32767)
                .within_wide(0, 2147483647),
            destination("D", "root").accepting(Accepts::D.or(Accepts::R)),
        ],
        "Writes the square root of a whole number, with the fraction dropped; M8021 goes on if \
         something was dropped, M8020 if the root is 0. A negative number is an execution error.\n\n\
         ```il\n\
         LD X0\n\
         SQR D0 D1\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP),
    applied(
        49,
        "FLT",
        "convert to a real number",
        &[
            source("S", "whole number").accepting(Accepts::D.or(Accepts::R)),
            destination("D", "first of two words for the real number")
                .accepting(Accepts::D.or(Accepts::R))
                .covering(2),
        ],
        "Converts a whole number to a real number of 32 bits, which takes two registers also in the \
         16-bit form. Constants need no conversion: real arithmetic such as DEADD converts them \
         itself. The way back is INT.\n\n\
         ```il\n\
         LD X0\n\
         FLT D0 D2\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP),
];
