//! Who reads and who drives each device and variable of a whole program: the accesses of all pages, sorted by what they
//! name. It is put together anew after each edit, from rows that the pages keep.

use crate::check::ProgramContext;
use crate::check::statements::is_fx_program;
use crate::document::{Access, Act, Chunk, Notation, Page, Part, Scopes, Symbol, Variable};
use crate::target::{Device, DeviceKind, DirectAddress, Flow};
use crate::text::Span;
use rustc_hash::FxHashMap;
use std::cell::OnceCell;

/// The accesses of a program.
pub struct Uses<'a> {
    pages: Vec<PageAt<'a>>,
    names: Vec<Name<'a>>,
    devices: FxHashMap<Device, u32>,
    /// The numbers of what is no device.
    numbers: FxHashMap<Key<'a>, u32>,
    /// What is done with each name.
    acts: Vec<Acts>,
    /// Where the accesses of each name begin in `order`, and behind the last name where they end.
    starts: Vec<u32>,
    /// The page and the number in it of each access, those of a name in the order of execution.
    order: Vec<(u32, u32)>,
    /// Devices that are read, and devices that are written, as parts of rows of several.
    read_rows: Rows,
    written_rows: Rows,
    /// Which files are lists.
    lists: Vec<bool>,
    /// Where each name is written.
    written: OnceCell<Vec<Vec<u32>>>,
    /// Where the program ends.
    end: u32,
    /// Whether it is a program for an FX.
    pub is_fx: bool,
}

/// A page at its place in the program.
struct PageAt<'a> {
    page: &'a Page,
    /// Where it starts in the program.
    start: usize,
    /// The place of its file among those of the program.
    file: usize,
    /// The rungs of the file before it.
    rungs: usize,
    /// The units that start in the file before it.
    pous: usize,
    /// The numbers of its names in the program.
    table: Vec<u32>,
}

/// What is named.
pub struct Name<'a> {
    /// What makes it the same as another one.
    pub key: Key<'a>,
    /// Its declaration, if it is a declared variable.
    pub variable: Option<&'a Variable>,
}

