use super::{Effect, Row};
use crate::{
    Page, Picture, Table,
    page::{Figure, Grid, GridRow},
    table::shown,
};

/// Pixels of the page that the large pictures are wide, at most.
const LARGE: u32 = 450;

/// The page of the table of effects of the scene called `scene`, whose pictures are `width` pixels wide.
pub fn page(scene: &str, width: u32, rows: &[Row]) -> Page {
    let mut page = Page::new(&format!("Effects of {scene}"));
    page.prose(
        "Every optical effect is a variable of one integral. Where the variable is held at one value the effect is gone; where it is \
         drawn for every sample it is there, and with few samples a pixel is noisy. All variables are drawn together, by the same \
         samples: their numbers do not multiply.",
    );
    page.prose(
        "Below each picture its noise, the quadratic mean over the pixels of error over brightness around, and the seconds that it \
         took. Choices, of a light or of reflection against refraction, and wavelengths are drawn in all rows. Where directions \
         are held, those of matt surfaces are, too: light that came by way of other surfaces is left as faint images of them.",
    );
    let counts = || rows.first().into_iter().flat_map(|row| row.cells.iter().map(|cell| cell.spp));
    let columns = counts().map(|n| format!("{n} sample{}", if n == 1 { "" } else { "s" })).collect();
    let row = |row: &Row| GridRow {
        name: row.name.to_owned(),
        about: about(row),
        cells: row
            .cells
            .iter()
            .filter_map(|cell| {
                // Only what has no pixels is no picture.
                let picture = Picture::from_linear_rgb(width, &cell.picture).ok()?;
                Some((picture, format!("noise {} · {} s", shown(cell.noise), shown(cell.seconds))))
            })
            .collect(),
    };
    page.grid(&Grid { columns, rows: rows.iter().map(row).collect() });

    page.heading("With and without");
    let large = |row: Option<&Row>| {
        let (row, cell) = row.and_then(|row| Some((row, row.cells.last()?)))?;
        let picture = Picture::from_linear_rgb(width, &cell.picture).ok()?;
        let scale = (LARGE / width.max(1)).max(1);
        Some(Figure::picture(&picture, scale, &format!("{}, {} samples a pixel.", row.name, cell.spp)))
    };
    page.figures(&[rows.first(), rows.last()].into_iter().filter_map(large).collect::<Vec<_>>());

    let mut table = Table::new(["effect", "samples per pixel", "noise", "seconds"]);
    for row in rows {
        for cell in &row.cells {
            table.row([row.name.into(), cell.spp.into(), cell.noise.into(), cell.seconds.into()]);
        }
    }
    page.data("", table);
    page
}

fn about(row: &Row) -> String {
    match &row.on[..] {
        [] => "all held".to_owned(),
        [effect] => effect.variable().to_owned(),
        on if on.len() == Effect::ALL.len() => "all drawn".to_owned(),
        on => on.iter().map(|e| e.name()).collect::<Vec<_>>().join(", "),
    }
}
