//! The immutable scene that the integrator sees.

use crate::{
    camera::Camera,
    film::{PixelBounds, Sensor},
    filter::Filter,
    light::{Light, Lights},
    material::{Material, Materials},
    movers::Movers,
    texture::{FloatSlot, Textures},
};
use tenfold_geometry::{PrimitiveId, World};
use tenfold_math::{Id, UVec2};
use tenfold_sampling::SamplerKind;
use tenfold_spectrum::RgbColorSpace;

/// Everything a render needs, checked and laid out for it.
#[derive(Debug)]
pub struct Scene {
    /// What sees.
    pub camera: Camera,
    /// What a pixel averages over.
    pub filter: Filter,
    /// What receives.
    pub film: FilmSpec,
    /// Shapes and their hierarchy. A primitive's payload indexes [`Scene::surfaces`].
    pub world: World,
    /// What the primitives look like.
    pub surfaces: Vec<Surface>,
    /// The objects that the scene names, and how they move.
    pub movers: Movers,
    /// All materials.
    pub materials: Materials,
    /// All textures.
    pub textures: Textures,
    /// All lights.
    pub lights: Lights,
    /// How many surfaces a path may meet, as pbrt counts: 0 sees lights only, 1 direct light.
    pub max_depth: u16,
    /// Which sampler the scene asks for.
    pub sampler: SamplerSpec,
    /// Whether any texture narrows its detail to the footprint of a pixel.
    pub needs_footprint: bool,
}

impl Scene {
    /// Whether the camera or anything it sees moves, so that it matters when it is seen.
    pub fn is_moving(&self) -> bool {
        self.camera.world_from_camera.is_moving() || self.world.is_moving()
    }
}

/// The look of a primitive.
#[derive(Clone, Debug)]
pub struct Surface {
    /// What it is made of.
    pub material: Id<Material>,
    /// Where it emits: its lights.
    pub lights: Option<SurfaceLights>,
    /// Where it is there at all: 1 is there, 0 is a hole, between by chance.
    pub alpha: Option<FloatSlot>,
}

impl Surface {
    /// The light that the primitive with this index in its mesh is.
    #[inline]
    pub fn light(&self, primitive: PrimitiveId) -> Option<Id<Light>> {
        let lights = self.lights?;
        Some(Id::new(lights.first.index() + (primitive.index / lights.primitives_each) as usize))
    }

    /// Whether rays may pass: such primitives ask the filter of the traversal.
    pub fn may_be_passed(&self, materials: &Materials) -> bool {
        self.alpha.is_some() || materials.is_interface(self.material)
    }
}

/// The lights that the primitives of a surface are, one after another.
#[derive(Copy, Clone, Debug)]
pub struct SurfaceLights {
    /// The light that the first primitive belongs to.
    pub first: Id<Light>,
    /// How many consecutive primitives are one light.
    pub primitives_each: u32,
}

/// The picture a scene asks for.
#[derive(Clone, Debug)]
pub struct FilmSpec {
    /// Width and height of the whole picture, in pixels.
    pub resolution: UVec2,
    /// The part to render.
    pub bounds: PixelBounds,
    /// From radiance to linear RGB.
    pub sensor: Sensor,
    /// What linear RGB means.
    pub color_space: &'static RgbColorSpace,
    /// The file that the scene names.
    pub filename: Option<String>,
}

/// The sampler that a scene asks for.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SamplerSpec {
    /// Which.
    pub kind: SamplerKind,
    /// Samples a pixel.
    pub spp: u32,
    /// Distinguishes renders of the same scene.
    pub seed: u64,
}
