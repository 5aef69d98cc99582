//! The table on the screen.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::columns::{Column, Placed, place};
use super::row::{RunRow, Standing};
use super::table::RunsTable;
use super::work::question;
use crate::dashboard::chrome::header::{last_line, put_hints, put_message};
use crate::dashboard::chrome::hints::ALWAYS;
use crate::dashboard::chrome::overlay::{Line, line, plain, window};
use crate::dashboard::keys::Action;
use crate::dashboard::look::{Paint, fitted, one_line, put, sparkline, width};
use crate::dashboard::panel::{SMALLEST, body, panel, too_small};

/// Actions of the hint bar, most useful first.
const HINTS: &[Action] = &[
    Action::Open,
    Action::Down,
    Action::Sort,
    Action::Reverse,
    Action::Theme,
];

/// Actions of the help overlay, after that of opening a run.
const HELP: &[Action] = &[
    Action::Up,
    Action::Down,
    Action::PageUp,
    Action::PageDown,
    Action::Top,
    Action::Bottom,
    Action::Sort,
    Action::Reverse,
    Action::Theme,
    Action::Redraw,
    Action::Suspend,
    Action::Help,
    Action::Quit,
];

/// What there is to see and how to read it.
const LESSON: &str = "\
The runs of a study: scenario, arm (what is studied against
what) and seed. best: mean time steps of a scored trial of the
best individual of the latest generation; course: the same from
the first generation on, falling as hierarchies get better, on
one scale for all runs of a scenario. fresh: the structure of
the winner, evaluated anew when the run is over: the luckiest of
many looks better than it is. A run that is over or broken off
opens as a replay, one that goes on is watched; q or esc in its
overview comes back here.";

impl RunsTable {
    /// Draws everything on a buffer of any size.
    pub fn draw_on(&self, buffer: &mut Buffer) {
        let (look, area) = (&self.look, buffer.area);
        buffer.set_style(area, look.style(Paint::Text));
        if area.width < SMALLEST.0 || area.height < SMALLEST.1 {
            return too_small(look, area, buffer);
        }
        self.draw_header(area, buffer);
        let counts = self.counts();
        let inside = panel(look, body(area), false, ("Runs", &counts), buffer);
        self.draw_table(inside, buffer);
        match &self.message {
            Some(text) => put_message(look, text, last_line(area), buffer),
            None => {
                let named = |actions: &[Action]| -> Vec<_> {
                    let hints = actions.iter();
                    hints
                        .filter_map(|&action| self.keys.hint(action, look.signs))
                        .collect()
                };
                put_hints(look, &named(HINTS), &named(ALWAYS), last_line(area), buffer);
            }
        }
        if let Some(scroll) = self.help {
            let titles = ("Help", "Runs of a study");
            window(look, titles, &self.help_lines(), scroll, area, buffer);
        }
        if self.asked {
            let lines = question(&self.keys);
            window(look, ("Question", ""), &lines, 0, area, buffer);
        }
    }

    pub(super) fn help_lines(&self) -> Vec<Line> {
        let lesson = LESSON.lines().map(plain);
        let (open, _, paint) = line(&self.keys, Action::Open);
        let open: Line = (open, String::from("Open the run that is pointed at"), paint);
        let keys = HELP.iter().map(|&action| line(&self.keys, action));
        lesson.chain([plain(""), open]).chain(keys).collect()
    }

    /// ```text
    ///  ▶ RUNNING  Study thesis · studies/thesis                 about 12 min left
    /// ```
    fn draw_header(&self, area: Rect, buffer: &mut Buffer) {
        let look = &self.look;
        let has = |standing| self.rows().iter().any(|row| row.standing == standing);
        let all_done = || self.rows().iter().all(|row| row.standing == Standing::Done);
        let (sign, word, paint) = match &self.rows {
            None => (look.signs.paused, "READING", Paint::Notice),
            Some(_) if self.work.is_some() || has(Standing::Running) => {
                (look.signs.running, "RUNNING", Paint::Good)
            }
            Some(_) if all_done() => (look.signs.finished, "DONE", Paint::Good),
            Some(_) => (look.signs.stopped, "NOBODY WORKS ON IT", Paint::Notice),
        };
        let state = format!(" {sign} {word} ");
        let column = put(buffer, area, (0, 0), &state, look.style(paint));
        let (name, folder) = (one_line(&self.name), one_line(&self.folder));
        let text = format!(" Study {name} {} {folder}", look.signs.separator);
        let left = self
            .work
            .and_then(super::work::Work::words)
            .unwrap_or_default();
        let right = width(&left) + usize::from(!left.is_empty());
        let room = usize::from(area.width.saturating_sub(column)).saturating_sub(right);
        let text = fitted(&text, room, look.signs);
        put(buffer, area, (column, 0), &text, look.style(Paint::Text));
        let start = usize::from(area.width).saturating_sub(right);
        let start = u16::try_from(start).unwrap_or(u16::MAX);
        put(buffer, area, (start, 0), &left, look.style(Paint::Dim));
    }

