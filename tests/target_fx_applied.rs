//! The rows of the applied instructions FNC 50 to 246: which there are, their forms, and that their pages are usable.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use rungwise::target::{
    Accepts, Access, Constant, DeviceKind, Form, Instruction, Model, Opcode, Operand, Role, Target, Wide,
    instructions,
};
use std::collections::BTreeSet;

use Wide::{No, Only, Yes};

/// Function number, plain mnemonic, 32-bit form, pulse form, number of operands.
const EXPECTED: &[(u16, &str, Wide, bool, usize)] = &[
    (50, "REF", No, true, 2),
    (51, "REFF", No, true, 1),
    (52, "MTR", No, false, 4),
    (53, "HSCS", Only, false, 3),
    (54, "HSCR", Only, false, 3),
    (55, "HSZ", Only, false, 4),
    (56, "SPD", Yes, false, 3),
    (57, "PLSY", Yes, false, 3),
    (58, "PWM", No, false, 3),
    (59, "PLSR", Yes, false, 4),
    (60, "IST", No, false, 3),
    (61, "SER", Yes, true, 4),
    (62, "ABSD", Yes, false, 4),
    (63, "INCD", No, false, 4),
    (64, "TTMR", No, false, 2),
    (65, "STMR", No, false, 3),
    (66, "ALT", No, true, 1),
    (67, "RAMP", No, false, 4),
    (68, "ROTC", No, false, 4),
    (69, "SORT", No, false, 5),
    (70, "TKY", Yes, false, 3),
    (71, "HKY", Yes, false, 4),
    (72, "DSW", No, false, 4),
    (73, "SEGD", No, true, 2),
    (74, "SEGL", No, false, 3),
    (75, "ARWS", No, false, 4),
    (76, "ASC", No, false, 2),
    (77, "PR", No, false, 2),
    (78, "FROM", Yes, true, 4),
    (79, "TO", Yes, true, 4),
    (80, "RS", No, false, 4),
    (81, "PRUN", Yes, true, 2),
    (82, "ASCI", No, true, 3),
    (83, "HEX", No, true, 3),
    (84, "CCD", No, true, 3),
    (85, "VRRD", No, true, 2),
    (86, "VRSC", No, true, 2),
    (88, "PID", No, false, 4),
    (110, "ECMP", Only, true, 3),
    (111, "EZCP", Only, true, 4),
    (118, "EBCD", Only, true, 2),
    (119, "EBIN", Only, true, 2),
    (120, "EADD", Only, true, 3),
    (121, "ESUB", Only, true, 3),
    (122, "EMUL", Only, true, 3),
    (123, "EDIV", Only, true, 3),
    (127, "ESQR", Only, true, 2),
    (129, "INT", Yes, true, 2),
    (130, "SIN", Only, true, 2),
    (131, "COS", Only, true, 2),
    (132, "TAN", Only, true, 2),
    (147, "SWAP", Yes, true, 1),
    (155, "ABS", Only, false, 3),
    (156, "ZRN", Yes, false, 4),
    (157, "PLSV", Yes, false, 3),
    (158, "DRVI", Yes, false, 4),
    (159, "DRVA", Yes, false, 4),
    (160, "TCMP", No, true, 5),
    (161, "TZCP", No, true, 4),
    (162, "TADD", No, true, 3),
    (163, "TSUB", No, true, 3),
    (166, "TRD", No, true, 1),
    (167, "TWR", No, true, 1),
    (169, "HOUR", Yes, false, 3),
    (170, "GRY", Yes, true, 2),
    (171, "GBIN", Yes, true, 2),
    (176, "RD3A", No, true, 3),
    (177, "WR3A", No, true, 3),
    (224, "LD=", Yes, false, 2),
    (225, "LD>", Yes, false, 2),
    (226, "LD<", Yes, false, 2),
    (228, "LD<>", Yes, false, 2),
    (229, "LD<=", Yes, false, 2),
    (230, "LD>=", Yes, false, 2),
    (232, "AND=", Yes, false, 2),
    (233, "AND>", Yes, false, 2),
    (234, "AND<", Yes, false, 2),
    (236, "AND<>", Yes, false, 2),
    (237, "AND<=", Yes, false, 2),
    (238, "AND>=", Yes, false, 2),
    (240, "OR=", Yes, false, 2),
    (241, "OR>", Yes, false, 2),
    (242, "OR<", Yes, false, 2),
    (244, "OR<>", Yes, false, 2),
    (245, "OR<=", Yes, false, 2),
    (246, "OR>=", Yes, false, 2),
];

