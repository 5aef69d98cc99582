//! Contract: the foraging world is the one that the method describes.
//!
//! Every result depends on the world, and no learning test shows an error in it: agents adapt to
//! any world. So every rule is checked against its definition on thousands of states, by brute
//! force over all walls, in every shipped arena. The lists of walls, the sliding, the noise and
//! the state types must agree with that. The tests count how often sight through slits, choices
//! between batteries, captures and deliveries occur.

#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "foraging/geometry.rs"]
mod geometry;
#[path = "foraging/memory.rs"]
mod memory;
#[path = "foraging/primitives.rs"]
mod primitives;
#[path = "foraging/readings.rs"]
mod readings;
#[path = "foraging/transparent_walls.rs"]
mod transparent_walls;
#[path = "foraging/walks.rs"]
mod walks;

use maxq_lab::random::Stream;
use maxq_lab::scenario::Scenario;
use maxq_lab::worlds::WorldSettings;
use maxq_lab::worlds::foraging::ForagingSettings;
use maxq_lab::worlds::foraging::{ForagingState, ForagingWorld};
use maxq_lab::worlds::{SubtaskId, World};
use rand::RngExt;

const SCENARIOS: [&str; 5] = [
    "environment-1",
    "environment-2",
    "environment-3",
    "environment-6",
    "smoke",
];

fn model(scenario: &str) -> ForagingSettings {
    let WorldSettings::Foraging(model) = Scenario::load(scenario).unwrap().world else {
        panic!("a foraging scenario")
    };
    *model
}

fn world(scenario: &str) -> ForagingWorld {
    ForagingWorld::new(&model(scenario)).unwrap()
}

/// Draws an action of a primitive subtask that is active in a state.
fn some_action(
    world: &ForagingWorld,
    state: &ForagingState,
    rng: &mut Stream,
) -> (SubtaskId, usize) {
    let catalogue = world.catalogue();
    let state_type = world.state_type(state);
    let active = catalogue.primitives();
    let active: Vec<_> = active
        .filter(|&primitive| catalogue.subtask(primitive).active.contains(state_type))
        .collect();
    let primitive = active[rng.random_range(0..active.len())];
    let acts_as = catalogue.acts_as(primitive, state_type, state.recalled.is_some());
    let actions = catalogue.subtask(acts_as).actions();
    (primitive, rng.random_range(0..actions))
}
