//! Translations with one fault in each: every contact, connection, constant, output and branch is spoiled in turn, in
//! lists of either language and in drawings.

use rungwise::document::{Document, Tree};
use rungwise::ladder::reduce::{Shape, reduce};
use rungwise::ladder::{Element, ElementKind, Rung, Style, print};
use rungwise::translate::Translation;
use std::collections::BTreeSet;

/// A translation with one fault, and what that is.
pub(crate) struct Mutant {
    pub(crate) fault: String,
    pub(crate) text: String,
}

/// The words of an instruction, with blanks before it left out.
pub(crate) fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

/// What an instruction is confused with, in either language of lists.
const CONFUSED: &[(&str, &[&str])] = &[
    ("LD", &["LDI", "LDN"]),
    ("LDI", &["LD"]),
    ("LDP", &["LDF"]),
    ("LDF", &["LDP"]),
    ("AND", &["ANI", "ANDN", "OR"]),
    ("ANI", &["AND", "ORI"]),
    ("ANDP", &["ANDF"]),
    ("ANDF", &["ANDP"]),
    ("OR", &["ORI", "ORN", "AND"]),
    ("ORI", &["OR", "ANI"]),
    ("ORP", &["ORF"]),
    ("ORF", &["ORP"]),
    ("ANB", &["ORB"]),
    ("ORB", &["ANB"]),
    ("SET", &["RST"]),
    ("RST", &["SET"]),
    ("PLS", &["PLF"]),
    ("PLF", &["PLS"]),
    ("LDN", &["LD"]),
    ("ANDN", &["AND", "ORN"]),
    ("ORN", &["OR", "ANDN"]),
    ("AND(", &["OR("]),
    ("OR(", &["AND("]),
    ("ANDN(", &["AND("]),
    ("ORN(", &["OR("]),
    ("ST", &["STN"]),
    ("STN", &["ST"]),
    ("S", &["R"]),
    ("R", &["S"]),
    ("GT", &["GE", "LE"]),
    ("GE", &["GT", "LT"]),
    ("LT", &["LE", "GE"]),
    ("LE", &["LT", "GT"]),
    ("EQ", &["NE"]),
    ("NE", &["EQ"]),
];

/// What a sign of comparison is confused with.
const SIGNS: &[(&str, &[&str])] = &[
    ("<>", &["="]),
    (">=", &[">", "<"]),
    ("<=", &["<", ">"]),
    ("=", &["<>", ">="]),
    (">", &[">=", "<="]),
    ("<", &["<=", ">="]),
];

/// The row of a table that begins with `word`.
fn row<'t>(table: &'t [(&str, &'t [&'t str])], word: &str) -> &'t [&'t str] {
    table.iter().find(|(own, _)| *own == word).map_or(&[], |(_, others)| others)
}

/// `mnemonic` with another sign of comparison, if it has one.
fn otherwise_compared(mnemonic: &str) -> Vec<String> {
    let Some(at) = mnemonic.find(['<', '>', '=']) else { return Vec::new() };
    let (word, sign) = mnemonic.split_at(at);
    row(SIGNS, sign).iter().map(|other| format!("{word}{other}")).collect()
}

/// `line` with the last number that stands for itself counted on by one: a preset, a constant.
fn counted_on(line: &str) -> Option<String> {
    let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
    let ends_there = |at: &usize| !line[at + digits(&line[*at..])..].starts_with(char::is_alphabetic);
    let starts = [" K", "T#", "PV := ", "LD      ", "EQ      ", "GT      "].iter().flat_map(|before| {
        line.match_indices(before).map(move |(at, _)| at + before.len()).collect::<Vec<_>>()
    });
    let starts = starts.filter(|at| digits(&line[*at..]) > 0);
    let at = starts.filter(|at| line[..*at].ends_with('#') || ends_there(at)).max()?;
    let end = at + digits(&line[at..]);
    let number: u32 = line[at..end].parse().ok()?;
    Some(format!("{}{}{}", &line[..at], number + 1, &line[end..]))
}

/// Where the block starts that the ANB or ORB in line `end` joins.
fn start_of_block(lines: &[&str], end: usize) -> Option<usize> {
    let mut open = 1;
    for at in (0..end).rev() {
        let mnemonic = words(lines[at]).first().copied().unwrap_or_default();
        match mnemonic {
            "ANB" | "ORB" => open += 1,
            _ if mnemonic.starts_with("LD") => open -= 1,
            _ => {}
        }
        if open == 0 {
            return Some(at);
        }
    }
    None
}

