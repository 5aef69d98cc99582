//! What the runs of a study show together: summaries, comparisons of arms, verdicts on claims.

use std::collections::BTreeMap;

use serde::Serialize;

use super::arm::Base;
use super::claims::{CLAIMS, Claim, Evidence, Scope, Verdict, judge};
use super::facts::{Facts, StudyRuns};
use super::metrics::{metrics, traits};
use super::provenance::Provenance;
use super::statistics::{
    Count, Estimate, Interval, fisher, iqm, mann_whitney, mean, probability_of_improvement,
};
use super::study::Study;

/// Number of final structures that are listed for each scenario and arm.
const STRUCTURES_LISTED: usize = 3;

/// Everything that is reported of a study.
#[derive(Clone, Debug, Serialize)]
pub struct Findings {
    /// What the findings were made from.
    pub provenance: Provenance,
    /// Every scenario and arm.
    #[serde(rename = "kinds")]
    pub groups: Vec<RunGroup>,
    /// The tested arm against every other arm.
    pub comparisons: Vec<Comparison>,
    /// The claims and the verdicts on them.
    pub claims: Vec<JudgedClaim>,
}

/// The finished runs of one scenario and arm.
#[derive(Clone, Debug, Serialize)]
pub struct RunGroup {
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the arm.
    pub arm: String,
    /// Number of runs.
    pub n: usize,
    /// Metrics, summarised over seeds.
    pub metrics: Vec<MetricSummary>,
    /// Traits, counted over seeds.
    pub counts: Vec<TraitCount>,
    /// The most frequent final structures, each with its number of runs.
    pub structures: Vec<(String, usize)>,
}

/// A metric, summarised over seeds.
#[derive(Clone, Debug, Serialize)]
pub struct MetricSummary {
    /// Its name, which ends in its unit.
    pub metric: String,
    /// Interquartile mean.
    pub iqm: Estimate,
    /// Mean.
    pub mean: Estimate,
}

/// A trait, counted over seeds.
#[derive(Clone, Debug, Serialize)]
pub struct TraitCount {
    /// The trait.
    pub what: String,
    /// Number of runs that have it.
    pub count: Count,
    /// Exact 95 % interval of the proportion.
    pub interval: Interval,
}

/// Two arms, compared by the trial lengths of their winners on fresh trials, paired by seed.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// The scenario; `all` for all scenarios together, each a stratum.
    pub scenario: String,
    /// The arm.
    pub arm: String,
    /// The arm that it is compared with.
    pub against: String,
    /// Interquartile mean of the differences in trial length, arm minus other, in time steps;
    /// `None` for all scenarios together.
    pub difference_iqm: Option<Estimate>,
    /// Mean of the differences in trial length; `None` for all scenarios together.
    pub difference_mean: Option<Estimate>,
    /// Probability that a winner of the arm is faster than a winner of the other arm.
    pub improvement: Estimate,
    /// Two-sided p-value of the Mann-Whitney test; `None` for all scenarios together.
    pub p: Option<f64>,
}

/// A claim and the verdict on it.
#[derive(Clone, Debug, Serialize)]
pub struct JudgedClaim {
    /// Its short name.
    pub claim: &'static str,
    /// Section of the thesis that makes it.
    pub source: &'static str,
    /// The claim, in the form in which it is tested.
    pub statement: &'static str,
    /// The scenarios for which it is judged.
    pub scenario: String,
    /// Number of seeds of the tested arm that show it.
    pub tested: Count,
    /// Exact 95 % interval of their proportion.
    pub interval: Interval,
    /// Number of seeds of the control arm that show it; `None` if the plan has no control.
    pub control: Option<Count>,
    /// Two-sided p-value of Fisher's exact test of the tested arm against the control.
    pub p: Option<f64>,
    /// The verdict; `None` if the plan has no control.
    pub verdict: Option<Verdict>,
    /// Number of seeds that show it, for every arm.
    pub arms: Vec<(String, Count)>,
}

impl Findings {
    /// Computes the findings of these runs.
    #[must_use]
    pub fn from_facts(study: &Study, all: &[Facts]) -> Self {
        let runs = StudyRuns { study, all };
        Self {
            provenance: Provenance::of(study, all),
            groups: groups(runs),
            comparisons: comparisons(runs),
            claims: claims(runs),
        }
    }
}

