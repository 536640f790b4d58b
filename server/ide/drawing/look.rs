//! How a rung is drawn, so that it can be drawn again in the same way: characters, rails, margin, comments behind it.

use super::assemble::Plan;
use super::site::Site;
use crate::ladder::reduce::reduce;
use crate::ladder::{
    Drawing, Element, ElementKind, OperandPlace, Rung, Strokes, Style, StyleKind, column_after,
};
use crate::text::{BYTE_ORDER_MARK, Message, text_width};

/// The look of one rung.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Look {
    pub kind: StyleKind,
    /// What stands before the left rail: on the line of the rung's number, and on the others.
    numbered_margin: Option<String>,
    margin: String,
    double_left: bool,
    double_right: bool,
    has_right: bool,
    /// Cells from the left rail to the right rail.
    rail: u32,
    line_end: &'static str,
    /// Whether its last line is ended.
    ended: bool,
}

impl Look {
    /// The look of the rung at `site`; `fallback` for a rung without any character that tells.
    pub fn of(site: &Site<'_>, fallback: StyleKind) -> Look {
        let text = site.lines().of(site.text);
        let lines: Vec<&str> = text.lines().collect();
        let left = lines.iter().filter_map(|line| first_drawn(line)).min().unwrap_or(0);
        let double_left = lines.iter().any(|line| bars_at(line, left) > 1);
        let rail = site.rung.right_rail.iter().map(|rail| rail.value);
        // A rung that ends in jumps reaches no rail, though one may be drawn.
        let rail = most_common(rail.collect()).or_else(|| rail_behind(&lines, left));
        let double_right = rail.is_some_and(|rail| lines.iter().any(|line| bars_at(line, rail) > 1));
        let widest = lines.iter().map(|line| line.chars().fold(0, column_after)).max().unwrap_or(1);
        let inner = left + u32::from(double_left);
        let number = site.rung.number.map(|number| {
            let start = site.line_start(site.line_of(number.span.start as usize));
            let head = site.text.get(start..number.span.end as usize).unwrap_or("");
            let blanks = (left as usize).saturating_sub(text_width(head));
            format!("{head}{}", " ".repeat(blanks))
        });
        Look {
            kind: kind_of(site.rung, text).unwrap_or(fallback),
            margin: " ".repeat(left as usize),
            numbered_margin: number,
            double_left,
            double_right,
            has_right: rail.is_some(),
            rail: rail.unwrap_or(widest).saturating_sub(inner),
            line_end: if text.contains("\r\n") { "\r\n" } else { "\n" },
            ended: text.ends_with('\n'),
        }
    }

    /// The look of a document's first rung.
    pub fn plain(kind: StyleKind, width: u32) -> Look {
        Look {
            kind,
            numbered_margin: None,
            margin: String::new(),
            double_left: false,
            double_right: false,
            has_right: true,
            rail: width.clamp(8, Style::WIDTH_MAX) - 1,
            line_end: "\n",
            ended: true,
        }
    }

    /// A line of bare rails for names, and a wire from rail to rail.
    pub fn empty_rung(&self) -> String {
        let (bar, left, wire, right) = match self.kind {
            StyleKind::Unicode => ('│', '├', '─', '┤'),
            _ => ('|', '+', '-', '+'),
        };
        let inner = (self.rail as usize).saturating_sub(1);
        let mut lines = [(bar, ' ', bar), (left, wire, right)].map(|(first, fill, last)| {
            let fill: String = std::iter::repeat_n(fill, inner).collect();
            format!("{first}{fill}{last}")
        });
        lines.iter_mut().for_each(|line| self.fit_rails(line));
        if !self.has_right {
            // Without a right rail the wire has to be seen all the same.
            lines[1].extend(std::iter::repeat_n(wire, inner));
        }
        lines.map(|line| format!("{}{line}{}", self.margin, self.line_end)).concat()
    }

    /// Bytes from the start of the empty rung's wire line to where the first contact stands.
    pub fn wire_inset(&self) -> usize {
        let unicode = self.kind == StyleKind::Unicode;
        let rail = if self.double_left { 2 } else { 1 };
        self.margin.len() + if unicode { 3 * (rail + 3) } else { rail + 3 }
    }

