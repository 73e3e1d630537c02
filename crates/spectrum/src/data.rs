//! The shipped tables: comma-separated figures under `data/`, each file naming its source.

/// Rows of figures of a shipped table. Comments, and anything that is not a row of numbers, are passed over.
pub(crate) fn rows(csv: &str) -> impl Iterator<Item = Vec<f32>> {
    csv.lines().filter(|l| !l.starts_with('#')).filter_map(|l| numbers(l.split(',')))
}

/// Named rows: a name, then figures.
pub(crate) fn named_rows(csv: &str) -> impl Iterator<Item = (&str, Vec<f32>)> {
    csv.lines().filter(|l| !l.starts_with('#')).filter_map(|l| {
        let (name, rest) = l.split_once(',')?;
        Some((name, numbers(rest.split(','))?))
    })
}

fn numbers<'a>(fields: impl Iterator<Item = &'a str>) -> Option<Vec<f32>> {
    fields.map(|f| f.trim().parse().ok()).collect()
}
