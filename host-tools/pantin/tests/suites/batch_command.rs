//! `pantin convert` of a folder: one bad file does not stop the rest, and what is up to date is left alone.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let folder = std::env::temp_dir().join(format!("pantin-batch-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(folder.join("in/below")).unwrap();
        Folder(folder)
    }

    fn put(&self, name: &str, text: &str) {
        std::fs::write(self.0.join("in").join(name), text).unwrap();
    }

    fn convert(&self, more: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_pantin"))
            .args(["convert", "in", "-o", "out"])
            .args(more)
            .current_dir(&self.0)
            .output()
            .unwrap()
    }

    fn clip(&self, name: &str) -> PathBuf {
        self.0.join("out").join(name)
    }

    /// Names of all clips, in order.
    fn clips(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.join("out")).unwrap();
        let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn run_keys() -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions/run.keys")).unwrap()
}

#[test]
fn a_bad_file_does_not_stop_the_rest_and_a_rerun_does_what_is_left() {
    let folder = Folder::new("rerun");
    folder.put("run.keys", &run_keys());
    folder.put("below/light.csv", "time,a\n0,0\n0.1,1\n0.2,0.5\n");
    folder.put("broken.bvh", "HIERARCHY\nROOT\n");
    folder.put("readme.txt", "no motion");
    let first = folder.convert(&["--jobs", "2"]);
    let (out, err) = (text(&first.stdout), text(&first.stderr));
    assert!(!first.status.success());
    assert!(folder.clip("run.ptn").exists() && folder.clip("below/light.ptn").exists() && !folder.clip("broken.ptn").exists());
    assert!(out.contains("broken.bvh") && out.contains("REFUSED: ") && out.contains("broken.bvh:"), "{out}");
    assert!(err.contains("2 converted, 0 up to date, 1 refused, 1 other files passed over"), "{err}");
    assert!(err.contains("1 of 3 files could not be converted"), "{err}");
    let left = std::fs::read_dir(folder.0.join("out")).unwrap().count();
    assert_eq!(left, 2, "clips and folders alone are written");

    std::fs::remove_file(folder.0.join("in/broken.bvh")).unwrap();
    let again = folder.convert(&[]);
    assert!(
        again.status.success() && text(&again.stderr).contains("0 converted, 2 up to date, 0 refused"),
        "{}",
        text(&again.stderr)
    );
    let other = folder.convert(&["--max-error", "2cm"]);
    assert!(text(&other.stderr).contains("2 converted, 0 up to date"), "{}", text(&other.stderr));
    folder.put("run.keys", &format!("{}\n# changed\n", run_keys()));
    let changed = folder.convert(&["--max-error", "2cm"]);
    assert!(text(&changed.stderr).contains("1 converted, 1 up to date"), "{}", text(&changed.stderr));
}

#[test]
fn sources_of_one_name_do_not_write_one_clip() {
    let folder = Folder::new("names");
    folder.put("light.csv", "time,a\n0,0\n0.1,1\n0.2,0.5\n");
    folder.put("light.tsv", "time\ta\n0\t0\n0.1\t1\n0.2\t0.5\n");
    let done = folder.convert(&["--json"]);
    assert!(done.status.success(), "{}", text(&done.stderr));
    assert!(folder.clip("light.csv.ptn").exists() && folder.clip("light.tsv.ptn").exists());
    let json: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    assert_eq!((json["files"][0]["frames"].as_u64(), json["files"][1]["frames"].as_u64()), (Some(3), Some(3)));
}

#[test]
fn a_folder_without_motions_is_refused() {
    let folder = Folder::new("none");
    folder.put("readme.txt", "no motion");
    let done = folder.convert(&[]);
    assert!(!done.status.success());
    assert!(text(&done.stderr).contains("no motion files in it; 1 others"), "{}", text(&done.stderr));
}

#[test]
fn edits_work_together_in_one_command() {
    let folder = Folder::new("edits");
    let keys = run_keys();
    folder.put("run.keys", &keys);
    let run = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pantin"));
        command.args(["convert", "in/run.keys", "-o", "run.ptn", "--json"]).args(more).current_dir(&folder.0);
        command.output().unwrap()
    };
    let done = run(&["--fps", "60", "--from", "2", "--to", "20", "--mirror", "--max-error", "0.5%"]);
    assert!(done.status.success(), "{}", text(&done.stderr));
    let json: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    assert!(json["max_error_percent_of_height"].as_f64().unwrap() <= 0.5);
    assert!(
        text(&done.stderr).contains("19 frames") && text(&done.stderr).contains("% of the figure's height"),
        "{}",
        text(&done.stderr)
    );
    let refused = run(&["--loop", "--exact"]);
    assert!(!refused.status.success());
    let refused = run(&["--map", "names.txt"]);
    assert!(!refused.status.success());
}

