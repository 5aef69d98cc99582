//! Which primitive subtasks the policies select.

use std::fmt::Write;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::View;
use crate::dashboard::desk::Desk;
use crate::dashboard::keys::Action;
use crate::dashboard::look::{Paint, put};

/// Primitive-selection probabilities of each state type (Thesis Figure 4.10).
pub(super) struct Policy;

impl View for Policy {
    fn caption(&self, _desk: &Desk) -> String {
        String::from("primitive selected, mean of the better half")
    }

    fn draw(&self, desk: &Desk, area: Rect, buffer: &mut Buffer) {
        let Some(record) = desk.shown() else {
            put(
                buffer,
                area,
                (1, 0),
                "no generation has lived yet",
                desk.look.style(Paint::Dim),
            );
            return;
        };
        let mut row = 0;
        for (index, probabilities) in record.selection_probabilities.iter().enumerate() {
            let info = desk.catalogue().state_types.get(index);
            let title = format!("{} {}", index + 1, info.map_or("", |info| info.description));
            put(
                buffer,
                area,
                (1, row),
                &title,
                desk.look.style(Paint::Title),
            );
            row += 1;
            let text = match probabilities {
                None => String::from("no such state in this arena"),
                Some(of) => {
                    let shares = of.iter().filter(|(_, share)| **share >= 0.005);
                    let texts: Vec<_> = shares
                        .map(|(name, share)| format!("{name} {:.0} %", share * 100.0))
                        .collect();
                    texts.join("  ")
                }
            };
            put(buffer, area, (3, row), &text, desk.look.style(Paint::Text));
            row += 1;
        }
    }

    fn hints(&self) -> &'static [Action] {
        &[Action::Earlier, Action::Later, Action::Play]
    }

    fn csv(&self, desk: &Desk) -> Option<String> {
        let mut csv = String::from("generation,state_type,primitive,probability\n");
        for record in desk.model().generations() {
            let types = record.selection_probabilities.iter().enumerate();
            for (index, of) in types.flat_map(|(index, of)| of.iter().map(move |of| (index, of))) {
                for (name, share) in of {
                    // Writing to a string cannot fail.
                    let _ = writeln!(csv, "{},{},{name},{share}", record.generation, index + 1);
                }
            }
        }
        Some(csv)
    }

    fn lesson(&self) -> &'static str {
        "With which probability the policy, followed from the root down, ends in each primitive\n\
         subtask, averaged over sampled states of a type and the better half of the population\n\
         (Thesis 4.5.4, Figure 4.10)."
    }
}
