//! The full product: every view is drawn in every size, world and state of the run, and every
//! key is pressed in every view and state, in one world of places and two worlds of cells. For
//! keys the sizes alternate.
//!
//! Why it matters: nobody looks at most frames, and those are the ones that go wrong: a panel
//! that draws over its border, a caption that ends in the middle of a word, a key in the hint
//! bar without an effect.

use std::time::Duration;

use maxq_lab::dashboard::keys::{Action, KeyMap, Scope};
use maxq_lab::dashboard::look::Signs;
use maxq_lab::dashboard::{Input, Mode, ViewId};
use maxq_lab::hierarchy::Glyphs::Unicode;
use maxq_lab::lab::Event;
use ratatui::buffer::Buffer;

use super::options::remembering;
use super::recorded::{Recorded, Screen, cells, foraging};

/// The states of a run on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    BeforeAnything,
    Training,
    Running,
    Paused,
    Stepping,
    Frozen,
    Stopped,
    Watched,
    Finished,
    Replayed,
    Past,
    Halted,
    Unfinished,
}

impl State {
    const ALL: [Self; 13] = [
        Self::BeforeAnything,
        Self::Training,
        Self::Running,
        Self::Paused,
        Self::Stepping,
        Self::Frozen,
        Self::Stopped,
        Self::Watched,
        Self::Finished,
        Self::Replayed,
        Self::Past,
        Self::Halted,
        Self::Unfinished,
    ];

    fn mode(self) -> Mode {
        match self {
            Self::Watched => Mode::Watch,
            Self::Replayed | Self::Past | Self::Halted | Self::Unfinished => Mode::Replay,
            _ => Mode::Live,
        }
    }

    /// The first word on the screen.
    fn word(self) -> &'static str {
        match self {
            Self::BeforeAnything | Self::Training => "TRAINING",
            Self::Running | Self::Frozen | Self::Watched => "RUNNING",
            Self::Paused => "PAUSED",
            Self::Stepping => "STEPPING",
            Self::Stopped => "STOPPED",
            Self::Finished | Self::Replayed | Self::Past | Self::Halted => "FINISHED",
            Self::Unfinished => "UNFINISHED",
        }
    }

    /// Returns a dashboard over a run in this state.
    fn screen(self, run: &Recorded) -> Screen {
        let mut screen = run.blank(self.mode(), "dark", Unicode);
        let ends = |event: &&Event| matches!(event, Event::Ended { .. });
        let lived = run.events.iter().filter(|event| !ends(event)).cloned();
        let told: Vec<_> = match self {
            Self::BeforeAnything => Vec::new(),
            Self::Training => run.events[..1]
                .iter()
                .cloned()
                .chain([progress(0)])
                .collect(),
            Self::Finished | Self::Replayed | Self::Past | Self::Halted => run.events.clone(),
            Self::Unfinished => lived.collect(),
            _ => lived.chain([progress(9)]).collect(),
        };
        for event in told {
            screen.send(event);
        }
        screen.wait(0.3);
        match self {
            Self::Paused => drop(screen.send(Event::Paused)),
            Self::Stepping => drop(screen.press("n")),
            Self::Frozen => drop(screen.press("f")),
            Self::Stopped => drop(screen.0.update(Input::Closed)),
            Self::Past => drop(screen.press("[")),
            Self::Halted => drop(screen.press("space")),
            _ => {}
        }
        screen
    }
}

fn progress(generation: u64) -> Event {
    Event::Progress {
        generation,
        lived: 3,
        population: 6,
        control_steps: 123_456,
    }
}

const SIZES: [(u16, u16); 5] = [(80, 24), (120, 40), (200, 60), (40, 12), (57, 17)];
const TINY: [(u16, u16); 4] = [(20, 5), (1, 1), (0, 0), (39, 60)];

/// The origin of a frame, for messages.
type Of = (State, ViewId, (u16, u16));

/// The lines of a frame, one character per cell.
fn lines(frame: &Buffer) -> Vec<Vec<char>> {
    let width = usize::from(frame.area.width).max(1);
    let rows = frame.content.chunks(width);
    let first = |symbol: &str| symbol.chars().next().unwrap_or(' ');
    rows.map(|row| row.iter().map(|cell| first(cell.symbol())).collect())
        .collect()
}

