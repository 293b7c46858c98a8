//! glTF files of others, where they are at hand: places against an evaluation of the file's own matrices, and conversion within a bound.

use crate::real::probe::probed;
use crate::real::{SAME, distance, files};
use gltf::animation::util::ReadOutputs;
use gltf::animation::{Interpolation, Property};
use pantin_convert::Level;
use pantin_convert::fit::fit;
use pantin_convert::import::{self, Disk, ImportOptions, units};
use pantin_convert::motion::Motion;
use pantin_convert::pose_bound::PoseBound;
use pantin_convert::{encode, export, fk, verify};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Part of the figure's height, and of scalars' full scale, that conversions keep to.
const BOUND: f64 = 0.005;
const SCALAR_BOUND: f64 = 0.02;

/// Every animation of every file.
fn motions() -> Vec<(PathBuf, usize, Motion)> {
    let of_file = |path: PathBuf| {
        let count = import::list(&Disk::default(), &path, &ImportOptions::new()).unwrap().len();
        (0..count).map(move |animation| {
            let options = ImportOptions::new().animation(animation.to_string());
            let motion = crate::told::load(&path, &options).unwrap_or_else(|error| panic!("{error:#}")).motion;
            (path.clone(), animation, motion)
        })
    };
    files(&["glb", "gltf"]).into_iter().flat_map(of_file).collect()
}

/// Keys of a node's translation, rotation or scale, read by the gltf crate.
pub struct NodeKeys {
    times: Vec<f32>,
    interpolation: Interpolation,
    values: Vec<Vec<f64>>,
}

impl NodeKeys {
    fn at(&self, time: f64, frame_time: f64, turns: bool) -> Vec<f64> {
        // Times that were rounded to f32 still belong to their frame.
        let late = if self.interpolation == Interpolation::Step { 1e-4 * frame_time } else { 0.0 };
        let key = self.times.partition_point(|&key| f64::from(key) <= time + late);
        let value = |key: usize| match self.interpolation {
            Interpolation::CubicSpline => self.values[3 * key + 1].clone(),
            _ => self.values[key].clone(),
        };
        if key == 0 || key == self.times.len() || self.interpolation == Interpolation::Step {
            return value(key.saturating_sub(1));
        }
        let (from, to) = (f64::from(self.times[key - 1]), f64::from(self.times[key]));
        let (length, t) = (to - from, (time - from) / (to - from));
        let (a, b) = (value(key - 1), value(key));
        if self.interpolation == Interpolation::CubicSpline {
            let (out, into) = (&self.values[3 * key - 1], &self.values[3 * key]);
            let (t2, t3) = (t * t, t * t * t);
            let mix = |i: usize| {
                (2.0 * t3 - 3.0 * t2 + 1.0) * a[i]
                    + length * (t3 - 2.0 * t2 + t) * out[i]
                    + (3.0 * t2 - 2.0 * t3) * b[i]
                    + length * (t3 - t2) * into[i]
            };
            return (0..a.len()).map(mix).collect();
        }
        let dot: f64 = if turns { a.iter().zip(&b).map(|(a, b)| a * b).sum() } else { 1.0 };
        let angle = dot.abs().min(1.0).acos();
        let (near, far) = if turns && angle > 1e-4 {
            (((1.0 - t) * angle).sin() / angle.sin(), (t * angle).sin() / angle.sin())
        } else {
            (1.0 - t, t)
        };
        a.iter().zip(&b).map(|(a, b)| near * a + far * dot.signum() * b).collect()
    }
}

