//! Our own walk and run have the shape the paper's had (docs/METHOD.md 2.6), and they walk and run.

use pantin_convert::encode::{clip, rig};
use pantin_convert::fit::{fit, level::Level};
use pantin_convert::fk;
use pantin_convert::import::ImportOptions;
use pantin_convert::motion::{Keys, Motion};
use pantin_convert::pose_bound::PoseBound;
use std::path::{Path, PathBuf};

/// The way forward.
const FORWARD: &str = "root.Zposition";
/// A foot stands while it is within this of its lowest height, in cm.
const NEAR: f64 = 2.0;

struct Clip {
    motion: Motion,
    /// World positions in cm: frame, joint.
    places: Vec<Vec<[f64; 3]>>,
    /// Way forward of one round.
    stride: f64,
}

fn motions(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../motions/{name}.keys"))
}

fn load(name: &str) -> Clip {
    let motion = crate::told::load(&motions(name), &ImportOptions::new()).unwrap().motion;
    let places: Vec<_> = (0..motion.frames).map(|frame| fk::positions(&motion.rig, &motion.values, frame)).collect();
    let forward = channel(&motion, FORWARD);
    let stride = (forward[1] - forward[0]) * motion.frames as f64;
    Clip { motion, places, stride }
}

impl Clip {
    fn joint(&self, name: &str) -> usize {
        (0..self.motion.rig.joints.len()).find(|&joint| self.motion.rig.joint_name(joint) == name).unwrap()
    }

    /// Place of a joint in any frame of the endless motion.
    fn place(&self, joint: usize, frame: usize) -> [f64; 3] {
        let [x, y, z] = self.places[frame % self.motion.frames][joint];
        [x, y, z + self.stride * (frame / self.motion.frames) as f64]
    }

    fn track(&self, joint: usize, axis: usize) -> Vec<f64> {
        self.places.iter().map(|frame| frame[joint][axis]).collect()
    }

    /// How far ahead of the hips, in every frame.
    fn ahead(&self, joint: usize) -> Vec<f64> {
        let hips = self.joint("hips");
        self.places.iter().map(|frame| frame[joint][2] - frame[hips][2]).collect()
    }

    /// The points of a foot that touch the floor: ball, tip of the toes, heel.
    fn sole(&self, side: &str) -> Vec<usize> {
        let ends = ["foot/end", "toes", "toes/end"].map(|part| self.joint(&format!("{side}-{part}")));
        ends.to_vec()
    }

    fn frames_near(&self, joint: usize) -> Vec<bool> {
        let heights = self.track(joint, 1);
        let lowest = heights.iter().copied().fold(f64::MAX, f64::min);
        heights.into_iter().map(|y| y < lowest + NEAR).collect()
    }

    /// Farthest that a point of a standing foot moves over the floor while it stands.
    fn slide(&self, joint: usize) -> f64 {
        let near = self.frames_near(joint);
        let count = near.len();
        let lifted = near.iter().position(|&near| !near).unwrap();
        let mut from = None;
        let mut slide: f64 = 0.0;
        for frame in lifted..lifted + count {
            if !near[frame % count] {
                from = None;
                continue;
            }
            let start = *from.get_or_insert(frame);
            for other in start..frame {
                let (a, b) = (self.place(joint, other), self.place(joint, frame));
                slide = slide.max((a[0] - b[0]).hypot(a[2] - b[2]));
            }
        }
        slide
    }
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (ma, mb) = (mean(a), mean(b));
    let product = |x: &[f64], mx: f64, y: &[f64], my: f64| x.iter().zip(y).map(|(x, y)| (x - mx) * (y - my)).sum::<f64>();
    product(a, ma, b, mb) / (product(a, ma, a, ma) * product(b, mb, b, mb)).sqrt()
}

fn max(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::MIN, f64::max)
}

fn min(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::MAX, f64::min)
}

fn channel<'a>(motion: &'a Motion, name: &str) -> &'a [f64] {
    let index = (0..motion.rig.channels()).find(|&index| motion.rig.channel_name(index) == name).unwrap();
    &motion.values[index]
}

/// Frames and moving channels; each channel that moves has `key_frames` rows in the file.
fn has_shape(name: &str, motion: &Motion, frames: usize, key_frames: usize) {
    assert_eq!(motion.frames, frames);
    assert!(motion.looped);
    let moving: Vec<usize> =
        (0..motion.values.len()).filter(|&index| max(&motion.values[index]) - min(&motion.values[index]) > 0.5).collect();
    assert!((20..=24).contains(&moving.len()), "{} channels move", moving.len());
    for (index, values) in motion.values.iter().enumerate() {
        assert!(moving.contains(&index) || max(values) == min(values), "{} hardly moves", motion.rig.channel_name(index));
        assert!(!moving.contains(&index) || matches!(motion.keys[index], Some(Keys::OnFrames { .. })), "channel {index}");
    }
    let text = std::fs::read_to_string(motions(name)).unwrap();
    for keys in text.split("\nkeys ").skip(1) {
        let rows = keys.lines().skip(1).filter(|line| line.trim().starts_with(|first: char| first.is_ascii_digit()));
        assert_eq!(rows.count(), key_frames, "{}", keys.lines().next().unwrap());
    }
}

