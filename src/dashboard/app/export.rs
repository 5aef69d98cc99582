//! A frame as text, ANSI or SVG.

use std::fmt::Write;
use std::str::FromStr;

use ratatui::buffer::{Buffer, Cell};
use ratatui::style::{Color, Modifier};
use thiserror::Error;

use crate::dashboard::look::palette_index;

/// The format of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameFormat {
    /// Plain characters.
    Text,
    /// Characters with ANSI escape codes for styles.
    Ansi,
    /// An SVG picture.
    Svg,
}

/// An unknown name of a format.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("found {found:?}; allowed: text, ansi, svg")]
pub struct UnknownFormat {
    /// The name.
    pub found: String,
}

impl FromStr for FrameFormat {
    type Err = UnknownFormat;

    fn from_str(name: &str) -> Result<Self, UnknownFormat> {
        match name {
            "text" => Ok(Self::Text),
            "ansi" => Ok(Self::Ansi),
            "svg" => Ok(Self::Svg),
            _ => Err(UnknownFormat {
                found: name.to_owned(),
            }),
        }
    }
}

/// Renders a frame in a format.
#[must_use]
pub fn render(buffer: &Buffer, format: FrameFormat) -> String {
    match format {
        FrameFormat::Text => text(buffer),
        FrameFormat::Ansi => ansi(buffer),
        FrameFormat::Svg => svg(buffer),
    }
}

fn rows(buffer: &Buffer) -> impl Iterator<Item = &[Cell]> {
    let width = usize::from(buffer.area.width).max(1);
    buffer.content.chunks(width)
}

fn text(buffer: &Buffer) -> String {
    let mut text = String::new();
    for row in rows(buffer) {
        let line: String = row.iter().map(Cell::symbol).collect();
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

fn ansi(buffer: &Buffer) -> String {
    let mut ansi = String::new();
    for row in rows(buffer) {
        let mut before = String::new();
        for cell in row {
            let codes = codes(cell);
            if codes != before {
                // Writing to a string cannot fail.
                let _ = write!(ansi, "\u{1b}[0{codes}m");
                before = codes;
            }
            ansi.push_str(cell.symbol());
        }
        ansi.push_str("\u{1b}[0m\n");
    }
    ansi
}

/// Returns the SGR codes of a cell's style, to follow a reset.
fn codes(cell: &Cell) -> String {
    let mut codes = String::new();
    for (modifier, code) in [
        (Modifier::BOLD, ";1"),
        (Modifier::DIM, ";2"),
        (Modifier::ITALIC, ";3"),
        (Modifier::UNDERLINED, ";4"),
        (Modifier::REVERSED, ";7"),
    ] {
        if cell.modifier.contains(modifier) {
            codes.push_str(code);
        }
    }
    for (colour, layer) in [(cell.fg, 38), (cell.bg, 48)] {
        match colour {
            Color::Reset => {}
            Color::Rgb(r, g, b) => {
                let _ = write!(codes, ";{layer};2;{r};{g};{b}");
            }
            other => {
                let _ = write!(codes, ";{layer};5;{}", palette_index(other));
            }
        }
    }
    codes
}

/// Returns a palette colour as red, green, blue: xterm's 16 colours, the 6x6x6 cube, 24 greys.
fn rgb(colour: Color, reset: [u8; 3]) -> [u8; 3] {
    const BASIC: [[u8; 3]; 16] = [
        [0, 0, 0],
        [205, 0, 0],
        [0, 205, 0],
        [205, 205, 0],
        [0, 0, 238],
        [205, 0, 205],
        [0, 205, 205],
        [229, 229, 229],
        [127, 127, 127],
        [255, 0, 0],
        [0, 255, 0],
        [255, 255, 0],
        [92, 92, 255],
        [255, 0, 255],
        [0, 255, 255],
        [255, 255, 255],
    ];
    match colour {
        Color::Reset => reset,
        Color::Rgb(r, g, b) => [r, g, b],
        other => match palette_index(other) {
            basic @ 0..16 => BASIC[usize::from(basic)],
            cube @ 16..232 => {
                let level = |n: u8| if n == 0 { 0 } else { 55 + 40 * n };
                let n = cube - 16;
                [level(n / 36), level(n / 6 % 6), level(n % 6)]
            }
            grey => [8 + 10 * (grey - 232); 3],
        },
    }
}

/// Width, height and baseline of a character in the picture.
const CELL: [f64; 3] = [8.4, 18.0, 13.5];

fn svg(buffer: &Buffer) -> String {
    let (width, height) = (
        f64::from(buffer.area.width) * CELL[0],
        f64::from(buffer.area.height) * CELL[1],
    );
    // Dark text means that the theme is for a light background.
    let bright = buffer
        .content
        .iter()
        .any(|cell| cell.fg == Color::Indexed(235));
    let (paper, ink) = if bright {
        ([255; 3], [0; 3])
    } else {
        ([22, 22, 26], [222; 3])
    };
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.1} {height:.1}\" \
         font-family=\"DejaVu Sans Mono, Menlo, Consolas, monospace\" font-size=\"14\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"{}\"/>\n",
        hex(paper)
    );
    for (y, row) in rows(buffer).enumerate() {
        let mut from = 0;
        while from < row.len() {
            let alike = row[from..]
                .iter()
                .take_while(|cell| same_style(cell, &row[from]));
            let to = from + alike.count();
            run(&mut svg, (from, y), &row[from..to], (paper, ink));
            from = to;
        }
    }
    svg.push_str("</svg>\n");
    svg
}

