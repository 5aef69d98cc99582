//! Why a session on a terminal is over.

/// Why a session is over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// The person has left.
    Left,
    /// The person has left, and the run is to go on.
    Detached,
    /// The line dropped: the terminal is gone.
    HungUp,
    /// A signal asked the program to end.
    Signal(i32),
    /// A thread has panicked, and the terminal was given back.
    Panicked,
    /// The run has failed.
    Failed,
}
