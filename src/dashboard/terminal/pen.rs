//! The style that a terminal prints with, and the shortest change to another.

use std::fmt::Write;

use ratatui::buffer::Cell;
use ratatui::style::{Color, Modifier};

use crate::dashboard::look::palette_index;

/// Attributes that are visible on a blank.
const ON_BLANKS: Modifier = Modifier::REVERSED
    .union(Modifier::UNDERLINED)
    .union(Modifier::CROSSED_OUT);

/// Each attribute with the SGR parameters that set and reset it (ECMA-48, 8.3.117). The reset
/// of bold resets dim too.
const LOOKS: [(Modifier, u8, u8); 9] = [
    (Modifier::BOLD, 1, 22),
    (Modifier::DIM, 2, 22),
    (Modifier::ITALIC, 3, 23),
    (Modifier::UNDERLINED, 4, 24),
    (Modifier::SLOW_BLINK, 5, 25),
    (Modifier::RAPID_BLINK, 6, 25),
    (Modifier::REVERSED, 7, 27),
    (Modifier::HIDDEN, 8, 28),
    (Modifier::CROSSED_OUT, 9, 29),
];

/// The current colours and attributes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Pen {
    front: Color,
    back: Color,
    looks: Modifier,
}

impl Pen {
    /// Returns the pen that a cell needs when `self` is the current one; on a blank only the
    /// background is visible.
    pub(super) fn for_cell(self, cell: &Cell) -> Self {
        let whole = Self {
            front: cell.fg,
            back: cell.bg,
            looks: cell.modifier,
        };
        let plain = !(self.looks | cell.modifier).intersects(ON_BLANKS);
        match cell.symbol() {
            " " if plain => Self {
                back: cell.bg,
                ..self
            },
            _ => whole,
        }
    }

    /// Returns the sequence from this pen to another: a change, or a reset with new settings,
    /// whichever is shorter.
    pub(super) fn way_to(self, to: Self) -> String {
        if self == to {
            return String::new();
        }
        let change = self.parameters(to);
        let anew = format!("0;{}", Self::default().parameters(to));
        let shorter = if change.len() <= anew.len() {
            change
        } else {
            anew
        };
        let parameters = shorter.trim_end_matches(';');
        // No parameter means 0.
        let parameters = if parameters == "0" { "" } else { parameters };
        format!("\x1b[{parameters}m")
    }

    /// Returns the parameters of a change, each followed by a semicolon.
    fn parameters(self, to: Self) -> String {
        let mut text = String::new();
        let mut looks = self.looks;
        for (look, _, end) in LOOKS {
            if looks.contains(look) && !to.looks.contains(look) {
                let _infallible = write!(text, "{end};");
                for (other, _, same) in LOOKS {
                    if same == end {
                        looks.remove(other);
                    }
                }
            }
        }
        for (look, begin, _) in LOOKS {
            if to.looks.contains(look) && !looks.contains(look) {
                let _infallible = write!(text, "{begin};");
            }
        }
        if self.front != to.front {
            colour(to.front, 30, &mut text);
        }
        if self.back != to.back {
            colour(to.back, 40, &mut text);
        }
        text
    }
}

/// Appends the parameters of a colour; `base` is 30 for the foreground, 40 for the background.
fn colour(colour: Color, base: u8, text: &mut String) {
    let parameter = match colour {
        Color::Reset => base + 9,
        Color::Indexed(number) => {
            let _infallible = write!(text, "{};5;{number};", base + 8);
            return;
        }
        Color::Rgb(red, green, blue) => {
            let _infallible = write!(text, "{};2;{red};{green};{blue};", base + 8);
            return;
        }
        named => match palette_index(named) {
            dark @ 0..8 => base + dark,
            bright => base + 60 + bright - 8,
        },
    };
    let _infallible = write!(text, "{parameter};");
}
