//! What the taxi problem looks like.

use super::catalogue::{AT_DESTINATION, AT_PASSENGER, EAST, NORTH, RIDING, SOUTH, WAITING, WEST};
use super::{Passenger, Percept, TaxiState, TaxiWorld};
use crate::random::Stream;
use crate::worlds::grid::{RADIUS, moves, outer_walls};
use crate::worlds::scene::{Mark, Role, Scale, Scenery, Scenic, Snapshot, Sweep};
use crate::worlds::{Probe, StateType, SubtaskId, World};

impl Scenic for TaxiWorld {
    fn scenery(&self) -> Scenery {
        let cells = self.city.cells;
        let walls = (0..cells.count()).filter(|&cell| {
            let last = (cell + 1).is_multiple_of(cells.columns);
            self.city.walled[cell] && !last
        });
        let east_of = |cell| {
            let [x, y] = cells.centre(cell);
            [[x + 0.5, y - 0.5], [x + 0.5, y + 0.5]]
        };
        let stands = self.city.stands.iter();
        Scenery {
            extent: cells.extent(),
            unit: String::from("cells"),
            grid: Some([cells.columns, cells.rows]),
            walls: outer_walls(cells)
                .into_iter()
                .chain(walls.map(east_of))
                .collect(),
            places: stands
                .map(|&(letter, cell)| Mark {
                    role: Role::Landmark,
                    label: letter.to_string(),
                    at: cells.centre(cell),
                })
                .collect(),
            transparent_walls: Vec::new(),
            moves: moves([EAST, NORTH, WEST, SOUTH]),
            time_step_s: None,
        }
    }

    fn snapshot(&self, state: &TaxiState) -> Snapshot {
        let cells = self.city.cells;
        let at = cells.centre(usize::from(state.taxi));
        let passenger = String::from("passenger");
        let waits = match state.passenger {
            Passenger::Waiting(stand) => Some(self.stand(stand)),
            Passenger::Delivered => Some(self.stand(state.destination)),
            Passenger::Boarded | Passenger::Riding => None,
        };
        let mut marks = vec![Mark {
            role: Role::Goal,
            label: String::from("destination"),
            at: cells.centre(self.stand(state.destination)),
        }];
        marks.extend(waits.map(|cell| Mark {
            role: Role::Object,
            label: passenger.clone(),
            at: cells.centre(cell),
        }));
        Snapshot {
            at,
            radius: RADIUS,
            heading: None,
            carries: waits.is_none().then_some(passenger),
            marks,
            view: None,
            sees: None,
            remembers: None,
            rays: Vec::new(),
            readings: cells.readings(usize::from(state.taxi)),
            state_type: self.state_type(state),
            variant: self.variant(state),
        }
    }

    fn position(&self, state: &TaxiState) -> [f64; 2] {
        self.city.cells.centre(usize::from(state.taxi))
    }

    fn variants(&self) -> Vec<String> {
        self.tasks()
            .map(|(passenger, destination)| self.words(passenger, destination))
            .collect()
    }

    fn state_at(&self, at: [f64; 2], _: f64, variant: usize, _: &mut Stream) -> Option<TaxiState> {
        let (passenger, destination) = self.tasks().nth(variant)?;
        Some(TaxiState {
            taxi: self.city.cells.cell_at(at)? as u16,
            passenger,
            destination,
        })
    }

    fn sweeps(&self, _: SubtaskId, state_type: StateType) -> Vec<Sweep<Percept>> {
        let tasks = self.tasks().filter(|(passenger, _)| {
            let waits = matches!(passenger, Passenger::Waiting(_));
            waits == matches!(state_type, WAITING | AT_PASSENGER)
        });
        let state = |taxi: usize, (passenger, destination)| TaxiState {
            taxi: taxi as u16,
            passenger,
            destination,
        };
        match state_type {
            // The taxi is at its target: one case for each task.
            AT_PASSENGER | AT_DESTINATION => {
                let probes = tasks.map(|task| {
                    let taxi = self.stand(self.target(&state(0, task)));
                    self.probe(&state(taxi, task))
                });
                let probes: Vec<_> = probes.collect();
                vec![Sweep {
                    across: Scale::Cases {
                        name: String::from("passenger and destination"),
                        labels: probes.iter().map(|probe| probe.label.clone()).collect(),
                    },
                    down: None,
                    probes,
                }]
            }
            WAITING | RIDING => {
                let cells = self.city.cells;
                let sweep = |task| Sweep {
                    across: cells.across(),
                    down: Some(cells.down()),
                    probes: cells
                        .upwards()
                        .map(|cell| self.probe(&state(cell, task)))
                        .collect(),
                };
                tasks.map(sweep).collect()
            }
            _ => Vec::new(),
        }
    }
}

impl TaxiWorld {
    /// Returns all pairs of passenger and destination, those of a waiting passenger first.
    fn tasks(&self) -> impl Iterator<Item = (Passenger, u8)> {
        let stands = 0..self.city.stands.len() as u8;
        let waiting = stands.clone().map(Passenger::Waiting);
        let places = waiting.chain(std::iter::once(Passenger::Riding));
        places.flat_map(move |place| stands.clone().map(move |destination| (place, destination)))
    }

    fn variant(&self, state: &TaxiState) -> usize {
        let passenger = match state.passenger {
            Passenger::Waiting(stand) => Passenger::Waiting(stand),
            Passenger::Boarded | Passenger::Riding | Passenger::Delivered => Passenger::Riding,
        };
        let task = (passenger, state.destination);
        self.tasks().position(|known| known == task).unwrap_or(0)
    }

    fn words(&self, passenger: Passenger, destination: u8) -> String {
        let letter = |stand: u8| self.city.stands[usize::from(stand)].0;
        let to = letter(destination);
        match passenger {
            Passenger::Waiting(stand) => format!("from {} to {to}", letter(stand)),
            Passenger::Boarded | Passenger::Riding => format!("in taxi to {to}"),
            Passenger::Delivered => format!("at {to}"),
        }
    }

    fn probe(&self, state: &TaxiState) -> Probe<Percept> {
        let readings = self
            .city
            .cells
            .readings(usize::from(state.taxi))
            .into_iter();
        Probe {
            label: self.words(state.passenger, state.destination),
            readings: readings
                .filter_map(|reading| Some((reading.name, reading.value?)))
                .collect(),
            percept: self.percept(state),
        }
    }
}
