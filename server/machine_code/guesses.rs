//! What no capture shows. Every line here is to be corrected when somebody reads it from a real PLC.

/// The word of the label `I000`; the others follow by their numbers. Labels P are `B000` to `B07F`. One firmware of a
/// compatible PLC takes every higher word that begins with B for a label of an interrupt.
pub const INTERRUPT_LABEL: u16 = 0xB100;

/// How many words the text of ASC has: one for each character, as one step for each is left of the 11 steps of the
/// manual when the opcode and the destination are taken away.
pub const TEXT_WORDS: usize = 8;

/// The word of a character of a text: it stands in the lower byte, as bytes of constants do.
pub const CHARACTER: u16 = 0x8000;

/// What fills a text of fewer characters.
pub const FILL: u8 = b' ';
