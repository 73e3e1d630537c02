//! Scenes from text, samples with their moments, and checks with a stated confidence.

use std::collections::HashMap;
use std::io;
use std::path::PathBuf;
use tenfold_math::{Ray, Rays, UVec2, Vec2, Vec3};
use tenfold_render::compile::compile;
use tenfold_render::film::Film;
use tenfold_render::integrator::{DispersionRule, PathTracer, Sample, Strategies, Workspace};
use tenfold_render::scene::Scene;
use tenfold_render::schedule::{PixelEstimator, RenderSettings, render};
use tenfold_sampling::{SampleGroup, Sampler, SamplerKind};
use tenfold_scene::{Resources, SourceMap, read_pbrt_str};
use tenfold_spectrum::{N, SampledSpectrum, SampledWavelengths};
use tenfold_testkit::Welford;
use tenfold_testkit::stats::{t_test_mean, t_test_two};

/// The probability with which a check fails though the renderer is right, for all its comparisons together (Šidák): that of 4.4
/// standard deviations in a single one.
pub(crate) const SIGNIFICANCE: f64 = 1e-5;

/// What single precision may do to a mean of many samples, relative to it.
const ROUNDING: f64 = 3e-5;

/// Wavelengths, in nm, at which radiance is measured.
pub(crate) const LAMBDA: [f32; N] = [440.0, 520.0, 600.0, 680.0];

/// What makes a spectrum of constant value emit just that value at all wavelengths: ∫ ȳ dλ, by which lights are divided.
pub(crate) const FLAT: &str = r#""spectrum L" [ 300 1 900 1 ] "float scale" 106.856895 "#;

/// Camera and film for scenes that are asked along rays of the test's own, up to the world block.
pub(crate) fn header(max_depth: u32) -> String {
    format!(
        r#"Film "rgb" "integer xresolution" 1 "integer yresolution" 1
        PixelFilter "box" Integrator "path" "integer maxdepth" {max_depth} Camera "perspective" WorldBegin "#
    )
}

/// Files that a scene names.
#[derive(Clone, Debug, Default)]
pub(crate) struct Files(HashMap<String, Vec<u8>>);

impl Files {
    /// A single one.
    pub(crate) fn one(name: &str, bytes: Vec<u8>) -> Self {
        Self(HashMap::from([(name.to_owned(), bytes)]))
    }
}

impl<const N: usize> From<[(&str, Vec<u8>); N]> for Files {
    fn from(files: [(&str, Vec<u8>); N]) -> Self {
        Self(files.into_iter().map(|(name, bytes)| (name.to_owned(), bytes)).collect())
    }
}

impl Resources for Files {
    fn load(&self, path: &str) -> io::Result<Vec<u8>> {
        self.0.get(path).cloned().ok_or_else(|| io::ErrorKind::NotFound.into())
    }

    fn resolve(&self, path: &str) -> PathBuf {
        PathBuf::from(path)
    }
}

/// The scene of a text, which must be without fault.
#[track_caller]
pub(crate) fn scene(text: &str) -> Scene {
    scene_with(text, &Files::default())
}

/// The scene of a text and the files it names.
#[track_caller]
pub(crate) fn scene_with(text: &str, files: &Files) -> Scene {
    let mut sources = SourceMap::new();
    let (description, diagnostics) = read_pbrt_str("test.pbrt", text, files, &mut sources);
    let scene = compile(&description, files, &diagnostics);
    let told: Vec<String> = diagnostics.to_vec().iter().map(|d| d.plain(&sources)).collect();
    assert!(!diagnostics.has_errors(), "{}", told.join("\n"));
    scene.unwrap_or_else(|| panic!("no scene: {}", told.join("\n")))
}

/// Moments of the spectral radiance along `ray` in the lanes of [`LAMBDA`]. Every wavelength is the hero as often as any other, as
/// the spectral weights presume: one value is the mean of `N` samples with rotated lanes.
pub(crate) fn radiance(
    scene: &Scene,
    ray: Ray,
    rule: DispersionRule,
    values: u32,
    seed: u64,
) -> [Welford; N] {
    let tracer = PathTracer::new(scene, rule, Strategies::default(), 1);
    let sampler = Sampler::new(SamplerKind::Independent, 1, seed);
    let mut moments = [Welford::new(); N];
    for value in 0..values {
        let mut sums = [0.0; N];
        for turn in 0..N {
            let lambda = std::array::from_fn(|i| LAMBDA[(i + turn) % N]);
            let wavelengths = SampledWavelengths::new(lambda, [1.0; N]);
            let sample = sampler.at(UVec2::ZERO, value * N as u32 + turn as u32);
            let l = traced(&tracer, ray, Sample::new(&sample, wavelengths));
            for i in 0..N {
                sums[(i + turn) % N] += f64::from(l.lane(i)) / N as f64;
            }
        }
        moments.iter_mut().zip(sums).for_each(|(m, sum)| m.add(sum));
    }
    moments
}

