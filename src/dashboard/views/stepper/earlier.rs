//! The earlier time steps, one line each.

use ratatui::text::Line;

use super::ShownStep;
use crate::dashboard::context::ViewContext;
use crate::dashboard::look::Paint;
use crate::dashboard::look::lines::{Pen, number};
use crate::dashboard::views::shared;
use crate::lab::inspection::StepTrace;

/// Returns at most `rows` lines with the recorded steps before the one that is `back` steps
/// back, the latest first.
///
/// ```text
///  step  101  type 1      Wander (600,600)        -0.300  FindBattery ✓
/// ```
///
/// A line ends with the subtasks that terminated, marked ✓ at their goal and ! elsewhere.
/// The steps of an earlier trial stand below its number.
pub(super) fn lines(
    context: &ViewContext,
    shown: &ShownStep<'_>,
    back: usize,
    rows: usize,
) -> Vec<Line<'static>> {
    let steps = (back + 1..).map_while(|back| context.player.trace(back));
    let (mut trial, mut lines) = (shown.trace.trial, Vec::new());
    for trace in steps.take(rows) {
        if trace.trial != trial {
            trial = trace.trial;
            let text = format!("trial {trial}");
            lines.push(shared::line(shown.look, text, Paint::Dim));
        }
        lines.push(line(shown, trace));
    }
    lines.truncate(rows);
    lines
}

fn line(shown: &ShownStep<'_>, trace: &StepTrace) -> Line<'static> {
    let action = &trace.explanation.action;
    let label = shown.actions(action).get(action.chosen);
    let label = label.map_or("", String::as_str);
    let what = format!("{} {label}", shown.name(action.node));
    let state_type = format!("  type {}  ", trace.before.state_type.number());
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
        .text(state_type, Paint::Dim)
        .cell(&what, 26, Paint::Text)
        .right(&number(trace.explanation.reward), 8, Paint::Text);
    for (name, at_goal) in ends {
        let (sign, paint) = if at_goal {
            (shown.look.signs.finished, Paint::Good)
        } else {
            ("!", Paint::Bad)
        };
        pen = pen.text(format!("  {name} {sign}"), paint);
    }
    pen.line()
}
