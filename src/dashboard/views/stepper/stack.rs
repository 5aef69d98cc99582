//! The MAXQ call stack of a time step, from the root to the action.

use ratatui::text::Line;

use super::{Detail, Shown};
use crate::dashboard::look::lines::{Pen, decimals, fixed, number, percent};
use crate::dashboard::look::{Paint, shortened, width};
use crate::learning::{ActionChoice, Choice, Explanation, Level, SelectionRule};

/// Columns below which numbers have a digit less.
const NARROW: usize = 60;

/// Columns of a name in short.
const SHORT: usize = 9;

/// How wide the parts of a line are.
#[derive(Clone, Copy)]
struct Widths {
    name: usize,
    number: usize,
    percent: usize,
    bar: usize,
    /// Digits after the point.
    digits: usize,
}

impl Widths {
    fn of(columns: usize, explanation: &Explanation) -> Self {
        let choices = explanation.levels.iter().flat_map(|level| &level.choices);
        let values = choices.flat_map(|choice| [choice.preference(), choice.value, choice.c]);
        let digits = decimals(values.chain(explanation.action.values.iter().copied()));
        let (number, percent, digits) = match columns < NARROW {
            true => (7, 6, digits - 1),
            false => (8, 6, digits),
        };
        let rest = columns.saturating_sub(4 * number + percent);
        // Names are up to 15 long and indented by up to 4.
        let name = rest.min(24);
        Self {
            name,
            bar: rest.saturating_sub(name + 2).min(20),
            number,
            percent,
            digits,
        }
    }
}

/// The call stack.
///
/// ```text
///                        C~+V       V      C~       C     p
///  Root  V -3.612  τ 0.812  chooses by softmax
///  ▸ FindBattery       -3.612  -3.212  -0.400  -0.400  88 %  ━━━━━━━━
///    Wander            -5.401  -0.300  -5.101  -5.101  12 %  ━
///   FindBattery  V -3.212  τ 0.900  invoked, chooses by softmax
///   ▸ Avoid            ...
///    Avoid  acts
///    ▸ (600,600)                -0.300                  74 %  ━━━━━━━
/// ```
pub(super) fn lines(shown: &Shown<'_>, columns: usize, detail: Detail) -> Vec<Line<'static>> {
    let explanation = &shown.trace.explanation;
    let widths = Widths::of(columns, explanation);
    let mut lines = vec![head(shown, widths)];
    for (depth, level) in explanation.levels.iter().enumerate() {
        lines.push(title(shown, widths, columns, depth, level));
        if level.chose || detail.standing {
            let choices = level.choices.iter();
            lines.extend(choices.map(|choice| child(shown, widths, depth, level, choice)));
        }
    }
    let depth = explanation.levels.len();
    lines.extend(action(shown, widths, depth, &explanation.action, detail));
    lines
}

fn head(shown: &Shown<'_>, widths: Widths) -> Line<'static> {
    let mut pen = Pen::new(shown.look).to(widths.name);
    for name in ["C~+V", "V", "C~", "C"] {
        pen = pen.right(name, widths.number, Paint::Dim);
    }
    pen.right("p", widths.percent, Paint::Dim).line()
}

fn title(
    shown: &Shown<'_>,
    widths: Widths,
    columns: usize,
    depth: usize,
    level: &Level,
) -> Line<'static> {
    let signs = shown.look.signs;
    let value = level.value().map_or(String::new(), |value| {
        format!("  V {}", fixed(value, widths.digits))
    });
    let paint = match level.chose {
        true => Paint::Text,
        false => Paint::Dim,
    };
    let tau = format!("  {} {}  ", signs.tau, number(level.temperature));
    let pen = Pen::new(shown.look)
        .to(depth)
        .text(shown.name(level.node), Paint::Title)
        .text(value, Paint::Title)
        .text(tau, paint);
    let room = columns.saturating_sub(pen.column());
    let ways = how(shown, level);
    let how = ways.iter().find(|way| width(way) <= room);
    pen.text(how.unwrap_or(&ways[2]).as_str(), paint).line()
}

/// How a node chose: in words, in short, in the shortest way.
fn how(shown: &Shown<'_>, level: &Level) -> [String; 3] {
    let epsilon = shown.look.signs.epsilon;
    let (long, short) = match (level.chose, level.rule) {
        (false, _) => {
            let active = shown.name(level.active);
            let short = shortened(active, SHORT, shown.look.signs);
            (format!("goes on with {active}"), format!("on with {short}"))
        }
        (true, SelectionRule::OnlyChoice) => {
            (String::from("has one choice"), String::from("one choice"))
        }
        (true, SelectionRule::Uniform) => {
            (String::from("chooses at random"), String::from("at random"))
        }
        (true, SelectionRule::Softmax) => {
            (String::from("chooses by softmax"), String::from("softmax"))
        }
        (true, SelectionRule::EpsilonGreedy) => (
            format!("chooses {epsilon}-greedily"),
            format!("{epsilon}-greedy"),
        ),
    };
    match level.invoked {
        true => [
            format!("invoked, {long}"),
            format!("invoked, {short}"),
            short,
        ],
        false => [long, short.clone(), short],
    }
}

fn child(
    shown: &Shown<'_>,
    widths: Widths,
    depth: usize,
    level: &Level,
    choice: &Choice,
) -> Line<'static> {
    let is_active = choice.node == level.active;
    let (name, values) = match (is_active, level.chose) {
        (true, true) => (Paint::Active, Paint::Title),
        (true, false) => (Paint::Title, Paint::Text),
        (false, true) => (Paint::Text, Paint::Text),
        (false, false) => (Paint::Dim, Paint::Dim),
    };
    let mut pen = named(
        shown,
        widths,
        depth,
        is_active,
        shown.name(choice.node),
        name,
    );
    for value in [choice.preference(), choice.value, choice.c_tilde, choice.c] {
        pen = pen.right(&fixed(value, widths.digits), widths.number, values);
    }
    probability(pen, widths, choice.probability, is_active, values).line()
}

