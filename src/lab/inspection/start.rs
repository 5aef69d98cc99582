//! A state to begin in, as a person writes it.

use thiserror::Error;

/// A state in which the trials of a rollout begin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Place of the agent in the world's unit.
    pub at: [f64; 2],
    /// Its heading in radians; of no account where agents have none.
    pub heading: f64,
    /// Index of one of the experiment's variants.
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
    /// Reads `VARIANT at X,Y` or `VARIANT at X,Y heading DEGREES`; whether the agent can be
    /// there is not checked.
    pub(in crate::lab) fn parse(text: &str, variants: &[String]) -> Option<Self> {
        let (case, rest) = text.split_once(" at ")?;
        let (place, degrees) = rest.split_once(" heading ").unwrap_or((rest, "0"));
        let (x, y) = place.split_once(',')?;
        let number = |text: &str| text.trim().parse().ok().filter(|n: &f64| n.is_finite());
        Some(Self {
            at: [number(x)?, number(y)?],
            heading: number(degrees)?.to_radians(),
            variant: variants.iter().position(|variant| variant == case.trim())?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_a_place_and_a_heading() {
        let variants = ["empty-handed", "carrying"].map(String::from);
        let read = |text| Start::parse(text, &variants);
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