fn groups(runs: StudyRuns<'_>) -> Vec<RunGroup> {
    let plan = &runs.study.plan;
    let scenarios = plan.scenarios.iter().enumerate();
    let groups = scenarios.flat_map(|(index, scenario)| {
        let arms = plan.arms.iter().enumerate();
        arms.map(move |(arm_index, arm)| {
            group(&scenario.name, &arm.name, &runs.of(index, arm_index))
        })
    });
    groups.collect()
}

fn group(scenario: &str, arm: &str, runs: &[&Facts]) -> RunGroup {
    let types = runs.first().map_or(0, |run| run.winner.selectable.len());
    let summaries = metrics(types).into_iter().filter_map(|metric| {
        let values: Vec<_> = runs.iter().filter_map(|facts| (metric.of)(facts)).collect();
        Some(MetricSummary {
            metric: metric.name,
            iqm: Estimate::of(&values, iqm)?,
            mean: Estimate::of(&values, mean)?,
        })
    });
    let counts = traits(types).into_iter().filter_map(|of| {
        let count = Count::of(runs.iter().filter_map(|facts| (of.of)(facts)));
        (count.n > 0).then(|| TraitCount {
            what: of.name,
            count,
            interval: count.interval(),
        })
    });
    let mut times: BTreeMap<&String, usize> = BTreeMap::new();
    for facts in runs {
        *times.entry(&facts.winner.structure).or_default() += 1;
    }
    let mut structures: Vec<_> = times.into_iter().map(|(s, n)| (s.clone(), n)).collect();
    structures.sort_by(|(a, n), (b, m)| m.cmp(n).then(a.cmp(b)));
    structures.truncate(STRUCTURES_LISTED);
    RunGroup {
        scenario: scenario.to_owned(),
        arm: arm.to_owned(),
        n: runs.len(),
        metrics: summaries.collect(),
        counts: counts.collect(),
        structures,
    }
}

/// Compares the tested arm with every other arm.
fn comparisons(runs: StudyRuns<'_>) -> Vec<Comparison> {
    let Some(tested) = runs.tested_arm() else {
        return Vec::new();
    };
    let others = (0..runs.study.plan.arms.len()).filter(|&arm| arm != tested);
    others
        .flat_map(|other| compare(runs, tested, other))
        .collect()
}

/// Compares two arms in each scenario and, if there are several, in all of them together.
fn compare(runs: StudyRuns<'_>, arm: usize, other: usize) -> Vec<Comparison> {
    let plan = &runs.study.plan;
    let names = [arm, other].map(|arm| plan.arms[arm].name.clone());
    let mut strata = Vec::new();
    let mut comparisons = Vec::new();
    for (index, scenario) in plan.scenarios.iter().enumerate() {
        let pairs = pairs(runs, index, arm, other);
        comparisons.extend(compare_pairs(&scenario.name, &names, &pairs));
        strata.push(pairs);
    }
    if strata.len() > 1
        && let Some(improvement) = Estimate::stratified(&strata, improvement)
    {
        let [arm, against] = names;
        comparisons.push(Comparison {
            scenario: String::from("all"),
            arm,
            against,
            difference_iqm: None,
            difference_mean: None,
            improvement,
            p: None,
        });
    }
    comparisons
}

/// Returns the fresh trial lengths of the winners of two arms, paired by seed.
fn pairs(runs: StudyRuns<'_>, scenario: usize, arm: usize, other: usize) -> Vec<[f64; 2]> {
    let others = runs.of(scenario, other);
    let pair = |own: &Facts| {
        let other = others.iter().find(|other| other.run.seed == own.run.seed)?;
        Some([own.fresh.steps, other.fresh.steps])
    };
    runs.of(scenario, arm)
        .into_iter()
        .filter_map(pair)
        .collect()
}

fn compare_pairs(
    scenario: &str,
    [arm, against]: &[String; 2],
    pairs: &[[f64; 2]],
) -> Option<Comparison> {
    let strata = [pairs.to_vec()];
    let differences: Vec<_> = pairs.iter().map(|[own, other]| own - other).collect();
    let [own, other] = columns(pairs);
    Some(Comparison {
        scenario: scenario.to_owned(),
        arm: arm.clone(),
        against: against.clone(),
        difference_iqm: Estimate::of(&differences, iqm),
        difference_mean: Estimate::of(&differences, mean),
        improvement: Estimate::stratified(&strata, improvement)?,
        p: Some(mann_whitney(&own, &other)),
    })
}

