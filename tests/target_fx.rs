//! The FX family as data: devices, operand words, forms, steps, opcodes and pages.

#![allow(clippy::unwrap_used, clippy::panic)]

use proptest::prelude::*;
use rungwise::target::{
    Access, Constant, Device, DeviceKind, Form, Instruction, Model, Opcode, Operand, Target, Wide,
    instructions,
};
use std::collections::HashMap;

const FX: [Model; 4] = [Model::Fx1s, Model::Fx1n, Model::Fx2n, Model::Fx3u];

fn read(word: &str) -> Operand {
    Operand::read(word, Model::Fx2n)
}

fn device(word: &str) -> Device {
    read(word).device().unwrap_or_else(|| panic!("{word} is no device"))
}

#[test]
fn every_device_of_every_model_is_read_as_it_is_shown() {
    for model in FX {
        let target = Target::of(model);
        for range in target.devices {
            for number in range.first..=range.last {
                let device = Device::new(range.kind, number);
                assert_eq!(Operand::read(&device.to_string(), model), Operand::Device(device));
                assert_eq!(device.range_on(target), Some(range), "{device} lies in one range only");
            }
        }
    }
}

#[test]
fn ranges_are_in_reading_order_and_end_where_they_should() {
    for (model, kind, numbers) in [
        (Model::Fx1s, DeviceKind::X, "0-15"),
        (Model::Fx1s, DeviceKind::Y, "0-13"),
        (Model::Fx1s, DeviceKind::M, "0-511 8000-8255"),
        (Model::Fx1s, DeviceKind::S, "0-127"),
        (Model::Fx1s, DeviceKind::T, "0-63"),
        (Model::Fx1s, DeviceKind::C, "0-31 235-255"),
        (Model::Fx1s, DeviceKind::D, "0-255 1000-2499 8000-8255"),
        (Model::Fx1s, DeviceKind::P, "0-63"),
        (Model::Fx1n, DeviceKind::X, "0-127"),
        (Model::Fx1n, DeviceKind::M, "0-1535 8000-8255"),
        (Model::Fx1n, DeviceKind::S, "0-999"),
        (Model::Fx1n, DeviceKind::T, "0-255"),
        (Model::Fx1n, DeviceKind::C, "0-255"),
        (Model::Fx1n, DeviceKind::D, "0-7999 8000-8255"),
        (Model::Fx2n, DeviceKind::Y, "0-255"),
        (Model::Fx2n, DeviceKind::M, "0-3071 8000-8255"),
        (Model::Fx2n, DeviceKind::S, "0-999"),
        (Model::Fx2n, DeviceKind::T, "0-255"),
        (Model::Fx2n, DeviceKind::C, "0-255"),
        (Model::Fx2n, DeviceKind::D, "0-7999 8000-8255"),
        (Model::Fx2n, DeviceKind::R, ""),
        (Model::Fx2n, DeviceKind::V, "0-7"),
        (Model::Fx2n, DeviceKind::P, "0-127"),
        (Model::Fx2n, DeviceKind::N, "0-7"),
        (Model::Fx3u, DeviceKind::X, "0-247"),
        (Model::Fx3u, DeviceKind::M, "0-7679 8000-8511"),
        (Model::Fx3u, DeviceKind::S, "0-4095"),
        (Model::Fx3u, DeviceKind::T, "0-511"),
        (Model::Fx3u, DeviceKind::D, "0-7999 8000-8511"),
        (Model::Fx3u, DeviceKind::R, "0-32767"),
        (Model::Fx3u, DeviceKind::P, "0-4095"),
    ] {
        let target = Target::of(model);
        let exists = |number: u32| Device::new(kind, number).range_on(target).is_some();
        let special = matches!(kind, DeviceKind::M | DeviceKind::D);
        let mut runs: Vec<(u32, u32)> = Vec::new();
        for number in (0..40_000).filter(|&number| exists(number)) {
            match runs.last_mut() {
                // The special devices follow the registers without a gap, but are a run of their own.
                Some((_, last)) if *last + 1 == number && !(special && number == 8000) => *last = number,
                _ => runs.push((number, number)),
            }
        }
        let shown: Vec<String> = runs.iter().map(|(first, last)| format!("{first}-{last}")).collect();
        assert_eq!(shown.join(" "), numbers, "{model:?} {kind:?}");
    }
    for model in FX {
        let places: Vec<(DeviceKind, u32)> =
            Target::of(model).devices.iter().map(|range| (range.kind, range.first)).collect();
        let order = |kind| DeviceKind::ALL.iter().position(|&other| other == kind);
        assert!(places.windows(2).all(|pair| order(pair[0].0) <= order(pair[1].0)), "{model:?}");
    }
}

