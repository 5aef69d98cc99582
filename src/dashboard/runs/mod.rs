//! The table of a study's runs: how far each is, and which one to open.
//!
//! The table knows of runs what its rows say, and nothing of studies or folders: whoever
//! drives it fills the rows and opens what a person has chosen. As the dashboard of a
//! run it is a state, [`RunsTable::key`] and [`RunsTable::tell`], and a pure function that draws.

mod columns;
mod draw;
mod row;
mod table;
mod work;

pub use row::{RunRow, Standing};
pub use table::RunsTable;
pub use work::{RunsEffect, RunsNews, Work};
