//! A clip as per-frame motion again, by the device's own decoder.

use crate::encode::rig;
use crate::euler;
use crate::events;
use crate::fit::raw;
use crate::fk::from_exponential;
use crate::memory::Memory;
use crate::motion::{Event, Frames, Joint, Motion, Rig};
use anyhow::Result;
use pantin::{ChannelState, Clip, Player};

/// A clip that is played frame by frame. Angles run on past half a turn; joints that the clip codes as exponential maps come back as
/// the Euler angles that the rig has.
pub struct Expanded<'a> {
    clip: Clip<'a>,
    rig: Rig,
    on_frame: Option<&'a (dyn Fn() + Sync)>,
}

/// Three rotation channels that hold an exponential map: their indices and axes.
type Slots = [(usize, usize); 3];

impl<'a> Expanded<'a> {
    /// Prepares `clip`.
    pub fn new(clip: &Clip<'a>) -> Expanded<'a> {
        Expanded { clip: *clip, rig: rig::decode(&clip.rig()), on_frame: None }
    }

    /// Calls `on_frame` at each frame that is played, to show how far it is.
    pub fn watched(self, on_frame: &'a (dyn Fn() + Sync)) -> Expanded<'a> {
        Expanded { on_frame: Some(on_frame), ..self }
    }

    fn exponential(&self) -> Vec<Slots> {
        let first = self.rig.first_channels();
        let joints = self.rig.joints.iter().enumerate().filter(|(index, _)| self.clip.is_exponential(*index));
        joints.filter_map(|(index, joint)| slots(joint, first[index])).collect()
    }
}

impl Frames for Expanded<'_> {
    fn rig(&self) -> &Rig {
        &self.rig
    }

    fn frame_time(&self) -> f64 {
        f64::from(self.clip.frame_time_ns()) * 1e-9
    }

    fn frames(&self) -> usize {
        self.clip.frames() as usize
    }

    fn events(&self) -> Vec<Event> {
        events::of_clip(&self.clip)
    }

    fn each(&self, each: &mut dyn FnMut(&[f64]) -> Result<()>) -> Result<()> {
        let scales = raw::scales(&self.rig, self.clip.length_exponent());
        let rotations: Vec<bool> = self.rig.channel_kinds().iter().map(|(_, kind)| kind.is_rotation()).collect();
        let exponential = self.exponential();
        let mut states = vec![ChannelState::default(); self.clip.moving()];
        let mut pose = vec![0; self.rig.channels()];
        let mut player = Player::new(self.clip, &mut states, &mut pose)?;
        let mut angles = vec![[0.0; 3]; exponential.len()];
        let (mut before, mut values) = (vec![0.0; scales.len()], vec![0.0; scales.len()]);
        for frame in 0..self.frames() {
            for ((out, raw), scale) in values.iter_mut().zip(player.pose().values).zip(&scales) {
                *out = f64::from(*raw) * scale;
            }
            for (slots, before) in exponential.iter().zip(&mut angles) {
                let vector = slots.map(|(slot, _)| values[slot].to_radians());
                *before = euler::near(&from_exponential(vector), slots.map(|(_, axis)| axis), *before);
                slots.iter().zip(*before).for_each(|(&(slot, _), angle)| values[slot] = angle);
            }
            if frame > 0 {
                let turned = values.iter_mut().zip(&before).zip(&rotations).filter(|(_, rotation)| **rotation);
                turned.for_each(|((value, before), _)| *value = euler::nearest(*value, *before));
            }
            if let Some(on_frame) = self.on_frame {
                on_frame();
            }
            each(&values)?;
            before.copy_from_slice(&values);
            if frame + 1 < self.frames() {
                player.step();
            }
        }
        Ok(())
    }
}

/// Plays `clip` from its first to its last frame into memory. Fails for a clip that takes more than the default limit.
pub fn expand(clip: &Clip<'_>) -> Result<Motion> {
    expand_within(clip, Memory::default())
}

/// The same within another limit.
pub fn expand_within(clip: &Clip<'_>, memory: Memory) -> Result<Motion> {
    memory.check(clip.frames() as usize, clip.rig().channels())?;
    expand_made(clip)
}

/// The same for a clip that was made of a motion in memory, which has its size.
pub(crate) fn expand_made(clip: &Clip<'_>) -> Result<Motion> {
    Ok(Motion { looped: clip.looped(), ..gather(&Expanded::new(clip))? })
}

/// All frames in memory, as a motion that is no loop.
pub fn gather(frames: &impl Frames) -> Result<Motion> {
    let (rig, count) = (frames.rig().clone(), frames.frames());
    let mut values: Vec<Vec<f64>> = vec![Vec::with_capacity(count); rig.channels()];
    frames.each(&mut |pose| {
        values.iter_mut().zip(pose).for_each(|(out, &value)| out.push(value));
        Ok(())
    })?;
    let (frame_time, keys) = (frames.frame_time(), vec![None; rig.channels()]);
    Ok(Motion {
        rig,
        frame_time,
        frames: count,
        values,
        keys,
        looped: false,
        events: frames.events(),
        origin: Default::default(),
    })
}

/// The rotation channels of a joint that has three of them, its first channel being `first`.
fn slots(joint: &Joint, first: usize) -> Option<Slots> {
    let rotations = joint.kinds.iter().enumerate().filter(|(_, kind)| kind.is_rotation());
    let slots: Vec<(usize, usize)> = rotations.map(|(i, kind)| (first + i, kind.axis().unwrap_or(0))).collect();
    slots.try_into().ok()
}
