//! The MAXQ call stack of a time step, from the root to the action.

use ratatui::text::Line;

use super::{Detail, ShownStep};
use crate::dashboard::look::lines::{Pen, decimals, fixed, number, percent};
use crate::dashboard::look::{Paint, shortened, width};
use crate::learning::{ActionChoice, Choice, Explanation, Level, SelectionRule};

/// In fewer columns, numbers have one digit less.
const NARROW: usize = 60;

/// Columns of a shortened name.
const SHORT: usize = 9;

/// The widths of the parts of a line.
#[derive(Clone, Copy)]
struct Widths {
    name: usize,
    number: usize,
    percent: usize,
    bar: usize,
    /// Digits after the decimal point.
    digits: usize,
}

impl Widths {
    fn of(columns: usize, explanation: &Explanation) -> Self {
        let choices = explanation.levels.iter().flat_map(|level| &level.choices);
        let values = choices.flat_map(|choice| [choice.preference(), choice.value, choice.c]);
        let digits = decimals(values.chain(explanation.action.values.iter().copied()));
        let (number, digits) = if columns < NARROW {
            (7, digits - 1)
        } else {
            (8, digits)
        };
        let percent = 6;
        let rest = columns.saturating_sub(4 * number + percent);
        // Most names have up to 15 characters and are indented by up to 4.
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

/// Returns the lines of the call stack.
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
pub(super) fn lines(shown: &ShownStep<'_>, columns: usize, detail: Detail) -> Vec<Line<'static>> {
    let explanation = &shown.trace.explanation;
    let stack = Stack {
        shown,
        columns,
        widths: Widths::of(columns, explanation),
    };
    let mut lines = vec![stack.head()];
    for (depth, level) in explanation.levels.iter().enumerate() {
        lines.push(stack.title(depth, level));
        if level.chose || detail.standing {
            lines.extend(stack.children(depth, level, detail.children));
        }
    }
    lines.extend(stack.action(explanation.levels.len(), &explanation.action, detail));
    lines
}

/// A call stack with its layout.
struct Stack<'s> {
    shown: &'s ShownStep<'s>,
    columns: usize,
    widths: Widths,
}

impl Stack<'_> {
    /// Returns the heads of the columns.
    fn head(&self) -> Line<'static> {
        let mut pen = Pen::new(self.shown.look).to(self.widths.name);
        for name in ["C~+V", "V", "C~", "C"] {
            pen = pen.right(name, self.widths.number, Paint::Dim);
        }
        pen.right("p", self.widths.percent, Paint::Dim).line()
    }

