//! The signs that things are drawn with.

use ratatui::symbols::border;

use crate::hierarchy::Glyphs;

/// The signs that things are drawn with.
#[derive(Debug, PartialEq)]
pub struct Signs {
    /// Whether cells can be divided into dots: braille patterns.
    pub dots: bool,
    /// The signs of trees.
    pub tree: Glyphs,
    /// Borders of panels.
    pub border: border::Set<'static>,
    /// The agent, for eight headings from +x counter-clockwise.
    pub headings: [&'static str; 8],
    /// An agent without a heading.
    pub agent: &'static str,
    /// A goal.
    pub goal: &'static str,
    /// An object.
    pub object: &'static str,
    /// A hazard.
    pub hazard: &'static str,
    /// A wall where cells cannot be divided.
    pub wall: &'static str,
    /// The trail where cells cannot be divided.
    pub trail: &'static str,
    /// Walls between the cells of a world: by the sum of 1 if one leads up from here, 2 down,
    /// 4 to the left, 8 to the right.
    pub lines: [&'static str; 16],
    /// A ray where cells cannot be divided.
    pub ray: &'static str,
    /// Field of view where there is no colour to show it.
    pub sight: &'static str,
    /// Levels from nothing to full, rising.
    pub bars: [&'static str; 9],
    /// A filled part of a horizontal bar.
    pub filled: &'static str,
    /// An unfilled part of a horizontal bar.
    pub unfilled: &'static str,
    /// What points at the selected line.
    pub pointer: &'static str,
    /// What is lit: on the path from root to action.
    pub lit: &'static str,
    /// Ascending, descending order.
    pub order: [&'static str; 2],
    /// Running, paused, stepping, finished, stopped.
    pub running: &'static str,
    /// Evolution waits.
    pub paused: &'static str,
    /// One generation, then it waits.
    pub stepping: &'static str,
    /// It is over.
    pub finished: &'static str,
    /// It was stopped.
    pub stopped: &'static str,
    /// The view is frozen.
    pub frozen: &'static str,
    /// A text was cut here.
    pub ellipsis: &'static str,
    /// About: before a number that is not quite it.
    pub about: &'static str,
    /// Between parts of a line.
    pub separator: &'static str,
    /// Points of the best, the middle, the worst where cells cannot be divided.
    pub series: [&'static str; 3],
    /// The cursor in time.
    pub cursor: &'static str,
    /// Between what was and what came of it.
    pub becomes: &'static str,
    /// So many times.
    pub times: &'static str,
    /// Temperature.
    pub tau: &'static str,
    /// The probability of a random choice.
    pub epsilon: &'static str,
    /// Degrees.
    pub degrees: &'static str,
}

/// Unicode signs, one column wide each.
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
    /// The sign of a heading in radians from +x, counter-clockwise.
    #[must_use]
    pub fn heading(&self, heading: f64) -> &'static str {
        let eighth = heading / std::f64::consts::FRAC_PI_4;
        self.headings[eighth.round().rem_euclid(8.0) as usize % 8]
    }

    /// The signs of a glyph set.
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
