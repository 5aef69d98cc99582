//! A state to begin in, as a person writes it.

use thiserror::Error;

use super::Bench;

/// A state in which the trials of a rollout begin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Place of the agent in the world's unit.
    pub at: [f64; 2],
    /// Its heading in radians; of no account where agents have none.
    pub heading: f64,
    /// Index of one of the bench's variants.
    pub variant: usize,
}

/// A text that is no state to begin in.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error(
    "found {found:?}; allowed: CASE at X,Y with free room there, and 'heading DEGREES' after it \
     where agents have one; X and Y in {unit}, from 0 to {extent}; CASE one of {cases}"
)]
pub struct StartError {
    /// The text.
    pub found: String,
    /// The unit of lengths.
    pub unit: String,
    /// The largest X and Y.
    pub extent: String,
    /// What can be the case.
    pub cases: String,
}

impl Start {
    /// Reads `from R to B at 0,3` or `carrying at 500,1200 heading 90`: one of the
    /// bench's variants, the agent's place, and its heading in degrees.
    ///
    /// # Errors
    /// When it is none, or the agent cannot be there.
    pub fn read(text: &str, bench: &dyn Bench) -> Result<Self, StartError> {
        let start = parse(text, bench.variants()).filter(|start| bench.can_begin(*start));
        let scenery = bench.scenery();
        let [width, height] = scenery.extent;
        start.ok_or_else(|| StartError {
            found: text.to_owned(),
            unit: scenery.unit.clone(),
            extent: format!("{width},{height}"),
            cases: bench.variants().join(", "),
        })
    }
}

fn parse(text: &str, variants: &[String]) -> Option<Start> {
    let (case, rest) = text.split_once(" at ")?;
    let (place, degrees) = rest.split_once(" heading ").unwrap_or((rest, "0"));
    let (x, y) = place.split_once(',')?;
    let number = |text: &str| text.trim().parse().ok().filter(|n: &f64| n.is_finite());
    Some(Start {
        at: [number(x)?, number(y)?],
        heading: number(degrees)?.to_radians(),
        variant: variants.iter().position(|variant| variant == case.trim())?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_a_place_and_a_heading() {
        let variants = ["empty-handed", "carrying"].map(String::from);
        let read = |text| parse(text, &variants);
        let start = read("carrying at 500,1200.5 heading 180").unwrap();
        assert_eq!((start.at, start.variant), ([500.0, 1200.5], 1));
        assert_eq!(start.heading, std::f64::consts::PI);
        assert_eq!(read("empty-handed at 1, 2").unwrap().heading, 0.0);
        for wrong in [
            "",
            "carrying",
            "carrying at 1",
            "car at 1,2",
            "carrying at 1,inf",
        ] {
            assert_eq!(read(wrong), None, "{wrong}");
        }
    }
}
