//! The lineage page: how an individual came about.

use std::fmt::Write;

use ratatui::text::Line;

use crate::dashboard::context::ViewContext;
use crate::dashboard::look::lines::Pen;
use crate::dashboard::look::{Paint, one_line, wrapped};
use crate::dashboard::views::shared::{csv_line, line, origin_lines};
use crate::evolution::Origin;
use crate::lab::inspection::{Ancestor, Lineage};

/// Lists the line along which the root was handed down, the individual first.
///
/// ```text
///  362 generation  24   rank  1   128.6 steps per trial
///      340 with its FindNest replaced by FindNest of 351
///      inherited FindBattery from 340, FindNest from 351
///      reset Root, Deliver
///  340 generation  22   ...
/// ```
pub(super) fn lines(
    context: &ViewContext,
    lineage: &Lineage,
    columns: usize,
) -> Vec<Line<'static>> {
    let look = &context.look;
    let known = lineage.ancestors.len().saturating_sub(1);
    let note = format!("{known} ancestors; line of descent:");
    let mut lines = vec![line(look, note, Paint::Dim)];
    let individuals = context.shown().map(|record| &record.individuals);
    let trials = individuals
        .and_then(|all| all.first())
        .map_or(1, |one| one.scored());
    for ancestor in lineage.line() {
        let steps = ancestor.fitness_steps as f64 / trials.max(1) as f64;
        let (born, rank) = (ancestor.born, ancestor.rank);
        let head = format!(" generation {born:>3}   rank {rank:>2}   {steps:.1} steps per trial");
        let pen = Pen::new(look).right(&ancestor.id.to_string(), 5, Paint::Title);
        lines.push(pen.text(head, Paint::Text).line());
        for (text, paint) in made(ancestor) {
            let texts = wrapped(&one_line(&text), columns.saturating_sub(6), "  ");
            let texts = texts.into_iter();
            lines.extend(texts.map(|text| Pen::new(look).to(6).text(text, paint).line()));
        }
    }
    lines
}

/// Tells how an individual was made.
///
/// An ancestor is reproduced only where the records of earlier generations are missing.
fn made(ancestor: &Ancestor) -> Vec<(String, Paint)> {
    match ancestor.origin {
        Origin::Reproduced => {
            let text = String::from("reproduced; earlier records are missing");
            vec![(text, Paint::Bad)]
        }
        _ => origin_lines(&ancestor.origin, Paint::Dim),
    }
}

/// Writes all ancestors as CSV.
pub(super) fn csv(lineage: &Lineage) -> String {
    let mut csv = String::from("id,born,last_seen,rank,fitness_steps,receiver,donor,tree\n");
    for ancestor in lineage.ancestors.values() {
        let parents = ancestor.parents();
        let parent = |index: usize| parents.get(index).map_or(String::new(), u64::to_string);
        csv_line(
            &mut csv,
            &[
                &ancestor.id,
                &ancestor.born,
                &ancestor.last_seen,
                &ancestor.rank,
                &ancestor.fitness_steps,
                &parent(0),
                &parent(1),
                &ancestor.tree,
            ],
        );
    }
    csv
}

/// Writes all ancestors as a Graphviz graph, with edges solid from the receiver, dashed from the donor.
pub(super) fn dot(lineage: &Lineage) -> String {
    let mut dot = String::from("digraph lineage {\n  node [shape=box, fontname=\"Helvetica\"];\n");
    for ancestor in lineage.ancestors.values() {
        let (id, born, rank) = (ancestor.id, ancestor.born, ancestor.rank);
        // Writing to a string cannot fail.
        let _ = writeln!(
            dot,
            "  n{id} [label=\"{id}\\ngeneration {born}, rank {rank}\"];"
        );
        for (parent, style) in ancestor.parents().iter().zip(["solid", "dashed"]) {
            let _ = writeln!(dot, "  n{parent} -> n{id} [style={style}];");
        }
    }
    dot.push_str("}\n");
    dot
}
