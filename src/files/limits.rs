//! Limits of JSON texts, which hold before anything of them is parsed.

use super::json::JsonError;

/// What a file of one kind may hold at most. A text that keeps them cannot make the parser take
/// much more memory than it has bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes.
    pub bytes: u64,
    /// Lists and objects inside each other.
    pub depth: usize,
    /// Values, each list, object, text and number counted.
    pub values: usize,
}

impl Limits {
    /// Checks the depth of a JSON text and the number of its values. It takes no memory; whether the
    /// text is JSON at all is left to the parser.
    ///
    /// # Errors
    /// Fails at the first place beyond a limit.
    pub fn check(&self, text: impl AsRef<[u8]>) -> Result<(), JsonError> {
        let text = text.as_ref();
        let (mut depth, mut values) = (0_usize, 0);
        let mut in_text = false;
        let mut escaped = false;
        let mut between = true;
        for (at, &byte) in text.iter().enumerate() {
            if in_text {
                in_text = escaped || byte != b'"';
                escaped = !escaped && byte == b'\\';
                continue;
            }
            let is_end = matches!(byte, b',' | b':' | b'}' | b']') || byte.is_ascii_whitespace();
            values += usize::from(between && !is_end);
            between = is_end || matches!(byte, b'{' | b'[');
            match byte {
                b'"' => in_text = true,
                b'{' | b'[' => depth += 1,
                b'}' | b']' => depth = depth.saturating_sub(1),
                _ => {}
            }
            if depth > self.depth {
                let most = self.depth;
                let message = format!(
                    "found more than {most} lists and objects inside each other; allowed: at most \
                     {most}"
                );
                return Err(JsonError::in_text(text, at, message));
            }
            if values > self.values {
                let most = self.values;
                let message = format!("found more than {most} values; allowed: at most {most}");
                return Err(JsonError::in_text(text, at, message));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMALL: Limits = Limits {
        bytes: 1000,
        depth: 2,
        values: 5,
    };

    #[test]
    fn depth_and_values_are_counted_outside_of_texts() {
        // Names of fields count as values.
        SMALL
            .check(r#"{"a": [1, 2.5e-3], "b\"[[[[": null}"#)
            .unwrap_err();
        SMALL.check(r#"{"a[[[[,,,,": ["\\", true]}"#).unwrap();
        SMALL.check("[1, 2, 3, 4]").unwrap();
        let error = SMALL.check("[1,\n2, 3, 4, 5]").unwrap_err();
        assert_eq!(
            error.to_string(),
            "line 2, column 10, at the top level: found more than 5 values; allowed: at most 5"
        );
        let error = SMALL.check("[[[").unwrap_err();
        assert!(error.to_string().contains("inside each other"), "{error}");
        SMALL.check("[[],[]]]]] [").unwrap();
    }
}