fn function(row: &Instruction) -> Option<u16> {
    match row.opcode {
        Opcode::Function(number) if number >= 50 => Some(number),
        _ => None,
    }
}

fn rows() -> impl Iterator<Item = &'static Instruction> {
    instructions::all().filter(|row| function(row).is_some())
}

fn form(mnemonic: &str) -> Form {
    Form::named(mnemonic).unwrap_or_else(|| panic!("there is no {mnemonic}"))
}

/// The lines of the example between the fences.
fn example(row: &Instruction) -> Vec<&'static str> {
    let (_, example) = row.page.split_once("```il\n").expect("a fence opens");
    let (example, _) = example.split_once("```\n").expect("the fence closes");
    example.lines().collect()
}

#[test]
fn every_function_has_its_row_once_in_order() {
    let found: Vec<_> = rows()
        .map(|row| (function(row).unwrap(), row.mnemonic, row.wide, row.pulse, row.operands.len()))
        .collect();
    assert_eq!(found, EXPECTED);
}

#[test]
fn forms_are_spelled_as_the_manual_does() {
    for name in [
        "DHSCS", "deaddp", "LDD=", "ANDD>=", "ORD<>", "INT", "DINTP", "FROMP", "DTOP", "SWAPP", "DABS",
        "DDRVI",
    ] {
        assert_eq!(form(name).mnemonic(), name.to_ascii_uppercase());
    }
    for name in ["HSCS", "EADD", "ABS", "DLD=", "LD=P", "PWMP", "DPWM", "DSINPP"] {
        assert_eq!(Form::named(name), None, "{name}");
    }
}

#[test]
fn steps_agree_with_program_memory() {
    let expected = [
        ("PID", 9),
        ("ASC", 11),
        ("LD=", 5),
        ("LDD=", 9),
        ("AND>=", 5),
        ("TRD", 3),
        ("FROM", 9),
        ("DFROM", 17),
        ("DHSZ", 17),
        ("DHSCS", 13),
        ("DEADD", 13),
        ("DSIN", 9),
        ("INT", 5),
        ("ALT", 3),
        ("MTR", 9),
        ("SORT", 11),
        ("TCMP", 11),
    ];
    for (name, steps) in expected {
        assert_eq!(form(name).steps(&[]), steps, "{name}");
    }
}

#[test]
fn compare_contacts_stand_where_contacts_do() {
    for row in rows() {
        let expected = match function(row).unwrap() {
            224..=230 => Role::Load,
            232..=238 => Role::Series,
            240..=246 => Role::Parallel,
            _ => Role::Output,
        };
        assert_eq!(row.role, expected, "{}", row.mnemonic);
    }
}

#[test]
fn the_small_models_have_what_their_manual_lists() {
    let missing = |model| -> Vec<u16> {
        rows().filter(|row| !row.models.contains(&model)).filter_map(function).collect()
    };
    let full = vec![155, 156, 157, 158, 159];
    assert_eq!(missing(Model::Fx3u), Vec::<u16>::new());
    assert_eq!(missing(Model::Fx2n), full);
    let floats = [110, 111, 118, 119, 120, 121, 122, 123, 127, 129, 130, 131, 132];
    let small: Vec<u16> = [51, 55, 61, 64, 65, 68, 69, 70, 71, 73, 75, 76, 77]
        .into_iter()
        .chain(floats)
        .chain([147, 170, 171])
        .collect();
    assert_eq!(missing(Model::Fx1n), small);
    let smallest: BTreeSet<u16> = small.into_iter().chain([78, 79, 176, 177]).collect();
    assert_eq!(missing(Model::Fx1s).into_iter().collect::<BTreeSet<_>>(), smallest);
}

#[test]
fn operands_are_consistent() {
    for row in rows() {
        let names: BTreeSet<_> = row.operands.iter().map(|spec| spec.name).collect();
        assert_eq!(names.len(), row.operands.len(), "{}: two operands with one name", row.mnemonic);
        for spec in row.operands {
            let place = format!("{} {}", row.mnemonic, spec.name);
            assert!(!spec.meaning.is_empty() && !spec.meaning.ends_with('.'), "{place}");
            let written = spec.access != Access::Read;
            assert!(!written || !spec.accepts.contains(Accepts::K), "{place} writes to a constant");
            assert!(!written || !spec.accepts.contains(Accepts::X), "{place} writes to an input");
            if let Some((least, most)) = spec.range {
                assert!(least < most && spec.accepts.contains(Accepts::K), "{place}");
            }
            assert!(spec.accepts != Accepts::NONE && spec.count > 0 && !spec.optional, "{place}");
        }
    }
}

