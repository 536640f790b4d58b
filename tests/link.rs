//! The programming port: frames as they were recorded, both maps, and what a host does with a virtual PLC.

use crate::loopback::{Loopback, words};
use rungwise::link::Logbook;
use rungwise::link::frame::{ACK, ENQ, NAK, framed};
use rungwise::link::plc::{Faults, Plc, Server};
use rungwise::link::{
    Address, BitAddress, Command, Extended, Fate, Host, Line, LinkError, Lying, Map, Mode, Part, Patience,
    Plain, Point, Program, Space, Stage, Watch,
};
use rungwise::machine_code::{END, Image, ParameterBlock};
use rungwise::simulate::Value;
use rungwise::target::{Device, DeviceKind, Model, Target};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

const MODELS: [Model; 4] = [Model::Fx1s, Model::Fx1n, Model::Fx2n, Model::Fx3u];

fn device(kind: DeviceKind, number: u32) -> Device {
    Device::new(kind, number)
}

fn bit<M: Map>(kind: DeviceKind, number: u32) -> BitAddress<M> {
    M::bit(device(kind, number), Part::Contact).unwrap()
}

/// The frame of a request, without its control bytes: body and sum.
fn check_frame(command: &Command, body: &str, sum: &str) {
    let frame = framed(&command.body());
    let wanted = [b"\x02", body.as_bytes(), b"\x03", sum.as_bytes()].concat();
    assert_eq!(frame, wanted, "{command:?}: {}", String::from_utf8_lossy(&frame));
    assert_eq!(Command::of_body(body.as_bytes()).as_ref(), Some(command), "{body}");
}

#[test]
fn requests_are_those_that_were_recorded() {
    use DeviceKind::{D, M, X, Y};
    let word = |number| Plain::word(device(D, number)).unwrap().0;
    check_frame(&word(123).read(4), "010F604", "74");
    check_frame(&word(123).write(&[1, 0]), "110F6020100", "34");
    check_frame(&bit::<Plain>(X, 2).force(true), "70204", "00");
    check_frame(&bit::<Plain>(Y, 0).force(true), "70005", "FF");
    check_frame(&bit::<Plain>(M, 8).force(false), "80808", "0B");
    check_frame(&word(8001).read(2), "00E0202", "6C");
    check_frame(&word(8101).read(2), "00ECA02", "8E");
    check_frame(&Program::START.read(0x40), "E01800040", "D5");
    check_frame(&Address::<Program>::new(0x8040).read(0x1C), "E0180401C", "E9");
    check_frame(&Address::<Program>::new(0x805C).write(&[0, 0x24]), "E11805C020024", "B2");
    check_frame(&bit::<Extended>(M, 8118).force(true), "E7760E", "61");
    check_frame(&bit::<Extended>(M, 8118).force(false), "E8760E", "62");
    check_frame(&bit::<Extended>(M, 8037).force(true), "E7250E", "5B");
    check_frame(&bit::<Extended>(M, 8037).force(false), "E8250E", "5C");
    check_frame(&bit::<Extended>(M, 8000).byte().0.read(1), "E0001C001", "DD");
    check_frame(&Command::Search { from: 0x805C, word: [0x0F, 0] }, "E41805C0F00", "63");
    check_frame(&Command::Commit, "B", "45");
    check_frame(&Command::Clear(1), "E61", "AF");
}

#[test]
fn each_device_is_found_where_it_lies() {
    fn check<M: Map>(target: &Target) -> usize {
        let mut found = 0;
        let devices = target.devices.iter();
        for device in devices.flat_map(|range| (range.first..=range.last).map(|n| Device::new(range.kind, n)))
        {
            for part in [Part::Contact, Part::Coil] {
                let Some(address) = M::bit(device, part) else { continue };
                assert_eq!(M::at_bit(address.bit()), Some(Lying::Bit(device, part)));
                assert_eq!(M::at_byte(address.byte().0.byte()), None, "{device} is no word");
                found += 1;
            }
            let Some((address, width)) = M::word(device) else { continue };
            for byte in 0..width {
                assert_eq!(M::at_byte(address.byte() + byte), Some(Lying::Byte(device, byte)));
            }
            found += 1;
        }
        found
    }
    // S, X, Y, T, M, C and special M, contacts and coils; then the words of T, C, special D and D.
    let words = 256 + 256 + 256 + 8000;
    assert_eq!(check::<Plain>(Target::of(Model::Fx2n)), 1000 + 512 + 512 + 1536 + 512 + 256 + words);
    assert_eq!(check::<Extended>(Target::of(Model::Fx2n)), 1000 + 512 + 512 + 3072 + 512 + 256 + words);
}

