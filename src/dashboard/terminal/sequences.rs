//! The meaning of complete escape sequences: keys, mouse events, or replies that mean nothing
//! to the dashboard.

use ratatui::crossterm::event::{
    Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers, MouseButton, MouseEvent, MouseEventKind,
};

/// Returns the event of ESC O and a byte.
pub(super) fn function(last: u8) -> Option<Event> {
    let code = match last {
        b'R' => KeyCode::F(3),
        other => letter(other)?,
    };
    Some(Event::Key(KeyEvent::new(code, KeyModifiers::NONE)))
}

/// Returns the event of ESC [, parameters and a last byte, or `None` for a reply.
pub(super) fn control(parameters: &[u8], last: u8) -> Option<Event> {
    let text = std::str::from_utf8(parameters).ok()?;
    if text == "[" {
        // The Linux console.
        let number = last.checked_sub(b'A').filter(|number| *number < 5)?;
        return Some(Event::Key(KeyCode::F(1 + number).into()));
    }
    if let Some(mouse) = text.strip_prefix('<') {
        return new_mouse(mouse, last);
    }
    let mut numbers = text.split(';');
    let first = numbers.next().unwrap_or_default();
    let code = match last {
        b'~' => numbered(first.parse().ok()?)?,
        b'u' => unicode(first.split(':').next()?.parse().ok()?)?,
        // Not letters of keys with parameters: only keys have 1 as the first one.
        other if matches!(first, "" | "1") => letter(other)?,
        _ => return None,
    };
    let (modifiers, kind) = modifiers(numbers.next());
    Some(Event::Key(KeyEvent::new_with_kind(code, modifiers, kind)))
}

/// Returns the modifiers of a key and whether it was released, from `MODIFIERS:KIND`.
fn modifiers(text: Option<&str>) -> (KeyModifiers, KeyEventKind) {
    let mut numbers = text.unwrap_or_default().split(':');
    let mut number = || numbers.next().and_then(|number| number.parse::<u8>().ok());
    let bits = number().unwrap_or(1).saturating_sub(1);
    let mut modifiers = KeyModifiers::NONE;
    for (bit, modifier) in [
        (1, KeyModifiers::SHIFT),
        (2, KeyModifiers::ALT),
        (4, KeyModifiers::CONTROL),
    ] {
        modifiers.set(modifier, bits & bit != 0);
    }
    let kind = match number() {
        Some(3) => KeyEventKind::Release,
        _ => KeyEventKind::Press,
    };
    (modifiers, kind)
}

fn letter(last: u8) -> Option<KeyCode> {
    Some(match last {
        b'A' => KeyCode::Up,
        b'B' => KeyCode::Down,
        b'C' => KeyCode::Right,
        b'D' => KeyCode::Left,
        b'F' => KeyCode::End,
        b'H' => KeyCode::Home,
        b'Z' => KeyCode::BackTab,
        b'P' => KeyCode::F(1),
        b'Q' => KeyCode::F(2),
        // No F3: ESC [ 1 ; 2 R is a position of the cursor.
        b'S' => KeyCode::F(4),
        _ => return None,
    })
}

fn numbered(number: u8) -> Option<KeyCode> {
    Some(match number {
        1 | 7 => KeyCode::Home,
        2 => KeyCode::Insert,
        3 => KeyCode::Delete,
        4 | 8 => KeyCode::End,
        5 => KeyCode::PageUp,
        6 => KeyCode::PageDown,
        11..=15 => KeyCode::F(number - 10),
        17..=21 => KeyCode::F(number - 11),
        23..=24 => KeyCode::F(number - 12),
        _ => return None,
    })
}

fn unicode(number: u32) -> Option<KeyCode> {
    Some(match char::from_u32(number)? {
        '\u{1b}' => KeyCode::Esc,
        '\r' | '\n' => KeyCode::Enter,
        '\t' => KeyCode::Tab,
        '\u{7f}' => KeyCode::Backspace,
        c => KeyCode::Char(c),
    })
}

/// Returns the event of `BUTTON;COLUMN;ROW`, which ends with `M`, or with `m` for a release.
fn new_mouse(text: &str, last: u8) -> Option<Event> {
    let numbers: Option<Vec<u16>> = text.split(';').map(|number| number.parse().ok()).collect();
    match (numbers?.as_slice(), last) {
        (&[button, column, row], b'M') => mouse(button, column, row),
        _ => None,
    }
}

/// Returns the event of three bytes, each 32 more than its number.
pub(super) fn old_mouse(button: u8, column: u8, row: u8) -> Option<Event> {
    let number = |byte: u8| byte.checked_sub(32).map(u16::from);
    mouse(number(button)?, number(column)?, number(row)?)
}

/// Returns the event of a press of the left button or of the wheel; the dashboard knows no
/// others. Columns and rows count from 1.
fn mouse(button: u16, column: u16, row: u16) -> Option<Event> {
    // Bits for Shift, Alt and Ctrl.
    let modifiers = 0b1_1100;
    let kind = match button & !modifiers {
        0 => MouseEventKind::Down(MouseButton::Left),
        64 => MouseEventKind::ScrollUp,
        65 => MouseEventKind::ScrollDown,
        _ => return None,
    };
    Some(Event::Mouse(MouseEvent {
        kind,
        column: column.checked_sub(1)?,
        row: row.checked_sub(1)?,
        modifiers: KeyModifiers::NONE,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns kind, column and row of a mouse event.
    fn seen(event: Option<Event>) -> Option<(MouseEventKind, u16, u16)> {
        match event? {
            Event::Mouse(event) => Some((event.kind, event.column, event.row)),
            _ => None,
        }
    }

    #[test]
    fn clicks_and_the_wheel_are_read_in_both_encodings() {
        let left = MouseEventKind::Down(MouseButton::Left);
        for (parameters, last, expected) in [
            ("<0;10;20", b'M', Some((left, 9, 19))),
            ("<4;300;1", b'M', Some((left, 299, 0))),
            ("<0;10;20", b'm', None),
            ("<32;10;20", b'M', None),
            ("<64;1;2", b'M', Some((MouseEventKind::ScrollUp, 0, 1))),
            ("<65;10;10", b'M', Some((MouseEventKind::ScrollDown, 9, 9))),
            ("<0;0;0", b'M', None),
            ("<0;99999;1", b'M', None),
        ] {
            let event = seen(control(parameters.as_bytes(), last));
            assert_eq!(event, expected, "{parameters}");
        }
        assert_eq!(seen(old_mouse(32, 42, 52)), Some((left, 9, 19)));
        assert_eq!(seen(old_mouse(32, 32, 52)), None);
        assert_eq!(seen(old_mouse(1, 42, 52)), None);
    }
}