const LIGHT: &str = "time,a\n0,0\n0.1,1\n0.2,0.5\n";

#[test]
fn names_that_meet_are_told_apart_before_anything_is_written() {
    let folder = Folder::new("meet");
    // `a.bvh` and `a.keys` have one stem, and `a.bvh.keys` is called as the clip of `a.bvh` would be.
    for name in ["a.tsv", "a.csv", "a.tsv.csv"] {
        folder.put(name, &LIGHT.replace(',', if name.ends_with(".tsv") { "\t" } else { "," }));
    }
    let done = folder.convert(&[]);
    assert!(done.status.success(), "{}", text(&done.stderr));
    assert_eq!(folder.clips(), ["a.csv.ptn", "a.tsv.csv.ptn", "a.tsv.ptn"]);
}

#[cfg(unix)]
#[test]
fn clips_that_links_lead_to_one_file_are_refused() {
    let folder = Folder::new("links");
    folder.put("a.csv", LIGHT);
    folder.put("b.csv", LIGHT);
    std::fs::create_dir(folder.0.join("out")).unwrap();
    std::os::unix::fs::symlink("a.ptn", folder.clip("b.ptn")).unwrap();
    std::fs::write(folder.clip("a.ptn"), "old").unwrap();
    let done = folder.convert(&[]);
    assert!(!done.status.success() && text(&done.stderr).contains("one file"), "{}", text(&done.stderr));
    assert_eq!(std::fs::read(folder.clip("a.ptn")).unwrap(), b"old");
}

#[cfg(unix)]
#[test]
fn a_clip_that_leads_to_its_own_source_is_refused() {
    let folder = Folder::new("own");
    folder.put("a.csv", LIGHT);
    std::fs::create_dir(folder.0.join("out")).unwrap();
    std::os::unix::fs::symlink("../in/a.csv", folder.clip("a.ptn")).unwrap();
    let done = folder.convert(&[]);
    assert!(!done.status.success() && text(&done.stderr).contains("is the input"), "{}", text(&done.stderr));
    assert_eq!(std::fs::read_to_string(folder.0.join("in/a.csv")).unwrap(), LIGHT);
}

#[cfg(unix)]
#[test]
fn a_pipe_in_the_folder_is_passed_over() {
    let folder = Folder::new("pipe");
    folder.put("a.csv", LIGHT);
    if !Command::new("mkfifo").arg(folder.0.join("in/pipe.bvh")).status().is_ok_and(|status| status.success()) {
        eprintln!("skipped: no mkfifo");
        return;
    }
    let done = folder.convert(&[]);
    assert!(done.status.success() && text(&done.stderr).contains("1 other files"), "{}", text(&done.stderr));
}

#[test]
fn a_change_of_any_file_that_was_read_converts_again() {
    let folder = Folder::new("changes");
    folder.put("run.keys", &run_keys());
    let with = folder.0.join("face.csv");
    std::fs::write(&with, LIGHT).unwrap();
    let run = || folder.convert(&["--with", "face.csv", "--effort", "fast"]);
    assert!(run().status.success());
    assert!(text(&run().stderr).contains("1 up to date"));
    std::fs::write(&with, LIGHT.replace("0.5", "0.25")).unwrap();
    assert!(text(&run().stderr).contains("1 converted"), "{}", text(&run().stderr));
    assert!(text(&run().stderr).contains("1 up to date"));
}

#[test]
fn a_change_of_a_buffer_beside_a_gltf_converts_again() {
    let folder = Folder::new("buffer");
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pantin"));
        command.args(arguments).current_dir(&folder.0).output().unwrap()
    };
    folder.put("light.csv", LIGHT);
    assert!(run(&["convert", "in/light.csv", "-o", "light.ptn"]).status.success());
    assert!(run(&["expand", "light.ptn", "-o", "light.glb"]).status.success());
    std::fs::remove_file(folder.0.join("in/light.csv")).unwrap();
    let glb = gltf::Glb::from_slice(&std::fs::read(folder.0.join("light.glb")).unwrap()).unwrap().json.into_owned();
    let bytes = std::fs::read(folder.0.join("light.glb")).unwrap();
    let mut buffer = gltf::Glb::from_slice(&bytes).unwrap().bin.unwrap().into_owned();
    let mut json: serde_json::Value = serde_json::from_slice(&glb).unwrap();
    json["buffers"][0]["uri"] = "numbers.of light".into();
    json["buffers"][0]["byteLength"] = buffer.len().into();
    folder.put("light.gltf", &json.to_string());
    let numbers = folder.0.join("in/numbers.of light");
    std::fs::write(&numbers, &buffer).unwrap();
    assert!(folder.convert(&[]).status.success());
    assert!(text(&folder.convert(&[]).stderr).contains("1 up to date"));
    buffer.extend([0; 4]);
    std::fs::write(&numbers, &buffer).unwrap();
    assert!(text(&folder.convert(&[]).stderr).contains("1 converted"));
}

