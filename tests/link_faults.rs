//! Downloads over lines with faults: what the host says of the PLC is true, and when the faults stop the job is finished.

use crate::loopback::{Loopback, Overheard, words};
use rungwise::link::plc::{Faults, Plc, Server};
use rungwise::link::{DownloadFailure, Fate, Host, Line, LinkError, Mode, Patience, Switch, Uploaded};
use rungwise::machine_code::{BLANK, END};
use rungwise::simulate::Value;
use rungwise::target::{Model, Target};
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Two programs that differ in many places, long enough for several frames.
fn programs(model: Model) -> [Vec<u16>; 2] {
    let list = |shift: usize| -> String {
        (0..36).map(|n| format!("LD X{}\nOUT M{}\n", n % 8, (n * shift) % 100)).collect::<String>() + "END\n"
    };
    let longer = format!("LD M8000\nMOV K5 D0\n{}", list(3));
    [words(&list(7), model), words(&longer, model)]
}

/// Faults of one script: each kind alone, or several, rare to frequent.
fn faults_of(seed: u64) -> Faults {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut share = |most: f64| if random.bool() { 0.0 } else { most * random.f64().powi(4) };
    Faults {
        drop: share(0.02),
        flip: share(0.02),
        duplicate: share(0.02),
        delay: share(0.02),
        disconnect: share(0.002),
        nak: share(0.5),
        delay_ms: 1 + seed % 3000,
        seed,
    }
}

fn program_in(line: &Loopback) -> Vec<u16> {
    program_of(line.ends().server.plc())
}

fn program_of(plc: &Plc) -> Vec<u16> {
    let words = plc.words();
    let end = words.iter().position(|word| *word == END).map_or(words.len(), |end| end + 1);
    words[..end].to_vec()
}

/// What came of scripts, to see that they are neither all harmless nor all deadly.
#[derive(Default, Debug)]
struct Tally {
    done: usize,
    untouched: usize,
    partial: usize,
    unverified: usize,
    wrong: Vec<String>,
}

/// A PLC that runs the first of two programs, which a host wants to replace by the second.
struct Case {
    target: &'static Target,
    programs: [Vec<u16>; 2],
    /// One with the memory that the model comes with, and one with a smaller memory, which is sooner read as a whole.
    plcs: [Plc; 2],
}

impl Case {
    fn new(model: Model) -> Case {
        let (target, programs) = (Target::of(model), programs(model));
        let plc = || Plc::new(target, 200_000_000);
        let plcs = [plc(), plc().with_memory(1)].map(|mut plc| {
            plc.load(&programs[0]);
            plc.power_on(Switch::Run, 0);
            plc
        });
        Case { target, programs, plcs }
    }

    /// That of a script: of twenty one has all of its memory.
    fn plc(&self, seed: u64) -> Plc {
        self.plcs[usize::from(!seed.is_multiple_of(20))].clone()
    }

    /// From now on each start of the PLC is looked at: the answer says whether it has ever begun to run a program that
    /// is neither of the two. A PLC that runs takes no program, so this is so at every moment.
    fn watched(&self, line: &Loopback) -> Arc<AtomicBool> {
        let (programs, has_run) = (self.programs.clone(), Arc::<AtomicBool>::default());
        let seen = Arc::clone(&has_run);
        let look =
            move |plc: &Plc| _ = seen.fetch_or(!programs.contains(&program_of(plc)), Ordering::Relaxed);
        line.ends().at_start = Some(Box::new(look));
        has_run
    }

    /// Whether what a host says of a download that has failed is so.
    fn is_true(&self, line: &Loopback, failure: &DownloadFailure) -> bool {
        let [before, after] = &self.programs;
        let (program, is_running) = (program_in(line), Case::is_running(line));
        let is_told = failure.mode.is_none_or(|mode| (mode == Mode::Run) == is_running);
        is_told
            && match failure.fate {
                Fate::Untouched => program == *before && is_running,
                Fate::Stopped => program == *before,
                Fate::Doubtful => !is_running,
                Fate::Partial => !is_running && program != *before,
                Fate::Unverified => !is_running,
                Fate::Verified => program == *after,
            }
    }

    fn is_running(line: &Loopback) -> bool {
        line.ends().server.plc().mode() == Mode::Run
    }

