//! What keys can do: the one list that input, hint bars and the help overlay read.

use crate::dashboard::view_id::ViewId;

/// Where a key does something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// In every view.
    Everywhere,
    /// In these views, full screen or as the panel that has the focus.
    In(&'static [ViewId]),
    /// In the menu of exports.
    ExportMenu,
    /// Where a question is asked.
    Question,
}

impl Scope {
    /// Whether a key could mean both of two actions.
    #[must_use]
    pub fn meets(self, other: Self) -> bool {
        match (self, other) {
            (Self::In(some), Self::In(others)) => some.iter().any(|view| others.contains(view)),
            (Self::Everywhere, Self::In(_)) | (Self::In(_), Self::Everywhere) => true,
            (one, other) => one == other,
        }
    }
}

macro_rules! actions {
    ($($(#[doc = $doc:literal])* $action:ident = $name:literal, $scope:expr, [$($key:literal),*], $hint:literal;)*) => {
        /// Something that a key does.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Action {
            $($(#[doc = $doc])* $action,)*
        }

        impl Action {
            /// All actions, in the order of the help overlay.
            pub const ALL: &'static [Self] = &[$(Self::$action),*];

            /// Its name in key-map files.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(Self::$action => $name,)* }
            }

            /// What it does, in a sentence.
            #[must_use]
            pub fn description(self) -> &'static str {
                match self { $(Self::$action => concat!($($doc),*).trim_ascii(),)* }
            }

            /// What it does, in a word or two.
            #[must_use]
            pub fn hint(self) -> &'static str {
                match self { $(Self::$action => $hint,)* }
            }

            /// Where it does so.
            #[must_use]
            pub fn scope(self) -> Scope {
                match self { $(Self::$action => $scope,)* }
            }

            /// The names of the keys that do it, where the person has not said otherwise.
            #[must_use]
            pub fn default_keys(self) -> &'static [&'static str] {
                match self { $(Self::$action => &[$($key),*],)* }
            }
        }
    };
}

use Scope::{Everywhere, ExportMenu, In, Question};
use ViewId as V;

/// Views that show the rollout.
const ROLLOUT_VIEWS: &[ViewId] = &[V::Overview, V::Arena, V::Hierarchy, V::Stepper];

