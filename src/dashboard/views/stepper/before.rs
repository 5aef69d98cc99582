//! The time steps before the one that is shown, a line each.

use ratatui::text::Line;

use super::Shown;
use crate::dashboard::context::ViewContext;
use crate::dashboard::look::Paint;
use crate::dashboard::look::lines::{Pen, number};
use crate::lab::inspection::StepTrace;

/// Lines of the recorded steps before the one that is `back` steps back, as many as
/// `rows`, the latest first.
///
/// ```text
///  step  101  type 1      Wander (600,600)        -0.300  FindBattery ✓
/// ```
///
/// The steps of an earlier trial stand below its number. Subtasks that ended stand behind, with ✓ at their goal and ! elsewhere.
pub(super) fn lines(
    context: &ViewContext,
    shown: &Shown<'_>,
    back: usize,
    rows: usize,
) -> Vec<Line<'static>> {
    let steps = (back + 1..).map_while(|back| context.player.trace(back));
    let (mut trial, mut lines) = (shown.trace.trial, Vec::new());
    for trace in steps.take(rows) {
        if trace.trial != trial {
            trial = trace.trial;
            let text = format!("trial {trial}");
            lines.push(Pen::new(shown.look).text(text, Paint::Dim).line());
        }
        lines.push(line(shown, trace));
    }
    lines.truncate(rows);
    lines
}

fn line(shown: &Shown<'_>, trace: &StepTrace) -> Line<'static> {
    let action = &trace.explanation.action;
    let label = shown.actions(action.node).get(action.chosen);
    let what = format!(
        "{} {}",
        shown.name(action.node),
        label.map_or("", String::as_str)
    );
    let ends = trace
        .explanation
        .update_traces
        .iter()
        .filter_map(|update_trace| {
            let at_goal = update_trace.termination?.at_goal;
            Some((shown.name(update_trace.node), at_goal))
        });
    let mut pen = Pen::new(shown.look)
        .right(&trace.step.to_string(), 5, Paint::Dim)
        .text(
            format!("  type {}  ", trace.before.state_type.number()),
            Paint::Dim,
        )
        .cell(&what, 26, Paint::Text)
        .right(&number(trace.explanation.reward), 8, Paint::Text);
    for (name, at_goal) in ends {
        let (sign, paint) = match at_goal {
            true => (shown.look.signs.finished, Paint::Good),
            false => ("!", Paint::Bad),
        };
        pen = pen.text(format!("  {name} {sign}"), paint);
    }
    pen.line()
}
