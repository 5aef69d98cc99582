//! The look of the dashboard: themes, signs, text, charts, the canvas.

mod canvas;
mod chart;
pub(in crate::dashboard) mod lines;
mod paint;
mod signs;
mod text;
mod theme;

pub use canvas::{Canvas, Layer};
pub use chart::{Chart, Curve, axis_end, sparkline};
pub use paint::Paint;
pub use signs::Signs;
pub use text::{fitted, fitted_end, fitted_parts, one_line, put, shortened, width, wrapped};
pub use theme::{StyleError, Theme, palette_index};

use ratatui::style::Style;

/// The themes and signs in use.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// The themes that the theme key cycles through; never empty.
    themes: Vec<Theme>,
    current: usize,
    /// The signs.
    pub signs: &'static Signs,
}

impl Look {
    /// Creates a look that starts with the theme named `first`.
    #[must_use]
    pub fn new(themes: Vec<Theme>, first: &str, signs: &'static Signs) -> Self {
        let current = themes.iter().position(|theme| theme.name == first);
        Self {
            current: current.unwrap_or(0),
            themes,
            signs,
        }
    }

    /// Returns the style of a paint.
    #[must_use]
    pub fn style(&self, paint: Paint) -> Style {
        self.themes
            .get(self.current)
            .map_or_else(Style::new, |theme| theme.style(paint))
    }

    /// Returns the name of the theme in use.
    #[must_use]
    pub fn theme(&self) -> &str {
        self.themes
            .get(self.current)
            .map_or("", |theme| &theme.name)
    }

    /// Switches to the theme with a name, if there is one.
    pub fn use_theme(&mut self, name: &str) {
        let named = self.themes.iter().position(|theme| theme.name == name);
        self.current = named.unwrap_or(self.current);
    }

    /// Switches to the next theme.
    pub fn next_theme(&mut self) {
        self.current = (self.current + 1) % self.themes.len().max(1);
    }
}
