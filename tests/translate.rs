//! From drawing to list and back, with an answer beside each that owes nothing to the translator: the list is run by
//! `stack_machine`, the drawing by following its wires.

use crate::stack_machine::{self, Bits};
use proptest::prelude::*;
use rungwise::document::{Document, Notation, Tree};
use rungwise::ladder::{ContactKind, ElementKind, Graph, VertexId, VertexKind};
use rungwise::target::{Model, Target};
use rungwise::translate::{Certificate, Options, Proof, To, Value, prove, translate};
use rungwise::translate::{from_boolean, to_boolean};
use std::collections::{HashSet, VecDeque};

pub(crate) fn list(text: &str) -> Document {
    Document::new(text, Notation::FxIl, Target::of(Model::Fx2n))
}

pub(crate) fn drawing(text: &str) -> Document {
    Document::new(text, Notation::Ladder, Target::of(Model::Fx2n))
}

/// The translation, of which every rung must be proved.
pub(crate) fn certain(document: &Document, to: To) -> String {
    let translation = translate(document, None, to, &Options::default());
    for rung in &translation.rungs {
        let certificate = rung.certificate;
        let source = document.slice(rung.span);
        assert!(
            certificate.is_some_and(Certificate::is_certain),
            "{certificate:?} {:?}\n{source}\n{}",
            rung.note,
            translation.text
        );
        assert_eq!(rung.note, None, "{source}");
    }
    translation.text
}

fn there_and_back(text: &str) -> (String, String) {
    let drawn = certain(&list(text), To::Ladder);
    (certain(&drawing(&drawn), To::Fx), drawn)
}

/// A rung of contacts in series and in parallel, for which all orders and depths are made.
#[derive(Clone, Debug)]
enum Part {
    Contact,
    Series(Vec<Part>),
    Parallel(Vec<Part>),
}

/// All parts with `contacts` contacts; those in series (or in parallel) are left out if `but` says so, so that none
/// stands directly in its like.
fn parts(contacts: usize, but: Option<bool>) -> Vec<Part> {
    if contacts == 1 {
        return vec![Part::Contact];
    }
    let mut all = Vec::new();
    for series in [true, false].into_iter().filter(|series| but != Some(*series)) {
        for rows in rows(contacts, series) {
            all.push(if series { Part::Series(rows) } else { Part::Parallel(rows) });
        }
    }
    all
}

/// At least two parts side by side with so many contacts in all.
fn rows(contacts: usize, series: bool) -> Vec<Vec<Part>> {
    let mut all = Vec::new();
    for first in 1..contacts {
        for head in parts(first, Some(series)) {
            let rest = contacts - first;
            let mut tails: Vec<Vec<Part>> =
                parts(rest, Some(series)).into_iter().map(|part| vec![part]).collect();
            tails.extend(if rest > 1 { rows(rest, series) } else { Vec::new() });
            all.extend(tails.into_iter().map(|tail| [vec![head.clone()], tail].concat()));
        }
    }
    all
}

/// The part as a list that joins block by block, as nobody would write it.
fn naive(part: &Part, next: &mut u32, closed: u32, text: &mut String) {
    match part {
        Part::Contact => {
            let mnemonic = if closed & 1 << *next == 0 { "LD" } else { "LDI" };
            *text += &format!("{mnemonic} X{next}\n");
            *next += 1;
        }
        Part::Series(parts) | Part::Parallel(parts) => {
            for (number, inner) in parts.iter().enumerate() {
                naive(inner, next, closed, text);
                if number > 0 {
                    *text += if matches!(part, Part::Series(_)) { "ANB\n" } else { "ORB\n" };
                }
            }
        }
    }
}

/// All series-parallel rungs of up to five contacts, open and closed, as lists.
pub(crate) fn all_small_rungs() -> Vec<String> {
    let mut rungs = Vec::new();
    for contacts in 1..=5 {
        for part in parts(contacts, None) {
            for closed in 0..1 << contacts {
                let mut text = String::new();
                naive(&part, &mut 0, closed, &mut text);
                rungs.push(text + "OUT Y0\n");
            }
        }
    }
    rungs
}

