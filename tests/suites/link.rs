//! Motion over a line that loses packets and flips bits: the reference board shows what the host's receiver of the same bytes shows, it keeps
//! moving, and it is exact again when it should be. And it shows what `pantin stream` sends by TCP and UDP.

use std::io::Read;
use std::net::{TcpListener, UdpSocket};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::LazyLock;
use std::time::Duration;

use harness::build::{self, Firmware};
use harness::display::Picture;
use harness::lossy::{Damage, Lossy, arrivals};
use harness::qemu::{LM3S6965EVB, Launch};
use harness::{clips, defmt_log, paths, setup, simulator, sync};
use pantin::Clip;
use pantin_line::sender::{LineSettings, Sender, Source};
use pantin_link::packet::{Receiver, TagKey};
use pantin_link::{Channel, Link, MAX_PACKET, QUEUE_PACKETS};
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

/// What arrives in each frame's time of two rounds over a line of 38,400 baud that is damaged between two of them.
fn line(source: &Source, damage: Damage, from: usize, to: usize) -> (Vec<Vec<u8>>, LineSettings) {
    keyed_line(source, None, damage, from, to)
}

/// The same, with tags of a key.
fn keyed_line(source: &Source, key: Option<TagKey>, damage: Damage, from: usize, to: usize) -> (Vec<Vec<u8>>, LineSettings) {
    let wanted = LineSettings { rate: 3840.0, ahead: 48, share: 1.0, cycle: 12, parity: false, key };
    let fit = wanted.fitted(source).expect("the line carries it");
    let mut lossy = Lossy::new(5);
    let frames = arrivals(Sender::new(3).clip(source, fit, Some(2)), source, fit, |frame, timed| {
        if (from..to).contains(&frame) { lossy.pass(&timed.bytes, damage).0 } else { timed.bytes }
    });
    (frames, fit)
}

/// Half a second of our greeting, in which what is drawn joins the state.
const JOIN: usize = 60;

#[test]
fn the_board_shows_what_the_host_shows_of_a_line_that_damages_and_recovers() {
    if setup::host_only("a line that damages") {
        return;
    }
    let (source, firmware) = (source(), firmware("face,link"));
    let (from, to) = (70, 190);
    let damage = Damage { loss: 0.3, flips: 1e-4 };
    let (line, fit) = line(&source, damage, from, to);
    let expected = simulator::link(&CLIP.1, &[], &line).unwrap();
    let whole = simulator::link(&CLIP.1, &[], &self::line(&source, damage, 0, 0).0).unwrap();
    let launch = Launch::new(LM3S6965EVB, firmware.elf()).argument("link").limit(Duration::from_secs(120));
    let mut session = sync::Session::start(launch).unwrap();
    let (mut moved, mut before, mut wrong) = (0, None, vec![]);
    for (frame, bytes) in [&vec![]].into_iter().chain(&line).enumerate() {
        let (number, picture) = session.hear(bytes).unwrap();
        assert_eq!((number, &picture), (expected[frame].0, &expected[frame].1), "picture {frame}");
        if picture != whole[frame].1 {
            wrong.push(frame);
        }
        moved += usize::from((from..to).contains(&frame) && before.as_ref() != Some(&picture));
        before = Some(picture);
    }
    assert_eq!(session.end().unwrap().code, 0);
    assert!(moved > (to - from) / 2, "while the line damages, {moved} pictures of {} differ from the one before", to - from);
    // What the last damaged packet told of was ahead of its time.
    let last = to + (fit.ahead + fit.cycle) as usize + JOIN;
    println!("pictures {:?} to {:?} are not those of a whole line; at most to {last}", wrong.first(), wrong.last());
    assert!(!wrong.is_empty() && wrong.iter().all(|frame| (from..last).contains(frame)), "{wrong:?}");
}

const KEY: &str = "00112233445566778899aabbccddeeff";
const OTHER_KEY: &str = "00112233445566778899aabbccddeefe";

/// Frames of the line with a key that the board shows.
const KEYED: usize = 90;