/// What a walk and a run have in common.
fn goes_on_two_legs(clip: &Clip) {
    let height = pantin_convert::import::units::rest_height_cm(&clip.motion);
    assert!((150.0..180.0).contains(&height), "{height} cm");
    let [left, right] = ["left", "right"].map(|side| clip.ahead(clip.joint(&format!("{side}-foot"))));
    let swaps = (0..left.len()).filter(|&i| (left[i] > right[i]) != (left[(i + 1) % left.len()] > right[(i + 1) % left.len()]));
    assert_eq!(swaps.count(), 2, "each foot passes the other once a stride");
    assert!(correlation(&left, &right) < -0.7);
    for (side, other) in [("left", "right"), ("right", "left")] {
        for joint in clip.sole(side) {
            let name = clip.motion.rig.joint_name(joint);
            assert!(clip.slide(joint) < 3.0, "{name} slides {} cm", clip.slide(joint));
            assert!(min(&clip.track(joint, 1)) > -1.5, "{name} sinks to {} cm", min(&clip.track(joint, 1)));
            println!("{name}: slides {:.2} cm, lowest {:.2} cm", clip.slide(joint), min(&clip.track(joint, 1)));
        }
        let against =
            correlation(&clip.ahead(clip.joint(&format!("{side}-hand"))), &clip.ahead(clip.joint(&format!("{side}-foot"))));
        let along =
            correlation(&clip.ahead(clip.joint(&format!("{side}-hand"))), &clip.ahead(clip.joint(&format!("{other}-foot"))));
        assert!(against < -0.7 && along > 0.7, "{side} arm: {against} with its leg, {along} with the other");
        let ball = clip.joint(&format!("{side}-toes"));
        let lifts = max(&clip.track(ball, 1)) - min(&clip.track(ball, 1));
        assert!(lifts > 8.0, "{side} foot rises by {lifts} cm only");
    }
}

/// Lowest point of a foot above the floor, in every frame.
fn clearance(clip: &Clip, side: &str) -> Vec<f64> {
    let tracks: Vec<Vec<f64>> = clip.sole(side).into_iter().map(|joint| clip.track(joint, 1)).collect();
    (0..clip.motion.frames).map(|frame| tracks.iter().map(|track| track[frame]).fold(f64::MAX, f64::min)).collect()
}

/// Degrees by which the middle joint of a limb is bent, in every frame: 0 is straight, whatever pose the rig rests in.
fn bend(clip: &Clip, limb: [usize; 3]) -> Vec<f64> {
    let bend = |places: &Vec<[f64; 3]>| {
        let [above, middle, below] = limb.map(|joint| places[joint]);
        let upper: [f64; 3] = std::array::from_fn(|axis| middle[axis] - above[axis]);
        let lower: [f64; 3] = std::array::from_fn(|axis| below[axis] - middle[axis]);
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        (dot(upper, lower) / (dot(upper, upper) * dot(lower, lower)).sqrt()).acos().to_degrees()
    };
    clip.places.iter().map(bend).collect()
}

fn elbow(clip: &Clip, side: &str) -> Vec<f64> {
    bend(clip, ["upper-arm", "forearm", "hand"].map(|part| clip.joint(&format!("{side}-{part}"))))
}

/// At 0.5 cm it takes no more than `most` bytes, and `least` channels at least are coded as moving.
fn costs(clip: &Clip, most: usize, least: usize) {
    let rig = rig::encode(&clip.motion.rig).unwrap();
    let coded = fit(&clip.motion, Level::DEFAULT.plan(PoseBound::places(0.5)), 0.0, &mut |_| ()).unwrap();
    let bytes = clip::encode(&coded, &rig, false).unwrap();
    let opened = pantin::Clip::new_checked(&bytes).unwrap();
    let (size, moving) = (opened.motion_len(), opened.moving());
    assert!(size <= most && moving >= least, "{size} bytes, {moving} channels move");
}

/// Over the seam no channel accelerates more than it does elsewhere.
fn loops_smoothly(clip: &Clip) {
    for (index, values) in clip.motion.values.iter().enumerate() {
        let count = values.len();
        let round = if clip.motion.rig.channel_name(index) == FORWARD { clip.stride } else { 0.0 };
        let at = |frame: usize| values[frame % count] + round * (frame / count) as f64;
        let bend = |frame: usize| (at(frame + 1) - 2.0 * at(frame) + at(frame - 1)).abs();
        let inside = (1..count - 1).map(bend).fold(0.0, f64::max);
        let seam = bend(count - 1).max(bend(count));
        assert!(seam <= 1.5 * inside + 1e-9, "{}: {seam} at the seam, {inside} inside", clip.motion.rig.channel_name(index));
    }
}

