//! What a conversion keeps to: bounds of joints, or of channels; and what closing a loop takes of them.

use super::distance::Distance;
use crate::edit::cut::cut;
use crate::edit::loop_seam::{self, Closed, Most};
use crate::error::{Error, Setting, require};
use crate::fit::bounds::Bounds;
use crate::fit::chain::Constraint;
use crate::motion::Motion;
use crate::note::{Note, NoteKind, Remedy};
use crate::options::{ChannelBound, Options};
use crate::verify::compare;
use anyhow::Result;

/// What closing a loop may take of the bound.
pub(crate) const CLOSING: f64 = 0.9;

/// What a conversion keeps to.
#[derive(Clone, Debug)]
pub enum Bound {
    /// Distances of joints, and errors of scalars.
    Distance(Distance),
    /// Errors of channels.
    Channels(Bounds),
}

impl Bound {
    /// The bound that `options` ask for, less what is not known of the source.
    pub fn of(options: &Options, motion: &Motion) -> Result<Bound> {
        let error_cm = motion.origin.error_cm;
        let bounds = match options.channels {
            None => return Ok(Bound::Distance(Distance::of(options, motion)?.less(error_cm)?)),
            Some(ChannelBound::Error(delta)) => Bounds::of(motion, Constraint::Positions, delta),
            Some(ChannelBound::Acceleration(epsilon)) => Bounds::of(motion, Constraint::Accelerations, epsilon),
            Some(ChannelBound::Exact) => Bounds::exact(motion)?,
        };
        // Bounds of channels do not see where the joints are.
        let most = 0.5 * Options::MAX_ERROR.of(motion).unwrap_or(1.0);
        let text = || {
            format!(
                "the file's joints are only known within {error_cm:.3e} cm; a bound of channels needs them within {most:.3e} cm"
            )
        };
        require!(error_cm < most, Error::bound(text()));
        Ok(Bound::Channels(bounds))
    }

    /// Closes a loop, and leaves of the bound what that did not take: in the end no joint is farther than all of it from the source.
    pub fn close(&mut self, motion: &Motion) -> Result<Closed> {
        match self {
            Bound::Distance(distance) => close_within(distance, motion),
            Bound::Channels(bounds) => {
                let closed = loop_seam::close(motion, Most::Channels(bounds))?;
                bounds.greatest.iter_mut().zip(&closed.moved).for_each(|(greatest, moved)| *greatest -= moved);
                Ok(closed)
            }
        }
    }
}

fn close_within(distance: &mut Distance, motion: &Motion) -> Result<Closed> {
    let whole = *distance;
    let most = Most::Distance(&whole.pose, whole.scalar_part);
    let (left, closed) = loop_seam::first_that_fits(motion, most, |ways| {
        let mut left = whole;
        let closed = close_but_for(&mut left, motion, ways)?;
        Ok((left, closed))
    })?;
    *distance = left;
    Ok(closed)
}

fn close_but_for(distance: &mut Distance, motion: &Motion, ways: &[usize]) -> Result<Closed> {
    let Distance { pose, scalar_part } = distance;
    let closed = loop_seam::close_but_for(motion, Most::Distance(pose, *scalar_part), ways)?;
    let (max_cm, least) = (pose.max_cm, closed.moved_cm / CLOSING);
    // Half of the seam at most, or a little more where joints turn far: then there is nothing left to code with.
    let too_far = || {
        let Closed { joint, moved_cm, .. } = &closed;
        format!(
            "closing the seam moves {joint} by {moved_cm:.3} cm, which leaves too little of the bound of {max_cm} cm; a bound above {least:.3} cm will do"
        )
    };
    require!(closed.moved_cm < CLOSING * max_cm, open(too_far()));
    pose.max_cm -= closed.moved_cm;
    let scalars = motion.rig.scalars.iter().zip(&closed.moved[motion.rig.joint_channels()..]);
    *scalar_part -= scalars.map(|(scalar, moved)| moved / scalar.full_scale).fold(0.0, f64::max);
    for (most, turned, whose) in [
        (&mut pose.max_rotation_deg, closed.turned_deg, "in the world"),
        (&mut pose.max_joint_deg, closed.turned_joint_deg, "against its parent"),
    ] {
        let Some(most) = most else { continue };
        let too_far = || {
            format!(
                "closing the seam turns a joint by {turned:.3} degrees {whose}, which leaves too little of the bound of {most} degrees"
            )
        };
        require!(turned < CLOSING * *most, open(too_far()));
        *most -= turned;
    }
    if let Some(mean_cm) = pose.mean_cm {
        let source = cut(motion, None, Some(closed.motion.frames - 1))?;
        let moved = compare(&source, &closed.motion, pose.shell_cm().unwrap_or(0.0))?.bounded_mean_cm(pose);
        let too_far = || {
            format!(
                "closing the seam moves the joints by {moved:.4} cm in the mean, which leaves too little of the mean error, {mean_cm} cm"
            )
        };
        require!(moved < CLOSING * mean_cm, open(too_far()));
        pose.mean_cm = Some(mean_cm - moved);
    }
    Ok(closed)
}

fn open(text: String) -> Error {
    Error::setting(Setting::Loop, text).remedy(Remedy::LoosenBound)
}

/// What closing the loop of `motion` did.
pub fn closed_notes(closed: &Closed, motion: &Motion) -> Vec<Note> {
    let note = |text: String| Note::info(NoteKind::Loop, text);
    if motion.looped {
        return vec![note("loop: it is one already".into())];
    }
    let joint = if closed.joint.is_empty() { String::new() } else { format!(" ({})", closed.joint) };
    let seam = note(format!("loop: the greatest seam is {:.4} cm ({})", closed.seam_cm, closed.seam_joint));
    let moved = note(format!(
        "loop: closing the seam moved joints by up to {:.4} cm{joint}; {} frames",
        closed.moved_cm, closed.motion.frames
    ));
    let travel =
        closed.travel.iter().map(|(name, way)| format!("loop: {name} goes {way:.3} units on each time round, which stays"));
    let seam = (!closed.seam_joint.is_empty()).then(|| seam.of_joint(&closed.seam_joint));
    seam.into_iter().chain([moved]).chain(travel.map(note)).collect()
}
