//! The values page: what a subtask has learned, as a table, curves or sheets.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;

use super::chart::{self, largest};
use crate::dashboard::context::ViewContext;
use crate::dashboard::keys::Action;
use crate::dashboard::look::lines::{Pen, decimals, draw_lines, fixed};
use crate::dashboard::look::{Paint, put, shortened, wrapped};
use crate::dashboard::views::shared::{below, csv_line, keys};
use crate::lab::inspection::{Profile, Quantity};
use crate::worlds::scene::Scale;

/// The profile that is shown: a quantity, and a place among the profiles of that quantity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct ProfileChoice {
    quantity: usize,
    place: usize,
    quantities: usize,
    places: usize,
}

/// Lists the quantities of some profiles, in order.
fn quantities(profiles: &[Profile]) -> Vec<Quantity> {
    let mut quantities = Vec::new();
    for profile in profiles {
        if !quantities.contains(&profile.quantity) {
            quantities.push(profile.quantity);
        }
    }
    quantities
}

impl ProfileChoice {
    /// Adapts to new profiles, keeping quantity and place where they exist.
    pub(super) fn fit(&mut self, profiles: &[Profile]) {
        self.quantities = quantities(profiles).len().max(1);
        self.quantity = self.quantity.min(self.quantities - 1);
        self.places = (profiles.len() / self.quantities).max(1);
        self.place = self.place.min(self.places - 1);
    }

    /// Returns whether there is more than one quantity.
    pub(super) fn has_quantities(&self) -> bool {
        self.quantities > 1
    }

    /// Turns to the next quantity.
    pub(super) fn next_quantity(&mut self) {
        self.quantity = (self.quantity + 1) % self.quantities.max(1);
    }

    /// Turns to the next place (`1`) or to the one before (`-1`): a state type with its inputs.
    pub(super) fn turn(&mut self, by: isize) {
        let places = self.places.max(1) as isize;
        self.place = (self.place as isize + by).rem_euclid(places) as usize;
    }

    fn chosen<'p>(&self, profiles: &'p [Profile]) -> Option<&'p Profile> {
        let quantity = *quantities(profiles).get(self.quantity)?;
        let mut showing = profiles.iter().filter(|of| of.quantity == quantity);
        showing.nth(self.place)
    }

    /// Draws the profile that is shown.
    pub(super) fn draw(
        &self,
        context: &ViewContext,
        profiles: &[Profile],
        area: Rect,
        buffer: &mut Buffer,
    ) {
        let look = &context.look;
        let Some(profile) = self.chosen(profiles) else {
            return draw_nothing(context, area, buffer);
        };
        let title = wrapped(&self.title(context, profile), usize::from(area.width), "");
        for (row, line) in (0..area.height).zip(&title) {
            put(buffer, area, (0, row), line, look.style(Paint::Dim));
        }
        let inside = below(area, title.len() as u16);
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
        let mut title = String::new();
        if self.places > 1 {
            let (number, keys) = (self.place + 1, keys(context, Action::Left));
            title += &format!("{number}/{} {keys}  ", self.places);
        }
        if profile.quantity != Quantity::ActionValue {
            title += &format!("state type {}: ", profile.state_type.number());
        }
        let (quantity, _) = names(profile.quantity);
        title + &format!("{quantity} over {over}")
    }
}

/// Tells why the selected subtask has no values to show.
fn draw_nothing(context: &ViewContext, area: Rect, buffer: &mut Buffer) {
    let subtask = context.player.tree().map(|tree| {
        let node = context.node_in(tree);
        tree.subtask(node)
    });
    let why = subtask.and_then(|subtask| {
        let why = context.experiment.nothing_learned(subtask)?;
        Some(format!("{} {why}", subtask.name(context.catalogue())))
    });
    let why = why.unwrap_or_else(|| String::from("this subtask can act in no state type"));
    let lines = wrapped(&why, usize::from(area.width), "");
    for (row, line) in (0..area.height).zip(&lines) {
        put(buffer, area, (0, row), line, context.look.style(Paint::Dim));
    }
}

/// Returns the names of a quantity: on the screen, and in CSV.
fn names(quantity: Quantity) -> (&'static str, &'static str) {
    match quantity {
        Quantity::ActionValue => ("Q of its actions", "q"),
        Quantity::Preference => ("C~+V", "c_tilde_plus_v"),
        Quantity::CTilde => ("C~ of its children", "c_tilde"),
        Quantity::C => ("C of its children", "c"),
        Quantity::Value => ("V of its children", "v"),
        Quantity::Probability => ("probability of its children", "probability"),
    }
}

/// Returns a table with a line for each case and a column for each curve; a pointer marks the
/// largest value of a line.
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
            let value = curve.values.get(row);
            let text = value.map_or(String::new(), |value| fixed(*value, digits));
            pen = if Some(index) == best && curves.len() > 1 {
                pen.right(&format!("{}{text}", look.signs.pointer), each, Paint::Best)
            } else {
                pen.right(&text, each, Paint::Text)
            };
        }
        pen.line()
    });
    std::iter::once(head.line()).chain(rows).collect()
}

/// Writes all profiles as CSV.
pub(super) fn csv(profiles: &[Profile]) -> String {
    let mut csv = String::from("quantity,state_type,across,at,down,at_down,of,value\n");
    for profile in profiles {
        let width = profile.across.len().max(1);
        for curve in &profile.curves {
            for (place, value) in curve.values.iter().enumerate() {
                let down = profile.down.as_ref();
                csv_line(
                    &mut csv,
                    &[
                        &names(profile.quantity).1,
                        &profile.state_type.number(),
                        &profile.across.name(),
                        &profile.across.label(place % width),
                        &down.map_or("", Scale::name),
                        &down.map_or(String::new(), |down| down.label(place / width)),
                        &curve.label,
                        value,
                    ],
                );
            }
        }
    }
    csv
}
