//! What must hold for any bytes: one function for each fuzz target. The fuzzer looks for bytes that break it, and the
//! tests of the package run it over the bytes kept in `fuzz/corpus`.

#![allow(dead_code, reason = "each target uses one of these")]

use rungwise::check::{self, Severities};
use rungwise::document::{Document, Edit, Notation};
use rungwise::ide::{self, Style};
use rungwise::link::frame::framed;
use rungwise::link::plc::{Plc, Server};
use rungwise::link::{Host, Line, Patience, Point, Switch, Transport, Watch};
use rungwise::project::{CommentsFile, FormatStyle, Manifest, decode};
use rungwise::target::{Model, Target};
use rungwise::text::{Encoding, Language, LineColumn, Span, TextEdit};
use std::collections::VecDeque;
use std::io;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

/// What must hold for any bytes.
pub type Body = fn(&[u8]);

/// A target by the name of its folder in `fuzz/corpus`.
pub const TARGETS: &[(&str, Body)] = &[
    ("fx", fx),
    ("iec", iec),
    ("ladder", ladder),
    ("edits", edits),
    ("session", session),
    ("manifest", manifest),
    ("comments", comments),
    ("port", port),
    ("peer", peer),
];

/// Instruction list of a PLC; the first byte chooses the model.
pub fn fx(bytes: &[u8]) {
    let (choice, text) = choice_and_text(bytes);
    let model = [Model::Fx1s, Model::Fx1n, Model::Fx2n, Model::Fx3u][usize::from(choice) % 4];
    holds(&Document::new(&text, Notation::FxIl, Target::of(model)));
}

/// Instruction List of IEC 61131-3.
pub fn iec(bytes: &[u8]) {
    holds(&Document::new(&String::from_utf8_lossy(bytes), Notation::IecIl, Target::of(Model::Iec)));
}

/// A ladder drawing; the first byte chooses devices or variables.
pub fn ladder(bytes: &[u8]) {
    let (choice, text) = choice_and_text(bytes);
    let model = [Model::Fx2n, Model::Iec][usize::from(choice) % 2];
    holds(&Document::new(&text, Notation::Ladder, Target::of(model)));
}

/// A document under edits: it is the document that one would read from its text.
///
/// The first byte chooses the language, the second how long the text is before the first edit; each edit is a place,
/// a length and how many of the following bytes come in.
pub fn edits(bytes: &[u8]) {
    let [choice, length, rest @ ..] = bytes else { return };
    let (notation, model) = [
        (Notation::FxIl, Model::Fx2n),
        (Notation::IecIl, Model::Iec),
        (Notation::Ladder, Model::Fx2n),
        (Notation::Ladder, Model::Iec),
    ][usize::from(*choice) % 4];
    let (text, mut rest) = rest.split_at(rest.len().min(usize::from(*length) * 4));
    let mut document = Document::new(&String::from_utf8_lossy(text), notation, Target::of(model));
    while let [place, gone, comes, more @ ..] = rest {
        let (new, more) = more.split_at(more.len().min(usize::from(*comes) % 16));
        rest = more;
        let start = inside(&document, document.len() * usize::from(*place) / 255);
        let end = inside(&document, start + usize::from(*gone) % 64).max(start);
        document.apply(&[Edit { range: Some(start..end), text: String::from_utf8_lossy(new).into_owned() }]);
    }
    let scratch = Document::new(&document.text(), notation, Target::of(model));
    let pieces = |document: &Document| -> Vec<String> {
        document.chunks().map(|at| at.chunk.text().to_string()).collect()
    };
    assert_eq!(pieces(&document), pieces(&scratch), "chunks");
    let found = |document: &Document| check::all(document, &Severities::default());
    assert_eq!(found(&document), found(&scratch), "diagnostics");
}

/// A client that sends these bytes: first as they are, then each line of them as the body of a frame.
pub fn session(bytes: &[u8]) {
    let mut framed = Vec::new();
    for body in bytes.split(|byte| *byte == b'\n') {
        framed.extend_from_slice(format!("Content-Length: {}\r\n\r\n", body.len()).as_bytes());
        framed.extend_from_slice(body);
    }
    for input in [bytes.to_vec(), framed] {
        serve(input);
    }
}

