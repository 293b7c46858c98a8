//! A body over a line while it is captured: VMC datagrams and BVH rows become packets, and a simulated board shows them soon. Time is that of the line.

use std::net::{SocketAddr, UdpSocket};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::LazyLock;
use std::time::{Duration, Instant};

use harness::{build, simulator};
use pantin::Clip;
use pantin_line::sender::{LineSettings, LiveChannel, LiveTiming, Sender, Source};
use pantin_line::stream::body::Body;
use pantin_link::packet::Receiver;
use pantin_link::{Channel, Link, MAX_PACKET, QUEUE_PACKETS};
use tempfile::TempDir;

/// Joints with their parents and offsets: a figure that stands with its arms out.
const JOINTS: [(&str, &str, [i32; 3]); 17] = [
    ("Hips", "", [0, 0, 0]),
    ("Spine", "Hips", [0, 12, 0]),
    ("Chest", "Spine", [0, 14, 0]),
    ("Neck", "Chest", [0, 24, 0]),
    ("Head", "Neck", [0, 10, 0]),
    ("LeftUpperArm", "Chest", [17, 20, 0]),
    ("LeftLowerArm", "LeftUpperArm", [27, 0, 0]),
    ("LeftHand", "LeftLowerArm", [25, 0, 0]),
    ("RightUpperArm", "Chest", [-17, 20, 0]),
    ("RightLowerArm", "RightUpperArm", [-27, 0, 0]),
    ("RightHand", "RightLowerArm", [-25, 0, 0]),
    ("LeftUpperLeg", "Hips", [9, -4, 0]),
    ("LeftLowerLeg", "LeftUpperLeg", [0, -42, 0]),
    ("LeftFoot", "LeftLowerLeg", [0, -40, 0]),
    ("RightUpperLeg", "Hips", [-9, -4, 0]),
    ("RightLowerLeg", "RightUpperLeg", [0, -42, 0]),
    ("RightFoot", "RightLowerLeg", [0, -40, 0]),
];
const FRAME_SECONDS: f64 = 1.0 / 60.0;
/// The fastest turn of these motions.
const MOST_DEGREES_A_FRAME: f64 = 4.0;
/// What is allowed from a datagram to the picture that shows it.
const MOST_MILLISECONDS: f64 = 150.0;

/// The figure's hierarchy and the head of its motion.
fn head() -> String {
    fn joint(name: &str, keyword: &str) -> String {
        let (_, _, [x, y, z]) = JOINTS.iter().find(|(own, ..)| *own == name).unwrap();
        let places = if keyword == "ROOT" { "6 Xposition Yposition Zposition" } else { "3" };
        let children: String =
            JOINTS.iter().filter(|(_, parent, _)| *parent == name).map(|(own, ..)| joint(own, "JOINT")).collect();
        let end = if children.is_empty() { "End Site\n{\nOFFSET 0 0 9\n}\n" } else { &children };
        format!("{keyword} {name}\n{{\nOFFSET {x} {y} {z}\nCHANNELS {places} Zrotation Xrotation Yrotation\n{end}}}\n")
    }
    format!("HIERARCHY\n{}MOTION\nFrames: 0\nFrame Time: 0.0166667\n", joint("Hips", "ROOT"))
}

/// A row in which every joint turns, each at its own pace.
fn row(frame: usize) -> String {
    let time = frame as f64 * FRAME_SECONDS;
    let angle = |index: usize| format!(" {:.4}", 25.0 * (time * (1.0 + index as f64 / 20.0)).sin());
    let turns: String = (0..3 * JOINTS.len()).map(angle).collect();
    format!("{:.4} 95 0{turns}\n", 20.0 * time.sin())
}

/// The clip that the board has.
static CLIP: LazyLock<(TempDir, PathBuf)> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let (bvh, clip) = (folder.path().join("figure.bvh"), folder.path().join("figure.ptn"));
    let still = format!("0 95 0{}\n", " 0".repeat(3 * JOINTS.len()));
    std::fs::write(&bvh, head().replace("Frames: 0", "Frames: 2") + &still + &still).unwrap();
    let output = Command::new(build::host_tool().unwrap())
        .args(["convert", "--rotations", "euler", "--cm-per-unit", "1", "--up", "y"])
        .arg(&bvh)
        .arg("-o")
        .arg(&clip)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    (folder, clip)
});

