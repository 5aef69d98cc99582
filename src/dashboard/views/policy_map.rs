//! What the selected individual would do all over the arena.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Modifier;
use ratatui::text::Line;

use super::shared::nobody;
use super::view::View;
use crate::dashboard::context::Effect;
use crate::dashboard::context::Subject;
use crate::dashboard::context::ViewContext;
use crate::dashboard::keys::Action;
use crate::dashboard::look::lines::{Pen, draw_lines, number, percent};
use crate::dashboard::look::{Canvas, Layer, Paint};
use crate::dashboard::scene::share;
use crate::dashboard::scene::{Scene, draw_mark, draw_scene, in_proportion};
use crate::lab::inspection::{MapView, PolicyCell, PolicyMap};

/// Headings that keys go through.
const HEADINGS: usize = 24;
/// Columns of the legend.
const LEGEND: u16 = 34;
/// A primitive subtask less probable than this is written small.
const CLEAR: f64 = 2.0 / 3.0;

/// The arena, each place with the letter of the primitive subtask that the selected
/// individual would most probably end in there, for a heading and a load that keys turn.
///
/// ```text
///  ╭ Policy map  individual 362 ──────────────╮
///  │ ⡏⠉⠉⠉⠉⠉⠉⠉⠉⠉⢹  heading 45° ↗  carrying │
///  │ ⡇AAAAAWWWNN⢸  A Avoid          61 %      │
///  │ ⡇AAAAwwNNNN⢸  N ApproachNest   22 %      │
///  │ ⣇⣀⣀⣀⣀⣀⣀⣀⣀⣀⣸  small: less than 2 in 3   │
///  ╰──────────────────────────────────────────╯
/// ```
#[derive(Default)]
pub(super) struct Map {
    /// In steps of a turn divided by [`HEADINGS`].
    heading: usize,
    variant: usize,
    by_value: bool,
    made: Option<Made>,
}

/// A map with what it was made for.
struct Made {
    subject: Subject,
    map: PolicyMap,
}

impl Map {
    fn heading(&self) -> f64 {
        let heading = self.heading as f64 / HEADINGS as f64 * TAU;
        if heading > PI { heading - TAU } else { heading }
    }

    fn map(&self) -> Option<&PolicyMap> {
        self.made.as_ref().map(|made| &made.map)
    }

    /// What stands for a cell: a digit or a letter, and how it is painted.
    fn sign(&self, context: &ViewContext, cell: &PolicyCell, range: [f32; 2]) -> (char, Paint) {
        if self.by_value {
            let level = (share(cell.value, range) * 10.0).clamp(0.0, 9.0) as u32;
            let paint = match level {
                0..=2 => Paint::Worst,
                3..=6 => Paint::Median,
                _ => Paint::Best,
            };
            return (char::from_digit(level, 10).unwrap_or(' '), paint);
        }
        let mut primitives = context.catalogue().primitives();
        let place = primitives.position(|primitive| primitive == cell.primitive);
        let place = place.unwrap_or(0);
        let letter = context
            .catalogue()
            .letters()
            .get(place)
            .copied()
            .unwrap_or('?');
        let letter = match cell.probability >= CLEAR {
            true => letter,
            false => letter.to_ascii_lowercase(),
        };
        (letter, Paint::series(place))
    }

    /// Draws the cells where there is no wall.
    fn shade(
        &self,
        context: &ViewContext,
        map: &PolicyMap,
        canvas: &Canvas<'_>,
        place: Rect,
        buffer: &mut Buffer,
    ) {
        let (look, extent) = (&context.look, context.scenery().extent);
        let range = map.values().unwrap_or_default();
        let clipped = place.intersection(buffer.area);
        for position in clipped.positions() {
            let (column, row) = (position.x - place.x, position.y - place.y);
            let is_free = buffer[position].symbol() == " ";
            let cell = cell_at(map, canvas.place(column, row), extent).filter(|_| is_free);
            let Some(cell) = cell else { continue };
            let (sign, paint) = self.sign(context, cell, range);
            let style = look.style(paint);
            // Shaded where there are colours: letters then need not be everywhere.
            let shaded = !self.by_value && style.fg.is_some() && cell.probability >= CLEAR;
            let lettered = !shaded || (column + 4 * (row % 2)) % 8 == 3;
            let style = match shaded {
                true => style.add_modifier(Modifier::REVERSED),
                false => style,
            };
            let sign = if lettered { sign } else { ' ' };
            buffer[position].set_char(sign).set_style(style);
        }
    }

