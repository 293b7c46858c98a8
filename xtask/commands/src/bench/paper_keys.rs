//! Our motions as key clips, which hold the keys exactly, beside the paper's own scheme.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use harness::paths;
use pantin::{ChannelState, Clip, Player};
use pantin_convert::encode::rig;
use pantin_convert::fit::raw::clip_length_exponent;
use pantin_convert::import::{self, ImportOptions};
use pantin_convert::key_clip;

use super::{Goal, table};

/// Folders of our motions, and the most bytes that their key clips may take together: of the library 280 for each motion.
const GROUPS: [(&str, &str, f64); 4] = [
    ("walk, run, greet, kneebend", "", f64::INFINITY),
    ("library motions", "library", 4480.0),
    ("faces", "face", 310.0),
    ("emotes", "emotes", 490.0),
];
/// Motions with a goal of their own.
const SINGLE: [(&str, f64); 2] = [("walk", 90.0), ("run", 110.0)];
const MOST_IN_ALL: f64 = 5780.0;

const HEADER: [&str; 9] = [
    "motion",
    "clips",
    "channels with keys",
    "keys",
    "key clips",
    "names of events",
    "keys at 16 bits",
    "2(k-1) numbers at 16 bits",
    "at 19 bits",
];

/// What one or several key clips take.
#[derive(Clone, Copy, Default)]
struct Taken {
    clips: usize,
    channels: usize,
    keys: usize,
    /// Bytes of the files without rigs and names of events.
    bytes: usize,
    names: usize,
    /// The paper's numbers: two for each segment of a channel.
    numbers: usize,
}

impl Taken {
    /// Makes the key clip of a .keys file, which is checked against the source at every frame.
    fn of(path: &Path) -> Result<Taken> {
        let motion = import::load(path, &ImportOptions::new())?.motion;
        let rig = rig::encode(&motion.rig)?;
        let time = (motion.frame_time * 1e9).round() as u32;
        let bytes = key_clip(&motion, &rig, (time, clip_length_exponent(&motion.rig, &motion.values)), true)?;
        let clip = Clip::with_rig(&bytes, &rig)?;
        let (mut states, mut pose) = (vec![ChannelState::default(); clip.moving()], vec![0; clip.rig().channels()]);
        let player = Player::new(clip, &mut states, &mut pose)?;
        let channels = player.states().len();
        let keys = (0..channels).filter_map(|index| Some(player.channel_keys(index)?.iter().count())).sum();
        let names = clip.event_names_len() + usize::from(clip.event_names_len() > 0);
        // A rig beside the clip leaves its id in the head, which a clip with its rig does not have.
        let bytes = bytes.len() - names - size_of::<u32>();
        Ok(Taken { clips: 1, channels, keys, bytes, names, numbers: 2 * (keys - channels) })
    }

    fn add(self, other: Taken) -> Taken {
        Taken {
            clips: self.clips + other.clips,
            channels: self.channels + other.channels,
            keys: self.keys + other.keys,
            bytes: self.bytes + other.bytes,
            names: self.names + other.names,
            numbers: self.numbers + other.numbers,
        }
    }

    fn row(&self, name: &str) -> Vec<String> {
        let at = |bits: usize| (self.numbers * bits).div_ceil(8);
        let numbers = [self.clips, self.channels, self.keys, self.bytes, self.names, 2 * self.keys, at(16), at(19)];
        [name.to_owned()].into_iter().chain(numbers.map(|number| number.to_string())).collect()
    }
}

fn motions(folder: &Path) -> Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(folder).with_context(|| folder.display().to_string())?;
    let mut paths: Vec<PathBuf> = entries.map(|entry| Ok(entry?.path())).collect::<Result<_>>()?;
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "keys"));
    paths.sort();
    Ok(paths)
}

/// Prints the table, and returns the goals.
pub fn run() -> Result<Vec<Goal>> {
    let root = paths::root().join("motions");
    let (mut rows, mut goals, mut all) = (vec![], vec![], Taken::default());
    for (name, most) in SINGLE {
        let taken = Taken::of(&root.join(name).with_extension("keys")).with_context(|| name.to_owned())?;
        rows.push(taken.row(name));
        goals.push(Goal::at_most(format!("our {name}, exact, as a key clip"), taken.bytes as f64, most, 0, "bytes"));
    }
    for (name, folder, most) in GROUPS {
        let mut group = Taken::default();
        for path in motions(&root.join(folder))? {
            group = group.add(Taken::of(&path).with_context(|| path.display().to_string())?);
        }
        rows.push(group.row(name));
        all = all.add(group);
        if most.is_finite() {
            goals.push(Goal::at_most(
                format!("our {} {name}, exact, as key clips", group.clips),
                group.bytes as f64,
                most,
                0,
                "bytes",
            ));
        }
    }
    rows.push(all.row("all"));
    goals.push(Goal::at_most(
        format!("all {} motions, exact, as key clips", all.clips),
        all.bytes as f64,
        MOST_IN_ALL,
        0,
        "bytes",
    ));
    table::print(&HEADER, &rows);
    Ok(goals)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_walk_is_counted_as_its_file_says() {
        let taken = Taken::of(&paths::root().join("motions/walk.keys")).unwrap();
        // Key times of one frame fewer are segments; collinear keys of straight lines are not counted.
        assert_eq!((taken.clips, taken.names, taken.numbers), (1, 0, 2 * (taken.keys - taken.channels)));
        assert!(taken.channels >= 20 && taken.keys >= 2 * taken.channels);
    }
}
