//! The curve page: how an individual learns while it lives, and what its line has inherited.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::dashboard::context::ViewContext;
use crate::dashboard::look::{Chart, Curve, Paint, fitted, put, wrapped};
use crate::dashboard::views::shared::{below, csv_line};
use crate::lab::inspection::TrialLengths;

/// Mean time steps per trial at a trial or in a generation.
type Course = [(u64, f64)];

/// Draws the learning curve of the rollout above that of the line of descent.
///
/// ```text
///  rollout, 2 trials a point: 310.5, now 161.0
///   350 ⠒⢄
///   150   ⠑⠒⠤⠤
///       2    24
///  line of descent, each generation: 812.0, now 143.3
///   850 ⠒⢄
/// ```
pub(super) fn draw(context: &ViewContext, line: &Course, area: Rect, buffer: &mut Buffer) {
    let rollout = context.player.rollout();
    let lengths = rollout.map(|rollout| rollout.status().lengths.clone());
    let lengths = lengths.unwrap_or_default();
    let upper = Rect {
        height: area.height / 2,
        ..area
    };
    let parts = [
        (of_rollout(&lengths), lengths.means(), Paint::Series1, upper),
        (
            String::from("its line of descent, each generation"),
            line.to_vec(),
            Paint::Series2,
            below(area, upper.height),
        ),
    ];
    for (title, course, paint, area) in parts {
        draw_course(context, &title, &course, paint, area, buffer);
    }
}

fn of_rollout(lengths: &TrialLengths) -> String {
    match lengths.stretch() {
        1 => String::from("this rollout, each trial"),
        stretch => format!("this rollout, means of {stretch} trials"),
    }
}

/// Draws a title with the first and the last value, and a chart where there is room.
fn draw_course(
    context: &ViewContext,
    title: &str,
    course: &Course,
    paint: Paint,
    area: Rect,
    buffer: &mut Buffer,
) {
    let look = &context.look;
    let values = match course {
        [] => String::from("no trial has ended yet"),
        [(_, only)] => format!("{only:.1} time steps"),
        [(_, first), .., (_, last)] => format!("{first:.1} at first, now {last:.1}"),
    };
    let text = format!("{title}: {values}");
    let room = usize::from(area.width);
    let lines = wrapped(&text, room, "  ");
    for (row, text) in (0..area.height).zip(&lines) {
        let text = fitted(text, room, look.signs);
        put(buffer, area, (0, row), &text, look.style(paint));
    }
    if course.len() < 2 {
        return;
    }
    let points = course.iter().map(|&(at, steps)| Some([at as f64, steps]));
    let curve = Curve {
        points: points.collect(),
        paint,
        letter: None,
    };
    let chart = Chart::of(vec![curve], [f64::INFINITY, f64::NEG_INFINITY]);
    let rest = below(area, lines.len() as u16);
    chart.rounded().draw(look, rest, buffer);
}

/// Writes both curves as CSV.
pub(super) fn csv(context: &ViewContext, line: &Course) -> String {
    let rollout = context.player.rollout();
    let means = rollout.map_or(Vec::new(), |rollout| rollout.status().lengths.means());
    let mut csv = String::from("curve,at,mean_steps\n");
    for (name, course) in [("trial", means.as_slice()), ("generation", line)] {
        for (at, steps) in course {
            csv_line(&mut csv, &[&name, at, steps]);
        }
    }
    csv
}
