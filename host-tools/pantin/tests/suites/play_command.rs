//! `pantin play`: text for a pipe, and a session in a pseudo-terminal whose screen is read as a person would.

use pantin_tools::play::colours::Colours;
use pantin_tools::play::terminal::Terminal;
use portable_pty::{Child, CommandBuilder, ExitStatus, MasterPty, PtySize, native_pty_system};
use std::io::{Read, Write};
use std::num::NonZeroU16;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

const PANTIN: &str = env!("CARGO_BIN_EXE_pantin");
const PATIENCE: Duration = Duration::from_secs(20);

fn side(cells: u16) -> NonZeroU16 {
    NonZeroU16::new(cells).unwrap()
}

struct Folder(PathBuf);

impl Folder {
    /// A folder with our walk (160 frames) and run (26 frames), and a clip without joints.
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("pantin-play-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        let folder = Folder(path);
        std::fs::write(folder.0.join("face.csv"), "time,jaw,brow\n0,0,0.5\n0.1,1,0.5\n0.2,0.5,0.25\n").unwrap();
        let motions = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions");
        for (from, to) in [(motions.join("walk.keys"), "walk.ptn"), (motions.join("run.keys"), "run.ptn")] {
            assert!(folder.pantin(&["convert", from.to_str().unwrap(), "-o", to]).status.success());
        }
        assert!(folder.pantin(&["convert", "face.csv", "-o", "face.ptn"]).status.success());
        folder
    }

    fn pantin(&self, arguments: &[&str]) -> Output {
        Command::new(PANTIN).args(arguments).current_dir(&self.0).output().unwrap()
    }