/// Tracks of an animation by node and path (0 translation, 1 rotation, 2 scale), and its first time.
pub fn tracks(document: &gltf::Document, buffers: &[Vec<u8>], animation: usize) -> (HashMap<(usize, usize), NodeKeys>, f64) {
    let mut tracks = HashMap::new();
    let mut first = f64::MAX;
    for channel in document.animations().nth(animation).unwrap().channels() {
        let reader = channel.reader(|buffer| buffers.get(buffer.index()).map(Vec::as_slice));
        let times: Vec<f32> = reader.read_inputs().unwrap().collect();
        first = first.min(f64::from(times[0]));
        let wide = |vector: [f32; 3]| vector.map(f64::from).to_vec();
        let values = match reader.read_outputs().unwrap() {
            ReadOutputs::Translations(values) => values.map(wide).collect(),
            ReadOutputs::Scales(values) => values.map(wide).collect(),
            ReadOutputs::Rotations(values) => values.into_f32().map(|q| q.map(f64::from).to_vec()).collect(),
            ReadOutputs::MorphTargetWeights(_) => continue,
        };
        let path = match channel.target().property() {
            Property::Translation => 0,
            Property::Rotation => 1,
            _ => 2,
        };
        let track = NodeKeys { times, interpolation: channel.sampler().interpolation(), values };
        tracks.insert((channel.target().node().index(), path), track);
    }
    (tracks, first)
}

pub type Affine = [[f64; 4]; 3];

fn product(a: &Affine, b: &Affine) -> Affine {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum::<f64>() + if j == 3 { a[i][3] } else { 0.0 })
    })
}

fn affine(node: &gltf::Node, tracks: &HashMap<(usize, usize), NodeKeys>, time: f64, frame_time: f64) -> Affine {
    let track = |path: usize| tracks.get(&(node.index(), path)).map(|track| track.at(time, frame_time, path == 1));
    if (0..3).all(|path| track(path).is_none()) {
        let m = node.transform().matrix();
        return std::array::from_fn(|i| std::array::from_fn(|j| f64::from(m[j][i])));
    }
    let (t, q, s) = node.transform().decomposed();
    let or = |path: usize, rest: &[f32]| track(path).unwrap_or_else(|| rest.iter().map(|&x| f64::from(x)).collect());
    let (t, q, s) = (or(0, &t), or(1, &q), or(2, &s));
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    let [x, y, z, w] = [q[0], q[1], q[2], q[3]].map(|x| x / length);
    let turn = [
        [w * w + x * x - y * y - z * z, 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), w * w + y * y - x * x - z * z, 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w + z * z - x * x - y * y],
    ];
    std::array::from_fn(|i| std::array::from_fn(|j| if j == 3 { t[i] } else { turn[i][j] * s[j] }))
}

/// World matrices of all nodes by the name that their joint has.
pub fn worlds(
    document: &gltf::Document,
    tracks: &HashMap<(usize, usize), NodeKeys>,
    time: f64,
    frame_time: f64,
) -> HashMap<String, Affine> {
    let one: Affine = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
    let mut left: Vec<(gltf::Node, Affine)> = document.scenes().next().unwrap().nodes().map(|node| (node, one)).collect();
    let mut worlds = HashMap::new();
    while let Some((node, above)) = left.pop() {
        let world = product(&above, &affine(&node, tracks, time, frame_time));
        let name = node.name().map_or_else(|| format!("node{}", node.index()), str::to_string);
        worlds.insert(name, world);
        left.extend(node.children().map(|child| (child, world)));
    }
    worlds
}

pub fn buffers(path: &Path, document: &gltf::Document, blob: Option<Vec<u8>>) -> Vec<Vec<u8>> {
    use base64::Engine as _;
    let read = |buffer: gltf::Buffer| match buffer.source() {
        gltf::buffer::Source::Bin => blob.clone().unwrap(),
        gltf::buffer::Source::Uri(uri) => match uri.split_once(";base64,") {
            Some((_, data)) => base64::engine::general_purpose::STANDARD.decode(data).unwrap(),
            None => std::fs::read(path.with_file_name(uri)).unwrap(),
        },
    };
    document.buffers().map(read).collect()
}

