//! The scene that the program carries along.

use tenfold_scene::EmbeddedResources;

/// Its name, in messages and in the picture's metadata.
pub(crate) const NAME: &str = "default.pbrt";

/// Its text.
pub(crate) const TEXT: &str = include_str!("../../../scenes/default.pbrt");

/// The picture it makes where no other name is given.
pub(crate) const PICTURE: &str = "tenfold.png";

/// The files it names.
pub(crate) fn resources() -> EmbeddedResources {
    EmbeddedResources::new(&[
        ("textures/backdrop.png", include_bytes!("../../../scenes/textures/backdrop.png")),
        ("textures/window.png", include_bytes!("../../../scenes/textures/window.png")),
    ])
}
