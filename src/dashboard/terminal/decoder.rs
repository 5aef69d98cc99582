//! A decoder that turns the bytes of a terminal into keys and mouse events.
//!
//! Terminals also send bytes that nobody has typed: pasted text, and replies to questions that
//! another program asked. The decoder swallows both whole, so that they do not act as keys. It
//! takes one byte at a time; a sequence that is split over several reads is the same sequence.

use std::time::Duration;

use ratatui::crossterm::event::{Event, KeyCode, KeyEvent, KeyModifiers};

use super::sequences;

const ESCAPE: u8 = 0x1b;
const BELL: u8 = 0x07;

/// Time after which ESC without further bytes is the Esc key.
const ESCAPE_TIME: Duration = Duration::from_millis(100);

/// Time without further bytes after which an open sequence counts as cut off.
const OPEN_TIME: Duration = Duration::from_secs(1);

/// Most bytes of a control sequence, and of a string; what is longer counts as cut off.
const LONGEST_SEQUENCE: usize = 256;
const LONGEST_STRING: usize = 1 << 14;

/// End of a pasted text.
const END_OF_PASTE: &[u8] = b"\x1b[201~";

/// The decoder: what is open, and its bytes so far.
#[derive(Debug, Default)]
pub(super) struct Decoder {
    open: Open,
    bytes: Vec<u8>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Open {
    /// Nothing: the next byte begins something.
    #[default]
    Nothing,
    /// A character of several bytes in UTF-8.
    Character(KeyModifiers),
    /// ESC, which is a key or begins a sequence.
    Escape,
    /// ESC O, which begins a function key.
    Function,
    /// ESC [, which begins a control sequence.
    Control,
    /// ESC [ M, which begins a mouse event of three bytes in the old encoding.
    OldMouse,
    /// A string of this introducer, which only replies have: DCS, SOS, OSC, PM or APC.
    String(u8),
    /// Pasted text.
    Paste,
}

impl Decoder {
    /// Takes a byte; returns the event that it completes.
    pub(super) fn take(&mut self, byte: u8) -> Option<Event> {
        match self.open {
            Open::Nothing => self.begin(byte, KeyModifiers::NONE),
            Open::Character(modifiers) => self.in_character(byte, modifiers),
            Open::Escape => self.after_escape(byte),
            Open::Function => self.in_function(byte),
            Open::Control => self.in_control(byte),
            Open::OldMouse => self.in_old_mouse(byte),
            Open::String(_) => {
                self.in_string(byte);
                None
            }
            Open::Paste => {
                self.in_paste(byte);
                None
            }
        }
    }

    /// Returns the time to wait for the next byte, or `None` if nothing is open.
    ///
    /// If it passes, the caller must call [`Decoder::give_up`].
    pub(super) fn patience(&self) -> Option<Duration> {
        match self.open {
            Open::Nothing => None,
            Open::Escape | Open::Function => Some(ESCAPE_TIME),
            Open::Control | Open::String(_) if self.bytes.is_empty() => Some(ESCAPE_TIME),
            _ => Some(OPEN_TIME),
        }
    }

    /// Closes what is open, because no more bytes have come: ESC is the Esc key, ESC and a
    /// character are the key with Alt, and anything longer was cut off.
    pub(super) fn give_up(&mut self) -> Option<Event> {
        let alone = self.bytes.is_empty();
        let open = self.close();
        match open {
            Open::Escape => key(KeyCode::Esc, KeyModifiers::NONE),
            Open::Function => character('O', KeyModifiers::ALT),
            Open::Control if alone => character('[', KeyModifiers::ALT),
            Open::String(introducer) if alone => {
                character(char::from(introducer), KeyModifiers::ALT)
            }
            _ => None,
        }
    }

    fn open(&mut self, open: Open) -> Option<Event> {
        self.bytes.clear();
        self.open = open;
        None
    }

    fn close(&mut self) -> Open {
        self.bytes.clear();
        std::mem::take(&mut self.open)
    }

