//! What a clip is: its rig, its time, its events.

use crate::array::floats;
use crate::error::exception;
use anyhow::{Error, Result, bail};
use pantin::{Clip, OpenError};
use pantin_convert::facts::segment_bits;

use pantin_convert::import::up;
use pantin_convert::motion::Rig;
use pantin_convert::{Memory, events};
use pyo3::prelude::*;
use pyo3::types::PyByteArray;
use serde_json::json;

/// Opens the bytes of a clip's file.
pub fn open(bytes: &[u8]) -> Result<Clip<'_>> {
    Clip::new_checked(bytes).or_else(|error| match error {
        OpenError::IsBank => {
            bail!("a bank of several clips, which pantin.Bank opens")
        }
        OpenError::BadMagic => bail!("{error}; pantin.convert makes clips of motions"),
        error => Err(error.into()),
    })
}

/// The facts of a clip as JSON.
#[pyfunction]
pub fn facts(py: Python<'_>, clip: &[u8]) -> PyResult<String> {
    text(clip).map_err(|error: Error| exception(py, &error, None))
}

/// Bytes that the segments of each channel take.
#[pyfunction]
pub fn channel_bytes<'py>(py: Python<'py>, clip: &[u8]) -> PyResult<Bound<'py, PyByteArray>> {
    let bits = py.detach(|| -> Result<Vec<f64>> {
        let clip = open(clip)?;
        Memory::default().check(clip.frames() as usize, clip.rig().channels())?;
        segment_bits(&clip)
    });
    let bits = bits.map_err(|error| exception(py, &error, None))?;
    Ok(floats(py, bits.into_iter().map(|bits| bits / 8.0)))
}

fn text(bytes: &[u8]) -> Result<String> {
    let clip = open(bytes)?;
    let figure = Rig::from(&clip.rig());
    let joint = |(index, joint): (usize, &pantin_convert::motion::Joint)| {
        let order = clip.rig().joint_ref(index).and_then(|joint| joint.euler_order());
        json!({
            "name": joint.name,
            "parent": joint.parent,
            "offset": joint.offset.map(|x| x * figure.cm_per_unit),
            "end_site": joint.end_site,
            "helper": joint.helper,
            "order": order.map(|order| format!("{order:?}")),
        })
    };
    // Channels by what the clip stores: where three Euler angles are coded as an exponential map, its components.
    let coded = (0..figure.joints.len()).flat_map(|joint| clip.kinds(joint).map(move |kind| (joint, kind)));
    let channels: Vec<String> = coded
        .map(|(joint, kind)| format!("{}.{kind:?}", figure.joints[joint].name))
        .chain(figure.scalars.iter().map(|scalar| scalar.name.clone()))
        .collect();
    let events: Vec<_> = events::of_clip(&clip).into_iter().map(|event| json!([event.frame, event.name])).collect();
    let facts = json!({
        "frames": clip.frames(),
        "frame_time_ns": clip.frame_time_ns(),
        "looped": clip.looped(),
        "moving": clip.moving(),
        "has_keys": clip.has_keys(),
        "up": up::text(figure.up),
        "joints": figure.joints.iter().enumerate().map(joint).collect::<Vec<_>>(),
        "scalars": figure.scalars.iter().map(|scalar| json!([scalar.name, scalar.full_scale])).collect::<Vec<_>>(),
        "channels": channels,
        "events": events,
    });
    Ok(facts.to_string())
}
