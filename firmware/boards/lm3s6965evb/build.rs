//! Brings the repository's memory map and the clip to where the linker and the program find them.

use std::path::{Path, PathBuf};
use std::{env, fs};

const MEMORY: &str = "../../../memory.x";
const WALK: &str = "../../../motions/walk.ptn";

fn main() {
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    copy(Path::new(MEMORY), &out.join("memory.x"), "it is the memory map of the reference machine");
    println!("cargo::rustc-link-search={}", out.display());
    for argument in ["--nmagic", "-Tlink.x", "-Tdefmt.x"] {
        println!("cargo::rustc-link-arg-bins={argument}");
    }
    println!("cargo::rerun-if-env-changed=PANTIN_CLIP");
    let clip = env::var_os("PANTIN_CLIP").map_or_else(|| PathBuf::from(WALK), PathBuf::from);
    let advice = "set PANTIN_CLIP to the whole path of a clip; `cargo pantin convert IN -o OUT.ptn` makes one";
    copy(&clip, &out.join("clip.ptn"), advice);
}

fn copy(from: &Path, to: &Path, advice: &str) {
    println!("cargo::rerun-if-changed={}", from.display());
    if let Err(error) = fs::copy(from, to) {
        println!("cargo::error={}: {error}: {advice}", from.display());
    }
}
