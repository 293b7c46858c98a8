//! The Raspberry Pi Pico's own flash image in rp2040js: what its displays show over their buses is what the same program shows on the host.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use harness::build::Firmware;
use harness::display::{Display, Picture};
use harness::rp2040::{self, CLOCK, LCD, OLED, Outcome, Request};
use harness::{clips, paths, screen, setup, simulator};
use pantin_figure::rotation::Rotation;
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
    let clips: Vec<&Path> = CLIPS.1.iter().map(PathBuf::as_path).collect();
    let firmware = Firmware::featuring(features, "pico", "pico", rp2040::TARGET, &clips).unwrap();
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

/// No letters after a picture, but those for the next clip after so many of each.
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

#[test]
fn thirty_frames_a_second_hold_with_the_buses_own_times() {
    if setup::host_only("the Pico's times") {
        return;
    }
    for (display, features) in [(OLED, "face"), (LCD, "face,st7789")] {
        let (_folder, image) = image(features);
        for (clip, name) in ["walk", "hello", "greet"].into_iter().enumerate() {
            let keys: Vec<&[u8]> = std::iter::repeat_n(&b"n"[..], clip).chain([&b""[..]; 10]).collect();
            let mut outcome = in_step(Request::new(&image, display).timed(), &keys);
            equal(&outcome, &expected(display, &keys));
            outcome.frames.drain(..clip + 1);
            let worst = measures(&format!("{name} on {:?}", display.way), &outcome);
            assert!(worst < 1e3 / 30.0, "{worst} ms");
        }
    }
}
