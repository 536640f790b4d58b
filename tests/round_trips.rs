//! There and back at the edges: rungs of about two hundred elements, all small rungs through IEC 61131-3, what nests as
//! deep as a model allows and one deeper, and every row of the instruction table.

use crate::ladder_generate::{Leaf, Part, generate, large_rung};
use crate::machine_code_rows;
use crate::proof_shown::Dice;
use crate::stack_machine::{self, Bits};
use crate::translate::{all_small_rungs, certain, drawing, list, truth_of_list};
use crate::translate_iec;
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::TestRunner;
use rungwise::document::{Document, Notation, Tree};
use rungwise::il::fx;
use rungwise::ladder::{ContactKind, ElementKind, Graph, VertexId, VertexKind};
use rungwise::logic::{Comparison, Effort, compare, rungs};
use rungwise::target::{Form, Model, Role, Target, instructions};
use rungwise::translate::{Options, Proof, To, prove, translate};
use std::collections::{BTreeSet, HashMap};

/// The most blocks and the most powers that a list keeps at a time.
fn depths(text: &str) -> [usize; 2] {
    let (mut blocks, mut kept, mut most) = (0, 0, [0, 0]);
    let mut has_driven = true;
    for line in text.lines() {
        let word = line.split_whitespace().next().unwrap_or_default();
        match word {
            "ANB" | "ORB" => blocks -= 1,
            "MPS" => kept += 1,
            "MPP" => kept -= 1,
            // Behind the outputs of a rung the next one begins, unless a branch goes on.
            _ if word.starts_with("LD") => blocks = if has_driven && kept == 0 { 1 } else { blocks + 1 },
            _ => {}
        }
        has_driven = matches!(word, "OUT" | "SET" | "RST");
        most = [most[0].max(blocks), most[1].max(kept)];
    }
    most
}

/// A condition of so many contacts, joined block by block, in which each device is used once.
fn condition(dice: &mut Dice, contacts: usize, next: &mut usize, text: &mut String) {
    if contacts == 1 {
        *text += &format!("{} M{next}\n", dice.one(&["LD", "LD", "LDI", "LDP", "LDF"]));
        *next += 1;
        return;
    }
    let first = 1 + dice.roll(contacts - 1);
    condition(dice, first, next, text);
    condition(dice, contacts - first, next, text);
    *text += dice.one(&["ANB\n", "ORB\n"]);
}

fn graphs(document: &Document) -> Vec<(String, Graph)> {
    let rungs = document.chunks().flat_map(|at| match at.chunk.tree() {
        Tree::Ladder(tree) => tree
            .rungs
            .iter()
            .map(|rung| (at.chunk.text().to_string(), rung.graph.clone()))
            .collect::<Vec<_>>(),
        _ => Vec::new(),
    });
    rungs.collect()
}

fn elements(graph: &Graph) -> usize {
    graph.vertex_ids().filter(|id| graph.element_at(*id).is_some()).count()
}

/// The bits M0 to M199 of one state.
fn bits(dice: &mut Dice) -> Bits {
    (0..200).map(|number| (format!("M{number}"), dice.roll(2) == 1)).collect()
}

#[test]
fn rungs_of_two_hundred_elements_go_there_and_back() {
    for seed in 0..24 {
        let mut dice = Dice(seed * 7919 + 3);
        let mut text = String::new();
        let contacts = 180 + dice.roll(20);
        condition(&mut dice, contacts, &mut 0, &mut text);
        let outputs = ["OUT Y0\n", "SET Y1\n", "RST Y2\n"];
        outputs[..1 + dice.roll(3)].iter().for_each(|output| text += output);
        let drawn = certain(&list(&text), To::Ladder);
        let [(_, graph)] = &graphs(&drawing(&drawn))[..1] else { panic!("{drawn}") };
        assert!((181..=205).contains(&elements(graph)), "{} elements\n{drawn}", elements(graph));
        let again = certain(&drawing(&drawn), To::Fx);
        assert_eq!(certain(&drawing(&certain(&list(&again), To::Ladder)), To::Fx), again);
        assert_eq!(prove(&list(&text), &list(&again)), Proof::Equal { is_reordered: false });
        let [blocks, kept] = depths(&again);
        assert!(blocks <= 8 && kept <= 11, "{blocks} {kept}\n{again}");
        for _ in 0..8 {
            let [now, before] = [bits(&mut dice), bits(&mut dice)];
            let [one, two] = [&text, &again].map(|text| stack_machine::scan(text, &mut now.clone(), &before));
            assert_eq!(one, two, "{text}\n{again}");
        }
    }
}