/// The addresses of published tables, firmware and recordings, in hexadecimal: `None` for what a map has not.
#[test]
fn devices_lie_where_published_tables_say() {
    use DeviceKind::{C, D, M, S, T, X, Y};
    use Part::{Coil, Contact};
    let bits = [
        (S, 0, Contact, Some(0x0000), Some(0x1400)),
        (S, 999, Contact, Some(0x03E7), Some(0x17E7)),
        (X, 0, Contact, Some(0x0400), Some(0x1200)),
        (X, 0o377, Contact, Some(0x04FF), Some(0x12FF)),
        (Y, 0, Contact, Some(0x0500), Some(0x0C00)),
        (Y, 0o12, Contact, Some(0x050A), Some(0x0C0A)),
        (T, 0, Contact, Some(0x0600), Some(0x1000)),
        (M, 0, Contact, Some(0x0800), Some(0x0000)),
        (M, 1535, Contact, Some(0x0DFF), Some(0x05FF)),
        (M, 1536, Contact, None, Some(0x0600)),
        (M, 3071, Contact, None, Some(0x0BFF)),
        (C, 0, Contact, Some(0x0E00), Some(0x0F00)),
        (M, 8000, Contact, Some(0x0F00), Some(0x0E00)),
        // E7 760E, as it was recorded before a program is written.
        (M, 8118, Contact, Some(0x0F76), Some(0x0E76)),
        (T, 0, Coil, Some(0x1600), Some(0x2800)),
        (C, 0, Coil, Some(0x1E00), Some(0x2700)),
    ];
    for (kind, number, part, plain, extended) in bits {
        let own = device(kind, number);
        assert_eq!(Plain::bit(own, part).map(BitAddress::bit), plain, "{own} {part:?}");
        assert_eq!(Extended::bit(own, part).map(BitAddress::bit), extended, "{own} {part:?}");
    }
    let words = [
        (T, 5, (0x080A, 2), (0x100A, 2)),
        (C, 3, (0x0A06, 2), (0x0A06, 2)),
        (C, 201, (0x0C04, 4), (0x0C04, 4)),
        (D, 8001, (0x0E02, 2), (0x0E02, 2)),
        (D, 0, (0x1000, 2), (0x4000, 2)),
        (D, 123, (0x10F6, 2), (0x40F6, 2)),
        (D, 7999, (0x4E7E, 2), (0x7E7E, 2)),
    ];
    for (kind, number, plain, extended) in words {
        let own = device(kind, number);
        assert_eq!(Plain::word(own).map(|(at, width)| (at.byte(), width)), Some(plain), "{own}");
        assert_eq!(Extended::word(own).map(|(at, width)| (at.byte(), width)), Some(extended), "{own}");
    }
    assert_eq!([Extended::WATCH_LIST.byte(), Extended::WATCH_RESULT.byte()], [0x1400, 0x1790]);
}

#[test]
fn a_plc_says_who_it_is() {
    // D8001 as it was read from real ones, the low byte first: FX1S 2.10, FX1N 2.10, FX2N 3.10; an FX3U says 24232 here
    // and 16232 in D8101.
    for (model, word) in MODELS.into_iter().zip(["C256", "6266", "F65E", "A85E"]) {
        let line = Loopback::new(model);
        let mut host = line.host().unwrap();
        assert_eq!(host.identity().target.model, model);
        assert_eq!(host.mode().unwrap(), Mode::Stop);
        assert_eq!(line.ends().sent[0], ENQ, "the host greets first");
        assert_eq!(answers(&line, &framed(b"00E0202")), framed(word.as_bytes()), "{model:?}");
    }
    assert_eq!(answers(&Loopback::new(Model::Fx3u), &framed(b"00ECA02")), framed(b"683F"));
}