#[test]
fn purposes_of_some_devices() {
    for (model, word, purpose, latched, unit_ms, bits) in [
        (Model::Fx2n, "M499", "general relay", false, 0, 1),
        (Model::Fx2n, "M500", "latched relay", true, 0, 1),
        (Model::Fx2n, "S9", "initial state", false, 0, 1),
        (Model::Fx2n, "S900", "annunciator", true, 0, 1),
        (Model::Fx2n, "T199", "100 ms timer for subroutines and interrupts", false, 100, 16),
        (Model::Fx2n, "T200", "10 ms timer", false, 10, 16),
        (Model::Fx2n, "T249", "1 ms retentive timer", true, 1, 16),
        (Model::Fx2n, "T250", "100 ms retentive timer", true, 100, 16),
        (Model::Fx3u, "T256", "1 ms timer", false, 1, 16),
        (Model::Fx1s, "T63", "1 ms timer", false, 1, 16),
        (Model::Fx2n, "C100", "latched 16-bit up counter", true, 0, 16),
        (Model::Fx2n, "C200", "32-bit up/down counter", false, 0, 32),
        (Model::Fx2n, "C251", "high-speed counter, A and B phase", true, 0, 32),
        (Model::Fx2n, "D200", "latched register", true, 0, 16),
        (Model::Fx2n, "P63", "pointer to END", false, 0, 1),
        (Model::Fx2n, "I001", "interrupt from X0", false, 0, 1),
    ] {
        let range = device(word).range_on(Target::of(model)).unwrap();
        let found = (range.purpose, range.latched, range.timer_unit_ms, range.bits);
        assert_eq!(found, (purpose, latched, unit_ms, bits), "{model:?} {word}");
    }
    let fx2n = Target::of(Model::Fx2n);
    assert_eq!(device("X7").next_in_range(fx2n), Some(device("X10")));
    assert_eq!(device("M499").next_in_range(fx2n), None);
    assert_eq!(device("D9000").next_in_range(fx2n), None);
}

#[test]
fn special_devices_are_sorted_found_and_exist() {
    for model in FX {
        let target = Target::of(model);
        assert!(
            target.special.windows(2).all(|pair| pair[0].device < pair[1].device),
            "{model:?} is not sorted"
        );
        assert!(target.special.len() > 100);
        for special in target.special {
            assert_eq!(special.device.special_on(target), Some(special));
            assert!(special.device.range_on(target).is_some(), "{model:?} {}", special.device);
            assert!(!special.meaning.is_empty() && !special.meaning.ends_with('.'));
        }
    }
    let meaning = |word, model| device(word).special_on(Target::of(model)).map(|special| special.meaning);
    assert_eq!(meaning("M8002", Model::Fx1s), Some("On in the first scan after the CPU starts to run"));
    assert_eq!(meaning("M8028", Model::Fx1s), Some("Makes T32 to T62 count in 10 ms steps"));
    assert_eq!(meaning("M8028", Model::Fx2n), Some("Lets interrupts come while FROM and TO run"));
    assert_eq!(meaning("M8199", Model::Fx1n), None);
    assert_eq!(meaning("D8182", Model::Fx2n), Some("Content of Z1"));
    assert_eq!(meaning("D8195", Model::Fx2n), Some("Content of V7"));
    assert_eq!(meaning("M0", Model::Fx2n), None);
}

