//! What of the instruction table has no words in a list of IEC 61131-3, whatever its operands are.

/// The rows, by what they are about. Each stays as it is, in a comment, and what it decides about with it.
pub const KEPT: &[&str] = &[
    // Timers and counters with more than one result, and what keeps its own state between scans.
    "ABSD", "ALT", "ANR", "ANS", "INCD", "RAMP", "ROTC", "STMR", "TTMR", "HOUR",
    // Codes, texts and bits of words.
    "ASC", "ASCI", "HEX", "BCD", "BIN", "BON", "CCD", "DECO", "ENCO", "GBIN", "GRY", "SEGD", "SEGL", "SUM",
    "SWAP", "SMOV", "PRUN", // Floating point.
    "EADD", "ESUB", "EMUL", "EDIV", "ESQR", "ECMP", "EZCP", "EBCD", "EBIN", "FLT", "INT", "SIN", "COS",
    "TAN", // Rows of words and bits that move, and what is found in them.
    "MEAN", "RCL", "RCR", "ROL", "ROR", "SER", "SFRD", "SFWR", "SFTL", "SFTR", "WSFL", "WSFR", "SORT", "SQR",
    "XCH",
    // The order of execution: interrupts, loops, subroutines, the power of a section, steps, the pulse of a result.
    "CALL", "SRET", "FEND", "IRET", "EI", "DI", "FOR", "NEXT", "MC", "MCR", "STL", "RET", "IST", "MEP", "MEF",
    "WDT",
    // Beyond the image of inputs and outputs: fast counters, pulses, drives, displays, keys, units, serial lines.
    "HSCS", "HSCR", "HSZ", "SPD", "PLSY", "PLSR", "PLSV", "PWM", "DRVI", "DRVA", "ZRN", "ABS", "REF", "REFF",
    "MTR", "TKY", "HKY", "DSW", "ARWS", "PR", "FROM", "TO", "RD3A", "WR3A", "RS", "VRRD", "VRSC", "PID",
    // The clock.
    "TCMP", "TZCP", "TADD", "TSUB", "TRD", "TWR",
];

/// Forms of other rows: a jump that is a pulse, and products of 64 bits.
pub const KEPT_FORMS: &[&str] = &["CJP", "DMUL", "DMULP"];
