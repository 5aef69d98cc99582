//! The cliff walk (Thesis 2.1.3, Figures 2.2 and 2.3). Its specification is on the page of
//! [the worlds](super).

mod catalogue;
mod scene;
mod settings;

use rand::RngExt;

use self::catalogue::{ABOVE, ACTIONS, AT_GOAL, AT_START, CELL, INPUTS, LAST, POSITION};
pub use self::settings::{CliffBegin, CliffSettings};
use super::grid::{Cells, Direction, any_of};
use super::mdp::{Mdp, MdpState, Outcome};
use super::{Catalogue, Settings, StateType, SubtaskId, World};
use crate::random::Stream;
use crate::rules::{Check, Problem};

/// What the agent perceives: the number of its cell, and the cell's position along x and y in
/// [0, 1], from the lower left.
pub type Percept = [f32; INPUTS];

/// The cliff world. Its state is the number of the agent's cell, counted row by row from the
/// upper left.
#[derive(Clone, Debug)]
pub struct CliffWorld {
    catalogue: Catalogue,
    cells: Cells,
    settings: CliffSettings,
}

impl CliffWorld {
    /// Makes the world of settings that obey the rules.
    ///
    /// # Errors
    /// Fails if the grid is too small to have a cliff.
    pub fn new(settings: &CliffSettings) -> Result<Self, Problem> {
        let cells = Cells {
            columns: settings.width,
            rows: settings.height,
        };
        if cells.columns < 3 || cells.rows < 2 {
            let found = format!("{} by {} cells", cells.columns, cells.rows);
            return Err(Problem::new("", found, "at least 3 by 2"));
        }
        Ok(Self {
            catalogue: catalogue::catalogue(cells, settings),
            cells,
            settings: settings.clone(),
        })
    }

    fn goal(&self) -> usize {
        self.cells.count() - 1
    }

    fn start(&self) -> usize {
        self.cells.count() - self.cells.columns
    }

    fn is_cliff(&self, cell: usize) -> bool {
        cell > self.start() && cell < self.goal()
    }

    /// Cells in which trials start.
    fn starts(&self) -> std::ops::RangeInclusive<usize> {
        match self.settings.begin {
            CliffBegin::Start => self.start()..=self.start(),
            CliffBegin::Anywhere => 0..=self.start(),
        }
    }

    /// Returns the cell that a move leads to, and its reward.
    fn act(&self, cell: usize, primitive: SubtaskId) -> (usize, f64) {
        let direction = Direction::of(primitive, ACTIONS);
        let to = self.cells.neighbour(cell, direction).unwrap_or(cell);
        if self.is_cliff(to) {
            (self.start(), self.settings.fall_reward)
        } else {
            (to, self.settings.step_reward)
        }
    }

    fn mdp_state(&self, cell: usize) -> MdpState<Percept> {
        let state_type = self.state_type(&cell);
        let outcome = |primitive| {
            let (next, reward) = self.act(cell, primitive);
            let probability = 1.0;
            vec![Outcome {
                probability,
                reward,
                next,
            }]
        };
        let starts = self.starts();
        let share = 1.0 / (starts.end() - starts.start() + 1) as f64;
        MdpState {
            state_type,
            percept: self.percept(&cell),
            start: if starts.contains(&cell) { share } else { 0.0 },
            outcomes: match state_type {
                AT_GOAL => Vec::new(),
                _ => ACTIONS.map(outcome).into(),
            },
        }
    }
}

impl Settings for CliffSettings {
    type World = CliffWorld;

    fn check(&self, check: &mut Check) {
        check.range("width", self.width, 3..=64);
        check.range("height", self.height, 2..=64);
        check.reward("step_reward", self.step_reward);
        check.reward("fall_reward", self.fall_reward);
        check.range("rbf_width_cells", self.rbf_width_cells, 0.1..=10.0);
    }

    fn build(&self) -> Result<CliffWorld, Problem> {
        CliffWorld::new(self)
    }
}

impl World for CliffWorld {
    type Start = usize;
    type State = usize;
    type Percept = Percept;

    fn catalogue(&self) -> &Catalogue {
        &self.catalogue
    }

    fn draw_start(&self, rng: &mut Stream) -> usize {
        rng.random_range(self.starts())
    }

    fn begin(&self, start: &usize, _: &mut Stream) -> usize {
        *start
    }

    fn step(&self, state: &mut usize, primitive: SubtaskId, _: usize, _: &mut Stream) -> f32 {
        let (to, reward) = self.act(*state, primitive);
        *state = to;
        reward as f32
    }

    fn state_type(&self, state: &usize) -> StateType {
        match *state {
            cell if cell == self.goal() => AT_GOAL,
            cell if cell >= self.start() => AT_START,
            cell if (cell + 1).is_multiple_of(self.cells.columns) => LAST,
            _ => ABOVE,
        }
    }

    fn percept(&self, state: &usize) -> Percept {
        let [x, y] = self.cells.centre(*state);
        let [width, height] = self.cells.extent();
        let share = |at: f64, extent: f64| ((at - 0.5) / (extent - 1.0)) as f32;
        [*state as f32, share(x, width), share(y, height)]
    }

    fn sample(&self, state_type: StateType, rng: &mut Stream) -> Option<Percept> {
        let cells = (0..self.cells.count())
            .filter(|cell| !self.is_cliff(*cell) && self.state_type(cell) == state_type);
        any_of(cells, rng).map(|cell| self.percept(&cell))
    }

    fn hand_made(&self) -> Option<&str> {
        Some(
            "(Root (Leave Up Down Right Left) (Cross Up Down Right Left) \
             (Descend Up Down Right Left))",
        )
    }

    fn mdp(&self) -> Option<Mdp<Percept>> {
        let states = (0..self.cells.count())
            .map(|cell| (!self.is_cliff(cell)).then(|| self.mdp_state(cell)));
        Some(Mdp {
            table: CELL,
            gaussian: Some(POSITION),
            actions: ACTIONS.map(|primitive| (primitive, 0)).into(),
            states: states.collect(),
        })
    }
}
