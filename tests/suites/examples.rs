//! The programs in `examples/`, built and run as a stranger does: their angles and pictures are those of the host.

use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Size};
use embedded_graphics::pixelcolor::BinaryColor;
use harness::{paths, setup};
use pantin::{Clip, EulerOrder, Room};
use pantin_convert::import::Disk;
use pantin_convert::{Length, Options, Recipe};
use pantin_figure::{Canvas, FigureRenderer, View};
use std::path::{Path, PathBuf};
use std::process::Command;

const CORE: &str = "thumbv7m-none-eabi";

/// Builds and runs the package in a folder, and returns what it printed.
fn output(package: &Path) -> String {
    setup::rust_target(CORE).unwrap();
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["run", "--quiet", "--release"]).current_dir(package);
    // In `examples` cargo finds the settings itself; twice they would link twice.
    if !package.starts_with(paths::root().join("examples")) {
        cargo.arg("--config").arg(paths::root().join("examples/.cargo/config.toml"));
    }
    for variable in ["RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS", "CARGO_TARGET_DIR", "CARGO_BUILD_TARGET_DIR"] {
        cargo.env_remove(variable);
    }
    let done = cargo.env("CARGO_TARGET_DIR", paths::root().join("examples/target")).output().unwrap();
    assert!(done.status.success(), "{}: {}", package.display(), String::from_utf8_lossy(&done.stderr));
    String::from_utf8(done.stdout).unwrap()
}

/// A copy of an example outside of the repository's folders, with other words in its program.
fn copied(folder: &Path, example: &str, words: &[(&str, &str)]) -> PathBuf {
    let (from, to) = (paths::root().join("examples").join(example), folder.join(example));
    std::fs::create_dir_all(to.join("src")).unwrap();
    for file in ["Cargo.toml", "Cargo.lock", "memory.x", "src/main.rs"] {
        let text = std::fs::read_to_string(from.join(file)).unwrap();
        let text = text.replace("../../decoder", paths::root().join("decoder").to_str().unwrap());
        // Under another name: both packages have one target directory, and may be built at the same time.
        let text = text.replace(&format!("pantin-example-{example}"), &format!("pantin-example-{example}-copy"));
        let text = words.iter().fold(text, |text, (old, new)| text.replace(old, new));
        std::fs::write(to.join(file), text).unwrap();
    }
    to
}

/// An angle in degrees as the program prints it: from half a turn back to half a turn ahead, limited to what a servo reaches.
fn limited(angle: f64) -> f64 {
    ((angle + 180.0).rem_euclid(360.0) - 180.0).clamp(-90.0, 90.0)
}

/// Compares printed angles of a joint with those of the decoded clip in double precision, to 0.1 degree.
fn compare(printed: &str, clip: &Path, joint: &str) {
    let bytes = std::fs::read(clip).unwrap();
    let clip = Clip::new_checked(&bytes).unwrap();
    let index = clip.find(joint).unwrap().index();
    assert!(clip.is_exponential(index), "{joint} is not coded as an exponential map");
    let truth = pantin_convert::expand::expand(&clip).unwrap();
    let first = truth.rig.first_channels()[index];
    let channels: Vec<usize> = (0..3)
        .map(|n| truth.rig.joints[index].kinds.iter().enumerate().filter(|(_, kind)| kind.is_rotation()).nth(n).unwrap().0)
        .collect();
    let mut widest = [f64::MAX, f64::MIN];
    let mut frames = 0;
    for (frame, line) in printed.lines().enumerate() {
        let (number, angles) = line.split_once(": ").unwrap();
        assert_eq!(number.parse::<usize>().unwrap(), frame);
        let angles: Vec<f64> = angles.split(' ').map(|word| word.parse::<f64>().unwrap() / 100.0).collect();
        for (channel, got) in channels.iter().zip(&angles) {
            let off = (got - limited(truth.values[first + channel][frame])).abs();
            assert!(off < 0.1, "frame {frame}: {angles:?}, off by {off} degrees");
        }
        widest = [widest[0].min(angles[2]), widest[1].max(angles[2])];
        frames += 1;
    }
    assert_eq!(frames, clip.frames());
    println!("{joint} bends from {} to {} degrees over {frames} frames", widest[0], widest[1]);
}

#[test]
fn a_newcomers_program_prints_a_knees_angles_right_to_a_tenth_of_a_degree() {
    if setup::host_only("a newcomer's program") {
        return;
    }
    let example = paths::root().join("examples/knee");
    let program = std::fs::read_to_string(example.join("src/main.rs")).unwrap();
    assert!(program.lines().count() <= 30, "{} lines", program.lines().count());
    compare(&output(&example), &paths::root().join("motions/kneebend.ptn"), "left-shin");
}

/// The manifest of a program that uses the README's crates.
fn manifest() -> String {
    let path = |folder: &str| paths::root().join(folder).display().to_string();
    let (decoder, figure) = (path("decoder"), path("firmware/figure"));
    format!(
        "[package]\nname = \"pantin-readme\"\nedition = \"2024\"\n[lib]\n[dependencies]\nembedded-graphics = \"0.8\"\n\
         pantin = {{ path = {decoder:?} }}\npantin-figure = {{ path = {figure:?} }}\n[workspace]\n"
    )
}

