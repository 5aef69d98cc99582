//! Contract: in the textbook worlds the learned values are those of the textbook.
//!
//! The values of taxi and cliff walk are printed in the thesis, and dynamic programming computes
//! them. Learning never uses the MDP. If both agree in every state, then world, algorithm and table
//! are right, and foraging runs the same code.
//!
//! Learned values are single precision sums. In the deterministic worlds they converge to the
//! exact ones up to rounding.

#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "textbook/cliff.rs"]
mod cliff;
#[path = "textbook/fickle.rs"]
mod fickle;
#[path = "textbook/four_rooms.rs"]
mod four_rooms;
#[path = "textbook/taxi.rs"]
mod taxi;
#[path = "textbook/worlds.rs"]
mod worlds;

use maxq_lab::evolution::{Experiment, Workers, read_tree};
use maxq_lab::hierarchy::Tree;
use maxq_lab::lab::{Algorithm, LearnProtocol, Learned, learn};
use maxq_lab::learning::Gate;
use maxq_lab::scenario::Scenario;
use maxq_lab::worlds::World;
use maxq_lab::worlds::WorldSettings;
use maxq_lab::worlds::cliff::CliffWorld;
use maxq_lab::worlds::four_rooms::FourRoomsWorld;
use maxq_lab::worlds::taxi::TaxiWorld;

fn scenario(name: &str, settings: &[&str]) -> Scenario {
    let settings: Vec<_> = settings.iter().map(|&setting| setting.into()).collect();
    let scenario = Scenario::load(name).unwrap();
    scenario.with_settings(&settings).unwrap()
}

fn taxi(name: &str, settings: &[&str]) -> Experiment<TaxiWorld> {
    let scenario = scenario(name, settings);
    let WorldSettings::Taxi(model) = &scenario.world else {
        panic!("a taxi scenario")
    };
    let world = TaxiWorld::new(model).unwrap();
    Experiment::new(scenario, world).unwrap()
}

fn cliff(settings: &[&str]) -> Experiment<CliffWorld> {
    let scenario = scenario("cliff", settings);
    let WorldSettings::Cliff(model) = &scenario.world else {
        panic!("a cliff scenario")
    };
    let world = CliffWorld::new(model).unwrap();
    Experiment::new(scenario, world).unwrap()
}

fn four_rooms(settings: &[&str]) -> Experiment<FourRoomsWorld> {
    let scenario = scenario("four-rooms", settings);
    let WorldSettings::FourRooms(model) = &scenario.world else {
        panic!("a scenario of four rooms")
    };
    let world = FourRoomsWorld::new(model).unwrap();
    Experiment::new(scenario, world).unwrap()
}

fn hand_made<W: World>(experiment: &Experiment<W>) -> Tree {
    let text = experiment.world.hand_made().unwrap();
    let depth = experiment.scenario.evolution.maximum_depth;
    read_tree(text, experiment.catalogue(), depth).unwrap()
}

fn learned<W: World>(
    experiment: &Experiment<W>,
    algorithm: &Algorithm,
    steps: u64,
    repeats: usize,
) -> Learned {
    let protocol = LearnProtocol {
        steps,
        every: 5000,
        tolerance: 1e-6,
        repeats,
    };
    let workers = Workers::new(1).unwrap();
    let gate = Gate::default();
    learn(experiment, 1, algorithm, &protocol, &workers, &gate, |_| {}).unwrap()
}
