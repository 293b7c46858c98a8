//! A motion after all edits, with what its clip must keep, and its way to a verified clip.

use super::Progress;
use super::bound::{Bound, closed_notes};
use super::distance::Distance;
use super::keyed::key_clip;
use super::left_out::left_out;
use super::report::{Errors, Report, SeamReport};
use crate::channel_error;
use crate::edit::cut::cut;
use crate::edit::footsteps::footsteps;
use crate::edit::loop_seam::Closed;
use crate::encode::clip::{self, Coded};
use crate::encode::rig;
use crate::encode::same_rig::difference;
use crate::error::{Error, Setting, require};
use crate::fit::bounds::Bounds;
use crate::fit::level::Level;
use crate::fit::rotation_coding::{Coding, Rotations, has_choice, quaternions};
use crate::fit::{channelwise, fit_coding};
use crate::import::up;
use crate::length::Length;
use crate::motion::{Keys, Motion, Up};
use crate::note::{Note, NoteKind, Remedy};
use crate::number::Number;
use crate::options::{ChannelBound, Options, UseKeys};
use crate::pose_bound::PoseBound;
use crate::verify::verify;
use anyhow::{Context, Result};
use pantin::codec::layout::MAX_FRAMES;
use pantin::{LEFT_FOOT_DOWN, RIGHT_FOOT_DOWN};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A motion after all edits, and what its clip must keep.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Prepared {
    /// The motion, its seam closed if that was asked for.
    pub motion: Motion,
    /// The bytes of the motion's rig.
    pub rig: Vec<u8>,
    /// What was found so far.
    pub notes: Vec<Note>,
    options: Options,
    bound: Bound,
    seam: Option<Seam>,
}

/// A loop's source, and what closing its seam took of the bound.
#[derive(Clone, Debug)]
struct Seam {
    /// The motion before its seam was closed, without the last frame.
    source: Motion,
    /// The bound against it.
    bound: Bound,
    report: SeamReport,
}

/// A verified clip of a prepared motion.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Made {
    /// The bytes of the clip.
    pub clip: Vec<u8>,
    /// How far it is from the source.
    pub report: Report,
    /// What was done and what is odd, that of the prepared motion included.
    pub notes: Vec<Note>,
}

/// Checks the options against `motion`, and closes its seam if that is asked for. Footsteps are found by [`Prepared::find_footsteps`].
pub fn prepare(motion: Motion, options: &Options) -> Result<Prepared, Error> {
    prepared(motion, options).map_err(|error| Error::of(&error, Error::source))
}

fn prepared(mut motion: Motion, options: &Options) -> Result<Prepared> {
    check_settings(options)?;
    let mut notes = without_effect(options, &motion);
    if options.makes_quaternions() {
        motion = quaternions(&motion);
    }
    let size = [motion.rig.joints.len(), motion.rig.channels()];
    let beam = options.effort.plan(PoseBound::places(1.0)).effort.beam;
    options.memory.check_fit(motion.frames, size, beam, motion.origin.bytes)?;
    let mut bound = Bound::of(options, &motion)?;
    let mut seam = None;
    if options.looped {
        let whole = bound.clone();
        let closed = bound.close(&motion)?;
        notes.extend(closed_notes(&closed, &motion));
        if !motion.looped {
            let source = cut(&motion, None, Some(closed.motion.frames - 1))?;
            let Closed { seam_cm, seam_joint, moved_cm, joint: moved_joint, turned_deg, .. } = closed;
            let report = SeamReport { seam_cm, seam_joint, moved_cm, moved_joint, turned_deg };
            seam = Some(Seam { source, bound: whole, report });
        }
        motion = closed.motion;
    }
    let rig = rig::encode(&motion.rig)?;
    Ok(Prepared { motion, rig, notes, options: options.clone(), bound, seam })
}

impl Options {
    /// Refuses numbers that no setting takes, whatever the motion.
    pub fn check(&self) -> Result<(), Error> {
        check_settings(self).map_err(|error| Error::of(&error, Error::source))
    }
}

