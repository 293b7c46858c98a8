//! The rotations of joints as the decoder computes them: `turns.txt`, for the tests of every other language.
//!
//! Each line is a joint at a frame: the clip, the joint's name, the frame, three Euler angles in the order XYZ (about x, y and z), three in the
//! order ZXY (about z, x and y), the quaternion w, x, y and z, and a checksum. Angles are in 2^-32 turns, components in 2^-30. The checksum is the
//! CRC-16/IBM-3740 of 28 little-endian 32-bit integers: the rotation matrix row by row, the whole angle, and the Euler angles in the six orders
//! XYZ, XZY, YXZ, YZX, ZXY and ZYX.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context, Result};
use pantin::codec::crc;
use pantin::units::{Angle, Component};
use pantin::{ChannelState, EulerOrder, Player, Turn};

use super::Vector;

/// The file's name.
pub const NAME: &str = "turns.txt";

/// The clips, which together code joints in every form.
const CLIPS: [&str; 6] = ["exponential-choice", "exponential-map", "mixed", "quaternion", "rests-and-choices", "turn-orders"];

/// The file's text, of the committed clips.
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
    let mut sum = crc::INITIAL;
    let mut put = |bits: i32| sum = crc::update(sum, &bits.to_le_bytes());
    turn.matrix().rows.iter().flatten().for_each(|element| put(element.to_bits()));
    put(turn.angle().to_bits());
    EulerOrder::ALL.iter().flat_map(|&order| turn.euler(order)).map(Angle::to_bits).for_each(put);
    sum
}
