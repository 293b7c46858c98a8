//! Programs of `firmware/testsuite` on an emulated machine, with a clip in its flash.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use harness::build::Firmware;
use harness::qemu::{Launch, Machine};
use harness::{defmt_log, icount};

/// Upper half of the flash: `firmware/testsuite/memory.x` leaves it to the clip.
const CLIP: (u32, u64) = (0x2_0000, 0x2_0000);

/// A program, built for a machine.
pub struct Guest {
    machine: Machine,
    firmware: Firmware,
    plugin: PathBuf,
}

impl Guest {
    /// Builds it.
    pub fn new(machine: Machine, program: &str) -> Result<Self> {
        Self::featuring("", machine, program)
    }

    /// Builds it with features of the package, separated by commas.
    pub fn featuring(features: &str, machine: Machine, program: &str) -> Result<Self> {
        let firmware = Firmware::featuring(features, "testsuite", program, machine.target, &[])?;
        Ok(Self { machine, firmware, plugin: icount::plugin(machine.emulator)? })
    }

    /// Instructions of each marked region.
    pub fn counts(&self, clip: Option<&Path>) -> Result<Vec<u64>> {
        let folder = tempfile::tempdir().context("cannot make a temporary folder")?;
        let counts = folder.path().join("counts");
        self.run(self.launch(clip)?.counting(&self.plugin, &counts))?;
        icount::read(&counts)
    }

    /// What the program logs, a line a message.
    pub fn log(&self, clip: &Path) -> Result<Vec<String>> {
        let stdout = self.run(self.launch(Some(clip))?)?;
        defmt_log::decode(self.firmware.elf(), &stdout)
    }

    fn launch(&self, clip: Option<&Path>) -> Result<Launch> {
        let launch = Launch::new(self.machine, self.firmware.elf());
        let Some(clip) = clip else { return Ok(launch) };
        let length = clip.metadata().with_context(|| clip.display().to_string())?.len();
        ensure!(length <= CLIP.1, "{}: {length} bytes do not fit the machine's flash", clip.display());
        Ok(launch.loading(clip, CLIP.0).argument(CLIP.0.to_string()).argument(length.to_string()))
    }

    fn run(&self, launch: Launch) -> Result<Vec<u8>> {
        let outcome = launch.start()?.wait()?;
        ensure!(outcome.code == 0, "{} ended with code {}: {}", self.machine.name, outcome.code, outcome.stderr.trim());
        Ok(outcome.stdout)
    }
}
