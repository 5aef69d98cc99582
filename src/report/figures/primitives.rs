//! Figure 4.3: the action values of primitive subtasks against the one sensor reading that they
//! depend on.

use std::path::Path;

use super::{Chart, Series};
use crate::lab::{AnyExperiment, CHECKPOINT, Checkpoint, CheckpointError, SetupError, experiment};
use crate::learning::PrimitiveValues;
use crate::scenario::Scenario;
use crate::worlds::{Kind, Probe};

/// Number of points of a line.
const POINTS: usize = 121;

/// Returns a chart for every primitive subtask that depends on a single reading.
///
/// # Errors
/// When the experiment of the scenario cannot be built; the inner error when the checkpoint
/// cannot be used.
pub(super) fn action_values(
    scenario: &Scenario,
    folder: &Path,
) -> Result<Result<Vec<Chart>, String>, SetupError> {
    let experiment = experiment(scenario.clone(), 0)?;
    Ok(charts(&*experiment, folder))
}

fn charts(experiment: &dyn AnyExperiment, folder: &Path) -> Result<Vec<Chart>, String> {
    let wrong = |error: CheckpointError| format!("checkpoint.json: {error}");
    let checkpoint = Checkpoint::read(&folder.join(CHECKPOINT)).map_err(wrong)?;
    let checkpoint = checkpoint.ok_or("holds no checkpoint.json")?;
    let state = experiment.population(&checkpoint).map_err(wrong)?;
    let primitives = state.primitives.all().iter();
    Ok(primitives
        .filter_map(|primitive| chart(experiment, primitive))
        .collect())
}

fn chart(experiment: &dyn AnyExperiment, primitive: &PrimitiveValues) -> Option<Chart> {
    let catalogue = experiment.catalogue();
    let subtask = catalogue.subtask(primitive.subtask);
    let [axis] = catalogue.maps[subtask.map.index()].axes() else {
        return None;
    };
    let probes = experiment.probes(primitive.subtask);
    let (first, last) = (probes.first()?, probes.last()?);
    let (name, _) = first.readings.first()?;
    let input = |probe: &Probe<Vec<f32>>| probe.percept.get(axis.input).copied();
    let reading = |probe: &Probe<Vec<f32>>| probe.readings.first().map(|(_, value)| *value);
    let [from, to] = [
        (input(first)?, reading(first)?),
        (input(last)?, reading(last)?),
    ];
    let Kind::Primitive { actions, .. } = &subtask.kind else {
        return None;
    };
    let mut lines = vec![Vec::with_capacity(POINTS); actions.len()];
    let mut percept = first.percept.clone();
    for point in 0..POINTS {
        let share = point as f64 / (POINTS - 1) as f64;
        percept[axis.input] = from.0 + (to.0 - from.0) * share as f32;
        let x = from.1 + (to.1 - from.1) * share;
        let values = primitive.action_values(experiment.encoder(), &percept);
        for (line, value) in lines.iter_mut().zip(values) {
            line.push((x, f64::from(value)));
        }
    }
    let series = actions.iter().zip(lines).enumerate();
    Some(Chart {
        title: subtask.name.to_owned(),
        x: with_unit(name),
        y: String::from("action value Q"),
        y_range: None,
        series: series
            .map(|(index, (action, points))| Series {
                name: format!("action {} {action}", index + 1),
                points,
                band: Vec::new(),
                mark: index,
            })
            .collect(),
    })
}

/// Returns the axis label of a reading, whose name ends in its unit.
fn with_unit(name: &str) -> String {
    match name.rsplit_once('_') {
        Some((what, unit)) => format!("{} ({unit})", what.replace('_', " ")),
        None => name.to_owned(),
    }
}