/// What a host sends to clear and to change the speed, as the maker's tools were recorded to do it: the program by these
/// four orders, and the speed by a digit. For devices and the faster speeds there is one source only.
#[test]
fn orders_to_clear_and_to_go_faster_are_those_that_were_recorded() {
    let line = Loopback::new(Model::Fx2n);
    let mut host = line.host().unwrap();
    let sent = |host: &mut Host<Loopback>, order: &dyn Fn(&mut Host<Loopback>) -> Result<(), LinkError>| {
        line.ends().sent.clear();
        order(host).unwrap();
        line.ends().sent.clone()
    };
    let all = |orders: &[&str]| orders.iter().flat_map(|body| framed(body.as_bytes())).collect::<Vec<u8>>();
    let program = sent(&mut host, &|host| host.clear(true));
    assert!(program.ends_with(&all(&["E61", "E60", "E63", "E62"])), "{}", program.escape_ascii());
    let devices = sent(&mut host, &|host| host.clear(false));
    assert!(devices.ends_with(&all(&["E64", "E63"])), "{}", devices.escape_ascii());
    for (baud, body) in [(19_200, "A1"), (38_400, "A2"), (57_600, "A3"), (115_200, "A5")] {
        let faster = sent(&mut host, &|host| host.set_speed(baud));
        assert!(faster.starts_with(&all(&[body])), "{baud}: {}", faster.escape_ascii());
    }
}

/// What a PLC answers to bytes.
fn answers(line: &Loopback, bytes: &[u8]) -> Vec<u8> {
    let mut ends = line.ends();
    bytes.iter().filter_map(|byte| ends.server.take(*byte, 0)).flat_map(|answer| answer.bytes).collect()
}

#[test]
fn a_plc_answers_as_recorded() {
    let line = Loopback::new(Model::Fx2n);
    let asks = |body: &str| answers(&line, &framed(body.as_bytes()));
    assert_eq!(answers(&line, &[ENQ]), [ACK]);
    assert_eq!(asks("00E0202"), framed(b"F65E"), "D8001 of an FX2N 3.10");
    assert_eq!(asks("00ECA02"), framed(b"F65E"));
    assert_eq!(asks("E0001C001"), framed(b"0A"), "STOP");
    assert_eq!(asks("E000E0602"), framed(b"1000"), "D8003");
    assert_eq!(asks("E000ECC02"), framed(b"0800"), "D8102");
    assert_eq!(asks("E01800808"), framed(b"2020202020202020"), "no keyword");
    assert_eq!(asks("E01800204"), framed(b"D0E00000"), "the sum of a blank memory");
    // A program in a short download, and where its END is.
    assert_eq!(asks("E7760E"), [ACK]);
    assert_eq!(asks("E11805C06002400C50F00"), [ACK]);
    assert_eq!(asks("E8760E"), [ACK]);
    assert_eq!(asks("B"), [ACK]);
    assert_eq!(asks("E41805C0F00"), framed(b"18060"));
    assert_eq!(asks("E41805C3412"), framed(b""));
    assert_eq!(asks("E01805C06"), framed(b"002400C50F00"));
    assert_eq!(asks("E8250E"), [ACK]);
    line.ends().server.advance(20_000_000);
    assert_eq!(asks("E0001C001"), framed(b"09"), "RUN");
    for wrong in
        ["", "X", "0", "00E02", "00E0200", "00E0241", "00E02G2", "E01FFF040", "1100002FF", "EC12345678"]
    {
        assert_eq!(asks(wrong), [NAK], "{wrong}");
    }
    let mut damaged = framed(b"00E0202");
    damaged[3] ^= 1;
    assert_eq!(answers(&line, &damaged), [NAK]);
    assert_eq!(answers(&line, b"noise \x03\x06\x15"), Vec::<u8>::new(), "nobody is asked outside a frame");
    // A new start ends what had begun, and nothing is kept of a frame without end.
    assert_eq!(answers(&line, &[b"\x0200E0", &framed(b"00E0202")[..]].concat()), framed(b"F65E"));
    assert_eq!(answers(&line, &[&b"\x02"[..], &[b'0'; 1000]].concat()), [NAK]);
}

