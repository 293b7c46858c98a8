//! The poses of a clip, frame after frame, from the device's own decoder.

use crate::array::floats;
use crate::error::exception;
use crate::facts::open;
use anyhow::{Context, Error, Result};
use pantin::{ChannelState, EulerOrder, Player};
use pantin_convert::motion::Motion;
use pantin_convert::{Memory, expand, fk};
use pyo3::prelude::*;
use pyo3::types::PyByteArray;

/// A clip as a motion, played without the interpreter's lock.
fn expanded(py: Python<'_>, clip: &[u8]) -> PyResult<Motion> {
    py.detach(|| expand::expand(&open(clip)?)).map_err(|error: Error| exception(py, &error, None))
}

/// Numbers of all frames, computed without the interpreter's lock.
fn frames<'py, T: Send + IntoIterator<Item = f64>>(
    py: Python<'py>,
    motion: &Motion,
    of_frame: impl Fn(usize) -> Vec<T> + Sync,
) -> Bound<'py, PyByteArray>
where
    Vec<T>: Send,
{
    let all: Vec<T> = py.detach(|| (0..motion.frames).flat_map(&of_frame).collect());
    floats(py, all.into_iter().flatten())
}

/// Rotations of all joints in their parents: w, x, y, z.
#[pyfunction]
pub fn rotations<'py>(py: Python<'py>, clip: &[u8]) -> PyResult<Bound<'py, PyByteArray>> {
    let motion = expanded(py, clip)?;
    let mut before = vec![[0.0; 4]; motion.rig.joints.len()];
    let all: Vec<[f64; 4]> = py.detach(|| {
        let near = |(turn, before): ([f64; 4], &mut [f64; 4])| {
            // Of the two quaternions that turn alike, the nearer to that of the frame before.
            let dot: f64 = turn.iter().zip(&*before).map(|(a, b)| a * b).sum();
            *before = if dot < 0.0 { turn.map(|x| -x) } else { turn };
            *before
        };
        let frame = |frame| fk::rotations(&motion.rig, &motion.values, frame).into_iter().zip(&mut before).map(near).collect();
        (0..motion.frames).flat_map::<Vec<_>, _>(frame).collect()
    });
    Ok(floats(py, all.into_iter().flatten()))
}

/// Places of all joints in the world, in cm.
#[pyfunction]
pub fn positions<'py>(py: Python<'py>, clip: &[u8]) -> PyResult<Bound<'py, PyByteArray>> {
    let motion = expanded(py, clip)?;
    Ok(frames(py, &motion, |frame| fk::positions(&motion.rig, &motion.values, frame)))
}

/// Places of all joints in their parents, in cm.
#[pyfunction]
pub fn places<'py>(py: Python<'py>, clip: &[u8]) -> PyResult<Bound<'py, PyByteArray>> {
    let motion = expanded(py, clip)?;
    let (first, unit) = (motion.rig.first_channels(), motion.rig.cm_per_unit);
    Ok(frames(py, &motion, |frame| {
        let place = |(joint, &first): (&pantin_convert::motion::Joint, &usize)| {
            let mut place = joint.offset;
            for (channel, kind) in (first..).zip(&joint.kinds).filter(|(_, kind)| kind.is_position()) {
                if let (Some(axis), Some(values)) = (kind.axis(), motion.values.get(channel)) {
                    place[axis] = values[frame];
                }
            }
            place.map(|x| x * unit)
        };
        motion.rig.joints.iter().zip(&first).map(place).collect()
    }))
}

/// Values of all scalars.
#[pyfunction]
pub fn scalars<'py>(py: Python<'py>, clip: &[u8]) -> PyResult<Bound<'py, PyByteArray>> {
    let motion = expanded(py, clip)?;
    let first = motion.rig.joint_channels();
    Ok(frames(py, &motion, |frame| motion.values[first..].iter().map(|values| [values[frame]]).collect()))
}

/// The decoder's own integers: all channels of all frames, 32 bits each.
#[pyfunction]
pub fn raw<'py>(py: Python<'py>, clip: &[u8]) -> PyResult<Bound<'py, PyByteArray>> {
    let values = py.detach(|| raw_values(clip)).map_err(|error| exception(py, &error, None))?;
    Ok(PyByteArray::new(py, &values))
}

fn raw_values(bytes: &[u8]) -> Result<Vec<u8>> {
    let clip = open(bytes)?;
    Memory::default().check(clip.frames() as usize, clip.rig().channels())?;
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut pose = vec![0; clip.rig().channels()];
    let mut player = Player::new(clip, &mut states, &mut pose)?;
    let mut values = Vec::new();
    for frame in 0..clip.frames() {
        if frame > 0 {
            player.step();
        }
        values.extend(player.pose().values.iter().flat_map(|value| value.to_ne_bytes()));
    }
    Ok(values)
}

/// The Euler angles of a joint of this index in all frames: three of 32 bits each, in 2^-32 turns.
#[pyfunction]
pub fn euler<'py>(py: Python<'py>, clip: &[u8], joint: usize, order: &str) -> PyResult<Bound<'py, PyByteArray>> {
    let values = py.detach(|| euler_values(clip, joint, order)).map_err(|error| exception(py, &error, None))?;
    Ok(PyByteArray::new(py, &values))
}

fn euler_values(bytes: &[u8], joint: usize, order: &str) -> Result<Vec<u8>> {
    let clip = open(bytes)?;
    let known = EulerOrder::ALL.into_iter().find(|known| format!("{known:?}") == order);
    let order = known.with_context(|| format!("no order of Euler angles {order:?}: XYZ, XZY, YXZ, YZX, ZXY or ZYX"))?;
    let joint = clip.rig().joint_ref(joint).with_context(|| format!("no joint {joint}"))?;
    Memory::default().check(clip.frames() as usize, clip.rig().channels())?;
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut pose = vec![0; clip.rig().channels()];
    let mut player = Player::new(clip, &mut states, &mut pose)?;
    let mut values = Vec::new();
    for frame in 0..clip.frames() {
        if frame > 0 {
            player.step();
        }
        let turn = player.turn(&joint).map_err(Error::msg)?;
        values.extend(turn.euler(order).iter().flat_map(|angle| angle.to_bits().to_ne_bytes()));
    }
    Ok(values)
}
