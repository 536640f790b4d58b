//! Operands of IEC programs: literals, direct addresses, variables.

use super::{Literal, LiteralProblem, LiteralValue, is_identifier, is_keyword};
use crate::target::{DirectAddress, Location, Operand, OperandProblem, Width};

/// How deep subscripts and parentheses may nest; deeper ones are no operand, so that no input exhausts the stack.
const MAX_DEPTH: u32 = 16;

/// Reads one operand word of an IEC program. Never fails; see [`Operand::Invalid`].
pub fn read_operand(word: &str) -> Operand {
    read_nested(word, 0)
}

fn read_nested(word: &str, depth: u32) -> Operand {
    let Some(first) = word.chars().next() else { return Operand::Invalid(OperandProblem::Unreadable) };
    let name_end = word.find(|c: char| !is_name_character(c)).unwrap_or(word.len());
    match first {
        '%' => match direct_address(&word[1..]) {
            Some(address) => Operand::Direct(address),
            None => Operand::Invalid(OperandProblem::MalformedAddress),
        },
        '\'' | '"' | '0'..='9' | '+' | '-' | '.' => literal(word),
        // `#` right after the first name makes a literal; further on it belongs to a subscript.
        _ if word[name_end..].starts_with('#') => literal(word),
        _ if word.eq_ignore_ascii_case("TRUE") || word.eq_ignore_ascii_case("FALSE") => literal(word),
        _ if name_end == 0 => Operand::Invalid(OperandProblem::Unreadable),
        _ if is_keyword(&word[..name_end]) => Operand::Invalid(OperandProblem::Keyword),
        _ if is_variable(word, name_end, depth) => Operand::Variable,
        _ => Operand::Invalid(OperandProblem::MalformedName),
    }
}

fn literal(word: &str) -> Operand {
    match Literal::read(word) {
        Ok(literal) => Operand::Literal(literal),
        Err(LiteralProblem::Form) => Operand::Invalid(OperandProblem::Unreadable),
        Err(problem) => Operand::Invalid(OperandProblem::MalformedLiteral(problem)),
    }
}

/// A direct address without its `%`: `IX0.0`, `QW3`, `M1`, `I*`.
fn direct_address(text: &str) -> Option<DirectAddress> {
    let mut rest = text.chars();
    let location = match rest.next()?.to_ascii_uppercase() {
        'I' => Location::Input,
        'Q' => Location::Output,
        'M' => Location::Memory,
        _ => return None,
    };
    let after_location = rest.as_str();
    let width = match rest.next()?.to_ascii_uppercase() {
        'X' => Width::Bit,
        'B' => Width::Byte,
        'W' => Width::Word,
        'D' => Width::Double,
        'L' => Width::Long,
        _ => {
            rest = after_location.chars();
            Width::Bit
        }
    };
    let mut path = [None; 4];
    if rest.as_str() != "*" {
        let mut levels = rest.as_str().split('.');
        for level in &mut path {
            let Some(number) = levels.next() else { break };
            // `parse` would take a sign.
            if !number.bytes().all(|digit| digit.is_ascii_digit()) {
                return None;
            }
            *level = Some(number.parse().ok()?);
        }
        if levels.next().is_some() {
            return None;
        }
    }
    Some(DirectAddress { location, width, path })
}

/// A variable: a name that ends at `name_end`, then members `.x`, bits `.3` and `.%X3`, subscripts `[i, 2]`, and
/// the third edition's `^`.
fn is_variable(word: &str, name_end: usize, depth: u32) -> bool {
    let (name, mut rest) = word.split_at(name_end);
    if !is_identifier(name) {
        return false;
    }
    while let Some(mark) = rest.chars().next() {
        let after = &rest[mark.len_utf8()..];
        rest = match mark {
            '^' => after,
            '[' => match subscripts(after, depth) {
                Some(after) => after,
                None => return false,
            },
            '.' => {
                let end = after.find(|c: char| !is_name_character(c) && c != '%').unwrap_or(after.len());
                let (member, after) = after.split_at(end);
                if !is_identifier(member) && !is_partial_access(member) {
                    return false;
                }
                after
            }
            _ => return false,
        };
    }
    true
}

/// `3`, `%X3`, `%B1`, `%W0`, `%D0`, `%L0` behind the point: a bit or another part of a bit string.
fn is_partial_access(member: &str) -> bool {
    let number = match member.strip_prefix('%') {
        Some(part) => part.strip_prefix(['X', 'B', 'W', 'D', 'L', 'x', 'b', 'w', 'd', 'l']).unwrap_or(part),
        None => member,
    };
    (1..=2).contains(&number.len()) && number.bytes().all(|digit| digit.is_ascii_digit())
}

/// Subscripts after the `[`: expressions with commas between them. Gives what follows the `]`.
fn subscripts(text: &str, depth: u32) -> Option<&str> {
    let mut rest = text;
    loop {
        rest = expression(rest, depth.checked_add(1).filter(|depth| *depth <= MAX_DEPTH)?)?.trim_start();
        match rest.chars().next()? {
            ',' => rest = &rest[1..],
            ']' => return Some(&rest[1..]),
            _ => return None,
        }
    }
}

/// A sum of products at the start of `text`, operands of it being integers, variables and parentheses. Gives what
/// follows it.
fn expression(text: &str, depth: u32) -> Option<&str> {
    let mut rest = text;
    loop {
        rest = rest.trim_start();
        rest = match rest.chars().next()? {
            '-' | '+' => rest[1..].trim_start(),
            _ => rest,
        };
        rest = match rest.strip_prefix('(') {
            Some(inner) => {
                let deeper = depth.checked_add(1).filter(|depth| *depth <= MAX_DEPTH)?;
                expression(inner, deeper)?.trim_start().strip_prefix(')')?
            }
            None => {
                let end = primary_end(rest);
                let (primary, after) = rest.split_at(end);
                let integer = |literal: Literal| {
                    matches!(literal.value, LiteralValue::Integer(_) | LiteralValue::Enumerated)
                };
                match read_nested(primary, depth) {
                    Operand::Variable | Operand::Direct(_) => after,
                    Operand::Literal(literal) if integer(literal) => after,
                    _ => return None,
                }
            }
        };
        rest = rest.trim_start();
        rest = match rest.chars().next() {
            Some('+' | '-' | '*' | '/') => &rest[1..],
            _ => return Some(rest),
        };
    }
}

/// Where the name, number or address at the start of `text` ends, its own subscripts included.
fn primary_end(text: &str) -> usize {
    let mut open = 0u32;
    for (offset, character) in text.char_indices() {
        match character {
            '[' => open = open.saturating_add(1),
            ']' if open > 0 => open -= 1,
            _ if open > 0 || is_name_character(character) || ".#%^".contains(character) => {}
            _ => return offset,
        }
    }
    text.len()
}

fn is_name_character(character: char) -> bool {
    unicode_ident::is_xid_continue(character)
}
