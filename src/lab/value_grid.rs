//! Values of a finite world, laid out as its cells.

use serde::Serialize;

use super::learn::Learned;
use crate::random::{Purpose, stream};
use crate::worlds::scene::Scenic;

/// Values in the cells of a world, for one variant of its states.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ValueGrid {
    /// The variant, such as `from R to B`.
    pub case: String,
    /// The values learned by the first repeat, row by row from the top; `None` where the agent
    /// cannot be.
    pub learned: Vec<Vec<Option<f64>>>,
    /// The exact values.
    pub exact: Vec<Vec<Option<f64>>>,
}

/// Returns learned and exact values, one grid for each variant of the world; none where the world
/// has no cells.
pub fn value_grids<W: Scenic>(world: &W, learned: &Learned) -> Vec<ValueGrid> {
    let (Some(finite), Some([columns, rows])) = (world.mdp(), world.scenery().grid) else {
        return Vec::new();
    };
    let none = Vec::new();
    let values = learned
        .repeats
        .first()
        .map_or(&none, |course| &course.values);
    // A state of a finite world does not depend on the random stream.
    let mut rng = stream(0, 0, 0, Purpose::PolicyMap);
    let mut number = |variant, column: usize, row: usize| {
        let at = [column as f64 + 0.5, (rows - row) as f64 - 0.5];
        let state = world.state_at(at, 0.0, variant, &mut rng)?;
        let (state_type, percept) = (world.state_type(&state), world.percept(&state));
        finite
            .existing()
            .find(|(_, known)| {
                known.state_type == state_type && known.percept.as_ref() == percept.as_ref()
            })
            .map(|(number, _)| number)
    };
    let variants = world.variants().into_iter().enumerate();
    variants
        .map(|(variant, case)| {
            let cells: Vec<Vec<_>> = (0..rows)
                .map(|row| {
                    (0..columns)
                        .map(|column| number(variant, column, row))
                        .collect()
                })
                .collect();
            let of = |values: &[Option<f64>]| -> Vec<Vec<_>> {
                let value = |&number: &Option<usize>| *values.get(number?)?;
                cells
                    .iter()
                    .map(|row| row.iter().map(value).collect())
                    .collect()
            };
            ValueGrid {
                case,
                learned: of(values),
                exact: of(&learned.exact),
            }
        })
        .collect()
}
