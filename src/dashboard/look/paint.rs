//! What there is to paint.

macro_rules! paints {
    ($($(#[doc = $doc:literal])* $paint:ident = $name:literal;)*) => {
        /// Something that a theme gives a style to.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Paint {
            $($(#[doc = $doc])* $paint,)*
        }

        impl Paint {
            /// All paints, in the order of the themes' tables.
            pub const ALL: &'static [Self] = &[$(Self::$paint),*];

            /// Its name in theme files.
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
    /// Captions, units, what matters less.
    Dim = "dim";
    /// Titles of panels.
    Title = "title";
    /// Borders.
    Border = "border";
    /// Border and title of the panel that has the focus.
    Focus = "focus";
    /// Keys in hints and help.
    Key = "key";
    /// What is well: running, delivered.
    Good = "good";
    /// What is not: stopped, failed.
    Bad = "bad";
    /// What asks for attention: paused, messages.
    Notice = "notice";
    /// The selected line.
    Selected = "selected";
    /// That the view is frozen, or in the past.
    Frozen = "frozen";
    /// What is active: the path from root to action.
    Active = "active";
    /// The best individual.
    Best = "best";
    /// The middle of the better half.
    Median = "median";
    /// The worst of the better half.
    Worst = "worst";
    /// Walls.
    Wall = "wall";
    /// The agent.
    Agent = "agent";
    /// The nest, a destination.
    Goal = "goal";
    /// Batteries, a passenger.
    Object = "object";
    /// What is to be kept away from.
    Hazard = "hazard";
    /// Places with a name.
    Landmark = "landmark";
    /// Where the agent has been.
    Trail = "trail";
    /// Where the agent sees.
    Sight = "sight";
    /// Proximity rays.
    Ray = "ray";
    /// The lowest values of a world of cells.
    Shade1 = "shade-1";
    /// Low ones.
    Shade2 = "shade-2";
    /// Those in the middle.
    Shade3 = "shade-3";
    /// High ones.
    Shade4 = "shade-4";
    /// The highest.
    Shade5 = "shade-5";
    /// The first primitive subtask, and what else comes first.
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
    /// The paint of the n-th of several things, from 0.
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

    /// The paint of a value at a place between the lowest, 0, and the highest, 1.
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

    /// The paint with this name.
    #[must_use]
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|paint| paint.name() == name)
    }
}
