//! FNC 70–79: keys, switches, displays and special modules. Most multiplex inputs and outputs over several scans.

mod keys;

mod displays;

mod modules;

use super::specs::{FX1N_UP, FX2N_UP, applied, bits, bits_out, changed, count, destination, operand, source};
use crate::target::{Accepts, Access, Extent, Instruction};

const STORED: Accepts = Accepts::T.or(Accepts::C).or(Accepts::D).or(Accepts::R);
const STORED_OR_INDEX: Accepts = STORED.or(Accepts::V).or(Accepts::Z);

/// TKY HKY DSW SEGD SEGL ARWS ASC PR FROM TO.
pub const ROWS: &[Instruction] = &[
    applied(
        70,
        "TKY",
        "ten keys",
        &[
            bits("S", "first of 10 keys, 0 to 9").covering(10),
            destination("D1", "number typed in"),
            bits_out("D2", "first of 10 key flags and one for any key").covering(11),
        ],
        "Takes a decimal number from ten keys wired to ten inputs. Each press shifts its digit into \
         `D1` from the right; after four digits (eight with `DTKY`) the leftmost is lost. The flags \
         from `D2` on show which key is held, and the eleventh that any is. If two are pressed the \
         first one counts. With the drive off the flags go off and the number stays. It must run in \
         every scan, and there is no key to clear: move 0 into `D1` for that.\n\n\
         ```il\n\
         LD X20\n\
         TKY X0 D0 M0\n\
         LD M10\n\
         OUT Y0\n\
         LD X21\n\
         MOV K0 D0\n\
         END\n\
         ```\n",
    )
    .always(keys::ten_keys)
    .wide()
    .on(FX2N_UP),
    applied(
        71,
        "HKY",
        "sixteen keys",
        &[
            operand("S", "first of 4 column inputs", Access::Read, Accepts::X).covering(4),
            operand("D1", "first of 4 row outputs", Access::Write, Accepts::Y).covering(4),
            destination("D2", "number typed in").accepting(STORED_OR_INDEX),
            bits_out("D3", "first of 8 flags: A to F, any of them, any digit").covering(8),
        ],
        "Takes numbers and six function keys from a keypad of 4 × 4 keys, scanned by four transistor \
         outputs. Digits shift into `D2` from the right (0 to 9999, with `DHKY` to 99,999,999); the keys A \
         to F switch the first six flags from `D3` on, the seventh is on while one of them is held, the \
         eighth while a digit is. One round takes eight scans and ends with `M8029`, so a key must be held \
         that long. With `M8167` on all sixteen keys are hexadecimal digits. A program can hold it only \
         once. The flag of a function key stays on until another function key is pressed. In the simulator \
         a scenario presses the key between `Y0` and `X3` by `Y0.X3 = 1`.\n\n\
         ```il\n\
         LD M8000\n\
         HKY X0 Y0 D0 M0\n\
         LD M0\n\
         OUT Y10\n\
         LD M7\n\
         OUT Y11\n\
         END\n\
         ```\n",
    )
    .always(keys::sixteen_keys)
    .wide()
    .on(FX2N_UP),
    applied(
        72,
        "DSW",
        "digital switches",
        &[
            operand("S", "first of 4 inputs (8 for two sets)", Access::Read, Accepts::X).covering(4),
            operand("D1", "first of 4 strobe outputs", Access::Write, Accepts::Y).covering(4),
            destination("D2", "number set, and that of the second set")
                .accepting(STORED_OR_INDEX)
                .counted_by(3),
            count("n", "sets of switches", (1, 2)),
        ],
        "Reads one or two sets of four BCD thumbwheels through four (or eight) inputs and four strobe \
         outputs, and stores the decimal number, 0 to 9999, in `D2` (the second set in the next register). \
         `M8029` comes on after each round of four digits. With transistor outputs drive it all the time; \
         with relay outputs let a button start it and `M8029` stop it, so that the relays do not wear out. \
         The strobes follow one another slowly, and a new setting takes some tenths of a second to arrive. \
         The wheels need a diode in each line. In the simulator a strobe lasts two scans. A digit above 9 \
         is an operation error. A scenario closes the contact of a wheel between `Y10` and `X10` by \
         `Y10.X10 = 1`.\n\n\
         ```il\n\
         LD M8000\n\
         DSW X10 Y10 D0 K1\n\
         LD>= D0 K500\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .always(keys::digital_switches),
    applied(
        73,
        "SEGD",
        "seven-segment decoder",
        &[source("S", "digit in the lower 4 bits"), destination("D", "segments in the lower 8 bits")],
        "Turns the hexadecimal digit in the lower four bits of `S` into the pattern of a seven-segment \
         display: bit 0 of `D` is segment a, bit 6 is segment g, bit 7 stays off. The upper byte of `D` \
         is not changed. The usual destination is `K2Y0`, eight outputs for one digit. Only the lowest \
         digit counts, so a number with more digits must be split first, for instance by `BCD`. A 7 \
         lights segment f as well.\n\n\
         ```il\n\
         LD M8000\n\
         SEGD D0 K2Y0\n\
         LD X0\n\
         INCP D0\n\
         END\n\
         ```\n",
    )
    .doing(displays::seven_segments)
    .pulse()
    .on(FX2N_UP),
    applied(
        74,
        "SEGL",
        "seven-segment display with latch",
        &[
            source("S", "number to show, 0 to 9999"),
            operand("D", "first of 8 outputs (12 for two sets)", Access::Write, Accepts::Y).covering(8),
            count("n", "sets and logic of the signals", (0, 7)),
        ],
        "Shows a number of four digits on a latching BCD display through four data outputs and four \
         strobes (four more data outputs for a second set, whose number is in the register after `S`). \
         `n` from 0 to 3 is for one set, 4 to 7 for two; within each four it says whether data and strobe \
         have the same sense as the outputs. If the display shows nonsense, try the other values. A round \
         takes twelve scans and ends with `M8029`. Numbers above 9999 or below 0 are an operation error. \
         Each digit takes three scans, the units first.\n\n\
         ```il\n\
         LD M8002\n\
         MOV K1234 D0\n\
         LD M8000\n\
         SEGL D0 Y0 K0\n\
         END\n\
         ```\n",
    )
    .always(displays::latched_display),
    applied(
        75,
        "ARWS",
        "arrow switch",
        &[
            bits("S", "first of 4 keys: down, up, right, left").covering(4),
            changed("D1", "number to set, 0 to 9999").accepting(STORED_OR_INDEX),
            operand("D2", "first of 8 display outputs", Access::Write, Accepts::Y).covering(8),
            count("n", "logic of the display, as for SEGL", (0, 3)),
        ],
        "Lets an operator change a number digit by digit with four keys while a latching display shows \
         it. When the drive comes on the thousands are chosen; the right and left keys move to another \
         digit, and the up and down keys change it. The strobe outputs show which digit is chosen. It \
         needs transistor outputs and a scan that is not too short, and a program can hold it only once. \
         The number in `D1` changes at once with each press: copy it when a confirming key is pressed. \
         The simulator sends only the chosen digit, whose strobe stays on.\n\n\
         ```il\n\
         LD M8000\n\
         ARWS X10 D0 Y0 K0\n\
         LD X14\n\
         MOVP D0 D200\n\
         END\n\
         ```\n",
    )
    .always(keys::arrow_switch)
    .on(FX2N_UP),
    applied(
        76,
        "ASC",
        "characters to ASCII",
        &[
            operand("S", "eight characters", Access::Read, Accepts::TEXT),
            operand("D", "first of 4 words, or of 8", Access::Write, STORED).reaching(Extent::Onwards),
        ],
        "Stores a text of eight characters as ASCII codes in four words, two in each: the first character \
         in the low byte, the second in the high byte. With `M8161` on each takes a word of its own, \
         eight words in all. The text is a constant of the program; letters and digits are safe, blanks \
         are not. Executing it in every scan is harmless, but once is enough. It takes 11 steps. A \
         shorter text is filled up with blanks.\n\n\
         ```il\n\
         LD M8002\n\
         ASC \"MOTORRUN\" D100\n\
         LD X0\n\
         MOV D100 D0\n\
         END\n\
         ```\n",
    )
    .doing(displays::characters)
    .taking(11)
    .on(FX2N_UP),
    applied(
        77,
        "PR",
        "print ASCII",
        &[
            operand("S", "first of 4 words of text", Access::Read, STORED).covering(4),
            operand("D", "first of 10 outputs: data, strobe, busy", Access::Write, Accepts::Y).covering(10),
        ],
        "Sends the eight characters at `S`, as stored by `ASC`, one after the other through eight outputs \
         with a strobe in the ninth; the tenth is on while it works. With `M8027` on up to sixteen \
         characters are sent, ended by a zero byte. Each step takes scans, so use a constant scan to suit \
         the receiver. Switching the drive off stops it, and it begins again from the first character. It \
         needs transistor outputs, and a program can hold it at most twice. In the simulator a character \
         takes three scans, and `M8029` comes on at the end.\n\n\
         ```il\n\
         LD M8002\n\
         ASC \"BATCHEND\" D100\n\
         LD X0\n\
         PR D100 Y0\n\
         END\n\
         ```\n",
    )
    .always(displays::print)
    .on(FX2N_UP),
    applied(
        78,
        "FROM",
        "read from a special module",
        &[
            count("m1", "module number from the CPU on", (0, 7)).or_register(),
            count("m2", "first buffer memory number", (0, 32_767)).or_register(),
            destination("D", "first word of the destination").counted_by(3),
            count("n", "words to read", (1, 32_767)).or_register(),
        ],
        "Reads `n` words from the buffer memory of the special module `m1`, from number `m2` on, to `D`. \
         Modules are counted from the CPU outwards beginning with 0; those with only inputs and outputs do \
         not count. `DFROM` reads `n` pairs. It reads in every scan in which it is driven, and each word \
         costs time: read many at once rarely, or the watchdog (`D8000`) trips. If no module answers at \
         this number the CPU reports an error instead of a value. With `M8028` on, interrupts are accepted \
         while words are transferred. In the simulator all eight modules answer, with 0 where nothing is \
         written, until a scenario sets `U0 = 0`; it writes a word by `U0.G5 = 7`.\n\n\
         ```il\n\
         LD M8000\n\
         FROM K0 K5 D0 K4\n\
         LD> D0 K1000\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .doing(modules::read)
    .wide()
    .pulse()
    .on(FX1N_UP),
    applied(
        79,
        "TO",
        "write to a special module",
        &[
            count("m1", "module number from the CPU on", (0, 7)).or_register(),
            count("m2", "first buffer memory number", (0, 32_767)).or_register(),
            source("S", "first word to write").counted_by(3),
            count("n", "words to write", (1, 32_767)).or_register(),
        ],
        "Writes `n` words from `S` on to the buffer memory of the special module `m1`, beginning at number \
         `m2`. `DTO` writes `n` pairs; a constant is written `n` times. It writes in every scan in which \
         it is driven. Settings belong into `TOP` or the first scan: some modules store a number in EEPROM \
         at each write, and that memory wears out. After power-up a module needs a moment before it \
         accepts values, as its manual says. The simulator keeps the words, and `FROM` reads them back; a \
         scenario expects them as `U0.G1`.\n\n\
         ```il\n\
         LD M8002\n\
         TO K0 K1 K4 K1\n\
         LD M8000\n\
         TO K0 K2 D0 K1\n\
         END\n\
         ```\n",
    )
    .doing(modules::write)
    .wide()
    .pulse()
    .on(FX1N_UP),
];
