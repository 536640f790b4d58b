//! Two PLCs of a few lines that calculate with words: one runs the text of an FX list, the other that of a list of IEC
//! 61131-3 by its declarations. They owe nothing to the product.

use crate::translate_iec::combine;
use std::collections::BTreeMap;

/// Bits, and registers by number.
#[derive(Clone, Default, PartialEq, Debug)]
pub struct Fx {
    pub bits: BTreeMap<String, bool>,
    pub words: BTreeMap<u32, i16>,
    /// The power of each pulse form one scan before, by line.
    pulses: BTreeMap<usize, bool>,
}

impl Fx {
    fn bit(&self, name: &str) -> bool {
        name == "M8000" || self.bits.get(name).copied().unwrap_or(false)
    }

    fn word(&self, number: u32) -> i16 {
        self.words.get(&number).copied().unwrap_or(0)
    }

    fn value(&self, word: &str, wide: bool) -> i64 {
        let (kind, rest) = word.split_at(1);
        match kind {
            "K" => rest.parse().unwrap(),
            "H" => {
                let bits = i64::from_str_radix(rest, 16).unwrap();
                if wide { i64::from(bits as i32) } else { i64::from(bits as i16) }
            }
            "D" => {
                let number: u32 = rest.parse().unwrap();
                let low = self.word(number);
                match wide {
                    true => i64::from(i32::from(self.word(number + 1)) << 16 | i32::from(low as u16)),
                    false => i64::from(low),
                }
            }
            _ => panic!("{word}"),
        }
    }

    fn store(&mut self, word: &str, wide: bool, value: i64) {
        let number: u32 = word.strip_prefix('D').unwrap().parse().unwrap();
        self.words.insert(number, value as i16);
        if wide {
            self.words.insert(number + 1, (value >> 16) as i16);
        }
    }

    /// One scan.
    pub fn scan(&mut self, list: &str) {
        let (mut results, mut kept): (Vec<bool>, Vec<bool>) = (Vec::new(), Vec::new());
        let mut drove = true;
        for (at, line) in list.lines().enumerate() {
            let words: Vec<&str> = line.split_whitespace().collect();
            let [mnemonic, operands @ ..] = &words[..] else { continue };
            let load = mnemonic.starts_with("LD");
            if load && drove && kept.is_empty() {
                results.clear();
            }
            drove = false;
            let signs = ['=', '<', '>'];
            let joined = ["LD", "AND", "OR"].into_iter().find(|word| {
                mnemonic.strip_prefix(word).is_some_and(|rest| rest.trim_start_matches('D').contains(signs))
            });
            match *mnemonic {
                "END" => return,
                "ANB" | "ORB" => {
                    let upper = results.pop().unwrap();
                    let lower = results.last_mut().unwrap();
                    *lower = if *mnemonic == "ANB" { *lower & upper } else { *lower | upper };
                }
                "INV" => *results.last_mut().unwrap() ^= true,
                "MPS" => kept.push(*results.last().unwrap()),
                "MRD" => *results.last_mut().unwrap() = *kept.last().unwrap(),
                "MPP" => *results.last_mut().unwrap() = kept.pop().unwrap(),
                _ if joined.is_some() => {
                    let rest = mnemonic.strip_prefix(joined.unwrap()).unwrap();
                    let (sign, wide) = (rest.trim_start_matches('D'), rest.starts_with('D'));
                    let [left, right] = [0, 1].map(|side| self.value(operands[side], wide));
                    let holds = match sign {
                        "=" => left == right,
                        "<>" => left != right,
                        "<" => left < right,
                        "<=" => left <= right,
                        ">" => left > right,
                        _ => left >= right,
                    };
                    join(&mut results, joined.unwrap(), holds);
                }
                "LD" | "AND" | "OR" => join(&mut results, mnemonic, self.bit(operands[0])),
                "LDI" | "ANI" | "ORI" => join(&mut results, &mnemonic[..2], !self.bit(operands[0])),
                _ => {
                    drove = true;
                    let power = *results.last().unwrap();
                    self.output(at, mnemonic, operands, power);
                }
            }
        }
    }

