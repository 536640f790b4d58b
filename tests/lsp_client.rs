//! A scripted client against the real binary over standard input and output.

use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// No answer comes later than this on the slowest machine; a test that waits so long has failed.
pub const PATIENCE: Duration = Duration::from_secs(60);

/// A client with its server.
pub struct Client {
    server: Child,
    input: Option<ChildStdin>,
    messages: Receiver<(Instant, Value)>,
    kept: Vec<Value>,
    last_id: i64,
    /// When the message that was waited for last had come in, before it was understood.
    pub arrived: Instant,
    /// The answer to `initialize`.
    pub initialised: Value,
}

impl Client {
    /// A server that was just started.
    pub fn spawn() -> Client {
        Client::spawn_with(&[])
    }

    /// A server that was just started with further arguments.
    pub fn spawn_with(arguments: &[&str]) -> Client {
        Client::spawn_program(env!("CARGO_BIN_EXE_rungwise").as_ref(), arguments)
    }

    /// A server of the program `rungwise`, or another build of it.
    pub fn spawn_program(rungwise: &Path, arguments: &[&str]) -> Client {
        let mut server = Command::new(rungwise)
            .arg("lsp")
            .args(arguments)
            .env("LC_ALL", "C")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the binary starts");
        let output = server.stdout.take().expect("piped");
        let (sender, messages) = channel();
        std::thread::spawn(move || {
            let mut output = BufReader::new(output);
            while let Some(body) = read_body(&mut output) {
                let arrived = Instant::now();
                let Ok(message) = serde_json::from_slice(&body) else { return };
                if sender.send((arrived, message)).is_err() {
                    return;
                }
            }
        });
        let input = server.stdin.take();
        let (kept, arrived) = (Vec::new(), Instant::now());
        Client { server, input, messages, kept, last_id: 0, arrived, initialised: Value::Null }
    }

    /// A server after the handshake, with these capabilities and initialization options.
    pub fn start_with(capabilities: Value, options: Value) -> Client {
        let mut client = Client::spawn();
        client.initialise(capabilities, options);
        client
    }

    /// The handshake.
    pub fn initialise(&mut self, capabilities: Value, options: Value) {
        let params = json!({"processId": null, "rootUri": null, "capabilities": capabilities,
            "initializationOptions": options});
        self.initialised = self.request("initialize", params)["result"].clone();
        self.notify("initialized", json!({}));
    }

    /// A server after the handshake with a client that knows nothing special.
    pub fn start() -> Client {
        Client::start_with(json!({}), Value::Null)
    }

    pub fn send(&mut self, message: Value) {
        self.send_raw(message.to_string().as_bytes());
    }

    /// Any bytes as the body of a message.
    pub fn send_raw(&mut self, body: &[u8]) {
        let input = self.input.as_mut().expect("the input is open");
        // A server that has gone is seen by what it does not answer.
        let _ = write!(input, "Content-Length: {}\r\n\r\n", body.len());
        let _ = input.write_all(body);
        let _ = input.flush();
    }

    pub fn notify(&mut self, method: &str, params: Value) {
        self.send(json!({"jsonrpc": "2.0", "method": method, "params": params}));
    }

    /// Sends a request and returns its number.
    pub fn ask(&mut self, method: &str, params: Value) -> i64 {
        self.last_id += 1;
        self.send(json!({"jsonrpc": "2.0", "id": self.last_id, "method": method, "params": params}));
        self.last_id
    }

    /// Sends a request and waits for the whole answer.
    pub fn request(&mut self, method: &str, params: Value) -> Value {
        let id = self.ask(method, params);
        self.answer(id)
    }

    /// The answer to request number `id`.
    pub fn answer(&mut self, id: i64) -> Value {
        self.wait_for(&format!("the answer to request {id}"), |message| {
            message["id"] == json!(id) && message.get("method").is_none()
        })
    }

    /// Whether request number `id` is answered already.
    pub fn has_answer(&mut self, id: i64) -> bool {
        self.kept.extend(self.messages.try_iter().map(|(_, message)| message));
        self.kept.iter().any(|message| message["id"] == json!(id) && message.get("method").is_none())
    }

    /// The next notification or request of the server with this method.
    pub fn wait_for_method(&mut self, method: &str) -> Value {
        self.wait_for(method, |message| message["method"] == json!(method))
    }

    /// The diagnostics of `uri` at `version`.
    pub fn diagnostics(&mut self, uri: &str, version: i64) -> Vec<Value> {
        let message = self.wait_for(&format!("diagnostics of version {version}"), |message| {
            message["method"] == json!("textDocument/publishDiagnostics")
                && message["params"]["uri"] == json!(uri)
                && message["params"]["version"] == json!(version)
        });
        message["params"]["diagnostics"].as_array().expect("an array").clone()
    }