#[test]
fn every_form_is_found_and_no_two_collide() {
    let mut seen: HashMap<String, &str> = HashMap::new();
    for instruction in instructions::all() {
        for form in instructions::forms_of(instruction) {
            let name = form.mnemonic();
            assert_eq!(seen.insert(name.clone(), instruction.mnemonic), None, "{name} has two meanings");
            assert_eq!(Form::named(&name), Some(form));
            assert_eq!(Form::named(&name.to_lowercase()), Some(form));
        }
    }
    for (alias, name) in [("dwand", "DAND"), ("DWORP", "DORP"), ("DWXOR", "DXOR")] {
        assert_eq!(Form::named(alias).map(Form::mnemonic).as_deref(), Some(name));
    }
    for word in ["", "WANDER", "LDDD", "MOVPP", "P0", "DEND", "ÄÖÜ", "LD\0", "AVERYVERYLONGWORDTHATISNONE"]
    {
        assert_eq!(Form::named(word), None, "{word}");
    }
    let forms = instructions::forms_on(Model::Fx1s).count();
    assert!(forms > 80 && forms < instructions::forms_on(Model::Fx2n).count());
}

#[test]
fn function_numbers_and_forms() {
    // Number, name, D and P as the manual's list of applied instructions has them.
    let list = "0 CJ P/1 CALL P/2 SRET/3 IRET/4 EI/5 DI/6 FEND/7 WDT P/8 FOR/9 NEXT/10 CMP DP/11 ZCP DP/12 MOV DP/\
                13 SMOV P/14 CML DP/15 BMOV P/16 FMOV DP/17 XCH DP/18 BCD DP/19 BIN DP/20 ADD DP/21 SUB DP/\
                22 MUL DP/23 DIV DP/24 INC DP/25 DEC DP/26 WAND DP/27 WOR DP/28 WXOR DP/29 NEG DP/30 ROR DP/\
                31 ROL DP/32 RCR DP/33 RCL DP/34 SFTR P/35 SFTL P/36 WSFR P/37 WSFL P/38 SFWR P/39 SFRD P/\
                40 ZRST P/41 DECO P/42 ENCO P/43 SUM DP/44 BON DP/45 MEAN DP/46 ANS/47 ANR P/48 SQR DP/49 FLT DP";
    for entry in list.split('/') {
        let mut words = entry.split(' ');
        let number: u16 = words.next().unwrap().parse().unwrap();
        let form = Form::named(words.next().unwrap()).unwrap_or_else(|| panic!("{entry}"));
        let marks = words.next().unwrap_or("");
        assert_eq!(form.instruction.opcode, Opcode::Function(number), "{entry}");
        assert_eq!(form.instruction.wide == Wide::Yes, marks.contains('D'), "{entry}");
        assert_eq!(form.instruction.pulse, marks.contains('P'), "{entry}");
    }
}

#[test]
fn codes_of_basic_instructions() {
    let contact = |class, extended| Opcode::Contact { class, extended };
    for (name, opcode) in [
        ("LD", contact(2, 0x01C2)),
        ("LDI", contact(3, 0x01C3)),
        ("AND", contact(4, 0x01C4)),
        ("ANI", contact(5, 0x01C5)),
        ("OR", contact(6, 0x01C6)),
        ("ORI", contact(7, 0x01C7)),
        ("LDP", Opcode::Device(0x01CA)),
        ("LDF", Opcode::Device(0x01CB)),
        ("ANDP", Opcode::Device(0x01CC)),
        ("ANDF", Opcode::Device(0x01CD)),
        ("ORP", Opcode::Device(0x01CE)),
        ("ORF", Opcode::Device(0x01CF)),
        ("ANB", Opcode::Word(0xFFF8)),
        ("ORB", Opcode::Word(0xFFF9)),
        ("MPS", Opcode::Word(0xFFFA)),
        ("MRD", Opcode::Word(0xFFFB)),
        ("MPP", Opcode::Word(0xFFFC)),
        ("INV", Opcode::Word(0xFFFD)),
        ("PLS", Opcode::Device(0x0008)),
        ("PLF", Opcode::Device(0x0009)),
        ("MC", Opcode::Device(0x000A)),
        ("MCR", Opcode::Device(0x000B)),
        ("STL", contact(15, 0)),
        ("RET", Opcode::Word(0xF7FF)),
        ("END", Opcode::Word(0x000F)),
        ("NOP", Opcode::Word(0xFFFF)),
    ] {
        assert_eq!(Form::named(name).unwrap().instruction.opcode, opcode, "{name}");
    }
    assert_eq!(instructions::LABEL.opcode, Opcode::Label);
}

