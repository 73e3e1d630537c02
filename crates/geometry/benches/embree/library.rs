//! Embree 4, loaded at run time: the few calls that the comparison needs.

use libloading::Library;
use std::{
    env,
    ffi::{CString, c_char, c_int, c_uint, c_void},
    path::PathBuf,
    ptr,
};
use tenfold_math::{Ray, Vec3};

type Handle = *mut c_void;

/// The calls, as `rtcore.h` of Embree 4 declares them.
struct Calls {
    new_device: unsafe extern "C" fn(*const c_char) -> Handle,
    release_device: unsafe extern "C" fn(Handle),
    device_error: unsafe extern "C" fn(Handle) -> c_int,
    device_property: unsafe extern "C" fn(Handle, c_int) -> isize,
    new_scene: unsafe extern "C" fn(Handle) -> Handle,
    release_scene: unsafe extern "C" fn(Handle),
    scene_flags: unsafe extern "C" fn(Handle, c_int),
    scene_quality: unsafe extern "C" fn(Handle, c_int),
    commit_scene: unsafe extern "C" fn(Handle),
    new_geometry: unsafe extern "C" fn(Handle, c_int) -> Handle,
    release_geometry: unsafe extern "C" fn(Handle),
    time_steps: unsafe extern "C" fn(Handle, c_uint),
    shared_buffer: unsafe extern "C" fn(Handle, c_int, c_uint, c_int, *const c_void, usize, usize, usize),
    commit_geometry: unsafe extern "C" fn(Handle),
    attach_geometry: unsafe extern "C" fn(Handle, Handle) -> c_uint,
    intersect: unsafe extern "C" fn(Handle, *mut RayHit, *mut c_void),
    occluded: unsafe extern "C" fn(Handle, *mut RayHit, *mut c_void),
    // Last, so that the calls outlive nothing.
    _library: Library,
}

/// `RTCRayHit`: the ray, then the hit, with room for the instance of any build of the library.
#[repr(C, align(64))]
struct RayHit {
    origin: [f32; 3],
    near: f32,
    direction: [f32; 3],
    time: f32,
    far: f32,
    mask: u32,
    id: u32,
    flags: u32,
    normal: [f32; 3],
    u: f32,
    v: f32,
    primitive: u32,
    geometry: u32,
    instance: [u32; 9],
}

/// `RTC_INVALID_GEOMETRY_ID`.
const INVALID: u32 = u32::MAX;

impl RayHit {
    #[inline]
    fn new(ray: &Ray, t_max: f32) -> Self {
        Self {
            origin: ray.origin.to_array(),
            near: 0.0,
            direction: ray.direction.to_array(),
            time: ray.time,
            far: t_max,
            mask: u32::MAX,
            id: 0,
            flags: 0,
            normal: [0.0; 3],
            u: 0.0,
            v: 0.0,
            primitive: 0,
            geometry: INVALID,
            instance: [INVALID; 9],
        }
    }
}

/// The library with a device.
pub(crate) struct Embree {
    calls: Calls,
    device: Handle,
}

impl Embree {
    /// The library that `EMBREE_LIBRARY` names, or that the Python package `embreex` of the active virtual environment brings.
    pub(crate) fn find() -> Result<PathBuf, String> {
        if let Some(path) = env::var_os("EMBREE_LIBRARY") {
            return Ok(path.into());
        }
        let venv = env::var_os("VIRTUAL_ENV").ok_or("neither EMBREE_LIBRARY nor VIRTUAL_ENV is set")?;
        let list = |dir: PathBuf| {
            std::fs::read_dir(dir)
                .into_iter()
                .flatten()
                .filter_map(|e| Some(e.ok()?.path()))
                .collect::<Vec<_>>()
        };
        list(PathBuf::from(venv).join("lib"))
            .into_iter()
            .flat_map(|python| list(python.join("site-packages/embreex.libs")))
            .find(|path| path.to_string_lossy().contains("libembree4"))
            .ok_or("the virtual environment has no package embreex with libembree4".into())
    }

    /// Loads the library; it builds on `threads` threads.
    pub(crate) fn load(path: &PathBuf, threads: usize) -> Result<Self, String> {
        // SAFETY: a published library whose initialisers do nothing but set it up.
        let library = unsafe { Library::new(path) }.map_err(|e| e.to_string())?;
        macro_rules! call {
            ($name:literal) => {
                // SAFETY: the field's type is the declaration of this name in Embree 4's headers.
                *unsafe { library.get($name) }.map_err(|e| e.to_string())?
            };
        }
        let calls = Calls {
            new_device: call!(b"rtcNewDevice\0"),
            release_device: call!(b"rtcReleaseDevice\0"),
            device_error: call!(b"rtcGetDeviceError\0"),
            device_property: call!(b"rtcGetDeviceProperty\0"),
            new_scene: call!(b"rtcNewScene\0"),
            release_scene: call!(b"rtcReleaseScene\0"),
            scene_flags: call!(b"rtcSetSceneFlags\0"),
            scene_quality: call!(b"rtcSetSceneBuildQuality\0"),
            commit_scene: call!(b"rtcCommitScene\0"),
            new_geometry: call!(b"rtcNewGeometry\0"),
            release_geometry: call!(b"rtcReleaseGeometry\0"),
            time_steps: call!(b"rtcSetGeometryTimeStepCount\0"),
            shared_buffer: call!(b"rtcSetSharedGeometryBuffer\0"),
            commit_geometry: call!(b"rtcCommitGeometry\0"),
            attach_geometry: call!(b"rtcAttachGeometry\0"),
            intersect: call!(b"rtcIntersect1\0"),
            occluded: call!(b"rtcOccluded1\0"),
            _library: library,
        };
        let config = CString::new(format!("threads={threads}")).expect("no zero inside");
        // SAFETY: a string with its zero.
        let device = unsafe { (calls.new_device)(config.as_ptr()) };
        if device.is_null() { Err("Embree makes no device".into()) } else { Ok(Self { calls, device }) }
    }