#[test]
fn limits_of_constants_hold() {
    let fits = |name, place, value| form(name).constant_fits(place, Constant::Decimal(value), &[]);
    for (name, place, least, most) in [
        ("FROM", 0, 0, 7),
        ("TO", 1, 0, 32_767),
        ("SER", 3, 1, 256),
        ("DSER", 3, 1, 128),
        ("DSW", 3, 1, 2),
        ("SEGL", 2, 0, 7),
        ("TCMP", 0, 0, 23),
        ("TCMP", 1, 0, 59),
        ("DRVI", 1, 10, 32_767),
        ("DDRVI", 1, 10, 200_000),
        ("REF", 1, 8, 256),
        ("GRY", 0, 0, 32_767),
        ("DGRY", 0, 0, 2_147_483_647),
    ] {
        assert!(fits(name, place, least) && fits(name, place, most), "{name} {place}");
        assert!(!fits(name, place, least - 1) && !fits(name, place, most + 1), "{name} {place}");
    }
}

#[test]
fn pages_are_one_paragraph_and_one_program() {
    for row in rows() {
        let name = row.mnemonic;
        let (paragraph, rest) = row.page.split_once("\n\n").expect(name);
        assert!(paragraph.len() > 150 && paragraph.ends_with('.'), "{name}: {paragraph}");
        assert!(!paragraph.contains(['\n', '\\']) && !paragraph.contains("  "), "{name}: {paragraph}");
        assert!(rest.starts_with("```il\n") && rest.ends_with("\nEND\n```\n"), "{name}: {rest}");
        assert_eq!(row.page.matches("```").count(), 2, "{name}");
        assert!(!rest.contains("\n\n"), "{name}: {rest}");
    }
}

#[test]
fn examples_use_their_instruction_with_operands_that_every_model_has() {
    for row in rows() {
        let lines = example(row);
        let uses = |line: &&str| {
            line.split(' ')
                .next()
                .and_then(Form::named)
                .is_some_and(|form| form.instruction.mnemonic == row.mnemonic)
        };
        assert!(lines.iter().any(uses), "{}: the example lacks it", row.mnemonic);
        for &model in row.models {
            for line in &lines {
                check_line(row.mnemonic, line, model);
            }
        }
    }
}

fn check_line(page: &str, line: &str, model: Model) {
    let at = format!("page {page}, {line}, {model:?}");
    let mut words = line.split(' ');
    let form = form(words.next().unwrap());
    assert!(form.is_on(model), "{at}");
    let operands: Vec<Operand> = words.map(|word| Operand::read(word, model)).collect();
    let least = form.instruction.operands.iter().filter(|spec| !spec.optional).count();
    assert!((least..=form.instruction.operands.len()).contains(&operands.len()), "{at}: operand count");
    for (place, operand) in operands.iter().enumerate() {
        assert!(!matches!(operand, Operand::Invalid(_)), "{at}: {operand:?}");
        assert!(form.takes(place, operand, model), "{at}: {operand:?}");
        if let Operand::Constant { value, .. } = operand {
            assert!(form.constant_fits(place, *value, &operands), "{at}: {operand:?}");
        }
        if let Some(mut device) = operand.device() {
            let count = match operand {
                Operand::Device(_) => u32::from(form.instruction.operands[place].count),
                _ => 1,
            };
            for _ in 0..count {
                assert!(device.range_on(Target::of(model)).is_some(), "{at}: no {device}");
                device.number += 1;
            }
        }
    }
}

#[test]
fn examples_have_a_contact_before_what_needs_one_and_drive_each_coil_once() {
    for row in rows() {
        let mut coils = BTreeSet::new();
        let mut driven = false;
        for line in example(row) {
            let (mnemonic, operands) = line.split_once(' ').unwrap_or((line, ""));
            match form(mnemonic).instruction.role {
                Role::Load | Role::StepLoad => driven = true,
                Role::Standalone => driven = false,
                _ => assert!(driven, "{}: {line} has no contact before it", row.mnemonic),
            }
            if mnemonic == "OUT" {
                let coil = operands.split(' ').next().unwrap();
                assert!(coils.insert(coil), "{}: {coil} is driven twice", row.mnemonic);
                let kind = DeviceKind::of_letter(coil.chars().next().unwrap()).unwrap();
                assert!(kind != DeviceKind::X, "{}: {line}", row.mnemonic);
            }
        }
    }
}