    /// Carries out the script of a seed; what the host says is compared with the PLC.
    fn script(&self, seed: u64, tally: &mut Tally) {
        let line = Loopback::with(Server::new(self.plc(seed / 2)), Faults::default());
        let has_run_partly = self.watched(&line);
        // Every other script has its faults from the beginning; the others when the plan is made.
        let is_early = seed.is_multiple_of(2);
        let start = || line.reconnect(faults_of(seed));
        let [before, after] = &self.programs;
        let mut wrong = Vec::new();
        if is_early {
            start();
        }
        let planned = line.host().and_then(|mut host| {
            let plan = host.plan(after, self.target, &mut |_| {})?;
            Ok((host, plan))
        });
        match planned {
            Err(_) => {
                tally.untouched += 1;
                if program_in(&line) != *before || !Case::is_running(&line) {
                    wrong.push("something has changed before the download".to_string());
                }
            }
            Ok((_, plan)) if plan.before.program() != *before => {
                wrong.push("not what is there was read".into())
            }
            Ok((mut host, plan)) => {
                if !is_early {
                    start();
                }
                let end = host.download(&plan, true, &mut |_| {});
                let (fate, is_true) = match &end {
                    Ok(report) => {
                        let is_running = report.mode == Mode::Run;
                        let is_right = program_in(&line) == *after;
                        (Fate::Verified, is_right && Case::is_running(&line) == is_running)
                    }
                    Err(failure) => (failure.fate, self.is_true(&line, failure)),
                };
                if !is_true {
                    wrong.push(format!("{end:?} is not true"));
                }
                match fate {
                    Fate::Untouched | Fate::Stopped => tally.untouched += 1,
                    Fate::Doubtful | Fate::Partial => tally.partial += 1,
                    Fate::Unverified => tally.unverified += 1,
                    Fate::Verified => tally.done += 1,
                }
            }
        }
        // The faults stop, and the same download finishes the job.
        line.reconnect(Faults::default());
        // Every other one knows what the first try began to replace.
        let replaced = (seed / 4).is_multiple_of(2).then_some(&before[..]);
        let again = line.host().and_then(|mut host| {
            let plan = host.plan_behind(replaced, after, self.target, &mut |_| {})?;
            host.download(&plan, true, &mut |_| {}).map_err(|failure| failure.cause)
        });
        if !again.as_ref().is_ok_and(|report| report.mode == Mode::Run) || program_in(&line) != *after {
            wrong.push(format!("the second try: {again:?}"));
        }
        let held = line.ends().server.plc().words();
        let (program, rest) = held.split_at(after.len());
        if program != after || rest.iter().any(|word| *word != BLANK) {
            wrong.push("something is left behind the program".into());
        }
        if has_run_partly.load(Ordering::Relaxed) {
            wrong.push("part of a program has run".into());
        }
        tally.wrong.extend(wrong.into_iter().map(|what| format!("seed {seed}: {what}")));
    }
}

fn check(model: Model, seeds: Range<u64>) {
    let case = Case::new(model);
    let mut tally = Tally::default();
    let count = (seeds.end - seeds.start) as usize;
    seeds.for_each(|seed| case.script(seed, &mut tally));
    println!("{model:?}: {tally:?}");
    assert!(tally.wrong.is_empty(), "{}", tally.wrong.join("\n"));
    for (what, times) in [("done", tally.done), ("untouched", tally.untouched), ("partial", tally.partial)] {
        assert!(times > count / 50, "{what}: {times}");
    }
}

#[test]
fn downloads_to_an_fx2n_are_told_truly_and_can_be_mended() {
    check(Model::Fx2n, 0..2500);
}

#[test]
fn downloads_to_an_fx2n_are_told_truly_and_can_be_mended_too() {
    check(Model::Fx2n, 2500..5000);
}

#[test]
fn downloads_to_an_fx1n_are_told_truly_and_can_be_mended() {
    check(Model::Fx1n, 5000..7500);
}

#[test]
fn downloads_to_an_fx1s_are_told_truly_and_can_be_mended() {
    check(Model::Fx1s, 7500..10_000);
}

#[test]
fn what_an_upload_brings_is_what_is_in_the_plc() {
    let mut brought = 0;
    let cases = [Model::Fx2n, Model::Fx1s].map(Case::new);
    for seed in 0..3000 {
        let case = &cases[seed as usize % 2];
        let line = Loopback::with(Server::new(case.plc(seed / 2)), faults_of(seed));
        let image = line.host().and_then(|mut host| host.upload(&mut |_| {}));
        if let Ok(Uploaded { image, is_whole }) = image {
            brought += 1;
            assert!(is_whole, "seed {seed}");
            assert_eq!(image.program(), case.programs[0], "seed {seed}");
            assert_eq!(image.memory(), line.ends().server.plc().words(), "seed {seed}");
        }
        // What is compared is true as well: a plan for the program that is there has nothing to write.
        let same = line.host().and_then(|mut host| host.plan(&case.programs[0], case.target, &mut |_| {}));
        let other = line.host().and_then(|mut host| host.plan(&case.programs[1], case.target, &mut |_| {}));
        assert!(same.is_err() || same.is_ok_and(|plan| plan.bytes() == 0), "seed {seed}");
        assert!(other.is_err() || other.is_ok_and(|plan| plan.bytes() > 0), "seed {seed}");
    }
    assert!((500..2900).contains(&brought), "{brought}");
}

