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
const CLOSING: f64 = 0.9;

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
    let Distance { max_cm, mean_cm, scalar_part } = distance;
    let closed = loop_seam::close(motion, Most::Distance(*max_cm, *scalar_part))?;
    let least = closed.moved_cm / CLOSING;
    // Half of the seam at most, or a little more where joints turn far: then there is nothing left to code with.
    let too_far = || {
        let Closed { joint, moved_cm, .. } = &closed;
        let text = format!(
            "closing the seam moves {joint} by {moved_cm:.3} cm, which leaves too little of the bound of {max_cm} cm; a bound above {least:.3} cm will do"
        );
        Error::setting(Setting::Loop, text).remedy(Remedy::LoosenBound)
    };
    require!(closed.moved_cm < CLOSING * *max_cm, too_far());
    *max_cm -= closed.moved_cm;
    let scalars = motion.rig.scalars.iter().zip(&closed.moved[motion.rig.joint_channels()..]);
    *scalar_part -= scalars.map(|(scalar, moved)| moved / scalar.full_scale).fold(0.0, f64::max);
    if let Some(mean_cm) = mean_cm {
        let moved = compare(&cut(motion, None, Some(closed.motion.frames - 1))?, &closed.motion)?.mean_joint_cm;
        let too_far = || {
            let text = format!(
                "closing the seam moves the joints by {moved:.4} cm in the mean, which leaves too little of the mean error, {mean_cm} cm"
            );
            Error::setting(Setting::Loop, text).remedy(Remedy::LoosenBound)
        };
        require!(moved < CLOSING * *mean_cm, too_far());
        *mean_cm -= moved;
    }
    Ok(closed)
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
