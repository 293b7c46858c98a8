//! A body that is captured now: what a sender says becomes a pose a frame. Time is counted in frames; nothing here reads a clock.
//!
//! A sender that is silent leaves the figure in its last pose, and after [`HELD_SECONDS`] the figure eases to the first frame of its clip. While a sender is
//! heard, datagrams of others are passed over. Nothing that comes can end a session: what is wrong is left out, counted, and logged the first time.

use super::turns::{IDENTITY, Turn, inverse, product};
use super::vmc::{DISPLAY, Odd, Vmc};
use anyhow::{Context, Result, ensure};
use pantin::{Clip, Up};
use pantin_convert::Posing;
use pantin_convert::fk::rotations;
use pantin_convert::import::{BvhStream, one_line};
use std::collections::HashSet;
use std::net::SocketAddr;
use std::path::Path;

/// A sender counts as silent after this time, in seconds, and gives its place to another one.
pub const SILENT_SECONDS: f64 = 0.5;
/// The last pose of a silent sender is held for this time, in seconds.
pub const HELD_SECONDS: f64 = 2.0;
/// The figure returns to rest within this time, in seconds.
pub const EASE_SECONDS: f64 = 1.0;
/// The most names and senders that get a line in the log: an enemy may send any number.
const MOST_LOGGED: usize = 20;