/// The radiance of a sample that arrives along `ray`.
pub(crate) fn traced(tracer: &PathTracer<'_>, ray: Ray, sample: Sample<'_>) -> SampledSpectrum {
    let (mut rays, mut samples) = (Rays::default(), [sample]);
    rays.set(0, ray);
    tracer.trace(&SampleGroup::from(*sample.sampler), &rays, &mut samples, &mut Workspace::default());
    samples[0].radiance
}

/// A ray from `origin` toward `direction` at time 0.
pub(crate) fn ray(origin: Vec3, direction: Vec3) -> Ray {
    Ray::new(origin, direction.normalize(), 0.0)
}

/// Moments of the luminance of every pixel, by independent samples.
pub(crate) fn luminance(scene: &Scene, spp: u32, seed: u64) -> Vec<Welford> {
    let estimator = PixelEstimator::new(scene, &RenderSettings { spp, ..RenderSettings::of(scene) });
    let sampler = Sampler::new(SamplerKind::Independent, spp, seed);
    let mut workspace = Workspace::default();
    let moments = |pixel| {
        let sample = |index| estimator.sample(&sampler.at(pixel, index), &mut workspace);
        (0..spp).map(sample).map(luma).collect()
    };
    scene.film.bounds.pixels().map(moments).collect()
}

/// Luminance of linear sRGB.
pub(crate) fn luma(rgb: Vec3) -> f64 {
    0.2126 * f64::from(rgb.x) + 0.7152 * f64::from(rgb.y) + 0.0722 * f64::from(rgb.z)
}

/// The film of a scene, by what it asks for but for `change`.
pub(crate) fn film(scene: &Scene, change: impl FnOnce(&mut RenderSettings)) -> Film {
    let mut settings = RenderSettings::of(scene);
    change(&mut settings);
    let done = render(scene, &settings, &|_| true);
    assert!(done.complete);
    assert_eq!(done.statistics.dropped, 0, "{:?}", done.statistics.first_dropped);
    done.film
}

/// The channels of a picture, pixel by pixel.
pub(crate) fn channels(picture: &[Vec3]) -> Vec<f32> {
    picture.iter().flat_map(|v| v.to_array()).collect()
}

/// Checks a mean against its closed form, as one of `tests`; and that the check means something: a standard error of at most
/// `precision`, relative to `want`.
#[track_caller]
pub(crate) fn check_mean(what: &str, values: &Welford, want: f64, precision: f64, tests: usize) {
    let blunt = values.standard_error() > precision * want.abs();
    assert!(!blunt, "{what}: a standard error of {} about {want} says little", values.standard_error());
    let test = t_test_mean(&nearer(values, want, ROUNDING * want.abs()), want);
    assert!(
        test.passes(SIGNIFICANCE, tests),
        "{what}: {} ± {} instead of {want}, {test:?}",
        values.mean,
        values.standard_error()
    );
}

/// The same moments with the mean nearer to `want` by up to `slack`.
pub(crate) fn nearer(values: &Welford, want: f64, slack: f64) -> Welford {
    Welford { mean: values.mean + (want - values.mean).clamp(-slack, slack), ..*values }
}

/// Checks two independently measured means against each other, as one of `tests`; and that both are known to `precision`.
#[track_caller]
pub(crate) fn check_agreement(what: &str, a: &Welford, b: &Welford, precision: f64, tests: usize) {
    let blunt = a.standard_error().max(b.standard_error()) > precision * a.mean.abs();
    assert!(!blunt, "{what}: {a:?} and {b:?} say little");
    t_test_two(&nearer(a, b.mean, ROUNDING * b.mean.abs()), b).check(what, SIGNIFICANCE, tests);
}

/// [`check_mean`] for all lanes of a measured radiance.
#[track_caller]
pub(crate) fn check_lanes(what: &str, values: &[Welford; N], want: [f64; N], precision: f64, tests: usize) {
    for i in 0..N {
        check_mean(&format!("{what} at {} nm", LAMBDA[i]), &values[i], want[i], precision, N * tests);
    }
}

