//! Motion files: an error that names the file, or a motion that holds together.

use std::path::{Path, PathBuf};

use pantin_convert::import::{self, ImportOptions};

/// Stands between the ASF and the AMC of one input.
const BETWEEN: &[u8] = b"\n%%\n";

pub const BVH_WORDS: [&str; 14] = [
    "HIERARCHY",
    "ROOT",
    "JOINT",
    "End Site",
    "{",
    "}",
    "OFFSET",
    "CHANNELS",
    "Xrotation",
    "MOTION",
    "Frames:",
    "Frame Time:",
    "-1e9",
    "nan",
];

pub const KEYS_WORDS: [&str; 14] = [
    "joint",
    "end",
    "parent",
    "offset",
    "channels",
    "scalar",
    "scale",
    "keys",
    "natural",
    "catmull-rom",
    "loop",
    "fps",
    "frames",
    "99999999999",
];

pub const AMC_WORDS: [&str; 14] = [
    ":units",
    ":root",
    ":bonedata",
    ":hierarchy",
    "begin",
    "end",
    "name",
    "length",
    "direction",
    "axis",
    "dof",
    "limits",
    "(",
    "1e99",
];

pub const LIVELINK_WORDS: [&str; 12] =
    ["Timecode", "BlendshapeCount", "JawOpen", "_R", "00:00:59:59.9", "23:59:59;29", ",0\n", ",", "\n", "\"", "-1e9", "nan"];

pub const FAP_WORDS: [&str; 8] = ["2.1", " 1", " 0", "\n", "-1e9", "nan", " 25 ", "99999999999"];

pub const TABLE_WORDS: [&str; 12] = ["time", "frame", "ms", ",", ";", "\t", "\n", "\"", "-1e9", "1e-9", "nan", "99999999999"];

pub const PROC_WORDS: [&str; 14] =
    ["let ", " = ", "sin(", "sqrt(", "min(", ")", "^", "/", "joint", "scalar", "loop", "fps", "frames", "99999999999"];

pub const GLTF_WORDS: [&str; 14] = [
    "\"children\":[0],",
    "\"count\":4294967295,",
    "\"byteOffset\":18446744073709551615,",
    "\"byteStride\":4,",
    "\"matrix\":[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,1],",
    "\"scale\":[0,1,1],",
    "\"normalized\":true,",
    "CUBICSPLINE",
    "STEP",
    "null",
    "[]",
    "{}",
    "-1",
    "1e38",
];

pub const FBX_WORDS: [&str; 12] = [
    "Objects:  {",
    "}",
    "Model: 9, \"Model::x\", \"LimbNode\" {",
    "C: \"OO\",1,2\n",
    "C: \"OO\",2,1\n",
    "*2000000000 {",
    "a: ",
    ",46186158000",
    "9000000000000000000",
    "\"UnitScaleFactor\"",
    "-1e38",
    "nan",
];

pub const VRML_WORDS: [&str; 14] = [
    "DEF a ",
    "USE a ",
    "Transform {",
    "children [",
    "PROTO a [ ] {",
    " IS a ",
    "ROUTE a.b TO a.b ",
    "key [",
    "keyValue [",
    "]",
    "}",
    "\"",
    "1e9",
    "-1e-9",
];

/// Loads a file of this kind.
pub fn load(extension: &str, text: &[u8]) -> bool {
    in_folder(|folder| {
        let path = folder.join("input").with_extension(extension);
        std::fs::write(&path, text).expect("the temporary folder is writable");
        check(&path, &ImportOptions::new())
    })
}

/// Loads an AMC and its ASF.
pub fn amc(text: &[u8]) -> bool {
    let at = text.windows(BETWEEN.len()).position(|window| window == BETWEEN).unwrap_or(text.len());
    let amc = text.get(at + BETWEEN.len()..).unwrap_or(&[]);
    in_folder(|folder| {
        let skeleton = folder.join("input.asf");
        let path = folder.join("input.amc");
        std::fs::write(&skeleton, &text[..at]).expect("the temporary folder is writable");
        std::fs::write(&path, amc).expect("the temporary folder is writable");
        check(&path, &ImportOptions::new().skeleton(skeleton))
    })
}

/// A folder of this thread's own, which goes with the thread.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Folder {
        let name = format!("pantin-hostile-{}-{:?}", std::process::id(), std::thread::current().id());
        let path = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&path).expect("the temporary folder is writable");
        Folder(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // There is nothing to be done about one that stays.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn in_folder(work: impl FnOnce(&Path) -> bool) -> bool {
    thread_local!(static FOLDER: Folder = Folder::new());
    FOLDER.with(|folder| work(&folder.0))
}

fn check(path: &Path, options: &ImportOptions) -> bool {
    match import::load(path, options) {
        Ok(imported) => {
            let motion = imported.motion;
            assert!(motion.frames > 0);
            assert_eq!(motion.values.len(), motion.rig.channels());
            assert_eq!(motion.keys.len(), motion.rig.channels());
            assert!(motion.values.iter().all(|values| values.len() == motion.frames));
            assert!(motion.values.iter().flatten().all(|value| value.is_finite()));
            assert!(motion.rig.joints.iter().flat_map(|joint| joint.offset).all(f64::is_finite));
            let parents = motion.rig.joints.iter().map(|joint| joint.parent).enumerate();
            assert!(parents.into_iter().all(|(index, parent)| parent.map_or(index == 0, |parent| parent < index)));
            assert!(motion.frame_time > 0.0 && motion.rig.cm_per_unit > 0.0);
            assert!(motion.frame_time.is_finite() && motion.rig.cm_per_unit.is_finite());
            true
        }
        Err(error) => {
            let error = format!("{error:#}");
            assert!(error.contains("input."), "no file in: {error}");
            assert!(!error.contains('\n'), "several lines: {error}");
            false
        }
    }
}
