//! The figure's integers against the same in floating point: where joints are, and where they appear.

use crate::noise::Noise;
use embedded_graphics::draw_target::{DrawTarget, DrawTargetExt};
use embedded_graphics::geometry::{Point, Size};
use embedded_graphics::mock_display::MockDisplay;
use embedded_graphics::pixelcolor::BinaryColor;
use embedded_graphics::primitives::Rectangle;
use pantin::codec::layout::MAX_JOINTS;
use pantin::{Form, Kind, Pose};
use pantin_convert::motion::{Joint, Motion, Rig};
use pantin_convert::{encode, fk, import};
use pantin_figure::camera::DISTANCE;
use pantin_figure::kinematics::Kinematics;
use pantin_figure::surface::OnTarget;
use pantin_figure::{CameraTarget, Canvas, Detail, DrawStyle, FigureRenderer, Skeleton, View};
use std::path::PathBuf;

/// Room for any of the rigs.
const JOINTS: usize = 192;
const _: () = assert!(JOINTS <= MAX_JOINTS);
const CANVAS: Canvas = Canvas { width: 128, height: 64 };

/// Raw values of a frame as a clip with the rig's own step of lengths holds them.
fn pose(motion: &Motion, exponent: i8, frame: usize) -> Vec<i32> {
    let kinds = motion.rig.channel_kinds();
    let raw = |(channel, &(_, kind)): (usize, &(Option<usize>, Kind))| {
        let value = motion.values[channel][frame];
        if kind.is_position() {
            (value / f64::from(exponent).exp2()).round() as i32
        } else if kind.is_quaternion() {
            (value * f64::from(1 << 30)).round() as i32
        } else {
            (value / 360.0 * 2f64.powi(32)).round() as i64 as i32
        }
    };
    kinds.iter().enumerate().map(raw).collect()
}

/// A motion with what the figure makes of it.
struct Case {
    motion: Motion,
    bytes: Vec<u8>,
}

impl Case {
    fn new(motion: Motion) -> Case {
        let bytes = encode::rig::encode(&motion.rig).unwrap();
        Case { motion, bytes }
    }

    fn rig(&self) -> pantin::Rig<'_> {
        pantin::Rig::new_checked(&self.bytes).unwrap()
    }

    fn pose(&self, frame: usize) -> Vec<i32> {
        pose(&self.motion, self.rig().length_exponent(), frame)
    }

    fn skeleton(&self, detail: Detail) -> Skeleton<JOINTS> {
        Skeleton::new(&self.rig(), detail, Pose { values: &self.pose(0), form: (&self.form()).into() }).unwrap()
    }

    /// Every joint as the rig has it, positions in the unit of its offsets.
    fn form(&self) -> Form {
        Form::new(self.rig().id(), self.rig().length_exponent(), [])
    }

    /// True positions of a frame in figure units.
    fn truth(&self, skeleton: &Skeleton<JOINTS>, frame: usize) -> Vec<[f64; 3]> {
        let unit = f64::from(skeleton.exponent).exp2() * self.motion.rig.cm_per_unit;
        let places = fk::positions(&self.motion.rig, &self.motion.values, frame);
        places.into_iter().map(|place| place.map(|x| x / unit)).collect()
    }

    /// Greatest distance of a joint from its true place, in figure units, over every `stride`-th frame.
    fn worst(&self, stride: usize) -> f64 {
        let skeleton = self.skeleton(Detail::Full);
        let mut joints: Kinematics<JOINTS> = Kinematics::new();
        let mut worst = 0.0f64;
        for frame in (0..self.motion.frames).step_by(stride) {
            joints.set_pose(&skeleton, &self.pose(frame));
            let truth = self.truth(&skeleton, frame);
            assert_eq!(truth.len(), joints.positions().len());
            for (bone, position) in skeleton.bones.iter().zip(joints.positions()) {
                worst = worst.max(distance(position.map(f64::from), truth[usize::from(bone.joint)]));
            }
        }
        worst
    }

    fn renderer(&self, view: View) -> FigureRenderer<JOINTS> {
        let stride = self.motion.frames.div_ceil(48);
        FigureRenderer::new(self.skeleton(Detail::Full), CANVAS, view, |visit| {
            (0..self.motion.frames).step_by(stride).for_each(|frame| visit(&self.pose(frame)));
        })
    }

    /// Greatest distance in pixels of a joint on the display from where a camera in real numbers puts its true place.
    fn worst_pixel(&self, view: View, stride: usize) -> f64 {
        let mut renderer = self.renderer(view);
        let mut worst = 0.0f64;
        for frame in (0..self.motion.frames).step_by(stride) {
            renderer.set_pose(Pose { values: &self.pose(frame), form: (&self.form()).into() }).unwrap();
            let hips = renderer.skeleton().hips;
            let target = renderer.target();
            let truth = self.truth(renderer.skeleton(), frame);
            // A joint above the hips only says where the clip began: it may be far away.
            let root = truth[usize::from(renderer.skeleton().bones[hips].joint)];
            for (bone, position) in renderer.skeleton().bones.iter().zip(renderer.joints().positions()).skip(hips) {
                let got = renderer.camera().project(*position);
                let want = project(&renderer, view, root, target, truth[usize::from(bone.joint)]);
                worst = worst.max((f64::from(got.x) - want[0]).hypot(f64::from(got.y) - want[1]) / 16.0);
            }
        }
        worst
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| a[axis] * b[axis]).sum()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[(axis + 1) % 3] * b[(axis + 2) % 3] - a[(axis + 2) % 3] * b[(axis + 1) % 3])
}

