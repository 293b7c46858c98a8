//! The rows of states and layers.

use super::names::NAME_BYTES;
use super::warnings::{Warning, other_form};
use super::{Maker, NONE, Row, SECONDS};
use crate::machine::source::{Layer, Source, State, Text};
use anyhow::{Context, Result, ensure};
use pantin::Clip;
use pantin_animator::Mask;
use pantin_convert::Remedy;
use pantin_convert::import::text::quoted;

/// The longest time of a row: 255 of 64 parts of a second.
const MOST_SECONDS: f64 = 255.0 / 64.0;
/// The least time in which a blend goes from one clip to the other, in seconds, where the file states none.
const FOLLOW: f64 = 0.5;
/// The speed 1, as a state's row stores it.
const SPEED_ONE: f64 = 256.0;

/// A layer's row, and the patterns of its joints, one a line.
pub(super) struct LayerRow {
    pub row: [u8; 12],
    pub joints: String,
}

impl<'s> Maker<'s, '_> {
    pub(super) fn state_row(&mut self, state: &'s State, first: usize, file: &Text) -> Result<Row> {
        let name = quoted(state.name.get_ref());
        let place = self.place_of_clip(state, file);
        let clip = self.clip_of(state)?;
        let (mut other, mut parameter, mut follow) = (NONE, 0, 0);
        if let Some(blend) = &state.blend {
            let place = file.at(blend.span());
            let blend = blend.get_ref();
            let found = self.clips.find(&blend.clip);
            let named = found.and_then(|clip| Ok((clip, self.parameter(&blend.by)?, time(blend.seconds.unwrap_or(FOLLOW))?)));
            let named = named.with_context(|| format!("state {name}: blend")).with_context(|| place.clone());
            (other, parameter, follow) = named?;
            let [own, its] = [clip, other].map(|index| &self.clips.all[usize::from(index)]);
            if own.1.form().check(its.1.form_ref()).is_err() {
                let [own, its] = [quoted(own.0), quoted(its.0)];
                return Err(other_form(format!("state {name}: the clips {own} and {its} have different forms")).context(place));
            }
            let steps =
                |clip: &Clip| clip.event_id(pantin::LEFT_FOOT_DOWN).is_some() || clip.event_id(pantin::RIGHT_FOOT_DOWN).is_some();
            if !steps(&own.1) || !steps(&its.1) {
                let text = format!(
                    "state {name}: without events of footsteps in both clips the second shows the frame of the same number"
                );
                self.warnings.push(Warning::new(text, Some(Remedy::FindFootsteps)));
            }
        }
        let speed = state.speed.unwrap_or(1.0);
        ensure!((-4.0..=4.0).contains(&speed), place.error(format!("state {name}: the speed {speed} is outside -4 to 4")));
        let rounded = (speed * SPEED_ONE).round();
        ensure!(
            speed == 0.0 || rounded != 0.0,
            place.error(format!("state {name}: the speed {speed} would be stored as 0; the slowest is {}", 1.0 / SPEED_ONE))
        );
        let [low, high] = (rounded as i16).to_le_bytes();
        let [first, count] = [first, state.transitions.len()].map(|number| u8::try_from(number).unwrap_or(u8::MAX));
        Ok([clip, other, parameter, follow, low, high, first, count])
    }

    /// The row of a layer. Fails if a clip under it has another form.
    pub(super) fn layer_row(&mut self, layer: &Layer, source: &Source) -> Result<LayerRow> {
        let clip = self.clips.find(&layer.clip)?;
        let input = self.input(&layer.input)?;
        let fade = time(layer.seconds.unwrap_or(SECONDS))?;
        let rig = self.clips.all[usize::from(clip)].1.rig();
        let mut words = vec![0; Mask::words(&rig)];
        let mut mask = Mask::new(&rig, &mut words)?;
        ensure!(!layer.joints.is_empty(), "joints: it has none");
        for pattern in &layer.joints {
            mask.set(&rig, pattern, true).with_context(|| format!("joints: {}", quoted(pattern)))?;
        }
        let joints = layer.joints.join("\n");
        ensure!(joints.len() <= NAME_BYTES, "joints: {} bytes of patterns; at most {NAME_BYTES}", joints.len());
        let mut states = u64::MAX;
        if let Some(names) = &layer.states {
            ensure!(!names.is_empty(), "states: it has none, so the layer would never play");
            states = 0;
            for name in names {
                states |= 1 << self.state(name)?;
            }
        }
        for (_, state) in source.states.iter().enumerate().filter(|(index, _)| states >> index & 1 != 0) {
            let (name, under) = self.played(state)?;
            if under.form().check(self.clips.all[usize::from(clip)].1.form_ref()).is_err() {
                let [own, its] = [quoted(name), quoted(&layer.clip)];
                return Err(other_form(format!("the clips {own} and {its} have different forms")));
            }
        }
        let mut row = [0; 12];
        (row[0], row[1], row[2]) = (clip, input, fade);
        row[4..].copy_from_slice(&states.to_le_bytes());
        Ok(LayerRow { row, joints })
    }
}

/// A time in the unit of a row.
fn time(seconds: f64) -> Result<u8> {
    ensure!((0.0..=MOST_SECONDS).contains(&seconds), "seconds: expected 0 to {MOST_SECONDS}, found {seconds}");
    Ok((seconds * 64.0).round() as u8)
}
