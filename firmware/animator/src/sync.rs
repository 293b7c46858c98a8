//! Phases of a gait: two clips in step by their footstep events.

use crate::Error;
use crate::track::Track;
use fixed::types::U0F16;
use pantin::{Clip, LEFT_FOOT_DOWN, RIGHT_FOOT_DOWN};

/// Where a gait is: between two footsteps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Phase {
    /// Whether the last foot that came down is the right one.
    right: bool,
    /// How far the gait is on the way to the next footstep, in 2^-16.
    part: u32,
}

/// The footsteps of a clip: frames, and whether of the right foot.
fn steps<'c>(clip: &'c Clip<'_>) -> Result<impl Iterator<Item = (u32, bool)> + 'c, Error> {
    let (left, right) = (clip.event_id(LEFT_FOOT_DOWN), clip.event_id(RIGHT_FOOT_DOWN));
    let (Some(left), Some(right)) = (left, right) else { return Err(Error::NoFootsteps) };
    Ok(clip
        .events()
        .filter(move |event| event.id == left || event.id == right)
        .map(move |event| (event.frame, event.id == right)))
}

/// Frames of a stride: from one footstep of the left foot to the next, on average.
pub(crate) fn stride(clip: &Clip<'_>) -> Result<u32, Error> {
    let strides = steps(clip)?.filter(|(_, right)| !right).count() as u32;
    clip.frames().checked_div(strides).ok_or(Error::NoFootsteps)
}

/// The phase at an instant of a loop.
fn phase(clip: &Clip<'_>, frame: u32, part: U0F16) -> Result<Phase, Error> {
    let mut last = None;
    let mut next = None;
    let (mut first, mut end) = (None, None);
    for (at, right) in steps(clip)? {
        first = first.or(Some((at, right)));
        end = Some((at, right));
        if at <= frame {
            last = Some((at, right));
        } else if next.is_none() {
            next = Some(at);
        }
    }
    let (Some((first, _)), Some(end)) = (first, end) else { return Err(Error::NoFootsteps) };
    // Over the seam of the loop.
    let frames = i64::from(clip.frames());
    let (from, right) = last.map_or((i64::from(end.0) - frames, end.1), |(at, right)| (at.into(), right));
    let to = next.map_or(i64::from(first) + frames, i64::from);
    let now = ((i64::from(frame) - from) << 16) + i64::from(part.to_bits());
    Ok(Phase { right, part: now.checked_div(to - from).unwrap_or(0).clamp(0, 0xffff) as u32 })
}

impl Track<'_, '_> {
    /// Goes to the instant of this loop that is in step with another, the nearest after the last one: a walk and a run that are mixed have
    /// the same foot on the ground. [`Error::NoFootsteps`] if one of them lacks the events.
    pub fn sync_to(&mut self, other: &Track<'_, '_>) -> Result<(), Error> {
        let (frame, part) = in_step(other.clip(), other.frame(), other.part(), self.clip(), self.frame())?;
        self.seek_part(frame, part);
        Ok(())
    }
}

/// The frame, and the part after it, of `clip` that is in step with an instant of `other`: of several strides the one that is nearest to `near`.
pub(crate) fn in_step(other: &Clip<'_>, frame: u32, part: U0F16, clip: &Clip<'_>, near: u32) -> Result<(u32, U0F16), Error> {
    let phase = phase(other, frame, part)?;
    let frames = i64::from(clip.frames());
    let mut best: Option<(i64, i64)> = None;
    let mut try_step = |from: i64, to: i64| {
        let at = (from << 16) + (to - from) * i64::from(phase.part);
        let at = at.rem_euclid((frames << 16).max(1));
        let apart = (at - (i64::from(near) << 16)).abs();
        let apart = apart.min((frames << 16) - apart);
        if best.is_none_or(|(least, _)| apart < least) {
            best = Some((apart, at));
        }
    };
    let (mut before, mut first) = (None, None);
    for (at, right) in steps(clip)? {
        first = first.or(Some(at));
        if let Some((from, was_right)) = before.replace((i64::from(at), right))
            && was_right == phase.right
        {
            try_step(from, at.into());
        }
    }
    if let (Some((from, right)), Some(first)) = (before, first)
        && right == phase.right
    {
        try_step(from, i64::from(first) + frames);
    }
    let (_, at) = best.ok_or(Error::NoFootsteps)?;
    Ok(((at >> 16) as u32, U0F16::from_bits(at as u16)))
}
