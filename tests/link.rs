//! Motion over a line that loses packets and flips bits: the reference board shows what the host's receiver of the same bytes shows, it keeps
//! moving, and it is exact again when it should be. And in its own time, from a TCP line as fast as a real one.

use std::path::PathBuf;
use std::process::Command;
use std::sync::LazyLock;
use std::time::{Duration, Instant};

use harness::build::{self, Firmware};
use harness::lossy::{Damage, Lossy};
use harness::qemu::{LM3S6965EVB, Launch};
use harness::{clips, defmt_log, paths, setup, simulator, sync};
use pantin::Clip;
use pantin_link::sender::{Line, Sender, Source};
use tempfile::TempDir;

/// Our greeting: a body and its face.
static CLIP: LazyLock<(TempDir, PathBuf)> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let clip = clips::convert(&paths::root().join("motions/greet.keys"), folder.path()).unwrap();
    (folder, clip)
});

fn firmware(features: &str) -> Firmware {
    Firmware::featuring(features, "lm3s6965evb", "lm3s6965evb", LM3S6965EVB.target, &[&CLIP.1]).unwrap()
}

fn source() -> Source {
    let bytes = std::fs::read(&CLIP.1).unwrap();
    Source::new(&Clip::new_checked(&bytes).unwrap()).unwrap()
}

/// What arrives in each frame's time over a line of 38,400 baud that is damaged between two frames of the clip.
fn line(source: &Source, damage: Damage, from: usize, to: usize) -> Vec<Vec<u8>> {
    let wanted = Line { rate: 3840.0, ahead: 48, share: 1.0, cycle: 12, parity: false };
    let fit = wanted.fitted(source).expect("the line carries it");
    let (mut lossy, mut frames) = (Lossy::new(5), vec![]);
    for departure in Sender::new(3).clip(source, fit, Some(1)) {
        let there = departure.at + departure.bytes.len() as f64 / fit.rate;
        let frame = (there / source.frame_seconds()) as usize + fit.ahead as usize;
        frames.resize_with(frames.len().max(frame + 1), Vec::new);
        let harms = (from..to).contains(&frame);
        frames[frame].extend(if harms { lossy.pass(&departure.bytes, damage).0 } else { departure.bytes });
    }
    frames
}

#[test]
fn the_board_shows_what_the_host_shows_of_a_line_that_damages() {
    if setup::host_only("a line that damages") {
        return;
    }
    let (source, firmware) = (source(), firmware("face,link"));
    let line = line(&source, Damage { loss: 0.1, flips: 1e-4 }, 90, 150);
    let expected = simulator::link(&CLIP.1, &["info"], &line).unwrap();
    let launch = Launch::new(LM3S6965EVB, firmware.elf()).argument("info").argument("link").limit(Duration::from_secs(120));
    let mut session = sync::Session::start(launch).unwrap();
    let mut changed = 0;
    for (frame, (bytes, pair)) in [&vec![]].into_iter().chain(&line).zip(expected.windows(2)).enumerate() {
        let (number, picture) = session.hear(bytes).unwrap();
        assert_eq!((number, &picture), (pair[0].0, &pair[0].1), "picture {frame}");
        changed += usize::from(pair[0].1 != pair[1].1);
    }
    assert_eq!(session.end().unwrap().code, 0);
    // It stands before the first frame, and moves from there on, also while the line damages.
    assert!(changed > line.len() * 3 / 5, "{changed} of {} pictures differ from the one before", line.len());
}

/// Plays in the board's own time what `pantin stream` sends there; what the board then logs.
fn streamed(features: &str, connect: impl FnOnce(Launch, u16) -> Launch, to: impl Fn(u16) -> String) -> String {
    let firmware = firmware(features);
    let port = std::net::UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let launch = Launch::new(LM3S6965EVB, firmware.elf()).argument("link").argument("info").argument("frames=320");
    let mut qemu = connect(launch, port).display().start().unwrap();
    let mut stream = Command::new(build::host_tool().unwrap());
    let output = stream.args(["stream", "--ahead", "1", "--to", &to(port)]).arg(&CLIP.1).output().unwrap();
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && words.contains("packets") && words.contains("refresh"), "{words}");
    assert!(qemu.picture().unwrap().pixels.iter().any(|&pixel| pixel > 0));
    defmt_log::decode(firmware.elf(), &qemu.wait().unwrap().stdout).unwrap().join("\n")
}

/// Nothing is lost on the way, and all channels were exact.
fn is_whole(log: &str) {
    let source = source();
    assert!(log.contains(&format!("{0} of {0} channels exact", source.channels())), "{log}");
    assert!(
        log.lines().last().is_some_and(|last| last.contains(" 0 missing, 0 damaged, 0 foreign, 0 crowded; 0 states lost")),
        "{log}"
    );
}

#[test]
fn pantin_stream_plays_on_a_board_by_its_serial_line() {
    if !setup::host_only("pantin stream to a serial line") {
        let connect = |launch: Launch, port| launch.serial_at(&format!("tcp:127.0.0.1:{port},server=on,wait=off"));
        is_whole(&streamed("face,link", connect, |port| format!("tcp:127.0.0.1:{port}@38400")));
    }
}

#[test]
fn pantin_stream_plays_on_a_board_by_ethernet() {
    if !setup::host_only("pantin stream by UDP") {
        let connect = |launch: Launch, port| launch.network(&format!("user,hostfwd=udp:127.0.0.1:{port}-10.0.2.15:4000"));
        is_whole(&streamed("face,ethernet", connect, |port| format!("udp:127.0.0.1:{port}@38400")));
    }
}

#[test]
fn a_line_that_is_not_there_is_told() {
    let tool = build::host_tool().unwrap();
    let fails = |arguments: &[&str]| {
        let start = Instant::now();
        let output = Command::new(&tool).arg("stream").args(arguments).arg(&CLIP.1).output().unwrap();
        assert!(!output.status.success() && start.elapsed() < Duration::from_secs(20));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    assert!(fails(&["--to", "serial:/dev/pantin-is-not-there"]).contains("cannot be opened"));
    assert!(fails(&["--to", "tcp:127.0.0.1:1"]).contains("cannot connect"));
    assert!(fails(&["--to", "tcp:127.0.0.1:1@300"]).contains("too much for 30 bytes a second"));
    assert!(fails(&["--to", "carrier-pigeon:1"]).contains("expected serial:DEVICE"));
}