actions! {
    /// Show or hide this help.
    Help = "help", Everywhere, ["?", "f1"], "help";
    /// Leave; a run is saved and can be resumed.
    Quit = "quit", Everywhere, ["q", "ctrl-c"], "quit";
    /// Back: close what is open, return to the overview.
    Back = "back", Everywhere, ["esc", "backspace"], "back";
    /// Put the program into the background of the shell.
    Suspend = "suspend", Everywhere, ["ctrl-z"], "suspend";
    /// Draw the whole screen again.
    Redraw = "redraw", Everywhere, ["ctrl-l"], "redraw";

    /// Pause evolution, or let it go on.
    Pause = "pause", Everywhere, ["p"], "pause";
    /// Let evolution live one generation, then pause.
    StepGeneration = "step-generation", Everywhere, ["n"], "step";
    /// Save a checkpoint now.
    Checkpoint = "checkpoint", Everywhere, ["w"], "save";
    /// Save and stop evolution; the dashboard stays.
    Stop = "stop", Everywhere, ["X"], "stop";
    /// Hold all figures as they are while evolution goes on, or let them go.
    Freeze = "freeze", Everywhere, ["f"], "freeze";

    /// The overview.
    ViewOverview = "view-overview", Everywhere, ["1"], "overview";
    /// The arena.
    ViewArena = "view-arena", Everywhere, ["2"], "arena";
    /// The hierarchy.
    ViewHierarchy = "view-hierarchy", Everywhere, ["3"], "hierarchy";
    /// Fitness and structural difference.
    ViewFitness = "view-fitness", Everywhere, ["4"], "fitness";
    /// Primitive-selection probabilities.
    ViewPolicy = "view-policy", Everywhere, ["5"], "policy";
    /// The population.
    ViewPopulation = "view-population", Everywhere, ["6"], "population";
    /// What the run is doing, in full.
    ViewStatus = "view-status", Everywhere, ["7"], "status";
    /// The selected individual, taken apart.
    ViewInspector = "view-inspector", Everywhere, ["8", "i"], "inspect";
    /// What the selected individual would do all over the arena.
    ViewMap = "view-map", Everywhere, ["9", "m"], "policy map";
    /// One time step, taken apart.
    ViewStepper = "view-stepper", Everywhere, ["0", "t"], "stepper";
    /// Two individuals side by side.
    ViewCompare = "view-compare", Everywhere, ["c"], "compare";
    /// The next panel.
    NextPanel = "next-panel", In(&[V::Overview, V::Inspector]), ["tab"], "panel";
    /// The panel before.
    PreviousPanel = "previous-panel", In(&[V::Overview, V::Inspector]), ["shift-tab"], "panel";
    /// Open the panel that has the focus.
    Open = "open", Everywhere, ["enter"], "open";

    /// Up.
    Up = "up", Everywhere, ["up", "k"], "select";
    /// Down.
    Down = "down", Everywhere, ["down", "j"], "select";
    /// Left.
    Left = "left", Everywhere, ["left", "h"], "turn";
    /// Right.
    Right = "right", Everywhere, ["right", "l"], "turn";
    /// A page up.
    PageUp = "page-up", Everywhere, ["page-up", "ctrl-u"], "page up";
    /// A page down.
    PageDown = "page-down", Everywhere, ["page-down", "ctrl-d"], "page down";
    /// To the top.
    Top = "top", Everywhere, ["home", "g"], "top";
    /// To the bottom.
    Bottom = "bottom", Everywhere, ["end", "G"], "bottom";

    /// The generation before.
    Earlier = "earlier", Everywhere, ["["], "earlier";
    /// The next generation.
    Later = "later", Everywhere, ["]"], "later";
    /// Ten generations back.
    MuchEarlier = "much-earlier", Everywhere, ["{"], "-10";
    /// Ten generations on.
    MuchLater = "much-later", Everywhere, ["}"], "+10";
    /// The first generation.
    First = "first", Everywhere, ["<"], "first";
    /// The latest generation, and follow evolution.
    Follow = "follow", Everywhere, [">"], "follow";
    /// Let time run through the generations, or halt it.
    Play = "play", Everywhere, ["P"], "play";

    /// Select the best individual.
    Best = "best", Everywhere, ["b"], "best";
    /// Sort the table by the next column.
    Sort = "sort", In(&[V::Population]), ["s"], "sort";
    /// Turn the table's order round.
    Reverse = "reverse", In(&[V::Population]), ["S"], "reverse";

    /// Halt the rollout, or let it go on.
    Halt = "halt", In(ROLLOUT_VIEWS), ["space"], "halt";
    /// One time step of the rollout.
    StepRollout = "step-rollout", In(ROLLOUT_VIEWS), ["."], "time step";
    /// One recorded time step back.
    StepBack = "step-back", In(&[V::Stepper]), [","], "step back";
    /// The rollout faster.
    Faster = "faster", In(ROLLOUT_VIEWS), ["+", "="], "faster";
    /// The rollout slower.
    Slower = "slower", In(ROLLOUT_VIEWS), ["-"], "slower";
    /// A new rollout from another start.
    Restart = "restart", In(ROLLOUT_VIEWS), ["r"], "new rollout";

    /// Give this trial up and begin the next.
    NextTrial = "next-trial", In(ROLLOUT_VIEWS), ["N"], "next trial";

    /// Keep the selected individual to compare others with.
    Mark = "mark", Everywhere, ["M"], "mark";
    /// Draw something else: another quantity, values instead of the policy.
    Mode = "mode", In(&[V::Inspector, V::PolicyMap]), ["v"], "values";

    /// The next theme.
    Theme = "theme", Everywhere, ["T"], "theme";
    /// Write what is on the screen to a file.
    Export = "export", Everywhere, ["e"], "export";
    /// The frame as text.
    ExportText = "export-text", ExportMenu, ["t"], "frame as text";
    /// The frame as text with colours (ANSI).
    ExportAnsi = "export-ansi", ExportMenu, ["a"], "frame with colours";
    /// The frame as a picture (SVG).
    ExportSvg = "export-svg", ExportMenu, ["s"], "frame as SVG";
    /// The hierarchy as a Graphviz graph (DOT).
    ExportDot = "export-dot", ExportMenu, ["d"], "hierarchy as DOT";
    /// The data as a table (CSV).
    ExportCsv = "export-csv", ExportMenu, ["c"], "data as CSV";

    /// Yes.
    Yes = "yes", Question, ["y", "enter"], "yes";
    /// No.
    No = "no", Question, ["n"], "no";
    /// Leave, and let the run go on without a terminal.
    Detach = "detach", Question, ["d"], "detach";
}

impl Action {
    /// The action with this name.
    #[must_use]
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL
            .iter()
            .copied()
            .find(|action| action.name() == name)
    }

    /// The view that it opens, if it opens one.
    #[must_use]
    pub fn view(self) -> Option<ViewId> {
        Some(match self {
            Self::ViewOverview => V::Overview,
            Self::ViewArena => V::Arena,
            Self::ViewHierarchy => V::Hierarchy,
            Self::ViewFitness => V::Fitness,
            Self::ViewPolicy => V::Policy,
            Self::ViewPopulation => V::Population,
            Self::ViewStatus => V::Status,
            Self::ViewInspector => V::Inspector,
            Self::ViewMap => V::PolicyMap,
            Self::ViewStepper => V::Stepper,
            Self::ViewCompare => V::Compare,
            _ => return None,
        })
    }
}
