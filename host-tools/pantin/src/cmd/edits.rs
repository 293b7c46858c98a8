//! The flags of `pantin convert` that change the motion before it is fitted.

use super::render::Moment;
use anyhow::{Context, Result};
use pantin::{LEFT_FOOT_DOWN, RIGHT_FOOT_DOWN};
use pantin_convert::edit::{
    cut::cut, footsteps::footsteps, join::join, loop_seam, mirror::mirror, pick::pick, resample::resample, retarget,
};
use pantin_convert::events;
use pantin_convert::import;
use pantin_convert::motion::{Event, Motion};
use pantin_convert::number::Number;
use std::collections::HashSet;
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
    footsteps: bool,
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

/// How many events a clip of the motion has: those of one name at one frame are one.
fn distinct(motion: &Motion) -> usize {
    motion.events.iter().map(|event| (event.frame, &event.name)).collect::<HashSet<_>>().len()
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

/// What the edits gave.
pub struct Edited {
    /// The motion.
    pub motion: Motion,
    /// How far --retarget is off.
    pub retarget_max_cm: Option<f64>,
    /// For the user, a sentence each.
    pub said: Vec<String>,
}

impl Edits {
    /// A sentence for a cycle of a file that is read at the times of `fps`.
    pub fn on_sampled(&self, path: &Path, options: &import::Options) -> Result<Option<String>> {
        let Some(fps) = options.fps.filter(|_| self.close_loop) else { return Ok(None) };
        let sentence = || {
            format!(
                "loop: the file was read at {} frames a second up to its last time, which one such frame parts from its first; at its own rate, it is one of its own frames",
                Number(fps)
            )
        };
        Ok(import::is_sampled(path, options)?.then(sentence))
    }

    /// Whether there is any.
    pub fn any(&self) -> bool {
        *self != Edits::default()
    }

    /// The frame from which the motion is kept.
    pub fn first_frame(&self, frame_time: f64) -> usize {
        self.from.map_or(0, |moment| moment.nearest(frame_time))
    }

    /// Adds the footsteps, if they are asked for, to a motion after all other edits; a sentence about them.
    pub fn add_footsteps(&self, motion: &mut Motion) -> Result<Option<String>> {
        if !self.footsteps {
            return Ok(None);
        }
        let steps = footsteps(motion)?;
        let count = |name: &str| steps.iter().filter(|step| step.name == name).count();
        let sentence = format!("footsteps: {} left, {} right", count(LEFT_FOOT_DOWN), count(RIGHT_FOOT_DOWN));
        motion.add_events(steps);
        Ok(Some(sentence))
    }

    /// Takes the paths of files that the edits read as ones from `folder`.
    pub fn read_from(&mut self, folder: &Path) {
        self.map.iter_mut().chain(&mut self.with).for_each(|path| *path = folder.join(&path));
    }

    /// The files that the edits read.
    pub fn inputs(&self) -> impl Iterator<Item = &Path> {
        self.map.iter().chain(&self.with).map(PathBuf::as_path)
    }

    /// All but the loop, which depends on the bound. `fps` is the rate to have; other motions and names are read from `files`.
    pub fn apply(&self, motion: Motion, fps: Option<f64>, files: &import::Files) -> Result<Edited> {
        let mut said = Vec::new();
        let mut motion = motion;
        if let Some(rate) = self.rate {
            said.push(format!(
                "rate: {} frames, {:.3} a second by the file, are now {} a second",
                motion.frames,
                1.0 / motion.frame_time,
                Number(rate)
            ));
            motion.frame_time = 1.0 / rate;
        }
        if let Some(fps) = fps {
            let before = (motion.frames, 1.0 / motion.frame_time);
            let events = distinct(&motion);
            // What will be closed to a loop is one from the start: frames at another rate run on from its last frame to its first.
            let whole = self.to.is_none() && self.first_frame(motion.frame_time) == 0;
            let cycle = self.close_loop && !motion.looped && whole;
            if cycle {
                motion.looped = true;
                motion.keys.fill(None);
            }
            motion = resample(&motion, fps)?;
            motion.looped &= !cycle;
            let merged = events - distinct(&motion);
            if merged > 0 {
                said.push(format!(
                    "events: {merged} of {events} come to a frame that has one of their name, and are one with it"
                ));
            }
            if (before.1 / fps - 1.0).abs() > 1e-3 {
                said.push(format!("{} frames at {:.3} a second became {} at {}", before.0, before.1, motion.frames, Number(fps)));
            }
        }
        for Marker { name, moment } in &self.events {
            let frame =
                moment.frame(motion.frames as u32, motion.frame_time).with_context(|| format!("--event {name}"))? as usize;
            motion.add_events([Event { frame, name: name.clone() }]);
        }
        if self.from.is_some() || self.to.is_some() {
            let frame = |moment: Moment| moment.nearest(motion.frame_time);
            let before = motion.events.len();
            let looped = motion.looped;
            motion = cut(&motion, self.from.map(frame), self.to.map(frame))?;
            if looped && !motion.looped && !self.looped && !self.close_loop {
                said.push("loop: a part of a loop is no loop; --loop or --close-loop makes one".into());
            }
            let left_out = before - motion.events.len();
            if left_out > 0 {
                said.push(format!("events: {left_out} of {before} are not between --from and --to"));
            }
        }
        if !self.joints.is_empty() || !self.drop.is_empty() {
            motion = pick(&motion, &self.joints, &self.drop)?;
        }
        if self.mirror {
            motion = mirror(&motion)?;
        }
        let mut retarget_max_cm = None;
        if let Some(Body::Display) = self.retarget {
            let read = |path: &PathBuf| {
                String::from_utf8(files.read(path)?).with_context(|| format!("{}: expected UTF-8 text", path.display()))
            };
            let map = self.map.as_ref().map(read).transpose()?.unwrap_or_default();
            let done = retarget::display(&motion, &map)?;
            let pairs: Vec<String> = done.sources.iter().map(|(display, source)| format!("{display} {source}")).collect();
            said.push(format!("display's joints: {}", pairs.join(", ")));
            let (cm, joint, frame) = (done.max_cm, done.joint, done.frame);
            said.push(format!("retarget: at most {cm:.2} cm from the source's joints ({joint} at frame {frame})"));
            retarget_max_cm = Some(cm);
            motion = done.motion;
        }
        if let Some(path) = &self.with {
            let mut options = import::Options { files: files.clone(), ..Default::default() };
            let mut imported = import::load(path, &options)?;
            if (imported.motion.frame_time / motion.frame_time - 1.0).abs() > 1e-9 {
                // A file that is read at the rate is nearer to what it says than its frames at another are.
                options.fps = Some(1.0 / motion.frame_time);
                imported.motion = import::load(path, &options)?.motion;
            }
            said.extend(imported.warnings.iter().map(|warning| format!("with: warning: {warning}")));
            let other = imported.motion;
            let before = motion;
            motion = join(&before, &other).with_context(|| format!("--with {}", path.display()))?;
            said.push(format!("with: {} scalars more, {} frames", other.rig.scalars.len(), motion.frames));
            if self.close_loop && motion.frames < before.frames {
                let (left, whole) = (motion.frames, before.frames);
                said.push(format!(
                    "with: warning: the other file ends before the cycle does: {left} of {whole} frames become the loop"
                ));
            }
            if before.looped && !motion.looped {
                said.push(
                    "with: the clip is no loop any more, as the two are not loops of one length; --close-loop makes one".into(),
                );
            }
            let lost = before.events.len() + other.events.len() - motion.events.len();
            if lost > 0 {
                said.push(format!("events: {lost} are behind the end of the shorter of the two, or in both"));
            }
        }
        if self.close_loop && motion.looped {
            said.push("loop: it is one already".into());
        } else if self.close_loop {
            let joined = loop_seam::join_ends(&motion)?;
            motion = joined.motion;
            if let Some([seam, inside]) = joined.joints_cm {
                said.push(format!(
                    "loop: from the last frame to the first, joints go up to {seam:.4} cm; within the clip up to {inside:.4} cm a frame"
                ));
            }
            if let Some([seam, inside]) = joined.scalars.map(|parts| parts.map(|part| 100.0 * part)) {
                said.push(format!(
                    "loop: from the last frame to the first, scalars change by up to {seam:.2} % of full scale; within the clip by up to {inside:.2} % a frame"
                ));
            }
        }
        Ok(Edited { motion, retarget_max_cm, said })
    }
}
