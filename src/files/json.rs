//! JSON texts: parsed with the place of every error.

use serde::Deserialize;
use thiserror::Error;

use crate::words::{plain, shortened};

/// Returns the version in the `format` field of a JSON text, if it has one.
///
/// It is checked before anything else: other fields have other meanings in other formats.
#[must_use]
pub fn stated_format(text: &str) -> Option<u32> {
    #[derive(Deserialize)]
    struct AnyFormat {
        format: u32,
    }
    let any: AnyFormat = serde_json::from_str(text).ok()?;
    Some(any.format)
}

/// An error in a JSON text.
#[derive(Debug, Error)]
#[error("line {line}, column {column}, at {place}: {message}")]
pub struct JsonError {
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1.
    pub column: usize,
    /// Dotted path of the wrong value.
    pub place: String,
    /// What was found, and what was expected.
    pub message: String,
}

const TOP: &str = "the top level";

impl JsonError {
    /// Returns the same error for a value that is the part `name` of another.
    #[must_use]
    pub fn within(self, name: &str) -> Self {
        let place = match self.place.as_str() {
            TOP => name.to_owned(),
            place => format!("{name}.{place}"),
        };
        Self { place, ..self }
    }

    /// The error of a text at the byte `at`, outside of any field.
    pub(super) fn in_text(text: &[u8], at: usize, message: String) -> Self {
        let before = text.get(..at).unwrap_or_default();
        let is_end = |byte: &&u8| **byte == b'\n';
        let line_start = before.rsplit(|&byte| byte == b'\n').next();
        Self {
            line: before.iter().filter(is_end).count() + 1,
            column: line_start.map_or(0, <[u8]>::len) + 1,
            place: String::from(TOP),
            message,
        }
    }

    fn at(place: String, error: &serde_json::Error) -> Self {
        let (line, column) = (error.line(), error.column());
        Self {
            line,
            column,
            place,
            message: message(error),
        }
    }
}

/// Returns what is wrong with a JSON text, without the place.
#[must_use]
pub fn message(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let suffix = format!(" at line {} column {}", error.line(), error.column());
    plain(text.strip_suffix(&suffix).unwrap_or(&text))
}

/// Parses a JSON text of exactly one value.
///
/// # Errors
/// Fails with the place if the text is not JSON of the type.
pub fn parse_json<'t, T: Deserialize<'t>>(text: &'t str) -> Result<T, JsonError> {
    let mut json = serde_json::Deserializer::from_str(text);
    let value = serde_path_to_error::deserialize(&mut json).map_err(|error| {
        let place = match error.path().to_string().as_str() {
            // `?` is a key or value that could not be read.
            "." | "?" => String::from(TOP),
            path => shortened(path.strip_suffix(".?").unwrap_or(path)),
        };
        JsonError::at(place, error.inner())
    })?;
    let end = json.end();
    end.map_err(|error| JsonError::at(String::from("the end of the file"), &error))?;
    Ok(value)
}

#[cfg(test)]
mod tests {
    use super::parse_json;

    #[test]
    fn json_errors_say_once_where_they_are() {
        #[derive(Debug, serde::Deserialize)]
        struct Any {
            #[expect(dead_code, reason = "only read")]
            list: Vec<u8>,
        }
        let says = |text| parse_json::<Any>(text).unwrap_err().to_string();
        let eof = "line 1, column 0, at the top level: the text ends before a value";
        assert_eq!(says(""), eof);
        let number = says("{\"list\":\n[1,-2]}");
        assert!(
            number.starts_with(
                "line 2, column 5, at list[1]: found -2; allowed: a whole number from 0 to 255"
            ),
            "{number}"
        );
        assert_eq!(number.matches("line").count(), 1, "{number}");
        let more = says("{\"list\":[]} x");
        assert!(
            more.contains("at the end of the file: trailing characters"),
            "{more}"
        );
    }
}