/// The part with nothing but what an FX list has words for: no function blocks, jumps, connectors and bare wires.
/// Without `outputs` it has contacts alone.
fn for_fx(part: Part, outputs: bool) -> Part {
    let all = |parts: Vec<Part>| parts.into_iter().map(|part| for_fx(part, outputs)).collect();
    match part {
        Part::Series(parts) => Part::Series(all(parts)),
        Part::Parallel(parts) => Part::Parallel(all(parts)),
        Part::Wire => Part::Leaf(Leaf::Contact(0, 5)),
        Part::Leaf(Leaf::Block(n)) => Part::Leaf(Leaf::Contact(1, n)),
        Part::Leaf(Leaf::Invert) => Part::Leaf(Leaf::Compare(3, 8)),
        Part::Leaf(Leaf::Coil(_, n) | Leaf::Timer(n) | Leaf::Box(_, n)) if !outputs => {
            Part::Leaf(Leaf::Contact(n as u8, n))
        }
        Part::Leaf(Leaf::Jump(n) | Leaf::ConnectorOut(n)) if !outputs => Part::Leaf(Leaf::Contact(0, n)),
        Part::Leaf(Leaf::Return) if !outputs => Part::Leaf(Leaf::Contact(1, 7)),
        Part::Leaf(Leaf::Jump(n) | Leaf::ConnectorOut(n)) => Part::Leaf(Leaf::Coil(0, n)),
        Part::Leaf(Leaf::Return) => Part::Leaf(Leaf::Coil(2, 7)),
        leaf => leaf,
    }
}

#[test]
fn large_drawings_of_all_elements_go_there_and_back() {
    let mut runner = TestRunner::deterministic();
    let target = Target::of(Model::Fx2n);
    for _ in 0..12 {
        let mut large_part = || large_rung().new_tree(&mut runner).unwrap().current();
        let part = Part::Series(vec![for_fx(large_part(), false), for_fx(large_part(), true)]);
        let generated = generate(&part, target);
        let size = elements(&generated.graph);
        let drawn = crate::ladder_print::drawn(&generated, &Default::default());
        let listed = certain(&drawing(&drawn), To::Fx);
        let again = certain(&list(&listed), To::Ladder);
        assert_eq!(certain(&drawing(&again), To::Fx), listed, "{drawn}");
        let proof = prove(&drawing(&drawn), &list(&listed));
        assert!(matches!(proof, Proof::Equal { .. }), "{proof:?}\n{drawn}");
        let [blocks, kept] = depths(&listed);
        assert!(blocks <= 8 && kept <= 11, "{blocks} {kept}\n{listed}");
        assert!((150..260).contains(&size), "{size} elements");
    }
}

/// What a drawing of one rung drives its coil with, found along its wires, for all values of X0 to X4, a bit each.
fn truth_of_drawing((text, graph): &(String, Graph)) -> u32 {
    let is_coil = |id: &VertexId| {
        graph.element_at(*id).is_some_and(|element| matches!(element.kind, ElementKind::Coil(_)))
    };
    let coil = graph.vertex_ids().find(is_coil).expect("a coil");
    let power = |inputs: u32| power_before(text, graph, coil, inputs);
    (0..32).filter(|inputs| power(*inputs)).fold(0, |truth, inputs| truth | 1 << inputs)
}

fn power_before(text: &str, graph: &Graph, at: VertexId, inputs: u32) -> bool {
    graph.incoming(at).any(|arc| {
        let tail = graph.arc(arc).tail;
        match graph.vertex(tail).kind {
            VertexKind::LeftRail => true,
            VertexKind::Element(id) => {
                let element = graph.element(id);
                let name = element.operand_text(0, text);
                let number: u32 = name.strip_prefix('X').expect("an input").parse().expect("a number");
                let closed = element.kind == ElementKind::Contact(ContactKind::NormallyClosed);
                (inputs & 1 << number != 0) != closed && power_before(text, graph, tail, inputs)
            }
            _ => power_before(text, graph, tail, inputs),
        }
    })
}

#[test]
fn every_small_drawing_goes_through_iec_and_back() {
    let small = all_small_rungs();
    let options = Options { is_whole: false, ..Options::default() };
    let drawn = translate(&list(&small.concat()), None, To::Ladder, &options).text;
    let source = translate_iec::drawing(&drawn);
    let translation = translate_iec::to(&source, To::Iec);
    assert_eq!(translation.rungs.len(), small.len());
    assert!(translation.is_certain());
    let again = translate_iec::certain(&translate_iec::list(&translation.text), To::Ladder);
    let drawings = [graphs(&source), graphs(&translate_iec::drawing(&again))];
    assert_eq!(drawings.each_ref().map(Vec::len), [small.len(); 2]);
    for (number, rung) in small.iter().enumerate() {
        let truth = truth_of_list(rung);
        let listed = &translation.text[translation.rungs[number].result.clone()];
        let in_list = (0..32u32).filter(|inputs| {
            let inputs = (0..5).map(|input| (format!("x{input}"), i64::from(inputs >> input & 1)));
            let mut state: HashMap<String, i64> = inputs.collect();
            translate_iec::scan(listed, &mut state);
            state["y0"] == 1
        });
        assert_eq!(in_list.fold(0, |truth, inputs| truth | 1 << inputs), truth, "{rung}\n{listed}");
        for drawings in &drawings {
            assert_eq!(truth_of_drawing(&drawings[number]), truth, "{rung}");
        }
    }
}

