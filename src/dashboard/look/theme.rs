//! Themes: a style for each paint.

use std::str::FromStr;

use ratatui::style::{Color, Modifier, Style};
use thiserror::Error;

use super::paint::Paint;
use crate::words::quoted;

/// A style for each paint.
#[derive(Clone, Debug, PartialEq)]
pub struct Theme {
    /// The name.
    pub name: String,
    /// The styles, in the order of [`Paint::ALL`].
    styles: Vec<Style>,
}

/// A text that is not a style.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error(
    "found {}; allowed: any of {}, then a colour, then 'on' and a background colour; a colour is a \
     name such as red or light-blue, a number from 0 to 255, or #rrggbb",
    quoted(.found), modifiers()
)]
pub struct StyleError {
    /// The text.
    pub found: String,
}

const MODIFIERS: [(&str, Modifier); 5] = [
    ("bold", Modifier::BOLD),
    ("dim", Modifier::DIM),
    ("italic", Modifier::ITALIC),
    ("underline", Modifier::UNDERLINED),
    ("reverse", Modifier::REVERSED),
];

fn modifiers() -> String {
    MODIFIERS.map(|(name, _)| name).join(", ")
}

/// The names of the built-in themes, each a column of [`TABLE`].
const NAMES: [&str; 4] = ["dark", "light", "high-contrast", "mono"];

/// The style of each paint in the themes dark, light, high-contrast and mono.
///
/// Dark and light use the upper 240 colours of the 256-colour palette, which look the same in
/// every terminal. High-contrast uses the terminal's own 16 colours. Mono uses none: it
/// distinguishes by weight, reversal and the signs themselves.
#[rustfmt::skip]
const TABLE: &[(Paint, [&str; 4])] = &[
    (Paint::Text,     ["252",            "235",            "white",               ""]),
    (Paint::Dim,      ["244",            "243",            "white",               "dim"]),
    (Paint::Title,    ["bold 252",       "bold 235",       "bold white",          "bold"]),
    (Paint::Border,   ["239",            "249",            "white",               "dim"]),
    (Paint::Focus,    ["bold 117",       "bold 25",        "bold light-cyan",     "bold"]),
    (Paint::Key,      ["bold 180",       "bold 94",        "bold light-yellow",   "bold"]),
    (Paint::Good,     ["114",            "28",             "bold light-green",    "bold"]),
    (Paint::Bad,      ["bold 203",       "bold 124",       "bold light-red",      "bold reverse"]),
    (Paint::Notice,   ["bold 221",       "bold 130",       "bold light-yellow",   "bold"]),
    (Paint::Selected, ["bold 231 on 238","bold 16 on 253", "bold black on white", "reverse"]),
    (Paint::Frozen,   ["bold 16 on 117", "bold 231 on 25", "bold black on light-cyan", "bold reverse"]),
    (Paint::Active,   ["bold 16 on 150", "bold 16 on 157", "bold black on light-green", "bold reverse"]),
    (Paint::Best,     ["bold 114",       "bold 28",        "bold light-green",    "bold"]),
    (Paint::Median,   ["180",            "94",             "light-yellow",        ""]),
    (Paint::Worst,    ["174",            "131",            "light-red",           "dim"]),
    (Paint::Wall,     ["250",            "240",            "bold white",          "bold"]),
    (Paint::TransparentWall, ["73",      "30",             "light-cyan",          ""]),
    (Paint::Agent,    ["bold 231",       "bold 16",        "bold white",          "bold"]),
    (Paint::Goal,     ["bold 114",       "bold 28",        "bold light-green",    "bold"]),
    (Paint::Object,   ["bold 221",       "bold 130",       "bold light-yellow",   "bold"]),
    (Paint::Hazard,   ["bold 203",       "bold 124",       "bold light-red",      "bold"]),
    (Paint::Landmark, ["bold 117",       "bold 25",        "bold light-cyan",     "bold"]),
    (Paint::Trail,    ["67",             "67",             "light-blue",          ""]),
    (Paint::Remembered, ["bold 176",     "bold 90",        "bold light-magenta",  "bold"]),
    (Paint::Sight,    ["on 235",         "on 254",         "",                    ""]),
    (Paint::Ray,      ["139",            "96",             "light-magenta",       "dim"]),
    (Paint::Shade1,   ["on 234",         "on 255",         "",                    ""]),
    (Paint::Shade2,   ["on 17",          "on 195",         "",                    ""]),
    (Paint::Shade3,   ["on 18",          "on 153",         "",                    ""]),
    (Paint::Shade4,   ["on 25",          "on 117",         "",                    ""]),
    (Paint::Shade5,   ["on 31",          "on 75",          "",                    ""]),
    (Paint::Series1,  ["75",             "25",             "light-blue",          "bold"]),
    (Paint::Series2,  ["150",            "64",             "light-green",         ""]),
    (Paint::Series3,  ["221",            "130",            "light-yellow",        "dim"]),
    (Paint::Series4,  ["211",            "125",            "light-magenta",       "italic"]),
    (Paint::Series5,  ["80",             "30",             "light-cyan",          "bold italic"]),
    (Paint::Series6,  ["216",            "88",             "light-red",           "dim italic"]),
];

