//! The views: one file each.
//!
//! A view fills the screen between header and hint bar; most are also a panel of the
//! overview, where they get a corner. They draw what fits.

mod arena;
mod compare;
mod fitness;
mod hierarchy;
mod inspector;
mod lines;
mod overview;
mod policy;
mod policy_map;
mod population;
mod status;
mod stepper;

use std::str::FromStr;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use thiserror::Error;

pub(super) use lines::mark_more;
pub(super) use overview::panels;

use super::desk::{Activity, Desk};
use super::input::Effect;
use super::keys::Action;
use super::look::{Chart, Curve, Paint, axis_end, fitted, put};
use super::mouse::Clicked;
use crate::evolution::Origin;
use crate::scenario::Selection;
use crate::worlds::Catalogue;
use crate::worlds::scene::Snapshot;

/// A view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ViewId {
    /// Everything at a glance.
    Overview,
    /// A rollout of the selected individual.
    Arena,
    /// The selected individual's task hierarchy.
    Hierarchy,
    /// Fitness and structural difference over generations.
    Fitness,
    /// Primitive-selection probabilities.
    Policy,
    /// All individuals of a generation.
    Population,
    /// What the run is doing.
    Status,
    /// An individual: its tree, what it has learned, where it comes from.
    Inspector,
    /// What an individual would do all over the arena.
    PolicyMap,
    /// One time step of the rollout.
    Stepper,
    /// Two individuals side by side.
    Compare,
}

/// A view's name for the command line, and its title.
const VIEWS: &[(ViewId, &str, &str)] = &[
    (ViewId::Overview, "overview", "Overview"),
    (ViewId::Arena, "arena", "Arena"),
    (ViewId::Hierarchy, "hierarchy", "Hierarchy"),
    (ViewId::Fitness, "fitness", "Fitness"),
    (ViewId::Policy, "policy", "Policy"),
    (ViewId::Population, "population", "Population"),
    (ViewId::Status, "status", "Status"),
    (ViewId::Inspector, "inspector", "Inspector"),
    (ViewId::PolicyMap, "policy-map", "Policy map"),
    (ViewId::Stepper, "stepper", "Trial stepper"),
    (ViewId::Compare, "compare", "Comparison"),
];

/// A name that no view has.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("found {found:?}; allowed: {}", names())]
pub struct UnknownView {
    /// The name.
    pub found: String,
}

fn names() -> String {
    let names: Vec<_> = VIEWS.iter().map(|(_, name, _)| *name).collect();
    names.join(", ")
}

impl ViewId {
    /// All views, in the order of the header.
    pub fn all() -> impl Iterator<Item = Self> {
        VIEWS.iter().map(|(id, ..)| *id)
    }

    fn entry(self) -> (&'static str, &'static str) {
        let entry = VIEWS.iter().find(|(id, ..)| *id == self);
        entry.map_or(("", ""), |(_, name, title)| (name, title))
    }

    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.entry().0
    }

    /// Whether it shows what the individual on the stage does or has learned.
    pub(super) fn needs_stage(self) -> bool {
        matches!(
            self,
            Self::Arena
                | Self::Hierarchy
                | Self::Inspector
                | Self::PolicyMap
                | Self::Stepper
                | Self::Compare
        )
    }

    /// The view that takes apart what is selected in it.
    pub(super) fn opens(self) -> Option<Self> {
        matches!(self, Self::Hierarchy | Self::Population | Self::Compare)
            .then_some(Self::Inspector)
    }

    /// Its title.
    #[must_use]
    pub fn title(self) -> &'static str {
        self.entry().1
    }
}

impl FromStr for ViewId {
    type Err = UnknownView;

    fn from_str(name: &str) -> Result<Self, UnknownView> {
        let entry = VIEWS.iter().find(|(_, known, _)| *known == name);
        entry.map(|(id, ..)| *id).ok_or_else(|| UnknownView {
            found: name.to_owned(),
        })
    }
}

/// What a view does. Everything that several views share is on the [`Desk`]; a view
/// keeps what is its own: a column to sort by, a cache of what is dear to compute.
pub(super) trait View: Send {
    /// What the panel is about, after its title: whose, when, in which unit.
    fn caption(&self, _desk: &Desk) -> String {
        String::new()
    }

    /// Draws into the area, which may be of any size.
    fn draw(&self, desk: &Desk, area: Rect, buffer: &mut Buffer);

    /// The actions that the hint bar names, most useful first.
    fn hints(&self) -> &'static [Action];

    /// Whether one of these actions can do something as things are; only asked for what the
    /// dashboard has nothing against.
    fn can(&self, _desk: &Desk, _action: Action) -> bool {
        true
    }

    /// Does what a key asks for; `None` where that is not this view's business.
    fn act(&mut self, _desk: &mut Desk, _action: Action) -> Option<Vec<Effect>> {
        None
    }

    /// Selects what is at a place of the area that it was drawn into.
    fn click(&mut self, _desk: &mut Desk, _area: Rect, _at: Position) -> Clicked {
        Clicked::Nothing
    }

    /// Computes what drawing needs, after every input while the view is on the screen.
    fn prepare(&mut self, _desk: &Desk) {}