    /// The first message, in the order of arrival, that `wanted` takes; others are kept.
    pub fn wait_for(&mut self, what: &str, wanted: impl Fn(&Value) -> bool) -> Value {
        if let Some(place) = self.kept.iter().position(&wanted) {
            return self.kept.remove(place);
        }
        let end = Instant::now() + PATIENCE;
        loop {
            let left = end.saturating_duration_since(Instant::now());
            match self.messages.recv_timeout(left) {
                Ok((arrived, message)) if wanted(&message) => {
                    self.arrived = arrived;
                    return message;
                }
                Ok((_, message)) => self.kept.push(message),
                Err(_) => {
                    let short = |message: &Value| message.to_string().chars().take(300).collect::<String>();
                    let kept: Vec<String> = self.kept.iter().map(short).collect();
                    panic!("{what} did not come; there were:\n{}", kept.join("\n"))
                }
            }
        }
    }

    /// The first message that came already and that `wanted` takes.
    pub fn take(&mut self, wanted: impl Fn(&Value) -> bool) -> Option<Value> {
        self.kept.extend(self.messages.try_iter().map(|(_, message)| message));
        let place = self.kept.iter().position(wanted)?;
        Some(self.kept.remove(place))
    }

    /// The notifications with this method that came while something else was waited for.
    #[allow(dead_code, reason = "the bench asks")]
    pub fn notified(&self, method: &str) -> Vec<&Value> {
        self.kept.iter().filter(|message| message["method"] == json!(method)).collect()
    }

    /// Whether nothing that `unwanted` takes comes within `time`.
    pub fn stays_silent(&mut self, time: Duration, unwanted: impl Fn(&Value) -> bool) -> bool {
        let end = Instant::now() + time;
        while let Ok((_, message)) = self.messages.recv_timeout(end.saturating_duration_since(Instant::now()))
        {
            self.kept.push(message);
        }
        !self.kept.iter().any(unwanted)
    }

    pub fn open(&mut self, uri: &str, language: &str, text: &str) {
        self.notify(
            "textDocument/didOpen",
            json!({"textDocument": {"uri": uri, "languageId": language, "version": 1, "text": text}}),
        );
    }

    /// Replaces the characters between two places.
    pub fn change(&mut self, uri: &str, version: i64, from: (u32, u32), to: (u32, u32), text: &str) {
        let range =
            json!({"start": {"line": from.0, "character": from.1}, "end": {"line": to.0, "character": to.1}});
        self.notify(
            "textDocument/didChange",
            json!({"textDocument": {"uri": uri, "version": version}, "contentChanges": [{"range": range, "text": text}]}),
        );
    }

    /// Closes the server's input, as a client that dies does.
    pub fn hang_up(&mut self) {
        self.input = None;
    }

    /// The processor time that the server has used, where the system tells, in steps of 10 ms.
    #[allow(dead_code, reason = "the bench asks")]
    pub fn processor_time(&self) -> Option<Duration> {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.server.id())).ok()?;
        // Behind the name, which may contain blanks: user time is the 12th field, system time the 13th.
        let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
        let ticks = fields.get(11)?.parse::<u64>().ok()? + fields.get(12)?.parse::<u64>().ok()?;
        Some(Duration::from_millis(ticks * 10))
    }

    /// The server's memory in KiB, where the system tells.
    pub fn resident_kib(&self) -> Option<u64> {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.server.id())).ok()?;
        let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
        line.split_whitespace().nth(1)?.parse().ok()
    }

    /// How the server ends.
    pub fn exit_status(&mut self) -> ExitStatus {
        let end = Instant::now() + PATIENCE;
        while Instant::now() < end {
            if let Some(status) = self.server.try_wait().expect("the server can be asked") {
                return status;
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        panic!("the server does not end");
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// Parameters of a request about a place.
pub fn at(uri: &str, line: u32, character: u32) -> Value {
    json!({"textDocument": {"uri": uri}, "position": {"line": line, "character": character}})
}

/// The codes of diagnostics, in their order.
pub fn codes(diagnostics: &[Value]) -> Vec<String> {
    diagnostics.iter().map(|diagnostic| diagnostic["code"].as_str().unwrap_or("?").to_string()).collect()
}

/// The next message of a program that writes as language servers and debug adapters do; nothing at its end.
pub fn read_body(output: &mut impl BufRead) -> Option<Vec<u8>> {
    let mut length = 0;
    loop {
        let mut line = String::new();
        if output.read_line(&mut line).ok()? == 0 {
            return None;
        }
        if line == "\r\n" {
            break;
        }
        if let Some(number) = line.strip_prefix("Content-Length: ") {
            length = number.trim().parse().ok()?;
        }
    }
    let mut body = vec![0; length];
    output.read_exact(&mut body).ok()?;
    Some(body)
}