#[test]
fn a_download_that_is_ended_at_any_request_is_told_truly_and_can_be_finished() {
    for model in [Model::Fx2n, Model::Fx1s] {
        let case = Case::new(model);
        let [before, after] = &case.programs;
        let mut fates = Vec::new();
        for requests in 0.. {
            let line = Loopback::with(Server::new(case.plc(0)), Faults::default());
            let cancel = Arc::<AtomicBool>::default();
            let (ending, mut left) = (Arc::clone(&cancel), requests);
            let hear = move |_: &[u8]| match left {
                0 => ending.store(true, Ordering::Relaxed),
                _ => left -= 1,
            };
            let ended = Overheard { line: line.clone(), hear };
            let has_run_partly = case.watched(&line);
            let is_running = || Case::is_running(&line);
            let planned =
                Host::connect(Line::new(ended, Patience::default(), cancel)).and_then(|mut host| {
                    let plan = host.plan(after, case.target, &mut |_| {})?;
                    Ok((host, plan))
                });
            let (mut host, plan) = match planned {
                Ok(planned) => planned,
                Err(error) => {
                    assert_eq!(error, LinkError::Cancelled, "{requests}");
                    assert!(is_running() && program_in(&line) == *before, "{requests}");
                    continue;
                }
            };
            let failure = match host.download(&plan, true, &mut |_| {}) {
                Ok(report) => {
                    assert!(report.mode == Mode::Run && is_running() && program_in(&line) == *after);
                    break;
                }
                Err(failure) => failure,
            };
            assert_eq!(failure.cause, LinkError::Cancelled, "{requests}");
            // What lets hosts write the program is taken back in any case.
            assert_eq!(line.ends().server.plc().shown("M8118"), Some(Value::Bit(false)), "{requests}");
            let is_true = case.is_true(&line, &failure);
            assert!(failure.mode.is_some(), "{requests}");
            assert!(is_true, "{requests}: {failure:?}, and it runs: {}", is_running());
            fates.push(failure.fate);
            let again = line.host().and_then(|mut host| {
                let plan = host.plan(after, case.target, &mut |_| {})?;
                host.download(&plan, true, &mut |_| {}).map_err(|failure| failure.cause)
            });
            assert!(again.is_ok_and(|report| report.mode == Mode::Run), "{requests}");
            assert!(program_in(&line) == *after && Case::is_running(&line), "{requests}");
            assert!(!has_run_partly.load(Ordering::Relaxed), "{requests}");
        }
        fates.dedup();
        let all = [Fate::Untouched, Fate::Stopped, Fate::Partial, Fate::Unverified, Fate::Verified];
        assert_eq!(fates, all, "{model:?}");
    }
}

/// The line breaks at each frame there is, once before the request has come and once when only its answer is lost.
#[test]
fn a_line_that_breaks_at_any_frame_leaves_no_partial_program_running() {
    for (model, is_answer) in
        [(Model::Fx2n, false), (Model::Fx2n, true), (Model::Fx1s, false), (Model::Fx1s, true)]
    {
        let case = Case::new(model);
        let [before, after] = &case.programs;
        let mut fates = Vec::new();
        for frames in 0.. {
            let line = Loopback::with(Server::new(case.plc(1)), Faults::default());
            let has_run_partly = case.watched(&line);
            let (broken, mut left) = (line.clone(), frames);
            let hear = move |_: &[u8]| match left {
                0 => broken.cut(is_answer),
                _ => left -= 1,
            };
            let breaking = Overheard { line: line.clone(), hear };
            let mut host = match Host::connect(Line::new(breaking, Patience::default(), Arc::default())) {
                Ok(host) => host,
                Err(error) => {
                    assert!(matches!(error, LinkError::Gone { .. }), "{frames}: {error:?}");
                    continue;
                }
            };
            let ended = match host.plan(after, case.target, &mut |_| {}) {
                Ok(plan) => host.download(&plan, true, &mut |_| {}),
                Err(error) => {
                    assert!(matches!(error, LinkError::Gone { .. }), "{frames}: {error:?}");
                    assert!(program_in(&line) == *before && Case::is_running(&line), "{frames}");
                    continue;
                }
            };
            let Err(failure) = ended else { break };
            assert!(matches!(failure.cause, LinkError::Gone { .. }), "{frames}: {failure:?}");
            assert!(case.is_true(&line, &failure), "{frames}: {failure:?}");
            fates.push(failure.fate);
            line.reconnect(Faults::default());
            let again = line.host().and_then(|mut host| {
                let plan = host.plan(after, case.target, &mut |_| {})?;
                host.download(&plan, true, &mut |_| {}).map_err(|failure| failure.cause)
            });
            assert!(again.is_ok_and(|report| report.mode == Mode::Run), "{frames}");
            assert!(program_in(&line) == *after && Case::is_running(&line), "{frames}");
            assert!(!has_run_partly.load(Ordering::Relaxed), "{frames}");
        }
        fates.dedup();
        let all =
            [Fate::Untouched, Fate::Stopped, Fate::Doubtful, Fate::Partial, Fate::Unverified, Fate::Verified];
        assert_eq!(fates, all, "{model:?}, answers: {is_answer}");
    }
}

