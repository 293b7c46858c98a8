//! Outputs of all commands: no input is overwritten, no file is replaced by half of one, and what is no regular file stays what it is.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

pub struct Folder(TempDir);

impl Folder {
    pub fn new() -> Folder {
        let folder = Folder(TempDir::new().unwrap());
        let motions = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions");
        std::fs::copy(motions.join("run.keys"), folder.path("run.keys")).unwrap();
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn put(&self, name: &str, bytes: impl AsRef<[u8]>) {
        if let Some(folder) = self.path(name).parent() {
            std::fs::create_dir_all(folder).unwrap();
        }
        std::fs::write(self.path(name), bytes).unwrap();
    }

    pub fn get(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap()
    }

    /// Names in the folder, in order.
    pub fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pantin"));
        command.args(arguments).current_dir(self.0.path());
        command
    }

    pub fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Runs the command, which must succeed.
    pub fn done(&self, arguments: &[&str]) -> Output {
        let output = self.run(arguments);
        assert!(output.status.success(), "{arguments:?}: {}", err(&output));
        output
    }

    /// Runs the command, which must fail without a panic, and returns what it says.
    pub fn refused(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {}", err(&output));
        err(&output)
    }
}

pub fn err(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn what_a_faces_options_cannot_do_is_said() {
    let folder = Folder::new();
    folder.put("ball.points", "8.3 31\n");
    let output = folder.run(&["face", "model", "--cartoon", "--points", "ball.points", "-o", "a.model"]);
    assert!(output.status.code() == Some(2) && !folder.path("a.model").exists(), "{}", err(&output));
    let said = |arguments: &[&str]| err(&folder.done(&[&["face", "model", "--small", "-o"], arguments].concat()));
    assert!(said(&["b.model", "--cartoon"]).contains("--small has no effect"));
    assert!(!said(&["c.model"]).contains("no effect"));
}

#[test]
fn a_faces_names_are_an_output_like_any_other() {
    let folder = Folder::new();
    let motion = folder.get("run.keys");
    folder.refused(&["face", "model", "-o", "face.model", "--names", "run.keys"]);
    assert_eq!(folder.get("run.keys"), motion);
    let said = folder.refused(&["face", "model", "-o", "twins", "--names", "./twins"]);
    assert!(said.contains("both outputs are one file"), "{said}");
    folder.refused(&["face", "model", "-o", "face.model", "--names", "nowhere/names.txt"]);
    assert_eq!(folder.names(), ["run.keys"]);
    folder.done(&["face", "model", "-o", "face.model", "--names", "names.txt"]);
    assert_eq!(folder.names(), ["face.model", "names.txt", "run.keys"]);
}

#[cfg(unix)]
#[test]
fn a_batchs_clips_are_no_sources_by_links_and_no_pipes() {
    let folder = Folder::new();
    let motion = folder.get("run.keys");
    folder.put("in/run.keys", &motion);
    folder.put("in/walk.keys", &motion);
    std::fs::create_dir(folder.path("out")).unwrap();
    std::os::unix::fs::symlink("../in/run.keys", folder.path("out/walk.ptn")).unwrap();
    for inputs in [&["in"][..], &["in/walk.keys", "in/run.keys"]] {
        let said = folder.refused(&[&["convert"], inputs, &["-o", "out"]].concat());
        assert!(said.contains("is the input"), "{said}");
    }
    assert_eq!(folder.get("in/run.keys"), motion);
    std::fs::remove_file(folder.path("out/walk.ptn")).unwrap();
    assert!(Command::new("mkfifo").arg(folder.path("out/walk.ptn")).status().unwrap().success());
    let said = folder.refused(&["convert", "in", "-o", "out"]);
    assert!(said.contains("no regular file"), "{said}");
}

#[cfg(target_os = "linux")]
#[test]
fn an_input_is_no_output_by_a_name_below_proc() {
    let folder = Folder::new();
    let motion = folder.get("run.keys");
    folder.put("mine.ptn", &motion);
    let said = folder.refused(&["convert", "mine.ptn", "-o", "/proc/self/cwd/mine.ptn"]);
    assert!(said.contains("is the input"), "{said}");
    assert_eq!(folder.get("mine.ptn"), motion);
}

#[cfg(target_os = "linux")]
#[test]
fn a_new_output_can_have_a_name_below_proc() {
    let folder = Folder::new();
    folder.done(&["convert", "run.keys", "-o", "/proc/self/cwd/new.ptn", "--effort", "fast"]);
    folder.put("old.ptn", "old");
    folder.done(&["convert", "run.keys", "-o", "/proc/self/cwd/old.ptn", "--effort", "fast"]);
    assert_eq!(folder.get("new.ptn"), folder.get("old.ptn"));
    let said = folder.refused(&["convert", "run.keys", "-o", "/proc/self/cwd/a.ptn", "--rig-out", "a.ptn"]);
    assert!(said.contains("one file") || said.contains("a rig's name"), "{said}");
    assert_eq!(folder.names(), ["new.ptn", "old.ptn", "run.keys"]);
}

/// A glTF whose buffer is a file: a node that moves, and a mesh with a morph target.
fn gltf(buffer: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"name":"a","children":[1]}},{{"name":"b","translation":[0,1,0]}}],
        "buffers":[{{"byteLength":44,"uri":"{buffer}"}}],
        "bufferViews":[{{"buffer":0,"byteLength":8}},{{"buffer":0,"byteOffset":8,"byteLength":36}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[1]}},
        {{"bufferView":1,"componentType":5126,"count":2,"type":"VEC3"}},
        {{"bufferView":1,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,1]}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":2}},"targets":[{{"POSITION":2}}]}}]}}],
        "animations":[{{"samplers":[{{"input":0,"output":1}}],"channels":[{{"sampler":0,"target":{{"node":0,"path":"translation"}}}}]}}]}}"#
    )
}

