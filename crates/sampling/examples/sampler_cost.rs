//! Nanoseconds for each call of each sampler: `cargo run --release -p tenfold-sampling --example sampler_cost`.

use std::hint::black_box;
use std::time::Instant;
use tenfold_math::UVec2;
use tenfold_sampling::{Dimension, Sampler, SamplerKind};

const SAMPLES: u32 = 512;
const DIMENSIONS: u16 = 20;

/// Nanoseconds a call, the best of many short runs, which a busy machine disturbs least.
fn measure(calls: u32, mut run: impl FnMut() -> f32) -> f64 {
    let once = |_| {
        let start = Instant::now();
        black_box(run());
        start.elapsed().as_secs_f64() * 1e9 / f64::from(calls)
    };
    (0..1000).map(once).fold(f64::INFINITY, f64::min)
}

fn main() {
    println!(
        "{:14} {:>8} {:>8} {:>8} {:>8} {:>14}",
        "ns", "at", "get_1d", "get_2d", "hash", "get_2d chained"
    );
    for kind in SamplerKind::ALL {
        let sampler = black_box(Sampler::new(kind, 64, 1));
        let at = |i: u32| sampler.at(UVec2::new(i / 64 % 640, i / 64 / 640), i % 64);
        let calls = SAMPLES * u32::from(DIMENSIONS);
        let start =
            measure(SAMPLES, || (0..SAMPLES).map(|i| at(black_box(i)).hash(Dimension::LENS) as f32).sum());
        let one = measure(calls, || {
            let mut sum = 0.0;
            for i in 0..SAMPLES {
                let p = at(i);
                for b in 0..DIMENSIONS {
                    sum += p.get_1d(Dimension::roulette(b));
                }
            }
            sum
        });
        let two = measure(calls, || {
            let mut sum = 0.0;
            for i in 0..SAMPLES {
                let p = at(i);
                for b in 0..DIMENSIONS {
                    let u = p.get_2d(Dimension::light_point(b));
                    sum += u.x + u.y;
                }
            }
            sum
        });
        let hash = measure(calls, || {
            let mut sum = 0;
            for i in 0..SAMPLES {
                let p = at(i);
                for b in 0..DIMENSIONS {
                    sum ^= p.hash(Dimension::layer(b));
                }
            }
            sum as f32
        });
        // Each call waits for the one before, as it never does on a path: the latency.
        let chained = measure(calls, || {
            let mut b = 0u16;
            for i in 0..SAMPLES {
                let p = at(i);
                for _ in 0..DIMENSIONS {
                    let u = p.get_2d(Dimension::light_point(b));
                    b = ((u.x + u.y) * 100.0) as u16;
                }
            }
            f32::from(b)
        });
        println!("{:14} {start:8.2} {one:8.2} {two:8.2} {hash:8.2} {chained:14.2}", kind.name());
    }
}
