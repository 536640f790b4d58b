//! The boolean form in the hover of an output.

use rungwise::document::{Document, Notation};
use rungwise::ide;
use rungwise::target::Target;
use rungwise::text::Language;

fn hover(text: &str, notation: Notation, word: &str) -> String {
    let document = Document::new(text, notation, Target::named("fx2n").expect("a model"));
    let place = text.rfind(word).unwrap_or_else(|| panic!("no {word}"));
    ide::hover(&document, place, Language::English).map(|hover| hover.markdown).unwrap_or_default()
}

fn list(text: &str, word: &str) -> String {
    hover(text, Notation::FxIl, word)
}

/// The equations before the page of the device.
fn head(markdown: &str) -> Vec<&str> {
    markdown.lines().take_while(|line| !line.is_empty()).map(str::trim_end).collect()
}

#[test]
fn an_output_shows_its_equation() {
    let text = "LD X0\nOR Y0\nANI X1\nOUT Y0\n";
    assert_eq!(head(&list(text, "Y0")), ["`Y0 = (X0 + Y0)*[X1]`"]);
    assert_eq!(head(&list(text, "OUT")), ["`Y0 = (X0 + Y0)*[X1]`"]);
    assert!(list(text, "Y0").contains("output"), "the device is still told of");
    assert!(!list(text, "X1").contains('='), "a contact has no equation");
    assert!(!list("LD X0\nMOV K5 D0\n", "D0").contains('='), "a box has none");
    assert!(!list("LD X0\nORB\nOUT Y0\n", "Y0").contains('='), "nor what cannot be read");
}

#[test]
fn the_output_under_the_pointer_is_the_one_that_is_told() {
    let text = "LD X0\nMPS\nAND X1\nOUT Y1\nMPP\nAND X2\nOUT T0 K50\n";
    assert_eq!(head(&list(text, "Y1")), ["`Y1 = X0*X1`"]);
    assert_eq!(head(&list(text, "T0")), ["`T0 K50 = X0*X2`"]);
}

#[test]
fn a_shorter_form_is_shown_as_well() {
    let text = "LD X0\nAND X1\nLD X0\nANI X1\nORB\nOUT Y0\n";
    let shown = list(text, "Y0");
    assert_eq!(head(&shown), ["`Y0 = X0*X1 + X0*[X1]`", "Shorter, as a sum of products: `Y0 = X0`"]);
    let consensus = "LD X0\nAND X1\nLDI X0\nAND X2\nORB\nLD X1\nAND X2\nORB\nOUT Y0\n";
    let shown = list(consensus, "Y0");
    assert!(shown.contains("sum of products: `Y0 = X0*X1 + [X0]*X2`"), "{shown}");
    let never = list("LD X0\nANI X0\nOUT Y0\n", "Y0");
    assert!(never.contains("sum of products: `Y0 = 0`"), "{never}");
    let edge = list("LDP X0\nAND X0\nOUT Y0\n", "Y0");
    assert!(edge.contains("sum of products: `Y0 = R_EDGE(X0)`"), "{edge}");
    let factored = list("LD X0\nLD X1\nOR X2\nANB\nOUT Y0\n", "Y0");
    assert_eq!(head(&factored).len(), 1, "its sum of products is longer: {factored}");
}

#[test]
fn a_drawn_coil_shows_its_equation() {
    let drawing = "\
|   X0        X1                             Y0  |
+---| |---+---|/|----------------------------( )-+
|   Y0    |                                      |
+---| |---+                                      |
";
    let shown = hover(drawing, Notation::Ladder, "( )");
    assert_eq!(head(&shown), ["`Y0 = (X0 + Y0)*[X1]`"]);
    let inverted = drawing.replace("( )", "(/)");
    let shown = hover(&inverted, Notation::Ladder, "(/)");
    assert_eq!(head(&shown), ["`[Y0] = (X0 + Y0)*[X1]`"]);
}