/// What an OSC program sends for a bone: its place, and its rotation by `degrees` about z of Unity.
fn bone(name: &str, place: [f32; 3], degrees: f32) -> Vec<u8> {
    let mut out = Vec::new();
    for text in ["/VMC/Ext/Bone/Pos", ",sfffffff", name] {
        out.extend(text.as_bytes());
        out.resize((out.len() + 1).next_multiple_of(4), 0);
    }
    let half = (degrees / 2.0).to_radians();
    [&place[..], &[0.0, 0.0, half.sin(), half.cos()]].concat().iter().for_each(|number| out.extend(number.to_be_bytes()));
    out
}

/// A datagram of a frame in which the arms move if they are `moving`.
fn datagram(frame: usize, moving: bool) -> Vec<u8> {
    let wave = if moving { 60.0 * (frame as f32 * FRAME_SECONDS as f32 * 4.0).sin() } else { 0.0 };
    let mut out = b"#bundle\0\0\0\0\0\0\0\0\x01".to_vec();
    for (name, place, degrees) in
        [("Hips", [0.0, 0.95, 0.0], 0.0), ("LeftUpperArm", [0.0; 3], wave), ("RightLowerArm", [0.0; 3], wave / 2.0)]
    {
        let element = bone(name, place, degrees);
        out.extend((element.len() as u32).to_be_bytes());
        out.extend(element);
    }
    out
}

/// A session in the line's time.
struct Session {
    /// What has arrived by each frame's time.
    arrived: Vec<Vec<u8>>,
    /// The pose of each frame as it was captured.
    poses: Vec<Vec<i32>>,
    omitted: u32,
    bytes_a_second: f64,
}

/// Sends `frames` poses of a body over a line of 38,400 baud; `bring` gives the body the datagrams or rows before each.
fn session(mut body: Body, frames: usize, mut bring: impl FnMut(&mut Body, usize)) -> Session {
    let bytes = std::fs::read(&CLIP.1).unwrap();
    let clip = Clip::new_checked(&bytes).unwrap();
    let posing = body.posing();
    let (bounds, ways) = (posing.raw_errors(1.0, 0.5, 0.02), posing.raw_errors(180.0, 100.0, 1.0));
    let channels = bounds.into_iter().zip(ways).zip(posing.wraps());
    let channels: Vec<LiveChannel> =
        channels.map(|((bound, way), wraps)| LiveChannel { bound, way: way as u32, wraps }).collect();
    let source = Source::live(clip.form(), clip.frame_time_ns(), &channels);
    let line = LineSettings { rate: 3840.0, ahead: 2, share: 1.0, cycle: 40, parity: false, key: None };
    let mut live = Sender::new(7).live(&source, line, LiveTiming::BODY, &channels);
    let (mut on_line, mut arrived, mut poses) = (Vec::new(), Vec::new(), Vec::new());
    for frame in 0..frames {
        bring(&mut body, frame);
        poses.push(body.pose());
        for timed in live.push(&poses[frame]) {
            on_line.push((timed.at + timed.bytes.len() as f64 / line.rate, timed.bytes));
        }
        let now = (frame as f64 + 1.0 - f64::from(LiveTiming::BODY.delay(&line))) * FRAME_SECONDS;
        let there = on_line.iter().take_while(|(there, _)| *there <= now).count();
        arrived.push(on_line.drain(..there).flat_map(|(_, bytes)| bytes).collect());
    }
    Session {
        arrived,
        poses,
        omitted: live.omitted_messages(),
        bytes_a_second: live.bytes().line / (frames as f64 * FRAME_SECONDS),
    }
}

fn body(make: impl FnOnce(&Clip) -> anyhow::Result<Body>) -> Body {
    let bytes = std::fs::read(&CLIP.1).unwrap();
    make(&Clip::new_checked(&bytes).unwrap()).unwrap()
}