    /// Takes the first byte of a key.
    fn begin(&mut self, byte: u8, modifiers: KeyModifiers) -> Option<Event> {
        self.close();
        let control = modifiers | KeyModifiers::CONTROL;
        match byte {
            ESCAPE => self.open(Open::Escape),
            b'\r' | b'\n' => key(KeyCode::Enter, modifiers),
            b'\t' => key(KeyCode::Tab, modifiers),
            0x7f => key(KeyCode::Backspace, modifiers),
            0 => key(KeyCode::Char(' '), control),
            0x01..=0x1a => key(KeyCode::Char(char::from(byte - 1 + b'a')), control),
            0x1c..=0x1f => key(KeyCode::Char(char::from(byte - 0x1c + b'4')), control),
            0x20..=0x7e => character(char::from(byte), modifiers),
            0x80.. => {
                self.open(Open::Character(modifiers));
                self.in_character(byte, modifiers)
            }
        }
    }

    fn in_character(&mut self, byte: u8, modifiers: KeyModifiers) -> Option<Event> {
        self.bytes.push(byte);
        match std::str::from_utf8(&self.bytes) {
            Ok(text) => {
                let event = text.chars().next().and_then(|c| character(c, modifiers));
                self.close();
                event
            }
            // The bytes so far begin a character.
            Err(error) if error.error_len().is_none() => None,
            Err(_) => {
                let first = self.bytes.len() == 1;
                self.close();
                // What was not the character's next byte begins something new.
                if first {
                    None
                } else {
                    self.begin(byte, KeyModifiers::NONE)
                }
            }
        }
    }

    fn after_escape(&mut self, byte: u8) -> Option<Event> {
        match byte {
            // The first ESC was a key; this one may begin a sequence.
            ESCAPE => key(KeyCode::Esc, KeyModifiers::NONE),
            b'[' => self.open(Open::Control),
            b'O' => self.open(Open::Function),
            b'P' | b'X' | b']' | b'^' | b'_' => self.open(Open::String(byte)),
            byte => self.begin(byte, KeyModifiers::ALT),
        }
    }

    fn in_function(&mut self, byte: u8) -> Option<Event> {
        if byte == ESCAPE {
            return self.open(Open::Escape);
        }
        self.close();
        sequences::function(byte)
    }

    fn in_control(&mut self, byte: u8) -> Option<Event> {
        let first = self.bytes.is_empty();
        match byte {
            ESCAPE => self.open(Open::Escape),
            b'M' if first => self.open(Open::OldMouse),
            // The Linux console sends ESC [ [ A for F1.
            b'[' if first => {
                self.bytes.push(byte);
                None
            }
            0x20..=0x3f if self.bytes.len() < LONGEST_SEQUENCE => {
                self.bytes.push(byte);
                None
            }
            0x40..=0x7e => {
                let parameters = std::mem::take(&mut self.bytes);
                self.close();
                if (parameters.as_slice(), byte) == (b"200", b'~') {
                    return self.open(Open::Paste);
                }
                sequences::control(&parameters, byte)
            }
            _ => {
                self.close();
                None
            }
        }
    }

    fn in_old_mouse(&mut self, byte: u8) -> Option<Event> {
        self.bytes.push(byte);
        let &[button, column, row] = self.bytes.as_slice() else {
            return None;
        };
        self.close();
        sequences::old_mouse(button, column, row)
    }

    /// Swallows a byte of a string, which ends with BEL or ESC \.
    fn in_string(&mut self, byte: u8) {
        if byte == BELL || (byte == b'\\' && self.bytes.last() == Some(&ESCAPE)) {
            self.close();
            return;
        }
        self.bytes.push(byte);
        if self.bytes.len() > LONGEST_STRING {
            self.close();
        }
    }