#[test]
fn the_readmes_program_compiles_with_the_sizes_that_expand_writes() {
    let readme = std::fs::read_to_string(paths::root().join("README.md")).unwrap();
    let (_, program) = readme.split_once("```rust\n").unwrap();
    let (program, _) = program.split_once("```").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let src = folder.path().join("src");
    std::fs::create_dir(&src).unwrap();
    std::fs::write(folder.path().join("Cargo.toml"), manifest()).unwrap();
    std::fs::write(src.join("lib.rs"), format!("#![allow(dead_code)]\n{program}")).unwrap();
    let mut expand = Command::new(harness::build::host_tool().unwrap());
    expand.arg("expand").arg(paths::root().join("motions/walk.ptn")).arg("-o").arg(src.join("walk.rs"));
    assert!(expand.status().unwrap().success());
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["check", "--quiet"]).current_dir(folder.path()).env("CARGO_TARGET_DIR", paths::root().join("examples/target"));
    let done = cargo.output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}

#[test]
fn a_newcomers_program_reads_a_captured_knee_outside_of_the_repository() {
    if setup::host_only("a newcomer's program with a captured clip") {
        return;
    }
    let data = std::env::var_os("PANTIN_DATA").map_or_else(|| paths::root().join("../shared/data"), PathBuf::from);
    let bvh = data.join("bvh_cmu131_start-walk-stop.bvh");
    if !bvh.exists() {
        return println!("skipped: {} is not there; set PANTIN_DATA", bvh.display());
    }
    let folder = tempfile::tempdir().unwrap();
    let clip = folder.path().join("cmu.ptn");
    let tool = harness::build::host_tool().unwrap();
    let done = Command::new(tool).arg("convert").arg(&bvh).arg("-o").arg(&clip).args(["--effort", "fast"]).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let words = [("../../../motions/kneebend.ptn", clip.to_str().unwrap()), ("left-shin", "LeftKnee")];
    compare(&output(&copied(folder.path(), "knee", &words)), &clip, "LeftKnee");
}

/// The display of `examples/draw`.
struct Bits([u64; 48]);

impl OriginDimensions for Bits {
    fn size(&self) -> Size {
        Size::new(64, 48)
    }
}

impl DrawTarget for Bits {
    type Color = BinaryColor;
    type Error = std::convert::Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<BinaryColor>>>(&mut self, pixels: I) -> Result<(), Self::Error> {
        for Pixel(at, color) in pixels {
            let bit = 1 << at.x;
            let row = &mut self.0[at.y as usize];
            *row = if color.is_on() { *row | bit } else { *row & !bit };
        }
        Ok(())
    }
}

#[test]
fn a_newcomers_display_shows_the_hosts_picture() {
    if setup::host_only("a newcomer's display") {
        return;
    }
    let printed = output(&paths::root().join("examples/draw"));
    let walk = std::fs::read(paths::root().join("motions/walk.ptn")).unwrap();
    let mut room = Room::<96, 144>::new();
    let mut player = room.player(Clip::new_checked(&walk).unwrap()).unwrap();
    let canvas = Canvas { width: 64, height: 48 };
    let mut figure = FigureRenderer::<36>::of_clip(&mut player, canvas, View::default()).unwrap();
    let mut display = Bits([0; 48]);
    figure.draw(player.pose(), &mut display).unwrap();
    let rows: Vec<String> = display.0.iter().map(|row| format!("{row:064b}")).collect();
    assert_eq!(printed.lines().collect::<Vec<_>>(), rows);
    assert!(display.0.iter().map(|row| row.count_ones()).sum::<u32>() > 100, "hardly anything is drawn");
}

/// `examples/build` has no clip in the repository: its build script converts `motions/walk.keys`.
#[test]
fn a_program_plays_the_motion_that_its_build_script_converts() {
    if setup::host_only("a build script") {
        return;
    }
    let printed = output(&paths::root().join("examples/build"));
    let recipe = Recipe::new().options(Options::new().max_error(Length::cm(1.0)));
    let converted = recipe.convert(&Disk::default(), &paths::root().join("motions/walk.keys"), &mut |_| ()).unwrap();
    let clip = Clip::new_checked(&converted.clip).unwrap();
    let (mut room, knee) = (Room::<96, 144>::new(), clip.find("left-shin").unwrap());
    let mut player = room.player(clip).unwrap();
    let mut lines = Vec::new();
    for frame in 0..clip.frames() {
        let [a, b, c] = player.turn(&knee).unwrap().euler(EulerOrder::XYZ).map(|angle| angle.centidegrees());
        lines.push(format!("{frame}: {a} {b} {c}"));
        player.step();
    }
    assert_eq!(printed.lines().collect::<Vec<_>>(), lines);
}

#[test]
fn clips_play_by_time_in_tasks_of_rtic_and_embassy() {
    if setup::host_only("RTIC and embassy") {
        return;
    }
    for (example, most) in [("rtic", 60), ("embassy", 60)] {
        let folder = paths::root().join("examples").join(example);
        let lines = std::fs::read_to_string(folder.join("src/main.rs")).unwrap().lines().count();
        assert!(lines <= most, "{example}: {lines} lines");
        let printed = output(&folder);
        // 40 ms are 4.8 frames of 120 a second.
        let frames: Vec<usize> = printed
            .lines()
            .map(|line| line.strip_prefix("frame ").unwrap().split(':').next().unwrap().parse().unwrap())
            .collect();
        assert_eq!(frames, [0, 4, 9, 14, 19, 24, 28, 33, 38, 43], "{example}");
    }
}
