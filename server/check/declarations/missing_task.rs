//! # missing-task
//!
//! A program of a configuration is connected to no task, although there are tasks. By the standard it then runs with
//! the lowest priority, again and again whenever nothing else has to run: not with the period that its timers and
//! filters may have been designed for. With no task at all that is the usual cyclic program and nothing is said.
//!
//! A task that a program names and that is not declared is reported too.
//!
//! ```iec
//! PROGRAM Cutter
//! VAR
//!     Blade AT %QX0.0 : BOOL;
//! END_VAR
//!     LD TRUE
//!     ST Blade
//! END_PROGRAM
//!
//! CONFIGURATION Line
//!     TASK Fast(INTERVAL := T#10ms, PRIORITY := 1);
//!     PROGRAM First : Cutter;
//!             ^^^^^
//!     PROGRAM Second WITH Slow : Cutter;
//!                         ^^^^
//! END_CONFIGURATION
//! ```
//!
//! ```iec
//! PROGRAM Cutter
//! VAR
//!     Blade AT %QX0.0 : BOOL;
//! END_VAR
//!     LD TRUE
//!     ST Blade
//! END_PROGRAM
//!
//! CONFIGURATION Line
//!     TASK Fast(INTERVAL := T#10ms, PRIORITY := 1);
//!     PROGRAM First WITH Fast : Cutter;
//! END_CONFIGURATION
//! ```

use crate::check::iec::{View, views};
use crate::check::{ProgramContext, Rule, Run};
use crate::il::iec::{Instance, ItemKind};
use crate::text::{Diagnostic, Message, Severity, Span, TextEdit};

pub(super) const RULE: Rule = Rule {
    code: "missing-task",
    severity: Severity::Warning,
    run: Run::Program(check),
    source: include_str!("missing_task.rs"),
};

/// More tasks than this are not offered.
const MOST_FIXES: usize = 3;

fn check(context: &ProgramContext<'_>, found: &mut Vec<Diagnostic>) {
    for (start, view) in views(context) {
        let mut tasks: Vec<Span> = Vec::new();
        let mut instances: Vec<Instance> = Vec::new();
        for item in &view.tree.items {
            match item.kind {
                ItemKind::Configuration { .. } | ItemKind::Resource { .. } | ItemKind::End(_) => {
                    judge(&view, start, &tasks, &instances, found);
                    tasks.clear();
                    instances.clear();
                }
                ItemKind::Task(index) => {
                    tasks.extend(view.tree.tasks.get(index as usize).and_then(|task| task.name));
                }
                ItemKind::Instance(index) => instances.extend(view.tree.instances.get(index as usize)),
                _ => {}
            }
        }
        judge(&view, start, &tasks, &instances, found);
    }
}

fn judge(view: &View<'_>, start: usize, tasks: &[Span], instances: &[Instance], found: &mut Vec<Diagnostic>) {
    for instance in instances {
        let Some(name) = instance.name else { continue };
        match instance.task {
            Some(task) => {
                let word = task.of(view.text);
                if !tasks.iter().any(|own| own.of(view.text).eq_ignore_ascii_case(word)) {
                    let message = Message::new("missing-task.undeclared").with("task", word);
                    let mut diagnostic = Diagnostic::new(RULE.code, task.shifted(start), message);
                    for own in tasks.iter().take(MOST_FIXES) {
                        let title = Message::new("missing-task.run").with("task", own.of(view.text));
                        let edit = TextEdit::new(task.shifted(start), own.of(view.text));
                        diagnostic = diagnostic.fix(title, vec![edit]);
                    }
                    found.push(diagnostic);
                }
            }
            None if !tasks.is_empty() => {
                let message = Message::new("missing-task.found").with("name", name.of(view.text));
                let mut diagnostic = Diagnostic::new(RULE.code, name.shifted(start), message);
                for own in tasks.iter().take(MOST_FIXES) {
                    let word = own.of(view.text);
                    let at = Span::at(start + name.end as usize);
                    let title = Message::new("missing-task.run").with("task", word);
                    diagnostic = diagnostic.fix(title, vec![TextEdit::new(at, format!(" WITH {word}"))]);
                }
                found.push(diagnostic);
            }
            None => {}
        }
    }
}
