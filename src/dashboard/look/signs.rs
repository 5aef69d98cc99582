//! The signs that the dashboard draws with.

use ratatui::symbols::border;

use crate::hierarchy::Glyphs;

/// The signs that the dashboard draws with.
#[derive(Debug, PartialEq)]
pub struct Signs {
    /// Whether cells can be divided into the dots of braille patterns.
    pub dots: bool,
    /// The signs of trees.
    pub tree: Glyphs,
    /// Borders of panels.
    pub border: border::Set<'static>,
    /// The agent with a heading: eight headings from +x counter-clockwise.
    pub headings: [&'static str; 8],
    /// An agent without a heading.
    pub agent: &'static str,
    /// A goal.
    pub goal: &'static str,
    /// An object.
    pub object: &'static str,
    /// A hazard.
    pub hazard: &'static str,
    /// A wall where cells have no dots.
    pub wall: &'static str,
    /// A transparent wall where cells have no dots.
    pub transparent_wall: &'static str,
    /// The place where the agent remembers its target.
    pub remembered: &'static str,
    /// The trail where cells have no dots.
    pub trail: &'static str,
    /// Walls at a corner between cells, by the sum of 1 for a wall upwards, 2 downwards, 4 to
    /// the left, 8 to the right.
    pub lines: [&'static str; 16],
    /// A ray where cells have no dots.
    pub ray: &'static str,
    /// The field of view where there is no colour for it.
    pub sight: &'static str,
    /// Bars from empty to full.
    pub bars: [&'static str; 9],
    /// The filled part of a horizontal bar.
    pub filled: &'static str,
    /// The unfilled part of a horizontal bar.
    pub unfilled: &'static str,
    /// The pointer to the selected line.
    pub pointer: &'static str,
    /// An active subtask, on the path from root to action.
    pub lit: &'static str,
    /// Ascending and descending order.
    pub order: [&'static str; 2],
    /// A running run.
    pub running: &'static str,
    /// A paused run.
    pub paused: &'static str,
    /// A run that evolves one generation and then pauses.
    pub stepping: &'static str,
    /// A finished run.
    pub finished: &'static str,
    /// A stopped run.
    pub stopped: &'static str,
    /// A frozen display.
    pub frozen: &'static str,
    /// The end of a text that was cut.
    pub ellipsis: &'static str,
    /// The sign before an approximate number.
    pub about: &'static str,
    /// The separator between parts of a line.
    pub separator: &'static str,
    /// Points of the best, median and worst curve where cells have no dots.
    pub series: [&'static str; 3],
    /// The cursor at a generation.
    pub cursor: &'static str,
    /// The sign between a value before and after an update.
    pub becomes: &'static str,
    /// The multiplication sign.
    pub times: &'static str,
    /// The temperature.
    pub tau: &'static str,
    /// The probability of a random choice.
    pub epsilon: &'static str,
    /// The unit of degrees.
    pub degrees: &'static str,
}

/// Unicode signs, each one column wide.
pub static UNICODE: Signs = Signs {
    dots: true,
    tree: Glyphs::Unicode,
    border: border::ROUNDED,
    headings: ["→", "↗", "↑", "↖", "←", "↙", "↓", "↘"],
    agent: "●",
    goal: "⌂",
    object: "▮",
    hazard: "▒",
    wall: "█",
    transparent_wall: "▒",
    remembered: "◇",
    trail: "·",
    lines: [
        " ", "╹", "╻", "┃", "╸", "┛", "┓", "┫", "╺", "┗", "┏", "┣", "━", "┻", "┳", "╋",
    ],
    ray: "·",
    sight: "·",
    bars: [" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"],
    filled: "━",
    unfilled: "─",
    pointer: "▸",
    lit: "•",
    order: ["▲", "▼"],
    running: "▶",
    paused: "‖",
    stepping: "»",
    finished: "✓",
    stopped: "■",
    frozen: "✱",
    ellipsis: "…",
    about: "≈",
    separator: "·",
    series: ["●", "○", "×"],
    cursor: "│",
    becomes: "→",
    times: "×",
    tau: "τ",
    epsilon: "ε",
    degrees: "°",
};

const ASCII_BORDER: border::Set<'static> = border::Set {
    top_left: "+",
    top_right: "+",
    bottom_left: "+",
    bottom_right: "+",
    vertical_left: "|",
    vertical_right: "|",
    horizontal_top: "-",
    horizontal_bottom: "-",
};

/// Plain ASCII signs.
pub static ASCII: Signs = Signs {
    dots: false,
    tree: Glyphs::Ascii,
    border: ASCII_BORDER,
    headings: [">", "/", "^", "\\", "<", "/", "v", "\\"],
    agent: "@",
    goal: "N",
    object: "B",
    hazard: "%",
    wall: "#",
    transparent_wall: "=",
    remembered: "?",
    trail: ".",
    lines: [
        " ", "|", "|", "|", "-", "+", "+", "+", "-", "+", "+", "+", "-", "+", "+", "+",
    ],
    ray: "'",
    sight: ":",
    bars: [" ", "_", ".", "-", "-", "=", "=", "#", "#"],
    filled: "=",
    unfilled: "-",
    pointer: ">",
    lit: "*",
    order: ["^", "v"],
    running: ">",
    paused: "||",
    stepping: ">>",
    finished: "*",
    stopped: "[]",
    frozen: "*",
    ellipsis: "~",
    about: "~",
    separator: "|",
    series: ["*", "o", "x"],
    cursor: "|",
    becomes: "->",
    times: "x",
    tau: "T",
    epsilon: "epsilon",
    degrees: " deg",
};

impl Signs {
    /// Returns the sign of a heading in radians from +x, counter-clockwise.
    #[must_use]
    pub fn heading(&self, heading: f64) -> &'static str {
        let eighth = heading / std::f64::consts::FRAC_PI_4;
        self.headings[eighth.round().rem_euclid(8.0) as usize % 8]
    }

    /// Returns the signs of a glyph set.
    #[must_use]
    pub fn of(glyphs: Glyphs) -> &'static Self {
        match glyphs {
            Glyphs::Unicode => &UNICODE,
            Glyphs::Ascii => &ASCII,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ascii_is_ascii() {
        let all = format!("{ASCII:?}");
        assert!(all.is_ascii(), "{all}");
    }
}