/// Where poses come from.
enum Source {
    Vmc { vmc: Vmc, joints: Vec<(usize, &'static str)> },
    Bvh { stream: BvhStream, joints: Vec<(usize, usize)>, ended: bool },
}

/// A body's pose, frame by frame.
pub struct Body {
    posing: Posing,
    source: Source,
    frame_seconds: f64,
    rest: Vec<i32>,
    shown: Vec<i32>,
    /// The pose that a silent sender left.
    held: Vec<i32>,
    sender: Option<SocketAddr>,
    /// Frames since something was heard; `None` before the first time.
    silent: Option<u32>,
    news: bool,
    left_out: u32,
    logged: HashSet<String>,
    log: Vec<String>,
}

impl Body {
    /// A body that VMC datagrams move, for a clip of the receiver's figure. The figure must have y up; with all angles at 0 it should stand with its arms out,
    /// looking along z. Fails for another direction up, and if no joint has the name of a humanoid's bone.
    pub fn vmc(clip: &Clip<'_>) -> Result<Body> {
        let posing = Posing::new(clip)?;
        ensure!(posing.up() == Up::Y, "the clip's figure has another direction up than y, and VMC senders have y");
        let own = posing.joints().iter().map(|joint| joint.name.as_str());
        let named = own.enumerate().filter_map(|(joint, name)| Some((joint, Vmc::bone_named(name)?)));
        let mut joints: Vec<(usize, &'static str)> = named.collect();
        for (joint, bone) in posing.body_joints().into_iter().zip(DISPLAY) {
            let Some(joint) = joint else { continue };
            if !joints.iter().any(|(own, other)| *own == joint || *other == bone) {
                joints.push((joint, bone));
            }
        }
        ensure!(!joints.is_empty(), "none of the clip's joints is a bone of a humanoid by its name");
        // Parents first.
        joints.sort_unstable();
        Body::new(clip, posing, Source::Vmc { vmc: Vmc::default(), joints })
    }

    /// A body that a BVH stream moves, a row a frame: joints of one name turn alike. `name` begins the errors.
    pub fn bvh(clip: &Clip<'_>, name: &Path) -> Result<Body> {
        let source = Source::Bvh { stream: BvhStream::new(name), joints: Vec::new(), ended: false };
        Body::new(clip, Posing::new(clip)?, source)
    }

    fn new(clip: &Clip<'_>, posing: Posing, source: Source) -> Result<Body> {
        let rest = posing.raw();
        Ok(Body {
            posing,
            source,
            frame_seconds: f64::from(clip.frame_time_ns()) * 1e-9,
            shown: rest.clone(),
            held: rest.clone(),
            rest,
            sender: None,
            silent: None,
            news: false,
            left_out: 0,
            logged: HashSet::new(),
            log: Vec::new(),
        })
    }

    /// The pose's channels.
    pub fn posing(&self) -> &Posing {
        &self.posing
    }

    /// Datagrams and rows that were left out.
    pub fn left_out(&self) -> u32 {
        self.left_out
    }

    /// Returns the lines for the log since the last call.
    pub fn take_log(&mut self) -> Vec<String> {
        std::mem::take(&mut self.log)
    }

    /// Takes a datagram.
    pub fn receive(&mut self, from: SocketAddr, datagram: &[u8]) {
        let Source::Vmc { vmc, .. } = &mut self.source else { return };
        let silent = self.silent.is_none_or(|frames| f64::from(frames) * self.frame_seconds >= SILENT_SECONDS);
        if self.sender.is_some_and(|sender| sender != from) && !silent {
            self.left_out = self.left_out.saturating_add(1);
            return self
                .log_once(&format!("warning: {from}: another sender; its datagrams are left out while the first one is heard"));
        }
        match vmc.take(datagram) {
            Ok((moved, odd)) => {
                if moved {
                    self.heard(Some(from));
                }
                for odd in odd {
                    self.log_once(&match odd {
                        Odd::Bone(name) => format!("warning: {}: an unknown bone, which is left out", one_line(&name)),
                        Odd::Address(address) => {
                            format!("warning: {}: an address outside of VMC, which is left out", one_line(&address))
                        }
                    });
                }
            }
            Err(reason) => {
                self.left_out = self.left_out.saturating_add(1);
                self.log_once(&format!("warning: {from}: a datagram with {reason}, which is left out"));
            }
        }
    }

    /// Takes bytes of the stream, cut anywhere. Fails for a header whose figure or rate does not fit; damage of a row ends the stream with a line of the log.
    pub fn push(&mut self, bytes: &[u8]) -> Result<()> {
        let Source::Bvh { stream, joints, ended } = &mut self.source else { return Ok(()) };
        if *ended {
            return Ok(());
        }
        let had_head = stream.head().is_some();
        let damage = stream.push(bytes).err();
        if let Some(head) = stream.head().filter(|_| !had_head) {
            let rate = head.frame_time / self.frame_seconds;
            ensure!(
                (rate - 1.0).abs() < 0.01,
                "the stream has {:.2} frames a second, and the clip has {:.2}",
                1.0 / head.frame_time,
                1.0 / self.frame_seconds
            );
            let own = self.posing.joints();
            let place = |name: &str| own.iter().position(|joint| !joint.end_site && joint.name.eq_ignore_ascii_case(name));
            let theirs = head.rig.joints.iter().enumerate().filter(|(_, joint)| !joint.end_site);
            let mut unknown = Vec::new();
            for (index, joint) in theirs {
                match place(&joint.name) {
                    Some(own) => joints.push((own, index)),
                    None => unknown.push(one_line(&joint.name)),
                }
            }
            ensure!(!joints.is_empty(), "none of the stream's joints has the name of one of the clip's");
            if !unknown.is_empty() {
                unknown.truncate(MOST_LOGGED);
                self.log.push(format!("warning: joints that the clip's figure has not are left out: {}", unknown.join(", ")));
            }
        }
        match damage {
            // Without a header there is nothing to show.
            Some(error) if stream.head().is_none() => Err(error).context("the stream"),
            Some(error) => {
                *ended = true;
                self.left_out = self.left_out.saturating_add(1);
                self.log.push(format!("warning: {error}; the stream is left out from there on"));
                Ok(())
            }
            None => Ok(()),
        }
    }

    /// Takes the end of the stream: a row that has no line end is still shown. Fails if it ends before its first row.
    pub fn end(&mut self) -> Result<()> {
        let Source::Bvh { stream, ended, .. } = &mut self.source else { return Ok(()) };
        if std::mem::replace(ended, true) {
            return Ok(());
        }
        match stream.end() {
            Err(error) if stream.ready() == 0 && self.silent.is_none() => Err(error).context("the stream"),
            Err(error) => {
                self.log.push(format!("warning: {error}"));
                Ok(())
            }
            Ok(()) => Ok(()),
        }
    }

    /// Whether a pose has been shown that came.
    pub fn posing_has_begun(&self) -> bool {
        self.silent.is_some()
    }

    /// Whether a row waits to be shown.
    pub fn has_row(&self) -> bool {
        matches!(&self.source, Source::Bvh { stream, .. } if stream.ready() > 0)
    }

    /// Whether a damaged stream has ended and the figure has come to rest.
    pub fn is_over(&self) -> bool {
        let quiet = self.silent.is_some_and(|frames| f64::from(frames) * self.frame_seconds > HELD_SECONDS + EASE_SECONDS);
        matches!(&self.source, Source::Bvh { stream, ended: true, .. } if stream.ready() == 0) && quiet
    }

    /// The pose of the next frame: what came last, or what is left of it.
    pub fn pose(&mut self) -> Vec<i32> {
        self.take_row();
        if std::mem::take(&mut self.news) {
            self.apply();
            self.shown = self.posing.raw();
            self.held.clone_from(&self.shown);
            self.silent = Some(0);
            return self.shown.clone();
        }
        let Some(silent) = &mut self.silent else { return self.shown.clone() };
        *silent = silent.saturating_add(1);
        let seconds = f64::from(*silent) * self.frame_seconds;
        let passed = |limit: f64| seconds >= limit && seconds - self.frame_seconds < limit;
        if passed(SILENT_SECONDS) {
            self.log.push(format!("warning: nothing has come for {SILENT_SECONDS} s; the last pose is held"));
        }
        if passed(HELD_SECONDS) {
            self.log.push(format!("warning: nothing has come for {HELD_SECONDS} s; the figure returns to rest"));
        }
        if seconds > HELD_SECONDS {
            let part = ((seconds - HELD_SECONDS) / EASE_SECONDS).min(1.0);
            let eased = part * part * (3.0 - 2.0 * part);
            let between = |((held, rest), wraps): ((&i32, &i32), bool)| {
                let way = if wraps { i64::from(rest.wrapping_sub(*held)) } else { i64::from(*rest) - i64::from(*held) };
                (i64::from(*held) + (way as f64 * eased).round() as i64) as i32
            };
            self.shown = self.held.iter().zip(&self.rest).zip(self.posing.wraps()).map(between).collect();
        }
        self.shown.clone()
    }

    fn heard(&mut self, from: Option<SocketAddr>) {
        if self.sender != from {
            self.log.extend(from.map(|from| format!("{from}: its poses are shown")));
            self.sender = from;
        }
        (self.news, self.silent) = (true, Some(0));
    }

    fn log_once(&mut self, line: &str) {
        if self.logged.len() < MOST_LOGGED && self.logged.insert(line.into()) {
            self.log.push(line.into());
        }
    }

    fn take_row(&mut self) {
        if self.has_row() {
            self.news = true;
        }
    }

    /// Puts what came last on the rig.
    fn apply(&mut self) {
        let posing = &mut self.posing;
        match &mut self.source {
            Source::Vmc { vmc, joints } => {
                let mut worlds: Vec<Turn> = Vec::with_capacity(posing.joints().len());
                for joint in 0..posing.joints().len() {
                    let above = posing.joints()[joint].parent.map_or(IDENTITY, |parent| worlds[parent]);
                    let bone = joints.iter().find(|(own, _)| *own == joint).map(|(_, bone)| *bone);
                    worlds.push(bone.map_or(above, |bone| vmc.world(bone)));
                    // Joints between bones keep what the bones say about those below them.
                    posing.set_turn(joint, product(inverse(above), worlds[joint]));
                }
                let hips = joints.iter().find(|(_, bone)| *bone == "Hips").map(|(joint, _)| *joint);
                if let (Some(hips), Some(metres)) = (hips, vmc.place()) {
                    let units = 100.0 / posing.cm_per_unit();
                    posing.set_place(hips, metres.map(|metre| metre * units));
                }
            }
            Source::Bvh { stream, joints, .. } => {
                let row = stream.take(1);
                let Some(head) = stream.head() else { return };
                let (rig, turns) = (&head.rig, rotations(&head.rig, &row, 0));
                let first = rig.first_channels();
                for &(own, theirs) in joints.iter() {
                    posing.set_turn(own, turns[theirs]);
                    let mut place = rig.joints[theirs].offset;
                    for (slot, kind) in rig.joints[theirs].kinds.iter().enumerate().filter(|(_, kind)| kind.is_position()) {
                        if let (Some(axis), Some(value)) =
                            (kind.axis(), row.get(first[theirs] + slot).and_then(|values| values.first()))
                        {
                            place[axis] = *value;
                        }
                    }
                    if rig.joints[theirs].kinds.iter().any(|kind| kind.is_position()) {
                        posing.set_place(own, place);
                    }
                }
            }
        }
    }
}
