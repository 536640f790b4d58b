//! Machine code: worked examples and recorded captures, the parameter block, the memory image.

use rungwise::machine_code::{
    self, BLANK, END, Image, NO_MACHINE_CODE, ParameterBlock, address_of_step, decode, encode, sum,
};
use rungwise::target::{Device, DeviceKind, Latch, Latches, Model, Target};
use rungwise::text::{Language, catalogue_keys};

fn words(list: &str) -> Vec<u16> {
    words_on(list, Model::Fx2n)
}

fn words_on(list: &str, model: Model) -> Vec<u16> {
    encode(list, Target::of(model)).unwrap_or_else(|found| panic!("{list}: {found:?}")).words
}

/// The words that are written in hexadecimal, parted by blanks.
fn hex(text: &str) -> Vec<u16> {
    text.split_whitespace().map(|word| u16::from_str_radix(word, 16).unwrap()).collect()
}

/// The words of a memory dump, the low byte of each first.
fn dump(text: &str) -> Vec<u16> {
    let bytes: Vec<u8> =
        (0..text.len()).step_by(2).map(|at| u8::from_str_radix(&text[at..at + 2], 16).unwrap()).collect();
    bytes.chunks(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]])).collect()
}

/// The code table of Xu Yiyi and captures of the maker's tools.
const EXAMPLES: &[(&str, &str)] = &[
    ("LD X2", "2402"),
    ("LDI X3", "3403"),
    ("AND M20", "4814"),
    ("ANI M503", "59F7"),
    ("OR M22", "6816"),
    ("ORI X0", "7400"),
    ("OUT Y0", "C500"),
    ("SET Y1", "D501"),
    ("RST Y0", "E500"),
    ("LD M8002", "2F02"),
    ("OUT M8047", "0002 8F2F"),
    ("SET M8034", "0003 8F22"),
    ("RST M8034", "0004 8F22"),
    ("SET S0", "0006 8000"),
    ("SET S13", "0006 800D"),
    ("RST S0", "0007 8000"),
    ("OUT S10", "0005 800A"),
    ("STL S12", "F00C"),
    ("RET", "F7FF"),
    ("PLS M21", "0008 8815"),
    ("PLF M1", "0009 8801"),
    ("MC N0 M0", "000A 8000 8800"),
    ("MCR N0", "000B 8000"),
    ("OUT T1 K15", "0601 800F 8000"),
    ("OUT T198 D980", "06C6 86A8 8607"),
    ("OUT C2 K1", "0E02 8001 8000"),
    ("OUT C235 K-100000", "0EEB 8060 8079 80FE 80FF"),
    ("RST C0", "000C 8E00"),
    ("RST D0", "000D 8600 8600"),
    ("RST D230", "000D 86CC 8601"),
    ("LD M1536", "01C2 A800"),
    ("ORI M3071", "01C7 ADFF"),
    ("OUT M1536", "0002 A800"),
    ("LDP X0", "01CA 8400"),
    ("ORF M3071", "01CF ADFF"),
    ("ANB", "FFF8"),
    ("ORB", "FFF9"),
    ("MPS", "FFFA"),
    ("MRD", "FFFB"),
    ("MPP", "FFFC"),
    ("INV", "FFFD"),
    ("NOP", "FFFF"),
    ("END", "000F"),
    ("P32", "B020"),
    ("CJ P8", "0010 8810 8000"),
    ("CALL P32", "0012 8840 8000"),
    ("SRET", "0014"),
    ("FEND", "001C"),
    ("ZRST S2 S40", "0060 8402 8000 8428 8000"),
    ("ZRST Y0 Y3", "0060 8400 8005 8403 8005"),
    ("ZRST C1 C20", "0060 8602 8400 8628 8400"),
    ("ZRST M0 M3071", "0060 8400 8008 84FF 802D"),
    ("ADDP D230 K1 D230", "1038 86CC 8601 8001 8000 86CC 8601"),
    ("CMP K5 K3 M0", "0024 8005 8000 8003 8000 8400 8008"),
    ("MUL T198 K100 D984", "003C 868C 8201 8064 8000 86B0 8607"),
    ("DMOV K999 D2000", "0029 80E7 8003 8000 8000 86D0 8807 8000 8000"),
    ("MOV HFF K4Y0", "0028 82FF 8000 8400 8805"),
    ("DMOV K-2 K8M0", "0029 80FE 80FF 80FF 80FF 8400 9008 8000 8000"),
    ("SFTL M1523 S10 K9 K1", "0056 84F3 800D 840A 8000 8009 8000 8001 8000"),
    ("INC Z0", "0040 8638 8000"),
    ("INC V7", "0040 8686 8001"),
    ("MOV K4M1469Z0 D0", "0028 A4BD 880D 8600 8600"),
    ("MOV D0Z5 D1000", "0028 A600 8740 8600 8800"),
    ("LD= D0 K3", "01D0 8600 8600 8003 8000"),
    ("LDD>= D0 K3", "01DD 8600 8600 8000 8000 8003 8000 8000 8000"),
    ("TRD D0", "015C 8600 8600"),
];