/// The lines of branches: blocks up to the instruction that joins them, in parentheses with these, and outputs behind a
/// kept power.
fn branches(lines: &[&str]) -> Vec<std::ops::Range<usize>> {
    let mut found = Vec::new();
    let mut open = Vec::new();
    for (at, line) in lines.iter().enumerate() {
        match words(line).first().copied().unwrap_or_default() {
            "ANB" | "ORB" => found.extend(start_of_block(lines, at).map(|start| start..at + 1)),
            word if word.ends_with('(') && line.trim().len() == word.len() => open.push(at),
            word if word.ends_with('(') && !line.contains(')') => open.push(at),
            ")" => found.extend(open.pop().map(|start| start..at + 1)),
            "MRD" => {
                let next =
                    lines[at + 1..].iter().position(|line| matches!(line.trim(), "MRD" | "MPP" | "MPS"));
                found.extend(
                    next.filter(|next| lines[at + 1 + next].trim() != "MPS").map(|next| at..at + 1 + next),
                );
            }
            _ => {}
        }
    }
    found
}

const OUTPUTS: [&str; 8] = ["OUT", "SET", "RST", "PLS", "PLF", "ST", "S", "R"];

/// What an instruction drives: its operands.
fn driven(line: &str) -> Option<&str> {
    let (mnemonic, operands) = line.trim_start().split_once(char::is_whitespace)?;
    OUTPUTS.contains(&mnemonic).then(|| operands.trim())
}

/// Which lines are instructions, and no declarations, ends and what a configuration says.
fn bodies(lines: &[&str]) -> Vec<bool> {
    let is_list = |text: &str| text.contains("PROGRAM");
    let mut is_body = !lines.iter().any(|line| is_list(line));
    let body = lines.iter().map(|line| {
        let word = words(line).first().copied().unwrap_or_default();
        let ends = word.starts_with("END");
        is_body = match word {
            "END_VAR" => true,
            _ if ends || word.starts_with("VAR") => false,
            _ => is_body,
        };
        is_body && word != "END_VAR"
    });
    body.collect()
}

/// A list with one fault in each: at each instruction, of each branch, of each two outputs, of rungs that drive the same.
pub(crate) fn of_list(made: &Translation) -> Vec<Mutant> {
    let text = &made.text;
    let lines: Vec<&str> = text.lines().collect();
    let is_body = bodies(&lines);
    // Words of the other language.
    let is_fx = !text.contains("PROGRAM");
    let foreign = if is_fx { ["LDN", "ANDN", "ORN"] } else { ["LDI", "ANI", "ORI"] };
    let mut mutants = Vec::new();
    let mut add = |fault: String, changed: Vec<String>| {
        mutants.push(Mutant { fault, text: changed.join("\n") + "\n" });
    };
    let own = |range: std::ops::Range<usize>| lines[range].iter().map(|line| line.to_string());
    let with = |at: usize, line: String| own(0..at).chain([line]).chain(own(at + 1..lines.len())).collect();
    for (at, line) in lines.iter().enumerate().filter(|(at, _)| is_body[*at]) {
        let all = words(line);
        let Some(mnemonic) = all.first().filter(|_| !line.trim_end().ends_with(':')) else { continue };
        // Only a bit is set.
        let is_word =
            all.get(1).is_some_and(|word| word.starts_with(['T', 'C', 'D']) && words(line).len() == 2);
        let others = row(CONFUSED, mnemonic).iter().map(|other| other.to_string());
        let others =
            others.filter(|other| (other != "SET" || !is_word) && !foreign.contains(&other.as_str()));
        for other in others.chain(otherwise_compared(mnemonic)) {
            add(format!("{line} as {other}"), with(at, line.replacen(mnemonic, &other, 1)));
        }
        if let Some(counted) = counted_on(line) {
            add(format!("{line} counted on"), with(at, counted));
        }
        add(format!("{line} left out"), own(0..at).chain(own(at + 1..lines.len())).collect());
        for (other, line_of_other) in lines.iter().enumerate().skip(at + 1).take_while(|(at, _)| is_body[*at])
        {
            let (Some(one), Some(two)) = (driven(line), driven(line_of_other)) else { continue };
            // What resets a counter cannot be what switches a lamp.
            let kinds = [line, line_of_other].map(|line| words(line)[0]);
            let is_alike =
                kinds[0] == kinds[1] || ![one, two].iter().any(|own| own.starts_with(['T', 'C', 'D']));
            if one == two || !is_alike {
                continue;
            }
            let mut swapped: Vec<String> = own(0..lines.len()).collect();
            swapped[at] = line.replacen(one, two, 1);
            swapped[other] = line_of_other.replacen(two, one, 1);
            add(format!("{one} and {two} swapped"), swapped);
        }
    }
    for range in branches(&lines) {
        let fault = format!("{} left out", lines[range.clone()].join("; "));
        add(fault, own(0..range.start).chain(own(range.end..lines.len())).collect());
    }
    for pair in made.rungs.windows(2) {
        let [one, two] = [0, 1].map(|side| &text[pair[side].result.clone()]);
        let drives =
            |text: &str| text.lines().filter_map(driven).map(str::to_string).collect::<BTreeSet<_>>();
        if pair.iter().any(|rung| rung.is_kept) || drives(one).is_disjoint(&drives(two)) {
            continue;
        }
        let between = &text[pair[0].result.end..pair[1].result.start];
        let swapped = format!("{two}{between}{one}");
        let mut text = text.clone();
        text.replace_range(pair[0].result.start..pair[1].result.end, &swapped);
        mutants.push(Mutant { fault: format!("swapped {one}{two}"), text });
    }
    mutants
}

