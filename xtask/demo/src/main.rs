//! `cargo xtask demo [MOTION] [--board NAME] [--out DIR]`: a motion, from its file to the display of an emulated board.
//!
//! ```text
//! $ cargo xtask demo motions/run.keys --board sx1
//! ```
//! leaves `demo/demo.gif`, `demo/demo-sheet.png` and the clip itself, and prints a table of what it cost.

mod board;
mod conversion;
mod report;
mod steer;

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail, ensure};
use conversion::Bounds;
use harness::display::Picture;
use harness::{paths, pictures, qemu, setup};
use lexopt::{Arg, ValueExt};
use report::Report;
use xtask::steps::say;

const USAGE: &str = "Plays a motion on the display of an emulated board, and prints what it costs

Usage: cargo xtask demo [OPTIONS] [MOTION]

Arguments:
  [MOTION]  The motion file; default: our own walk

Options:
      --board <NAME>                  The machine: lm3s6965evb (default), microbit, mps2-an386, riscv-virt or sx1
      --out <DIR>                     Folder for the pictures and the clip (default: demo)
      --max-error <LENGTH>            Largest error at any joint, as in 0.5cm
      --max-scalar-error <PERCENT>    Largest error of channels that move no joint, such as a face's, in percent of full scale
      --cm-per-unit <CM_PER_UNIT>     Length of the file's unit in cm, if the guess is wrong
      --style <STYLE>                 What a body is drawn as: lines (default) or solid
      --frames <FRAMES>               Frames to show (default: 600)
      --steer                         Play a recorded session of our character's state machine instead, on this machine;
                                      with --board (lm3s6965evb or sx1), steer it yourself in the emulator's window
      --meet                          Steer it to another character, which reacts to it, in the emulator's window
                                      of --board (sx1 without it)
  -h, --help                          Print help";

/// Pictures on the contact sheet.
const SHEET: usize = 12;
/// Pictures in a row of it.
const COLUMNS: usize = 3;

fn main() -> ExitCode {
    // `cargo xtask` passes its own arguments, which begin with the command's name.
    let mut arguments: Vec<OsString> = std::env::args_os().skip(1).collect();
    if arguments.first().is_some_and(|first| first == "demo") {
        arguments.remove(0);
    }
    let done = Demo::parse(&arguments).and_then(|demo| demo.map_or(Ok(()), |demo| demo.run(&arguments)));
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

/// What was asked for.
struct Demo {
    motion: PathBuf,
    board: String,
    out: PathBuf,
    bounds: Bounds,
    frames: usize,
    /// Whether a body has volume.
    solid: bool,
    steer: bool,
    /// Whether the character meets another one.
    meet: bool,
    /// Whether `board` was given.
    on_board: bool,
}

impl Demo {
    /// From the command line; `None` where help was asked for, which is printed.
    fn parse(arguments: &[OsString]) -> Result<Option<Self>> {
        let mut demo = Self {
            motion: paths::root().join("motions/walk.keys"),
            board: "lm3s6965evb".into(),
            out: "demo".into(),
            bounds: Bounds::default(),
            frames: 600,
            solid: false,
            steer: false,
            meet: false,
            on_board: false,
        };
        let mut parser = lexopt::Parser::from_args(arguments);
        while let Some(argument) = parser.next()? {
            match argument {
                Arg::Long("board") => (demo.board, demo.on_board) = (parser.value()?.string()?, true),
                Arg::Long("out") => demo.out = parser.value()?.into(),
                Arg::Long("max-error") => demo.bounds.error = Some(parser.value()?.string()?),
                Arg::Long("max-scalar-error") => demo.bounds.scalar_percent = Some(parser.value()?.parse()?),
                Arg::Long("cm-per-unit") => demo.bounds.cm_per_unit = Some(parser.value()?.parse()?),
                Arg::Long("frames") => demo.frames = parser.value()?.parse()?,
                Arg::Long("style") => {
                    demo.solid = match parser.value()?.string()?.as_str() {
                        "lines" => false,
                        "solid" => true,
                        other => bail!("--style {other}: expected lines or solid"),
                    }
                }
                Arg::Long("steer") => demo.steer = true,
                Arg::Long("meet") => demo.meet = true,
                Arg::Short('h') | Arg::Long("help") => {
                    println!("{USAGE}");
                    return Ok(None);
                }
                Arg::Value(motion) => demo.motion = motion.into(),
                other => bail!("{}\n\n{USAGE}", other.unexpected()),
            }
        }
        ensure!(demo.frames > 0, "--frames 0 leaves nothing to show");
        ensure!(demo.motion.exists(), "{}: no such file", demo.motion.display());
        Ok(Some(demo))
    }

    /// Converts, plays, writes the pictures, prints the table.
    #[cfg_attr(feature = "simulator", expect(unused_variables))]
    fn run(self, arguments: &[OsString]) -> Result<()> {
        if self.meet {
            return steer::live(if self.on_board { &self.board } else { "sx1" }, true);
        }
        if self.steer && self.on_board {
            return steer::live(&self.board, false);
        }
        if self.steer {
            return steer::run(&self.out);
        }
        let machine = qemu::board(&self.board)?;
        std::fs::create_dir_all(&self.out).with_context(|| format!("cannot make {}", self.out.display()))?;
        say(&format!("converting {}", self.motion.display()));
        let clip = conversion::convert(&self.motion, &self.out, &self.bounds)?;
        let frames = clip.frames.min(self.frames);
        if frames < clip.frames {
            say(&format!("showing the first {frames} of {} frames (--frames sets how many)", clip.frames));
        }
        let play = match setup::install_emulator(machine.emulator) {
            Ok(_) => board::play(machine, &clip.path, frames, self.solid)?,
            #[cfg(feature = "simulator")]
            Err(missing) => {
                say(&format!("{missing:#}\nplaying the board's program on this machine instead"));
                board::simulate(machine, &clip.path, frames, self.solid)?
            }
            #[cfg(not(feature = "simulator"))]
            Err(_) => return simulating(arguments),
        };
        self.write_pictures(&play.pictures, clip.rate)?;
        say(&format!("wrote {} and demo-sheet.png", self.out.join("demo.gif").display()));
        print!("{}", Report { clip: &clip, counts: play.counts });
        Ok(())
    }

    fn write_pictures(&self, shown: &[Picture], rate: f64) -> Result<()> {
        write(&self.out.join("demo.gif"), &pictures::animation(shown, rate)?)?;
        let chosen = SHEET.min(shown.len());
        let frames = (0..chosen).map(|index| index * shown.len() / chosen);
        let labelled: Vec<_> = frames.map(|frame| (format!("frame {frame}"), &shown[frame])).collect();
        write(&self.out.join("demo-sheet.png"), &pictures::sheet(&labelled, COLUMNS)?)
    }
}

#[cfg(not(feature = "simulator"))]
/// Runs this program with the simulator built in.
fn simulating(arguments: &[OsString]) -> Result<()> {
    let mut cargo = std::process::Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
    cargo.arg("run").arg("--manifest-path").arg(paths::root().join("Cargo.toml"));
    cargo.args(["--profile", "demo", "--package", "xtask-demo", "--features", "simulator", "--"]).args(arguments);
    ensure!(cargo.status().context("cannot start cargo")?.success(), "the simulator failed, see above");
    Ok(())
}

fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    std::fs::write(path, bytes).with_context(|| format!("cannot write {}", path.display()))
}
