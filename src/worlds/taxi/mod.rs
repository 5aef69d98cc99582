//! The taxi problem (Dietterich 2000, section 3.1; Thesis 2.2.2, Figures 2.6 to 2.8). Its
//! specification is on the page of [the worlds](super).

mod catalogue;
mod city;
mod mdp;
mod scene;
mod settings;

use rand::RngExt;

use self::catalogue::{
    AT_DESTINATION, AT_PASSENGER, DELIVERED, INPUTS, MOVES, PICKUP, PUTDOWN, RIDING, WAITING,
};
use self::city::City;
pub use self::settings::TaxiSettings;
use super::grid::Direction;
use super::mdp::Mdp;
use super::{Catalogue, Settings, StateType, SubtaskId, World};
use crate::random::Stream;
use crate::rules::{Check, Problem};

/// Rejection-sampling attempts before a state type counts as unreachable.
const MAX_DRAWS: usize = 10_000;

/// The place of the passenger.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Passenger {
    /// At a stand, numbered in the order of the map.
    Waiting(u8),
    /// In the taxi, which is still in the cell of the pickup: he may yet change his mind.
    Boarded,
    /// In the taxi, with a final destination.
    Riding,
    /// At his destination.
    Delivered,
}

/// Taxi, passenger and destination. It is also the start of a trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TaxiState {
    /// Cell of the taxi, counted row by row from the north-west.
    pub taxi: u16,
    /// The passenger.
    pub passenger: Passenger,
    /// The stand that is his destination.
    pub destination: u8,
}

/// What the agent perceives: whole numbers, the inputs of the catalogue's tables.
pub type Percept = [f32; INPUTS];

/// The taxi world.
#[derive(Clone, Debug)]
pub struct TaxiWorld {
    catalogue: Catalogue,
    city: City,
    settings: TaxiSettings,
}

/// The random part of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Chance {
    slip: Slip,
    /// The new destination if the passenger changes his mind: its number among the other stands.
    whim: Option<u8>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Slip {
    Straight,
    Right,
    Left,
}

impl Chance {
    const NONE: Self = Self {
        slip: Slip::Straight,
        whim: None,
    };
}

impl TaxiWorld {
    /// Makes the world of settings that obey the rules.
    ///
    /// # Errors
    /// Fails if the map is not that of a city.
    pub fn new(settings: &TaxiSettings) -> Result<Self, Problem> {
        let city = City::read(&settings.map)?;
        Ok(Self {
            catalogue: catalogue::catalogue(&city, settings),
            city,
            settings: settings.clone(),
        })
    }

    /// Returns the cell of a stand.
    fn stand(&self, stand: u8) -> usize {
        self.city.stands[usize::from(stand)].1
    }

    /// Returns the stand to go to: first the passenger's, then the destination.
    fn target(&self, state: &TaxiState) -> u8 {
        match state.passenger {
            Passenger::Waiting(stand) => stand,
            _ => state.destination,
        }
    }

    fn is_at_target(&self, state: &TaxiState) -> bool {
        usize::from(state.taxi) == self.stand(self.target(state))
    }

    /// Executes an action and returns its reward.
    fn act(&self, state: &mut TaxiState, primitive: SubtaskId, chance: Chance) -> f64 {
        let legal = match (primitive, state.passenger) {
            (PICKUP, Passenger::Waiting(_)) => {
                let there = self.is_at_target(state);
                if there {
                    state.passenger = if self.settings.change_of_mind > 0.0 {
                        Passenger::Boarded
                    } else {
                        Passenger::Riding
                    };
                }
                there
            }
            (PUTDOWN, Passenger::Boarded | Passenger::Riding) if self.is_at_target(state) => {
                state.passenger = Passenger::Delivered;
                return self.settings.step_reward + self.settings.delivery_reward;
            }
            (PICKUP | PUTDOWN, _) => false,
            _ => {
                self.drive(state, Direction::of(primitive, MOVES), chance);
                true
            }
        };
        let penalty = if legal {
            0.0
        } else {
            self.settings.illegal_reward
        };
        self.settings.step_reward + penalty
    }

    fn drive(&self, state: &mut TaxiState, meant: Direction, chance: Chance) {
        let direction = match chance.slip {
            Slip::Straight => meant,
            Slip::Right => meant.clockwise(),
            Slip::Left => meant.clockwise().clockwise().clockwise(),
        };
        let to = self.city.to(usize::from(state.taxi), direction) as u16;
        let left = std::mem::replace(&mut state.taxi, to) != to;
        if left && state.passenger == Passenger::Boarded {
            state.passenger = Passenger::Riding;
            if let Some(whim) = chance.whim {
                state.destination = whim + u8::from(whim >= state.destination);
            }
        }
    }