#[test]
fn the_walk_is_a_walk() {
    let clip = load("walk");
    has_shape("walk", &clip.motion, 160, 5);
    costs(&clip, 170, 20);
    assert_eq!(clip.motion.frame_time, 1.0 / 120.0);
    goes_on_two_legs(&clip);
    loops_smoothly(&clip);
    let [left, right] = ["left", "right"].map(|side| clearance(&clip, side));
    let on_floor = left.iter().zip(&right).all(|(left, right)| left.min(*right) < 1.5);
    assert!(on_floor, "one foot is always on the floor");
    let both = left.iter().zip(&right).filter(|(left, right)| left.max(**right) < 1.5).count();
    assert!((8..60).contains(&both), "{both} frames on both feet");
    for side in ["left", "right"] {
        let knee = channel(&clip.motion, &format!("{side}-shin.Xrotation"));
        assert!(max(knee) > 50.0 && min(knee) > 0.0, "{side} knee {} to {}", min(knee), max(knee));
        assert!(max(&elbow(&clip, side)) < 45.0, "{side} elbow bent by {}", max(&elbow(&clip, side)));
    }
}

#[test]
fn the_run_is_a_run() {
    let clip = load("run");
    has_shape("run", &clip.motion, 26, 4);
    costs(&clip, 120, 16);
    goes_on_two_legs(&clip);
    loops_smoothly(&clip);
    let [left, right] = ["left", "right"].map(|side| clearance(&clip, side));
    let air: Vec<bool> = left.iter().zip(&right).map(|(left, right)| left.min(*right) > 1.5).collect();
    let flights = (0..air.len()).filter(|&frame| air[frame] && !air[(frame + 1) % air.len()]).count();
    assert_eq!(flights, 2, "two flights a stride: {air:?}");
    assert!(left.iter().zip(&right).all(|(left, right)| left.max(*right) > NEAR), "never on both feet");
    for side in ["left", "right"] {
        let knee = channel(&clip.motion, &format!("{side}-shin.Xrotation"));
        assert!(max(knee) > 90.0 && min(knee) > 0.0, "{side} knee {} to {}", min(knee), max(knee));
        let bends = elbow(&clip, side);
        assert!(min(&bends) > 60.0 && max(&bends) < 130.0, "{side} elbow bent by {} to {}", min(&bends), max(&bends));
    }
    assert!(min(&clip.ahead(clip.joint("head"))) > 5.0, "leans forward");
}

/// Its clip is for whoever reads a knee's angle: the rig names three Euler angles, the clip holds an exponential map.
#[test]
fn the_knees_bend_and_are_coded_as_exponential_maps() {
    let motion = crate::told::load(&motions("kneebend"), &ImportOptions::new()).unwrap().motion;
    let places: Vec<_> = (0..motion.frames).map(|frame| fk::positions(&motion.rig, &motion.values, frame)).collect();
    let clip = Clip { motion, places, stride: 0.0 };
    loops_smoothly(&clip);
    let bytes = std::fs::read(motions("kneebend").with_extension("ptn")).unwrap();
    let coded = pantin::Clip::new_checked(&bytes).unwrap();
    assert_eq!(coded.frames() as usize, clip.motion.frames);
    for side in ["left", "right"] {
        let shin = clip.joint(&format!("{side}-shin"));
        assert!(clip.motion.rig.joints[shin].kinds.iter().all(|kind| kind.is_rotation()));
        assert!(coded.is_exponential(shin), "{side}-shin");
        let angles = ["Z", "Y", "X"].map(|axis| channel(&clip.motion, &format!("{side}-shin.{axis}rotation")));
        let swing = angles.map(|angles| max(angles) - min(angles));
        assert!(swing[0] > 30.0 && swing[1] > 20.0 && swing[2] > 50.0, "{swing:?}");
        let bends = bend(&clip, ["thigh", "shin", "foot"].map(|part| clip.joint(&format!("{side}-{part}"))));
        assert!(min(&bends) < 10.0 && max(&bends) > 80.0, "{side} knee bent by {} to {}", min(&bends), max(&bends));
        for sole in clip.sole(side) {
            let moved = [0, 1, 2].map(|axis| max(&clip.track(sole, axis)) - min(&clip.track(sole, axis)));
            assert!(moved.iter().all(|&cm| cm < 0.5), "{}: moves by {moved:?} cm", clip.motion.rig.joint_name(sole));
        }
    }
}

/// What one motion holds all along is no saving if the rig holds it instead: both have the same.
#[test]
fn both_move_one_figure() {
    assert_eq!(load("walk").motion.rig, load("run").motion.rig);
}

#[test]
fn both_come_back_from_bvh() {
    let path = std::env::temp_dir().join(format!("pantin-own-motions-{}.bvh", std::process::id()));
    for name in ["walk", "run"] {
        let motion = load(name).motion;
        pantin_tools::output::save_bvh(&motion, &path).unwrap();
        let back = crate::told::load(&path, &ImportOptions::new()).unwrap().motion;
        assert_eq!(back.rig, motion.rig, "{name}: joints, and the unit guessed");
        let pairs = motion.values.iter().flatten().zip(back.values.iter().flatten());
        let far = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(far <= 5e-8 + 1e-12 && back.frames == motion.frames, "{name}: {far}");
    }
    std::fs::remove_file(&path).unwrap();
}
