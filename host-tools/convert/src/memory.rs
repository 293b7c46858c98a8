//! The memory that one motion may take: a small file can ask for any number of frames.
//!
//! Everything that allocates by a count (importers, edits, the fit, expansion) asks a [`Memory`] before it does.

use crate::error::{Error, require};
use anyhow::Result;

/// Bytes that a value of a channel at a frame takes on its way from a file to a clip, with all copies that exist at a time.
const BYTES_A_VALUE: u64 = 192;
/// Bytes that a joint at a frame takes in a fit: its rotations and its place, where it is and where it should be.
const POSE_BYTES_A_JOINT: u64 = 400;
/// Bytes that a frame takes whatever the number of channels: its time, its row, and how it was filled.
const BYTES_A_FRAME: u64 = 192;
/// Bytes that the search for a channel's code takes for each frame: always, and for each hypothesis that it extends from a frame.
const SEARCH_BYTES: u64 = 500;
const SEARCH_BYTES_A_HYPOTHESIS: u64 = 110;
/// Under the default limit, a fit may take this many bytes for each byte that its motion was read from: captures of many minutes are
/// large, and fill no memory by surprise.
const FIT_BYTES_A_BYTE_READ: u64 = 128;
/// Bytes of the default limit.
const DEFAULT_BYTES: u64 = 1 << 30;

/// A limit of memory in bytes; 1 GiB by default.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory(u64);

impl Default for Memory {
    fn default() -> Memory {
        Memory(DEFAULT_BYTES)
    }
}

impl Memory {
    /// A limit of `bytes`.
    pub fn new(bytes: u64) -> Memory {
        Memory(bytes)
    }

    /// The limit in bytes.
    pub fn bytes(self) -> u64 {
        self.0
    }

    /// Refuses a motion that takes more memory than the limit.
    pub fn check(self, frames: usize, channels: usize) -> Result<()> {
        check_motion(frames, channels, (channels as u64).saturating_mul(BYTES_A_VALUE), self.0)
    }

    /// Refuses a motion whose fit takes more memory than the limit. Each thread searches a channel, or takes up another while it waits for one, and
    /// extends `beam` hypotheses from each frame; the motion was read from `read` bytes of files.
    pub fn check_fit(self, frames: usize, [joints, channels]: [usize; 2], beam: usize, read: u64) -> Result<()> {
        let searches = channels.min(2 * rayon::current_num_threads()) as u64;
        let search = SEARCH_BYTES + SEARCH_BYTES_A_HYPOTHESIS * beam as u64;
        let most = match self.0 {
            DEFAULT_BYTES => DEFAULT_BYTES.max(read.saturating_mul(FIT_BYTES_A_BYTE_READ)),
            asked => asked,
        };
        let a_frame = channels as u64 * BYTES_A_VALUE + joints as u64 * POSE_BYTES_A_JOINT + searches * search;
        check_motion(frames, channels, a_frame, most)
    }

    /// Refuses `numbers` of 8 bytes each that exist beside the motion, with a copy.
    pub fn check_numbers(self, numbers: usize, what: &str) -> Result<()> {
        let bytes = (numbers as u64).saturating_mul(16);
        let refusal = || Error::memory(format!("{what} take about {}; the limit is {}", size(bytes), size(self.0)));
        require!(bytes <= self.0, refusal());
        Ok(())
    }

    /// Refuses the bytes of files that are kept in memory together.
    pub fn check_bytes_held(self, bytes: u64) -> Result<()> {
        require!(bytes <= self.0, Error::memory(format!("the files have more than {} together, the limit", size(self.0))));
        Ok(())
    }
}

/// Refuses frames that take more than `most` bytes, each `a_frame` and what every frame takes.
fn check_motion(frames: usize, channels: usize, a_frame: u64, most: u64) -> Result<()> {
    let bytes = (frames as u64).saturating_mul(a_frame.saturating_add(BYTES_A_FRAME));
    let refusal = || {
        let (size, limit) = (size(bytes), size(most));
        Error::memory(format!("{frames} frames of {channels} channels take about {size}; the limit is {limit}"))
    };
    require!(bytes <= most, refusal());
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
        let limit = Memory::default();
        assert!(limit.check(100_000, 30).is_ok());
        assert!(limit.check(1 << 24, 1).is_err() && limit.check(usize::MAX, usize::MAX).is_err());
    }
}
