//! Paths of moving transforms: through their keys, smoothly, within their bounds.

use tenfold_math::{Bounds3, Key, Motion, Transform, Vec3};
use tenfold_testkit::Rng;

fn in_box(rng: &mut Rng, half: f32) -> Vec3 {
    (rng.vec3() - Vec3::splat(0.5)) * 2.0 * half
}

fn random_transform(rng: &mut Rng) -> Transform {
    let mirror = if rng.below(5) == 0 { -1.0 } else { 1.0 };
    Transform::translate(in_box(rng, 2.0))
        * Transform::rotate(3.0 * rng.f32(), rng.direction()).unwrap()
        * Transform::scale(Vec3::new(mirror, 1.0, 1.0) * (Vec3::splat(1.5) + in_box(rng, 1.0))).unwrap()
}

fn random_motion(rng: &mut Rng, keys: usize) -> Motion {
    let mut time = -0.3;
    let mut key = || {
        time += 0.1 + rng.f32();
        Key { time, transform: random_transform(rng) }
    };
    Motion::through(&(0..keys).map(|_| key()).collect::<Vec<_>>())
}

/// Where the corners of the unit cube are.
fn corners(m: &Motion, time: f32) -> [Vec3; 8] {
    let unit = Bounds3::new(Vec3::ZERO, Vec3::ONE);
    std::array::from_fn(|i| m.at(time).point(unit.corner(i)))
}

fn distance(a: [Vec3; 8], b: [Vec3; 8]) -> f32 {
    (0..8).map(|i| a[i].distance(b[i])).fold(0.0, f32::max)
}

fn time_range(m: &Motion) -> [f32; 2] {
    let keys = m.keys();
    [keys[0].time, keys[keys.len() - 1].time]
}

/// Pictures depend on these bits.
#[test]
fn the_bits_of_two_keys_are_pinned() {
    let start = Transform::translate(Vec3::new(0.3, 1.0, -2.0))
        * Transform::rotate(0.4, Vec3::new(0.1, 0.9, -0.3)).unwrap();
    let end = start
        * Transform::rotate(2.9, Vec3::new(0.3, 0.1, 1.0)).unwrap()
        * Transform::scale(Vec3::new(1.5, 0.7, -1.0)).unwrap();
    let m = Motion::new(start, 0.25, end, 1.5);
    let b = Bounds3::new(Vec3::new(-2.0, -0.5, -1.0), Vec3::new(1.0, 0.25, 3.0));
    let mut hash = 0u64;
    let mut add = |v: Vec3| {
        for x in v.to_array() {
            hash = (hash ^ u64::from(x.to_bits())).wrapping_mul(0x100_0000_01b3).rotate_left(17);
        }
    };
    for k in 0..64 {
        let t = m.at(k as f32 / 32.0);
        [t.point(Vec3::ZERO), t.vector(Vec3::X), t.vector(Vec3::Y), t.normal(Vec3::Z)]
            .into_iter()
            .for_each(&mut add);
    }
    for (from, to) in [(0.0, 2.0), (0.5, 0.75)] {
        let b = m.bounds(&b, from, to);
        [b.min, b.max].into_iter().for_each(&mut add);
    }
    assert_eq!(hash, 0x91de_ccc8_3ee8_4431);
}

#[test]
fn a_path_goes_through_its_keys_and_rests_outside() {
    let mut rng = Rng::new(1);
    for keys in 2..7 {
        let m = random_motion(&mut rng, keys);
        assert!(m.is_moving());
        for key in m.keys() {
            assert_eq!(m.at(key.time), key.transform);
            let near = [key.time.next_down(), key.time.next_up()].map(|t| corners(&m, t));
            assert!(near.iter().all(|n| distance(*n, corners(&m, key.time)) < 2e-5), "{keys}");
        }
        let [first, last] = time_range(&m);
        assert_eq!(m.at(first - 1.0), m.at(first));
        assert_eq!(m.at(last + 1.0), m.at(last));
        assert_eq!(*m.start(), m.at(first));
    }
}

/// Velocities of the corners just after a time, or for negative `h` just before, by differences of second order.
fn velocities(m: &Motion, time: f32, h: f32) -> [Vec3; 8] {
    let [p0, p1, p2] = [0.0, 1.0, 2.0].map(|k| corners(m, time + k * h));
    std::array::from_fn(|i| (4.0 * p1[i] - 3.0 * p0[i] - p2[i]) / (2.0 * h))
}

#[test]
fn velocities_are_continuous() {
    const H: f32 = 4e-3;
    let mut rng = Rng::new(2);
    for keys in [3, 3, 4, 6, 9] {
        let m = random_motion(&mut rng, keys);
        for triple in m.keys().windows(3) {
            let time = triple[1].time;
            let jump = |before: &Motion, after: &Motion| {
                let (before, after) = (velocities(before, time, -H), velocities(after, time, H));
                let fastest = before.iter().chain(&after).map(|v| v.length()).fold(0.0, f32::max);
                distance(before, after) / fastest
            };
            // From key to key each by itself there are kinks: what is measured is there to be seen.
            let kink = jump(&Motion::through(&triple[..2]), &Motion::through(&triple[1..]));
            assert!(kink > 0.2 && jump(&m, &m) < 0.02, "{kink} {}", jump(&m, &m));
        }
    }
}