/// What a symbol of a drawing is confused with.
const SYMBOLS: &[(&str, &[&str])] = &[
    ("-| |-", &["-|/|-"]),
    ("-|/|-", &["-| |-"]),
    ("-|P|-", &["-|N|-", "-| |-"]),
    ("-|N|-", &["-|P|-"]),
    ("-( )-", &["-(/)-", "-(S)-"]),
    ("-(S)-", &["-(R)-"]),
    ("-(R)-", &["-(S)-"]),
    ("-[> ", &["-[< "]),
    ("-[< ", &["-[> "]),
    ("-[>= ", &["-[<= "]),
    ("-[<= ", &["-[>= "]),
    ("-[= ", &["-[> "]),
];

/// A drawing with one fault in each: at each symbol, at each constant, without a branch, with two outputs swapped,
/// without a rung.
pub(crate) fn of_drawing(document: &Document) -> Vec<Mutant> {
    let text = &document.text();
    let mut mutants = symbols(text);
    let lines: Vec<&str> = text.lines().collect();
    for (at, line) in lines.iter().enumerate() {
        let counted = counted_on(line).filter(|counted| line.starts_with('|') && counted.len() == line.len());
        if let Some(counted) = counted {
            let all = [&lines[..at], &[&counted], &lines[at + 1..]].concat();
            mutants.push(Mutant { fault: format!("{line} counted on"), text: all.join("\n") + "\n" });
        }
    }
    let mut coils = Vec::new();
    for at in document.chunks() {
        let chunk = at.chunk.text();
        let Tree::Ladder(tree) = at.chunk.tree() else { continue };
        for rung in &tree.rungs {
            let lines = line_range(text, at.start, rung);
            let own = &text[lines.clone()];
            let replaced = |new: &str| format!("{}{new}{}", &text[..lines.start], &text[lines.end..]);
            let is_end = own.contains("[END]");
            if !is_end {
                mutants.push(Mutant { fault: format!("rung left out:\n{own}"), text: replaced("") });
            }
            // A block that nothing follows.
            let Ok(shape) = reduce(&rung.graph) else {
                assert!(rung.graph.elements.iter().any(|element| element.block().is_some()), "{own}");
                continue;
            };
            for (branch, rest) in without_a_branch(&shape) {
                let names =
                    branch.elements().into_iter().map(|id| rung.graph.element(id).operand_text(0, chunk));
                let fault = format!("branch left out: {}", names.collect::<Vec<_>>().join(" "));
                let drawn = print(&rest, &rung.graph, chunk, &Style::default());
                let drawn = drawn.unwrap_or_else(|| panic!("no drawing of {rest:?}"));
                mutants.push(Mutant { fault, text: replaced(&drawn) });
            }
            let is_coil = |element: &&Element| matches!(element.kind, ElementKind::Coil(_));
            coils.extend(rung.graph.elements.iter().filter(is_coil).map(|element| {
                let [first, last] = [element.operands.first(), element.operands.last()].map(Option::unwrap);
                let place = at.start + first.span.start as usize..at.start + last.span.end as usize;
                (document.unit_at(place.start).number, &element.kind, place)
            }));
        }
    }
    for (number, one) in coils.iter().enumerate() {
        for two in coils[number + 1..].iter().filter(|two| two.0 == one.0) {
            let names = [&one.2, &two.2].map(|place| &text[place.clone()]);
            // What resets a counter cannot be what switches a lamp.
            let is_alike = one.1 == two.1 || !names.iter().any(|name| name.starts_with(['T', 'C', 'D']));
            if names[0] != names[1] && is_alike {
                let swapped = renamed(&renamed(text, &two.2, names[0]), &one.2, names[1]);
                mutants
                    .push(Mutant { fault: format!("{} and {} swapped", names[0], names[1]), text: swapped });
            }
        }
    }
    mutants
}