#[test]
fn a_cut_clip_with_the_right_time_is_converted_again() {
    let folder = Folder::new("cut");
    folder.put("a.csv", LIGHT);
    assert!(folder.convert(&[]).status.success());
    let clip = folder.clip("a.ptn");
    let (whole, time) = (std::fs::read(&clip).unwrap(), std::fs::metadata(&clip).unwrap().modified().unwrap());
    std::fs::write(&clip, &whole[..whole.len() - 3]).unwrap();
    std::fs::File::options().write(true).open(&clip).unwrap().set_modified(time).unwrap();
    let again = folder.convert(&[]);
    assert!(text(&again.stderr).contains("1 converted") && std::fs::read(&clip).unwrap() == whole, "{}", text(&again.stderr));
}

#[test]
fn every_warning_and_under_quiet_every_failure_is_printed() {
    let folder = Folder::new("warnings");
    folder.put("gap.csv", "time,a\n0,0\n0.1,1\n0.2,0.5\n0.5,0\n");
    folder.put("bad.bvh", "HIERARCHY\n");
    let done = folder.convert(&[]);
    assert!(text(&done.stderr).contains("gap.csv: warning: "), "{}", text(&done.stderr));
    let quiet = folder.convert(&["-q"]);
    assert!(!quiet.status.success() && quiet.stdout.is_empty());
    assert!(text(&quiet.stderr).contains("bad.bvh: ") && !text(&quiet.stderr).contains("gap.csv"), "{}", text(&quiet.stderr));
}

#[test]
fn shards_make_the_clips_of_one_run() {
    let folder = Folder::new("shards");
    let table = |last: usize| format!("time,a\n0,0\n0.1,1\n0.2,0.{last}\n");
    for number in 1..=5 {
        folder.put(&format!("light{number}.csv"), &table(number));
    }
    // Their clips keep their whole names, whichever shard makes them.
    folder.put("light1.tsv", &table(7).replace(',', "\t"));
    let mut converted = 0;
    for part in ["1/2", "2/2"] {
        let done = folder.convert(&["--shard", part, "--json"]);
        assert!(done.status.success(), "{}", text(&done.stderr));
        let json: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
        converted += json["files"].as_array().unwrap().len();
        assert_eq!(folder.clips().len(), converted);
    }
    let of_shards: Vec<Vec<u8>> = folder.clips().iter().map(|name| std::fs::read(folder.clip(name)).unwrap()).collect();
    let whole = folder.convert(&[]);
    assert!(text(&whole.stderr).contains("0 converted, 6 up to date"), "{}", text(&whole.stderr));
    std::fs::remove_dir_all(folder.0.join("out")).unwrap();
    assert!(folder.convert(&[]).status.success());
    let of_one: Vec<Vec<u8>> = folder.clips().iter().map(|name| std::fs::read(folder.clip(name)).unwrap()).collect();
    assert!(of_one == of_shards);
    // More shards than files: the last have nothing to do.
    let empty = folder.convert(&["--shard", "20/20"]);
    assert!(
        empty.status.success() && text(&empty.stderr).contains("0 converted, 0 up to date, 0 refused"),
        "{}",
        text(&empty.stderr)
    );
}

#[test]
fn what_cannot_be_divided_has_no_shards() {
    let folder = Folder::new("no-shards");
    folder.put("light.csv", "time,a\n0,0\n0.1,1\n0.2,0.5\n");
    for (arguments, why) in [
        (["in/light.csv", "-o", "light.ptn", "--shard", "1/2"], "--shard divides several files"),
        (["in", "-o", "moves.ptb", "--shard", "1/2"], "a bank holds all of them"),
        (["in", "-o", "out", "--shard", "3/2"], "I from 1 to N"),
    ] {
        let refused =
            Command::new(env!("CARGO_BIN_EXE_pantin")).arg("convert").args(arguments).current_dir(&folder.0).output().unwrap();
        assert!(!refused.status.success() && text(&refused.stderr).contains(why), "{}", text(&refused.stderr));
    }
    assert!(!folder.0.join("out").exists());
}
