//! `--noise` and `--time-limit`: pictures with an error that is stated.

use crate::Place;
use serde_json::Value;
use tenfold_image::Attribute;

#[test]
fn the_closing_line_and_the_layers_tell_the_noise() {
    let place = Place::new();
    let run =
        place.succeed("scene.pbrt --noise 0.2 --layers samples,error -o a.exr -o b.png --progress plain");
    for part in ["noise 0.", "95 %", "target 0.2", "samples a pixel"] {
        assert!(run.err.contains(part), "{part}: {}", run.err);
    }
    let picture = place.read("a.exr");
    let channel = |name: &str| {
        let c = picture.channels().iter().position(|c| c == name).unwrap();
        (0..17)
            .flat_map(|y| (0..23).map(move |x| (x, y)))
            .map(|(x, y)| picture.get(x, y, c))
            .collect::<Vec<_>>()
    };
    assert_eq!(picture.channels().len(), 8);
    assert!(channel("samples.Y").iter().all(|n| *n >= 16.0 && n.fract() == 0.0));
    for name in ["error.R", "error.G", "error.B", "error.Y"] {
        let errors = channel(name);
        assert!(errors.iter().all(|e| e.is_finite() && *e >= 0.0) && errors.iter().any(|e| *e > 0.0));
    }
    assert!(matches!(picture.metadata.attributes["noise"], Attribute::F32(noise) if noise < 0.4));
    // A layer does not change the picture, and needs no noise where it is the samples.
    let plain = place.picture("--noise 0.2");
    assert_eq!(plain.rgb(11, 8), picture.rgb(11, 8));
    assert_eq!(place.picture("--layers samples").get(3, 4, 3), 3.0);
}

#[test]
fn programs_are_told_too() {
    let place = Place::new();
    let run = place.succeed("scene.pbrt --noise 0.2 --max-spp 4096 --progress json");
    let events: Vec<Value> = run.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!((&events[0]["noise_target"], &events[0]["samples"]), (&0.2.into(), &Value::Null));
    let progress = events.iter().rfind(|e| e["event"] == "progress").unwrap();
    assert!(progress["percent"] == 100.0 && progress["noise"].as_f64().unwrap() > 0.0);
    let last = events.last().unwrap();
    let (noise, samples) = (&last["noise"], &last["samples_per_pixel"]);
    let [reached, low, high] =
        [&noise["reached"], &noise["interval_95"][0], &noise["interval_95"][1]].map(|v| v.as_f64().unwrap());
    assert!(low < reached && reached < high && noise["stop"] == "target");
    assert!(samples["least"].as_u64() <= samples["most"].as_u64());
    assert!(samples["mean"].as_f64() < samples["in_all"].as_f64());
}

#[test]
fn time_limits_are_kept_and_are_no_failure() {
    let place = Place::new();
    let run = place.succeed("scene.pbrt --time-limit 0.5s -o a.exr");
    assert!(run.err.contains("ended by the time limit"), "{}", run.err);
    assert!(!place.read("a.exr").metadata.attributes.contains_key("interruptedAfterSamples"));
}

#[test]
fn threads_and_tiles_do_not_change_the_picture() {
    let place = Place::new();
    let one = place.picture("--noise 0.25 --nthreads 1");
    let other = place.picture("--noise 0.25 --nthreads 3 --tile-size 5 --tile-order reverse");
    assert_eq!(one.as_f32(), other.as_f32());
}

#[test]
fn what_does_not_go_together_is_refused() {
    let place = Place::new();
    for (line, part) in [
        ("--min-spp 4", "--noise or --time-limit"),
        ("--max-spp 4", "--noise or --time-limit"),
        ("--allocation uniform", "--noise or --time-limit"),
        ("--noise 0.1 --min-spp 8 --max-spp 4", "--min-spp 8 is more than --max-spp 4"),
        ("--noise 0.1 --spp 4", "--spp"),
        ("--noise many", "above 0"),
        ("--time-limit 3d", "90s"),
        ("--layers error", "--noise"),
        ("--layers samples -o a.png", "EXR"),
        ("--layers depth", "samples"),
    ] {
        let run = place.run(&format!("scene.pbrt {line}"));
        assert_eq!(run.code, Some(2), "{line}: {}", run.err);
        assert!(run.err.contains(part), "{line}: {}", run.err);
    }
    assert_eq!(place.files(), ["scene.pbrt"]);
}
