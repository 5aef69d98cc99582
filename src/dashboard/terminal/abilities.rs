//! What a type of terminal can show.

/// What a terminal can show, as far as the name of its type (`TERM`) tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Abilities {
    /// Whether its font has the characters that curves and arenas are drawn with.
    pub braille: bool,
    /// Whether it has colours.
    pub colour: bool,
}

impl Abilities {
    /// The abilities of a terminal that can show everything.
    pub const ALL: Self = Self {
        braille: true,
        colour: true,
    };

    /// Returns the abilities of a type of terminal.
    ///
    /// A type that is not known to lack something can show everything. The font of the Linux
    /// console has no braille; the VT terminals of DEC before the VT525, and types that are
    /// called mono, have no colours.
    #[must_use]
    pub fn of_type(name: &str) -> Self {
        let mut parts = name.split('-');
        Self {
            braille: parts.next() != Some("linux"),
            colour: !name.split('-').any(is_mono),
        }
    }
}

/// Returns whether a part of a terminal's name says that it has no colours.
fn is_mono(part: &str) -> bool {
    let model = part.strip_prefix("vt").filter(|model| {
        let model = model.strip_suffix("nam").unwrap_or(model);
        !model.is_empty() && model.bytes().all(|byte| byte.is_ascii_digit())
    });
    matches!(part, "mono" | "m") || model.is_some_and(|model| model != "525")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terminals_lack_what_their_names_say() {
        for (name, braille, colour) in [
            ("xterm-256color", true, true),
            ("xterm", true, true),
            ("screen-256color", true, true),
            ("tmux", true, true),
            ("rxvt-unicode", true, true),
            ("alacritty", true, true),
            ("vte-256color", true, true),
            ("vt525", true, true),
            ("", true, true),
            ("linux", false, true),
            ("linux-16color", false, true),
            ("linux-m", false, false),
            ("xterm-mono", true, false),
            ("xterm-vt220", true, false),
            ("ansi-mono", true, false),
            ("ansi-m", true, false),
            ("vt52", true, false),
            ("vt100", true, false),
            ("vt100-am", true, false),
            ("vt102", true, false),
            ("vt220", true, false),
            ("vt100nam", true, false),
        ] {
            assert_eq!(
                Abilities::of_type(name),
                Abilities { braille, colour },
                "{name:?}"
            );
        }
    }
}
