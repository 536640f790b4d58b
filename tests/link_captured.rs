//! Whole sessions on the programming port, byte by byte: those of the maker's tools with real PLCs, and those of our host.
//!
//! In `captured/` all bytes stand as they were on the line, sums too, and no table and no encoder of ours is asked: host
//! and virtual PLC share those, and if both were wrong alike they would understand each other.

use crate::loopback::{Loopback, words};
use rungwise::link::frame::{ACK, ENQ, ETX, NAK, STX};
use rungwise::link::{Host, Line, Mode, Patience, Point, Transport, Watch};
use rungwise::target::{Model, Target};
use std::collections::VecDeque;
use std::io;
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// A request and its answer, as they stand in a row.
struct Exchange {
    request: &'static str,
    answer: &'static str,
}

fn session(text: &'static str) -> impl Iterator<Item = Exchange> {
    let rows = text.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
    rows.map(|row| {
        let (request, answer) = row.split_once(" > ").unwrap();
        Exchange { request, answer }
    })
}

/// The bytes of `ENQ`, `ACK`, `NAK`, or of a body and its sum; an empty body has its sum alone.
fn bytes(words: &str) -> Vec<u8> {
    match words {
        "ENQ" => vec![ENQ],
        "ACK" => vec![ACK],
        "NAK" => vec![NAK],
        _ => {
            let (body, sum) = words.split_once(' ').unwrap();
            [&[STX], body.as_bytes(), &[ETX], sum.as_bytes()].concat()
        }
    }
}

/// What came instead of the answer of a row, if that is another one.
fn differs(answer: &[u8], row: &str) -> Option<String> {
    let is_same = match row.split_once('…') {
        None => answer == bytes(row),
        Some((before, rest)) => {
            let text = String::from_utf8_lossy(answer);
            text.starts_with(&format!("\x02{before}")) && text.contains(rest.trim_end_matches('…'))
        }
    };
    (!is_same).then(|| answer.escape_ascii().to_string())
}

/// A virtual PLC of this model answers each request of the session as its rows say.
fn check_plc(model: Model, text: &'static str) {
    let line = Loopback::new(model);
    for (number, Exchange { request, answer }) in session(text).enumerate() {
        let mut ends = line.ends();
        // A request a scan.
        ends.now_ns += 100_000_000;
        let now_ns = ends.now_ns;
        ends.server.advance(now_ns);
        let came =
            bytes(request).iter().filter_map(|byte| ends.server.take(*byte, now_ns)).collect::<Vec<_>>();
        let came: Vec<u8> = came.into_iter().flat_map(|answer| answer.bytes).collect();
        assert_eq!(differs(&came, answer), None, "{number}: {request}: {answer}");
    }
}

#[test]
fn a_virtual_fx2n_answers_the_makers_tool_as_a_real_one() {
    check_plc(Model::Fx2n, include_str!("captured/maker-fx2n.txt"));
}

#[test]
fn a_virtual_fx1s_answers_the_makers_tool_as_a_real_one() {
    check_plc(Model::Fx1s, include_str!("captured/maker-fx1s.txt"));
}

/// The other end of a line on which everything happens as it is written.
struct Script {
    left: Arc<Mutex<VecDeque<Exchange>>>,
    pending: VecDeque<u8>,
    now: Duration,
}

impl Transport for Script {
    fn send(&mut self, sent: &[u8]) -> io::Result<()> {
        let Exchange { request, answer } = self.left.lock().unwrap().pop_front().expect("no more is asked");
        assert_eq!(sent.escape_ascii().to_string(), bytes(request).escape_ascii().to_string());
        self.pending.extend(bytes(answer));
        Ok(())
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        let count = self.pending.len().min(buffer.len());
        for (place, byte) in buffer.iter_mut().zip(self.pending.drain(..count)) {
            *place = byte;
        }
        if count == 0 {
            self.now += wait;
        }
        Ok(count)
    }

    fn set_baud(&mut self, _baud: u32) -> io::Result<()> {
        Ok(())
    }

    fn now(&self) -> Duration {
        self.now
    }
}

/// The host sends the requests of the session and no others; the virtual PLC gives their answers.
fn check_host(model: Model, text: &'static str) {
    let left = Arc::new(Mutex::new(session(text).collect::<VecDeque<_>>()));
    let script = Script { left: Arc::clone(&left), pending: VecDeque::new(), now: Duration::ZERO };
    let mut host = Host::connect(Line::new(script, Patience::default(), Arc::default())).unwrap();
    let target = Target::of(model);
    let point = |name: &str| Point::named(name, target).unwrap();
    let program = [0x2400, 0xC500, 0x000F];
    let plan = host.plan(&program, target, &mut |_| {}).unwrap();
    let report = host.download(&plan, true, &mut |_| {}).unwrap();
    assert_eq!(report.mode, Mode::Run);
    host.write(point("X0"), 1).unwrap();
    host.write(point("D123"), 1).unwrap();
    assert_eq!(host.read(&["Y0", "D123"].map(point)).unwrap(), [1, 1]);
    let mut watch = Watch::new(["D0", "D10", "T0", "X0", "M0", "Y1", "M8000"].map(point).to_vec());
    for _ in 0..2 {
        assert_eq!(host.poll(&mut watch).unwrap(), [0, 0, 0, 1, 0, 0, 1]);
    }
    host.stop().unwrap();
    assert_eq!(host.upload(&mut |_| {}).unwrap().image.program(), program);
    assert_eq!(
        left.lock().unwrap().iter().map(|row| row.request).collect::<Vec<_>>(),
        [""; 0],
        "all was said"
    );
    check_plc(model, text);
}

#[test]
fn a_host_says_to_an_fx2n_what_was_recorded() {
    check_host(Model::Fx2n, include_str!("captured/host-fx2n.txt"));
}

#[test]
fn a_host_says_to_an_fx1s_what_was_recorded() {
    check_host(Model::Fx1s, include_str!("captured/host-fx1s.txt"));
}

/// Programs that were recorded are what their words say, in both directions.
#[test]
fn the_words_of_recorded_programs_are_their_instructions() {
    let memory = "002400C5012401C5002502D5012502E50F00";
    let list = "LD X0\nOUT Y0\nLD X1\nOUT Y1\nLD Y0\nSET Y2\nLD Y1\nRST Y2\nEND\n";
    let encoded = words(list, Model::Fx2n);
    let written: String =
        encoded.iter().flat_map(|word| word.to_le_bytes()).map(|b| format!("{b:02X}")).collect();
    assert_eq!(written, memory);
    assert_eq!(rungwise::machine_code::decode(&encoded, Model::Fx2n).text, list);
}
