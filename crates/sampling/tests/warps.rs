//! Every warp against its density (χ²) and its inverse (round trip).

use tenfold_math::{ONE_MINUS_EPSILON, Vec2, Vec3, vec2};
use tenfold_sampling::warp::*;
use tenfold_testkit::{ChiSquared, Options, Rng, chi2};

fn options() -> Options {
    Options { tests: 50, ..Options::default() }
}

/// Points of the unit square, the corners among them.
fn points() -> Vec<Vec2> {
    let ends = [0.0, 1e-7, 0.5, 0.999, ONE_MINUS_EPSILON];
    let mut rng = Rng::new(17);
    let corners = ends.iter().flat_map(|&x| ends.map(|y| vec2(x, y)));
    corners.chain((0..2000).map(|_| rng.vec2())).collect()
}

fn directions(what: &str, sample: impl Fn(Vec2) -> Vec3, pdf: impl Fn(Vec3) -> f32) {
    for u in points() {
        let d = sample(u);
        assert!((d.length() - 1.0).abs() < 1e-5 && pdf(d) >= 0.0, "{what}: {u} {d}");
    }
    chi2::sphere_test(|_, u| Some(sample(u)), |d| f64::from(pdf(d)), &options()).check(what);
}

fn line(
    what: &str,
    low: f32,
    high: f32,
    sample: impl Fn(f32) -> f32,
    pdf: impl Fn(f32) -> f32,
) -> ChiSquared {
    let o = Options { theta_bins: 10, phi_bins: 10, ..options() };
    // Samples beyond the range tested count as none.
    let inside = |x: f32| (low..=high).contains(&x).then_some(x);
    let result = chi2::interval_test(low, high, |u| inside(sample(u)), |x| f64::from(pdf(x)), &o);
    result.check(what);
    result
}

fn round_trip_1d(what: &str, tolerance: f32, sample: impl Fn(f32) -> f32, invert: impl Fn(f32) -> f32) {
    for i in 1..1000 {
        let u = i as f32 / 1000.0;
        assert!((invert(sample(u)) - u).abs() < tolerance, "{what}: {u} {} {}", sample(u), invert(sample(u)));
    }
}

fn round_trip_2d<T>(what: &str, tolerance: f32, sample: impl Fn(Vec2) -> T, invert: impl Fn(T) -> Vec2) {
    let mut rng = Rng::new(3);
    for _ in 0..2000 {
        let u = rng.vec2();
        let v = invert(sample(u));
        assert!((u - v).abs().max_element() < tolerance, "{what}: {u} {v}");
    }
}

#[test]
fn disks() {
    let pdf = |p: Vec2| if p.length() <= 1.0 { f64::from(uniform_disk_pdf()) } else { 0.0 };
    let (low, high) = (Vec2::splat(-1.0), Vec2::ONE);
    let o = options();
    chi2::rectangle_test(low, high, |u| Some(sample_uniform_disk_concentric(u)), pdf, &o).check("concentric");
    chi2::rectangle_test(low, high, |u| Some(sample_uniform_disk_polar(u)), pdf, &o).check("polar");
    round_trip_2d("concentric", 1e-5, sample_uniform_disk_concentric, invert_uniform_disk_concentric);
    round_trip_2d("polar", 1e-5, sample_uniform_disk_polar, invert_uniform_disk_polar);
    for u in points() {
        assert!(sample_uniform_disk_concentric(u).length() < 1.0 + 1e-6);
    }
    assert_eq!(sample_uniform_disk_concentric(Vec2::splat(0.5)), Vec2::ZERO);
    assert_eq!(invert_uniform_disk_concentric(Vec2::ZERO), Vec2::splat(0.5));
}

#[test]
fn hemispheres_and_spheres() {
    directions("cosine", sample_cosine_hemisphere, |d| cosine_hemisphere_pdf(d.z));
    directions("hemisphere", sample_uniform_hemisphere, |d| {
        if d.z < 0.0 { 0.0 } else { uniform_hemisphere_pdf() }
    });
    directions("sphere", sample_uniform_sphere, |_| uniform_sphere_pdf());
    round_trip_2d("cosine", 1e-5, sample_cosine_hemisphere, invert_cosine_hemisphere);
    round_trip_2d("hemisphere", 1e-5, sample_uniform_hemisphere, invert_uniform_hemisphere);
    round_trip_2d("sphere", 1e-5, sample_uniform_sphere, invert_uniform_sphere);
}