#[test]
fn a_gltfs_own_buffer_is_no_output_of_any_command() {
    let folder = Folder::new();
    let numbers: [f32; 11] = [0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.5, 0.25, 1.0, 1.0, 0.0];
    let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    for (name, arguments) in [
        ("a.ptn", &["convert", "a.gltf", "-o", "a.ptn"][..]),
        ("a.png", &["render", "a.gltf", "--frame", "0", "-o", "a.png"]),
        ("plain", &["render", "a.gltf", "--format", "gif", "-o", "./plain"]),
        ("plain", &["face", "model", "a.gltf", "-o", "plain"]),
        ("names", &["face", "model", "a.gltf", "-o", "a.model", "--names", "names"]),
    ] {
        folder.put("a.gltf", gltf(name));
        folder.put(name, &bytes);
        let said = folder.refused(arguments);
        assert!(said.contains("is the input"), "{arguments:?}: {said}");
        assert_eq!(folder.get(name), bytes, "{arguments:?}");
        std::fs::remove_file(folder.path(name)).unwrap();
    }
    // In a batch, it can be the buffer of another motion.
    folder.put("in/a.gltf", gltf("run.ptn"));
    folder.put("in/run.ptn", &bytes);
    folder.put("in/run.keys", folder.get("run.keys"));
    let said = folder.refused(&["convert", "in/run.keys", "in/a.gltf", "-o", "in"]);
    assert!(said.contains("is the input") && folder.get("in/run.ptn") == bytes, "{said}");
    assert_eq!(folder.names(), ["a.gltf", "in", "run.keys"]);
}

