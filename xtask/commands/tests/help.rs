//! Every command that `cargo xtask` lists prints its help.

use std::process::Command;

#[test]
fn every_listed_command_prints_its_help() {
    let list = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../src/main.rs")).unwrap();
    let names: Vec<&str> = list
        .lines()
        .filter_map(|line| line.trim().strip_prefix("(\"")?.split_once("\", COMMANDS"))
        .map(|(name, _)| name)
        .collect();
    assert!(names.len() > 10, "{names:?}");
    for name in names {
        let output = Command::new(env!("CARGO_BIN_EXE_xtask-commands")).args([name, "--help"]).output().unwrap();
        let (help, complaints) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert!(output.status.success() && help.contains(&format!("Usage: cargo xtask {name}")), "{name}: {help}{complaints}");
    }
}