#[test]
fn cones() {
    for versine in [0.02f32, 0.3, 1.0, 1.7, 2.0] {
        let pdf = |d: Vec3| if 1.0 - d.z <= versine { uniform_cone_pdf(versine) } else { 0.0 };
        directions(&format!("cone {versine}"), |u| sample_uniform_cone(u, versine), pdf);
        round_trip_2d("cone", 3e-4, |u| sample_uniform_cone(u, versine), |d| invert_uniform_cone(d, versine));
    }
    // A disk as small as a star's: the radius must still be uniform in area.
    let versine = 1e-11;
    round_trip_2d("star", 1e-5, |u| sample_uniform_cone(u, versine), |d| invert_uniform_cone(d, versine));
}

#[test]
fn triangles() {
    // The first two barycentric coordinates are uniform below the diagonal.
    let pdf = |p: Vec2| if p.x + p.y <= 1.0 { 2.0 } else { 0.0 };
    let sample = |u| Some(sample_uniform_triangle(u).truncate());
    chi2::square_test(sample, pdf, &options()).check("triangle");
    round_trip_2d("triangle", 1e-5, sample_uniform_triangle, invert_uniform_triangle);
    for u in points() {
        let b = sample_uniform_triangle(u);
        assert!(b.min_element() >= 0.0 && (b.element_sum() - 1.0).abs() < 1e-6, "{u}: {b}");
    }
}

#[test]
fn lines_and_bilinear_patches() {
    for (a, b) in [(1.0, 1.0), (0.0, 1.0), (3.0, 0.0), (0.2, 5.0), (0.0, 0.0), (1e-30, 1e30), (1e-38, 3e-38)]
    {
        let what = format!("line {a} {b}");
        line(&what, 0.0, 1.0, |u| sample_linear(u, a, b), |x| linear_pdf(x, a, b));
        round_trip_1d(&what, 1e-5, |u| sample_linear(u, a, b), |x| invert_linear(x, a, b));
        assert!((0.0..1.0).contains(&sample_linear(ONE_MINUS_EPSILON, a, b)));
        assert_eq!(sample_linear(0.0, a, b), 0.0);
    }
    for w in [[1.0; 4], [0.0, 1.0, 2.0, 3.0], [5.0, 0.0, 0.0, 1.0], [0.0; 4], [0.0, 0.0, 0.0, 1.0]] {
        let what = format!("bilinear {w:?}");
        let pdf = |p| f64::from(bilinear_pdf(p, w));
        chi2::square_test(|u| Some(sample_bilinear(u, w)), pdf, &options()).check(&what);
        round_trip_2d(&what, 1e-3, |u| sample_bilinear(u, w), |p| invert_bilinear(p, w));
    }
}

#[test]
fn tents_exponentials_and_normals() {
    line("tent", -1.5, 1.5, |u| sample_tent(u, 1.5), |x| tent_pdf(x, 1.5));
    round_trip_1d("tent", 1e-5, |u| sample_tent(u, 1.5), |x| invert_tent(x, 1.5));
    line("exponential", 0.0, 3.0, |u| sample_exponential(u, 2.0), |x| exponential_pdf(x, 2.0));
    round_trip_1d("exponential", 1e-5, |u| sample_exponential(u, 2.0), |x| invert_exponential(x, 2.0));
    line("normal", -2.0, 5.0, |u| sample_normal(u, 1.0, 1.5), |x| normal_pdf(x, 1.0, 1.5));
    round_trip_1d("normal", 1e-5, |u| sample_normal(u, 1.0, 1.5), |x| invert_normal(x, 1.0, 1.5));
    assert!(sample_normal(0.0, 0.0, 1.0).is_finite() && sample_normal(ONE_MINUS_EPSILON, 0.0, 1.0) > 4.5);
    for (sigma, radius) in [(0.5, 1.5), (1.0, 0.4), (0.2, 3.0)] {
        let n = TruncatedNormal::new(sigma, radius);
        line("truncated normal", -radius, radius, |u| n.sample(u), |x| n.pdf(x));
        round_trip_1d("truncated normal", 1e-5, |u| n.sample(u), |x| n.invert(x));
        assert!(n.sample(0.0) >= -radius && n.sample(ONE_MINUS_EPSILON) <= radius);
    }
    let (low, high) = (Vec2::splat(-3.0), Vec2::splat(4.0));
    let inside = |p: Vec2| (p.cmpge(low).all() && p.cmple(high).all()).then_some(p);
    let pdf = |p: Vec2| f64::from(normal_pdf(p.x, 0.5, 1.2) * normal_pdf(p.y, 0.5, 1.2));
    chi2::rectangle_test(low, high, |u| inside(sample_two_normals(u, 0.5, 1.2)), pdf, &options())
        .check("two normals");
    // Abramowitz and Stegun, table 7.1, and the complement at 4.
    for (x, y) in [
        (0.5, 0.520_499_877_8),
        (1.0, 0.842_700_792_9),
        (-2.0, -0.995_322_265_0),
        (4.0, 1.0 - 1.541_725_8e-8),
    ] {
        assert!((erf(x) - y).abs() < 1e-10, "{x}: {}", erf(x));
    }
}

