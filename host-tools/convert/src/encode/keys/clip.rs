//! A key clip's file.

use super::{KeyMotion, channels, range};
use crate::encode::clip::{self, Head};
use anyhow::{Context, Result, bail, ensure};
use pantin::codec::keys::{KEYS, MAX_KEY_FRAMES};
use pantin::codec::layout::*;

/// The file: with `rig` in it, or with the id of `rig` if `apart`.
pub fn encode(motion: &KeyMotion, rig: &[u8], apart: bool) -> Result<Vec<u8>> {
    let &KeyMotion { frames, frame_time_ns, length_exponent, looped, .. } = motion;
    ensure!((1..=MAX_KEY_FRAMES).contains(&frames), "{frames} frames; a key clip holds 1 to {MAX_KEY_FRAMES}");
    if let Some(event) = motion.events.last().filter(|event| event.frame >= frames) {
        bail!("an event marker at frame {}; the last frame is {}", event.frame, frames - 1);
    }
    let parsed = pantin::Rig::new_checked(rig).context("the rig that was just made does not open")?;
    let (splits, states) = channels::put(motion, &parsed)?;
    let mut flags = if apart { KEYS } else { KEYS | HAS_RIG };
    flags |= if looped { LOOPED } else { 0 };
    flags |= if motion.events.is_empty() { 0 } else { HAS_EVENTS };
    flags |= if motion.event_names.is_empty() { 0 } else { HAS_EVENT_NAMES };
    let head = Head { frame_time_ns, frames, length_exponent, rig_id: apart.then(|| parsed.id()), states: Some(states) };
    let mut payload = head.bytes();
    clip::put_events(&mut payload, &motion.events);
    payload.extend(range::bytes(&splits));
    let mut out = clip::assembled(flags, rig, &payload, None);
    clip::put_event_names(&mut out, &motion.event_names);
    Ok(out)
}
