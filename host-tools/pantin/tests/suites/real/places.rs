//! How near places must be to the file's.

/// Part of the figure's height by which imported places may differ from the file's: a hundredth of what the tightest bounds leave.
pub const SAME: f64 = 2e-6;

/// Between two places.
pub fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}
