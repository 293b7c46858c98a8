//! The animations of a file.

use super::file::File;
use super::{key_numbers, tracks};
use crate::error::{Error, require};
use crate::import::Request;
use crate::import::animations::Entry;
use crate::import::grid;
use crate::note::Remedy;
use anyhow::Result;
use std::path::Path;

/// Numbers of the keys of all animations: so many take about ten seconds.
const MOST_NUMBERS: usize = 1 << 29;

/// All animations of the glTF file `path`, those included that nothing can be read from: they have no frames.
pub fn list(path: &Path, options: &Request) -> Result<Vec<Entry>> {
    let file = File::open(path, &options.read(path)?, options)?;
    // Animations may share keys, which are read again for each.
    let numbers = file.root.animations.iter().map(|animation| key_numbers(&file, animation)).fold(0, usize::saturating_add);
    let place = path.display();
    let refusal = || Error::source(format!("{place}: the keys of all animations are {numbers} numbers, too many to list"));
    require!(numbers <= MOST_NUMBERS, refusal().remedy(Remedy::ChooseAnimation));
    let entry = |number: usize| {
        let name = file.root.animations[number].name.as_deref().map(super::one_line);
        let tracks = tracks(&file, number, &mut Vec::new())?;
        let count = tracks.len();
        if count == 0 {
            return Ok(Entry { name, frames: 0, fps: 0.0, tracks: 0 });
        }
        let grid = grid::grid(&tracks.values().map(|track| track.times.as_slice()).collect::<Vec<_>>(), options.fps)?;
        Ok(Entry { name, frames: grid.frames, fps: 1.0 / grid.frame_time, tracks: count })
    };
    (0..file.root.animations.len()).map(entry).collect()
}