#[test]
fn a_name_that_the_user_does_not_give_replaces_nothing() {
    let folder = Folder::new();
    folder.done(&["convert", "run.keys", "-o", "a.ptn", "--effort", "fast"]);
    let runs: [(&str, &[&str]); 7] = [
        ("run.ptn", &["convert", "run.keys"]),
        ("a.gif", &["render", "a.ptn"]),
        ("a.png", &["render", "a.ptn", "--frame", "0"]),
        ("a.bvh", &["expand", "a.ptn"]),
        ("a.uf2", &["flash-image", "a.ptn", "--board", "pico"]),
        ("a.hex", &["flash-image", "a.ptn", "--board", "microbit"]),
        ("a.bin", &["flash-image", "a.ptn", "--board", "esp32-c3"]),
    ];
    for (name, arguments) in runs {
        folder.put(name, "mine");
        let said = folder.refused(arguments);
        assert!(said.contains(&format!("{name}: exists; --output {name} replaces it")), "{arguments:?}: {said}");
        assert_eq!(folder.get(name), b"mine");
        folder.done(&[arguments, &["-o", name]].concat());
        assert_ne!(folder.get(name), b"mine");
        // A link that leads nowhere is there too.
        #[cfg(unix)]
        {
            std::fs::remove_file(folder.path(name)).unwrap();
            std::os::unix::fs::symlink("nowhere", folder.path(name)).unwrap();
            folder.refused(arguments);
            std::fs::remove_file(folder.path(name)).unwrap();
        }
    }
    // Several motions: a clip that is up to date is not in the way.
    folder.put("light.csv", "time,a\n0,0\n0.1,1\n0.2,0.5\n");
    folder.put("lamp.csv", "time,a\n0,0\n0.1,1\n0.2,0.5\n");
    folder.done(&["convert", "light.csv", "lamp.csv"]);
    folder.done(&["convert", "light.csv", "lamp.csv"]);
    let clip = folder.get("lamp.ptn");
    let said = folder.refused(&["convert", "light.csv", "lamp.csv", "--max-scalar-error", "9", "-q"]);
    assert!(said.contains("light.ptn: exists; --output FOLDER"), "{said}");
    assert_eq!(folder.get("lamp.ptn"), clip);
    folder.done(&["convert", "light.csv", "lamp.csv", "--max-scalar-error", "9", "-o", "."]);
}

#[cfg(unix)]
#[test]
fn a_file_that_may_not_grow_leaves_nothing() {
    let folder = Folder::new();
    folder.done(&["convert", "run.keys", "-o", "run.ptn", "--effort", "fast"]);
    folder.done(&["pack", "run.ptn", "-o", "moves.ptb"]);
    let commands: [&[&str]; 8] = [
        &["render", "run.ptn", "-o", "new.gif"],
        &["render", "run.ptn", "-o", "new.apng"],
        &["render", "run.ptn", "-o", "new.png"],
        &["render", "run.ptn", "-o", "new.svg"],
        &["expand", "run.ptn", "-o", "new.bvh"],
        &["expand", "run.ptn", "-o", "new.csv"],
        &["expand", "run.ptn", "-o", "new.glb"],
        &["face", "sheet", "-o", "new.png"],
    ];
    for arguments in commands {
        let said = err(&small_files(&folder, arguments));
        let output = arguments[arguments.len() - 1];
        assert!(said.starts_with(&format!("error: {output}: cannot be written: ")), "{arguments:?}: {said}");
        // What the program calls it meanwhile is of no use to the user.
        assert!(!said.contains(".pantin-") && said.matches("cannot be written").count() == 1, "{arguments:?}: {said}");
        assert!(said.contains("ulimit -f"), "{arguments:?}: {said}");
    }
    let said = err(&small_files(&folder, &["unpack", "moves.ptb", "-o", "new/deep"]));
    assert!(said.starts_with("error: new/deep/run.ptn: cannot be written: "), "{said}");
    assert_eq!(folder.names(), ["moves.ptb", "run.keys", "run.ptn"]);
}

/// Runs the command, which must fail, where a file may have at most 512 or 1,024 bytes, depending on the shell.
#[cfg(unix)]
fn small_files(folder: &Folder, arguments: &[&str]) -> Output {
    let tool = env!("CARGO_BIN_EXE_pantin");
    let script = "ulimit -f 1; exec \"$@\"";
    let output =
        Command::new("sh").args(["-c", script, "sh", tool]).args(arguments).current_dir(folder.path("")).output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {}", err(&output));
    output
}

