//! Where power flows in the text, beside what electricity does in the drawing's wires.

use crate::simulate::switch;
use crate::translate::{all_small_rungs, certain, list, truth_of_list};
use rungwise::document::{Document, Notation};
use rungwise::simulate::{Energised, EnergisedKind, Session, compile, power_flow};
use rungwise::target::{Model, Target};
use rungwise::text::Span;
use rungwise::translate::To;
use std::collections::BTreeMap;
use std::sync::Arc;

fn document(text: &str, notation: Notation) -> Document {
    Document::new(text, notation, Target::of(Model::Fx3u))
}

/// What is shown of the first scan of a program with these inputs on, and whether each is on.
fn shown(document: &Document, inputs: &[(&str, bool)]) -> Vec<Energised> {
    let code = |is_watched| Arc::new(compile(&[document], is_watched).expect("a program"));
    let watched = code(true);
    let mut session = Session::new(code(false));
    inputs.iter().for_each(|(name, on)| switch(&mut session, name, *on));
    session.scan(0);
    let sights = session.sights(1, &watched).expect("a scan");
    power_flow(document, 0, &watched, &sights, 0..document.text().len())
}

/// The text with what is energised marked below each line: `=` for wires, `#` for contacts and outputs.
#[track_caller]
fn check(expected: &str, notation: Notation, inputs: &str) {
    let is_text = |line: &&str| !line.trim_matches([' ', '=', '#']).is_empty();
    let text: String =
        expected.lines().filter(|line| is_text(line)).map(|line| format!("{line}\n")).collect();
    let document = document(&text, notation);
    let inputs: Vec<(&str, bool)> = inputs.split_whitespace().map(|name| (name, true)).collect();
    let mut marks = vec![' '; text.len()];
    for shown in shown(&document, &inputs).into_iter().filter(|shown| shown.energised) {
        let mark = if shown.kind == EnergisedKind::Wire { '=' } else { '#' };
        marks[shown.span.start as usize..shown.span.end as usize].fill(mark);
    }
    let mut found = String::new();
    let mut start = 0;
    for line in text.lines() {
        let below: String = marks[start..start + line.len()].iter().collect();
        found += &format!("{line}\n");
        if !below.trim().is_empty() {
            found += &format!("{}\n", below.trim_end());
        }
        start += line.len() + 1;
    }
    assert_eq!(found, expected);
}

#[test]
fn power_is_where_it_flowed_when_contacts_were_executed() {
    // Y0 was still off when its contact was executed, and on in the rung below.
    check(
        "\
|   X0         X1     Y0 |
+---| |---+----|/|---( )-+
 ===###========###===###=
|   Y0    |              |
          =
+---| |---+              |
 ===      =
|   Y0      X2        Y1 |
+---| |-----| |------( )-+
 ===###=====
+--[END]-----------------+
 ==     =================
",
        Notation::Ladder,
        "X0",
    );
}

#[test]
fn power_is_shown_in_the_lines_of_a_list_that_a_drawing_carries_along() {
    check(
        "\
{il
LDI Y0
######
OUT Y0
######
OR X1
#####
OUT Y1
######
LD X2
ANB
OUT Y2
}
|   X1        Y3 |
+---| |------( )-+
 ===
",
        Notation::Ladder,
        "",
    );
}

#[test]
fn behind_a_master_control_without_power_there_is_none() {
    // Neither behind contacts that conduct, nor behind an inversion of what does not.
    let dark = "LD X7\nMC N0 M100\nLD X0\nOR X1\nINV\nOUT Y0\nLD M8000\nOUT Y1\nMCR N0\nEND\n";
    check(dark, Notation::FxIl, "X0");
    check(dark, Notation::FxIl, "");
    check(
        "\
LD X7
#####
MC N0 M100
##########
LD X0
OR X1
INV
###
OUT Y0
######
LD M8000
########
OUT Y1
######
MCR N0
END
",
        Notation::FxIl,
        "X7",
    );
    check(
        "\
|   X7                              |
+---| |-------[MC N0 M100]----------+
 ===
|   X0                          Y0  |
+---| |----[INV]---------------( )--+
|  M8000                        Y1  |
+---| |------------------------( )--+
+--[MCR N0]-------------------------+
+--[END]----------------------------+
 ==     ============================
",
        Notation::Ladder,
        "X0",
    );
    check(
        "\
|   X7                              |
+---| |-------[MC N0 M100]----------+
 ===###=======############==========
|   X0                          Y0  |
+---| |----[INV]---------------( )--+
 ===       #####===============###==
|  M8000                        Y1  |
+---| |------------------------( )--+
 ===###========================###==
+--[MCR N0]-------------------------+
 ==        =========================
+--[END]----------------------------+
 ==     ============================
",
        Notation::Ladder,
        "X7",
    );
}

