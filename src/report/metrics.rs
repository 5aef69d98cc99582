//! The numbers of a run that are summarised over seeds, and what is counted.

use super::facts::Facts;

/// How something is read from a run; none where the run has none.
type Reading<T> = Box<dyn Fn(&Facts) -> Option<T>>;

/// Something that is read from every run.
pub struct Measure<T> {
    /// Its name; of a number, with its unit.
    pub name: String,
    /// How it is read.
    pub of: Reading<T>,
}

/// Where courses are looked at, in per cent of the generations.
const PERCENT: [u32; 6] = [0, 10, 25, 50, 75, 100];

/// The numbers that are reported, for runs with this many state types.
#[must_use]
pub fn metrics(state_types: usize) -> Vec<Measure<f64>> {
    let mut metrics = Vec::new();
    let mut add = |name: String, of: Reading<f64>| {
        metrics.push(Measure { name, of });
    };
    add(
        "generations".into(),
        Box::new(|f| Some(f.generations as f64)),
    );
    add(
        "control_steps".into(),
        Box::new(|f| Some(f.control_steps as f64)),
    );
    add(
        "fresh_trial_steps".into(),
        Box::new(|f| Some(f.fresh.steps)),
    );
    add(
        "fresh_delivered_share".into(),
        Box::new(|f| Some(f.fresh.delivered_share)),
    );
    add(
        "best_fitness_first_trial_steps".into(),
        Box::new(|f| f.at(0.0, |m| m.best_steps)),
    );
    add(
        "best_fitness_last_trial_steps".into(),
        Box::new(|f| f.at(1.0, |m| m.best_steps)),
    );
    add(
        "middle_fitness_first_trial_steps".into(),
        Box::new(|f| f.at(0.0, |m| m.middle_steps)),
    );
    add(
        "middle_fitness_last_trial_steps".into(),
        Box::new(|f| f.at(1.0, |m| m.middle_steps)),
    );
    add(
        "composites".into(),
        Box::new(|f| Some(f.winner.composites.len() as f64)),
    );
    add(
        "primitives".into(),
        Box::new(|f| Some(f.winner.primitives.len() as f64)),
    );
    for index in 0..state_types {
        add(
            format!("selectable_primitives_type_{}", index + 1),
            Box::new(move |f| Some(f.winner.selectable.get(index)?.len() as f64)),
        );
    }
    add(
        "selectable_primitives_all_types".into(),
        Box::new(|f| Some(f.winner.selectable_in_all() as f64)),
    );
    add(
        "deliver_minus_capture_subtasks".into(),
        Box::new(|f| {
            f.winner
                .sides()
                .map(|[capture, deliver]| deliver as f64 - capture as f64)
        }),
    );
    for percent in PERCENT {
        add(
            format!("structural_difference_at_{percent}_percent"),
            Box::new(move |f| f.at(f64::from(percent) / 100.0, |m| m.difference)),
        );
    }
    metrics
}

/// What is counted, for runs with this many state types.
#[must_use]
pub fn traits(state_types: usize) -> Vec<Measure<bool>> {
    let mut traits = Vec::new();
    let mut add = |name: String, of: Reading<bool>| {
        traits.push(Measure { name, of });
    };
    add("converged".into(), Box::new(|f| Some(f.converged)));
    add(
        "one primitive in every state type".into(),
        Box::new(|f| Some(f.winner.is_minimal())),
    );
    for index in 0..state_types {
        add(
            format!("two or more primitives in state type {}", index + 1),
            Box::new(move |f| Some(f.winner.selectable.get(index)?.len() >= 2)),
        );
    }
    for (name, holds) in [
        (
            "deliver side above capture side",
            usize::gt as fn(&usize, &usize) -> bool,
        ),
        ("deliver side equal to capture side", usize::eq),
        ("deliver side below capture side", usize::lt),
    ] {
        add(
            name.into(),
            Box::new(move |f| {
                f.winner
                    .sides()
                    .map(|[capture, deliver]| holds(&deliver, &capture))
            }),
        );
    }
    traits
}
