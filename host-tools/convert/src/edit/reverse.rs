//! A motion that is played backwards.

use crate::motion::Motion;
use pantin::{LEFT_FOOT_DOWN, RIGHT_FOOT_DOWN};

/// Plays `motion` backwards. Frame 0 of a loop stays where it is. The events of footsteps are left out: a foot is lifted where it was put down.
pub fn reverse(motion: &Motion) -> Motion {
    let mut out = motion.clone();
    for values in &mut out.values {
        let loops = usize::from(motion.looped).min(values.len());
        values[loops..].reverse();
    }
    out.keys.fill(None);
    out.events.retain(|event| ![LEFT_FOOT_DOWN, RIGHT_FOOT_DOWN].contains(&event.name.as_str()));
    for event in &mut out.events {
        event.frame = match (motion.looped, event.frame) {
            (true, 0) => 0,
            (true, frame) => motion.frames - frame,
            (false, frame) => motion.frames - 1 - frame,
        };
    }
    out.events.sort_by_key(|event| event.frame);
    out
}
