//! The places of the figure's joints are those of `pantin_math::Kinematics`, bit for bit.

use std::path::{Path, PathBuf};

use pantin::{ChannelState, Clip, Player};
use pantin_figure::kinematics::Kinematics as FigureKinematics;
use pantin_figure::rotation::Rotation;
use pantin_figure::{Detail, Skeleton};
use pantin_math::{JointPlace, Kinematics};

const JOINTS: usize = 192;

fn clips(folder: &Path, found: &mut Vec<PathBuf>) {
    for path in std::fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().path()) {
        if path.is_dir() {
            clips(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "ptn") {
            found.push(path);
        }
    }
}

#[test]
fn places_are_those_of_the_figure() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut paths = vec![];
    clips(&root.join("motions"), &mut paths);
    clips(&root.join("tests/vectors"), &mut paths);
    let (mut clips, mut compared) = (0, 0);
    for path in &paths {
        let (bytes, rig) = (std::fs::read(path).unwrap(), std::fs::read(path.with_extension("rig")).ok());
        let clip = rig.map_or_else(|| Clip::new_checked(&bytes), |rig| Clip::with_rig(&bytes, rig.leak()));
        let Ok(clip) = clip else { continue };
        let (mut states, mut pose) = (vec![ChannelState::NEW; clip.moving()], vec![0; clip.rig().channels()]);
        let mut player = Player::new(clip, &mut states, &mut pose).unwrap();
        let Ok(skeleton) = Skeleton::<JOINTS>::new(&clip.rig(), Detail::Full, player.pose()) else { continue };
        let mut memory = vec![JointPlace::NEW; clip.rig().joint_count()];
        let mut kinematics = Kinematics::new(&clip, player.pose(), &mut memory).unwrap();
        let mut figure = FigureKinematics::<JOINTS, Rotation>::new();
        assert_eq!(kinematics.exponent(), skeleton.exponent);
        clips += 1;
        for _ in 0..clip.frames().min(40) {
            kinematics.set_pose(player.pose()).unwrap();
            figure.set_pose(&skeleton, player.pose().values);
            for (bone, place) in skeleton.bones.iter().zip(figure.positions()) {
                let own = kinematics.joints()[usize::from(bone.joint)].position();
                assert_eq!(own, *place, "{}: joint {} at frame {}", path.display(), bone.joint, player.frame());
                compared += 1;
            }
            player.step();
        }
    }
    assert!(clips > 10 && compared > 5_000, "{clips} clips, {compared} joints");
}
