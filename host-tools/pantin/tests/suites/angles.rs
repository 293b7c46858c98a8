//! Angles and places that a program reads from a clip are those of the decoded motion in double precision.

use pantin::{Angle, Clip, EulerOrder, Room, WrongForm};
use pantin_convert::expand::expand;
use pantin_convert::fk;
use pantin_convert::import::ImportOptions;
use pantin_convert::motion::Motion;
use pantin_figure::JointChain;
use std::path::{Path, PathBuf};

type Matrix = [[f64; 3]; 3];
type Memory = Room<512, 512>;

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|row| std::array::from_fn(|column| (0..3).map(|k| a[row][k] * b[k][column]).sum()))
}

fn about(axis: usize, angle: f64) -> Matrix {
    let (sin, cos) = angle.sin_cos();
    let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut matrix = [[0.0; 3]; 3];
    matrix[axis][axis] = 1.0;
    (matrix[j][j], matrix[j][k], matrix[k][j], matrix[k][k]) = (cos, -sin, sin, cos);
    matrix
}

fn of_angles(axes: impl IntoIterator<Item = (usize, f64)>) -> Matrix {
    let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    axes.into_iter().fold(identity, |matrix, (axis, degrees)| product(&matrix, &about(axis, degrees.to_radians())))
}

fn degrees(angle: Angle) -> f64 {
    f64::from(angle.to_bits()) / 4_294_967_296.0 * 360.0
}

/// The angle between two rotations, in degrees.
fn between(a: &Matrix, b: &Matrix) -> f64 {
    // The distance of the elements: of small angles it is their sine times the root of two.
    let square: f64 = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).powi(2)).sum();
    (square / 8.0).sqrt().min(1.0).asin().to_degrees() * 2.0
}

/// Checks every joint over some frames; returns how many joints the clip codes as exponential maps.
fn check(file: &Path) -> usize {
    let bytes = std::fs::read(file).unwrap();
    let clip = Clip::new_checked(&bytes).unwrap();
    let truth = expand(&clip).unwrap();
    let mut room = Memory::new();
    let mut player = room.player(clip).unwrap();
    let firsts = truth.rig.first_channels();
    let stride = clip.frames().div_ceil(40).max(1);
    for frame in (0..clip.frames()).step_by(stride as usize) {
        player.seek(frame);
        let places = fk::positions(&truth.rig, &truth.values, frame as usize);
        for (index, joint) in truth.rig.joints.iter().enumerate() {
            let chain = JointChain::<64>::to_joint(&clip, index).unwrap();
            let at = chain.locate(player.pose()).unwrap();
            for (got, want) in at.position.iter().zip(places[index]) {
                assert!(
                    (got.to_num::<f64>() - want).abs() < 0.01,
                    "{}: joint {index}, frame {frame}: {got} for {want} cm",
                    file.display()
                );
            }
            let turning: Vec<_> = joint.kinds.iter().enumerate().filter(|(_, kind)| kind.is_rotation()).collect();
            let Some(order) = clip.rig().joint_ref(index).and_then(|joint| joint.euler_order()) else { continue };
            let want = of_angles(
                turning
                    .iter()
                    .map(|(channel, kind)| (kind.axis().unwrap(), truth.values[firsts[index] + channel][frame as usize])),
            );
            let reference = clip.rig().joint_ref(index).unwrap();
            let angles = player.turn(&reference).unwrap().euler(order).map(degrees);
            let got = of_angles(order.axes().into_iter().map(|axis| axis as usize).zip(angles));
            assert!(between(&got, &want) < 0.01, "{}: joint {index}, frame {frame}: {angles:?}", file.display());
        }
    }
    (0..truth.rig.joints.len()).filter(|&joint| clip.is_exponential(joint)).count()
}

fn motions() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions")
}

#[test]
fn joints_of_our_own_clips_are_where_double_precision_puts_them() {
    let exponential: usize = ["walk.ptn", "run.ptn", "kneebend.ptn"].iter().map(|name| check(&motions().join(name))).sum();
    assert!(exponential > 0, "no joint is coded as an exponential map");
}

fn captured(name: &str) -> PathBuf {
    std::env::var_os("PANTIN_DATA").map_or_else(|| motions().join("../../../shared/data"), PathBuf::from).join(name)
}

