use super::{Convergence, Curve, ErrorPoint, FITTED_FROM, PowerLaw};
use crate::{
    Cell, Page, Table,
    page::Figure,
    plot::{Axis, Chart, Mark, Point, Series},
};
use tenfold_math::ops;

/// The page of one or more experiments.
pub fn page(results: &[Convergence]) -> Page {
    let title = match results {
        [one] => format!("Convergence of {}", one.subject),
        _ => "Convergence".to_owned(),
    };
    let mut page = Page::new(&title);
    page.prose(&format!(
        "How fast estimates come near the truth: the error against the samples taken and against the time that they took. On \
         logarithmic axes a power law is a line. Independent samples have slope −½: four times the samples for half the error; \
         what falls faster has samples that know of each other. Slopes are fitted from {FITTED_FROM} samples on, and their ± is the \
         standard error from the spread of the points about the line. Error bars, and the ± of errors, are one standard error."
    ));
    if results.len() > 1 {
        page.heading("All at once");
        page.prose("The error with the most samples, divided by the least of its column.");
        page.table(&overview(results));
    }
    for result in results {
        page.heading(&result.subject);
        page.prose(&result.about);
        let by_samples = by_samples(&result.curves);
        page.figure(&Figure::drawing(
            &by_samples.svg(),
            "The error against the samples, with fitted slopes. Dashed: slopes to compare with.",
        ));
        page.table(&errors(&result.curves));
        let caption = "The error against the seconds that all pixels took together, on this machine.";
        page.figure(&Figure::drawing(&by_seconds(&result.curves).svg(), caption));
        let picture = |curve: &Curve| {
            let (samples, picture) = curve.picture.as_ref()?;
            let scale = (240 / picture.width.max(1)).max(1);
            Some(Figure::picture(picture, scale, &format!("{}, {samples} samples per pixel", curve.name)))
        };
        let pictures: Vec<Figure> = result.curves.iter().filter_map(picture).collect();
        if !pictures.is_empty() {
            page.figures(&pictures);
        }
    }
    page.data("", all_errors(results));
    page.data("slopes", all_slopes(results));
    page
}

/// A slope as legends and tables have it.
fn measured(law: Option<PowerLaw>) -> Cell {
    law.map_or(Cell::Empty, |law| Cell::Measured(law.slope, law.standard_error))
}

/// Error against samples.
fn by_samples(curves: &[Curve]) -> Chart {
    let x = |p: &ErrorPoint| f64::from(p.samples);
    let mut chart = chart(Axis::log2("samples per pixel"), curves, x, |c| c.by_samples);
    let first = curves.iter().flat_map(|c| c.points.first()).max_by(|a, b| a.error.total_cmp(&b.error));
    let last = curves.iter().flat_map(|c| &c.points).map(x).fold(0.0, f64::max);
    let least = curves
        .iter()
        .flat_map(|c| &c.points)
        .map(|p| p.error)
        .filter(|e| *e > 0.0)
        .fold(f64::INFINITY, f64::min);
    for (name, slope) in [("slope −½", -0.5), ("slope −1", -1.0)] {
        let Some(first) = first.filter(|p| p.error > 0.0) else { break };
        let x0 = f64::from(first.samples);
        // It ends with the curves, to the right or below.
        let end = f64::min(last, x0 * ops::powf(least / first.error, 1.0 / slope));
        let at = |x: f64| Point { x, y: first.error * ops::powf(x / x0, slope), error: 0.0 };
        let points = vec![at(x0), at(end)];
        chart.series.push(Series { name: name.to_owned(), points, mark: Mark::Dashes, color: None });
    }
    chart
}

/// Error against seconds.
fn by_seconds(curves: &[Curve]) -> Chart {
    chart(Axis::log("time (s)"), curves, |p| p.seconds, |c| c.by_seconds)
}