/// A manifest, with the place of what is wrong with it.
pub fn manifest(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    match Manifest::read(&text) {
        Ok(manifest) => drop((manifest.severities(), manifest.target(), manifest.notation())),
        Err(error) => {
            let Span { start, end } = error.span;
            assert!(text.get(start as usize..end as usize).is_some(), "{:?} of {}", error.span, text.len());
            assert!(!error.message.render(Language::English).is_empty());
        }
    }
}

/// A file of device comments, in any encoding.
pub fn comments(bytes: &[u8]) {
    let text = decode(bytes);
    let file = CommentsFile::read(Path::new("devices.csv"), &text, Target::of(Model::Fx2n));
    for found in &file.diagnostics {
        assert!(text.get(found.span.start as usize..found.span.end as usize).is_some(), "{found:?}");
        assert!(!found.message.render(Language::SimplifiedChinese).is_empty());
    }
    // A program of the words of the file is read with its symbols.
    holds(&Document::new(&text, Notation::FxIl, Target::of(Model::Fx2n)).commented(&file.comments));
}

/// From one scan of the virtual PLC to the next.
const SCAN_NS: i64 = 10_000_000;

/// A host that sends these bytes to the virtual PLC: as they are, then each line of them as the body of a frame. The
/// first byte chooses the model, the switch and what makes time pass.
pub fn port(bytes: &[u8]) {
    let (choice, bytes) = bytes.split_first().unwrap_or((&0, &[]));
    let model = [Model::Fx1s, Model::Fx1n, Model::Fx2n, Model::Fx3u][usize::from(*choice) % 4];
    let mut plc = Plc::new(Target::of(model), SCAN_NS);
    plc.power_on(if choice & 4 == 0 { Switch::Run } else { Switch::Stop }, 0);
    let mut server = if choice & 8 == 0 { Server::new(plc) } else { Server::stepped(plc, SCAN_NS) };
    let frames = bytes.split(|byte| *byte == b'\n').map(framed);
    for (number, piece) in [bytes.to_vec()].into_iter().chain(frames).enumerate() {
        let now_ns = number as i64 * SCAN_NS;
        server.advance(now_ns);
        piece.iter().for_each(|byte| drop(server.take(*byte, now_ns)));
    }
    let answers = |byte: &u8| server.take(*byte, 0).map_or(0, |answer| answer.bytes.len());
    assert_eq!(framed(b"00E0202").iter().map(answers).sum::<usize>(), 8, "it answers no more");
}

/// Somebody at the other end of a host's line: pieces of the bytes say what each answer is. A piece has a kind and a
/// length, and is sent as it is, as the body of a frame, or in the place of part of what the virtual PLC answers.
pub fn peer(bytes: &[u8]) {
    let (choice, script) = bytes.split_first().unwrap_or((&0, &[]));
    let model = [Model::Fx1s, Model::Fx1n, Model::Fx2n, Model::Fx3u][usize::from(*choice) % 4];
    let server = Server::new(Plc::new(Target::of(model), SCAN_NS));
    let line = Scripted {
        server,
        script: script.to_vec(),
        place: 0,
        on_the_way: VecDeque::new(),
        now: Duration::ZERO,
        sent: 0,
    };
    let patience = Patience { answer: Duration::from_secs(1), tries: 3 };
    let Ok(mut host) = Host::connect(Line::new(line, patience, Arc::default())) else { return };
    let target = host.identity().target;
    let points: Vec<Point> =
        ["X0", "D0", "C199", "M8000"].iter().filter_map(|name| Point::named(name, target)).collect();
    // What comes of each is told truly or is an error; here they only have to end.
    let _ = host.status();
    let _ = host.read(&points);
    let _ = host.poll(&mut Watch::new(points));
    if let Ok(plan) = host.plan(&[0x2400, 0xC500, 0x000F], target, &mut |_| {}) {
        let _ = host.download(&plan, true, &mut |_| {});
    }
}

/// The line of [`peer`].
struct Scripted {
    server: Server,
    script: Vec<u8>,
    place: usize,
    on_the_way: VecDeque<u8>,
    now: Duration,
    sent: usize,
}