/// A program with a bit of everything that can be seen from outside.
const MOTOR: &str = "LD X0\nOR Y0\nANI X1\nOUT Y0\nLD Y0\nOUT T0 K5\nLD T0\nOUT Y1\nLD X2\nOUT C0 K3\nLD M8000\nMOV D0 D1\nEND\n";

#[test]
fn what_was_downloaded_is_there_word_for_word_and_runs() {
    for model in MODELS {
        let line = Loopback::new(model);
        let mut host = line.host().unwrap();
        let program = words(MOTOR, model);
        let plan = host.plan(&program, Target::of(model), &mut |_| {}).unwrap();
        let mut stages = Vec::new();
        let report = host.download(&plan, true, &mut |progress| stages.push(progress)).unwrap();
        assert_eq!(report.mode, Mode::Run, "{model:?}");
        assert_eq!(host.upload(&mut |_| {}).unwrap().image.program(), program, "{model:?}");
        let last = stages.last().unwrap();
        assert_eq!(last.done, last.total, "{stages:?}");
        let point = |name: &str| Point::named(name, Target::of(model)).unwrap();
        host.write(point("X0"), 1).unwrap();
        host.write(point("D0"), -7).unwrap();
        let seen = host.read(&["X0", "Y0", "D1", "M8000"].map(point)).unwrap();
        assert_eq!(seen, [1, 1, -7, 1], "{model:?}");
        // The timer runs in the time of the line.
        while host.read(&[point("Y1")]).unwrap() == [0] {}
        assert!(line.ends().now_ns > 500_000_000);
        host.stop().unwrap();
        assert_eq!(host.read(&["Y0", "Y1"].map(point)).unwrap(), [0, 0], "outputs are off in STOP");
    }
}

#[test]
fn only_what_has_changed_is_written() {
    let line = Loopback::new(Model::Fx2n);
    let mut host = line.host().unwrap();
    let long: String = (0..2000).map(|n| format!("LD M{}\nOUT M{}\n", n % 1000, n % 1000 + 1)).collect();
    let before = words(&format!("{long}END\n"), Model::Fx2n);
    let after = words(&format!("{}END\n", long.replacen("LD M500\n", "LDI M500\n", 1)), Model::Fx2n);
    let plan = host.plan(&before, Target::of(Model::Fx2n), &mut |_| {}).unwrap();
    host.download(&plan, false, &mut |_| {}).unwrap();
    let plan = host.plan(&after, Target::of(Model::Fx2n), &mut |_| {}).unwrap();
    assert_eq!(plan.bytes(), 2, "one word");
    let report = host.download(&plan, false, &mut |_| {}).unwrap();
    assert_eq!((report.written, report.compared), (2, 2 * (after.len() + ParameterBlock::WORDS)));
    assert_eq!(host.upload(&mut |_| {}).unwrap().image.program(), after);
    // A shorter program leaves nothing of the longer one behind it.
    let short = words("LD X0\nOUT Y0\nEND\n", Model::Fx2n);
    let plan = host.plan(&short, Target::of(Model::Fx2n), &mut |_| {}).unwrap();
    host.download(&plan, false, &mut |_| {}).unwrap();
    assert_eq!(Image::from_bytes(&memory(&line)).unwrap(), Image::of(&short, Model::Fx2n).unwrap());
    // And what was there before comes back.
    host.download(&plan.undone(), false, &mut |_| {}).unwrap();
    assert_eq!(host.upload(&mut |_| {}).unwrap().image.program(), after);
}

