//! The frames on which keys in time are sampled.
//!
//! Rule: the first key of all is frame 0, and where the file has a cycle, its begin. Without --fps, a frame is as long as the commonest
//! distance between two keys of a track that follow each other; a usual rate within 0.05 % of it is meant. Keys farther apart than
//! [`LONGEST`] are poses, not frames: then there are [`PLAIN_FPS`]. The last frame is the first one at or after the last key, or the end
//! of the cycle.

use crate::error::{Error, require};
use crate::note::{Note, NoteKind, Remedy};
use anyhow::Result;
use pantin::codec::layout::MAX_FRAMES;

/// Seconds above which the distance of keys says nothing about frames.
const LONGEST: f64 = 0.11;
/// Frames a second where keys do not say.
const PLAIN_FPS: f64 = 30.0;
/// Rates that people mean.
const USUAL: [f64; 16] = [10.0, 12.0, 12.5, 15.0, 20.0, 23.976, 24.0, 25.0, 29.97, 30.0, 48.0, 50.0, 59.94, 60.0, 100.0, 120.0];
/// Distances within this part of each other are one.
const ALIKE: f64 = 0.01;
/// Rates within this part of a usual one are that one.
const MEANT: f64 = 5e-4;
/// Shorter frames are no frames.
const MOST_FPS: f64 = 1000.0;

/// Frames in time.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Seconds of frame 0.
    pub first: f64,
    /// Seconds a frame.
    pub frame_time: f64,
    /// Number of frames.
    pub frames: usize,
    /// The rate, and where it comes from.
    pub note: Note,
}

/// The frames for tracks with keys at these `times`, of which there is at least one.
#[cfg(any(feature = "fbx", feature = "gltf"))]
pub fn grid(tracks: &[&[f64]], fps: Option<f64>) -> Result<Grid> {
    let times = || tracks.iter().flat_map(|times| times.iter());
    let (first, last) = times().fold((f64::MAX, f64::MIN), |(first, last), &time| (first.min(time), last.max(time)));
    let mut grid = between(first, last, fps, common(tracks))?;
    if first > 0.5 * grid.frame_time {
        grid.note.text = format!("{}; the clip begins with the first key, at {first:.3} s", grid.note.text);
    }
    Ok(grid)
}

/// Frames from `first` to `last` seconds, where keys have this distance in seconds.
pub fn between(first: f64, last: f64, fps: Option<f64>, distance: Option<f64>) -> Result<Grid> {
    let (fps, why) = match (fps, distance) {
        (Some(fps), _) => (fps, "as given"),
        (None, Some(seconds)) if seconds <= LONGEST => {
            let meant = USUAL.into_iter().find(|usual| (usual * seconds - 1.0).abs() < MEANT);
            (meant.unwrap_or(1.0 / seconds), "the commonest distance of keys")
        }
        _ => (PLAIN_FPS, "as the keys are far apart"),
    };
    over(first, last, fps, why)
}

/// Frames from `first` to `last` seconds; `why` tells where the rate comes from.
pub fn over(first: f64, last: f64, fps: f64, why: &str) -> Result<Grid> {
    let too_fast = || Error::source(format!("keys ask for {fps:.0} frames a second, more than {MOST_FPS}"));
    require!(fps <= MOST_FPS, too_fast().remedy(Remedy::LowerFrameRate));
    let steps = ((last - first) * fps - 1e-3).ceil().max(0.0);
    let too_long = || Error::source(format!("{:.0} s at {fps} frames a second are too long for a clip", last - first));
    require!(steps < f64::from(MAX_FRAMES), too_long().remedy(Remedy::LowerFrameRate));
    let sentence = format!("{fps:.6}");
    let shown = sentence.trim_end_matches('0').trim_end_matches('.');
    let note = Note::info(NoteKind::FrameRate, format!("{shown} frames a second, {why}")).remedy(Remedy::ChangeFrameRate);
    Ok(Grid { first, frame_time: 1.0 / fps, frames: steps as usize + 1, note })
}

/// The commonest distance of keys, the mean of those that are alike; of equally common ones, the shortest.
pub fn common(tracks: &[&[f64]]) -> Option<f64> {
    let mut spaces: Vec<f64> = tracks.iter().flat_map(|times| times.windows(2).map(|pair| pair[1] - pair[0])).collect();
    spaces.retain(|space| *space > 0.0);
    spaces.sort_unstable_by(f64::total_cmp);
    let alike = spaces.chunk_by(|a, b| b - a < ALIKE * a);
    let most = alike.rev().max_by_key(|group| group.len())?;
    Some(most.iter().sum::<f64>() / most.len() as f64)
}
