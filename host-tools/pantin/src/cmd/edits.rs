//! The flags of `pantin convert` that change the motion before it is fitted.

use crate::memory::limit;
use anyhow::{Context, Result};
use pantin_convert::{Moment, edit, events};
use std::path::{Path, PathBuf};

/// Changes of the motion. They apply in this order: --rate, --fps, --event, --from and --to, --joints and --drop, --mirror, --retarget, --with, --loop, --footsteps.
#[derive(clap::Args, Clone, Debug, Default, PartialEq)]
pub struct Edits {
    /// Keep only the joints and scalars whose names match, as in 'Left*,Spine?' (case-insensitive). A joint that is not kept is
    /// removed, or held as in the first frame if a kept joint depends on it
    #[arg(long, value_name = "GLOB,...", value_delimiter = ',')]
    joints: Vec<String>,
    /// Drop the joints and scalars whose names match, in the same way
    #[arg(long, value_name = "GLOB,...", value_delimiter = ',')]
    drop: Vec<String>,
    /// Frames per second that the frames have, instead of what the file states: all frames stay, and the motion gets slower or faster
    #[arg(long, value_name = "FPS", value_parser = rate)]
    pub rate: Option<f64>,
    /// Add an event marker: a name, or a number that is its id, @ a frame or a time, as in clap@12 or 'door opens@1.5s'. Frames count from 0
    /// after --fps and before --from. May be given several times
    #[arg(long = "event", value_name = "NAME@MOMENT", value_parser = marker)]
    events: Vec<Marker>,
    /// Find the frames at which a foot begins to bear weight, and mark them as the events left_foot_down and right_foot_down
    #[arg(long)]
    pub footsteps: bool,
    /// First frame to convert, counted from 0 after --fps: a number, or seconds as in 1.5s
    #[arg(long, value_name = "MOMENT")]
    from: Option<Moment>,
    /// Last frame to convert, inclusive
    #[arg(long, value_name = "MOMENT")]
    to: Option<Moment>,
    /// Mirror the motion at x = 0, with left and right exchanged
    #[arg(long)]
    mirror: bool,
    /// Transfer the motion of any humanoid figure to another body
    #[arg(long, value_enum, value_name = "BODY")]
    retarget: Option<Body>,
    /// Joints for --retarget whose names are not recognized: a file of lines `DISPLAY-JOINT JOINT`, as in `LeftShin knee.L`
    #[arg(long, value_name = "FILE", requires = "retarget")]
    map: Option<PathBuf>,
    /// Add the scalars of another file, such as a face recorded with the body; the shorter file ends the clip
    #[arg(long, value_name = "FILE")]
    with: Option<PathBuf>,
    /// Make a loop: the last frame leads into the first one. Their difference, which must be within the bound, is spread over the clip
    #[arg(long = "loop", conflicts_with_all = ["exact", "max_accel_error"])]
    pub looped: bool,
    /// Make a loop of a motion that is one cycle without its first frame again at the end: frame 0 follows the last frame
    #[arg(long, conflicts_with = "looped")]
    close_loop: bool,
}

/// An event marker as the user gives it.
#[derive(Clone, Debug, PartialEq)]
struct Marker {
    name: String,
    moment: Moment,
}

/// Frames per second that a clip can have: its frame time takes 32 bits of nanoseconds.
fn rate(text: &str) -> Result<f64, String> {
    let rate = text.trim().parse().ok().filter(|rate| (0.24..=1e9).contains(rate));
    rate.ok_or_else(|| "expected 0.24 to 1e9 frames a second".into())
}

fn marker(text: &str) -> Result<Marker> {
    let (name, moment) = text.rsplit_once('@').context("expected NAME@FRAME or NAME@SECONDSs, as in clap@12 or clap@1.5s")?;
    events::check_name(name)?;
    Ok(Marker { name: name.into(), moment: moment.parse()? })
}

/// A body that motions can be put on.
#[derive(Clone, Copy, Debug, PartialEq, clap::ValueEnum)]
enum Body {
    /// 15 joints: hips, chest, head, and upper arm, forearm, hand, thigh, shin, foot of both sides
    Display,
}

impl Edits {
    /// The edits for the library, but for the loop and the footsteps, which depend on the bound. `fps` is the rate to have.
    pub fn edits(&self, fps: Option<f64>) -> edit::Edits {
        let mut edits = edit::Edits::new().memory(limit()).mirror(self.mirror).close_loop(self.close_loop);
        (edits.rate, edits.fps, edits.from, edits.to) = (self.rate, fps, self.from, self.to);
        edits.events = self.events.iter().map(|marker| (marker.name.clone(), marker.moment)).collect();
        (edits.joints, edits.drop) = (self.joints.clone(), self.drop.clone());
        edits.retarget = self.retarget.map(|Body::Display| edit::Body::Display);
        (edits.map, edits.with) = (self.map.clone(), self.with.clone());
        edits
    }

    /// Whether there is any.
    pub fn any(&self) -> bool {
        *self != Edits::default()
    }

    /// The frame from which the motion is kept.
    pub fn first_frame(&self, frame_time: f64) -> usize {
        self.from.map_or(0, |moment| moment.nearest(frame_time))
    }

    /// Takes the paths of files that the edits read as ones from `folder`.
    pub fn read_from(&mut self, folder: &Path) {
        self.map.iter_mut().chain(&mut self.with).for_each(|path| *path = folder.join(&path));
    }

    /// The files that the edits read.
    pub fn inputs(&self) -> impl Iterator<Item = &Path> {
        self.map.iter().chain(&self.with).map(PathBuf::as_path)
    }
}