fn steps(line: &str) -> u32 {
    let mut words = line.split(' ');
    let form = Form::named(words.next().unwrap()).unwrap_or_else(|| panic!("{line}"));
    form.steps(&words.map(read).collect::<Vec<_>>())
}

#[test]
fn steps_are_the_words_of_the_program_memory() {
    for (expected, lines) in [
        (
            1,
            "LD X2/LDI X3/AND M20/ANI M503/OR M22/OUT Y0/SET Y1/RST Y0/LD M8002/LD T0/LD S0/LD M1535/OUT M0/END/\
             FEND/NOP/RET/SRET/IRET/EI/DI/WDT/NEXT/STL S12/ANB/ORB/MPS/MRD/MPP/INV/OUT/ANR",
        ),
        (
            2,
            "OUT M8047/SET S0/RST S13/OUT S10/PLS M21/PLF M1/RST C0/RST T250/LDP X0/ORF M0/LD M1536/OR M3071/\
             OUT M1536/SET M8034/MCR N0/LD M8256/LD S1024",
        ),
        (
            3,
            "OUT T1 K15/OUT T198 D980/OUT C2 K1/OUT T0/RST D230/RST Z0/MC N0 M0/CALL P32/CJ P0/FOR K4/INC D0/LD D0.3",
        ),
        (5, "OUT C200 K10/OUT C255 D0/MOV K1 D0/ZRST S2 S40/ZRST M0 M3071/DINC D0/CML D0 D1"),
        (7, "ADDP D230 K1 D230/CMP K5 K3 M0/MUL T198 K100 D984/BMOV D0 D1 K2/ANS T0 K1 S900"),
        (9, "DMOV K999 D2000/SFTL M1523 S10 K9 K1/ZCP K1 K2 D0 M0/DCML D0 D2"),
        (11, "SMOV D0 K1 K1 D1 K1"),
        (13, "DCMP D0 D2 M0/DADDP D0 D2 D4/DAND D0 D2 D4"),
        (17, "DZCP D0 D2 D4 M0"),
    ] {
        for line in lines.split('/') {
            assert_eq!(steps(line), expected, "{line}");
        }
    }
    let label = Form { instruction: &instructions::LABEL, wide: false, pulse: false };
    assert_eq!(label.steps(&[read("P32")]), 1);
}

#[test]
fn operands_that_are_taken() {
    for (model, taken, line) in [
        (Model::Fx2n, true, "LD X0"),
        (Model::Fx2n, false, "LD D0"),
        (Model::Fx2n, false, "LD D0.3"),
        (Model::Fx3u, true, "LD D0.3"),
        (Model::Fx2n, false, "LD M0Z0"),
        (Model::Fx3u, true, "LD M0Z0"),
        (Model::Fx2n, false, "OUT X0"),
        (Model::Fx2n, true, "OUT T0"),
        (Model::Fx2n, false, "OUT D0"),
        (Model::Fx2n, false, "SET T0"),
        (Model::Fx2n, true, "RST T0"),
        (Model::Fx2n, true, "RST Z3"),
        (Model::Fx2n, false, "PLS S0"),
        (Model::Fx2n, true, "STL S0"),
        (Model::Fx2n, false, "STL M0"),
        (Model::Fx2n, true, "MOV D0Z1"),
        (Model::Fx2n, true, "MOV K4X0"),
        (Model::Fx2n, false, "MOV X0"),
        (Model::Fx2n, false, "MOV R0"),
        (Model::Fx3u, true, "MOV R0"),
        (Model::Fx2n, false, "INC K1"),
        (Model::Fx2n, false, "INC K4X0"),
        (Model::Fx2n, false, "END X0"),
    ] {
        let (name, operand) = line.split_once(' ').unwrap();
        let form = Form::named(name).unwrap();
        assert_eq!(form.takes(0, &Operand::read(operand, model), model), taken, "{model:?} {line}");
    }
}

