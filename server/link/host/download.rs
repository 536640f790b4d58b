//! Downloading: the PLC stops, gets what has changed, and is read back word for word before it may run.

use super::program::{Cut, Teller};
use super::{Dialect, Host};
use crate::link::frame::MOST_DATA;
use crate::link::{Command, LinkError, Mode, Transport};
use crate::machine_code::{Chunk, END, Image, PARAMETER_ADDRESS, PROGRAM_ADDRESS, ParameterBlock, executed};
use crate::target::{Latch, Model, Target};
use crate::text::Message;
use std::sync::Arc;
use std::time::Duration;

/// What is going on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Stage {
    /// The program in the PLC is read.
    Reading,
    /// What has changed is written.
    Writing,
    /// What was written is read back and compared.
    Comparing,
}

impl Stage {
    /// The word for it.
    pub fn message(self) -> Message {
        Message::new(match self {
            Stage::Reading => "link.stage-reading",
            Stage::Writing => "link.stage-writing",
            Stage::Comparing => "link.stage-comparing",
        })
    }
}

/// How far it is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Progress {
    /// What is going on.
    pub stage: Stage,
    /// Bytes so far.
    pub done: usize,
    /// Bytes of this stage in all.
    pub total: usize,
    /// How long this stage will take from here, if it goes on as before.
    pub remaining: Duration,
}

impl Progress {
    /// How far it is in words: what goes on, the bytes of this stage, and the seconds that it will take.
    pub fn message(&self) -> Message {
        Message::new("link.progress")
            .with_messages("stage", vec![self.stage.message()])
            .with("done", self.done)
            .with("total", self.total)
            .with("seconds", self.remaining.as_secs_f64().ceil())
    }
}

/// A download that has not begun: what is in the PLC, and what shall be.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Plan {
    /// The model of the PLC.
    pub model: Model,
    /// What was read from the PLC.
    pub before: Image,
    /// The sum that the PLC had computed.
    pub found: u16,
    /// Whether that is a program that was taken over, and not one that is written in part.
    pub is_whole: bool,
    /// What shall be there.
    pub wanted: Image,
}

/// A download that has ended well.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Report {
    /// Bytes that were written.
    pub written: usize,
    /// Bytes that were read back and compared.
    pub compared: usize,
    /// What the CPU does now.
    pub mode: Mode,
}

/// What has become of the program in the PLC.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Fate {
    /// It is the old one, and the CPU does what it did.
    Untouched,
    /// It is the old one; the CPU was told to stop, which it may not have heard.
    Stopped,
    /// The first part of the new one was sent, and nobody has heard whether the PLC has written it.
    Doubtful,
    /// Part of it is the new one.
    Partial,
    /// All of it has been written, but not found to be right.
    Unverified,
    /// It is the new one, word for word.
    Verified,
}

/// A download that has not ended well.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct DownloadFailure {
    /// Why.
    pub cause: LinkError,
    /// What has become of the program.
    pub fate: Fate,
    /// What the CPU does, where it could still be asked.
    pub mode: Option<Mode>,
}

impl DownloadFailure {
    /// The sentences that say in which state the PLC is: its program, and its CPU.
    pub fn state(&self) -> [Message; 2] {
        let program = match self.fate {
            Fate::Untouched => "link.fate-untouched",
            Fate::Stopped => "link.fate-stopped",
            Fate::Doubtful => "link.fate-doubtful",
            Fate::Partial => "link.fate-partial",
            Fate::Unverified => "link.fate-unverified",
            Fate::Verified => "link.fate-verified",
        };
        let mode = match self.mode {
            Some(Mode::Run) => "link.runs",
            Some(Mode::Stop) => "link.stands-still",
            None => "link.mode-unknown",
        };
        [program, mode].map(Message::new)
    }
}

/// Lets a host write the program; the maker's tools switch it on before and off behind.
const WRITE_ENABLE: u32 = 8118;
/// How often what reads otherwise is written again.
const MOST_MENDS: usize = 2;

impl Plan {
    /// Bytes that are written.
    pub fn bytes(&self) -> usize {
        self.wanted.changed_chunks(&self.before, MOST_DATA).iter().map(|chunk| chunk.bytes.len()).sum()
    }

    /// Whether the PLC has taken over this very program, so that nothing need be written.
    pub fn is_same(&self) -> bool {
        self.is_whole && self.bytes() == 0
    }

