//! Four rooms (Sutton, Precup and Singh 1999, *Between MDPs and semi-MDPs*, section 3).
//!
//! A house of four rooms with a hallway between each two neighbouring ones: 104 cells.
//!
//! - **Actions.** Up, Down, Right, Left move by one cell, with probability 1/3 into one of
//!   the three other directions, all alike. Where a wall is the agent stays.
//! - **Start.** Any cell but the goal, all alike.
//! - **Rewards.** -1 for every step. The paper has 1 for reaching the goal, 0 for the
//!   others, and makes the agent hurry by discounting; but a subtask of MAXQ, whose
//!   pseudo-reward is 0 in its goal, would then have no reason to.
//! - **End.** The goal is reached: a hallway, or any other cell.
//!
//! The eight ways from a room to one of its hallways, which the paper has as options, are
//! composite subtasks here: `NorthWestToNorth` is active in the room in the north-west and
//! in its other hallway, and its goal is the hallway in the north. `ToGoal` is active in
//! what lies around the goal.

mod catalogue;
mod house;
mod mdp;
mod scene;
mod settings;

use rand::RngExt;

use self::catalogue::{AT_GOAL, DOWN, INPUTS, LEFT, RIGHT};
use self::house::{CELLS, House};
pub use self::settings::FourRoomsSettings;
use super::grid::{Direction, any_of};
use super::mdp::Mdp;
use super::{Catalogue, Settings, StateType, SubtaskId, World};
use crate::random::Stream;
use crate::rules::{Check, Problem};

/// What the agent perceives: the number of its cell, and nothing else.
pub type Percept = [f32; INPUTS];

/// The world of four rooms. Its state is the cell that the agent is in, counted row by row
/// from the upper left, walls included.
#[derive(Clone, Debug)]
pub struct FourRoomsWorld {
    catalogue: Catalogue,
    house: House,
    settings: FourRoomsSettings,
    goal: usize,
}

impl FourRoomsWorld {
    /// The world of settings that obey the rules.
    ///
    /// # Errors
    /// When the goal lies in a wall or outside.
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

    /// The cells in which trials begin.
    fn starts(&self) -> impl Iterator<Item = usize> {
        self.house.cells().filter(|&cell| cell != self.goal)
    }

    /// Where a move leads, and its reward.
    fn walk(&self, cell: usize, direction: Direction) -> (usize, f64) {
        let to = self.house.to(cell, direction);
        match to == self.goal {
            true => (to, self.settings.goal_reward),
            false => (to, self.settings.step_reward),
        }
    }
}

fn direction(primitive: SubtaskId) -> Direction {
    match primitive {
        DOWN => Direction::Down,
        RIGHT => Direction::Right,
        LEFT => Direction::Left,
        _ => Direction::Up,
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
        let mut towards = direction(primitive);
        if rng.random_bool(self.settings.slip) {
            towards = towards.others()[rng.random_range(0..3_usize)];
        }
        let (to, reward) = self.walk(*state, towards);
        *state = to;
        reward as f32
    }

    fn state_type(&self, state: &usize) -> StateType {
        match *state == self.goal {
            true => AT_GOAL,
            false => self.house.place(*state).state_type(),
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
        Some(self.as_mdp())
    }
}