#[test]
fn a_receiver_with_a_key_shows_packets_with_its_tag_and_no_others() {
    let source = source();
    let of_key = |key: Option<&str>| {
        let key = key.map(|key| TagKey::from_hex(key).unwrap());
        let (mut frames, _) = keyed_line(&source, key, Damage::default(), 0, 0);
        frames.truncate(KEYED);
        frames
    };
    let (genuine, plain, forged) = (of_key(Some(KEY)), of_key(None), of_key(Some(OTHER_KEY)));
    let word = format!("key={KEY}");
    let shown = |words: &[&str], line: &[Vec<u8>]| simulator::link(&CLIP.1, words, line).unwrap();
    let expected = shown(&[&word], &genuine);
    assert!(expected.windows(2).filter(|pair| pair[0].1 != pair[1].1).count() > KEYED / 3, "hardly anything moves");
    // Another sender's packets come before and after each.
    let mixed: Vec<Vec<u8>> = (0..KEYED).map(|frame| [&plain[frame][..], &genuine[frame], &forged[frame]].concat()).collect();
    assert_eq!(shown(&[&word], &mixed), expected);
    let still = |pictures: Vec<(u32, Picture)>| pictures.windows(2).all(|pair| pair[0] == pair[1]);
    assert!(still(shown(&[&word], &plain)), "packets without a tag are shown");
    assert!(still(shown(&[&word], &forged)), "packets with a tag of another key are shown");
    assert!(still(shown(&[], &genuine)), "packets with a tag are shown without a key");
    assert!(simulator::link(&CLIP.1, &["key=0011"], &genuine).is_err(), "a key that is none");
    if setup::host_only("a line with a key") {
        return;
    }
    let firmware = firmware("face,key");
    let launch = Launch::new(LM3S6965EVB, firmware.elf()).argument("link").argument(&word).limit(Duration::from_secs(120));
    let mut session = sync::Session::start(launch).unwrap();
    for (frame, bytes) in [&vec![]].into_iter().chain(&mixed).enumerate() {
        assert_eq!(session.hear(bytes).unwrap(), expected[frame], "picture {frame}");
    }
    assert_eq!(session.end().unwrap().code, 0);
}

#[test]
fn a_key_that_is_none_is_refused_and_not_printed() {
    let mut stream = Command::new(build::host_tool().unwrap());
    let output = stream.args(["stream", "--to", "udp:127.0.0.1:9", "--key", "0123456789"]).arg(&CLIP.1).output().unwrap();
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success() && words.contains("--key: neither 32 hexadecimal digits nor a file"), "{words}");
    assert!(!words.contains("0123456789"), "{words}");
}

#[test]
fn pantin_stream_plays_with_a_key_on_a_board_by_ethernet() {
    if setup::host_only("pantin stream with a key") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("key");
    std::fs::write(&file, format!("{KEY}\n")).unwrap();
    is_whole(&by_ethernet("face,ethernet,key", &[&format!("key={KEY}")], &["--key", file.to_str().unwrap()]));
}

#[test]
fn pantin_stream_plays_on_a_board_by_ethernet() {
    if !setup::host_only("pantin stream by UDP") {
        is_whole(&by_ethernet("face,ethernet", &[], &[]));
    }
}

/// A board that hears a line in the mode `sync`: it goes on when the test says so, so nothing depends on how fast either machine is.
struct Listener {
    firmware: Firmware,
    session: sync::Session,
}

impl Listener {
    fn start(features: &str, words: &[&str], network: Option<u16>) -> Listener {
        let firmware = firmware(features);
        let launch = Launch::new(LM3S6965EVB, firmware.elf()).argument("link").argument("info").limit(Duration::from_secs(600));
        let launch = words.iter().fold(launch, |launch, word| launch.argument(*word));
        let launch = match network {
            Some(port) => launch.network(&format!("user,hostfwd=udp:127.0.0.1:{port}-10.0.2.15:4000")),
            None => launch,
        };
        let mut session = sync::Session::start(launch).unwrap();
        session.hear(&[]).unwrap();
        Listener { firmware, session }
    }

    /// What the board logs of all that it heard, after it has shown something.
    fn end(mut self) -> String {
        assert!(self.session.picture().unwrap().pixels.iter().any(|&pixel| pixel > 0));
        defmt_log::decode(self.firmware.elf(), &self.session.end().unwrap().stdout).unwrap().join("\n")
    }
}

/// Frames that the board goes on by after each packet: `pantin stream` fills a line of 38,400 baud.
const FRAMES_A_PACKET: usize = 3;

