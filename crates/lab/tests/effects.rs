//! The table of effects.

use tenfold_lab::{
    Work,
    effects::{Effect, page, table, work_of},
};
use tenfold_render::{
    compile::{coarsen, compile},
    schedule::RenderSettings,
};
use tenfold_scene::{FileResources, SourceMap, read_pbrt};

/// The scene that comes with the program has all effects, and its noise falls.
#[test]
fn every_effect_shows() {
    let path = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/effects.pbrt"));
    let (mut description, diagnostics) = read_pbrt(path, &mut SourceMap::new());
    coarsen(&mut description, 600);
    let scene = compile(&description, &FileResources::beside(path), &diagnostics).unwrap();
    let settings = RenderSettings::of(&scene);
    let counts = [4, 64];
    let last = std::sync::atomic::AtomicU64::new(0);
    let observe = |progress: tenfold_render::schedule::Progress| {
        last.fetch_max(progress.done, std::sync::atomic::Ordering::Relaxed);
        true
    };
    let total = work_of(&settings, &counts);
    let rows = table(&scene, &settings, &counts, &mut Work::new(total, &observe)).unwrap();
    assert_eq!(last.into_inner(), total);

    let names: Vec<_> = rows.iter().map(|row| row.name).collect();
    let effects = Effect::ALL.map(Effect::name);
    assert_eq!(names[0], "no effect");
    assert_eq!((&names[1..7], names[7]), (&effects[..], "all together"));
    for row in &rows {
        println!("{:16} {:.3} {:.3}", row.name, row.cells[0].noise, row.cells[1].noise);
        assert!(row.cells[1].noise < 0.6 * row.cells[0].noise, "{}", row.name);
    }
    // Where the effect is, the mean over the picture of the change is above what noise does: by this much.
    let change = |name: &str| {
        let row = rows.iter().find(|row| row.name == name).unwrap();
        let pairs = || row.cells[1].picture.iter().zip(&rows[0].cells[1].picture);
        pairs().map(|(a, b)| (*a - *b).abs().element_sum()).sum::<f32>()
            / pairs().map(|(_, b)| b.element_sum()).sum::<f32>()
    };
    for name in effects {
        println!("{name:16} {:.3}", change(name));
        assert!(change(name) > 0.01, "{name}");
    }
    assert!(change("all together") > 0.05);
    assert!(page("effects.pbrt", 30, &rows).html("effects").matches("<img").count() == 18);
}
