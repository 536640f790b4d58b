//! `rungwise test`

mod json;
mod junit;
mod subject;
mod text;

use super::input::{complain, put, say};
use super::{Outcome, paths_or_here};
use crate::project::read_text;
use crate::scenario::{Counts, Fate, Flaw, Golden, Mutants, Report, Scenario, lcov};
use crate::text::{Encoding, Language, Message, Span, position_of};
use clap::ValueEnum;
use std::path::PathBuf;
use subject::{Subject, SuiteFile};

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Files with scenario tests, programs, folders or projects; the current folder if left out.
    paths: Vec<PathBuf>,
    /// Run only the scenarios whose names have these words in them.
    #[arg(long, value_name = "WORDS")]
    only: Option<String>,
    /// Tell which contacts were on and off, and which of them decided.
    #[arg(long)]
    coverage: bool,
    /// Write the coverage to this file, as a tracefile of lcov.
    #[arg(long, value_name = "FILE")]
    coverage_file: Option<PathBuf>,
    /// Run the scenarios with programs that have one fault each, and list the faults that none of them finds.
    #[arg(long)]
    mutate: bool,
    /// At most so many faults are tried.
    #[arg(long, value_name = "N", default_value_t = 1000, requires = "mutate")]
    mutants: usize,
    /// Which faults are tried where there are more.
    #[arg(long, value_name = "N", default_value_t = 0, requires = "mutate")]
    seed: u64,
    /// Write golden traces anew.
    #[arg(long)]
    update: bool,
    /// The shape of the result.
    #[arg(long, value_enum, default_value = "text")]
    format: TestFormat,
}

/// The shape of test results on standard output.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum TestFormat {
    /// For people.
    Text,
    /// One JSON document.
    Json,
    /// A report as JUnit writes it, for build servers.
    Junit,
}

/// What came of everything.
struct Session {
    suites: Vec<SuiteFile>,
    subjects: Vec<Subject>,
    /// By the numbers of the suites.
    results: Vec<Vec<Ran>>,
    survivors: Option<Survivors>,
    /// Golden traces that were written.
    written: Vec<String>,
    shows_coverage: bool,
}

/// What came of a scenario.
struct Ran {
    /// Its number in its file.
    number: usize,
    verdict: Verdict,
}

enum Verdict {
    /// It was run.
    Done(Report),
    /// The program does not run.
    Stuck,
}

/// What came of mutants.
#[derive(Default)]
struct Survivors {
    total: usize,
    tried: usize,
    killed: usize,
    equivalent: usize,
    invalid: Vec<Fault>,
    unwritten: Vec<Fault>,
    /// Those that no scenario found.
    survived: Vec<Fault>,
}

/// A mutant: the number of the subject and of the document, the place, what it is.
struct Fault {
    subject: usize,
    document: usize,
    span: Span,
    change: Message,
}

impl SuiteFile {
    /// The line and the column of a byte, from 1.
    fn position(&self, offset: u32) -> (u32, u32) {
        let at = position_of(&self.text, offset as usize, Encoding::Utf32);
        (at.line + 1, at.column + 1)
    }

    /// `motor.test.toml:3:5`
    fn place(&self, span: Span) -> String {
        let (line, column) = self.position(span.start);
        format!("{}:{line}:{column}", self.shown)
    }
}

impl Ran {
    fn is_passed(&self) -> bool {
        matches!(&self.verdict, Verdict::Done(report) if report.is_passed())
    }
}

impl Session {
    fn count(&self, wanted: impl Fn(&Ran) -> bool) -> usize {
        self.results.iter().flatten().filter(|ran| wanted(ran)).count()
    }

    fn counts(&self) -> Counts {
        let mut counts = Counts::default();
        let covered = self.subjects.iter().filter_map(|subject| subject.coverage.as_ref());
        covered.for_each(|coverage| counts += coverage.counts(None));
        counts
    }

    fn has_flaws(&self) -> bool {
        self.suites.iter().any(|suite| !suite.flaws.is_empty())
    }
}

pub(super) fn run(arguments: &Arguments, language: Language) -> Outcome {
    let wants_coverage = arguments.coverage || arguments.coverage_file.is_some();
    let Some((suites, subjects)) = subject::found(&paths_or_here(&arguments.paths), wants_coverage, language)
    else {
        return Outcome::Unusable;
    };
    let mut session = Session {
        results: suites.iter().map(|_| Vec::new()).collect(),
        suites,
        subjects,
        survivors: None,
        written: Vec::new(),
        shows_coverage: wants_coverage,
    };
    if !session.run(arguments, language) {
        return Outcome::Unusable;
    }
    if let (Some(words), true) =
        (&arguments.only, session.results.iter().all(Vec::is_empty) && !session.has_flaws())
    {
        let reason = Message::new("cli.no-scenario").with("words", words).render(language);
        complain("no-tests", &reason, &Message::new("cli.give-suite").render(language), language);
        return Outcome::Unusable;
    }
    if arguments.mutate {
        session.mutate(arguments);
    }
    match arguments.format {
        TestFormat::Text => say(&text::told(&session, language)),
        TestFormat::Json => say(&format!("{:#}\n", json::of(&session, language))),
        TestFormat::Junit => say(&junit::of(&session, language)),
    }
    for suite in &session.suites {
        for flaw in &suite.flaws {
            let reason = format!("{}: {}", suite.place(flaw.span), flaw.message.render(language));
            complain("scenario", &reason, &Message::new("cli.mend-suite").render(language), language);
        }
    }
    if let Some(path) = &arguments.coverage_file {
        let traces = session.subjects.iter().filter_map(|subject| {
            let coverage = subject.coverage.as_ref()?;
            let documents = subject.programs.iter().map(|program| &program.document);
            Some(lcov(coverage, &subject.paths().zip(documents).collect::<Vec<_>>()))
        });
        if !put(&traces.collect::<String>(), Some(path), language) {
            return Outcome::Unusable;
        }
    }
    let has_survivors = session
        .survivors
        .as_ref()
        .is_some_and(|survivors| !survivors.survived.is_empty() || !survivors.unwritten.is_empty());
    if session.has_flaws() {
        Outcome::Unusable
    } else if session.count(|ran| !ran.is_passed()) > 0 || has_survivors {
        Outcome::Findings
    } else {
        Outcome::Clean
    }
}

