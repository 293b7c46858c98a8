//! Packets that leave when it is time.

use super::address::Line;
use crate::sender::TimedPacket;
use anyhow::Result;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How long a wait may go on without a look at whether it is to end.
const GLANCE: Duration = Duration::from_millis(50);

/// Sends packets, the first at once and the others as much later as they say, until there are no more or `stop` is set: how many seconds the clip
/// had played then. Returns early where the line fails.
pub fn send(line: &mut Line, timed_packets: &mut dyn Iterator<Item = TimedPacket>, stop: &AtomicBool) -> Result<f64> {
    let mut start = None;
    let mut at = 0.0;
    for timed in timed_packets {
        let (began, first) = *start.get_or_insert((Instant::now(), timed.at));
        at = timed.at;
        if !wait(began + Duration::from_secs_f64((at - first).max(0.0)), stop) {
            break;
        }
        line.send(&timed.bytes)?;
    }
    Ok(at)
}

/// Waits until then; false if it was told to stop.
pub fn wait(until: Instant, stop: &AtomicBool) -> bool {
    loop {
        if stop.load(Ordering::Relaxed) {
            return false;
        }
        let left = until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return true;
        }
        std::thread::sleep(left.min(GLANCE));
    }
}
