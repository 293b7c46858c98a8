//! The doors that bytes of strangers come through, and what must hold behind each. A door panics where it does not hold.

pub mod clips;
pub mod fix;
mod imports;
pub mod noise;

/// A door.
#[derive(Clone, Copy)]
pub struct Door {
    /// Its name, and that of its fuzz target and of its folder of first inputs.
    pub name: &'static str,
    /// Takes any bytes; whether they were a clip, a rig or a motion.
    pub enter: fn(&[u8]) -> bool,
    /// What damage to text may put in: bytes alone seldom make words.
    pub words: &'static [&'static str],
    /// Which of the golden vectors' files are inputs too, by extension.
    pub vectors: &'static [&'static str],
}

const CLIPS: &[&str] = &["ptn"];

/// All doors.
pub const DOORS: [Door; 13] = [
    Door { name: "open_play", enter: clips::open_play, words: &[], vectors: CLIPS },
    Door { name: "crc_fixed_play", enter: clips::crc_fixed_play, words: &[], vectors: CLIPS },
    Door { name: "rig_open", enter: clips::rig_open, words: &[], vectors: &["rig"] },
    Door { name: "import_bvh", enter: |text| imports::load("bvh", text), words: &imports::BVH_WORDS, vectors: &[] },
    Door { name: "import_keys", enter: |text| imports::load("keys", text), words: &imports::KEYS_WORDS, vectors: &[] },
    Door { name: "import_gltf", enter: |bytes| imports::load("gltf", bytes), words: &imports::GLTF_WORDS, vectors: &[] },
    Door { name: "import_fbx", enter: |bytes| imports::load("fbx", bytes), words: &imports::FBX_WORDS, vectors: &[] },
    Door { name: "import_vrml", enter: |text| imports::load("wrl", text), words: &imports::VRML_WORDS, vectors: &[] },
    Door { name: "import_amc", enter: imports::amc, words: &imports::AMC_WORDS, vectors: &[] },
    Door { name: "import_fap", enter: |text| imports::load("fap", text), words: &imports::FAP_WORDS, vectors: &[] },
    Door { name: "import_livelink", enter: |text| imports::load("csv", text), words: &imports::LIVELINK_WORDS, vectors: &[] },
    Door { name: "import_table", enter: |text| imports::load("tsv", text), words: &imports::TABLE_WORDS, vectors: &[] },
    Door { name: "import_proc", enter: |text| imports::load("proc", text), words: &imports::PROC_WORDS, vectors: &[] },
];

/// The door of this name.
pub fn door(name: &str) -> Option<Door> {
    DOORS.into_iter().find(|door| door.name == name)
}