/// Returns the probability of improvement, averaged over strata.
fn improvement(strata: &[Vec<[f64; 2]>]) -> f64 {
    let each = strata.iter().map(|pairs| {
        let [own, other] = columns(pairs);
        probability_of_improvement(&own, &other)
    });
    mean(&each.collect::<Vec<_>>())
}

fn columns(pairs: &[[f64; 2]]) -> [Vec<f64>; 2] {
    [0, 1].map(|side| pairs.iter().map(|pair| pair[side]).collect())
}

/// Judges every claim whose scenarios the study has.
fn claims(runs: StudyRuns<'_>) -> Vec<JudgedClaim> {
    let scenarios = &runs.study.plan.scenarios;
    let has = |name: &&str| scenarios.iter().any(|scenario| scenario.name == *name);
    let mut judged = Vec::new();
    for claim in CLAIMS {
        match claim.scope {
            Scope::Named(names) if names.iter().all(has) => {
                let here = names.first().copied().unwrap_or_default();
                judged.extend(judge_claim(runs, claim, here, names.join(", ")));
            }
            Scope::Named(_) => {}
            Scope::Each => judged.extend(scenarios.iter().filter_map(|scenario| {
                judge_claim(runs, claim, &scenario.name, scenario.name.clone())
            })),
        }
    }
    judged
}

fn judge_claim(
    runs: StudyRuns<'_>,
    claim: &Claim,
    here: &str,
    scenario: String,
) -> Option<JudgedClaim> {
    let plan = &runs.study.plan;
    let tested = count(runs, claim, here, runs.tested_arm()?);
    let control = plan.control.as_ref();
    let control = control.and_then(|name| runs.arm(|arm| arm.name == *name));
    let control = control.map(|arm| count(runs, claim, here, arm));
    let arms = plan.arms.iter().enumerate();
    let arms = arms.map(|(index, arm)| (arm.name.clone(), count(runs, claim, here, index)));
    (tested.n > 0).then(|| JudgedClaim {
        claim: claim.id,
        source: claim.source,
        statement: claim.statement,
        scenario,
        tested,
        interval: tested.interval(),
        control,
        p: control.map(|control| fisher(tested, control)),
        verdict: control.map(|control| judge(tested, control)),
        arms: arms.collect(),
    })
}

/// Counts the seeds of an arm that show a claim.
fn count(runs: StudyRuns<'_>, claim: &Claim, here: &str, arm: usize) -> Count {
    let plan = &runs.study.plan;
    let seeds: Vec<_> = plan.seeds.iter().collect();
    let across = matches!(claim.scope, Scope::Named(names) if names.len() > 1);
    let drifts = plan.arms[arm].base == Base::RandomSelection;
    let designed = runs.arm(|arm| arm.base == Base::HandDesigned);
    Count::of(seeds.iter().enumerate().filter_map(|(place, &seed)| {
        let evidence = Evidence {
            runs: if across && drifts {
                staggered(runs, &seeds, place, arm)
            } else {
                by_scenario(runs, seed, arm)
            },
            designed: designed.map_or_else(BTreeMap::new, |arm| by_scenario(runs, seed, arm)),
            here,
        };
        (claim.shows)(&evidence)
    }))
}

/// Returns one run of each scenario, each with the seed after that of the scenario before.
///
/// Without selection, a seed leads to the same structures in every scenario. A comparison of
/// scenarios within one seed would then find no difference where chance alone makes one.
fn staggered<'s>(
    runs: StudyRuns<'s>,
    seeds: &[u64],
    place: usize,
    arm: usize,
) -> BTreeMap<&'s str, &'s Facts> {
    let scenarios = runs.study.plan.scenarios.iter().enumerate();
    let found = scenarios.filter_map(|(shift, scenario)| {
        let seed = seeds[(place + shift) % seeds.len()];
        by_scenario(runs, seed, arm).remove_entry(scenario.name.as_str())
    });
    found.collect()
}

/// Returns the runs of a seed and arm, by scenario.
fn by_scenario(runs: StudyRuns<'_>, seed: u64, arm: usize) -> BTreeMap<&str, &Facts> {
    let of = |facts: &&Facts| facts.run.seed == seed && facts.run.arm == arm;
    let found = runs.all.iter().filter(of);
    found
        .map(|facts| (runs.study.scenario(&facts.run).name.as_str(), facts))
        .collect()
}
