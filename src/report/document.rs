//! The report of a study as Markdown.

use super::claims::Verdict;
use super::findings::{Comparison, Findings, JudgedClaim, MetricSummary, RunGroup};
use super::statistics::{Count, Estimate, Interval, RESAMPLES};
use super::table::{Table, p_value, short};

/// Returns the report.
#[must_use]
pub fn markdown(findings: &Findings) -> String {
    let provenance = &findings.provenance;
    let mut text = format!("# Study {}\n\n{}.\n\n", provenance.study, provenance.line());
    text += &claims(&findings.claims);
    text += &comparisons(&findings.comparisons);
    for groups in findings.groups.chunk_by(|a, b| a.scenario == b.scenario) {
        text += &format!("## {}\n\n", groups[0].scenario);
        text += &metrics("Interquartile mean [95 % interval]", groups, |m| m.iqm);
        text += &metrics("Mean [95 % interval]", groups, |m| m.mean);
        text += &counts(groups);
        text += &structures(groups);
    }
    text
}

fn claims(claims: &[JudgedClaim]) -> String {
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
            or_dash(judged.control, count),
            or_dash(judged.p, p_value),
            judged
                .verdict
                .map_or("no control", Verdict::words)
                .to_owned(),
        ]);
    }
    format!(
        "## Claims\n\nThe unit of observation is the seed. Brackets hold the exact 95 % interval of the \
         proportion of seeds that show a claim, and p is the two-sided p-value of Fisher's exact test \
         against the control. A claim *holds* if most seeds show it (the interval lies above one half) \
         and significantly more than under the control (p < 0.05). It is *explained by drift alone* if \
         most seeds show it, and most seeds of the control too, without a significant difference. It \
         *does not hold* if most seeds do not show it (the interval lies below one half), or \
         significantly fewer than under the control. Otherwise it is *undecided at this n*. A claim \
         that compares scenarios is judged within each seed; for the control, runs of different seeds \
         are compared, because without selection a seed leads to the same structures in every \
         scenario. The table has {} tests and no correction for multiple testing: of the tests without a \
         real difference, about one in twenty is significant.\n\n{}\n",
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
            or_dash(row.difference_iqm, estimate),
            or_dash(row.difference_mean, estimate),
            estimate(row.improvement),
            or_dash(row.p, p_value),
        ]);
    }
    format!(
        "## Comparison of arms\n\nArms are compared by the mean trial length of the winners' structures, \
         evaluated with new hierarchies, newly trained primitive subtasks and new trials. Differences \
         are in time steps, paired by seed, and negative if the arm is faster than the one it is \
         compared with. The probability of improvement is the probability that a winner of the arm is \
         faster. Brackets hold percentile-bootstrap 95 % intervals from {RESAMPLES} resamples of the \
         seeds, stratified by scenario in the rows *all*. p is the two-sided p-value of the \
         Mann-Whitney test.\n\n{}\n",
        table.markdown()
    )
}

/// Returns a table with one row for each metric and one column for each arm.
fn metrics(title: &str, groups: &[RunGroup], of: fn(&MetricSummary) -> Estimate) -> String {
    let columns = groups
        .iter()
        .map(|group| format!("{} (n = {})", group.arm, group.n));
    let rows = groups.iter().map(|group| {
        let cells = group.metrics.iter();
        cells
            .map(|summary| (summary.metric.replace('_', " "), estimate(of(summary))))
            .collect()
    });
    by_arm(title, columns, rows.collect())
}

/// Returns a table with one row for each trait and one column for each arm.
fn counts(groups: &[RunGroup]) -> String {
    let columns = groups.iter().map(|group| group.arm.clone());
    let rows = groups.iter().map(|group| {
        let cells = group.counts.iter().map(|counted| {
            let share = percent(counted.interval);
            (
                counted.what.clone(),
                format!("{} {share}", count(counted.count)),
            )
        });
        cells.collect()
    });
    by_arm(
        "Runs [95 % interval of the proportion]",
        columns,
        rows.collect(),
    )
}

/// Returns a table with one column for each arm. `cells` holds the named cells of each column;
/// a name that a column does not have gets a dash.
fn by_arm(
    title: &str,
    columns: impl Iterator<Item = String>,
    cells: Vec<Vec<(String, String)>>,
) -> String {
    let mut table = Table::new(&[title]);
    table.header.extend(columns);
    let mut names: Vec<&String> = Vec::new();
    for (name, _) in cells.iter().flatten() {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    for name in names {
        let mut row = vec![name.clone()];
        row.extend(cells.iter().map(|column| {
            let found = column.iter().find(|(other, _)| other == name);
            or_dash(found, |(_, cell)| cell.clone())
        }));
        table.rows.push(row);
    }
    table.markdown() + "\n"
}

fn structures(groups: &[RunGroup]) -> String {
    let mut text = String::from(
        "The most frequent final structures, with children sorted and repeated primitive subtasks \
         left out:\n\n",
    );
    for group in groups {
        for (structure, times) in &group.structures {
            text += &format!("- {}: {times} of {}: `{structure}`\n", group.arm, group.n);
        }
    }
    text + "\n"
}

fn or_dash<T>(value: Option<T>, show: impl Fn(T) -> String) -> String {
    value.map_or_else(|| String::from("-"), show)
}

fn estimate(estimate: Estimate) -> String {
    let value = short(estimate.value);
    match estimate.interval {
        Some(Interval { low, high }) => format!("{value} [{}, {}]", short(low), short(high)),
        None => value,
    }
}

fn count(count: Count) -> String {
    format!("{} of {}", count.shown, count.n)
}

fn percent(Interval { low, high }: Interval) -> String {
    format!("[{:.0} %, {:.0} %]", 100.0 * low, 100.0 * high)
}
