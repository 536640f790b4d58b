//! The forms of a rung in a long program unit of IEC 61131-3: only a stretch around it is read, and what comes of it is
//! what comes of the whole unit.

use crate::translate_iec::{fx, fx_programs, list};
use proptest::prelude::*;
use rungwise::document::Document;
use rungwise::ide;
use rungwise::logic::stretch;
use rungwise::text::Span;
use rungwise::translate::{Options, To, Translated, Translation, translate};

/// What may stand between two rungs: other uses of helpers, detectors and labels, comments, rungs that cannot be read.
const BETWEEN: &[&str] = &[
    "LD Held1\nST Y2\n",
    "LD Y2\nST Held1\n",
    "LD Y2\nST Held1\nAND Y0\nST Y2\nLD Held1\nST Y1\n",
    "LD Y2\nST Held1\nAND Y0\nST Y2\nLD Held1\nAND Y1\nST Held2\nST Y1\nLD Held2\nANDN Y0\nST Y2\nLD Held1\nST Y0\n",
    "LD Y2\nAND Held1\nST Y2\n",
    "LD Held1\nFROB\nST Y2\n",
    "LD Pulse1.Q\nST Y1\n",
    "CAL Pulse2(CLK := Y0)\n",
    "CAL Rise1(CLK := Y0)\nLD Rise1.Q\nST Y1\n",
    "LD Y0\nST PLS_M9.CLK\n",
    "LD Y1\nJMPC Skip1\n",
    "LD Y1\nJMPCN Skip2\n",
    "LD Y1\nJMPCN Over\nLD D0\nADD 3\nST D1\nOver:\nLD Y2\nST Y0\n",
    "Over:\n",
    "\n",
    "(* note *)\n",
    "\n(* above *)\n\n",
    "(* one\n   two *) (* three *)\n",
    "{pragma}\n",
    "LD Y0 ) ST Y1\n",
    "LD Y0 ST Y1 (* begins\n ends *)\n",
];

/// A list that an FX program is, with more between its rungs.
fn units() -> impl Strategy<Value = String> {
    let more = (any::<prop::sample::Index>(), prop::sample::select(BETWEEN));
    (prop::collection::vec(fx_programs(), 2..8), prop::collection::vec(more, 0..6)).prop_map(
        |(programs, more)| {
            let program: String = programs.iter().map(|program| program.trim_end_matches("END\n")).collect();
            let written = translate(&fx(&(program + "END\n")), None, To::Iec, &Options::default()).text;
            let written = written.replacen(
                "VAR\n",
                "VAR\n    Held1, Held2 : BOOL;\n    Rise1, Pulse1, Pulse2, PLS_M9 : R_TRIG;\n",
                1,
            );
            let mut lines: Vec<String> = written.split_inclusive('\n').map(str::to_string).collect();
            let body = lines.iter().position(|line| line.contains("END_VAR")).map_or(0, |line| line + 1);
            for (index, between) in more {
                let loads = |line: &usize| {
                    lines[*line].trim_start().starts_with("LD") || lines[*line].contains("END_PROGRAM")
                };
                let places: Vec<usize> = (body..lines.len()).filter(loads).collect();
                if !places.is_empty() {
                    lines.insert(places[index.index(places.len())], between.to_string());
                }
            }
            lines.concat()
        },
    )
}

/// The lines of a drawing without wires, whose length is that of the widest rung.
fn told(translation: &Translation, rung: &Translated) -> String {
    let text = &translation.text[rung.result.clone()];
    text.lines().map(|line| line.replace(['-', ' '], "") + "\n").collect()
}

type Said<'t> = Vec<(Span, String, Option<&'t str>)>;

fn said<'t>(translation: &'t Translation, part: Option<Span>) -> Said<'t> {
    let touches = |rung: &&Translated| {
        part.is_none_or(|part| rung.span.start <= part.end && part.start <= rung.span.end)
    };
    let rungs = translation.rungs.iter().filter(touches);
    rungs
        .map(|rung| (rung.span, told(translation, rung), rung.note.as_ref().map(|note| note.key())))
        .collect()
}