/// What a list drives Y0 with, for all values of X0 to X4, a bit each.
pub(crate) fn truth_of_list(text: &str) -> u32 {
    (0..32).filter(|inputs| stack_machine_output(text, *inputs)).fold(0, |truth, inputs| truth | 1 << inputs)
}

fn stack_machine_output(text: &str, inputs: u32) -> bool {
    let mut bits: Bits = (0..5).map(|number| (format!("X{number}"), inputs & 1 << number != 0)).collect();
    stack_machine::scan(text, &mut bits, &Bits::new());
    bits["Y0"]
}

/// What a drawing of one rung drives its coil with, found along its wires.
fn truth_of_drawing(graph: &Graph) -> u32 {
    let coil = graph
        .vertex_ids()
        .find(|id| graph.element_at(*id).is_some_and(|element| matches!(element.kind, ElementKind::Coil(_))));
    let coil = coil.expect("a coil");
    (0..32).filter(|inputs| power_before(graph, coil, *inputs)).fold(0, |truth, inputs| truth | 1 << inputs)
}

fn power_before(graph: &Graph, at: VertexId, inputs: u32) -> bool {
    graph.incoming(at).any(|arc| {
        let tail = graph.arc(arc).tail;
        match graph.vertex(tail).kind {
            VertexKind::LeftRail => true,
            VertexKind::Element(id) => {
                let element = graph.element(id);
                let number = element.device().expect("a device").number;
                let on = inputs & 1 << number != 0;
                let closed = element.kind == ElementKind::Contact(ContactKind::NormallyClosed);
                on != closed && power_before(graph, tail, inputs)
            }
            _ => power_before(graph, tail, inputs),
        }
    })
}

#[test]
fn every_small_rung_goes_there_and_back() {
    let rungs = all_small_rungs();
    assert_eq!(rungs.len(), 3290);
    let (again, drawn) = there_and_back(&(rungs.concat() + "END\n"));
    // What came back is drawn the same, and written the same.
    assert_eq!(certain(&list(&again), To::Ladder), drawn);
    assert_eq!(certain(&list(&again), To::Fx), again);
    let mut lists = again.split_inclusive("OUT Y0\n");
    let document = drawing(&drawn);
    let graphs = document.chunks().flat_map(|at| match at.chunk.tree() {
        Tree::Ladder(tree) => tree.rungs.iter().map(|rung| rung.graph.clone()).collect::<Vec<_>>(),
        _ => Vec::new(),
    });
    let mut graphs = graphs.collect::<Vec<_>>().into_iter();
    for rung in &rungs {
        let truth = truth_of_list(rung);
        let list = lists.next().expect("a list for each rung");
        assert_eq!(truth_of_list(list), truth, "{rung}\n{list}");
        assert_eq!(truth_of_drawing(&graphs.next().expect("a drawing for each rung")), truth, "{rung}");
    }
}

