//! The flags of `pantin convert` that change the motion before it is fitted.

use crate::memory::limit;
use anyhow::{Context, Result};
use pantin_convert::{Moment, edit, events};
use std::path::{Path, PathBuf};

/// Changes of the motion. They apply in this order: --rate, --speed, --fps, --event, --from and --to, --between, --joints and --drop, --rename, --mirror, --retarget
/// or --body, --reverse, --scale, --smooth, --in-place, --turn, --pace, --append, --with, --loop, --footsteps.
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
    /// How many times faster the motion goes, as in 1.5: all frames stay
    #[arg(long, value_name = "FACTOR", value_parser = factor)]
    speed: Option<f64>,
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
    /// Keep what is between two events, as in step..step: the first event of the one name, and the next one of the other after it
    #[arg(long, value_name = "EVENT..EVENT", value_parser = stretch)]
    between: Option<(String, String)>,
    /// Give joints and scalars another name, as in 'hip=Hips,mixamorig:*=*'; one * stands for the same letters in both
    #[arg(long, value_name = "OLD=NEW,...", value_delimiter = ',', value_parser = other_name)]
    rename: Vec<(String, String)>,
    /// Mirror the motion at x = 0, with left and right exchanged
    #[arg(long)]
    mirror: bool,
    /// Transfer the motion of any humanoid figure to another body
    #[arg(long, value_enum, value_name = "BODY", group = "other body")]
    retarget: Option<Body>,
    /// Put the motion of any humanoid figure on the figure of another file: a motion, a clip or a bank. Motions on one body can be in one bank
    #[arg(long, value_name = "FILE", group = "other body")]
    body: Option<PathBuf>,
    /// Joints for --retarget and --body whose names are not recognized: a file of lines `DISPLAY-JOINT JOINT`, as in `LeftShin knee.L`
    #[arg(long, value_name = "FILE", requires = "other body")]
    map: Option<PathBuf>,
    /// Play the motion backwards
    #[arg(long)]
    reverse: bool,
    /// How many times larger the figure becomes, with its way
    #[arg(long, value_name = "FACTOR", value_parser = factor)]
    scale: Option<f64>,
    /// Smooth away what is faster than this frequency: motion keeps 0.707 of its size there, a quarter at twice the frequency
    #[arg(long, value_name = "HZ", value_parser = factor)]
    smooth: Option<f64>,
    /// Take out the way of the figure, or its heading too
    #[arg(long, value_enum, value_name = "WHAT", num_args = 0..=1, default_missing_value = "way", require_equals = true)]
    in_place: Option<InPlace>,
    /// Turn the whole motion about the vertical, to the figure's left: for a figure that faces another way than those of other clips
    #[arg(long, value_name = "DEGREES", allow_hyphen_values = true, value_parser = angle)]
    turn: Option<f64>,
    /// Let a figure that treads on the spot, as on a treadmill, go somewhere: at a speed in the direction in which it faces, as in 120cm/s
    /// or 1.2m/s, or `feet`: as fast as its feet on the ground slide, the opposite way
    #[arg(long, value_name = "SPEED|feet", allow_hyphen_values = true, value_parser = str::parse::<edit::Pace>)]
    pace: Option<edit::Pace>,
    /// Add another motion to the end, where the figure then stands. May be given several times
    #[arg(long, value_name = "FILE")]
    append: Vec<PathBuf>,
    /// Seconds in which the motion goes over to the next one of --append [default: 0.25]
    #[arg(long, value_name = "SECONDS", requires = "append", value_parser = seconds)]
    blend: Option<f64>,
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

/// A number above 0.
fn factor(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| "expected a number above 0".into())
}

fn angle(text: &str) -> Result<f64, String> {
    let degrees = text.trim().parse().ok().filter(|degrees: &f64| degrees.abs() <= 360.0);
    degrees.ok_or_else(|| "expected degrees, -360 to 360".into())
}

fn seconds(text: &str) -> Result<f64, String> {
    let number = text.trim().trim_end_matches('s').parse().ok().filter(|number: &f64| (0.0..1e6).contains(number));
    number.ok_or_else(|| "expected seconds, 0 or more".into())
}

fn stretch(text: &str) -> Result<(String, String)> {
    let (first, last) = text.split_once("..").context("expected two events, as in step..step")?;
    Ok((first.into(), last.into()))
}

fn other_name(text: &str) -> Result<(String, String)> {
    let (old, new) = text.split_once('=').context("expected OLD=NEW")?;
    Ok((old.into(), new.into()))
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

/// What --in-place takes out.
#[derive(Clone, Copy, Debug, PartialEq, clap::ValueEnum)]
enum InPlace {
    /// The horizontal way: the figure stays above the place of its first frame
    Way,
    /// The way and the heading
    WayAndHeading,
}

impl Edits {
    /// The edits for the library, but for the loop and the footsteps, which depend on the bound. `fps` is the rate to have.
    pub fn edits(&self, fps: Option<f64>) -> edit::Edits {
        let mut edits = edit::Edits::new().memory(limit()).mirror(self.mirror).close_loop(self.close_loop);
        (edits.rate, edits.fps, edits.from, edits.to) = (self.rate, fps, self.from, self.to);
        edits.events = self.events.iter().map(|marker| (marker.name.clone(), marker.moment)).collect();
        (edits.joints, edits.drop) = (self.joints.clone(), self.drop.clone());
        edits.retarget = self.retarget.map(|Body::Display| edit::Body::Display);
        if let Some(file) = &self.body {
            edits.retarget = Some(edit::Body::Of(file.clone()));
        }
        (edits.speed, edits.scale, edits.smooth, edits.blend) = (self.speed, self.scale, self.smooth, self.blend);
        (edits.between, edits.rename) = (self.between.clone(), self.rename.clone());
        (edits.reverse, edits.append) = (self.reverse, self.append.clone());
        edits.in_place = self.in_place.map(|what| match what {
            InPlace::Way => edit::InPlace::Way,
            InPlace::WayAndHeading => edit::InPlace::WayAndHeading,
        });
        (edits.turn, edits.pace) = (self.turn, self.pace);
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
        self.map
            .iter_mut()
            .chain(&mut self.with)
            .chain(&mut self.body)
            .chain(&mut self.append)
            .for_each(|path| *path = folder.join(&path));
    }

    /// The files that the edits read.
    pub fn inputs(&self) -> impl Iterator<Item = &Path> {
        self.map.iter().chain(&self.with).chain(&self.body).chain(&self.append).map(PathBuf::as_path)
    }
}
