//! The edits that make one text of another: unchanged lines stay, and of changed ones all or only the middle goes.

use crate::text::{Span, TextEdit};

/// More pairs of lines than this are not compared one by one.
const PAIRS_MAX: usize = 250_000;

/// The smallest edits from `old`, which starts at byte `start` of the document, to `new`; in order, none overlapping.
pub(super) fn between(old: &str, new: &str, start: usize) -> Vec<TextEdit> {
    let old_lines: Vec<&str> = old.split_inclusive('\n').collect();
    let new_lines: Vec<&str> = new.split_inclusive('\n').collect();
    let mut edits = Vec::new();
    let (mut old_at, mut new_at, mut offset) = (0, 0, start);
    let mut gap = |olds: &[&str], news: &[&str], offset: &mut usize| {
        let pairs = olds.len().min(news.len());
        for (old, new) in olds.iter().zip(news) {
            edits.extend(smallest(old, new, *offset));
            *offset += old.len();
        }
        let removed: usize = olds[pairs..].iter().map(|line| line.len()).sum();
        let added = news[pairs..].concat();
        if removed > 0 || !added.is_empty() {
            edits.push(TextEdit::new(Span::new(*offset, *offset + removed), added));
        }
        *offset += removed;
    };
    for (old_kept, new_kept) in kept_lines(&old_lines, &new_lines) {
        gap(&old_lines[old_at..old_kept], &new_lines[new_at..new_kept], &mut offset);
        offset += old_lines[old_kept].len();
        (old_at, new_at) = (old_kept + 1, new_kept + 1);
    }
    gap(&old_lines[old_at..], &new_lines[new_at..], &mut offset);
    edits
}

/// The edits that turn `old` into `new`: common lines at both ends stay, and where the rest has as many lines, only
/// those that differ are replaced, so that the editor keeps its cursor and marks.
pub(super) fn by_lines(old: &str, new: &str) -> Vec<TextEdit> {
    if old == new {
        return Vec::new();
    }
    let old_lines: Vec<&str> = old.split_inclusive('\n').collect();
    let new_lines: Vec<&str> = new.split_inclusive('\n').collect();
    let (head, tail) = common_ends(&old_lines, &new_lines);
    let (old_middle, new_middle) =
        (&old_lines[head..old_lines.len() - tail], &new_lines[head..new_lines.len() - tail]);
    let mut start: usize = old_lines[..head].iter().map(|line| line.len()).sum();
    if old_middle.len() != new_middle.len() {
        let length: usize = old_middle.iter().map(|line| line.len()).sum();
        return vec![TextEdit::new(Span::new(start, start + length), new_middle.concat())];
    }
    let mut edits = Vec::new();
    for (old_line, new_line) in old_middle.iter().zip(new_middle) {
        if old_line != new_line {
            edits.push(TextEdit::new(Span::new(start, start + old_line.len()), *new_line));
        }
        start += old_line.len();
    }
    edits
}

/// Numbers of lines that are the same in both texts: a longest common subsequence between what is common at both ends.
fn kept_lines(old: &[&str], new: &[&str]) -> Vec<(usize, usize)> {
    let (head, tail) = common_ends(old, new);
    let mut kept: Vec<(usize, usize)> = (0..head).map(|line| (line, line)).collect();
    let (old_middle, new_middle) = (&old[head..old.len() - tail], &new[head..new.len() - tail]);
    if old_middle.len().saturating_mul(new_middle.len()) <= PAIRS_MAX {
        let common = longest_common(old_middle, new_middle);
        kept.extend(common.into_iter().map(|(left, right)| (head + left, head + right)));
    }
    kept.extend((0..tail).map(|line| (old.len() - tail + line, new.len() - tail + line)));
    kept
}

/// How many lines both have in common at their start, and behind these at their end.
fn common_ends(old: &[&str], new: &[&str]) -> (usize, usize) {
    let same = |(left, right): &(&&str, &&str)| left == right;
    let head = old.iter().zip(new).take_while(same).count();
    let (old, new) = (&old[head..], &new[head..]);
    (head, old.iter().rev().zip(new.iter().rev()).take_while(same).count())
}

fn longest_common(old: &[&str], new: &[&str]) -> Vec<(usize, usize)> {
    let width = new.len() + 1;
    // The length of the longest common subsequence of what follows each pair.
    let mut lengths = vec![0u32; (old.len() + 1) * width];
    for left in (0..old.len()).rev() {
        for right in (0..new.len()).rev() {
            lengths[left * width + right] = match old[left] == new[right] {
                true => lengths[(left + 1) * width + right + 1] + 1,
                false => lengths[(left + 1) * width + right].max(lengths[left * width + right + 1]),
            };
        }
    }
    let (mut left, mut right) = (0, 0);
    let mut common = Vec::new();
    while left < old.len() && right < new.len() {
        if old[left] == new[right] {
            common.push((left, right));
            (left, right) = (left + 1, right + 1);
        } else if lengths[(left + 1) * width + right] >= lengths[left * width + right + 1] {
            left += 1;
        } else {
            right += 1;
        }
    }
    common
}

/// The one edit from `old` to `new` without what both have in common at their ends; none if they are equal.
pub(super) fn smallest(old: &str, new: &str, start: usize) -> Option<TextEdit> {
    if old == new {
        return None;
    }
    let heads = old.chars().zip(new.chars()).take_while(|(left, right)| left == right);
    let head: usize = heads.map(|(character, _)| character.len_utf8()).sum();
    let tails = old[head..].chars().rev().zip(new[head..].chars().rev());
    let tail: usize =
        tails.take_while(|(left, right)| left == right).map(|(character, _)| character.len_utf8()).sum();
    let span = Span::new(start + head, start + old.len() - tail);
    Some(TextEdit::new(span, &new[head..new.len() - tail]))
}
