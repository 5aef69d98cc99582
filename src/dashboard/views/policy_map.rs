//! The policy map: what the selected individual would do all over the arena.

use std::f64::consts::{PI, TAU};

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Modifier;
use ratatui::text::Line;

use super::shared::{csv_line, draw_no_individual, keys, line, right_of, subject};
use super::view::View;
use crate::dashboard::context::Effect;
use crate::dashboard::context::Subject;
use crate::dashboard::context::ViewContext;
use crate::dashboard::keys::Action;
use crate::dashboard::look::lines::{Pen, draw_lines, number, percent};
use crate::dashboard::look::{Canvas, Paint, width, wrapped};
use crate::dashboard::scene::share;
use crate::dashboard::scene::{Scene, draw_mark, draw_scene, draw_walls, in_proportion};
use crate::lab::inspection::{MapView, PolicyCell, PolicyMap};
use crate::worlds::StateType;

/// Number of headings that the keys step through.
const HEADINGS: usize = 24;
/// Most columns of the legend.
const LEGEND: u16 = 34;
/// Fewest columns of the legend's titles, before their keys.
const TITLE: usize = 20;
/// Of more primitive subtasks, those that are selected nowhere share a line of the legend.
const MANY: usize = 8;
/// Less probable primitive subtasks are written in lower case.
const CLEAR: f64 = 2.0 / 3.0;

/// The arena, with the letter of the primitive subtask that the selected individual would most
/// probably select at each position. Keys change heading and load.
///
/// ```text
///  ╭ Policy map  individual 362 ──────────────╮
///  │ ⡏⠉⠉⠉⠉⠉⠉⠉⠉⠉⢹  heading 45° ↗  carrying │
///  │ ⡇AAAAAWWWNN⢸  A Avoid          61 %      │
///  │ ⡇AAAAwwNNNN⢸  N ApproachNest   22 %      │
///  │ ⣇⣀⣀⣀⣀⣀⣀⣀⣀⣀⣸  lower case: below 2/3     │
///  ╰──────────────────────────────────────────╯
/// ```
#[derive(Default)]
pub(super) struct PolicyMapView {
    /// In units of a full turn divided by [`HEADINGS`].
    heading: usize,
    variant: usize,
    by_value: bool,
    computed: Option<Computed>,
}

/// A computed map with the individual that it is of.
struct Computed {
    subject: Subject,
    map: PolicyMap,
}

impl PolicyMapView {
    fn heading(&self) -> f64 {
        let heading = self.heading as f64 / HEADINGS as f64 * TAU;
        if heading > PI { heading - TAU } else { heading }
    }

    fn map(&self) -> Option<&PolicyMap> {
        Some(&self.computed.as_ref()?.map)
    }

    /// Returns the digit or letter of a cell, with its paint.
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
        let catalogue = context.catalogue();
        let mut primitives = catalogue.primitives();
        let place = primitives.position(|primitive| primitive == cell.primitive);
        let place = place.unwrap_or(0);
        let mut letter = catalogue.letters().get(place).copied().unwrap_or('?');
        if cell.probability < CLEAR {
            letter = letter.to_ascii_lowercase();
        }
        (letter, Paint::series(place))
    }

    /// Fills the blank cells of the screen with the map.
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
            let mut style = look.style(paint);
            // With colours the cells are shaded, and a few letters are enough.
            let shaded = !self.by_value && style.fg.is_some() && cell.probability >= CLEAR;
            let lettered = !shaded || (column + 4 * (row % 2)) % 8 == 3;
            if shaded {
                style = style.add_modifier(Modifier::REVERSED);
            }
            let sign = if lettered { sign } else { ' ' };
            buffer[position].set_char(sign).set_style(style);
        }
    }

    fn legend(&self, context: &ViewContext, map: &PolicyMap) -> Vec<Line<'static>> {
        let variants = context.experiment.variants();
        let room = variants.iter().map(|variant| width(variant));
        let room = room.fold(TITLE, usize::max);
        let mut lines = Vec::new();
        if context.scenery().grid.is_none() {
            let signs = context.look.signs;
            let degrees = self.heading().to_degrees().round();
            let arrow = signs.headings[(self.heading / (HEADINGS / 8)) % 8];
            let text = format!("heading {degrees:.0}{} {arrow}", signs.degrees);
            lines.push(with_keys(context, &text, room, Action::Left));
        }
        if let Some(variant) = variants.get(self.variant) {
            lines.push(with_keys(context, variant, room, Action::Up));
        }
        let mode = if self.by_value { "value" } else { "policy" };
        lines.push(with_keys(context, mode, room, Action::Mode));
        lines.push(Line::default());
        if self.by_value {
            lines.extend(value_legend(context, map))
        } else {
            lines.extend(policy_legend(context, map))
        }
        lines.push(Line::default());
        lines.extend(type_legend(context, map));
        lines
    }
}

/// Returns a line of the legend with the keys that change what it says.
fn with_keys(context: &ViewContext, text: &str, room: usize, action: Action) -> Line<'static> {
    Pen::new(&context.look)
        .cell(text, room, Paint::Title)
        .text(format!(" {}", keys(context, action)), Paint::Key)
        .line()
}

