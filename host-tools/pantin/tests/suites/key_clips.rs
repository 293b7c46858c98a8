//! Key clips: `pantin convert --keys`, and what the other commands make of them.

use pantin::{Bank, Clip, OpenError};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn own(name: &str) -> String {
    let path: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions").join(name);
    path.to_str().unwrap().to_owned()
}

fn pantin(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pantin")).args(arguments).current_dir(folder).output().unwrap()
}

/// What the command prints to standard error.
fn succeeds(folder: &Path, arguments: &[&str]) -> String {
    let output = pantin(folder, arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stderr).unwrap()
}

fn refusal(folder: &Path, arguments: &[&str]) -> String {
    let output = pantin(folder, arguments);
    assert!(!output.status.success());
    String::from_utf8(output.stderr).unwrap()
}

#[test]
fn the_smaller_clip_is_written_and_a_note_says_which() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let is_keys = |name: &str| Clip::new_checked(&std::fs::read(folder.join(name)).unwrap()).unwrap().has_keys();
    let (walk, bow) = (own("walk.keys"), own("library/bow.keys"));
    let options = ["--effort", "fast", "--keys"];
    let note = succeeds(folder, &[&["convert", &walk, "-o", "walk.ptn"][..], &options].concat());
    assert!(note.contains("keys: the clip holds the motion's keys") && is_keys("walk.ptn"), "{note}");
    let note = succeeds(folder, &[&["convert", &bow, "-o", "bow.ptn", "--max-error", "3cm"][..], &options].concat());
    assert!(note.contains("keys: segments within the bound take") && !is_keys("bow.ptn"), "{note}");
    let note = succeeds(folder, &[&["convert", &walk, "-o", "cut.ptn", "--fps", "47"][..], &options].concat());
    assert!(note.contains("there is no key clip of this motion") && !is_keys("cut.ptn"), "{note}");
    // Exact coding keeps rotations to 0.006 degrees and places to a part of the figure.
    succeeds(folder, &["convert", &walk, "-o", "exact.ptn", "--exact", "--keys"]);
    assert_eq!(std::fs::read(folder.join("exact.ptn")).unwrap(), std::fs::read(folder.join("walk.ptn")).unwrap());
    assert!(!succeeds(folder, &["convert", &walk, "-o", "plain.ptn", "--effort", "fast"]).contains("keys:"));
    assert!(!is_keys("plain.ptn"));
}

#[test]
fn a_bank_holds_clips_of_both_kinds() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let joy = own("face/joy.keys");
    succeeds(folder, &["convert", &joy, "-o", "keys.ptn", "--keys"]);
    succeeds(folder, &["convert", &joy, "-o", "segments.ptn"]);
    for (names, version) in [(&["segments.ptn", "keys.ptn"][..], 2), (&["segments.ptn"], 1)] {
        succeeds(folder, &[&["pack"][..], names, &["-o", "faces.ptb"]].concat());
        let mut bytes = std::fs::read(folder.join("faces.ptb")).unwrap();
        assert_eq!(bytes[2], version);
        let bank = Bank::new_checked(&bytes).unwrap();
        assert!(bank.entries().all(|entry| bank.open(&entry).unwrap().has_keys() == (entry.name() == "keys")));
        bytes[2] = 3;
        assert_eq!(Bank::new_checked(&bytes).err(), Some(OpenError::UnsupportedVersion(3)));
    }
    succeeds(folder, &["pack", "segments.ptn", "keys.ptn", "-o", "faces.ptb"]);
    succeeds(folder, &["unpack", "faces.ptb", "-o", "out"]);
    for name in ["keys.ptn", "segments.ptn"] {
        assert_eq!(std::fs::read(folder.join("out").join(name)).unwrap(), std::fs::read(folder.join(name)).unwrap(), "{name}");
    }
}

#[test]
fn boards_and_lines_refuse_key_clips_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    succeeds(folder, &["convert", &own("walk.keys"), "-o", "walk.ptn", "--effort", "fast", "--keys"]);
    succeeds(folder, &["pack", "walk.ptn", "-o", "moves.ptb"]);
    for clip in ["walk.ptn", "moves.ptb"] {
        let error = refusal(folder, &["flash-image", clip, "-o", "image.bin", "--board", "pico"]);
        assert!(error.contains("key clip") && error.contains("without --keys"), "{error}");
    }
    let error = refusal(folder, &["stream", "walk.ptn", "--to", "tcp:127.0.0.1:9"]);
    assert!(error.contains("a key clip cannot be sent"), "{error}");
    let info = pantin(folder, &["info", "walk.ptn", "--json"]);
    let info: serde_json::Value = serde_json::from_slice(&info.stdout).unwrap();
    assert_eq!(
        (&info["keys"], &info["segments"], &info["boards"]),
        (&107.into(), &serde_json::Value::Null, &serde_json::json!([]))
    );
}

#[test]
fn expand_writes_the_keys_as_text_again() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    succeeds(folder, &["convert", &own("greet.keys"), "-o", "greet.ptn", "--effort", "fast", "--keys"]);
    succeeds(folder, &["expand", "greet.ptn", "-o", "back.keys"]);
    succeeds(folder, &["convert", "back.keys", "-o", "again.ptn", "--effort", "fast", "--keys"]);
    assert_eq!(std::fs::read(folder.join("again.ptn")).unwrap(), std::fs::read(folder.join("greet.ptn")).unwrap());
    succeeds(folder, &["convert", &own("greet.keys"), "-o", "segments.ptn", "--effort", "fast"]);
    let error = refusal(folder, &["expand", "segments.ptn", "-o", "none.keys"]);
    assert!(error.contains("the clip holds segments, no keys") && !folder.join("none.keys").exists(), "{error}");
}