impl Theme {
    /// Returns the built-in themes: dark, light, high-contrast, mono.
    #[must_use]
    pub fn all() -> Vec<Self> {
        NAMES
            .iter()
            .enumerate()
            .map(|(column, name)| Self::column(name, column))
            .collect()
    }

    /// Returns the names of the built-in themes.
    #[must_use]
    pub fn names() -> &'static [&'static str] {
        &NAMES
    }

    /// Returns the theme without colours.
    #[must_use]
    pub fn mono() -> Self {
        Self::column("mono", NAMES.len() - 1)
    }

    fn column(name: &str, column: usize) -> Self {
        let style = |paint: &Paint| {
            let row = TABLE.iter().find(|(painted, _)| painted == paint);
            // A test checks that every style of the table can be read.
            row.and_then(|(_, texts)| read(texts[column]).ok())
                .unwrap_or_default()
        };
        Self {
            name: name.to_owned(),
            styles: Paint::ALL.iter().map(style).collect(),
        }
    }

    /// Returns the style of a paint.
    #[must_use]
    pub fn style(&self, paint: Paint) -> Style {
        self.styles.get(paint as usize).copied().unwrap_or_default()
    }

    /// Changes the style of a paint; `text` is a style such as `bold 214 on #202020`.
    ///
    /// # Errors
    /// When the text is not a style.
    pub fn set(&mut self, paint: Paint, text: &str) -> Result<(), StyleError> {
        let style = read(text)?;
        if let Some(old) = self.styles.get_mut(paint as usize) {
            *old = style;
        }
        Ok(())
    }
}

/// Returns the index of a colour in the 256-colour palette; 0 for a colour outside of it.
#[must_use]
pub fn palette_index(colour: Color) -> u8 {
    const NAMED: [Color; 16] = [
        Color::Black,
        Color::Red,
        Color::Green,
        Color::Yellow,
        Color::Blue,
        Color::Magenta,
        Color::Cyan,
        Color::Gray,
        Color::DarkGray,
        Color::LightRed,
        Color::LightGreen,
        Color::LightYellow,
        Color::LightBlue,
        Color::LightMagenta,
        Color::LightCyan,
        Color::White,
    ];
    match colour {
        Color::Indexed(index) => index,
        other => NAMED.iter().position(|named| *named == other).unwrap_or(0) as u8,
    }
}

fn read(text: &str) -> Result<Style, StyleError> {
    let error = || StyleError {
        found: text.to_owned(),
    };
    let mut style = Style::new();
    let mut words = text.split_ascii_whitespace();
    while let Some(word) = words.next() {
        if let Some((_, modifier)) = MODIFIERS.iter().find(|(name, _)| *name == word) {
            style = style.add_modifier(*modifier);
        } else if word == "on" {
            let colour = words.next().and_then(|word| Color::from_str(word).ok());
            style = style.bg(colour.ok_or_else(error)?);
        } else {
            style = style.fg(Color::from_str(word).map_err(|_| error())?);
        }
    }
    Ok(style)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_theme_has_a_style_for_every_paint() {
        for (row, &paint) in TABLE.iter().zip(Paint::ALL) {
            assert_eq!(row.0, paint);
            for text in row.1 {
                read(text).unwrap();
            }
        }
        assert_eq!(TABLE.len(), Paint::ALL.len());
    }

    #[test]
    fn mono_has_no_colour() {
        for &paint in Paint::ALL {
            let style = Theme::mono().style(paint);
            assert_eq!((style.fg, style.bg), (None, None), "{paint:?}");
        }
    }

    #[test]
    fn what_is_no_style_is_quoted() {
        for wrong in ["bald", "on", "on bold", "256", "#12345"] {
            let error = read(wrong).unwrap_err().to_string();
            assert!(error.contains(&format!("{wrong:?}")), "{error}");
        }
    }
}
