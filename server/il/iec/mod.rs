//! Instruction List of IEC 61131-3: declarations and bodies, never failing.
