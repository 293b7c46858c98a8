//! What reaches a terminal, and what happens where nobody reads it.

use super::outputs::{Folder, err};
use std::fs::File;
use std::process::Stdio;

const HOSTILE: &str = "time,a\u{1b}]0;owned\u{7},b\u{202e}c\n0,0,1\n0.1,1,2\n0.2,0.5,3\n";

#[test]
fn control_characters_of_names_stay_out_of_messages_and_tables() {
    let folder = Folder::new();
    folder.put("a.csv", HOSTILE);
    folder.put("in/x\u{1b}[31m.csv", HOSTILE);
    folder.put("in/bad\u{1b}[31m.bvh", "HIERARCHY\nROOT \u{1b}[31m{ OFFSET 0 0 0 CHANNELS 1 Bad\u{1b}[0m");
    folder.done(&["convert", "a.csv", "-o", "a.ptn"]);
    let runs: [&[&str]; 8] = [
        &["convert", "a.csv", "-o", "b.ptn"],
        &["convert", "a.csv", "-o", "b.ptn", "--json"],
        &["convert", "a.csv", "-o", "b.ptn", "--max-channel-error", "1"],
        &["convert", "in", "-o", "out"],
        &["convert", "in", "-o", "out", "--json"],
        &["convert", "in/bad\u{1b}[31m.bvh", "-o", "c.ptn"],
        &["info", "a.ptn"],
        &["play", "a.ptn", "--plain", "--frames", "1"],
    ];
    for arguments in runs {
        let output = folder.run(arguments);
        let text = String::from_utf8_lossy(&output.stdout).into_owned() + &err(&output);
        let hostile = text.chars().find(|c| (c.is_control() && *c != '\n') || *c == '\u{202e}');
        assert_eq!(hostile, None, "{arguments:?}: {text:?}");
    }
}

#[cfg(unix)]
#[test]
fn a_closed_or_full_output_ends_no_command_with_a_panic() {
    let folder = Folder::new();
    folder.done(&["convert", "run.keys", "-o", "a.ptn"]);
    folder.put("in/a.csv", "time,a\n0,0\n0.1,1\n");
    let runs: [&[&str]; 9] = [
        &["info", "a.ptn"],
        &["info", "a.ptn", "--json"],
        &["convert", "run.keys", "-o", "b.ptn", "--json"],
        &["convert", "in", "-o", "out"],
        &["expand", "a.ptn", "-o", "/dev/stdout.csv"],
        &["face", "model", "-o", "face.model"],
        &["play", "a.ptn", "--plain"],
        &["convert", "run.keys", "-o", "-"],
        &["--help"],
    ];
    for arguments in runs {
        let full = || File::options().write(true).open("/dev/full").unwrap();
        let status = folder.command(arguments).stdout(full()).stderr(full()).status().unwrap();
        assert!(matches!(status.code(), Some(0 | 1)), "{arguments:?}, full: {status}");
        let mut child = folder.command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        // Both readers are gone before the first line.
        drop((child.stdout.take(), child.stderr.take()));
        let status = child.wait().unwrap();
        assert!(matches!(status.code(), Some(0 | 1 | 141)), "{arguments:?}, closed: {status}");
    }
    // What was asked for was not printed.
    for arguments in [&["--help"][..], &["--version"], &["convert", "-h"], &["help", "render"], &["man"], &["completions", "zsh"]]
    {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let output = folder.command(arguments).stdout(full).stderr(Stdio::piped()).output().unwrap();
        let said = err(&output);
        assert!(output.status.code() == Some(1) && said.starts_with("error: "), "{arguments:?}: {} {said}", output.status);
        let mut child = folder.command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        // A short text may have been written before the reader went away.
        assert!(matches!(output.status.code(), Some(0 | 141)) && output.stderr.is_empty(), "{arguments:?}: {}", output.status);
    }
    let mut child = folder.command(&["play", "a.ptn", "--plain"]).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.code() == Some(141) && output.stderr.is_empty(), "{}: {}", output.status, err(&output));
}
