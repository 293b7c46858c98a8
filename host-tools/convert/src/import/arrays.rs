//! A motion that a program holds as arrays: a rotation and a place of every joint at every frame, and scalars.

use super::{Imported, angles, ends, helpers, scalars, unwrap_angles};
use crate::fk::{self, Matrix, distance, from_quaternion};
use crate::memory::Memory;
use crate::motion::{Joint, Kind, Motion, Rig, Scalar, Up};
use crate::note::{Note, NoteKind};
use anyhow::{Result, ensure};
use pantin::codec::layout::{MAX_FRAMES, MAX_JOINTS};

/// Places that waver by less than this part of the greatest one are constant: programs compute them in f32.
const STANDS: f64 = 2e-7;
/// No length of a real motion comes near it.
const LARGEST: f64 = 1e9;
/// Shorter quaternions have no direction.
const SHORTEST: f64 = 1e-6;

/// A joint, or an End Site.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Its name; an End Site needs none.
    pub name: String,
    /// Index of its parent, smaller than its own; `None` for a root.
    pub parent: Option<usize>,
    /// Where it stands in its parent, if there are no places.
    pub offset: [f64; 3],
    /// Whether it is only a bone's end: its rotations do not count.
    pub end_site: bool,
}

/// The arrays.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrays {
    /// Parents before children.
    pub joints: Vec<Entry>,
    /// Rotation of each joint in its parent, as a quaternion w, x, y, z of any length: all joints of frame 0, then those of frame 1.
    pub rotations: Vec<[f64; 4]>,
    /// Place of each joint in its parent, in the same order; empty if every joint stays at its offset.
    pub places: Vec<[f64; 3]>,
    /// Scalars, each with a value a frame. A full scale of 0 stands for the greatest value.
    pub scalars: Vec<(Scalar, Vec<f64>)>,
    /// Number of frames.
    pub frames: usize,
    /// Frames a second.
    pub rate: f64,
    /// Length of the unit of places in cm.
    pub cm_per_unit: f64,
    /// The direction of the world that is vertical.
    pub up: Up,
    /// The memory that the motion may take.
    pub memory: Memory,
}

impl Arrays {
    /// The motion. Several roots get a joint `root` above them, and a leaf that turns gets an End Site. Fails where arrays do not fit together or
    /// numbers are not finite, and names the joint and the frame.
    pub fn motion(mut self) -> Result<Imported> {
        self.check()?;
        self.join_roots();
        let count = self.joints.len();
        let worlds: Vec<Vec<[f64; 3]>> = (0..self.frames).map(|frame| self.worlds(frame)).collect();
        let wavers = STANDS * worlds.iter().flatten().flatten().fold(0.0, |largest: f64, x| largest.max(x.abs()));
        let (mut joints, mut values) = (Vec::with_capacity(count), Vec::new());
        for (index, Entry { name, parent, end_site, .. }) in self.joints.iter().enumerate() {
            let (offset, places) = self.places(index, wavers);
            let locals: Vec<Matrix> = match end_site {
                true => Vec::new(),
                false => (0..self.frames).map(|frame| from_quaternion(self.rotations[frame * count + index])).collect(),
            };
            let turns = if *end_site { Vec::new() } else { angles::channels(&locals) };
            let (kinds, channels): (Vec<Kind>, Vec<Vec<f64>>) = places.into_iter().chain(turns).unzip();
            values.extend(channels);
            joints.push(Joint { name: name.clone(), parent: *parent, offset, kinds, end_site: *end_site, helper: false });
        }
        let mut notes: Vec<Note> = ends::complete(&mut joints).into_iter().collect();
        let (mut scalars, of_scalars): (Vec<Scalar>, Vec<Vec<f64>>) = std::mem::take(&mut self.scalars).into_iter().unzip();
        scalars
            .iter_mut()
            .zip(&of_scalars)
            .for_each(|(scalar, values)| scalar.full_scale = scalar.full_scale.max(scalars::peak(values)));
        values.extend(of_scalars);
        let mut rig = Rig { joints, scalars, cm_per_unit: self.cm_per_unit, up: self.up };
        helpers::mark(&mut rig);
        let keys = vec![None; values.len()];
        let mut motion = Motion {
            rig,
            frame_time: 1.0 / self.rate,
            frames: self.frames,
            values,
            keys,
            looped: false,
            events: Vec::new(),
            origin: Default::default(),
        };
        unwrap_angles(&mut motion);
        let far = |(frame, worlds): (usize, &Vec<[f64; 3]>)| {
            let found = fk::positions(&motion.rig, &motion.values, frame);
            let pairs = worlds.iter().zip(found);
            pairs.map(|(world, found)| distance(world.map(|x| x * self.cm_per_unit), found)).fold(0.0, f64::max)
        };
        let error_cm = worlds.iter().enumerate().map(far).fold(0.0, f64::max);
        motion.origin.error_cm = error_cm;
        notes.push(Note::info(NoteKind::Unit, format!("the unit is {} cm, as given", self.cm_per_unit)));
        Ok(Imported { motion, notes })
    }