/// Instructions of the shortest list that drives the outputs with these truths in this order, each contact once and in
/// this order, normally open or closed, if it is shorter than `known`; else `known`. Found by trying all lists that can
/// be.
fn shortest(contacts: &[u32], outputs: &[u32], known: usize) -> usize {
    type State = (Vec<u32>, Vec<u32>, usize, usize);
    let mut waiting: VecDeque<(State, usize)> = VecDeque::from([((vec![], vec![], 0, 0), 0)]);
    let mut seen: HashSet<State> = HashSet::new();
    while let Some((state, length)) = waiting.pop_front() {
        let (blocks, kept, next, driven) = &state;
        if *driven == outputs.len() && *next == contacts.len() && kept.is_empty() && blocks.len() == 1 {
            return length;
        }
        let mut go = |blocks: Vec<u32>, kept: Vec<u32>, next: usize, driven: usize| {
            // Each contact and output still takes an instruction, and so do each block to join and each power to
            // forget.
            let left = contacts.len() - next + outputs.len() - driven + kept.len() + blocks.len().max(1) - 1;
            let state = (blocks, kept, next, driven);
            if length + 1 + left < known && seen.insert(state.clone()) {
                waiting.push_back((state, length + 1));
            }
        };
        let joined = |value: u32, and: bool| {
            let mut blocks = blocks.clone();
            if let Some(top) = blocks.last_mut() {
                *top = if and { *top & value } else { *top | value };
            }
            blocks
        };
        for contact in contacts.get(*next).into_iter().flat_map(|contact| [*contact, !contact]) {
            let mut loaded = blocks.clone();
            loaded.push(contact);
            go(loaded, kept.clone(), next + 1, *driven);
            if !blocks.is_empty() {
                go(joined(contact, true), kept.clone(), next + 1, *driven);
                go(joined(contact, false), kept.clone(), next + 1, *driven);
            }
        }
        let Some(top) = blocks.last() else { continue };
        if let [rest @ .., lower, upper] = &blocks[..] {
            go([rest, &[lower & upper]].concat(), kept.clone(), *next, *driven);
            go([rest, &[lower | upper]].concat(), kept.clone(), *next, *driven);
        }
        let replaced = |value: u32| [&blocks[..blocks.len() - 1], &[value]].concat();
        go(replaced(!top), kept.clone(), *next, *driven);
        go(blocks.clone(), [&kept[..], &[*top]].concat(), *next, *driven);
        if let [rest @ .., last] = &kept[..] {
            go(replaced(*last), kept.clone(), *next, *driven);
            go(replaced(*last), rest.to_vec(), *next, *driven);
        }
        if outputs.get(*driven) == Some(top) && blocks.len() == 1 {
            go(blocks.clone(), kept.clone(), *next, driven + 1);
        }
    }
    known
}

/// The truth of input `number` over all values of five inputs.
fn input(number: u32) -> u32 {
    (0..32).filter(|inputs| inputs & 1 << number != 0).fold(0, |truth, inputs| truth | 1 << inputs)
}

#[test]
fn no_list_for_the_drawn_order_is_shorter() {
    for contacts in 1..=4 {
        for part in parts(contacts, None) {
            let mut text = String::new();
            naive(&part, &mut 0, 0, &mut text);
            for output in ["OUT Y0\n", "INV\nOUT Y0\n"] {
                let text = text.clone() + output;
                let truth = truth_of_list(&text);
                let short = certain(&list(&text), To::Fx);
                let inputs: Vec<u32> = (0..contacts as u32).map(input).collect();
                // END is no part of the rung.
                let length = short.lines().count() - 1;
                assert_eq!(length, shortest(&inputs, &[truth], length), "{short}");
            }
        }
    }
}

#[test]
fn no_list_for_several_outputs_is_shorter() {
    // Behind X0, each letter is what one drive needs: o output, n negated coil, b output behind a contact, c output
    // behind two contacts in parallel, v output behind a contact that feeds another one behind a second, i output
    // behind a contact behind an inverter.
    for drives in words("onbcvi", 3) {
        let mut rows = Vec::new();
        let mut next = 1;
        let mut outputs = Vec::new();
        let mut number = 0;
        let mut coil = || {
            number += 1;
            format!("Y{}", number - 1)
        };
        for drive in drives.chars() {
            let mut contact = || {
                next += 1;
                next - 1
            };
            match drive {
                'o' => {
                    outputs.push(input(0));
                    rows.push(format!("OUT {}", coil()));
                }
                'n' => {
                    outputs.push(!input(0));
                    rows.push(format!("INV\nOUT {}", coil()));
                }
                'b' => {
                    let own = contact();
                    outputs.push(input(0) & input(own));
                    rows.push(format!("AND X{own}\nOUT {}", coil()));
                }
                'i' => {
                    let own = contact();
                    outputs.push(!input(0) & input(own));
                    rows.push(format!("INV\nAND X{own}\nOUT {}", coil()));
                }
                'c' => {
                    let [one, two] = [contact(), contact()];
                    outputs.push(input(0) & (input(one) | input(two)));
                    rows.push(format!("LD X{one}\nOR X{two}\nANB\nOUT {}", coil()));
                }
                _ => {
                    let [one, two] = [contact(), contact()];
                    outputs.extend([input(0) & input(one), input(0) & input(one) & input(two)]);
                    rows.push(format!("AND X{one}\nOUT {}\nAND X{two}\nOUT {}", coil(), coil()));
                }
            }
        }
        if next > 5 {
            continue;
        }
        let mut text = "LD X0\n".to_string();
        for (row, drive) in rows.iter().enumerate() {
            text += match row {
                _ if rows.len() == 1 => "",
                0 => "MPS\n",
                _ if row + 1 == rows.len() => "MPP\n",
                _ => "MRD\n",
            };
            text += &format!("{drive}\n");
        }
        let short = certain(&list(&text), To::Fx);
        let contacts: Vec<u32> = (0..next).map(input).collect();
        let length = short.lines().count() - 1;
        assert_eq!(length, shortest(&contacts, &outputs, length), "{drives}\n{text}\n{short}");
    }
}

