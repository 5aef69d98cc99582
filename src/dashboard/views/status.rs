//! What the run is doing.

use std::time::Duration;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::View;
use crate::dashboard::desk::Desk;
use crate::dashboard::header::activity;
use crate::dashboard::keys::Action;
use crate::dashboard::look::{Paint, fitted, one_line, put};
use crate::lab::Ending;

/// What the run is doing.
pub(super) struct Status;

impl View for Status {
    fn draw(&self, desk: &Desk, area: Rect, buffer: &mut Buffer) {
        let look = &desk.look;
        for (row, (name, value, paint)) in facts(desk).iter().enumerate() {
            let Ok(row) = u16::try_from(row) else { return };
            put(buffer, area, (1, row), name, look.style(Paint::Dim));
            let room = usize::from(area.width.saturating_sub(14));
            let value = fitted(&one_line(value), room, look.signs);
            put(buffer, area, (14, row), &value, look.style(*paint));
        }
    }

    fn hints(&self) -> &'static [Action] {
        &[Action::Checkpoint, Action::Stop]
    }

    fn lesson(&self) -> &'static str {
        "What the run is doing. A control step is one time step of one individual; the time\n\
         left is that to the generation limit, evolution may converge long before."
    }
}

type Fact = (&'static str, String, Paint);

fn facts(desk: &Desk) -> Vec<Fact> {
    let model = desk.live();
    let evolution = &desk.scenario().evolution;
    let (sign, word, paint) = activity(desk);
    let mut facts = vec![
        ("evolution", format!("{sign} {word}"), paint),
        ("scenario", desk.scenario().name.clone(), Paint::Text),
        ("seed", desk.bench.seed().to_string(), Paint::Text),
    ];
    let lived = model.latest().map_or(0, |record| record.generation);
    let limit = evolution.generation_limit;
    facts.push((
        "generation",
        format!("{lived} of at most {limit}"),
        Paint::Text,
    ));
    if let Some(progress) = model.progress() {
        let text = match progress.generation {
            0 => String::from("training the primitive subtasks"),
            _ => format!("{} of {} have lived", progress.lived, progress.population),
        };
        facts.push(("individuals", text, Paint::Text));
    }
    match model.ending() {
        Some(Ending::Converged) => facts.push((
            "ended",
            String::from("the better half has one structure"),
            Paint::Good,
        )),
        Some(Ending::GenerationLimit) => {
            facts.push(("ended", String::from("generation limit"), Paint::Notice))
        }
        None => {
            let left = desk.pace.time_to(limit).map_or(String::from("?"), duration);
            facts.push(("time left", format!("at most {left}"), Paint::Text));
        }
    }
    if let Some(rate) = desk.pace.steps_per_second() {
        facts.push(("speed", format!("{rate:.0} control steps/s"), Paint::Text));
    }
    let saved = match model.checkpoint() {
        Some(generation) => format!("after generation {generation}"),
        None => String::from("none yet"),
    };
    facts.push(("checkpoint", saved, Paint::Text));
    facts.push(("folder", desk.folder.clone(), Paint::Text));
    facts
}

fn duration(time: Duration) -> String {
    let seconds = time.as_secs();
    match seconds {
        0..60 => format!("{seconds} s"),
        60..3600 => format!("{} min {} s", seconds / 60, seconds % 60),
        _ => format!("{} h {} min", seconds / 3600, seconds / 60 % 60),
    }
}