#[test]
fn constants_that_fit() {
    for (fits, place, line) in [
        (true, 0, "MOV K32767 D0"),
        (true, 0, "MOV K-32768 D0"),
        (false, 0, "MOV K32768 D0"),
        (false, 0, "MOV K-32769 D0"),
        (true, 0, "MOV HFFFF D0"),
        (false, 0, "MOV H10000 D0"),
        (true, 0, "DMOV K2147483647 D0"),
        (false, 0, "DMOV K2147483648 D0"),
        (true, 0, "DMOV HFFFFFFFF D0"),
        (false, 0, "DMOV H100000000 D0"),
        (true, 1, "OUT T0 K32767"),
        (false, 1, "OUT T0 K32768"),
        (false, 1, "OUT T0 K-1"),
        (false, 1, "OUT T0 HFFFF"),
        (true, 1, "OUT C199 K1"),
        (false, 1, "OUT C199 K0"),
        (true, 1, "OUT C200 K-5"),
        (false, 1, "OUT C200 K2147483648"),
        (true, 2, "BMOV D0 D1 K512"),
        (false, 2, "BMOV D0 D1 K513"),
        (false, 2, "BMOV D0 D1 K0"),
        (true, 1, "ROR D0 K16"),
        (false, 1, "ROR D0 K17"),
        (true, 1, "DROR D0 K32"),
        (false, 1, "DROR D0 K33"),
    ] {
        let mut words = line.split(' ');
        let form = Form::named(words.next().unwrap()).unwrap();
        let operands: Vec<Operand> = words.map(read).collect();
        let Operand::Constant { value, .. } = operands[place] else { panic!("{line}") };
        assert_eq!(form.constant_fits(place, value, &operands), fits, "{line}");
    }
    let mov = Form::named("MOV").unwrap();
    assert!(mov.constant_fits(0, Constant::Real(1e30), &[]));
}

