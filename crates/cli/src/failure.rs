use crate::diagnostics::say;

/// Why the program ends without having done what it was asked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Failure {
    /// The scene or the command line is wrong: exit code 2.
    Wrong(String),
    /// The command line is wrong, and this whole text says how: exit code 2.
    Usage(String),
    /// The render could not be done or its picture not written: exit code 1.
    Failed(String),
    /// The program itself is at fault: exit code 1.
    Bug(String),
}

impl Failure {
    /// The exit code.
    pub(crate) fn code(&self) -> u8 {
        match self {
            Self::Failed(_) | Self::Bug(_) => 1,
            Self::Wrong(_) | Self::Usage(_) => 2,
        }
    }

    /// What happened, in plain text.
    pub(crate) fn message(&self) -> &str {
        match self {
            Self::Wrong(message) | Self::Usage(message) | Self::Failed(message) | Self::Bug(message) => {
                message
            }
        }
    }

    /// Tells the user.
    pub(crate) fn print(&self) {
        match self {
            Self::Usage(text) => say(text.trim_end()),
            Self::Wrong(message) | Self::Failed(message) => say(&format!("tenfold: error: {message}")),
            Self::Bug(message) => say(&format!(
                "tenfold: internal error: {message}\nThis is a fault of tenfold, not of the scene. Please report it, with the scene and the command."
            )),
        }
    }
}
