//! The table of formats: one entry each has every fact about a format that the rest of the program asks for.

use super::animations::{self, Entry};
use super::request::Request;
use super::{Source, amc, bvh, fap, fbx, gltf, keyframes, livelink, procedural, table, vrml, zip};
use anyhow::Result;
use std::path::{Path, PathBuf};

/// A motion format.
pub struct Format {
    /// What people call it.
    pub name: &'static str,
    /// Extensions of its files, in lower case.
    pub extensions: &'static [&'static str],
    /// Extensions of files that belong to its files and hold no motion, in lower case.
    pub companion_extensions: &'static [&'static str],
    /// Whether its files may hold several animations, of which one is chosen.
    pub has_animations: bool,
    /// Whether its files take their skeleton from another one.
    pub has_skeleton: bool,
    /// Whether it states that y is up, or its importer turns figures so; such files come from programs whose rigs have joints to steer by.
    pub(super) states_up: bool,
    /// Whether each frame takes bytes in the file: all others can ask for any number of frames.
    pub(super) has_rows: bool,
    /// Whether a file that begins so is of this format, for files whose extension does not tell.
    pub(super) begins: fn(&[u8]) -> bool,
    pub(super) read: fn(&Path, &Request) -> Result<Source>,
    /// The animations of a file.
    pub(super) list: fn(&Path, &Request) -> Result<Vec<Entry>>,
    /// Files that belong to a file, as far as can be told without importing it.
    pub(super) companions: fn(&Path, &Request) -> Result<Vec<PathBuf>>,
}

/// A format of one motion a file, without companions.
const PLAIN: Format = Format {
    name: "",
    extensions: &[],
    companion_extensions: &[],
    has_animations: false,
    has_skeleton: false,
    states_up: false,
    has_rows: false,
    begins: |_| false,
    read: |_, _| unreachable!("every format has a reader"),
    list: animations::only_one,
    companions: |_, _| Ok(Vec::new()),
};

/// All formats. Of several with one extension, those that a file's first bytes tell stand before the one that takes all others.
pub const FORMATS: &[Format] = &[
    Format { name: "BVH", extensions: &["bvh"], has_rows: true, begins: bvh::begins, read: bvh::read, ..PLAIN },
    Format {
        name: "AMC",
        extensions: &["amc"],
        companion_extensions: &["asf"],
        has_skeleton: true,
        has_rows: true,
        begins: amc::begins,
        read: amc::read,
        companions: amc::skeletons,
        ..PLAIN
    },
    Format {
        name: "glTF",
        extensions: &["glb", "gltf"],
        has_animations: true,
        states_up: true,
        begins: gltf::begins,
        read: gltf::read,
        list: gltf::list,
        companions: gltf::buffers,
        ..PLAIN
    },
    Format {
        name: "FBX",
        extensions: &["fbx"],
        has_animations: true,
        states_up: true,
        begins: fbx::begins,
        read: fbx::read,
        list: fbx::list,
        ..PLAIN
    },
    Format {
        name: "VRML",
        extensions: &["wrl", "vrml", "x3dv"],
        has_animations: true,
        states_up: true,
        begins: vrml::begins,
        read: vrml::read,
        list: vrml::list,
        ..PLAIN
    },
    Format { name: "key frames", extensions: &["keys"], begins: keyframes::begins, read: keyframes::read, ..PLAIN },
    Format { name: "procedural motion", extensions: &["proc"], begins: procedural::begins, read: procedural::read, ..PLAIN },
    Format { name: "FAP", extensions: &["fap"], begins: fap::begins, read: fap::read, ..PLAIN },
    Format { name: "Live Link Face", extensions: &["csv"], begins: livelink::begins, read: livelink::read, ..PLAIN },
    Format { name: "table", extensions: &["csv", "tsv"], begins: table::begins, read: table::read, ..PLAIN },
    Format {
        name: "ZIP",
        extensions: &["zip"],
        has_animations: true,
        has_skeleton: true,
        begins: zip::begins,
        read: zip::read,
        list: zip::list,
        ..PLAIN
    },
];

impl Format {
    /// Whether a file's name has one of the format's extensions, in any case of letters.
    pub fn names(&self, path: &Path) -> bool {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        self.extensions.contains(&extension.as_str())
    }

    /// `BVH (.bvh)`, for a list of what is known.
    pub fn sentence(&self) -> String {
        format!("{} (.{})", self.name, self.extensions.join(", ."))
    }
}