/// All words of up to `length` letters.
fn words(letters: &str, length: usize) -> Vec<String> {
    let mut all = vec![String::new()];
    let mut start = 0;
    for _ in 0..length {
        let end = all.len();
        for word in start..end {
            all.extend(letters.chars().map(|letter| format!("{}{letter}", all[word])).collect::<Vec<_>>());
        }
        start = end;
    }
    all.split_off(1)
}

/// The programs of the papers, as list and as equations.
pub const WORKED: [(&str, &str); 3] = [
    ("LD X4\nOR X6\nORI M102\nOUT Y5\nEND\n", "Y5 = X4 + X6 + [M102]\nEND\n"),
    (
        "LDI Y5\nAND X7\nOR M108\nANI X10\nORI M110\nOUT M103\nEND\n",
        "M103 = ([Y5]*X7 + M108)*[X10] + [M110]\nEND\n",
    ),
    (
        "LD X0\nOR X1\nLD X2\nAND X3\nLDI X4\nANI X5\nORB\nOR X6\nANB\nOR X7\nOUT Y6\nEND\n",
        "Y6 = (X0 + X1)*(X2*X3 + [X4]*[X5] + X6) + X7\nEND\n",
    ),
];

#[test]
fn worked_examples_of_the_field() {
    for (text, equation) in WORKED {
        let (again, drawn) = there_and_back(text);
        assert_eq!(again, text);
        assert_eq!(certain(&list(text), To::Boolean), equation);
        assert_eq!(certain(&drawing(&drawn), To::Boolean), equation);
        assert_eq!(from_boolean::list(equation, Target::of(Model::Fx2n)), Ok(text.to_string()));
        let symbols = Options { notation: to_boolean::Notation::Symbols, ..Options::default() };
        let symbols = translate(&list(text), None, To::Boolean, &symbols).text;
        assert_eq!(from_boolean::list(&symbols, Target::of(Model::Fx2n)), Ok(text.to_string()));
    }
}

#[test]
fn comments_of_every_kind_stand_among_equations() {
    let text = "(* two\n   lines; // of it *)\n; plain\n// why\nLD X0\nOUT Y0\n(* last *)\nEND\n";
    let equations = certain(&list(text), To::Boolean);
    assert_eq!(equations, "(* two\n   lines; // of it *)\n; plain\n// why\nY0 = X0\n\n(* last *)\nEND\n");
    assert_eq!(from_boolean::list(&equations, Target::of(Model::Fx2n)), Ok(text.to_string()));
    let beside = "Y0 = X0 (* a\nb *)\nY1 = X1 // c\nY2 (* d *) = X2";
    let read = "(* a\nb *)\nLD X0\nOUT Y0\n// c\nLD X1\nOUT Y1\n(* d *)\nLD X2\nOUT Y2\n";
    assert_eq!(from_boolean::list(beside, Target::of(Model::Fx2n)), Ok(read.to_string()));
    check_equation("Y0 = X0 (* a", "        ^^");
}

#[test]
fn comments_and_networks_keep_their_places() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let drawn = std::fs::read_to_string(folder.join("traffic-lights/lights.lad")).expect("an example");
    let listed = certain(&drawing(&drawn), To::Fx);
    assert!(listed.contains(". *)\n\n; NETWORK 1 'the cycle'\n(* Green for A, 20 s *)\nLD X0\n"), "{listed}");
    let again = certain(&list(&listed), To::Ladder);
    assert_eq!(
        again.strip_suffix("\n\n+--[END]---------------------------------------+\n"),
        drawn.strip_suffix('\n')
    );
}

