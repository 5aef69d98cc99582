//! Progress on a terminal.

use std::io::{IsTerminal, stderr};
use std::time::Duration;

use crossbeam_channel::Receiver;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::evolution::GenerationRecord;
use crate::lab::Event;

/// Follows a run to its end; draws a bar where standard error is a terminal.
pub(super) fn follow(events: &Receiver<Event>, limit: u64, population: usize) {
    let bar = bar(limit * population as u64, true);
    let mut message = String::from("training the primitive subtasks");
    for event in events {
        match event {
            Event::Generation(record) => {
                message = describe(&record);
                bar.set_position(record.generation * population as u64);
            }
            Event::Progress {
                generation,
                lived,
                population,
                ..
            } if generation > 0 => {
                bar.set_position((generation - 1) * population as u64 + lived as u64);
            }
            Event::Ended { generations, .. } => bar.set_length(generations * population as u64),
            _ => {}
        }
        bar.set_message(message.clone());
    }
    bar.finish_and_clear();
}

/// A bar on standard error, drawn only where that is a terminal and `shown` says so.
pub(super) fn bar(length: u64, shown: bool) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::hidden());
    if shown {
        appear(&bar);
    }
    let template = "{bar:10} {elapsed}, at most {eta} left  {wide_msg}";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(500));
    bar
}

/// A bar for repeats of the same.
pub(super) fn repeats(number: u64) -> ProgressBar {
    let bar = bar(number, true);
    bar.set_message("repeats");
    bar
}

/// Draws a bar on standard error from now on, where that is a terminal.
pub(super) fn appear(bar: &ProgressBar) {
    if stderr().is_terminal() {
        bar.set_draw_target(ProgressDrawTarget::stderr_with_hz(5));
    }
}

fn describe(record: &GenerationRecord) -> String {
    let middle = record.individuals.len() / 2;
    let mean = |rank| record.mean_trial_steps(rank).unwrap_or(f64::NAN);
    format!(
        "generation {}: best {:.0}, rank {middle} {:.0} steps",
        record.generation,
        mean(1),
        mean(middle)
    )
}