/// A perspective camera in real numbers: sixteenths of a pixel. Along the axes that the camera follows, the target is the
/// true place of the hips.
fn project(renderer: &FigureRenderer<JOINTS>, view: View, hips: [f64; 3], target: [i32; 3], place: [f64; 3]) -> [f64; 2] {
    let unit = |v: [i32; 3]| {
        let length = dot(v.map(f64::from), v.map(f64::from)).sqrt();
        v.map(|x| f64::from(x) / length)
    };
    let (up, facing) = (unit(renderer.orientation().up), unit(renderer.orientation().facing));
    let left = cross(up, facing);
    let (orbit, tilt) = (f64::from(view.orbit).to_radians(), f64::from(view.tilt).to_radians());
    let level: [f64; 3] = std::array::from_fn(|axis| orbit.cos() * facing[axis] + orbit.sin() * left[axis]);
    let right = cross(up, level);
    let near: [f64; 3] = std::array::from_fn(|axis| tilt.cos() * level[axis] + tilt.sin() * up[axis]);
    let upwards: [f64; 3] = std::array::from_fn(|axis| tilt.cos() * up[axis] - tilt.sin() * level[axis]);
    let relative: [f64; 3] = std::array::from_fn(|axis| {
        let followed = renderer.camera().target([0; 3])[axis] != renderer.camera().target([1; 3])[axis];
        place[axis] - if followed { hips[axis] } else { f64::from(target[axis]) }
    });
    let (scale, size, centre) = renderer.camera().framing();
    let away = f64::from(DISTANCE * size);
    let magnified = f64::from(scale) / f64::from(size) * away / (away - dot(near, relative));
    [f64::from(centre[0]) + dot(right, relative) * magnified, f64::from(centre[1]) - dot(upwards, relative) * magnified]
}

fn joint(name: &str, parent: Option<usize>, offset: [f64; 3], kinds: &[Kind]) -> Joint {
    Joint { name: name.into(), parent, offset, kinds: kinds.to_vec(), end_site: kinds.is_empty(), helper: false }
}

fn motion(rig: Rig, values: Vec<Vec<f64>>) -> Motion {
    let keys = vec![None; values.len()];
    Motion {
        rig,
        frame_time: 0.04,
        frames: values[0].len(),
        values,
        keys,
        looped: false,
        events: Vec::new(),
        origin: Default::default(),
    }
}