    fn output(&mut self, at: usize, mnemonic: &str, operands: &[&str], power: bool) {
        let first = operands[0].to_string();
        match mnemonic {
            "OUT" => {
                self.bits.insert(first, power);
                return;
            }
            "SET" | "RST" if !first.starts_with('D') => {
                if power {
                    self.bits.insert(first, mnemonic == "SET");
                }
                return;
            }
            _ => {}
        }
        let (plain, is_pulse) = match mnemonic.strip_suffix('P') {
            Some(plain) if !mnemonic.ends_with("CMP") && !mnemonic.ends_with("ZCP") => (plain, true),
            _ => (mnemonic, false),
        };
        let before = self.pulses.insert(at, power).unwrap_or(false);
        if !power || is_pulse && before {
            return;
        }
        let wide = plain.starts_with('D') && !matches!(plain, "DIV" | "DEC");
        let plain = if wide { &plain[1..] } else { plain };
        let value = |place: usize| self.value(operands[place], wide);
        let last = operands[operands.len() - 1];
        let stored = match plain {
            "MOV" => value(0),
            "ADD" => value(0) + value(1),
            "SUB" => value(0) - value(1),
            "INC" => value(0) + 1,
            "DEC" => value(0) - 1,
            "NEG" => -value(0),
            "RST" => 0,
            "WAND" | "AND" => value(0) & value(1),
            "WOR" | "OR" => value(0) | value(1),
            "WXOR" | "XOR" => value(0) ^ value(1),
            "CML" => !value(0),
            "MUL" => {
                let product = value(0) * value(1);
                return self.store(last, true, product);
            }
            "DIV" => {
                let (quotient, remainder) = (value(0) / value(1), value(0) % value(1));
                let number: u32 = last[1..].parse().unwrap();
                self.store(last, wide, quotient);
                return self.store(&format!("D{}", number + if wide { 2 } else { 1 }), wide, remainder);
            }
            "CMP" | "ZCP" => {
                let number: u32 = last[1..].parse().unwrap();
                let told = match plain {
                    "CMP" => [value(0) > value(1), value(0) == value(1), value(0) < value(1)],
                    _ => {
                        let within = value(0) <= value(2) && value(2) <= value(1);
                        [value(2) < value(0), within, value(2) > value(1)]
                    }
                };
                for (more, is_on) in (0..).zip(told) {
                    self.bits.insert(format!("{}{}", &last[..1], number + more), is_on);
                }
                return;
            }
            "ZRST" => {
                let [from, to] = [0, 1].map(|place| operands[place][1..].parse::<u32>().unwrap());
                for number in from..=to {
                    match &last[..1] {
                        "D" => self.store(&format!("D{number}"), false, 0),
                        kind => _ = self.bits.insert(format!("{kind}{number}"), false),
                    }
                }
                return;
            }
            "FMOV" | "BMOV" => {
                let count: u32 = operands[2][1..].parse().unwrap();
                let to: u32 = operands[1][1..].parse().unwrap();
                let width = if wide { 2 } else { 1 };
                let values: Vec<i64> = (0..count)
                    .map(|number| match plain {
                        "FMOV" => value(0),
                        _ => i64::from(self.word(operands[0][1..].parse::<u32>().unwrap() + number)),
                    })
                    .collect();
                for (number, value) in (0..).zip(values) {
                    self.store(&format!("D{}", to + number * width), wide, value);
                }
                return;
            }
            other => panic!("{other}"),
        };
        self.store(last, wide, stored);
    }
}

fn join(results: &mut Vec<bool>, word: &str, own: bool) {
    match (word, results.last_mut()) {
        ("LD", _) => results.push(own),
        ("AND" | "AN", Some(result)) => *result &= own,
        (_, Some(result)) => *result |= own,
        _ => panic!("{word}"),
    }
}

/// What a variable of a list of IEC 61131-3 holds: a bit as 0 or 1.
#[derive(Clone, Default, Debug)]
pub struct Iec {
    pub values: BTreeMap<String, i64>,
}