/// The panels of a frame: left, top, right, bottom.
fn panels(lines: &[Vec<char>]) -> Vec<[usize; 4]> {
    let mut panels = Vec::new();
    for (top, line) in lines.iter().enumerate() {
        for (left, _) in line.iter().enumerate().filter(|(_, c)| **c == '╭') {
            let right = (left..line.len()).find(|&at| line[at] == '╮');
            let bottom = (top..lines.len()).find(|&at| lines[at][left] == '╰');
            panels.push([left, top, right.unwrap_or(0), bottom.unwrap_or(0)]);
        }
    }
    panels
}

fn text(lines: &[Vec<char>]) -> String {
    let lines = lines.iter().map(|line| line.iter().collect::<String>());
    lines.collect::<Vec<_>>().join("\n")
}

/// Checks what holds for every frame.
fn check(lines: &[Vec<char>], of: Of) {
    let (_, view, (width, height)) = of;
    let text = || text(lines);
    assert!(!lines.iter().flatten().any(|c| c.is_control()), "{of:?}");
    if width < 40 || height < 12 {
        assert!(
            width < 9 || height < 1 || text().contains("too small"),
            "{of:?}\n{}",
            text()
        );
        return;
    }
    // No panel draws over its border, or over that of another.
    let panels = panels(lines);
    assert!(!panels.is_empty(), "{of:?}\n{}", text());
    for &[left, top, right, bottom] in &panels {
        assert!(right > left && bottom > top, "{of:?}\n{}", text());
        assert_eq!(lines[bottom][right], '╯', "{of:?}\n{}", text());
        for line in &lines[top + 1..bottom] {
            assert_eq!((line[left], line[right]), ('│', '│'), "{of:?}\n{}", text());
        }
        let below = &lines[bottom][left + 1..right];
        assert!(below.iter().all(|&c| c == '─'), "{of:?}\n{}", text());
    }
    if view != ViewId::Overview {
        let title: String = lines[panels[0][1]].iter().collect();
        assert!(
            title.contains(&format!(" {} ", view.title())),
            "{of:?}\n{}",
            text()
        );
    }
}

/// The captions of the panels, in parts.
fn captions(screen: &Screen) -> Vec<String> {
    let lines = lines(&screen.0.app().frame());
    let tops = panels(&lines).into_iter().map(|[left, top, right, _]| {
        let text: String = lines[top][left + 1..right].iter().collect();
        text.trim_matches(['─', ' ', '▸']).to_owned()
    });
    tops.collect()
}

/// Captions are complete, or lack whole parts, or end with an ellipsis.
fn check_captions(screen: &mut Screen, of: Of) {
    let short = captions(screen);
    screen.0.update(Input::Resize(250, 60));
    let long = captions(screen);
    let (.., (width, height)) = of;
    screen.0.update(Input::Resize(width, height));
    for caption in short {
        let title = caption.split("  ").next().unwrap_or("");
        let is_whole = |long: &String| {
            let rest = long.strip_prefix(&caption);
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(" · "))
        };
        let is_title = ViewId::all().any(|view| view.title() == title);
        let is_cut = caption.contains('…');
        assert!(
            long.iter().any(is_whole) || is_title || is_cut,
            "{of:?}: {caption:?} of {long:?}"
        );
    }
}

/// The actions in the hint bar; of two opposite ones, the one that leads away from the start.
fn named(frame: &Buffer, keys: &KeyMap) -> Vec<Action> {
    let last = lines(frame).pop().unwrap_or_default();
    let last = last.into_iter().collect::<String>() + "  ";
    let is_named = |action: &&Action| {
        if matches!(action, Action::Up | Action::Left) {
            return false;
        }
        let hint = keys.hint(**action, Signs::of(Unicode));
        hint.is_some_and(|(keys, word)| {
            let mut words = [word, "resume", "unfreeze", "stop playing"].into_iter();
            words.any(|word| (String::from("  ") + &last).contains(&format!("  {keys} {word}  ")))
        })
    };
    Action::ALL.iter().filter(is_named).copied().collect()
}

fn every_frame(run: &Recorded) {
    for state in State::ALL {
        let mut screen = state.screen(run);
        for size in SIZES.into_iter().chain(TINY) {
            screen.0.update(Input::Resize(size.0, size.1));
            for view in ViewId::all() {
                screen.0.open(view);
                let frame = screen.0.app().frame();
                assert_eq!((frame.area.width, frame.area.height), size);
                let lines = lines(&frame);
                check(&lines, (state, view, size));
                if size.0 >= 40 && size.1 >= 12 {
                    let first: String = lines[0].iter().collect();
                    assert!(first.contains(state.word()), "{state:?}: {first}");
                    check_captions(&mut screen, (state, view, size));
                }
            }
        }
    }
}

