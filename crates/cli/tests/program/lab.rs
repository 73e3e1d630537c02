//! Experiments from the command line.

use crate::Place;

#[test]
fn experiments_write_pages_and_numbers() {
    let place = Place::new();
    let run = place.succeed(
        "lab convergence scene.pbrt integral:disk-2d --spp 1,2 --seeds 2 --max-pixels 30 --samplers n-rooks,zsobol+lens=jittered -o c.html",
    );
    assert!(run.out.is_empty() && run.err.contains("c.html, c.csv, c-slopes.csv"), "{}", run.err);
    place.succeed("lab convergence scene.pbrt --spp 1 --seeds 2 --max-pixels 30 --strategies combine=mis,scatter=cosine -q");
    let page = std::fs::read_to_string(place.path("convergence.html")).unwrap();
    assert!(
        page.contains("combine=mis")
            && page.contains("scatter=cosine")
            && page.contains("Convergence of scene.pbrt")
    );
    let run = place.succeed("lab portrait n-rooks --samples 7 --seeds 2 -q");
    assert!(run.err.is_empty());
    let mut expected = vec!["c-slopes.csv", "c.csv", "c.html", "convergence-slopes.csv", "convergence.csv"];
    expected.extend([
        "convergence.html",
        "portrait-discrepancy.csv",
        "portrait-spectrum.csv",
        "portrait.csv",
    ]);
    expected.extend(["portrait.html", "scene.pbrt"]);
    assert_eq!(place.files(), expected);
    // Four samplers and subjects, two counts, and a line of names.
    assert_eq!(std::fs::read_to_string(place.path("c.csv")).unwrap().lines().count(), 9);
}

#[test]
fn noise_and_effects_take_the_scene_or_one_of_their_own() {
    let place = Place::new();
    place.succeed(
        "lab noise scene.pbrt --spp 1 --max-pixels 30 --strategy light=uniform-area --freeze lens -q",
    );
    let noise = std::fs::read_to_string(place.path("noise.csv")).unwrap();
    assert!(noise.starts_with("variable,first-order share,first-order share standard error,total share"));
    assert!(noise.contains("\nlens,0,,0,,") && !noise.contains("\nscatter,0,"), "{noise}");
    let run = place.succeed("lab effects --spp 2,1 --max-pixels 60");
    assert!(run.err.contains("wrote effects.html, effects.csv"), "{}", run.err);
    // Eight rows of two pictures, and a line of names.
    assert_eq!(std::fs::read_to_string(place.path("effects.csv")).unwrap().lines().count(), 17);
    let run = place.run("lab noise scene.pbrt --strategy time=path:nobody");
    assert!(run.code == Some(2) && run.err.contains("nobody"), "{}", run.err);
}

#[test]
fn help_names_the_experiments() {
    let place = Place::new();
    let run = place.succeed("lab --help");
    for part in ["convergence", "effects", "noise", "portrait", "Exit codes"] {
        assert!(run.out.contains(part), "{part}");
    }
    assert!(place.succeed("lab convergence --help").out.contains("integral:smooth-10d"));
}

#[test]
fn wrong_experiments_say_what_is_wrong() {
    let place = Place::new();
    for (line, code, part) in [
        ("lab", 2, "convergence"),
        ("lab convergense", 2, "'convergence'"),
        ("lab convergence missing.pbrt", 2, "missing.pbrt"),
        ("lab convergence integral:smooth2d", 2, "did you mean integral:smooth-2d?"),
        ("lab convergence scene.pbrt --cropwindow 0.5,0.5,0,1", 2, "no pixel"),
        ("lab convergence scene.pbrt --samplers zsobol,zsobl", 2, "did you mean zsobol?"),
        ("lab convergence scene.pbrt -o page.pdf", 2, ".html"),
        ("lab convergence scene.pbrt -o missing/page.html", 1, "no such directory"),
        ("lab portrait halten", 2, "did you mean halton?"),
        ("lab portrait halton --samples 5000", 2, "4096"),
    ] {
        let run = place.run(line);
        assert_eq!(run.code, Some(code), "{line}: {}", run.err);
        assert!(run.err.contains(part), "{line}: {}", run.err);
        assert!(run.out.is_empty() && !run.err.contains("panicked"), "{line}");
    }
    assert_eq!(place.files(), ["scene.pbrt"]);
}