#[test]
fn a_folder_that_was_made_for_nothing_goes_again() {
    let folder = Folder::new();
    folder.put("bad/a.bvh", "HIERARCHY\nROOT\n");
    folder.put("other.keys", "keyframes 1\nfps 30\nframes 10\nscalar a scale 1\nkeys linear a\n0 0\n9 1\n");
    std::fs::create_dir(folder.path("empty")).unwrap();
    let before = folder.names();
    let commands: [&[&str]; 5] = [
        &["convert", "bad", "-o", "new"],
        &["convert", "bad", "-o", "new/deep/er"],
        &["convert", "bad", "-o", "empty"],
        &["convert", "bad/a.bvh", "other.keys", "--same-form", "-o", "new/deep"],
        &["convert", "run.keys", "other.keys", "--same-form", "--effort", "fast", "-o", "new"],
    ];
    for arguments in commands {
        folder.refused(arguments);
        // A folder that was there stays.
        assert_eq!(folder.names(), before, "{arguments:?}");
    }
    // One that holds a clip stays too.
    folder.put("bad/b.keys", folder.get("other.keys"));
    folder.refused(&["convert", "bad", "-o", "new"]);
    assert!(folder.path("new/b.ptn").is_file());
}

#[test]
fn clips_of_one_form_have_places_that_are_checked_before_the_work() {
    let folder = Folder::new();
    folder.put("broken.bvh", "HIERARCHY\nROOT\n");
    folder.put("file", "");
    assert!(folder.refused(&["convert", "broken.bvh", "run.keys", "--same-form", "-o", "file"]).contains("needs a folder"));
    std::fs::create_dir_all(folder.path("out/run.ptn")).unwrap();
    let said = folder.refused(&["convert", "broken.bvh", "run.keys", "--same-form", "-o", "out"]);
    assert!(said.contains("run.ptn: no regular file"), "{said}");
}

#[test]
fn an_output_is_not_the_input() {
    let folder = Folder::new();
    let before = folder.get("run.keys");
    folder.put("sub/x", "");
    for output in ["run.keys", "./run.keys", "sub/../run.keys"] {
        let said = folder.refused(&["convert", "run.keys", "-o", output]);
        assert!(said.contains("is the input"), "{said}");
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("run.keys", folder.path("link.ptn")).unwrap();
        std::fs::hard_link(folder.path("run.keys"), folder.path("hard.ptn")).unwrap();
        for output in ["link.ptn", "hard.ptn"] {
            let said = folder.refused(&["convert", "run.keys", "-o", output]);
            assert!(said.contains("is the input"), "{said}");
        }
        assert!(folder.path("link.ptn").is_symlink());
    }
    assert_eq!(folder.get("run.keys"), before);
    folder.done(&["convert", "run.keys", "-o", "run.ptn"]);
    std::fs::copy(folder.path("run.ptn"), folder.path("run.bvh")).unwrap();
    let clip = folder.get("run.ptn");
    let said = folder.refused(&["expand", "run.bvh", "-o", "run.bvh"]);
    assert!(said.contains("is the input") && folder.get("run.bvh") == clip, "{said}");
}

#[test]
fn files_that_belong_to_a_motion_are_not_its_output() {
    let folder = Folder::new();
    folder.put("face.csv", "time,smile\n0,0\n0.1,1\n0.2,0.5\n");
    folder.put("face", folder.get("face.csv"));
    let said = folder.refused(&["convert", "run.keys", "--with", "face", "-o", "face"]);
    assert!(said.contains("is the input"), "{said}");
    assert!(folder.get("face").starts_with(b"time"));
}

#[test]
fn two_outputs_are_two_files() {
    let folder = Folder::new();
    let said = folder.refused(&["convert", "run.keys", "-o", "a.ptn", "--rig-out", "./a.ptn"]);
    assert!(said.contains("one file") || said.contains("a rig's name"), "{said}");
    let said = folder.refused(&["convert", "run.keys", "-o", "a", "--rig-out", "./a"]);
    assert!(said.contains("one file"), "{said}");
    assert_eq!(folder.names(), ["run.keys"]);
}