    /// How many runs stand how.
    fn counts(&self) -> String {
        let rows = self.rows();
        let counts = Standing::ALL.iter().map(|&standing| {
            let count = rows.iter().filter(|row| row.standing == standing).count();
            (count, standing.word())
        });
        let some = counts.filter(|(count, _)| *count > 0);
        let some: Vec<_> = some
            .map(|(count, word)| format!("{count} {word}"))
            .collect();
        some.join(", ")
    }

    fn draw_table(&self, area: Rect, buffer: &mut Buffer) {
        if self.rows.is_none() {
            let dim = self.look.style(Paint::Dim);
            put(buffer, area, (1, 0), "the runs are being read", dim);
            return;
        }
        let rows = self.rows();
        // The first column is the pointer's.
        let room = usize::from(area.width.saturating_sub(1));
        let placed = place(rows, room, self.look.signs);
        self.draw_head(&placed, area, buffer);
        for (below, place) in self.visible(area).into_iter().enumerate() {
            let line = Rect {
                y: area.y + 1 + below as u16,
                height: 1,
                ..area
            };
            self.draw_row(&rows[place], &placed, place == self.selected, line, buffer);
        }
    }

    /// The heads of the columns; the one that the table is sorted by says so.
    fn draw_head(&self, placed: &[Placed], area: Rect, buffer: &mut Buffer) {
        let look = &self.look;
        let mut at = 1;
        for Placed {
            column,
            head,
            width,
        } in placed
        {
            let (head, paint) = match Some(*column) == self.by {
                true => {
                    let sign = look.signs.order[usize::from(self.reversed)];
                    (format!("{sign}{head}"), Paint::Title)
                }
                false => ((*head).to_owned(), Paint::Dim),
            };
            let text = aligned(*column, &head, *width);
            put(buffer, area, (at, 0), &text, look.style(paint));
            at += *width as u16 + 1;
        }
    }

    fn draw_row(
        &self,
        row: &RunRow,
        placed: &[Placed],
        is_selected: bool,
        line: Rect,
        buffer: &mut Buffer,
    ) {
        let look = &self.look;
        let paint = |paint| match is_selected {
            true => Paint::Selected,
            false => paint,
        };
        if is_selected {
            let style = look.style(Paint::Selected);
            buffer.set_style(line.intersection(buffer.area), style);
            put(buffer, line, (0, 0), look.signs.pointer, style);
        }
        let plain = match row.standing {
            Standing::Waiting => Paint::Dim,
            _ => Paint::Text,
        };
        let mut at = 1;
        for &Placed { column, width, .. } in placed {
            let (text, its_paint) = match column {
                Column::Course => {
                    let range = self.ranges.get(&row.scenario).copied();
                    let range = range.unwrap_or([0.0, 1.0]);
                    let line = sparkline(&row.course, range, width, look.signs);
                    (line, Paint::Best)
                }
                Column::Standing => (column.text(row, look.signs), row.standing.paint()),
                column => (column.text(row, look.signs), plain),
            };
            let text = aligned(column, &fitted(&text, width, look.signs), width);
            put(buffer, line, (at, 0), &text, look.style(paint(its_paint)));
            at += width as u16 + 1;
        }
    }
}

/// A text in its column: numbers end at its end.
fn aligned(column: Column, text: &str, columns: usize) -> String {
    match column.is_number() {
        true => " ".repeat(columns.saturating_sub(width(text))) + text,
        false => text.to_owned(),
    }
}
