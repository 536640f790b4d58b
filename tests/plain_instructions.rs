//! Rules about words look only at instructions that are not right at one look. They find the same as if they looked
//! at all.

use rungwise::check::{ChunkContext, RULES, Run};
use rungwise::document::{Document, Notation};
use rungwise::target::{Target, instructions};
use rungwise::text::Diagnostic;

/// Ordinary words, ends of ranges on one model or another, and words with something wrong.
const WORDS: &[&str] = &[
    "X0",
    "X17",
    "X367",
    "X370",
    "X377",
    "X8",
    "Y0",
    "Y15",
    "Y16",
    "M0",
    "M1535",
    "M3071",
    "M7679",
    "M8000",
    "M8255",
    "M8511",
    "M8512",
    "S0",
    "S127",
    "S999",
    "S4095",
    "T0",
    "T63",
    "T255",
    "T511",
    "C0",
    "C199",
    "C200",
    "C234",
    "C235",
    "C255",
    "D0",
    "D199",
    "D200",
    "D7998",
    "D7999",
    "D8000",
    "D8255",
    "D8511",
    "R0",
    "R32767",
    "V0",
    "V8",
    "Z7",
    "P0",
    "P62",
    "P63",
    "P127",
    "P4095",
    "I001",
    "I610",
    "N0",
    "N7",
    "N8",
    "K-32768",
    "K-1",
    "K0",
    "K1",
    "K8",
    "K16",
    "K255",
    "K32767",
    "K32768",
    "K2147483647",
    "K2147483648",
    "H0",
    "HFFFF",
    "H10000",
    "E1.5",
    "E1E38",
    "E1E39",
    "K4M0",
    "K5M0",
    "K8Y0",
    "K1X0",
    "D0Z0",
    "K1Z0",
    "D0.3",
    "\"AB\"",
    "K1.5",
    "Q0",
    "Motor",
];

#[test]
fn nothing_is_found_in_what_is_plain() {
    let mut random = 1u64;
    let mut next = |below: usize| {
        random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (random >> 33) as usize % below
    };
    let (mut plain, mut faulty) = (0, 0);
    for target in Target::ALL {
        for form in instructions::all().flat_map(instructions::forms_of) {
            let mut text = String::new();
            for _ in 0..25 {
                let most = form.instruction.operands.len() + usize::from(next(8) == 0);
                let count = most - usize::from(most > 0 && next(6) == 0);
                text += &form.mnemonic();
                (0..count).for_each(|_| text += &format!(" {}", WORDS[next(WORDS.len())]));
                text.push('\n');
            }
            let document = Document::new(&text, Notation::FxIl, target);
            for at in document.chunks() {
                let mut context = ChunkContext::new(at.chunk, &document, None);
                let quick = judged(&context);
                context.doubtful = at.chunk.operations().collect();
                plain += context.doubtful.len();
                faulty += quick.len();
                assert_eq!(judged(&context), quick, "{}\n{}", target.name, at.chunk.text());
            }
            let doubtful =
                document.chunks().map(|at| ChunkContext::new(at.chunk, &document, None).doubtful.len());
            plain -= doubtful.sum::<usize>();
        }
    }
    assert!(plain > 1_000 && faulty > 10_000, "{plain} plain, {faulty} findings");
}

fn judged(context: &ChunkContext<'_>) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    for rule in RULES.iter() {
        if let Run::Chunk(judge) | Run::Both(judge, _) = rule.run {
            judge(context, &mut found);
        }
    }
    found
}
