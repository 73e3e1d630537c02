/// Half the window over which brightness is taken, without its middle: 11 × 11 pixels.
const RADIUS: usize = 5;
/// Added to the brightness of each pixel, of the mean of all: what is nearly black may be as noisy as that.
const FLOOR: f64 = 0.01;

/// What the standard error of each pixel is divided by: the mean luminance of the 11 × 11 pixels around, and 1 % of
/// the picture's mean.
pub(super) fn denominators(luminance: &[f64], width: usize) -> Vec<f64> {
    let mean = luminance.iter().sum::<f64>() / luminance.len().max(1) as f64;
    box_mean(luminance, width, RADIUS).into_iter().map(|local| local.max(0.0) + FLOOR * mean).collect()
}

/// The mean of the pixels at most `radius` columns and rows away that there are.
pub(super) fn box_mean(values: &[f64], width: usize, radius: usize) -> Vec<f64> {
    if values.is_empty() {
        return Vec::new();
    }
    let height = values.len() / width;
    let window = |i: usize, n: usize| i.saturating_sub(radius)..(i + radius + 1).min(n);
    let means = |values: &[f64], n: usize, at: &dyn Fn(usize, usize) -> usize, lines: usize| {
        let mut out = vec![0.0; values.len()];
        for line in 0..lines {
            for i in 0..n {
                let window = window(i, n);
                let count = window.len() as f64;
                out[at(line, i)] = window.map(|j| values[at(line, j)]).sum::<f64>() / count;
            }
        }
        out
    };
    let rows = means(values, width, &|y, x| y * width + x, height);
    means(&rows, height, &|x, y| y * width + x, width)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_end_at_the_edges() {
        let values: Vec<f64> = (0..12).map(f64::from).collect();
        assert_eq!(box_mean(&values, 4, 0), values);
        let means = box_mean(&values, 4, 1);
        assert_eq!((means[0], means[5]), (2.5, 5.0));
        assert!(box_mean(&values, 4, 9).iter().all(|m| (m - 5.5).abs() < 1e-12));
        assert!(denominators(&[2.0; 12], 4).iter().all(|d| (d - 2.02).abs() < 1e-12));
    }
}
