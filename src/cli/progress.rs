//! Progress bars on standard error, drawn only where that is a terminal.

use std::io::{IsTerminal, stderr};
use std::time::Duration;

use crossbeam_channel::Receiver;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::evolution::GenerationRecord;
use crate::lab::Event;
use crate::scenario::EvolutionSettings;

/// Follows a run to its end with a bar.
///
/// It counts control steps where the scenario limits them, and individuals otherwise.
pub(super) fn follow(events: &Receiver<Event>, evolution: &EvolutionSettings) {
    let individuals = |generations: u64| generations * evolution.population_size as u64;
    let step_limit = evolution.control_step_limit;
    let bar = hidden(
        step_limit.unwrap_or(individuals(evolution.generation_limit)),
        "{bar:10} {elapsed}, at most {eta} left  {wide_msg}",
    );
    show(&bar);
    let mut message = String::from("training the primitive subtasks");
    for event in events {
        match event {
            Event::Generation(record) => {
                message = describe(&record);
                bar.set_position(match step_limit {
                    Some(_) => record.control_steps,
                    None => individuals(record.generation),
                });
            }
            Event::Progress {
                generation, lived, ..
            } if generation > 0 && step_limit.is_none() => {
                bar.set_position(individuals(generation - 1) + lived as u64)
            }
            Event::Ended { generations, .. } if step_limit.is_none() => {
                bar.set_length(individuals(generations));
            }
            _ => {}
        }
        bar.set_message(message.clone());
    }
    bar.finish_and_clear();
}

/// A bar that is not drawn yet.
pub(super) fn hidden(length: u64, template: &str) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::hidden());
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(500));
    bar
}

/// A bar that counts finished repeats.
pub(super) fn repeats(number: u64) -> ProgressBar {
    let bar = hidden(
        number,
        "{bar:20} {pos} of {len} repeats, {elapsed}, about {eta} left",
    );
    show(&bar);
    bar
}

/// Draws a bar from now on.
pub(super) fn show(bar: &ProgressBar) {
    if stderr().is_terminal() {
        bar.set_draw_target(ProgressDrawTarget::stderr_with_hz(5));
    }
}

fn describe(record: &GenerationRecord) -> String {
    let middle = record.individuals.len() / 2;
    let mean = |rank| record.mean_trial_steps(rank).unwrap_or(f64::NAN);
    format!(
        "generation {}: {:.0} steps per trial (best), {:.0} (rank {middle})",
        record.generation,
        mean(1),
        mean(middle)
    )
}