    /// The same with other parameters, where the program fits then.
    pub fn with_parameters(mut self, parameters: impl FnOnce(ParameterBlock) -> ParameterBlock) -> Plan {
        if let Some(wanted) = self.wanted.with_parameters(parameters(*self.wanted.parameters())) {
            self.wanted = wanted;
        }
        self
    }

    /// What changes in the parameters, a sentence each.
    pub fn parameter_changes(&self) -> Vec<Message> {
        let [before, after] = [self.before.parameters(), self.wanted.parameters()];
        let told = |key, before: String, after: String| {
            (before != after).then(|| Message::new(key).with("before", before).with("after", after))
        };
        let range = |block: &ParameterBlock, latch| {
            block.latched(latch).map_or_else(|| "–".to_string(), |(first, last)| format!("{first}–{last}"))
        };
        let latches = Latch::ALL.into_iter();
        let latches =
            latches.filter_map(|latch| told("link.latch-changes", range(before, latch), range(after, latch)));
        told("link.title-changes", before.title(), after.title()).into_iter().chain(latches).collect()
    }

    /// The plan that undoes this one.
    pub fn undone(&self) -> Plan {
        Plan {
            model: self.model,
            found: self.wanted.parameters().sum(),
            before: self.wanted.clone(),
            is_whole: true,
            wanted: self.before.clone(),
        }
    }
}

impl<T: Transport> Host<T> {
    /// Reads what is in the PLC and sees whether `program` may take its place. Nothing is changed.
    ///
    /// The parameters of the PLC stay as they are, which devices are latched, its title, its memory, unless
    /// [`Plan::with_parameters`] says otherwise.
    ///
    /// # Errors
    /// If the PLC is another one than `target`, has a keyword or too little memory, or if the line fails.
    pub fn plan(
        &mut self,
        program: &[u16],
        target: &'static Target,
        tell: &mut dyn FnMut(Progress),
    ) -> Result<Plan, LinkError> {
        self.plan_behind(None, program, target, tell)
    }

    /// The same, where somebody knows the program that a download began to replace which is not known to have ended:
    /// if it did not, less is read, and what it left is no whole program, whatever its sum.
    ///
    /// # Errors
    /// See [`Host::plan`].
    pub fn plan_behind(
        &mut self,
        replaced: Option<&[u16]>,
        program: &[u16],
        target: &'static Target,
        tell: &mut dyn FnMut(Progress),
    ) -> Result<Plan, LinkError> {
        let found = self.identity.target;
        if found.model != target.model {
            return Err(LinkError::WrongModel { wanted: target.title, found: found.title });
        }
        let program = executed(program);
        if program.last() != Some(&END) {
            return Err(LinkError::NoEnd);
        }
        let raw = self.raw_parameters()?;
        if raw.has_keyword() {
            return Err(LinkError::Keyword);
        }
        if raw.file_register_blocks() > 0 || raw.comment_blocks() > 0 {
            return Err(LinkError::FileRegisters);
        }
        let cut = replaced.map(|replaced| Cut { replaced, steps: replaced.len().max(program.len()) });
        let (before, is_whole) = self.read_memory(cut, tell)?;
        let parameters = *before.parameters();
        let capacity = parameters.program_steps() as usize;
        let wanted = Image::new(parameters, program).filter(|_| program.len() <= capacity);
        let wanted = wanted.ok_or(LinkError::TooLarge { steps: program.len(), capacity })?;
        Ok(Plan { model: target.model, found: raw.sum(), before, is_whole, wanted })
    }

    /// Carries a plan out: stop, write what has changed, read all of it back, compare the sum, and start if
    /// `is_started` says so. A program that is there already is only compared, and what runs goes on.
    ///
    /// # Errors
    /// With what has become of the program. The same download, planned again, finishes the job.
    pub fn download(
        &mut self,
        plan: &Plan,
        is_started: bool,
        tell: &mut dyn FnMut(Progress),
    ) -> Result<Report, DownloadFailure> {
        let mut fate = Fate::Untouched;
        // Whoever was asked may have taken time, in which somebody else came.
        let done = match self.sum() {
            Ok(sum) if sum == plan.found => self.carry_out(plan, is_started, &mut fate, tell),
            Ok(_) => Err(LinkError::Changed),
            Err(cause) => Err(cause),
        };
        done.map_err(|cause| self.look_after(plan, is_started, cause, fate))
    }

