//! The Raspberry Pi Pico's own flash image in rp2040js: what its displays show over their buses is what the same program shows on the host.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use board_drivers::servo::{self, JointAngle, Law, Servo, SoftStart};
use embedded_graphics::Drawable;
use embedded_graphics::geometry::Point;
use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_4X6};
use embedded_graphics::pixelcolor::BinaryColor;
use embedded_graphics::text::{Baseline, Text};
use harness::build::Firmware;
use harness::display::{Display, Picture};
use harness::lossy::arrivals;
use harness::rp2040::{self, CLOCK, LCD, OLED, Outcome, Request, Spi};
use harness::vectors::synthetic::noisy;
use harness::{clips, paths, screen, setup, simulator, sync};
use pantin::{Axis, ChannelState, Clip, Player};
use pantin_app::TextScreen;
use pantin_convert::import::{Disk, ImportOptions, import};
use pantin_figure::rotation::Rotation;
use pantin_figure::surface::{Framebuffer, MonoPages};
use pantin_line::sender::{LineSettings, Sender, Source};
use tempfile::TempDir;

/// Our walk, as converted now, and a greeting with body and face.
static CLIPS: LazyLock<(TempDir, Vec<PathBuf>)> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let walk = clips::convert(&paths::root().join("motions/walk.keys"), folder.path()).unwrap();
    (folder, vec![walk, paths::root().join("motions/face/hello.ptn"), paths::root().join("motions/greet.ptn")])
});

/// Stretches of a frame.
const STRETCHES: [&str; 4] = ["decode", "place", "draw", "show"];

fn image(features: &str) -> (TempDir, PathBuf) {
    program("pico", features, &CLIPS.1)
}

fn program(name: &str, features: &str, clips: &[PathBuf]) -> (TempDir, PathBuf) {
    let clips: Vec<&Path> = clips.iter().map(PathBuf::as_path).collect();
    let firmware = Firmware::featuring(features, "pico", name, rp2040::TARGET, &clips).unwrap();
    rp2040::image(firmware.elf()).unwrap()
}

fn in_step(request: Request, keys: &[&[u8]]) -> Outcome {
    let outcome = request.in_step(keys).run().unwrap();
    assert_eq!(outcome.ended, "done");
    outcome
}

fn expected(display: Display, keys: &[&[u8]]) -> Vec<(u32, Picture)> {
    simulator::play::<Rotation>(display, &CLIPS.1, &[], keys).unwrap()
}

fn equal(outcome: &Outcome, expected: &[(u32, Picture)]) {
    assert_eq!(outcome.pictures.len(), expected.len());
    assert_eq!(outcome.frames.len(), expected.len());
    for (index, ((number, picture), (shown, frame))) in
        expected.iter().zip(outcome.pictures.iter().zip(&outcome.frames)).enumerate()
    {
        assert_eq!(frame.number, Some(*number), "picture {index}");
        assert!(!picture.is_dark(), "every picture shows something");
        if let Some(difference) = screen::difference(shown, picture) {
            panic!("picture {index} of frame {number}: {difference}");
        }
    }
}

/// Says what a frame takes, and returns the longest frame's time in milliseconds. The first, which sends a whole picture, does not count.
fn measures(what: &str, outcome: &Outcome) -> f64 {
    let frames = &outcome.frames[1..];
    let mean = |stretch: usize| frames.iter().map(|frame| frame.cycles[stretch]).sum::<u64>() / frames.len() as u64;
    let stretches: Vec<String> = STRETCHES.iter().enumerate().map(|(index, name)| format!("{name} {}", mean(index))).collect();
    let bytes = frames.iter().map(|frame| frame.bytes).sum::<u64>() / frames.len() as u64;
    let worst = frames.iter().map(|frame| frame.cycles.iter().sum::<u64>()).max().unwrap() as f64 / CLOCK * 1e3;
    let all = (0..4).map(mean).sum::<u64>() as f64 / CLOCK * 1e3;
    println!("{what}: clocks a frame: {}; {bytes} bytes; {all:.1} ms, at most {worst:.1} ms", stretches.join(", "));
    worst
}