    fn text(&self, arguments: &[&str]) -> String {
        let output = self.pantin(arguments);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A program in a terminal of 80x24.
struct Seat {
    master: Box<dyn MasterPty + Send>,
    keys: Box<dyn Write + Send>,
    child: Box<dyn Child + Send + Sync>,
    screen: Arc<Mutex<vt100::Parser>>,
    /// The terminal's modes before the program began.
    modes: String,
}

impl Seat {
    fn new(folder: &Path, program: &str, arguments: &[&str]) -> Seat {
        let size = PtySize { rows: 24, cols: 80, pixel_width: 0, pixel_height: 0 };
        let pair = native_pty_system().openpty(size).unwrap();
        let modes = format!("{:?}", pair.master.get_termios());
        let mut command = CommandBuilder::new(program);
        command.args(arguments);
        command.cwd(folder);
        command.env("TERM", "xterm-256color");
        command.env("COLORTERM", "truecolor");
        command.env_remove("NO_COLOR");
        // A panic's message is not to scroll away.
        command.env("RUST_BACKTRACE", "0");
        let child = pair.slave.spawn_command(command).unwrap();
        let screen = Arc::new(Mutex::new(vt100::Parser::new(side(24), side(80), 0)));
        let (mut reader, shown) = (pair.master.try_clone_reader().unwrap(), screen.clone());
        std::thread::spawn(move || {
            let mut bytes = [0; 4096];
            while let Ok(count @ 1..) = reader.read(&mut bytes) {
                shown.lock().unwrap().process(&bytes[..count]);
            }
        });
        let keys = pair.master.take_writer().unwrap();
        Seat { master: pair.master, keys, child, screen, modes }
    }

    fn press(&mut self, keys: &str) {
        self.keys.write_all(keys.as_bytes()).unwrap();
    }

    fn rows(&self) -> Vec<String> {
        let parser = self.screen.lock().unwrap();
        let (_, columns) = parser.screen().size();
        parser.screen().rows(0, columns.get()).collect()
    }

    /// Waits until the screen shows these words: what a program wrote before its end may not have been read yet.
    fn shows(&self, words: &str) {
        let begun = Instant::now();
        while !self.screen.lock().unwrap().screen().contents().contains(words) {
            assert!(begun.elapsed() < PATIENCE, "no {words:?} on the screen: {:?}", self.rows());
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// Waits until the last row has all of the words, and gives it.
    fn status(&self, words: &[&str]) -> String {
        let begun = Instant::now();
        loop {
            let status = self.rows().pop().unwrap();
            if words.iter().all(|word| status.contains(word)) {
                return status;
            }
            assert!(begun.elapsed() < PATIENCE, "no {words:?} in {status:?}");
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// The frame's number once the last row has the words.
    fn frame(&self, words: &[&str]) -> i32 {
        let status = self.status(words);
        status.split("frame ").nth(1).and_then(|rest| rest.split('/').next()).unwrap().parse().unwrap()
    }

    fn wait(&mut self) -> ExitStatus {
        let begun = Instant::now();
        loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                return status;
            }
            if begun.elapsed() > PATIENCE {
                self.child.kill().unwrap();
                panic!("it does not end: {:?}", self.rows());
            }
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// Whether the terminal is as it was before, once all that was written is read.
    fn is_restored(&self) -> bool {
        let begun = Instant::now();
        loop {
            let parser = self.screen.lock().unwrap();
            let screen = parser.screen();
            let same = !screen.alternate_screen() && !screen.hide_cursor() && self.modes == self.modes();
            if same || begun.elapsed() > Duration::from_secs(2) {
                return same;
            }
            drop(parser);
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    fn modes(&self) -> String {
        format!("{:?}", self.master.get_termios())
    }
}

#[test]
fn keys_do_what_they_say_and_the_terminal_is_left_as_it_was() {
    let folder = Folder::new("keys");
    let mut seat = Seat::new(&folder.0, PANTIN, &["play", "walk.ptn", "run.ptn"]);
    seat.status(&["1/2 walk", "frame", "/160", "x1", "orbit -50 tilt 12 follow"]);
    assert!(seat.screen.lock().unwrap().screen().alternate_screen() && seat.modes() != seat.modes);
    seat.press(" ");
    let frame = seat.frame(&["paused"]);
    seat.press(".");
    assert_eq!(seat.frame(&[&format!("frame {}/", (frame + 1) % 160), "paused"]), (frame + 1) % 160);
    seat.press(",,,");
    seat.status(&[&format!("frame {}/", (frame + 158) % 160)]);
    seat.press("+r\x1b[C\x1b[Af");
    seat.status(&["x2", "orbit -35 tilt 17 fixed", "reverse", "paused"]);
    seat.press("?");
    let begun = Instant::now();
    // Two lines in 80 columns.
    while !(seat.rows()[21].contains("space pause") && seat.rows()[22].contains("q quit")) {
        assert!(begun.elapsed() < PATIENCE, "no help in {:?}", seat.rows());
    }
    seat.press("n");
    seat.status(&["2/2 run", "/26", "paused"]);
    seat.press("n---- ");
    seat.status(&["1/2 walk", "x1/8"]);
    assert!(!seat.status(&[]).contains("paused"));
    seat.press("q");
    assert!(seat.wait().success());
    assert!(seat.is_restored());
}

/// A machine of the walk and the run, with an input that is held, one that is fired, and a parameter.
const MACHINE: &str = r#"
bank = "moves.ptb"

[[parameter]]
name = "speed"
range = [0, 100]

[[state]]
name = "stroll"
clip = "walk"
transitions = [{ to = "sprint", input = "go" }, { to = "hop", input = "jump" }, { to = "sprint", above = ["speed", 25], kind = "cut" }]

[[state]]
name = "sprint"
clip = "run"
transitions = [{ to = "stroll", released = "go" }]

[[state]]
name = "hop"
clip = "run"
transitions = [{ to = "stroll", input = "wave" }]
"#;

impl Folder {
    /// With a bank that has a state machine.
    fn with_machine(name: &str) -> Folder {
        let folder = Folder::new(name);
        folder.text(&["pack", "walk.ptn", "run.ptn", "-o", "moves.ptb"]);
        std::fs::write(folder.0.join("m.toml"), MACHINE).unwrap();
        folder.text(&["machine", "m.toml", "-o", "m.ptb"]);
        folder
    }
}

#[test]
fn a_state_machine_is_steered_by_keys() {
    let folder = Folder::with_machine("machine");
    let mut seat = Seat::new(&folder.0, PANTIN, &["play", "m.ptb"]);
    seat.status(&[" m ", "state stroll", "speed 0", "orbit -50 tilt 12 follow"]);
    // `go` is the arrow up, and is held until a second press.
    seat.press("\x1b[A");
    seat.status(&["state sprint", "[go]"]);
    seat.press("\x1b[A");
    assert!(!seat.status(&["state stroll"]).contains("[go]"));
    // `jump` is the space bar and is fired; `wave` has a letter.
    seat.press(" ");
    seat.status(&["state hop", "(jump)"]);
    seat.press("w");
    seat.status(&["state stroll"]);
    seat.press("++");
    seat.status(&["state stroll", "speed 20"]);
    seat.press("-----");
    seat.status(&["speed 0"]);
    seat.press("V");
    seat.status(&["orbit 0"]);
    seat.press("F");
    seat.status(&["fixed"]);
    seat.press("?");
    seat.shows("up go (on, off)");
    seat.shows("space jump");
    seat.shows("w wave");
    seat.press("R\x1b[A");
    seat.status(&["state sprint"]);
    seat.press("q");
    assert!(seat.wait().success());
    assert!(seat.is_restored());
}

#[test]
fn a_watched_machine_plays_what_its_file_says_now() {
    let folder = Folder::with_machine("watched");
    let write = |text: &str| std::fs::write(folder.0.join("m.toml"), text).unwrap();
    let mut seat = Seat::new(&folder.0, PANTIN, &["machine", "m.toml", "--watch", "-o", "watched.ptb"]);
    seat.status(&[" m ", "state stroll"]);
    seat.press("\x1b[A");
    seat.status(&["state sprint", "[go]"]);
    // The input stays held, and leads to the state by its new name.
    write(&MACHINE.replace("sprint", "dash"));
    seat.status(&["state dash", "[go]"]);
    // One that is wrong is shown, and the last one plays on.
    write(&MACHINE.replace("clip = \"walk\"", "clip = \"crawl\""));
    seat.shows("crawl");
    seat.status(&["state dash", "[go]"]);
    write(&format!("{MACHINE}\n[feet]\n"));
    seat.status(&["state sprint", "[go]", "on the ground: "]);
    assert!(!seat.rows()[..23].concat().contains("crawl"));
    assert_eq!(std::fs::read(folder.0.join("watched.ptb")).unwrap().len(), {
        folder.text(&["machine", "m.toml", "-o", "again.ptb"]);
        std::fs::read(folder.0.join("again.ptb")).unwrap().len()
    });
    seat.press("q");
    assert!(seat.wait().success());
    assert!(seat.is_restored());
}

#[test]
fn a_state_machine_is_printed_and_described() {
    let folder = Folder::with_machine("machine-text");
    let text = folder.text(&["play", "m.ptb", "--plain", "--frames", "3", "--size", "60x20"]);
    assert_eq!(text.lines().count(), 60);
    assert_eq!(text.lines().filter(|line| line.contains("state stroll")).count(), 3);
    for (arguments, reason) in [
        (&["play", "m.ptb", "--plain"][..], "--plain needs --frames"),
        (&["play", "m.ptb", "walk.ptn"], "plays alone"),
        (&["play", "m.ptb", "--once"], "does not end"),
    ] {
        let output = folder.pantin(arguments);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && error.contains(reason), "{error}");
    }
    let text = folder.text(&["info", "m.ptb"]);
    for line in [
        "state machine",
        "  states      stroll, sprint, hop",
        "  inputs      go, jump, wave",
        "  parameters  speed",
        "  starts in   stroll",
    ] {
        assert!(text.lines().any(|own| own == line), "{line}: {text}");
    }
    let object: serde_json::Value = serde_json::from_str(&folder.text(&["info", "m.ptb", "--json"])).unwrap();
    assert_eq!(object["machine"]["states"][2], serde_json::json!({"name": "hop", "clip": "run"}));
    assert_eq!(object["machine"]["parameters"][0]["range"], serde_json::json!([0, 100]));
}

#[test]
fn the_figure_fills_a_terminal_that_grows_and_shrinks() {
    let folder = Folder::new("resize");
    let mut seat = Seat::new(&folder.0, PANTIN, &["play", "walk.ptn", "--view", "front"]);
    for (rows, cols) in [(24, 80), (50, 160), (12, 30), (1, 8)] {
        seat.screen.lock().unwrap().screen_mut().set_size(side(rows), side(cols));
        seat.master.resize(PtySize { rows, cols, pixel_width: 0, pixel_height: 0 }).unwrap();
        seat.status(&[" walk "]);
        let begun = Instant::now();
        // Head to feet take most of the rows; the head is in the middle.
        let fills = |rows: Vec<String>| {
            let full = rows.iter().filter(|row| !row.is_ascii()).count();
            full >= (rows.len() - 1) * 8 / 10
        };
        while !fills(seat.rows()) {
            assert!(begun.elapsed() < PATIENCE, "{rows}x{cols}: {:#?}", seat.rows());
            std::thread::sleep(Duration::from_millis(10));
        }
    }
    seat.press("\x03");
    assert!(seat.wait().success());
    assert!(seat.is_restored());
}

/// Now and then both are there when it looks for either.
#[test]
fn a_key_that_comes_with_a_resize_is_not_lost() {
    let folder = Folder::new("both");
    let mut seat = Seat::new(&folder.0, PANTIN, &["play", "walk.ptn"]);
    seat.status(&[" walk ", " x1 "]);
    for round in 0..300 {
        let (rows, key, speed) = if round % 2 == 0 { (30, "+", " x2 ") } else { (24, "-", " x1 ") };
        seat.screen.lock().unwrap().screen_mut().set_size(side(rows), side(80));
        seat.master.resize(PtySize { rows, cols: 80, pixel_width: 0, pixel_height: 0 }).unwrap();
        seat.press(key);
        seat.status(&[speed]);
    }
    seat.press("q");
    assert!(seat.wait().success());
}

#[test]
fn a_clip_plays_at_its_rate_and_once_ends_it() {
    let folder = Folder::new("once");
    let begun = Instant::now();
    let mut seat = Seat::new(&folder.0, PANTIN, &["play", "walk.ptn", "run.ptn", "--once"]);
    assert!(seat.wait().success());
    // 160 frames at 120 a second and 26 at 36, and the program's start.
    let seconds = begun.elapsed().as_secs_f64();
    let least = 160.0 / 120.0 + 26.0 / 36.0;
    assert!((least..least + 8.0).contains(&seconds), "{seconds} s");
    assert!(seat.is_restored());
}

#[test]
fn a_signal_restores_the_terminal_and_a_hangup_ends_it() {
    let folder = Folder::new("signal");
    let mut seat = Seat::new(&folder.0, PANTIN, &["play", "walk.ptn"]);
    seat.status(&[" walk "]);
    let id = seat.child.process_id().unwrap().to_string();
    assert!(Command::new("kill").args(["-TERM", &id]).status().unwrap().success());
    assert_eq!(seat.wait().exit_code(), 128 + 15);
    assert!(seat.is_restored());

    let seat = Seat::new(&folder.0, PANTIN, &["play", "walk.ptn"]);
    seat.status(&[" walk "]);
    let Seat { master, keys, mut child, .. } = seat;
    let id = child.process_id().unwrap().to_string();
    drop((master, keys));
    assert!(Command::new("kill").args(["-HUP", &id]).status().unwrap().success());
    let begun = Instant::now();
    while child.try_wait().unwrap().is_none() {
        assert!(begun.elapsed() < PATIENCE, "it goes on without a terminal");
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn a_signal_ends_it_where_the_terminal_has_stopped_reading() {
    let folder = Folder::new("stopped");
    for (name, number) in [("-TERM", 15), ("-INT", 2), ("-HUP", 1)] {
        let pair = native_pty_system().openpty(PtySize { rows: 100, cols: 300, pixel_width: 0, pixel_height: 0 }).unwrap();
        let modes = format!("{:?}", pair.master.get_termios());
        let mut command = CommandBuilder::new(PANTIN);
        command.args(["play", "walk.ptn", "--dots", "half", "--colours", "all"]);
        command.cwd(&folder.0);
        let mut child = pair.slave.spawn_command(command).unwrap();
        let begun = Instant::now();
        while modes == format!("{:?}", pair.master.get_termios()) {
            assert!(begun.elapsed() < PATIENCE, "it does not begin");
            std::thread::sleep(Duration::from_millis(10));
        }
        // Nobody reads: by now a write waits.
        std::thread::sleep(Duration::from_secs(2));
        assert!(Command::new("kill").args([name, &child.process_id().unwrap().to_string()]).status().unwrap().success());
        let begun = Instant::now();
        let status = loop {
            if let Some(status) = child.try_wait().unwrap() {
                break status;
            }
            if begun.elapsed() > Duration::from_secs(5) {
                child.kill().unwrap();
                panic!("{name} does not end it");
            }
            std::thread::sleep(Duration::from_millis(10));
        };
        assert_eq!(status.exit_code(), 128 + number, "{name}");
        assert_eq!(modes, format!("{:?}", pair.master.get_termios()), "{name}");
    }
}

/// Runs in the terminal of the test below.
#[test]
#[ignore = "panics on purpose: `cargo test -p pantin-tools --test suites a_panic_restores_the_terminal` runs it in a terminal"]
fn panics_while_it_plays() {
    let _terminal = Terminal::enter(Colours::All).unwrap();
    panic!("on purpose");
}

#[test]
fn a_panic_restores_the_terminal_and_is_read() {
    let own = std::env::current_exe().unwrap();
    let arguments = ["--ignored", "--exact", "play_command::panics_while_it_plays", "--nocapture"];
    let mut seat = Seat::new(&std::env::temp_dir(), own.to_str().unwrap(), &arguments);
    assert!(!seat.wait().success());
    assert!(seat.is_restored());
    seat.shows("on purpose");
}

#[test]
fn plain_frames_go_to_a_pipe() {
    let folder = Folder::new("plain");
    let text = folder.text(&["play", "walk.ptn", "--once", "--frames", "3", "--plain", "--size", "60x20"]);
    let rows: Vec<&str> = text.lines().collect();
    assert_eq!(rows.len(), 60);
    for frame in 0..3 {
        assert!(rows[frame * 20 + 19].starts_with(&format!(" walk  frame {frame}/160  ")), "{}", rows[frame * 20 + 19]);
        let braille = |row: &&&str| row.chars().any(|letter| ('\u{2801}'..='\u{28ff}').contains(&letter));
        assert!(rows[frame * 20..][..19].iter().filter(braille).count() >= 15);
    }
    assert!(rows[..19] != rows[40..59] && !text.contains('\u{1b}'));
    let half = folder.text(&["play", "run.ptn", "--plain", "--frames", "30", "--dots", "half"]);
    assert!(half.contains('█') && half.contains("frame 25/26") && half.lines().count() == 30 * 24);
    let all = folder.text(&["play", "run.ptn", "run.ptn", "--plain", "--once"]);
    assert_eq!((all.matches("frame 25/26").count(), all.matches(" 2/2 run ").count()), (2, 26));
}

#[test]
fn a_clip_without_joints_plays_as_bars() {
    let folder = Folder::new("bars");
    let text = folder.text(&["play", "face.ptn", "--plain", "--size", "52x8"]);
    let rows: Vec<&str> = text.lines().collect();
    assert_eq!(rows.len(), 3 * 8);
    let bar = |row: &str| row.chars().filter(|&letter| letter == '█').count();
    assert!(rows[8].starts_with(" jaw") && rows[9].starts_with(" brow"), "{text}");
    // Frame 1 has jaw at its greatest, frame 2 at half of it.
    assert!(bar(rows[8]) >= 19 && (9..=10).contains(&bar(rows[16])) && bar(rows[0]) == 0, "{text}");
    assert!(rows[7].starts_with(" face  frame 0/3 ") && !rows[7].contains("orbit"));
}

#[test]
fn a_face_plays_as_a_face() {
    let folder = Folder::new("joy");
    let joy = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions/face/joy.ptn");
    let text = |view: &[&str]| folder.text(&[&["play", joy.to_str().unwrap(), "--plain", "--size", "60x24"], view].concat());
    let front = text(&[]);
    let frames: Vec<Vec<&str>> = front.lines().collect::<Vec<_>>().chunks(24).map(|rows| rows[..23].to_vec()).collect();
    // Looked in the eyes, most rows reach as far to the left of the middle as to the right.
    let even = |frame: &[&str]| {
        let ends = frame.iter().filter_map(|row| Some((row.find(|letter| letter != ' ')?, row.chars().count())));
        ends.filter(|(from, to)| (59..=61).contains(&(from + to))).count()
    };
    assert!(frames.iter().all(|frame| even(frame) > 18), "{front}");
    assert!(frames.len() == 36 && frames[0] != frames[18] && frames[0] == frames[35], "{front}");
    assert_eq!(text(&["--view", "front"]).lines().take(23).collect::<Vec<_>>(), frames[0]);
    let side = text(&["--view", "right"]);
    assert!(even(&side.lines().take(23).collect::<Vec<_>>()) < 12, "{side}");
}

#[test]
fn without_a_terminal_it_says_what_to_do() {
    let folder = Folder::new("pipe");
    for (arguments, words) in [
        (&["play", "walk.ptn"][..], "play needs a terminal"),
        (&["play", "walk.ptn", "no.ptn", "--plain"], "no.ptn: cannot be read"),
        (&["play", "no.csv", "--plain"], "no.csv"),
        (&["play", "walk.ptn", "--palette", "sepia"], "blueprint"),
    ] {
        let output = folder.pantin(arguments);
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && error.contains(words) && output.stdout.is_empty(), "{error}");
        assert!(!error.contains("panicked"));
    }
}

#[test]
fn a_long_conversion_shows_its_progress_and_a_stop_leaves_nothing() {
    let folder = Folder::new("progress");
    let motions = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions");
    std::fs::copy(motions.join("walk.keys"), folder.0.join("walk.keys")).unwrap();
    let big =
        "keyframes 1\nfps 30\nframes 100000\njoint hip offset 0 90 0 channels Yposition Zposition Xrotation\nkeys natural hip\n";
    std::fs::write(folder.0.join("big.keys"), format!("{big}0 0 0 0\n50000 50 20 10\n99999 3 3 3\n")).unwrap();
    let swing = |name: &str, fps: u32, frames: u32| {
        let figure = "joint hip offset 0 90 0 channels Yposition Xrotation\nhip.Yposition = 90 - 2 * sin(2 * PI * t)^2\n";
        let text = format!("procedural 1\nfps {fps}\nframes {frames}\n{figure}hip.Xrotation = 25 * sin(2 * PI * t)\n");
        std::fs::write(folder.0.join(name), text).unwrap();
    };
    std::fs::create_dir(folder.0.join("two")).unwrap();
    ["two/a.proc", "two/b.proc"].iter().for_each(|name| swing(name, 1000, 40_000));
    swing("short.proc", 30, 100);
    let made =
        Command::new(env!("CARGO_BIN_EXE_pantin")).args(["convert", "short.proc"]).current_dir(&folder.0).output().unwrap();
    assert!(made.status.success(), "{made:?}");
    let clip = std::fs::read(folder.0.join("short.ptn")).unwrap();
    std::fs::write(folder.0.join("long.ptn"), super::exhaustion::with_frames(&clip, 1 << 23)).unwrap();
    let names = || {
        let entries = std::fs::read_dir(&folder.0).unwrap();
        entries.map(|entry| entry.unwrap().file_name()).collect::<std::collections::BTreeSet<_>>()
    };
    let before = names();
    // The command, what its bar says, and whether its time must have been estimated: then the bar has moved.
    let cases: [(&[&str], [&str; 2], bool); 7] = [
        (&["convert", "walk.keys", "--exact", "-o", "new.ptn"], ["fitting", " %"], false),
        (&["convert", "big.keys", "-o", "new.ptn"], ["fitting", " %"], false),
        (&["convert", "two", "-o", "new.ptb"], ["", "0 of 2 clips"], true),
        (&["convert", "two", "-o", "new"], ["", "0 of 2 files"], true),
        (&["render", "big.keys", "-o", "new.gif"], ["converting", " %"], true),
        (&["expand", "long.ptn", "-o", "new.csv"], ["writing", " %"], true),
        (&["expand", "long.ptn", "-o", "new.bvh"], ["writing", " %"], true),
    ];
    for (arguments, words, moves) in cases {
        let mut seat = Seat::new(&folder.0, env!("CARGO_BIN_EXE_pantin"), arguments);
        let begun = Instant::now();
        let shows = |row: &String| {
            let row = row.trim_end();
            words.iter().all(|word| row.contains(word)) && row.ends_with(" left") && !(moves && row.ends_with("? s left"))
        };
        let shown = || seat.rows().iter().any(shows);
        while !shown() {
            assert!(begun.elapsed() < PATIENCE, "{:?}", seat.rows());
            std::thread::sleep(Duration::from_millis(10));
        }
        seat.press("\x03");
        seat.wait();
        assert_eq!(names(), before);
    }
}
