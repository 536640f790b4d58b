//! `rungwise download`

use super::Connection;
use super::connection::{Bar, confirmed, failed};
use super::contents::{is_drawn, words_at};
use crate::cli::Outcome;
use crate::cli::colour::Colour;
use crate::cli::diff::unified;
use crate::cli::input::{caution, complain, remark, say, usable_manifest};
use crate::link::{Mode, Plan};
use crate::machine_code::decode;
use crate::project::{Backup, Origin};
use crate::text::{Language, Message};
use crate::translate::from_machine_code::drawn;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(in crate::cli) struct Arguments {
    /// A program, a project, or a backup; the current project if left out.
    file: Option<PathBuf>,
    #[command(flatten)]
    connection: Connection,
    /// Do not ask before the PLC is stopped and written.
    #[arg(long)]
    yes: bool,
    /// Start the PLC when the program is in it and was found to be right.
    #[arg(long)]
    start: bool,
    /// Show what would change, and change nothing.
    #[arg(long)]
    dry_run: bool,
    /// Write what was in the PLC before the last download.
    #[arg(long, conflicts_with = "file")]
    rollback: bool,
}

pub(in crate::cli) fn run(arguments: &Arguments, colour: Colour, language: Language) -> Outcome {
    carry_out(arguments, colour, language).unwrap_or_else(|outcome| outcome)
}

fn carry_out(arguments: &Arguments, colour: Colour, language: Language) -> Result<Outcome, Outcome> {
    let here = PathBuf::from(".");
    let beside = arguments.file.as_deref().unwrap_or(&here);
    let last = Backup::latest(beside);
    let backup = last.as_ref().filter(|_| arguments.rollback);
    let known = last.as_ref().map(|(path, _)| path.as_path());
    if let Some(path) = Backup::unreadable_behind(beside, known).filter(|_| arguments.rollback) {
        let reason = Message::new("link.unreadable-backup").with("path", path.display()).render(language);
        let help = Message::new("link.help-unreadable-backup").render(language);
        caution("unreadable-backup", &reason, &help, language);
    }
    if let Some((path, backup)) = backup {
        let told = Message::new("link.rolls-back").with("path", path.display());
        let told = told.with("time", &backup.time).with("port", &backup.port).with("model", &backup.model);
        remark(&told.render(language));
    }
    if arguments.rollback && backup.is_none() {
        let reason = Message::new("link.no-backup").render(language);
        complain("no-backup", &reason, &Message::new("link.help-backup").render(language), language);
        return Err(Outcome::Unusable);
    }
    let (words, target) = words_at(backup.map_or(beside, |(path, _)| path), language)?;
    let mut host = arguments.connection.open(beside, language)?;
    let mut bar = Bar::new(language);
    let replaced = last.as_ref().and_then(|(_, backup)| backup.replaced());
    let plan = host.plan_behind(replaced, &words, target, &mut |progress| bar.show(progress));
    bar.clear();
    let plan = plan.map_err(|error| failed(&error, language))?;
    let plan = with_parameters(plan, backup.map_or(beside, |(path, _)| path), language)?;
    if let Some((_, backup)) = backup {
        caution_other_plc(backup, &host.identity().version(), &plan, language);
    }
    say(&changes(&plan, is_drawn(beside), colour, language));
    plan.parameter_changes().iter().for_each(|change| remark(&change.render(language)));
    if plan.bytes() == 0 {
        remark(&Message::new("link.same").render(language));
    }
    if arguments.dry_run {
        return Ok(if plan.bytes() == 0 { Outcome::Clean } else { Outcome::Findings });
    }
    let question = match (plan.is_same(), arguments.start) {
        // Nothing stops, and nothing starts.
        (true, false) => None,
        (true, true) => Some("link.ask-start"),
        (false, false) => Some("link.ask-download"),
        (false, true) => Some("link.ask-download-start"),
    };
    let question = question.map(|question| {
        Message::new(question).with("bytes", plan.bytes()).with("model", host.identity().target.title)
    });
    if question.is_some_and(|question| !confirmed(&question, arguments.yes, &mut host, language)) {
        return Err(Outcome::Findings);
    }
    // What changes nothing leaves nothing to go back to.
    let mut kept = None;
    if plan.bytes() > 0 {
        let port = arguments.connection.port(beside).unwrap_or_default();
        let identity = host.identity();
        let replaced_by = plan.wanted.parameters().sum();
        let version = identity.version();
        let origin = Origin { target: identity.target, port: &port, version, replaced_by };
        kept = Some(back_up(beside, &origin, &plan, language)?);
    }
    let report = host.download(&plan, arguments.start, &mut |progress| bar.show(progress));
    bar.clear();
    match report {
        Ok(report) => {
            let known = [kept.as_deref(), last.as_ref().map(|(path, _)| path.as_path())];
            if let Err(error) = Backup::note_end(known.into_iter().flatten()) {
                remark(&Message::new("link.end-not-noted").with("reason", error).render(language));
            }
            let done = Message::new("link.downloaded")
                .with("steps", words.len())
                .with("written", report.written)
                .with("compared", report.compared);
            remark(&done.render(language));
            let mode = if report.mode == Mode::Run { "link.runs" } else { "link.stands-still" };
            remark(&Message::new(mode).render(language));
            let is_as_asked = !arguments.start || report.mode == Mode::Run;
            Ok(if is_as_asked { Outcome::Clean } else { Outcome::Findings })
        }
        Err(failure) => {
            let outcome = failed(&failure.cause, language);
            failure.state().iter().for_each(|sentence| remark(&sentence.render(language)));
            Err(outcome)
        }
    }
}