#[test]
fn what_is_read_again_after_a_download_that_did_not_end_is_what_it_may_have_written() {
    let list = |count: usize, shift: usize| -> Vec<u16> {
        let rungs = (0..count).map(|n| format!("LD M{}\nOUT M{}\n", n % 500, (n + shift) % 500));
        words(&format!("{}END\n", rungs.collect::<String>()), Model::Fx2n)
    };
    let target = Target::of(Model::Fx2n);
    // The new program is longer, shorter, or as long.
    for (before, after) in [(50, 600), (600, 50), (300, 300)] {
        let (before, after) = (list(before, 1), list(after, 2));
        for is_elsewhere in [false, true] {
            let mut plc = Plc::new(target, 10_000_000);
            plc.load(&before);
            let line = Loopback::with(Server::new(plc), Faults::default());
            let cancel = Arc::<AtomicBool>::default();
            let cut = Host::connect(Line::new(line.clone(), Patience::default(), Arc::clone(&cancel)));
            let mut cut = cut.unwrap();
            let plan = cut.plan(&after, target, &mut |_| {}).unwrap();
            let ended = cut.download(&plan, false, &mut |progress| {
                let is_half = progress.stage == Stage::Writing && 2 * progress.done > progress.total;
                cancel.fetch_or(is_half, Ordering::Relaxed);
            });
            assert_eq!(ended.unwrap_err().fate, Fate::Partial);
            let mut host = line.host().unwrap();
            if is_elsewhere {
                // Somebody else has written far behind both programs, too.
                host.line().ask(&bit::<Extended>(DeviceKind::M, 8118).force(true)).unwrap();
                let address = 0x805C + 2 * 7000;
                let data = vec![0x12, 0x34];
                host.line().ask(&Command::Write { space: Space::Program, address, data }).unwrap();
            }
            let mut read = |replaced: &[u16]| {
                let start = line.ends().received.len();
                let plan = host.plan_behind(Some(replaced), &after, target, &mut |_| {}).unwrap();
                (plan, line.ends().received.len() - start)
            };
            // Whoever knows of something else knows nothing.
            let (_, all) = read(&[END]);
            assert!(all > 2 * 2 * 8000, "{all}");
            let (plan, read) = read(&before);
            assert!(!plan.is_whole, "it is no program to go back to");
            // Two digits a byte, frames around them, parameters twice, and some that are blank.
            let most = 2 * 2 * before.len().max(after.len()) * 11 / 10 + 1_000;
            assert!(read < most, "{read} {most}");
            host.download(&plan, false, &mut |_| {}).unwrap();
            assert_eq!(Image::from_bytes(&memory(&line)).unwrap(), Image::of(&after, Model::Fx2n).unwrap());
        }
    }
}

#[test]
fn what_a_download_left_is_no_whole_program_though_its_sum_is_that_of_the_old_one() {
    let target = Target::of(Model::Fx2n);
    let between: String = (0..60).map(|n| format!("LD M{n}\nOUT M{}\n", n + 1)).collect();
    let list = |[first, second]: [&str; 2], last: &str| {
        let list = format!("LD {first}\nOUT Y0\nLD {second}\nOUT Y1\n{between}LD {last}\nOUT Y5\nEND\n");
        words(&list, Model::Fx2n)
    };
    let (before, after) = (list(["X0", "X2"], "X5"), list(["X2", "X0"], "X6"));
    let mut plc = Plc::new(target, 10_000_000);
    plc.load(&before);
    let line = Loopback::with(Server::new(plc), Faults::default());
    let cancel = Arc::<AtomicBool>::default();
    let mut host = Host::connect(Line::new(line.clone(), Patience::default(), Arc::clone(&cancel))).unwrap();
    let plan = host.plan_behind(Some(&before), &after, target, &mut |_| {}).unwrap();
    assert!(plan.is_whole, "nothing was begun");
    let failure = host.download(&plan, false, &mut |_| cancel.store(true, Ordering::Relaxed)).unwrap_err();
    assert_eq!(failure.fate, Fate::Partial);
    let mut host = line.host().unwrap();
    let plan = host.plan_behind(Some(&before), &after, target, &mut |_| {}).unwrap();
    assert_eq!(plan.found, plan.before.parameters().sum(), "the sums are equal");
    assert!(!plan.is_whole && plan.before.program() != before);
    // Whoever knows that no download was begun has read a whole program.
    host.download(&plan, false, &mut |_| {}).unwrap();
    assert!(host.plan(&after, target, &mut |_| {}).unwrap().is_whole);
}

