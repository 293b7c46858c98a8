//! Conversion of a motion that Python holds as arrays.

use crate::array::groups;
use crate::background;
use crate::convert::{Made, made};
use crate::error::refused;
use crate::settings::{Settings, direction};
use pantin_convert::Error;
use pantin_convert::import::Disk;
use pantin_convert::import::arrays::{Arrays, Entry};
use pantin_convert::motion::Scalar;
use pyo3::prelude::*;

/// A joint: name, parent, offset, whether it is an End Site.
type Joint = (String, Option<usize>, [f64; 3], bool);
/// A scalar: name, full scale, values.
type Values = (String, f64, Vec<u8>);

/// A motion as arrays of bytes: a dict with all of these keys.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Given {
    joints: Vec<Joint>,
    rotations: Vec<u8>,
    places: Vec<u8>,
    scalars: Vec<Values>,
    frames: usize,
    rate: f64,
    cm_per_unit: f64,
    up: String,
}

impl Given {
    /// The library's arrays.
    fn arrays(self, settings: &Settings) -> Result<Arrays, Error> {
        let joint = |(name, parent, offset, end_site)| Entry { name, parent, offset, end_site };
        let scalar = |(name, full_scale, values): Values| {
            let values = groups::<1>(&values).into_iter().map(|[value]| value).collect();
            (Scalar { name, full_scale }, values)
        };
        Ok(Arrays {
            joints: self.joints.into_iter().map(joint).collect(),
            rotations: groups(&self.rotations),
            places: groups(&self.places),
            scalars: self.scalars.into_iter().map(scalar).collect(),
            frames: self.frames,
            rate: self.rate,
            cm_per_unit: self.cm_per_unit,
            up: direction(&self.up)?,
            memory: settings.memory()?,
        })
    }
}

/// Converts arrays.
#[pyfunction]
pub fn convert_arrays(
    py: Python<'_>,
    motion: Given,
    settings: Settings,
    jobs: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Made> {
    let fail = |error| refused(py, &error, None, &settings);
    let recipe = settings.recipe().map_err(fail)?;
    let read = (motion.rotations.len() + motion.places.len()) as u64;
    let arrays = motion.arrays(&settings).map_err(fail)?;
    let files = Disk::new(recipe.options.memory);
    let done = background::run(py, jobs, progress.as_ref(), |progress| {
        let mut imported = arrays.motion().map_err(|error| Error::of(&error, Error::source))?;
        imported.motion.origin.bytes = read;
        recipe.convert_imported(imported, &files, progress)
    })?;
    Ok(made(done.map_err(fail)?, &settings))
}
