//! The memory that one motion may take: a small file can ask for any number of frames.
//!
//! Everything that allocates by a count (importers, edits, the fit, expansion) asks [`check`] before it does.

use anyhow::{Result, ensure};
use std::sync::atomic::{AtomicU64, Ordering};

/// Bytes that a value of a channel at a frame takes on its way from a file to a clip, with all copies that exist at a time.
const BYTES_A_VALUE: u64 = 192;
/// Bytes that a joint at a frame takes in a fit: its rotations and its place, where it is and where it should be.
const POSE_BYTES_A_JOINT: u64 = 400;
/// Bytes that a frame takes whatever the number of channels: its time, its row, and how it was filled.
const BYTES_A_FRAME: u64 = 192;
/// Bytes that the search for a channel's code takes for each frame: always, and for each hypothesis that it extends from a frame.
const SEARCH_BYTES: u64 = 500;
const SEARCH_BYTES_A_HYPOTHESIS: u64 = 110;
/// Without `--max-memory`, a fit may take this many bytes for each byte that its motion was read from: captures of many minutes are
/// large, and fill no memory by surprise.
const FIT_BYTES_A_BYTE_READ: u64 = 128;
/// The limit without `--max-memory`.
pub const DEFAULT: u64 = 1 << 30;

static MOST_BYTES: AtomicU64 = AtomicU64::new(DEFAULT);

/// Sets the limit of this process in bytes.
pub fn set(bytes: u64) {
    MOST_BYTES.store(bytes, Ordering::Relaxed);
}

/// The limit in bytes.
pub fn most_bytes() -> u64 {
    MOST_BYTES.load(Ordering::Relaxed)
}

/// Values of channels at frames within the limit.
pub fn most_values() -> usize {
    usize::try_from(most_bytes() / BYTES_A_VALUE).unwrap_or(usize::MAX)
}

/// Refuses a motion that takes more memory than the limit.
pub fn check(frames: usize, channels: usize) -> Result<()> {
    check_bytes(frames, channels, (channels as u64).saturating_mul(BYTES_A_VALUE), most_bytes())
}

/// Refuses a motion whose fit takes more memory than the limit. Each thread searches a channel and extends `beam` hypotheses from each
/// frame; the motion was read from `read` bytes of files.
pub fn check_fit(frames: usize, [joints, channels]: [usize; 2], beam: usize, read: u64) -> Result<()> {
    let searches = channels.min(rayon::current_num_threads()) as u64;
    let search = SEARCH_BYTES + SEARCH_BYTES_A_HYPOTHESIS * beam as u64;
    let most = match most_bytes() {
        DEFAULT => DEFAULT.max(read.saturating_mul(FIT_BYTES_A_BYTE_READ)),
        asked => asked,
    };
    let a_frame = channels as u64 * BYTES_A_VALUE + joints as u64 * POSE_BYTES_A_JOINT + searches * search;
    check_bytes(frames, channels, a_frame, most)
}

/// Refuses frames that take more than `most` bytes, each `a_frame` and what every frame takes.
fn check_bytes(frames: usize, channels: usize, a_frame: u64, most: u64) -> Result<()> {
    let bytes = (frames as u64).saturating_mul(a_frame.saturating_add(BYTES_A_FRAME));
    ensure!(
        bytes <= most,
        "{frames} frames of {channels} channels take about {}; the limit is {}, and --max-memory raises it",
        size(bytes),
        size(most)
    );
    Ok(())
}

/// Refuses `numbers` of 8 bytes each that exist beside the motion, with a copy.
pub fn check_numbers(numbers: usize, what: &str) -> Result<()> {
    let bytes = (numbers as u64).saturating_mul(16);
    ensure!(
        bytes <= most_bytes(),
        "{what} take about {}; the limit is {}, and --max-memory raises it",
        size(bytes),
        size(most_bytes())
    );
    Ok(())
}

/// Refuses the bytes of files that are kept in memory together.
pub fn check_bytes_held(bytes: u64) -> Result<()> {
    let most = most_bytes();
    ensure!(bytes <= most, "the files have more than {} together; --max-memory raises the limit", size(most));
    Ok(())
}

/// A number of bytes for a person: `1.5 GB`.
pub fn size(bytes: u64) -> String {
    let units = [("GB", 30), ("MB", 20), ("kB", 10)];
    let unit = units.into_iter().find(|(_, bits)| bytes >> bits > 0);
    match unit {
        Some((name, bits)) => format!("{:.1} {name}", bytes as f64 / f64::from(1 << bits)),
        None => format!("{bytes} bytes"),
    }
}

/// Reads a size: `500MB`, `2GB`, or bytes without a unit.
pub fn parse(text: &str) -> Result<u64, String> {
    let units = [("gb", 30), ("mb", 20), ("kb", 10), ("g", 30), ("m", 20), ("k", 10), ("", 0)];
    let lower = text.trim().to_ascii_lowercase();
    let found = units.iter().find_map(|(unit, bits)| Some((lower.strip_suffix(unit)?.trim(), bits)));
    let number = found.and_then(|(number, bits)| Some(number.parse::<f64>().ok()? * f64::from(1u32 << bits)));
    match number {
        Some(bytes) if bytes >= 1.0 && bytes < u64::MAX as f64 => Ok(bytes as u64),
        _ => Err("expected a size such as 500MB or 2GB".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_and_printed() {
        assert_eq!(["1GB", "1.5 mb", "10k", "7"].map(|text| parse(text).unwrap()), [1 << 30, 3 << 19, 10 << 10, 7]);
        assert!(["", "0", "-1GB", "nan", "1TB"].iter().all(|text| parse(text).is_err()));
        assert_eq!([size(3 << 29), size(999)], ["1.5 GB", "999 bytes"]);
    }

    #[test]
    fn counts_beyond_the_limit_are_refused() {
        assert!(check(100_000, 30).is_ok());
        assert!(check(1 << 24, 1).is_err() && check(usize::MAX, usize::MAX).is_err());
    }
}