    /// Asks the PLC what has become of it, though what was under way has failed or was ended by the user.
    fn look_after(&mut self, plan: &Plan, is_started: bool, cause: LinkError, fate: Fate) -> DownloadFailure {
        if matches!(cause, LinkError::Gone { .. }) {
            return DownloadFailure { cause, fate, mode: None };
        }
        let cancel = self.line.set_cancel(Arc::default());
        // An order that was heard may not be obeyed yet.
        let mode = match fate {
            Fate::Stopped => self.settled(Mode::Stop),
            Fate::Verified if is_started => self.settled(Mode::Run),
            _ => self.mode(),
        };
        // A line that has said nothing to this is not asked for more.
        let fate = match mode {
            Ok(_) if fate == Fate::Doubtful => self.is_begun(plan).map_or(fate, |is_begun| match is_begun {
                true => Fate::Partial,
                false => Fate::Stopped,
            }),
            _ => fate,
        };
        self.line.set_cancel(cancel);
        DownloadFailure { cause, fate, mode: mode.ok() }
    }

    /// What the CPU does when it has had time to come to `mode`.
    fn settled(&mut self, mode: Mode) -> Result<Mode, LinkError> {
        if self.comes_to(mode)? { Ok(mode) } else { self.mode() }
    }

    /// Whether the PLC has written any of the first piece that a plan sends.
    fn is_begun(&mut self, plan: &Plan) -> Result<bool, LinkError> {
        let Some(first) = plan.wanted.changed_chunks(&plan.before, MOST_DATA).into_iter().next() else {
            return Ok(false);
        };
        let parameters = plan.before.parameters().with_sum(plan.found).to_words();
        let place = first.address.saturating_sub(PARAMETER_ADDRESS) as usize;
        let old = parameters.iter().chain(plan.before.memory()).flat_map(|word| word.to_le_bytes());
        let old: Vec<u8> = old.skip(place).take(first.bytes.len()).collect();
        // What is neither the old nor the new counts if it comes twice: a line that has failed is not to be trusted.
        let mut last = None;
        for _ in 0..=MOST_MENDS {
            let held = self.read_program(first.address, first.bytes.len(), &mut |_, _| {})?;
            if held == old {
                return Ok(false);
            }
            if held == first.bytes || last.as_ref() == Some(&held) {
                return Ok(true);
            }
            last = Some(held);
        }
        Err(LinkError::Noise)
    }

    fn carry_out(
        &mut self,
        plan: &Plan,
        is_started: bool,
        fate: &mut Fate,
        tell: &mut dyn FnMut(Progress),
    ) -> Result<Report, LinkError> {
        let mut written = 0;
        let mut compared = 0;
        // What is there word for word need not be written, and nothing stops for it.
        let is_there = plan.is_same()
            && first_difference(&self.read_back(plan, &mut compared, tell)?, &plan.wanted).is_none();
        if is_there {
            if is_started {
                *fate = Fate::Verified;
                self.start()?;
            }
            return Ok(Report { written, compared, mode: self.mode()? });
        }
        if self.mode()? == Mode::Run {
            *fate = Fate::Stopped;
            self.halt()?;
        }
        let mut held = plan.before.clone();
        for round in 0..=MOST_MENDS {
            written += self.write_changes(&held, &plan.wanted, fate, tell)?;
            // What was sent may have come otherwise, and with a sum that is right by chance.
            *fate = Fate::Unverified;
            held = self.read_back(plan, &mut compared, tell)?;
            match first_difference(&held, &plan.wanted) {
                None => break,
                Some(step) if round == MOST_MENDS => return Err(LinkError::Mismatch { step }),
                Some(_) => {}
            }
        }
        self.compare_sum(plan, fate, &mut written, tell)?;
        *fate = Fate::Verified;
        if is_started {
            self.start()?;
        }
        // Somebody may have turned the switch meanwhile.
        Ok(Report { written, compared, mode: self.mode()? })
    }

    fn write_changes(
        &mut self,
        held: &Image,
        wanted: &Image,
        fate: &mut Fate,
        tell: &mut dyn FnMut(Progress),
    ) -> Result<usize, LinkError> {
        let chunks = wanted.changed_chunks(held, MOST_DATA);
        let total = chunks.iter().map(|chunk| chunk.bytes.len()).sum();
        if chunks.is_empty() && matches!(fate, Fate::Untouched | Fate::Stopped) {
            // The same words may never have been taken over.
            self.line.ask(&Command::Commit)?;
            return Ok(0);
        }
        let since = self.line.now();
        let mut teller = Teller::new(Stage::Writing, total, since, tell);
        let written = self.write_chunks(&chunks, fate, &mut teller);
        self.forbid_writing(written)?;
        self.line.ask(&Command::Commit)?;
        Ok(total)
    }

