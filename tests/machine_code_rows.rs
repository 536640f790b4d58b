//! Machine code of every row of the instruction table, and the two identities: what is encoded reads as it was
//! written, and any words at all, decoded and encoded again, are the same words.

use proptest::prelude::*;
use rungwise::il::fx;
use rungwise::machine_code::{decode, encode};
use rungwise::target::instructions::{self, LABEL, UNREAD};
use rungwise::target::{Form, Model, Target};
use std::collections::BTreeSet;
use std::sync::LazyLock;

const MODELS: [Model; 4] = [Model::Fx1s, Model::Fx1n, Model::Fx2n, Model::Fx3u];

/// Operands of every kind, the ends of ranges among them, as the listing writes them.
const WORDS: &[&str] = &[
    "X0",
    "X17",
    "X367",
    "Y0",
    "Y15",
    "Y367",
    "M0",
    "M383",
    "M1535",
    "M1536",
    "M3071",
    "M8000",
    "M8255",
    "S0",
    "S127",
    "S999",
    "S1023",
    "T0",
    "T62",
    "T255",
    "T256",
    "T511",
    "C0",
    "C31",
    "C199",
    "C200",
    "C235",
    "C255",
    "D0",
    "D127",
    "D255",
    "D999",
    "D1000",
    "D7999",
    "D8000",
    "D8255",
    "V0",
    "V7",
    "Z0",
    "Z7",
    "P0",
    "P62",
    "P63",
    "P127",
    "I001",
    "I610",
    "I899",
    "N0",
    "N7",
    "K1X0",
    "K4Y0",
    "K8M0",
    "K4S0",
    "K4M1536",
    "K0",
    "K1",
    "K-1",
    "K32767",
    "K-32768",
    "K2147483647",
    "K-2147483648",
    "H0",
    "HFF",
    "HFFFF",
    "HFFFFFFFF",
    "D0Z0",
    "D1000Z7",
    "D8000Z3",
    "X0Z0",
    "M1536Z4",
    "K4M0Z5",
    "P1Z2",
    "T0Z1",
    "C200Z6",
    "\"ABCD 12#\"",
];

/// Operands that are read, and whose coding is not known.
const UNCODED: &[&str] = &[
    "D0V0", "K4M0V7", "K5Z0", "H5V1", "D0.3", "E1.5", "R0", "M3072", "M7679", "M8256", "S1024", "S4095",
    "D8256", "P128", "P4095",
];

/// A line for every operand of every kind at every place of every form that `model` has.
pub(crate) fn lines(model: Model) -> Vec<(Form, String)> {
    let target = Target::of(model);
    let plain = |instruction| Form { instruction, wide: false, pulse: false };
    let labels = WORDS.iter().filter(|word| {
        let device = target.read(word).device().filter(|device| device.kind.is_pointer());
        device.is_some_and(|device| device.range_on(target).is_some()) && !word.contains('Z')
    });
    let mut lines: Vec<(Form, String)> = labels.map(|word| (plain(&LABEL), word.to_string())).collect();
    for form in instructions::forms_on(model).chain([plain(&UNREAD)]) {
        let specs = form.instruction.operands;
        let takes = |place: usize, word: &&str| {
            let operand = target.read(word);
            let is_there = operand.device().is_none_or(|device| device.range_on(target).is_some());
            form.takes(place, &operand, model) && is_there
        };
        let fitting = |place: usize| WORDS.iter().copied().filter(move |word| takes(place, word));
        let first: Vec<&str> = (0..specs.len()).map(|place| fitting(place).next().unwrap_or("K1")).collect();
        if specs.is_empty() {
            lines.push((form, form.mnemonic()));
        }
        for place in 0..specs.len() {
            for word in fitting(place) {
                let mut operands = first.clone();
                operands[place] = word;
                // OUT takes a preset for timers and counters, and for these alone.
                if specs.last().is_some_and(|spec| spec.optional) {
                    match operands[0].starts_with(['T', 'C']) {
                        true => {}
                        false if place == 1 => operands[0] = "T0",
                        false => operands.truncate(1),
                    }
                }
                lines.push((form, format!("{} {}", form.mnemonic(), operands.join(" "))));
            }
        }
    }
    lines
}