fn chart(
    axis: Axis,
    curves: &[Curve],
    x: impl Fn(&ErrorPoint) -> f64,
    law: impl Fn(&Curve) -> Option<PowerLaw>,
) -> Chart {
    let mut chart = Chart::new(axis, Axis::log("relative error (RMS)"));
    for (color, curve) in curves.iter().enumerate() {
        let slope = law(curve).map(|law| format!(" ({:.2})", law.slope).replace('-', "−"));
        let point = |p: &ErrorPoint| Point { x: x(p), y: p.error, error: p.standard_error };
        chart.series.push(Series {
            name: format!("{}{}", curve.name, slope.unwrap_or_default()),
            points: curve.points.iter().map(point).collect(),
            mark: Mark::Marks,
            color: Some(color),
        });
    }
    chart
}

/// The counts whose errors a table shows: up to three powers of four, or what there is.
fn shown_counts(curves: &[Curve]) -> Vec<u32> {
    let counts: Vec<u32> = curves.first().map_or(vec![], |c| c.points.iter().map(|p| p.samples).collect());
    let fours =
        counts.iter().copied().filter(|n| n.is_power_of_two() && n.trailing_zeros() % 2 == 0 && *n > 1);
    let fours: Vec<u32> = fours.collect();
    let from = if fours.len() > 1 { fours } else { counts };
    from[from.len().saturating_sub(3)..].to_vec()
}

fn errors(curves: &[Curve]) -> Table {
    let counts = shown_counts(curves);
    let columns = counts.iter().map(|n| format!("error at {n}"));
    let mut table = Table::new(
        ["sampler".to_owned(), "slope".to_owned()]
            .into_iter()
            .chain(columns)
            .chain(["to the best".to_owned(), "samples saved".to_owned()]),
    );
    let last = counts.last().copied().unwrap_or(1);
    let best = least_error(curves, last);
    let plain = curves.iter().find(|c| c.name == "independent").and_then(|c| c.at(last));
    for curve in curves {
        let point = |n: u32| curve.at(n).map_or(Cell::Empty, |p| Cell::Measured(p.error, p.standard_error));
        let here = curve.at(last);
        let saved = here.zip(plain).map(|(p, plain)| (plain.error / p.error).powi(2));
        let shown = |x: Option<f64>| x.map_or(Cell::Empty, |x| format!("× {x:.2}").into());
        let ratio = here.map(|p| p.error / best);
        table.row(
            [curve.name.as_str().into(), measured(curve.by_samples)]
                .into_iter()
                .chain(counts.iter().map(|&n| point(n)))
                .chain([shown(ratio), shown(saved)]),
        );
    }
    table
}

fn least_error(curves: &[Curve], samples: u32) -> f64 {
    curves.iter().filter_map(|c| c.at(samples)).map(|p| p.error).fold(f64::INFINITY, f64::min)
}

/// Every way's error with the most samples, relative to the best.
fn overview(results: &[Convergence]) -> Table {
    let mut table = Table::new(std::iter::once("").chain(results.iter().map(|r| r.subject.as_str())));
    let names = results.first().map_or(&[][..], |r| &r.curves);
    for (i, curve) in names.iter().enumerate() {
        let ratio = |result: &Convergence| {
            let last = result.curves.get(i)?.points.last()?;
            let best = least_error(&result.curves, last.samples);
            Some(Cell::Measured(last.error / best, last.standard_error / best))
        };
        let cells = results.iter().map(|result| ratio(result).unwrap_or(Cell::Empty));
        table.row(std::iter::once(curve.name.as_str().into()).chain(cells));
    }
    table
}

fn all_errors(results: &[Convergence]) -> Table {
    let mut table = Table::new(["subject", "variant", "samples", "error", "seconds"]);
    for result in results {
        for curve in &result.curves {
            for p in &curve.points {
                table.row([
                    result.subject.as_str().into(),
                    curve.name.as_str().into(),
                    p.samples.into(),
                    Cell::Measured(p.error, p.standard_error),
                    p.seconds.into(),
                ]);
            }
        }
    }
    table
}

fn all_slopes(results: &[Convergence]) -> Table {
    let mut table = Table::new(["subject", "variant", "slope by samples", "slope by seconds"]);
    for result in results {
        for curve in &result.curves {
            table.row([
                result.subject.as_str().into(),
                curve.name.as_str().into(),
                measured(curve.by_samples),
                measured(curve.by_seconds),
            ]);
        }
    }
    table
}