fn is_braille(c: char) -> bool {
    ('\u{2800}'..='\u{28ff}').contains(&c)
}

/// Draws the dots of a braille pattern, because few fonts have braille in the width of their
/// other characters.
fn dots(svg: &mut String, text: &str, (left, top): (f64, f64), colour: [u8; 3]) {
    /// Column and row of the dot of each bit.
    const PLACES: [(u8, u8); 8] = [
        (0, 0),
        (0, 1),
        (0, 2),
        (1, 0),
        (1, 1),
        (1, 2),
        (0, 3),
        (1, 3),
    ];
    let mut path = String::new();
    for (index, c) in text.chars().enumerate().filter(|(_, c)| is_braille(*c)) {
        for (bit, (column, row)) in PLACES.iter().enumerate() {
            if (u32::from(c) - 0x2800) >> bit & 1 == 1 {
                let x = left + (index as f64 + 0.15 + 0.5 * f64::from(*column)) * CELL[0];
                let y = top + (0.1 + 0.25 * f64::from(*row)) * CELL[1];
                // Writing to a string cannot fail.
                let _ = write!(path, "M{x:.1} {y:.1}h2v2h-2z");
            }
        }
    }
    if !path.is_empty() {
        let _ = writeln!(svg, "<path d=\"{path}\" fill=\"{}\"/>", hex(colour));
    }
}

fn same_style(a: &Cell, b: &Cell) -> bool {
    (a.fg, a.bg, a.modifier) == (b.fg, b.bg, b.modifier)
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Draws adjacent cells of one style.
fn run(svg: &mut String, (x, y): (usize, usize), cells: &[Cell], (paper, ink): ([u8; 3], [u8; 3])) {
    let Some(first) = cells.first() else { return };
    let has = |modifier| first.modifier.contains(modifier);
    let (mut fg, mut bg) = (rgb(first.fg, ink), rgb(first.bg, paper));
    if has(Modifier::REVERSED) {
        std::mem::swap(&mut fg, &mut bg);
    }
    let (left, top) = (x as f64 * CELL[0], y as f64 * CELL[1]);
    let width = cells.len() as f64 * CELL[0];
    // Writing to a string cannot fail.
    if bg != paper {
        let _ = writeln!(
            svg,
            "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{width:.1}\" height=\"{}\" fill=\"{}\"/>",
            CELL[1],
            hex(bg)
        );
    }
    let text: String = cells.iter().map(Cell::symbol).collect();
    dots(svg, &text, (left, top), fg);
    let text = text.replace(is_braille, " ");
    if text.trim().is_empty() {
        return;
    }
    let mut style = String::new();
    for (modifier, attribute) in [
        (Modifier::BOLD, " font-weight=\"bold\""),
        (Modifier::DIM, " opacity=\"0.6\""),
        (Modifier::ITALIC, " font-style=\"italic\""),
        (Modifier::UNDERLINED, " text-decoration=\"underline\""),
    ] {
        if has(modifier) {
            style.push_str(attribute);
        }
    }
    let text = text
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;");
    let _ = writeln!(
        svg,
        "<text x=\"{left:.1}\" y=\"{:.1}\" textLength=\"{width:.1}\" xml:space=\"preserve\" fill=\"{}\"{style}>{text}</text>",
        top + CELL[2],
        hex(fg)
    );
}
