//! The devices of each model, run by run.
//!
//! Source: the device tables of the FX programming manuals; the retentive ranges are the ones set in a new PLC,
//! and on FX2N and FX3U some of them can be moved by parameter.

use crate::target::DeviceKind::{C, D, I, M, N, P, R, S, T, V, X, Y, Z};
use crate::target::{DeviceKind, DeviceRange};

/// FX1S.
pub const FX1S: &[DeviceRange] = &[
    bits(X, 0, 0o17, "input"),
    bits(Y, 0, 0o15, "output"),
    bits(M, 0, 383, "general relay"),
    bits(M, 384, 511, "latched relay").latched(),
    bits(M, 8000, 8255, "special relay"),
    bits(S, 0, 9, "initial state").latched(),
    bits(S, 10, 127, "latched state").latched(),
    timer(0, 31, 100, "100 ms timer"),
    timer(32, 62, 100, "100 ms timer, 10 ms while M8028 is on"),
    timer(63, 63, 1, "1 ms timer"),
    words(C, 0, 15, "16-bit up counter"),
    words(C, 16, 31, "latched 16-bit up counter").latched(),
    HIGH_SPEED[0],
    HIGH_SPEED[1],
    HIGH_SPEED[2],
    HIGH_SPEED[3],
    words(D, 0, 127, "general register"),
    words(D, 128, 255, "latched register").latched(),
    words(D, 1000, 2499, "file register").latched(),
    words(D, 8000, 8255, "special register"),
    INDEX[0],
    INDEX[1],
    bits(P, 0, 62, "pointer"),
    bits(P, 63, 63, "pointer to END"),
    INPUT_INTERRUPTS[0],
    INPUT_INTERRUPTS[1],
    INPUT_INTERRUPTS[2],
    INPUT_INTERRUPTS[3],
    INPUT_INTERRUPTS[4],
    INPUT_INTERRUPTS[5],
    NESTING,
];

/// FX1N.
pub const FX1N: &[DeviceRange] = &[
    bits(X, 0, 0o177, "input"),
    bits(Y, 0, 0o177, "output"),
    bits(M, 0, 383, "general relay"),
    bits(M, 384, 1535, "latched relay").latched(),
    bits(M, 8000, 8255, "special relay"),
    bits(S, 0, 9, "initial state").latched(),
    bits(S, 10, 999, "latched state").latched(),
    timer(0, 199, 100, "100 ms timer"),
    timer(200, 245, 10, "10 ms timer"),
    RETENTIVE_TIMERS[0],
    RETENTIVE_TIMERS[1],
    words(C, 0, 15, "16-bit up counter"),
    words(C, 16, 199, "latched 16-bit up counter").latched(),
    UP_DOWN[0],
    UP_DOWN[1],
    HIGH_SPEED[0],
    HIGH_SPEED[1],
    HIGH_SPEED[2],
    HIGH_SPEED[3],
    words(D, 0, 127, "general register"),
    words(D, 128, 999, "latched register").latched(),
    words(D, 1000, 7999, "latched register, may hold file registers").latched(),
    words(D, 8000, 8255, "special register"),
    INDEX[0],
    INDEX[1],
    bits(P, 0, 62, "pointer"),
    bits(P, 63, 63, "pointer to END"),
    bits(P, 64, 127, "pointer"),
    INPUT_INTERRUPTS[0],
    INPUT_INTERRUPTS[1],
    INPUT_INTERRUPTS[2],
    INPUT_INTERRUPTS[3],
    INPUT_INTERRUPTS[4],
    INPUT_INTERRUPTS[5],
    NESTING,
];

