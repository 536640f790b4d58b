//! Nothing takes much longer on the line than the bytes that must travel; in the time of the line, so everywhere the same.

use crate::line_time::{LineTime, download, look, program, stretches, three_changed};

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
