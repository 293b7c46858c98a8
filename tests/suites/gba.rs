//! The Game Boy Advance's cartridge in mGBA: what the display shows is what the same program shows on the host, pixel by pixel, and no frame
//! is dropped.

use std::path::PathBuf;
use std::sync::LazyLock;

use harness::display::Picture;
use harness::gba::{self, Console, FRAME_CYCLES, LCD, MOST};
use harness::simulator::Reading;
use harness::{clips, paths, screen, setup, simulator};
use pantin_app::SteerKey;
use pantin_figure::rotation::Rotation;
use tempfile::TempDir;

/// The clips of the image with all our motions, and the image.
static CARTRIDGE: LazyLock<(TempDir, Vec<PathBuf>, Vec<u8>)> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let clips = clips::own(folder.path(), clips::Drawn::Lines).unwrap();
    let image = gba::image(gba::LINES, &clips.iter().map(PathBuf::as_path).collect::<Vec<_>>()).unwrap();
    (folder, clips, image)
});

const A: u16 = 1 << 0;
const B: u16 = 1 << 1;
const SELECT: u16 = 1 << 2;
const START: u16 = 1 << 3;
const RIGHT: u16 = 1 << 4;
const LEFT: u16 = 1 << 5;
const UP: u16 = 1 << 6;
const R: u16 = 1 << 8;
const L: u16 = 1 << 9;

/// Frames that a button is held in a test, and after which the next one is pressed: the camera is set up meanwhile.
const HELD: u32 = 6;
const APART: u32 = 90;

/// Frames of 60 seconds.
const MINUTE: u32 = 3584;

#[test]
fn the_header_is_right_and_all_motions_fit() {
    if setup::host_only("the cartridge's header") {
        return;
    }
    let image = &CARTRIDGE.2;
    println!("{} bytes with all our motions", image.len());
    assert!(image.len() <= MOST, "{} bytes", image.len());
    // An unconditional branch behind the header.
    assert_eq!(image[3], 0xea);
    let target = 8 + 4 * u32::from_le_bytes([image[0], image[1], image[2], 0]);
    assert_eq!(target, 0xc0);
    assert!(image[4..0xa0].iter().all(|byte| *byte == 0), "the logo is not ours");
    assert_eq!(&image[0xa0..0xac], b"PANTIN\0\0\0\0\0\0");
    assert_eq!(&image[0xac..0xb2], b"APTE00");
    assert_eq!(image[0xb2], 0x96);
    let sum = image[0xa0..0xbd].iter().fold(0_u8, |sum, byte| sum.wrapping_sub(*byte));
    assert_eq!(image[0xbd], sum.wrapping_sub(0x19), "the header's check");
}

/// A clip of the image by its place, for the simulator.
fn clip(name: &str) -> PathBuf {
    let named = |path: &&PathBuf| path.file_stem().is_some_and(|stem| stem == name);
    CARTRIDGE.1.iter().find(named).unwrap().clone()
}

fn frames(clip: &PathBuf) -> usize {
    let bytes = std::fs::read(clip).unwrap();
    pantin::Clip::new_checked(&bytes).unwrap().frames() as usize
}

/// Pictures after which none is dropped: with a face, the first one takes longer than a frame of the display.
const BEGUN: usize = 4;

/// Plays a clip alone for a minute: each picture of the host is on the display for exactly `each` of its frames. `words` are the options with which
/// the program of `features` plays.
fn drops_no_frame(name: &str, clip: PathBuf, features: &str, words: &[&str], each: usize) {
    let image = gba::image(features, &[&clip]).unwrap();
    // Twice through the clip: what follows repeats.
    let period = frames(&clip);
    let keys = vec![&b""[..]; 2 * period - 1];
    let expected = simulator::play::<Rotation>(LCD, &[clip], words, &keys).unwrap();
    let expected: Vec<Vec<u8>> = expected.iter().map(|(_, picture)| gba::pixels(picture)).collect();
    // A button ends the start screen.
    let console = Console::new(&image).unwrap().hold(30, SELECT).hold(32, 0);
    let mut first = None;
    let mut shown = 0;
    console
        .run(MINUTE + 120, |frame, pixels| {
            if first.is_none() && pixels == expected[BEGUN] {
                first = Some(frame);
            }
            let Some(first) = first else { return };
            let index = BEGUN + (frame - first) as usize / each;
            let expected = &expected[if index < period { index } else { period + index % period }];
            if pixels != expected {
                let difference = screen::difference(&gba::picture(pixels), &gba::picture(expected));
                panic!("{name}, picture {index} in frame {frame}: {}", difference.unwrap());
            }
            shown += 1;
        })
        .unwrap();
    assert!(shown >= MINUTE, "{shown} frames equal");
    let stretches = console.stretches(300 * each as u32).unwrap();
    // Decoding, kinematics, drawing, what comes before the wait for the display, and what comes after it.
    let pictures: Vec<_> = stretches.chunks_exact(5).skip(20).collect();
    let mean = |kind: usize| pictures.iter().map(|picture| u64::from(picture[kind].cycles)).sum::<u64>() / pictures.len() as u64;
    let instructions = pictures.iter().map(|picture| picture.iter().map(|stretch| u64::from(stretch.instructions)).sum::<u64>());
    let most = pictures.iter().map(|picture| picture.iter().map(|stretch| stretch.cycles).sum::<u32>()).max().unwrap();
    let there = FRAME_CYCLES * each as u32;
    println!(
        "{name}: {shown} frames shown, none dropped; cycles a frame: decode {}, kinematics {}, draw {}, page {}; at most {most} of {}; \
         {} instructions; {each} display frames a picture",
        mean(0),
        mean(1),
        mean(2),
        mean(3) + mean(4),
        there,
        instructions.sum::<u64>() / pictures.len() as u64
    );
    assert!(most < there);
}

