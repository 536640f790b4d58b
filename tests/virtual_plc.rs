//! `rungwise plc` as a process, with somebody in front of it, and a proxy that sees what goes over its line.

use crate::binary::command;
use std::io::{BufRead, BufReader, Lines, Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Stdio};
use std::sync::{Arc, Mutex};

/// A virtual PLC that ends with the test.
pub struct VirtualPlc {
    child: Child,
    person: ChildStdin,
    said: Lines<BufReader<ChildStdout>>,
    /// As it stands behind `--port`.
    pub port: String,
}

impl VirtualPlc {
    /// On any free TCP port.
    pub fn start(folder: &Path, arguments: &[&str]) -> VirtualPlc {
        VirtualPlc::listening(folder, &[&["--listen", "127.0.0.1:0"], arguments].concat())
    }

    /// Wherever the arguments say.
    pub fn listening(folder: &Path, arguments: &[&str]) -> VirtualPlc {
        let mut command = command(folder, &[&["plc"], arguments].concat());
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
        let person = child.stdin.take().unwrap();
        let mut said = BufReader::new(child.stdout.take().unwrap()).lines();
        let first = said.next().expect("it says where it listens").unwrap();
        let port = first.split_whitespace().last().unwrap().to_string();
        VirtualPlc { child, person, said, port }
    }

    /// Somebody types a line that is not answered.
    pub fn tell(&mut self, line: &str) {
        writeln!(self.person, "{line}").unwrap();
    }

    /// Somebody types a line, and reads the answer.
    pub fn ask(&mut self, line: &str) -> String {
        self.tell(line);
        self.said.next().expect("it answers").unwrap()
    }

    /// Where it listens, without the scheme.
    pub fn address(&self) -> &str {
        self.port.strip_prefix("tcp://").unwrap()
    }

    /// Its process.
    #[cfg(unix)]
    pub fn process(&self) -> &Child {
        &self.child
    }

    /// Waits for its end; gives its exit code.
    pub fn ended(&mut self) -> Option<i32> {
        self.child.wait().unwrap().code()
    }

    /// It is switched off in good order; gives its exit code.
    pub fn quit(mut self) -> Option<i32> {
        self.tell("quit");
        self.ended()
    }
}

impl Drop for VirtualPlc {
    fn drop(&mut self) {
        // It may be over already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Lets several hosts speak with the PLC at `address`, a request and its answer after the other, as PLCs with several
/// ports do; where `refuses` says so of the body of a request, the PLC says no. Gives its own address, as behind
/// `--port`.
pub fn shared(address: &str, refuses: impl Fn(&str) -> bool + Send + Sync + 'static) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = format!("tcp://{}", listener.local_addr().unwrap());
    let plc = Arc::new(Mutex::new(TcpStream::connect(address).unwrap()));
    let refuses = Arc::new(refuses);
    std::thread::spawn(move || {
        for mut host in listener.incoming().map_while(Result::ok) {
            let (plc, refuses) = (Arc::clone(&plc), Arc::clone(&refuses));
            std::thread::spawn(move || -> std::io::Result<()> {
                loop {
                    let request = word(&mut host)?;
                    let body = request.split(|byte| *byte == 3).next().unwrap_or_default();
                    let body = String::from_utf8_lossy(body.get(1..).unwrap_or_default()).into_owned();
                    let answer = match refuses(&body) {
                        true => vec![0x15],
                        false => {
                            let mut plc = plc.lock().unwrap();
                            plc.write_all(&request)?;
                            word(&mut *plc)?
                        }
                    };
                    host.write_all(&answer)?;
                }
            });
        }
    });
    port
}

/// A request or an answer: a frame with its sum, or a byte that stands alone.
fn word(stream: &mut impl Read) -> std::io::Result<Vec<u8>> {
    let mut word = vec![0];
    stream.read_exact(&mut word)?;
    while word[0] == 2 && !word.iter().rev().skip(2).take(1).any(|byte| *byte == 3) {
        let mut byte = [0];
        stream.read_exact(&mut byte)?;
        word.extend(byte);
    }
    Ok(word)
}

/// What a proxy does with a request.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Pass {
    On,
    /// Both ends of the line are pulled.
    Cut,
}

/// Listens for one host and passes its requests to the PLC at `address`, as long as `judge` says so of each body.
/// Gives its own address, as behind `--port`.
pub fn proxy(address: &str, mut judge: impl FnMut(&str) -> Pass + Send + 'static) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = format!("tcp://{}", listener.local_addr().unwrap());
    let mut plc = TcpStream::connect(address).unwrap();
    std::thread::spawn(move || {
        let (mut host, _) = listener.accept().unwrap();
        let (mut answers, mut back) = (plc.try_clone().unwrap(), host.try_clone().unwrap());
        std::thread::spawn(move || std::io::copy(&mut answers, &mut back));
        let mut body = Vec::new();
        let mut byte = [0];
        while let Ok(1) = host.read(&mut byte) {
            if byte == [2] {
                body.clear();
            }
            // A request is judged when its last byte is still to come.
            if byte == [3] && judge(&String::from_utf8_lossy(body.get(1..).unwrap_or_default())) == Pass::Cut
            {
                break;
            }
            body.extend(byte);
            if plc.write_all(&byte).is_err() {
                break;
            }
        }
        let _ = host.shutdown(Shutdown::Both);
        let _ = plc.shutdown(Shutdown::Both);
    });
    port
}