/// Triangles and points to see them from: ordinary, grazing, close, large, far.
fn views() -> Vec<(Vec3, [Vec3; 3])> {
    let v = |x, y, z| Vec3::new(x, y, z);
    vec![
        (Vec3::ZERO, [Vec3::X, Vec3::Y, Vec3::Z]),
        (v(0.3, 0.2, -0.1), [v(-1.0, -1.0, 1.0), v(2.0, -1.0, 1.5), v(0.0, 3.0, 0.8)]),
        (v(0.1, 0.1, 0.01), [v(-1.0, -1.0, 0.0), v(1.0, -1.0, 0.0), v(0.0, 1.0, 0.0)]),
        (v(3.0, 0.2, 0.1), [v(-1.0, -1.0, 0.0), v(1.0, -1.0, 0.0), v(0.0, 1.0, 0.0)]),
        (v(10.0, 20.0, 30.0), [v(10.0, 20.4, 36.0), v(10.5, 20.0, 36.0), v(10.0, 19.6, 36.2)]),
    ]
}

/// Whether the ray from `from` along `d` hits the triangle.
fn hits(from: Vec3, [a, b, c]: [Vec3; 3], d: Vec3) -> bool {
    let [a, b, c, d] = [a - from, b - from, c - from, d].map(|v| v.as_dvec3());
    let side = [d.dot(a.cross(b)), d.dot(b.cross(c)), d.dot(c.cross(a))];
    let front = a.dot(b.cross(c)).signum();
    side.iter().all(|s| s * front >= 0.0)
}

#[test]
fn spherical_triangles() {
    for (i, (from, vertices)) in views().into_iter().enumerate() {
        let t = SphericalTriangle::new(from, vertices).unwrap();
        let pdf = |d| if hits(from, vertices, d) { t.pdf() } else { 0.0 };
        directions(&format!("triangle {i}"), |u| t.sample(u).unwrap().direction, pdf);
        // A float direction has an error of 1e-7: that over the triangle's extent is what the inverse can tell.
        let tolerance = 3e-6 / t.solid_angle();
        round_trip_2d("triangle", tolerance.max(1e-4), |u| t.sample(u).unwrap().direction, |d| t.invert(d));
        for u in points() {
            let s = t.sample(u).unwrap();
            let p =
                vertices[0] * s.barycentric.x + vertices[1] * s.barycentric.y + vertices[2] * s.barycentric.z;
            // The points are floats of magnitude 36 at most.
            let miss = ((p - from) - s.direction * (p - from).length()).length();
            assert!(miss < 1e-5 && s.barycentric.min_element() >= 0.0, "{i} {u}: {s:?}");
        }
    }
    let [a, b, c] = [Vec3::X, Vec3::Y, Vec3::Z];
    assert!(
        (SphericalTriangle::new(Vec3::ZERO, [a, b, c]).unwrap().solid_angle() - std::f32::consts::FRAC_PI_2)
            .abs()
            < 1e-6
    );
    assert_eq!(SphericalTriangle::new(Vec3::ZERO, [a, b, b]), None);
    assert_eq!(SphericalTriangle::new(a, [a, b, c]), None);
    assert_eq!(SphericalTriangle::new(Vec3::ZERO, [a, b, Vec3::new(1.0, 1.0, 0.0)]), None);
    assert_eq!(SphericalTriangle::new(Vec3::ZERO, [Vec3::NAN, b, c]), None);
}

