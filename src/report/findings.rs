//! What the runs of a study say together.

use std::collections::BTreeMap;

use serde::Serialize;

use super::arm::Base;
use super::claims::{CLAIMS, Claim, Evidence, Scope, Verdict, judge};
use super::facts::Facts;
use super::metrics::{metrics, traits};
use super::provenance::Provenance;
use super::statistics::{
    Count, Estimate, Interval, fisher, iqm, mann_whitney, mean, probability_of_improvement,
};
use super::study::Study;

/// Final structures that are listed of each kind of run.
const STRUCTURES_LISTED: usize = 3;

/// Everything that is reported of a study.
#[derive(Clone, Debug, Serialize)]
pub struct Findings {
    /// What it was made from.
    pub provenance: Provenance,
    /// Every scenario and arm.
    pub kinds: Vec<Kind>,
    /// The tested arm against every other.
    pub comparisons: Vec<Comparison>,
    /// The claims.
    pub claims: Vec<Judged>,
}

/// The runs of one scenario and arm.
#[derive(Clone, Debug, Serialize)]
pub struct Kind {
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the arm.
    pub arm: String,
    /// Runs that are done.
    pub n: usize,
    /// Numbers over seeds.
    pub metrics: Vec<Summary>,
    /// Counts over seeds.
    pub counts: Vec<Counted>,
    /// The most frequent final structures.
    pub structures: Vec<(String, usize)>,
}

/// One number over seeds.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// Its name, with its unit.
    pub metric: String,
    /// Interquartile mean.
    pub iqm: Estimate,
    /// Mean.
    pub mean: Estimate,
}

/// One count over seeds.
#[derive(Clone, Debug, Serialize)]
pub struct Counted {
    /// What is counted.
    pub what: String,
    /// How many show it.
    pub count: Count,
    /// The exact 95 % interval of their share.
    pub interval: Interval,
}

/// Two arms, compared by how good their winners are on fresh trials, paired by seed.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// The scenario; `all` for all of them, each a stratum.
    pub scenario: String,
    /// The arm.
    pub arm: String,
    /// The arm that it is compared with.
    pub against: String,
    /// Interquartile mean of the differences in trial length, arm minus other, in time
    /// steps; for one scenario.
    pub difference_iqm: Option<Estimate>,
    /// Mean of the differences.
    pub difference_mean: Option<Estimate>,
    /// Probability that a winner of the arm is faster than one of the other.
    pub improvement: Estimate,
    /// Mann-Whitney test, two-sided; for one scenario.
    pub p: Option<f64>,
}

/// A claim and what became of it.
#[derive(Clone, Debug, Serialize)]
pub struct Judged {
    /// Its short name.
    pub claim: &'static str,
    /// Where the thesis makes it.
    pub source: &'static str,
    /// What is claimed.
    pub statement: &'static str,
    /// For which scenarios.
    pub scenario: String,
    /// How many seeds show it, in the tested arm.
    pub tested: Count,
    /// The exact 95 % interval of their share.
    pub interval: Interval,
    /// How many seeds show it in the control arm; none where the plan has none.
    pub control: Option<Count>,
    /// Fisher's exact test of the two, two-sided.
    pub p: Option<f64>,
    /// The verdict; none without a control.
    pub verdict: Option<Verdict>,
    /// How many seeds show it in every arm.
    pub arms: Vec<(String, Count)>,
}

impl Findings {
    /// What these runs say.
    #[must_use]
    pub fn from_facts(study: &Study, all: &[Facts]) -> Self {
        let view = View { study, all };
        Self {
            provenance: Provenance::of(study, all),
            kinds: view.kinds(),
            comparisons: view.comparisons(),
            claims: view.claims(),
        }
    }
}

struct View<'s> {
    study: &'s Study,
    all: &'s [Facts],
}

impl<'s> View<'s> {
    fn of_kind(&self, scenario: usize, arm: usize) -> Vec<&Facts> {
        let of = |facts: &&Facts| (facts.run.scenario, facts.run.arm) == (scenario, arm);
        let mut runs: Vec<_> = self.all.iter().filter(of).collect();
        runs.sort_by_key(|facts| facts.run.seed);
        runs
    }

    fn kinds(&self) -> Vec<Kind> {
        let plan = &self.study.plan;
        let mut kinds = Vec::new();
        for (index, scenario) in plan.scenarios.iter().enumerate() {
            for (arm_index, arm) in plan.arms.iter().enumerate() {
                let runs = self.of_kind(index, arm_index);
                kinds.push(kind(&scenario.name, &arm.name, &runs));
            }
        }
        kinds
    }

    /// The arm that claims are tested on: the first that evolves.
    fn tested(&self) -> Option<usize> {
        self.study
            .plan
            .arms
            .iter()
            .position(|arm| arm.base == Base::Evolved)
    }

    fn control(&self) -> Option<usize> {
        let name = self.study.plan.control.as_ref()?;
        self.study
            .plan
            .arms
            .iter()
            .position(|arm| arm.name == *name)
    }

    fn comparisons(&self) -> Vec<Comparison> {
        let Some(tested) = self.tested() else {
            return Vec::new();
        };
        let others = (0..self.study.plan.arms.len()).filter(|&arm| arm != tested);
        others
            .flat_map(|other| self.compare(tested, other))
            .collect()
    }

