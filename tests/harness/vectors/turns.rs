//! The rotations of joints as the decoder computes them: `turns.txt`, for the tests of every other language.
//!
//! Each line is a joint at a frame: the clip, the joint's name, the frame, three Euler angles in the order XYZ (about x, y and z), three in the
//! order ZXY (about z, x and y), the quaternion w, x, y and z, and a checksum. Angles are in 2^-32 turns, components in 2^-30. The checksum is the
//! CRC-16/IBM-3740 of 28 little-endian 32-bit integers: the rotation matrix row by row, the whole angle, and the Euler angles in the six orders
//! XYZ, XZY, YXZ, YZX, ZXY and ZYX.
//!
//! `turn-sums.txt` has the rotations of clips of our own motions, and of one with half turns: a line for each joint, with the clip, the joint's name, and
//! for each frame two checksums of the same kind in eight hexadecimal digits: of the Euler angles in the six orders, then of the quaternion, the rotation
//! matrix and the whole angle.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context, Result};
use pantin::codec::crc;
use pantin::units::{Angle, Component};
use pantin::{ChannelState, Clip, EulerOrder, JointRef, Player, Turn};

use super::Vector;

/// The name of the file with rotations.
pub const NAME: &str = "turns.txt";

/// The name of the file with checksums of rotations.
pub const SUMS: &str = "turn-sums.txt";

/// How the names of the clips begin of which it has checksums.
const SUMMED: [&str; 2] = ["half-turns", "own-"];

/// The clips, which together code joints in every form.
const CLIPS: [&str; 6] = ["exponential-choice", "exponential-map", "mixed", "quaternion", "rests-and-choices", "turn-orders"];

/// The text with rotations, of the committed clips.
pub fn text(folder: &Path) -> Result<String> {
    let mut text = String::new();
    for vector in super::load(folder)?.iter().filter(|vector| CLIPS.contains(&vector.name.as_str())) {
        add(&mut text, vector)?;
    }
    Ok(text)
}

fn add(text: &mut String, vector: &Vector) -> Result<()> {
    let clip = vector.open()?;
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut pose = vec![0; clip.rig().channels()];
    let mut player = Player::new(clip, &mut states, &mut pose)?;
    for frame in 0..clip.frames() {
        for joint in clip.rig().joints() {
            let handle = clip.find(joint.name()).with_context(|| format!("{}: a joint without a name", vector.name))?;
            let turn = player.turn(&handle).map_err(|wrong| anyhow::anyhow!("{wrong}"))?;
            let (xyz, zxy) = (turn.euler(EulerOrder::XYZ), turn.euler(EulerOrder::ZXY));
            let angles = xyz.iter().chain(&zxy).map(|angle| angle.to_bits());
            write!(text, "{} {} {frame}", vector.name, joint.name())?;
            for bits in angles.chain(turn.quaternion().map(Component::to_bits)) {
                write!(text, " {bits}")?;
            }
            writeln!(text, " {:04x}", checksum(turn))?;
        }
        player.step();
    }
    Ok(())
}

fn checksum(turn: Turn) -> u16 {
    sum_of(matrix_and_angle(turn).into_iter().chain(euler_angles(turn)))
}

fn sum_of(numbers: impl Iterator<Item = i32>) -> u16 {
    numbers.fold(crc::INITIAL, |sum, bits| crc::update(sum, &bits.to_le_bytes()))
}

fn matrix_and_angle(turn: Turn) -> Vec<i32> {
    turn.matrix().rows.iter().flatten().map(|element| element.to_bits()).chain([turn.angle().to_bits()]).collect()
}

fn euler_angles(turn: Turn) -> impl Iterator<Item = i32> {
    EulerOrder::ALL.into_iter().flat_map(move |order| turn.euler(order)).map(Angle::to_bits)
}

/// The text with checksums, of the committed clips.
pub fn sums_text(folder: &Path) -> Result<String> {
    let vectors = super::load(folder)?;
    let summed = |vector: &&Vector| SUMMED.iter().any(|start| vector.name.starts_with(start));
    vectors.iter().filter(summed).map(|vector| sums_of(&vector.name, &vector.open()?)).collect()
}

/// The lines of one clip: of each joint that has a name, which no joint before it has.
pub fn sums_of(name: &str, clip: &Clip<'_>) -> Result<String> {
    let mut joints: Vec<(JointRef<'_>, String)> = vec![];
    for (index, joint) in clip.rig().joints().enumerate() {
        if let Some(found) = clip.find(joint.name()).filter(|found| found.index() == index) {
            joints.push((found, format!("{name} {}", joint.name())));
        }
    }
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut pose = vec![0; clip.rig().channels()];
    let mut player = Player::new(*clip, &mut states, &mut pose)?;
    for _ in 0..clip.frames() {
        for (joint, line) in &mut joints {
            let turn = player.turn(joint).map_err(|wrong| anyhow::anyhow!("{wrong}"))?;
            let others = turn.quaternion().map(Component::to_bits).into_iter().chain(matrix_and_angle(turn));
            write!(line, " {:04x}{:04x}", sum_of(euler_angles(turn)), sum_of(others))?;
        }
        player.step();
    }
    Ok(joints.into_iter().map(|(_, line)| line + "\n").collect())
}
