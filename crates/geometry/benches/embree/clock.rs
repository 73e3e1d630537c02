//! Time and memory, as the system counts them.

use std::fs;

/// Seconds that this thread ran.
#[cfg(unix)]
pub(crate) fn thread_seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// Seconds that all threads of this process ran.
#[cfg(unix)]
pub(crate) fn process_seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// Not known here.
#[cfg(not(unix))]
pub(crate) fn process_seconds() -> f64 {
    0.0
}

/// Seconds that passed.
#[cfg(not(unix))]
pub(crate) fn thread_seconds() -> f64 {
    use std::{sync::OnceLock, time::Instant};
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_secs_f64()
}

/// Resident memory in bytes: now, and the most since [`reset_peak`]. Linux only; 0 elsewhere.
pub(crate) fn resident() -> [u64; 2] {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    ["VmRSS:", "VmHWM:"].map(|key| {
        let line = status.lines().find_map(|line| line.strip_prefix(key));
        line.and_then(|l| l.split_whitespace().next()?.parse::<u64>().ok()).unwrap_or(0) * 1024
    })
}

/// Makes the present memory the peak.
pub(crate) fn reset_peak() {
    // Where the system refuses, the peak is that of the whole process.
    let _ = fs::write("/proc/self/clear_refs", "5");
}

/// The quantile `q` of `values`.
pub(crate) fn quantile(values: &[f64], q: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[((sorted.len() - 1) as f64 * q).round() as usize]
}
