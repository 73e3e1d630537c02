use super::{Discrepancy, Portrait, Spectrum, View, discrepancy::l2_star_of_independent};
use crate::{
    Cell, Page, Picture, Table,
    page::Figure,
    plot::{Axis, Chart, Mark, Point, Series},
};

/// The page of a portrait.
pub fn page(portrait: &Portrait) -> Page {
    let (name, n) = (&portrait.name, portrait.samples);
    let mut page = Page::new(&format!("Portrait of {name}"));
    page.prose(&format!(
        "What the {n} samples of one pixel look like in single variables and pairs of them, how evenly they cover the square, and how \
         the errors of neighbouring pixels hang together."
    ));

    page.heading("Points");
    page.prose(
        "The numbers of one pair are spread together. Those of different variables, and of different bounces, are put together at \
         random: no pattern may show but what each axis has alone.",
    );
    page.figures(&portrait.views.iter().map(scatter).collect::<Vec<_>>());

    page.heading("One dimension");
    page.prose(
        "Cut into as many strata as there are samples, a number may have one sample in each (hidden sampling). The plot shows how far \
         the samples, from the least to the greatest, are from the middle of the stratum of their rank: within ±½ where each has one.",
    );
    page.figure(&Figure::drawing(
        &offsets(portrait).svg(),
        "Distance from the middle of the stratum, in strata.",
    ));
    page.table(&strata(portrait));

    page.heading("Discrepancy");
    page.prose(
        "The star discrepancy is the largest difference, over all rectangles with a corner at the origin, between the share of the \
         points within and the area; the L2 star discrepancy is its root mean square. Both are exact, and means over several seeds of \
         the pair of the first figure, at numbers of samples that are powers of two and others between. Error bars are one standard error.",
    );
    let [star, l2] = discrepancies(portrait);
    page.figures(&[
        Figure::drawing(&star.svg(), "Star discrepancy against the number of samples."),
        Figure::drawing(
            &l2.svg(),
            "L2 star discrepancy. Dashed: √(5/36 N), the root of the mean square of independent points.",
        ),
    ]);

    page.heading("Spectrum of the points");
    page.prose(
        "The mean power of the points at each frequency: 1, middle grey, is that of independent points; black is none, white twice as \
         much or more. What is dark about the centre has no clumps and no holes; dark axes are one-dimensional strata.",
    );
    page.figures(&spectrum(&portrait.points, name, "frequency (periods a side)"));

    page.heading("Errors of neighbouring pixels");
    page.prose(&format!(
        "{} × {} pixels estimate the same smooth integral with {} samples each. Where low frequencies are missing (blue noise), the \
         errors of neighbours differ, and the eye takes their mean.",
        portrait.errors.side, portrait.errors.side, portrait.errors.samples
    ));
    let mut figures: Vec<Figure> = errors(portrait).into_iter().collect();
    figures.extend(spectrum(&portrait.errors.spectrum, name, "frequency (periods a picture)"));
    page.figures(&figures);

    page.data("", points(&portrait.views));
    page.data("discrepancy", discrepancy_table(portrait));
    page.data("spectrum", spectra(portrait));
    page
}

fn scatter(view: &View) -> Figure {
    let mut chart = Chart::square(view.axes[0], view.axes[1], 250.0);
    chart.series.push(Series::new("", Mark::Dots, 0, view.points.iter().map(|p| p.to_array())));
    Figure::drawing(&chart.svg(), view.about)
}

fn offsets(portrait: &Portrait) -> Chart {
    let mut chart = Chart::new(Axis::linear("number").range(0.0, 1.0), Axis::linear("offset (strata)"));
    chart.area[1] = 200.0;
    for (i, projection) in portrait.projections.iter().enumerate() {
        let points = projection.sorted.iter().zip(projection.offsets()).map(|(u, offset)| [*u, offset]);
        chart.series.push(Series::new(projection.name, Mark::Dots, i, points));
    }
    for (i, level) in [-0.5, 0.5].into_iter().enumerate() {
        let name = if i == 0 { "±½ stratum" } else { "" };
        let line = Series::new(name, Mark::Dashes, 0, [[0.0, level], [1.0, level]]);
        chart.series.push(Series { color: None, ..line });
    }
    chart
}