/// A drawing with one symbol that is another one in each.
fn symbols(text: &str) -> Vec<Mutant> {
    let mut mutants = Vec::new();
    for (symbol, others) in SYMBOLS {
        for (at, _) in text.match_indices(symbol) {
            let start = text[..at].rfind('\n').map_or(0, |line| line + 1);
            let above = text[..start].lines().next_back().unwrap_or_default();
            // A coil stands at the right rail, and its name ends there.
            let name = match symbol.ends_with(")-") {
                true => above.trim_end_matches(['|', ' ']).rsplit("  ").next(),
                false => above.get(at - start..),
            };
            let name = name.unwrap_or_default().trim();
            let is_counted =
                name.starts_with(['T', 'C']) && name[1..].starts_with(|next: char| next.is_ascii_digit());
            // There are no such coils of timers and counters.
            if is_counted && symbol.ends_with(")-") {
                continue;
            }
            let name = words(name).first().copied().unwrap_or_default();
            for other in *others {
                let mut changed = text.to_string();
                changed.replace_range(at..at + symbol.len(), other);
                mutants.push(Mutant { fault: format!("{symbol} of {name} as {other}"), text: changed });
            }
        }
    }
    mutants
}

/// The lines of a rung whose chunk begins at `start`.
fn line_range(text: &str, start: usize, rung: &Rung) -> std::ops::Range<usize> {
    let [first, last] = [rung.span.start, rung.span.end].map(|at| start + at as usize);
    let first = text[..first].rfind('\n').map_or(0, |at| at + 1);
    first..text[last..].find('\n').map_or(text.len(), |at| last + at + 1)
}

/// The drawing with another name in place of the one that stands there, which ends in the same column.
fn renamed(text: &str, place: &std::ops::Range<usize>, name: &str) -> String {
    let blanks = text[..place.start].len() - text[..place.start].trim_end_matches(' ').len();
    let start = (place.end - name.len()).min(place.start);
    assert!(place.start - start < blanks.max(1), "no room for {name} in\n{text}");
    let blanks = " ".repeat(place.end - start - name.len());
    format!("{}{blanks}{name}{}", &text[..start], &text[place.end..])
}

/// Each branch of a shape, with the shape without it.
fn without_a_branch(shape: &Shape) -> Vec<(Shape, Shape)> {
    let (parts, is_series) = match shape {
        Shape::Series(parts) => (parts, true),
        Shape::Parallel(parts) => (parts, false),
        _ => return Vec::new(),
    };
    let mut found = Vec::new();
    for (number, part) in parts.iter().enumerate() {
        let with = |own: &[Shape]| joined([&parts[..number], own, &parts[number + 1..]].concat(), is_series);
        if !is_series {
            found.push((part.clone(), with(&[])));
        }
        found.extend(without_a_branch(part).into_iter().map(|(branch, rest)| (branch, with(&[rest]))));
    }
    found
}

/// The shape of these parts, none of which is like it.
fn joined(parts: Vec<Shape>, is_series: bool) -> Shape {
    let flat = parts.into_iter().flat_map(|part| match part {
        Shape::Series(own) if is_series => own,
        Shape::Parallel(own) if !is_series => own,
        Shape::Wire if is_series => Vec::new(),
        part => vec![part],
    });
    let mut flat: Vec<Shape> = flat.collect();
    match flat.len() {
        0 => Shape::Wire,
        1 => flat.remove(0),
        _ if is_series => Shape::Series(flat),
        _ => Shape::Parallel(flat),
    }
}