    /// Its version, as in 4.4.0.
    pub(crate) fn version(&self) -> String {
        let part = |i: c_int| {
            // SAFETY: the device lives; properties 1 to 3 are the parts of the version.
            unsafe { (self.calls.device_property)(self.device, i) }
        };
        format!("{}.{}.{}", part(1), part(2), part(3))
    }
}

impl Drop for Embree {
    fn drop(&mut self) {
        // SAFETY: scenes borrow `self`: nothing uses the device any more.
        unsafe { (self.calls.release_device)(self.device) }
    }
}

/// Triangles as Embree wants them: positions at one time or at the two ends of the interval [0, 1], with four bytes behind the last.
pub(crate) struct EmbreeMesh {
    steps: Vec<Vec<f32>>,
    indices: Vec<u32>,
}

impl EmbreeMesh {
    /// Positions by time.
    pub(crate) fn new(steps: &[&[Vec3]], indices: &[u32]) -> Self {
        let padded = |p: &&[Vec3]| p.iter().flat_map(|p| p.to_array()).chain([0.0]).collect();
        Self { steps: steps.iter().map(padded).collect(), indices: indices.to_vec() }
    }
}

/// How a scene is built (`RTCBuildQuality`, `RTCSceneFlags`).
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(crate) enum Quality {
    /// What Embree does unasked: medium quality.
    Default,
    /// High quality: with spatial splits.
    High,
    /// Medium quality with the flag for robust, watertight intersection.
    Robust,
}

impl Quality {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Default => "default",
            Self::High => "high",
            Self::Robust => "robust",
        }
    }
}

/// A committed scene.
pub(crate) struct EmbreeScene<'a> {
    embree: &'a Embree,
    scene: Handle,
}

impl<'a> EmbreeScene<'a> {
    pub(crate) fn build(embree: &'a Embree, meshes: &'a [EmbreeMesh], quality: Quality) -> Self {
        let calls = &embree.calls;
        // SAFETY: handles are used as they were made, and released once; the buffers are of the sizes given, and outlive the scene.
        unsafe {
            let scene = (calls.new_scene)(embree.device);
            (calls.scene_quality)(scene, if quality == Quality::High { 2 } else { 1 });
            (calls.scene_flags)(scene, if quality == Quality::Robust { 4 } else { 0 });
            for mesh in meshes {
                const TRIANGLES: c_int = 0;
                const INDEX: c_int = 0;
                const VERTEX: c_int = 1;
                const UINT3: c_int = 0x5003;
                const FLOAT3: c_int = 0x9003;
                let geometry = (calls.new_geometry)(embree.device, TRIANGLES);
                (calls.time_steps)(geometry, mesh.steps.len() as c_uint);
                for (slot, step) in mesh.steps.iter().enumerate() {
                    let data = step.as_ptr().cast();
                    (calls.shared_buffer)(
                        geometry,
                        VERTEX,
                        slot as c_uint,
                        FLOAT3,
                        data,
                        0,
                        12,
                        step.len() / 3,
                    );
                }
                let data = mesh.indices.as_ptr().cast();
                (calls.shared_buffer)(geometry, INDEX, 0, UINT3, data, 0, 12, mesh.indices.len() / 3);
                (calls.commit_geometry)(geometry);
                (calls.attach_geometry)(scene, geometry);
                (calls.release_geometry)(geometry);
            }
            (calls.commit_scene)(scene);
            assert_eq!((calls.device_error)(embree.device), 0, "Embree reports an error");
            Self { embree, scene }
        }
    }

    /// The closest hit: its distance, geometry and triangle.
    #[inline]
    pub(crate) fn intersect(&self, ray: &Ray, t_max: f32) -> Option<(f32, u32, u32)> {
        let mut query = RayHit::new(ray, t_max);
        // SAFETY: a committed scene, and a query larger than the library's structure and aligned to more.
        unsafe { (self.embree.calls.intersect)(self.scene, &mut query, ptr::null_mut()) };
        (query.geometry != INVALID).then_some((query.far, query.geometry, query.primitive))
    }

    /// Whether anything is hit.
    #[inline]
    pub(crate) fn occluded(&self, ray: &Ray, t_max: f32) -> bool {
        let mut query = RayHit::new(ray, t_max);
        // SAFETY: as above; the call uses the ray alone.
        unsafe { (self.embree.calls.occluded)(self.scene, &mut query, ptr::null_mut()) };
        query.far < 0.0
    }
}

impl Drop for EmbreeScene<'_> {
    fn drop(&mut self) {
        // SAFETY: made by `build`, released here alone.
        unsafe { (self.embree.calls.release_scene)(self.scene) }
    }
}