#[test]
fn pages_are_one_paragraph_and_a_program() {
    let rows = instructions::all().chain([&instructions::LABEL, &instructions::UNREAD]);
    let problems: Vec<String> = rows
        .filter_map(|row| check_page(row).err().map(|problem| format!("{}: {problem}", row.mnemonic)))
        .collect();
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

fn check_page(row: &Instruction) -> Result<(), String> {
    let (paragraph, rest) = row.page.split_once("\n\n```il\n").ok_or("no il fence")?;
    if paragraph.contains("\n\n") || !paragraph.ends_with('.') || paragraph.len() < 80 {
        return Err(format!("not one paragraph: {paragraph}"));
    }
    let program = rest.strip_suffix("```\n").ok_or("something after the fence")?;
    if !program.ends_with("\nEND\n") || program.contains("```") {
        return Err("not one program with END".to_string());
    }
    let mut forms = program.lines().filter_map(|line| Form::named(line.split(' ').next()?));
    if row.opcode != Opcode::Label && !forms.any(|form| form.instruction.mnemonic == row.mnemonic) {
        return Err("the example does not show it".to_string());
    }
    if row.models.is_empty() || row.title.is_empty() {
        return Err("no model or no title".to_string());
    }
    row.models.iter().try_for_each(|&model| {
        check_program(program, model).map_err(|problem| format!("{model:?}: {problem}"))
    })
}

/// A plain reading of a small program, stricter than a PLC: words, operands, devices, limits, order of blocks.
fn check_program(program: &str, model: Model) -> Result<(), String> {
    let target = Target::of(model);
    let mut balance: HashMap<&str, i32> = HashMap::new();
    let mut coils: Vec<Device> = Vec::new();
    let mut labels: Vec<Device> = Vec::new();
    let mut calls: Vec<Device> = Vec::new();
    let mut in_step = false;
    for line in program.lines() {
        let mut words = line.split(' ');
        let word = words.next().unwrap_or_default();
        let operands: Vec<Operand> = words.map(|word| Operand::read(word, model)).collect();
        if let Operand::Device(label) = Operand::read(word, model)
            && matches!(label.kind, DeviceKind::P | DeviceKind::I)
        {
            labels.push(label);
            label.range_on(target).ok_or(format!("{line}: no such label"))?;
            continue;
        }
        check_instruction(line, word, &operands, model)?;
        if word == "OUT" && !in_step {
            let coil = operands[0].device().ok_or("no coil")?;
            if coils.contains(&coil) {
                return Err(format!("{line}: double coil"));
            }
            coils.push(coil);
        }
        let (group, change) = match word {
            "MPS" => ("MPS", 1),
            "MPP" => ("MPS", -1),
            "FOR" => ("FOR", 1),
            "NEXT" => ("FOR", -1),
            "MC" => ("MC", 1),
            "MCR" => ("MC", -1),
            _ => ("", 0),
        };
        let open = balance.entry(group).or_default();
        *open += change;
        if *open < 0 {
            return Err(format!("{line}: closes nothing"));
        }
        in_step = match word {
            "STL" => true,
            "RET" => false,
            _ => in_step,
        };
        if matches!(word, "CJ" | "CALL") {
            calls.extend(operands[0].device());
        }
    }
    let subroutines = program.lines().filter(|line| matches!(*line, "SRET" | "IRET")).count();
    let entered = labels.iter().filter(|label| label.kind == DeviceKind::I).count()
        + program.lines().filter(|line| line.starts_with("CALL ")).count();
    if in_step || balance.values().any(|&open| open != 0) || subroutines != entered {
        return Err("something is left open".to_string());
    }
    match calls.iter().find(|call| !labels.contains(call)) {
        Some(call) => Err(format!("{call} is not defined")),
        None => Ok(()),
    }
}

fn check_instruction(line: &str, word: &str, operands: &[Operand], model: Model) -> Result<(), String> {
    let form = Form::named(word).ok_or(format!("{line}: unknown"))?;
    let specs = form.instruction.operands;
    let first = operands.first().and_then(Operand::device);
    let timed = word == "OUT" && first.is_some_and(|d| matches!(d.kind, DeviceKind::T | DeviceKind::C));
    let needed = specs.iter().filter(|spec| !spec.optional || timed).count();
    if !form.is_on(model) || operands.len() != needed {
        return Err(format!("{line}: not on the model, or the wrong number of operands"));
    }
    for (place, operand) in operands.iter().enumerate() {
        let fits = match *operand {
            Operand::Constant { value, .. } => form.constant_fits(place, value, operands),
            Operand::Invalid(_) => false,
            _ => true,
        };
        let exists = operand.device().is_none_or(|device| device.range_on(Target::of(model)).is_some());
        let input = operand.device().is_some_and(|device| device.kind == DeviceKind::X);
        let written = specs[place].access != Access::Read;
        if !fits || !exists || (input && written) || !form.takes(place, operand, model) {
            return Err(format!("{line}: operand {place}"));
        }
    }
    Ok(())
}

#[test]
fn the_reading_of_pages_finds_mistakes() {
    for wrong in [
        "LD X8\nOUT Y0\nEND\n",
        "LD X0\nOUT T0\nEND\n",
        "LD X0\nOUT X1\nEND\n",
        "LD X0\nOUT Y0\nOUT Y0\nEND\n",
        "LD X0\nMPS\nOUT Y0\nEND\n",
        "LD X0\nMPP\nOUT Y0\nEND\n",
        "LD X0\nCJ P0\nEND\n",
        "LD X0\nMOV K40000 D0\nEND\n",
        "LD X0\nMOV K1 D9000\nEND\n",
        "STL S0\nOUT Y0\nEND\n",
        "LD X0\nMOVE K1 D0\nEND\n",
        "LD X0\nMEP\nOUT Y0\nEND\n",
    ] {
        assert!(check_program(wrong, Model::Fx2n).is_err(), "{wrong}");
    }
}

proptest! {
    #[test]
    fn no_word_makes_the_readers_panic(word in "\\PC{0,24}") {
        for target in Target::ALL {
            let _ = Operand::read(&word, target.model);
        }
        let _ = Form::named(&word);
        let _ = instructions::suggestions(&word, Model::Fx3u);
    }

    #[test]
    fn nor_does_a_word_of_likely_letters(word in "[KHEXYMSTCDVZPIN0-9.+\\-\"éß]{0,24}") {
        let operand = read(&word);
        if let Operand::Device(device) = operand && device.number < u32::MAX {
            prop_assert_eq!(read(&device.to_string()), operand);
        }
        if let Some(form) = Form::named(&word) {
            let _ = (form.steps(&[operand, operand]), form.constant_limits(1, &[operand]));
        }
    }
}
