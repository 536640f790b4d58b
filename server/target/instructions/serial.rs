//! FNC 80–88: serial communication, ASCII conversion, the trimmers of the CPU, and PID control.

mod characters;

mod pid;

use super::specs::{applied, count, destination, operand, source};
use crate::target::{Accepts, Access, Extent, Instruction};

const REGISTER: Accepts = Accepts::D.or(Accepts::R);
const INDEX: Accepts = Accepts::V.or(Accepts::Z);

/// RS PRUN ASCI HEX CCD VRRD VRSC PID.
pub const ROWS: &[Instruction] = &[
    applied(
        80,
        "RS",
        "serial communication",
        &[
            operand("S", "first word to send", Access::Read, REGISTER).reaching(Extent::Onwards),
            count("m", "bytes to send", (0, 4_096)).or_register(),
            operand("D", "first word received", Access::Write, REGISTER).reaching(Extent::Onwards),
            count("n", "bytes to receive at most", (0, 4_096)).or_register(),
        ],
        "Sends and receives frames of bytes through a serial board or adapter, with the format set in \
         `D8120`. Drive it all the time; it only opens the port. Setting `M8122` sends `m` bytes, and the \
         CPU resets it when they are out. `M8123` comes on when a frame has arrived: fetch the data, then \
         reset `M8123` yourself, because nothing more is received before. With `M8161` on each word \
         carries one byte, otherwise two. Write `D8120` before the first execution; only one `RS` may be \
         active at a time. In the simulator a frame is sent within a scan, and the frames that a scenario \
         hands over (`receive`) wait until they can be received; what is sent can be expected there \
         (`sent`).\n\n\
         ```il\n\
         LD M8002\n\
         MOV H0C81 D8120\n\
         LD M8000\n\
         RS D0 K4 D10 K8\n\
         LDP X0\n\
         SET M8122\n\
         LD M8123\n\
         MOV D10 D20\n\
         RST M8123\n\
         END\n\
         ```\n",
    )
    .doing(characters::communicate),
    applied(
        81,
        "PRUN",
        "parallel run: octal copy",
        &[
            source("S", "bits to copy").accepting(Accepts::KNX.or(Accepts::KNM)),
            destination("D", "where they go").accepting(Accepts::KNY.or(Accepts::KNM)),
        ],
        "Copies bits between octal and decimal numbers, eight by eight: `X0`–`X7` to `M0`–`M7`, \
         `X10`–`X17` to `M10`–`M17`, while `M8` and `M9` stay as they are. In the other direction `M10` \
         goes to `Y10`. That makes an image of the inputs in relays with the same last digits. Begin at \
         numbers that end in 0. It copies in every scan in which it is driven; `MOV K4X0 K4M0` would \
         fill `M8` and `M9` as well and shift the rest.\n\n\
         ```il\n\
         LD M8000\n\
         PRUN K4X0 K4M0\n\
         LD M10\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .doing(characters::copy_octal)
    .wide()
    .pulse(),
    applied(
        82,
        "ASCI",
        "hexadecimal to ASCII",
        &[
            source("S", "first word to convert").reaching(Extent::Onwards),
            destination("D", "first word of the characters").except(INDEX).reaching(Extent::Onwards),
            count("n", "characters", (1, 256)).or_register(),
        ],
        "Writes the last `n` hexadecimal digits of the words from `S` on as ASCII characters to `D`, the \
         highest digit first. With `M8161` off two characters share a word, the first in the low byte; \
         with `M8161` on each has a word of its own. The same relay rules `HEX`, `CCD`, `RS` and `ASC`, \
         so set it directly before the group that needs it, or once for the whole program. It works in \
         every scan in which it is driven. `D` and the words after it must not overlap the source. If \
         half of the last word gets no character it stays as it is.\n\n\
         ```il\n\
         LD M8002\n\
         MOV H12AB D0\n\
         LD X0\n\
         ASCIP D0 D10 K4\n\
         END\n\
         ```\n",
    )
    .doing(characters::to_characters)
    .pulse(),
    applied(
        83,
        "HEX",
        "ASCII to hexadecimal",
        &[
            source("S", "first word of the characters").except(INDEX).reaching(Extent::Onwards),
            destination("D", "first word of the digits").reaching(Extent::Onwards),
            count("n", "characters", (1, 256)).or_register(),
        ],
        "Reads `n` ASCII characters (`0`–`9`, `A`–`F`) from `S` on as hexadecimal digits and packs them \
         into `D`, four in a word, the last character in the lowest digit. Any other character, lower \
         case included, is an operation error (`M8067`), and nothing is converted. With `M8161` on each \
         character has a word of its own, otherwise two share one. If the peer sends decimal digits the \
         result is BCD; `BIN` turns it into a number. Digits of the last word for which there is no \
         character become 0.\n\n\
         ```il\n\
         LD M8002\n\
         MOV H3231 D0\n\
         MOV H3433 D1\n\
         LD X0\n\
         HEXP D0 D10 K4\n\
         END\n\
         ```\n",
    )
    .doing(characters::from_characters)
    .pulse(),
    applied(
        84,
        "CCD",
        "check code",
        &[
            source("S", "first word of the data").except(INDEX.or(Accepts::K)).reaching(Extent::Onwards),
            destination("D", "sum and parity").except(INDEX).covering(2),
            count("n", "bytes", (1, 256)).or_register(),
        ],
        "Adds up `n` bytes from `S` on into `D` and combines them by exclusive or into the next \
         register, which are the two check codes that serial protocols use most. With `M8161` off the \
         bytes are taken from low and high halves in turn, with it on from the low halves only. Compute \
         it after the frame is complete and before it is sent. Most protocols want only the lower eight \
         bits of the sum: mask it by `WAND`.\n\n\
         ```il\n\
         LD M8002\n\
         MOV H3130 D0\n\
         MOV H3332 D1\n\
         LD X0\n\
         CCDP D0 D10 K4\n\
         WANDP D10 H0FF D12\n\
         END\n\
         ```\n",
    )
    .doing(characters::check_code)
    .pulse(),
    applied(
        85,
        "VRRD",
        "read a trimmer",
        &[source("S", "trimmer number").within(0, 7), destination("D", "position, 0 to 255")],
        "Reads the position of trimmer `S` as a number from 0 to 255. FX1S and FX1N have two of their own, \
         0 and 1, which can also be read in `D8030` and `D8031`; larger CPUs need a trimmer board with \
         eight. Read it in every scan if the operator may turn it at any time. The value jumps by one or \
         two on its own: do not compare it for equality. Multiply it before using it as the preset of a \
         timer that runs longer than 25.5 s. In the simulator trimmers stand at 0 until a scenario turns \
         them: `VR0` is the first, `VR0 = 128` turns it halfway.\n\n\
         ```il\n\
         LD M8000\n\
         VRRD K0 D0\n\
         LD X0\n\
         OUT T0 D0\n\
         LD T0\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .doing(characters::read_trimmer)
    .pulse(),
    applied(
        86,
        "VRSC",
        "read a trimmer as a switch",
        &[source("S", "trimmer number").within(0, 7), destination("D", "position, 0 to 10")],
        "Reads the position of trimmer `S` as one of eleven, 0 to 10, rounded, so that it serves as a \
         rotary switch. Together with `DECO` it switches one of several relays. At the border between two \
         positions the number may flutter: take it over only when the machine is at rest. Which trimmers \
         there are is the same as for `VRRD`. The simulator rounds to the nearest position.\n\n\
         ```il\n\
         LDP X0\n\
         VRSC K1 D0\n\
         LD= D0 K3\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .doing(characters::read_switch)
    .pulse(),
    applied(
        88,
        "PID",
        "PID control",
        &[
            operand("S1", "set value", Access::Read, REGISTER),
            operand("S2", "measured value", Access::Read, REGISTER),
            operand("S3", "first of 25 words of parameters", Access::ReadWrite, REGISTER).covering(25),
            operand("D", "output value", Access::ReadWrite, REGISTER),
        ],
        "A PID controller. The parameters from `S3` on are the sampling time in ms, the direction and \
         alarm switches, the input filter in %, the gain in %, the integral time in 100 ms, the \
         derivative gain in % and the derivative time in 10 ms; the rest up to `S3`+24 is working memory \
         and alarm limits, which nothing else may use. Drive it all the time: it computes once in each \
         sampling time, which must be longer than the scan. Load the parameters once, before it starts. \
         Bad ones set `M8067`, and `D8067` holds the code. Each loop needs 25 registers of its own. Limit \
         the output before it goes to the plant, and clear it in the first scan if its register keeps its \
         value without power. The first computation comes with the drive: it takes the measured value for \
         its past, no error before it, and goes on from what `D` holds. A sampling time below the scan \
         counts as the scan, with the code 6740. An alarm comes on when a change is greater than its \
         limit. Bit 4 of `S3`+1 asks for tuning: with the output at a fixed value, and the measured value at least \
         150 from the set one (else 6750), it waits until a third of that way is gone, writes gain, times \
         and direction, and takes the bit away. The simulator keeps its working memory elsewhere, tunes \
         by the rules of Ziegler and Nichols, where a CPU may find somewhat other numbers, and has only \
         the method of the step response: bit 6 with bit 4 is an operation error there on an FX3U.\n\n\
         ```il\n\
         LD M8002\n\
         MOV K500 D0\n\
         MOV K1000 D10\n\
         MOV H1 D11\n\
         MOV K70 D12\n\
         MOV K100 D13\n\
         MOV K30 D14\n\
         MOV K0 D15\n\
         MOV K0 D16\n\
         LD X0\n\
         PID D0 D1 D10 D2\n\
         LD X1\n\
         MOV D2 D40\n\
         END\n\
         ```\n",
    )
    .always(pid::control),
];
