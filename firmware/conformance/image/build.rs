//! Embeds the golden vectors, and hands the memory map of the target's machine to the linker.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

const VECTORS: &str = "../../../tests/vectors";

fn main() {
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::write(out.join("vectors.rs"), list()).expect("OUT_DIR is writable");
    let target = env::var("TARGET").expect("cargo sets TARGET");
    println!("cargo::rustc-link-search={}", out.display());
    println!("cargo::rustc-check-cfg=cfg(start, values(\"bare\", \"cortex_m\", \"wasm\"))");
    let (start, map, arguments): (_, _, &[&str]) = match target.split('-').next() {
        Some("thumbv6m") if env::var_os("CARGO_FEATURE_RP2040").is_some() => {
            ("cortex_m", Some("rp2040.x"), &["--nmagic", "-Tlink.x"])
        }
        Some(core) if core.starts_with("thumb") => ("cortex_m", Some("cortex-m.x"), &["--nmagic", "-Tlink.x"]),
        Some(core) if core.starts_with("riscv32") => ("bare", Some("virt.x"), &["--nmagic", "-Tmemory.x"]),
        Some("armv4t") => ("bare", Some("sx1.x"), &["--nmagic", "-Tmemory.x"]),
        Some("wasm32") => ("wasm", None, &["--export=run", "--no-entry"]),
        _ => {
            println!("cargo::error={target} is no target of this program; `cargo xtask conformance` names those that are");
            return;
        }
    };
    println!("cargo::rustc-cfg=start=\"{start}\"");
    if let Some(map) = map {
        println!("cargo::rerun-if-changed=maps/{map}");
        fs::copy(Path::new("maps").join(map), out.join("memory.x")).expect("the memory map can be copied");
    }
    arguments.iter().for_each(|argument| println!("cargo::rustc-link-arg-bins={argument}"));
}

/// Rust source: a slice of names, clips and rigs.
fn list() -> String {
    println!("cargo::rerun-if-changed={VECTORS}");
    let folder = fs::canonicalize(VECTORS).expect("the golden vectors are in the repository");
    let entries = fs::read_dir(&folder).expect("the golden vectors can be listed");
    let mut clips: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    clips.retain(|path| path.extension().is_some_and(|extension| extension == "ptn"));
    clips.sort();
    let mut list = "&[".to_owned();
    for clip in clips {
        println!("cargo::rerun-if-changed={}", clip.display());
        let rig = clip.with_extension("rig");
        let rig = if rig.is_file() { format!("include_bytes!({rig:?})") } else { "&[]".into() };
        let name = clip.file_stem().unwrap_or_default();
        let _ = writeln!(list, "Vector {{ name: {name:?}, clip: include_bytes!({clip:?}), rig: {rig} }},");
    }
    list + "]"
}
