use super::{Attribution, BLOCKS, Group};
use crate::{
    Cell, Page, Picture, Table,
    page::{Figure, escape},
    plot::{self, Axis, Bars},
};
use std::fmt::Write;
use tenfold_image::srgb_to_linear;
use tenfold_math::Vec3;

/// Pixels of the page that pictures are wide, at most.
const PICTURE_WIDTH: u32 = 460;

/// The page of an attribution of the scene called `scene`.
pub fn page(scene: &str, attribution: &Attribution) -> Page {
    let mut page = Page::new(&format!("Noise of {scene}"));
    let noise = attribution.noise();
    let size = attribution.bounds.size();
    page.prose(&format!(
        "Which variable makes the noise? One independent sample a pixel has a noise of {:.3} ± {:.3}: the quadratic mean over the \
         pixels of standard error over brightness around. {} such samples a pixel make it {:.4}. Measured with {} samples of each of \
         {} × {} pixels, {} million evaluations.",
        noise.value,
        noise.error,
        attribution.samples,
        noise.value / f64::from(attribution.samples).sqrt(),
        attribution.samples,
        size.x,
        size.y,
        (attribution.evaluations as f64 * 1e-6).ceil(),
    ));
    if attribution.dropped > 0 {
        page.prose(&format!("{} samples were not finite and are left out.", attribution.dropped));
    }

    page.heading("Shares of the variance");
    page.prose(
        "The first-order share of a variable is the part of the variance that goes where its numbers, and theirs alone, are spread \
         evenly. Its total share is the part that goes where it is integrated exactly: it counts all that the variable does together \
         with others, so that total shares overlap. What first-order shares leave of 1 are interactions.",
    );
    page.table(&table(attribution));
    page.figure(&Figure::drawing(
        &chart(attribution).svg(),
        &format!("Shares of the variance, with standard errors from {BLOCKS} independent blocks of samples."),
    ));

    page.heading("What to do");
    attribution.advice().iter().for_each(|sentence| page.prose(sentence));

    page.heading("Where");
    let scale = (PICTURE_WIDTH / size.x.max(1)).max(1);
    let (colours, full) = false_colours(attribution);
    let captions = [
        "The picture.".to_owned(),
        format!(
            "The colour is that of the variable with the largest total share around a pixel, smoothed over 9 × 9. Brightness grows with the root of \
             the noise of one sample there, from none to {full:.2} and beyond."
        ),
    ];
    let pictures = [&attribution.picture, &colours].map(|pixels| Picture::from_linear_rgb(size.x, pixels));
    let figures = pictures.into_iter().zip(captions).filter_map(|(picture, caption)| {
        // Only what has no pixels is no picture.
        picture.ok().map(|picture| Figure::picture(&picture, scale, &caption))
    });
    page.figures(&figures.collect::<Vec<_>>());
    page.figure(&Figure::drawing(&legend(&attribution.groups), "The colours of the variables."));
    page.data("", table(attribution));
    page
}

fn table(attribution: &Attribution) -> Table {
    let measured = |share: super::Share| Cell::Measured(share.value, share.error);
    let mut table = Table::new(["variable", "first-order share", "total share", "decides"]);
    for (i, group) in attribution.groups.iter().enumerate() {
        let (first, total) = (attribution.totals.first_order(i), attribution.totals.total(i));
        table.row([group.name().into(), measured(first), measured(total), group.decides().into()]);
    }
    let rest = "what variables do together".into();
    table.row(["interactions".into(), measured(attribution.totals.interactions()), Cell::Empty, rest]);
    let idle = Group::ALL.into_iter().filter(|g| !attribution.groups.contains(g));
    for group in idle {
        table.row([group.name().into(), 0.0.into(), 0.0.into(), "nothing in this picture".into()]);
    }
    table
}

fn chart(attribution: &Attribution) -> Bars {
    let bar = |share: super::Share| [share.value, share.error];
    let groups = attribution.groups.iter().enumerate().map(|(i, group)| plot::Group {
        name: group.name().to_owned(),
        bars: vec![bar(attribution.totals.first_order(i)), bar(attribution.totals.total(i))],
    });
    let interactions =
        plot::Group { name: "interactions".to_owned(), bars: vec![bar(attribution.totals.interactions())] };
    Bars {
        axis: Axis::linear("share of the variance"),
        names: vec!["first-order".to_owned(), "total".to_owned()],
        groups: groups.chain([interactions]).collect(),
    }
}

/// A pixel's colour says which group makes it noisy, its brightness how noisy it is; and the noise of the brightest.
fn false_colours(attribution: &Attribution) -> (Vec<Vec3>, f64) {
    let noise = attribution.noise_around();
    let mut sorted = noise.clone();
    sorted.sort_by(f64::total_cmp);
    // A few fireflies shall not darken the rest.
    let full = sorted.get(sorted.len() * 98 / 100).copied().unwrap_or(0.0).max(f64::MIN_POSITIVE);
    let culprits = attribution.culprits();
    let colour = |(noise, culprit): (&f64, Option<usize>)| match culprit {
        None => Vec3::ZERO,
        Some(group) => {
            let brightness = (noise / full).min(1.0).sqrt() as f32;
            rgb(attribution.groups[group]).map(|c| srgb_to_linear(c as f32 / 255.0 * brightness)).into()
        }
    };
    (noise.iter().zip(culprits).map(colour).collect(), full)
}

/// The colour of a group, in sRGB: of about the same lightness for all.
fn rgb(group: Group) -> [u8; 3] {
    match group {
        Group::Pixel => [222, 222, 222],
        Group::Lens => [86, 160, 245],
        Group::Time => [60, 200, 110],
        Group::Wavelength => [190, 120, 250],
        Group::Light => [245, 215, 40],
        Group::Scatter => [245, 95, 60],
        Group::Mix => [60, 210, 215],
        Group::Alpha => [250, 160, 200],
        Group::Roulette => [185, 140, 95],
        Group::Medium => [140, 150, 165],
    }
}

/// Swatches: these colours do not follow light and dark, as those of the picture do not.
fn legend(groups: &[Group]) -> String {
    const STEP: usize = 112;
    let width = (groups.len() * STEP).max(STEP);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} 22\" width=\"{width}\" height=\"22\" role=\"img\" \
         aria-label=\"colours of the variables\">\n"
    );
    for (i, &group) in groups.iter().enumerate() {
        let ([r, g, b], x) = (rgb(group), i * STEP);
        let _ = writeln!(
            svg,
            "<rect x=\"{x}.5\" y=\"3.5\" width=\"14\" height=\"14\" fill=\"rgb({r},{g},{b})\" stroke=\"currentColor\"/>\
             <text x=\"{}\" y=\"16\" fill=\"currentColor\">{}</text>",
            x + 20,
            escape(group.name())
        );
    }
    svg.push_str("</svg>");
    svg
}