#[test]
fn comments_behind_the_end_stay_behind_it() {
    for text in ["LD X0\nOUT Y0\nEND\n; after\n", "LD X0\nOUT Y0\nEND\n\n; after\n; all\n"] {
        assert_eq!(certain(&list(text), To::Fx), text);
        let (again, drawn) = there_and_back(text);
        assert!(drawn.contains("--+\n\n; after\n"), "{drawn}");
        assert_eq!(again.replace("END\n\n", "END\n"), text.replace("END\n\n", "END\n"));
    }
}

#[test]
fn contacts_behind_a_step_begin_anew() {
    let text = "STL S20\nLD X0\nOR X1\nAND X2\nSET S21\nSTL S21\nOUT Y0\nRET\nEND\n";
    let (again, drawn) = there_and_back(text);
    assert_eq!(again, text);
    assert!(drawn.contains("--[STL S20]-"), "{drawn}");
    // Outputs may branch behind a step; what branches with contacts would need a result that there is not.
    let branched = "\
|                                          Y0  |
+--[STL S20]--+----------------------------( )-+
|             |   X1                       S21 |
|             +---| |----------------------(S)-+
";
    let translation = translate(&drawing(branched), None, To::Fx, &Options::default());
    let [rung] = &translation.rungs[..] else { panic!("{translation:?}") };
    assert_eq!(rung.certificate, Some(Certificate::Undecided));
    assert_eq!(rung.note.as_ref().map(|note| note.key()), Some("translate.step-branch"));
    let refused = translate(&list("STL S20\nAND X1\nSET S21\n"), None, To::Ladder, &Options::default());
    assert!(refused.rungs[0].note.is_some());
}

#[test]
fn branches_that_nest_too_deep_are_written_output_by_output() {
    let nested = |last: &str| {
        let down: String = (0..12).map(|number| format!("MPS\nAND M{number}\n")).collect();
        let up: String = (0..12).map(|number| format!("MPP\nANI X{number}\nOUT Y{number}\n")).collect();
        format!("LD X20\n{down}OUT {last}\n{}", up.replace("ANI X8", "ANI X10").replace("ANI X9", "ANI X11"))
    };
    let text = nested("Y20").replace("OUT Y8", "OUT Y12").replace("OUT Y9", "OUT Y13");
    let drawn = translate(&list(&text), None, To::Ladder, &Options::default());
    let listed = certain(&drawing(&drawn.text), To::Fx);
    assert!(!listed.contains("MPS") && listed.matches("LD X20\n").count() == 13, "{listed}");
    assert!(matches!(prove(&list(&listed), &drawing(&drawn.text)), Proof::Equal { .. }));
    // What is driven first and read then would not be the same any more.
    let drawn = translate(&list(&nested("M3")), None, To::Ladder, &Options::default());
    let kept = translate(&drawing(&drawn.text), None, To::Fx, &Options::default());
    assert_eq!(
        kept.rungs[0].note.as_ref().map(|note| note.key()),
        Some("translate.branches"),
        "{}",
        kept.text
    );
}

/// The bits that a proof gives for a scan, and as they were one scan before.
fn bits_of(found: &rungwise::translate::Counterexample) -> (Bits, Bits) {
    let bits = |values: &std::collections::BTreeMap<String, Value>| -> Bits {
        let bits = values.iter().filter_map(|(name, value)| match value {
            Value::Bit(value) => Some((name.clone(), *value)),
            _ => None,
        });
        bits.collect()
    };
    let now = bits(&found.inputs);
    let mut before = now.clone();
    before.extend(bits(&found.before));
    (now, before)
}