/// The type of each variable.
pub fn types(text: &str) -> BTreeMap<String, String> {
    let from = text.find("VAR").unwrap() + 3;
    let section = &text[from..text.find("END_VAR").unwrap()];
    let declared = section.split(';').filter_map(|line| {
        let (name, kind) = line.split_once(':')?;
        Some((name.split_whitespace().next()?.to_string(), kind.trim().to_string()))
    });
    declared.collect()
}

impl Iec {
    /// One scan.
    pub fn scan(&mut self, text: &str) {
        let types = types(text);
        let from = text.rfind("END_VAR").unwrap() + "END_VAR".len();
        let body = &text[from..text.find("END_PROGRAM").unwrap()];
        let lines: Vec<Vec<&str>> = body
            .lines()
            .map(|line| line.split_whitespace().collect::<Vec<_>>())
            .filter(|line| !line.is_empty())
            .collect();
        let mut stack: Vec<(String, i64, bool)> = Vec::new();
        let (mut current, mut is_bit, mut at) = (0_i64, false, 0);
        while let Some(line) = lines.get(at) {
            at += 1;
            let (word, operand) = (line[0], line.get(1).copied().unwrap_or(""));
            let (value, kind) = self.read(operand, &types);
            if let Some(operator) = word.strip_suffix('(') {
                stack.push((operator.to_string(), current, is_bit));
                (current, is_bit) = (value, kind == "BOOL");
                continue;
            }
            let label = format!("{operand}:");
            match word {
                ")" => {
                    let (operator, before, was_bit) = stack.pop().unwrap();
                    current = combine(&operator, before, current);
                    is_bit = was_bit;
                }
                "LD" => (current, is_bit) = (value, kind == "BOOL"),
                "LDN" => (current, is_bit) = (1 - value, true),
                "NOT" => current = if is_bit { 1 - current } else { !current },
                "INT_TO_WORD" => current &= 0xFFFF,
                "WORD_TO_INT" => current = i64::from(current as i16),
                "DINT_TO_DWORD" => current &= 0xFFFF_FFFF,
                "DWORD_TO_DINT" => current = i64::from(current as i32),
                "INT_TO_DINT" => current = i64::from(current as i16),
                "ST" => self.write(operand, current, &types),
                "STN" => self.write(operand, 1 - current, &types),
                "S" | "R" => {
                    if current == 1 {
                        self.write(operand, i64::from(word == "S"), &types);
                    }
                }
                "CAL" => {
                    let [clk, memory] = ["CLK", "M"].map(|member| format!("{operand}.{member}"));
                    let clk = self.values.get(&clk).copied().unwrap_or(0);
                    let before = self.values.insert(memory, clk).unwrap_or(0);
                    self.values.insert(format!("{operand}.Q"), i64::from(clk > before));
                }
                "JMPCN" => {
                    if current == 0 {
                        at = lines.iter().position(|line| line[0] == label).unwrap();
                    }
                }
                own if own.ends_with(':') => {}
                operator => {
                    let compares = ["GT", "GE", "EQ", "NE", "LE", "LT"].contains(&operator);
                    current = combine(operator, current, value);
                    is_bit |= compares;
                }
            }
        }
        assert!(stack.is_empty());
    }

    fn read(&self, word: &str, types: &BTreeMap<String, String>) -> (i64, String) {
        let digits = word.rsplit('#').next().unwrap_or(word);
        if word.contains("16#") {
            return (i64::from_str_radix(digits, 16).unwrap(), "WORD".into());
        }
        match (word, digits.parse()) {
            ("TRUE", _) => (1, "BOOL".into()),
            ("FALSE", _) => (0, "BOOL".into()),
            (_, Ok(number)) => (number, "INT".into()),
            _ => {
                let kind = types.get(word).cloned().unwrap_or_else(|| "BOOL".into());
                (self.values.get(word).copied().unwrap_or(0), kind)
            }
        }
    }

    fn write(&mut self, name: &str, value: i64, types: &BTreeMap<String, String>) {
        let value = match types.get(name).map(String::as_str) {
            Some("INT") => i64::from(value as i16),
            Some("DINT") => i64::from(value as i32),
            Some("WORD") => value & 0xFFFF,
            _ => value,
        };
        self.values.insert(name.to_string(), value);
    }
}