/// The plan with the title and the latched ranges of the backup, or those that the project of the program at `path`
/// names.
///
/// # Errors
/// With the outcome, after a complaint about the manifest.
fn with_parameters(plan: Plan, path: &Path, language: Language) -> Result<Plan, Outcome> {
    if Backup::is_named_so(path) {
        let kept = Backup::read(path).map(|backup| backup.parameters());
        return Ok(plan.with_parameters(|own| kept.map_or(own, |kept| own.with_settings_of(&kept))));
    }
    let manifest = usable_manifest(path, language).ok_or(Outcome::Unusable)?;
    let model = plan.model;
    Ok(plan.with_parameters(|own| manifest.plc.applied(own, model)))
}

/// Says if the PLC does not look like the one that a backup was read from.
fn caution_other_plc(backup: &Backup, version: &str, plan: &Plan, language: Language) {
    let differs = |key| Message::new(key);
    let mut reasons = Vec::new();
    if !backup.version.is_empty() && backup.version != version {
        let told = differs("link.differs-version").with("found", version);
        reasons.push(told.with("kept", &backup.version));
    }
    let sum = plan.found;
    // A download that was cut leaves the sum of what it began to replace.
    let is_cut = sum == plan.wanted.parameters().sum();
    if let Some(kept) = backup.replaced_by.filter(|kept| *kept != sum && !is_cut) {
        let told = differs("link.differs-sum").with("found", format!("{sum:04X}"));
        reasons.push(told.with("kept", format!("{kept:04X}")));
    }
    if !reasons.is_empty() {
        let reason = Message::new("link.other-plc").with_messages("differs", reasons).render(language);
        caution("other-plc", &reason, &Message::new("link.help-other-plc").render(language), language);
    }
}

/// What changes in the PLC, as a diff of instruction lists, or of drawings.
pub(super) fn changes(plan: &Plan, is_drawn: bool, colour: Colour, language: Language) -> String {
    let [before, after] = [&plan.before, &plan.wanted].map(|image| match is_drawn {
        true => drawn(image.program(), plan.model),
        false => decode(image.program(), plan.model).text,
    });
    if before == after {
        return String::new();
    }
    let [own, new] =
        ["link.program-in-plc", "link.program-of-file"].map(|name| Message::new(name).render(language));
    unified([&own, &new], &before, &after, colour)
}

fn back_up(beside: &Path, from: &Origin<'_>, plan: &Plan, language: Language) -> Result<PathBuf, Outcome> {
    match Backup::keep(beside, from, (&plan.before, plan.is_whole)) {
        Ok(path) => {
            remark(&Message::new("link.backed-up").with("path", path.display()).render(language));
            Ok(path)
        }
        Err(error) => {
            let reason = Message::new("link.cannot-back-up").with("reason", error).render(language);
            complain("no-backup", &reason, &Message::new("cli.make-room").render(language), language);
            Err(Outcome::Unusable)
        }
    }
}