/// What makes names mean the same.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Key<'a> {
    /// A device of the PLC.
    Device(Device),
    /// A direct address, also by the name of a variable that lies there.
    Direct(DirectAddress),
    /// A variable of all units.
    Global(&'a str),
    /// A variable of one unit: the number of the file, and of the unit in it, 0 for what stands outside of any.
    Local(usize, usize, &'a str),
}

/// An access at its place in the program.
#[derive(Clone, Copy)]
pub struct Use {
    /// What is done.
    pub access: Access,
    /// The cells of the name, in the program.
    pub span: Span,
    /// The place of its file among those of the program.
    pub file: usize,
    /// The number of its rung in the file, from 1.
    pub rung: usize,
    /// The units of its file that start before it; of no meaning for devices.
    pub unit: usize,
    /// The number of its page.
    page: usize,
}

impl Use {
    /// Whether both stand in the same rung.
    pub fn in_rung_of(&self, other: &Use) -> bool {
        // Chunks without an output count no rung of their own, but are none the same for that.
        (self.page, self.access.rung, self.access.chunk)
            == (other.page, other.access.rung, other.access.chunk)
    }

    /// Whether all of the one device or variable is meant.
    pub fn is_whole(&self) -> bool {
        self.access.part == Part::Whole && self.access.count == 1
    }
}

/// All that is done with a name, at one look.
#[derive(Clone, Copy, Default)]
pub struct Acts(u16);

impl Acts {
    const PAIR: u16 = 1 << 15;

    fn add(&mut self, access: &Access) {
        self.0 |= 1 << access.act as u16;
        if access.part == Part::Pair {
            self.0 |= Acts::PAIR;
        }
    }

    /// Whether any of `acts` is done.
    pub fn has(self, acts: &[Act]) -> bool {
        acts.iter().any(|act| self.0 & (1 << *act as u16) != 0)
    }

    /// Whether it is or may be written in another way than by `acts`.
    pub fn writes_but(self, acts: &[Act]) -> bool {
        Act::WRITES.iter().any(|act| !acts.contains(act) && self.has(&[*act]))
    }

    /// Whether it is or may be read.
    pub fn reads(self) -> bool {
        self.has(Act::READS)
    }

    /// Whether a 32-bit instruction takes it with the next register.
    pub fn has_pair(self) -> bool {
        self.0 & Acts::PAIR != 0
    }
}

impl<'a> Uses<'a> {
    /// The accesses of all files up to the end of the program.
    pub fn of(context: &ProgramContext<'a>) -> Uses<'a> {
        let end = context.executed().find(|statement| statement.flow() == Some(Flow::ProgramEnd));
        let end = end.map_or(u32::MAX, |end| end.span.start);
        let mut uses = Uses {
            pages: Vec::new(),
            names: Vec::new(),
            devices: FxHashMap::default(),
            numbers: FxHashMap::default(),
            acts: Vec::new(),
            starts: Vec::new(),
            order: Vec::new(),
            read_rows: Rows::default(),
            written_rows: Rows::default(),
            lists: context.files().iter().map(|file| file.document.notation() != Notation::Ladder).collect(),
            written: OnceCell::new(),
            end,
            is_fx: context.files().first().is_some_and(|file| is_fx_program(file.document)),
        };
        uses.number_names(context);
        uses.sort(end);
        for rows in [&mut uses.read_rows, &mut uses.written_rows] {
            rows.settle();
        }
        uses
    }

    /// Gives each name a number; for each page those of its own names.
    fn number_names(&mut self, context: &ProgramContext<'a>) {
        for (file, at) in context.files().iter().enumerate() {
            let scopes = at.document.scopes();
            let (mut start, mut rungs, mut pous) = (at.start, 0, 0);
            for page in at.document.pages() {
                let numbered = page.accesses().names.iter().map(|(pou, symbol)| {
                    let next = self.names.len() as u32;
                    let (name, number) = match symbol {
                        Symbol::Device(device) => {
                            let name = Name { key: Key::Device(*device), variable: None };
                            (name, *self.devices.entry(*device).or_insert(next))
                        }
                        _ => {
                            let name = name_of(symbol, file, pous + *pou as usize, scopes);
                            let number = *self.numbers.entry(name.key).or_insert(next);
                            (name, number)
                        }
                    };
                    if number == next {
                        self.names.push(name);
                    }
                    number
                });
                let table = numbered.collect();
                self.pages.push(PageAt { page, start, file, rungs, pous, table });
                start += page.bytes();
                rungs += page.size().rungs;
                pous += page.pou_starts();
            }
        }
    }

    /// Sorts the accesses before `end` by their names, and notes the rows among them.
    fn sort(&mut self, end: u32) {
        let mut counts = vec![0u32; self.names.len() + 1];
        let mut acts = vec![Acts::default(); self.names.len()];
        let within = |page: &PageAt<'_>| {
            let local_end = (end as usize).saturating_sub(page.start);
            page.page.accesses().all.partition_point(|access| (access.span.start as usize) < local_end)
        };
        let lengths: Vec<usize> = self.pages.iter().map(within).collect();
        for (page, length) in self.pages.iter().zip(&lengths) {
            for access in &page.page.accesses().all[..*length] {
                let name = page.table[access.name as usize] as usize;
                counts[name + 1] += 1;
                acts[name].add(access);
            }
        }
        for number in 1..counts.len() {
            counts[number] += counts[number - 1];
        }
        let mut next = counts.clone();
        let mut order = vec![(0, 0); counts.last().map_or(0, |count| *count as usize)];
        for (number, (page, length)) in self.pages.iter().zip(&lengths).enumerate() {
            for (place, access) in page.page.accesses().all[..*length].iter().enumerate() {
                let name = page.table[access.name as usize];
                let slot = &mut next[name as usize];
                order[*slot as usize] = (number as u32, place as u32);
                *slot += 1;
                if access.count > 1
                    && let Key::Device(device) = self.names[name as usize].key
                {
                    if access.act.reads() {
                        self.read_rows.add(device, access);
                    }
                    if access.act.writes() {
                        self.written_rows.add(device, access);
                    }
                }
            }
        }
        (self.acts, self.starts, self.order) = (acts, counts, order);
    }

    /// Every name with its number, in the order in which they first occur.
    pub fn names(&self) -> impl Iterator<Item = (u32, &Name<'a>)> {
        self.names.iter().enumerate().map(|(number, name)| (number as u32, name))
    }

    /// The name with this number.
    pub fn name(&self, number: u32) -> Option<&Name<'a>> {
        self.names.get(number as usize)
    }

    /// The number of what a declared name means in a unit of a file, or that of a direct address; units are counted as
    /// [`Key::Local`] does.
    pub fn named(&self, scopes: &'a Scopes, file: usize, unit: usize, symbol: &'a Symbol) -> Option<u32> {
        self.numbers.get(&name_of(symbol, file, unit, scopes).key).copied()
    }

    /// All that is accessed from one offset to another, each with the number of its name, in order.
    pub fn within(&self, start: u32, end: u32) -> impl Iterator<Item = (u32, Use)> {
        let first = self.pages.partition_point(|page| page.start <= start as usize).saturating_sub(1);
        let pages = self.pages.iter().enumerate().skip(first);
        let pages = pages.take_while(move |(_, page)| page.start < end as usize);
        pages.flat_map(move |(number, page)| {
            let all = &page.page.accesses().all;
            let at = |offset: u32| {
                all.partition_point(|access| (access.span.start as usize + page.start) < offset as usize)
            };
            let places = at(start)..at(end);
            places.map(move |place| (page.table[all[place].name as usize], self.at(number, place)))
        })
    }

    /// The chunk at an offset with its start, and how many units of its file have started when it ends.
    pub fn chunk_at(&self, offset: u32) -> Option<(usize, &'a Chunk, usize)> {
        let behind = self.pages.partition_point(|page| page.start <= offset as usize);
        let page = self.pages.get(behind.checked_sub(1)?)?;
        let (mut start, mut pous) = (page.start, page.pous);
        for chunk in page.page.chunks() {
            pous += chunk.pou_starts();
            if (offset as usize) < start + chunk.len() {
                return Some((start, chunk, pous));
            }
            start += chunk.len();
        }
        None
    }

    /// All that is done with a name.
    pub fn acts(&self, number: u32) -> Acts {
        self.acts.get(number as usize).copied().unwrap_or_default()
    }

    /// The number of a device, if it is named.
    pub fn device(&self, device: Device) -> Option<u32> {
        self.devices.get(&device).copied()
    }

    /// The accesses of a name in the order of execution.
    pub fn of_name(&self, number: u32) -> impl DoubleEndedIterator<Item = Use> + ExactSizeIterator {
        let place = |number: usize| self.starts.get(number).map_or(0, |start| *start as usize);
        let range = place(number as usize)..place(number as usize + 1);
        let places = self.order.get(range).unwrap_or_default();
        places.iter().map(|(page, place)| self.at(*page as usize, *place as usize))
    }

    /// The offsets at which a name is written, in order.
    pub fn written_at(&self, number: u32) -> &[u32] {
        let written = self.written.get_or_init(|| {
            let offsets = |number: u32| {
                if !self.acts(number).writes_but(&[]) {
                    return Vec::new();
                }
                let writes = self.of_name(number).filter(|one| one.access.act.writes());
                writes.map(|one| one.span.start).collect()
            };
            (0..self.names.len() as u32).map(offsets).collect()
        });
        written.get(number as usize).map_or(&[], Vec::as_slice)
    }

    fn at(&self, page: usize, place: usize) -> Use {
        let at = &self.pages[page];
        let access = at.page.accesses().all[place];
        Use {
            access,
            span: access.span.shifted(at.start),
            file: at.file,
            rung: at.rungs + access.rung as usize + 1,
            unit: at.pous + at.page.accesses().names[access.name as usize].0 as usize,
            page,
        }
    }

    /// What the rung of `one` accesses, each with the number of its name.
    pub fn in_rung(&self, one: &Use) -> impl Iterator<Item = (u32, Use)> {
        let page = &self.pages[one.page];
        let all = &page.page.accesses().all;
        let first = all.partition_point(|access| access.chunk < one.access.chunk);
        let chunk = one.access.chunk;
        let own = all[first..].iter().take_while(move |access| access.chunk == chunk);
        let (rung, number) = (one.access.rung, one.page);
        own.enumerate()
            .filter(move |(_, access)| access.rung == rung)
            .map(move |(place, access)| (page.table[access.name as usize], self.at(number, first + place)))
    }

    /// Calls `visit` with what each rung accesses, each with the number of its name.
    pub fn each_rung<'u>(&'u self, mut visit: impl FnMut(RungUses<'u, 'a>)) {
        for (number, page) in self.pages.iter().enumerate() {
            let all = &page.page.accesses().all;
            let length = (self.end as usize).saturating_sub(page.start);
            let length = all.partition_point(|access| (access.span.start as usize) < length);
            let mut first = 0;
            for rung in
                all[..length].chunk_by(|one, other| (one.chunk, one.rung) == (other.chunk, other.rung))
            {
                visit(RungUses { uses: self, page: number, places: first..first + rung.len() });
                first += rung.len();
            }
        }
    }

    /// The chunk of `one`, with its start in the program.
    pub fn chunk(&self, one: &Use) -> Option<(usize, &'a Chunk)> {
        let page = self.pages.get(one.page)?;
        let chunks = page.page.chunks();
        let before = chunks.iter().take(one.access.chunk as usize).map(|chunk| chunk.len()).sum::<usize>();
        Some((page.start + before, chunks.get(one.access.chunk as usize)?))
    }

    /// Whether `one` stands in a list and not in a drawing.
    pub fn is_list(&self, one: &Use) -> bool {
        self.lists.get(one.file).copied().unwrap_or(false)
    }

    /// The words of the name at `one`.
    pub fn words(&self, one: &Use) -> String {
        let words = self.chunk(one).and_then(|(start, chunk)| {
            chunk.text().get(one.span.start as usize - start..one.span.end as usize - start)
        });
        words.unwrap_or_default().to_string()
    }

    /// Whether `device` is read as a part of a row of several.
    pub fn is_read_in_row(&self, device: Device) -> bool {
        self.read_rows.covers(device)
    }

    /// Whether `device` is written as a part of a row of several.
    pub fn is_written_in_row(&self, device: Device) -> bool {
        self.written_rows.covers(device)
    }
}