/// Plays a clip of the image with lines.
fn lines_drop_no_frame(name: &str) {
    if setup::host_only(&format!("{name} on the Game Boy Advance")) {
        return;
    }
    drops_no_frame(name, clip(name), gba::LINES, &["info"], 1);
}

#[test]
fn a_figure_plays_for_a_minute_and_no_frame_is_dropped() {
    lines_drop_no_frame("walk");
}

#[test]
fn a_face_plays_for_a_minute_and_no_frame_is_dropped() {
    lines_drop_no_frame("hello");
}

#[test]
fn a_body_with_volume_plays_for_a_minute_at_30_pictures_a_second_and_none_is_late() {
    if setup::host_only("bodies with volume on the Game Boy Advance") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for name in ["walk", "run"] {
        let clip = folder.path().join(name).with_extension("ptn");
        clips::convert_at(&paths::root().join("motions").join(name).with_extension("keys"), 30, &clip).unwrap();
        drops_no_frame(name, clip, gba::SOLID, &["info", "solid", "neck"], 2);
    }
}

/// What the buttons do to the character: as in `firmware/boards/gba/src/keys.rs`.
const STEER: [SteerKey<'static>; 6] = {
    const fn key(button: u16, input: &str, holds: bool) -> SteerKey<'_> {
        SteerKey { button, letter: 0, input, holds }
    }
    [
        key(UP, "go", true),
        key(B, "fast", true),
        key(A, "jump", false),
        key(LEFT, "left", false),
        key(R, "wave", false),
        key(L, "bow", false),
    ]
};

/// Buttons, and for how many frames they are held: idle, walk, wave while walking, run, jump while running, stop, jump, turn, wave.
const SESSION: [(u16, u32); 13] = [
    (0, 60),
    (UP, 100),
    (UP | R, 5),
    (UP, 100),
    (UP | B, 110),
    (UP | B | A, 5),
    (UP | B, 60),
    (0, 100),
    (A, 5),
    (0, 120),
    (LEFT, 5),
    (0, 100),
    (R, 30),
];

#[test]
fn the_buttons_steer_the_character() {
    if setup::host_only("a character on the Game Boy Advance") {
        return;
    }
    let lasted = steered(&CARTRIDGE.2, false, &[], &SESSION);
    let late = lasted.iter().filter(|frames| **frames > 1).count();
    println!("{late} of {} pictures took longer than a frame", lasted.len());
    // Those of a switch to another clip.
    assert!(late <= 20, "{late}");
}

/// As `motions/meet.txt`: bow, walk up to the other one, wait for its wave, turn twice, walk away.
const MEETING: [(u16, u32); 10] =
    [(0, 30), (L, 5), (0, 175), (UP, 66), (0, 264), (LEFT, 5), (0, 91), (LEFT, 5), (0, 91), (UP, 168)];

#[test]
fn two_characters_meet_as_on_the_host() {
    if setup::host_only("a meeting on the Game Boy Advance") {
        return;
    }
    let image = gba::image("meet", &[&clip("walk")]).unwrap();
    let lasted = steered(&image, true, &["info"], &MEETING);
    let late = lasted.iter().filter(|frames| **frames > 3).count();
    println!("{late} of {} pictures took longer than three frames", lasted.len());
}