    fn check(&self) -> Result<()> {
        let Arrays { joints, rotations, places, frames, .. } = self;
        ensure!((1..=MAX_FRAMES as usize).contains(frames), "{frames} frames; a clip holds 1 to {MAX_FRAMES}");
        ensure!(!joints.is_empty() || !self.scalars.is_empty(), "neither joints nor scalars");
        ensure!(joints.len() < MAX_JOINTS, "{} joints; a rig holds fewer than {MAX_JOINTS}", joints.len());
        ensure!(self.rate.is_finite() && self.rate > 0.0, "a rate of {}: expected frames a second, above 0", self.rate);
        ensure!(self.cm_per_unit > 0.0 && self.cm_per_unit < LARGEST, "a unit of {} cm", self.cm_per_unit);
        self.memory.check(*frames, 6 * joints.len() + self.scalars.len())?;
        let count = frames * joints.len();
        ensure!(rotations.len() == count, "{} rotations for {frames} frames of {} joints", rotations.len(), joints.len());
        ensure!(
            places.is_empty() || places.len() == count,
            "{} places for {frames} frames of {} joints",
            places.len(),
            joints.len()
        );
        for (index, joint) in joints.iter().enumerate() {
            let name = &joint.name;
            ensure!(joint.parent.is_none_or(|parent| parent < index), "joint `{name}` stands before its parent");
            ensure!(joint.parent.is_some() || !joint.end_site, "the root `{name}` is an End Site");
            ensure!(joint.parent.is_none_or(|parent| !joints[parent].end_site), "the parent of joint `{name}` is an End Site");
            ensure!(joint.offset.iter().all(|x| x.abs() < LARGEST), "the offset of joint `{name}` is not below {LARGEST:e}");
        }
        let at = |index: usize| format!("joint `{}` at frame {}", joints[index % joints.len()].name, index / joints.len());
        for (index, turn) in rotations.iter().enumerate().filter(|(index, _)| !joints[index % joints.len()].end_site) {
            let length = turn.iter().map(|x| x * x).sum::<f64>();
            ensure!((SHORTEST..LARGEST).contains(&length), "the rotation of {} has a squared length of {length}", at(index));
        }
        for (index, place) in places.iter().enumerate() {
            ensure!(place.iter().all(|x| x.abs() < LARGEST), "the place of {} is not below {LARGEST:e}", at(index));
        }
        for (Scalar { name, full_scale }, values) in &self.scalars {
            ensure!(values.len() == *frames, "scalar `{name}` has {} values for {frames} frames", values.len());
            ensure!((0.0..LARGEST).contains(full_scale), "scalar `{name}` has a full scale of {full_scale}");
            let wrong = values.iter().position(|x| x.is_nan() || x.abs() >= LARGEST);
            ensure!(wrong.is_none(), "scalar `{name}` at frame {} is not below {LARGEST:e}", wrong.unwrap_or_default());
        }
        Ok(())
    }

    /// Puts a joint above several roots.
    fn join_roots(&mut self) {
        if self.joints.iter().filter(|joint| joint.parent.is_none()).count() < 2 {
            return;
        }
        let count = self.joints.len();
        self.joints.iter_mut().for_each(|joint| joint.parent = Some(joint.parent.map_or(0, |parent| parent + 1)));
        self.joints.insert(0, Entry { name: "root".into(), parent: None, offset: [0.0; 3], end_site: false });
        self.rotations = with_first(&self.rotations, count, [1.0, 0.0, 0.0, 0.0]);
        self.places = with_first(&self.places, count, [0.0; 3]);
    }

    fn place(&self, joint: usize, frame: usize) -> [f64; 3] {
        self.places.get(frame * self.joints.len() + joint).copied().unwrap_or(self.joints[joint].offset)
    }

    /// Where the arrays put every joint at a frame, in their unit.
    fn worlds(&self, frame: usize) -> Vec<[f64; 3]> {
        let joints = self.joints.iter().enumerate().map(|(index, joint)| {
            let turn = from_quaternion(self.rotations[frame * self.joints.len() + index]);
            (joint.parent, (turn, self.place(index, frame)))
        });
        fk::worlds(joints).into_iter().map(|(_, place)| place).collect()
    }