    fn compare(&self, arm: usize, other: usize) -> Vec<Comparison> {
        let plan = &self.study.plan;
        let names = [arm, other].map(|arm| plan.arms[arm].name.clone());
        let mut strata = Vec::new();
        let mut comparisons = Vec::new();
        for (index, scenario) in plan.scenarios.iter().enumerate() {
            let pairs = self.pairs(index, arm, other);
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

    /// Trial lengths of the winners of two arms, seed by seed.
    fn pairs(&self, scenario: usize, arm: usize, other: usize) -> Vec<[f64; 2]> {
        let others = self.of_kind(scenario, other);
        let pair = |own: &Facts| {
            let other = others.iter().find(|other| other.run.seed == own.run.seed)?;
            Some([own.fresh.steps, other.fresh.steps])
        };
        self.of_kind(scenario, arm)
            .into_iter()
            .filter_map(pair)
            .collect()
    }

    fn claims(&self) -> Vec<Judged> {
        let scenarios = &self.study.plan.scenarios;
        let has = |name: &&str| scenarios.iter().any(|scenario| scenario.name == *name);
        let mut judged = Vec::new();
        for claim in CLAIMS {
            match claim.scope {
                Scope::Named(names) if names.iter().all(has) => {
                    judged.extend(self.judge(
                        claim,
                        names.first().copied().unwrap_or_default(),
                        names.join(", "),
                    ));
                }
                Scope::Named(_) => {}
                Scope::Each => judged.extend(scenarios.iter().filter_map(|scenario| {
                    self.judge(claim, &scenario.name, scenario.name.clone())
                })),
            }
        }
        judged
    }

    fn judge(&self, claim: &Claim, here: &str, scenario: String) -> Option<Judged> {
        let tested_arm = self.tested()?;
        let tested = self.count(claim, here, tested_arm);
        let control = self.control().map(|arm| self.count(claim, here, arm));
        let arms = self.study.plan.arms.iter().enumerate();
        let arms = arms.map(|(index, arm)| (arm.name.clone(), self.count(claim, here, index)));
        (tested.n > 0).then(|| Judged {
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

    /// How many seeds of an arm show what is claimed.
    fn count(&self, claim: &Claim, here: &str, arm: usize) -> Count {
        let seeds: Vec<_> = self.study.plan.seeds.iter().collect();
        let across = matches!(claim.scope, Scope::Named(names) if names.len() > 1);
        let drifts = self.study.plan.arms[arm].base == Base::RandomSelection;
        Count::of(seeds.iter().enumerate().filter_map(|(place, &seed)| {
            let evidence = Evidence {
                runs: match across && drifts {
                    true => self.staggered(&seeds, place, arm),
                    false => self.by_scenario(seed, arm),
                },
                designed: self.designed(seed),
                here,
            };
            (claim.shows)(&evidence)
        }))
    }

    /// One run of each scenario, each of the next seed. Without selection a seed leads to
    /// the same structures in every scenario, so that holding these against each other
    /// would show no difference where chance makes one.
    fn staggered(&self, seeds: &[u64], place: usize, arm: usize) -> BTreeMap<&'s str, &'s Facts> {
        let scenarios = self.study.plan.scenarios.iter().enumerate();
        let runs = scenarios.filter_map(|(shift, scenario)| {
            let seed = seeds[(place + shift) % seeds.len()];
            let of = self.by_scenario(seed, arm);
            of.get_key_value(scenario.name.as_str())
                .map(|(&name, &facts)| (name, facts))
        });
        runs.collect()
    }

    fn by_scenario(&self, seed: u64, arm: usize) -> BTreeMap<&'s str, &'s Facts> {
        let of = |facts: &&Facts| facts.run.seed == seed && facts.run.arm == arm;
        let named = |facts: &'s Facts| (self.study.scenario(&facts.run).name.as_str(), facts);
        self.all.iter().filter(of).map(named).collect()
    }

    fn designed(&self, seed: u64) -> BTreeMap<&'s str, &'s Facts> {
        let arms = &self.study.plan.arms;
        let arm = arms.iter().position(|arm| arm.base == Base::HandDesigned);
        arm.map(|arm| self.by_scenario(seed, arm))
            .unwrap_or_default()
    }
}

fn kind(scenario: &str, arm: &str, runs: &[&Facts]) -> Kind {
    let types = runs
        .first()
        .map_or(0, |facts| facts.winner.selectable.len());
    let summaries = metrics(types).into_iter().filter_map(|metric| {
        let values: Vec<_> = runs.iter().filter_map(|facts| (metric.of)(facts)).collect();
        Some(Summary {
            metric: metric.name,
            iqm: Estimate::of(&values, iqm)?,
            mean: Estimate::of(&values, mean)?,
        })
    });
    let counts = traits(types).into_iter().filter_map(|of| {
        let count = Count::of(runs.iter().filter_map(|facts| (of.of)(facts)));
        (count.n > 0).then(|| Counted {
            what: of.name,
            count,
            interval: count.interval(),
        })
    });
    let mut structures: BTreeMap<&str, usize> = BTreeMap::new();
    for facts in runs {
        *structures.entry(&facts.winner.structure).or_default() += 1;
    }
    let mut structures: Vec<_> = structures
        .into_iter()
        .map(|(s, n)| (s.to_owned(), n))
        .collect();
    structures.sort_by(|(a, n), (b, m)| m.cmp(n).then(a.cmp(b)));
    structures.truncate(STRUCTURES_LISTED);
    Kind {
        scenario: scenario.to_owned(),
        arm: arm.to_owned(),
        n: runs.len(),
        metrics: summaries.collect(),
        counts: counts.collect(),
        structures,
    }
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

fn columns(pairs: &[[f64; 2]]) -> [Vec<f64>; 2] {
    [0, 1].map(|side| pairs.iter().map(|pair| pair[side]).collect())
}

/// Probability of improvement, averaged over strata.
fn improvement(strata: &[Vec<[f64; 2]>]) -> f64 {
    let each: Vec<_> = strata
        .iter()
        .map(|pairs| {
            let [own, other] = columns(pairs);
            probability_of_improvement(&own, &other)
        })
        .collect();
    mean(&each)
}