impl Scripted {
    fn next(&mut self) -> u8 {
        self.place += 1;
        // Whoever has nothing more to say answers as a PLC does.
        self.script.get(self.place - 1).copied().unwrap_or(0)
    }
}

impl Transport for Scripted {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.sent += 1;
        assert!(self.sent < 50_000, "the host goes on for ever");
        let take = |byte: &u8| self.server.take(*byte, 0);
        let mut answer: Vec<u8> = bytes.iter().filter_map(take).flat_map(|answer| answer.bytes).collect();
        let kind = self.next();
        if !kind.is_multiple_of(4) {
            let length = self.next();
            let piece: Vec<u8> = (0..length).map(|_| self.next()).collect();
            match kind % 4 {
                1 => answer = piece,
                2 => answer = framed(&piece),
                _ => answer.iter_mut().zip(piece).for_each(|(place, byte)| *place ^= byte),
            }
        }
        self.on_the_way.extend(answer);
        Ok(())
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        let Some(byte) = self.on_the_way.pop_front() else {
            self.now += wait;
            return Ok(0);
        };
        self.now += Duration::from_millis(1);
        buffer[0] = byte;
        Ok(1)
    }

    fn set_baud(&mut self, _baud: u32) -> io::Result<()> {
        Ok(())
    }

    fn now(&self) -> Duration {
        self.now
    }
}

/// All that an editor asks of a document is answered with places inside it, and formatting is done after one time.
fn holds(document: &Document) {
    let text = document.text();
    let found = check::all(document, &Severities::default());
    for diagnostic in &found {
        assert!(
            text.get(diagnostic.span.start as usize..diagnostic.span.end as usize).is_some(),
            "{diagnostic:?}"
        );
        diagnostic.message.render(Language::English);
        for fix in &diagnostic.fixes {
            TextEdit::apply_all(&fix.edits, &text);
        }
    }
    let mut end = 0;
    for token in ide::semantic_tokens(document) {
        assert!(
            token.span.start >= end && text.get(token.span.start as usize..token.span.end as usize).is_some()
        );
        end = token.span.end;
    }
    for offset in [0, inside(document, text.len() / 3), inside(document, text.len() / 2), text.len()] {
        ide::hover(document, offset, Language::English);
        ide::completions(document, offset, Language::English);
        ide::definition(document, offset);
        ide::references(document, offset, true);
        // Most are refused, which is as good.
        let _ = ide::rename(document, offset, "M7");
    }
    ide::symbols(document, Language::English);
    ide::folds(document);
    ide::inlay_hints(document, Span::new(0, text.len()), Language::English);
    ide::status(document);
    for kind in [FormatStyle::Iec, FormatStyle::Brackets, FormatStyle::Unicode] {
        let style = Style { kind, width: 48 };
        let once = TextEdit::apply_all(&ide::format(document, style), &text);
        let again =
            Document::new(&once, document.notation(), document.target()).commented(document.comments());
        let twice = TextEdit::apply_all(&ide::format(&again, style), &once);
        assert_eq!(twice, once, "formatting {text:?} twice");
    }
}

/// Runs a server on `input` until it has read all of it and ended.
fn serve(input: Vec<u8>) {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_time().build();
    let Ok(runtime) = runtime else { return };
    let input = io::Cursor::new(input);
    let served = runtime.block_on(async {
        let session = rungwise::lsp::serve_between(input, tokio::io::sink(), None, Language::English);
        tokio::time::timeout(Duration::from_secs(10), session).await
    });
    assert!(served.is_ok(), "the server hangs");
}

fn choice_and_text(bytes: &[u8]) -> (u8, String) {
    let (choice, text) = bytes.split_first().unwrap_or((&0, &[]));
    (*choice, String::from_utf8_lossy(text).into_owned())
}

/// The next place at or before `offset` that lies between characters of the document.
fn inside(document: &Document, offset: usize) -> usize {
    let place = document.position(offset.min(document.len()), Encoding::Utf32);
    document.offset(LineColumn { line: place.line, column: place.column }, Encoding::Utf32)
}
