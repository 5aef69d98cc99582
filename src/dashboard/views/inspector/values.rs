//! Learned values of a subtask, as tables, curves and sheets.

use std::fmt::Write;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;

use super::chart::{self, largest};
use crate::dashboard::context::ViewContext;
use crate::dashboard::keys::Action;
use crate::dashboard::look::lines::{Pen, decimals, draw_lines, fixed};
use crate::dashboard::look::{Paint, put, shortened, wrapped};
use crate::lab::inspection::{Profile, Quantity};
use crate::worlds::scene::Scale;

/// Which of the profiles is looked at: a quantity, and a place among the profiles that
/// show it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Shelf {
    quantity: usize,
    place: usize,
    quantities: usize,
    places: usize,
}

/// The quantities that there are, in order.
fn quantities(profiles: &[Profile]) -> Vec<Quantity> {
    let mut quantities = Vec::new();
    for profile in profiles {
        if !quantities.contains(&profile.quantity) {
            quantities.push(profile.quantity);
        }
    }
    quantities
}

impl Shelf {
    /// Stays where it is, as far as that is among these profiles.
    pub(super) fn fit(&mut self, profiles: &[Profile]) {
        self.quantities = quantities(profiles).len().max(1);
        self.quantity = self.quantity.min(self.quantities - 1);
        self.places = (profiles.len() / self.quantities).max(1);
        self.place = self.place.min(self.places - 1);
    }

    /// Whether there is more than one quantity.
    pub(super) fn has_quantities(&self) -> bool {
        self.quantities > 1
    }

    /// Goes on to the next quantity.
    pub(super) fn next_quantity(&mut self) {
        self.quantity = (self.quantity + 1) % self.quantities.max(1);
    }

    /// Goes on to the next state type and inputs, or back.
    pub(super) fn turn(&mut self, by: isize) {
        let places = self.places.max(1) as isize;
        self.place = (self.place as isize + by).rem_euclid(places) as usize;
    }

    fn chosen<'p>(&self, profiles: &'p [Profile]) -> Option<&'p Profile> {
        let quantity = *quantities(profiles).get(self.quantity)?;
        let mut showing = profiles
            .iter()
            .filter(|profile| profile.quantity == quantity);
        showing.nth(self.place)
    }

    /// Draws the profile that is looked at.
    pub(super) fn draw(
        &self,
        context: &ViewContext,
        profiles: &[Profile],
        area: Rect,
        buffer: &mut Buffer,
    ) {
        let look = &context.look;
        let Some(profile) = self.chosen(profiles) else {
            let text = "this subtask can act in no state";
            put(buffer, area, (0, 0), text, look.style(Paint::Dim));
            return;
        };
        let title = wrapped(&self.title(context, profile), usize::from(area.width), "");
        for (row, line) in (0..area.height).zip(&title) {
            put(buffer, area, (0, row), line, look.style(Paint::Dim));
        }
        let head = (title.len() as u16).min(area.height);
        let inside = Rect {
            y: area.y + head,
            height: area.height - head,
            ..area
        };
        match (&profile.down, &profile.across) {
            (Some(down), _) => chart::sheets(context, profile, down, inside, buffer),
            (None, Scale::Quantity { values, .. }) => {
                chart::curves(context, profile, values, inside, buffer);
            }
            (None, Scale::Cases { labels, .. }) => {
                let lines = table(context, profile, labels, inside.width.into());
                draw_lines(look, &lines, 0, inside, buffer);
            }
        }
    }

    fn title(&self, context: &ViewContext, profile: &Profile) -> String {
        let over = match &profile.down {
            Some(down) => format!("{}, {}", profile.across.name(), down.name()),
            None => profile.across.name().to_owned(),
        };
        let over = over.replace('_', " ");
        let place = match self.places {
            1 => String::new(),
            places => format!("{}/{places} {}  ", self.place + 1, keys(context)),
        };
        let what = words(profile.quantity);
        match profile.quantity {
            Quantity::ActionValue => format!("{place}{what} over {over}"),
            _ => {
                let number = profile.state_type.number();
                format!("{place}state type {number}: {what} over {over}")
            }
        }
    }
}

/// The keys that turn to another place.
fn keys(context: &ViewContext) -> String {
    let hint = context.keys.hint(Action::Left, context.look.signs);
    hint.map_or(String::new(), |(keys, _)| keys)
}

fn words(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::ActionValue => "Q of its actions",
        Quantity::Preference => "C~+V",
        Quantity::CTilde => "C~ of its children",
        Quantity::C => "C of its children",
        Quantity::Value => "V of its children",
        Quantity::Probability => "probability of its children",
    }
}

/// One line a case, one column a curve; the largest of a line is pointed at.
fn table(
    context: &ViewContext,
    profile: &Profile,
    labels: &[String],
    columns: usize,
) -> Vec<Line<'static>> {
    let look = &context.look;
    let curves = &profile.curves;
    let each = (columns.saturating_sub(17) / curves.len().max(1)).clamp(7, 16);
    let label = columns.saturating_sub(each * curves.len()).clamp(8, 18);
    let mut head = Pen::new(look).to(label);
    for curve in curves {
        let name = shortened(&curve.label, each - 1, look.signs);
        head = head.right(&name, each, Paint::Title);
    }
    let digits = decimals(curves.iter().flat_map(|curve| curve.values.iter().copied()));
    let rows = labels.iter().enumerate().map(|(row, text)| {
        let mut pen = Pen::new(look).cell(text, label, Paint::Text);
        let best = largest(profile, row);
        for (index, curve) in curves.iter().enumerate() {
            let text = curve
                .values
                .get(row)
                .copied()
                .map(|value| fixed(value, digits))
                .unwrap_or_default();
            pen = match Some(index) == best && curves.len() > 1 {
                true => pen.right(&format!("{}{text}", look.signs.pointer), each, Paint::Best),
                false => pen.right(&text, each, Paint::Text),
            };
        }
        pen.line()
    });
    std::iter::once(head.line()).chain(rows).collect()
}

/// All profiles as a table.
pub(super) fn csv(profiles: &[Profile]) -> String {
    let mut csv = String::from("quantity,state_type,across,at,down,at_down,of,value\n");
    let quoted = |text: &str| match text.contains(',') {
        true => format!("\"{text}\""),
        false => text.to_owned(),
    };
    for profile in profiles {
        let width = profile.across.len().max(1);
        for curve in &profile.curves {
            for (place, value) in curve.values.iter().enumerate() {
                let down = profile.down.as_ref();
                // Writing to a string cannot fail.
                let _ = writeln!(
                    csv,
                    "{},{},{},{},{},{},{},{value}",
                    name(profile.quantity),
                    profile.state_type.number(),
                    profile.across.name(),
                    quoted(&profile.across.label(place % width)),
                    down.map_or("", Scale::name),
                    down.map_or(String::new(), |down| quoted(&down.label(place / width))),
                    quoted(&curve.label)
                );
            }
        }
    }
    csv
}

/// The name of a quantity in tables.
fn name(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::ActionValue => "q",
        Quantity::Preference => "c_tilde_plus_v",
        Quantity::CTilde => "c_tilde",
        Quantity::C => "c",
        Quantity::Value => "v",
        Quantity::Probability => "probability",
    }
}
