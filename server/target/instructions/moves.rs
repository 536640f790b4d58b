//! Moving and converting values: FNC 12 to 19.

use super::specs::{FX2N_UP, applied, changed, count, destination, source};
use crate::target::{Accepts, Instruction};

/// Words that blocks are made of; index registers do not stand in a row of memory with others.
const BLOCK: Accepts = Accepts::WORD_DESTINATION.without(Accepts::V.or(Accepts::Z));

/// Words and groups of bits, no constants.
const WORDS: Accepts = Accepts::WORD_SOURCE.without(Accepts::K);

/// MOV SMOV CML BMOV FMOV XCH BCD BIN.
pub const ROWS: &[Instruction] = &[
    applied(
        12,
        "MOV",
        "move",
        &[source("S", "value"), destination("D", "where it goes")],
        "Copies a constant, a word or a group of bits to a word or a group of bits, in each scan in \
         which the result is on. When the result goes off, the destination keeps its value. K4M0 \
         stands for sixteen relays from M0 on; a destination with fewer bits takes the lower ones, \
         one with more is filled with 0. DMOV moves 32 bits, a register and the next one.\n\n\
         ```il\n\
         LD X0\n\
         MOV K100 D0\n\
         LD X1\n\
         MOV D0 K2Y0\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse(),
    applied(
        13,
        "SMOV",
        "move digits",
        &[
            source("S", "source").accepting(WORDS),
            count("m1", "first digit that is moved, 4 is the highest", (1, 4)),
            count("m2", "number of digits", (1, 4)),
            destination("D", "destination"),
            count("n", "place of the first digit in the destination", (1, 4)),
        ],
        "Moves decimal digits from one word into another: m2 digits of the source from digit m1 \
         downwards go to the destination from digit n downwards, and its other digits stay. Digit 1 \
         is the units, digit 4 the thousands. Both words are converted to decimal digits and back, so \
         they must lie between 0 and 9999; while M8168 is on, hexadecimal digits are moved as they \
         are.\n\n\
         ```il\n\
         LD X0\n\
         SMOVP D0 K2 K2 D1 K4\n\
         END\n\
         ```\n",
    )
    .pulse()
    .on(FX2N_UP),
    applied(
        14,
        "CML",
        "move the complement",
        &[source("S", "value"), destination("D", "where the inverted bits go")],
        "Copies a value with every bit turned round, 0 to 1 and 1 to 0, in each scan in which the \
         result is on. It serves where a device reads inputs or drives lamps with inverted logic.\n\n\
         ```il\n\
         LD X0\n\
         CML K2X10 K2Y0\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP),
    applied(
        15,
        "BMOV",
        "move a block",
        &[
            source("S", "first source").accepting(BLOCK.or(Accepts::KNX)).counted_by(2),
            destination("D", "first destination").accepting(BLOCK).counted_by(2),
            count("n", "number of words", (1, 512)).or_register(),
        ],
        "Copies a row of n words to another place, in each scan in which the result is on; areas that \
         overlap are copied correctly. Groups of bits must have the same number of digits on both \
         sides. Watch the end of the area: a block that would run past the last device is an \
         execution error.\n\n\
         ```il\n\
         LD X0\n\
         BMOVP D0 D10 K5\n\
         END\n\
         ```\n",
    )
    .pulse(),
    applied(
        16,
        "FMOV",
        "fill",
        &[
            source("S", "value"),
            destination("D", "first destination").accepting(BLOCK).counted_by(2),
            count("n", "number of words", (1, 512)),
        ],
        "Writes one value to a row of n words, for instance 0 to clear a table. It is executed in \
         each scan in which the result is on, so the pulse form is the usual one.\n\n\
         ```il\n\
         LD M8002\n\
         FMOV K0 D0 K10\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP),
    applied(
        17,
        "XCH",
        "exchange",
        &[changed("D1", "one word"), changed("D2", "the other word")],
        "Exchanges the contents of two words. Use the pulse form: without it they change places again \
         in every scan. While M8160 is on and both operands are the same, it exchanges the two bytes \
         of the word.\n\n\
         ```il\n\
         LD X0\n\
         XCHP D0 D1\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP),
    applied(
        18,
        "BCD",
        "convert to BCD",
        &[source("S", "binary value").accepting(WORDS), destination("D", "decimal digits")],
        "Converts a binary number to four decimal digits of four bits each, as seven-segment displays \
         want them. The number must lie between 0 and 9999, with DBCD between 0 and 99999999; \
         anything else is an execution error. Arithmetic is always binary, so convert only for \
         display.\n\n\
         ```il\n\
         LD X0\n\
         BCD D0 K2Y0\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse(),
    applied(
        19,
        "BIN",
        "convert from BCD",
        &[source("S", "decimal digits").accepting(WORDS), destination("D", "binary value")],
        "Converts decimal digits of four bits each, as thumbwheel switches give them, to a binary \
         number. A digit above 9 is an execution error, which happens for a moment while a switch is \
         turned; a constant cannot be converted, since constants are binary already.\n\n\
         ```il\n\
         LD X0\n\
         BIN K2X10 D0\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse(),
];
