//! Where an individual comes from.

use std::fmt::Write;

use ratatui::text::Line;

use crate::dashboard::context::ViewContext;
use crate::dashboard::look::lines::Pen;
use crate::dashboard::look::{Paint, one_line, wrapped};
use crate::evolution::Origin;
use crate::lab::inspection::{Ancestor, Lineage};

/// The line along which the tree was handed down, the individual first.
///
/// ```text
///  362 generation 24   rank 1   128.6 steps a trial
///      340 at FindNest, with FindNest of 351
///      inherited Capture from 340, FindNest from 351   reset Root, Deliver
///  340 born in ...
/// ```
pub(super) fn lines(
    context: &ViewContext,
    lineage: &Lineage,
    columns: usize,
) -> Vec<Line<'static>> {
    let look = &context.look;
    let known = lineage.ancestors.len().saturating_sub(1);
    let note = format!("{known} ancestors in all; the line that the root came down:");
    let mut lines = vec![Pen::new(look).text(note, Paint::Dim).line()];
    let individuals = context.shown().map(|record| &record.individuals);
    let scored = individuals
        .and_then(|all| all.first())
        .map_or(1, |one| one.trials.len());
    for ancestor in lineage.line() {
        let head = format!(
            " generation {:>3}   rank {:>2}   {:.1} steps a trial",
            ancestor.born,
            ancestor.rank,
            ancestor.fitness_steps as f64 / scored.max(1) as f64
        );
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

/// How an individual was made, in words.
fn made(ancestor: &Ancestor) -> Vec<(String, Paint)> {
    let mut made = match &ancestor.origin {
        Origin::Crossover {
            receiver,
            donor,
            inherited,
            reset,
            ..
        } => {
            let given: Vec<_> = inherited
                .iter()
                .map(|part| format!("{} of {}", part.subtask, part.from))
                .collect();
            let given = match given.is_empty() {
                true => String::from("nothing"),
                false => given.join(", "),
            };
            vec![
                (
                    format!(
                        "{} with its {} replaced by {} of {}",
                        receiver.id, receiver.subtask, donor.subtask, donor.id
                    ),
                    Paint::Text,
                ),
                (format!("inherited {given}"), Paint::Text),
                (format!("reset {}", reset.join(", ")), Paint::Dim),
            ]
        }
        Origin::Copied { from, .. } => vec![(format!("a copy of {from}"), Paint::Text)],
        Origin::HandCoded => vec![(String::from("hand-coded"), Paint::Dim)],
        Origin::Random => vec![(String::from("drawn by chance"), Paint::Dim)],
        Origin::Reproduced => vec![(
            String::from("reproduced; older records are lost"),
            Paint::Bad,
        )],
    };
    let mutations = ancestor.origin.mutations().iter();
    made.extend(mutations.map(|mutation| (format!("mutation: {mutation}"), Paint::Notice)));
    made
}

/// All ancestors as a table.
pub(super) fn csv(lineage: &Lineage) -> String {
    let mut csv = String::from("id,born,last_seen,rank,fitness_steps,receiver,donor,tree\n");
    for ancestor in lineage.ancestors.values() {
        let parents = ancestor.parents();
        let parent = |index: usize| parents.get(index).map_or(String::new(), u64::to_string);
        // Writing to a string cannot fail.
        let _ = writeln!(
            csv,
            "{},{},{},{},{},{},{},{}",
            ancestor.id,
            ancestor.born,
            ancestor.last_seen,
            ancestor.rank,
            ancestor.fitness_steps,
            parent(0),
            parent(1),
            ancestor.tree
        );
    }
    csv
}

/// All ancestors as a Graphviz graph: solid from the receiver, dashed from the donor.
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
