//! A pseudo-terminal that runs a program: tests read its screen and press its keys.

// The benchmark of the dashboard compiles this module too and uses a part of it.
#![allow(dead_code)]

use std::io::{Read, Write};
use std::num::NonZeroU16;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use maxq_lab::dashboard::terminal::LARGEST_SIDE;
use portable_pty::{Child, CommandBuilder, ExitStatus, MasterPty, PtySize, native_pty_system};

/// The limit of every wait: generous, for a loaded machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// Time between two checks of a condition.
const INTERVAL: Duration = Duration::from_millis(5);

pub struct Pty {
    master: Option<Box<dyn MasterPty + Send>>,
    keys: Arc<Mutex<Option<Box<dyn Write + Send>>>>,
    pub child: Box<dyn Child + Send + Sync>,
    output: Arc<Output>,
    reader: Option<JoinHandle<()>>,
    modes_before: String,
}

/// The output of the program.
struct Output {
    parser: Mutex<vt100::Parser>,
    bytes: AtomicU64,
    stalled: AtomicBool,
    closing: AtomicBool,
    /// The latest bytes, to search for escape sequences.
    raw: Mutex<Vec<u8>>,
}

/// What a program asks at its start, and the answer of a terminal without a background colour.
const QUESTION: &[u8] = b"\x1b]11;?\x1b\\\x1b[c";
const ATTRIBUTES: &str = "\x1b[?62;22c";

fn nonzero(number: u16) -> NonZeroU16 {
    NonZeroU16::new(number).unwrap()
}

fn size(columns: u16, rows: u16) -> PtySize {
    PtySize {
        rows,
        cols: columns,
        pixel_width: 0,
        pixel_height: 0,
    }
}

/// An empty screen of this size, up to the largest frame that the program draws.
fn screen(columns: u16, rows: u16) -> vt100::Parser {
    let [columns, rows] = [columns, rows].map(up_to_the_largest_frame);
    vt100::Parser::new(rows, columns, 0)
}

fn up_to_the_largest_frame(side: u16) -> NonZeroU16 {
    nonzero(side.min(LARGEST_SIDE))
}

/// The program, independent of the environment of the test.
pub fn program(arguments: &[&str]) -> CommandBuilder {
    let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_maxq-lab"));
    command.args(arguments);
    in_environment(command)
}

/// A command, independent of the environment of the test.
pub fn in_environment(mut command: CommandBuilder) -> CommandBuilder {
    command.env("TERM", "xterm-256color");
    command.env("LC_ALL", "C.UTF-8");
    command.env_remove("NO_COLOR");
    command
}

impl Pty {
    /// Starts a command in a new terminal.
    pub fn start(columns: u16, rows: u16, command: CommandBuilder) -> Self {
        Self::answering(columns, rows, command, ATTRIBUTES)
    }

    /// Starts a command in a new terminal, which answers the question for its background with
    /// `answer`.
    pub fn answering(columns: u16, rows: u16, command: CommandBuilder, answer: &str) -> Self {
        let pair = native_pty_system().openpty(size(columns, rows)).unwrap();
        let modes_before = modes(pair.master.as_ref());
        let mut reader = pair.master.try_clone_reader().unwrap();
        let keys = Arc::new(Mutex::new(Some(pair.master.take_writer().unwrap())));
        let child = pair.slave.spawn_command(command).unwrap();
        drop(pair.slave);
        let output = Arc::new(Output {
            parser: Mutex::new(screen(columns, rows)),
            bytes: AtomicU64::new(0),
            stalled: AtomicBool::new(false),
            closing: AtomicBool::new(false),
            raw: Mutex::new(Vec::new()),
        });
        let showing = Arc::clone(&output);
        let (answering, answer) = (Arc::clone(&keys), answer.as_bytes().to_vec());
        let reader = thread::spawn(move || {
            let mut buffer = [0; 1 << 14];
            while let Ok(count) = reader.read(&mut buffer) {
                showing.take(&buffer[..count]);
                if buffer[..count]
                    .windows(QUESTION.len())
                    .any(|part| part == QUESTION)
                    && let Some(keys) = answering.lock().unwrap().as_mut()
                {
                    keys.write_all(&answer).unwrap();
                    keys.flush().unwrap();
                }
                while showing.stalled.load(Ordering::SeqCst) {
                    thread::sleep(INTERVAL);
                }
                if count == 0 || showing.closing.load(Ordering::SeqCst) {
                    return;
                }
            }
        });
        Self {
            master: Some(pair.master),
            keys,
            child,
            output,
            reader: Some(reader),
            modes_before,
        }
    }

    /// The text on the screen.
    pub fn screen(&self) -> String {
        self.output.parser.lock().unwrap().screen().contents()
    }

    /// The number of bytes that the program has written.
    pub fn bytes(&self) -> u64 {
        self.output.bytes.load(Ordering::SeqCst)
    }

    /// The latest output of the program.
    pub fn raw(&self) -> Vec<u8> {
        self.output.raw.lock().unwrap().clone()
    }

    /// Waits until `holds`; panics with the screen if it never does.
    pub fn wait(&self, what: &str, mut holds: impl FnMut(&Self) -> bool) {
        let begun = Instant::now();
        while !holds(self) {
            if begun.elapsed() > PATIENCE {
                panic!("waiting for {what}; the screen is:\n{}", self.screen());
            }
            thread::sleep(INTERVAL);
        }
    }