/// What is lost of a line: the requests that begin so, or the answers to them.
#[derive(Clone, Copy)]
struct Lost {
    requests: &'static str,
    is_answer: bool,
}

/// Downloads the second program of a case, while `hear` hears the requests without what is around them.
fn overheard(
    case: &Case,
    line: &Loopback,
    mut hear: impl FnMut(&str) + Send,
) -> Result<Mode, DownloadFailure> {
    let hear = move |frame: &[u8]| hear(&String::from_utf8_lossy(&frame[1..frame.len() - 3]));
    let heard = Overheard { line: line.clone(), hear };
    let mut host = Host::connect(Line::new(heard, Patience::default(), Arc::default())).unwrap();
    let plan = host.plan(&case.programs[1], case.target, &mut |_| {}).unwrap();
    host.download(&plan, false, &mut |_| {}).map(|report| report.mode)
}

#[test]
fn what_is_not_heard_of_a_write_or_an_order_is_asked_for_afterwards() {
    let lost = |requests, is_answer| Lost { requests, is_answer };
    for (model, lost, fate, mode) in [
        // Written, and never acknowledged.
        (Model::Fx2n, lost("E11", true), Fate::Partial, Mode::Stop),
        (Model::Fx1s, lost("1", true), Fate::Partial, Mode::Stop),
        // Never written.
        (Model::Fx2n, lost("E11", false), Fate::Stopped, Mode::Stop),
        (Model::Fx1s, lost("1", false), Fate::Stopped, Mode::Stop),
        // The order to stop.
        (Model::Fx2n, lost("E7250E", true), Fate::Stopped, Mode::Stop),
        (Model::Fx2n, lost("E7250E", false), Fate::Stopped, Mode::Run),
    ] {
        let case = Case::new(model);
        let line = Loopback::with(Server::new(case.plc(1)), Faults::default());
        let wire = line.clone();
        let ended = overheard(&case, &line, move |body| {
            let drop = if body.starts_with(lost.requests) { 1.0 } else { 0.0 };
            wire.spoil(lost.is_answer, Faults { drop, ..Faults::default() });
        });
        let failure = ended.unwrap_err();
        assert_eq!((failure.fate, failure.mode), (fate, Some(mode)), "{model:?} {}", lost.requests);
        assert!(case.is_true(&line, &failure), "{failure:?}");
    }
}

#[test]
fn whoever_turns_the_switch_under_a_download_makes_nothing_of_it_untrue() {
    for model in [Model::Fx2n, Model::Fx1s] {
        let case = Case::new(model);
        let mut fates = Vec::new();
        for requests in 0.. {
            let line = Loopback::with(Server::new(case.plc(1)), Faults::default());
            let has_run_partly = case.watched(&line);
            let (plc, mut heard) = (line.clone(), 0);
            let is_over = Arc::<AtomicBool>::default();
            let is_turned = Arc::clone(&is_over);
            let ended = overheard(&case, &line, move |_| {
                if heard == requests {
                    let mut ends = plc.ends();
                    let now_ns = ends.now_ns;
                    ends.server.plc_mut().turn(Switch::Run, now_ns);
                    is_turned.store(true, Ordering::Relaxed);
                }
                heard += 1;
            });
            if !is_over.load(Ordering::Relaxed) {
                break;
            }
            let (program, is_running) = (program_in(&line), Case::is_running(&line));
            match ended {
                Ok(mode) => {
                    assert_eq!(program, case.programs[1], "{requests}");
                    assert_eq!(mode == Mode::Run, is_running, "{requests}");
                }
                Err(failure) => {
                    assert_eq!(failure.mode.map(|mode| mode == Mode::Run), Some(is_running), "{requests}");
                    let is_old = program == case.programs[0];
                    let is_told_old = matches!(failure.fate, Fate::Untouched | Fate::Stopped);
                    assert_eq!(is_told_old, is_old, "{requests}: {failure:?}");
                    fates.push((failure.fate, is_running));
                }
            }
            assert!(!has_run_partly.load(Ordering::Relaxed), "{requests}");
        }
        fates.dedup();
        // The old program runs again before anything of the new one was written; half of one does not run.
        assert!(fates.contains(&(Fate::Stopped, true)), "{model:?}: {fates:?}");
    }
}
