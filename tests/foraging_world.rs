//! Contract: the foraging world is the one that the method describes.
//!
//! The world is the ground that every result stands on, and an error in it shows in no
//! learning test: agents learn to live with whatever they are given. So every rule is
//! checked on thousands of states against its definition, by brute force over all
//! walls, in every shipped arena; the fast lists of walls, the sliding, the noise and
//! the state machine have to agree with that. Seen-through slits, closest batteries,
//! captures and deliveries all occur in these walks; the tests count them.

#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "foraging/geometry.rs"]
mod geometry;
#[path = "foraging/primitives.rs"]
mod primitives;
#[path = "foraging/readings.rs"]
mod readings;
#[path = "foraging/walks.rs"]
mod walks;

use maxq_lab::random::Stream;
use maxq_lab::scenario::Scenario;
use maxq_lab::worlds::WorldSettings;
use maxq_lab::worlds::foraging::ForagingSettings;
use maxq_lab::worlds::foraging::{ForagingState, ForagingWorld};
use maxq_lab::worlds::{SubtaskId, World};
use rand::RngExt;

const SCENARIOS: [&str; 4] = ["environment-1", "environment-2", "environment-3", "smoke"];

fn model(scenario: &str) -> ForagingSettings {
    let WorldSettings::Foraging(model) = Scenario::load(scenario).unwrap().world else {
        panic!("a foraging scenario")
    };
    *model
}

fn world(scenario: &str) -> ForagingWorld {
    ForagingWorld::new(&model(scenario)).unwrap()
}

/// An action of a primitive subtask that is active in a state.
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
    let actions = catalogue.subtask(primitive).actions();
    (primitive, rng.random_range(0..actions))
}
