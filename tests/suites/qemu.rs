//! The emulator as the tests drive it: exit codes, logs, time limits, and no process left behind.

use std::path::Path;
use std::time::Duration;

use harness::build::Firmware;
use harness::defmt_log;
use harness::display::{OLED, Picture};
use harness::qemu::{LM3S6965EVB, Launch, Outcome};
use harness::{screen, setup, sync};

fn endings() -> Firmware {
    Firmware::build("testsuite", "endings", LM3S6965EVB.target, &[]).unwrap()
}

fn run(program: &Firmware, words: &[&str]) -> Outcome {
    let launch = words.iter().fold(Launch::new(LM3S6965EVB, program.elf()), |launch, word| launch.argument(*word));
    launch.start().unwrap().wait().unwrap()
}

fn runs(id: u32) -> bool {
    Path::new("/proc").join(id.to_string()).exists()
}

#[test]
fn the_programs_exit_code_is_qemus() {
    if setup::host_only("exit codes") {
        return;
    }
    let program = endings();
    assert_eq!(run(&program, &["exit", "0"]).code, 0);
    assert_eq!(run(&program, &["exit", "42"]).code, 42);
    assert_eq!(run(&program, &["panic"]).code, 101);
    assert_eq!(run(&program, &["fault"]).code, 102);
}

#[test]
fn a_program_that_never_ends_is_stopped_at_its_limit_and_leaves_no_process() {
    if setup::host_only("the time limit") {
        return;
    }
    let program = endings();
    let limit = Duration::from_millis(500);
    let qemu = Launch::new(LM3S6965EVB, program.elf()).argument("spin").limit(limit).start().unwrap();
    let id = qemu.id();
    assert!(runs(id));
    let error = qemu.wait().unwrap_err().to_string();
    assert!(error.contains("longer than 500ms"), "{error}");
    assert!(!runs(id), "process {id} is still there");
}

#[test]
fn a_dropped_emulator_is_gone() {
    if setup::host_only("dropping") {
        return;
    }
    let program = endings();
    let qemu = Launch::new(LM3S6965EVB, program.elf()).argument("spin").serial().display().start().unwrap();
    let id = qemu.id();
    assert!(runs(id));
    drop(qemu);
    assert!(!runs(id), "process {id} is still there");
}

#[test]
fn a_display_that_nothing_drew_on_is_black_and_keys_are_taken() {
    if setup::host_only("the display") {
        return;
    }
    let program = endings();
    let mut qemu = Launch::new(LM3S6965EVB, program.elf()).argument("spin").display().start().unwrap();
    let picture = qemu.picture().unwrap();
    assert_eq!(picture, Picture::dark(OLED));
    for down in [true, false] {
        qemu.control().unwrap().key("up", down).unwrap();
    }
    let error = qemu.control().unwrap().key("no-such-key", true).unwrap_err().to_string();
    assert!(error.contains("no-such-key"), "{error}");
    qemu.control().unwrap().quit().unwrap();
    assert_eq!(qemu.wait().unwrap().code, 0);
}

#[test]
fn every_pixel_of_every_frame_is_read_back() {
    if setup::host_only("frames in step") {
        return;
    }
    let program = Firmware::build("testsuite", "panel", LM3S6965EVB.target, &[]).unwrap();
    let mut seen = 0;
    let outcome = sync::play(Launch::new(LM3S6965EVB, program.elf()), 5, |frame, picture| {
        assert_eq!(frame, seen);
        let greys = (0..64).flat_map(|y| (0..128).map(move |x| (x / 8 + y + frame as usize) % 16));
        let expected = Picture { display: OLED, pixels: greys.map(|grey| grey as u16).collect() };
        if let Some(difference) = screen::difference(&picture, &expected) {
            panic!("frame {frame}: {difference}");
        }
        seen += 1;
        Ok(())
    });
    assert_eq!(outcome.unwrap().code, 0);
    assert_eq!(seen, 5);
}

#[test]
fn qemus_own_words_explain_a_start_that_failed() {
    if setup::host_only("a failing start") {
        return;
    }
    let absent = Launch::new(LM3S6965EVB, Path::new("no-such-program.elf"));
    let error = sync::play(absent, 1, |_, _| Ok(())).unwrap_err();
    let error = format!("{error:#}");
    assert!(error.contains("no-such-program.elf") && error.contains("code 1"), "{error}");
}

#[test]
fn the_log_is_decoded_up_to_the_panic() {
    if setup::host_only("the log") {
        return;
    }
    let program = Firmware::build("testsuite", "log", LM3S6965EVB.target, &[]).unwrap();
    let outcome = run(&program, &[]);
    assert_eq!(outcome.code, 101, "{}", outcome.stderr);
    let lines = defmt_log::decode(program.elf(), &outcome.stdout).unwrap();
    assert_eq!(lines, ["INFO 160 frames of 23 channels", "WARN angle 0.5", "ERROR ends"]);
}