/// The proof finds that two lists differ, and the scan that it names does tell them apart.
pub(crate) fn found_different(left: &str, right: &str) {
    let Proof::Different(found) = prove(&list(left), &list(right)) else {
        panic!("no difference is found between\n{left}\nand\n{right}");
    };
    let (now, before) = bits_of(&found);
    let ends = [left, right].map(|text| {
        let mut bits = now.clone();
        stack_machine::scan(text, &mut bits, &before);
        bits
    });
    assert_ne!(ends[0], ends[1], "{found:?}\n{left}\nand\n{right}");
    assert_eq!(ends.map(|bits| Value::Bit(bits[&found.what])), found.sides, "{found:?}");
}

#[test]
fn every_wrong_translation_is_found() {
    let source = "LD X0\nOR Y0\nANI X1\nOUT Y0\nLDP X2\nMPS\nAND X3\nSET M0\nMRD\nANI X4\nRST M1\nMPP\n\
                  LD X5\nOR X6\nANB\nOUT Y1\nLD M0\nLD X7\nANI M1\nORB\nINV\nOUT Y2\nEND\n";
    let right = there_and_back(source).0;
    assert!(matches!(prove(&list(source), &list(&right)), Proof::Equal { is_reordered: false }));
    let lines: Vec<&str> = right.lines().collect();
    let mutate = |number: usize, line: &str| {
        let mut lines = lines.clone();
        lines[number] = line;
        lines.join("\n") + "\n"
    };
    let mut mutants = 0;
    for (number, line) in lines.iter().enumerate() {
        let (mnemonic, device) = line.split_once(' ').unwrap_or((line, ""));
        // Each contact the other way round, each put elsewhere, each left out, each output another one.
        let others: &[&str] = match mnemonic {
            "LD" => &["LDI"],
            "LDI" => &["LD"],
            "LDP" => &["LDF", "LD"],
            "AND" => &["ANI"],
            "ANI" => &["AND"],
            "OR" => &["ORI", "AND"],
            "ORB" => &["ANB"],
            "SET" => &["RST", "OUT"],
            "RST" => &["SET", "OUT"],
            "OUT" => &["SET"],
            _ => &[],
        };
        for other in others {
            found_different(&right, &mutate(number, &format!("{other} {device}")));
            mutants += 1;
        }
        if matches!(mnemonic, "AND" | "ANI" | "OR" | "INV") {
            found_different(&right, &mutate(number, "NOP").replace("NOP\n", ""));
            mutants += 1;
        }
        for other in lines[number + 1..].iter().filter(|_| mnemonic == "OUT") {
            let Some(target) = other.strip_prefix("OUT ") else { continue };
            let swapped = mutate(number, &format!("OUT {target}"));
            let last = swapped.rfind(other).expect("the other output");
            let swapped = format!("{}OUT {device}{}", &swapped[..last], &swapped[last + other.len()..]);
            found_different(&right, &swapped);
            mutants += 1;
        }
    }
    assert!(mutants > 30, "{mutants}");
}

/// What cannot be read in `text`, drawn under it.
fn check_equation(text: &str, marks: &str) {
    let problems = from_boolean::list(text, Target::of(Model::Fx2n)).expect_err("a problem");
    let mut drawn: Vec<char> = vec![' '; text.chars().count()];
    for problem in problems {
        let start = text[..problem.span.start as usize].chars().count();
        let end = text[..problem.span.end as usize].chars().count();
        drawn.resize(drawn.len().max(end + 1), ' ');
        (start..end.max(start + 1)).for_each(|column| drawn[column] = '^');
    }
    assert_eq!(drawn.iter().collect::<String>().trim_end(), marks, "{text}");
}

#[test]
fn equations_that_cannot_be_read_say_where() {
    check_equation("Y0 = X0 +", "         ^");
    check_equation("Y0 = (X0 + X1", "             ^");
    check_equation("Y0 = [X0", "        ^");
    check_equation("Y0 = X0 X1", "        ^");
    check_equation("Y0", "  ^");
    check_equation("Y0 = X9", "     ^^");
    check_equation("Y0 = (D0 >= K10 + X0)", "                ^");
    check_equation("Y9 = X0", "^^");
    check_equation("= X0", "^");
    let deep = format!("Y0 = {}X0", "(".repeat(100_000));
    let problems = from_boolean::list(&deep, Target::of(Model::Fx2n)).expect_err("a problem");
    assert_eq!(problems[0].message.key(), "boolean.depth");
}