/// Three keys of a throw are on one parabola, and so is all between them, at whatever times they were taken.
#[test]
fn even_accelerations_stay_even() {
    let at = |t: f32| Vec3::new(3.0 * t - 1.0, 2.0 + 4.0 * t - 4.9 * t * t, 0.5 * t * t);
    for times in [vec![0.0, 0.5, 1.0], vec![-0.2, 0.1, 1.3], vec![0.0, 0.3, 0.4, 0.9, 1.0]] {
        let keys: Vec<_> =
            times.iter().map(|&time| Key { time, transform: Transform::translate(at(time)) }).collect();
        let m = Motion::through(&keys);
        let [first, last] = time_range(&m);
        for k in 0..=100 {
            let t = first + (last - first) * k as f32 / 100.0;
            assert!(m.at(t).point(Vec3::ZERO).distance(at(t)) < 5e-6, "{t}");
        }
    }
}

/// A turn at constant speed goes through many keys at that speed, and may go further than half round.
#[test]
fn even_turns_stay_even() {
    let axis = Vec3::new(0.3, -1.0, 0.2);
    let turned = |t: f32| Transform::rotate(5.0 * t, axis).unwrap();
    for times in [vec![0.0, 0.2, 0.5], vec![0.0, 0.5, 0.6, 1.1, 1.7, 2.2]] {
        let keys: Vec<_> = times.iter().map(|&time| Key { time, transform: turned(time) }).collect();
        let m = Motion::through(&keys);
        let [first, last] = time_range(&m);
        for k in 0..=100 {
            let t = first + (last - first) * k as f32 / 100.0;
            let p = Vec3::new(1.0, 0.5, -0.3);
            assert!(m.at(t).point(p).distance(turned(t).point(p)) < 1e-5, "{t}");
        }
    }
}

#[test]
fn keys_that_say_nothing_of_a_motion_stand_still() {
    let key = |time, x| Key { time, transform: Transform::translate(Vec3::X * x) };
    for keys in [vec![key(0.0, 1.0); 3], vec![key(0.0, 1.0), key(0.0, 2.0)], vec![key(0.5, 1.0)]] {
        let m = Motion::through(&keys);
        assert!(!m.is_moving() && m.keys().is_empty());
        assert_eq!(m.at(0.3), keys[0].transform);
    }
    assert_eq!(Motion::through(&[]), Motion::default());
    // Without room for more than a transform.
    assert!(size_of::<Motion>() <= size_of::<Transform>() + 16);
}

#[test]
fn bounds_hold_the_whole_sweep_and_little_more() {
    let mut rng = Rng::new(3);
    for i in 0..60 {
        let m = random_motion(&mut rng, 2 + i % 5);
        let b = Bounds3::new(in_box(&mut rng, 2.0), in_box(&mut rng, 2.0));
        let [first, last] = time_range(&m);
        let [a, b_] = [rng.f32(), rng.f32()].map(|u| first - 0.2 + u * (last - first + 0.4));
        let (from, to) = if i % 3 == 0 { (first, last) } else { (a.min(b_), a.max(b_)) };
        let bound = m.bounds(&b, from, to);
        let mut swept = Bounds3::EMPTY;
        for k in 0..=2000 {
            swept = swept.union(m.at((from + (to - from) * k as f32 / 2000.0).min(to)).bounds(&b));
        }
        assert_eq!(bound.union(swept), bound, "{i}");
        assert!(bound.half_area() < 1.02 * swept.half_area(), "{i}: {bound:?} {swept:?}");
    }
    let m = random_motion(&mut rng, 3);
    assert_eq!(m.bounds(&Bounds3::EMPTY, 0.0, 1.0), Bounds3::EMPTY);
}

#[test]
fn linear_bounds_hold_the_box_all_the_time() {
    let mut rng = Rng::new(9);
    let unit = Bounds3::new(Vec3::ZERO, Vec3::ONE);
    for case in 0..60 {
        let m = match case % 3 {
            // Nothing but a translation.
            0 => {
                let start = random_transform(&mut rng);
                Motion::new(start, 0.0, Transform::translate(in_box(&mut rng, 2.0)) * start, 1.0)
            }
            keys => random_motion(&mut rng, 1 + keys),
        };
        let (from, to) = (0.2 * rng.f32(), 0.5 + rng.f32());
        let [a, b] = m.linear_bounds(&unit, from, to);
        for k in 0..=200 {
            let s = k as f32 / 200.0;
            let at = Bounds3 { min: a.min.lerp(b.min, s), max: a.max.lerp(b.max, s) }.expanded(1e-5);
            for p in corners(&m, from + (to - from) * s) {
                assert!(at.contains(p), "case {case} at {s}: {p} is not in {at:?}");
            }
        }
        // They follow the way: at any time the box is smaller than that for all times.
        if case % 3 == 0 {
            assert!(a.half_area() < m.bounds(&unit, from, to).half_area());
        }
    }
}
