//! Time sensors, and what they drive through interpolators.

use super::figure::{FIELDS, Moves};
use super::interpolator::{InterpolatorKeys, width};
use super::lexer::Words;
use super::world::{World, is_transform};
use anyhow::{Result, bail, ensure};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Fields that all clocks together may drive.
const MOST_DRIVES: usize = 1 << 16;
/// Numbers of all keys: an interpolator counts once for every field that it drives.
const MOST_NUMBERS: usize = 1 << 24;

/// A time sensor that drives interpolators.
#[derive(Clone, Debug)]
pub struct TimeSensor {
    /// Its node.
    pub node: usize,
    /// Seconds of a cycle.
    pub seconds: f64,
    /// What the file gives as its cycle, if that is no number above 0: then it lasts 1 s, as without a value.
    pub wrong: Option<String>,
    /// Interpolators with the node and the field that each sets.
    pub drives: Vec<Drive>,
}

/// An interpolator that sets a field.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// The interpolator.
    pub interpolator: usize,
    /// What it sets.
    pub target: usize,
    /// The field of the target's built-in type.
    pub field: String,
}

impl Drive {
    /// Index of [`FIELDS`], if it is one of a node with a place.
    pub fn place(&self, world: &World) -> Option<usize> {
        let index = FIELDS.iter().position(|(name, _)| *name == self.field)?;
        let fits = width(world.kind(self.interpolator)) == Some(FIELDS[index].1);
        (fits && is_transform(world.kind(self.target))).then_some(index)
    }

    /// Whether it is a number of its own.
    pub fn scalar(&self, world: &World) -> bool {
        width(world.kind(self.interpolator)) == Some(1)
    }
}

/// The time sensors that drive anything, in the file's order.
pub fn clocks(world: &World) -> Result<Vec<TimeSensor>> {
    let found = |(node, name): &(Option<usize>, String)| node.or_else(|| world.names.get(name).copied());
    let known = world.routes.iter();
    let known = known.filter_map(|route| Some((found(&route.source)?, found(&route.target)?, route.event.as_str())));
    let routes: BTreeSet<(usize, usize, &str)> = known.collect();
    let mut count = 0;
    let mut targets = HashMap::new();
    for &(source, target, event) in &routes {
        if width(world.kind(source)).is_some() {
            let drive = Drive { interpolator: source, target, field: world.set(target, event) };
            targets.entry(source).or_insert_with(Vec::new).push(drive);
        }
    }
    let mut clocks: BTreeMap<usize, TimeSensor> = BTreeMap::new();
    for &(source, target, event) in &routes {
        if world.kind(source) != "TimeSensor" || !event.ends_with("fraction") {
            continue;
        }
        let Some(drives) = targets.get(&target) else { continue };
        let field = world.field(source, "cycleInterval").filter(|value| value.is.is_none());
        let given = field.and_then(|value| value.numbers.first()).copied();
        let right = given.filter(|&seconds| seconds > 0.0);
        let wrong = field.filter(|_| right.is_none()).map(|_| given.map_or("no number".into(), |number| number.to_string()));
        let seconds = right.unwrap_or(1.0);
        let clock = clocks.entry(source).or_insert_with(|| TimeSensor { node: source, seconds, wrong, drives: Vec::new() });
        count += drives.len();
        ensure!(count <= MOST_DRIVES, "time sensors drive more than {MOST_DRIVES} fields");
        clock.drives.extend(drives.iter().filter(|drive| drive.place(world).is_some() || drive.scalar(world)).cloned());
    }
    Ok(clocks.into_values().filter(|clock| !clock.drives.is_empty()).collect())
}

/// What runs in one cycle.
#[derive(Debug, Default)]
pub struct Tracks {
    /// Tracks of places, rotations and scales.
    pub moves: Moves,
    /// Tracks of other fields, with their names.
    pub scalars: Vec<(String, InterpolatorKeys)>,
}

/// The tracks that these clocks drive.
pub fn tracks(world: &World, clocks: &[&TimeSensor], words: &Words) -> Result<Tracks> {
    let mut tracks = Tracks::default();
    let mut numbers = 0;
    for clock in clocks {
        for drive in &clock.drives {
            let Some(track) = InterpolatorKeys::read(world, drive.interpolator, clock.seconds, words)? else { continue };
            numbers += track.numbers();
            if numbers > MOST_NUMBERS {
                bail!(words.error_at(world.nodes[clock.node].line, format!("it drives more than {MOST_NUMBERS} numbers")));
            }
            match drive.place(world) {
                Some(index) => {
                    tracks.moves.insert((drive.target, index), track);
                }
                None => tracks.scalars.push((format!("{}.{}", world.name(drive.target), drive.field), track)),
            }
        }
    }
    Ok(tracks)
}

impl Tracks {
    /// The keys of all.
    pub fn times(&self) -> Vec<&[f64]> {
        let places = self.moves.values().map(|track| track.times.as_slice());
        places.chain(self.scalars.iter().map(|(_, track)| track.times.as_slice())).collect()
    }
}
