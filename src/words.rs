//! Words of messages: what was found is quoted in a line at most, the parser's errors are told in
//! plain words, and commands can be copied into a shell.

use std::path::Path;

/// Longest quote in a message, in characters.
const LONGEST_QUOTE: usize = 60;

/// Longest error of a parser that is told as it is, in characters.
const LONGEST_ERROR: usize = 200;

/// Returns the text as a message quotes it: at most sixty characters of its first line. A long
/// number is written with an exponent, so that its size can still be seen.
#[must_use]
pub fn shortened(text: &str) -> String {
    if text.chars().count() > LONGEST_QUOTE
        && let Ok(number) = text.parse::<f64>()
    {
        return format!("{number:e}");
    }
    cut(text.lines().next().unwrap_or_default(), text, LONGEST_QUOTE)
}

/// Returns `part`, which is the beginning of `whole`, with at most `longest` characters; three dots
/// stand for what is left out.
fn cut(part: &str, whole: &str, longest: usize) -> String {
    if part.len() == whole.trim_end_matches('\n').len() && part.chars().count() <= longest {
        return part.to_owned();
    }
    let start = part.chars().take(longest - 3);
    start.chain("...".chars()).collect()
}

/// Returns the text in quotation marks, shortened as [`shortened`] does.
#[must_use]
pub fn quoted(text: &str) -> String {
    format!("{:?}", shortened(text))
}

/// Escapes control characters other than line breaks: text from files must not control a terminal.
#[must_use]
pub fn visible(text: &str) -> String {
    let shown = |c: char| match c {
        '\n' => vec!['\n'],
        c if c.is_control() => c.escape_unicode().collect(),
        c => vec![c],
    };
    text.chars().flat_map(shown).collect()
}

/// Returns a word of a shell command line, quoted if necessary. Control characters are escaped in
/// the syntax of bash and zsh.
#[must_use]
pub fn shell_word(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:@%+,".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    if !word.contains(char::is_control) {
        return format!("'{}'", word.replace('\'', r"'\''"));
    }
    let escaped = word.chars().map(|c| match c {
        '\'' | '\\' => format!("\\{c}"),
        c if c.is_control() => format!("\\u{:04x}", u32::from(c)),
        c => c.to_string(),
    });
    format!("$'{}'", escaped.collect::<String>())
}

/// Returns a path as a word of a shell command line.
#[must_use]
pub fn shell_path(path: impl AsRef<Path>) -> String {
    shell_word(&path.as_ref().display().to_string())
}

/// Returns the error of a parser in the words of this program: `found X; allowed: Y` where the
/// parser says both.
#[must_use]
pub fn plain(error: &str) -> String {
    const WHOLE: [(&str, &str); 6] = [
        (
            "expected value",
            "found no JSON value; allowed: a number, text in quotation marks, true, false, null, \
             a list in [] or an object in {}",
        ),
        (
            "number out of range",
            "found a number that is too large; allowed: -1.79e308 to 1.79e308",
        ),
        ("EOF while parsing a value", "the text ends before a value"),
        (
            "EOF while parsing an object",
            "the text ends inside an object",
        ),
        ("EOF while parsing a list", "the text ends inside a list"),
        (
            "EOF while parsing a string",
            "the text ends inside quotation marks",
        ),
    ];
    if let Some((_, words)) = WHOLE.iter().find(|(theirs, _)| *theirs == error) {
        return (*words).to_owned();
    }
    let wrong = ["invalid type: ", "invalid value: ", "invalid "];
    let wrong = wrong.iter().find_map(|start| error.strip_prefix(start));
    if let Some((found, expected)) = wrong.and_then(|wrong| wrong.rsplit_once(", expected ")) {
        return format!("found {}; allowed: {}", value(found), kind(expected));
    }
    if let Some((name, known)) = unknown(error, "unknown field `") {
        return format!("found the unknown field {}; {known}", quoted(name));
    }
    if let Some((name, known)) = unknown(error, "unknown variant `") {
        return format!("found {}; {known}", quoted(name));
    }
    cut(error, error, LONGEST_ERROR)
}

/// Splits the error of a name that the parser does not know.
fn unknown<'e>(error: &'e str, start: &str) -> Option<(&'e str, String)> {
    let rest = error.strip_prefix(start)?;
    if let Some((name, known)) = rest.rsplit_once("`, expected ") {
        let known = known.strip_prefix("one of ").unwrap_or(known);
        let known = known.replace('`', "").replace(" or ", ", ");
        return Some((name, format!("allowed: {known}")));
    }
    let (name, _) = rest.rsplit_once("`, there are no ")?;
    Some((name, String::from("allowed: none")))
}

