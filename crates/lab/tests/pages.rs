//! Pages as a whole.

use tenfold_lab::{
    Page, Picture, Table,
    page::Figure,
    plot::{Axis, Bars, Chart, Group, Mark, Point, Series},
};

/// A page with everything that pages can hold, and texts that need care.
fn page() -> Page {
    let mut chart = Chart::new(Axis::log2("samples & more"), Axis::log("error <%>"));
    for (i, mark) in [Mark::Marks, Mark::Line, Mark::Dashes, Mark::Dots].into_iter().enumerate() {
        for color in 0..7 {
            let point = |k: i32| Point { x: f64::from(1 << k), y: f64::from(i as i32 + k + 1), error: 0.1 };
            let points = (0..5).map(point).collect();
            chart.series.push(Series {
                name: format!("\"{i}\" < {color}"),
                points,
                mark,
                color: Some(color),
            });
        }
    }
    let group = Group { name: "a & b".to_owned(), bars: vec![[0.5, 0.1], [-0.5, 0.0]] };
    let names = vec!["<alone>".to_owned(), "total".to_owned()];
    let bars = Bars { axis: Axis::linear("share"), names, groups: vec![group] };
    let mut table = Table::new(["<", "&"]);
    table.row(["\"".into(), 0.1.into()]);

    let mut page = Page::new("<title> & \"quotes\"");
    page.heading("<heading>");
    page.prose("1 < 2 && 2 > 1");
    page.table(&table);
    page.figure(&Figure::drawing(&chart.svg(), "<caption>"));
    let picture = Picture::from_grey(2, &[0.0, 1.0, 0.5, 0.25]).unwrap();
    page.figures(&[Figure::picture(&picture, 4, "\"a\" & b"), Figure::drawing(&bars.svg(), "bars")]);
    page.data("a & b", table);
    page
}

#[test]
fn pages_are_well_formed_and_need_nothing_else() {
    let html = page().html("page");
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    let document = roxmltree::Document::parse_with_options(&html, options).unwrap();
    let count = |name| document.descendants().filter(|n| n.tag_name().name() == name).count();
    assert_eq!(["svg", "img", "table", "h1", "figure"].map(count), [2, 1, 1, 1, 3]);
    for node in document.descendants() {
        for attribute in node.attributes().filter(|a| matches!(a.name(), "src" | "href")) {
            assert!(attribute.value().starts_with("data:"), "{}", attribute.value());
        }
    }
    assert!(!html.contains("<script") && !html.contains("NaN"));
}

#[test]
fn colours_follow_light_and_dark() {
    let html = page().html("page");
    let (light, dark) = html.split_once("prefers-color-scheme: dark").unwrap();
    for i in 0..tenfold_lab::plot::COLORS {
        assert!(light.contains(&format!("--c{i}: #")) && dark.contains(&format!("--c{i}: #")), "{i}");
        assert!(html.contains(&format!(".c{i} {{")), "{i}");
    }
}