/// Frames in which the board answers who has its address: it looks for the question whenever it waits for a letter.
const FRAMES_TO_ANSWER: usize = 10;

/// Passes on to the board's network what `pantin stream` sends by UDP; what the board then logs.
fn by_ethernet(features: &str, words: &[&str], options: &[&str]) -> String {
    // The port is free again when QEMU listens there.
    let port = UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let mut board = Listener::start(features, words, Some(port));
    let [socket, out] = [(); 2].map(|()| UdpSocket::bind("127.0.0.1:0").unwrap());
    // QEMU asks for the board's address at the first datagram, which may be lost meanwhile: a zero means nothing to the board.
    out.send_to(&[0], ("127.0.0.1", port)).unwrap();
    (0..FRAMES_TO_ANSWER).for_each(|_| drop(board.session.hear(&[]).unwrap()));
    let mut stream = Command::new(build::host_tool().unwrap());
    let to = format!("udp:{}@38400", socket.local_addr().unwrap());
    stream.args(["stream", "--ahead", "1", "--to", &to]).args(options).arg(&CLIP.1);
    let words = datagrams(&mut stream, &socket, |packet| {
        // With the letter in its datagram, the packet cannot come after it.
        let packet = [packet, &sync::letter(pantin_app::NEXT)].concat();
        out.send_to(&packet, ("127.0.0.1", port)).unwrap();
        board.session.heard().unwrap();
        (1..FRAMES_A_PACKET).for_each(|_| drop(board.session.hear(&[]).unwrap()));
    });
    assert!(words.contains("packets") && words.contains("refresh"), "{words}");
    board.end()
}

/// Bytes of a frame's time on the line: its frames are those of 120 a second.
const BYTES_A_FRAME: usize = 32;

#[test]
fn pantin_stream_plays_on_a_board_by_its_serial_line() {
    if setup::host_only("pantin stream to a serial line") {
        return;
    }
    let line = TcpListener::bind("127.0.0.1:0").unwrap();
    let to = format!("tcp:{}@38400", line.local_addr().unwrap());
    let mut stream = Command::new(build::host_tool().unwrap());
    stream.args(["stream", "--ahead", "1", "--to", &to]).arg(&CLIP.1).stderr(Stdio::piped());
    let stream = stream.spawn().unwrap();
    let mut bytes = Vec::new();
    line.accept().unwrap().0.read_to_end(&mut bytes).unwrap();
    let output = stream.wait_with_output().unwrap();
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && words.contains("packets") && words.contains("refresh"), "{words}");
    let mut board = Listener::start("face,link", &[], None);
    // A frame at a time, but no packet in two: the letter between them would end it.
    let (mut waiting, mut sent, mut frames) = (Vec::new(), 0, 0);
    for packet in bytes.split_inclusive(|&byte| byte == 0) {
        waiting.extend_from_slice(packet);
        sent += packet.len();
        while sent > (frames + 1) * BYTES_A_FRAME {
            board.session.hear(&std::mem::take(&mut waiting)).unwrap();
            frames += 1;
        }
    }
    board.session.hear(&waiting).unwrap();
    is_whole(&board.end());
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

/// Takes what `stream` sends to a UDP socket until it ends, a datagram at a time; its words at the end.
fn datagrams(stream: &mut Command, socket: &UdpSocket, mut each: impl FnMut(&[u8])) -> String {
    socket.set_read_timeout(Some(Duration::from_millis(100))).unwrap();
    let mut stream = stream.stderr(Stdio::piped()).spawn().unwrap();
    let mut room = [0; 2048];
    loop {
        // What was sent before the end is there after it.
        let ended = stream.try_wait().unwrap().is_some();
        match socket.recv(&mut room) {
            Ok(len) => each(&room[..len]),
            Err(_) if ended => break,
            Err(_) => {}
        }
    }
    let output = stream.wait_with_output().unwrap();
    let words = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{words}");
    words
}