#[test]
fn worked_examples() {
    for (line, code) in EXAMPLES {
        assert_eq!(words(line), hex(code), "{line}");
        assert_eq!(decode(&hex(code), Model::Fx2n).text, format!("{line}\n"), "{code}");
    }
}

#[test]
fn recorded_programs() {
    let list = "LD X0\nOUT Y0\nLD X1\nOUT Y1\nLD Y0\nSET Y2\nLD Y1\nRST Y2\nEND\n";
    let memory = dump("002400C5012401C5002502D5012502E50F00");
    assert_eq!(words(list), memory);
    assert_eq!(decode(&memory, Model::Fx2n).text, list);
    assert_eq!(words("LD X0\nOUT Y0\nEND\n"), dump("002400C50F00"));
}

#[test]
fn index_registers() {
    // The second word of D0 with each index register: two bits of its number in the value, one beside the area.
    for number in 0..8u16 {
        let coded = words(&format!("INC D0Z{number}"));
        assert_eq!(coded, [0x0040, 0xA600, 0x8600 | (number / 4) << 8 | (number % 4) << 6], "Z{number}");
    }
    assert_eq!(words("CJ P3Z1"), hex("0010 A806 8040"));
}

/// Sums that were recorded from PLCs with the programs that they had: an FX2N, cleared and with three steps; an
/// FX1N; and an FX1S with what an older, longer program left behind END.
#[test]
fn recorded_sums() {
    for (program, capacity, recorded) in [
        ("0F00", 8, "D0E0"),
        ("002400C50F00", 8, "D2C9"),
        ("022403C50F00", 8, "D7C9"),
        ("062407C50F0005C80F00", 2, "65A9"),
    ] {
        let block = ParameterBlock::new(Model::Fx2n).with_capacity(capacity);
        let image = Image::new(block, &dump(program)).unwrap();
        assert_eq!(image.parameters().sum(), dump(recorded)[0], "{program}");
        assert_eq!(sum(image.memory()), image.parameters().sum());
    }
}

/// The block that an FX1S and an FX1N sent, and the one that the maker's tool writes into an FX2N, but for capacity and
/// sum.
#[test]
fn the_block_of_a_new_plc() {
    let blanks = "2020".repeat(20);
    let latches = "F409FF0BF401E703640EC70EDC0EFF0E9001FE03";
    let recorded = dump(&format!("0800000000000000{blanks}{latches}{}", "0000".repeat(12)));
    let block = ParameterBlock::new(Model::Fx2n);
    assert_eq!(block.to_words().as_slice(), recorded.as_slice());
    assert_eq!(ParameterBlock::from_words(&recorded), block);
    assert_eq!(ParameterBlock::new(Model::Fx1s).capacity(), 2000);
    assert!(!block.has_keyword());
    let at = Device::new;
    for (latch, first, last) in [
        (Latch::Relays, at(DeviceKind::M, 500), at(DeviceKind::M, 1023)),
        (Latch::States, at(DeviceKind::S, 500), at(DeviceKind::S, 999)),
        (Latch::Counters, at(DeviceKind::C, 100), at(DeviceKind::C, 199)),
        (Latch::WideCounters, at(DeviceKind::C, 220), at(DeviceKind::C, 255)),
        (Latch::Registers, at(DeviceKind::D, 200), at(DeviceKind::D, 511)),
    ] {
        assert_eq!(block.latched(latch), Some((first, last)));
        assert_eq!(block.with_latched(latch, first, last), Some(block));
    }
    assert_eq!(block.with_latched(Latch::States, at(DeviceKind::M, 0), at(DeviceKind::M, 1)), None);
}

