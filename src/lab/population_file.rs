//! Primitive subtasks and individuals in a checkpoint file, and their conversion.

use serde::{Deserialize, Serialize};

use super::checkpoint_error::CheckpointError;
use crate::evolution::{Individual, Origin, TreeError, read_tree};
use crate::hierarchy::to_text;
use crate::learning::{CompositeValues, Hierarchy, PrimitiveSet, PrimitiveValues};
use crate::scenario::{LearningSettings, PrimitiveLearning, Scenario};
use crate::worlds::{Catalogue, SubtaskId};

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PrimitiveFile {
    subtask: String,
    /// Parameters of Q_prim, one vector for each action.
    actions: Vec<Vec<f32>>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct IndividualFile {
    id: u64,
    origin: Origin,
    tree: String,
    /// The composite subtasks in preorder.
    composites: Vec<CompositeFile>,
    /// Its primitive subtasks, if each individual has its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    primitives: Option<Vec<PrimitiveFile>>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CompositeFile {
    subtask: String,
    temperature: f32,
    children: Vec<ChildFile>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ChildFile {
    subtask: String,
    /// Parameters of C~, block after block of features.
    c_tilde: Vec<f32>,
    /// Parameters of C.
    c: Vec<f32>,
}

impl PrimitiveFile {
    pub(super) fn of(primitive: &PrimitiveValues, catalogue: &Catalogue) -> Self {
        Self {
            subtask: primitive.subtask.name(catalogue).to_owned(),
            actions: primitive.vectors().map(<[f32]>::to_vec).collect(),
        }
    }

    pub(super) fn primitive(
        &self,
        place: &str,
        catalogue: &Catalogue,
    ) -> Result<PrimitiveValues, CheckpointError> {
        let subtask = catalogue.find(&self.subtask).ok_or_else(|| {
            CheckpointError::misfit(place, format!("found subtask {:?}", self.subtask))
        })?;
        PrimitiveValues::from_vectors(subtask, catalogue, &self.actions).ok_or_else(|| {
            let width = catalogue.width(subtask);
            let actions = catalogue.subtask(subtask).actions();
            CheckpointError::misfit(
                place,
                format!("allowed: {actions} vectors of {width} numbers"),
            )
        })
    }
}

impl IndividualFile {
    pub(super) fn of(individual: &Individual, catalogue: &Catalogue) -> Self {
        let tree = individual.hierarchy.tree();
        let nodes = individual.hierarchy.values().iter().enumerate();
        let composites: Vec<_> = nodes
            .filter_map(|(node, values)| values.as_ref().map(|values| (node, values)))
            .map(|(node, values)| CompositeFile {
                subtask: tree.subtask(node).name(catalogue).to_owned(),
                temperature: values.temperature,
                children: tree
                    .children(node)
                    .zip(values.vectors())
                    .map(|(child, [c_tilde, c])| ChildFile {
                        subtask: tree.subtask(child).name(catalogue).to_owned(),
                        c_tilde,
                        c,
                    })
                    .collect(),
            })
            .collect();
        let primitives = individual.primitives.as_ref().map(|primitives| -> Vec<_> {
            let primitives = primitives.all().iter();
            primitives
                .map(|primitive| PrimitiveFile::of(primitive, catalogue))
                .collect()
        });
        Self {
            id: individual.id,
            origin: individual.origin.clone(),
            tree: to_text(tree, catalogue),
            composites,
            primitives,
        }
    }

    pub(super) fn individual(
        &self,
        place: &str,
        catalogue: &Catalogue,
        scenario: &Scenario,
    ) -> Result<Individual, CheckpointError> {
        let tree = read_tree(&self.tree, catalogue, scenario.evolution.maximum_depth).map_err(
            |error: TreeError| CheckpointError::misfit(&format!("{place}.tree"), error.to_string()),
        )?;
        let mut files = self.composites.iter();
        let mut values = Vec::with_capacity(tree.nodes().len());
        for node in 0..tree.nodes().len() {
            let subtask = tree.subtask(node);
            if !catalogue.subtask(subtask).is_composite() {
                values.push(None);
                continue;
            }
            let name = subtask.name(catalogue);
            let children = tree
                .children(node)
                .map(|child| tree.subtask(child).name(catalogue));
            let file = files.next().filter(|file| {
                let listed = file.children.iter().map(|child| child.subtask.as_str());
                file.subtask == name && listed.eq(children)
            });
            let place = format!("{place}.composites ({name})");
            let file = file.ok_or_else(|| {
                CheckpointError::misfit(
                    &place,
                    String::from(
                        "allowed: the composites of the tree and their children, in order",
                    ),
                )
            })?;
            check_temperature(&place, file.temperature, &scenario.learning)?;
            let children: Vec<_> = tree.children(node).map(|c| tree.subtask(c)).collect();
            values.push(Some(
                file.values(subtask, &children, catalogue).ok_or_else(|| {
                    CheckpointError::misfit(&place, allowed_widths(subtask, &children, catalogue))
                })?,
            ));
        }
        let extra = files.next().is_some();
        let hierarchy = Hierarchy::from_parts(tree, values).filter(|_| !extra);
        let hierarchy = hierarchy.ok_or_else(|| {
            CheckpointError::misfit(
                place,
                String::from("allowed: one entry in composites for each composite of the tree"),
            )
        })?;
        Ok(Individual {
            id: self.id,
            origin: self.origin.clone(),
            hierarchy,
            primitives: self.primitives(place, catalogue, &scenario.learning)?,
        })
    }

    fn primitives(
        &self,
        place: &str,
        catalogue: &Catalogue,
        learning: &LearningSettings,
    ) -> Result<Option<PrimitiveSet>, CheckpointError> {
        let place = format!("{place}.primitives");
        let own = learning.primitive_learning == PrimitiveLearning::Individual;
        match &self.primitives {
            Some(files) if own => primitives(files, &place, catalogue).map(Some),
            None => Ok(None),
            Some(_) => Err(CheckpointError::misfit(
                &place,
                String::from("allowed: only with primitive_learning individual"),
            )),
        }
    }
}

/// Returns the primitive subtasks that a file lists.
pub(super) fn primitives(
    files: &[PrimitiveFile],
    place: &str,
    catalogue: &Catalogue,
) -> Result<PrimitiveSet, CheckpointError> {
    let all = files.iter().enumerate();
    let all = all.map(|(index, file)| file.primitive(&format!("{place}[{index}]"), catalogue));
    PrimitiveSet::new(all.collect::<Result<_, _>>()?, catalogue).ok_or_else(|| {
        CheckpointError::misfit(
            place,
            String::from("allowed: each primitive subtask once, in order"),
        )
    })
}

fn allowed_widths(subtask: SubtaskId, children: &[SubtaskId], catalogue: &Catalogue) -> String {
    let width = |&child: &SubtaskId| catalogue.completion_width(subtask, child);
    let mut widths: Vec<_> = children.iter().map(width).map(|w| w.to_string()).collect();
    if widths.iter().all(|width| *width == widths[0]) {
        widths.truncate(1);
    }
    match &widths[..] {
        [same] => format!("allowed: {same} numbers in c_tilde and in c"),
        each => format!(
            "allowed: {} numbers in c_tilde and in c of the children",
            each.join(", ")
        ),
    }
}

impl CompositeFile {
    fn values(
        &self,
        subtask: SubtaskId,
        children: &[SubtaskId],
        catalogue: &Catalogue,
    ) -> Option<CompositeValues> {
        let vectors: Vec<_> = self
            .children
            .iter()
            .map(|child| [child.c_tilde.clone(), child.c.clone()])
            .collect();
        CompositeValues::from_vectors(subtask, children, catalogue, self.temperature, &vectors)
    }
}

/// Checks that a temperature lies between its limit and its initial value.
fn check_temperature(
    place: &str,
    found: f32,
    learning: &LearningSettings,
) -> Result<(), CheckpointError> {
    let (limit, initial) = (
        learning.temperature_limit as f32,
        learning.initial_temperature as f32,
    );
    match (limit..=initial).contains(&found) {
        true => Ok(()),
        false => Err(CheckpointError::misfit(
            place,
            format!("temperature: found {found}; allowed: {limit} to {initial}"),
        )),
    }
}
