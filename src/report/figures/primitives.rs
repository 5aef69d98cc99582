//! Figure 4.3: what the primitive subtasks have learned, over the one reading that they
//! look at.

use std::path::Path;

use super::{Chart, Series};
use crate::evolution::Experiment;
use crate::lab::{Checkpoint, CheckpointError, SetupError, WorldTask, with_world};
use crate::learning::PrimitiveValues;
use crate::scenario::Scenario;
use crate::worlds::{Kind, Probe, World};

/// Points of a line.
const POINTS: usize = 121;

/// A chart for every primitive subtask that looks at a single reading.
///
/// # Errors
/// When the scenario cannot be made ready.
pub(super) fn action_values(
    scenario: &Scenario,
    folder: &Path,
) -> Result<Result<Vec<Chart>, String>, SetupError> {
    with_world(scenario.clone(), OfCheckpoint(folder))
}

struct OfCheckpoint<'f>(&'f Path);

impl WorldTask for OfCheckpoint<'_> {
    type Output = Result<Vec<Chart>, String>;

    fn carry_out<W: World + 'static>(self, experiment: Experiment<W>) -> Self::Output {
        let wrong = |error: CheckpointError| format!("checkpoint.json: {error}");
        let checkpoint = Checkpoint::read(&self.0.join("checkpoint.json")).map_err(wrong)?;
        let checkpoint = checkpoint.ok_or("holds no checkpoint.json")?;
        let state = checkpoint.state(&experiment).map_err(wrong)?;
        let charts = state
            .primitives
            .all()
            .iter()
            .filter_map(|primitive| chart(&experiment, primitive));
        Ok(charts.collect())
    }
}

fn chart<W: World>(experiment: &Experiment<W>, primitive: &PrimitiveValues) -> Option<Chart> {
    let catalogue = experiment.catalogue();
    let subtask = catalogue.subtask(primitive.subtask);
    let [axis] = catalogue.maps[subtask.map.index()].axes() else {
        return None;
    };
    let probes = experiment.world.probes(primitive.subtask);
    let (first, last) = (probes.first()?, probes.last()?);
    let (name, _) = first.readings.first()?;
    let input = |probe: &Probe<W::Percept>| probe.percept.as_ref().get(axis.input).copied();
    let reading = |probe: &Probe<W::Percept>| probe.readings.first().map(|(_, value)| *value);
    let [from, to] = [
        (input(first)?, reading(first)?),
        (input(last)?, reading(last)?),
    ];
    let Kind::Primitive { actions } = &subtask.kind else {
        return None;
    };
    let mut lines = vec![Vec::with_capacity(POINTS); actions.len()];
    let mut percept = first.percept.as_ref().to_vec();
    for point in 0..POINTS {
        let share = point as f64 / (POINTS - 1) as f64;
        percept[axis.input] = from.0 + (to.0 - from.0) * share as f32;
        let x = from.1 + (to.1 - from.1) * share;
        let values = primitive.action_values(&experiment.encoder, &percept);
        for (line, value) in lines.iter_mut().zip(values) {
            line.push((x, f64::from(value)));
        }
    }
    let series = actions.iter().zip(lines).enumerate();
    Some(Chart {
        title: subtask.name.to_owned(),
        x: with_unit(name),
        y: String::from("action value Q"),
        whole: None,
        series: series
            .map(|(index, (action, points))| Series {
                name: format!("action {} {action}", index + 1),
                points,
                mark: index,
            })
            .collect(),
    })
}

/// A reading as it stands at an axis; its name ends in its unit.
fn with_unit(name: &str) -> String {
    match name.rsplit_once('_') {
        Some((what, unit)) => format!("{} ({unit})", what.replace('_', " ")),
        None => name.to_owned(),
    }
}
