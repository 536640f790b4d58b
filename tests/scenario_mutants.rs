//! Mutants: what is otherwise in them, and that it is nothing else.

use rungwise::document::Document;
use rungwise::project::{Manifest, open_document};
use rungwise::scenario::Mutants;

fn open(name: &str, text: &str) -> Document {
    open_document(name, text, &Manifest::default(), None, None)
}

#[test]
fn dbg() {
    let text = std::fs::read_to_string("examples/motor/motor.lad").unwrap();
    let document = open("motor.lad", &text);
    let documents = [&document];
    let mutants = Mutants::of(&documents);
    for mutant in mutants.sample(100, 0) {
        println!("{mutant:?}");
        match mutants.documents(mutant) { Some(made) => println!("{}", made[0].text()), None => println!("NONE") }
    }
}
