//! Studies: many runs, what they say together, and how sure that is.
//!
//! A [`Plan`] names scenarios, arms and seeds; a [`Study`] is its folder, in which every
//! scenario, arm and seed has a run folder of its own. One process may do one run or all
//! of them, on one machine or many: a run depends on nothing but the plan, so the study
//! comes out the same.

mod arm;
mod claims;
mod controls;
mod document;
mod facts;
pub mod figures;
mod findings;
mod merge;
mod metrics;
mod numbers;
mod pace;
mod plan;
mod plan_error;
mod provenance;
pub mod run_export;
mod runner;
mod single;
pub mod statistics;
mod status;
mod study;
pub mod study_export;
mod study_tables;
mod table;
mod winner;
mod write;

pub use arm::{Arm, Base};
pub use claims::{CLAIMS, Claim, Evidence, Scope, Verdict, judge};
pub use controls::StudyControls;
pub use facts::{Facts, FreshFacts, Moment, Winner};
pub use findings::{Comparison, Findings, JudgedClaim, MetricSummary, RunGroup, TraitCount};
pub use merge::{MergeError, merge};
pub use numbers::Numbers;
pub use pace::Pace;
pub use plan::{MAX_PLAN_BYTES, PLAN_FORMAT, Plan, Reevaluation};
pub use plan_error::PlanError;
pub use provenance::Provenance;
pub use runner::{StudyEvent, run_study};
pub use single::{Fresh, Single, SingleError};
pub use status::{RunState, RunStatus, StatusWatch, course, status};
pub use study::{RunId, Study, StudyError};
pub use table::Table;
pub use write::{ReportError, Written, read_facts, write_report};
