//! `cargo xtask demo [MOTION] [--out DIR]`: a motion, from its file to the display of an emulated board.
//!
//! ```text
//! $ cargo xtask demo motions/run.keys
//! ```
//! leaves `demo/demo.gif`, `demo/demo-sheet.png` and the clip itself, and prints a table of what it cost.

mod board;
mod report;

use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use clap::Args;
use harness::display::Picture;
use harness::{build, paths, setup};
use pantin_tools::cmd::write_whole;
use pantin_tools::render::{gif, sheet};

use super::steps::say;
use report::{Clip, Report};

/// Pictures on the contact sheet.
const SHEET: usize = 12;

/// Plays a motion on the display of an emulated board, and shows what it costs.
#[derive(Args)]
pub struct Demo {
    /// The motion file; our own walk if none is given
    motion: Option<PathBuf>,
    /// Where the pictures and the clip go
    #[arg(long, default_value = "demo")]
    out: PathBuf,
    /// Largest error at any joint, as in 0.5cm
    #[arg(long)]
    max_error: Option<String>,
    /// Length of the file's unit, where the guess is wrong
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
        let motion = self.motion.clone().unwrap_or_else(|| paths::root().join("motions/walk.keys"));
        ensure!(motion.exists(), "{}: no such file", motion.display());
        say(&format!("converting {}", motion.display()));
        let tool = build::host_tool()?;
        let clip = self.convert(&tool, &motion)?;
        let frames = clip.frames.min(self.frames);
        if frames < clip.frames {
            say(&format!("showing the first {frames} of {} frames (--frames says how many)", clip.frames));
        }
        let counts = match setup::install_emulator("qemu-system-arm") {
            Ok(_) => {
                let play = board::play(&clip.path, frames)?;
                self.write_pictures(&play.pictures, clip.rate)?;
                play.counts
            }
            Err(missing) => {
                say(&format!("{missing:#}\nplaying in the built-in host display instead"));
                for name in ["demo.gif", "demo-sheet.png"] {
                    run(Command::new(&tool).arg("render").arg(&clip.path).arg("-o").arg(self.out.join(name)))?;
                }
                None
            }
        };
        say(&format!("wrote {} and demo-sheet.png", self.out.join("demo.gif").display()));
        print!("{}", Report { clip: &clip, counts });
        Ok(())
    }

    fn convert(&self, tool: &PathBuf, motion: &PathBuf) -> Result<Clip> {
        std::fs::create_dir_all(&self.out).with_context(|| format!("cannot make {}", self.out.display()))?;
        let name = motion.file_stem().unwrap_or(motion.as_os_str());
        let path = self.out.join(name).with_extension("ptn");
        let mut convert = Command::new(tool);
        convert.arg("convert").arg(motion).arg("-o").arg(&path).arg("--json");
        convert.args(self.max_error.iter().flat_map(|error| ["--max-error", error]));
        convert.args(self.cm_per_unit.iter().flat_map(|unit| ["--cm-per-unit".to_owned(), unit.to_string()]));
        let converted = run(&mut convert)?;
        let info = run(Command::new(tool).args(["info", "--json"]).arg(&path))?;
        Clip::new(path, &converted, &info)
    }

    fn write_pictures(&self, shown: &[Picture], rate: f64) -> Result<()> {
        let stride = gif::stride(1.0 / rate) as usize;
        let animated: Vec<_> = shown.iter().step_by(stride).map(greys).collect();
        let mut animation = vec![];
        gif::write(&mut animation, &animated, stride as f64 / rate)?;
        write_whole(&self.out.join("demo.gif"), &animation)?;
        let chosen = SHEET.min(shown.len());
        let frames = (0..chosen).map(|index| index * shown.len() / chosen);
        let labelled: Vec<_> = frames.map(|frame| (frame as u32, greys(&shown[frame]))).collect();
        let mut pictures = vec![];
        sheet::write(&mut pictures, &labelled)?;
        write_whole(&self.out.join("demo-sheet.png"), &pictures)
    }
}

/// A picture of the reference display as the host tool draws them.
fn greys(picture: &Picture) -> pantin_tools::render::screen::Picture {
    pantin_tools::render::screen::Picture { pixels: picture.pixels.iter().map(|&grey| grey as u8).collect() }
}

/// Runs the host tool, whose stderr a person sees, and returns its stdout.
fn run(command: &mut Command) -> Result<Vec<u8>> {
    let output = command.stderr(std::process::Stdio::inherit()).output().context("cannot start the host tool")?;
    ensure!(output.status.success(), "pantin could not do it, see above");
    Ok(output.stdout)
}
