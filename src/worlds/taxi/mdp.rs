//! The taxi world as an MDP.

use super::catalogue::{ACTIONS, PICKUP, PUTDOWN, STATE, passenger_places};
use super::{Chance, Passenger, Percept, Slip, TaxiState, TaxiWorld};
use crate::worlds::mdp::{Mdp, MdpState, Outcome};
use crate::worlds::{SubtaskId, World};

impl TaxiWorld {
    /// Returns all states with the outcomes of every action.
    ///
    /// The end of a trial has no feature of its own in the table. It is the last state.
    pub(super) fn as_mdp(&self) -> Mdp<Percept> {
        let stands = self.city.stands.len();
        let places = passenger_places(&self.city, &self.settings);
        let starts = (self.city.cells.count() * stands * stands) as f64;
        let mut states = Vec::with_capacity(self.city.cells.count() * places * stands + 1);
        for taxi in 0..self.city.cells.count() {
            for place in 0..places {
                for destination in 0..stands {
                    let passenger = match place {
                        _ if place < stands => Passenger::Waiting(place as u8),
                        _ if place == stands => Passenger::Riding,
                        _ => Passenger::Boarded,
                    };
                    let state = TaxiState {
                        taxi: taxi as u16,
                        passenger,
                        destination: destination as u8,
                    };
                    let starts_here = place < stands;
                    let start = if starts_here { 1.0 / starts } else { 0.0 };
                    states.push(Some(self.finite_state(&state, start)));
                }
            }
        }
        let end = TaxiState {
            taxi: 0,
            passenger: Passenger::Delivered,
            destination: 0,
        };
        states.push(Some(MdpState {
            outcomes: Vec::new(),
            ..self.finite_state(&end, 0.0)
        }));
        Mdp {
            table: STATE,
            gaussian: None,
            actions: ACTIONS.map(|primitive| (primitive, 0)).into(),
            states,
        }
    }

    fn finite_state(&self, state: &TaxiState, start: f64) -> MdpState<Percept> {
        let outcomes = ACTIONS.map(|primitive| {
            let chances = self.chances(state, primitive).into_iter();
            let outcome = |(probability, chance)| {
                let mut next = *state;
                let reward = self.act(&mut next, primitive, chance);
                Outcome {
                    probability,
                    reward,
                    next: self.number(&next),
                }
            };
            chances.map(outcome).collect()
        });
        MdpState {
            state_type: self.state_type(state),
            percept: self.percept(state),
            start,
            outcomes: outcomes.into(),
        }
    }

    /// Returns the number of a state: its feature in the table.
    fn number(&self, state: &TaxiState) -> usize {
        let stands = self.city.stands.len();
        let places = passenger_places(&self.city, &self.settings);
        let place = match state.passenger {
            Passenger::Waiting(stand) => usize::from(stand),
            Passenger::Riding => stands,
            Passenger::Boarded => stands + 1,
            Passenger::Delivered => return self.city.cells.count() * places * stands,
        };
        (usize::from(state.taxi) * places + place) * stands + usize::from(state.destination)
    }

    /// Returns all random parts of a step with their probabilities.
    fn chances(&self, state: &TaxiState, primitive: SubtaskId) -> Vec<(f64, Chance)> {
        if matches!(primitive, PICKUP | PUTDOWN) {
            return vec![(1.0, Chance::NONE)];
        }
        let half = self.settings.slip / 2.0;
        let mut whims = vec![(1.0, None)];
        if state.passenger == Passenger::Boarded {
            let others = self.city.stands.len() as u8 - 1;
            let share = self.settings.change_of_mind / f64::from(others);
            whims = vec![(1.0 - self.settings.change_of_mind, None)];
            whims.extend((0..others).map(|whim| (share, Some(whim))));
        }
        let slips = [
            (1.0 - self.settings.slip, Slip::Straight),
            (half, Slip::Right),
            (half, Slip::Left),
        ];
        let all = slips.into_iter().flat_map(|(p, slip)| {
            let whims = whims.iter();
            whims.map(move |&(q, whim)| (p * q, Chance { slip, whim }))
        });
        all.filter(|&(probability, _)| probability > 0.0).collect()
    }
}