/// A rung made up for a property: how contacts are connected, what each asks, and what is driven behind them.
#[derive(Clone, Debug)]
pub(crate) struct MadeUp {
    part: Part,
    kinds: Vec<u8>,
    drives: Vec<(u8, Option<Part>)>,
}

pub(crate) fn made_up(most: u32) -> impl Strategy<Value = MadeUp> {
    let part = |size: u32| {
        Just(Part::Contact).prop_recursive(6, size, 6, |inner| {
            let several = proptest::collection::vec(inner, 2..6);
            prop_oneof![several.clone().prop_map(Part::Series), several.prop_map(Part::Parallel)]
        })
    };
    let drive = (0..8u8, proptest::option::of(part(most.max(16) / 8)));
    (part(most), proptest::collection::vec(0..8u8, 1..40), proptest::collection::vec(drive, 1..5))
        .prop_map(|(part, kinds, drives)| MadeUp { part, kinds, drives })
}

impl MadeUp {
    /// As a list that joins and branches as nobody would write it.
    pub(crate) fn list(&self) -> String {
        let mut text = String::new();
        let mut next = 0;
        self.block(&self.part, &mut next, &mut text);
        for (number, (kind, part)) in self.drives.iter().enumerate() {
            if self.drives.len() > 1 {
                text += match number {
                    0 => "MPS\n",
                    _ if number + 1 == self.drives.len() => "MPP\n",
                    _ => "MRD\n",
                };
            }
            if let Some(part) = part {
                self.block(part, &mut next, &mut text);
                text += "ANB\n";
            }
            if kind & 4 != 0 {
                text += "INV\n";
            }
            text += &format!("{} Y{number}\n", ["OUT", "SET", "RST", "OUT"][usize::from(kind & 3)]);
        }
        text
    }

