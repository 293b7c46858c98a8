//! `pantin render`

use super::{Files, write_whole};
use crate::expand::expand;
use crate::render::{chart, gif, screen, sheet};
use anyhow::{Context, Result, bail};
use pantin_figure::{Track, View};
use std::path::PathBuf;

/// Pictures of a contact sheet.
const SHEET_PICTURES: u32 = 12;

/// Draw a clip as the reference board's display shows it, by the firmware's own figure code.
///
/// A .gif is an animation at the clip's own rate, a .png a sheet of twelve frames. A clip without joints is a chart of its channels over time (.png).
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin render walk.ptn -o walk.gif
  pantin render walk.ptn -o walk.png --view 0
  pantin render face.ptn -o face.png")]
pub struct Arguments {
    /// The clip
    input: PathBuf,
    /// The picture to write: .gif or .png
    #[arg(short, long)]
    output: PathBuf,
    /// The rig of a clip that was made with --rig-out
    #[arg(long)]
    rig: Option<PathBuf>,
    /// Degrees about the figure: 0 looks it in the face, 90 sees it walk to the left, -90 to the right
    #[arg(long, value_name = "DEGREES", default_value_t = View::default().orbit, allow_negative_numbers = true)]
    view: i16,
    /// The axis that is vertical, where the figure is no person and stands on its hands too
    #[arg(long, value_enum, value_name = "AXIS")]
    up: Option<Axis>,
    /// Keep the camera still instead of following the figure
    #[arg(long)]
    fixed: bool,
}

/// An axis of the world.
#[derive(Clone, Copy, clap::ValueEnum)]
enum Axis {
    X,
    Y,
    Z,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    let track = if arguments.fixed { Track::Fixed } else { Track::Follow };
    let up = arguments.up.map(|axis| axis as u8);
    let view = View { orbit: arguments.view, track, up, ..View::default() };
    let files = Files::read(&arguments.input, arguments.rig.as_deref())?;
    let clip = files.open().with_context(|| arguments.input.display().to_string())?;
    let frame_time = f64::from(clip.frame_time_ns()) * 1e-9;
    let no_joints = clip.rig().joint_count() == 0;
    let mut out = Vec::new();
    match arguments.output.extension().and_then(|extension| extension.to_str()) {
        Some("gif") if no_joints => {
            bail!(
                "{}: a clip without joints has no figure to animate; a name that ends in .png gives a chart",
                arguments.output.display()
            );
        }
        Some("png") if no_joints => chart::write(&mut out, &expand(&clip)?)?,
        Some("gif") => {
            let stride = gif::stride(frame_time);
            let pictures = screen::pictures(&clip, view, (0..clip.frames()).step_by(stride as usize))?;
            gif::write(&mut out, &pictures, frame_time * f64::from(stride))?;
        }
        Some("png") => {
            let frames: Vec<u32> = sheet_frames(clip.frames()).collect();
            let pictures = screen::pictures(&clip, view, frames.iter().copied())?;
            let labelled: Vec<_> = frames.into_iter().zip(pictures).collect();
            sheet::write(&mut out, &labelled)?;
        }
        _ => bail!("{}: expected a name that ends in .gif or .png", arguments.output.display()),
    }
    write_whole(&arguments.output, &out)
}

/// Frames of a contact sheet, evenly spread.
fn sheet_frames(frames: u32) -> impl Iterator<Item = u32> {
    let count = frames.min(SHEET_PICTURES);
    (0..count).map(move |index| (u64::from(index) * u64::from(frames) / u64::from(count)) as u32)
}
