//! FNC 170–177: Gray code, and the small analog modules that have an instruction of their own.

use super::specs::{FX1N_UP, FX2N_UP, applied, destination, source};
use crate::target::{Execution, Fault, Instruction};

/// GRY GBIN RD3A WR3A.
pub const ROWS: &[Instruction] = &[
    applied(
        170,
        "GRY",
        "binary to Gray code",
        &[
            source("S", "number").within(0, 32_767).within_wide(0, 2_147_483_647),
            destination("D", "Gray code"),
        ],
        "Turns a number into Gray code, in which neighbours differ in one bit only. It takes 0 to \
         32,767 (`DGRY` to 2,147,483,647); a negative number is an operation error. It works in every \
         scan in which it is driven. Outputs of a word such as `K2Y0` switch together at the end of the \
         scan, but relay contacts do not close at exactly the same time: the receiver sees a clean code \
         only from transistors.\n\n\
         ```il\n\
         LD M8000\n\
         GRY D0 K2Y0\n\
         LD X0\n\
         INCP D0\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP)
    .doing(to_gray),
    applied(
        171,
        "GBIN",
        "Gray code to binary",
        &[
            source("S", "Gray code").within(0, 32_767).within_wide(0, 2_147_483_647),
            destination("D", "number"),
        ],
        "Turns Gray code into a number, mostly that of an absolute encoder at the inputs: `K3X0` for \
         twelve tracks. It takes 0 to 32,767 (`DGBIN` to 2,147,483,647); a negative number is an \
         operation error. The position is as old as a scan and the input filter (about 10 ms) \
         together: at speed that is several divisions. Refresh the inputs with a short filter by \
         `REFF` just before if that is too much.\n\n\
         ```il\n\
         LD M8000\n\
         GBIN K3X0 D0\n\
         LD>= D0 K1000\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .wide()
    .pulse()
    .on(FX2N_UP)
    .doing(from_gray),
    applied(
        176,
        "RD3A",
        "read an analog module",
        &[
            source("m1", "module number from the CPU on").within(0, 7),
            source("m2", "channel"),
            destination("D", "measured value"),
        ],
        "Starts a conversion in a small analog module (FX0N-3A, FX2N-2AD), waits for it and stores the \
         value, which would take several `FROM` and `TO` otherwise. `m1` counts the special modules from \
         the CPU on beginning with 0. The channel is 1 or 2 for the FX0N-3A, 21 or 22 for the FX2N-2AD; \
         some compatible controllers number their own channels from 0. It converts in every scan in which \
         it is driven and makes the scan longer: drive it by a clock such as `M8012` if the value changes \
         slowly. FX2N has it from version 3.00 on. In simulation the value is the word of the channel in \
         the buffer memory of the module, which a scenario writes (`U0.G1`); a module number above 7, a \
         channel above 99 and a module that does not answer are operation errors.\n\n\
         ```il\n\
         LD M8000\n\
         RD3A K0 K1 D0\n\
         LD> D0 K200\n\
         OUT Y0\n\
         END\n\
         ```\n",
    )
    .pulse()
    .on(FX1N_UP)
    .doing(read_analog),
    applied(
        177,
        "WR3A",
        "write to an analog module",
        &[
            source("m1", "module number from the CPU on").within(0, 7),
            source("m2", "channel"),
            source("S", "value to put out"),
        ],
        "Sends a value to a small analog module (FX0N-3A, FX2N-2DA), which puts it out as voltage or \
         current. `m1` counts the special modules from the CPU on beginning with 0. The channel is 1 for \
         the FX0N-3A, 21 or 22 for the FX2N-2DA. The module takes 8 or 12 bits: limit the value, because \
         higher bits are lost and a little too much becomes a little more than nothing. The output keeps \
         its value when the drive goes off: write 0 to stop. FX2N has it from version 3.00 on. In \
         simulation the value goes to the buffer memory of the module, to the word of the channel plus 100 \
         (`U0.G101`); operation errors are those of `RD3A`.\n\n\
         ```il\n\
         LD X0\n\
         WR3A K0 K1 D0\n\
         LDI X0\n\
         WR3A K0 K1 K0\n\
         END\n\
         ```\n",
    )
    .pulse()
    .on(FX1N_UP)
    .doing(write_analog),
];

/// The last place of a special module.
const LAST_MODULE: i64 = 7;
/// The highest number of a channel; what the modules have is 22 at most.
const LAST_CHANNEL: i64 = 99;
/// Where in the buffer memory of a simulated module the values stand that are put out, by channel from 0. Below stand
/// those that are measured.
const FIRST_OUTPUT: u16 = 100;

fn to_gray(execution: &mut dyn Execution) -> Result<(), Fault> {
    let value = positive(execution)?;
    execution.put(1, value ^ value >> 1)
}

/// A bit of the number is on if the bits of the code from there on that are on are odd in number.
fn from_gray(execution: &mut dyn Execution) -> Result<(), Fault> {
    let code = positive(execution)?;
    let number = [1, 2, 4, 8, 16].iter().fold(code, |number, by| number ^ number >> by);
    execution.put(1, number)
}

fn positive(execution: &mut dyn Execution) -> Result<i64, Fault> {
    let value = execution.value(0)?;
    if value < 0 { Err(Fault::Value(0)) } else { Ok(value) }
}

/// The module, and the channel as a number in its buffer memory.
fn channel(execution: &mut dyn Execution) -> Result<(u8, u16), Fault> {
    let module = execution.count(0, 0, LAST_MODULE)?;
    Ok((module as u8, execution.count(1, 0, LAST_CHANNEL)? as u16))
}

fn read_analog(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (module, channel) = channel(execution)?;
    let value = execution.outside().buffer(module, channel).ok_or(Fault::NoModule)?;
    execution.put(2, i64::from(value))
}

fn write_analog(execution: &mut dyn Execution) -> Result<(), Fault> {
    let (module, channel) = channel(execution)?;
    let value = execution.value(2)?;
    let is_taken = execution.outside().set_buffer(module, FIRST_OUTPUT + channel, value as i16);
    if is_taken { Ok(()) } else { Err(Fault::NoModule) }
}