    /// Waits until a text is on the screen.
    pub fn wait_for(&self, text: &str) {
        self.wait(&format!("{text:?}"), |pty| pty.screen().contains(text));
    }

    /// Waits until a text is not on the screen.
    pub fn wait_gone(&self, text: &str) {
        self.wait(&format!("no {text:?}"), |pty| !pty.screen().contains(text));
    }

    /// Presses keys.
    pub fn press(&mut self, keys: &str) {
        self.send(keys.as_bytes());
    }

    /// Sends bytes as a keyboard would.
    pub fn send(&mut self, bytes: &[u8]) {
        let mut keys = self.keys.lock().unwrap();
        let keys = keys.as_mut().unwrap();
        keys.write_all(bytes).unwrap();
        keys.flush().unwrap();
    }

    /// Resizes the window.
    pub fn resize(&mut self, columns: u16, rows: u16) {
        // Locked, so that no output for the new size reaches a screen of the old one.
        let mut parser = self.output.parser.lock().unwrap();
        parser.set_size(
            up_to_the_largest_frame(rows),
            up_to_the_largest_frame(columns),
        );
        let master = self.master.as_ref().unwrap();
        master.resize(size(columns, rows)).unwrap();
    }

    /// Stops reading the output of the program, or reads it again.
    pub fn stall(&self, stalled: bool) {
        self.output.stalled.store(stalled, Ordering::SeqCst);
    }

    /// The program's process id.
    pub fn id(&self) -> u32 {
        self.child.process_id().unwrap()
    }

    /// Sends the program a signal.
    pub fn signal(&self, name: &str) {
        signal(name, self.id());
    }

    /// Closes the terminal of the program, which must be one that draws.
    ///
    /// The program receives Enter and Ctrl-D first. The rest of a stalled output is not read.
    pub fn hang_up(&mut self) {
        self.output.closing.store(true, Ordering::SeqCst);
        self.stall(false);
        // The reader holds the terminal until there is output; a resize makes the program draw.
        let reader = self.reader.take().unwrap();
        let mut columns = 100;
        while !reader.is_finished() {
            let master = self.master.as_ref().unwrap();
            master.resize(size(columns, 40)).unwrap();
            columns = 201 - columns;
            thread::sleep(INTERVAL);
        }
        reader.join().unwrap();
        *self.keys.lock().unwrap() = None;
        self.master = None;
    }

    /// Waits for the end of the program.
    pub fn ended(&mut self) -> ExitStatus {
        let begun = Instant::now();
        loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                return status;
            }
            if begun.elapsed() > PATIENCE {
                panic!(
                    "the program does not end; the screen is:\n{}",
                    self.screen()
                );
            }
            thread::sleep(INTERVAL);
        }
    }

    /// Whether the program shows the alternate screen.
    pub fn is_taken(&self) -> bool {
        let parser = self.output.parser.lock().unwrap();
        parser.screen().alternate_screen()
    }

    /// Waits until the terminal is restored: line modes, main screen, cursor, mouse, pasting.
    pub fn wait_given_back(&self) {
        self.wait("the terminal's modes", |pty| {
            pty.modes() == pty.modes_before
        });
        self.wait("the screen", |pty| {
            let parser = pty.output.parser.lock().unwrap();
            let screen = parser.screen();
            !screen.alternate_screen()
                && !screen.hide_cursor()
                && !screen.bracketed_paste()
                && screen.mouse_protocol_mode() == vt100::MouseProtocolMode::None
                && screen.fgcolor() == vt100::Color::Default
        });
    }

    /// The line modes, as comparable text.
    pub fn modes(&self) -> String {
        modes(self.master.as_ref().unwrap().as_ref())
    }
}

impl Drop for Pty {
    fn drop(&mut self) {
        self.stall(false);
        let _ended = self.child.kill();
        let _reaped = self.child.wait();
    }
}

impl Output {
    fn take(&self, bytes: &[u8]) {
        self.parser.lock().unwrap().process(bytes);
        let mut raw = self.raw.lock().unwrap();
        raw.extend_from_slice(bytes);
        if raw.len() > 1 << 22 {
            raw.drain(..1 << 21);
        }
        self.bytes.fetch_add(bytes.len() as u64, Ordering::SeqCst);
    }
}

fn modes(master: &dyn MasterPty) -> String {
    format!("{:?}", master.get_termios())
}

/// Sends a process a signal.
pub fn signal(name: &str, process: u32) {
    let mut kill = std::process::Command::new("kill");
    let sent = kill.args(["-s", name, &process.to_string()]).status();
    assert!(sent.unwrap().success(), "kill -s {name} {process}");
}

/// The processor time of a process, in seconds; `None` if the process does not exist.
pub fn processor_seconds(process: u32) -> Option<f64> {
    let stat = std::fs::read_to_string(Path::new("/proc").join(process.to_string()).join("stat"));
    let stat = stat.ok()?;
    // The program name, in brackets, may contain anything.
    let fields: Vec<_> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |at: usize| fields.get(at)?.parse::<f64>().ok();
    // Linux reports 100 ticks per second to programs.
    Some((ticks(11)? + ticks(12)?) / 100.0)
}
