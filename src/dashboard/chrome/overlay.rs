//! Windows that open over a view: help, the export menu, questions.

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Rect};
use ratatui::widgets::{Clear, Widget};

use crate::dashboard::context::{Effect, ViewContext};
use crate::dashboard::keys::{Action, KeyMap, Scope};
use crate::dashboard::look::lines::mark_more;
use crate::dashboard::look::{Look, Paint, fitted, put, width, wrapped};
use crate::dashboard::panel::panel;
use crate::dashboard::view_id::ViewId;

/// A window over the view.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::dashboard) enum Overlay {
    /// What the view shows, and all keys.
    Help {
        /// Number of lines scrolled past the top.
        scroll: u16,
    },
    /// The export menu.
    Export,
    /// A question.
    Question(Question),
}

/// A question that the user must answer before an action is performed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::dashboard) enum Question {
    /// Quit while the run is live?
    Quit,
    /// Stop the run?
    Stop,
}

impl Question {
    fn text(self) -> &'static str {
        match self {
            Self::Quit => "Save the run and quit? It can be resumed later.",
            Self::Stop => "Save and stop the run? It can be resumed later.",
        }
    }

    fn answers(self) -> &'static [Action] {
        match self {
            Self::Quit => &[Action::Yes, Action::Detach, Action::No],
            Self::Stop => &[Action::Yes, Action::No],
        }
    }

    pub(in crate::dashboard) fn yes(self, context: &mut ViewContext) -> Vec<Effect> {
        match self {
            Self::Quit => vec![Effect::Quit],
            Self::Stop => {
                context.stopping = true;
                vec![Effect::Stop]
            }
        }
    }
}

/// A line of a window: keys or nothing, a text, and the paint of the text.
pub(in crate::dashboard) type Line = (String, String, Paint);

/// Draws a window.
pub(in crate::dashboard) fn draw(
    open: &Overlay,
    context: &ViewContext,
    view: ViewId,
    help_texts: &[(&str, &str)],
    area: Rect,
    buffer: &mut Buffer,
) {
    let (titles, lines, scroll) = match open {
        Overlay::Help { scroll } => {
            let lines = help_lines(context, view, help_texts);
            (("Help", view.title()), lines, *scroll)
        }
        Overlay::Export => {
            let lines = of_scope(context, Scope::ExportMenu);
            (("Export", "any other key cancels"), lines, 0)
        }
        Overlay::Question(question) => {
            let answers = question.answers().iter();
            let answers = answers.map(|&action| line(&context.keys, action));
            let lines = [plain(question.text())].into_iter().chain(answers);
            (("Question", ""), lines.collect(), 0)
        }
    };
    window(&context.look, titles, &lines, scroll, area, buffer);
}

/// Returns a line of text without keys.
pub(in crate::dashboard) fn plain(text: &str) -> Line {
    (String::new(), text.to_owned(), Paint::Text)
}

/// Returns the line of an action: its keys and its description.
pub(in crate::dashboard) fn line(keys: &KeyMap, action: Action) -> Line {
    let keys: Vec<_> = keys.keys(action).iter().map(ToString::to_string).collect();
    let description = action.description().trim_end_matches('.');
    (keys.join(" "), description.to_owned(), Paint::Text)
}

fn of_scope(context: &ViewContext, scope: Scope) -> Vec<Line> {
    let actions = Action::ALL.iter().filter(|action| action.scope() == scope);
    actions.map(|&action| line(&context.keys, action)).collect()
}

/// Returns the new scroll position of the help after an action, or `None` if the action closes
/// it.
pub(in crate::dashboard) fn scrolled(
    scroll: u16,
    action: Option<Action>,
    rows: u16,
    lines: usize,
) -> Option<u16> {
    let page = i16::try_from(rows / 2).unwrap_or(i16::MAX);
    let by = match action? {
        Action::Up => -1,
        Action::Down => 1,
        Action::PageUp => -page,
        Action::PageDown => page,
        Action::Top => i16::MIN,
        _ => return None,
    };
    let most = u16::try_from(lines).unwrap_or(u16::MAX);
    Some(scroll.saturating_add_signed(by).min(most))
}

/// Longest line of text that reads easily, in columns.
const READABLE: usize = 88;

/// Returns the lines of the help: what the view shows, and the keys that have an effect in it.
pub(in crate::dashboard) fn help_lines(
    context: &ViewContext,
    view: ViewId,
    help_texts: &[(&str, &str)],
) -> Vec<Line> {
    let mut lines = Vec::new();
    // The border and a blank on either side.
    let columns = usize::from(context.size.0.saturating_sub(4)).min(READABLE);
    for (title, text) in help_texts {
        lines.push((String::new(), (*title).to_owned(), Paint::Title));
        for paragraph in text.split("\n\n") {
            let text = paragraph.replace('\n', " ");
            lines.extend(wrapped(&text, columns, "").iter().map(|line| plain(line)));
            lines.push(plain(""));
        }
    }
    let here = |scope: Scope| match scope {
        Scope::In(views) => view == ViewId::Overview || views.contains(&view),
        Scope::Everywhere | Scope::ExportMenu | Scope::Question => false,
    };
    let groups: [(&str, &dyn Fn(Scope) -> bool); 2] = [
        ("Keys in this view", &here),
        ("Keys in every view", &|scope| scope == Scope::Everywhere),
    ];
    for (title, counts) in groups {
        let actions = Action::ALL.iter().filter(|action| counts(action.scope()));
        let of_group: Vec<_> = actions.map(|&action| line(&context.keys, action)).collect();
        if !of_group.is_empty() {
            lines.push((String::new(), title.to_owned(), Paint::Title));
            lines.extend(of_group);
            lines.push(plain(""));
        }
    }
    lines.pop();
    lines
}

/// Draws lines in a window in the middle of the screen.
pub(in crate::dashboard) fn window(
    look: &Look,
    titles: (&str, &str),
    lines: &[Line],
    scroll: u16,
    area: Rect,
    buffer: &mut Buffer,
) {
    let keys = lines.iter().map(|(keys, ..)| width(keys)).max();
    let texts = lines.iter().map(|(_, text, _)| width(text)).max();
    let (keys, texts) = (keys.unwrap_or(0), texts.unwrap_or(0));
    let wanted = |columns: usize| u16::try_from(columns).unwrap_or(u16::MAX);
    let place = area.centered(
        Constraint::Length(wanted(keys + texts + 6).min(area.width)),
        Constraint::Length(wanted(lines.len() + 2).min(area.height)),
    );
    Clear.render(place, buffer);
    buffer.set_style(place, look.style(Paint::Text));
    let inside = panel(look, place, true, titles, buffer);
    let last = lines.len().saturating_sub(usize::from(inside.height));
    let skipped = usize::from(scroll).min(last);
    let below = last - skipped;
    for (row, (key, text, paint)) in lines.iter().skip(skipped).enumerate() {
        let Ok(row) = u16::try_from(row) else { break };
        put(buffer, inside, (1, row), key, look.style(Paint::Key));
        let from = if key.is_empty() { 1 } else { wanted(keys + 3) };
        let room = usize::from(inside.width.saturating_sub(from));
        let text = fitted(text, room, look.signs);
        put(buffer, inside, (from, row), &text, look.style(*paint));
    }
    mark_more(look, [skipped, below], inside, buffer);
}
