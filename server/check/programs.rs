//! Which files of a project run as one program.

use super::ProgramContext;
use super::statements::is_fx_program;
use crate::document::{Document, ProjectView};
use crate::target::Flow;

/// The programs of a project, each as the numbers of its files in the order of execution.
///
/// The IEC files are one: their units, types and global variables know each other. The files for an FX are one after
/// another what the PLC executes. Where the manifest lists them they are one program; where it takes all files of the
/// folder, a file with `END` ends its program and the next file begins another.
pub fn programs(view: &ProjectView<'_>) -> Vec<Vec<usize>> {
    let mut iec = Vec::new();
    let mut programs: Vec<Vec<usize>> = vec![Vec::new()];
    for (number, member) in view.members().iter().enumerate() {
        if !is_fx_program(member.document) {
            iec.push(number);
            continue;
        }
        if let Some(program) = programs.last_mut() {
            program.push(number);
        }
        if !view.is_listed() && has_end(member.document) {
            programs.push(Vec::new());
        }
    }
    programs.push(iec);
    programs.retain(|program| !program.is_empty());
    programs
}

/// The numbers of the files that make up one program with the one that is looked at, which is among them.
pub fn program_around(view: &ProjectView<'_>) -> Vec<usize> {
    let here = view.here_number();
    if view.members().len() == 1 {
        return vec![here];
    }
    programs(view).into_iter().find(|program| program.contains(&here)).unwrap_or_else(|| vec![here])
}

fn has_end(document: &Document) -> bool {
    let context = ProgramContext::new([(0, document)], None);
    context.statements().any(|statement| statement.flow() == Some(Flow::ProgramEnd))
}
