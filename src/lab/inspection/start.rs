//! The state in which the trials of a rollout begin, as it is written on the command line.

use thiserror::Error;

use crate::words::quoted;

/// A state in which the trials of a rollout begin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Place of the agent, in the world's unit of length.
    pub at: [f64; 2],
    /// Heading of the agent in radians; ignored in worlds without headings.
    pub heading: f64,
    /// Index into [`AnyExperiment::variants`](crate::lab::AnyExperiment::variants).
    pub variant: usize,
}

/// The error for a text that is not such a state.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error(
    "found {}; allowed: CASE at X,Y where the agent has room, followed by 'heading DEGREES' \
     if agents have headings; X and Y in {unit}, from 0 to {extent}; CASE one of {cases}",
    quoted(.found)
)]
pub struct StartError {
    /// The text.
    pub found: String,
    /// The unit of lengths.
    pub unit: String,
    /// The largest X and Y.
    pub extent: String,
    /// The variants, separated by commas.
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
