//! Untrusted input: the first inputs of the fuzz targets, the golden vectors, and damage to both, the same on every run.
//! `cargo xtask fuzz` looks longer.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use harness::{paths, vectors};
use hostile::noise::Noise;
use hostile::{FUZZ_TARGETS, FuzzTarget};

/// Damaged inputs of a target: a second or two. (With RUST_BACKTRACE set, importers take many times longer over each error.)
const CLIPS: usize = 20_000;
/// The same for files.
const FILES: usize = 3000;

fn files(folder: &Path, wanted: impl Fn(&Path) -> bool) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = entries.filter(|path| path.is_file() && wanted(path)).collect();
    files.sort();
    files
}

fn inputs(target: FuzzTarget) -> Vec<(PathBuf, Vec<u8>)> {
    let of_kind = |path: &Path| target.vectors.iter().any(|kind| path.extension().is_some_and(|extension| extension == *kind));
    let mut all = files(&paths::root().join("fuzz/corpus-seed").join(target.name), |_| true);
    all.extend(files(&vectors::folder(), of_kind));
    let read = all.into_iter().map(|path| (path.clone(), fs::read(&path).unwrap()));
    let made = (target.made)().into_iter().enumerate().map(|(index, bytes)| (PathBuf::from(format!("made {index}")), bytes));
    read.chain(made).collect()
}

fn holds(name: &str, attempts: usize) {
    let target = hostile::fuzz_target(name).unwrap();
    let inputs = inputs(target);
    assert!(!inputs.is_empty(), "no first inputs for {name}");
    for (path, input) in &inputs {
        println!("{}", path.display());
        assert!((target.run)(input), "a first input is refused: it reaches nothing");
    }
    let mut noise = Noise::new(1);
    let mut accepted = 0;
    let started = Instant::now();
    for attempt in 0..attempts {
        let [(path, input), (_, other)] = [0; 2].map(|_| &inputs[noise.below(inputs.len())]);
        let damaged = noise.damage(input, other, target.words);
        // Shown if the target panics: the input can be made again from it.
        println!("attempt {attempt} on {}", path.display());
        accepted += usize::from((target.run)(&damaged));
    }
    println!("{name}: {accepted} of {attempts} accepted, in {:.1} s", started.elapsed().as_secs_f64());
    // Behind CRCs none or nearly none is; elsewhere the damage would test too little.
    assert!(name == "open_play" || (attempts / 20..attempts).contains(&accepted), "{accepted} of {attempts} accepted");
}

#[test]
fn clips_as_they_come() {
    holds("open_play", CLIPS);
}

#[test]
fn clips_behind_their_crcs() {
    holds("crc_fixed_play", CLIPS);
}

#[test]
fn key_clips_behind_their_crcs() {
    holds("keys_play", CLIPS);
}

#[test]
fn rigs() {
    holds("rig_open", CLIPS);
}

#[test]
fn banks() {
    holds("bank_open", CLIPS);
}

#[test]
fn animators() {
    holds("animator", CLIPS / 20);
}

#[test]
fn clips_in_pieces() {
    holds("stream_play", CLIPS);
}

#[test]
fn bytes_of_a_line_with_motion() {
    holds("link_receive", FILES);
}

#[test]
fn datagrams_with_poses() {
    holds("live_vmc", FILES);
}

#[test]
fn a_stream_with_poses() {
    holds("live_bvh", FILES);
}

#[test]
fn flash_with_clips() {
    holds("store_open", CLIPS);
}

#[test]
fn bytes_of_a_line_with_an_update() {
    holds("update_receive", FILES);
}

#[test]
fn models_of_faces() {
    holds("face_model", CLIPS);
}

#[test]
fn source_text_made_of_clips() {
    holds("export_source", CLIPS);
}

#[test]
fn bvh_files() {
    holds("import_bvh", FILES);
}

#[test]
fn key_frame_files() {
    holds("import_keys", FILES);
}

#[test]
fn amc_files() {
    holds("import_amc", FILES);
}

#[test]
fn fap_files() {
    holds("import_fap", FILES);
}

#[test]
fn live_link_face_files() {
    holds("import_livelink", FILES);
}

#[test]
fn tables() {
    holds("import_table", FILES);
}

#[test]
fn procedural_files() {
    holds("import_proc", FILES);
}

#[test]
fn gltf_files() {
    holds("import_gltf", FILES);
}

#[test]
fn fbx_files() {
    holds("import_fbx", FILES);
}

#[test]
fn vrml_files() {
    holds("import_vrml", FILES);
}

#[test]
fn every_fuzz_target_has_its_program() {
    let targets = files(&paths::root().join("fuzz/fuzz_targets"), |_| true);
    let mut named: Vec<&str> = FUZZ_TARGETS.iter().map(|target| target.name).collect();
    named.sort_unstable();
    let targets: Vec<String> = targets.iter().map(|path| path.file_stem().unwrap().to_string_lossy().into_owned()).collect();
    assert_eq!(targets, named);
}

#[test]
fn the_fuzz_targets_have_the_dependencies_of_their_lock_file() {
    let mut lock = Command::new("cargo");
    lock.args(["update", "--workspace", "--locked", "--manifest-path"]).arg(paths::root().join("fuzz/Cargo.toml"));
    let output = lock.output().unwrap();
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success(),
        "fuzz/Cargo.lock is stale: run `cargo update --workspace --manifest-path fuzz/Cargo.toml`\n{words}"
    );
}
