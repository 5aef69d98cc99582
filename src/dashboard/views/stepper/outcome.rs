//! The outcome of a time step: reward, updates and terminations.

use ratatui::text::Line;

use super::{Detail, ShownStep};
use crate::dashboard::look::Paint;
use crate::dashboard::look::lines::{Pen, TINY, is_tiny, number, told_apart};
use crate::dashboard::views::shared;
use crate::learning::{Change, Exit, Replayed, Update, UpdateTrace};
use crate::worlds::StateType;

/// Returns the lines of the outcome.
///
/// ```text
///  state type 2 → 4   reward -0.120
///  VisibleBattery updates ApproachBattery  pseudo-reward 0
///    C~ -0.401 → -0.398   C -0.400 → -0.397
///    N 1   error of C~ +0.012   of C +0.011
///    terminates at its goal   τ 0.812 → 0.808
/// ```
pub(super) fn lines(shown: &ShownStep<'_>, columns: usize, detail: Detail) -> Vec<Line<'static>> {
    let mut lines = vec![transition(shown)];
    let explanation = &shown.trace.explanation;
    if let Some(learned) = explanation.action.learned {
        let pen = Pen::new(shown.look).text(shown.name(explanation.action.node), Paint::Title);
        let pen = pen.text(" updates ", Paint::Text);
        lines.push(change(shown, pen, "Q", learned).line());
    }
    for update_trace in &explanation.update_traces {
        lines.extend(node_updates(shown, update_trace, columns, detail));
    }
    lines.extend(replay(shown, &explanation.replayed));
    if let Some(ended) = &shown.trace.ended {
        let (how, paint) = if ended.delivered {
            ("done in", Paint::Good)
        } else {
            ("truncated at the limit of", Paint::Bad)
        };
        let text = format!("trial {how} {} time steps", ended.steps);
        lines.push(shared::line(shown.look, text, paint));
    }
    lines
}

fn transition(shown: &ShownStep<'_>) -> Line<'static> {
    let trace = shown.trace;
    let number_of = |state_type: StateType| {
        if state_type == shown.catalogue.terminal() {
            String::from("done")
        } else {
            state_type.number().to_string()
        }
    };
    let (before, after) = (trace.before.state_type, trace.after.state_type);
    let pen = Pen::new(shown.look).text("state type ", Paint::Dim);
    let pen = if before == after {
        pen.text(number_of(after), Paint::Title)
            .text(" unchanged", Paint::Dim)
    } else {
        pen.text(number_of(before), Paint::Title)
            .text(format!(" {} ", shown.look.signs.becomes), Paint::Notice)
            .text(number_of(after), Paint::Notice)
    };
    pen.text("   reward ", Paint::Dim)
        .text(number(trace.explanation.reward), Paint::Title)
        .line()
}

/// Returns the lines of a node: its updates, and whether it terminated.
fn node_updates(
    shown: &ShownStep<'_>,
    update_trace: &UpdateTrace,
    columns: usize,
    detail: Detail,
) -> Vec<Line<'static>> {
    let look = shown.look;
    let mut pen = Pen::new(look)
        .text(shown.name(update_trace.node), Paint::Title)
        .text(" updates ", Paint::Dim)
        .text(shown.name(update_trace.child), Paint::Text);
    let (text, paint) = exit(shown, update_trace.exit);
    if !text.is_empty() && pen.column() + 2 + text.len() <= columns {
        pen = pen.text("  ", Paint::Text).text(text, paint);
    }
    let mut lines = vec![pen.line()];
    let pen = Pen::new(look).to(2);
    let pen = change(shown, pen, "C~", update_trace.c_tilde).text("   ", Paint::Text);
    lines.push(change(shown, pen, "C", update_trace.c).line());
    lines.extend(updates(shown, &update_trace.updates, detail.updates));
    if let Some(end) = update_trace.termination {
        let (text, paint) = if end.at_goal {
            ("terminates at its goal", Paint::Good)
        } else {
            ("terminates outside its goal", Paint::Bad)
        };
        let pen = Pen::new(look).to(2).text(text, paint);
        let pen = pen.text("   ", Paint::Text);
        lines.push(change(shown, pen, look.signs.tau, end.temperature).line());
    }
    lines
}

/// Tells what a node learned of the next state beyond its own values there.
fn exit(shown: &ShownStep<'_>, exit: Exit) -> (String, Paint) {
    match exit {
        Exit::PseudoReward(reward) => {
            let paint = if reward == 0.0 {
                Paint::Dim
            } else {
                Paint::Bad
            };
            (format!("pseudo-reward {reward}"), paint)
        }
        Exit::Continuation {
            ancestor: Some(ancestor),
            value,
        } => {
            let text = format!("exit worth {} to {}", number(value), shown.name(ancestor));
            (text, Paint::Notice)
        }
        Exit::Continuation { ancestor: None, .. } => {
            (String::from("exit worth 0, the trial is over"), Paint::Dim)
        }
        Exit::None => (String::new(), Paint::Dim),
    }
}

/// Returns the lines of what the repeated trial changed, if it was repeated.
fn replay(shown: &ShownStep<'_>, replayed: &[Replayed]) -> Vec<Line<'static>> {
    if replayed.is_empty() {
        return Vec::new();
    }
    let title = "the trial is replayed, last decision first";
    let title = shared::line(shown.look, String::from(title), Paint::Title);
    let line = |one: &Replayed| {
        Pen::new(shown.look)
            .to(2)
            .text(shown.name(one.node), Paint::Text)
            .text(" updates ", Paint::Dim)
            .text(shown.name(one.child), Paint::Text)
            .text(format!("  {} times", one.updates), Paint::Text)
            .text("  mean error of C~ ", Paint::Dim)
            .text(number(one.mean_error), Paint::Text)
            .line()
    };
    std::iter::once(title)
        .chain(replayed.iter().map(line))
        .collect()
}

/// Adds a value before and after an update, with enough digits to tell them apart.
fn change<'l>(shown: &ShownStep<'l>, pen: Pen<'l>, name: &str, change: Change) -> Pen<'l> {
    let pen = pen.text(format!("{name} "), Paint::Dim);
    if change.before == change.after && !is_tiny(change.after) {
        return pen.text(number(change.after), Paint::Text);
    }
    let nothing = format!("{}0", shown.look.signs.about);
    let [before, after] = told_apart(change.before, change.after, &nothing);
    if before == after {
        return pen.text(after, Paint::Text);
    }
    pen.text(before, Paint::Text)
        .text(format!(" {} ", shown.look.signs.becomes), Paint::Dim)
        .text(after, Paint::Title)
}

/// Returns the lines of updates with N and errors: the first ones and the last.
fn updates(shown: &ShownStep<'_>, updates: &[Update], listed: usize) -> Vec<Line<'static>> {
    let error = |value| format!("{:>7}", signed(shown, value));
    let line = |update: &Update| {
        Pen::new(shown.look)
            .to(2)
            .text(format!("N {:<4}", update.steps), Paint::Text)
            .text("error of C~ ", Paint::Dim)
            .text(error(update.error_inside), Paint::Text)
            .text("  of C ", Paint::Dim)
            .text(error(update.error_outside), Paint::Text)
            .line()
    };
    let (recent, far) = updates.split_at(updates.len().min(listed));
    let mut lines: Vec<_> = recent.iter().map(line).collect();
    if let [between @ .., last] = far {
        if !between.is_empty() {
            let left_out = between.len();
            let updates = if left_out == 1 { "update" } else { "updates" };
            let text = format!(
                "{} and {left_out} more {updates}",
                shown.look.signs.ellipsis
            );
            lines.push(Pen::new(shown.look).to(2).text(text, Paint::Dim).line());
        }
        lines.push(line(last));
    }
    lines
}

/// Writes a value with its sign, or `~0` if it is tiny.
fn signed(shown: &ShownStep<'_>, value: f32) -> String {
    let text = match value.abs() {
        _ if is_tiny(value) => return format!("{}0", shown.look.signs.about),
        size if (TINY..0.0005).contains(&size) => format!("{value:.0e}"),
        _ => number(value),
    };
    if text.starts_with('-') || value == 0.0 {
        text
    } else {
        format!("+{text}")
    }
}