/// Plays a session of buttons on an image, and compares each picture of the display with what the same program shows here with `words` of a command line.
/// Returns for how many frames of the display each picture was there.
fn steered(image: &[u8], meets: bool, words: &[&str], session: &[(u16, u32)]) -> Vec<u32> {
    // The start screen is there. The character is there long before the session begins.
    const BUTTON: u32 = 60;
    const BEGIN: u32 = 300;
    let mut console = Console::new(image).unwrap().hold(BUTTON, A).hold(BUTTON + 4, 0);
    let mut end = BEGIN;
    for (keys, frames) in session {
        console = console.hold(end, *keys);
        end += frames;
    }
    // The program marks four stretches a picture: motion, kinematics, drawing and, to the display's blank, the page; what comes after the
    // blank is the fifth, in the first frame that shows the picture.
    let stretches = console.stretches(end).unwrap();
    let steers = stretches.iter().position(|stretch| stretch.frame > BUTTON).unwrap();
    let pictures: Vec<_> = stretches[steers..].chunks_exact(5).collect();
    let blanks: Vec<u32> = pictures.iter().map(|picture| picture[4].frame).collect();
    let first = blanks[0];
    assert!(first < BEGIN, "the character is there after {} s", (first - BUTTON) as f32 / 60.0);
    // A picture shows the buttons and the time of the blank at which the one before it was shown.
    let held = |frame: u32| {
        let mut begun = BEGIN;
        session.iter().take_while(|(_, frames)| (begun <= frame, begun += frames).0).last().map_or(0, |(keys, _)| *keys)
    };
    // The timer starts at a blank, just before the first motion.
    let mut readings = vec![Reading { ticks: 0, held: 0 }, Reading { ticks: first - pictures[0][0].frame, held: 0 }];
    readings.extend(blanks.windows(2).map(|pair| Reading { ticks: pair[1] - pair[0], held: held(pair[1]) }));
    let bank = std::fs::read(harness::steered::bank()).unwrap();
    let expected = simulator::steer(&bank, meets, &STEER, words, &readings).unwrap();
    let expected: Vec<Vec<u8>> = expected.iter().map(gba::pixels).collect();
    let mut next = 0;
    let mut shown = 0;
    console
        .run(end, |frame, pixels| {
            while next < blanks.len() && blanks[next] <= frame {
                next += 1;
            }
            let Some(index) = next.checked_sub(1) else { return };
            if pixels != expected[index] {
                let difference = screen::difference(&gba::picture(pixels), &gba::picture(&expected[index]));
                panic!("picture {index} in frame {frame}: {}", difference.unwrap());
            }
            shown += 1;
        })
        .unwrap();
    let frames = end - first;
    assert_eq!(shown, frames);
    let lasted: Vec<u32> = blanks.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let longest = *lasted.iter().max().unwrap();
    println!("{frames} frames are equal; the longest picture took {longest}");
    assert!(longest <= 4, "{longest}");
    lasted
}

#[test]
fn the_buttons_do_what_they_should() {
    if setup::host_only("the buttons of the Game Boy Advance") {
        return;
    }
    // Each with the letters that do the same over a serial line.
    const PRESSES: [(&[u16], &[u8]); 10] = [
        (&[START], b" "),
        (&[RIGHT], b"d"),
        (&[LEFT], b"a"),
        (&[UP], b"w"),
        (&[SELECT], b"v"),
        (&[SELECT, SELECT | RIGHT], b"."),
        (&[SELECT, SELECT | LEFT], b","),
        (&[SELECT, SELECT | A], b"l"),
        (&[A], b"n"),
        (&[START], b" "),
    ];
    let mut console = Console::new(&CARTRIDGE.2).unwrap().hold(30, SELECT).hold(36, 0);
    let mut at = 120;
    let mut looks = vec![];
    for (keys, _) in PRESSES {
        for held in keys {
            console = console.hold(at, *held);
            at += HELD;
        }
        console = console.hold(at, 0);
        at += APART;
        looks.push(at - 1);
    }
    let mut seen: Vec<Picture> = vec![];
    let mut look = |frame, pixels: &[u8]| {
        if looks.contains(&frame) {
            seen.push(gba::picture(pixels));
        }
    };
    console.run(at, &mut look).unwrap();
    let clips = [clip("walk"), clip("greet")];
    // The frame at which the walk is paused, as the display says in words.
    let steps = vec![&b"."[..]; 2 * frames(&clips[0])];
    let paused = simulator::play::<Rotation>(LCD, &clips, &["info"], &steps).unwrap();
    let paused_at = paused.iter().skip(1).position(|(_, picture)| *picture == seen[0]).expect("the walk is paused");
    let mut letters = steps[..=paused_at].to_vec();
    for (index, (keys, letter)) in PRESSES.iter().enumerate().skip(1).take(8) {
        letters.push(letter);
        let expected = simulator::play::<Rotation>(LCD, &clips, &["info"], &letters).unwrap().pop().unwrap().1;
        if let Some(difference) = screen::difference(&seen[index], &expected) {
            panic!("after {keys:?}: {difference}");
        }
    }
    assert_ne!(seen[8], seen[9], "it plays on");
}