    /// Swallows a byte of a pasted text, however long it is.
    fn in_paste(&mut self, byte: u8) {
        self.bytes.push(byte);
        if self.bytes.ends_with(END_OF_PASTE) {
            self.close();
        } else if self.bytes.len() > LONGEST_SEQUENCE {
            let old = self.bytes.len() - END_OF_PASTE.len();
            self.bytes.drain(..old);
        }
    }
}

fn key(code: KeyCode, modifiers: KeyModifiers) -> Option<Event> {
    Some(Event::Key(KeyEvent::new(code, modifiers)))
}

fn character(c: char, modifiers: KeyModifiers) -> Option<Event> {
    key(KeyCode::Char(c), modifiers)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dashboard::keys::Key;
    use proptest::prelude::*;

    /// Returns the names of the keys in reads; after the last one no more bytes come.
    fn keys<'b>(reads: impl IntoIterator<Item = &'b [u8]>) -> Vec<String> {
        let mut decoder = Decoder::default();
        let mut events = Vec::new();
        for read in reads {
            events.extend(read.iter().filter_map(|&byte| decoder.take(byte)));
        }
        events.extend(decoder.give_up());
        assert_eq!(decoder.patience(), None);
        let name = |event| match event {
            Event::Key(event) => Key::of(event).map(|key| key.to_string()),
            other => Some(format!("{other:?}")),
        };
        events.into_iter().filter_map(name).collect()
    }

    /// What terminals send, and the keys that it stands for.
    const SENT: &[(&str, &[&str])] = &[
        ("aZ", &["a", "Z"]),
        ("ü宽🦀", &["ü", "宽", "🦀"]),
        (
            "\r\n\t\u{7f} ",
            &["enter", "enter", "tab", "backspace", "space"],
        ),
        ("\u{3}\u{1a}\0", &["ctrl-c", "ctrl-z", "ctrl-space"]),
        ("\u{1b}", &["esc"]),
        ("\u{1b}\u{1b}\u{1b}1", &["esc", "esc", "alt-1"]),
        ("\u{1b}gx", &["alt-g", "x"]),
        ("\u{1b}ü\u{1b}\u{3}", &["alt-ü", "ctrl-alt-c"]),
        ("\u{1b}O", &["alt-O"]),
        ("\u{1b}[", &["alt-["]),
        ("\u{1b}P", &["alt-P"]),
        ("\u{1b}]", &["alt-]"]),
        (
            "\u{1b}[A\u{1b}OB\u{1b}[1;5C\u{1b}[1;3D",
            &["up", "down", "ctrl-right", "alt-left"],
        ),
        (
            "\u{1b}[H\u{1b}[F\u{1b}[1~\u{1b}[8~\u{1b}OH",
            &["home", "end", "home", "end", "home"],
        ),
        (
            "\u{1b}[2~\u{1b}[3~\u{1b}[5~\u{1b}[6;5~",
            &["insert", "delete", "page-up", "ctrl-page-down"],
        ),
        ("\u{1b}[Z", &["shift-tab"]),
        (
            "\u{1b}OP\u{1b}[[B\u{1b}[13~\u{1b}[15~\u{1b}[24~\u{1b}[1;2S",
            &["f1", "f2", "f3", "f5", "f12", "f4"],
        ),
        ("\u{1b}[97;5u\u{1b}[27u\u{1b}[97;1:3u", &["ctrl-a", "esc"]),
        // Focus, and keys that have no name here.
        ("\u{1b}[I\u{1b}[O\u{1b}[99~\u{1b}[E\u{1b}Oxq", &["q"]),
        // Replies: colour, version, attributes, cursor, mode, size, keyboard, status.
        ("\u{1b}]11;rgb:ecec/eaea/e4e4\u{1b}\\q", &["q"]),
        ("\u{1b}]11;rgb:ecec/eaea/e4e4\u{7}q", &["q"]),
        ("\u{1b}P>|tmux 3.5a\u{1b}\\q", &["q"]),
        ("\u{1b}P1+r524742=38\u{1b}\\\u{1b}_Gi=1;OK\u{1b}\\q", &["q"]),
        ("\u{1b}^private\u{1b}\\\u{1b}Xstart\u{1b}\\q", &["q"]),
        ("\u{1b}[?6c\u{1b}[>41;390;0c\u{1b}[?1;2cq", &["q"]),
        (
            "\u{1b}[24;80R\u{1b}[?2026;2$y\u{1b}[8;40;120t\u{1b}[?1u\u{1b}[0nq",
            &["q"],
        ),
        // A string goes on after an ESC that does not end it.
        ("\u{1b}]0;a\u{1b}[Aq\u{7}q", &["q"]),
        // A paste, with what looks like keys, sequences and its own end.
        (
            "\u{1b}[200~pqe\r\u{1b}[A\u{1b}[201\u{3}\u{1b}[201~q",
            &["q"],
        ),
        ("\u{1b}[201~q", &["q"]),
        // Sequences that were cut off by the next one.
        ("\u{1b}[12\u{1b}[A\u{1b}O\u{1b}[B", &["up", "down"]),
        // Cut off at the end.
        ("q\u{1b}]11;rgb:ec", &["q"]),
        ("q\u{1b}[?6", &["q"]),
        ("q\u{1b}[200~pqe", &["q"]),
    ];

