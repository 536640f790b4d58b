//! Machine code: instruction list to the 16-bit words of program memory, and back.
//!
//! [`encode`] makes a [`Program`] of a list, [`decode`] a [`Listing`] of words, which never fails: a word that is no
//! instruction is listed as `NOP? H1234` and encoded to itself. [`Image`] is the memory of a PLC that holds a program
//! and its [`ParameterBlock`].
//!
//! Both ways read the instruction table, where each row has its code. What is written in words after the code is
//! the same for all: [`bits`] has the numbers of bit devices, [`operands`] the words of everything else. Where no
//! capture shows how something is coded, `guesses` has what is taken for it, and nothing else has.
//!
//! No decoder vouches for itself: what it read is encoded again, and counts only if the same words come out.
//!
//! Source of the format: the code table of Xu Yiyi (ourdev.cn, 2009), recorded downloads of the maker's tools, and
//! two firmwares of compatible PLCs, as far as they agree.

mod bits;

mod operands;

mod guesses;

mod codes;

mod encode;
pub use encode::{Encoder, Line, NO_MACHINE_CODE, Program, encode};

mod obstacle;

mod decode;
pub use decode::{Listed, Listing, decode};

mod parameters;
pub use parameters::ParameterBlock;

mod image;
pub use image::{Chunk, Image, executed, sum, words_of};

/// Where the parameter block begins in the memory of the PLC, in bytes.
pub const PARAMETER_ADDRESS: u32 = 0x8000;

/// Where step 0 lies, in bytes.
pub const PROGRAM_ADDRESS: u32 = 0x805C;

/// What unwritten program memory holds: NOP.
pub const BLANK: u16 = 0xFFFF;

/// The word of END.
pub const END: u16 = 0x000F;

/// The address of a program step in the memory of the PLC, in bytes.
pub fn address_of_step(step: u32) -> u32 {
    PROGRAM_ADDRESS + 2 * step
}