#[test]
fn latches_are_those_of_the_block() {
    let all = |target: &'static Target| {
        let ranges = target.devices.iter();
        ranges.flat_map(|range| (range.first..=range.last).map(|number| Device::new(range.kind, number)))
    };
    // What the block of a new PLC says is what the model keeps; that of an FX1S says something else, and is not asked.
    for model in [Model::Fx1s, Model::Fx1n, Model::Fx2n, Model::Fx3u] {
        let (target, latches) = (Target::of(model), ParameterBlock::new(model).latches());
        for device in all(target) {
            let keeps = Latches::default().keep(device, target);
            assert_eq!(latches.keep(device, target), keeps, "{device} of {}", target.title);
        }
    }
    let target = Target::of(Model::Fx2n);
    let at = Device::new;
    let block = ParameterBlock::new(Model::Fx2n);
    let block = block.with_latched(Latch::Relays, at(DeviceKind::M, 100), at(DeviceKind::M, 200)).unwrap();
    let block = block.with_latched(Latch::Counters, at(DeviceKind::C, 9), at(DeviceKind::C, 3)).unwrap();
    let latches = block.latches();
    for (kind, number, keeps) in [
        (DeviceKind::M, 99, false),
        (DeviceKind::M, 100, true),
        (DeviceKind::M, 200, true),
        (DeviceKind::M, 201, false),
        (DeviceKind::M, 600, false),
        (DeviceKind::M, 1024, true),
        (DeviceKind::M, 8000, false),
        (DeviceKind::C, 5, false),
        (DeviceKind::C, 150, false),
        (DeviceKind::C, 230, true),
        (DeviceKind::D, 300, true),
        (DeviceKind::T, 250, true),
    ] {
        assert_eq!(latches.keep(at(kind, number), target), keeps, "{kind:?}{number}");
    }
    for range in target.devices {
        let runs = latches.runs(range, target);
        assert_eq!(*runs[0].0.start(), range.first);
        assert_eq!(*runs[runs.len() - 1].0.end(), range.last);
        assert!(runs.windows(2).all(|pair| pair[0].0.end() + 1 == *pair[1].0.start()), "{runs:?}");
        for (numbers, keeps) in runs {
            assert!(numbers.clone().all(|number| latches.keep(at(range.kind, number), target) == keeps));
        }
    }
}

#[test]
fn titles_and_areas() {
    let block = ParameterBlock::new(Model::Fx2n);
    let titled = block.with_title("Mixer 3").unwrap();
    assert_eq!(titled.title(), "Mixer 3");
    assert_eq!(titled.with_title("").unwrap(), block);
    assert_eq!(block.with_title(&"a".repeat(33)), None);
    assert_eq!(block.with_title("é"), None);
    let mut words = block.to_words();
    (words[37], words[39]) = (2, 1);
    let block = ParameterBlock::from_words(&words);
    assert_eq!((block.file_register_blocks(), block.comment_blocks(), block.program_steps()), (2, 1, 6500));
    assert_eq!(Image::new(block, &[0x2400; 6501]), None);
    assert!(Image::new(block, &[0x2400; 6500]).is_some());
}

#[test]
fn programs_end_at_end_or_where_memory_is_blank() {
    let image = |list: &str| Image::of(&words_on(list, Model::Fx1s), Model::Fx1s).unwrap();
    assert_eq!(image("LD X0\nOUT Y0\nEND\nLD X1\n").program(), hex("2400 C500 000F"));
    assert_eq!(image("LD X0\nNOP\nOUT Y0\n").program(), hex("2400 FFFF C500"));
    assert!(image("").program().is_empty());
    assert_eq!(image("").memory(), [BLANK; 2000]);
    assert_eq!(address_of_step(3), 0x8062);
}