/// All of the program memory, as a host that reads all of it sees it.
fn memory(line: &Loopback) -> Vec<u8> {
    let block = ParameterBlock::new(Model::Fx2n).to_words();
    let words = line.ends().server.plc().words();
    block.iter().chain(&words).flat_map(|word| word.to_le_bytes()).collect()
}

#[test]
fn what_does_not_belong_into_a_plc_is_refused_before_anything_is_changed() {
    let line = Loopback::new(Model::Fx1s);
    let mut host = line.host().unwrap();
    let plan = |host: &mut Host<Loopback>, list: &str, model| {
        host.plan(&words(list, model), Target::of(model), &mut |_| {}).map(|_| ())
    };
    let wrong = LinkError::WrongModel { wanted: "FX2N", found: "FX1S" };
    assert_eq!(plan(&mut host, "LD X0\nOUT Y0\nEND\n", Model::Fx2n), Err(wrong));
    let mut large = vec![0x2400; 2001];
    assert_eq!(host.plan(&large, Target::of(Model::Fx1s), &mut |_| {}).map(|_| ()), Err(LinkError::NoEnd));
    large[2000] = 0x000F;
    let found = host.plan(&large, Target::of(Model::Fx1s), &mut |_| {}).map(|_| ());
    assert_eq!(found, Err(LinkError::TooLarge { steps: 2001, capacity: 2000 }));
    // A keyword in the parameters.
    assert_eq!(answers(&line, &framed(b"18008021234")), [ACK]);
    assert_eq!(answers(&line, &framed(b"B")), [ACK]);
    assert_eq!(plan(&mut host, "LD X0\nOUT Y0\nEND\n", Model::Fx1s), Err(LinkError::Keyword));
    // The keyword is gone; file registers, which nobody knows where to find, and a capacity that no FX1S has.
    for (address, word, wanted) in [
        ("1800802", "2020", None),
        ("1804A02", "0200", Some(LinkError::FileRegisters)),
        ("1804A02", "0000", None),
        ("1800002", "00FF", Some(LinkError::Parameters { capacity: 65_280_000 })),
    ] {
        assert_eq!(answers(&line, &framed(format!("{address}{word}").as_bytes())), [ACK]);
        let Some(wanted) = wanted else { continue };
        assert_eq!(plan(&mut host, "LD X0\nOUT Y0\nEND\n", Model::Fx1s), Err(wanted));
    }
    let order = Point::named("M8037", Target::of(Model::Fx1s)).unwrap();
    assert_eq!(host.write(order, 0), Err(LinkError::IsOrder { device: "M8037".into() }));
}

#[test]
fn a_running_plc_takes_no_program() {
    let line = Loopback::new(Model::Fx2n);
    let mut host = line.host().unwrap();
    let plan = host.plan(&words(MOTOR, Model::Fx2n), Target::of(Model::Fx2n), &mut |_| {}).unwrap();
    host.download(&plan, true, &mut |_| {}).unwrap();
    let asks = |body: &str| answers(&line, &framed(body.as_bytes()));
    assert_eq!(asks("E7760E"), [ACK]);
    assert_eq!(asks("E11805C020024"), [NAK]);
    assert_eq!(asks("E11800002FFFF"), [NAK]);
    assert_eq!(asks("B"), [NAK]);
    // Half a program does not run.
    assert_eq!(asks("E7250E"), [ACK]);
    assert_eq!(asks("E11805C020034"), [NAK], "not enabled");
    assert_eq!(asks("E7760E"), [ACK]);
    assert_eq!(asks("E11805C020034"), [ACK]);
    assert_eq!(asks("E8250E"), [ACK]);
    assert_eq!(asks("E0001C001"), framed(b"1A"), "STOP, and the error lamp");
    assert!(!host.start().unwrap());
    let error = Point::named("M8066", Target::of(Model::Fx2n)).unwrap();
    assert_eq!(host.read(&[error]).unwrap(), [1]);
}

