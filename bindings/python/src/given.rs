//! Conversion of a motion that Python holds as arrays.

use crate::array::groups;
use crate::background;
use crate::convert::{Aim, code, direction};
use crate::error::exception;
use anyhow::Result;
use pantin_convert::import::arrays::{Arrays, Entry};
use pantin_convert::motion::Scalar;
use pyo3::prelude::*;

/// A joint: name, parent, offset, whether it is an End Site.
type Joint = (String, Option<usize>, [f64; 3], bool);
/// A scalar: name, full scale, values.
type Values = (String, f64, Vec<u8>);

/// Converts arrays: the clip, and its report as JSON.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn convert_arrays(
    py: Python<'_>,
    joints: Vec<Joint>,
    rotations: &[u8],
    places: &[u8],
    scalars: Vec<Values>,
    frames: usize,
    rate: f64,
    cm_per_unit: f64,
    up: &str,
    max_error_cm: f64,
    max_scalar_error: f64,
    effort: &str,
    fps: Option<f64>,
    jobs: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Vec<u8>, String)> {
    let joint = |(name, parent, offset, end_site)| Entry { name, parent, offset, end_site };
    let scalar = |(name, full_scale, values): Values| {
        let values = groups::<1>(&values).into_iter().map(|[value]| value).collect();
        (Scalar { name, full_scale }, values)
    };
    let given = || -> Result<(Arrays, Aim)> {
        let arrays = Arrays {
            joints: joints.into_iter().map(joint).collect(),
            rotations: groups(rotations),
            places: groups(places),
            scalars: scalars.into_iter().map(scalar).collect(),
            frames,
            rate,
            cm_per_unit,
            up: direction(up)?,
        };
        Ok((arrays, Aim::new(max_error_cm, max_scalar_error, effort, fps)?))
    };
    let read = (rotations.len() + places.len()) as u64;
    let (arrays, aim) = given().map_err(|error| exception(py, &error, None))?;
    let made = background::run(py, jobs, progress.as_ref(), |progress| code(arrays.motion()?, aim, read, progress))?;
    made.map_err(|error| exception(py, &error, None))
}
