//! What came of a time step: reward, terminations, what was learned.

use ratatui::text::Line;

use super::{Detail, Shown};
use crate::dashboard::look::Paint;
use crate::dashboard::look::lines::{Pen, TINY, is_tiny, number, told_apart};
use crate::learning::{Change, Update, UpdateTrace};

/// Reward, terminations and updates.
///
/// ```text
///  state type 2 → 4   reward -0.120
///  VisibleBattery learns about ApproachBattery   pseudo-reward 0
///    C~ -0.401 → -0.398   C -0.400 → -0.397
///    N 1   error of C~ +0.012   of C +0.011
///  VisibleBattery ends at its goal   τ 0.812 → 0.808
/// ```
pub(super) fn lines(shown: &Shown<'_>, columns: usize, detail: Detail) -> Vec<Line<'static>> {
    let mut lines = vec![transition(shown)];
    let explanation = &shown.trace.explanation;
    if let Some(learned) = explanation.action.learned {
        let pen = Pen::new(shown.look).text(shown.name(explanation.action.node), Paint::Title);
        let pen = pen.text(" learns about its action   ", Paint::Text);
        lines.push(change(shown, pen, "Q", learned).line());
    }
    for update_trace in &explanation.update_traces {
        lines.extend(taught(shown, update_trace, columns, detail));
    }
    if let Some(ended) = &shown.trace.ended {
        let (text, paint) = match ended.delivered {
            true => (
                format!("trial over: done in {} time steps", ended.steps),
                Paint::Good,
            ),
            false => (
                format!(
                    "trial over: cut off at {} time steps, nothing ended",
                    ended.steps
                ),
                Paint::Bad,
            ),
        };
        lines.push(Pen::new(shown.look).text(text, paint).line());
    }
    lines
}

fn transition(shown: &Shown<'_>) -> Line<'static> {
    let trace = shown.trace;
    let terminal = shown.catalogue.terminal();
    let number_of = |state_type: crate::worlds::StateType| match state_type == terminal {
        true => String::from("done"),
        false => state_type.number().to_string(),
    };
    let (before, after) = (trace.before.state_type, trace.after.state_type);
    let pen = Pen::new(shown.look).text("state type ", Paint::Dim);
    let pen = match before == after {
        true => pen
            .text(number_of(after), Paint::Title)
            .text(" stays", Paint::Dim),
        false => pen
            .text(number_of(before), Paint::Title)
            .text(format!(" {} ", shown.look.signs.becomes), Paint::Notice)
            .text(number_of(after), Paint::Notice),
    };
    pen.text("   reward ", Paint::Dim)
        .text(number(trace.explanation.reward), Paint::Title)
        .line()
}

/// What a node learned, and whether it ended.
fn taught(
    shown: &Shown<'_>,
    update_trace: &UpdateTrace,
    columns: usize,
    detail: Detail,
) -> Vec<Line<'static>> {
    let look = shown.look;
    let pseudo = match update_trace.pseudo_reward {
        0.0 => Paint::Dim,
        _ => Paint::Bad,
    };
    let mut pen = Pen::new(look)
        .text(shown.name(update_trace.node), Paint::Title)
        .text(" learns about ", Paint::Dim)
        .text(shown.name(update_trace.child), Paint::Text);
    let text = format!("pseudo-reward {}", update_trace.pseudo_reward);
    if pen.column() + 2 + text.len() <= columns {
        pen = pen.text("  ", Paint::Text).text(text, pseudo);
    }
    let mut lines = vec![pen.line()];
    let pen = Pen::new(look).to(2);
    let pen = change(shown, pen, "C~", update_trace.c_tilde).text("   ", Paint::Text);
    lines.push(change(shown, pen, "C", update_trace.c).line());
    lines.extend(updates(shown, &update_trace.updates, detail.updates));
    if let Some(end) = update_trace.termination {
        let (text, paint) = match end.at_goal {
            true => ("ends at its goal", Paint::Good),
            false => ("ends without its goal", Paint::Bad),
        };
        let pen = Pen::new(look)
            .to(2)
            .text(text, paint)
            .text("   ", Paint::Text);
        let tau = look.signs.tau;
        lines.push(change(shown, pen, tau, end.temperature).line());
    }
    lines
}

fn change<'l>(shown: &Shown<'l>, pen: Pen<'l>, name: &str, change: Change) -> Pen<'l> {
    let pen = pen.text(format!("{name} "), Paint::Dim);
    let nothing = format!("{}0", shown.look.signs.about);
    let [before, after] = match change.before == change.after && !is_tiny(change.after) {
        true => return pen.text(number(change.after), Paint::Text),
        false => told_apart(change.before, change.after, &nothing),
    };
    if before == after {
        return pen.text(after, Paint::Text);
    }
    pen.text(before, Paint::Text)
        .text(format!(" {} ", shown.look.signs.becomes), Paint::Dim)
        .text(after, Paint::Title)
}

/// The updates with their N and errors: all, or the first ones and the last of many.
fn updates(shown: &Shown<'_>, updates: &[Update], listed: usize) -> Vec<Line<'static>> {
    let line = |update: &Update| {
        Pen::new(shown.look)
            .to(2)
            .text(format!("N {:<4}", update.steps), Paint::Text)
            .text("error of C~ ", Paint::Dim)
            .text(
                format!("{:>7}", signed(shown, update.error_inside)),
                Paint::Text,
            )
            .text("  of C ", Paint::Dim)
            .text(
                format!("{:>7}", signed(shown, update.error_outside)),
                Paint::Text,
            )
            .line()
    };
    let (recent, far) = updates.split_at(updates.len().min(listed));
    let mut lines: Vec<_> = recent.iter().map(line).collect();
    if let [between @ .., last] = far {
        if !between.is_empty() {
            let left_out = between.len();
            let states = if left_out == 1 { "state" } else { "states" };
            let text = format!("{} and {left_out} more {states}", shown.look.signs.ellipsis);
            lines.push(Pen::new(shown.look).to(2).text(text, Paint::Dim).line());
        }
        lines.push(line(last));
    }
    lines
}

fn signed(shown: &Shown<'_>, value: f32) -> String {
    let text = match value.abs() {
        _ if is_tiny(value) => return format!("{}0", shown.look.signs.about),
        size if (TINY..0.0005).contains(&size) => format!("{value:.0e}"),
        _ => number(value),
    };
    match text.starts_with('-') || value == 0.0 {
        true => text,
        false => format!("+{text}"),
    }
}
