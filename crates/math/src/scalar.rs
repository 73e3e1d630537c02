/// `x²`.
#[inline]
pub fn sqr(x: f32) -> f32 {
    x * x
}

/// The smaller one, and `b` where either is NaN: an instruction that vectors have, too, which `f32::min` is not.
#[inline(always)]
pub fn lower(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The larger one, and `b` where either is NaN: see [`lower`].
#[inline(always)]
pub fn higher(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// `a` at `t = 0`, `b` at `t = 1`, exactly at both ends.
#[inline]
pub fn lerp(t: f32, a: f32, b: f32) -> f32 {
    (1.0 - t) * a + t * b
}

/// Bound on the relative error of `n` rounded float operations in a row (Higham 2002, §3.1).
#[inline]
pub const fn gamma(n: i32) -> f32 {
    let eps = f32::EPSILON * 0.5;
    (n as f32 * eps) / (1.0 - n as f32 * eps)
}

/// The next larger float.
#[inline]
pub fn next_up(x: f32) -> f32 {
    x.next_up()
}

/// The largest index `i` in `[0, n - 2]` with `below(i)` true, 0 where there is none.
/// `below` must be true up to some index and false from there on.
#[inline]
pub fn find_interval(n: usize, below: impl Fn(usize) -> bool) -> usize {
    let (mut first, mut size) = (1, n.saturating_sub(2));
    while size > 0 {
        let half = size / 2;
        let middle = first + half;
        if below(middle) {
            first = middle + 1;
            size -= half + 1;
        } else {
            size = half;
        }
    }
    (first - 1).min(n.saturating_sub(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_bracket_their_value() {
        let nodes = [0.0, 0.1, 0.5, 0.9, 1.0];
        for (x, want) in [(-1.0, 0), (0.0, 0), (0.3, 1), (0.5, 2), (0.95, 3), (1.0, 3), (2.0, 3)] {
            assert_eq!(find_interval(nodes.len(), |i| nodes[i] <= x), want, "{x}");
        }
    }
}
