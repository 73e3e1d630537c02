/// `x²`.
#[inline]
pub fn sqr(x: f32) -> f32 {
    x * x
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

/// The next larger float where `sign` is positive, the next smaller where it is negative, and `x` where it is zero: without
/// branches, which signs of normals would mislead. `x` must be finite; −0 and 0 count as two floats.
#[inline]
pub fn next_by_sign(x: f32, sign: f32) -> f32 {
    // As integers, floats are in order once the lower bits of the negative ones are flipped.
    let ordered = |bits: i32| bits ^ ((bits >> 31) as u32 >> 1) as i32;
    let step = i32::from(sign > 0.0) - i32::from(sign < 0.0);
    f32::from_bits(ordered(ordered(x.to_bits() as i32) + step) as u32)
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
    fn the_next_float_follows_the_sign() {
        for x in [1.0f32, -1.0, 0.1, -1e-40, 1e-45, f32::MAX / 2.0, -0.5, 3e38] {
            assert_eq!(next_by_sign(x, 2.0), x.next_up(), "{x}");
            assert_eq!(next_by_sign(x, -1e-30), x.next_down(), "{x}");
            assert_eq!(next_by_sign(x, 0.0), x);
            assert_eq!(next_by_sign(x, -0.0), x);
        }
        assert!(next_by_sign(0.0, 1.0) > 0.0);
    }

    #[test]
    fn intervals_bracket_their_value() {
        let nodes = [0.0, 0.1, 0.5, 0.9, 1.0];
        for (x, want) in [(-1.0, 0), (0.0, 0), (0.3, 1), (0.5, 2), (0.95, 3), (1.0, 3), (2.0, 3)] {
            assert_eq!(find_interval(nodes.len(), |i| nodes[i] <= x), want, "{x}");
        }
    }
}