    fn legend(&self, context: &ViewContext, map: &PolicyMap) -> Vec<Line<'static>> {
        let look = &context.look;
        let keys = |action| {
            let hint = context.keys.hint(action, look.signs);
            hint.map_or(String::new(), |(keys, _)| keys)
        };
        let mut lines = Vec::new();
        if context.scenery().grid.is_none() {
            let degrees = self.heading().to_degrees().round();
            let eighth = (self.heading / (HEADINGS / 8)) % 8;
            let text = format!(
                "heading {degrees:.0}{} {}",
                look.signs.degrees, look.signs.headings[eighth]
            );
            lines.push(with_keys(context, &text, &keys(Action::Left)));
        }
        let variants = context.experiment.variants();
        if let Some(variant) = variants.get(self.variant) {
            lines.push(with_keys(context, variant, &keys(Action::Up)));
        }
        let mode = if self.by_value { "value" } else { "policy" };
        lines.push(with_keys(context, mode, &keys(Action::Mode)));
        lines.push(Line::default());
        match self.by_value {
            true => lines.extend(value_legend(context, map)),
            false => lines.extend(policy_legend(context, map)),
        }
        lines.push(Line::default());
        lines.extend(type_legend(context, map));
        lines
    }
}

fn with_keys(context: &ViewContext, text: &str, keys: &str) -> Line<'static> {
    Pen::new(&context.look)
        .cell(text, 20, Paint::Title)
        .text(format!(" {keys}"), Paint::Key)
        .line()
}

fn policy_legend(context: &ViewContext, map: &PolicyMap) -> Vec<Line<'static>> {
    let catalogue = context.catalogue();
    let free = map.cells.iter().flatten().count().max(1);
    let signs = catalogue.letters().into_iter().zip(catalogue.primitives());
    let mut lines: Vec<_> = signs
        .enumerate()
        .map(|(place, (letter, primitive))| {
            let cells = map.cells.iter().flatten();
            let count = cells.filter(|cell| cell.primitive == primitive).count();
            let share = count as f64 / free as f64;
            let paint = if count > 0 {
                Paint::series(place)
            } else {
                Paint::Dim
            };
            Pen::new(&context.look)
                .text(format!("{letter} "), paint)
                .cell(primitive.name(catalogue), 17, paint)
                .right(&percent(share), 6, Paint::Text)
                .line()
        })
        .collect();
    let note = match context.scenery().grid {
        Some(_) => "in the cells: the greedy action",
        None => "small letter: less than 2 in 3",
    };
    lines.push(Pen::new(&context.look).text(note, Paint::Dim).line());
    lines
}

fn value_legend(context: &ViewContext, map: &PolicyMap) -> Vec<Line<'static>> {
    let [low, high] = map.values().unwrap_or_default();
    let ends = [("0", Paint::Worst, low), ("9", Paint::Best, high)];
    let head = Pen::new(&context.look).text("V(root), expected reward", Paint::Dim);
    let ends = ends.map(|(digit, paint, value)| {
        Pen::new(&context.look)
            .text(format!("{digit} "), paint)
            .right(&number(value), 9, Paint::Text)
            .line()
    });
    [head.line()].into_iter().chain(ends).collect()
}

/// How much of the arena each state type is.
fn type_legend(context: &ViewContext, map: &PolicyMap) -> Vec<Line<'static>> {
    let free = map.cells.iter().flatten().count().max(1);
    let types = context.catalogue().types();
    let shares = types.map(|state_type| {
        let cells = map.cells.iter().flatten();
        let count = cells.filter(|cell| cell.state_type == state_type).count();
        (state_type, count)
    });
    shares
        .filter(|(_, count)| *count > 0)
        .map(|(state_type, count)| {
            let text = format!("state type {}", state_type.number());
            Pen::new(&context.look)
                .cell(&text, 19, Paint::Dim)
                .right(&percent(count as f64 / free as f64), 6, Paint::Dim)
                .line()
        })
        .collect()
}

/// Map and legend.
fn areas(context: &ViewContext, area: Rect) -> (Rect, Rect) {
    let legend = LEGEND.min(area.width / 2);
    let room = Rect {
        width: area.width - legend,
        ..area
    };
    let map = match context.scenery().grid {
        Some(_) => room,
        None => in_proportion(room, context.scenery().extent),
    };
    let map = Rect { x: area.x, ..map };
    let legend = Rect {
        x: map.right() + 2,
        width: area.right().saturating_sub(map.right() + 2),
        ..area
    };
    (map, legend)
}

