//! A scripted client of the debug adapter: the real binary over standard input and output.

use crate::lsp_client::{PATIENCE, read_body};
use serde_json::{Value, json};
use std::io::{BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};

/// A client with its adapter.
pub struct Debugger {
    adapter: Child,
    input: Option<ChildStdin>,
    messages: Receiver<Value>,
    /// Events that were not waited for yet.
    events: Vec<Value>,
    last: i64,
}

impl Debugger {
    /// An adapter that has answered `initialize`.
    pub fn start() -> Debugger {
        let mut debugger = Debugger::spawn();
        let capabilities = debugger.ask("initialize", json!({ "adapterID": "rungwise", "locale": "en" }));
        assert_eq!(capabilities["supportsStepBack"], true, "{capabilities}");
        debugger
    }

    /// An adapter that was just started.
    pub fn spawn() -> Debugger {
        let mut adapter = Command::new(env!("CARGO_BIN_EXE_rungwise"))
            .arg("dap")
            .env("LC_ALL", "C")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the binary starts");
        let output = adapter.stdout.take().expect("piped");
        let (sender, messages) = channel();
        std::thread::spawn(move || {
            let mut output = BufReader::new(output);
            while let Some(body) = read_body(&mut output) {
                let Ok(message) = serde_json::from_slice(&body) else { return };
                if sender.send(message).is_err() {
                    return;
                }
            }
        });
        let input = adapter.stdin.take();
        Debugger { adapter, input, messages, events: Vec::new(), last: 0 }
    }

    /// A program that stops at its first instruction; `more` are further arguments of `launch`.
    pub fn launch(program: &Path, more: Value) -> Debugger {
        let mut debugger = Debugger::start();
        let mut arguments = json!({ "program": program, "stopOnEntry": true, "speed": 0 });
        arguments.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        debugger.ask("launch", arguments);
        debugger.event("initialized");
        debugger
    }

    /// Ends the configuration, and waits until the program stops.
    pub fn begin(&mut self) -> Value {
        self.ask("configurationDone", json!({}));
        self.event("stopped")
    }

    pub fn write(&mut self, bytes: &[u8]) {
        let input = self.input.as_mut().expect("open");
        input.write_all(bytes).and_then(|()| input.flush()).expect("the adapter reads");
    }

    /// The client goes away without a word.
    pub fn hang_up(&mut self) {
        self.input = None;
    }

    /// Sends a request without waiting for its answer; gives its number.
    pub fn send(&mut self, command: &str, arguments: Value) -> i64 {
        self.last += 1;
        let seq = self.last;
        let request = json!({ "seq": seq, "type": "request", "command": command, "arguments": arguments });
        let body = request.to_string();
        self.write(format!("Content-Length: {}\r\n\r\n{body}", body.len()).as_bytes());
        seq
    }

    /// The answer to a request, whatever it is.
    pub fn answer(&mut self, command: &str, arguments: Value) -> Value {
        let seq = self.send(command, arguments);
        loop {
            let message = self.message(command);
            if message["type"] == "response" && message["request_seq"] == seq {
                return message;
            }
            self.events.push(message);
        }
    }

    /// The body of the answer to a request that succeeds.
    #[track_caller]
    pub fn ask(&mut self, command: &str, arguments: Value) -> Value {
        let answer = self.answer(command, arguments);
        assert_eq!(answer["success"], true, "{answer}");
        answer["body"].clone()
    }

    /// What a request that fails says.
    #[track_caller]
    pub fn refusal(&mut self, command: &str, arguments: Value) -> String {
        let answer = self.answer(command, arguments);
        assert_eq!(answer["success"], false, "{answer}");
        answer["message"].as_str().unwrap().to_string()
    }

    /// The body of the next event of this name.
    pub fn event(&mut self, name: &str) -> Value {
        loop {
            if let Some(at) = self.events.iter().position(|event| event["event"] == name) {
                return self.events.remove(at)["body"].clone();
            }
            let message = self.message(name);
            self.events.push(message);
        }
    }

    /// What was said in the console and not waited for.
    pub fn said(&mut self) -> Vec<String> {
        let (said, other) =
            std::mem::take(&mut self.events).into_iter().partition(|e| e["event"] == "output");
        self.events = other;
        let said: Vec<Value> = said;
        said.iter().map(|event| event["body"]["output"].as_str().unwrap().trim_end().to_string()).collect()
    }

    fn message(&mut self, what: &str) -> Value {
        self.messages.recv_timeout(PATIENCE).unwrap_or_else(|_| panic!("{what}; before it {:?}", self.events))
    }

    /// Goes on in some way, and waits until the program stops.
    #[track_caller]
    pub fn go(&mut self, command: &str) -> Value {
        self.ask(command, json!({ "threadId": 1 }));
        self.event("stopped")
    }

    /// The innermost frames as `name @line:column`, and the scan.
    pub fn stack(&mut self) -> Vec<String> {
        let stack = self.ask("stackTrace", json!({ "threadId": 1 }));
        let frames = stack["stackFrames"].as_array().unwrap().iter();
        frames
            .map(|frame| match frame["line"].as_i64() {
                Some(0) => frame["name"].as_str().unwrap().to_string(),
                _ => format!("{} @{}:{}", frame["name"].as_str().unwrap(), frame["line"], frame["column"]),
            })
            .collect()
    }

    /// The innermost frame and the scan.
    pub fn here(&mut self) -> String {
        let stack = self.stack();
        format!("{}, {}", stack[0], stack[stack.len() - 1])
    }

    /// The value of an expression.
    #[track_caller]
    pub fn value(&mut self, expression: &str) -> String {
        let body =
            self.ask("evaluate", json!({ "expression": expression, "context": "watch", "frameId": 1 }));
        body["result"].as_str().unwrap().to_string()
    }

    /// What a line of the console gives.
    #[track_caller]
    pub fn console(&mut self, line: &str) -> String {
        let body = self.ask("evaluate", json!({ "expression": line, "context": "repl", "frameId": 1 }));
        body["result"].as_str().unwrap().to_string()
    }

    /// Sets breakpoints in a file; gives what became of them.
    #[track_caller]
    pub fn breakpoints(&mut self, path: &Path, breakpoints: Value) -> Vec<Value> {
        let arguments = json!({ "source": { "path": path }, "breakpoints": breakpoints });
        self.ask("setBreakpoints", arguments)["breakpoints"].as_array().unwrap().clone()
    }

    /// Waits for the end of the process; its exit code.
    pub fn exit_code(mut self) -> Option<i32> {
        self.adapter.wait().unwrap().code()
    }
}

impl Drop for Debugger {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.adapter.kill();
        let _ = self.adapter.wait();
    }
}
