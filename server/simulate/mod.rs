//! The simulated PLC: programs become code, code runs scan by scan, and every scan can be looked into.
//!
//! Time is an argument: a scan happens at the moment that its caller names, so that the same inputs at the same times
//! give the same outputs, bit for bit.

mod lanes;
pub use lanes::Lanes;

mod row;
pub use row::{CELLS, Cell, Row};

mod layout;
pub use layout::{Layout, Slot};

mod memory;
pub use memory::Memory;

mod code;
pub use code::{Code, Place};

mod problem;
pub use problem::{Obstacle, Problem};

mod builder;

mod adopting;

mod from_list;

mod from_path;

mod compile;
pub use compile::compile;

mod annunciators;

mod clock;

mod forces;

mod orders;
pub use orders::is_identity;

mod execution;

mod timing;

mod terminals;

mod pulses;

mod interrupts;

mod iec;
pub use iec::{Lies, Spot};

mod special;

mod instruct;

mod run;

mod writes;

mod machine;
pub use machine::{Error, ErrorKind, Machine, Outcome, Sight};

pub use iec::{HandedOver, Member, UnitVariables, joined};

mod glimpse;
pub use glimpse::{Caller, Glimpse};

mod history;
pub use history::HistoryLimit;

mod session;
pub use session::{Session, Touch};

mod search;
pub use search::ChangeSearch;

mod value;
pub use value::Value;

mod around;

mod variable;
pub use variable::Variable;

mod setting;
pub use setting::Setting;

mod trace;
pub use trace::{Row as TraceRow, Trace, milliseconds};

mod duration;
pub use duration::duration;

mod expression;
pub use expression::{Expression, Names, NamesOfCode, WithSymbols};

mod alarm;
pub use alarm::{Alarm, AlarmChange, Alarms};

mod recorder;
pub use recorder::{Change, Recorder, Signal, is_affordable, thinned};

mod presets;
pub use presets::{Counted, CountedPreset};

mod words;
pub use words::instruction_words;

mod why;
pub use why::{Condition, Drivers, Inquiry, Reason};

mod power_flow;
pub use power_flow::{Energised, EnergisedKind, power_flow};
