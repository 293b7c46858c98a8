//! `cargo xtask demo [MOTION] [--board NAME] [--out DIR]`: a motion, from its file to the display of an emulated board.
//!
//! ```text
//! $ cargo xtask demo motions/run.keys --board sx1
//! ```
//! leaves `demo/demo.gif`, `demo/demo-sheet.png` and the clip itself, and prints a table of what it cost.

mod board;
mod report;

use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use clap::Args;
use harness::display::Picture;
use harness::{build, paths, qemu, setup};
use pantin_tools::cmd::write_whole;

use crate::pictures;
use report::{Clip, Report};
use xtask::steps::say;

/// Pictures on the contact sheet.
const SHEET: usize = 12;
/// Pictures in a row of it.
const COLUMNS: usize = 3;

/// Plays a motion on the display of an emulated board, and prints what it costs.
#[derive(Args)]
pub struct Demo {
    /// The motion file [default: our own walk]
    motion: Option<PathBuf>,
    /// The machine: lm3s6965evb, microbit, mps2-an386, riscv-virt or sx1
    #[arg(long, default_value = "lm3s6965evb")]
    board: String,
    /// The folder for the pictures and the clip
    #[arg(long, default_value = "demo")]
    out: PathBuf,
    /// Largest error at any joint, as in 0.5cm
    #[arg(long)]
    max_error: Option<String>,
    /// Largest error of channels that move no joint, such as a face's, in percent of their full scale
    #[arg(long, value_name = "PERCENT")]
    max_scalar_error: Option<f64>,
    /// Length of the file's unit in cm, if the guess is wrong
    #[arg(long)]
    cm_per_unit: Option<f64>,
    /// Frames to show
    #[arg(long, default_value_t = 600)]
    frames: usize,
}

impl Demo {
    /// Converts, plays, writes the pictures, prints the table.
    pub fn run(self) -> Result<()> {
        ensure!(self.frames > 0, "--frames 0 leaves nothing to show");
        let machine = qemu::board(&self.board)?;
        let motion = self.motion.clone().unwrap_or_else(|| paths::root().join("motions/walk.keys"));
        ensure!(motion.exists(), "{}: no such file", motion.display());
        say(&format!("converting {}", motion.display()));
        let tool = build::host_tool()?;
        let clip = self.convert(&tool, &motion)?;
        let frames = clip.frames.min(self.frames);
        if frames < clip.frames {
            say(&format!("showing the first {frames} of {} frames (--frames says how many)", clip.frames));
        }
        let play = match setup::install_emulator(machine.emulator) {
            Ok(_) => board::play(machine, &clip.path, frames)?,
            Err(missing) => {
                say(&format!("{missing:#}\nplaying the board's program on this machine instead"));
                board::simulate(machine, &clip.path, frames)?
            }
        };
        self.write_pictures(&play.pictures, clip.rate)?;
        say(&format!("wrote {} and demo-sheet.png", self.out.join("demo.gif").display()));
        print!("{}", Report { clip: &clip, counts: play.counts });
        Ok(())
    }

    fn convert(&self, tool: &PathBuf, motion: &PathBuf) -> Result<Clip> {
        std::fs::create_dir_all(&self.out).with_context(|| format!("cannot make {}", self.out.display()))?;
        let name = motion.file_stem().unwrap_or(motion.as_os_str());
        let path = self.out.join(name).with_extension("ptn");
        let mut convert = Command::new(tool);
        convert.arg("convert").arg(motion).arg("-o").arg(&path).arg("--json");
        convert.args(self.max_error.iter().flat_map(|error| ["--max-error", error]));
        convert.args(self.max_scalar_error.iter().flat_map(|error| ["--max-scalar-error".to_owned(), error.to_string()]));
        convert.args(self.cm_per_unit.iter().flat_map(|unit| ["--cm-per-unit".to_owned(), unit.to_string()]));
        let converted = run(&mut convert)?;
        let info = run(Command::new(tool).args(["info", "--json"]).arg(&path))?;
        Clip::new(path, &converted, &info)
    }

    fn write_pictures(&self, shown: &[Picture], rate: f64) -> Result<()> {
        write_whole(&self.out.join("demo.gif"), &pictures::animation(shown, rate)?)?;
        let chosen = SHEET.min(shown.len());
        let frames = (0..chosen).map(|index| index * shown.len() / chosen);
        let labelled: Vec<_> = frames.map(|frame| (format!("frame {frame}"), &shown[frame])).collect();
        write_whole(&self.out.join("demo-sheet.png"), &pictures::sheet(&labelled, COLUMNS)?)
    }
}

/// Runs the host tool, whose stderr a person sees, and returns its stdout.
fn run(command: &mut Command) -> Result<Vec<u8>> {
    let output = command.stderr(std::process::Stdio::inherit()).output().context("cannot start the host tool")?;
    ensure!(output.status.success(), "pantin could not do it, see above");
    Ok(output.stdout)
}