#[test]
fn every_row_reads_as_it_was_written() {
    for model in MODELS {
        let target = Target::of(model);
        let (mut read, mut rows) = (0, BTreeSet::new());
        for (form, line) in lines(model) {
            let program = match encode(&line, target) {
                Ok(program) => program,
                Err(found) => {
                    let key = found[0].message.key();
                    let is_too_large = key == "machine-code.too-large" && found.len() == 1;
                    let word = found[0].span.of(&line);
                    // An interrupt as an operand of HSCS; index registers in basic instructions; MEP and MEF.
                    let is_unknown = match key {
                        "machine-code.unknown-operand" => word.starts_with('I') || model == Model::Fx3u,
                        key => key == "machine-code.unknown-code" && model == Model::Fx3u,
                    };
                    assert!(is_too_large || is_unknown, "{model:?} {line}: {found:?}");
                    continue;
                }
            };
            let tree = fx::parse(&line, target);
            assert_eq!(program.words.len() as u32, fx::steps(&tree), "steps of {line} on {model:?}");
            let listing = decode(&program.words, model);
            let expected =
                if std::ptr::eq(form.instruction, &UNREAD) { listing.text.trim_end() } else { &line };
            assert_eq!(listing.text.trim_end(), expected, "{model:?} {:04X?}", program.words);
            assert_eq!(encode(&listing.text, target).unwrap().words, program.words, "{line}");
            read += 1;
            rows.insert(form.instruction.mnemonic);
        }
        let all = instructions::all().filter(|row| row.models.contains(&model)).map(|row| row.mnemonic);
        let lacking: Vec<&str> = all.filter(|mnemonic| !rows.contains(mnemonic)).collect();
        let known: &[&str] = if model == Model::Fx3u { &["MEP", "MEF"] } else { &[] };
        assert_eq!(lacking, known, "{model:?}");
        assert!(read > 1500, "only {read} lines on {model:?}");
    }
}

#[test]
fn what_no_source_tells_is_not_encoded() {
    let target = Target::of(Model::Fx3u);
    let mut refused = 0;
    for form in instructions::forms_on(Model::Fx3u) {
        let specs = form.instruction.operands;
        let first = |place: usize| {
            let fits = |word: &&&str| {
                let is_taken = form.takes(place, &target.read(word), Model::Fx3u);
                is_taken && !(word.starts_with('X') && word.contains('Z'))
            };
            WORDS.iter().find(fits).copied().unwrap_or("K1")
        };
        for place in 0..specs.len() {
            for word in UNCODED.iter().filter(|word| form.takes(place, &target.read(word), Model::Fx3u)) {
                let mut operands: Vec<&str> = (0..specs.len()).map(first).collect();
                operands[place] = word;
                if specs.last().is_some_and(|spec| spec.optional) {
                    match place {
                        0 => operands.truncate(1),
                        _ => operands[0] = "T0",
                    }
                }
                let line = format!("{} {}", form.mnemonic(), operands.join(" "));
                let found = encode(&line, target).expect_err(&line);
                assert_eq!(found[0].span.of(&line), *word, "{line}: {found:?}");
                refused += 1;
            }
        }
    }
    assert!(refused > 500, "only {refused}");
}

#[test]
fn every_word_is_listed_and_comes_back() {
    for model in MODELS {
        let words: Vec<u16> = (0..=u16::MAX).collect();
        assert_comes_back(&words, model);
        let words: Vec<u16> = (0..=u16::MAX).rev().collect();
        assert_comes_back(&words, model);
    }
}

/// Words are listed as canonical instruction list that the reader understands, and are the same when encoded again.
fn assert_comes_back(words: &[u16], model: Model) {
    let target = Target::of(model);
    let listing = decode(words, model);
    let mut step = 0;
    for line in &listing.lines {
        assert_eq!(line.step, step);
        step += u32::from(line.steps);
        let is_marked = line.span.of(&listing.text).starts_with("NOP? H");
        assert_eq!(is_marked, !line.is_read, "{}", line.span.of(&listing.text));
    }
    assert_eq!(step as usize, words.len());
    assert_eq!(listing.text.lines().count(), listing.lines.len());
    let mut again = encode_freely(&listing.text, target);
    assert_eq!(again.len(), words.len());
    again.truncate(words.len());
    assert!(again == words, "{model:?}: {}", listing.text);
}