#[test]
fn joints_stand_and_turn_as_the_files_matrices_have_them() {
    for (path, animation, motion) in motions() {
        let gltf = gltf::Gltf::open(&path).unwrap();
        let buffers = buffers(&path, &gltf.document, gltf.blob.clone());
        let (tracks, first) = tracks(&gltf.document, &buffers, animation);
        let cm = motion.rig.cm_per_unit;
        let height = units::posed_height_cm(&motion).max(cm);
        let probed = probed(&motion, height / cm);
        let mut worst = 0f64;
        for frame in 0..motion.frames {
            let time = first + frame as f64 * motion.frame_time;
            let expected = worlds(&gltf.document, &tracks, time, motion.frame_time);
            let places = fk::positions(&probed.rig, &probed.values, frame);
            let count = motion.rig.joints.len();
            for (index, joint) in motion.rig.joints.iter().enumerate().filter(|(_, joint)| !joint.end_site) {
                let Some(world) = expected.get(&joint.name) else {
                    assert_eq!(joint.name, "root", "{}", path.display());
                    continue;
                };
                let place = world.map(|row| row[3] * cm);
                worst = worst.max(distance(places[index], place) / height);
                for axis in 0..2 {
                    let length = world.iter().map(|row| row[axis] * row[axis]).sum::<f64>().sqrt();
                    let probe = std::array::from_fn(|i| place[i] + world[i][axis] / length * height);
                    worst = worst.max(distance(places[count + 2 * index + axis], probe) / height);
                }
            }
        }
        println!("{} {animation}: {} joints off by at most {worst:.1e} of the height", path.display(), motion.rig.joints.len());
        assert!(worst < SAME, "{} {animation}: {worst}", path.display());
    }
}

#[test]
fn files_convert_expand_and_export_within_the_bound() {
    let written = std::env::temp_dir().join(format!("pantin-gltf-real-files-{}.glb", std::process::id()));
    for (path, animation, motion) in motions() {
        let height = units::posed_height_cm(&motion).max(motion.rig.cm_per_unit);
        let bound = BOUND * height;
        let rig = encode::rig::encode(&motion.rig).unwrap();
        let coded = fit(&motion, Level::FAST.plan(PoseBound::places(bound)), SCALAR_BOUND, &mut |_| ()).unwrap();
        let bytes = encode::clip::encode(&coded, &rig, false).unwrap();
        let report = verify::verify(&bytes, &[], &motion, &PoseBound::places(bound), SCALAR_BOUND).unwrap();
        println!("{} {animation}: {} bytes, {:.4} cm of {bound:.4}", path.display(), bytes.len(), report.place_cm.error);

        let expanded = pantin_convert::expand::expand(&pantin::Clip::new_checked(&bytes).unwrap()).unwrap();
        std::fs::write(&written, export::gltf::write(&expanded).unwrap()).unwrap();
        let options = ImportOptions::new().fps(1.0 / expanded.frame_time);
        let back = crate::told::load(&written, &options).unwrap().motion;
        // f32 keeps 24 bits of a place, and errors add up along a limb.
        assert!(far(&expanded, &back) < 1e-5 * height, "{} {animation}: {}", path.display(), far(&expanded, &back));
        assert!(far(&motion, &back) < bound + 1e-5 * height, "{} {animation}", path.display());
        assert_eq!(back.rig.scalars.len(), motion.rig.scalars.len());
    }
    let _ = std::fs::remove_file(&written);
}

/// Greatest distance in cm of joints of one name.
fn far(a: &Motion, b: &Motion) -> f64 {
    assert_eq!(a.frames, b.frames);
    let by_name: HashMap<String, usize> = (0..b.rig.joints.len()).map(|joint| (b.rig.joint_name(joint), joint)).collect();
    let mut worst = 0f64;
    for frame in 0..a.frames {
        let (p, q) = (fk::positions(&a.rig, &a.values, frame), fk::positions(&b.rig, &b.values, frame));
        for (joint, p) in p.iter().enumerate() {
            let q = q[by_name[&a.rig.joint_name(joint)]];
            worst = worst.max(distance(*p, q));
        }
    }
    worst
}