/// Sends no keys between pictures except the one for the next clip after N pictures of each.
fn through_all_clips(pictures: usize) -> Vec<&'static [u8]> {
    let through = |_| std::iter::repeat_n(&b""[..], pictures - 1).chain([&b"n"[..]]);
    (0..CLIPS.1.len()).flat_map(through).collect()
}

#[test]
fn shows_on_the_ssd1306_what_the_host_shows() {
    if setup::host_only("pictures over I2C on the Pico") {
        return;
    }
    let (_folder, image) = image("face");
    let mut keys = through_all_clips(24);
    keys.extend([&b"i"[..], b"v", b"a", b"w", b"f", b"r", b".", b",", b"g", b"l"]);
    equal(&in_step(Request::new(&image, OLED), &keys), &expected(OLED, &keys));
}

#[test]
fn shows_on_the_st7789_what_the_host_shows() {
    if setup::host_only("pictures over SPI on the Pico") {
        return;
    }
    let (_folder, image) = image("face,st7789");
    let keys = through_all_clips(12);
    equal(&in_step(Request::new(&image, LCD), &keys), &expected(LCD, &keys));
}

/// The walk on an SSD1306 to whose wires something happens.
fn plugged(image: &Path, timed: bool, plugs: &[(f64, &'static str)], pictures: &[(u32, Picture)]) {
    const SHOWN: usize = 36;
    let request = Request::new(image, OLED).plugs(plugs).pictures(SHOWN).seconds(1.0);
    let outcome = if timed { request.timed() } else { request }.run().unwrap();
    assert_eq!((&*outcome.ended, outcome.pictures.len()), ("done", SHOWN), "{plugs:?}: the program goes on");
    let state = |nanos: f64| plugs.iter().rev().find(|(seconds, _)| seconds * 1e9 <= nanos).map_or("in", |(_, state)| state);
    let mut whole = 0;
    for (index, (shown, frames)) in outcome.pictures.iter().zip(outcome.frames.windows(2)).enumerate() {
        let Some(begun) = index.checked_sub(1).map(|before| outcome.frames[before].nanos) else { continue };
        let now = frames[0].nanos;
        match [begun, now].map(state) {
            ["in", "in"] => {
                let found = pictures.iter().any(|(_, picture)| picture == shown);
                assert!(found, "{plugs:?}: picture {index} is none of the walk");
                whole += 1;
            }
            [_, "out" | "stuck"] => assert!(shown.is_dark(), "picture {index}"),
            // Plugged in or out amid a picture.
            _ => {}
        }
    }
    assert!(whole > 10, "{plugs:?}: {whole} pictures");
}

#[test]
fn a_display_that_does_not_answer_is_set_up_when_it_does() {
    if setup::host_only("an unplugged display on the Pico") {
        return;
    }
    let (_folder, image) = image("");
    let pictures = expected(OLED, &[&b""[..]; 120]);
    for timed in [false, true] {
        // Absent, or with its wires swapped, from the start; unplugged while it runs; with a wire that holds the bus low.
        plugged(&image, timed, &[(0.0, "out"), (0.1, "in")], &pictures);
        plugged(&image, timed, &[(0.1003, "out"), (0.15, "in")], &pictures);
        plugged(&image, timed, &[(0.0, "stuck"), (0.1, "in")], &pictures);
        plugged(&image, timed, &[(0.1003, "stuck"), (0.15, "in")], &pictures);
    }
}

#[test]
fn the_receive_pin_is_pulled_up_and_the_bus_is_reported() {
    if setup::host_only("the Pico's pins") {
        return;
    }
    let (_folder, image) = image("");
    let outcome = Request::new(&image, OLED).pictures(2).run().unwrap();
    // Receive, I2C, buttons.
    assert_eq!(outcome.pulled_up, [1, 4, 5, 10, 11, 12, 13, 14]);
    assert_eq!(String::from_utf8_lossy(&outcome.spoken), "I2C: 0x3c\r\n");
    let nothing = Request::new(&image, OLED).plugs(&[(0.0, "out")]).pictures(2).run().unwrap();
    assert_eq!(String::from_utf8_lossy(&nothing.spoken), "I2C: nothing answers\r\n");
    let freed = Request::new(&image, OLED).plugs(&[(0.0, "amid a byte")]).pictures(2).run().unwrap();
    let text = "I2C: a device held SDA low and let go after 5 clocks\r\nI2C: 0x3c\r\n";
    assert_eq!(String::from_utf8_lossy(&freed.spoken), text);
    assert_eq!(freed.pictures, outcome.pictures);
    let held = Request::new(&image, OLED).plugs(&[(0.0, "stuck")]).pictures(2).run().unwrap();
    let text = "I2C: SDA or SCL is held low: a wire on GND, or a display without power\r\n";
    assert_eq!(String::from_utf8_lossy(&held.spoken), text);
}

#[test]
fn the_st7789_has_a_clock_for_jumper_wires_or_a_fast_one() {
    if setup::host_only("the Pico's SPI") {
        return;
    }
    for (features, hz) in [("st7789", 31.25e6), ("st7789,fast", 62.5e6)] {
        let (_folder, image) = image(features);
        let outcome = Request::new(&image, LCD).pictures(2).run().unwrap();
        assert_eq!(outcome.spi, Spi { mode: 3, hz });
    }
}

#[test]
fn thirty_frames_a_second_hold_with_the_buses_own_times() {
    if setup::host_only("the Pico's times") {
        return;
    }
    for (display, features) in [(OLED, "face"), (LCD, "face,st7789")] {
        let (_folder, image) = image(features);
        for (clip, name) in ["walk", "hello", "greet"].into_iter().enumerate() {
            let keys: Vec<&[u8]> = std::iter::repeat_n(&b"n"[..], clip).chain([&b""[..]; 40]).collect();
            let mut outcome = in_step(Request::new(&image, display).timed(), &keys);
            equal(&outcome, &expected(display, &keys));
            outcome.frames.drain(..clip + 1);
            let worst = measures(&format!("{name} on {:?}", display.way), &outcome);
            assert!(worst < 1e3 / 30.0, "{worst} ms");
        }
    }
}

#[test]
fn plays_at_its_own_pace() {
    if setup::host_only("the Pico's own pace") {
        return;
    }
    let (_folder, image) = image("");
    const PICTURES: usize = 40;
    let outcome = Request::new(&image, OLED).pictures(PICTURES).timed().run().unwrap();
    assert_eq!((&*outcome.ended, outcome.pictures.len()), ("done", PICTURES));
    let expected = expected(OLED, &[&b""[..]; 60]);
    let mut from = 0;
    for (index, picture) in outcome.pictures.iter().enumerate() {
        // The first picture, which is sent whole, takes longer than a frame; no other one makes it late.
        let within = if index <= 1 { 5 } else { 1 };
        let at = expected[from..].iter().take(within).position(|(_, expected)| expected == picture);
        from += at.unwrap_or_else(|| panic!("picture {index} is none of the next {within} from frame {from} on")) + 1;
    }
    let (first, last) = (&outcome.frames[2], &outcome.frames[PICTURES - 1]);
    let period = (last.nanos - first.nanos) / (PICTURES - 3) as f64;
    // Our walk has 120 frames a second. Pictures are shown as soon as they are sent, sooner or later by what changed.
    assert!((period * 120.0 / 1e9 - 1.0).abs() < 0.02, "{period} ns");
}

/// A clip nearly as large as the flash: 0.2 seconds until the first picture, half of that until the watchdog would have to be fed again.
#[test]
fn the_longest_clip_shows_its_first_picture_soon() {
    if setup::host_only("the Pico's start with a long clip") {
        return;
    }
    let walk = import(&Disk::default(), &paths::root().join("motions/walk.keys"), &ImportOptions::new()).unwrap();
    let bytes = noisy(&walk.motion.rig, 88_000).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let clip = folder.path().join("long.ptn");
    fs::write(&clip, &bytes).unwrap();
    let (_image, image) = program("pico", "", &[clip]);
    let outcome = Request::new(&image, OLED).pictures(3).timed().run().unwrap();
    let first = outcome.frames.first().map_or(f64::NAN, |first| first.nanos / 1e6);
    println!("{} bytes: {}, the first picture after {first:.0} ms", bytes.len(), outcome.ended);
    assert_eq!(outcome.ended, "done");
    assert!(first < 300.0, "{first} ms");
}

#[test]
fn servos_get_the_pulses_that_the_host_computes() {
    if setup::host_only("servos on the Pico") {
        return;
    }
    follows(&CLIPS.1[0], 160);
    // Thighs coded as exponential maps.
    follows(&paths::root().join("motions/kneebend.ptn"), 100);
}

fn follows(path: &Path, count: usize) {
    let bytes = std::fs::read(path).unwrap();
    let clip = Clip::new_checked(&bytes).unwrap();
    let (mut states, mut pose) = (vec![ChannelState::default(); clip.moving()], vec![0; clip.rig().channels()]);
    let mut player = Player::new(clip, &mut states, &mut pose).unwrap();
    let joints = ["left-thigh", "right-thigh", "left-upper-arm", "right-upper-arm"];
    let angles = joints.map(|joint| JointAngle::find(&clip, joint, Axis::X).unwrap());
    let law = Law { centre: 1500, turn: 4000, limits: [1000, 2000], slew: servo::slew(2500, clip.frame_time_ns()) };
    let mut servos = [1, -1, 1, -1].map(|side| Servo::new(Law { turn: side * law.turn, ..law }));

    // The start takes three seconds, during which the clip stands still.
    let started = (3e9 / f64::from(clip.frame_time_ns())).ceil() as usize + 1;
    let count = started + count;
    let mut start = SoftStart::new(4);
    let (_folder, image) = program("servo", "", &[path.to_owned()]);
    // Four outputs a frame, and what sets them up before.
    let outcome = Request::new(&image, None).servos(4 * (count + 1) + 16).run().unwrap();
    assert_eq!(outcome.ended, "done");
    for pair in [3, 4] {
        // A count is a microsecond, a period 20 milliseconds.
        assert_eq!((outcome.slices[pair].div, outcome.slices[pair].top), (125 << 4, 20_000 - 1));
    }
    let frames = rp2040::pulses(&outcome.pulses, [3, 4]);
    assert!(frames.len() >= count, "{} frames", frames.len());
    let mut swing = [u16::MAX, 0];
    let mut first = [None; 4];
    for (index, (nanos, pulses)) in frames.iter().take(count).enumerate() {
        let turned = servos.iter_mut().zip(&angles).map(|(servo, angle)| servo.follow(start.ease(angle.at(&player))));
        let expected: Vec<u16> = (0..).zip(turned).map(|(number, width)| if start.is_on(number) { width } else { 0 }).collect();
        assert_eq!(pulses[..], expected, "frame {index}");
        first.iter_mut().zip(pulses).filter(|(_, width)| **width > 0).for_each(|(first, width)| {
            first.get_or_insert((*nanos, *width));
        });
        if index > started {
            swing = [swing[0].min(pulses[0]), swing[1].max(pulses[0])];
        }
        // From the second tick on: the emulator's timer begins with one, while the widths of frame 1 are worked out.
        let due = frames[2].0 + (index as f64 - 2.0) * f64::from(clip.frame_time_ns());
        assert!(index < 2 || (nanos - due).abs() < 1e5, "frame {index} {} ns late", nanos - due);
        if start.advance(clip.frame_time_ns() / 1000) {
            player.step();
        }
    }
    let first = first.map(|first| first.unwrap());
    for (servo, two) in (1..).zip(first.windows(2)) {
        let apart = (two[1].0 - two[0].0) / 1e6;
        assert!((apart - 250.0).abs() < 40.0, "servo {servo} starts {apart} ms after the one before");
    }
    assert_eq!(first.map(|(_, width)| width), [1500; 4], "each starts at its centre");
    assert!(swing[1] - swing[0] > 300, "the thigh moves: {swing:?}");
}

#[test]
fn joints_that_the_clip_lacks_are_named_on_the_display_and_no_servo_moves() {
    if setup::host_only("a puppet's missing joint on the Pico") {
        return;
    }
    let (_folder, image) = program("servo", "", &CLIPS.1[1..2]);
    let outcome = Request::new(&image, OLED).pictures(usize::MAX).seconds(0.2).run().unwrap();
    assert_eq!(outcome.ended, "limit");
    says(&outcome, "the clip lacks joints:\nleft-thigh\nright-thigh\nleft-upper-arm\nright-upper-arm");
    assert!(outcome.pulses.is_empty());
}

/// What a display shows that shows nothing but these words.
fn words(text: &str) -> Picture {
    let mut frame = Framebuffer::<MonoPages<128, 64, 1024>>::new();
    TextScreen::new(&mut frame).write_str(text).unwrap();
    let pixels = (0..OLED.width * OLED.height).map(|index| frame.pixel(index % OLED.width, index / OLED.width).is_on().into());
    Picture { display: OLED, pixels: pixels.collect() }
}

fn says(outcome: &Outcome, text: &str) {
    if let Some(difference) = screen::difference(outcome.last.as_ref().unwrap(), &words(text)) {
        panic!("{text}: {difference}");
    }
}

/// LineSettings and column of a text in a file of the firmware, from 1.
fn place(file: &str, text: &str) -> (usize, usize) {
    let source = std::fs::read_to_string(paths::firmware().join(file)).unwrap();
    (1..).zip(source.lines()).find_map(|(number, line)| Some((number, line.find(text)? + 1))).unwrap()
}

#[test]
fn a_fault_is_told_on_the_display() {
    if setup::host_only("a fault of the Pico") {
        return;
    }
    let (_folder, image) = image("");
    let outcome = Request::new(&image, OLED).pictures(usize::MAX).seconds(0.2).harm("fault").run().unwrap();
    // The watchdog is fed meanwhile, so that it does not end the message.
    assert_eq!(outcome.ended, "limit");
    let file = "boards/common/src/cortex_m/faults.rs";
    let fault = "processor fault: an invalid access, or a stack overflow";
    let (line, column) = place(file, &format!("panic!(\"{fault}"));
    says(&outcome, &format!("panicked at {file}:{line}:{column}:\n{fault}"));
}

#[test]
fn a_program_that_hangs_is_started_anew() {
    if setup::host_only("the Pico's watchdog") {
        return;
    }
    let (_folder, image) = image("");
    // The watchdog has two seconds' patience, from when it was last fed.
    for (seconds, ended) in [(1.9, "limit"), (2.4, "watchdog")] {
        let outcome = Request::new(&image, OLED).pictures(usize::MAX).seconds(seconds).harm("hang").run().unwrap();
        assert_eq!(outcome.ended, ended);
    }
}

#[test]
fn a_damaged_clip_is_told_on_the_display() {
    if setup::host_only("a damaged clip on the Pico") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let clip = folder.path().join("broken.ptn");
    let mut bytes = std::fs::read(&CLIPS.1[1]).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(&clip, bytes).unwrap();
    let (_folder, image) = program("pico", "", &[clip]);
    let outcome = Request::new(&image, OLED).seconds(0.05).run().unwrap();
    says(&outcome, "broken\ncannot be played:\na CRC does not match: the clip is damaged");
}

/// What the program says of frames in step.
fn reports(frames: impl Iterator<Item = u32>) -> Vec<u8> {
    frames.flat_map(|number| [&[pantin_app::SHOWN][..], &number.to_le_bytes()].concat()).collect()
}

#[test]
fn keys_come_over_the_usb_port_and_the_port_reports_each_frame() {
    if setup::host_only("keys over the Pico's USB port") {
        return;
    }
    let (_folder, image) = image("face,usb");
    // More letters at once than the receive buffer holds: each one counts.
    let many = [&b"d"[..]; 1501].concat();
    let keys: [&[u8]; 5] = [b"", b"n", b"aw", &many, b""];
    let expected = expected(OLED, &keys);
    let outcome = in_step(Request::new(&image, OLED).usb(), &keys);
    equal(&outcome, &expected);
    assert_eq!(outcome.usb, reports(expected.iter().map(|(number, _)| *number)));
    assert!(outcome.held > 0, "the receive buffer was never full");
}

#[test]
fn a_pc_that_does_not_read_the_usb_port_holds_the_board_up_once() {
    // Pictures between which it does not read, and bytes that may wait for it: those of the board's buffer, also of the library's and a packet.
    const DEAF: [usize; 2] = [4, 104];
    const WAITING: std::ops::RangeInclusive<usize> = 256..=256 + 128 + 64;
    if setup::host_only("a PC that does not read the Pico's USB port") {
        return;
    }
    let (_folder, image) = image("face,usb");
    let keys = [&b""[..]; 110];
    let outcome = in_step(Request::new(&image, OLED).usb().deaf(DEAF[0], DEAF[1]), &keys);
    let expected = expected(OLED, &keys);
    equal(&outcome, &expected);
    let mut gaps: Vec<f64> = outcome.frames.windows(2).map(|two| (two[1].nanos - two[0].nanos) / 1e6).skip(1).collect();
    gaps.sort_by(f64::total_cmp);
    let [.., usual, longest] = *gaps else { unreachable!() };
    assert!(
        usual < 5.0 && (50.0..60.0).contains(&longest),
        "the longest times from picture to picture: {usual} and {longest} ms"
    );
    // It finds what waited, and what is sent after that.
    let numbers = |from: usize| reports(expected[from..].iter().map(|(number, _)| *number));
    let waited = outcome.usb.strip_suffix(&*numbers(DEAF[1] + 1)).expect("the port goes on");
    assert!(numbers(0).starts_with(waited));
    assert!(WAITING.contains(&(waited.len() - 5 * (DEAF[0] + 1))), "{} bytes", waited.len());
}

#[test]
fn poses_of_a_stream_come_over_the_usb_port() {
    if setup::host_only("a stream over the Pico's USB port") {
        return;
    }
    let clip = &CLIPS.1[2];
    let (_folder, image) = program("pico", "face,usb,link", std::slice::from_ref(clip));
    let bytes = fs::read(clip).unwrap();
    let source = Source::new(&Clip::new_checked(&bytes).unwrap()).unwrap();
    let wanted = LineSettings { rate: 11520.0, ahead: 12, share: 1.0, cycle: 12, parity: false, key: None };
    let fit = wanted.fitted(&source).expect("the line carries it");
    let mut frames = arrivals(Sender::new(3).clip(&source, fit, Some(1)), &source, fit, |_, timed| timed.bytes);
    frames.truncate(60);
    let expected = simulator::link_on(OLED, clip, &[], &frames).unwrap();
    assert!(expected.windows(2).filter(|pair| pair[0].1 != pair[1].1).count() > 20, "hardly anything moves");
    let next = sync::letter(pantin_app::NEXT);
    let lines: Vec<Vec<u8>> = frames.iter().map(|bytes| [&bytes[..], &next[..next.len()]].concat()).collect();
    let outcome = in_step(Request::new(&image, OLED).usb().packets(), &lines.iter().map(Vec::as_slice).collect::<Vec<_>>());
    equal(&outcome, &expected);
}

/// What the list of letters ends with, which the program sends for `?`.
const LIST_END: &[u8] = b"? this list\r\n";

/// Pulls display and USB cable out, and plugs them in again, a number of times.
fn survives_unplugging(times: usize) {
    /// A display is out for this time, and a cable. In again, a PC takes 15 ms to know the board, and opens its port.
    const DISPLAY_OUT: f64 = 0.012;
    const CABLE_OUT: f64 = 0.005;
    const PERIOD: f64 = 0.037;
    let (_folder, image) = image("usb");
    let begun = |index: usize| 0.1 + PERIOD * index as f64;
    // Not in step with the pictures, which are 8.3 ms apart.
    let display: Vec<_> = (0..times).flat_map(|index| [(begun(index), "out"), (begun(index) + DISPLAY_OUT, "in")]).collect();
    let cables: Vec<_> =
        (0..times).flat_map(|index| [(begun(index) + 0.003, "out"), (begun(index) + 0.003 + CABLE_OUT, "in")]).collect();
    let seconds = begun(times) + 0.1;
    let request = Request::new(&image, OLED).pictures(usize::MAX).plugs(&display).cables(&cables).seconds(seconds);
    let outcome = request.run().unwrap();
    assert_eq!(outcome.ended, "limit", "no reset, no fault");
    let lists = outcome.usb.windows(LIST_END.len()).filter(|bytes| *bytes == LIST_END).count();
    // Once before the first time, unless the cable is out before.
    assert!((times..=times + 1).contains(&lists), "the port answered {lists} times");
    let pictures = expected(OLED, &[&b""[..]; 160]);
    let is_of_the_walk = |shown: &Picture| pictures.iter().any(|(_, picture)| picture == shown);
    let state = |nanos: f64| display.iter().rev().find(|(at, _)| at * 1e9 <= nanos).map_or("in", |(_, state)| state);
    let mut whole = 0;
    for (shown, frames) in outcome.pictures[1..].iter().zip(outcome.frames.windows(2)) {
        let [before, now] = frames else { unreachable!() };
        match [before.nanos, now.nanos].map(state) {
            // Set up again, and whole.
            ["in", "in"] => {
                assert!(is_of_the_walk(shown), "at {} ms", now.nanos / 1e6);
                whole += 1;
            }
            [_, "out"] => assert!(shown.is_dark(), "at {} ms", now.nanos / 1e6),
            _ => {}
        }
    }
    assert!(whole >= times, "{whole} pictures after {times} times");
    assert!(is_of_the_walk(outcome.last.as_ref().unwrap()));
    println!("unplugged {times} times: {whole} whole pictures, {lists} lists of letters");
}

#[test]
fn display_and_usb_cable_are_unplugged_and_plugged_in() {
    if !setup::host_only("unplugging the Pico") {
        survives_unplugging(25);
    }
}

#[test]
#[ignore = "37 seconds of the chip take minutes in the emulator: `cargo test -p harness --test suites -- --ignored --nocapture a_thousand_times`"]
fn display_and_usb_cable_are_unplugged_a_thousand_times() {
    if !setup::host_only("unplugging the Pico a thousand times") {
        survives_unplugging(1000);
    }
}

/// The lines at the top and at the bottom of a display, as `pantin_app` writes them, and nothing else.
fn lines([top, bottom]: [&str; 2]) -> Framebuffer<MonoPages<128, 64, 1024>> {
    let mut frame = Framebuffer::new();
    let style = MonoTextStyle::new(&FONT_4X6, BinaryColor::On);
    for (line, y) in [(top, 0), (bottom, 58)] {
        Text::with_baseline(line, Point::new(0, y), style, Baseline::Top).draw(&mut frame).unwrap();
    }
    frame
}

/// Whether a picture has these lines. Their ground is dark, also over a figure.
fn has_lines(picture: &Picture, words: [&str; 2]) -> bool {
    let expected = lines(words);
    words.iter().zip([0, 58]).all(|(line, top)| {
        let mut pixels = (top..top + 6).flat_map(|y| (0..4 * line.len()).map(move |x| (x, y)));
        pixels.all(|(x, y)| picture.pixels[y * OLED.width + x] == u16::from(expected.pixel(x, y).is_on()))
    })
}

/// Clips of 20 pictures a second, with which the emulator needs a sixth of the time.
fn slow_clips(folder: &Path) -> Vec<PathBuf> {
    let clip = |name: &str| {
        let clip = folder.join(Path::new(name).file_stem().unwrap()).with_extension("ptn");
        clips::convert_at(&paths::root().join("motions").join(name), 20, &clip).unwrap();
        clip
    };
    ["walk.keys", "face/hello.keys", "emotes/happy.keys"].map(clip).into()
}

/// What a Pico that is alone showed.
struct Alone {
    /// When which clip's caption appeared.
    begun: Vec<(f64, String)>,
    /// When the display became dark, or lit.
    dark: Vec<(f64, bool)>,
}

/// Nobody gives commands to a Pico for some seconds; then `select` is pressed.
fn alone(seconds: f64, every: usize) -> Alone {
    const SELECT: u32 = 14;
    let folder = tempfile::tempdir().unwrap();
    let clips = slow_clips(folder.path());
    let (_image, image) = program("pico", "face", &clips);
    let captions = clips.iter().map(|path| {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let size = format!("{} bytes", fs::metadata(path).unwrap().len());
        (name, size)
    });
    let captions: Vec<(String, String)> = captions.collect();
    let request = Request::new(&image, OLED).pictures(usize::MAX).seconds(seconds + 3.0).every(every);
    let outcome = request.presses(&[(SELECT, seconds, 0.2)]).run().unwrap();
    assert_eq!(outcome.ended, "limit", "no reset, no fault");
    let times = outcome.frames.iter().skip(every - 1).step_by(every).map(|frame| frame.nanos / 1e9);
    let (mut begun, mut dark) = (vec![], vec![]);
    for (time, picture) in times.zip(&outcome.pictures) {
        if dark.last().is_none_or(|(_, was): &(f64, bool)| *was != picture.is_dark()) {
            dark.push((time, picture.is_dark()));
        }
        let Some((name, _)) = captions.iter().find(|(name, size)| has_lines(picture, [name, size])) else { continue };
        if begun.last().is_none_or(|(_, last): &(f64, String)| last != name) {
            begun.push((time, name.clone()));
        }
    }
    println!("{seconds} s alone: {} pictures; clips {begun:?}; dark {dark:?}", outcome.frames.len());
    Alone { begun, dark }
}

#[test]
fn a_pico_that_is_alone_plays_clip_after_clip_and_a_press_plays_the_next() {
    if setup::host_only("a Pico that is alone") {
        return;
    }
    let Alone { begun, dark } = alone(12.5, 1);
    let names: Vec<&str> = begun.iter().map(|(_, name)| name.as_str()).collect();
    assert_eq!(names, ["hello", "happy"], "the first clip has no caption");
    assert!((10.0..11.5).contains(&begun[0].0) && (12.5..13.0).contains(&begun[1].0), "{begun:?}");
    assert_eq!(dark.len(), 1, "it stays lit");
}

#[test]
#[ignore = "ten minutes of the chip take minutes in the emulator: `cargo test -p harness --test suites -- --ignored --nocapture ten_minutes`"]
fn after_ten_minutes_alone_a_pico_is_dark_until_a_press() {
    if setup::host_only("ten minutes of a Pico that is alone") {
        return;
    }
    let Alone { begun, dark } = alone(604.0, 10);
    // 600 s of clips that stay for 10 to 13 s.
    assert!((45..=60).contains(&begun.len()), "{} clips", begun.len());
    assert!(begun.windows(2).all(|two| (9.0..14.0).contains(&(two[1].0 - two[0].0))), "{begun:?}");
    let [(_, false), (dark_from, true), (lit_from, false)] = dark[..] else { panic!("{dark:?}") };
    // The emulator's timer begins each clip with a tick, by which the board's time is ahead: 55 times 50 ms, less what setting a clip up takes.
    assert!((597.0..601.0).contains(&dark_from) && (604.0..605.0).contains(&lit_from), "{dark:?}");
}