    fn block(&self, part: &Part, next: &mut usize, text: &mut String) {
        match part {
            Part::Contact => {
                let mnemonic = match self.kinds[*next % self.kinds.len()] {
                    0..=3 => "LD",
                    4 | 5 => "LDI",
                    6 => "LDP",
                    _ => "LDF",
                };
                *text += &format!("{mnemonic} M{next}\n");
                *next += 1;
            }
            Part::Series(parts) | Part::Parallel(parts) => {
                for (number, inner) in parts.iter().enumerate() {
                    self.block(inner, next, text);
                    if number > 0 {
                        *text += if matches!(part, Part::Series(_)) { "ANB\n" } else { "ORB\n" };
                    }
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn made_up_rungs_go_there_and_back(rung in made_up(200), states in any::<[u64; 8]>()) {
        let text = rung.list() + "END\n";
        let (again, drawn) = there_and_back(&text);
        // The shortest list is written the same again; the drawing of it may have its inverters elsewhere.
        prop_assert_eq!(&certain(&list(&again), To::Fx), &again);
        prop_assert_eq!(prove(&drawing(&drawn), &list(&again)), Proof::Equal { is_reordered: false });
        prop_assert_eq!(prove(&list(&text), &list(&again)), Proof::Equal { is_reordered: false });
        for state in states {
            // A bit for each relay, stretched over all of them.
            let bits: Bits = (0..400).map(|n| (format!("M{n}"), state.rotate_left(n * 7) & 1 == 1)).collect();
            let before: Bits = (0..400).map(|n| (format!("M{n}"), state.rotate_left(n * 5) & 2 == 2)).collect();
            let [one, two] = [&text, &again].map(|text| stack_machine::scan(text, &mut bits.clone(), &before));
            prop_assert_eq!(one, two, "{}\n{}", text, again);
        }
    }

    #[test]
    fn a_proof_says_what_all_inputs_say(one in made_up(5), two in made_up(5)) {
        // Both drive the same outputs; few contacts, so that they are often equal.
        let texts = [&one, &two].map(|rung| {
            MadeUp { drives: vec![(0, None)], kinds: vec![0, 4], ..rung.clone() }.list()
        });
        let contacts = 8;
        prop_assume!(texts.iter().all(|text| text.lines().filter(|line| line.contains('M')).count() <= contacts));
        let differs = (0..1u32 << contacts).any(|state| {
            let outputs = texts.each_ref().map(|text| {
                let mut bits: Bits = (0..contacts).map(|n| (format!("M{n}"), state & 1 << n != 0)).collect();
                stack_machine::scan(text, &mut bits, &Bits::new())
            });
            outputs[0] != outputs[1]
        });
        match prove(&list(&texts[0]), &list(&texts[1])) {
            Proof::Equal { .. } => prop_assert!(!differs),
            Proof::Different(_) => {
                prop_assert!(differs);
                found_different(&texts[0], &texts[1]);
            }
            Proof::Undecided { reason, .. } => prop_assert!(false, "{:?}", reason),
        }
    }
}

#[test]
fn lists_beyond_all_measure_are_refused_and_carried_along() {
    let many = 100_000;
    let alternating: String = (0..many / 2).map(|_| "AND X1\nOR X2\n").collect();
    for (what, body) in [
        ("blocks", "LD X0\n".repeat(many) + &"ANB\n".repeat(many - 1)),
        ("loads", "LD X0\n".repeat(many)),
        ("branches", "LD X0\n".to_string() + &"MPS\nAND X1\n".repeat(many / 2)),
        ("alternating contacts", "LD X0\n".to_string() + &alternating),
        ("inverters", "LD X0\n".to_string() + &"INV\n".repeat(many)),
        ("joins", "LD X0\n".to_string() + &"ORB\n".repeat(many)),
    ] {
        let text = body + "OUT Y0\nEND\n";
        let document = list(&text);
        for to in To::ALL {
            let translation = translate(&document, None, to, &Options::default());
            let told = translation.rungs.iter().any(|rung| rung.note.is_some());
            // Inverters in a row are a list as any other.
            assert!(told || translation.is_certain(), "{what} to {}", to.name());
            assert!(translation.text.len() > 1_000, "{what} to {}: {}", to.name(), translation.text);
        }
        let proof = prove(&document, &document);
        assert!(matches!(proof, Proof::Equal { .. }), "{what}: {proof:?}");
    }
    // 100,000 contacts in one rung, in series and in parallel, are read.
    for mnemonic in ["AND", "OR"] {
        let text = format!("LD X0\n{}OUT Y0\nEND\n", format!("{mnemonic} X1\n").repeat(many));
        assert_eq!(certain(&list(&text), To::Fx), text);
    }
}

#[test]
fn a_question_that_is_hard_to_decide_gets_no_guess() {
    // The middle bit of a product has no small diagram in any order; sums of products over pairs far apart have none
    // in the order of the text.
    let pairs = 40;
    let far: String = (0..pairs)
        .map(|n| {
            let load = format!("LD M{n}\nAND M{}\n", n + pairs);
            if n == 0 { load } else { load + "ORB\n" }
        })
        .collect();
    let order: String = (0..pairs).map(|n| format!("LD M{n}\nOR M{}\n", (n * 7) % pairs)).collect();
    let left = format!("{far}OUT Y0\n");
    let right = format!("{}OUT Y0\n", order + &"ANB\n".repeat(pairs - 1));
    // Whatever the answer, it is no guess and it comes.
    match prove(&list(&left), &list(&right)) {
        Proof::Equal { .. } => panic!("they are not equal"),
        Proof::Different(_) | Proof::Undecided { .. } => {}
    }
}

#[test]
fn lists_of_others_go_there_and_back() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let places = ["../shared/corpus/fx", "../../shared/corpus/fx"].map(|place| root.join(place));
    let Some(folder) = places.iter().find(|folder| folder.exists()) else {
        return crate::corpus::say_skipped("no folder of lists");
    };
    let mut files = 0;
    for entry in std::fs::read_dir(folder).expect("the folder is there") {
        let text = std::fs::read_to_string(entry.expect("a file").path()).expect("a list");
        let (again, drawn) = there_and_back(&text);
        for other in [list(&again), drawing(&drawn)] {
            assert_eq!(prove(&list(&text), &other), Proof::Equal { is_reordered: false }, "{text}");
        }
        files += 1;
    }
    assert!(files > 5, "{files}");
}
