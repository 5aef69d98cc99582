//! The shortest cursor movement from one position to another.

use ratatui::layout::Position;

/// Returns the shortest sequence that moves the cursor to a position; `from` is `None` if the
/// current position is unknown.
///
/// Every terminal since the VT100 knows the sequences in use: carriage return, line feed (which
/// keeps the column in raw mode, and never scrolls where there is a line below), backspace,
/// relative moves (CUU, CUD, CUF, CUB) and absolute ones (CUP; ECMA-48, 8.3.18 to 8.3.22).
pub(super) fn shortest_way(from: Option<Position>, to: Position) -> String {
    let anywhere = match to.x {
        0 => format!("\x1b[{}H", to.y + 1),
        x => format!("\x1b[{};{}H", to.y + 1, x + 1),
    };
    let Some(from) = from else { return anywhere };
    let lines = match to.y.checked_sub(from.y) {
        Some(down) => shorter("\n".repeat(down.into()), go(down, 'B')),
        None => go(from.y - to.y, 'A'),
    };
    let columns = match to.x.checked_sub(from.x) {
        Some(right) => go(right, 'C'),
        None => {
            let left = from.x - to.x;
            shorter("\u{8}".repeat(left.into()), go(left, 'D'))
        }
    };
    // Starting from the first column may be shorter.
    let columns = shorter(columns, format!("\r{}", go(to.x, 'C')));
    shorter(lines + &columns, anywhere)
}

/// Returns the sequence that moves a number of cells in a direction.
fn go(cells: u16, direction: char) -> String {
    match cells {
        0 => String::new(),
        1 => format!("\x1b[{direction}"),
        _ => format!("\x1b[{cells}{direction}"),
    }
}

fn shorter(one: String, other: String) -> String {
    if other.len() < one.len() { other } else { one }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::num::NonZeroU16;

    #[test]
    fn every_way_leads_there_and_none_is_longer_than_the_absolute_one() {
        let size = NonZeroU16::new(12).unwrap();
        let mut terminal = vt100::Parser::new(size, size, 0);
        for pair in 0..12_u32.pow(4) {
            let [fx, fy, tx, ty] = [1, 12, 144, 1728].map(|unit| (pair / unit % 12) as u16);
            let (from, to) = (Position::new(fx, fy), Position::new(tx, ty));
            let start = shortest_way(None, from);
            terminal.process(start.as_bytes());
            assert_eq!(terminal.screen().cursor_position(), (fy, fx));
            let way = shortest_way(Some(from), to);
            terminal.process(way.as_bytes());
            assert_eq!(terminal.screen().cursor_position(), (ty, tx), "{way:?}");
            assert!(way.len() <= shortest_way(None, to).len());
        }
    }

    #[test]
    fn near_places_are_a_byte_or_two_away() {
        let way = |from: (u16, u16), to: (u16, u16)| shortest_way(Some(from.into()), to.into());
        assert_eq!(way((5, 5), (5, 5)), "");
        assert_eq!(way((5, 5), (4, 6)), "\n\u{8}");
        assert_eq!(way((50, 5), (0, 6)), "\n\r");
        assert_eq!(way((5, 5), (9, 5)), "\x1b[4C");
    }
}