/// Refuses numbers that no setting takes.
fn check_settings(options: &Options) -> Result<()> {
    let number = |number: Option<f64>| number.is_none_or(|number| number.is_finite() && number > 0.0);
    for (setting, degrees) in
        [(Setting::MaxRotationError, options.max_rotation_error), (Setting::MaxJointError, options.max_joint_error)]
    {
        let wrong = || Error::setting(setting, format!("expected degrees from {:e} to 180", Options::LEAST_DEGREES));
        require!(degrees.is_none_or(|degrees| (Options::LEAST_DEGREES..=180.0).contains(&degrees)), wrong());
    }
    let both = options.places_only && options.shell.is_some();
    require!(!both, Error::setting(Setting::Shell, "it bounds what the bound of places alone leaves out"));
    let channels = match options.channels {
        Some(ChannelBound::Error(bound)) => (Setting::MaxChannelError, number(Some(bound))),
        Some(ChannelBound::Acceleration(bound)) => (Setting::MaxAccelError, number(Some(bound))),
        _ => (Setting::Exact, true),
    };
    for (setting, valid) in [(Setting::MaxScalarError, number(options.max_scalar_error)), channels] {
        require!(valid, Error::setting(setting, "expected a number above 0"));
    }
    let lengths =
        [(Setting::MaxError, options.max_error), (Setting::MeanError, options.mean_error), (Setting::Shell, options.shell)];
    for (setting, length) in lengths {
        let wrong = || Error::setting(setting, "expected a length above 0, at most 10 km or 1000000 % of the figure's height");
        require!(length.is_none_or(Length::is_valid), wrong());
    }
    let drifts = matches!(options.channels, Some(ChannelBound::Exact | ChannelBound::Acceleration(_)));
    require!(!(drifts && options.looped), Error::setting(Setting::Loop, "closing a seam needs a bound of positions"));
    Ok(())
}

/// Settings that bound nothing in this motion.
fn without_effect(options: &Options, motion: &Motion) -> Vec<Note> {
    let (no_joints, no_scalars) = (motion.rig.joints.is_empty(), motion.rig.scalars.is_empty());
    // Settings, whether they are given for nothing, and what is missing.
    let given = [
        (Setting::MaxError, options.max_error.is_some() && no_joints, "joints"),
        (Setting::MeanError, options.mean_error.is_some() && no_joints, "joints"),
        (Setting::MaxRotationError, options.max_rotation_error.is_some() && no_joints, "joints"),
        (Setting::MaxScalarError, options.max_scalar_error.is_some() && no_scalars, "scalars"),
        (Setting::MaxJointError, options.max_joint_error.is_some() && no_joints, "joints"),
        (Setting::Shell, options.shell.is_some() && no_joints, "joints"),
        (Setting::PlacesOnly, options.places_only && no_joints, "joints"),
        (Setting::Rotations, options.rotations != Rotations::ByCost && !has_choice(&motion.rig), "joint with three Euler angles"),
    ];
    let given = given.into_iter().filter(|(_, for_nothing, _)| *for_nothing);
    let mut notes: Vec<Note> =
        given.map(|(setting, _, what)| Note::no_effect(setting, format!("the motion has no {what}"))).collect();
    if options.channels.is_some() {
        let is_kept_from = match options.rotations {
            Rotations::Exponential => true,
            Rotations::Quaternion => !options.makes_quaternions(),
            Rotations::ByCost | Rotations::Euler => false,
        };
        let given = [(Setting::Effort, options.effort != Level::DEFAULT), (Setting::Rotations, is_kept_from)];
        let given = given.into_iter().filter(|(_, given)| *given);
        notes.extend(
            given.map(|(setting, _)| Note::no_effect(setting, "channels with bounds of their own are coded as they are")),
        );
    }
    notes
}

impl Prepared {
    /// States another direction as vertical.
    pub fn set_up(&mut self, up: Up) -> Result<(), Error> {
        self.motion.rig.up = up;
        self.rig = rig::encode(&self.motion.rig).map_err(|error| Error::of(&error, Error::source))?;
        Ok(())
    }

    /// Adds the events of footsteps, if they are asked for.
    pub fn find_footsteps(&mut self) -> Result<(), Error> {
        if !self.options.footsteps {
            return Ok(());
        }
        let steps = footsteps(&self.motion, self.options.memory).map_err(|error| Error::of(&error, Error::source))?;
        let count = |name: &str| steps.iter().filter(|step| step.name == name).count();
        let text = format!("footsteps: {} left, {} right", count(LEFT_FOOT_DOWN), count(RIGHT_FOOT_DOWN));
        self.notes.push(Note::info(NoteKind::Footsteps, text));
        self.motion.add_events(steps);
        Ok(())
    }

    /// The clip in a coding, verified by the device's own decoder.
    pub fn code(&self, coding: &Coding, progress: Progress<'_>) -> Result<Made, Error> {
        progress(0.0);
        let mut notes = self.notes.clone();
        let made = match &self.bound {
            Bound::Channels(bounds) => self.by_channel(bounds, coding, &mut notes, progress),
            Bound::Distance(distance) => self.by_distance(distance, coding, &mut notes, progress),
        };
        let (clip, coded, errors) = made.map_err(|error| Error::of(&error, Error::bound))?;
        progress(1.0);
        let Motion { frames, ref rig, .. } = self.motion;
        let (frame_time_ns, length_exponent) = (coded.frame_time_ns, coded.length_exponent);
        let seam = self.seam.as_ref().map(|seam| seam.report.clone());
        let report = Report { errors, frames, channels: rig.channels(), frame_time_ns, length_exponent, seam };
        Ok(Made { clip, report, notes })
    }

