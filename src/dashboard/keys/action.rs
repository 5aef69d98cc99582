//! The actions of the dashboard, in one list that the input, the hint bars and the help overlay
//! share.

use crate::dashboard::view_id::ViewId;

/// Where a key has an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// In every view.
    Everywhere,
    /// In these views, on the whole screen or as the panel with the focus.
    In(&'static [ViewId]),
    /// In the export menu.
    ExportMenu,
    /// While a question is open.
    Question,
}

impl Scope {
    /// Returns whether one key could mean both of two actions.
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
        /// An action that keys are bound to.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Action {
            $($(#[doc = $doc])* $action,)*
        }

        impl Action {
            /// All actions, in the order of the help overlay.
            pub const ALL: &'static [Self] = &[$(Self::$action),*];

            /// Returns the name in the configuration file.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(Self::$action => $name,)* }
            }

            /// Returns the effect in a sentence, for the help overlay.
            #[must_use]
            pub fn description(self) -> &'static str {
                match self { $(Self::$action => concat!($($doc),*).trim_ascii(),)* }
            }

            /// Returns the effect in a word or two, for the hint bar.
            #[must_use]
            pub fn hint(self) -> &'static str {
                match self { $(Self::$action => $hint,)* }
            }

            /// Returns where the action has an effect.
            #[must_use]
            pub fn scope(self) -> Scope {
                match self { $(Self::$action => $scope,)* }
            }

            /// Returns the names of the keys that are bound by default.
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
    /// Quit; a live run is saved and can be resumed.
    Quit = "quit", Everywhere, ["q", "ctrl-c"], "quit";
    /// Go back: close the open window, or return to the overview.
    Back = "back", Everywhere, ["esc", "backspace"], "back";
    /// Suspend the program, as Ctrl-Z does in a shell.
    Suspend = "suspend", Everywhere, ["ctrl-z"], "suspend";
    /// Redraw the whole screen.
    Redraw = "redraw", Everywhere, ["ctrl-l"], "redraw";

    /// Pause or resume evolution.
    Pause = "pause", Everywhere, ["p"], "pause";
    /// Evolve one more generation, then pause.
    StepGeneration = "step-generation", Everywhere, ["n"], "step";
    /// Save a checkpoint now.
    Checkpoint = "checkpoint", Everywhere, ["w"], "save";
    /// Save and stop the run; the dashboard stays open.
    Stop = "stop", Everywhere, ["X"], "stop";
    /// Freeze or unfreeze the display; evolution continues.
    Freeze = "freeze", Everywhere, ["f"], "freeze";

    /// Show the overview.
    ViewOverview = "view-overview", Everywhere, ["1"], "overview";
    /// Show the arena.
    ViewArena = "view-arena", Everywhere, ["2"], "arena";
    /// Show the task hierarchy.
    ViewHierarchy = "view-hierarchy", Everywhere, ["3"], "hierarchy";
    /// Show fitness and structural difference.
    ViewFitness = "view-fitness", Everywhere, ["4"], "fitness";
    /// Show primitive-selection probabilities.
    ViewPolicy = "view-policy", Everywhere, ["5"], "policy";
    /// Show the population.
    ViewPopulation = "view-population", Everywhere, ["6"], "population";
    /// Show the status of the run.
    ViewStatus = "view-status", Everywhere, ["7"], "status";
    /// Inspect the selected individual.
    ViewInspector = "view-inspector", Everywhere, ["8", "i"], "inspect";
    /// Show the policy of the selected individual as a map.
    ViewMap = "view-map", Everywhere, ["9", "m"], "policy map";
    /// Step through a trial.
    ViewStepper = "view-stepper", Everywhere, ["0", "t"], "stepper";
    /// Compare two individuals side by side.
    ViewCompare = "view-compare", Everywhere, ["c"], "compare";
    /// Focus the next panel.
    NextPanel = "next-panel", In(&[V::Overview, V::Inspector]), ["tab"], "panel";
    /// Focus the previous panel.
    PreviousPanel = "previous-panel", In(&[V::Overview, V::Inspector]), ["shift-tab"], "panel";
    /// Open the focused panel or the selected item.
    Open = "open", Everywhere, ["enter"], "open";

    /// Move up.
    Up = "up", Everywhere, ["up", "k"], "select";
    /// Move down.
    Down = "down", Everywhere, ["down", "j"], "select";
    /// Move left.
    Left = "left", Everywhere, ["left", "h"], "turn";
    /// Move right.
    Right = "right", Everywhere, ["right", "l"], "turn";
    /// Move a page up.
    PageUp = "page-up", Everywhere, ["page-up", "ctrl-u"], "page up";
    /// Move a page down.
    PageDown = "page-down", Everywhere, ["page-down", "ctrl-d"], "page down";
    /// Move to the top.
    Top = "top", Everywhere, ["home", "g"], "top";
    /// Move to the bottom.
    Bottom = "bottom", Everywhere, ["end", "G"], "bottom";

    /// Go to the previous generation.
    Earlier = "earlier", Everywhere, ["["], "earlier";
    /// Go to the next generation.
    Later = "later", Everywhere, ["]"], "later";
    /// Go back ten generations.
    MuchEarlier = "much-earlier", Everywhere, ["{"], "-10";
    /// Go forward ten generations.
    MuchLater = "much-later", Everywhere, ["}"], "+10";
    /// Go to the first generation.
    First = "first", Everywhere, ["<"], "first";
    /// Go to the latest generation and follow evolution.
    Follow = "follow", Everywhere, [">"], "follow";
    /// Play through the generations, or stop playing.
    Play = "play", Everywhere, ["P"], "play";

    /// Select the best individual.
    Best = "best", Everywhere, ["b"], "best";
    /// Sort the table by the next column.
    Sort = "sort", In(&[V::Population]), ["s"], "sort";
    /// Reverse the order of the table.
    Reverse = "reverse", In(&[V::Population]), ["S"], "reverse";

    /// Pause or resume the rollout.
    Halt = "halt", In(ROLLOUT_VIEWS), ["space"], "halt";
    /// Advance the rollout by one time step.
    StepRollout = "step-rollout", In(ROLLOUT_VIEWS), ["."], "time step";
    /// Go back one recorded time step.
    StepBack = "step-back", In(&[V::Stepper]), [","], "step back";
    /// Speed the rollout up.
    Faster = "faster", In(ROLLOUT_VIEWS), ["+", "="], "faster";
    /// Slow the rollout down.
    Slower = "slower", In(ROLLOUT_VIEWS), ["-"], "slower";
    /// Start a new rollout from another start state.
    Restart = "restart", In(ROLLOUT_VIEWS), ["r"], "new rollout";

    /// Abandon this trial and start the next.
    NextTrial = "next-trial", In(ROLLOUT_VIEWS), ["N"], "next trial";

    /// Mark the selected individual as the one to compare others with.
    Mark = "mark", Everywhere, ["M"], "mark";
    /// Switch what is drawn: another quantity, or values instead of the policy.
    Mode = "mode", In(&[V::Inspector, V::PolicyMap]), ["v"], "values";

    /// Switch to the next theme.
    Theme = "theme", Everywhere, ["T"], "theme";
    /// Export what is on the screen to a file.
    Export = "export", Everywhere, ["e"], "export";
    /// Frame as plain text.
    ExportText = "export-text", ExportMenu, ["t"], "frame as text";
    /// Frame as text with colours (ANSI).
    ExportAnsi = "export-ansi", ExportMenu, ["a"], "frame with colours";
    /// Frame as a picture (SVG).
    ExportSvg = "export-svg", ExportMenu, ["s"], "frame as SVG";
    /// Hierarchy as a Graphviz graph (DOT).
    ExportDot = "export-dot", ExportMenu, ["d"], "hierarchy as DOT";
    /// Data as a table (CSV).
    ExportCsv = "export-csv", ExportMenu, ["c"], "data as CSV";
    /// Remove the file that was written last.
    ExportRemove = "export-remove", ExportMenu, ["u"], "remove the file written last";

    /// Yes.
    Yes = "yes", Question, ["y", "enter"], "yes";
    /// No.
    No = "no", Question, ["n"], "no";
    /// Detach: leave, and let the run continue without a terminal.
    Detach = "detach", Question, ["d"], "detach";
}

impl Action {
    /// Returns the action with this name.
    #[must_use]
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL
            .iter()
            .copied()
            .find(|action| action.name() == name)
    }

    /// Returns the view that the action shows, if it shows one.
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