/// Returns the share of the arena's cells for which something holds.
fn share_of_cells(map: &PolicyMap, holds: impl Fn(&PolicyCell) -> bool) -> f64 {
    let cells = || map.cells.iter().flatten();
    let count = cells().filter(|cell| holds(cell)).count();
    count as f64 / cells().count().max(1) as f64
}

fn policy_legend(context: &ViewContext, map: &PolicyMap) -> Vec<Line<'static>> {
    let catalogue = context.catalogue();
    let signs = catalogue.letters().into_iter().zip(catalogue.primitives());
    let (mut lines, mut nowhere) = (Vec::new(), Vec::new());
    for (place, (letter, primitive)) in signs.enumerate() {
        let share = share_of_cells(map, |cell| cell.primitive == primitive);
        if share == 0.0 && catalogue.primitives().count() > MANY {
            nowhere.push(letter.to_string());
            continue;
        }
        let paint = if share > 0.0 {
            Paint::series(place)
        } else {
            Paint::Dim
        };
        let pen = Pen::new(&context.look)
            .text(format!("{letter} "), paint)
            .cell(primitive.name(catalogue), 17, paint)
            .right(&percent(share), 6, Paint::Text);
        lines.push(pen.line());
    }
    if !nowhere.is_empty() {
        let text = format!("nowhere: {}", nowhere.join(" "));
        let texts = wrapped(&text, usize::from(LEGEND) - 2, "  ").into_iter();
        lines.extend(texts.map(|text| line(&context.look, text, Paint::Dim)));
    }
    let note = match context.scenery().grid {
        Some(_) => "cells: the greedy action",
        None => "lower case: below 2/3",
    };
    lines.push(line(&context.look, note, Paint::Dim));
    lines
}

fn value_legend(context: &ViewContext, map: &PolicyMap) -> Vec<Line<'static>> {
    let [low, high] = map.values().unwrap_or_default();
    let ends = [("0", Paint::Worst, low), ("9", Paint::Best, high)];
    let head = line(&context.look, "V(root), expected return", Paint::Dim);
    let ends = ends.map(|(digit, paint, value)| {
        Pen::new(&context.look)
            .text(format!("{digit} "), paint)
            .right(&number(value), 9, Paint::Text)
            .line()
    });
    [head].into_iter().chain(ends).collect()
}

/// Lists the share of the arena that each state type takes.
fn type_legend(context: &ViewContext, map: &PolicyMap) -> Vec<Line<'static>> {
    let types = context.catalogue().types();
    let shares = types.map(|state_type| {
        let share = share_of_cells(map, |cell| cell.state_type == state_type);
        (state_type, share)
    });
    let shares = shares.filter(|(_, share)| *share > 0.0);
    let line = |(state_type, share): (StateType, f64)| {
        let text = format!("state type {}", state_type.number());
        Pen::new(&context.look)
            .cell(&text, 19, Paint::Dim)
            .right(&percent(share), 6, Paint::Dim)
            .line()
    };
    shares.map(line).collect()
}

/// Returns the areas of map and legend.
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
    (map, right_of(area, map.width + 2))
}

impl View for PolicyMapView {
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
        subject(context)
    }

    fn draw(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        let look = &context.look;
        let Some(map) = self.map() else {
            return draw_no_individual(context, area, buffer);
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
        draw_walls(&mut canvas, scenery);
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

    fn can(&self, _context: &ViewContext, action: Action) -> bool {
        action != Action::Mode || self.computed.is_some()
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
        let Some((inspected, subject)) = context.player.individual().zip(context.player.subject())
        else {
            self.computed = None;
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
        let computed = self.computed.as_ref();
        if computed.is_none_or(|of| of.subject != subject || of.map.view != view) {
            let map = context.experiment.policy_map(inspected, view);
            self.computed = Some(Computed { subject, map });
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
            csv_line(
                &mut csv,
                &[
                    &(x * width / columns as f64),
                    &(y * height / rows as f64),
                    &cell.state_type.number(),
                    &cell.primitive.name(context.catalogue()),
                    &cell.probability,
                    &cell.value,
                ],
            );
        }
        Some(csv)
    }

    fn help_text(&self) -> &'static str {
        "What the selected individual would do at every position, for one heading and load: its\n\
         policy is followed from the root down, and the letter names the primitive subtask that\n\
         it most probably ends in. Percentages are shares of the arena. In value mode a digit\n\
         shows V(root), from 0 (lowest) to 9 (highest). Positions where the robot does not fit\n\
         stay blank. A robot with memory is shown with nothing remembered, or with memory, where\n\
         it remembers the closest battery or the nest: composite subtasks learn the two cases\n\
         apart. Recall then acts as ApproachBattery or ApproachNest, otherwise as Wander."
    }
}

/// Returns the cell of the map at a position of the world.
fn cell_at(map: &PolicyMap, at: [f64; 2], extent: [f64; 2]) -> Option<&PolicyCell> {
    let MapView { columns, rows, .. } = map.view;
    let column = (at[0] / extent[0] * columns as f64) as usize;
    let row = ((1.0 - at[1] / extent[1]) * rows as f64) as usize;
    map.cell(column, row)
}
