//! FNC 147–159: swapping bytes, and positioning of servo and stepping drives by pulses.

mod drives;

use super::moves::swap_bytes;
use super::specs::{FX2N_UP, applied, bits, bits_out, changed, destination, operand, source};
use crate::target::{Accepts, Access, Instruction, Model, OperandSpec};

/// FX2N has no positioning of its own: it needs a special module.
const WITH_POSITIONING: &[Model] = &[Model::Fx1s, Model::Fx1n, Model::Fx3u];

const fn pulse_output(name: &'static str) -> OperandSpec {
    operand(name, "pulse output", Access::Write, Accepts::Y)
}

/// SWAP ABS ZRN PLSV DRVI DRVA.
pub const ROWS: &[Instruction] = &[
    applied(
        147,
        "SWAP",
        "swap bytes",
        &[changed("S", "word whose bytes change places")],
        "Exchanges the upper and the lower byte of a word; `DSWAP` does so in each of two words and \
         leaves the words in their order. Serial devices often send the upper byte first, and this puts \
         it right. In every scan in which it is driven the bytes change places again: use `SWAPP`.\n\n\
         ```il\n\
         LD M8002\n\
         MOV H1234 D0\n\
         LD X0\n\
         SWAPP D0\n\
         LD= D0 H3412\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP)
    .doing(swap_bytes),
    applied(
        155,
        "ABS",
        "read the absolute position of a servo",
        &[
            bits("S", "first of 3 signals from the amplifier").covering(3),
            bits_out("D1", "first of 3 signals to the amplifier").covering(3),
            destination("D2", "position, a pair").covering(2),
        ],
        "Reads the absolute position from a servo amplifier over six wires: two data bits and *ready* come \
         in from `S` on; *servo on*, *transfer mode* and *request* go out from `D1` on. It is written \
         `DABS`. `M8029` comes on when the position stands in `D2`. Do it once after power-up, before the \
         first movement, and keep the drive on: switching it off breaks the reading off and takes *servo \
         on* away. Move the result into the current value register of the pulse output, or read it there \
         directly. The outputs must be transistors. In the simulator the amplifier needs no signals and \
         answers after 19 scans, with the position that a scenario gives it as `ABS`.\n\n\
         ```il\n\
         LD M8000\n\
         DABS X4 Y4 D0\n\
         LD M8029\n\
         SET Y1\n\
         END\n\
         ```\n",
    )
    .always(drives::absolute)
    .wide_only()
    .on(WITH_POSITIONING),
    applied(
        156,
        "ZRN",
        "return to zero",
        &[
            source("S1", "speed towards zero in Hz").within(10, 32_767).within_wide(10, 200_000),
            source("S2", "creep speed in Hz").within(10, 32_767),
            bits("S3", "proximity switch in front of zero"),
            pulse_output("D"),
        ],
        "Drives a machine to its origin: it runs at `S1` until the proximity switch `S3` comes on, slows \
         down to the creep speed `S2`, stops when the switch goes off, and clears the current position. \
         `M8029` comes on at the end. It runs in one direction and does not search: if it starts beyond \
         the switch it runs on, so end switches are needed. On FX1S and FX1N the direction output is the \
         program's matter. Use an input that has no long filter; the scan limits how exactly the switch \
         is seen. Do not drive two positioning instructions for one output at a time. In the simulator it \
         moves backwards, and the output is on while it moves.\n\n\
         ```il\n\
         LD X0\n\
         DZRN K5000 K500 X4 Y0\n\
         LD M8029\n\
         SET Y1\n\
         LDI X0\n\
         RST Y1\n\
         END\n\
         ```\n",
    )
    .always(drives::to_zero)
    .wide()
    .on(WITH_POSITIONING),
    applied(
        157,
        "PLSV",
        "pulse output with variable speed",
        &[
            source("S", "speed in Hz, negative for reverse"),
            pulse_output("D1"),
            bits_out("D2", "direction, on for forward"),
        ],
        "Gives pulses without end at the speed `S`, which may change at any time while it runs; the sign \
         sets the direction output `D2`. Moving 0 into `S`, or switching the drive off, stops it. The \
         speed changes at once, without a ramp: let the program raise it in small steps (`RAMP`), or the \
         motor loses steps. Before the direction turns stop for a moment. After switching off wait until \
         the unit's *busy* relay is off before driving it again. In the simulator the output is on while \
         pulses are given.\n\n\
         ```il\n\
         LD M8002\n\
         MOV K1000 D0\n\
         LD X0\n\
         PLSV D0 Y0 Y4\n\
         END\n\
         ```\n",
    )
    .always(drives::variable)
    .wide()
    .on(WITH_POSITIONING),
    applied(
        158,
        "DRVI",
        "drive by an increment",
        &[
            source("S1", "pulses, negative for reverse"),
            source("S2", "speed in Hz").within(10, 32_767).within_wide(10, 200_000),
            pulse_output("D1"),
            bits_out("D2", "direction, on for forward"),
        ],
        "Moves by `S1` pulses from where the machine stands, with ramps, at the speed `S2`; the sign sets \
         the direction output `D2`. `M8029` comes on when it has arrived. Operands changed on the way \
         count from the next start. Switching the drive off brakes with the ramp and stops, and then \
         `M8029` stays off. Highest speed and ramp time stand in special registers (`D8146` and `D8148` \
         on FX1S and FX1N; on FX3U each output has its own). Wait until the *busy* relay of the output is \
         off before the next movement. Above 32,767 pulses or Hz use `DDRVI`. In the simulator the output \
         is on while pulses are given, and a speed or time of 0 in these registers counts as 100,000 Hz \
         or 100 ms.\n\n\
         ```il\n\
         LD X0\n\
         DDRVI K50000 K10000 Y0 Y4\n\
         LD M8029\n\
         SET Y1\n\
         LDI X0\n\
         RST Y1\n\
         END\n\
         ```\n",
    )
    .always(drives::by_increment)
    .wide()
    .on(WITH_POSITIONING),
    applied(
        159,
        "DRVA",
        "drive to a position",
        &[
            source("S1", "target position in pulses"),
            source("S2", "speed in Hz").within(10, 32_767).within_wide(10, 200_000),
            pulse_output("D1"),
            bits_out("D2", "direction, on for forward"),
        ],
        "Moves to the position `S1`, counted from the origin, with ramps, at the speed `S2`; the \
         direction output `D2` follows by itself. `M8029` comes on when it has arrived. The present \
         position is in a pair of special registers (`D8140` for `Y0` on FX1S and FX1N, `D8340` on FX3U), \
         which `ZRN` sets to 0: return to zero first. Switching the drive off brakes and stops without \
         `M8029`; driving it again goes on to the target. Above 32,767 pulses or Hz use `DDRVA`. In the \
         simulator the ramps are those of `DRVI`.\n\n\
         ```il\n\
         LD X0\n\
         DDRVA K25000 K10000 Y0 Y4\n\
         LD M8029\n\
         SET Y1\n\
         LDI X0\n\
         RST Y1\n\
         END\n\
         ```\n",
    )
    .always(drives::to_position)
    .wide()
    .on(WITH_POSITIONING),
];
