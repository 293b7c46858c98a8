//! Places and rotations against [`JointChain`], which computes with 30 fraction bits, and against forward kinematics in double precision for rigs with every kind of channel.

use std::path::Path;

use pantin::{ChannelState, Clip, Form, Player, Pose, WrongForm};
use pantin_math::{JointChain, JointPlace, Kinematics, KinematicsError};

fn motion(name: &str) -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions").join(name)).unwrap()
}

#[test]
fn places_and_rotations_keep_the_stated_error() {
    for name in ["walk.ptn", "run.ptn", "kneebend.ptn", "greet.ptn"] {
        let bytes = motion(name);
        let clip = Clip::new_checked(&bytes).unwrap();
        let (mut states, mut pose) = (vec![ChannelState::NEW; clip.moving()], vec![0; clip.rig().channels()]);
        let mut player = Player::new(clip, &mut states, &mut pose).unwrap();
        let count = clip.rig().joint_count();
        let (mut memory, mut other) = (vec![JointPlace::NEW; count], vec![JointPlace::NEW; count]);
        let mut kinematics = Kinematics::new(&clip, player.pose(), &mut memory).unwrap();
        let mut single = Kinematics::new(&clip, player.pose(), &mut other).unwrap();
        let chains: Vec<_> = (0..count).map(|index| JointChain::<32>::to_joint(&clip, index).unwrap()).collect();
        let (mut far, mut turned, mut height) = (0.0f64, 0.0f64, 0.0f64);
        for _ in 0..clip.frames() {
            kinematics.set_pose(player.pose()).unwrap();
            for (index, chain) in chains.iter().enumerate() {
                let joint = clip.rig().joint_ref(index).unwrap();
                let place = *kinematics.joint(&joint).unwrap();
                let one = *single.place(player.pose(), &joint).unwrap();
                assert_eq!((one.position(), one.rotation()), (place.position(), place.rotation()));
                let truth = chain.locate(player.pose()).unwrap();
                let own = kinematics.centimetres(place.position());
                for (own, truth) in own.iter().zip(truth.position) {
                    far = far.max((own.to_num::<f64>() - truth.to_num::<f64>()).abs());
                    height = height.max(truth.to_num::<f64>().abs());
                }
                for (column, own) in place.rotation().0.iter().enumerate() {
                    for (row, own) in own.iter().enumerate() {
                        let truth = truth.rotation.rows[row][column].to_num::<f64>();
                        turned = turned.max((f64::from(*own) / 32768.0 - truth).abs());
                    }
                }
            }
            player.step();
        }
        assert!(far < 5e-4 * height && far < 0.09, "{name}: {far} cm of {height}");
        assert!(turned < 1e-3, "{name}: {turned}");
    }
}

#[test]
fn too_little_memory_and_other_poses_are_refused() {
    let bytes = motion("walk.ptn");
    let clip = Clip::new_checked(&bytes).unwrap();
    let needed = clip.rig().joint_count();
    let values = vec![0; clip.rig().channels()];
    let pose = Pose { values: &values, form: clip.form_ref() };
    let mut memory = vec![JointPlace::NEW; needed];
    let error = Kinematics::new(&clip, pose, &mut memory[1..]).unwrap_err();
    assert_eq!(error, KinematicsError::TooFewJoints { needed, given: needed - 1 });
    assert!(error.to_string().contains(&needed.to_string()));
    let other = Form::new(!clip.rig().id(), clip.length_exponent(), []);
    let strange = Pose { values: &values, form: (&other).into() };
    assert_eq!(Kinematics::new(&clip, strange, &mut memory).unwrap_err(), WrongForm::Rig.into());
    let mut kinematics = Kinematics::new(&clip, pose, &mut memory).unwrap();
    assert_eq!(kinematics.set_pose(strange), Err(WrongForm::Rig));
    let head = clip.find("head").unwrap();
    assert_eq!(kinematics.place(strange, &head).err(), Some(WrongForm::Rig));
    assert!(kinematics.place(pose, &head).is_ok());
    // A pose that is cut short has zeros in the place of what it lacks.
    let short = Pose { values: &values[..1], form: clip.form_ref() };
    assert_eq!(kinematics.set_pose(short), Ok(()));
}