/// What is said of a few rungs by themselves, but for those that the whole unit keeps only because a jump before them
/// has no words: alone, a rung is shown whoever skips it.
fn shown_apart<'t>(own: Said<'t>, in_whole: &Said<'t>) -> Said<'t> {
    let is_guarded = |(_, _, note): &&(Span, String, Option<&'t str>)| *note == Some("translate.guarded");
    let guarded = |span: Span| in_whole.iter().filter(is_guarded).find(|(other, ..)| *other == span);
    own.into_iter().map(|said| guarded(said.0).cloned().unwrap_or(said)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_rung_is_what_it_is_in_the_whole_unit(text in units()) {
        let document = list(&text);
        let options = Options { is_whole: false, proves: false, ..Options::default() };
        let all = Span::new(0, document.len());
        for to in [To::Boolean, To::Ladder] {
            let whole = translate(&document, Some(all), to, &options);
            for rung in &whole.rungs {
                for cursor in [rung.span.start, (rung.span.start + rung.span.end) / 2, rung.span.end] {
                    let Some(part) = ide::part_at(&document, Span::at(cursor as usize)) else { continue };
                    let part = part.span();
                    let own = translate(&document, Some(part), to, &options);
                    let place = document.slice(part);
                    let (own, in_whole) = (said(&own, None), said(&whole, Some(part)));
                    prop_assert_eq!(shown_apart(own, &in_whole), in_whole, "{}\n--\n{}", place, text);
                }
            }
        }
    }
}

/// Rungs of an FX list that tell what becomes of timers and counters, and some that do not.
const COUNTED: &[&str] = &[
    "LD X0\nOUT T0 K5\n",
    "LD X1\nOUT T0 K7\n",
    "LD X1\nOUT T1 D0\n",
    "LD T0\nANI T1\nOUT Y0\n",
    "LD X0\nOUT C0 K3\n",
    "LD X0\nOUT C0 K0\n",
    "LD X2\nRST C0\n",
    "LD C0\nAND= C0 K3\nOUT Y1\n",
    "LD>= C0 K5\nOUT Y2\n",
    "LD X3\nOUT C100 K2\n",
    "LD X3\nCJ P0\n",
    "LD X2\nCJ P63\n",
    "LD X3\nMC N0 M10\n",
    "MCR N0\n",
    "FOR K3\n",
    "NEXT\n",
    "LD X5\nOUT Y5\n",
    "LD X5\nFROB Y5\n",
    "END\n",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_rung_with_a_timer_is_what_it_is_in_the_whole_fx_list(
        rungs in prop::collection::vec(prop::sample::select(COUNTED), 2..12),
        label in any::<prop::sample::Index>(),
    ) {
        let mut rungs = rungs;
        rungs.insert(label.index(rungs.len()), "P0\n");
        let document = fx(&(rungs.concat() + "LD X7\nOUT Y7\nEND\n"));
        let options = Options { is_whole: false, ..Options::default() };
        let whole = translate(&document, Some(Span::new(0, document.len())), To::Iec, &options);
        for rung in &whole.rungs {
            let Some(part) = ide::part_at(&document, Span::at(rung.span.start as usize)) else { continue };
            let own = translate(&document, Some(part.span()), To::Iec, &options);
            let notes = |translation: &Translation| {
                said(translation, Some(rung.span)).into_iter().map(|(span, _, note)| (span, note.map(str::to_string)))
                    .collect::<Vec<_>>()
            };
            let in_whole = notes(&whole);
            if in_whole.iter().any(|(_, note)| note.as_deref() == Some("translate.guarded")) {
                continue;
            }
            prop_assert_eq!(notes(&own), in_whole, "{}\n--\n{}", document.slice(rung.span), document.text());
        }
    }
}

/// A unit of rungs with branches that one helper keeps.
fn long(rungs: usize) -> Document {
    let mut text = "PROGRAM Main\nVAR\n    a, b, c, Held1 : BOOL;\nEND_VAR\n".to_string();
    let branch = "    LD a\n    OR c\n    ST Held1\n    AND b\n    ST c\n    LD Held1\n    ST b\n";
    (0..rungs).for_each(|_| text += branch);
    list(&(text + "END_PROGRAM\n"))
}

#[test]
fn little_is_read_of_a_long_unit() {
    let document = long(2_000);
    let text = document.text();
    for place in [text.find("LD a"), text.find("LD Held1"), text.rfind("LD Held1")] {
        let place = place.expect("a load");
        let part = ide::part_at(&document, Span::at(place)).expect("a rung").span();
        let (bytes, unit) = stretch::holding(&document, part).expect("a stretch");
        assert!(bytes.len() < 200, "{}", document.slice(bytes));
        assert_eq!(unit.number, Some(0));
        let forms = translate(&document, Some(part), To::Boolean, &Options::default());
        assert!(!forms.text.contains("Held1"), "{}", forms.text);
    }
    // Where a store waits for a load in vain, right before a rung that must be read to see that it does not.
    let apart =
        "    LD a\n    ST Held1\n\n    LD a\n    ST Held1\n    CAL T1(IN := b)\n    LD Held1\n    ST b\n";
    let vain = text.replacen("Held1 :", "Held1 : BOOL; T1 : TON; c1 :", 1).replacen(
        "    LD a\n",
        &format!("{apart}    LD a\n"),
        1,
    );
    let document = list(&vain);
    let last = Span::at(vain.rfind("LD Held1").expect("a load"));
    let part = ide::part_at(&document, last).expect("a rung").span();
    let forms = translate(&document, Some(part), To::Boolean, &Options::default());
    assert!(forms.text.contains("Held1"), "{}", forms.text);
    // Where somebody reads the helper far away, what is stored to it counts.
    let read = text.replacen("    LD a\n", "    LD Held1\n    ST a\n    LD a\n", 1);
    let document = list(&read);
    let last = Span::at(read.rfind("LD Held1").expect("a load"));
    let part = ide::part_at(&document, last).expect("a rung").span();
    let forms = translate(&document, Some(part), To::Boolean, &Options::default());
    assert!(forms.text.contains("Held1"), "{}", forms.text);
}

/// A menu asks at each step of the cursor, and a rung may be longer than what it stands in.
#[test]
fn a_menu_does_not_wait_for_the_forms_of_a_long_rung() {
    let text = |calculations: usize| {
        let body = "    LD n\n    ADD 1\n    ST n\n".repeat(calculations);
        let head = "PROGRAM Main\nVAR\n    a : BOOL;\n    n : INT;\nEND_VAR\n";
        format!("{head}    LD a\n    JMPCN over\n{body}over:\n    LD a\n    ST a\nEND_PROGRAM\n")
    };
    let settings = (ide::Style { kind: rungwise::project::FormatStyle::Iec, width: 48 }, None);
    for (calculations, is_told) in [(3, true), (1000, false)] {
        let document = list(&text(calculations));
        let place = document.text().find("LD n").expect("a load");
        let part = ide::part_at(&document, Span::at(place)).expect("a part").span();
        let told = ide::forms_at_once(&document, (part, 16_384), &[To::Ladder], settings, &|| false);
        assert_eq!(told.is_some(), is_told, "{calculations}");
        let asked = ide::forms(&document, Some(part), &[To::Ladder], settings, &|| false);
        assert!(asked.is_some_and(|forms| !forms.is_empty()));
    }
}
