//! The state of the table, and its response to keys and clicks.

use std::collections::BTreeMap;

use ratatui::Frame;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::columns::Column;
use super::row::{RowStatus, RunRow};
use super::work::{self, RunsEffect, RunsNews, Work};
use crate::dashboard::chrome::overlay;
use crate::dashboard::context::{Mouse, line_at};
use crate::dashboard::keys::{Action, Key, KeyMap};
use crate::dashboard::look::Look;
use crate::dashboard::panel::{body, inside};
use crate::dashboard::view_id::ViewId;

/// A table of runs.
#[derive(Clone, Debug)]
pub struct RunsTable {
    pub(super) name: String,
    pub(super) folder: String,
    pub(super) look: Look,
    pub(super) keys: KeyMap,
    pub(super) size: (u16, u16),
    /// The runs in the order of the study; `None` before they are read.
    pub(super) rows: Option<Vec<RunRow>>,
    /// Smallest and largest value of all courses of a scenario, the common scale of their
    /// sparklines.
    pub(super) ranges: BTreeMap<String, [f64; 2]>,
    /// The column that the rows are sorted by; `None` is the order of the study.
    pub(super) by: Option<Column>,
    pub(super) reversed: bool,
    /// Index of the selected run in `rows`.
    pub(super) selected: usize,
    /// The scroll position of the help, while it is open.
    pub(super) help: Option<u16>,
    /// The work of this program on the runs, while there is any.
    pub(super) work: Option<Work>,
    /// Whether the question about the work is open.
    pub(super) question_open: bool,
    /// The message since the last key.
    pub(super) message: Option<String>,
}

impl RunsTable {
    /// Creates the table of a study; `folder` is the study's folder, as shown to the user.
    #[must_use]
    pub fn new(name: String, folder: String, look: Look, keys: KeyMap) -> Self {
        Self {
            name,
            folder,
            look,
            keys,
            size: (80, 24),
            rows: None,
            ranges: BTreeMap::new(),
            by: None,
            reversed: false,
            selected: 0,
            help: None,
            work: None,
            question_open: false,
            message: None,
        }
    }

    /// Returns the themes and signs in use.
    #[must_use]
    pub fn look(&self) -> &Look {
        &self.look
    }

    /// Sets the size of the terminal in columns and rows.
    pub fn resize(&mut self, columns: u16, rows: u16) {
        self.size = (columns, rows);
    }

    /// Shows a message until the next key.
    pub fn show_message(&mut self, text: impl Into<String>) {
        self.message = Some(text.into());
    }

    /// Updates the runs and the work on them; returns whether anything has changed.
    pub fn update(&mut self, news: RunsNews) -> bool {
        let changed = self.work != news.work;
        self.work = news.work;
        self.question_open &= self.work.is_some();
        self.set_rows(news.rows) || changed
    }

    /// Sets the rows, which must always have the same order; returns whether anything has
    /// changed.
    pub fn set_rows(&mut self, rows: Vec<RunRow>) -> bool {
        if self.rows.as_ref() == Some(&rows) {
            return false;
        }
        self.ranges.clear();
        for row in &rows {
            let known = [f64::INFINITY, f64::NEG_INFINITY];
            let range = self.ranges.entry(row.scenario.clone()).or_insert(known);
            for steps in &row.course {
                *range = [range[0].min(*steps), range[1].max(*steps)];
            }
        }
        self.selected = self.selected.min(rows.len().saturating_sub(1));
        self.rows = Some(rows);
        true
    }

    /// Handles a key; returns the effect that the caller must run.
    pub fn key(&mut self, key: Key) -> Option<RunsEffect> {
        self.message = None;
        if self.question_open {
            self.question_open = false;
            return work::answer(&self.keys, key);
        }
        // The table shares its keys with the population view.
        let action = self.keys.in_view(key, ViewId::Population);
        if let Some(scroll) = self.help {
            let lines = self.help_lines().len();
            self.help = overlay::scrolled(scroll, action, self.size.1, lines);
            return None;
        }
        self.perform(action?)
    }