    pub fn line_end(&self) -> &'static str {
        self.line_end
    }

    /// The lines of `plan`, whose words stand in `source`, in this look, with what stood behind the old lines.
    ///
    /// # Errors
    /// Where the notation has no drawing for it, or a comment stands in the middle of the rung.
    pub fn draw(&self, plan: &Plan, source: &str, site: &Site<'_>) -> Result<String, Message> {
        let cannot = || Message::new("edit.cannot-draw");
        let graph = plan.graph();
        let drawing = Drawing::new(&plan.shape, &graph, source, self.kind).ok_or_else(cannot)?;
        let rail =
            if self.has_right { self.rail.max(drawing.rail_column_min()) } else { drawing.rail_column_min() };
        let mut lines = drawing.paint(rail).ok_or_else(cannot)?;
        for line in &mut lines {
            self.fit_rails(line);
        }
        self.add_margin(&mut lines);
        for (row, column, comment) in comments_behind(site)? {
            let line = lines.get_mut(line_of_row(plan, &drawing, row)).ok_or_else(cannot)?;
            let blanks = (column as usize).saturating_sub(text_width(line)).max(2);
            line.push_str(&" ".repeat(blanks));
            line.push_str(comment);
        }
        let mut text = lines.join(self.line_end);
        if site.lines().of(site.text).starts_with(BYTE_ORDER_MARK) {
            text.insert(0, BYTE_ORDER_MARK);
        }
        if self.ended {
            text.push_str(self.line_end);
        }
        Ok(text)
    }

    /// Whether the rung is drawn as it would be drawn again.
    pub fn redraws(&self, site: &Site<'_>) -> bool {
        let Ok(shape) = reduce(&site.rung.graph) else { return false };
        let plan = Plan { shape, elements: site.rung.graph.elements.clone() };
        self.draw(&plan, site.text, site).is_ok_and(|lines| lines == site.lines().of(site.text))
    }

    /// Rails as this rung has them: double, or none on the right.
    fn fit_rails(&self, line: &mut String) {
        if !self.has_right {
            line.pop();
            let bare = line.trim_end_matches([' ', '-', '─']);
            let keep = if bare.ends_with([')', ']', '>']) { bare.len() } else { line.trim_end().len() };
            line.truncate(keep);
        } else if self.double_right && line.pop().is_some() {
            line.push_str(self.double());
        }
        if self.double_left && !line.is_empty() {
            let first = line.chars().next().map_or(0, char::len_utf8);
            line.replace_range(..first, self.double());
        }
    }

    fn double(&self) -> &'static str {
        if self.kind == StyleKind::Unicode { "││" } else { "||" }
    }

    /// The rung's number stands beside its first power line.
    fn add_margin(&self, lines: &mut [String]) {
        let mut number = self.numbered_margin.as_ref();
        let last = lines.len().saturating_sub(1);
        for (row, line) in lines.iter_mut().enumerate() {
            let bars = line.chars().take_while(|c| is_bar(*c)).count();
            let second = line.chars().nth(bars).unwrap_or(' ');
            let power = bars == 0 || Strokes::of(second).left;
            let margin = number.take_if(|_| power || row == last).unwrap_or(&self.margin);
            line.insert_str(0, margin);
        }
    }
}

/// The characters of a drawing, if it has any that tell.
fn kind_of(rung: &Rung, text: &str) -> Option<StyleKind> {
    if text.contains(|c| ('\u{2500}'..='\u{257F}').contains(&c)) {
        return Some(StyleKind::Unicode);
    }
    let named = |element: &&Element| matches!(element.kind, ElementKind::Contact(_) | ElementKind::Coil(_));
    let mut places = rung.graph.elements.iter().filter(named).map(|element| element.place).peekable();
    places.peek()?;
    Some(if places.all(|place| place == OperandPlace::Inside) { StyleKind::Brackets } else { StyleKind::Iec })
}

/// The column of the first cell that is drawn, a number in the margin passed over.
fn first_drawn(line: &str) -> Option<u32> {
    let mut column = 0;
    for character in line.trim_start_matches(BYTE_ORDER_MARK).chars() {
        if Strokes::of(character) != Strokes::default() || matches!(character, '[' | ']' | '(' | ')') {
            return Some(column);
        }
        if !character.is_ascii_digit() && !character.is_whitespace() {
            return None;
        }
        column = column_after(column, character);
    }
    None
}

fn is_bar(character: char) -> bool {
    let Strokes { left, right, up, down } = Strokes::of(character);
    up && down && !left && !right
}

/// How many bars stand side by side from a column on.
fn bars_at(line: &str, from: u32) -> usize {
    let mut column = 0;
    let cells = line.chars().map(|character| {
        let at = column;
        column = column_after(column, character);
        (at, character)
    });
    cells.skip_while(|(at, _)| *at < from).take_while(|(_, character)| is_bar(*character)).count()
}

/// The column right of `left` at which every line ends in bars.
fn rail_behind(lines: &[&str], left: u32) -> Option<u32> {
    let mut columns = lines.iter().map(|line| {
        let line = line.trim_end();
        let bare = line.trim_end_matches(is_bar);
        (bare.len() < line.len()).then(|| bare.chars().fold(0, column_after))
    });
    let first = columns.next()??;
    (first > left && columns.all(|column| column == Some(first))).then_some(first)
}

/// The value that comes most often; of several the greatest.
pub(super) fn most_common<T: Ord + Copy>(mut values: Vec<T>) -> Option<T> {
    values.sort_unstable();
    values
        .chunk_by(|left, right| left == right)
        .max_by_key(|run| run.len())
        .and_then(|run| run.first().copied())
}

/// The comments behind a rung's lines: line of the chunk, column, words.
fn comments_behind<'d>(site: &Site<'d>) -> Result<Vec<(u32, u32, &'d str)>, Message> {
    let lines = site.lines();
    let inside =
        site.tree.comments.iter().filter(|comment| comment.start < lines.end && lines.start < comment.end);
    let behind = inside.map(|comment| {
        let line = site.line_of(comment.start as usize);
        let (start, end) = (site.line_start(line), site.line_start(line + 1));
        let before = site.text.get(start..comment.start as usize).unwrap_or("");
        let after = site.text.get(comment.end as usize..end.max(comment.end as usize)).unwrap_or("");
        let is_behind = !before.trim().is_empty() && after.trim().is_empty();
        let comment_text = comment.of(site.text).trim_end();
        is_behind
            .then(|| (line, site.column(comment.start as usize), comment_text))
            .ok_or_else(|| Message::new("edit.comment-inside"))
    });
    behind.collect()
}

/// The line of a drawing that shows what was drawn on line `row` of the chunk, or below it if no element was there.
fn line_of_row(plan: &Plan, drawing: &Drawing, row: u32) -> usize {
    let old = || (0u32..).zip(&plan.elements).filter(|(_, element)| element.row != NEW_ROW);
    let below = old().filter(|(_, element)| element.row >= row).min_by_key(|(_, element)| element.row);
    let nearest = below.or(old().max_by_key(|(_, element)| element.row));
    nearest.and_then(|(id, _)| drawing.line_of(id)).unwrap_or(0)
}

/// The row of elements that have not been drawn yet.
pub(super) const NEW_ROW: u32 = u32::MAX;
