//! Tolerance for lines that miss each other by a column or two, the norm in drawings by hand.
//!
//! Between two rows, the ends of vertical wires that run down and those that run up *seek* each other. A bar that
//! ends in the air and a corner that only one wire reaches must go on, a junction in the middle of a wire should.
//! Of all ways to join seekers that do not cross, the one that leaves the fewest in the air is the reading; where two
//! ways are as good, both are reported and neither is taken.

use super::Choice;
use super::grid::Grid;
use super::scan::{Token, Tokens, What};
use super::uprights::{Role, Upright, Uprights, reached_from_output};
use crate::text::{Diagnostic, Message, Related, Span};
use rustc_hash::{FxHashMap, FxHashSet};
use std::cmp::Reverse;

/// How many columns a line may be beside what it joins.
pub(super) const ASIDE: usize = 2;
/// How many columns a whole vertical wire may be beside the only two junctions that lack one.
const FAR_ASIDE: usize = 8;
/// More seekers than this so near to each other are no drawing.
const MOST_SEEKERS: usize = 10;

/// The message about a wire that can be read in two ways.
pub const TWO_READINGS: &str = "ragged-drawing.either";

const JUNCTION: &str = "ragged-drawing.junction";

/// An end of a vertical wire to which nothing is joined.
#[derive(Clone, Copy, Debug)]
struct Seeker {
    row: usize,
    token: Token,
    /// Its number in the row.
    number: usize,
    /// Whether it is an upper end, which seeks in the row above.
    top: bool,
    /// How much is missing if nothing is joined to it: a line that ends in the air wants to go on, a junction in the
    /// middle of a wire would be no more than wire, and a vertical wire that ends in a junction wants nothing.
    wants: Wants,
    /// Whether it is a bar that touches nothing.
    bare: bool,
    /// Whether its wire has a cell in this row only.
    single: bool,
}

/// What a seeker lacks; the greater, the more.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Wants {
    Nothing,
    Something,
    Much,
}

/// Mends the vertical wires of a drawing, see the module; what it read so is reported as `ragged-drawing`.
pub(super) struct Mender<'a> {
    uprights: &'a mut Uprights,
    grid: &'a Grid,
    tokens: &'a Tokens,
    left: usize,
    problems: &'a mut Vec<Diagnostic>,
    choice: Option<Choice>,
    found: Vec<Diagnostic>,
    /// The finding about each joint that was made, by what is off and how.
    numbers: FxHashMap<(Span, &'static str), usize>,
}

