//! The notes of odd motions, which no way of converting loses: `tests/odd/notes.json` lists their kinds for all front ends.

use super::outputs::{Folder, err};
use pantin_convert::import::Disk;
use pantin_convert::{Level, Note, Options, Recipe};
use pantin_tools::words;
use serde_json::{Value, json};
use std::path::PathBuf;

fn odd() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../tests/odd")
}

fn listed() -> Vec<Value> {
    serde_json::from_str(&std::fs::read_to_string(odd().join("notes.json")).unwrap()).unwrap()
}

#[test]
fn convert_reports_the_kinds_that_are_listed() {
    let folder = Folder::new();
    for entry in listed() {
        let file = odd().join(entry["file"].as_str().unwrap());
        let fps = entry["fps"].as_f64().map(|fps| fps.to_string());
        let mut arguments = vec!["convert", file.to_str().unwrap(), "-o", "odd.ptn", "--json", "--max-error", "0.5cm"];
        arguments.extend(["--effort", "fast"]);
        arguments.extend(fps.iter().flat_map(|fps| ["--fps", fps]));
        let output = folder.run(&arguments);
        let report: Value = serde_json::from_slice(&output.stdout).unwrap_or_default();
        let Some(kinds) = entry["outcome"]["notes"].as_array() else {
            assert!(!output.status.success(), "{file:?} converts");
            continue;
        };
        let diagnostics = report["diagnostics"].as_array().unwrap_or_else(|| panic!("{file:?}: {}", err(&output)));
        let kind = |note: &Value| json!(format!("{} {}", note["severity"].as_str().unwrap(), note["kind"].as_str().unwrap()));
        assert_eq!(diagnostics.iter().map(kind).collect::<Vec<_>>(), *kinds, "{file:?}");
    }
}

/// What a command that shows a motion must print: the notes of a fast conversion that bounds places.
fn shown(file: &str) -> Vec<String> {
    let recipe = Recipe::new().options(Options::new().effort(Level::FAST).places_only(true));
    let converted = recipe.convert(&Disk::default(), &odd().join(file), &mut |_| ()).unwrap();
    converted.notes.iter().map(|note: &Note| words::line(note)).collect()
}

#[test]
fn render_and_play_report_what_convert_does() {
    let folder = Folder::new();
    for file in ["two-joints.bvh", "guessed-unit.bvh", "helpers.gltf"] {
        let path = odd().join(file);
        let path = path.to_str().unwrap();
        let rendered = err(&folder.done(&["render", path, "-o", "odd.png"]));
        let played = err(&folder.run(&["play", path, "--once", "--plain"]));
        for line in shown(file) {
            assert!(rendered.contains(&line), "render {file}: no `{line}` in: {rendered}");
            assert!(played.contains(&line), "play {file}: no `{line}` in: {played}");
        }
    }
}

#[test]
fn a_dry_run_reads_and_writes_nothing() {
    let folder = Folder::new();
    let before = folder.names();
    let said = err(&folder.done(&["convert", "run.keys", "-o", "run.ptn", "--dry-run"]));
    assert!(said.contains("run.ptn: would be written") && said.contains("26 frames"), "{said}");
    folder.put("in/walk.keys", folder.get("run.keys"));
    let output = folder.done(&["convert", "in", "-o", "out", "--dry-run"]);
    assert!(String::from_utf8_lossy(&output.stdout).contains("would become out/walk.ptn"), "{}", err(&output));
    folder.done(&["convert", "in", "-o", "moves.ptb", "--dry-run"]);
    assert!(folder.refused(&["convert", "none.keys", "-o", "none.ptn", "--dry-run"]).contains("none.keys"));
    let mut after = folder.names();
    after.retain(|name| name != "in");
    assert_eq!(after, before);
}

#[test]
fn info_measures_a_clip_against_its_motion() {
    let folder = Folder::new();
    let made: Value = serde_json::from_slice(&folder.done(&["convert", "run.keys", "-o", "run.ptn", "--json"]).stdout).unwrap();
    let told: Value =
        serde_json::from_slice(&folder.done(&["info", "run.ptn", "--against", "run.keys", "--json"]).stdout).unwrap();
    for field in ["max_error_cm", "max_shell_cm", "max_rotation_deg", "max_joint_rotation_deg"] {
        let [made, told] = [&made[field], &told["errors"][field]].map(|value| value.as_f64().unwrap());
        assert!((made - told).abs() < 1e-9, "{field}: {made}, {told}");
    }
    folder.put("other.keys", String::from_utf8(folder.get("run.keys")).unwrap().replace("head", "skull"));
    assert!(folder.refused(&["info", "run.ptn", "--against", "other.keys"]).contains("other names"));
}