/// Returns to the view after any key, without a message, in the generation and frozen and
/// halted as the state requires.
fn back(screen: &mut Screen, state: State, view: ViewId) {
    screen.press("esc");
    screen.0.open(ViewId::Arena);
    if !screen.0.app().context().player.halted() {
        screen.press("space");
    }
    screen.0.update(Input::Tick(Duration::from_secs(6)));
    if screen.0.app().context().frozen() != (state == State::Frozen) {
        screen.press("f");
    }
    screen.press(">");
    if state == State::Past {
        screen.press("[");
    }
    if state != State::Halted {
        screen.press("space");
    }
    screen.0.open(view);
}

/// Presses every key in every view and state, or in every `stride`-th of these from `first` on.
fn every_key(run: &Recorded, first: usize, stride: usize) {
    let keys = KeyMap::default();
    // The most expensive size is rare. Nine sizes and eleven views have no common divisor, so
    // that every view meets every size.
    let [small, middle, large, smallest, odd] = SIZES;
    let order = [
        small, middle, smallest, odd, small, middle, odd, smallest, large,
    ];
    let mut sizes = order.into_iter().cycle();
    let states = State::ALL.into_iter();
    let places = states.flat_map(|state| ViewId::all().map(move |view| (state, view)));
    for (state, view) in places.skip(first).step_by(stride) {
        let size = sizes.next().unwrap();
        let mut screen = state.screen(run);
        screen.0.update(Input::Resize(size.0, size.1));
        screen.0.open(view);
        for &action in Action::ALL {
            press(&mut screen, &keys, action, (state, view, size));
            back(&mut screen, state, view);
        }
    }
}

fn press(screen: &mut Screen, keys: &KeyMap, action: Action, of: Of) {
    let (state, view, size) = of;
    let before = screen.0.app().frame();
    let is_named = named(&before, keys).contains(&action);
    let effects = screen.0.update(Input::Key(keys.keys(action)[0]));
    let after = screen.0.app().frame();
    let drawn = lines(&after);
    // An open window has the focus.
    let opens = panels(&drawn).iter().any(|&[left, top, ..]| {
        let title: String = drawn[top][left..].iter().take(12).collect();
        let mut titles = ["Help", "Export", "Question"].into_iter();
        titles.any(|known| title.starts_with(&format!("╭▸ {known} ")))
    });
    let does = before != after || !effects.is_empty();
    assert!(
        does || !is_named,
        "{of:?}: {action:?} does nothing\n{}",
        text(&lines(&before))
    );
    if !opens {
        return check(&drawn, (state, screen.0.app().view(), size));
    }
    screen.press("esc");
    assert_eq!(screen.0.app().view(), view, "{of:?}: {action:?}");
    let again = screen.0.app().frame();
    assert!(
        again == before,
        "{of:?}: {action:?}\n{}",
        text(&lines(&again))
    );
}

#[test]
fn every_frame_of_foraging() {
    every_frame(foraging());
}

#[test]
fn every_frame_with_memory_and_commands() {
    every_frame(remembering());
}

#[test]
fn every_frame_of_worlds_of_cells() {
    every_frame(&cells("taxi"));
    every_frame(&cells("cliff"));
    every_frame(&cells("four-rooms"));
}

#[test]
fn every_key_of_foraging() {
    every_key(foraging(), 0, 1);
}

/// The two worlds of cells have the same views in the same states, so each tests one half.
#[test]
fn every_key_of_the_taxi() {
    every_key(&cells("taxi"), 0, 2);
}

#[test]
fn every_key_of_the_cliff() {
    every_key(&cells("cliff"), 1, 2);
}

/// Every key of an action performs it, wherever the action is available.
#[test]
fn all_keys_of_an_action_do_it() {
    let keys = KeyMap::default();
    for &action in Action::ALL {
        for &key in keys.keys(action) {
            let done = match action.scope() {
                Scope::Everywhere => {
                    ViewId::all().all(|view| keys.in_view(key, view) == Some(action))
                }
                Scope::In(views) => {
                    let mut views = views.iter();
                    views.all(|&view| keys.in_view(key, view) == Some(action))
                }
                scope => keys.in_scope(key, scope) == Some(action),
            };
            assert!(done, "{action:?}: {key}");
        }
    }
}