/// Chains of joints driven in every way: Euler angles in all orders, exponential maps, quaternions, moving offsets.
fn every_kind() -> Motion {
    use Kind::*;
    const DRIVES: [&[Kind]; 10] = [
        &[Xposition, Yposition, Zposition, Zrotation, Xrotation, Yrotation],
        &[Xrotation, Yrotation, Zrotation],
        &[Xexponential, Yexponential, Zexponential],
        &[Wquaternion, Xquaternion, Yquaternion, Zquaternion],
        &[Yrotation, Zrotation, Xrotation],
        &[Zexponential, Yposition, Yexponential, Xexponential],
        &[Zrotation, Yrotation, Xrotation],
        &[Xquaternion, Yquaternion, Zquaternion, Wquaternion],
        &[Yrotation, Xrotation, Zrotation, Xrotation],
        &[Xrotation, Zrotation, Yrotation],
    ];
    let mut noise = Noise(7);
    let mut next = || noise.signed();
    let mut rig = Rig { cm_per_unit: 2.54, ..Rig::default() };
    for index in 0..40 {
        let parent = if index % 10 == 0 && index > 0 { 0 } else { index.max(1) - 1 };
        let offset = [next() * 20.0, next() * 20.0, next() * 20.0];
        rig.joints.push(joint(&format!("j{index}"), (index > 0).then_some(parent), offset, DRIVES[index % 10]));
    }
    let frames = 300;
    let mut value = |kind: Kind, root: bool| match kind {
        _ if kind.is_position() && root => next() * 500.0,
        _ if kind.is_position() => next() * 20.0,
        _ if kind.is_quaternion() => next(),
        _ if kind.is_exponential() => next() * 179.0,
        _ => next() * 400.0,
    };
    let kinds = rig.channel_kinds();
    let values = kinds.iter().map(|&(joint, kind)| (0..frames).map(|_| value(kind, joint == Some(0))).collect()).collect();
    motion(rig, values)
}

#[test]
fn joints_driven_in_every_way_are_where_real_numbers_put_them() {
    let case = Case::new(every_kind());
    let size = f64::from(case.skeleton(Detail::Full).size);
    let error = case.worst(1) / size;
    println!("worst joint: {:.4} % of the figure", error * 100.0);
    assert!(error < 5e-4, "{error}");
}

#[test]
fn euler_slots_that_hold_an_exponential_map_turn_as_one() {
    let with = |kinds: &[Kind]| {
        let rig = Rig {
            joints: vec![joint("root", None, [0.0; 3], kinds), joint("", Some(0), [3.0, -20.0, 5.0], &[])],
            cm_per_unit: 1.0,
            ..Rig::default()
        };
        Case::new(motion(rig, vec![vec![100.0], vec![-70.0], vec![33.0]]))
    };
    let truth = with(&[Kind::Xexponential, Kind::Yexponential, Kind::Zexponential]);
    let slots = with(&[Kind::Zrotation, Kind::Xrotation, Kind::Yrotation]);
    // The root is the only joint with a choice.
    let form = Form::new(slots.rig().id(), slots.rig().length_exponent(), [1]);
    let skeleton =
        Skeleton::<JOINTS>::new(&slots.rig(), Detail::Full, Pose { values: &slots.pose(0), form: (&form).into() }).unwrap();
    let mut joints: Kinematics<JOINTS> = Kinematics::new();
    joints.set_pose(&skeleton, &slots.pose(0));
    let error = distance(joints.position(1).map(f64::from), truth.truth(&skeleton, 0)[1]);
    assert!(error / f64::from(skeleton.size) < 5e-4, "{error}");
}

#[test]
fn joints_appear_within_a_pixel_of_a_camera_in_real_numbers() {
    let case = Case::new(every_kind());
    for (orbit, track) in [(0, CameraTarget::Follow), (-50, CameraTarget::Follow), (137, CameraTarget::Fixed)] {
        let error = case.worst_pixel(View { orbit, track, ..View::default() }, 10);
        println!("orbit {orbit}, {track:?}: {error:.3} pixels");
        assert!(error < 1.0, "{error}");
    }
}

/// A person with the arms held out: bones to be told by eye.
fn person() -> Motion {
    use Kind::*;
    let turn: &[Kind] = &[Zrotation, Xrotation, Yrotation];
    let mut joints = vec![
        joint("Hips", None, [0.0; 3], &[Xposition, Yposition, Zposition, Zrotation, Xrotation, Yrotation]),
        joint("Spine", Some(0), [0.0, 50.0, 0.0], turn),
        joint("Head", Some(1), [0.0, 12.0, 0.0], turn),
        joint("", Some(2), [0.0, 18.0, 0.0], &[]),
    ];
    for (side, out) in [("Left", 1.0), ("Right", -1.0)] {
        let first = joints.len();
        joints.push(joint(&format!("{side}Arm"), Some(1), [out * 18.0, 0.0, 0.0], turn));
        joints.push(joint("", Some(first), [out * 50.0, 0.0, 0.0], &[]));
        joints.push(joint(&format!("{side}UpLeg"), Some(0), [out * 14.0, 0.0, 0.0], turn));
        joints.push(joint(&format!("{side}Leg"), Some(first + 2), [out * 8.0, -42.0, 0.0], turn));
        joints.push(joint(&format!("{side}Foot"), Some(first + 3), [out * 8.0, -42.0, 0.0], turn));
        joints.push(joint("", Some(first + 4), [out * 10.0, -4.0, 14.0], &[]));
    }
    let rig = Rig { joints, cm_per_unit: 1.0, ..Rig::default() };
    let mut values = vec![vec![0.0]; rig.channels()];
    values[1] = vec![88.0];
    motion(rig, values)
}