    pub(super) fn perform(&mut self, action: Action) -> Option<RunsEffect> {
        let page = (self.size.1 / 2).max(1) as isize;
        match action {
            Action::Up => self.select(-1),
            Action::Down => self.select(1),
            Action::PageUp => self.select(-page),
            Action::PageDown => self.select(page),
            Action::Top => self.select(isize::MIN),
            Action::Bottom => self.select(isize::MAX),
            Action::Sort => self.by = Column::next(self.by),
            Action::Reverse => self.reversed = !self.reversed,
            Action::Open => return self.open(),
            Action::Help => self.help = Some(0),
            Action::Theme => {
                self.look.next_theme();
                self.show_message(format!("theme: {}", self.look.theme()));
            }
            Action::Quit if self.work.is_some() => self.question_open = true,
            Action::Quit => return Some(RunsEffect::Leave),
            Action::Suspend => return Some(RunsEffect::Suspend),
            Action::Redraw => return Some(RunsEffect::Redraw),
            _ => {}
        }
        None
    }

    /// Selects the run at a position of the screen; returns whether it was already selected.
    pub(super) fn click(&mut self, at: Position) -> bool {
        self.message = None;
        if self.help.take().is_some() || std::mem::take(&mut self.question_open) {
            return false;
        }
        let (width, height) = self.size;
        let table = inside(body(Rect::new(0, 0, width, height)));
        let line = line_at(at, table, 1);
        let clicked = line.and_then(|line| self.visible(table).get(line).copied());
        let before = self.selected;
        self.selected = clicked.unwrap_or(before);
        clicked == Some(before)
    }

    /// Returns the indices of the rows that have room below the headings, the selected one
    /// among them.
    pub(super) fn visible(&self, area: Rect) -> Vec<usize> {
        let sorted = self.sorted();
        let here = sorted.iter().position(|&place| place == self.selected);
        let rows = usize::from(area.height.saturating_sub(1));
        let skipped = here.unwrap_or(0).saturating_sub(rows / 2);
        let skipped = skipped.min(sorted.len().saturating_sub(rows));
        sorted.into_iter().skip(skipped).take(rows).collect()
    }

    fn open(&mut self) -> Option<RunsEffect> {
        let row = self.rows().get(self.selected)?;
        match (row.status, &row.trouble) {
            (RowStatus::Waiting, _) => self.show_message("this run has not started"),
            (RowStatus::Unreadable | RowStatus::Failed, Some(trouble)) => {
                self.show_message(trouble.clone())
            }
            _ => return Some(RunsEffect::Open(self.selected)),
        }
        None
    }

    pub(super) fn rows(&self) -> &[RunRow] {
        self.rows.as_deref().unwrap_or_default()
    }

    /// Returns the indices of the rows in display order.
    fn sorted(&self) -> Vec<usize> {
        let rows = self.rows();
        let mut places: Vec<_> = (0..rows.len()).collect();
        if let Some(column) = self.by {
            places.sort_by(|&one, &other| column.compare(&rows[one], &rows[other]));
        }
        if self.reversed {
            places.reverse();
        }
        places
    }

    /// Moves the selection `by` lines down.
    fn select(&mut self, by: isize) {
        let sorted = self.sorted();
        let here = sorted.iter().position(|&place| place == self.selected);
        let next = here.unwrap_or(0).saturating_add_signed(by);
        if let Some(&place) = sorted.get(next).or(sorted.last()) {
            self.selected = place;
        }
    }

    /// Returns a frame of the current terminal size.
    #[must_use]
    pub fn frame(&self) -> Buffer {
        let (width, height) = self.size;
        let mut buffer = Buffer::empty(Rect::new(0, 0, width, height));
        self.draw_on(&mut buffer);
        buffer
    }

    /// Draws a frame.
    pub fn draw(&self, frame: &mut Frame<'_>) {
        self.draw_on(frame.buffer_mut());
    }

    /// Handles a mouse gesture: a click on the selected run opens it.
    pub fn mouse(&mut self, mouse: Mouse) -> Option<RunsEffect> {
        match mouse.what.scrolls() {
            Some(action) => self.perform(action),
            None if self.click(mouse.at) => self.perform(Action::Open),
            None => None,
        }
    }
}
