//! The clip on a board: built into its firmware, booted, played frame by frame.

use std::path::Path;
use std::time::Duration;

use anyhow::{Context, Result, ensure};
use harness::build::Firmware;
use harness::display::Picture;
use harness::icount::{self, Stats};
use harness::qemu::{Launch, Machine};
use harness::{clips, defmt_log, setup, simulator, sync};
use pantin_figure::rotation::Rotation;

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

/// Plays the first `frames` frames of a clip.
pub fn play(machine: Machine, clip: &Path, frames: usize) -> Result<Play> {
    say("building the firmware");
    let firmware = Firmware::featuring(&clips::features(machine, &[clip])?, machine.name, machine.name, machine.target, &[clip])?;
    let folder = tempfile::tempdir()?;
    let counts = folder.path().join("counts");
    let mut launch = Launch::new(machine, firmware.elf()).limit(LIMIT);
    let counting = setup::takes_plugins(machine.emulator);
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
    let log = defmt_log::decode(firmware.elf(), &outcome.stdout)?;
    log.iter().for_each(|line| say(&format!("   board: {line}")));
    ensure!(outcome.code == 0, "the board ended with code {}: {}", outcome.code, outcome.stderr.trim());
    let counts = counting.then(|| icount::by_kind(&icount::read(&counts)?, icount::FRAME_REGIONS.len())).transpose()?;
    Ok(Play { pictures, counts })
}

/// The same by the board's program on this machine.
pub fn simulate(machine: Machine, clip: &Path, frames: usize) -> Result<Play> {
    let display = machine.display.context("this machine shows no pictures")?;
    let shown = simulator::play::<Rotation>(display, &[clip.into()], &[], &vec![&b""[..]; frames - 1])?;
    Ok(Play { pictures: shown.into_iter().map(|(_, picture)| picture).collect(), counts: None })
}