impl<'a> Mender<'a> {
    /// `left` is the leftmost column in which a line is drawn, `choice` a reading that is to be taken where there are
    /// two.
    pub(super) fn new(
        uprights: &'a mut Uprights,
        (grid, tokens): (&'a Grid, &'a Tokens),
        left: usize,
        choice: Option<Choice>,
        problems: &'a mut Vec<Diagnostic>,
    ) -> Mender<'a> {
        let (found, numbers) = (Vec::new(), FxHashMap::default());
        Mender { uprights, grid, tokens, left, problems, choice, found, numbers }
    }

    pub(super) fn mend(mut self) {
        let mut seekers = self.seekers();
        if seekers.iter().all(|seeker| seeker.wants == Wants::Nothing) {
            return;
        }
        // The rows between which each one seeks, then the columns.
        let between = |seeker: &Seeker| if seeker.top { seeker.row } else { seeker.row + 1 };
        seekers.sort_by_key(|seeker| (between(seeker), seeker.token.start, seeker.top));
        let mut joined = FxHashSet::default();
        let rows = seekers.chunk_by(|a, b| between(a) == between(b));
        for group in rows.flat_map(|row| row.chunk_by(|a, b| b.token.start <= a.token.end + ASIDE)) {
            if group.len() <= MOST_SEEKERS && group.iter().any(|seeker| seeker.wants > Wants::Nothing) {
                self.join_group(group, &mut joined);
            }
        }
        let alone = |seeker: &Seeker| !joined.contains(&(seeker.row, seeker.number, seeker.top));
        let mut rest: Vec<Seeker> = seekers.iter().copied().filter(alone).collect();
        self.join_over_gaps(&mut rest);
        self.join_displaced(&rest);
        self.report();
    }

    /// The open ends of all vertical wires but those of the rails.
    fn seekers(&self) -> Vec<Seeker> {
        let rows = 0..self.tokens.rows.len();
        let reach = rows.filter_map(|row| self.tokens.extent(row).wires).max().unwrap_or(0);
        let mut seekers = Vec::new();
        for upright in &self.uprights.all {
            let (Some(first), Some(last)) = (upright.cells.first(), upright.cells.last()) else { continue };
            let single = upright.cells.len() == 1;
            for (cell, top) in [(first, true), (last, false)] {
                let line = &self.tokens.rows[cell.row];
                let token = line[cell.token];
                let What::Upright(arms) = token.what else { continue };
                if !(if top { arms.up() } else { arms.down() }) || cell.row == 0 && top {
                    continue;
                }
                let before = cell.token.checked_sub(1).and_then(|before| line.get(before));
                let on_left = before.is_some_and(|before| before.is_drawn() && before.end == token.start);
                let after = line.get(cell.token + 1);
                let on_right = after.is_some_and(|after| after.is_drawn() && after.start == token.end);
                let bare = arms.is_vertical() && !on_left && !on_right;
                let one_way = !(arms.up() && arms.down());
                let corner = single && on_left != on_right;
                let wants = match bare || one_way || corner {
                    true => Wants::Much,
                    false if single && on_left && on_right => Wants::Something,
                    false => Wants::Nothing,
                };
                let (row, number) = (cell.row, cell.token);
                let is_first = before.is_none_or(|before| !before.is_drawn());
                let left_rail = is_first && !on_left && token.start <= self.left + ASIDE;
                let right_rail = wants == Wants::Much && self.is_right_rail(cell.row, number, reach);
                if !left_rail && !right_rail {
                    seekers.push(Seeker { row, token, number, top, wants, bare, single });
                }
            }
        }
        seekers
    }

    /// Whether the last bar or corner of a row is a piece of the right rail: it is reached from an output, or nothing
    /// is drawn further right than to `reach`.
    fn is_right_rail(&self, row: usize, number: usize, reach: usize) -> bool {
        let line = &self.tokens.rows[row];
        let last = !line[number + 1..].iter().any(Token::is_drawn);
        last && (line[number].end + ASIDE >= reach || reached_from_output(self.tokens, row, number))
    }

    /// Joins seekers that are near to each other in two neighbouring rows.
    fn join_group(&mut self, group: &[Seeker], joined: &mut FxHashSet<(usize, usize, bool)>) {
        let best = best_matchings(group);
        let pairs = match &best[..] {
            [] => return,
            [pairs] => pairs.clone(),
            several => {
                let Some((own, others)) = in_doubt(group, several) else { return };
                let cell = |seeker: usize| self.span(&group[seeker]);
                let chosen = self.choice.filter(|choice| choice.end == cell(own));
                let chosen = chosen.and_then(|choice| {
                    let other = others.iter().copied().find(|other| cell(*other) == choice.joint)?;
                    several.iter().find(|pairs| partner(pairs, own) == Some(other))
                });
                let Some(pairs) = chosen else {
                    self.report_two(&group[own], others.iter().map(|other| &group[*other]));
                    return;
                };
                pairs.clone()
            }
        };
        for (lower, upper) in pairs {
            self.join(&group[upper], &group[lower], "ragged-drawing.beside");
            joined.extend([upper, lower].map(|end| {
                let end = &group[end];
                (end.row, end.number, end.top)
            }));
        }
    }

    /// Joins ends in one column with a row between them, in which the bar is missing or a name is written over it.
    fn join_over_gaps(&mut self, rest: &mut Vec<Seeker>) {
        rest.sort_by_key(|seeker| (seeker.row, seeker.token.start));
        let mut taken = vec![false; rest.len()];
        for number in 0..rest.len() {
            let upper = rest[number];
            if upper.top {
                continue;
            }
            let far = (upper.row + 2, upper.token.start.saturating_sub(1));
            let from = rest.partition_point(|seeker| (seeker.row, seeker.token.start) < far);
            let below = rest[from..].iter().position(|lower| {
                lower.top
                    && lower.row == upper.row + 2
                    && lower.token.start < upper.token.end
                    && upper.token.start < lower.token.end
            });
            let Some(lower) = below.map(|below| from + below) else { continue };
            let between = self.tokens.over(upper.row + 1, upper.token.start..upper.token.end);
            let message = match between.map(|(_, token)| token.what) {
                None => "ragged-drawing.gap",
                Some(What::Word) => "ragged-drawing.name",
                _ => continue,
            };
            if !taken[lower] && upper.wants.max(rest[lower].wants) == Wants::Much {
                (taken[number], taken[lower]) = (true, true);
                self.join(&upper, &rest[lower], message);
            }
        }
        let mut taken = taken.into_iter();
        rest.retain(|_| !taken.next().unwrap_or(false));
    }

    /// Joins a vertical wire, both of whose ends are in the air, with the junctions above and below that lack one:
    /// they stand in one column, and there is no other in their rows.
    fn join_displaced(&mut self, rest: &[Seeker]) {
        let in_row = |row: usize| {
            let from = rest.partition_point(|seeker| seeker.row < row);
            rest[from..].iter().take_while(move |seeker| seeker.row == row)
        };
        let only = |row: usize, top: bool| {
            let mut lacking = in_row(row).filter(|seeker| seeker.top == top && seeker.single && !seeker.bare);
            lacking.next().filter(|_| lacking.next().is_none()).copied()
        };
        for top in rest.iter().filter(|seeker| seeker.top && seeker.bare) {
            let Some((_, wire, _)) = self.uprights.of(top.row, top.number) else { continue };
            let Some(last) = wire.cells.last().copied() else { continue };
            let bottom = in_row(last.row).find(|seeker| !seeker.top && seeker.number == last.token);
            let Some(bottom) = bottom.filter(|bottom| bottom.bare).copied() else { continue };
            let (Some(upper), Some(lower)) = (only(top.row - 1, false), only(last.row + 1, true)) else {
                continue;
            };
            let alone = [(top.row, top.number), (last.row, last.token)].iter().all(|(row, number)| {
                in_row(*row).filter(|other| other.bare).all(|other| other.number == *number)
            });
            let straight = upper.token.start == lower.token.start;
            if straight && alone && upper.token.start.abs_diff(top.token.start) <= FAR_ASIDE {
                self.join(&upper, top, "ragged-drawing.beside");
                self.join(&bottom, &lower, "ragged-drawing.beside");
            }
        }
    }

    /// Makes two ends one vertical wire and says so.
    fn join(&mut self, upper: &Seeker, lower: &Seeker, message: &'static str) {
        let number =
            |uprights: &Uprights, end: &Seeker| uprights.of(end.row, end.number).map(|(own, ..)| own);
        // Earlier joints may have moved the ends into other wires.
        let (Some(above), Some(below)) = (number(self.uprights, upper), number(self.uprights, lower)) else {
            return;
        };
        if above == below {
            return;
        }
        self.uprights.append(above, below);
        // A bar is what is off, if only one of the two is one.
        let (own, other) = if upper.bare && !lower.bare { (upper, lower) } else { (lower, upper) };
        // A wire in one row that misses its junctions at both ends is one finding.
        let (own, other) = (self.span(own), self.span(other));
        let found = &mut self.found;
        let number = *self.numbers.entry((own, message)).or_insert_with(|| {
            found.push(Diagnostic::new("ragged-drawing", own, Message::new(message)));
            found.len() - 1
        });
        let junction = Related { file: None, span: other, message: Message::new(JUNCTION) };
        found[number].related.push(junction);
    }

    fn report_two<'s>(&mut self, own: &Seeker, others: impl Iterator<Item = &'s Seeker>) {
        let columns: Vec<&Seeker> = others.collect();
        let column = |at: usize| columns.get(at).map_or(0, |other| other.token.start + 1);
        let message = Message::new(TWO_READINGS).with("first", column(0)).with("second", column(1));
        let mut problem = Diagnostic::new("ragged-drawing", self.span(own), message);
        for other in columns {
            let message = Message::new("ragged-drawing.reading").with("column", other.token.start + 1);
            problem = problem.related(self.span(other), message);
        }
        self.found.push(problem);
    }

    /// Hands the findings over. An end that seemed to stand on an element belongs beside it.
    fn report(self) {
        let ends: FxHashSet<Span> = self.found.iter().map(|found| found.span).collect();
        self.problems.retain(|problem| {
            let on_end = || problem.related.iter().any(|related| ends.contains(&related.span));
            problem.code != "contact-on-vertical" || !on_end()
        });
        self.problems.extend(self.found);
    }

    fn span(&self, seeker: &Seeker) -> Span {
        self.grid.span(seeker.row, seeker.token.start, seeker.token.end)
    }
}