/// Encodes a list that may be longer than the memory of its model.
fn encode_freely(list: &str, target: &Target) -> Vec<u16> {
    let lines: Vec<&str> = list.lines().collect();
    let encoded = |part: &[&str]| {
        let part = part.join("\n");
        encode(&part, target).unwrap_or_else(|found| panic!("{found:?}")).words
    };
    lines.chunks(100).flat_map(encoded).collect()
}

/// The lines that can be encoded for an FX2N.
static POOL: LazyLock<Vec<String>> = LazyLock::new(|| {
    let lines = lines(Model::Fx2n).into_iter().map(|(_, line)| line);
    lines.filter(|line| encode(line, Target::of(Model::Fx2n)).is_ok() && !line.starts_with("NOP?")).collect()
});

/// A line with operands of any numbers.
fn numbered() -> impl Strategy<Value = String> {
    prop_oneof![
        (any::<i16>(), 0..8000u32, 0..8u8).prop_map(|(value, d, z)| format!("MOV K{value} D{d}Z{z}")),
        (any::<i32>(), 1..9u8, 0..3000u32).prop_map(|(value, n, m)| format!("DMOVP K{value} K{n}M{m}")),
        (any::<u32>(), 0..200u32).prop_map(|(value, c)| format!("DADD H{value:X} C{c} D0")),
        (200..256u32, any::<i32>()).prop_map(|(c, value)| format!("OUT C{c} K{value}")),
        (0..256u32, 0..8000u32).prop_map(|(t, d)| format!("OUT T{t} D{d}")),
        (0..256u32, 0..1000u32).prop_map(|(x, s)| format!("ZRST S{s} S{x}")),
        (0..0o400u32).prop_map(|x| format!("LDI X{x:o}")),
        (0..3072u32).prop_map(|m| format!("SET M{m}")),
        (0..128u32).prop_map(|p| format!("P{p}")),
        "[ -!#-~]{8}".prop_map(|text| format!("ASC \"{text}\" D100")),
    ]
}

/// Words as programs have them, and others.
fn any_word() -> impl Strategy<Value = u16> {
    prop_oneof![
        2 => any::<u16>(),
        4 => 0x8000..0x9000u16,
        2 => 0xA000..0xB000u16,
        2 => 0..0x0200u16,
        1 => 0x1000..0x1200u16,
        1 => prop_oneof![Just(0x0601u16), Just(0x0EE0), Just(0xF7FF), Just(0xFFFF), Just(0x000F)],
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn programs_read_as_they_were_written(
        places in prop::collection::vec(any::<prop::sample::Index>(), 0..40),
        others in prop::collection::vec(numbered(), 0..40),
    ) {
        let mut list: Vec<&str> = places.iter().map(|place| place.get(&POOL).as_str()).collect();
        list.extend(others.iter().map(String::as_str));
        list.push("END");
        let list = list.join("\n") + "\n";
        let words = encode(&list, Target::of(Model::Fx2n)).unwrap().words;
        let listing = decode(&words, Model::Fx2n);
        prop_assert_eq!(&listing.text, &list);
        prop_assert!(listing.lines.iter().all(|line| line.is_read));
        prop_assert_eq!(encode(&listing.text, Target::of(Model::Fx2n)).unwrap().words, words);
        prop_assert!(fx::format(&list, Target::of(Model::Fx2n)).is_empty(), "not canonical");
    }

    #[test]
    fn any_words_come_back(words in prop::collection::vec(any_word(), 0..200), model in 0..4usize) {
        assert_comes_back(&words, MODELS[model]);
    }

    /// A word of a program is another: what was behind it is found again, or marked.
    #[test]
    fn damaged_programs_come_back(
        places in prop::collection::vec(any::<prop::sample::Index>(), 1..30),
        damaged in any::<prop::sample::Index>(),
        word in any_word(),
    ) {
        let list: Vec<&str> = places.iter().map(|place| place.get(&POOL).as_str()).collect();
        let mut words = encode(&list.join("\n"), Target::of(Model::Fx2n)).unwrap().words;
        let place = damaged.index(words.len());
        words[place] = word;
        for model in MODELS {
            assert_comes_back(&words, model);
        }
    }
}