    fn write_chunks(
        &mut self,
        chunks: &[Chunk],
        fate: &mut Fate,
        teller: &mut Teller<'_>,
    ) -> Result<(), LinkError> {
        if self.dialect() == Dialect::Extended {
            self.order(WRITE_ENABLE, true)?;
        }
        for chunk in chunks {
            if matches!(fate, Fate::Untouched | Fate::Stopped) {
                *fate = Fate::Doubtful;
            }
            self.write_program(chunk.address, &chunk.bytes)?;
            *fate = Fate::Partial;
            teller.add(chunk.bytes.len(), self.line.now());
        }
        Ok(())
    }

    /// Takes back that the program may be written, also if that went wrong or the user has ended it.
    fn forbid_writing(&mut self, written: Result<(), LinkError>) -> Result<(), LinkError> {
        if self.dialect() == Dialect::Plain {
            return written;
        }
        let forbidden = written.and_then(|()| self.order(WRITE_ENABLE, false));
        let Err(error) = forbidden else { return Ok(()) };
        if matches!(error, LinkError::Gone { .. }) {
            return Err(error);
        }
        let cancel = self.line.set_cancel(Arc::default());
        // What went wrong first is what is told.
        let _ = self.order(WRITE_ENABLE, false);
        self.line.set_cancel(cancel);
        Err(error)
    }

    /// What is in the PLC where the old or the new program is.
    fn read_back(
        &mut self,
        plan: &Plan,
        compared: &mut usize,
        tell: &mut dyn FnMut(Progress),
    ) -> Result<Image, LinkError> {
        let steps = plan.before.program().len().max(plan.wanted.program().len());
        let parameters = 2 * ParameterBlock::WORDS;
        let since = self.line.now();
        let mut block = self.read_program(PARAMETER_ADDRESS, parameters, &mut |_, _| {})?;
        let mut teller = Teller::new(Stage::Comparing, 2 * steps, since, tell);
        let mut done = |bytes, now| teller.add(bytes, now);
        let program = self.read_program(PROGRAM_ADDRESS, 2 * steps, &mut done)?;
        *compared = block.len() + program.len();
        block.extend(program);
        Image::from_bytes(&block).ok_or(LinkError::Mismatch { step: None })
    }

    /// The PLC adds up all of its memory, also what was neither written nor read. If that is not what it should be,
    /// something lies behind the program: then the rest is cleared too.
    fn compare_sum(
        &mut self,
        plan: &Plan,
        fate: &mut Fate,
        written: &mut usize,
        tell: &mut dyn FnMut(Progress),
    ) -> Result<(), LinkError> {
        let wanted = plan.wanted.parameters().sum();
        if self.sum()? == wanted {
            return Ok(());
        }
        let all = 2 * (ParameterBlock::WORDS + plan.wanted.memory().len());
        let bytes = self.read_program(PARAMETER_ADDRESS, all, &mut |_, _| {})?;
        let held = Image::from_bytes(&bytes).ok_or(LinkError::Mismatch { step: None })?;
        *written += self.write_changes(&held, &plan.wanted, fate, tell)?;
        *fate = Fate::Unverified;
        let bytes = self.read_program(PARAMETER_ADDRESS, all, &mut |_, _| {})?;
        let held = Image::from_bytes(&bytes).ok_or(LinkError::Mismatch { step: None })?;
        if let Some(step) = first_difference(&held, &plan.wanted) {
            return Err(LinkError::Mismatch { step });
        }
        match self.sum()? {
            found if found == wanted => Ok(()),
            found => Err(LinkError::Sum { wanted, found }),
        }
    }

    /// The sum that the PLC has computed.
    pub(super) fn sum(&mut self) -> Result<u16, LinkError> {
        match self.read_program(PARAMETER_ADDRESS + 2, 2, &mut |_, _| {})?[..] {
            [low, high] => Ok(u16::from_le_bytes([low, high])),
            _ => Err(LinkError::Noise),
        }
    }
}

/// The first step in which two images differ, or nothing for the parameters; nothing at all where they do not.
fn first_difference(held: &Image, wanted: &Image) -> Option<Option<usize>> {
    let parameters = |image: &Image| image.parameters().with_sum(0);
    if parameters(held) != parameters(wanted) {
        return Some(None);
    }
    let steps = held.memory().iter().zip(wanted.memory());
    steps.enumerate().find(|(_, (held, wanted))| held != wanted).map(|(step, _)| Some(step))
}