#[test]
fn a_name_of_another_kind_of_file_is_refused_with_a_hint() {
    let folder = Folder::new();
    for (name, hint) in [("a.bvh", "pantin expand"), ("a.GLB", "pantin expand"), ("a.png", "pantin render"), ("a.txt", ".ptn")] {
        let said = folder.refused(&["convert", "run.keys", "-o", name]);
        assert!(said.contains(hint), "{name}: {said}");
    }
    let said = folder.refused(&["convert", "run.keys", "-o", "a.ptn", "--rig-out", "a.bvh"]);
    assert!(said.contains(".rig"), "{said}");
    folder.done(&["convert", "run.keys", "-o", "a.ptn"]);
    for (arguments, hint) in [
        (["render", "a.ptn", "-o", "a.bvh"], "pantin expand"),
        (["render", "a.ptn", "-o", "b.ptn"], "pantin convert"),
        (["render", "a.ptn", "-o", "a.jpg"], ".png"),
        (["expand", "a.ptn", "-o", "a.gif"], "pantin render"),
        (["expand", "a.ptn", "-o", "b.fbx"], ".bvh"),
    ] {
        let said = folder.refused(&arguments);
        assert!(said.contains(hint), "{arguments:?}: {said}");
    }
    for name in ["b.bvh", "b.ptn"] {
        let said = folder.refused(&["face", "sheet", "-o", name]);
        assert!(said.contains("face sheet"), "{name}: {said}");
    }
    assert_eq!(folder.names(), ["a.ptn", "run.keys"]);
}

#[test]
fn the_place_of_an_output_is_checked_before_the_work() {
    let folder = Folder::new();
    folder.put("broken.bvh", "HIERARCHY\nROOT\n");
    let said = folder.refused(&["convert", "broken.bvh", "-o", "nowhere/a.ptn"]);
    assert!(said.contains("there is no folder nowhere"), "{said}");
    std::fs::create_dir(folder.path("sub")).unwrap();
    let said = folder.refused(&["convert", "broken.bvh", "-o", "sub"]);
    assert!(said.contains("a folder"), "{said}");
}

#[test]
fn another_programs_part_file_stays() {
    let folder = Folder::new();
    folder.put("a.ptn.part", "mine");
    folder.put("a.bvh.part", "mine");
    folder.done(&["convert", "run.keys", "-o", "a.ptn"]);
    folder.done(&["expand", "a.ptn", "-o", "a.bvh"]);
    assert!(folder.get("a.ptn.part") == b"mine" && folder.get("a.bvh.part") == b"mine");
    assert_eq!(folder.names(), ["a.bvh", "a.bvh.part", "a.ptn", "a.ptn.part", "run.keys"]);
}

#[test]
fn converts_to_one_name_at_once_leave_a_whole_clip() {
    let folder = Folder::new();
    folder.done(&["convert", "run.keys", "-o", "one.ptn", "--effort", "fast"]);
    folder.done(&["convert", "run.keys", "-o", "other.ptn", "--effort", "fast", "--max-error", "3cm"]);
    for _ in 0..4 {
        let start = |bound| {
            let mut command = folder.command(&["convert", "run.keys", "-o", "a.ptn", "--effort", "fast", "--max-error", bound]);
            command.stderr(Stdio::null()).spawn().unwrap()
        };
        let mut both = [start("0.5cm"), start("3cm")];
        for child in &mut both {
            assert!(child.wait().unwrap().success());
        }
        assert!([folder.get("one.ptn"), folder.get("other.ptn")].contains(&folder.get("a.ptn")));
    }
    assert_eq!(folder.names(), ["a.ptn", "one.ptn", "other.ptn", "run.keys"]);
}

