//! The columns of the table: their texts, widths and sort orders.

use std::cmp::Ordering;

use super::row::RunRow;
use crate::dashboard::look::{Signs, one_line, width};

/// A column of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Column {
    Status,
    Scenario,
    Arm,
    Seed,
    Generations,
    Best,
    Fresh,
    Course,
}

use Column::{Arm, Best, Course, Fresh, Generations, Scenario, Seed, Status};

/// The columns with their headings and least widths, in display order.
const COLUMNS: [(Column, &str, usize); 8] = [
    (Status, "state", 9),
    (Scenario, "scenario", 9),
    (Arm, "arm", 9),
    (Seed, "seed", 5),
    (Generations, "gen", 4),
    (Best, "best", 6),
    (Fresh, "fresh", 6),
    (Course, "course", 7),
];

/// The order in which columns are dropped where there is little room.
const DROPPED: [Column; 4] = [Fresh, Course, Scenario, Generations];

/// Most terminal columns of a sparkline.
const LONGEST_COURSE: usize = 50;

/// A column that has room.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    pub(super) column: Column,
    pub(super) head: &'static str,
    pub(super) width: usize,
}

impl Column {
    /// Returns the column to sort by after `now`; `None` is the order of the study.
    pub(super) fn next(now: Option<Self>) -> Option<Self> {
        let sortable = &COLUMNS[..COLUMNS.len() - 1];
        let here = sortable
            .iter()
            .position(|(column, ..)| Some(*column) == now);
        let next = here.map_or(0, |here| here + 1);
        sortable.get(next).map(|(column, ..)| *column)
    }

    /// Compares two runs; unknown values come last.
    pub(super) fn compare(self, one: &RunRow, other: &RunRow) -> Ordering {
        let number = |value: Option<f64>| value.unwrap_or(f64::INFINITY);
        match self {
            Status => one.status.cmp(&other.status),
            Scenario => one.scenario.cmp(&other.scenario),
            Arm => one.arm.cmp(&other.arm),
            Seed => one.seed.cmp(&other.seed),
            Generations => one.generations.cmp(&other.generations),
            Best | Course => number(one.best()).total_cmp(&number(other.best())),
            Fresh => number(one.fresh).total_cmp(&number(other.fresh)),
        }
    }

    /// Returns the text of a cell; empty for the course, which is drawn.
    pub(super) fn text(self, row: &RunRow, signs: &Signs) -> String {
        let steps = |steps: Option<f64>| steps.map_or(String::new(), |steps| format!("{steps:.1}"));
        match self {
            Status => format!("{} {}", row.status.sign(signs), row.status.word()),
            Course => String::new(),
            Scenario => one_line(&row.scenario),
            Arm => one_line(&row.arm),
            Seed => row.seed.to_string(),
            Generations if row.generations == 0 => String::new(),
            Generations => row.generations.to_string(),
            Best => steps(row.best()),
            Fresh => steps(row.fresh),
        }
    }

    pub(super) fn is_number(self) -> bool {
        matches!(self, Seed | Generations | Best | Fresh)
    }
}

/// Returns the columns that have room, as wide as their texts need.
pub(super) fn place(rows: &[RunRow], room: usize, signs: &Signs) -> Vec<Placed> {
    let placed = COLUMNS.map(|(column, head, width)| Placed {
        column,
        head,
        width,
    });
    let mut placed = placed.to_vec();
    let needed = |placed: &[Placed]| placed.iter().map(|column| column.width + 1).sum::<usize>();
    for dropped in DROPPED {
        if needed(&placed) <= room {
            break;
        }
        placed.retain(|placed| placed.column != dropped);
    }
    let mut left = room.saturating_sub(needed(&placed));
    for placed in &mut placed {
        let texts = rows
            .iter()
            .map(|row| width(&placed.column.text(row, signs)));
        let wanted = match placed.column {
            Course => LONGEST_COURSE,
            _ => texts.max().unwrap_or(0),
        };
        let more = wanted.saturating_sub(placed.width).min(left);
        placed.width += more;
        left -= more;
    }
    placed
}