    /// The offset of a joint, and the position channels along the axes on which it moves.
    fn places(&self, joint: usize, wavers: f64) -> ([f64; 3], Vec<(Kind, Vec<f64>)>) {
        let mut offset = [0.0; 3];
        let mut channels = Vec::new();
        for (axis, kind) in [Kind::Xposition, Kind::Yposition, Kind::Zposition].into_iter().enumerate() {
            let values: Vec<f64> = (0..self.frames).map(|frame| self.place(joint, frame)[axis]).collect();
            let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(low, high), &x| (low.min(x), high.max(x)));
            offset[axis] = (low + high) / 2.0;
            if high - low > 2.0 * wavers {
                channels.push((kind, values));
            }
        }
        (offset, channels)
    }
}

/// Frames of `count` values with one more before them.
fn with_first<const N: usize>(values: &[[f64; N]], count: usize, first: [f64; N]) -> Vec<[f64; N]> {
    values.chunks(count).flat_map(|frame| std::iter::once(first).chain(frame.iter().copied())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(name: &str, parent: Option<usize>, offset: [f64; 3]) -> Entry {
        Entry { name: name.into(), parent, offset, end_site: name.is_empty() }
    }

    /// An arm that turns about x, on a body that moves along x.
    fn arm() -> Arrays {
        let joints =
            vec![entry("body", None, [0.0; 3]), entry("arm", Some(0), [0.0, 10.0, 0.0]), entry("", Some(1), [0.0, 0.0, 5.0])];
        let turn = |frame: usize| [f64::cos(0.1 * frame as f64), f64::sin(0.1 * frame as f64), 0.0, 0.0].map(|x| 3.0 * x);
        let still = [1.0, 0.0, 0.0, 0.0];
        Arrays {
            rotations: (0..20).flat_map(|frame| [still, turn(frame), still]).collect(),
            places: (0..20).flat_map(|frame| [[frame as f64, 0.0, 0.0], joints[1].offset, joints[2].offset]).collect(),
            joints,
            scalars: vec![(Scalar { name: "smile".into(), full_scale: 0.0 }, vec![-0.5; 20])],
            frames: 20,
            rate: 25.0,
            cm_per_unit: 2.0,
            up: Up::Y,
            memory: Memory::default(),
        }
    }

    #[test]
    fn arrays_become_channels_of_what_moves() {
        let Imported { motion, .. } = arm().motion().unwrap();
        let kinds: Vec<Vec<Kind>> = motion.rig.joints.iter().map(|joint| joint.kinds.clone()).collect();
        assert_eq!(kinds, [vec![Kind::Xposition], vec![Kind::Xrotation], vec![]]);
        assert!(motion.origin.error_cm < 1e-12, "{}", motion.origin.error_cm);
        assert!((motion.values[1][19] - (3.8f64).to_degrees()).abs() < 1e-9);
        let [w, x, ..] = fk::rotations(&motion.rig, &motion.values, 5)[1];
        assert!((w / x - (0.5f64).cos() / (0.5f64).sin()).abs() < 1e-12);
        let tip = fk::positions(&motion.rig, &motion.values, 0)[2];
        assert!(distance(tip, [0.0, 20.0, 10.0]) < 1e-12, "{tip:?}");
        assert_eq!((motion.frame_time, motion.rig.scalars[0].full_scale), (0.04, 0.5));
        assert!(motion.rig.joints[2].end_site);
    }

    #[test]
    fn several_roots_hang_from_one_joint() {
        let mut arrays = arm();
        arrays.joints[1].parent = None;
        let Imported { motion, .. } = arrays.motion().unwrap();
        assert!(motion.origin.error_cm < 1e-12, "{}", motion.origin.error_cm);
        let names: Vec<&str> = motion.rig.joints.iter().map(|joint| joint.name.as_str()).collect();
        assert_eq!(names, ["root", "body", "arm", ""]);
        assert_eq!(motion.rig.joints[3].parent, Some(2));
    }

    #[test]
    fn what_does_not_fit_together_is_named() {
        type Change = fn(&mut Arrays);
        let changes: [(Change, &str); 8] = [
            (|arrays| arrays.rotations[4] = [0.0; 4], "joint `arm` at frame 1 has a squared length of 0"),
            (|arrays| arrays.rotations[4][0] = f64::NAN, "joint `arm` at frame 1"),
            (|arrays| arrays.places[3][2] = f64::INFINITY, "joint `body` at frame 1 is not below"),
            (|arrays| arrays.rotations.truncate(59), "59 rotations for 20 frames of 3 joints"),
            (|arrays| arrays.joints[1].parent = Some(1), "joint `arm` stands before its parent"),
            (|arrays| arrays.rate = 0.0, "a rate of 0"),
            (|arrays| arrays.scalars[0].1[7] = f64::NAN, "scalar `smile` at frame 7"),
            (|arrays| arrays.frames = 0, "0 frames"),
        ];
        for (change, expected) in changes {
            let mut arrays = arm();
            change(&mut arrays);
            let error = arrays.motion().unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
    }
}