    /// What is shown as a table, comma-separated values with a line of names.
    fn csv(&self, _desk: &Desk) -> Option<String> {
        None
    }

    /// The hierarchy that is shown, as a Graphviz graph.
    fn dot(&self, _desk: &Desk) -> Option<String> {
        None
    }

    /// What there is to see and how to read it, in the terms of the method: the head of
    /// the help overlay.
    fn lesson(&self) -> &'static str;
}

/// All views in the order of [`ViewId::all`].
pub(super) fn all() -> Vec<(ViewId, Box<dyn View>)> {
    ViewId::all().map(|id| (id, make(id))).collect()
}

fn make(id: ViewId) -> Box<dyn View> {
    match id {
        ViewId::Overview => Box::new(overview::Overview),
        ViewId::Arena => Box::new(arena::Arena),
        ViewId::Hierarchy => Box::new(hierarchy::Hierarchy),
        ViewId::Fitness => Box::new(fitness::Fitness),
        ViewId::Policy => Box::new(policy::Policy),
        ViewId::Population => Box::new(population::Population::default()),
        ViewId::Status => Box::new(status::Status),
        ViewId::Inspector => Box::new(inspector::Inspector::default()),
        ViewId::PolicyMap => Box::new(policy_map::Map::default()),
        ViewId::Stepper => Box::new(stepper::Stepper::default()),
        ViewId::Compare => Box::new(compare::Compare::default()),
    }
}

/// What leads through time, for the hint bars of views that show all generations.
const THROUGH_TIME: &[Action] = &[
    Action::Earlier,
    Action::Later,
    Action::First,
    Action::Follow,
    Action::Play,
];

/// Curves over the generations so far, the one shown marked. While there are more to come the
/// axis has room for them.
fn over_generations(desk: &Desk, curves: Vec<Curve>, least: [f64; 2]) -> Chart {
    let mut chart = Chart::of(curves, least);
    let shown = desk.shown().map(|record| record.generation);
    chart.cursor = shown.map(|number| number as f64);
    let is_over = matches!(desk.activity(), Activity::Finished | Activity::Stopped);
    let latest = desk.model().latest().map(|record| record.generation);
    if let (false, Some(latest)) = (is_over, latest) {
        let limit = desk.scenario().evolution.generation_limit;
        chart.across[1] = axis_end(latest, limit) as f64;
    }
    chart
}

/// That ranks do not tell who is better, where they do not.
fn by_chance(desk: &Desk) -> Option<&'static str> {
    let selection = desk.scenario().evolution.selection;
    (selection == Selection::Random).then_some("ranked by chance")
}

/// How fast the rollout goes, and whether it does.
fn pace(desk: &Desk) -> String {
    let speed = desk.stage.speed();
    match desk.stage.halted() {
        true => format!("halted, {speed}x"),
        false => format!("{speed}x"),
    }
}

/// Says why there is no individual to look at.
fn nobody(desk: &Desk, area: Rect, buffer: &mut Buffer) {
    let text = desk
        .stage
        .refused()
        .unwrap_or("no individual has lived yet");
    let room = usize::from(area.width.saturating_sub(1));
    let text = fitted(text, room, desk.look.signs);
    put(buffer, area, (1, 0), &text, desk.look.style(Paint::Dim));
}

/// Says that there is nothing to see yet.
fn nothing_yet(desk: &Desk, area: Rect, buffer: &mut Buffer) {
    let room = usize::from(area.width.saturating_sub(1));
    let text = fitted("no generation has lived yet", room, desk.look.signs);
    put(buffer, area, (1, 0), &text, desk.look.style(Paint::Dim));
}

/// What is the case besides the agent's place, where the state type does not tell: in worlds
/// of cells.
fn case<'d>(desk: &'d Desk, snapshot: &Snapshot) -> Option<&'d str> {
    desk.scenery().grid?;
    let is_done = snapshot.state_type == desk.catalogue().terminal();
    let variants = desk.bench.variants();
    let case = variants.get(snapshot.variant).filter(|_| !is_done);
    case.filter(|_| variants.len() > 1).map(String::as_str)
}

/// How an individual came to be, in a word or two.
fn origin(origin: &Origin) -> String {
    match origin {
        Origin::HandCoded => String::from("hand-coded"),
        Origin::Random => String::from("random"),
        Origin::Reproduced => String::from("reproduced"),
        Origin::Crossover {
            receiver, donor, ..
        } => format!("{} x {}", receiver.id, donor.id),
        Origin::Copied { from, .. } => format!("copy of {from}"),
    }
}

/// One capital letter for each primitive subtask: the first of its capitals, or else of
/// its letters, that no other has.
pub(super) fn letters(catalogue: &Catalogue) -> Vec<char> {
    let mut letters: Vec<char> = Vec::new();
    for primitive in catalogue.primitives() {
        let name = catalogue.subtask(primitive).name;
        let capitals = name.chars().filter(char::is_ascii_uppercase);
        let others = name.chars().map(|c| c.to_ascii_uppercase());
        let free = capitals
            .chain(others)
            .find(|letter| !letters.contains(letter));
        letters.push(free.unwrap_or('?'));
    }
    letters
}
