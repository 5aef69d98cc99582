//! The table of a study's runs, from which a run can be opened.
//!
//! The table knows only its rows, and nothing about studies or folders: its driver fills the
//! rows and opens the run that the user chooses. Like the dashboard of one run it is a state
//! with two functions, [`RunsTable::key`] and [`RunsTable::draw`].

mod columns;
mod draw;
mod row;
mod table;
mod work;

pub use row::{RowStatus, RunRow};
pub use table::RunsTable;
pub use work::{RunsEffect, RunsNews, Work};