/// A choice that is a name and no more.
const NAME_ALONE: &str = "the name alone";
/// A choice that has a value.
const NAME_WITH_VALUE: &str = "the name with its value, as in {\"name\": value}";

/// Returns the parser's words for a value that was found in plain words.
fn value(found: &str) -> String {
    for kind in ["integer `", "floating point `", "boolean `"] {
        if let Some(number) = found.strip_prefix(kind) {
            return shortened(number.trim_end_matches('`'));
        }
    }
    if let Some(text) = found.strip_prefix("string \"") {
        return format!("\"{}\"", shortened(text.strip_suffix('"').unwrap_or(text)));
    }
    match found {
        "map" => String::from("an object"),
        "sequence" => String::from("a list"),
        "unit variant" => String::from(NAME_ALONE),
        "newtype variant" => String::from(NAME_WITH_VALUE),
        _ => match found.strip_prefix("length ") {
            Some(length) => format!("a list of {}", shortened(length)),
            None => shortened(found),
        },
    }
}

/// Returns the parser's words for what it expected in plain words.
fn kind(expected: &str) -> String {
    let whole = |least: i64, most: u64| format!("a whole number from {least} to {most}");
    match expected {
        "u8" => whole(0, u8::MAX.into()),
        "u16" => whole(0, u16::MAX.into()),
        "u32" => whole(0, u32::MAX.into()),
        "u64" => whole(0, u64::MAX),
        "usize" => whole(0, usize::MAX as u64),
        "f32" | "f64" => String::from("a number"),
        "a boolean" => String::from("true or false"),
        "a string" => String::from("text"),
        "a sequence" => String::from("a list"),
        "a map" => String::from("an object"),
        "unit variant" => String::from(NAME_ALONE),
        "newtype variant" => String::from(NAME_WITH_VALUE),
        _ if expected.starts_with("struct ") => String::from("an object"),
        _ => match expected.strip_prefix("an array of length ") {
            Some(length) => format!("a list of {length}"),
            None => shortened(expected),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_survive_the_shell() {
        assert_eq!(shell_word("studies/thesis"), "studies/thesis");
        assert_eq!(shell_word("my study"), "'my study'");
        assert_eq!(shell_word("it's"), r"'it'\''s'");
        assert_eq!(shell_word(""), "''");
        assert_eq!(shell_word("a\nb's"), r"$'a\u000ab\'s'");
    }

    #[test]
    fn quotes_are_a_line_at_most() {
        assert_eq!(shortened("short"), "short");
        assert_eq!(shortened("one\n"), "one");
        assert_eq!(shortened("one\ntwo"), "one...");
        assert_eq!(shortened(&"é".repeat(60)), "é".repeat(60));
        assert_eq!(shortened(&"é".repeat(61)), "é".repeat(57) + "...");
        assert_eq!(shortened(&format!("1{}", "0".repeat(299))), "1e299");
    }

    #[test]
    fn errors_of_the_parser_name_the_range() {
        assert_eq!(
            plain("invalid type: string \"six\", expected u32"),
            "found \"six\"; allowed: a whole number from 0 to 4294967295"
        );
        assert_eq!(
            plain("invalid value: integer `-6`, expected u8"),
            "found -6; allowed: a whole number from 0 to 255"
        );
        assert_eq!(
            plain("invalid length 3, expected an array of length 2"),
            "found a list of 3; allowed: a list of 2"
        );
        assert_eq!(
            plain("unknown field `sise`, expected one of `size`, `name`"),
            "found the unknown field \"sise\"; allowed: size, name"
        );
        assert_eq!(
            plain("unknown variant `a`, expected `b` or `c`"),
            "found \"a\"; allowed: b, c"
        );
        assert_eq!(
            plain("invalid type: unit variant, expected newtype variant"),
            "found the name alone; allowed: the name with its value, as in {\"name\": value}"
        );
        let long = format!(
            "invalid type: string {:?}, expected f64",
            "x".repeat(10_000)
        );
        assert!(plain(&long).len() < 100, "{}", plain(&long));
        assert!(plain(&"x".repeat(10_000)).len() <= LONGEST_ERROR);
    }
}