    fn by_distance(
        &self,
        distance: &Distance,
        coding: &Coding,
        notes: &mut Vec<Note>,
        progress: Progress<'_>,
    ) -> Result<(Vec<u8>, Coded, Errors)> {
        let Prepared { motion, rig, options, .. } = self;
        let (plan, part) = (distance.plan(options.effort), distance.scalar_part);
        let coded = fit_coding(motion, coding, plan, part, progress)?;
        let by_segments = self.file(&coded, notes)?;
        // Errors are those against the source, whatever closing a loop moved.
        let (source, whole) = match &self.seam {
            Some(Seam { source, bound: Bound::Distance(whole), .. }) => (source, whole),
            _ => (motion, distance),
        };
        let within = |bytes: &[u8]| verify(bytes, rig, source, &whole.pose, whole.scalar_part).map(drop);
        let keyed = self.by_keys(&coded, &by_segments, &within, notes)?;
        let has_keys = keyed.is_some();
        let bytes = keyed.unwrap_or(by_segments);
        let report = verify(&bytes, rig, source, &whole.pose, whole.scalar_part)?;
        if let Some(mean_cm) = whole.pose.mean_cm {
            let mean = report.bounded_mean_cm(&whole.pose);
            let refusal =
                || Error::bound(format!("joints are {mean:.5} cm off in the mean; the bound of the mean is {mean_cm} cm"));
            require!(mean <= mean_cm, refusal());
        }
        if !has_keys {
            notes.extend(left_out(motion, &coded, &whole.pose));
        }
        Ok((bytes, coded, Errors::Joints(report)))
    }

