//! The table of feet: when which point of a foot is on the ground in each clip.

use super::entries::{Clip, acceleration, best};
use super::transitions::length;
use super::{Maker, Warning};
use crate::machine::source::{Feet, Kind, Source, Start, Text, Transition};
use anyhow::{Context, Result, ensure};
use pantin::codec::crc;
use pantin_animator::machine::{FEET_VERSION, FeetTable, POINTS};
use pantin_convert::Memory;
use pantin_convert::edit::contacts::{contacts, feet};
use pantin_convert::expand::expand;
use pantin_convert::import::text::quoted;

/// The longest that a transition waits to begin, in seconds, where the file states none.
const WITHIN: f64 = 0.5;
/// The greatest acceleration that looks like a body's, in cm/s^2: twice that at which shoes slide on a floor, as it decreases to zero over a transition.
const MOST_ACCELERATION: f64 = 1400.0;

impl Maker<'_, '_> {
    /// The table's bytes.
    pub(super) fn feet(&mut self, named: &Feet, source: &Source, file: &Text) -> Result<Vec<u8>> {
        let mut found = None;
        let mut clips = Vec::new();
        let (mut ends, mut rows): (Vec<u16>, Vec<[u8; 6]>) = (Vec::new(), Vec::new());
        for (name, clip) in &self.clips.all {
            let place = || format!("clip {}", quoted(name));
            let motion = expand(clip).with_context(place)?;
            if found.is_none() {
                found = Some(feet(&motion.rig, [named.left.as_deref(), named.right.as_deref()])?);
            }
            let own = found.as_deref().unwrap_or_default();
            ensure!(motion.frames <= usize::from(u16::MAX), "clip {}: {} frames; at most 65535", quoted(name), motion.frames);
            let contacts = contacts(&motion, own, Memory::default()).with_context(place)?;
            clips.push(Clip::of(&motion, own, contacts.as_deref().unwrap_or_default())?);
            match contacts {
                Some(contacts) => {
                    for (foot, contact) in
                        contacts.iter().enumerate().flat_map(|(foot, own)| own.iter().map(move |own| (foot, own)))
                    {
                        let [[a, b], [c, d]] = [contact.from, contact.to].map(|frame| (frame as u16).to_le_bytes());
                        rows.push([foot as u8, contact.point as u8, a, b, c, d]);
                    }
                }
                None => {
                    let text = format!("clip {}: its ground moves, as on a treadmill, so no foot is held in it", quoted(name));
                    self.warnings.push(Warning::new(text, None));
                }
            }
            ends.push(u16::try_from(rows.len()).context("more than 65535 contacts of feet")?);
        }
        let feet = found.unwrap_or_default();
        let entries = self.entries(source, file, &clips)?;
        let count = u8::try_from(ends.len()).context("more than 255 clips")?;
        let mut out = vec![FEET_VERSION, feet.len() as u8, count, 0];
        out.extend((rows.len() as u16).to_le_bytes());
        out.extend(u16::try_from(entries.len()).context("more than 65535 entries of transitions")?.to_le_bytes());
        for foot in &feet {
            out.extend((foot.ankle as u16).to_le_bytes());
            out.extend([foot.points.len() as u8, 0]);
            let points = foot.points.iter().map(|&point| point as u16).chain(std::iter::repeat(0)).take(POINTS);
            out.extend(points.flat_map(u16::to_le_bytes));
        }
        out.extend(ends.into_iter().flat_map(u16::to_le_bytes));
        out.extend(rows.into_iter().chain(entries).flatten());
        out.extend(crc::of(&out).to_le_bytes());
        FeetTable::new(&out, self.clips.all.len())?;
        Ok(out)
    }

    /// The rows of instants at which transitions with `sync = "feet"` may begin. Warns of transitions in which the figure could not change its velocity.
    fn entries(&mut self, source: &Source, file: &Text, clips: &[Clip]) -> Result<Vec<[u8; 6]>> {
        let mut rows = Vec::new();
        let mut index = source.any.len();
        for state in &source.states {
            for transition in &state.transitions {
                let row = transition.get_ref();
                let target = &source.states[usize::from(self.state(&row.to)?)];
                let length = if row.kind == Kind::Cut { 1 } else { length(row, &self.played(target)?.1)?.into() };
                let [from, to] = [self.clip_of(state)?, self.clip_of(target)?].map(|clip| &clips[usize::from(clip)]);
                let speeds = [state, target].map(|state| state.speed.unwrap_or(1.0));
                let pairs = pairs(row, from, to, speeds, length);
                if row.sync.is_some() {
                    for &(at, start) in &pairs {
                        let [[a, b], [c, d]] = [at, start].map(|frame| (frame as u16).to_le_bytes());
                        rows.push([u8::try_from(index)?, 0, a, b, c, d]);
                    }
                }
                index += 1;
                let ([most, change, glide], seconds) =
                    (acceleration(from, to, &pairs, length, speeds), length as f64 * to.frame_time());
                if row.kind != Kind::Cut && most > MOST_ACCELERATION {
                    let text = format!(
                        "state {}: in the {seconds:.2} s to {} the velocity of the figure would change by {:.1} m/s, and its place by {glide:.0} cm for its \
                         feet, faster than a body can: a blend of both, a state between the two, or more `seconds` look better",
                        quoted(state.name.get_ref()),
                        quoted(&row.to),
                        change / 100.0,
                    );
                    self.warnings.push(Warning::at(file.at(transition.span()), text));
                }
            }
        }
        Ok(rows)
    }

    /// Refuses what transitions cannot wait for.
    pub(super) fn check_sync(&self, source: &Source, file: &Text) -> Result<()> {
        let transitions = source.states.iter().flat_map(|state| state.transitions.iter().map(move |row| (Some(state), row)));
        for (state, row) in transitions.chain(source.any.iter().map(|row| (None, row))) {
            let (place, own) = (file.at(row.span()), row.get_ref());
            let wait = own.sync.is_some();
            ensure!(wait || own.within.is_none(), place.error("within: only a transition with sync = \"feet\" waits"));
            ensure!(!wait || source.feet.is_some(), place.error("sync = \"feet\" needs feet: write [feet] above the states"));
            ensure!(!wait || state.is_some(), place.error("sync = \"feet\": a transition from any state does not wait"));
            ensure!(!wait || own.end.is_none(), place.error("sync = \"feet\": a transition at a clip's end does not wait"));
            ensure!(
                !wait || state.and_then(|state| state.speed).is_none_or(|speed| speed > 0.0),
                place.error("sync = \"feet\": the state plays backwards, or stands")
            );
            ensure!(
                own.within.is_none_or(|within| within > 0.0 && within <= 4.0),
                place.error("within: expected a time above 0, at most 4 s")
            );
        }
        Ok(())
    }
}

/// Pairs of frames of the old and of the new clip at which a transition may begin.
fn pairs(row: &Transition, from: &Clip, to: &Clip, speeds: [f64; 2], length: usize) -> Vec<(usize, usize)> {
    let [speed, _] = speeds;
    let start = match &row.start {
        Some(Start::Frame(frame)) => *frame as usize,
        _ => 0,
    };
    match row.sync {
        Some(_) => best(from, to, Some(start).filter(|start| *start > 0), row.within.unwrap_or(WITHIN) * speed, length, speeds),
        None if row.end.is_some() => vec![(from.frames() - 1, start)],
        None => (0..from.frames()).map(|frame| (frame, start)).collect(),
    }
}