/// A list that keeps so many blocks at a time, each begun inside the one before.
fn nested(blocks: usize) -> String {
    let loads: String = (0..blocks).map(|number| format!("LD M{number}\n")).collect();
    let joins: String = (1..blocks).map(|number| if number % 2 == 1 { "ORB\n" } else { "ANB\n" }).collect();
    format!("{loads}AND M{blocks}\n{joins}OUT Y0\nEND\n")
}

#[test]
fn blocks_nest_as_deep_as_the_model_allows() {
    assert_eq!([8, 9].map(|blocks| depths(&nested(blocks))[0]), [8, 9]);
    let deepest = nested(8);
    assert_eq!(certain(&list(&deepest), To::Fx), deepest);
    assert_eq!(certain(&drawing(&certain(&list(&deepest), To::Ladder)), To::Fx), deepest);
    // One deeper, and the deepest block comes first.
    let deeper = nested(9);
    let drawn = certain(&list(&deeper), To::Ladder);
    for written in [certain(&list(&deeper), To::Fx), certain(&drawing(&drawn), To::Fx)] {
        assert!(depths(&written)[0] <= 8, "{written}");
        assert_eq!(prove(&drawing(&drawn), &list(&written)), Proof::Equal { is_reordered: false });
        for state in 0..1u32 << 10 {
            let now: Bits = (0..10).map(|number| (format!("M{number}"), state >> number & 1 == 1)).collect();
            let [one, two] =
                [&deeper, &written].map(|text| stack_machine::scan(text, &mut now.clone(), &Bits::new()));
            assert_eq!(one, two);
        }
    }
}

/// A condition in which each part is joined of two alike, `levels` deep.
fn balanced(levels: u32, next: &mut u32, text: &mut String) {
    if levels == 0 {
        *text += &format!("LD M{next}\n");
        *next += 1;
        return;
    }
    balanced(levels - 1, next, text);
    balanced(levels - 1, next, text);
    *text += if levels.is_multiple_of(2) { "ANB\n" } else { "ORB\n" };
}

#[test]
fn what_needs_more_blocks_than_the_model_has_is_never_written() {
    for (levels, is_written) in [(8, true), (9, false)] {
        let mut text = String::new();
        balanced(levels, &mut 0, &mut text);
        let drawn = certain(&list(&(text + "OUT Y0\n")), To::Ladder);
        let translation = translate(&drawing(&drawn), None, To::Fx, &Options::default());
        assert_eq!(translation.is_certain(), is_written);
        let key = translation.rungs[0].note.as_ref().map(|note| note.key());
        assert_eq!(key, (!is_written).then_some("translate.blocks"));
        assert!(depths(&translation.text)[0] <= 8);
        let tree = fx::parse(&translation.text, Target::of(Model::Fx2n));
        assert_eq!(tree.lines.len() > 1, is_written, "{}", translation.text);
    }
}

#[test]
fn branches_nest_as_deep_as_the_model_allows() {
    let nested = |depth: usize| {
        let down: String = (0..depth).map(|number| format!("MPS\nAND M{number}\n")).collect();
        let up = (0..depth).map(|number| format!("MPP\nANI M{}\nOUT M{}\n", 50 + number, 100 + number));
        let up: String = up.collect();
        format!("LD X20\n{down}OUT Y20\n{up}END\n")
    };
    let deepest = nested(11);
    assert_eq!(depths(&deepest), [1, 11]);
    assert_eq!(certain(&list(&deepest), To::Fx), deepest);
    let drawn = certain(&list(&deepest), To::Ladder);
    assert_eq!(certain(&drawing(&drawn), To::Fx), deepest);
    let deeper = nested(12);
    let drawn = certain(&list(&deeper), To::Ladder);
    let written = certain(&drawing(&drawn), To::Fx);
    assert_eq!(depths(&written)[1], 0, "{written}");
    let proof = prove(&list(&deeper), &list(&written));
    assert!(matches!(proof, Proof::Equal { .. }), "{proof:?}");
}

