//! What is odd about the scenarios of a plan, and what its runs cost.

use super::plan::Plan;
use crate::files::ByteCount;
use crate::lab::experiment;
use crate::scenario::Scenario;

/// Returns what is odd about the scenarios of a plan with the settings of its arms, each warning
/// once and with the name of its scenario.
#[must_use]
pub fn plan_warnings(plan: &Plan) -> Vec<String> {
    let mut warnings = Vec::new();
    for scenario in variants(plan) {
        // A plan whose scenarios cannot be built is refused where it is read.
        let ready = experiment(scenario, 0).into_iter();
        for ready in ready {
            let name = &ready.scenario().name;
            for odd in ready.warnings() {
                let warning = format!("{name}: {odd}");
                if !warnings.contains(&warning) {
                    warnings.push(warning);
                }
            }
        }
    }
    warnings
}

/// Returns about how many bytes it takes to keep all generations of all runs.
#[must_use]
pub fn bytes_of_all_generations(plan: &Plan) -> ByteCount {
    let seeds = plan.seeds.count();
    let of_run = |scenario: Scenario| {
        let limit = scenario.evolution.generation_limit;
        let ready = experiment(scenario, 0).ok();
        ready.map_or(0, |ready| ready.state_bytes().saturating_mul(limit))
    };
    let of_seed = variants(plan).map(of_run);
    ByteCount(of_seed.fold(0, u64::saturating_add).saturating_mul(seeds))
}

/// Returns the scenarios with the settings of the arms.
fn variants(plan: &Plan) -> impl Iterator<Item = Scenario> {
    let pairs = plan
        .scenarios
        .iter()
        .flat_map(|scenario| plan.arms.iter().map(move |arm| arm.apply(scenario)));
    pairs.flatten()
}
