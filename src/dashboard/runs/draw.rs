//! Drawing of the table.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::columns::{Column, Placed, place};
use super::row::{RowStatus, RunRow};
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

/// Actions of the help window, after the open key.
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

/// The head of the help overlay.
const HELP_TEXT: &str = "\
The runs of a study, each with its scenario, its arm (one of the
settings that the study compares) and its seed. best: mean time
steps per scored trial of the best individual of the latest
generation. course: the same from the first generation on, on
one scale for all runs of a scenario; it falls as hierarchies
improve. fresh: the structure of the winner, evaluated again in
new trials after the run, because the luckiest of many looks
better than it is. Enter replays a run that has finished or was
interrupted, and watches one that is running; q or esc in its
overview returns here.";

impl RunsTable {
    /// Draws a frame into a buffer of any size.
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
        if self.question_open {
            let lines = question(&self.keys);
            window(look, ("Question", ""), &lines, 0, area, buffer);
        }
    }

    pub(super) fn help_lines(&self) -> Vec<Line> {
        let text = HELP_TEXT.lines().map(plain);
        let (open, _, paint) = line(&self.keys, Action::Open);
        let open: Line = (open, String::from("Open the selected run"), paint);
        let keys = HELP.iter().map(|&action| line(&self.keys, action));
        text.chain([plain(""), open]).chain(keys).collect()
    }

    /// ```text
    ///  ▶ RUNNING  Study thesis · studies/thesis                 about 12 min left
    /// ```
    fn draw_header(&self, area: Rect, buffer: &mut Buffer) {
        let look = &self.look;
        let has = |status| self.rows().iter().any(|row| row.status == status);
        let all_done = || self.rows().iter().all(|row| row.status == RowStatus::Done);
        let (sign, word, paint) = match &self.rows {
            None => (look.signs.paused, "READING", Paint::Notice),
            Some(_) if self.work.is_some() || has(RowStatus::Running) => {
                (look.signs.running, "RUNNING", Paint::Good)
            }
            Some(_) if all_done() => (look.signs.finished, "DONE", Paint::Good),
            Some(_) => (look.signs.stopped, "IDLE", Paint::Notice),
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

    /// Returns the number of runs for each status.
    fn counts(&self) -> String {
        let rows = self.rows();
        let counts = RowStatus::ALL.iter().map(|&status| {
            let count = rows.iter().filter(|row| row.status == status).count();
            (count, status.word())
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
            put(buffer, area, (1, 0), "reading the runs", dim);
            return;
        }
        let rows = self.rows();
        // The first column is for the pointer.
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

    /// Draws the headings, with a mark on the column that the table is sorted by.
    fn draw_head(&self, placed: &[Placed], area: Rect, buffer: &mut Buffer) {
        let look = &self.look;
        let mut at = 1;
        for Placed {
            column,
            head,
            width,
        } in placed
        {
            let (head, paint) = if Some(*column) == self.by {
                let sign = look.signs.order[usize::from(self.reversed)];
                (format!("{sign}{head}"), Paint::Title)
            } else {
                ((*head).to_owned(), Paint::Dim)
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
        let paint = |paint| if is_selected { Paint::Selected } else { paint };
        if is_selected {
            let style = look.style(Paint::Selected);
            buffer.set_style(line.intersection(buffer.area), style);
            put(buffer, line, (0, 0), look.signs.pointer, style);
        }
        let plain = match row.status {
            RowStatus::Waiting => Paint::Dim,
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
                Column::Status => (column.text(row, look.signs), row.status.paint()),
                column => (column.text(row, look.signs), plain),
            };
            let text = aligned(column, &fitted(&text, width, look.signs), width);
            put(buffer, line, (at, 0), &text, look.style(paint(its_paint)));
            at += width as u16 + 1;
        }
    }
}

/// Aligns a text in its column: numbers to the right, words to the left.
fn aligned(column: Column, text: &str, columns: usize) -> String {
    if column.is_number() {
        " ".repeat(columns.saturating_sub(width(text))) + text
    } else {
        text.to_owned()
    }
}
