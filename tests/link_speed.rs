//! Nothing takes much longer on the line than the bytes that must travel; in the time of the line, so everywhere the same.

use crate::line_time::{LineTime, download, look, program, three_changed};

fn check(what: &str, time: &LineTime) {
    println!("{what}: {:?}, at least {:?}: {:.3}", time.took, time.least, time.ratio());
    assert!(time.ratio() >= 1.0, "{what}: the least is not the least");
    assert!(time.ratio() < 1.1, "{what}: {:.3} times the least", time.ratio());
}

#[test]
fn a_download_takes_little_more_than_its_bytes() {
    let [before, after] = [0, 1].map(program);
    assert_eq!((before.len(), after.len()), (4_000, 4_000));
    let changed = before.iter().zip(&after).filter(|(a, b)| a != b).count();
    assert!(changed > 1_000, "{changed}");
    let stretches = stretches(&before, &after);
    check("another program", &download(&before, &after, &stretches));
}

#[test]
fn a_download_of_three_words_takes_little_more_than_its_bytes() {
    let before = program(0);
    let after = three_changed(&before);
    check("three words", &download(&before, &after, &[1, 1, 1]));
}

#[test]
fn a_look_at_a_hundred_devices_takes_little_more_than_its_bytes() {
    check("a look", &look());
}

/// The lengths of what is written at least: words that differ, with those between them where that is shorter than
/// another request.
fn stretches(before: &[u16], after: &[u16]) -> Vec<usize> {
    // A request and its answer are 14 bytes beyond the digits, four of which are a word.
    const GAP: usize = 3;
    let mut stretches: Vec<std::ops::Range<usize>> = Vec::new();
    for at in (0..after.len()).filter(|at| before[*at] != after[*at]) {
        match stretches.last_mut() {
            Some(last) if at - last.end <= GAP => last.end = at + 1,
            _ => stretches.push(at..at + 1),
        }
    }
    stretches.into_iter().map(|stretch| stretch.len()).collect()
}
