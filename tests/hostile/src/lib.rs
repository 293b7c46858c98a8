//! Entry points for untrusted input, and what must hold for each: a target panics where it does not.

mod animator;
pub mod clips;
mod faces;
pub mod fix;
mod imports;
pub mod lines;
pub mod live;
pub mod mutants;
pub mod noise;
mod sources;
pub mod streams;

/// An entry point for untrusted input.
#[derive(Clone, Copy)]
pub struct FuzzTarget {
    /// Its name, and that of its program in `fuzz/fuzz_targets` and of its folder of first inputs.
    pub name: &'static str,
    /// Reads any bytes; returns whether they were a clip, a rig or a motion.
    pub run: fn(&[u8]) -> bool,
    /// What damage to text may put in: bytes alone seldom make words.
    pub words: &'static [&'static str],
    /// Which of the golden vectors' files are inputs too, by extension.
    pub vectors: &'static [&'static str],
    /// First inputs that this repository's encoders make.
    pub made: fn() -> Vec<Vec<u8>>,
}

const CLIPS: &[&str] = &["ptn"];

/// All entry points.
pub const FUZZ_TARGETS: [FuzzTarget; 24] = [
    FuzzTarget { name: "open_play", run: clips::open_play, words: &[], vectors: CLIPS, made: Vec::new },
    FuzzTarget { name: "crc_fixed_play", run: clips::crc_fixed_play, words: &[], vectors: CLIPS, made: Vec::new },
    FuzzTarget { name: "keys_play", run: clips::keys_play, words: &[], vectors: &[], made: clips::key_clips },
    FuzzTarget { name: "rig_open", run: clips::rig_open, words: &[], vectors: &["rig"], made: Vec::new },
    FuzzTarget { name: "bank_open", run: clips::bank_open, words: &[], vectors: &["ptb"], made: Vec::new },
    FuzzTarget { name: "animator", run: animator::animator, words: &[], vectors: &[], made: animator::tables },
    FuzzTarget { name: "stream_play", run: streams::stream_play, words: &[], vectors: CLIPS, made: Vec::new },
    FuzzTarget { name: "link_receive", run: lines::link_receive, words: &[], vectors: &[], made: lines::streams },
    FuzzTarget { name: "live_vmc", run: live::vmc, words: &live::BONES, vectors: &[], made: live::datagrams },
    FuzzTarget { name: "live_bvh", run: live::bvh, words: &imports::BVH_WORDS, vectors: &[], made: live::streams },
    FuzzTarget { name: "store_open", run: lines::store_open, words: &[], vectors: CLIPS, made: Vec::new },
    FuzzTarget { name: "update_receive", run: lines::update_receive, words: &[], vectors: &[], made: lines::updates },
    FuzzTarget { name: "face_model", run: faces::face_model, words: &[], vectors: &[], made: faces::models },
    FuzzTarget { name: "export_source", run: sources::export_source, words: &sources::WORDS, vectors: CLIPS, made: Vec::new },
    FuzzTarget {
        name: "import_bvh",
        run: |text| imports::load("bvh", text),
        words: &imports::BVH_WORDS,
        vectors: &[],
        made: Vec::new,
    },
    FuzzTarget {
        name: "import_keys",
        run: |text| imports::load("keys", text),
        words: &imports::KEYS_WORDS,
        vectors: &[],
        made: Vec::new,
    },
    FuzzTarget {
        name: "import_gltf",
        run: |bytes| imports::load("gltf", bytes),
        words: &imports::GLTF_WORDS,
        vectors: &[],
        made: Vec::new,
    },
    FuzzTarget {
        name: "import_fbx",
        run: |bytes| imports::load("fbx", bytes),
        words: &imports::FBX_WORDS,
        vectors: &[],
        made: Vec::new,
    },
    FuzzTarget {
        name: "import_vrml",
        run: |text| imports::load("wrl", text),
        words: &imports::VRML_WORDS,
        vectors: &[],
        made: Vec::new,
    },
    FuzzTarget { name: "import_amc", run: imports::amc, words: &imports::AMC_WORDS, vectors: &[], made: Vec::new },
    FuzzTarget {
        name: "import_fap",
        run: |text| imports::load("fap", text),
        words: &imports::FAP_WORDS,
        vectors: &[],
        made: Vec::new,
    },
    FuzzTarget {
        name: "import_livelink",
        run: |text| imports::load("csv", text),
        words: &imports::LIVELINK_WORDS,
        vectors: &[],
        made: Vec::new,
    },
    FuzzTarget {
        name: "import_table",
        run: |text| imports::load("tsv", text),
        words: &imports::TABLE_WORDS,
        vectors: &[],
        made: Vec::new,
    },
    FuzzTarget {
        name: "import_proc",
        run: |text| imports::load("proc", text),
        words: &imports::PROC_WORDS,
        vectors: &[],
        made: Vec::new,
    },
];

/// Finds a target by its name.
pub fn fuzz_target(name: &str) -> Option<FuzzTarget> {
    FUZZ_TARGETS.into_iter().find(|target| target.name == name)
}
