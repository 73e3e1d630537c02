//! The effects of distributed ray tracing one by one: a scene without any, with each alone, and with all of them, at few samples a
//! pixel and at many.
//!
//! An effect is switched off by holding its variable at one value. What is held costs nothing and makes no noise: the pictures show
//! what each effect looks like, and how many samples it wants.

mod effect;
mod page;

pub use effect::Effect;
pub use page::page;

use crate::{Interrupted, Work};
use tenfold_math::Vec3;
use tenfold_render::{
    scene::Scene,
    schedule::{RenderSettings, relative_error},
};
use tenfold_spectrum::RgbColorSpace;

/// A scene with some of its effects.
#[derive(Clone, Debug)]
pub struct Row {
    /// What it is called.
    pub name: &'static str,
    /// The effects that are there.
    pub on: Vec<Effect>,
    /// Pictures, by rising numbers of samples.
    pub cells: Vec<Cell>,
}

/// One picture.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Samples a pixel.
    pub spp: u32,
    /// The picture, of linear sRGB.
    pub picture: Vec<Vec3>,
    /// Its noise: root mean square of the relative errors of the pixels, without the part of the reference.
    pub noise: f64,
    /// Wall-clock time, in seconds.
    pub seconds: f64,
}

/// The rows of the table: no effect, each alone, all.
fn rows() -> impl Iterator<Item = (&'static str, Vec<Effect>)> {
    let alone = Effect::ALL.into_iter().map(|effect| (effect.name(), vec![effect]));
    [("no effect", vec![])].into_iter().chain(alone).chain([("all together", Effect::ALL.to_vec())])
}

/// The samples that [`table`] takes, for [`Work::new`].
pub fn work_of(settings: &RenderSettings, counts: &[u32]) -> u64 {
    let reference = counts.last().copied().unwrap_or(0);
    let samples = counts.iter().chain([&reference]).map(|&n| u64::from(n)).sum::<u64>();
    samples * settings.bounds.area() as u64 * rows().count() as u64
}

/// Renders `scene` with each choice of effects at each of `counts`, rising, of samples a pixel, the rest as `settings` say.
///
/// The truth is not known; of two renders with the largest count and different seeds half the mean squared difference is the
/// variance of one, and what the others differ more than that from the second is theirs.
///
/// # Errors
/// [`Interrupted`] where the observer of the work did not want to go on.
pub fn table(
    scene: &Scene,
    settings: &RenderSettings,
    counts: &[u32],
    work: &mut Work<'_>,
) -> Result<Vec<Row>, Interrupted> {
    let space = scene.film.color_space;
    let luminance =
        |picture: &[Vec3]| picture.iter().map(|&rgb| f64::from(space.luminance(rgb))).collect::<Vec<_>>();
    let to_srgb = space.to(RgbColorSpace::srgb());
    let width = settings.bounds.size().x as usize;
    rows()
        .map(|(name, on)| {
            let mut settings = settings.clone();
            Effect::ALL.into_iter().filter(|e| !on.contains(e)).for_each(|e| e.switch_off(&mut settings));
            let mut cells = Vec::new();
            for &spp in counts {
                let render = work.render(scene, &RenderSettings { spp, ..settings.clone() })?;
                let seconds = render.statistics.seconds;
                cells.push(Cell { spp, picture: render.film.means(), noise: 0.0, seconds });
            }
            let spp = counts.last().copied().unwrap_or(0);
            let seed = settings.seed ^ REFERENCE;
            let reference = work.render(scene, &RenderSettings { spp, seed, ..settings })?.film.means();
            let reference = luminance(&reference);
            let squares: Vec<f64> = cells
                .iter()
                .map(|cell| relative_error(&luminance(&cell.picture), &reference, width).powi(2))
                .collect();
            let of_reference = 0.5 * squares.last().copied().unwrap_or(0.0);
            for (cell, square) in cells.iter_mut().zip(squares) {
                cell.noise = (square - of_reference).max(0.0).sqrt();
                cell.picture.iter_mut().for_each(|rgb| *rgb = to_srgb * *rgb);
            }
            Ok(Row { name, on, cells })
        })
        .collect()
}

/// Sets the seed of references apart.
const REFERENCE: u64 = 1 << 63;
