//! Peers that are no PLC, or one gone mad: the host ends, in a time that can be told beforehand, with a clear error; and
//! hosts that send anything at all to the virtual PLC.

use crate::loopback::SCAN_NS;
use rungwise::link::frame::{ACK, Arrival, ENQ, Frames, NAK, STX, framed};
use rungwise::link::plc::{Plc, Server};
use rungwise::link::{Host, Line, LinkError, Patience, Point, Switch, Transport, Watch};
use rungwise::target::{Model, Target};
use std::collections::VecDeque;
use std::io;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// What a peer sends by itself, when it sends it, and what it answers.
trait Peer: Send {
    /// What comes back for bytes that were sent.
    fn answer(&mut self, sent: &[u8]) -> Vec<u8>;

    /// A byte that comes by itself, and how long after the last one.
    fn by_itself(&mut self) -> Option<(Duration, u8)> {
        None
    }
}

/// A line to such a peer, with a time of its own: a byte takes what it takes at 9600 bit/s.
struct Hostile<P> {
    peer: P,
    on_the_way: VecDeque<u8>,
    now: Duration,
    next: Duration,
    sent: Arc<AtomicUsize>,
    clock: Arc<Mutex<Duration>>,
}

const BYTE: Duration = Duration::from_micros(1042);

impl<P: Peer> Hostile<P> {
    fn new(peer: P) -> Hostile<P> {
        let (sent, clock) = Default::default();
        Hostile { peer, on_the_way: VecDeque::new(), now: Duration::ZERO, next: Duration::ZERO, sent, clock }
    }
}

impl<P: Peer> Transport for Hostile<P> {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        assert!(self.sent.fetch_add(1, Ordering::Relaxed) < 20_000, "the host goes on for ever");
        self.now += BYTE * bytes.len() as u32;
        self.on_the_way.extend(self.peer.answer(bytes));
        Ok(())
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        let end = self.now + wait;
        let by_itself = self.on_the_way.pop_front().map(|byte| (self.now + BYTE, byte));
        let due = by_itself
            .or_else(|| self.peer.by_itself().map(|(after, byte)| (self.next + after.max(BYTE), byte)));
        let count = match due {
            Some((due, byte)) if due <= end.max(self.now + BYTE) => {
                self.now = self.now.max(due);
                self.next = self.now;
                buffer[0] = byte;
                1
            }
            _ => {
                self.now = end;
                0
            }
        };
        *self.clock.lock().unwrap() = self.now;
        assert!(self.now < Duration::from_secs(24 * 3600), "the host waits for ever");
        Ok(count)
    }

    fn set_baud(&mut self, _baud: u32) -> io::Result<()> {
        Ok(())
    }

    fn now(&self) -> Duration {
        self.now
    }
}

/// Says the same for ever.
struct Endless {
    before: Option<u8>,
    again: u8,
    after: Duration,
}

impl Peer for Endless {
    fn answer(&mut self, _sent: &[u8]) -> Vec<u8> {
        Vec::new()
    }

    fn by_itself(&mut self) -> Option<(Duration, u8)> {
        Some((self.after, self.before.take().unwrap_or(self.again)))
    }
}

/// A PLC whose answers pass through somebody.
struct Twisted<F> {
    server: Server,
    twist: F,
    requests: usize,
}

impl<F: FnMut(usize, &[u8], Vec<u8>) -> Vec<u8> + Send> Peer for Twisted<F> {
    fn answer(&mut self, sent: &[u8]) -> Vec<u8> {
        let take = |byte: &u8| self.server.take(*byte, 0);
        let answer: Vec<u8> = sent.iter().filter_map(take).flat_map(|answer| answer.bytes).collect();
        self.requests += 1;
        (self.twist)(self.requests, sent, answer)
    }
}

fn twisted<F: FnMut(usize, &[u8], Vec<u8>) -> Vec<u8> + Send>(twist: F) -> Twisted<F> {
    Twisted { server: Server::new(Plc::new(Target::of(Model::Fx2n), SCAN_NS)), twist, requests: 0 }
}

