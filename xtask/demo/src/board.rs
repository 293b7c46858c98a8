//! The clip on a board: built into its firmware, booted, played frame by frame.

use std::path::Path;
use std::process::Command;
use std::time::Duration;

use anyhow::{Result, bail, ensure};
use harness::build::Firmware;
use harness::display::Picture;
use harness::icount::{self, Stats};
use harness::qemu::{Launch, Machine};
use harness::{clips, paths, setup, sync};
use xtask::clip::firmware_copy;
use xtask::steps::{progress, say};

/// The longest that a demo may play.
const LIMIT: Duration = Duration::from_secs(180);

/// What the board showed and how many instructions it took.
pub struct Play {
    /// The display, frame by frame.
    pub pictures: Vec<Picture>,
    /// Instructions of each of the frame's regions; `None` where QEMU cannot count.
    pub counts: Option<Vec<Stats>>,
}

/// Plays the first `frames` frames of a clip, as lines or as a body with volume.
pub fn play(machine: Machine, clip: &Path, frames: usize, solid: bool) -> Result<Play> {
    say("building the firmware");
    let clip: &Path = &firmware_copy(clip)?;
    let mut features = clips::features(machine, &[clip])?;
    if solid {
        features.push_str(",solid");
    }
    let firmware = Firmware::featuring(&features, machine.name, machine.name, machine.target, &[clip])?;
    let folder = tempfile::tempdir()?;
    let counts = folder.path().join("counts");
    let mut launch = Launch::new(machine, firmware.elf()).limit(LIMIT);
    let counting = setup::takes_plugins(machine.emulator);
    if solid {
        launch = launch.argument("solid");
    }
    if counting {
        launch = launch.counting(&icount::plugin(machine.emulator)?, &counts);
    } else {
        say("this QEMU takes no plugins: instructions are not counted");
    }
    say(&format!("playing on QEMU's {}", machine.name));
    let mut pictures = vec![];
    let outcome = sync::play(launch, frames, |number, picture| {
        ensure!(number as usize == pictures.len(), "the board shows frame {number}, expected {}", pictures.len());
        pictures.push(picture);
        progress("frame", pictures.len(), frames);
        Ok(())
    })?;
    if outcome.code != 0 {
        log(firmware.elf(), &outcome.stdout).unwrap_or_else(|error| say(&format!("the board's log cannot be read: {error:#}")));
        bail!("the board ended with code {}: {}", outcome.code, outcome.stderr.trim());
    }
    let counts = counting.then(|| icount::by_kind(&icount::read(&counts)?, icount::FRAME_REGIONS.len())).transpose()?;
    Ok(Play { pictures, counts })
}

/// The same by the board's program on this machine.
#[cfg(feature = "simulator")]
pub fn simulate(machine: Machine, clip: &Path, frames: usize, solid: bool) -> Result<Play> {
    let display = anyhow::Context::context(machine.display, "this machine shows no pictures")?;
    let words: &[&str] = if solid { &["solid"] } else { &[] };
    let shown = harness::simulator::play::<pantin_figure::rotation::Rotation>(
        display,
        &[clip.into()],
        words,
        &vec![&b""[..]; frames - 1],
    )?;
    Ok(Play { pictures: shown.into_iter().map(|(_, picture)| picture).collect(), counts: None })
}

/// Prints the board's log, by a program of its own: what decodes it takes long to compile, and is needed only for failures.
fn log(elf: &Path, bytes: &[u8]) -> Result<()> {
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("log");
    std::fs::write(&file, bytes)?;
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
    cargo.arg("run").arg("--quiet").arg("--manifest-path").arg(paths::root().join("Cargo.toml"));
    let status = cargo.args(["--package", "xtask-commands", "--", "log"]).arg(elf).arg(file).status()?;
    ensure!(status.success(), "the decoder failed");
    Ok(())
}