/// Checks the pixels of a picture, whose samples are between 0 and about 1, against the closed form of each. Neighbours are taken
/// together until they are expected to have enough samples of either kind for their sum to be near to normal.
#[track_caller]
pub(crate) fn check_pixels(what: &str, pixels: &[Welford], want: &[f64]) {
    assert_eq!(pixels.len(), want.len());
    struct Group {
        pixels: std::ops::Range<usize>,
        /// Expected sum of the samples, and of what they lack of 1.
        bright: f64,
        dark: f64,
    }
    let mut groups: Vec<Group> = Vec::new();
    for (i, (pixel, want)) in pixels.iter().zip(want).enumerate() {
        let n = pixel.count as f64;
        let (bright, dark) = (want * n, (1.0 - want) * n);
        match groups.last_mut() {
            Some(last) if last.bright.min(last.dark) < 100.0 => {
                last.pixels.end = i + 1;
                last.bright += bright;
                last.dark += dark;
            }
            _ => groups.push(Group { pixels: i..i + 1, bright, dark }),
        }
    }
    if let [.., before, last] = &mut groups[..]
        && last.bright.min(last.dark) < 100.0
    {
        before.pixels.end = last.pixels.end;
        groups.pop();
    }
    for group in &groups {
        let range = group.pixels.clone();
        let mean: f64 = pixels[range.clone()].iter().map(|p| p.mean).sum();
        let error = pixels[range.clone()].iter().map(Welford::variance_of_mean).sum::<f64>().sqrt();
        let expected: f64 = want[range.clone()].iter().sum();
        let off = ((mean - expected).abs() - ROUNDING * range.len() as f64).max(0.0);
        let limit = sigmas(groups.len());
        assert!(off <= limit * error, "{what}: pixels {range:?} sum up to {mean} ± {error}, not {expected}");
    }
    // A picture of the same brightness that is somewhere else does not pass.
    assert!(groups.len() > 8, "{what}: {} groups of pixels say little", groups.len());
}

/// How many standard deviations a normal variable leaves with probability [`SIGNIFICANCE`], as one of `tests`.
pub(crate) fn sigmas(tests: usize) -> f64 {
    let passes = |x: f64| {
        // Very many degrees of freedom.
        let values =
            Welford { count: 1 << 40, mean: x, squares: ((1u64 << 40) as f64 - 1.0) * (1u64 << 40) as f64 };
        t_test_mean(&values, 0.0).passes(SIGNIFICANCE, tests)
    };
    let (mut low, mut high) = (0.0, 40.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if passes(middle) { low = middle } else { high = middle }
    }
    low
}

/// The part of a polygon where `normal · p > offset` (Sutherland and Hodgman 1974). Points are (x, y).
pub(crate) fn clip(polygon: &[[f64; 2]], normal: [f64; 2], offset: f64) -> Vec<[f64; 2]> {
    let side = |p: &[f64; 2]| normal[0] * p[0] + normal[1] * p[1] - offset;
    let mut inside = Vec::new();
    for (i, a) in polygon.iter().enumerate() {
        let b = &polygon[(i + 1) % polygon.len()];
        let (sa, sb) = (side(a), side(b));
        if sa > 0.0 {
            inside.push(*a);
        }
        if (sa > 0.0) != (sb > 0.0) {
            let t = sa / (sa - sb);
            inside.push([a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]);
        }
    }
    inside
}

/// The part of a polygon between `low` and `high`.
pub(crate) fn clip_to_box(polygon: &[[f64; 2]], low: [f64; 2], high: [f64; 2]) -> Vec<[f64; 2]> {
    let p = clip(polygon, [1.0, 0.0], low[0]);
    let p = clip(&p, [-1.0, 0.0], -high[0]);
    let p = clip(&p, [0.0, 1.0], low[1]);
    clip(&p, [0.0, -1.0], -high[1])
}

/// Area of a polygon (the shoelace formula).
pub(crate) fn area(polygon: &[[f64; 2]]) -> f64 {
    let n = polygon.len();
    let cross = |i: usize| {
        let (a, b) = (polygon[i], polygon[(i + 1) % n]);
        a[0] * b[1] - a[1] * b[0]
    };
    0.5 * (0..n).map(cross).sum::<f64>().abs()
}

/// Fresnel's reflectance of unpolarised light at a boundary with relative index `n`, met at `cos_i`.
pub(crate) fn fresnel(cos_i: f64, n: f64) -> f64 {
    let sin2_t = (1.0 - cos_i * cos_i) / (n * n);
    if sin2_t >= 1.0 {
        return 1.0;
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    let s = (cos_i - n * cos_t) / (cos_i + n * cos_t);
    let p = (n * cos_i - cos_t) / (n * cos_i + cos_t);
    0.5 * (s * s + p * p)
}

/// Where pixel (x, y) of a picture lies, in pixels.
pub(crate) fn pixel_centre(index: usize, width: usize) -> Vec2 {
    Vec2::new((index % width) as f32 + 0.5, (index / width) as f32 + 0.5)
}

/// Nodes in (0, 1) and weights of the Gauss–Legendre rule of `n` points, by Newton's method on the polynomial.
pub(crate) fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let node = |i: usize| {
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..100 {
            let (mut p0, mut p1) = (1.0, x);
            for k in 2..=n {
                let k = k as f64;
                (p0, p1) = (p1, ((2.0 * k - 1.0) * x * p1 - (k - 1.0) * p0) / k);
            }
            slope = n as f64 * (x * p1 - p0) / (x * x - 1.0);
            let step = p1 / slope;
            x -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(node).collect()
}