fn strata(portrait: &Portrait) -> Table {
    let mut table = Table::new(["number", "strata with exactly one sample (%)"]);
    for projection in &portrait.projections {
        table.row([projection.name.into(), format!("{:.1}", 100.0 * projection.stratified()).into()]);
    }
    table
}

fn discrepancies(portrait: &Portrait) -> [Chart; 2] {
    let both = [(&portrait.name[..], &portrait.discrepancies), ("independent", &portrait.independent)];
    let chart = |label: &str, of: fn(&Discrepancy) -> [f64; 2]| {
        let mut chart = Chart::new(Axis::log2("samples"), Axis::log(label));
        chart.area = [250.0, 240.0];
        for (color, (name, all)) in both.into_iter().enumerate() {
            let point = |d: &Discrepancy| {
                let [y, error] = of(d);
                Point { x: d.samples.into(), y, error }
            };
            let points = all.iter().map(point).collect();
            chart.series.push(Series {
                name: name.to_owned(),
                points,
                mark: Mark::Marks,
                color: Some(color),
            });
        }
        chart
    };
    let star = chart("star discrepancy", |d| d.star);
    let mut l2 = chart("L2 star discrepancy", |d| d.l2);
    let expected =
        portrait.independent.iter().map(|d| [d.samples.into(), l2_star_of_independent(d.samples as usize)]);
    l2.series.push(Series { color: None, ..Series::new("√(5/36 N)", Mark::Dashes, 0, expected) });
    [star, l2]
}

/// The picture and the radial mean of a spectrum.
fn spectrum(spectrum: &Spectrum, name: &str, frequency: &str) -> Vec<Figure> {
    let grey: Vec<f32> = spectrum.power.iter().map(|p| (0.5 * p) as f32).collect();
    let picture = Picture::from_grey(spectrum.side(), &grey).ok();
    let scale = (260.0 / f64::from(spectrum.side())).round().max(1.0) as u32;
    let largest = spectrum.largest;
    let caption = format!("Power at frequencies from −{largest} to {largest} in both directions.");
    let mut radial = Chart::new(Axis::linear(frequency), Axis::linear("power").range(0.0, 2.0));
    radial.area = [270.0, 220.0];
    radial.series.push(Series::new(name, Mark::Line, 0, spectrum.radial()));
    let one = Series::new("independent", Mark::Dashes, 0, [[0.0, 1.0], [largest.into(), 1.0]]);
    radial.series.push(Series { color: None, ..one });
    let picture = picture.map(|p| Figure::picture(&p, scale, &caption));
    picture
        .into_iter()
        .chain([Figure::drawing(&radial.svg(), "The mean power over all directions.")])
        .collect()
}

fn errors(portrait: &Portrait) -> Option<Figure> {
    let errors = &portrait.errors;
    let n = errors.picture.len().max(1) as f64;
    let deviation = (errors.picture.iter().map(|e| e * e).sum::<f64>() / n).sqrt().max(f64::MIN_POSITIVE);
    let grey: Vec<f32> = errors.picture.iter().map(|e| (0.5 + 0.2 * e / deviation) as f32).collect();
    let picture = Picture::from_grey(errors.side, &grey).ok()?;
    let caption = "The errors; grey is none, black and white are 2.5 standard deviations.";
    Some(Figure::picture(&picture, 4, caption))
}

fn points(views: &[View]) -> Table {
    let mut table = Table::new(["x is", "y is", "x", "y"]);
    for view in views {
        for p in &view.points {
            table.row([view.axes[0].into(), view.axes[1].into(), p.x.into(), p.y.into()]);
        }
    }
    table
}

fn discrepancy_table(portrait: &Portrait) -> Table {
    let mut table = Table::new(["sampler", "samples", "star discrepancy", "L2 star discrepancy"]);
    for (name, all) in [(&portrait.name[..], &portrait.discrepancies), ("independent", &portrait.independent)]
    {
        for d in all {
            let [star, l2] = [d.star, d.l2].map(|[mean, error]| Cell::Measured(mean, error));
            table.row([name.into(), d.samples.into(), star, l2]);
        }
    }
    table
}

fn spectra(portrait: &Portrait) -> Table {
    let mut table = Table::new(["of", "frequency", "power"]);
    for (of, spectrum) in [("points", &portrait.points), ("errors of pixels", &portrait.errors.spectrum)] {
        spectrum.radial().into_iter().for_each(|[k, power]| table.row([of.into(), k.into(), power.into()]));
    }
    table
}