/// Pairs of seekers by their numbers in the group: the one that seeks upwards, and the one that seeks downwards.
type Pairs = Vec<(usize, usize)>;

/// The ways to join the seekers of a group that leave the fewest in the air and do not cross.
fn best_matchings(group: &[Seeker]) -> Vec<Pairs> {
    let side = |top: bool| (0..group.len()).filter(|end| group[*end].top == top).collect::<Vec<_>>();
    let mut search = Search { group, uppers: side(false), best: Vec::new(), score: 1, pairs: Vec::new() };
    search.run(&side(true), 0, 0);
    search.best
}

struct Search<'a> {
    group: &'a [Seeker],
    /// The seekers of the upper row.
    uppers: Vec<usize>,
    best: Vec<Pairs>,
    score: usize,
    pairs: Pairs,
}

impl Search<'_> {
    /// Tries all partners for the first of `lowers` among the uppers from `from` on. `score` is what the pairs so far
    /// wanted.
    fn run(&mut self, lowers: &[usize], from: usize, score: usize) {
        let Some((lower, rest)) = lowers.split_first() else {
            if score > self.score {
                (self.score, self.best) = (score, Vec::new());
            }
            if score == self.score {
                self.best.push(self.pairs.clone());
            }
            return;
        };
        self.run(rest, from, score);
        for at in from..self.uppers.len() {
            let (a, b) = (self.group[*lower], self.group[self.uppers[at]]);
            let gap =
                a.token.start.saturating_sub(b.token.end).max(b.token.start.saturating_sub(a.token.end));
            if gap < ASIDE && a.wants.max(b.wants) > Wants::Nothing {
                self.pairs.push((*lower, self.uppers[at]));
                self.run(rest, at + 1, score + a.wants as usize + b.wants as usize);
                self.pairs.pop();
            }
        }
    }
}

