//! Durations, dates and times of day.

use super::numeric::{difference, product, quotient, sum};
use super::{Function, FunctionPage, Parameter, ParameterType};
use crate::target::iec::page::Page;
use crate::target::iec::semantics::NS_OF_DAY;
use crate::target::iec::{Datum, Formula};
use crate::target::iec::{ElementaryType, GenericType};

/// ADD_TIME to CONCAT_DATE_TOD.
pub const ROWS: &[Function] = &[
    Function {
        name: "ADD_TIME",
        title: "sum of durations",
        inputs: &[
            Parameter::of("IN1", ElementaryType::Time, "duration"),
            Parameter::of("IN2", ElementaryType::Time, "duration"),
        ],
        extensible: false,
        result: ParameterType::Elementary(ElementaryType::Time),
        formula: Formula::new(sum),
        page: FunctionPage::Own(Page {
            about: "The sum of two TIMEs. The operator `ADD` with two TIMEs does the same; the name says \
                    what is added where that is not plain to see.",
            variables: &["Base : TIME := T#2s", "Extra : TIME := T#500ms", "Total : TIME"],
            body: &["LD Base", "ADD_TIME Extra", "ST Total"],
        }),
    },
    Function {
        name: "ADD_TOD_TIME",
        title: "later time of day",
        inputs: &[
            Parameter::of("IN1", ElementaryType::TimeOfDay, "time of day"),
            Parameter::of("IN2", ElementaryType::Time, "duration"),
        ],
        extensible: false,
        result: ParameterType::Elementary(ElementaryType::TimeOfDay),
        formula: Formula::new(sum),
        page: FunctionPage::Own(Page {
            about: "A time of day moved on by a TIME. The current result is the TOD. The standard does \
                    not say what comes after midnight; most controllers start again at 00:00:00.",
            variables: &["Start : TOD := TOD#06:00:00", "Shift : TIME := T#8h", "Finish : TOD"],
            body: &["LD Start", "ADD_TOD_TIME Shift", "ST Finish"],
        }),
    },
    Function {
        name: "ADD_DT_TIME",
        title: "later date and time",
        inputs: &[
            Parameter::of("IN1", ElementaryType::DateAndTime, "date and time"),
            Parameter::of("IN2", ElementaryType::Time, "duration"),
        ],
        extensible: false,
        result: ParameterType::Elementary(ElementaryType::DateAndTime),
        formula: Formula::new(sum),
        page: FunctionPage::Own(Page {
            about: "A date and time moved on by a TIME. The current result is the DT.",
            variables: &["Begin : DT := DT#2024-01-31-22:00:00", "Duration : TIME := T#8h", "Finish : DT"],
            body: &["LD Begin", "ADD_DT_TIME Duration", "ST Finish"],
        }),
    },
    Function {
        name: "SUB_TIME",
        title: "difference of durations",
        inputs: &[
            Parameter::of("IN1", ElementaryType::Time, "duration"),
            Parameter::of("IN2", ElementaryType::Time, "duration"),
        ],
        extensible: false,
        result: ParameterType::Elementary(ElementaryType::Time),
        formula: Formula::new(difference),
        page: FunctionPage::Own(Page {
            about: "IN1 minus IN2, two TIMEs. The current result is IN1. The difference may be negative \
                    where the controller's TIME has a sign.",
            variables: &["Allowed : TIME := T#30s", "Elapsed : TIME := T#12s", "Rest : TIME"],
            body: &["LD Allowed", "SUB_TIME Elapsed", "ST Rest"],
        }),
    },
    Function {
        name: "SUB_DATE_DATE",
        title: "time between dates",
        inputs: &[
            Parameter::of("IN1", ElementaryType::Date, "later date"),
            Parameter::of("IN2", ElementaryType::Date, "earlier date"),
        ],
        extensible: false,
        result: ParameterType::Elementary(ElementaryType::Time),
        formula: Formula::new(difference),
        page: FunctionPage::Own(Page {
            about: "The TIME from IN2 to IN1, two DATEs, in whole days. The current result is IN1, the \
                    later date for a positive result.",
            variables: &["Due : DATE := D#2024-03-01", "Today : DATE := D#2024-02-28", "Rest : TIME"],
            body: &["LD Due", "SUB_DATE_DATE Today", "ST Rest"],
        }),
    },
    Function {
        name: "SUB_TOD_TIME",
        title: "earlier time of day",
        inputs: &[
            Parameter::of("IN1", ElementaryType::TimeOfDay, "time of day"),
            Parameter::of("IN2", ElementaryType::Time, "duration"),
        ],
        extensible: false,
        result: ParameterType::Elementary(ElementaryType::TimeOfDay),
        formula: Formula::new(difference),
        page: FunctionPage::Own(Page {
            about: "A time of day moved back by a TIME. The current result is the TOD. The standard does \
                    not say what comes before midnight.",
            variables: &["Opening : TOD := TOD#07:00:00", "Warmup : TIME := T#45m", "Heating : TOD"],
            body: &["LD Opening", "SUB_TOD_TIME Warmup", "ST Heating"],
        }),
    },
    Function {
        name: "SUB_TOD_TOD",
        title: "time between times of day",
        inputs: &[
            Parameter::of("IN1", ElementaryType::TimeOfDay, "later time of day"),
            Parameter::of("IN2", ElementaryType::TimeOfDay, "earlier time of day"),
        ],
        extensible: false,
        result: ParameterType::Elementary(ElementaryType::Time),
        formula: Formula::new(difference),
        page: FunctionPage::Own(Page {
            about: "The TIME from IN2 to IN1, two times of day. The current result is IN1. Across \
                    midnight the result is negative; add T#24h then.",
            variables: &["Finish : TOD := TOD#14:00:00", "Begin : TOD := TOD#06:15:00", "Worked : TIME"],
            body: &["LD Finish", "SUB_TOD_TOD Begin", "ST Worked"],
        }),
    },
    Function {
        name: "SUB_DT_TIME",
        title: "earlier date and time",
        inputs: &[
            Parameter::of("IN1", ElementaryType::DateAndTime, "date and time"),
            Parameter::of("IN2", ElementaryType::Time, "duration"),
        ],
        extensible: false,
        result: ParameterType::Elementary(ElementaryType::DateAndTime),
        formula: Formula::new(difference),
        page: FunctionPage::Own(Page {
            about: "A date and time moved back by a TIME. The current result is the DT.",
            variables: &[
                "Delivery : DT := DT#2024-03-01-08:00:00",
                "Transit : TIME := T#36h",
                "Loading : DT",
            ],
            body: &["LD Delivery", "SUB_DT_TIME Transit", "ST Loading"],
        }),
    },
    Function {
        name: "SUB_DT_DT",
        title: "time between dates and times",
        inputs: &[
            Parameter::of("IN1", ElementaryType::DateAndTime, "later date and time"),
            Parameter::of("IN2", ElementaryType::DateAndTime, "earlier date and time"),
        ],
        extensible: false,
        result: ParameterType::Elementary(ElementaryType::Time),
        formula: Formula::new(difference),
        page: FunctionPage::Own(Page {
            about: "The TIME from IN2 to IN1, two dates with times. The current result is IN1. A TIME of \
                    32 bits in milliseconds holds some 24 days only, so a longer distance may not fit.",
            variables: &[
                "Finish : DT := DT#2024-03-01-08:00:00",
                "Begin : DT := DT#2024-02-28-20:30:00",
                "Lasted : TIME",
            ],
            body: &["LD Finish", "SUB_DT_DT Begin", "ST Lasted"],
        }),
    },
    Function {
        name: "MUL_TIME",
        title: "multiple of a duration",
        inputs: &[
            Parameter::of("IN1", ElementaryType::Time, "duration"),
            Parameter::any("IN2", GenericType::AnyNum, "factor"),
        ],
        extensible: false,
        result: ParameterType::Elementary(ElementaryType::Time),
        formula: Formula::new(product),
        page: FunctionPage::Own(Page {
            about: "A TIME multiplied by a number of any type. The current result is the TIME. This is \
                    the third edition's name; the second calls it `MULTIME`.",
            variables: &["Cycle : TIME := T#1.5s", "Total : TIME"],
            body: &["LD Cycle", "MUL_TIME 12", "ST Total"],
        }),
    },
    Function {
        name: "MULTIME",
        title: "multiple of a duration",
        inputs: &[
            Parameter::of("IN1", ElementaryType::Time, "duration"),
            Parameter::any("IN2", GenericType::AnyNum, "factor"),
        ],
        extensible: false,
        result: ParameterType::Elementary(ElementaryType::Time),
        formula: Formula::new(product),
        page: FunctionPage::Own(Page {
            about: "A TIME multiplied by a number of any type. The current result is the TIME. This is \
                    the second edition's name; the third calls it `MUL_TIME`.",
            variables: &["Cycle : TIME := T#1.5s", "Total : TIME"],
            body: &["LD Cycle", "MULTIME 12", "ST Total"],
        }),
    },
    Function {
        name: "DIV_TIME",
        title: "part of a duration",
        inputs: &[
            Parameter::of("IN1", ElementaryType::Time, "duration"),
            Parameter::any("IN2", GenericType::AnyNum, "divisor"),
        ],
        extensible: false,
        result: ParameterType::Elementary(ElementaryType::Time),
        formula: Formula::new(quotient),
        page: FunctionPage::Own(Page {
            about: "A TIME divided by a number of any type. The current result is the TIME; a divisor of \
                    0 is an error. This is the third edition's name; the second calls it `DIVTIME`.",
            variables: &["Run : TIME := T#1h", "Part : TIME"],
            body: &["LD Run", "DIV_TIME 4", "ST Part"],
        }),
    },
    Function {
        name: "DIVTIME",
        title: "part of a duration",
        inputs: &[
            Parameter::of("IN1", ElementaryType::Time, "duration"),
            Parameter::any("IN2", GenericType::AnyNum, "divisor"),
        ],
        extensible: false,
        result: ParameterType::Elementary(ElementaryType::Time),
        formula: Formula::new(quotient),
        page: FunctionPage::Own(Page {
            about: "A TIME divided by a number of any type. The current result is the TIME; a divisor of \
                    0 is an error. This is the second edition's name; the third calls it `DIV_TIME`.",
            variables: &["Run : TIME := T#1h", "Part : TIME"],
            body: &["LD Run", "DIVTIME 4", "ST Part"],
        }),
    },
    Function {
        name: "CONCAT_DATE_TOD",
        title: "date and time from its parts",
        inputs: &[
            Parameter::of("IN1", ElementaryType::Date, "date"),
            Parameter::of("IN2", ElementaryType::TimeOfDay, "time of day"),
        ],
        extensible: false,
        result: ParameterType::Elementary(ElementaryType::DateAndTime),
        formula: Formula::new(|inputs| Ok(Datum::Whole(inputs.whole(0) * NS_OF_DAY + inputs.whole(1)))),
        page: FunctionPage::Own(Page {
            about: "A date and a time of day joined to a DT. The current result is the DATE. \
                    `DT_TO_DATE` and `DT_TO_TOD` take it apart again.",
            variables: &["Day : DATE := D#2024-01-31", "Hour : TOD := TOD#12:30:00", "Moment : DT"],
            body: &["LD Day", "CONCAT_DATE_TOD Hour", "ST Moment"],
        }),
    },
];