/// All that a host does, until something fails; the error, and how long it took.
fn used<P: Peer>(peer: P) -> (Result<(), LinkError>, Duration) {
    let line = Hostile::new(peer);
    let clock = Arc::clone(&line.clock);
    let all = || -> Result<(), LinkError> {
        let mut host = Host::connect(Line::new(line, Patience::default(), Arc::default()))?;
        host.status()?;
        host.upload(&mut |_| {})?;
        let points =
            ["X0", "D0", "T0", "C200"].map(|name| Point::named(name, Target::of(Model::Fx2n)).unwrap());
        host.read(&points)?;
        host.poll(&mut Watch::new(points.to_vec()))?;
        host.write(points[1], 5)?;
        host.set_speed(19_200)?;
        let target = host.identity().target;
        let plan = host.plan(&[0x2400, 0xC500, 0x000F], target, &mut |_| {})?;
        host.download(&plan, true, &mut |_| {}).map_err(|failure| failure.cause)?;
        Ok(())
    };
    let end = all();
    let took = *clock.lock().unwrap();
    (end, took)
}

#[test]
fn somebody_who_never_stops_talking() {
    for again in [0, b'A', STX, ACK, NAK, ENQ, 3, 0xFF] {
        for before in [None, Some(STX), Some(ACK)] {
            for after in [Duration::from_millis(10), Duration::from_millis(900)] {
                let (end, took) = used(Endless { before, again, after });
                let Err(error) = end else { panic!("{again:02X} is no PLC") };
                assert!(took < Duration::from_secs(60), "{again:02X} {after:?}: {took:?}");
                let is_clear = matches!(error, LinkError::NoAnswer | LinkError::Noise | LinkError::Occupied)
                    || matches!(error, LinkError::Refused { .. });
                assert!(is_clear, "{again:02X} {after:?}: {error:?}");
            }
        }
    }
}

#[test]
fn a_byte_an_hour() {
    let (end, took) = used(Endless { before: None, again: ACK, after: Duration::from_secs(3600) });
    assert_eq!(end, Err(LinkError::NoAnswer));
    assert!(took < Duration::from_secs(10), "{took:?}");
}

#[test]
fn answers_that_fit_no_request() {
    type Twist = fn(usize, &[u8], Vec<u8>) -> Vec<u8>;
    let greeted = |twist: Twist| {
        move |request: usize, sent: &[u8], answer: Vec<u8>| {
            if sent == [ENQ] { answer } else { twist(request, sent, answer) }
        }
    };
    let twists: [(&str, Twist); 8] = [
        ("an echo", |_, sent, _| sent.to_vec()),
        ("done, whatever it was", |_, _, _| vec![ACK]),
        ("no, whatever it was", |_, _, _| vec![NAK]),
        ("nothing in a frame", |_, _, _| framed(b"")),
        ("always too much", |_, _, _| framed(&[b'0'; 137])),
        ("a byte too few", |_, _, mut answer| answer.drain(..answer.len().saturating_sub(1)).collect()),
        ("a frame that does not end", |_, _, _| [&[STX], &[b'0'; 2000][..]].concat()),
        ("the address of a search", |_, _, _| framed(b"18060")),
    ];
    for (name, twist) in twists {
        let (end, took) = used(twisted(greeted(twist)));
        assert!(end.is_err(), "{name}");
        assert!(took < Duration::from_secs(60), "{name}: {took:?}");
    }
}

#[test]
fn a_plc_that_goes_mad_after_any_request() {
    let mut done = None;
    for good in 2.. {
        let mut random = fastrand::Rng::with_seed(good as u64);
        let mad = twisted(move |request, _, answer| {
            if request <= good { answer } else { (0..random.usize(0..300)).map(|_| random.u8(..)).collect() }
        });
        let (end, took) = used(mad);
        assert!(took < Duration::from_secs(90), "{good}: {took:?}");
        if end.is_ok() {
            done = Some(good);
            break;
        }
    }
    assert!(done.is_some_and(|good| good > 30), "{done:?}");
}