fn partner(pairs: &Pairs, seeker: usize) -> Option<usize> {
    let of = |(a, b): &(usize, usize)| match seeker {
        _ if *a == seeker => Some(*b),
        _ if *b == seeker => Some(*a),
        _ => None,
    };
    pairs.iter().find_map(of)
}

/// The seeker that has different partners in several matchings, with these partners; a bar rather than a junction.
fn in_doubt(group: &[Seeker], several: &[Pairs]) -> Option<(usize, Vec<usize>)> {
    let doubt = |own: usize| {
        let mut others: Vec<usize> = several.iter().filter_map(|pairs| partner(pairs, own)).collect();
        others.sort_by_key(|other| group[*other].token.start);
        others.dedup();
        (others.len() > 1).then_some((own, others))
    };
    (0..group.len()).filter_map(doubt).max_by_key(|(own, _)| group[*own].bare)
}

/// Whether a vertical wire that begins its rows near the leftmost column is a piece of the left rail: nothing has room
/// between the two.
pub(super) fn is_left_rail(upright: &Upright, tokens: &Tokens, left: usize) -> bool {
    upright.cells.iter().all(|cell| {
        let start = tokens.rows[cell.row][cell.token].start;
        let first = tokens.extent(cell.row).drawn.map(|(first, _)| first);
        !cell.left && start <= left + ASIDE && first == Some(start)
    })
}

/// Reports the rows that are joined with the left rail although it is in another column beside most of the rows.
pub(super) fn report_left_rail(
    uprights: &Uprights,
    grid: &Grid,
    tokens: &Tokens,
    problems: &mut Vec<Diagnostic>,
) {
    let rails = uprights.all.iter().filter(|upright| upright.role == Role::LeftRail);
    let wired = rails.flat_map(|rail| &rail.cells).filter(|cell| cell.right);
    let cells: Vec<(usize, Token)> =
        wired.map(|cell| (cell.row, tokens.rows[cell.row][cell.token])).collect();
    let mut counts: FxHashMap<usize, usize> = FxHashMap::default();
    for (_, token) in &cells {
        *counts.entry(token.start).or_default() += 1;
    }
    let usual = counts.into_iter().max_by_key(|(column, count)| (*count, Reverse(*column)));
    let is_off = |(_, token): &&(usize, Token)| Some(token.start) != usual.map(|(column, _)| column);
    for (row, token) in cells.iter().filter(is_off) {
        let span = grid.span(*row, token.start, token.end);
        problems.push(Diagnostic::new("ragged-drawing", span, Message::new("ragged-drawing.rail")));
    }
}
