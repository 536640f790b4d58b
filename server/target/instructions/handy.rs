//! FNC 60–69: ready-made solutions for frequent tasks: step control, search, drums, special timers, ramps, sorting.

mod drums;

mod step_control;

mod tables;

mod times;

use super::specs::{FX2N_UP, applied, bits, bits_out, count, destination, operand, source};
use crate::target::{Accepts, Access, Extent, Instruction};

const REGISTER: Accepts = Accepts::D.or(Accepts::R);
const STORED: Accepts = Accepts::T.or(Accepts::C).or(REGISTER);
const BITS_AS_WORDS: Accepts = Accepts::KNX.or(Accepts::KNY).or(Accepts::KNM).or(Accepts::KNS);

/// IST SER ABSD INCD TTMR STMR ALT RAMP ROTC SORT.
pub const ROWS: &[Instruction] = &[
    applied(
        60,
        "IST",
        "initial state for step control",
        &[
            bits("S", "first of 8 mode switches").except(Accepts::S).covering(8),
            operand("D1", "lowest state of the automatic mode", Access::Read, Accepts::S),
            operand("D2", "highest state of the automatic mode", Access::Read, Accepts::S),
        ],
        "Connects eight switches with a step program that has `S0` for manual operation, `S1` for the \
         return to the origin and `S2` for automatic operation. In order from `S`: manual, return to \
         origin, single step, one cycle, continuous, start of the return, start of automatic operation, \
         stop. It then controls the relays `M8040` to `M8042` and `M8047`. Drive it by `M8000`, once in a \
         program and before the step ladder that it controls. Use a rotary switch: never may two of the \
         first five be on together. Use `S10` to `S19` for the return, and set `M8043` when it is done \
         and `M8044` at the origin. When the mode changes, `S0` to `S2`, `S10` to `S19` and the states \
         from `D1` to `D2` go off and the initial state of the new mode comes on; away from the origin \
         all outputs go off as well, unless `M8045` is on. `M8040` is on in manual operation, in single \
         step but for the scan in which start is pressed, and in the other modes from stop to start; in \
         continuous operation stop takes `M8041` away instead, so that the cycle is finished. `M8041` is \
         on in automatic operation while start is pressed, in continuous operation until stop. `M8042` is \
         on for the scan in which start is pressed.\n\n\
         ```il\n\
         LD M8000\n\
         IST X0 S20 S29\n\
         LD X10\n\
         OUT M8044\n\
         STL S0\n\
         LD X11\n\
         OUT Y0\n\
         RET\n\
         END\n\
         ```\n",
    )
    .doing(step_control::initial_state),
    applied(
        61,
        "SER",
        "search in a table",
        &[
            source("S1", "first word of the table").accepting(BITS_AS_WORDS.or(STORED)).counted_by(3),
            source("S2", "value to look for"),
            destination("D", "first of 5 results").except(Accepts::V.or(Accepts::Z)).covering(5),
            count("n", "words in the table", (1, 256)).within_wide(1, 128).or_register(),
        ],
        "Looks through `n` words from `S1` on for the value `S2`. The five results from `D` on are how \
         many are equal, the position of the first and of the last equal one, and the positions of the \
         smallest and of the largest value. Positions start at 0, so 0 in the second result means *first \
         word* only if the first result is not 0. It works through the whole table in every scan in which \
         it is driven: `SERP` does it once. In the 32-bit form table entries and results are pairs, and \
         `n` goes to 128. Of several smallest or largest values the last one counts.\n\n\
         ```il\n\
         LD X0\n\
         SERP D100 K25 D200 K10\n\
         LD> D200 K0\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .doing(tables::search)
    .wide()
    .pulse()
    .on(FX2N_UP),
    applied(
        62,
        "ABSD",
        "absolute drum",
        &[
            source("S1", "first of n pairs: on at, off at")
                .accepting(BITS_AS_WORDS.or(STORED))
                .covering(2)
                .counted_by(3),
            operand("S2", "counter that gives the position", Access::Read, Accepts::C),
            bits_out("D", "first of n outputs").counted_by(3),
            count("n", "outputs", (1, 64)),
        ],
        "A cam switch: each of `n` outputs from `D` on is on while the counter `S2` lies between its two \
         values in the table at `S1` (on at, off at, for the first output; then the next pair …). All \
         outputs are computed in each scan; with the drive off they stay as they are. Reset the counter \
         yourself at the end of a turn. `DABSD` takes a 32-bit counter, even a high-speed one, but its \
         outputs still follow only once in a scan. If the off value is the smaller one the output is on \
         across the zero point. An output is on from its on value to just before its off value, and never \
         where both are equal.\n\n\
         ```il\n\
         LD M8002\n\
         MOV K40 D0\n\
         MOV K140 D1\n\
         MOV K100 D2\n\
         MOV K200 D3\n\
         LD X0\n\
         ABSD D0 C0 Y0 K2\n\
         LD X1\n\
         OUT C0 K360\n\
         LD C0\n\
         RST C0\n\
         END\n\
         ```\n",
    )
    .doing(drums::absolute)
    .wide(),
    applied(
        63,
        "INCD",
        "incremental drum",
        &[
            source("S1", "first of n counts").accepting(BITS_AS_WORDS.or(STORED)).counted_by(3),
            operand("S2", "counter of events and counter of steps", Access::ReadWrite, Accepts::C)
                .covering(2),
            bits_out("D", "first of n outputs").counted_by(3),
            count("n", "steps", (1, 64)),
        ],
        "A step switch: one of `n` outputs from `D` on is on at a time. When the counter `S2` reaches the \
         count of the step in the table at `S1`, the instruction resets it, and the counter after it, \
         which holds the number of the step, goes on by one. After the last step `M8029` comes on for a \
         scan and the first begins again. Switching the drive off clears both counters and all outputs. \
         Only the first counter needs an `OUT`; give it a preset that no step reaches. A count above that \
         of the step counts as reached as well.\n\n\
         ```il\n\
         LD M8002\n\
         MOV K20 D0\n\
         MOV K30 D1\n\
         MOV K10 D2\n\
         LD X0\n\
         AND M8013\n\
         OUT C0 K9999\n\
         LD X0\n\
         INCD D0 C0 Y0 K3\n\
         END\n\
         ```\n",
    )
    .always(drums::incremental),
    applied(
        64,
        "TTMR",
        "teaching timer",
        &[
            operand("D", "taught time and running time", Access::Write, REGISTER).covering(2),
            count("n", "unit: 0 is 1 s, 1 is 0.1 s, 2 is 0.01 s", (0, 2)).or_register(),
        ],
        "Measures how long a button is held. While it is driven the register after `D` counts in tenths \
         of a second and `D` shows the time in the unit that `n` chooses: whole seconds for 0, tenths \
         for 1, hundredths for 2. On release the running time goes to 0 and `D` keeps the result, which \
         can be the preset of a timer: with `n` = 1 that is right for a 100 ms timer. `D` is rewritten \
         at the next press, so protect it by a mode switch.\n\n\
         ```il\n\
         LD X0\n\
         TTMR D0 K1\n\
         LD X1\n\
         OUT T0 D0\n\
         LD T0\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .always(times::teach)
    .on(FX2N_UP),
    applied(
        65,
        "STMR",
        "special timer",
        &[
            operand("S", "100 ms timer, T0 to T199", Access::Write, Accepts::T),
            count("m", "time in units of 100 ms", (1, 32_767)).or_register(),
            bits_out("D", "first of 4 outputs").covering(4),
        ],
        "Gives four timing functions with one timer. `D` goes off `m` × 100 ms after the drive does (off \
         delay); the next output gives one pulse of that length when the drive goes off; the third one \
         pulse when it comes on; the fourth comes on and goes off with that delay. It must be executed in \
         every scan. Do not use the timer anywhere else. Put a normally closed contact of the fourth \
         output in series with the drive, and the second and third flash in turn. The third ends early if \
         the drive goes off, and after a drive shorter than `m` × 100 ms the fourth stays off.\n\n\
         ```il\n\
         LD X0\n\
         STMR T10 K20 M0\n\
         LD M0\n\
         OUT Y0\n\
         LD M2\n\
         OUT Y1\n\
         END\n\
         ```\n",
    )
    .always(times::special_timer)
    .on(FX2N_UP),
    applied(
        66,
        "ALT",
        "alternate",
        &[bits_out("D", "bit to toggle").read_and_written()],
        "Turns the bit over: off becomes on, on becomes off. It does so in *every* scan in which it is \
         driven, so that the plain form flickers while a button is held. Use `ALTP`, or drive it by a \
         pulse contact, for one change at a press. Do not drive the same bit by `OUT` elsewhere.\n\n\
         ```il\n\
         LD X0\n\
         ALTP M0\n\
         LD M0\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .doing(|execution| {
        let is_on = execution.bit(0, 0)?;
        execution.set_bit(0, 0, !is_on)
    })
    .pulse(),
    applied(
        67,
        "RAMP",
        "ramp",
        &[
            operand("S1", "start value", Access::Read, REGISTER),
            operand("S2", "end value", Access::Read, REGISTER),
            operand("D", "present value and scans done", Access::Write, REGISTER).covering(2),
            count("n", "scans", (1, 32_767)).or_register(),
        ],
        "Moves `D` from `S1` to `S2` in `n` equal steps, one in each scan; the register after `D` counts \
         the scans. At the end `M8029` comes on; with `M8026` on the value stays at the end, otherwise \
         the ramp begins again. Switching the drive off stops it, and switching it on starts from `S1`. \
         The time is `n` scans, not seconds: set a constant scan (`M8039`, `D8039`) if it matters. Write \
         start and end values before the ramp begins and leave them alone while it runs. Parts of 1 are \
         cut off.\n\n\
         ```il\n\
         LD M8002\n\
         MOV K0 D0\n\
         MOV K1000 D1\n\
         LD X0\n\
         RAMP D0 D1 D2 K500\n\
         LD> D2 K500\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .always(times::ramp),
    applied(
        68,
        "ROTC",
        "rotary table control",
        &[
            operand("S", "position, station, item", Access::ReadWrite, REGISTER).covering(3),
            count("m1", "divisions of the table", (2, 32_767)),
            count("m2", "divisions at low speed", (0, 32_767)),
            bits_out("D", "three signals in, five out").read_and_written().covering(8),
        ],
        "Turns a round table with `m1` divisions the shorter way until the item (number in `S`+2) is at \
         the station (`S`+1); `S` counts the position. The program copies the signals of the two-phase \
         encoder to `D` and `D`+1 and of the zero switch to `D`+2; the instruction gives fast forward, \
         slow forward, stop, slow backward, fast backward in `D`+3 to `D`+7. The last `m2` divisions run \
         slowly. Write station and item before switching the drive on. A program can hold it only once, \
         and the table must turn slowly enough for the scan to see every edge of the encoder. `S` is the \
         number of the item at station 0, and a division forward raises it by one; where both ways are \
         equally long the table turns forward.\n\n\
         ```il\n\
         LD X0\n\
         OUT M0\n\
         LD X1\n\
         OUT M1\n\
         LD X2\n\
         OUT M2\n\
         LD X3\n\
         ROTC D0 K10 K2 M0\n\
         LD M3\n\
         OUT Y0\n\
         LD M4\n\
         OUT Y1\n\
         END\n\
         ```\n",
    )
    .always(drums::rotary_table)
    .on(FX2N_UP),
    applied(
        69,
        "SORT",
        "sort a table",
        &[
            operand("S", "first word of the table", Access::Read, REGISTER).reaching(Extent::Onwards),
            count("m1", "rows", (1, 32)),
            count("m2", "columns", (1, 6)),
            operand("D", "first word of the sorted table", Access::Write, REGISTER).reaching(Extent::Onwards),
            count("n", "column to sort by", (1, 6)).or_register(),
        ],
        "Copies a table of `m1` rows and `m2` columns to `D` with the rows in rising order of column `n`. \
         The table lies in memory column by column: first all values of column 1, then all of column 2. \
         The work is spread over `m1` scans, and `M8029` comes on at the end: keep the drive on and the \
         table unchanged until then. To sort again switch the drive off for a scan. A program can hold it \
         only once. `n` must not exceed `m2`. The sorted table appears all at once in the last of these \
         scans, and rows with equal values keep their order.\n\n\
         ```il\n\
         LD X0\n\
         SORT D100 K10 K2 D200 K1\n\
         LD M8029\n\
         SET Y0\n\
         LDI X0\n\
         RST Y0\n\
         END\n\
         ```\n",
    )
    .always(tables::sort)
    .on(FX2N_UP),
];
