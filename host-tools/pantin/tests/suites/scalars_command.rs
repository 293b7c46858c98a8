//! A motion without joints through the commands: convert, expand, render, and what they say.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("pantin-scalars-command-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    fn path(&self, name: &str) -> String {
        self.0.join(name).display().to_string()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // There is nothing to be done about one that stays.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn pantin(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pantin")).args(arguments).output().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Values near the ends of what a power of two holds, jumps, and a channel at rest.
fn table(path: &str) {
    let row = |frame: u32| {
        let top = if frame % 90 < 60 { 0.9999 } else { 0.3 };
        let bottom = if frame % 70 < 40 { -0.99999 } else { 0.99 };
        let sine = 0.99999 * f64::from(frame).sin();
        format!("{},{top},{bottom},{sine},{},7\n", f64::from(frame) / 50.0, frame / 37 % 3)
    };
    std::fs::write(path, "time,top,bottom,sine,step,still\n".to_string() + &(0..200).map(row).collect::<String>()).unwrap();
}

fn columns(path: &str) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(path).unwrap();
    let rows: Vec<Vec<f64>> =
        text.lines().skip(1).map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    (1..rows[0].len()).map(|column| rows.iter().map(|row| row[column]).collect()).collect()
}

#[test]
fn every_value_is_within_the_bound_it_was_converted_with() {
    let folder = Folder::new("bound");
    let [source, clip, back] = ["servos.csv", "servos.ptn", "back.csv"].map(|name| folder.path(name));
    table(&source);
    for percent in ["0.01", "2", "30"] {
        let made = pantin(&["convert", &source, "-o", &clip, "--max-scalar-error", percent, "--json"]);
        assert!(made.status.success(), "{percent} %: {}", stderr(&made));
        assert!(stderr(&made).contains("scalars' error max") && !stderr(&made).contains(" cm ("), "{}", stderr(&made));
        let json: serde_json::Value = serde_json::from_slice(&made.stdout).unwrap();
        let told = json["max_scalar_error_percent"].as_f64().unwrap();
        assert!(json.get("max_error_cm").is_none() && json["worst_scalar"].is_string() && json["worst_scalar_frame"].is_u64());
        assert!(pantin(&["expand", &clip, "-o", &back]).status.success());
        let worst = columns(&source).iter().zip(columns(&back)).fold(0f64, |worst, (source, back)| {
            let peak = source.iter().fold(0f64, |peak, x| peak.max(x.abs()));
            let off = source.iter().zip(back).fold(0f64, |off, (a, b)| off.max((a - b).abs()));
            worst.max(100.0 * off / peak)
        });
        assert!(worst <= percent.parse::<f64>().unwrap() && (worst - told).abs() < 1e-4, "{percent} %: {worst}, told {told}");
    }
    let by_channel = pantin(&["convert", &source, "-o", &clip, "--max-channel-error", "2", "-q"]);
    assert!(by_channel.status.success(), "{}", stderr(&by_channel));
}

#[test]
fn a_bound_of_nothing_is_refused_by_name() {
    for nothing in ["0", "-1", "nan", "inf", "two"] {
        let refused = pantin(&["convert", "face.csv", "-o", "face.ptn", &format!("--max-scalar-error={nothing}")]);
        assert_eq!(refused.status.code(), Some(2));
        assert!(stderr(&refused).contains("--max-scalar-error") && stderr(&refused).contains("expected a number above 0"));
    }
}

#[test]
fn a_chart_is_drawn_and_what_cannot_be_is_refused() {
    let folder = Folder::new("render");
    let [source, clip, chart] = ["servos.csv", "servos.ptn", "servos.png"].map(|name| folder.path(name));
    table(&source);
    assert!(pantin(&["convert", &source, "-o", &clip, "--effort", "fast"]).status.success());
    assert!(pantin(&["render", &clip, "-o", &chart]).status.success());
    assert!(std::fs::read(&chart).unwrap().starts_with(b"\x89PNG"));
    for (output, part) in [("x.gif", "without joints"), ("x.bvh", "expected a name that ends in .gif, .apng, .png or .svg")] {
        let refused = pantin(&["render", &clip, "-o", &folder.path(output)]);
        assert!(!refused.status.success() && stderr(&refused).contains(part), "{}", stderr(&refused));
    }
    for (input, output, part) in [
        (&clip, "x.bvh", "`top` moves no joint"),
        (&clip, "x.txt", ".bvh, .glb, .keys, .csv, .h or .rs"),
        (&source, "x.h", "servos.csv: "),
        (&source, "x.rs", "servos.csv: "),
    ] {
        let refused = pantin(&["expand", input, "-o", &folder.path(output)]);
        assert!(!refused.status.success() && stderr(&refused).contains(part), "{}", stderr(&refused));
        assert!(!Path::new(&folder.path(output)).exists());
    }
}