/// Takes what `stream` sends to a UDP socket until it ends, and goes on by three frames after each datagram; its words at the end.
fn heard(stream: &mut Command, socket: &UdpSocket, clip: &Clip, mut each: impl FnMut(&Link<QUEUE_PACKETS>)) -> String {
    let channels = clip.rig().channels();
    let (mut states, mut pose) = (vec![Channel::default(); channels], vec![0; channels]);
    let mut link = Link::<QUEUE_PACKETS>::new(clip.form(), &mut states, &mut pose);
    let mut receiver = Receiver::<MAX_PACKET>::new();
    let words = datagrams(stream, socket, |bytes| {
        for &byte in bytes {
            if let Some(packet) = receiver.push(byte) {
                link.receive(&packet).unwrap();
            }
        }
        for _ in 0..FRAMES_A_PACKET {
            link.step();
            each(&link);
        }
    });
    assert_eq!(link.counts().missing, 0);
    words
}

#[test]
fn pantin_stream_sends_clips_one_after_the_other() {
    let bytes = std::fs::read(&CLIP.1).unwrap();
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let to = format!("udp:{}@38400", socket.local_addr().unwrap());
    let mut stream = Command::new(build::host_tool().unwrap());
    stream.args(["stream", "--ahead", "0.5", "--to", &to]).arg(&CLIP.1).arg(&CLIP.1);
    let mut exact = [0; 2];
    let words = heard(&mut stream, &socket, &Clip::new_checked(&bytes).unwrap(), |link| {
        if let Some(head) = link.head().filter(|_| link.is_synced()) {
            exact[usize::from(head.clip)] += 1;
        }
    });
    assert!(exact.iter().all(|&frames| frames > 20), "{exact:?} {words}");
}

/// Frames of a face that is recorded, and one of its values.
const RECORDED: usize = 120;

fn recorded(frame: usize, channel: usize) -> f64 {
    0.5 + 0.4 * (frame as f64 / (5.0 + 3.0 * channel as f64)).sin()
}

#[test]
fn pantin_stream_sends_a_face_while_it_is_recorded() {
    let folder = tempfile::tempdir().unwrap();
    let values = |frame: usize| (0..3).map(|channel| format!(",{:.6}", recorded(frame, channel))).collect::<String>();
    let line = |frame: usize| format!("00:00:{:02}:{:02}.000,3{}\n", frame / 30, frame % 30, values(frame));
    let text: String = std::iter::once("Timecode,BlendShapeCount,EyeBlinkLeft,JawOpen,MouthSmileLeft\n".into())
        .chain((0..RECORDED).map(line))
        .collect();
    let csv = folder.path().join("face.csv");
    std::fs::write(&csv, &text).unwrap();
    let clip = clips::convert(&csv, folder.path()).unwrap();
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let to = format!("udp:{}@38400", socket.local_addr().unwrap());
    let mut stream = Command::new(build::host_tool().unwrap());
    stream.args(["stream", "--live", "-", "--to", &to]).arg(&clip).stdin(std::fs::File::open(&csv).unwrap());
    let bytes = std::fs::read(&clip).unwrap();
    let mut exact = 0;
    let words = heard(&mut stream, &socket, &Clip::new_checked(&bytes).unwrap(), |link| {
        let Some(frame) =
            link.frame().map(|frame| frame as usize).filter(|frame| link.is_synced() && (1..RECORDED).contains(frame))
        else {
            return;
        };
        exact += 1;
        for (channel, state) in link.channels().iter().enumerate() {
            let value = f64::from(state.state().unwrap()[0]) / 30f64.exp2();
            assert!((value - recorded(frame, channel)).abs() < 0.021, "frame {frame}, channel {channel}: {value}");
        }
    });
    assert!(words.contains("3 channels; shown 567 ms after they came") && !words.contains("no room"), "{words}");
    assert!(exact >= RECORDED - 20, "{exact}");
}

#[test]
fn a_line_that_is_not_there_is_told() {
    let tool = build::host_tool().unwrap();
    let fails = |arguments: &[&str]| {
        let output = Command::new(&tool).arg("stream").args(arguments).arg(&CLIP.1).output().unwrap();
        assert!(!output.status.success());
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    assert!(fails(&["--to", "serial:/dev/pantin-is-not-there"]).contains("cannot be opened"));
    assert!(fails(&["--to", "tcp:127.0.0.1:1"]).contains("cannot connect"));
    assert!(fails(&["--to", "tcp:127.0.0.1:1@300"]).contains("too much for 30 bytes a second"));
    assert!(fails(&["--to", "carrier-pigeon:1"]).contains("expected serial:DEVICE"));
}
