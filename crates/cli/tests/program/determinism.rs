//! Neither threads nor tiles nor the part that is rendered change a bit of a pixel.

use crate::Place;
use tenfold_image::Image;

/// The bits of a picture, so that a difference in the sign of a zero would show as well.
fn bits(image: &Image) -> Vec<u32> {
    image.as_f32().unwrap().iter().map(|v| v.to_bits()).collect()
}

#[test]
fn threads_and_tiles_do_not_change_the_picture() {
    let place = Place::new();
    let whole = bits(&place.picture("--nthreads 1"));
    assert!(whole.iter().any(|&b| b != 0));
    for options in [
        "--nthreads 2",
        "--nthreads 3 --tile-size 1",
        "--nthreads 2 --tile-size 7 --tile-order rows",
        "--nthreads 1 --tile-size 16 --tile-order reverse",
        "--nthreads 2 --tile-size 64 --tile-order centre",
        "--nthreads 2 --tile-size 1 --tile-order reverse",
        "--nthreads 1 --tile-size 7 --tile-order reverse",
    ] {
        assert_eq!(bits(&place.picture(options)), whole, "{options}");
    }
}

#[test]
fn blocks_of_samples_do_not_change_the_picture() {
    // More samples than one piece of work takes.
    let place = Place::new();
    let small = "--spp 150 --pixelbounds 8,13,5,9";
    let whole = bits(&place.picture(&format!("{small} --nthreads 1")));
    assert_eq!(bits(&place.picture(&format!("{small} --nthreads 2 --tile-size 2"))), whole);
}

#[test]
fn every_sampler_and_rule_repeats_itself() {
    let place = Place::new();
    let mut seen = Vec::new();
    for options in [
        "--sampler independent",
        "--sampler stratified",
        "--sampler paddedsobol",
        "--sampler zsobol",
        "--sampler n-rooks",
        "--sampler multi-jittered",
        "--sampler halton",
        "--dispersion terminate",
        "--seed 7",
    ] {
        let one = bits(&place.picture(&format!("{options} --nthreads 1")));
        assert_eq!(bits(&place.picture(&format!("{options} --nthreads 2 --tile-size 5"))), one, "{options}");
        assert!(!seen.contains(&one), "{options} changes nothing");
        seen.push(one);
    }
}

#[test]
fn a_pixel_alone_is_the_same_pixel() {
    let place = Place::new();
    let whole = place.picture("");
    for (x, y) in [(0, 0), (22, 16), (9, 8), (14, 10)] {
        let run = place.succeed(&format!("scene.pbrt -q --pixel {x},{y}"));
        let value: Vec<f32> = (0..3).map(|c| whole.get(x, y, c)).collect();
        assert_eq!(run.out, format!("{x},{y}: {} {} {}\n", value[0], value[1], value[2]));
        assert_eq!(bits(&place.picture(&format!("--pixel {x},{y}"))), bits_of(&value));
    }
    assert_eq!(place.files(), ["out.exr", "scene.pbrt"]);
}

fn bits_of(values: &[f32]) -> Vec<u32> {
    values.iter().map(|v| v.to_bits()).collect()
}

#[test]
fn a_part_is_the_same_part() {
    let place = Place::new();
    let whole = place.picture("");
    for (options, [x0, x1, y0, y1]) in [
        ("--pixelbounds 3,20,2,9", [3, 20, 2, 9]),
        ("--pixelbounds -5,4,10,99", [0, 4, 10, 17]),
        ("--cropwindow 0.25,0.75,0,0.5", [6, 18, 0, 9]),
        ("--cropwindow 0.5 1 0.5 1", [12, 23, 9, 17]),
    ] {
        let part = place.picture(options);
        assert_eq!(
            (part.metadata.origin, part.resolution()),
            ((x0, y0), ((x1 - x0) as u32, (y1 - y0) as u32))
        );
        let window = part.metadata.display_window.unwrap();
        assert_eq!((window.x, window.y, window.width, window.height), (0, 0, 23, 17));
        for (y, x) in (y0..y1).flat_map(|y| (x0..x1).map(move |x| (y, x))) {
            let (inner, outer) = ((x - x0) as u32, (y - y0) as u32);
            assert_eq!(part.rgb(inner, outer), whole.rgb(x as u32, y as u32), "{options}: {x},{y}");
        }
    }
}
