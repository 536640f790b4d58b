//! How long things take on a line of 9600 bit/s, and how long the bytes take that must travel. Both are the time of the
//! line, not of a computer, so they are the same everywhere.
//!
//! What must travel are frames as full as they can be (64 bytes of memory), with their addresses and sums: for a
//! download the old parameters and the old program (which are kept), the words that change, and the new parameters and
//! the new program (which are compared). Who the PLC is, its mode, orders and sums come on top of that. The PLC answers
//! at once; a real one does so at the end of its scan.

use crate::loopback::{Loopback, words};
use rungwise::link::frame::{BITS_PER_BYTE, MOST_DATA, framed};
use rungwise::link::plc::{Faults, Plc, Server};
use rungwise::link::{Address, Command, Extended, Mode, Point, Program, Switch, Watch};
use rungwise::machine_code::ParameterBlock;
use rungwise::target::{Model, Target};
use std::ops::Range;
use std::time::Duration;

/// How long something took, and how long it has to take.
pub struct LineTime {
    pub took: Duration,
    pub least: Duration,
}

impl LineTime {
    /// How many times as long as it has to.
    pub fn ratio(&self) -> f64 {
        self.took.as_secs_f64() / self.least.as_secs_f64()
    }
}

/// Bytes of a request and its answer, which follow each other.
fn exchange(command: &Command) -> usize {
    framed(&command.body()).len() + command.expected().bytes()
}

fn pieces(bytes: usize, command: impl Fn(usize) -> Command) -> usize {
    (0..bytes).step_by(MOST_DATA).map(|done| exchange(&command((bytes - done).min(MOST_DATA)))).sum()
}

fn reads(bytes: usize) -> usize {
    pieces(bytes, |length| Address::<Program>::new(0x8000).read(length))
}

fn writes(bytes: usize) -> usize {
    pieces(bytes, |length| Address::<Program>::new(0x8000).write(&[0; MOST_DATA][..length]))
}

fn on_the_line(bytes: usize) -> Duration {
    Duration::from_secs(1) * (bytes as u32 * BITS_PER_BYTE as u32) / 9600
}

/// A program of 4,000 steps with a bit of everything; another `kind` differs from it in each rung.
pub fn program(kind: usize) -> Vec<u16> {
    let rung = |n: usize| match n % 5 {
        0 => format!("LD X{:o}\nOR M{1}\nANI X1\nOUT M{1}\n", (n + kind) % 64, (n + kind) % 500),
        1 => format!("LD M{}\nOUT T{} K{}\n", (n + kind) % 500, n % 200, n % 1000 + 1 + kind),
        2 => format!(
            "LD M{}\nMPS\nAND M{}\nOUT Y{:o}\nMPP\nSET S{}\n",
            n % 500,
            n % 77 + kind,
            n % 64,
            n % 450
        ),
        3 => format!("LD> D{} K{}\nMOV K{} D{}\n", n % 500, n % 900 + kind, n % 300 + kind, n % 400),
        _ => format!("LDI X{:o}\nOUT C{} D{}\n", (n + kind) % 64, n % 90, (n + kind) % 200),
    };
    let mut list = String::new();
    let mut steps = 0;
    let mut number = 0;
    while steps < 3_990 {
        let rung = rung(number);
        steps += words(&format!("{rung}END\n"), Model::Fx2n).len() - 1;
        list += &rung;
        number += 1;
    }
    list += &"NOP\n".repeat(3_999 - steps);
    words(&format!("{list}END\n"), Model::Fx2n)
}

/// The same program with three contacts the other way round, far from each other.
pub fn three_changed(program: &[u16]) -> Vec<u16> {
    let mut after = program.to_vec();
    let contacts: Vec<usize> = (0..after.len()).filter(|at| after[*at] >> 12 == 2).collect();
    for place in [10, contacts.len() / 2, contacts.len() - 10] {
        after[contacts[place]] ^= 0x1000;
    }
    after
}

/// The lengths of what is written at least: words that differ, with those between them where that is shorter than
/// another request.
pub fn stretches(before: &[u16], after: &[u16]) -> Vec<usize> {
    // A request and its answer are 14 bytes beyond the digits, four of which are a word.
    const GAP: usize = 3;
    let mut stretches: Vec<Range<usize>> = Vec::new();
    for at in (0..after.len()).filter(|at| before[*at] != after[*at]) {
        match stretches.last_mut() {
            Some(last) if at - last.end <= GAP => last.end = at + 1,
            _ => stretches.push(at..at + 1),
        }
    }
    stretches.into_iter().map(|stretch| stretch.len()).collect()
}

/// A PLC that runs `before`, in the place of which a host puts `after`; `changed` are the lengths in words of the
/// stretches in which they differ.
pub fn download(before: &[u16], after: &[u16], changed: &[usize]) -> LineTime {
    let target = Target::of(Model::Fx2n);
    let mut plc = Plc::new(target, 10_000_000);
    plc.load(before);
    plc.power_on(Switch::Run, 0);
    let line = Loopback::with(Server::new(plc), Faults::default());
    let ended = line.host().and_then(|mut host| {
        let plan = host.plan(after, target, &mut |_| {})?;
        host.download(&plan, true, &mut |_| {}).map_err(|failure| failure.cause)
    });
    assert!(ended.is_ok_and(|report| report.mode == Mode::Run), "the line is good");
    let took = Duration::from_nanos(line.ends().now_ns as u64);
    let block = 2 * ParameterBlock::WORDS;
    let kept = reads(block) + reads(2 * before.len());
    let written: usize = changed.iter().map(|words| writes(2 * words)).sum();
    let compared = reads(block) + reads(2 * after.len());
    LineTime { took, least: on_the_line(kept + written + compared) }
}

/// A look at 50 relays and 50 registers that lie anywhere.
pub fn look() -> LineTime {
    let target = Target::of(Model::Fx2n);
    let line = Loopback::new(Model::Fx2n);
    let names = (0..50).flat_map(|n| [format!("M{}", n * 37), format!("D{}", n * 91)]);
    let points: Vec<Point> = names.filter_map(|name| Point::named(&name, target)).collect();
    assert_eq!(points.len(), 100);
    let mut watch = Watch::new(points);
    let looked = line.host().and_then(|mut host| {
        // The list is sent once.
        host.poll(&mut watch)?;
        let start = host.line().now();
        let looks = 20;
        for _ in 0..looks {
            host.poll(&mut watch)?;
        }
        Ok((host.line().now() - start) / looks)
    });
    let took = looked.unwrap_or_else(|error| panic!("{error:?}"));
    let bytes = 50 * 2 + 50usize.div_ceil(8);
    let least = on_the_line(pieces(bytes, |length| Extended::WATCH_RESULT.read(length)));
    LineTime { took, least }
}