/// The wires of a drawing as electricity sees them: those that touch are one.
struct Wires {
    cells: Vec<u8>,
    /// For each cell of a wire the first cell of those that it is one with.
    one_with: Vec<usize>,
}

impl Wires {
    /// Of a drawing of lines of equal length, in which `elements` are no wires.
    fn of(text: &str, elements: &[Energised]) -> Wires {
        let mut cells = text.as_bytes().to_vec();
        for element in elements {
            cells[element.span.start as usize..element.span.end as usize].fill(b' ');
        }
        let width = text.lines().next().expect("a line").len() + 1;
        let mut wires = Wires { one_with: (0..cells.len()).collect(), cells };
        for at in 0..wires.cells.len() {
            let is =
                |at: usize, wire: &str| wires.cells.get(at).is_some_and(|cell| wire.contains(*cell as char));
            let below = at + width;
            let (is_row, is_column) = (is(at, "-+") && is(at + 1, "-+"), is(at, "|+") && is(below, "|+"));
            for next in [is_row.then_some(at + 1), is_column.then_some(below)].into_iter().flatten() {
                let (one, two) = (wires.first(at), wires.first(next));
                wires.one_with[one.max(two)] = one.min(two);
            }
        }
        wires
    }

    fn first(&self, at: usize) -> usize {
        if self.one_with[at] == at { at } else { self.first(self.one_with[at]) }
    }

    /// The wires that are live: those of the left rail, and those behind a contact that conducts with a live wire before
    /// it.
    fn live(&self, elements: &[Energised], has_rail: bool) -> Vec<bool> {
        let mut live = vec![false; self.cells.len()];
        live[self.first(0)] = has_rail;
        loop {
            let before = live.clone();
            for element in elements {
                let (left, right) = self.sides(element);
                live[right] |= live[left] && element.kind == EnergisedKind::Contact(true);
            }
            if live == before {
                return live;
            }
        }
    }

    fn sides(&self, element: &Energised) -> (usize, usize) {
        (self.first(element.span.start as usize - 1), self.first(element.span.end as usize))
    }
}

#[test]
fn in_every_small_rung_power_is_where_electricity_flows_and_a_list_shows_the_same() {
    let mut seen = BTreeMap::new();
    for (number, rung) in all_small_rungs().into_iter().enumerate() {
        // Of those with many contacts some, each with other inputs, within a master control and without.
        if number > 300 && number % 37 != 0 {
            continue;
        }
        let (inputs, has_rail) = (number as u32 * 11 % 32, number % 3 != 0);
        let text = format!("LD X7\nMC N0 M100\n{rung}MCR N0\nEND\n");
        let names: Vec<String> = (0..5).map(|input| format!("X{input}")).collect();
        let switches =
            names.iter().enumerate().map(|(input, name)| (name.as_str(), inputs >> input & 1 == 1));
        let switches: Vec<(&str, bool)> = switches.chain([("X7", has_rail)]).collect();
        let is_driven = has_rail && truth_of_list(&rung) >> inputs & 1 == 1;

        let listed = shown(&document(&text, Notation::FxIl), &switches);
        let lines = |wanted: &str| {
            let of = |shown: &&Energised| text[shown.span.start as usize..].starts_with(wanted);
            listed.iter().filter(of).map(|shown| shown.energised).collect::<Vec<bool>>()
        };
        assert_eq!(lines("OUT"), [is_driven], "{switches:?}\n{text}");
        let dark = listed.iter().filter(|shown| !shown.energised).count();
        assert!(has_rail || dark >= rung.lines().count(), "{switches:?}\n{text}\n{listed:?}");

        let drawn = certain(&list(&text), To::Ladder);
        let own = drawn.split("\n\n").nth(1).expect("the rung in the master control");
        let start = drawn.find(own).expect("a part of it") as u32;
        let all = shown(&document(&drawn, Notation::Ladder), &switches);
        let within = |shown: &&Energised| (start..start + own.len() as u32).contains(&shown.span.start);
        let moved = |shown: &Energised| Energised {
            span: Span { start: shown.span.start - start, end: shown.span.end - start },
            ..*shown
        };
        let elements: Vec<Energised> =
            all.iter().filter(within).map(moved).filter(|shown| shown.kind != EnergisedKind::Wire).collect();
        assert_eq!(elements.len(), rung.matches('X').count() + 1, "{own}\n{elements:?}");
        let own = format!("{own}\n");
        let wires = Wires::of(&own, &elements);
        let live = wires.live(&elements, has_rail);
        for element in &elements {
            let (left, _) = wires.sides(element);
            let expected = live[left] && element.kind != EnergisedKind::Contact(false);
            assert_eq!(element.energised, expected, "{element:?} {switches:?}\n{own}");
            *seen.entry((element.kind == EnergisedKind::Output, has_rail, expected)).or_insert(0) += 1;
        }
    }
    assert!(seen.len() == 6 && seen.values().all(|times| *times > 50), "{seen:?}");
}
