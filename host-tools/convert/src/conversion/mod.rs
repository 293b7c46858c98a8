//! The one conversion behind every front end: a motion after all edits becomes a clip that the device's own decoder has verified.
//!
//! [`convert`] is all of it. A bank, or clips of one form, take the two steps apart: [`Prepared`] motions agree on what they share, and each is
//! then coded by [`Prepared::code`].

mod bound;
mod distance;
mod keyed;
mod left_out;
mod prepared;
mod recipe;
mod recording;
mod report;

use crate::error::Error;
use crate::motion::Motion;
use crate::note::Note;
use crate::options::Options;
pub(crate) use bound::CLOSING;
pub(crate) use distance::Distance;
#[cfg(feature = "internals")]
#[doc(hidden)]
pub use keyed::key_clip;
pub use prepared::{Made, Prepared, agree_on_up, of_one_rig, prepare, shared_coding};
pub use recipe::Recipe;
pub use recording::{RecordedClip, Recording};
pub use report::{Errors, Report, SeamReport};

/// A clip that keeps its bound.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Converted {
    /// The bytes of the clip.
    pub clip: Vec<u8>,
    /// The bytes of its rig, which the clip holds too unless [`Options::rig_apart`] is set.
    pub rig: Vec<u8>,
    /// The motion that was coded: the source after all edits, with the seam closed.
    pub motion: Motion,
    /// How far the clip is from the source.
    pub report: Report,
    /// What was done and what is odd, in the order in which it was found.
    pub notes: Vec<Note>,
}

/// Receives the part of a conversion that is done, from 0 to 1.
pub type Progress<'a> = &'a mut (dyn FnMut(f64) + Send);

/// Converts `motion` to a clip. The device's own decoder has played it and found every bound kept, against the source.
///
/// ```
/// use pantin_convert::{Length, Options, convert, import};
///
/// let bvh = "HIERARCHY ROOT hips { OFFSET 0 0 0 CHANNELS 3 Xrotation Yrotation Zrotation End Site { OFFSET 0 100 0 } } \
///            MOTION Frames: 3 Frame Time: 0.04  0 0 0  1 0 0  2 0 0";
/// let files = import::InMemory::new().with("bow.bvh", bvh.as_bytes());
/// let bow = import::import(&files, "bow.bvh".as_ref(), &import::ImportOptions::new())?;
/// let converted = convert(&bow.motion, &Options::new().max_error(Length::cm(0.5)), &mut |_| ())?;
/// assert!(converted.clip.len() < 100);
/// # Ok::<(), pantin_convert::Error>(())
/// ```
pub fn convert(motion: &Motion, options: &Options, progress: Progress<'_>) -> Result<Converted, Error> {
    let mut prepared = prepare(motion.clone(), options)?;
    prepared.find_footsteps()?;
    let Made { clip, report, notes } = prepared.code(&shared_coding(std::slice::from_ref(&prepared)), progress)?;
    let Prepared { motion, rig, .. } = prepared;
    Ok(Converted { clip, rig, motion, report, notes })
}
