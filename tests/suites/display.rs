//! What the boards' displays show is what the same program shows on the host, pixel by pixel, whatever keys it gets.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::thread;
use std::time::{Duration, Instant};

use harness::build::Firmware;
use harness::display::Picture;
use harness::qemu::{BOARDS, LM3S6965EVB, Launch, MICROBIT, MPS2_AN386, Machine, Qemu, RISCV_VIRT, SX1};
use harness::{clips, defmt_log, equal, paths, screen, setup, simulator, vectors};
use pantin_figure::rotation::Rotation;
use pantin_figure::rotation_float::FloatRotation;
use tempfile::TempDir;

/// Frames of our walk, of our run, and of a captured walk.
const FRAMES: [usize; 3] = [160, 26, 50];

/// The clips that all firmware here is built with: ours, and a captured one where there are any.
static CLIPS: LazyLock<(TempDir, Vec<PathBuf>)> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let mut motions = ["motions/walk.keys", "motions/run.keys"].map(|own| paths::root().join(own)).to_vec();
    motions.extend(paths::data().map(|data| data.join("bvh_bandai1_walk.bvh")));
    let clips = motions.iter().map(|motion| clips::convert(motion, folder.path()).unwrap()).collect();
    (folder, clips)
});

fn firmware(machine: Machine) -> Firmware {
    let clips: Vec<&Path> = CLIPS.1.iter().map(PathBuf::as_path).collect();
    Firmware::build(machine.name, machine.name, machine.target, &clips).unwrap()
}

fn expected(machine: Machine, words: &[&str], keys: &[&[u8]]) -> Vec<(u32, Picture)> {
    simulator::play::<Rotation>(machine.display.unwrap(), &CLIPS.1, words, keys).unwrap()
}

/// Plays a picture, and one more after each of the keys' letters, and compares each with the host's.
fn shows_what_the_host_shows(machine: Machine, keys: &[&[u8]]) {
    equal::shows(machine, &firmware(machine), &expected(machine, &[], keys), keys);
}

/// No letters after a picture but those for the next clip after its last one.
fn through_clips(count: usize) -> Vec<&'static [u8]> {
    let through = |&frames: &usize| std::iter::repeat_n(&b""[..], frames - 1).chain([&b"n"[..]]);
    FRAMES[..count].iter().flat_map(through).collect()
}

fn through_all_clips() -> Vec<&'static [u8]> {
    through_clips(CLIPS.1.len())
}

fn plays_all_clips(machine: Machine) {
    if !setup::host_only(&format!("clips on {}", machine.name)) {
        shows_what_the_host_shows(machine, &through_all_clips());
    }
}

#[test]
fn lm3s6965evb_plays_all_clips_as_the_host_does() {
    plays_all_clips(LM3S6965EVB);
}

#[test]
fn microbit_plays_all_clips_as_the_host_does() {
    plays_all_clips(MICROBIT);
}

#[test]
fn microbit_plays_key_clips_as_the_host_does() {
    if setup::host_only("key clips on the microbit") {
        return;
    }
    let clips = ["walk", "run"].map(|name| vectors::keyed::folder().join(name).with_extension("ptn"));
    let firmware =
        Firmware::featuring("keys", MICROBIT.name, MICROBIT.name, MICROBIT.target, &clips.each_ref().map(PathBuf::as_path));
    let keys = through_clips(clips.len());
    let expected = simulator::play::<Rotation>(MICROBIT.display.unwrap(), &clips, &[], &keys).unwrap();
    equal::shows(MICROBIT, &firmware.unwrap(), &expected, &keys);
}

#[test]
fn mps2_an386_plays_all_clips_as_the_host_does() {
    plays_all_clips(MPS2_AN386);
}

#[test]
fn mps2_an386_plays_all_clips_in_floating_point_as_the_host_does() {
    if setup::host_only("clips in floating point on mps2-an386") {
        return;
    }
    let machine = MPS2_AN386;
    let clips: Vec<&Path> = CLIPS.1.iter().map(PathBuf::as_path).collect();
    let firmware = Firmware::featuring("micromath", machine.name, machine.name, machine.target, &clips).unwrap();
    let keys = through_all_clips();
    let expected = simulator::play::<FloatRotation>(machine.display.unwrap(), &CLIPS.1, &[], &keys).unwrap();
    equal::shows(machine, &firmware, &expected, &keys);
}

#[test]
fn riscv_virt_plays_all_clips_as_the_host_does() {
    plays_all_clips(RISCV_VIRT);
}

#[test]
fn sx1_plays_all_clips_as_the_host_does() {
    plays_all_clips(SX1);
}

/// Every letter but that for the list, alone and in company.
const KEYS: [&[u8]; 37] = [
    b"", b"i", b"v", b"v", b"v", b"v", b"w", b"ww", b"sssss", b"a", b"dd", b"f", b"", b"f", b"r", b"", b"r", b".", b".", b",",
    b",,,", b" ", b"", b"+", b"--", b"l", b"g", b"n", b"g", b"vw", b"n", b"lr", b"p", b"i", b" ", b"x\0Q", b"p",
];

fn takes_keys(machine: Machine) {
    if !setup::host_only(&format!("keys on {}", machine.name)) {
        shows_what_the_host_shows(machine, &KEYS);
    }
}

#[test]
fn lm3s6965evb_takes_keys_as_the_host_does() {
    takes_keys(LM3S6965EVB);
}

