//! Maps of what an individual would do at each place of the arena.

use crate::learning::Policy;
use crate::random::{Purpose, Stream, stream};
use crate::worlds::scene::{Mark, Scenic};
use crate::worlds::{StateType, SubtaskId};

/// Noisy readings over which a cell is averaged.
const SAMPLES: usize = 4;

/// The states that a map shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapView {
    /// Heading of the agent in radians.
    pub heading: f64,
    /// Index into [`AnyExperiment::variants`](crate::lab::AnyExperiment::variants).
    pub variant: usize,
    /// Number of cells along x.
    pub columns: usize,
    /// Number of cells along y.
    pub rows: usize,
}

/// What an individual would do at a place.
#[derive(Clone, Debug, PartialEq)]
pub struct PolicyCell {
    /// Type of the state there.
    pub state_type: StateType,
    /// The primitive subtask that it most probably selects.
    pub primitive: SubtaskId,
    /// The probability of selecting it.
    pub probability: f64,
    /// V of the root.
    pub value: f32,
    /// The primitive subtask and its action that it would choose without exploration.
    pub greedy: Option<(SubtaskId, usize)>,
}

/// What an individual would do at the centres of a grid of cells.
#[derive(Clone, Debug, PartialEq)]
pub struct PolicyMap {
    /// The states that it shows.
    pub view: MapView,
    /// The cells row by row, with the largest y first; `None` where the agent cannot be or its
    /// task is done.
    pub cells: Vec<Option<PolicyCell>>,
    /// The movable objects, where they are in this variant.
    pub marks: Vec<Mark>,
}

impl PolicyMap {
    /// Returns the cell in a column and a row, counted from the top left.
    #[must_use]
    pub fn cell(&self, column: usize, row: usize) -> Option<&PolicyCell> {
        if column >= self.view.columns {
            return None;
        }
        self.cells.get(row * self.view.columns + column)?.as_ref()
    }

    /// Returns the smallest and the largest value of its cells.
    #[must_use]
    pub fn values(&self) -> Option<[f32; 2]> {
        let values = self.cells.iter().flatten().map(|cell| cell.value);
        values.fold(None, |range, value| {
            let [low, high] = range.unwrap_or([value; 2]);
            Some([low.min(value), high.max(value)])
        })
    }
}

pub(in crate::lab) fn policy_map<W: Scenic>(
    world: &W,
    policy: &mut Policy<'_>,
    view: MapView,
    seed: u64,
) -> PolicyMap {
    let extent = world.scenery().extent;
    let MapView { columns, rows, .. } = view;
    // All cells get the same noise, so that they differ by their places alone.
    let rng = stream(seed, 0, 0, Purpose::PolicyMap);
    let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| [column, row]));
    let cells = cells.map(|[column, row]| {
        let share = |index: usize, count: usize| (index as f64 + 0.5) / count as f64;
        let at = [
            extent[0] * share(column, columns),
            extent[1] * (1.0 - share(row, rows)),
        ];
        policy_cell(world, policy, view, at, rng.clone())
    });
    let (cells, states): (Vec<_>, Vec<_>) = cells.map(Option::unzip).unzip();
    let somewhere = states.into_iter().flatten().next();
    PolicyMap {
        view,
        cells,
        marks: somewhere.map_or(Vec::new(), |state| world.snapshot(&state).marks),
    }
}

fn policy_cell<W: Scenic>(
    world: &W,
    policy: &mut Policy<'_>,
    view: MapView,
    at: [f64; 2],
    mut rng: Stream,
) -> Option<(PolicyCell, W::State)> {
    let catalogue = world.catalogue();
    let mut totals = vec![0.0; catalogue.primitives().count()];
    let first = world.state_at(at, view.heading, view.variant, &mut rng.clone())?;
    let state_type = world.state_type(&first);
    if state_type == catalogue.terminal() {
        return None;
    }
    let mut value = 0.0;
    for _ in 0..SAMPLES {
        let state = world.state_at(at, view.heading, view.variant, &mut rng)?;
        policy.look(state_type, world.percept(&state).as_ref());
        policy.add_probabilities(&mut totals);
        value += policy.value() / SAMPLES as f32;
    }
    let likeliest = catalogue.primitives().zip(&totals);
    let (primitive, total) = likeliest.reduce(|a, b| if b.1 > a.1 { b } else { a })?;
    let cell = PolicyCell {
        state_type,
        primitive,
        probability: total / SAMPLES as f64,
        value,
        greedy: policy.greedy(),
    };
    Some((cell, first))
}
