//! BVH files as outputs.

use super::{Staged, commit};
use anyhow::Result;
use pantin_convert::export::bvh::{Columns, write};
use pantin_convert::motion::Motion;
use std::path::Path;

/// Writes `motion`, with its own channels, to the output `path`: all of it, or the file stays as it was.
pub fn save_bvh(motion: &Motion, path: &Path) -> Result<()> {
    let mut file = Staged::create(path)?;
    let written = write(motion, Columns::Own, &mut file);
    file.explain(written, || path.display().to_string())?;
    commit(vec![file])
}

#[cfg(test)]
mod tests {
    use super::*;
    use pantin_convert::motion::{Rig, Scalar};

    #[test]
    fn a_motion_that_bvh_cannot_hold_leaves_no_file() {
        let folder = tempfile::tempdir().unwrap();
        let scalar = Scalar { name: "smile".into(), full_scale: 1.0 };
        let motion = Motion {
            rig: Rig { scalars: vec![scalar], cm_per_unit: 1.0, ..Rig::default() },
            frame_time: 0.01,
            frames: 1,
            values: vec![vec![0.0]],
            keys: vec![None],
            looped: false,
            events: Vec::new(),
            origin: Default::default(),
        };
        assert!(save_bvh(&motion, &folder.path().join("face.bvh")).is_err());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
