//! Four rooms (Sutton, Precup and Singh 1999, *Between MDPs and semi-MDPs*, section 3). Its
//! specification is on the page of [the worlds](super).

mod catalogue;
mod house;
mod scene;

use rand::RngExt;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use self::catalogue::{ACTIONS, AT_GOAL, CELL, INPUTS};
use self::house::{CELLS, House};
use super::grid::{Direction, any_of};
use super::mdp::{Mdp, MdpState, Outcome};
use super::{Catalogue, Settings, StateType, SubtaskId, World};
use crate::random::Stream;
use crate::rules::{Check, Problem};

/// Probability of a slip, Sutton, Precup and Singh 1999, section 3.
const SLIP: f64 = 1.0 / 3.0;
/// A cell of the south-eastern room, which no subtask but `ToGoal` has as its goal.
const GOAL_CELL: [usize; 2] = [8, 8];
/// Reward of every step: see the page of the worlds.
const STEP_REWARD: f64 = -1.0;

/// A house of four rooms with hallways between them, and a goal in one cell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FourRoomsSettings {
    /// Column and row of the goal, from 0 at the upper left, within the outer walls.
    pub goal_cell: [usize; 2],
    /// Probability that a move goes into one of the three other directions, each equally likely.
    pub slip: f64,
    /// Reward of every step that does not reach the goal.
    pub step_reward: f64,
    /// Reward of the step that reaches it.
    pub goal_reward: f64,
}

impl Default for FourRoomsSettings {
    fn default() -> Self {
        Self {
            goal_cell: GOAL_CELL,
            slip: SLIP,
            step_reward: STEP_REWARD,
            goal_reward: STEP_REWARD,
        }
    }
}

/// What the agent perceives: the number of its cell, and nothing else.
pub type Percept = [f32; INPUTS];

/// The world of four rooms. Its state is the number of the agent's cell, counted row by row
/// from the upper left, walls included.
#[derive(Clone, Debug)]
pub struct FourRoomsWorld {
    catalogue: Catalogue,
    house: House,
    settings: FourRoomsSettings,
    goal: usize,
}

impl FourRoomsWorld {
    /// Makes the world of settings that obey the rules.
    ///
    /// # Errors
    /// Fails if the goal lies in a wall or outside the house.
    pub fn new(settings: &FourRoomsSettings) -> Result<Self, Problem> {
        let house = House::new();
        let goal = house.goal(settings.goal_cell)?;
        Ok(Self {
            catalogue: catalogue::catalogue(house.place(goal)),
            house,
            settings: settings.clone(),
            goal,
        })
    }

    /// Cells in which trials start.
    fn starts(&self) -> impl Iterator<Item = usize> {
        self.house.cells().filter(|&cell| cell != self.goal)
    }

    /// Returns the cell that a move leads to, and its reward.
    fn walk(&self, cell: usize, direction: Direction) -> (usize, f64) {
        let to = self.house.to(cell, direction);
        let settings = &self.settings;
        let at_goal = to == self.goal;
        let reward = if at_goal {
            settings.goal_reward
        } else {
            settings.step_reward
        };
        (to, reward)
    }

    fn mdp_state(&self, cell: usize) -> MdpState<Percept> {
        let mut state = MdpState {
            state_type: self.state_type(&cell),
            percept: self.percept(&cell),
            start: 0.0,
            outcomes: Vec::new(),
        };
        if cell != self.goal {
            state.start = 1.0 / self.starts().count() as f64;
            state.outcomes = ACTIONS
                .map(|primitive| self.outcomes(cell, primitive))
                .into();
        }
        state
    }

    fn outcomes(&self, cell: usize, primitive: SubtaskId) -> Vec<Outcome> {
        let meant = Direction::of(primitive, ACTIONS);
        let slips = meant
            .others()
            .map(|other| (self.settings.slip / 3.0, other));
        let straight = std::iter::once((1.0 - self.settings.slip, meant));
        let all = straight.chain(slips).filter(|&(chance, _)| chance > 0.0);
        all.map(|(probability, direction)| {
            let (next, reward) = self.walk(cell, direction);
            Outcome {
                probability,
                reward,
                next,
            }
        })
        .collect()
    }
}

impl Settings for FourRoomsSettings {
    type World = FourRoomsWorld;

    fn check(&self, check: &mut Check) {
        if let Err(problem) = House::new().goal(self.goal_cell) {
            check.add(problem);
        }
        check.range("slip", self.slip, 0.0..=1.0);
        check.reward("step_reward", self.step_reward);
        check.reward("goal_reward", self.goal_reward);
    }

    fn build(&self) -> Result<FourRoomsWorld, Problem> {
        FourRoomsWorld::new(self)
    }
}

impl World for FourRoomsWorld {
    type Start = usize;
    type State = usize;
    type Percept = Percept;

    fn catalogue(&self) -> &Catalogue {
        &self.catalogue
    }

    fn draw_start(&self, rng: &mut Stream) -> usize {
        loop {
            let cell = rng.random_range(0..CELLS);
            if cell != self.goal && self.house.is_free(cell) {
                return cell;
            }
        }
    }

    fn begin(&self, start: &usize, _: &mut Stream) -> usize {
        *start
    }

    fn step(&self, state: &mut usize, primitive: SubtaskId, _: usize, rng: &mut Stream) -> f32 {
        let mut towards = Direction::of(primitive, ACTIONS);
        if rng.random_bool(self.settings.slip) {
            towards = towards.others()[rng.random_range(0..3_usize)];
        }
        let (to, reward) = self.walk(*state, towards);
        *state = to;
        reward as f32
    }

    fn state_type(&self, state: &usize) -> StateType {
        if *state == self.goal {
            AT_GOAL
        } else {
            self.house.place(*state).state_type()
        }
    }

    fn percept(&self, state: &usize) -> Percept {
        [*state as f32]
    }

    fn sample(&self, state_type: StateType, rng: &mut Stream) -> Option<Percept> {
        let cells = self.house.cells();
        let cells = cells.filter(|cell| self.state_type(cell) == state_type);
        any_of(cells, rng).map(|cell| self.percept(&cell))
    }

    fn hand_made(&self) -> Option<&str> {
        Some(catalogue::HAND_MADE)
    }

    fn mdp(&self) -> Option<Mdp<Percept>> {
        let states = (0..CELLS).map(|cell| self.house.is_free(cell).then(|| self.mdp_state(cell)));
        Some(Mdp {
            table: CELL,
            gaussian: None,
            actions: ACTIONS.map(|primitive| (primitive, 0)).into(),
            states: states.collect(),
        })
    }
}