#[test]
fn images_are_bytes_in_the_order_of_memory() {
    let image = Image::of(&words("LD X0\nOUT Y0\nEND\n"), Model::Fx2n).unwrap();
    let bytes = image.to_bytes();
    assert_eq!(bytes.len(), 92 + 16_000);
    assert_eq!(bytes[..4], [0x08, 0x00, 0xD2, 0xC9]);
    assert_eq!(bytes[92..98], [0x00, 0x24, 0x00, 0xC5, 0x0F, 0x00]);
    assert_eq!(Image::from_bytes(&bytes), Some(image.clone()));
    assert_eq!(Image::from_bytes(&bytes[..98]), Some(image));
    for unusable in [&bytes[..91], &bytes[..93], &[bytes.as_slice(), &[0, 0]].concat()] {
        assert_eq!(Image::from_bytes(unusable), None);
    }
    assert_eq!(Image::of(&[END; 8001], Model::Fx2n).unwrap().parameters().capacity(), 16_000);
    assert_eq!(Image::of(&[END; 16_001], Model::Fx2n), None);
    assert_eq!(Image::of(&[END; 2001], Model::Fx1s), None);
}

#[test]
fn downloads_write_what_has_changed() {
    let image = |list: &str| Image::of(&words(list), Model::Fx2n).unwrap();
    let old = image("LD X0\nOUT Y0\nLD X1\nOUT Y1\nEND\n");
    assert_eq!(old.changed_chunks(&old, 64), []);
    let new = image("LD X0\nOUT Y2\nLD X1\nOUT Y3\nEND\n");
    let chunks = new.changed_chunks(&old, 64);
    assert_eq!(chunks.len(), 1);
    assert_eq!(chunks[0].address, 0x805E);
    assert_eq!(chunks[0].bytes, [0x02, 0xC5, 0x01, 0x24, 0x03, 0xC5]);
    assert_eq!(new.changed_chunks(&old, 2).len(), 2);
    // Written into the old memory they make the new one.
    for most in [2, 3, 16, 64, 100_000] {
        let new = image(&"LD X7\nOUT Y7\nLD X1\nOUT Y1\n".repeat(40));
        let mut memory = old.to_bytes();
        for chunk in new.changed_chunks(&old, most) {
            assert!(chunk.bytes.len() <= most);
            let at = (chunk.address - machine_code::PARAMETER_ADDRESS) as usize;
            memory[at..at + chunk.bytes.len()].copy_from_slice(&chunk.bytes);
        }
        assert_eq!(Image::from_bytes(&memory), Some(new));
    }
}

