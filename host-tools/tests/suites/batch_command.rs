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
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../motions/run.keys")).unwrap()
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
    assert_eq!((json[0]["frames"].as_u64(), json[1]["frames"].as_u64()), (Some(3), Some(3)));
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
