//! The changed cells of a frame, grouped by style.

use ratatui::buffer::Cell;
use ratatui::layout::Position;

use super::pen::Pen;

/// The cells of one pen, in reading order.
type Run<'c> = (Pen, Vec<(Position, &'c Cell)>);

/// Changed cells grouped by pen.
///
/// The order in which cells are painted does not matter, because ratatui reports every cell
/// that a changed wide character uncovers.
pub(super) struct StyleRuns<'c> {
    runs: Vec<Run<'c>>,
}

impl<'c> StyleRuns<'c> {
    /// Groups cells in reading order. A blank, which any pen of its background can paint, joins
    /// the group of the cell before it.
    pub(super) fn of(cells: impl Iterator<Item = (u16, u16, &'c Cell)>) -> Self {
        let mut runs: Vec<Run<'c>> = Vec::new();
        let mut blanks = Vec::new();
        let mut last = 0;
        for (x, y, cell) in cells {
            let placed = (Position::new(x, y), cell);
            let suits = |(pen, _): &Run<'_>| pen.for_cell(cell) == *pen;
            match runs.get_mut(last).filter(|run| suits(run)) {
                Some((_, cells)) => cells.push(placed),
                None if cell.symbol() == " " => blanks.push(placed),
                None => {
                    last = place(&mut runs, placed);
                }
            }
        }
        for blank in blanks {
            place(&mut runs, blank);
        }
        for (_, cells) in &mut runs {
            cells.sort_by_key(|(at, _)| (at.y, at.x));
        }
        Self { runs }
    }

    /// Takes the group whose pen is the shortest change from `from`.
    pub(super) fn take_nearest(&mut self, from: Pen) -> Option<Run<'c>> {
        let pens = self.runs.iter().map(|(pen, _)| from.way_to(*pen).len());
        let (nearest, _) = pens.enumerate().min_by_key(|(_, length)| *length)?;
        Some(self.runs.swap_remove(nearest))
    }
}

/// Adds a cell to the group of its pen; returns the index of the group.
fn place<'c>(runs: &mut Vec<Run<'c>>, placed: (Position, &'c Cell)) -> usize {
    let (_, cell) = placed;
    let suited = runs.iter_mut().enumerate();
    let mut suited = suited.filter(|(_, (pen, _))| pen.for_cell(cell) == *pen);
    if let Some((index, (_, cells))) = suited.next() {
        cells.push(placed);
        return index;
    }
    runs.push((Pen::default().for_cell(cell), vec![placed]));
    runs.len() - 1
}
