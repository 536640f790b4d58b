//! Ladder graphs: their shape, their drawing, and what drawing and reading make of them.

use crate::ladder_generate::{Generated, Leaf, Part, all_rungs, generate, rung};
use proptest::prelude::*;
use rungwise::ladder::reduce::{NotSeriesParallel, Shape, reduce};
use rungwise::ladder::{Graph, Style, StyleKind, VertexKind, print};
use rungwise::target::Target;

const STYLES: [StyleKind; 3] = [StyleKind::Iec, StyleKind::Brackets, StyleKind::Unicode];

fn fx() -> &'static Target {
    Target::named("fx2n").unwrap()
}

fn iec() -> &'static Target {
    Target::named("iec").unwrap()
}

fn style(kind: StyleKind, width: u32) -> Style {
    Style { kind, width }
}

fn drawn(made: &Generated, style: &Style) -> String {
    let shape = reduce(&made.graph).unwrap_or_else(|why| panic!("{why:?} for {made:?}"));
    print(&shape, &made.graph, &made.words, style).unwrap_or_else(|| panic!("no drawing of {shape:?}"))
}

#[test]
fn show() {
    use proptest::strategy::ValueTree;
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    for n in 0..8 {
        let part = rung(14).new_tree(&mut runner).unwrap().current();
        for kind in STYLES {
            let target = if n % 2 == 0 { fx() } else { iec() };
            let made = generate(&part, target);
            let shape = reduce(&made.graph).unwrap();
            println!("{}", print(&shape, &made.graph, &made.words, &style(kind, 48)).unwrap_or_default());
        }
    }
}
