//! FNC 50–59: refreshing, high-speed counters, pulse outputs. Most of these act between scans.
//!
//! Where only the 32-bit form exists, `count` is that form's: 2 for a pair of registers.

mod inputs;

mod counters;

mod pulses;

use super::specs::{FX2N_UP, applied, bits_out, count, destination, operand, source};
use crate::target::{Accepts, Access, Extent, Instruction, OperandSpec};

/// Y with a transistor behind it; which numbers can give pulses depends on the unit.
const fn pulse_output(meaning: &'static str) -> OperandSpec {
    operand("D", meaning, Access::Write, Accepts::Y)
}

/// A high-speed counter, C235 to C255.
const fn high_speed_counter(name: &'static str) -> OperandSpec {
    operand(name, "high-speed counter", Access::Read, Accepts::C)
}

/// REF REFF MTR HSCS HSCR HSZ SPD PLSY PWM PLSR.
pub const ROWS: &[Instruction] = &[
    applied(
        50,
        "REF",
        "refresh inputs or outputs",
        &[
            // Refreshing an input is not writing to it, so the operand counts as read.
            operand("D", "first input or output", Access::Read, Accepts::X.or(Accepts::Y)).counted_by(1),
            count("n", "points, a multiple of 8", (8, 256)),
        ],
        "Reads `n` inputs from their terminals, or sends `n` outputs to theirs, at once instead of at the \
         end of the scan. It acts in every scan in which it is driven. The first device must end in 0 \
         (`X0`, `X10`, `Y20`) and `n` must be a multiple of 8. Use it in the middle of a long program or \
         in an interrupt routine. The input filter still applies: an input that changed less than about \
         10 ms ago reads as before, however often it is refreshed. In the simulator inputs have no \
         filter.\n\n\
         ```il\n\
         LD M8000\n\
         REF X0 K8\n\
         LD X0\n\
         OUT Y0\n\
         LD M8000\n\
         REF Y0 K8\n\
         END\n\
         ```\n",
    )
    .doing(inputs::refresh)
    .pulse(),
    applied(
        51,
        "REFF",
        "refresh inputs with filter time",
        &[count("n", "filter time in ms", (0, 60)).or_register()],
        "Reads the inputs with a digital filter (`X0` to `X17`, or to `X7` on small units) at once, with \
         a filter time of `n` milliseconds; `K0` gives the shortest that the hardware has, some tens of \
         microseconds. Drive it in every scan, usually by `M8000`: the ordinary reading between scans \
         goes on with the time in `D8020`, 10 ms after power-up. A filter shorter than the bounce of a \
         mechanical contact makes one press look like several. In the simulator inputs have no filter, so \
         the time makes no difference.\n\n\
         ```il\n\
         LD M8000\n\
         REFF K1\n\
         LD X0\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .doing(inputs::refresh_filtered)
    .pulse()
    .on(FX2N_UP),
    applied(
        52,
        "MTR",
        "input matrix",
        &[
            operand("S", "first of 8 inputs", Access::Read, Accepts::X).covering(8),
            operand("D1", "first row output", Access::Write, Accepts::Y).counted_by(3),
            bits_out("D2", "first bit of the image of the matrix").reaching(Extent::Onwards),
            count("n", "rows", (2, 8)),
        ],
        "Reads up to 64 contacts through 8 inputs and `n` transistor outputs: each output in turn feeds \
         one row, and the row's 8 contacts are copied to `D2`…, each row ten numbers after the last \
         (`M0`–`M7`, `M10`–`M17`, …). Every device must begin at a number ending in 0. Drive it all the \
         time by `M8000`; `M8029` comes on for a scan when all rows have been read. A row takes about 20 \
         ms, so short presses can be missed. Every contact needs a diode in series, and a program can hold \
         the instruction only once. In the simulator a row takes two scans, and a scenario closes the \
         contact between `Y10` and `X12` by `Y10.X12 = 1`.\n\n\
         ```il\n\
         LD M8000\n\
         MTR X10 Y10 M0 K3\n\
         LD M0\n\
         OUT Y0\n\
         LD M10\n\
         OUT Y1\n\
         END\n\
         ```\n",
    )
    .always(inputs::matrix),
    applied(
        53,
        "HSCS",
        "set by high-speed counter",
        &[
            source("S1", "value to compare with").covering(2),
            high_speed_counter("S2"),
            bits_out("D", "bit to set, or interrupt to call").also(Accepts::I),
        ],
        "Sets `D` in the very moment in which the high-speed counter `S2` reaches `S1`, without waiting \
         for the scan; an output goes to its terminal at once. Only the 32-bit form exists. Drive it all \
         the time by `M8000`, and drive the counter with `OUT` as well. The comparison belongs to the \
         counting pulse: a value that the program moves into the counter sets nothing. Only a few such \
         comparisons can be active at a time (four on FX1S and FX1N, six on FX2N), and each lowers the \
         highest frequency. On the larger models `D` can be one of the pointers `I010` to `I060`. The \
         simulator counts the pulses between two scans when the second one begins, by the comparisons that \
         were driven in the first, and takes up to 64 of these; a scenario gives pulses by `pulses = { X0 \
         = 40 }`.\n\n\
         ```il\n\
         LD M8000\n\
         OUT C235 K2147483647\n\
         DHSCS K1000 C235 Y0\n\
         LD X10\n\
         RST Y0\n\
         END\n\
         ```\n",
    )
    .doing(counters::set)
    .wide_only(),
    applied(
        54,
        "HSCR",
        "reset by high-speed counter",
        &[
            source("S1", "value to compare with").covering(2),
            high_speed_counter("S2"),
            bits_out("D", "bit to reset, or the counter itself").also(Accepts::C),
        ],
        "Resets `D` in the very moment in which the high-speed counter `S2` reaches `S1`, without waiting \
         for the scan. `D` can be the same counter, which then starts again from 0 by itself. Only the \
         32-bit form exists; drive it all the time by `M8000`. As with `DHSCS` only a counting pulse \
         triggers it, not a value moved into the counter, and the number of such comparisons that are \
         active at a time is limited. The simulator acts on the pulses between two scans when the second \
         one begins.\n\n\
         ```il\n\
         LD M8000\n\
         OUT C235 K2147483647\n\
         DHSCR K2000 C235 Y0\n\
         LD X10\n\
         SET Y0\n\
         END\n\
         ```\n",
    )
    .doing(counters::reset)
    .wide_only(),
    applied(
        55,
        "HSZ",
        "zone by high-speed counter",
        &[
            source("S1", "lower limit").covering(2),
            source("S2", "upper limit").covering(2),
            high_speed_counter("S"),
            bits_out("D", "below, within, above").covering(3),
        ],
        "Compares the high-speed counter `S` with two limits at every counting pulse and switches three \
         bits at once: `D` below `S1`, the next from `S1` to `S2`, the third above `S2`. Only the 32-bit \
         form exists; `S1` must not be larger than `S2`. Until the first pulse arrives all three bits \
         keep their state, so a machine that starts at rest needs a `DZCP` in the first scan. Frequency \
         control by a table (`M8130`, `M8132`) is another mode of the same instruction. The simulator \
         compares after the pulses between two scans, and does not have the modes with a table: asking \
         for them is an operation error there.\n\n\
         ```il\n\
         LD M8000\n\
         OUT C235 K2147483647\n\
         DHSZ K1000 K1200 C235 Y0\n\
         END\n\
         ```\n",
    )
    .doing(counters::zone)
    .wide_only()
    .on(FX2N_UP),
    applied(
        56,
        "SPD",
        "speed detection",
        &[
            operand("S1", "pulse input", Access::Read, Accepts::X),
            source("S2", "measuring time in ms"),
            destination("D", "pulses, running count, remaining time")
                .accepting(
                    Accepts::T.or(Accepts::C).or(Accepts::D).or(Accepts::R).or(Accepts::V).or(Accepts::Z),
                )
                .covering(3),
        ],
        "Counts the pulses at a fast input (`X0` to `X5`) during `S2` milliseconds, over and over. `D` \
         holds the result of the last complete window, the next register the count of the running one and \
         the third the time that is left in it. Revolutions per minute are 60,000 × `D` ÷ (pulses per \
         revolution × `S2`). The input cannot serve a high-speed counter, an interrupt or a pulse catch as \
         well. A short window follows changes quickly but resolves coarsely: one pulse more or less in ten \
         is ten per cent. The form `DSPD` exists on FX3U only. In the simulator pulses come from a \
         scenario (`pulses = { X0 = 40 }`) or from the input itself, one for each time it comes on, and \
         those before the scan in which a window ends belong to that window.\n\n\
         ```il\n\
         LD X10\n\
         SPD X0 K100 D0\n\
         LD>= D0 K500\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .always(inputs::speed)
    .wide(),
    applied(
        57,
        "PLSY",
        "pulse output",
        &[
            source("S1", "frequency in Hz"),
            source("S2", "number of pulses; 0 for no end"),
            pulse_output("pulse output"),
        ],
        "Sends `S2` pulses of `S1` Hz, half on and half off, to a transistor output (`Y0` or `Y1`); 0 \
         pulses means that it goes on for ever. When all have been sent `M8029` comes on: read it \
         directly after this instruction, because other instructions use it too. Switching the drive off \
         stops at once, and switching it on again starts from the beginning; there is no ramp, so a \
         stepping motor can lose steps (see `PLSR`). The frequency may be changed while it runs, the \
         number not. Use `DPLSY` above 32,767 and keep within the unit's limit. Relay outputs wear out \
         within minutes. In the simulator the output is on while pulses are given and does not follow \
         each of them; `D8140` (`D8142` for `Y1`) and `D8136` count them.\n\n\
         ```il\n\
         LD X0\n\
         PLSY K1000 K500 Y0\n\
         LD M8029\n\
         SET Y1\n\
         LDI X0\n\
         RST Y1\n\
         END\n\
         ```\n",
    )
    .always(pulses::pulses)
    .wide(),
    applied(
        58,
        "PWM",
        "pulse width modulation",
        &[
            source("S1", "pulse width in ms").within(0, 32_767),
            source("S2", "period in ms").within(1, 32_767),
            pulse_output("pulse output"),
        ],
        "Gives pulses of `S1` ms in a period of `S2` ms on a transistor output (`Y0` or `Y1`) for as long \
         as it is driven, independently of the scan. Change `S1` while it runs to change the duty. `S1` \
         must not be larger than `S2`, otherwise there is an operation error; limit a computed width \
         first. With the drive off the output goes off. One output can serve only one pulse instruction. \
         In the simulator the output follows the pulses only as closely as scans follow each other.\n\n\
         ```il\n\
         LD M8002\n\
         MOV K30 D0\n\
         LD X0\n\
         PWM D0 K100 Y0\n\
         END\n\
         ```\n",
    )
    .always(pulses::pulse_width),
    applied(
        59,
        "PLSR",
        "pulse output with ramps",
        &[
            source("S1", "highest frequency in Hz"),
            source("S2", "number of pulses"),
            source("S3", "time of acceleration and of braking in ms").within(0, 5_000),
            pulse_output("pulse output"),
        ],
        "Sends `S2` pulses to a transistor output (`Y0` or `Y1`), speeding up to `S1` Hz within `S3` ms \
         and slowing down likewise at the end, so that a stepping motor can follow. `M8029` comes on when \
         all have been sent. Operands changed on the way count only from the next start. Switching the \
         drive off stops at once without a ramp. With few pulses or a long ramp the highest frequency may \
         not be reached. There is no direction output: switch it yourself before the start, or use `DRVI` \
         where the model has it. In the simulator the output is on while pulses are given, and the speed \
         changes in steps of a millisecond.\n\n\
         ```il\n\
         LD X0\n\
         PLSR K1000 K5000 K200 Y0\n\
         LD M8029\n\
         SET Y1\n\
         LDI X0\n\
         RST Y1\n\
         END\n\
         ```\n",
    )
    .always(pulses::ramped_pulses)
    .wide(),
];