/// From when a frame was captured to when the receiver shows it, in frames, at most; each of them within the bound from frame `from` on.
fn latest(session: &Session, from: usize) -> usize {
    let bytes = std::fs::read(&CLIP.1).unwrap();
    let clip = Clip::new_checked(&bytes).unwrap();
    let (mut states, mut pose) = (vec![Channel::default(); clip.rig().channels()], vec![0; clip.rig().channels()]);
    let mut link = Link::<QUEUE_PACKETS>::new(clip.form(), &mut states, &mut pose);
    let mut receiver = Receiver::<MAX_PACKET>::new();
    let (mut late, mut waits, mut before, degree) = (0, 0, None, f64::from(1u32 << 31) / 180.0);
    for (frame, bytes) in session.arrived.iter().enumerate() {
        for &byte in bytes {
            if let Some(packet) = receiver.push(byte) {
                link.receive(&packet).unwrap();
            }
        }
        link.step();
        if frame < from {
            continue;
        }
        assert!(link.is_synced(), "frame {frame}: {} channels exact", link.exact_channels());
        let shown = link.frame().unwrap() as usize;
        late = late.max(frame - shown);
        let waited = before.replace(shown) == Some(shown);
        waits += usize::from(waited);
        // The first three are places.
        for (channel, wanted) in session.poses[shown].iter().enumerate().skip(3) {
            let off = |value: i32| f64::from(value.wrapping_sub(*wanted)).abs() / degree;
            let (state, drawn) = (link.channels()[channel].state().unwrap()[0], link.pose().values[channel]);
            assert!(off(state) < 1.1, "frame {shown}, channel {channel}: {} degrees", off(state));
            // While the clock waits for a packet, what is drawn goes on by half of its last way.
            assert!(off(drawn) < 1.1 + MOST_DEGREES_A_FRAME, "frame {shown}, channel {channel}: {} degrees", off(drawn));
        }
    }
    println!("the clock waited in {waits} of {} frames", session.arrived.len() - from);
    assert!(20 * waits < session.arrived.len() - from, "{waits} waits");
    late
}

#[test]
fn a_vmc_body_is_on_the_board_within_150_ms() {
    const MOVES: usize = 240;
    let from: SocketAddr = "127.0.0.1:39540".parse().unwrap();
    let sent = |moves: bool| {
        session(body(Body::vmc), 420, |body, frame| {
            body.receive(from, &datagram(frame - frame.min(MOVES), moves && frame >= MOVES));
        })
    };
    let (moving, still) = (sent(true), sent(false));
    let milliseconds = 1e3 * latest(&moving, 120) as f64 * FRAME_SECONDS;
    println!("shown {milliseconds:.0} ms after a datagram at the latest; {:.0} bytes a second", moving.bytes_a_second);
    assert!(milliseconds <= MOST_MILLISECONDS, "{milliseconds} ms");
    assert_eq!(moving.omitted, 0);
    let pictures = [&moving, &still].map(|session| simulator::link(&CLIP.1, &[], &session.arrived).unwrap());
    let differs = |index: &usize| pictures[0][*index].1 != pictures[1][*index].1;
    let all: Vec<usize> = (0..pictures[0].len()).filter(differs).collect();
    // A picture precedes the first frame's.
    let first = all[0] - 1;
    let milliseconds = 1e3 * (first - MOVES) as f64 * FRAME_SECONDS;
    println!("the first picture that moves is {milliseconds:.0} ms after its datagram; {} move", all.len());
    assert!(first >= MOVES && milliseconds <= MOST_MILLISECONDS && all.len() > 150, "{first} {}", all.len());
}

#[test]
fn every_angle_of_a_bvh_stream_is_on_the_board_within_150_ms() {
    let stream = head() + &(0..420).map(row).collect::<String>();
    // Rows come as pieces of a pipe.
    let mut bytes = stream.as_bytes().chunks(700);
    let sent = session(body(|clip| Body::bvh(clip, "-".as_ref())), 420, |body, _| {
        while !body.has_row() {
            body.push(bytes.next().unwrap()).unwrap();
        }
    });
    let milliseconds = 1e3 * latest(&sent, 180) as f64 * FRAME_SECONDS;
    println!(
        "shown {milliseconds:.0} ms after a row at the latest; {:.0} bytes a second, {} omitted",
        sent.bytes_a_second, sent.omitted
    );
    assert!(milliseconds <= MOST_MILLISECONDS, "{milliseconds} ms");
}

