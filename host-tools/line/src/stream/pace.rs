//! Packets that leave when it is time.

use super::address::Output;
use crate::sender::TimedPacket;
use anyhow::Result;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How long a wait may go on without a look at whether it is to end.
const GLANCE: Duration = Duration::from_millis(50);

/// The delay up to which packets catch up. After a longer one, such as a stop of the process, all later packets are sent as much later: a burst would
/// overflow the receiver's queue.
pub const CATCH_UP: Duration = Duration::from_millis(100);

/// Sends packets, the first at once and the others at their times relative to it, until there are no more or `stop` is set. Returns by how much the last ones
/// are late, or an error if the line fails.
pub fn send(line: &mut Output, timed_packets: &mut dyn Iterator<Item = TimedPacket>, stop: &AtomicBool) -> Result<Duration> {
    let mut start = None;
    let mut delay = Duration::ZERO;
    for timed in timed_packets {
        let (began, first) = *start.get_or_insert((Instant::now(), timed.at));
        let due = began + delay + Duration::from_secs_f64((timed.at - first).max(0.0));
        if !wait(due, stop) {
            break;
        }
        let late = due.elapsed();
        if late > CATCH_UP {
            delay += late;
        }
        line.send(&timed.bytes)?;
    }
    Ok(delay)
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::UdpSocket;

    #[test]
    fn a_sender_that_was_stopped_keeps_the_pace_afterwards() {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        socket.set_read_timeout(Some(Duration::from_millis(500))).unwrap();
        let to: crate::stream::address::Address = format!("udp:{}", socket.local_addr().unwrap()).parse().unwrap();
        let mut line = to.open().unwrap();
        let receiver = std::thread::spawn(move || {
            let mut times = vec![];
            while socket.recv(&mut [0; 8]).is_ok() || times.len() < 5 {
                times.push(Instant::now());
            }
            times
        });
        // A packet each 10 ms; the sender is stopped for 400 ms at the tenth.
        let mut packets = (0..60).map(|number| {
            if number == 10 {
                std::thread::sleep(Duration::from_millis(400));
            }
            TimedPacket { at: 0.01 * f64::from(number), bytes: vec![1] }
        });
        send(&mut line, &mut packets, &AtomicBool::new(false)).unwrap();
        let times = receiver.join().unwrap();
        let most = times
            .iter()
            .map(|from| times.iter().filter(|time| (*from..*from + Duration::from_millis(100)).contains(time)).count())
            .max();
        assert!(most <= Some(20), "{most:?} packets in 100 ms, of which the pace has 10");
    }
}
