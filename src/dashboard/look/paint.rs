//! Paints: the roles that a theme gives a style to.

macro_rules! paints {
    ($($(#[doc = $doc:literal])* $paint:ident = $name:literal;)*) => {
        /// A role that a theme gives a style to.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Paint {
            $($(#[doc = $doc])* $paint,)*
        }

        impl Paint {
            /// All paints, in the order of the themes' tables.
            pub const ALL: &'static [Self] = &[$(Self::$paint),*];

            /// Returns the name in the configuration file.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(Self::$paint => $name,)* }
            }
        }
    };
}

paints! {
    /// Plain text.
    Text = "text";
    /// Captions, units, less important text.
    Dim = "dim";
    /// Titles of panels.
    Title = "title";
    /// Borders.
    Border = "border";
    /// Border and title of the focused panel.
    Focus = "focus";
    /// Keys in hints and help.
    Key = "key";
    /// Good states: running, delivered.
    Good = "good";
    /// Bad states: stopped, failed.
    Bad = "bad";
    /// States that need attention: paused, messages.
    Notice = "notice";
    /// The selected line.
    Selected = "selected";
    /// Marks of a frozen display or an earlier generation.
    Frozen = "frozen";
    /// Active subtasks: the path from root to action.
    Active = "active";
    /// The best individual.
    Best = "best";
    /// The median of the better half.
    Median = "median";
    /// The worst of the better half.
    Worst = "worst";
    /// Walls.
    Wall = "wall";
    /// Walls that the agent sees through.
    TransparentWall = "transparent-wall";
    /// The agent.
    Agent = "agent";
    /// The nest, a destination.
    Goal = "goal";
    /// Batteries, a passenger.
    Object = "object";
    /// Places to avoid.
    Hazard = "hazard";
    /// Places with a name.
    Landmark = "landmark";
    /// The path of the agent.
    Trail = "trail";
    /// The place where the agent remembers its target.
    Remembered = "remembered";
    /// The field of view of the agent.
    Sight = "sight";
    /// Proximity rays.
    Ray = "ray";
    /// The lowest values in a world of cells.
    Shade1 = "shade-1";
    /// Low values.
    Shade2 = "shade-2";
    /// Medium values.
    Shade3 = "shade-3";
    /// High values.
    Shade4 = "shade-4";
    /// The highest values.
    Shade5 = "shade-5";
    /// The first primitive subtask, or the first of other series.
    Series1 = "series-1";
    /// The second.
    Series2 = "series-2";
    /// The third.
    Series3 = "series-3";
    /// The fourth.
    Series4 = "series-4";
    /// The fifth.
    Series5 = "series-5";
    /// The sixth.
    Series6 = "series-6";
}

impl Paint {
    /// Returns the paint of the n-th series, from 0.
    #[must_use]
    pub fn series(n: usize) -> Self {
        const SERIES: [Paint; 6] = [
            Paint::Series1,
            Paint::Series2,
            Paint::Series3,
            Paint::Series4,
            Paint::Series5,
            Paint::Series6,
        ];
        SERIES[n % SERIES.len()]
    }

    /// Returns the paint of a value between the lowest, 0, and the highest, 1.
    #[must_use]
    pub fn shade(share: f32) -> Self {
        const SHADES: [Paint; 5] = [
            Paint::Shade1,
            Paint::Shade2,
            Paint::Shade3,
            Paint::Shade4,
            Paint::Shade5,
        ];
        SHADES[(share * 5.0).clamp(0.0, 4.0) as usize]
    }

    /// Returns the paint with this name.
    #[must_use]
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|paint| paint.name() == name)
    }
}
