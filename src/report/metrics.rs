//! What is measured in every run: the metrics that are summarised over seeds, and the traits
//! that are counted.

use std::cmp::Ordering;

use super::facts::Facts;

/// Reads something from a run; `None` if the run does not have it.
type Reading<T> = Box<dyn Fn(&Facts) -> Option<T>>;

/// A quantity or property of a run.
pub struct Measure<T> {
    /// Its name; that of a metric ends in its unit.
    pub name: String,
    /// Reads it from a run.
    pub of: Reading<T>,
}

/// Points in a run at which the structural difference is reported, in per cent of its
/// generations.
const PERCENT: [u32; 6] = [0, 10, 25, 50, 75, 100];

/// Returns the metrics that are reported for runs with this many state types.
#[must_use]
pub fn metrics(state_types: usize) -> Vec<Measure<f64>> {
    let mut metrics = Vec::new();
    let mut add = |name: &str, of: Reading<f64>| {
        metrics.push(Measure {
            name: name.to_owned(),
            of,
        });
    };
    add("generations", Box::new(|f| Some(f.generations as f64)));
    add("control_steps", Box::new(|f| Some(f.control_steps as f64)));
    add("fresh_trial_steps", Box::new(|f| Some(f.fresh.steps)));
    add(
        "fresh_delivered_share",
        Box::new(|f| Some(f.fresh.delivered_share)),
    );
    add(
        "then_first_tenth_trial_steps",
        Box::new(|f| Some(f.later?.first)),
    );
    add(
        "then_last_tenth_trial_steps",
        Box::new(|f| Some(f.later?.last)),
    );
    for (end, share) in [("first", 0.0), ("last", 1.0)] {
        let name = format!("best_fitness_{end}_trial_steps");
        add(&name, Box::new(move |f| f.at(share, |g| g.best_steps)));
    }
    for (end, share) in [("first", 0.0), ("last", 1.0)] {
        let name = format!("middle_fitness_{end}_trial_steps");
        add(&name, Box::new(move |f| f.at(share, |g| g.middle_steps)));
    }
    add(
        "composites",
        Box::new(|f| Some(f.winner.composites.len() as f64)),
    );
    add(
        "primitives",
        Box::new(|f| Some(f.winner.primitives.len() as f64)),
    );
    for index in 0..state_types {
        let name = format!("selectable_primitives_type_{}", index + 1);
        add(
            &name,
            Box::new(move |f| Some(f.winner.selectable.get(index)?.len() as f64)),
        );
    }
    let in_all = |f: &Facts| Some(f.winner.selectable_in_all() as f64);
    add("selectable_primitives_all_types", Box::new(in_all));
    let surplus = |f: &Facts| {
        let [capture, deliver] = f.winner.sides()?;
        Some(deliver as f64 - capture as f64)
    };
    add("deliver_minus_capture_subtasks", Box::new(surplus));
    for percent in PERCENT {
        let name = format!("structural_difference_at_{percent}_percent");
        let share = f64::from(percent) / 100.0;
        add(&name, Box::new(move |f| f.at(share, |g| g.difference)));
    }
    metrics
}

/// Returns the traits that are counted for runs with this many state types.
#[must_use]
pub fn traits(state_types: usize) -> Vec<Measure<bool>> {
    let mut traits = Vec::new();
    let mut add = |name: &str, of: Reading<bool>| {
        traits.push(Measure {
            name: name.to_owned(),
            of,
        });
    };
    add("converged", Box::new(|f| Some(f.converged)));
    let minimal = |f: &Facts| Some(f.winner.is_minimal());
    add("one primitive in every state type", Box::new(minimal));
    for index in 0..state_types {
        let name = format!("two or more primitives in state type {}", index + 1);
        add(
            &name,
            Box::new(move |f| Some(f.winner.selectable.get(index)?.len() >= 2)),
        );
    }
    for (word, order) in [
        ("above", Ordering::Greater),
        ("equal to", Ordering::Equal),
        ("below", Ordering::Less),
    ] {
        let holds = move |f: &Facts| {
            let [capture, deliver] = f.winner.sides()?;
            Some(deliver.cmp(&capture) == order)
        };
        add(
            &format!("deliver side {word} capture side"),
            Box::new(holds),
        );
    }
    traits
}
