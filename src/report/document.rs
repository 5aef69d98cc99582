//! The report of a study for people: Markdown.

use super::claims::Verdict;
use super::findings::{Comparison, Findings, Judged, Kind, Summary};
use super::statistics::{Count, Estimate, Interval, RESAMPLES};
use super::table::{Table, p_value, short};

/// The report.
#[must_use]
pub fn markdown(findings: &Findings) -> String {
    let mut text = format!(
        "# Study {}\n\n{}.\n\n",
        findings.provenance.study,
        findings.provenance.line()
    );
    text += &claims(&findings.claims);
    text += &comparisons(&findings.comparisons);
    let mut scenarios: Vec<&str> = findings
        .kinds
        .iter()
        .map(|kind| kind.scenario.as_str())
        .collect();
    scenarios.dedup();
    for scenario in scenarios {
        let kinds: Vec<_> = findings
            .kinds
            .iter()
            .filter(|kind| kind.scenario == scenario)
            .collect();
        text += &format!("## {scenario}\n\n");
        text += &numbers("Interquartile mean [95 % interval]", &kinds, |summary| {
            summary.iqm
        });
        text += &numbers("Mean [95 % interval]", &kinds, |summary| summary.mean);
        text += &counts(&kinds);
        text += &structures(&kinds);
    }
    text
}

fn claims(claims: &[Judged]) -> String {
    if claims.is_empty() {
        return String::new();
    }
    let mut table = Table::new(&[
        "claim", "thesis", "scenario", "shown", "control", "p", "verdict",
    ]);
    for judged in claims {
        table.rows.push(vec![
            judged.statement.to_owned(),
            judged.source.to_owned(),
            judged.scenario.clone(),
            format!("{} {}", count(judged.tested), percent(judged.interval)),
            judged.control.map_or_else(|| String::from("-"), count),
            judged.p.map_or_else(|| String::from("-"), p_value),
            judged
                .verdict
                .map_or("no control", Verdict::words)
                .to_owned(),
        ]);
    }
    format!(
        "## Claims\n\nThe seed is the unit; in brackets the exact 95 % interval of the share. A claim *holds* if \
         more than half of the seeds show it (the interval lies above one half) and more than under \
         the control (Fisher's exact test, p < 0.05); it *comes out by drift alone* if more than half \
         show it and the control's do too; it *does not hold* if fewer than half show it (the interval \
         lies below), or fewer than the control's. Across scenarios, runs of one seed are held against \
         each other; of the control's, runs of different seeds, because without selection a seed leads \
         to the same structures everywhere. {} verdicts: about one in twenty tests is \
         significant by chance.\n\n{}\n",
        claims.len(),
        table.markdown()
    )
}

fn comparisons(comparisons: &[Comparison]) -> String {
    if comparisons.is_empty() {
        return String::new();
    }
    let mut table = Table::new(&[
        "scenario",
        "arm",
        "against",
        "n",
        "difference, interquartile mean",
        "difference, mean",
        "probability of improvement",
        "p",
    ]);
    for row in comparisons {
        table.rows.push(vec![
            row.scenario.clone(),
            row.arm.clone(),
            row.against.clone(),
            row.improvement.n.to_string(),
            row.difference_iqm
                .map_or_else(|| String::from("-"), estimate),
            row.difference_mean
                .map_or_else(|| String::from("-"), estimate),
            estimate(row.improvement),
            row.p.map_or_else(|| String::from("-"), p_value),
        ]);
    }
    format!(
        "## Arms compared\n\nBy the structures of the winners on fresh trials, with fresh hierarchies and freshly \
         trained primitive subtasks; differences of trial lengths in time steps, paired by seed, \
         negative where the arm is faster; 95 % intervals by {RESAMPLES} bootstrap resamples of the \
         seeds, for *all* stratified by scenario; p by the Mann-Whitney test.\n\n{}\n",
        table.markdown()
    )
}

fn numbers(title: &str, kinds: &[&Kind], of: fn(&Summary) -> Estimate) -> String {
    let mut table = Table::default();
    table.header.push(title.to_owned());
    table.header.extend(
        kinds
            .iter()
            .map(|kind| format!("{} (n = {})", kind.arm, kind.n)),
    );
    let names = kinds
        .iter()
        .flat_map(|kind| kind.metrics.iter().map(|summary| &summary.metric));
    for name in in_order(names) {
        let mut row = vec![name.replace('_', " ")];
        row.extend(kinds.iter().map(|kind| {
            let found = kind.metrics.iter().find(|summary| summary.metric == *name);
            found.map_or_else(|| String::from("-"), |summary| estimate(of(summary)))
        }));
        table.rows.push(row);
    }
    table.markdown() + "\n"
}

fn counts(kinds: &[&Kind]) -> String {
    let mut table = Table::default();
    table
        .header
        .push(String::from("Runs [95 % interval of the share]"));
    table
        .header
        .extend(kinds.iter().map(|kind| kind.arm.clone()));
    let names = kinds
        .iter()
        .flat_map(|kind| kind.counts.iter().map(|counted| &counted.what));
    for name in in_order(names) {
        let mut row = vec![name.clone()];
        row.extend(kinds.iter().map(|kind| {
            let found = kind.counts.iter().find(|counted| counted.what == *name);
            found.map_or_else(
                || String::from("-"),
                |counted| format!("{} {}", count(counted.count), percent(counted.interval)),
            )
        }));
        table.rows.push(row);
    }
    table.markdown() + "\n"
}

fn structures(kinds: &[&Kind]) -> String {
    let mut text = String::from(
        "Most frequent final structures, children sorted, repeated primitive subtasks left out:\n\n",
    );
    for kind in kinds {
        for (structure, times) in &kind.structures {
            text += &format!("- {}: {times} of {}: `{structure}`\n", kind.arm, kind.n);
        }
    }
    text + "\n"
}

fn in_order<'n>(names: impl Iterator<Item = &'n String>) -> Vec<&'n String> {
    let mut once: Vec<&String> = Vec::new();
    for name in names {
        if !once.contains(&name) {
            once.push(name);
        }
    }
    once
}

fn estimate(estimate: Estimate) -> String {
    match estimate.interval {
        Some(Interval { low, high }) => {
            format!(
                "{} [{}, {}]",
                short(estimate.value),
                short(low),
                short(high)
            )
        }
        None => short(estimate.value),
    }
}

fn count(count: Count) -> String {
    format!("{} of {}", count.shown, count.n)
}

fn percent(Interval { low, high }: Interval) -> String {
    format!("[{:.0} %, {:.0} %]", 100.0 * low, 100.0 * high)
}