/// A rung in which an instruction stands at a place of its own.
pub(crate) fn around(form: Form, line: &str) -> String {
    match form.instruction.role {
        Role::Load | Role::StepLoad => format!("{line}\nOUT Y7\n"),
        Role::Series | Role::Parallel => format!("LD X1\n{line}\nOUT Y7\n"),
        Role::BlockSeries => format!("LD X1\nLD X2\nOR X3\n{line}\nOUT Y7\n"),
        Role::BlockParallel => format!("LD X1\nLD X2\nAND X3\n{line}\nOUT Y7\n"),
        Role::BranchPush | Role::BranchRead | Role::BranchPop => {
            "LD X1\nMPS\nAND X2\nOUT Y5\nMRD\nAND X3\nOUT Y6\nMPP\nAND X4\nOUT Y7\n".into()
        }
        // An edge has no opposite that would do without it.
        Role::Modify => format!("LDP X1\n{line}\nOUT Y7\n"),
        Role::Output => format!("LD X1\n{line}\n"),
        Role::Standalone if line.starts_with(['P', 'I']) && form.mnemonic() != "PR" => {
            format!("{line}\nLD X1\nOUT Y7\n")
        }
        Role::Standalone => format!("{line}\n"),
    }
}

#[test]
fn every_row_of_the_table_goes_there_and_back() {
    for model in [Model::Fx1s, Model::Fx1n, Model::Fx2n, Model::Fx3u] {
        let target = Target::of(model);
        let mut rows = BTreeSet::new();
        // What ends the program would end it here; NOP is nothing to draw.
        let lines = machine_code_rows::lines(model).into_iter();
        let lines =
            lines.filter(|(form, line)| form.mnemonic() != "NOP" && line != "END" && !line.contains('?'));
        let mut text = String::new();
        for (form, line) in lines {
            text += &around(form, &line);
            rows.insert(form.instruction.mnemonic);
        }
        text += "END\n";
        let of = |text: &str, notation| Document::new(text, notation, target);
        let drawn = certain(&of(&text, Notation::FxIl), To::Ladder);
        let again = certain(&of(&drawn, Notation::Ladder), To::Fx);
        let instructions = |text: &str| {
            let lines = text.lines().filter(|line| !line.trim().is_empty());
            lines.map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect::<Vec<_>>()
        };
        let [one, two] = [&text, &again].map(|text| instructions(text));
        let differing = one.iter().zip(&two).position(|(one, two)| one != two);
        let near =
            differing.map(|at| (&one[at.saturating_sub(2)..at + 2], &two[at.saturating_sub(2)..at + 2]));
        assert_eq!(near, None, "{model:?}");
        assert_eq!(one.len(), two.len());
        let all = instructions::all().filter(|row| row.models.contains(&model)).map(|row| row.mnemonic);
        let lacking: Vec<&str> = all.filter(|mnemonic| !rows.contains(mnemonic)).collect();
        assert_eq!(lacking, ["NOP", "END"], "{model:?}");
    }
}

#[test]
fn a_question_too_large_is_told_so_with_bounded_work() {
    // Sums of products over pairs far apart have no small diagram where the firsts of all pairs come before the seconds,
    // and that all firsts in parallel stand before them changes nothing.
    let pairs = 40;
    let far = |numbers: &mut dyn Iterator<Item = usize>| -> String {
        let joined = |(place, n)| {
            let load = format!("LD M{n}\nAND M{}\n", n + pairs);
            if place == 0 { load } else { load + "ORB\n" }
        };
        numbers.enumerate().map(joined).collect()
    };
    let firsts: String = (1..pairs).map(|n| format!("OR M{n}\n")).collect();
    let left = format!("LD M0\n{firsts}{}ANB\nOUT Y0\n", far(&mut (0..pairs)));
    let right = format!("{}OUT Y0\n", far(&mut (0..pairs).rev()));
    match prove(&list(&left), &list(&right)) {
        Proof::Undecided { reason, .. } => assert_eq!(reason.key(), "prove.undecided"),
        other => panic!("{other:?}"),
    }
    let [left, right] = [left, right].map(|text| {
        let document = list(&text);
        let chunk = document.chunks().next().expect("a chunk").chunk;
        let rung = rungs(chunk, document.target()).remove(0);
        rung.path.ok().flatten().expect("a path")
    });
    let mut effort = Effort::of_program();
    let all = effort.left();
    let mut asked = 0;
    while effort.left() > 0 {
        assert_eq!(effort.ask(|formulas| compare(&[&left], &[&right], formulas)), Comparison::Undecided);
        asked += 1;
        // No question takes more than its share, and all of them no more than there is.
        assert!(all - effort.left() <= asked * all / 8, "{asked}: {} of {all} left", effort.left());
    }
    assert_eq!(effort.ask(|formulas| compare(&[&left], &[&right], formulas)), Comparison::Undecided);
}