    fn by_channel(
        &self,
        bounds: &Bounds,
        coding: &Coding,
        notes: &mut Vec<Note>,
        progress: Progress<'_>,
    ) -> Result<(Vec<u8>, Coded, Errors)> {
        let Prepared { motion, rig, .. } = self;
        let mut bounds = bounds.clone();
        bounds.at_least_steps(motion, coding.length_exponent);
        let (channels, done, progress) = (motion.rig.channels() as f64, AtomicUsize::new(0), Mutex::new(progress));
        let step = || {
            let part = (done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / channels;
            // A poisoned lock means that another thread's report failed, which will end the conversion.
            if let Ok(mut progress) = progress.lock() {
                progress(part);
            }
        };
        let coded = channelwise::fit_exponent(motion, &bounds, coding.length_exponent, &step)?;
        if let Some((channel, asked)) = bounds.raised(motion) {
            let (name, bound) = (motion.rig.channel_name(channel), bounds.greatest[channel]);
            let text = format!(
                "the figure is so far from its origin that positions have steps of {bound:.3e}: {name} and channels like it keep this bound, not the \
                 {asked:.3e} that was asked for"
            );
            notes.push(Note::warning(NoteKind::BoundRaised, text).of_joint(name));
        }
        let by_segments = self.file(&coded, notes)?;
        let within = |bytes: &[u8]| channel_error::verify(bytes, rig, motion, &bounds).map(drop);
        let bytes = self.by_keys(&coded, &by_segments, &within, notes)?.unwrap_or(by_segments);
        let report = channel_error::verify(&bytes, rig, motion, &bounds)?;
        Ok((bytes, coded, Errors::Channels(report, bounds.constraint)))
    }

    /// The key clip of the motion, if it is to be written; a note says which kind of clip is, and why.
    fn by_keys(
        &self,
        coded: &Coded,
        by_segments: &[u8],
        within: &dyn Fn(&[u8]) -> Result<()>,
        notes: &mut Vec<Note>,
    ) -> Result<Option<Vec<u8>>> {
        let Options { keys, rig_apart, index, .. } = self.options;
        let has_keys = self.motion.keys.iter().flatten().any(|keys| matches!(keys, Keys::OnFrames { .. }));
        match keys {
            UseKeys::Never => return Ok(None),
            // Motions without keys, as captures are, have nothing to choose from.
            UseKeys::IfSmaller if index.is_some() || !has_keys => return Ok(None),
            UseKeys::Always => {
                let why = "a key clip has no index: its player seeks to any frame at once";
                require!(index.is_none(), Error::setting(Setting::Index, why));
            }
            UseKeys::IfSmaller => {}
        }
        let made = key_clip(&self.motion, &self.rig, (coded.frame_time_ns, coded.length_exponent), rig_apart);
        let made = made.and_then(|bytes| within(&bytes).map(|()| bytes));
        let bytes = match made {
            Ok(bytes) => bytes,
            Err(error) if keys == UseKeys::Always => {
                return Err(Error::bound(format!("there is no key clip of this motion: {error:#}"))
                    .remedy(Remedy::AllowSegments)
                    .into());
            }
            Err(error) => {
                let text = format!("keys: segments, for there is no key clip of this motion: {error:#}");
                notes.push(Note::info(NoteKind::Keys, text));
                return Ok(None);
            }
        };
        let [own, other] = [bytes.len(), by_segments.len()];
        let written = keys == UseKeys::Always || own < other;
        let text = match written {
            true => format!("keys: a key clip of {own} bytes; segments within the bound would take {other} bytes"),
            false => format!("keys: segments within the bound, {other} bytes; a key clip would take {own} bytes"),
        };
        let note = Note::info(NoteKind::Keys, text);
        notes.push(if written && keys == UseKeys::IfSmaller { note.remedy(Remedy::WriteSegments) } else { note });
        Ok(written.then_some(bytes))
    }

    /// The clip's bytes, with the index that was asked for; a note says what it costs.
    fn file(&self, coded: &Coded, notes: &mut Vec<Note>) -> Result<Vec<u8>> {
        let Options { rig_apart, index, memory, .. } = self.options;
        let plain = clip::encode(coded, &self.rig, rig_apart)?;
        let Some(seconds) = index else { return Ok(plain) };
        let spacing = (seconds * 1e9 / f64::from(coded.frame_time_ns)).round();
        let frame = f64::from(coded.frame_time_ns) * 1e-9;
        let refusal = || {
            let (given, most) = (Number(seconds), frame * f64::from(MAX_FRAMES));
            let text = format!("expected seconds, from {frame} (a frame) to {most} ({MAX_FRAMES} frames)");
            Error::value(Setting::Index, given, text)
        };
        require!((1.0..=f64::from(MAX_FRAMES)).contains(&spacing), refusal());
        let bytes = clip::encode_with_index(coded, &self.rig, rig_apart, spacing as u32, memory)?;
        let cost = bytes.len() - plain.len();
        let part = 100.0 * cost as f64 / plain.len() as f64;
        let text = format!("index: a snapshot each {spacing} frames costs {cost} bytes ({part:.1} % more)");
        notes.push(Note::info(NoteKind::Index, text));
        Ok(bytes)
    }
}

/// The cheapest coding for motions of one rig together, by the options of the first.
pub fn shared_coding(prepared: &[Prepared]) -> Coding {
    let of = |prepared: &Prepared| match &prepared.bound {
        Bound::Distance(distance) => (distance.plan(prepared.options.effort).bound, prepared.options.rotations),
        // Bounds of channels are bounds of the file's own angles.
        Bound::Channels(_) => (PoseBound::places(f64::INFINITY), Rotations::Euler),
    };
    let rotations = prepared.first().map_or(Rotations::Euler, |first| of(first).1);
    let motions: Vec<_> = prepared.iter().map(|prepared| (&prepared.motion, of(prepared).0)).collect();
    Coding::of(&motions, rotations)
}

/// Lets motions of one figure share the direction that is vertical in most of them: a guess may fail for a motion on the floor.
/// `given` says that the user stated it, so that nothing is changed.
pub fn agree_on_up(prepared: &mut [Prepared], given: bool) -> Result<Option<Note>, Error> {
    let count = |up| prepared.iter().filter(|prepared| prepared.motion.rig.up == up).count();
    let most = prepared.iter().map(|prepared| prepared.motion.rig.up).max_by_key(|&up| (count(up), std::cmp::Reverse(up.byte())));
    let Some(most) = most.filter(|&up| !given && count(up) < prepared.len()) else { return Ok(None) };
    let (others, all) = (prepared.len() - count(most), prepared.len());
    for prepared in prepared {
        prepared.set_up(most)?;
    }
    let text = format!("up: {others} of {all} motions look as if another axis were up; all take {}", up::text(most));
    Ok(Some(Note::info(NoteKind::Up, text)))
}

/// Refuses motions of different rigs. `labels` name the motions, and `why` says what needs one rig.
pub fn of_one_rig(prepared: &[Prepared], labels: &[String], why: &str) -> Result<(), Error> {
    let compare = |first: &Prepared, label: &String, other: &Prepared| -> Result<()> {
        let found = difference(&first.motion.rig, &other.motion.rig).with_context(|| label.clone())?;
        match found {
            Some(found) => Err(Error::source(format!("{label}: another rig than {}: {found}; {why}", labels[0])).into()),
            None => Ok(()),
        }
    };
    let Some(first) = prepared.first() else { return Ok(()) };
    let mut others = labels.iter().zip(prepared).skip(1);
    others.try_for_each(|(label, other)| compare(first, label, other)).map_err(|error| Error::of(&error, Error::source))
}