#[test]
fn a_rig_and_its_clip_are_both_written_or_neither() {
    let folder = Folder::new();
    folder.put("figure.rig", "old rig");
    // The clip's place fails after all checks: a name that is too long for the file system.
    let long = format!("{}.ptn", "a".repeat(300));
    folder.refused(&["convert", "run.keys", "--rig-out", "figure.rig", "-o", &long]);
    assert_eq!(folder.get("figure.rig"), b"old rig");
    assert_eq!(folder.names(), ["figure.rig", "run.keys"]);
    folder.done(&["convert", "run.keys", "--rig-out", "figure.rig", "-o", "a.ptn"]);
    folder.done(&["info", "a.ptn", "--rig", "figure.rig"]);
    assert_eq!(folder.names(), ["a.ptn", "figure.rig", "run.keys"]);
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::io::Read;
    use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
    use std::time::{Duration, Instant};

    /// A clip by the plain way, to compare with.
    fn clip(folder: &Folder) -> Vec<u8> {
        folder.done(&["convert", "run.keys", "-o", "plain.ptn"]);
        folder.get("plain.ptn")
    }

    #[test]
    fn a_link_stays_and_what_it_names_is_replaced() {
        let folder = Folder::new();
        let clip = clip(&folder);
        folder.put("real/a.ptn", "old");
        symlink("real/a.ptn", folder.path("link.ptn")).unwrap();
        symlink("link.ptn", folder.path("second.ptn")).unwrap();
        symlink("real/missing.ptn", folder.path("dangling.ptn")).unwrap();
        folder.done(&["convert", "run.keys", "-o", "second.ptn"]);
        folder.done(&["convert", "run.keys", "-o", "dangling.ptn"]);
        assert!(["link.ptn", "second.ptn", "dangling.ptn"].iter().all(|name| folder.path(name).is_symlink()));
        assert!(folder.get("real/a.ptn") == clip && folder.get("real/missing.ptn") == clip);
        symlink("circle.ptn", folder.path("circle.ptn")).unwrap();
        assert!(folder.refused(&["convert", "run.keys", "-o", "circle.ptn"]).contains("circle"));
    }

    #[test]
    fn standard_output_and_devices_are_written_through() {
        let folder = Folder::new();
        let clip = clip(&folder);
        let out = folder.done(&["convert", "run.keys", "-o", "-"]);
        assert!(out.stdout == clip);
        let out = folder.done(&["convert", "run.keys", "-o", "/dev/stdout"]);
        assert!(out.stdout == clip);
        folder.done(&["convert", "run.keys", "-o", "/dev/null"]);
        assert!(std::fs::metadata("/dev/null").unwrap().file_type().is_char_device());
        assert!(std::fs::symlink_metadata("/dev/stdout").unwrap().is_symlink());
        let said = folder.refused(&["convert", "run.keys", "-o", "/dev/full"]);
        assert!(said.contains("/dev/full: cannot be written"), "{said}");
    }

    #[test]
    fn a_pipe_stays_a_pipe() {
        let folder = Folder::new();
        let clip = clip(&folder);
        let made = Command::new("mkfifo").arg(folder.path("pipe")).status();
        if !made.is_ok_and(|status| status.success()) {
            eprintln!("skipped: no mkfifo");
            return;
        }
        let path = folder.path("pipe");
        let reader = std::thread::spawn(move || {
            let mut bytes = Vec::new();
            std::fs::File::open(path).unwrap().read_to_end(&mut bytes).unwrap();
            bytes
        });
        folder.done(&["convert", "run.keys", "-o", "pipe"]);
        assert!(reader.join().unwrap() == clip);
        assert!(std::fs::metadata(folder.path("pipe")).unwrap().file_type().is_fifo());
    }

    /// Standard input, fed with `bytes`.
    fn fed(folder: &Folder, arguments: &[&str], bytes: &[u8]) -> Output {
        let mut command = folder.command(arguments);
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        std::io::Write::write_all(&mut child.stdin.take().unwrap(), bytes).unwrap();
        child.wait_with_output().unwrap()
    }

    #[test]
    fn standard_input_is_read_from_its_first_byte() {
        let folder = Folder::new();
        let clip = clip(&folder);
        let keys = folder.get("run.keys");
        assert!(keys.len() > 1024);
        for input in ["-", "/dev/stdin"] {
            let out = fed(&folder, &["convert", input, "-o", "-"], &keys);
            assert!(out.stdout == clip, "{input}: {}", err(&out));
        }
        let out = fed(&folder, &["info", "-"], &clip);
        assert!(out.status.success(), "{}", err(&out));
    }

    #[test]
    fn a_redirected_input_is_no_output_and_a_redirected_output_no_input() {
        let folder = Folder::new();
        let clip = clip(&folder);
        folder.put("z.csv", &clip);
        folder.put("a1.ptn", &clip);
        let runs = [
            "expand - -o z.csv < z.csv",
            "expand - --format csv -o - < a1.ptn >> a1.ptn",
            "expand a1.ptn --format csv -o - >> a1.ptn",
            "expand a1.ptn --format csv -o - 1<> a1.ptn",
            "expand z.csv --format csv -o /dev/stdout >> z.csv",
            "render a1.ptn --format png --frame 0 -o - >> a1.ptn",
            "convert - -o z.ptn < z.ptn",
            "convert a.keys -o - >> a.keys",
        ];
        folder.put("z.ptn", folder.get("run.keys"));
        folder.put("a.keys", folder.get("run.keys"));
        for run in runs {
            let mut command = Command::new("sh");
            command.args(["-c", &format!("\"$0\" {run}"), env!("CARGO_BIN_EXE_pantin")]).current_dir(folder.path(""));
            let output = command.output().unwrap();
            let said = err(&output);
            assert!(output.status.code() == Some(1) && said.contains("is the input"), "{run}: {said}");
            assert!(folder.get("z.csv") == clip && folder.get("a1.ptn") == clip, "{run}");
            assert!(["z.ptn", "a.keys"].iter().all(|name| folder.get(name) == folder.get("run.keys")), "{run}");
        }
        // Other files are no obstacle.
        let run = "\"$0\" expand - --format csv -o - < a1.ptn >> new.csv && \"$0\" expand a1.ptn --format csv -o - > /dev/null < a1.ptn";
        let done =
            Command::new("sh").args(["-c", run, env!("CARGO_BIN_EXE_pantin")]).current_dir(folder.path("")).output().unwrap();
        assert!(done.status.success() && !folder.get("new.csv").is_empty(), "{}", err(&done));
    }

    #[test]
    fn a_replaced_file_keeps_its_rights_and_a_new_one_has_the_usual_ones() {
        let folder = Folder::new();
        folder.put("a.ptn", "old");
        std::fs::set_permissions(folder.path("a.ptn"), PermissionsExt::from_mode(0o640)).unwrap();
        folder.done(&["convert", "run.keys", "-o", "a.ptn"]);
        folder.done(&["convert", "run.keys", "-o", "b.ptn"]);
        let mode = |name: &str| std::fs::metadata(folder.path(name)).unwrap().permissions().mode() & 0o777;
        folder.put("usual", "");
        assert_eq!((mode("a.ptn"), mode("b.ptn")), (0o640, mode("usual")));
    }

    #[test]
    fn a_signal_leaves_no_part_of_an_output() {
        let folder = Folder::new();
        folder.done(&["convert", "run.keys", "-o", "a.ptn"]);
        // Standard output is a pipe that nobody reads: the rig waits beside its place meanwhile.
        let mut child = folder
            .command(&["render", "a.ptn", "-o", "a.gif", "--size", "4096x4096", "--smooth"])
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let begun = Instant::now();
        let part = || folder.names().iter().any(|name| name.ends_with(".part"));
        while !part() && child.try_wait().unwrap().is_none() && begun.elapsed() < Duration::from_secs(60) {
            std::thread::sleep(Duration::from_millis(5));
        }
        assert!(part(), "the picture is written as it is drawn");
        Command::new("kill").arg(child.id().to_string()).status().unwrap();
        assert_eq!(std::os::unix::process::ExitStatusExt::signal(&child.wait().unwrap()), Some(15));
        assert_eq!(folder.names(), ["a.ptn", "run.keys"]);
        // Nor a folder for it.
        let mut child = folder.command(&["convert", ".", "-o", "new/deep", "--exact"]).stderr(Stdio::null()).spawn().unwrap();
        let begun = Instant::now();
        while !folder.path("new/deep").is_dir() && begun.elapsed() < Duration::from_secs(60) {
            std::thread::sleep(Duration::from_millis(5));
        }
        Command::new("kill").arg(child.id().to_string()).status().unwrap();
        assert_eq!(std::os::unix::process::ExitStatusExt::signal(&child.wait().unwrap()), Some(15));
        assert_eq!(folder.names(), ["a.ptn", "run.keys"]);
    }
}