/// The greatest error of an Euler angle, in its joint's own order, and of a joint's rotation in its parent, in degrees.
fn errors(source: &Motion, clip: &Path) -> [f64; 2] {
    let bytes = std::fs::read(clip).unwrap();
    let clip = Clip::new_checked(&bytes).unwrap();
    let mut room = Memory::new();
    let mut player = room.player(clip).unwrap();
    let firsts = source.rig.first_channels();
    let mut worst = [0f64; 2];
    for frame in 0..source.frames {
        for (index, joint) in source.rig.joints.iter().enumerate() {
            let reference = clip.rig().joint_ref(index).unwrap();
            let Some(order) = reference.euler_order() else { continue };
            let turning = (firsts[index]..).zip(&joint.kinds).filter(|(_, kind)| kind.is_rotation());
            let truth: Vec<(usize, f64)> =
                turning.map(|(channel, kind)| (kind.axis().unwrap(), source.values[channel][frame])).collect();
            let angles = player.turn(&reference).unwrap().euler(order).map(degrees);
            for (angle, (_, truth)) in angles.iter().zip(&truth) {
                let off = angle - truth;
                worst[0] = worst[0].max((off - 360.0 * (off / 360.0).round()).abs());
            }
            let got = of_angles(order.axes().into_iter().map(|axis| axis as usize).zip(angles));
            worst[1] = worst[1].max(between(&got, &of_angles(truth)));
        }
        player.step();
    }
    worst
}

/// What the pages say to authors of servos and of skinned meshes.
#[test]
fn a_bound_of_channels_holds_for_each_euler_angle_and_one_of_joints_for_rotations() {
    let folder = tempfile::tempdir().unwrap();
    let clip = folder.path().join("a.ptn");
    for (path, least) in [(motions().join("library/dance.keys"), 0.5), (captured("bvh_bandai1_kick.bvh"), 5.0)] {
        if !path.exists() {
            println!("skipped: {} is not there; set PANTIN_DATA", path.display());
            continue;
        }
        let source = crate::told::load(&path, &ImportOptions::new()).unwrap().motion;
        let worst = |options: &[&str]| {
            let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_pantin"));
            let done = command.arg("convert").arg(&path).arg("-o").arg(&clip).args(options).output().unwrap();
            assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
            errors(&source, &clip)
        };
        let [single, whole] = worst(&["--max-channel-error", "1", "--segments"]);
        println!("{}: --max-channel-error: {single} degrees an angle, {whole} a rotation", path.display());
        assert!(single > 0.5 && single <= 1.0, "{single}");
        let [single, whole] = worst(&["--max-joint-error", "1", "--segments", "--effort", "fast"]);
        println!("{}: --max-joint-error: {single} degrees an angle, {whole} a rotation", path.display());
        assert!(single > least && whole > 0.5 && whole <= 1.0, "{single} {whole}");
    }
}

#[test]
fn joints_of_captured_clips_are_where_double_precision_puts_them() {
    let bvh = captured("bvh_cmu131_start-walk-stop.bvh");
    if !bvh.exists() {
        return println!("skipped: {} is not there; set PANTIN_DATA", bvh.display());
    }
    let folder = tempfile::tempdir().unwrap();
    let clip = folder.path().join("cmu.ptn");
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_pantin"));
    let done = command.arg("convert").arg(&bvh).arg("-o").arg(&clip).args(["--effort", "fast"]).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    assert!(check(&clip) > 0);
    // The source's left knee bends by 46 degrees at frame 0; its X channel reads 0 where it holds an exponential map.
    let bytes = std::fs::read(&clip).unwrap();
    let clip = Clip::new_checked(&bytes).unwrap();
    let mut room = Memory::new();
    let player = room.player(clip).unwrap();
    let knee = clip.find("LeftKnee").unwrap();
    assert_eq!(knee.euler_order(), Some(EulerOrder::ZYX));
    let [z, y, x] = player.turn(&knee).unwrap().euler(EulerOrder::ZYX).map(degrees);
    assert!((z - 6.37).abs() < 5.0 && (y - 14.77).abs() < 5.0 && (x - 46.44).abs() < 5.0, "{z} {y} {x}");
}

#[test]
fn a_renderer_refuses_a_pose_of_another_form() {
    let read = |name: &str| std::fs::read(motions().join(name)).unwrap();
    let (walk, knee) = (read("walk.ptn"), read("kneebend.ptn"));
    let (mut first, mut second) = (Memory::new(), Memory::new());
    let mut player = first.player(Clip::new_checked(&walk).unwrap()).unwrap();
    let other = second.player(Clip::new_checked(&knee).unwrap()).unwrap();
    let canvas = pantin_figure::Canvas { width: 128, height: 64 };
    let mut renderer = pantin_figure::FigureRenderer::<64>::of_clip(&mut player, canvas, Default::default()).unwrap();
    assert_eq!(renderer.set_pose(player.pose()), Ok(()));
    assert_eq!(renderer.set_pose(other.pose()), Err(WrongForm::Rig));
}
