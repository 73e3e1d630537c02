//! RGB to spectrum and back to RGB, under the illuminant of the colour space.

use tenfold_spectrum::{
    LAMBDA_MAX, LAMBDA_MIN, Observer, Rgb, RgbColorSpace, SampledWavelengths, SigmoidPolynomial,
};

/// RGB of a reflectance under the illuminant of its colour space, by a sum over whole nanometres.
fn seen(cs: &RgbColorSpace, s: &SigmoidPolynomial) -> Rgb {
    let observer = Observer::cie1931();
    let mut xyz = [0.0f64; 3];
    let mut white = 0.0;
    for nm in LAMBDA_MIN as u32..=LAMBDA_MAX as u32 {
        let lambda = nm as f32;
        let m = observer.matching(lambda).0 * cs.illuminant().eval(lambda);
        let value = f64::from(s.eval(lambda));
        for (sum, m) in xyz.iter_mut().zip(m.to_array()) {
            *sum += f64::from(m) * value;
        }
        white += f64::from(m.y);
    }
    let [x, y, z] = xyz.map(|v| (v / white) as f32);
    cs.to_rgb(tenfold_spectrum::Xyz::new(x, y, z))
}

/// Largest and mean, over a grid of `n`³ colours up to `top`, of the largest difference of a component over the largest component.
fn differences(cs: &RgbColorSpace, n: u32, top: f32, f: impl Fn(Rgb) -> SigmoidPolynomial) -> (f32, f32) {
    let (mut largest, mut sum) = (0.0f32, 0.0);
    for i in 1..n.pow(3) {
        let [r, g, b] = [i % n, i / n % n, i / n / n].map(|k| k as f32 / (n - 1) as f32 * top);
        let c = Rgb::new(r, g, b);
        let e = (seen(cs, &f(c)).0 - c.0).abs().max_element() / c.0.max_element();
        largest = largest.max(e);
        sum += e;
    }
    (largest, sum / (n.pow(3) - 1) as f32)
}

#[test]
fn solved_colours_come_back() {
    let cs = RgbColorSpace::srgb();
    for (n, top) in [(12, 1.0), (7, 0.999), (7, 0.5), (5, 0.02), (4, 1e-3)] {
        let (largest, _) = differences(cs, n, top, |c| cs.solve_sigmoid(c));
        assert!(largest < 2e-5, "up to {top}: {largest}");
    }
}

/// The precision that the documentation states, over bright and dark colours.
#[test]
fn looked_up_colours_come_back_nearly() {
    let cs = RgbColorSpace::srgb();
    for (n, top) in [(14, 1.0), (13, 0.96), (11, 0.5)] {
        let (largest, mean) = differences(cs, n, top, |c| cs.to_sigmoid(c));
        assert!(largest < 0.01 && mean < 0.001, "up to {top}: largest {largest}, mean {mean}");
    }
    for (n, top) in [(9, 0.1), (7, 0.01), (6, 1e-3)] {
        let (largest, mean) = differences(cs, n, top, |c| cs.to_sigmoid(c));
        assert!(largest < 0.12 && mean < 0.01, "up to {top}: largest {largest}, mean {mean}");
    }
    let (largest, mean) = differences(cs, 6, 1e-5, |c| cs.to_sigmoid(c));
    assert!(largest * 1e-5 < 2e-5 && mean < 0.1, "nearly black: largest {largest}, mean {mean}");
}

/// Colours of middling saturation are within all gamuts and the reach of the sigmoids. This also fails where a shipped table is not of
/// today's solver.
#[test]
fn other_colour_spaces_meet_colours_within_reach() {
    for cs in RgbColorSpace::all() {
        let n = 5u32;
        for i in 0..n.pow(3) {
            let [r, g, b] = [i % n, i / n % n, i / n / n].map(|k| k as f32);
            let c = Rgb::new(0.3 + 0.07 * r, 0.35 + 0.06 * g, 0.25 + 0.08 * b);
            let solved = (seen(cs, &cs.solve_sigmoid(c)).0 - c.0).abs().max_element();
            assert!(solved < 1e-5, "{} {c:?}: {solved}", cs.name());
            let looked_up = (seen(cs, &cs.to_sigmoid(c)).0 - c.0).abs().max_element();
            assert!(looked_up < 2e-3, "{} {c:?}: {looked_up}", cs.name());
        }
    }
}

/// Colours that no sigmoid polynomial has still get a finite one, and the nearest is not far from the table's.
#[test]
fn colours_out_of_reach_are_tame() {
    for cs in RgbColorSpace::all() {
        for c in [
            Rgb::new(1.0, 0.0, 0.0),
            Rgb::new(0.0, 1.0, 0.0),
            Rgb::new(0.0, 0.0, 1.0),
            Rgb::new(0.9, 1.0, 0.0),
        ] {
            for s in [cs.solve_sigmoid(c), cs.to_sigmoid(c)] {
                assert!(s.c.iter().all(|c| c.is_finite()), "{} {c:?}: {s:?}", cs.name());
                assert!(seen(cs, &s).0.is_finite());
            }
        }
    }
}

#[test]
fn texels_agree_with_constants() {
    let cs = RgbColorSpace::srgb();
    let w = SampledWavelengths::sample_visible(0.3);
    let c = Rgb::new(0.3, 0.2, 0.1);
    let albedo = tenfold_spectrum::RgbAlbedo::new(cs, c).sample(&w);
    assert!((cs.sample_albedo(c, &w) - albedo).0.abs().max_element() < 1e-3);
    let bright = Rgb(c.0 * 50.0);
    let unbounded = tenfold_spectrum::RgbUnbounded::new(cs, bright).sample(&w);
    assert!((cs.sample_unbounded(bright, &w) / unbounded - 1.0).0.abs().max_element() < 5e-3);
    let light = tenfold_spectrum::RgbIlluminant::new(cs, bright).sample(&w);
    assert!((cs.sample_illuminant(bright, &w) / light - 1.0).0.abs().max_element() < 5e-3);
    assert!(cs.sample_albedo(Rgb::default(), &w).is_black());
    assert!(cs.sample_unbounded(Rgb::default(), &w).is_black());
}

/// Greys are exact in the table too, and components are clamped.
#[test]
fn greys_and_clamping() {
    for cs in RgbColorSpace::all() {
        for v in [0.0, 0.18, 0.5, 1.0] {
            let s = cs.to_sigmoid(Rgb::new(v, v, v));
            assert!((s.eval(555.0) - v).abs() < 1e-7);
        }
        assert_eq!(cs.to_sigmoid(Rgb::new(2.0, 0.5, -1.0)), cs.to_sigmoid(Rgb::new(1.0, 0.5, 0.0)));
        assert_eq!(cs.solve_sigmoid(Rgb::new(2.0, 0.5, -1.0)), cs.solve_sigmoid(Rgb::new(1.0, 0.5, 0.0)));
    }
}