#[test]
fn a_person_is_drawn_as_a_person() {
    let case = Case::new(person());
    let canvas = Canvas { width: 40, height: 40 };
    let view = View { orbit: 0, tilt: 0, ..View::default() };
    let mut renderer: FigureRenderer<JOINTS> =
        FigureRenderer::new(case.skeleton(Detail::Body), canvas, view, |visit| visit(&case.pose(0)));
    let mut display = MockDisplay::<BinaryColor>::new();
    display.set_allow_overdraw(true);
    display.set_allow_out_of_bounds_drawing(true);
    renderer.set_pose(Pose { values: &case.pose(0), form: (&case.form()).into() }).unwrap();
    let mut inside = display.cropped(&Rectangle::new(Point::zero(), Size::new(40, 40)));
    inside.clear(BinaryColor::Off).unwrap();
    let mut surface = OnTarget::new(&mut inside);
    renderer.draw_on(&mut surface, DrawStyle { ground: false, ..DrawStyle::default() });
    surface.outcome().unwrap();
    #[rustfmt::skip]
    display.assert_pattern(&[
        "........................................",
        "...................###..................",
        "..................#...#.................",
        "..................#...#.................",
        "..................#...#.................",
        "...................###..................",
        "....................#...................",
        "....................#...................",
        ".....##############################.....",
        "....................#...................",
        "....................#...................",
        "....................#...................",
        "....................#...................",
        "....................#...................",
        "....................#...................",
        "....................#...................",
        "....................#...................",
        "....................#...................",
        ".................######.................",
        ".................#....#.................",
        ".................#....#.................",
        "................#......#................",
        "................#......#................",
        "................#......#................",
        "................#......#................",
        "...............#........#...............",
        "...............#........#...............",
        "...............#........#...............",
        "...............#........#...............",
        "...............#........#...............",
        "..............#..........#..............",
        "..............#..........#..............",
        "..............#..........#..............",
        "..............#..........#..............",
        ".............#............#.............",
        ".............#............#.............",
        ".............#............#.............",
        "............#..............#............",
        "...........#................#...........",
        "........................................",
    ]);
}

/// Every clip that can be imported, from `$PANTIN_DATA` or beside the repository.
fn clips() -> Vec<(String, Motion)> {
    let data = std::env::var_os("PANTIN_DATA").map_or_else(|| PathBuf::from("../../shared/data"), PathBuf::from);
    let Ok(entries) = std::fs::read_dir(&data) else {
        println!("skipped: no clips in {}; set PANTIN_DATA", data.display());
        return Vec::new();
    };
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "bvh"));
    paths.sort();
    let name = |path: &PathBuf| path.file_name().unwrap().to_string_lossy().into_owned();
    let load = |path: &PathBuf| crate::told::load(path, &import::ImportOptions::new()).unwrap().motion;
    paths.iter().map(|path| (name(path), load(path))).collect()
}

#[test]
fn every_clip_keeps_to_real_numbers() {
    for (name, motion) in clips() {
        let case = Case::new(motion);
        let renderer = case.renderer(View::default());
        let axis = renderer.orientation().axis;
        let first = case.truth(renderer.skeleton(), 0);
        let places = || first.iter().skip(renderer.skeleton().hips).map(|place| place[axis]);
        let height = places().fold(f64::MIN, f64::max) - places().fold(f64::MAX, f64::min);
        let stride = case.motion.frames.div_ceil(500);
        let error = case.worst(stride) / height;
        let pixels = case.worst_pixel(View::default(), stride);
        println!("{name}: {:.4} % of the height, {pixels:.3} pixels", error * 100.0);
        assert!(error < 2e-3, "{name}: {error}");
        assert!(pixels < 1.0, "{name}: {pixels}");
    }
}