/// What a rung accesses, in order.
#[derive(Clone)]
pub struct RungUses<'u, 'a> {
    uses: &'u Uses<'a>,
    page: usize,
    places: std::ops::Range<usize>,
}

impl Iterator for RungUses<'_, '_> {
    type Item = (u32, Use);

    fn next(&mut self) -> Option<(u32, Use)> {
        let place = self.places.next()?;
        let page = &self.uses.pages[self.page];
        let name = page.table[page.page.accesses().all[place].name as usize];
        Some((name, self.uses.at(self.page, place)))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.places.size_hint()
    }
}

fn name_of<'a>(symbol: &'a Symbol, file: usize, started: usize, scopes: &'a Scopes) -> Name<'a> {
    let plain = |key| Name { key, variable: None };
    match symbol {
        Symbol::Device(device) => plain(Key::Device(*device)),
        Symbol::Direct(address) => plain(Key::Direct(*address)),
        Symbol::Variable(name)
        | Symbol::Label(name)
        | Symbol::Pou(name)
        | Symbol::Type(name)
        | Symbol::Connector(name) => {
            let number = started.checked_sub(1);
            let variable = scopes.variable(number, name);
            let address = variable.and_then(|variable| variable.address).filter(|one| one.path[0].is_some());
            let is_global = variable.is_some_and(|variable| variable.section.is_global());
            let key = match address {
                Some(address) => Key::Direct(address),
                None if is_global => Key::Global(name),
                None => Key::Local(file, started, name),
            };
            Name { key, variable }
        }
    }
}

/// Rows of devices, put together where they touch.
#[derive(Default)]
struct Rows(Vec<(DeviceKind, u32, u32)>);

impl Rows {
    fn add(&mut self, device: Device, access: &Access) {
        let (first, end) = match (access.part, access.count) {
            // An index register may be negative.
            (Part::Indexed, _) => (0, u32::MAX),
            (_, Access::OPEN) => (device.number, u32::MAX),
            (_, count) => (device.number, device.number.saturating_add(u32::from(count))),
        };
        self.0.push((device.kind, first, end));
    }

    fn settle(&mut self) {
        self.0.sort_unstable();
        self.0.dedup_by(|later, earlier| {
            let joins = later.0 == earlier.0 && later.1 <= earlier.2;
            if joins {
                earlier.2 = earlier.2.max(later.2);
            }
            joins
        });
    }

    fn covers(&self, device: Device) -> bool {
        let behind =
            self.0.partition_point(|(kind, first, _)| (*kind, *first) <= (device.kind, device.number));
        behind
            .checked_sub(1)
            .and_then(|last| self.0.get(last))
            .is_some_and(|(kind, _, end)| *kind == device.kind && device.number < *end)
    }
}