    /// Returns the line of a node: its value and temperature, and how it chose.
    fn title(&self, depth: usize, level: &Level) -> Line<'static> {
        let digits = self.widths.digits;
        let value = level.value();
        let value = value.map_or(String::new(), |value| {
            format!("  V {}", fixed(value, digits))
        });
        let paint = if level.chose { Paint::Text } else { Paint::Dim };
        let tau = self.shown.look.signs.tau;
        let tau = format!("  {tau} {}  ", number(level.temperature));
        let pen = Pen::new(self.shown.look)
            .to(depth)
            .text(self.shown.name(level.node), Paint::Title)
            .text(value, Paint::Title)
            .text(tau, paint);
        let room = self.columns.saturating_sub(pen.column());
        let forms = how(self.shown, level);
        let form = forms.iter().find(|form| width(form) <= room);
        pen.text(form.unwrap_or(&forms[2]).as_str(), paint).line()
    }

    /// Returns the lines of the children: of `most` if there are more, the active one and the
    /// most probable among them, and a line for the rest.
    fn children(&self, depth: usize, level: &Level, most: usize) -> Vec<Line<'static>> {
        let mut shown: Vec<&Choice> = level.choices.iter().collect();
        shown.sort_by(|a, b| {
            let key = |choice: &Choice| (choice.node == level.active, choice.probability);
            let ((a_acts, a), (b_acts, b)) = (key(a), key(b));
            b_acts.cmp(&a_acts).then(b.total_cmp(&a))
        });
        // One left out would take as much room as its line.
        let rest = if shown.len() > most + 1 {
            shown.split_off(most)
        } else {
            Vec::new()
        };
        shown.sort_by_key(|choice| choice.node);
        let children = shown.into_iter();
        let mut lines: Vec<_> = children
            .map(|choice| self.child(depth, level, choice))
            .collect();
        if !rest.is_empty() {
            let share: f32 = rest.iter().map(|choice| choice.probability).sum();
            let text = format!("{} and {} more", self.shown.look.signs.ellipsis, rest.len());
            let pen = Pen::new(self.shown.look).to(depth + 2);
            let pen = pen.text(text, Paint::Dim);
            let pen = pen.to(self.widths.name + 4 * self.widths.number);
            lines.push(self.probability(pen, share, false, Paint::Dim));
        }
        lines
    }

    /// Returns the line of a child: its values and its probability.
    fn child(&self, depth: usize, level: &Level, choice: &Choice) -> Line<'static> {
        let is_active = choice.node == level.active;
        let (name, values) = match (is_active, level.chose) {
            (true, true) => (Paint::Active, Paint::Title),
            (true, false) => (Paint::Title, Paint::Text),
            (false, true) => (Paint::Text, Paint::Text),
            (false, false) => (Paint::Dim, Paint::Dim),
        };
        let mut pen = self.name(depth, is_active, self.shown.name(choice.node), name);
        for value in [choice.preference(), choice.value, choice.c_tilde, choice.c] {
            let value = fixed(value, self.widths.digits);
            pen = pen.right(&value, self.widths.number, values);
        }
        self.probability(pen, choice.probability, is_active, values)
    }

    /// Returns the lines of a primitive node: its actions with their values and probabilities.
    fn action(&self, depth: usize, action: &ActionChoice, detail: Detail) -> Vec<Line<'static>> {
        let (signs, widths) = (self.shown.look.signs, self.widths);
        let tau = format!(", {} {}", signs.tau, number(action.temperature));
        let (how, tau) = match action.rule {
            _ if action.values.len() == 1 => (String::from("by its only action"), String::new()),
            SelectionRule::EpsilonGreedy => (format!("{}-greedily", signs.epsilon), tau),
            _ => (String::from("by softmax"), tau),
        };
        let subtask = self.shown.tree.subtask(action.node);
        let acts = if action.acts_as == subtask {
            String::from("acts")
        } else {
            format!("acts as {}", action.acts_as.name(self.shown.catalogue))
        };
        let step = if action.persistence > 1 {
            format!(", step {} of {}", action.step, action.persistence)
        } else {
            String::new()
        };
        let name = self.shown.name(action.node);
        let [long, short] = [tau.as_str(), ""].map(|tau| format!("  {acts} {how}{tau}{step}"));
        let fits = depth + width(name) + width(&long) <= self.columns;
        let how = if fits { long } else { short };
        let mut title = Pen::new(self.shown.look)
            .to(depth)
            .text(name, Paint::Title)
            .text(how, Paint::Text);
        let above = widths.name + 2 * widths.number - 1;
        if title.column() < above {
            title = title.to(above).text("Q", Paint::Dim);
        }
        let mut lines = vec![title.line()];
        let labels = self.shown.actions(action).iter();
        let values = action.values.iter().zip(&action.probabilities);
        for (index, (label, (value, share))) in labels.zip(values).enumerate() {
            let is_chosen = index == action.chosen;
            if !is_chosen && !detail.actions {
                continue;
            }
            let (name, numbers) = if is_chosen {
                (Paint::Active, Paint::Title)
            } else {
                (Paint::Text, Paint::Text)
            };
            let pen = self
                .name(depth, is_chosen, label, name)
                .to(widths.name + widths.number)
                .right(&fixed(*value, widths.digits), widths.number, numbers)
                .to(widths.name + 4 * widths.number);
            lines.push(self.probability(pen, *share, is_chosen, numbers));
        }
        lines
    }

    /// Begins the line of a child or an action; a pointer marks the chosen one.
    fn name(&self, depth: usize, is_chosen: bool, name: &str, paint: Paint) -> Pen<'_> {
        let signs = self.shown.look.signs;
        let sign = if is_chosen { signs.pointer } else { " " };
        let pen = Pen::new(self.shown.look).to(depth);
        let pen = pen.text(format!("{sign} "), paint);
        let room = self.widths.name.saturating_sub(pen.column());
        let name = shortened(name, room, signs);
        pen.text(name, paint).to(self.widths.name)
    }

    /// Ends the line of a child or an action.
    fn probability(
        &self,
        pen: Pen<'_>,
        share: f32,
        is_chosen: bool,
        paint: Paint,
    ) -> Line<'static> {
        let share = f64::from(share);
        let bar = if is_chosen { Paint::Good } else { Paint::Dim };
        pen.right(&percent(share), self.widths.percent, paint)
            .text("  ", Paint::Text)
            .bar(share, self.widths.bar, bar)
            .line()
    }
}

/// Tells how a node chose, in a long, a shorter and the shortest form.
fn how(shown: &ShownStep<'_>, level: &Level) -> [String; 3] {
    let epsilon = shown.look.signs.epsilon;
    let (long, short) = match (level.chose, level.rule) {
        (false, _) => {
            let active = shown.name(level.active);
            let short = shortened(active, SHORT, shown.look.signs);
            (format!("continues {active}"), format!("continues {short}"))
        }
        (true, SelectionRule::OnlyChoice) => {
            (String::from("has one choice"), String::from("one choice"))
        }
        (true, SelectionRule::Uniform) => {
            (String::from("chooses uniformly"), String::from("uniform"))
        }
        (true, SelectionRule::Softmax) => {
            (String::from("chooses by softmax"), String::from("softmax"))
        }
        (true, SelectionRule::EpsilonGreedy) => (
            format!("chooses {epsilon}-greedily"),
            format!("{epsilon}-greedy"),
        ),
    };
    if level.invoked {
        let invoked = |how: &str| format!("invoked, {how}");
        [invoked(&long), invoked(&short), short]
    } else {
        [long, short.clone(), short]
    }
}