/// Numbers that a PLC would never say, in frames that are right.
#[test]
fn a_plc_that_lies_in_perfect_form() {
    for seed in 0..300 {
        let mut random = fastrand::Rng::with_seed(seed);
        let lying = twisted(move |_, sent, answer| {
            // Who it is, and barriers, are told truly; of the rest some bytes are others.
            let is_identity = sent.windows(4).any(|four| four == b"00E0" || four == b"00EC");
            let Some([STX, body @ .., 3, _, _]) = Some(&answer[..]).filter(|_| !is_identity) else {
                return answer;
            };
            let mut body = body.to_vec();
            for digit in &mut body {
                if random.u8(0..20) == 0 {
                    *digit = *random.choice(b"0123456789ABCDEF").unwrap();
                }
            }
            framed(&body)
        });
        let (end, took) = used(lying);
        assert!(took < Duration::from_secs(3600), "{seed}: {end:?} after {took:?}");
    }
}

/// Bodies of requests, near enough to right ones.
fn body(random: &mut fastrand::Rng) -> Vec<u8> {
    let verb: &[u8] = random
        .choice([
            b"0".as_slice(),
            b"1",
            b"7",
            b"8",
            b"E00",
            b"E01",
            b"E10",
            b"E11",
            b"E7",
            b"E8",
            b"E41",
            b"B",
            b"E6",
            b"A",
        ])
        .unwrap();
    let edges: [u16; 13] =
        [0, 0x8000, 0x805C, 0xBED8, 0xFFFF, 0x7FC0, 0x1400, 0x1790, 0x0E4E, 0x0E02, 0x4000, 0x7E7E, 0x0C00];
    let near = random.choice(edges).unwrap().wrapping_add(random.u16(0..80)).wrapping_sub(40);
    let address = if random.bool() { near } else { random.u16(..) };
    let length = random.u8(0..0x44);
    let mut text = [verb, format!("{address:04X}").as_bytes()].concat();
    match verb {
        b"7" | b"8" | b"E7" | b"E8" => {}
        b"B" | b"E6" | b"A" => text = [verb, &[b'0' + random.u8(0..6)][..usize::from(verb != b"B")]].concat(),
        b"E41" => text.extend(format!("{:04X}", random.u16(..)).bytes()),
        _ => {
            text.extend(format!("{length:02X}").bytes());
            if verb.last() == Some(&b'1') || verb == b"E10" {
                text.extend((0..length).flat_map(|_| format!("{:02X}", random.u8(..)).into_bytes()));
            }
        }
    }
    if random.u8(0..20) == 0 {
        text.truncate(random.usize(0..=text.len()));
    }
    text
}

#[test]
fn a_host_that_sends_anything_at_all() {
    for seed in 0..400 {
        let mut random = fastrand::Rng::with_seed(seed);
        let model = [Model::Fx1s, Model::Fx1n, Model::Fx2n, Model::Fx3u][seed as usize % 4];
        let mut plc = Plc::new(Target::of(model), SCAN_NS);
        plc.power_on(if random.bool() { Switch::Run } else { Switch::Stop }, 0);
        let mut server = if random.bool() { Server::new(plc) } else { Server::stepped(plc, SCAN_NS) };
        let mut now_ns = 0;
        for _ in 0..150 {
            now_ns += random.i64(0..3 * SCAN_NS);
            server.advance(now_ns);
            let bytes: Vec<u8> = match random.u8(0..10) {
                0 => (0..random.usize(0..400)).map(|_| random.u8(..)).collect(),
                1 => vec![ENQ],
                _ => framed(&body(&mut random)),
            };
            let mut frames = Frames::default();
            for byte in bytes {
                let Some(answer) = server.take(byte, now_ns) else { continue };
                let arrivals: Vec<Arrival> =
                    answer.bytes.iter().filter_map(|byte| frames.take(*byte)).collect();
                let [Arrival::Acknowledge | Arrival::Refusal | Arrival::Body(_)] = arrivals[..] else {
                    panic!("seed {seed}: no answer is like this: {:?}", answer.bytes);
                };
            }
        }
        // And then it still answers.
        let asked = framed(b"00E0202");
        let answer: Vec<u8> = asked
            .iter()
            .filter_map(|byte| server.take(*byte, now_ns))
            .flat_map(|answer| answer.bytes)
            .collect();
        assert_eq!(answer.len(), 8, "seed {seed}");
        // Nothing of it is too much for what is kept without power.
        let saved = server.plc_mut().save();
        if let Some(saved) = saved {
            assert!(Plc::restored(&saved, SCAN_NS).is_ok(), "seed {seed}");
        }
    }
}