/// Log lines of a body over `frames` frames, and its last pose.
fn logged(body: &mut Body, frames: usize, mut bring: impl FnMut(&mut Body, usize)) -> (Vec<String>, Vec<i32>) {
    let mut pose = Vec::new();
    for frame in 0..frames {
        bring(body, frame);
        pose = body.pose();
    }
    (body.take_log(), pose)
}

#[test]
fn a_silent_sender_leaves_its_pose_which_eases_to_rest() {
    let mut body = body(Body::vmc);
    let rest = body.pose();
    let [first, other]: [SocketAddr; 2] = ["10.0.0.1:39539", "10.0.0.2:39539"].map(|address| address.parse().unwrap());
    let (log, held) = logged(&mut body, 10, |body, frame| {
        body.receive(first, &datagram(frame + 20, true));
        // Another sender, while the first one is heard.
        body.receive(other, &datagram(0, false));
    });
    assert!(log.len() == 2 && log[0].contains("10.0.0.1:39539: its poses are shown"), "{log:?}");
    assert!(log[1].contains("10.0.0.2:39539: another sender") && body.left_out() == 10, "{log:?}");
    assert_ne!(held, rest);
    // 0.5 s, then 2 s, then a second more.
    let (log, pose) = logged(&mut body, 118, |_, _| {});
    assert!(log.len() == 1 && log[0].contains("the last pose is held") && pose == held, "{log:?}");
    let (log, pose) = logged(&mut body, 30, |_, _| {});
    assert!(log.len() == 1 && log[0].contains("returns to rest") && pose != held && pose != rest, "{log:?}");
    let (log, pose) = logged(&mut body, 60, |_, _| {});
    assert!(log.is_empty() && pose == rest, "{log:?}");
    // The other one is taken now.
    let (log, pose) = logged(&mut body, 1, |body, _| body.receive(other, &datagram(20, true)));
    assert!(log.len() == 1 && log[0].contains("10.0.0.2:39539: its poses are shown") && pose != rest, "{log:?}");
}

#[test]
fn what_is_wrong_is_logged_once_and_left_out() {
    let mut body = body(Body::vmc);
    let from: SocketAddr = "10.0.0.1:39539".parse().unwrap();
    let cut = |len: usize| datagram(20, true)[..len].to_vec();
    let wrong = [cut(3), cut(30), b"/VMC/Ext/Bone/Pos\0\0\0,i\0\0\0\0\0\x01".to_vec(), vec![], bone("Hips", [f32::NAN; 3], 0.0)];
    let (log, pose) = logged(&mut body, 50, |body, frame| {
        body.receive(from, &wrong[frame % wrong.len()]);
        body.receive(from, &bone("Tail", [0.0; 3], 0.0));
    });
    assert_eq!(body.left_out(), 50);
    assert!(log.len() <= 5 && log.iter().any(|line| line.contains("Tail: an unknown bone")), "{log:?}");
    assert!(log.iter().any(|line| line.contains("a bone without a name")), "{log:?}");
    assert!(log.iter().any(|line| line.contains("not finite")), "{log:?}");
    assert_eq!(pose, self::body(Body::vmc).pose());
}

#[test]
fn a_damaged_stream_holds_its_last_pose_and_is_over_at_rest() {
    let stream = head() + &(0..30).map(row).collect::<String>() + "1 2 3\n" + &row(31);
    let mut body = body(|clip| Body::bvh(clip, "-".as_ref()));
    let rest = body.pose();
    body.push(stream.as_bytes()).unwrap();
    let (log, last) = logged(&mut body, 31, |_, _| {});
    let line = head().lines().count() + 31;
    assert!(log.len() == 1 && log[0].contains(&format!("-:{line}: expected 54 numbers, one a channel, found 3")), "{log:?}");
    assert!(last != rest && !body.is_over());
    let (log, pose) = logged(&mut body, 190, |body, _| body.push(row(1).as_bytes()).unwrap());
    assert!(pose == rest && body.is_over() && log.len() == 2, "{log:?}");
    for (stream, wanted) in [
        (head().replace("0.0166667", "0.01"), "100.00 frames a second, and the clip has 60.00"),
        (head().replace("0.0166667", "x"), "expected a number"),
        ("time,a\n".into(), "expected `HIERARCHY`"),
    ] {
        let mut body = self::body(|clip| Body::bvh(clip, "-".as_ref()));
        let error = format!("{:#}", body.push(stream.as_bytes()).unwrap_err());
        assert!(error.contains(wanted), "{error}");
    }
}