/// FX2N.
pub const FX2N: &[DeviceRange] = &[
    bits(X, 0, 0o377, "input"),
    bits(Y, 0, 0o377, "output"),
    bits(M, 0, 499, "general relay"),
    bits(M, 500, 1023, "latched relay").latched(),
    bits(M, 1024, 3071, "latched relay").latched(),
    bits(M, 8000, 8255, "special relay"),
    STATES[0],
    STATES[1],
    STATES[2],
    STATES[3],
    STATES[4],
    timer(0, 191, 100, "100 ms timer"),
    timer(192, 199, 100, "100 ms timer for subroutines and interrupts"),
    timer(200, 245, 10, "10 ms timer"),
    RETENTIVE_TIMERS[0],
    RETENTIVE_TIMERS[1],
    words(C, 0, 99, "16-bit up counter"),
    words(C, 100, 199, "latched 16-bit up counter").latched(),
    UP_DOWN[0],
    UP_DOWN[1],
    HIGH_SPEED[0],
    HIGH_SPEED[1],
    HIGH_SPEED[2],
    HIGH_SPEED[3],
    words(D, 0, 199, "general register"),
    words(D, 200, 511, "latched register").latched(),
    words(D, 512, 999, "latched register").latched(),
    words(D, 1000, 7999, "latched register, may hold file registers").latched(),
    words(D, 8000, 8255, "special register"),
    INDEX[0],
    INDEX[1],
    bits(P, 0, 62, "pointer"),
    bits(P, 63, 63, "pointer to END"),
    bits(P, 64, 127, "pointer"),
    INPUT_INTERRUPTS[0],
    INPUT_INTERRUPTS[1],
    INPUT_INTERRUPTS[2],
    INPUT_INTERRUPTS[3],
    INPUT_INTERRUPTS[4],
    INPUT_INTERRUPTS[5],
    OTHER_INTERRUPTS[0],
    OTHER_INTERRUPTS[1],
    OTHER_INTERRUPTS[2],
    OTHER_INTERRUPTS[3],
    OTHER_INTERRUPTS[4],
    OTHER_INTERRUPTS[5],
    OTHER_INTERRUPTS[6],
    OTHER_INTERRUPTS[7],
    OTHER_INTERRUPTS[8],
    NESTING,
];

/// FX3U.
pub const FX3U: &[DeviceRange] = &[
    bits(X, 0, 0o367, "input"),
    bits(Y, 0, 0o367, "output"),
    bits(M, 0, 499, "general relay"),
    bits(M, 500, 1023, "latched relay").latched(),
    bits(M, 1024, 7679, "latched relay").latched(),
    bits(M, 8000, 8511, "special relay"),
    STATES[0],
    STATES[1],
    STATES[2],
    STATES[3],
    STATES[4],
    bits(S, 1000, 4095, "latched state").latched(),
    timer(0, 191, 100, "100 ms timer"),
    timer(192, 199, 100, "100 ms timer for subroutines and interrupts"),
    timer(200, 245, 10, "10 ms timer"),
    RETENTIVE_TIMERS[0],
    RETENTIVE_TIMERS[1],
    timer(256, 511, 1, "1 ms timer"),
    words(C, 0, 99, "16-bit up counter"),
    words(C, 100, 199, "latched 16-bit up counter").latched(),
    UP_DOWN[0],
    UP_DOWN[1],
    HIGH_SPEED[0],
    HIGH_SPEED[1],
    HIGH_SPEED[2],
    HIGH_SPEED[3],
    words(D, 0, 199, "general register"),
    words(D, 200, 511, "latched register").latched(),
    words(D, 512, 999, "latched register").latched(),
    words(D, 1000, 7999, "latched register, may hold file registers").latched(),
    words(D, 8000, 8511, "special register"),
    words(R, 0, 32767, "extension register").latched(),
    INDEX[0],
    INDEX[1],
    bits(P, 0, 62, "pointer"),
    bits(P, 63, 63, "pointer to END"),
    bits(P, 64, 4095, "pointer"),
    INPUT_INTERRUPTS[0],
    INPUT_INTERRUPTS[1],
    INPUT_INTERRUPTS[2],
    INPUT_INTERRUPTS[3],
    INPUT_INTERRUPTS[4],
    INPUT_INTERRUPTS[5],
    OTHER_INTERRUPTS[0],
    OTHER_INTERRUPTS[1],
    OTHER_INTERRUPTS[2],
    OTHER_INTERRUPTS[3],
    OTHER_INTERRUPTS[4],
    OTHER_INTERRUPTS[5],
    OTHER_INTERRUPTS[6],
    OTHER_INTERRUPTS[7],
    OTHER_INTERRUPTS[8],
    NESTING,
];