/// The beginning of the line of a child or an action.
fn named<'s>(
    shown: &Shown<'s>,
    widths: Widths,
    depth: usize,
    is_chosen: bool,
    name: &str,
    paint: Paint,
) -> Pen<'s> {
    let sign = if is_chosen {
        shown.look.signs.pointer
    } else {
        " "
    };
    let pen = Pen::new(shown.look)
        .to(depth)
        .text(format!("{sign} "), paint);
    let room = widths.name.saturating_sub(pen.column());
    let name = shortened(name, room, shown.look.signs);
    pen.text(name, paint).to(widths.name)
}

fn probability(
    pen: Pen<'_>,
    widths: Widths,
    probability: f32,
    is_chosen: bool,
    paint: Paint,
) -> Pen<'_> {
    let share = f64::from(probability);
    let bar = if is_chosen { Paint::Good } else { Paint::Dim };
    pen.right(&percent(share), widths.percent, paint)
        .text("  ", Paint::Text)
        .bar(share, widths.bar, bar)
}

fn action(
    shown: &Shown<'_>,
    widths: Widths,
    depth: usize,
    action: &ActionChoice,
    detail: Detail,
) -> Vec<Line<'static>> {
    let signs = shown.look.signs;
    let how = match action.rule {
        SelectionRule::EpsilonGreedy => format!("{}-greedily", signs.epsilon),
        _ => String::from("by softmax"),
    };
    let title = Pen::new(shown.look)
        .to(depth)
        .text(shown.name(action.node), Paint::Title)
        .text(
            format!("  acts {how}, {} {}", signs.tau, number(action.temperature)),
            Paint::Text,
        );
    let above = widths.name + 2 * widths.number - 1;
    let title = match title.column() < above {
        true => title.to(above).text("Q", Paint::Dim),
        false => title,
    };
    let mut lines = vec![title.line()];
    let labels = shown.actions(action.node).iter();
    let values = action.values.iter().zip(&action.probabilities);
    for (index, (label, (value, share))) in labels.zip(values).enumerate() {
        let is_chosen = index == action.chosen;
        if !is_chosen && !detail.actions {
            continue;
        }
        let (name, numbers) = match is_chosen {
            true => (Paint::Active, Paint::Title),
            false => (Paint::Text, Paint::Text),
        };
        let pen = named(shown, widths, depth, is_chosen, label, name)
            .to(widths.name + widths.number)
            .right(&fixed(*value, widths.digits), widths.number, numbers)
            .to(widths.name + 4 * widths.number);
        lines.push(probability(pen, widths, *share, is_chosen, numbers).line());
    }
    lines
}