impl View for Map {
    fn name(&self) -> &'static str {
        "policy-map"
    }

    fn title(&self) -> &'static str {
        "Policy map"
    }

    fn needs_rollout(&self) -> bool {
        true
    }

    fn caption(&self, context: &ViewContext) -> String {
        let subject = context.player.subject();
        subject.map_or(String::new(), |subject| subject.to_string())
    }

    fn draw(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        let look = &context.look;
        let Some(map) = self.map() else {
            return nobody(context, area, buffer);
        };
        let (place, legend) = areas(context, area);
        let scenery = context.scenery();
        if scenery.grid.is_some() {
            let scene = Scene {
                marks: &map.marks,
                cells: Some(map),
                ..Scene::default()
            };
            draw_scene(context, &scene, place, buffer);
            return draw_lines(look, &self.legend(context, map), 0, legend, buffer);
        }
        let mut canvas = Canvas::new(look, place, [0.0, 0.0], scenery.extent);
        for [from, to] in &scenery.walls {
            canvas.line(*from, *to, Layer::Wall, Paint::Wall);
        }
        canvas.finish(buffer);
        self.shade(context, map, &canvas, place, buffer);
        for mark in scenery.places.iter().chain(&map.marks) {
            draw_mark(look, &canvas, mark, place, buffer);
        }
        draw_lines(look, &self.legend(context, map), 0, legend, buffer);
    }

    fn hints(&self) -> &'static [Action] {
        &[Action::Mode, Action::Best, Action::ViewInspector]
    }

    fn can(&self, _desk: &ViewContext, action: Action) -> bool {
        action != Action::Mode || self.made.is_some()
    }

    fn act(&mut self, context: &mut ViewContext, action: Action) -> Option<Vec<Effect>> {
        let variants = context.experiment.variants().len().max(1);
        match action {
            Action::Left => self.heading = (self.heading + 1) % HEADINGS,
            Action::Right => self.heading = (self.heading + HEADINGS - 1) % HEADINGS,
            Action::Up => self.variant = (self.variant + variants - 1) % variants,
            Action::Down => self.variant = (self.variant + 1) % variants,
            Action::Mode => self.by_value = !self.by_value,
            _ => return None,
        }
        Some(Vec::new())
    }

    fn prepare(&mut self, context: &ViewContext) {
        let Some((individual, subject)) = context.player.individual().zip(context.player.subject())
        else {
            self.made = None;
            return;
        };
        let (width, height) = context.size;
        let inside = Rect::new(0, 0, width.saturating_sub(2), height.saturating_sub(4));
        let (place, _) = areas(context, inside);
        let cells = [place.width, place.height].map(usize::from);
        let [columns, rows] = context.scenery().grid.unwrap_or(cells);
        let view = MapView {
            heading: self.heading(),
            variant: self.variant,
            columns,
            rows,
        };
        let made = self.made.as_ref();
        if made.is_none_or(|made| made.subject != subject || made.map.view != view) {
            let map = context.experiment.policy_map(individual, view);
            self.made = Some(Made { subject, map });
        }
    }

    fn csv(&self, context: &ViewContext) -> Option<String> {
        let map = self.map()?;
        let [width, height] = context.scenery().extent;
        let MapView { columns, rows, .. } = map.view;
        let mut csv = String::from("x,y,state_type,primitive,probability,value\n");
        for (index, cell) in map.cells.iter().enumerate() {
            let Some(cell) = cell else { continue };
            let x = (index % columns) as f64 + 0.5;
            let y = (rows - index / columns) as f64 - 0.5;
            // Writing to a string cannot fail.
            let _ = writeln!(
                csv,
                "{},{},{},{},{},{}",
                x * width / columns as f64,
                y * height / rows as f64,
                cell.state_type.number(),
                context.catalogue().subtask(cell.primitive).name,
                cell.probability,
                cell.value
            );
        }
        Some(csv)
    }

    fn help_text(&self) -> &'static str {
        "What the selected individual would do at every place, for one heading and load: its\n\
         policy is followed from the root down, and the letter is that of the primitive subtask\n\
         that it most probably ends in. As values: V(root), from 0, the lowest, to 9. Where the\n\
         body has no room nothing is drawn."
    }
}

/// The cell of the map at a place.
fn cell_at(map: &PolicyMap, at: [f64; 2], extent: [f64; 2]) -> Option<&PolicyCell> {
    let MapView { columns, rows, .. } = map.view;
    let column = (at[0] / extent[0] * columns as f64) as usize;
    let row = ((1.0 - at[1] / extent[1]) * rows as f64) as usize;
    map.cell(column, row)
}