#[test]
fn microbit_takes_keys_as_the_host_does() {
    takes_keys(MICROBIT);
}

#[test]
fn mps2_an386_takes_keys_as_the_host_does() {
    takes_keys(MPS2_AN386);
}

#[test]
fn riscv_virt_takes_keys_as_the_host_does() {
    takes_keys(RISCV_VIRT);
}

#[test]
fn sx1_takes_keys_as_the_host_does() {
    takes_keys(SX1);
}

/// Waits until the display shows one of the pictures, and tells which.
fn await_one(qemu: &mut Qemu, what: &str, pictures: &[&Picture]) -> usize {
    let deadline = Instant::now() + Duration::from_secs(20);
    loop {
        let picture = qemu.picture().unwrap();
        if let Some(index) = pictures.iter().position(|expected| **expected == picture) {
            return index;
        }
        if Instant::now() > deadline {
            let differences = pictures.iter().filter_map(|expected| screen::difference(&picture, expected));
            let least = differences.min_by_key(|difference| difference.count).unwrap();
            panic!("{what}: the display shows none of {} pictures; of the nearest, {least}", pictures.len());
        }
        thread::sleep(Duration::from_millis(5));
    }
}

/// Long enough for the program, which looks at the buttons between two pictures.
const HELD: Duration = Duration::from_millis(100);

fn tap(qemu: &mut Qemu, button: &str) {
    for down in [true, false] {
        qemu.control().unwrap().key(button, down).unwrap();
        thread::sleep(HELD);
    }
}

/// Holds the buttons down, the last one last, until the display shows the picture.
fn press(qemu: &mut Qemu, buttons: &[&str], expected: &Picture) {
    for button in buttons {
        qemu.control().unwrap().key(button, true).unwrap();
        thread::sleep(HELD);
    }
    await_one(qemu, &format!("{buttons:?} held"), &[expected]);
    for button in buttons.iter().rev() {
        qemu.control().unwrap().key(button, false).unwrap();
        thread::sleep(HELD);
    }
}

#[test]
fn lm3s6965evb_has_buttons() {
    if setup::host_only("buttons on lm3s6965evb") {
        return;
    }
    let firmware = firmware(LM3S6965EVB);
    let mut qemu = Launch::new(LM3S6965EVB, firmware.elf()).argument("info").display().start().unwrap();
    while qemu.picture().unwrap().is_dark() {
        thread::sleep(HELD);
    }
    // The emulator holds every line low until its key was once pressed and let go.
    ["up", "down", "left", "right", "ctrl"].iter().for_each(|button| tap(&mut qemu, button));
    // Every frame of the walk, paused there, as the display says in words.
    let steps = vec![&b"."[..]; 160];
    let paused = expected(LM3S6965EVB, &["info"], &steps);
    let pictures: Vec<&Picture> = paused[1..].iter().map(|(_, picture)| picture).collect();
    tap(&mut qemu, "ctrl");
    let at = await_one(&mut qemu, "select", &pictures);
    let after = |keys: &[&[u8]]| {
        let begun: Vec<&[u8]> = steps[..=at].iter().chain(keys).copied().collect();
        expected(LM3S6965EVB, &["info"], &begun).pop().unwrap().1
    };
    press(&mut qemu, &["ctrl", "right"], &after(&[b"."]));
    press(&mut qemu, &["ctrl", "left"], &after(&[b".", b","]));
    press(&mut qemu, &["right"], &after(&[b"d"]));
    press(&mut qemu, &["left"], &after(&[b"d", b"a"]));
    press(&mut qemu, &["ctrl", "down"], &after(&[b"r"]));
    press(&mut qemu, &["ctrl", "up"], &after(&[b"r", b"n"]));
    // Plays the run again, backwards, then faster, then slower.
    let mut letters = vec![&b"."[..], b"r", b"n"];
    for (button, letter) in [("ctrl", b" "), ("up", b"+"), ("down", b"-"), ("down", b"-")] {
        letters.push(letter);
        let playing = expected(LM3S6965EVB, &["info"], &[&letters[..], &[&b""[..]; 26]].concat());
        let playing: Vec<&Picture> = playing[letters.len()..].iter().map(|(_, picture)| picture).collect();
        tap(&mut qemu, button);
        await_one(&mut qemu, button, &playing);
    }
}

#[test]
fn every_board_plays_at_its_own_pace_and_ends() {
    if setup::host_only("boards at their own pace") {
        return;
    }
    // Our walk has 120 frames a second. Emulated timers are the host's: none is early, and all may be late.
    const PICTURES: u32 = 40;
    for machine in BOARDS {
        let firmware = firmware(machine);
        let begun = Instant::now();
        let launch = Launch::new(machine, firmware.elf()).argument(format!("frames={PICTURES}"));
        let outcome = launch.start().unwrap().wait().unwrap();
        let took = begun.elapsed();
        let log = defmt_log::decode(firmware.elf(), &outcome.stdout).unwrap();
        assert_eq!(outcome.code, 0, "{}: {log:?}", machine.name);
        let last = log.last().unwrap();
        assert!(last.starts_with(&format!("INFO {PICTURES} pictures, ")), "{}: {last}", machine.name);
        assert!(took >= Duration::from_secs(1) * (PICTURES - 1) / 120, "{}: {took:?}", machine.name);
        println!("{}: {last}, {took:?}", machine.name);
    }
}
