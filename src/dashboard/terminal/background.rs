//! The background of the terminal, which the theme must suit: the terminal is asked for it.

use std::io;
use std::time::{Duration, Instant};

use ratatui::crossterm::event::Event;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;

use super::decoder::Decoder;
use super::tty::Tty;

/// Asks for the background colour (OSC 11), then for the attributes of the terminal (DA1). Every
/// terminal answers the second question, so one that does not know the first is not waited for.
const QUESTION: &[u8] = b"\x1b]11;?\x1b\\\x1b[c";

/// Start of the answer to the first question.
const COLOUR: &[u8] = b"\x1b]11;";

/// Longest wait for an answer. One that comes later is swallowed with other replies.
const PATIENCE: Duration = Duration::from_millis(150);

/// Most bytes that are read while waiting.
const MOST: usize = 1 << 12;

/// Whether dark or bright text can be read on a terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Background {
    /// Bright text can.
    Dark,
    /// Dark text can.
    Light,
}

impl Background {
    /// Returns the background that `COLORFGBG` states: numbers of colours, the last of which is the
    /// background's. Some terminals set it, and it may be that of another terminal.
    #[must_use]
    pub fn of_hint(colours: &str) -> Option<Self> {
        let (_, background) = colours.rsplit_once(';')?;
        match background.parse().ok()? {
            0..=6 | 8 => Some(Self::Dark),
            7 | 9..=15 => Some(Self::Light),
            _ => None,
        }
    }

    /// Returns the background of a colour as terminals answer: `rgb:RRRR/GGGG/BBBB`, with one to
    /// four hexadecimal digits each.
    fn of_colour(text: &str) -> Option<Self> {
        let numbers = text.strip_prefix("rgb:").or(text.strip_prefix("rgba:"))?;
        let share = |digits: &str| {
            let most = 16_u32.checked_pow(u32::try_from(digits.len()).ok()?)?;
            let number = u32::from_str_radix(digits, 16).ok()?;
            (digits.len() <= 4).then(|| f64::from(number) / f64::from(most - 1))
        };
        let mut shares = numbers.split('/').map(share);
        let (red, green, blue) = (shares.next()??, shares.next()??, shares.next()??);
        // How bright the colours look (ITU-R BT.601).
        let brightness = 0.299 * red + 0.587 * green + 0.114 * blue;
        Some(if brightness > 0.5 {
            Self::Light
        } else {
            Self::Dark
        })
    }

    /// Returns the background in the bytes that a terminal has answered.
    fn of_answer(bytes: &[u8]) -> Option<Self> {
        let start = bytes
            .windows(COLOUR.len())
            .position(|part| part == COLOUR)?;
        let answer = bytes.get(start + COLOUR.len()..)?;
        let end = answer.iter().position(|byte| matches!(byte, 0x07 | 0x1b))?;
        Self::of_colour(std::str::from_utf8(&answer[..end]).ok()?)
    }
}

/// Asks the terminal for its background, and waits a moment for the answer. Returns also what was
/// typed meanwhile.
///
/// A program in the background may not read from the terminal; it asks nothing.
pub(super) fn ask(tty: &Tty) -> (Option<Background>, Vec<Event>) {
    if !tty.is_foreground() || tty.make_raw().is_err() {
        return (None, Vec::new());
    }
    let bytes = tty
        .write_within(QUESTION, PATIENCE)
        .and_then(|_| answer(tty))
        .unwrap_or_default();
    // If this fails, the terminal is gone, which shows when the screen is taken.
    let _gone = tty.restore();
    let mut decoder = Decoder::default();
    let typed = bytes.iter().filter_map(|&byte| decoder.take(byte));
    let typed = typed.collect();
    (Background::of_answer(&bytes), typed)
}

/// Reads until the second question is answered or the time is over.
fn answer(tty: &Tty) -> io::Result<Vec<u8>> {
    let begun = Instant::now();
    let mut bytes = Vec::new();
    let mut part = [0; 256];
    while !is_answered(&bytes) && bytes.len() < MOST {
        let left = PATIENCE.saturating_sub(begun.elapsed());
        if left.is_zero() {
            break;
        }
        let mut descriptors = [PollFd::from_borrowed_fd(tty.descriptor(), PollFlags::IN)];
        let left = Timespec::try_from(left).ok();
        match poll(&mut descriptors, left.as_ref()) {
            Ok(_) | Err(Errno::INTR) => {}
            Err(error) => return Err(error.into()),
        }
        match rustix::io::read(tty.descriptor(), &mut part) {
            Ok(0) => break,
            Ok(count) => bytes.extend_from_slice(&part[..count]),
            Err(Errno::AGAIN | Errno::INTR) => {}
            Err(error) => return Err(error.into()),
        }
    }
    Ok(bytes)
}

/// Returns whether the bytes hold the attributes of a terminal: `ESC [ ? NUMBERS c`.
fn is_answered(bytes: &[u8]) -> bool {
    let mut parts = bytes.windows(3).enumerate();
    parts.any(|(start, part)| {
        let numbers = bytes.get(start + 3..).unwrap_or_default();
        let is_number = |byte: &&u8| byte.is_ascii_digit() || **byte == b';';
        let end = numbers.iter().take_while(is_number).count();
        part == b"\x1b[?" && numbers.get(end) == Some(&b'c')
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn backgrounds_are_told_by_their_brightness() {
        for (colour, background) in [
            ("rgb:0000/0000/0000", Some(Background::Dark)),
            ("rgb:1e1e/1e1e/2e2e", Some(Background::Dark)),
            ("rgb:00/2b/36", Some(Background::Dark)),
            ("rgb:0000/0000/ffff", Some(Background::Dark)),
            ("rgb:ffff/ffff/ffff", Some(Background::Light)),
            ("rgb:ecec/eaea/e4e4", Some(Background::Light)),
            ("rgba:ff/ff/dd/ff", Some(Background::Light)),
            ("rgb:f/f/f", Some(Background::Light)),
            ("rgb:fffff/fffff/fffff", None),
            ("rgb:ff/ff", None),
            ("rgb://", None),
            ("#ffffff", None),
            ("", None),
        ] {
            assert_eq!(Background::of_colour(colour), background, "{colour}");
        }
    }

    #[test]
    fn the_answer_is_found_between_keys() {
        let light = b"ab\x1b]11;rgb:ffff/ffff/ffff\x1b\\c\x1b[?62;22cd";
        assert_eq!(Background::of_answer(light), Some(Background::Light));
        assert!(is_answered(light));
        let with_bell = b"\x1b]11;rgb:00/00/00\x07";
        assert_eq!(Background::of_answer(with_bell), Some(Background::Dark));
        assert!(!is_answered(with_bell));
        assert_eq!(Background::of_answer(b"\x1b]11;rgb:ff"), None);
        assert!(is_answered(b"\x1b[A\x1b[?6c") && !is_answered(b"\x1b[?62;2"));
    }

    #[test]
    fn the_hint_of_the_environment_is_the_last_number() {
        for (hint, background) in [
            ("15;0", Some(Background::Dark)),
            ("0;15", Some(Background::Light)),
            ("0;default;7", Some(Background::Light)),
            ("12;8", Some(Background::Dark)),
            ("0;default", None),
            ("15", None),
            ("", None),
        ] {
            assert_eq!(Background::of_hint(hint), background, "{hint:?}");
        }
    }
}