    #[test]
    fn keys_are_decoded_and_replies_and_pasted_text_are_swallowed() {
        for (sent, meant) in SENT {
            assert_eq!(keys([sent.as_bytes()]), *meant, "{sent:?}");
        }
    }

    #[test]
    fn an_open_string_or_sequence_does_not_swallow_keys_for_ever() {
        let string = [b"\x1b]".as_slice(), &[b'x'; LONGEST_STRING + 1], b"q"].concat();
        assert_eq!(keys([string.as_slice()]), ["q"]);
        let sequence = [b"\x1b[".as_slice(), &[b'1'; LONGEST_SEQUENCE + 1], b"q"].concat();
        assert_eq!(keys([sequence.as_slice()]), ["q"]);
        let paste = [
            b"\x1b[200~".as_slice(),
            &[b'q'; 1 << 16],
            END_OF_PASTE,
            b"q",
        ]
        .concat();
        assert_eq!(keys([paste.as_slice()]), ["q"]);
    }

    #[test]
    fn whatever_is_open_is_closed_after_a_time() {
        for (sent, time) in [
            ("\u{1b}", ESCAPE_TIME),
            ("\u{1b}]", ESCAPE_TIME),
            ("\u{1b}]1", OPEN_TIME),
            ("\u{1b}[200~pq", OPEN_TIME),
        ] {
            let mut decoder = Decoder::default();
            for &byte in sent.as_bytes() {
                assert_eq!(decoder.take(byte), None);
            }
            assert_eq!(decoder.patience(), Some(time), "{sent:?}");
            decoder.give_up();
            assert_eq!(decoder.take(b'q'), character('q', KeyModifiers::NONE));
        }
    }

    #[test]
    fn bytes_that_are_no_text_do_no_harm() {
        assert_eq!(keys([b"\xff\xc3q\x80\xe2\x82q".as_slice()]), ["q", "q"]);
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// What terminals send means the same however it is split over reads.
        #[test]
        fn any_split_gives_the_same_keys(
            sent in prop::collection::vec(prop::sample::select(SENT), 1..6),
            ends in prop::collection::vec(any::<prop::sample::Index>(), 0..12),
        ) {
            let bytes: Vec<u8> = sent.iter().flat_map(|(sent, _)| sent.bytes()).collect();
            let mut ends: Vec<_> = ends.iter().map(|end| end.index(bytes.len())).collect();
            ends.extend([0, bytes.len()]);
            ends.sort_unstable();
            let reads = ends.windows(2).map(|ends| &bytes[ends[0]..ends[1]]);
            prop_assert_eq!(keys(reads), keys([bytes.as_slice()]));
        }

        /// A reply or a paste between two keys leaves the keys alone.
        #[test]
        fn what_nobody_typed_gives_no_key(
            text in "[ -~]{0,40}",
            string in prop::sample::select(&["P", "X", "]", "^", "_"][..]),
        ) {
            let paste = format!("a\u{1b}[200~{text}\u{1b}[201~b");
            prop_assert_eq!(keys([paste.as_bytes()]), ["a", "b"]);
            let reply = format!("a\u{1b}{string}{text}\u{1b}\\b");
            prop_assert_eq!(keys([reply.as_bytes()]), ["a", "b"]);
        }
    }
}