#[test]
fn spherical_triangles_that_look_small_are_sampled_like_flat_ones() {
    // Seen from afar, uniform in solid angle is uniform in area.
    for distance in [1e2f32, 1e4, 1e6] {
        let vertices =
            [Vec3::new(-1.0, -1.0, distance), Vec3::new(2.0, -1.0, distance), Vec3::new(0.0, 1.0, distance)];
        let t = SphericalTriangle::new(Vec3::ZERO, vertices).unwrap();
        let area = 3.0 / (distance * distance);
        assert!((t.solid_angle() / area - 1.0).abs() < 1e-3, "{distance}: {}", t.solid_angle() / area);
        let pdf = |p: Vec2| if p.x + p.y <= 1.0 { 2.0 } else { 0.0 };
        let sample = |u| Some(t.sample(u)?.barycentric.truncate());
        chi2::square_test(sample, pdf, &Options { samples: 50_000, ..options() })
            .check(&format!("from {distance}"));
    }
}

#[test]
fn spherical_rectangles() {
    let (v, size) = (|x, y, z| Vec3::new(x, y, z), Vec2::new(2.0, 3.0));
    for (i, (corner, size)) in [
        (v(-1.0, -1.5, 1.0), size),
        (v(-1.0, -1.5, -0.05), size),
        (v(0.0, 0.0, 1.0), size),
        (v(-8.4, 1.2, 3.5), Vec2::ONE),
        (v(-6.0, -0.2, 1.1), Vec2::new(2.0, 4.0)),
        (v(3.0, -0.5, -0.3), size),
    ]
    .into_iter()
    .enumerate()
    {
        let r = SphericalRectangle::new(corner, size).unwrap();
        let (eu, ev) = (v(size.x, 0.0, 0.0), v(0.0, size.y, 0.0));
        let corners = [corner, corner + eu, corner + eu + ev, corner + ev];
        let halves = [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]];
        let pdf = |d| if halves.iter().any(|&h| hits(Vec3::ZERO, h, d)) { r.pdf() } else { 0.0 };
        let toward = |place: Vec2| (corner + (place * size).extend(0.0)).normalize();
        directions(&format!("rectangle {i}"), |u| toward(r.sample(u)), pdf);
        round_trip_2d("rectangle", 1e-4, |u| r.sample(u), |place| r.invert(place));
        let triangles: f32 =
            halves.iter().map(|&h| SphericalTriangle::new(Vec3::ZERO, h).unwrap().solid_angle()).sum();
        assert!((r.solid_angle() / triangles - 1.0).abs() < 1e-4);
        for (distance, corner) in r.corner_distances().into_iter().zip([0, 1, 3, 2].map(|k| corners[k])) {
            assert!((distance / corner.length() - 1.0).abs() < 1e-6, "{i}: {corner}");
        }
    }
    assert_eq!(SphericalRectangle::new(v(1.0, 1.0, 0.0), size), None);
    assert_eq!(SphericalRectangle::new(v(1.0, 1.0, 1.0), Vec2::new(0.0, 3.0)), None);
    assert_eq!(SphericalRectangle::new(Vec3::NAN, size), None);
}

#[test]
fn spherical_rectangles_that_look_small_are_sampled_like_flat_ones() {
    for distance in [1e2f32, 1e3, 1e4] {
        let r = SphericalRectangle::new(Vec3::new(-1.0, -0.3, distance), Vec2::new(2.0, 1.0)).unwrap();
        assert!((r.solid_angle() * distance * distance / 2.0 - 1.0).abs() < 1e-3, "{distance}");
        let o = Options { samples: 50_000, ..options() };
        chi2::square_test(|u| Some(r.sample(u)), |_| 1.0, &o).check(&format!("from {distance}"));
    }
}

#[test]
fn spherical_rectangles_at_all_scales_give_places_within() {
    let mut rng = Rng::new(7);
    for scale in [1e-9f32, 1e-3, 1.0, 1e4, 1e9] {
        for _ in 0..2000 {
            let flat = [1.0, 1e-6][rng.below(2)];
            let size = scale * (rng.vec2() + 1e-3);
            let corner = 3.0 * scale * rng.direction() * Vec3::new(1.0, 1.0, flat);
            let Some(r) = SphericalRectangle::new(corner, size) else { continue };
            assert!(r.pdf() > 0.0 && r.solid_angle() < 6.284, "{corner} {size}");
            for u in [Vec2::ZERO, rng.vec2(), Vec2::splat(tenfold_math::ONE_MINUS_EPSILON)] {
                let place = r.sample(u);
                let within = |x: f32| (0.0..=1.0).contains(&x);
                assert!(within(place.x) && within(place.y), "{corner} {size} {u}: {place}");
                let back = r.invert(place);
                assert!(within(back.x) && within(back.y), "{corner} {size} {place}: {back}");
            }
        }
    }
}