#[test]
fn pantin_stream_sends_a_body_that_comes_on_its_standard_input() {
    let folder = tempfile::tempdir().unwrap();
    let bvh = folder.path().join("live.bvh");
    std::fs::write(&bvh, head() + &(0..90).map(row).collect::<String>()).unwrap();
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let to = format!("udp:{}@38400", socket.local_addr().unwrap());
    let mut stream = Command::new(build::host_tool().unwrap());
    stream.args(["stream", "--live", "bvh:-", "--to", &to]).arg(&CLIP.1).stdin(std::fs::File::open(&bvh).unwrap());
    let output = stream.stderr(Stdio::piped()).output().unwrap();
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && words.contains("54 channels; shown 100 ms after they came"), "{words}");
    assert!(words.contains("packets,") && !words.contains("warning"), "{words}");
    for (from, wanted) in [("vmc:x", "expected vmc:PORT"), ("bvh:x", "expected vmc:PORT"), ("-", "a clip with joints")] {
        let output = Command::new(build::host_tool().unwrap())
            .args(["stream", "--live", from, "--to", &to])
            .arg(&CLIP.1)
            .output()
            .unwrap();
        let words = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && words.contains(wanted), "{words}");
    }
}

/// What is allowed until the pose is shown, on a machine that is busy.
const PATIENCE: Duration = Duration::from_secs(60);

#[test]
fn pantin_stream_sends_a_body_that_comes_by_datagrams() {
    let bytes = std::fs::read(&CLIP.1).unwrap();
    let clip = Clip::new_checked(&bytes).unwrap();
    let datagram = datagram(20, true);
    let mut body = Body::vmc(&clip).unwrap();
    body.receive(SocketAddr::from(([127, 0, 0, 1], 1)), &datagram);
    let (wanted, bounds) = (body.pose(), body.posing().raw_errors(1.0, 0.5, 0.02));
    let [socket, vmc] = [0; 2].map(|_| UdpSocket::bind("127.0.0.1:0").unwrap());
    let (to, port) = (format!("udp:{}@38400", socket.local_addr().unwrap()), vmc.local_addr().unwrap().port());
    drop(vmc);
    let stream = Command::new(build::host_tool().unwrap())
        .args(["stream", "--live", &format!("vmc:{port}"), "--to", &to])
        .arg(&CLIP.1)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let program = UdpSocket::bind("127.0.0.1:0").unwrap();
    socket.set_read_timeout(Some(Duration::from_millis(15))).unwrap();
    let (mut states, mut pose) = (vec![Channel::default(); clip.rig().channels()], vec![0; clip.rig().channels()]);
    let mut link = Link::<QUEUE_PACKETS>::new(clip.form(), &mut states, &mut pose);
    let mut receiver = Receiver::<MAX_PACKET>::new();
    let (started, mut packet) = (Instant::now(), [0; 2048]);
    let shows = |link: &Link<QUEUE_PACKETS>| {
        let values = link.channels().iter().map(|channel| channel.state().map(|state| state[0]));
        link.is_synced()
            && values
                .zip(&wanted)
                .zip(&bounds)
                .all(|((value, wanted), bound)| value.is_some_and(|value| value.wrapping_sub(*wanted).abs() <= *bound))
    };
    while !shows(&link) {
        assert!(started.elapsed() < PATIENCE, "the pose does not come: {:?}", link.counts());
        // Before the port is open, and where the line is full, there is nobody to hear it.
        let _ = program.send_to(&datagram, ("127.0.0.1", port));
        if let Ok(len) = socket.recv(&mut packet) {
            for &byte in &packet[..len] {
                if let Some(packet) = receiver.push(byte) {
                    link.receive(&packet).unwrap();
                }
            }
            link.step();
        }
    }
    let stopped = Command::new("kill").args(["-INT", &stream.id().to_string()]).status().unwrap();
    assert!(stopped.success());
    let output = stream.wait_with_output().unwrap();
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(words.contains("its poses are shown") && words.contains("packets,") && !words.contains("left out"), "{words}");
}
