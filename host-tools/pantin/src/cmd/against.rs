//! `pantin info CLIP --against MOTION`: how far a clip is from the motion that it was made of.

use crate::memory;
use anyhow::{Context, Result, ensure};
use pantin::Clip;
use pantin_convert::edit::{Edits, cut::cut};
use pantin_convert::expand::expand_within;
use pantin_convert::import::{ImportOptions, import};
use pantin_convert::motion::Motion;
use pantin_convert::verify::{Report, compare, shell_radius_cm};
use std::path::Path;

/// The errors of `clip` against the motion file `path`, and that motion: at the clip's rate and in its unit of length, and without its last frame
/// if the clip is a loop that leaves it out. Fails for a motion of another figure or length.
pub fn errors(clip: &Clip<'_>, path: &Path) -> Result<(Report, Motion)> {
    let played = expand_within(clip, memory::limit())?;
    let place = || path.display().to_string();
    let mut options = ImportOptions::new().memory(memory::limit());
    if !played.rig.joints.is_empty() {
        options = options.cm_per_unit(played.rig.cm_per_unit);
    }
    let disk = memory::disk();
    let mut motion = import(&disk, path, &options)?.motion;
    if motion.frames != played.frames {
        let edits = Edits::new().fps(1.0 / played.frame_time).memory(memory::limit());
        motion = edits.apply(motion, &disk).with_context(place)?.motion;
    }
    if clip.looped() && motion.frames == played.frames + 1 {
        motion = cut(&motion, None, Some(played.frames - 1))?;
    }
    ensure!(
        motion.frames == played.frames,
        "{}: {} frames, and the clip has {}: give the motion as it was cut for the clip",
        place(),
        motion.frames,
        played.frames
    );
    let names = |motion: &Motion| (0..motion.rig.joints.len()).map(|joint| motion.rig.joint_name(joint)).collect::<Vec<_>>();
    let scalars = |motion: &Motion| motion.rig.scalars.iter().map(|scalar| scalar.name.clone()).collect::<Vec<_>>();
    let same = names(&motion) == names(&played) && scalars(&motion) == scalars(&played);
    ensure!(same, "{}: another figure than the clip's: joints or scalars have other names", place());
    let report = compare(&motion, &played, shell_radius_cm(&motion))?;
    Ok((report, motion))
}
