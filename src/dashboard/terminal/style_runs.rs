//! The changed cells of a frame, those of one look together.

use ratatui::buffer::Cell;
use ratatui::layout::Position;

use super::pen::Pen;

/// The cells to be painted with one pen, line by line.
type Stroke<'c> = (Pen, Vec<(Position, &'c Cell)>);

/// What is to be painted, by the pen that it needs. In which order cells are painted does
/// not matter: ratatui tells all that a change of a wide character lays bare.
pub(super) struct StyleRuns<'c> {
    style_runs: Vec<Stroke<'c>>,
}

impl<'c> StyleRuns<'c> {
    /// Cells in reading order, sorted by what they need. A blank, which suits every pen of its
    /// background, goes with the cell before it.
    pub(super) fn of(cells: impl Iterator<Item = (u16, u16, &'c Cell)>) -> Self {
        let mut style_runs: Vec<Stroke<'c>> = Vec::new();
        let mut blanks = Vec::new();
        let mut last = 0;
        for (x, y, cell) in cells {
            let placed = (Position::new(x, y), cell);
            let suits = |(pen, _): &Stroke<'_>| pen.for_cell(cell) == *pen;
            match style_runs.get_mut(last).filter(|stroke| suits(stroke)) {
                Some((_, cells)) => cells.push(placed),
                None if cell.symbol() == " " => blanks.push(placed),
                None => {
                    last = place(&mut style_runs, placed);
                }
            }
        }
        for blank in blanks {
            place(&mut style_runs, blank);
        }
        for (_, cells) in &mut style_runs {
            cells.sort_by_key(|(at, _)| (at.y, at.x));
        }
        Self { style_runs }
    }

    /// Takes what is to be painted with the pen that is nearest to this one.
    pub(super) fn take_nearest(&mut self, from: Pen) -> Option<Stroke<'c>> {
        let pens = self
            .style_runs
            .iter()
            .map(|(pen, _)| from.way_to(*pen).len());
        let (nearest, _) = pens.enumerate().min_by_key(|(_, length)| *length)?;
        Some(self.style_runs.swap_remove(nearest))
    }
}

/// Adds a cell to the stroke whose pen suits it. Returns which that is.
fn place<'c>(style_runs: &mut Vec<Stroke<'c>>, placed: (Position, &'c Cell)) -> usize {
    let (_, cell) = placed;
    let suited = style_runs.iter_mut().enumerate();
    let mut suited = suited.filter(|(_, (pen, _))| pen.for_cell(cell) == *pen);
    if let Some((index, (_, cells))) = suited.next() {
        cells.push(placed);
        return index;
    }
    style_runs.push((Pen::default().for_cell(cell), vec![placed]));
    style_runs.len() - 1
}