impl Session {
    /// Runs the scenarios; whether golden traces could be written.
    fn run(&mut self, arguments: &Arguments, language: Language) -> bool {
        for (suite, results) in self.suites.iter_mut().zip(&mut self.results) {
            let Some(subject) = suite.subject.and_then(|number| self.subjects.get_mut(number)) else {
                continue;
            };
            if !suite.flaws.is_empty() {
                continue;
            }
            for number in 0..suite.suite.scenarios.len() {
                let scenario = &suite.suite.scenarios[number];
                let is_wanted = |words: &String| scenario.name.to_lowercase().contains(&words.to_lowercase());
                if !arguments.only.as_ref().is_none_or(is_wanted) {
                    continue;
                }
                let golden = match suite.golden(scenario, arguments.update) {
                    Ok(golden) => golden,
                    Err(flaw) => {
                        suite.flaws.push(flaw);
                        continue;
                    }
                };
                let Ok(bench) = &subject.bench else {
                    results.push(Ran { number, verdict: Verdict::Stuck });
                    continue;
                };
                match bench.run(scenario, golden.as_ref(), subject.coverage.as_mut()) {
                    Ok(report) => {
                        if let Some(path) = suite.golden_path(scenario).filter(|_| arguments.update) {
                            let text = report.trace.csv();
                            if std::fs::read_to_string(&path).is_ok_and(|before| before == text) {
                                results.push(Ran { number, verdict: Verdict::Done(report) });
                                continue;
                            }
                            if !put(&text, Some(&path), language) {
                                return false;
                            }
                            self.written.push(path.display().to_string());
                        }
                        results.push(Ran { number, verdict: Verdict::Done(report) });
                    }
                    Err(flaws) => suite.flaws.extend(flaws),
                }
            }
        }
        true
    }

    /// Runs the scenarios that pass with programs that have one fault each.
    fn mutate(&mut self, arguments: &Arguments) {
        let mut survivors = Survivors::default();
        for (number, subject) in self.subjects.iter().enumerate() {
            let documents: Vec<_> = subject.programs.iter().map(|program| &program.document).collect();
            let mut scenarios: Vec<(&Scenario, Option<Golden>)> = Vec::new();
            for (suite, results) in self.suites.iter().zip(&self.results) {
                let own = results.iter().filter(|ran| suite.subject == Some(number) && ran.is_passed());
                scenarios.extend(own.filter_map(|ran| {
                    let scenario = suite.suite.scenarios.get(ran.number)?;
                    Some((scenario, suite.golden(scenario, false).ok()?))
                }));
            }
            if scenarios.is_empty() {
                continue;
            }
            let scenarios: Vec<(&Scenario, Option<&Golden>)> =
                scenarios.iter().map(|(scenario, golden)| (*scenario, golden.as_ref())).collect();
            let mutants = Mutants::of(&documents);
            survivors.total += mutants.len();
            for mutant in mutants.sample(arguments.mutants, arguments.seed) {
                survivors.tried += 1;
                let fault = || Fault {
                    subject: number,
                    document: mutant.document,
                    span: mutant.span,
                    change: mutant.change.message(),
                };
                match mutants.fate(mutant, &scenarios) {
                    Fate::Killed => survivors.killed += 1,
                    Fate::Equivalent => survivors.equivalent += 1,
                    Fate::Invalid => survivors.invalid.push(fault()),
                    Fate::Unwritten => survivors.unwritten.push(fault()),
                    Fate::Survived => survivors.survived.push(fault()),
                }
            }
        }
        self.survivors = Some(survivors);
    }
}

impl SuiteFile {
    fn golden_path(&self, scenario: &Scenario) -> Option<PathBuf> {
        let folder = self.path.parent()?;
        scenario.golden.as_ref().map(|golden| folder.join(&golden.name))
    }

    /// The golden trace of a scenario, if it has one; with `is_new` it is about to be written.
    fn golden(&self, scenario: &Scenario, is_new: bool) -> Result<Option<Golden>, Flaw> {
        let (Some(path), Some(named)) = (self.golden_path(scenario), &scenario.golden) else {
            return Ok(None);
        };
        if is_new {
            let needs_end = scenario.last.is_none().then(|| Message::new("scenario.golden-time"));
            return needs_end.map_or(Ok(None), |message| Err(Flaw { message, span: named.span }));
        }
        let read = match read_text(&path) {
            Some(text) => Golden::read(&text),
            None => Err(Message::new("scenario.golden-missing").with("path", &named.name)),
        };
        read.map(Some).map_err(|message| Flaw { message, span: named.span })
    }
}