const STATES: [DeviceRange; 5] = [
    bits(S, 0, 9, "initial state"),
    bits(S, 10, 19, "state for returning home"),
    bits(S, 20, 499, "general state"),
    bits(S, 500, 899, "latched state").latched(),
    bits(S, 900, 999, "annunciator").latched(),
];

const RETENTIVE_TIMERS: [DeviceRange; 2] = [
    timer(246, 249, 1, "1 ms retentive timer").latched(),
    timer(250, 255, 100, "100 ms retentive timer").latched(),
];

const UP_DOWN: [DeviceRange; 2] = [
    words(C, 200, 219, "32-bit up/down counter").of_32_bits(),
    words(C, 220, 234, "latched 32-bit up/down counter").of_32_bits().latched(),
];

const HIGH_SPEED: [DeviceRange; 4] = [
    words(C, 235, 240, "high-speed counter, one phase").of_32_bits().latched(),
    words(C, 241, 245, "high-speed counter, one phase with reset or start input").of_32_bits().latched(),
    words(C, 246, 250, "high-speed counter, separate up and down inputs").of_32_bits().latched(),
    words(C, 251, 255, "high-speed counter, A and B phase").of_32_bits().latched(),
];

const INDEX: [DeviceRange; 2] = [words(V, 0, 7, "index register"), words(Z, 0, 7, "index register")];

/// The tens digit of an input interrupt is always 0; the last digit is 0 for the falling edge, 1 for the rising one.
const INPUT_INTERRUPTS: [DeviceRange; 6] = [
    bits(I, 0, 1, "interrupt from X0"),
    bits(I, 100, 101, "interrupt from X1"),
    bits(I, 200, 201, "interrupt from X2"),
    bits(I, 300, 301, "interrupt from X3"),
    bits(I, 400, 401, "interrupt from X4"),
    bits(I, 500, 501, "interrupt from X5"),
];

/// A timer interrupt ends in its period, 10 to 99 ms.
const OTHER_INTERRUPTS: [DeviceRange; 9] = [
    bits(I, 10, 10, "high-speed counter interrupt 1"),
    bits(I, 20, 20, "high-speed counter interrupt 2"),
    bits(I, 30, 30, "high-speed counter interrupt 3"),
    bits(I, 40, 40, "high-speed counter interrupt 4"),
    bits(I, 50, 50, "high-speed counter interrupt 5"),
    bits(I, 60, 60, "high-speed counter interrupt 6"),
    bits(I, 610, 699, "timer interrupt 6, the last two digits are its period in ms"),
    bits(I, 710, 799, "timer interrupt 7, the last two digits are its period in ms"),
    bits(I, 810, 899, "timer interrupt 8, the last two digits are its period in ms"),
];

const NESTING: DeviceRange = bits(N, 0, 7, "nesting level of master control");

const fn bits(kind: DeviceKind, first: u32, last: u32, purpose: &'static str) -> DeviceRange {
    DeviceRange { kind, first, last, purpose, latched: false, timer_unit_ms: 0, bits: 1 }
}

const fn words(kind: DeviceKind, first: u32, last: u32, purpose: &'static str) -> DeviceRange {
    DeviceRange { bits: 16, ..bits(kind, first, last, purpose) }
}

const fn timer(first: u32, last: u32, timer_unit_ms: u32, purpose: &'static str) -> DeviceRange {
    DeviceRange { timer_unit_ms, ..words(T, first, last, purpose) }
}

impl DeviceRange {
    const fn latched(self) -> DeviceRange {
        DeviceRange { latched: true, ..self }
    }

    const fn of_32_bits(self) -> DeviceRange {
        DeviceRange { bits: 32, ..self }
    }
}
