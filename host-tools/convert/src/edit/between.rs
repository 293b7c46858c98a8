//! The stretch from one event to the next.

use super::cut::cut;
use crate::error::{Error, Setting};
use crate::motion::Motion;
use anyhow::Result;

/// Keeps the frames from the first event of a name to the next one of another name, or of the same. The last frame is the second event's.
pub fn between(motion: &Motion, first: &str, last: &str) -> Result<Motion> {
    let names = || motion.events.iter().map(|event| event.name.as_str()).collect::<Vec<_>>().join(", ");
    let missing = |name: &str, after: &str| {
        Error::value(Setting::Between, format!("{first}..{last}"), format!("no event {name}{after}; the events are: {}", names()))
    };
    let start = motion.events.iter().find(|event| event.name == first).ok_or_else(|| missing(first, ""))?.frame;
    let end = motion.events.iter().find(|event| event.name == last && event.frame > start);
    let end = end.ok_or_else(|| missing(last, &format!(" after frame {start}")))?.frame;
    cut(motion, Some(start), Some(end))
}