#[test]
fn watched_devices_come_in_one_exchange() {
    for model in MODELS {
        let line = Loopback::new(model);
        let mut host = line.host().unwrap();
        let target = Target::of(model);
        let names = ["X3", "D5", "M10", "T3", "TS3", "Y7", "D7:32", "C9", "CS9", "M8001"];
        let mut points: Vec<Point> = names.iter().map(|name| Point::named(name, target).unwrap()).collect();
        if model != Model::Fx1s {
            points.push(Point::named("C200", target).unwrap());
        }
        let mut watch = Watch::new(points.clone());
        let values = [1, -5, 1, 77, 1, 1, 100_000, 9, 0, 1, -70_000];
        for (point, value) in points.iter().zip(values).filter(|(_, value)| *value != 0) {
            host.write(*point, value).unwrap();
        }
        assert_eq!(host.poll(&mut watch).unwrap(), values[..points.len()], "{model:?}");
        line.ends().sent.clear();
        host.poll(&mut watch).unwrap();
        let requests = line.ends().sent.iter().filter(|byte| **byte == 2).count();
        assert!(model == Model::Fx1s || requests <= 2, "{requests} requests: {model:?}");
    }
}

#[test]
fn a_host_that_is_refused_or_not_answered_says_so() {
    let line = Loopback::new(Model::Fx2n);
    let mut host = line.host().unwrap();
    let refused = host.line().ask(&Address::<Program>::new(0xFFF0).read(8));
    assert_eq!(refused, Err(LinkError::Refused { request: "E01FFF008".into() }));
    let far = Point::named("D100", Target::of(Model::Fx2n)).unwrap();
    assert_eq!(host.read(&[far]).unwrap(), [0], "and goes on");
    let silent = Faults { drop: 1.0, ..Default::default() };
    line.reconnect(silent);
    assert_eq!(host.mode(), Err(LinkError::NoAnswer));
    assert!(matches!(line.host().err(), Some(LinkError::NoAnswer)));
    let dead = Faults { disconnect: 1.0, ..Default::default() };
    line.reconnect(dead);
    assert!(matches!(host.mode(), Err(LinkError::Gone { .. })));
}

#[test]
fn a_plc_keeps_its_program_and_latched_devices_without_power() {
    let mut plc = Plc::new(Target::of(Model::Fx2n), 10_000_000);
    plc.load(&words(MOTOR, Model::Fx2n));
    for (command, _) in [
        (bit::<Extended>(DeviceKind::M, 600).force(true), ()),
        (bit::<Extended>(DeviceKind::M, 5).force(true), ()),
        (Extended::word(device(DeviceKind::D, 300)).unwrap().0.write(&[7, 0]), ()),
        (Extended::word(device(DeviceKind::C, 220)).unwrap().0.write(&[1, 2, 3, 0]), ()),
        (bit::<Extended>(DeviceKind::C, 100).force(true), ()),
    ] {
        plc.obey_host(&command, 0).unwrap();
    }
    let saved = plc.save().expect("something has changed");
    let text = serde_json::to_string(&saved).unwrap();
    let saved = serde_json::from_str(&text).unwrap();
    let mut again = Plc::restored(&saved, 10_000_000).unwrap();
    assert_eq!(again.words(), plc.words());
    let machine = again.machine();
    assert_eq!(machine.bit(device(DeviceKind::M, 600)), 0xFF);
    assert_eq!(machine.bit(device(DeviceKind::C, 100)), 0xFF);
    assert_eq!(machine.bit(device(DeviceKind::M, 5)), 0, "M5 is not latched");
    assert_eq!(machine.word(device(DeviceKind::D, 300), 0), 7);
    assert_eq!(machine.word(device(DeviceKind::C, 220), 0), 0x30201);
    assert_eq!(again.save(), None, "nothing has changed since");
    again.power_on(rungwise::link::Switch::Run, 0);
    assert_eq!(again.mode(), Mode::Run);
    assert_eq!(again.machine().word(device(DeviceKind::D, 300), 0), 7);
}

