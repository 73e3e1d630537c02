//! The scenes that the program carries along.

/// A scene with its files.
pub(crate) struct Embedded {
    /// Its name, in messages and in the picture's metadata.
    pub(crate) name: &'static str,
    pub(crate) text: &'static str,
    /// The files it names.
    pub(crate) files: &'static [(&'static str, &'static [u8])],
}

const WINDOW: (&str, &[u8]) = ("textures/window.png", include_bytes!("../../../scenes/textures/window.png"));
const BACKDROP: (&str, &[u8]) =
    ("textures/backdrop.png", include_bytes!("../../../scenes/textures/backdrop.png"));

/// What is rendered where no scene is named.
pub(crate) static DEFAULT: Embedded = Embedded {
    name: "default.pbrt",
    text: include_str!("../../../scenes/default.pbrt"),
    files: &[BACKDROP, WINDOW],
};

/// The picture it makes where no other name is given.
pub(crate) const PICTURE: &str = "tenfold.png";

/// What `tenfold lab effects` looks at where no scene is named: every effect at a place of its own.
pub(crate) static EFFECTS: Embedded =
    Embedded { name: "effects.pbrt", text: include_str!("../../../scenes/effects.pbrt"), files: &[WINDOW] };