#[test]
fn what_has_no_machine_code_is_told_at_its_place() {
    for (list, model, place, key) in [
        ("LD X0\nMOV D0V1 D1\n", Model::Fx2n, "D0V1", "index-v"),
        ("LD X0\nMOV K10Z0 D1\n", Model::Fx2n, "K10Z0", "unknown-operand"),
        ("LD M3072\n", Model::Fx2n, "M3072", "no-device"),
        ("LD M3072\n", Model::Fx3u, "M3072", "unknown-operand"),
        ("LD S1024\n", Model::Fx3u, "S1024", "unknown-operand"),
        ("LD D0.3\n", Model::Fx3u, "D0.3", "unknown-operand"),
        ("LD X0Z0\n", Model::Fx3u, "X0Z0", "unknown-operand"),
        ("LD X0Z0\n", Model::Fx2n, "X0Z0", "operand-not-taken"),
        ("LD X0\nMOV R0 D0\n", Model::Fx3u, "R0", "unknown-operand"),
        ("LD X0\nMOV D8256 D0\n", Model::Fx3u, "D8256", "unknown-operand"),
        ("LD X0\nDEMOV E1.5 D0\n", Model::Fx3u, "DEMOV", "unknown-instruction"),
        ("LD X0\nDEADD E1.5 D0 D2\n", Model::Fx3u, "E1.5", "unknown-operand"),
        ("P128\n", Model::Fx3u, "P128", "unknown-operand"),
        ("LD X0\nMEP\nOUT Y0\n", Model::Fx3u, "MEP", "unknown-code"),
        ("LD X0\nASC \"ABC\" D0\n", Model::Fx1n, "ASC", "not-on-model"),
        ("LD X0\nASC \"ABCDEFGHI\" D0\n", Model::Fx2n, "\"ABCDEFGHI\"", "text"),
        ("LD X0\nMOV K32768 D0\n", Model::Fx2n, "K32768", "too-large"),
        ("LD X0\nMOV H10000 D0\n", Model::Fx2n, "H10000", "too-large"),
        ("LD X0\nMOV K1\n", Model::Fx2n, "MOV K1", "operand-count"),
        ("LD X0\nOUT T0\n", Model::Fx2n, "OUT T0", "operand-count"),
        ("LD X0\nOUT Y0 K5\n", Model::Fx2n, "OUT Y0 K5", "operand-count"),
        ("LD X0\nOUT X1\n", Model::Fx2n, "X1", "operand-not-taken"),
        ("STL X1\n", Model::Fx2n, "X1", "operand-not-taken"),
        ("MCR N8\n", Model::Fx2n, "N8", "no-device"),
        ("FOO X1\n", Model::Fx2n, "FOO", "unknown-instruction"),
        ("LD Foo\n", Model::Fx2n, "Foo", "unreadable-operand"),
        ("NOP? H10000\n", Model::Fx2n, "H10000", "too-large"),
    ] {
        let found = encode(list, Target::of(model)).expect_err(list);
        let texts: Vec<&str> = found.iter().map(|problem| problem.span.of(list)).collect();
        assert_eq!(texts, [place], "{list}");
        assert_eq!(found[0].code, NO_MACHINE_CODE);
        assert_eq!(found[0].message.key(), format!("machine-code.{key}"), "{list}");
        for language in Language::ALL {
            let said = found[0].message.render(*language);
            assert!(!said.contains('{') && !said.contains("machine-code"), "{said}");
        }
    }
    // What cannot be read at all is told by the reader.
    let found = encode("LD X0,\n", Target::of(Model::Fx2n)).unwrap_err();
    assert_eq!(found[0].code, "syntax-error");
}

#[test]
fn every_reason_has_a_test() {
    let source = include_str!("machine_code.rs");
    for (key, _) in catalogue_keys(Language::English) {
        // Rungs that are not translated are a matter of documents, see `cli_machine_code`.
        if let Some(reason) = key.strip_prefix("machine-code.").filter(|reason| *reason != "not-translated") {
            assert!(source.contains(&format!("\"{reason}\"")), "{key}");
        }
    }
}

#[test]
fn programs_have_room_in_the_model() {
    let list = "LD X0\nOUT T0 K5\n".repeat(500);
    let found = encode(&format!("{list}END\n"), Target::of(Model::Fx1s)).unwrap_err();
    assert_eq!(found[0].message.key(), ["machine-code", "too-many-steps"].join("."));
    assert_eq!(found[0].span.start as usize, list.len());
    assert!(encode(&format!("{list}END\n"), Target::of(Model::Fx1n)).is_ok());
}

#[test]
fn words_know_their_lines() {
    let list = "LD X0 ; start\nOUT T0 K5\n\nP1\nLD T0\nOUT Y0\nEND\n";
    let program = encode(list, Target::of(Model::Fx2n)).unwrap();
    let lines: Vec<(u32, usize, &str)> = program
        .lines
        .iter()
        .map(|line| (line.step, program.words_of(line).len(), line.span.of(list)))
        .collect();
    assert_eq!(
        lines,
        [
            (0, 1, "LD X0"),
            (1, 3, "OUT T0 K5"),
            (4, 1, "P1"),
            (5, 1, "LD T0"),
            (6, 1, "OUT Y0"),
            (7, 1, "END")
        ]
    );
    let at = |step| program.line_of_step(step).map(|line| line.span.of(list));
    assert_eq!(
        [0, 1, 3, 7, 8].map(at),
        [Some("LD X0"), Some("OUT T0 K5"), Some("OUT T0 K5"), Some("END"), None]
    );
    let mut twice = program.clone();
    twice.append(&program);
    assert_eq!(twice.words.len(), 16);
    assert_eq!(twice.line_of_step(9).map(|line| line.span.of(list)), Some("OUT T0 K5"));
}