#[test]
fn a_logbook_keeps_the_latest_changes_and_the_last_value_of_each_point() {
    let [fast, slow, late] =
        ["D0", "Y0", "D5"].map(|name| Point::named(name, Target::of(Model::Fx2n)).unwrap());
    let mut book = Logbook::default();
    book.begin(10);
    for look in 0..100u64 {
        let (number, bit) = (Value::Number(look as i64), Value::Bit(false));
        let late_value = Value::Number(7);
        let mut read = vec![(fast, &number), (slow, &bit)];
        if look >= 97 {
            read.push((late, &late_value));
        }
        book.note(look * 1_000_000, read.into_iter());
    }
    let changes = book.changes(fast, 0, u64::MAX, 1000);
    assert_eq!(changes.len(), 8);
    assert_eq!(changes[0], (92_000_000, Value::Number(92)));
    assert_eq!(book.known_from_ns(slow), Some(0));
    // What was not read yet is empty in a table, and has no value in a dump.
    let trace = book.trace(&[late, slow, fast]);
    let csv = trace.csv();
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines[..4], ["scan,time_ms,D5,Y0,D0", "0,0,,0,", "1,92,,0,92", "2,93,,0,93"], "{csv}");
    assert_eq!(lines[lines.len() - 3..], ["6,97,7,0,97", "7,98,7,0,98", "8,99,7,0,99"], "{csv}");
    let dump = String::from_utf8(trace.vcd().unwrap()).unwrap();
    let at = |time: &str| dump.find(&format!("#{time}\n")).unwrap();
    assert!(!dump[at("0")..at("97000000")].contains(" !"), "{dump}");
    assert!(dump[at("97000000")..at("98000000")].contains("b0000000000000111 !"), "{dump}");
    book.begin(10);
    assert!(book.points().is_empty() && book.beginnings() == 2);
}

#[test]
fn a_plan_is_not_carried_out_on_what_somebody_else_has_written_meanwhile() {
    let target = Target::of(Model::Fx2n);
    let [before, after, other] = ["LD X0\nOUT Y0\nEND\n", "LD X1\nOUT Y1\nEND\n", "LD X2\nOUT Y2\nEND\n"]
        .map(|list| words(list, Model::Fx2n));
    let line = Loopback::new(Model::Fx2n);
    line.ends().server.plc_mut().load(&before);
    let mut host = line.host().unwrap();
    let plan = host.plan(&after, target, &mut |_| {}).unwrap();
    line.ends().server.plc_mut().load(&other);
    let failure = host.download(&plan, false, &mut |_| {}).unwrap_err();
    assert_eq!((failure.cause, failure.fate), (LinkError::Changed, Fate::Untouched));
    assert!(line.ends().server.plc().words().starts_with(&other));
    // Planned again, it is; and so is what undoes it.
    let plan = host.plan(&after, target, &mut |_| {}).unwrap();
    host.download(&plan, false, &mut |_| {}).unwrap();
    host.download(&plan.undone(), false, &mut |_| {}).unwrap();
    assert!(line.ends().server.plc().words().starts_with(&other));
}

#[test]
fn a_virtual_fx1s_knows_plain_commands_only() {
    let line = Loopback::new(Model::Fx1s);
    let mut host = line.host().unwrap();
    let read = |space| Command::Read { space, address: 0x0E02, length: 2 };
    assert!(host.line().ask(&read(Space::Plain)).is_ok());
    for refused in [
        read(Space::Extended),
        Command::Force { space: Space::Extended, bit: 5, on: true },
        Command::Search { from: 0x8000, word: [0x0F, 0] },
        Command::Clear(1),
    ] {
        let answer = host.line().ask(&refused);
        assert!(matches!(answer, Err(LinkError::Refused { .. })), "{refused:?}: {answer:?}");
    }
}