    /// Draws the random part of a step. No number is drawn for a probability of 0.
    fn chance(&self, state: &TaxiState, primitive: SubtaskId, rng: &mut Stream) -> Chance {
        let mut chance = Chance::NONE;
        if matches!(primitive, PICKUP | PUTDOWN) {
            return chance;
        }
        if self.settings.slip > 0.0 {
            let draw: f64 = rng.random();
            if draw < self.settings.slip {
                let right = draw < self.settings.slip / 2.0;
                chance.slip = if right { Slip::Right } else { Slip::Left };
            }
        }
        if state.passenger == Passenger::Boarded && rng.random_bool(self.settings.change_of_mind) {
            let others = self.city.stands.len() as u8 - 1;
            chance.whim = Some(rng.random_range(0..others));
        }
        chance
    }
}

impl Settings for TaxiSettings {
    type World = TaxiWorld;

    fn check(&self, check: &mut Check) {
        if let Err(problem) = City::read(&self.map) {
            check.add(problem);
        }
        check.range("slip", self.slip, 0.0..=1.0);
        check.range("change_of_mind", self.change_of_mind, 0.0..=1.0);
        check.reward("step_reward", self.step_reward);
        check.reward("delivery_reward", self.delivery_reward);
        check.reward("illegal_reward", self.illegal_reward);
    }

    fn build(&self) -> Result<TaxiWorld, Problem> {
        TaxiWorld::new(self)
    }
}

impl World for TaxiWorld {
    type Start = TaxiState;
    type State = TaxiState;
    type Percept = Percept;

    fn catalogue(&self) -> &Catalogue {
        &self.catalogue
    }

    fn draw_start(&self, rng: &mut Stream) -> TaxiState {
        let stands = self.city.stands.len() as u8;
        TaxiState {
            taxi: rng.random_range(0..self.city.cells.count() as u16),
            passenger: Passenger::Waiting(rng.random_range(0..stands)),
            destination: rng.random_range(0..stands),
        }
    }

    fn begin(&self, start: &TaxiState, _: &mut Stream) -> TaxiState {
        *start
    }

    fn step(&self, state: &mut TaxiState, primitive: SubtaskId, _: usize, rng: &mut Stream) -> f32 {
        let chance = self.chance(state, primitive, rng);
        self.act(state, primitive, chance) as f32
    }

    fn state_type(&self, state: &TaxiState) -> StateType {
        let there = self.is_at_target(state);
        match state.passenger {
            Passenger::Waiting(_) if there => AT_PASSENGER,
            Passenger::Waiting(_) => WAITING,
            Passenger::Boarded | Passenger::Riding if there => AT_DESTINATION,
            Passenger::Boarded | Passenger::Riding => RIDING,
            Passenger::Delivered => DELIVERED,
        }
    }

    fn percept(&self, state: &TaxiState) -> Percept {
        let stands = self.city.stands.len() as u8;
        let passenger = match state.passenger {
            Passenger::Waiting(stand) => stand,
            Passenger::Riding | Passenger::Delivered => stands,
            Passenger::Boarded => stands + 1,
        };
        let state_type = self.state_type(state);
        [
            f32::from(state.taxi),
            f32::from(passenger),
            f32::from(state.destination),
            f32::from(self.target(state)),
            f32::from(u8::from(state_type == AT_PASSENGER)),
            f32::from(u8::from(state_type == AT_DESTINATION)),
        ]
    }

    fn sample(&self, state_type: StateType, rng: &mut Stream) -> Option<Percept> {
        (0..MAX_DRAWS).find_map(|_| {
            let mut state = self.draw_start(rng);
            if rng.random() {
                state.passenger = Passenger::Riding;
            }
            (self.state_type(&state) == state_type).then(|| self.percept(&state))
        })
    }

    /// Thesis Figures 2.7 and 3.1.
    fn hand_made(&self) -> Option<&str> {
        Some(
            "(Root (Get (NavigateToPassenger North South East West) Pickup) \
             (Put (NavigateToDestination North South East West) Putdown))",
        )
    }

    fn mdp(&self) -> Option<Mdp<Percept>> {
        Some(self.as_mdp())
    }
}
