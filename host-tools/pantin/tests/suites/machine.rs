//! `pantin machine`: a table in a bank that `pantin-animator` plays, a picture of it, and errors that name file and line.

use pantin::Bank;
use pantin_animator::machine::{Cause, Machine, SECTION, Table};
use pantin_animator::session::{Replay, Session};
use pantin_animator::{Animator, Transition, Workspace};
use pantin_convert::bank::{self, CheckedRig, Named};
use pantin_pictures::machine::playback::{joints, play};
use pantin_pictures::machine::{Location, Source, Text, compile, graph, inputs, make};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::Arc;

fn motions() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions")
}

/// A bank of the walk and the run in their committed clips, which have one rig.
fn small_bank() -> Vec<u8> {
    let named = |name: &str| {
        let bytes = std::fs::read(motions().join(name).with_extension("ptn")).unwrap();
        let rig: Arc<[u8]> = bank::rig_of(&bytes).unwrap().into();
        let clip = bank::without_rig(&bytes, &CheckedRig::new(&rig).unwrap()).unwrap();
        Named { name: name.into(), place: name.into(), clip, rig }
    };
    bank::encode(&[named("walk"), named("run")]).unwrap()
}

fn error(text: &str) -> String {
    let bytes = small_bank();
    let file = Text { name: "a.toml", text };
    let made = Source::parse(&file).and_then(|source| make(&source, &file, &Bank::new_checked(&bytes).unwrap()));
    format!("{:#}", made.unwrap_err())
}

const SMALL: &str = r#"
bank = "moves.ptb"
start = "go"

[[parameter]]
name = "speed"
range = [0, 100]
first = 30

[[any]]
to = "stop"
input = "halt"
kind = "faded"
frames = 7

[[state]]
name = "stop"
clip = "walk"
speed = 0.5
transitions = [{ to = "go", input = "go", start = 3, seconds = 0.5 }, { to = "run", above = ["speed", 50], kind = "cut" }]

[[state]]
name = "go"
clip = "walk"
transitions = [{ to = "stop", released = "go" }]

[[state]]
name = "run"
transitions = [{ to = "go", below = ["speed", 20], start = "in-step" }]
"#;

#[test]
fn the_table_says_what_the_text_says() {
    let bytes = small_bank();
    let bank = Bank::new_checked(&bytes).unwrap();
    let file = Text { name: "a.toml", text: SMALL };
    let made = make(&Source::parse(&file).unwrap(), &file, &bank).unwrap();
    assert!(made.warnings.is_empty(), "{:?}", made.warnings);
    let unused = format!("{SMALL}\n[[parameter]]\nname = \"wind\"\nrange = [0, 1]\n");
    let file = Text { name: "a.toml", text: &unused };
    let warnings = make(&Source::parse(&file).unwrap(), &file, &bank).unwrap().warnings;
    assert!(
        warnings.len() == 1 && warnings[0].text.ends_with("parameter `wind`: no blend and no transition uses it"),
        "{warnings:?}"
    );
    let table = Table::new(&made.table, bank.len()).unwrap();
    let names: Vec<&str> = (0..table.states() as u8).map(|state| table.state_name(state)).collect();
    assert_eq!(names, ["stop", "go", "run"]);
    assert_eq!((table.parameter("speed"), table.input("halt"), table.input("go")), (Some(0), Some(0), Some(1)));
    assert_eq!(Machine::new(table).state(), 1);
    assert_eq!(Machine::new(table).get(0), 30);
    let [stop, run] = [0, 2].map(|state| table.state(state).unwrap());
    assert_eq!((stop.clip, stop.speed.to_num::<f64>(), run.clip), (0, 0.5, 1));
    let row = |index: usize| table.transition(index).unwrap();
    assert_eq!((row(0).cause, row(0).to, row(0).transition), (Cause::Input(0), 0, Transition::Faded(7)));
    // Half a second in frames of the clip that it leads to.
    let frames = (0.5e9 / f64::from(bank.clip("walk").unwrap().frame_time_ns())).round() as u8;
    assert_eq!(
        (row(1).cause, row(1).first_frame, row(1).transition),
        (Cause::Input(1), Some(3), Transition::Inertialized(frames))
    );
    assert_eq!((row(2).cause, row(2).transition), (Cause::Above(0, 50), Transition::Cut));
    assert_eq!((row(3).cause, row(3).to), (Cause::Released(1), 0));
    assert_eq!((row(4).cause, row(4).first_frame), (Cause::Below(0, 20), None));
}

/// A bank that is already one with a machine gets the new one in its place; its clips stay.
#[test]
fn a_bank_holds_one_machine() {
    let bytes = small_bank();
    let one = bank::with_section(&bytes, SECTION, b"one").unwrap();
    let two = bank::with_section(&one, SECTION, b"second").unwrap();
    assert_eq!(two, bank::with_section(&bytes, SECTION, b"second").unwrap());
    assert_eq!(&two[..bytes.len()], bytes);
    assert!(bank::with_section(&bytes[..bytes.len() - 1], SECTION, b"").is_err());
}

#[test]
fn what_is_wrong_is_named_with_its_line() {
    let [state, run] = ["walk", "run"].map(|name| format!("[[state]]\nname = \"{name}\"\n"));
    let v = "[[parameter]]\nname = \"v\"\nrange = [0, 9]\n";
    for (text, part) in [
        (format!("{state}clip = \"fly\"\n"), "3: state `walk`: the bank has no clip `fly`; it has `walk`, `run`"),
        (format!("{state}transitions = [{{ to = \"x\", input = \"a\" }}]\n"), "3: state `walk`: no state `x`; there are `walk`"),
        (format!("{state}transitions = [{{ to = \"walk\" }}]\n"), "3: state `walk`: a transition has one of end,"),
        (format!("{state}transitions = [{{ to = \"walk\", input = \"a\", end = true }}]\n"), "this one has 2"),
        (format!("{state}transitions = [{{ to = \"walk\", end = true }}]\n"), "the clip `walk` is a loop, which has no end"),
        (
            format!("{state}transitions = [{{ to = \"walk\", event = \"clap\" }}]\n"),
            "no clip that plays there has an event `clap`",
        ),
        (format!("{state}transitions = [{{ to = \"walk\", above = [\"v\", 1] }}]\n"), "no [[parameter]] `v`"),
        (format!("{state}[[parameter]]\nname = \"v\"\nrange = [0, 9, 10]\n"), "two values"),
        (format!("{state}[[parameter]]\nname = \"v\"\nrange = [0]\n"), "two values"),
        (format!("{state}transitions = [{{ to = \"walk\", above = [\"v\", 1, 2] }}]\n"), "two values"),
        (format!("{state}transitions = [{{ to = \"walk\", input = \"a\", frames = 0 }}]\n"), "a transition of 0 frames"),
        (format!("{state}transitions = [{{ to = \"walk\", input = \"a\", frames = 256 }}]\n"), "a transition of 256 frames"),
        (format!("{state}transitions = [{{ to = \"walk\", input = \"a\", seconds = -1.0 }}]\n"), "expected a time above 0"),
        (
            format!("{state}transitions = [{{ to = \"walk\", input = \"a\", kind = \"cut\", frames = 3 }}]\n"),
            "a cut has no length",
        ),
        (format!("{state}transitions = [{{ to = \"walk\", input = \"a\", start = 160 }}]\n"), "start: frame 160"),
        (format!("{state}transitions = [{{ to = \"walk\", input = \"a\", start = \"here\" }}]\n"), "\"in-step\", found `here`"),
        (
            format!(
                "{state}transitions = [{{ to = \"walk\", input = \"a\" }}, {{ to = \"walk\", input = \"a\", frames = 3 }}]\n"
            ),
            "3: state `walk`: a transition before this one happens whenever this one could",
        ),
        (
            format!(
                "{state}transitions = [{{ to = \"walk\", above = [\"v\", 3] }}, {{ to = \"walk\", above = [\"v\", 5] }}]\n{v}"
            ),
            "a transition before this one",
        ),
        (
            format!(
                "{state}transitions = [{{ to = \"walk\", below = [\"v\", 5] }}, {{ to = \"walk\", below = [\"v\", 5] }}]\n{v}"
            ),
            "a transition before this one",
        ),
        (
            format!("[[any]]\nto = \"run\"\ninput = \"a\"\n{state}transitions = [{{ to = \"run\", input = \"a\" }}]\n{run}"),
            "6: state `walk`: a transition of any state ([[any]]) happens",
        ),
        (
            format!("{state}transitions = [{{ to = \"walk\", above = [\"v\", 9] }}]\n{v}"),
            "3: state `walk`: parameter `v` is at most 9,",
        ),
        (format!("{state}transitions = [{{ to = \"walk\", below = [\"v\", 0] }}]\n{v}"), "parameter `v` is at least 0, so"),
        (format!("[[any]]\nto = \"walk\"\nend = true\n{state}"), "every state plays a loop or stands still"),
        (format!("{state}speed = 0\ntransitions = [{{ to = \"walk\", end = true }}]\n"), "the state's speed is 0"),
        (format!("{state}speed = -0.001\n"), "the speed -0.001 would be stored as 0; the slowest is 0.00390625"),
        (format!("{state}{state}"), "4: two states are called `walk`"),
        (format!("{state}[[state]]\nname = \"run\"\n"), "4: no transition leads to state `run`"),
        (format!("{state}speed = 5\n"), "the speed 5 is outside -4 to 4"),
        (format!("{state}speed = nan\n"), "outside -4 to 4"),
        (format!("start = \"run\"\n{state}"), "1: start: no state `run`"),
        (format!("{state}[[parameter]]\nname = \"v\"\nrange = [3, 3]\n"), "4: parameter `v`: the range 3 to 3 is empty"),
        (format!("{state}[[parameter]]\nname = \"v\"\nrange = [3, 4]\nfirst = 5\n"), "5 is outside its range 3 to 4"),
        (format!("{state}blend = {{ clip = \"run\", by = \"v\" }}\n"), "3: state `walk`: blend: no [[parameter]] `v`"),
        ("[[state]]\nname = \"\"\nclip = \"walk\"\n".into(), "2: a name is empty"),
        ("[[state]]\nname = 3\n".into(), "2: "),
        ("[[state]]\nname = \"walk\"\ncolour = 3\n".into(), "3: unknown field `colour`"),
        ("[[state]\n".into(), "1: "),
        (String::new(), "missing field `state`"),
        ("state = []\n".into(), "at least one [[state]]"),
    ] {
        let error = error(&text);
        assert!(error.contains(part), "{text}\n{error}");
    }
}

/// A transition that a like one hides in one state only can happen in the others; so can the two sides of a threshold.
#[test]
fn what_can_happen_is_no_error() {
    let [state, run] = ["walk", "run"].map(|name| format!("[[state]]\nname = \"{name}\"\n"));
    let text = format!(
        "[[any]]\nto = \"run\"\ninput = \"a\"\n{state}transitions = [{{ to = \"walk\", above = [\"v\", 5] }}, {{ to = \"walk\", above = [\"v\", 3] }}]\n\
         {run}transitions = [{{ to = \"walk\", input = \"a\" }}, {{ to = \"walk\", below = [\"v\", 1] }}]\n\
         [[parameter]]\nname = \"v\"\nrange = [0, 9]\n"
    );
    let (bytes, file) = (small_bank(), Text { name: "a.toml", text: &text });
    make(&Source::parse(&file).unwrap(), &file, &Bank::new_checked(&bytes).unwrap()).unwrap();
}

/// The table has ids, and clips give their names ids of their own.
#[test]
fn an_id_that_is_another_event_elsewhere_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (name, event) in [("a", "clap"), ("b", "boom")] {
        let text = format!(
            "keyframes 1\nfps 30\nframes 20\ncm-per-unit 1\njoint hip offset 0 90 0 channels Xrotation\nend parent hip offset 0 -45 0\n\
             event {event} 5\nkeys linear hip\n 0 -20\n 10 20\n 19 -20\n"
        );
        std::fs::write(folder.path().join(name).with_extension("keys"), text).unwrap();
    }
    let run = |arguments: &[&str]| {
        let out = Command::new(env!("CARGO_BIN_EXE_pantin")).args(arguments).current_dir(folder.path()).output().unwrap();
        (out.status.code(), String::from_utf8_lossy(&out.stderr).into_owned())
    };
    let (code, said) = run(&["convert", "a.keys", "b.keys", "--same-form", "--effort", "fast", "-o", "ab.ptb"]);
    assert_eq!(code, Some(0), "{said}");
    let states =
        "bank = \"ab.ptb\"\n[[state]]\nname = \"a\"\ntransitions = [{ to = \"b\", event = \"clap\" }]\n[[state]]\nname = \"b\"\n";
    std::fs::write(folder.path().join("own.toml"), format!("{states}transitions = [{{ to = \"a\", event = \"boom\" }}]\n"))
        .unwrap();
    assert_eq!(run(&["machine", "own.toml", "-o", "own.ptb"]).0, Some(0));
    // In the state that it leads to it does not happen, whatever its id is there.
    std::fs::write(
        folder.path().join("to.toml"),
        format!("{states}[[any]]\nto = \"b\"\nevent = \"clap\"\n").replace("event = \"clap\" }", "end = true }"),
    )
    .unwrap();
    let (code, said) = run(&["machine", "to.toml", "-o", "to.ptb"]);
    assert_eq!(code, Some(0), "{said}");
    std::fs::write(
        folder.path().join("any.toml"),
        format!("{states}[[state]]\nname = \"c\"\nclip = \"a\"\n[[any]]\nto = \"c\"\nevent = \"clap\"\n"),
    )
    .unwrap();
    let (code, said) = run(&["machine", "any.toml", "-o", "any.ptb"]);
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("event `clap` has the id 0, which is `boom` in the clip `b`"), "{said}");
    // Clips hold no machine, and today's boards play none: both is said.
    let (code, said) = run(&["unpack", "own.ptb", "-o", "clips"]);
    assert!(code == Some(0) && said.contains("own.ptb: the bank's state machine stays in it"), "{said}");
    let (code, said) = run(&["flash-image", "own.ptb", "--board", "pico", "-o", "own.uf2"]);
    assert!(code == Some(0) && said.contains("not the state machine"), "{said}");
    let out = Command::new(env!("CARGO_BIN_EXE_pantin")).args(["list", "own.ptb"]).current_dir(folder.path()).output().unwrap();
    assert!(String::from_utf8_lossy(&out.stdout).contains("state machine"), "{out:?}");
}

/// What begins with a count is no line.
#[test]
fn too_many_of_anything_is_an_error_of_the_file() {
    let states: String = (0..65).map(|index| format!("[[state]]\nname = \"s{index}\"\nclip = \"walk\"\n")).collect();
    assert_eq!(error(&states), "a.toml: 65 states; at most 64");
    let parameters: String = (0..9).map(|index| format!("[[parameter]]\nname = \"p{index}\"\nrange = [0, 1]\n")).collect();
    assert_eq!(error(&format!("[[state]]\nname = \"walk\"\n{parameters}")), "a.toml: 9 parameters; at most 8");
    // More than a byte counts.
    let inputs: String = (0..300).map(|index| format!("{{ to = \"walk\", input = \"i{index}\" }},")).collect();
    let said = error(&format!("[[state]]\nname = \"walk\"\ntransitions = [{inputs}]\n"));
    assert!(said.ends_with("the input `i32` is one more than the 32 that a machine may have"), "{said}");
}

#[test]
fn a_clip_that_is_not_there_is_an_error_of_the_state_that_names_it() {
    let text = "[[state]]\nname = \"walk\"\ntransitions = [{ to = \"back\", input = \"a\" }]\n[[state]]\nname = \"back\"\nclip = \"wlak\"\n";
    assert_eq!(error(text), "a.toml:6: state `back`: the bank has no clip `wlak`; it has `walk`, `run`");
}

fn pantin(arguments: &[&std::ffi::OsStr]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pantin")).args(arguments).output().unwrap()
}

/// The committed character: as a program it is steered through each of its states.
#[test]
fn our_character_goes_through_all_its_states() {
    let folder = tempfile::tempdir().unwrap();
    let [library, bank, graph] = ["library.ptb", "character.ptb", "character.svg"].map(|name| folder.path().join(name));
    let (source, toml) = (motions().join("library"), motions().join("character.toml"));
    let convert =
        ["convert".as_ref(), source.as_os_str(), "--same-form".as_ref(), "--effort".as_ref(), "fast".as_ref(), "-o".as_ref()];
    let out = pantin(&[&convert[..], &[library.as_os_str()]].concat());
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let machine = ["machine".as_ref(), toml.as_os_str(), "--bank".as_ref(), library.as_os_str(), "-o".as_ref(), bank.as_os_str()];
    let out = pantin(&[&machine[..], &["--graph".as_ref(), graph.as_os_str()]].concat());
    let said = String::from_utf8_lossy(&out.stderr).into_owned();
    assert!(out.status.success() && said.contains("16 states, 29 transitions") && !said.contains("warning"), "{said}");
    let picture = std::fs::read_to_string(&graph).unwrap();
    let document = roxmltree::Document::parse(&picture).unwrap();
    let texts: Vec<&str> = document.descendants().filter_map(|node| node.text()).collect();
    assert!(texts.contains(&"layer wave, by wave, over start, walk, run"), "{texts:?}");
    assert!(["idle", "get_up", "no dance", "trip"].iter().all(|text| texts.contains(text)), "{texts:?}");
    // In a column of a page its letters have 11 pixels at least.
    let width: f64 = document.root_element().attribute("width").unwrap().parse().unwrap();
    let sizes = document.descendants().filter_map(|node| node.attribute("font-size")?.parse().ok());
    let smallest = sizes.fold(f64::INFINITY, f64::min);
    assert!(smallest * (700.0 / width).min(1.0) >= 11.0, "{smallest} in a width of {width}");
    let bytes = std::fs::read(&bank).unwrap();
    let (bank, table) = (Bank::new_checked(&bytes).unwrap(), Table::of_bank(&bytes).unwrap());
    let mut machine = Machine::new(table);
    let mut memory = Workspace::<80, 100>::new();
    let mut animator = Animator::new(machine.first_clip(&bank).unwrap(), memory.lend()).unwrap();
    let mut visited = vec![machine.state()];
    // Inputs held or fired, and for how many pictures.
    let script: [(&[&str], &str, usize); 22] = [
        (&["go"], "", 90),
        (&["go", "fast"], "", 60),
        (&["go", "fast"], "jump", 60),
        (&["go"], "", 40),
        (&[], "", 90),
        (&[], "jump", 80),
        (&[], "wave", 90),
        (&[], "bow", 90),
        (&[], "left", 60),
        (&[], "right", 60),
        (&["dance"], "", 90),
        (&[], "", 40),
        (&[], "sit", 90),
        (&[], "stand", 70),
        (&["go"], "", 60),
        (&["go"], "trip", 60),
        (&["go"], "", 40),
        (&[], "", 120),
        (&["go"], "jump", 40),
        (&[], "", 90),
        (&[], "wave", 20),
        (&[], "", 90),
    ];
    for (held, fired, pictures) in script {
        for input in ["go", "fast", "dance"] {
            machine.hold(table.input(input).unwrap(), held.contains(&input));
        }
        if let Some(input) = table.input(fired) {
            machine.fire(input);
        }
        for _ in 0..pictures {
            let updated = machine.update(33_333, &bank, &mut animator, None).unwrap();
            visited.extend(updated.entered);
        }
    }
    let mut names: Vec<&str> = visited.iter().map(|&state| table.state_name(state)).collect();
    assert_eq!(names[..8], ["idle", "start", "walk", "run", "leap", "run", "walk", "stop"]);
    assert_eq!(*names.last().unwrap(), "idle");
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), table.states(), "{names:?}");
}

#[test]
fn the_command_refuses_what_it_cannot_do_and_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let bank = put("moves.ptb", &small_bank());
    let good = put("good.toml", SMALL.as_bytes());
    let run = |arguments: &[&str]| {
        let out = Command::new(env!("CARGO_BIN_EXE_pantin")).arg("machine").args(arguments).current_dir(folder.path()).output();
        let out = out.unwrap();
        (out.status.code(), String::from_utf8_lossy(&out.stderr).into_owned())
    };
    put("lone.toml", b"[[state]]\nname = \"walk\"\n");
    put("line.toml", b"bank = \"moves.ptb\"\n[[state]]\nname = \"fly\"\n");
    put("clip.ptb", &std::fs::read(motions().join("walk.ptn")).unwrap());
    put("bad.toml", b"\xff\xfe");
    for (arguments, code, part) in [
        (&["lone.toml", "-o", "a.ptb"][..], 1, "lone.toml: no bank; write `bank = \"FILE.ptb\"`"),
        (&["line.toml", "-o", "a.ptb"], 1, "line.toml:3: state `fly`: the bank has no clip `fly`"),
        (&["lone.toml", "--bank", "clip.ptb", "-o", "a.ptb"], 1, "clip.ptb: not a bank"),
        (&["bad.toml", "-o", "a.ptb"], 1, "bad.toml: not text"),
        (&["moves.ptb", "-o", "a.ptb"], 1, "moves.ptb: a bank; the state machine is a .toml file"),
        (&["good.toml", "-o", "moves.ptb"], 1, "moves.ptb"),
        (&["good.toml", "-o", "a.bvh"], 1, "a.bvh"),
        (&["good.toml", "-o", "a.ptb", "--graph", "a.png"], 1, "the graph is written as .svg"),
    ] {
        let (got, said) = run(arguments);
        assert!(got == Some(code) && said.contains(part), "{arguments:?}: {said}");
        assert!(!folder.path().join("a.ptb").exists());
    }
    assert_eq!(std::fs::read(&bank).unwrap(), small_bank());
    let (code, said) = run(&["good.toml"]);
    assert!(code == Some(0) && said.contains("no bank written") && !folder.path().join("a.ptb").exists(), "{said}");
    assert_eq!(run(&["good.toml", "-o", "a.ptb"]).0, Some(0));
    assert!(good.exists() && Table::of_bank(&std::fs::read(folder.path().join("a.ptb")).unwrap()).is_ok());
    let _ = graph::svg(&Source::parse(&Text { name: "good.toml", text: SMALL }).unwrap());
}

#[test]
fn a_layer_is_checked_as_a_state_is() {
    let state = "[[state]]\nname = \"walk\"\n";
    let layer = |rest: &str| format!("[[layer]]\nclip = \"run\"\ninput = \"go\"\n{rest}\n{state}");
    for (text, part) in [
        (layer(""), "missing field `joints`"),
        (layer("joints = []"), "layer: joints: it has none"),
        (layer("joints = [\"*\"]\nstates = []"), "layer: states: it has none"),
        (layer("joints = [\"wing\"]"), "layer: joints: `wing`"),
        (layer("joints = [\"*\"]\nstates = [\"fly\"]"), "layer: no state `fly`; there are `walk`"),
        (layer("joints = [\"*\"]\nseconds = 4.5"), "seconds: expected 0 to 3.98"),
        (layer("joints = [\"*\"]").replace("\"run\"", "\"fly\""), "the bank has no clip `fly`"),
    ] {
        let error = error(&text);
        assert!(error.contains(part), "{text}\n{error}");
    }
    let bytes = small_bank();
    let bank = Bank::new_checked(&bytes).unwrap();
    let text = layer("joints = [\"*\"]\nstates = [\"walk\"]\nseconds = 0.5");
    let file = Text { name: "a.toml", text: &text };
    let made = make(&Source::parse(&file).unwrap(), &file, &bank).unwrap();
    let table = Table::new(&made.table, bank.len()).unwrap();
    let row = table.layer(0).unwrap();
    assert_eq!((table.layers(), row.clip, row.fade_us, row.states, row.joints), (1, 1, 500_000, 1, "*"));
    assert_eq!((table.inputs(), table.input_name(row.input)), (1, "go"));
}

/// The text of a figure of three joints with a base at the origin; it goes 2 m in a second, by its base or by its hips.
fn goer(joint: &str) -> String {
    let places = |own: &str, height: u32| match own == joint {
        true => format!("keys linear {own}\n 0 0 {height} 0\n 30 0 {height} 200\n"),
        false => format!("keys linear {own}\n 0 0 {height} 0\n 30 0 {height} 0\n"),
    };
    let position = "Xposition Yposition Zposition";
    let figure = format!(
        "joint base offset 0 0 0 channels {position}\njoint hips parent base offset 0 90 0 channels {position}\n\
         joint chest parent hips offset 0 40 0 channels Xrotation\nend parent chest offset 0 40 0\n"
    );
    let [base, hips] = [places("base", 0), places("hips", 90)];
    format!("keyframes 1\nfps 30\nframes 31\ncm-per-unit 1\n{figure}{base}{hips}keys linear chest\n 0 0\n 30 20\n")
}

#[test]
fn clips_that_travel_by_different_joints_are_warned_of() {
    let folder = super::outputs::Folder::new();
    for (name, joint) in [("walk", "base"), ("run", "base"), ("kick", "hips")] {
        folder.put(&format!("{name}.keys"), goer(joint));
    }
    folder.put("hero.toml", "[[state]]\nname = \"walk\"\ntransitions = [{ to = \"kick\", end = true }]\n[[state]]\nname = \"kick\"\n[[any]]\nto = \"walk\"\nend = true\n");
    let said = |arguments: &[&str]| String::from_utf8(folder.done(arguments).stderr).unwrap();
    let both = "warning: the clips travel by different joints, so that the figure jumps at changes between them: `walk`, `run` by `base`; `kick` by `hips`; `pantin convert` with the same --body FILE";
    for bank in [
        &["convert", "walk.keys", "run.keys", "kick.keys", "--same-form", "-o", "moves.ptb"][..],
        &["machine", "hero.toml", "--bank", "moves.ptb"],
    ] {
        let said = said(bank);
        assert!(said.contains(both), "{bank:?}: {said}");
    }
    let alike = said(&["convert", "walk.keys", "run.keys", "--same-form", "-o", "alike.ptb"]);
    assert!(!alike.contains("travel"), "{alike}");
}

fn warnings(text: &str) -> Vec<String> {
    let bytes = small_bank();
    let file = Text { name: "a.toml", text };
    let made = make(&Source::parse(&file).unwrap(), &file, &Bank::new_checked(&bytes).unwrap()).unwrap();
    made.warnings.iter().map(ToString::to_string).collect()
}

#[test]
fn errors_and_warnings_have_a_line_and_a_column() {
    let bytes = small_bank();
    let location = |text: &str| {
        let file = Text { name: "a.toml", text };
        let made = Source::parse(&file).and_then(|source| compile(&source, &file, &bytes));
        made.unwrap_err().downcast_ref::<Location>().unwrap().at
    };
    let state = "[[state]]\nname = \"walk\"\n";
    // Columns count characters.
    let second = "transitions = [{ to = \"walk\", input = \"ö\" }, { to = \"x\", input = \"a\" }]\n";
    assert_eq!(location(&format!("{state}{second}")), Some((3, 46)));
    assert_eq!(location(&format!("{state}clip = \"fly\"\n")), Some((3, 8)));
    assert_eq!(location(&format!("{state}speed = 9.0\n")), Some((2, 8)));
    assert_eq!(location(&format!("{state}blend = {{ clip = \"run\", by = \"v\" }}\n")), Some((3, 9)));
    assert_eq!(location(&format!("{state}transitions = 1\n")), Some((3, 15)));
    assert_eq!(location("state = []\n"), None);
    let unused = format!("[[parameter]]\nname = \"v\"\nrange = [0, 9]\n{state}");
    let file = Text { name: "a.toml", text: &unused };
    let made = compile(&Source::parse(&file).unwrap(), &file, &bytes).unwrap();
    assert_eq!(made.warnings[0].location.as_ref().unwrap().at, Some((2, 8)));
}

#[test]
fn inputs_that_do_something_and_those_that_are_held_are_known() {
    let bytes = small_bank();
    let layer = "\n[[layer]]\nclip = \"run\"\ninput = \"hurry\"\njoints = [\"*\"]\nstates = [\"run\"]\n";
    let text = format!("{SMALL}{layer}");
    let source = Source::parse(&Text { name: "a.toml", text: &text }).unwrap();
    let own = [("stop", vec!["go", "halt"]), ("go", vec!["go", "halt"]), ("run", vec!["halt", "hurry"])];
    assert_eq!(inputs::of_states(&source), own);
    // A loop plays as long as its input is held.
    assert_eq!(inputs::held(&source, &Bank::new_checked(&bytes).unwrap()).into_iter().collect::<Vec<_>>(), ["go", "hurry"]);
}

#[test]
fn states_between_which_held_inputs_go_back_and_forth_are_warned_of() {
    let two = |there: &str, back: &str| {
        format!(
            "[[parameter]]\nname = \"speed\"\nrange = [0, 100]\n[[state]]\nname = \"walk\"\ntransitions = [{there}]\n\
             [[state]]\nname = \"run\"\ntransitions = [{back}]\n"
        )
    };
    let to_run = |condition: &str| format!("{{ to = \"run\", {condition} }}");
    let to_walk = |condition: &str| format!("{{ to = \"walk\", {condition} }}");
    for (there, back, when) in [
        ("input = \"fast\"", "input = \"slow\"", Some("while `fast` is held and `slow` is held,")),
        ("input = \"fast\"", "input = \"fast\"", Some("while `fast` is held,")),
        ("input = \"fast\"", "released = \"fast\"", None),
        ("input = \"fast\"", "released = \"go\"", Some("while `fast` is held and `go` is not held,")),
        ("above = [\"speed\", 40]", "below = [\"speed\", 60]", Some("while `speed` is 41 to 59,")),
        ("above = [\"speed\", 40]", "below = [\"speed\", 41]", None),
    ] {
        let found = warnings(&two(&to_run(there), &to_walk(back)));
        let found: Vec<&String> = found.iter().filter(|text| text.contains("back and forth")).collect();
        match when {
            None => assert!(found.is_empty(), "{there} {back}: {found:?}"),
            Some(when) => assert!(found.len() == 1 && found[0].contains(when), "{there} {back}: {found:?}"),
        }
    }
    let found = warnings(&two(&to_run("input = \"fast\""), &to_walk("input = \"slow\"")));
    let told = found.iter().find(|text| text.contains("back and forth")).unwrap();
    assert!(
        told.starts_with("a.toml:6: states `walk` and `run`: ") && told.contains("the transition of line 9 leads back"),
        "{told}"
    );
    // A transition before it that is taken under the same condition hides one.
    let first = "{ to = \"walk\", start = 1, released = \"slow\" }, ";
    let hidden = two(&to_run("input = \"fast\""), &format!("{first}{}", to_walk("above = [\"speed\", 3]")));
    assert!(warnings(&hidden).iter().any(|text| text.contains("`slow` is not held")));
    // A transition from any state leads back, too.
    let any =
        |condition: &str| warnings(&format!("{}[[any]]\nto = \"walk\"\n{condition}\n", two(&to_run("input = \"fast\""), "")));
    let released = any("released = \"power\"");
    assert!(released.iter().any(|text| text.contains("while `power` is not held and `fast` is held,")), "{released:?}");
    // An input that leads away from any state is fired.
    assert!(!any("input = \"halt\"").iter().any(|text| text.contains("back and forth")));
}

#[test]
fn a_change_of_velocity_that_no_body_could_make_is_warned_of() {
    let stops = |seconds: f64| {
        let text = format!(
            "[feet]\n[[state]]\nname = \"run\"\ntransitions = [{{ to = \"stand\", input = \"halt\", seconds = {seconds} }}]\n\
             [[state]]\nname = \"stand\"\nclip = \"walk\"\nspeed = 0.0\ntransitions = [{{ to = \"run\", input = \"go\", seconds = 1.0 }}]\n"
        );
        warnings(&text).into_iter().filter(|text| text.contains("velocity")).collect::<Vec<String>>()
    };
    // From 1.8 m/s.
    let hasty = stops(0.1);
    assert!(
        hasty.len() == 1
            && hasty[0]
                .starts_with("a.toml:4: state `run`: in the 0.10 s to `stand` the velocity of the figure would change by 1."),
        "{hasty:?}"
    );
    assert_eq!(stops(1.0), [""; 0]);
}

/// The farthest that a joint goes in a picture about the hips at 60 a second, before a program sets the parameter of a blend from one end to the other
/// at once, and after it; and how far the figure goes in the last second.
fn blended(blend: &str) -> [f64; 3] {
    let text = format!(
        "[[parameter]]\nname = \"speed\"\nrange = [0, 100]\n[[state]]\nname = \"move\"\nclip = \"walk\"\n\
         blend = {{ clip = \"run\", by = \"speed\"{blend} }}\n"
    );
    let bytes = small_bank();
    let file = Text { name: "a.toml", text: &text };
    let made = make(&Source::parse(&file).unwrap(), &file, &Bank::new_checked(&bytes).unwrap()).unwrap();
    let bytes = bank::with_section(&bytes, SECTION, &made.table).unwrap();
    let table = Table::of_bank(&bytes).unwrap();
    let session = Session::new_checked("1.5 set speed 100\n4 end", &table).unwrap();
    let mut poses: Vec<Vec<[f64; 3]>> = Vec::new();
    play(&bytes, Replay::new(session, 60), |character| {
        poses.push(joints(character));
        Ok(())
    })
    .unwrap();
    let way = |pair: &[Vec<[f64; 3]>], joint: usize| {
        let about = |axis: usize| (pair[1][joint][axis] - pair[1][0][axis]) - (pair[0][joint][axis] - pair[0][0][axis]);
        (0..3).map(|axis| about(axis).powi(2)).sum::<f64>().sqrt()
    };
    let farthest = |poses: &[Vec<[f64; 3]>]| {
        poses.windows(2).flat_map(|pair| (0..pair[0].len()).map(move |joint| way(pair, joint))).fold(0.0, f64::max)
    };
    let [from, to] = [poses[180][0], poses[239][0]];
    [farthest(&poses[..88]), farthest(&poses[88..]), (0..3).map(|axis| (to[axis] - from[axis]).powi(2)).sum::<f64>().sqrt()]
}

#[test]
fn a_blend_follows_its_parameter_in_its_time() {
    let [walk, at_once, run] = blended(", seconds = 0");
    assert!(at_once > 2.0 * walk, "{at_once} cm; the walk {walk}");
    // Two clips that move as fast as the faster one, and the way from one to the other in half a second.
    let [_, followed, same] = blended("");
    assert!(followed < 0.7 * at_once, "{followed} cm; at once {at_once}");
    assert!((same - run).abs() < 0.02 * run, "{same} cm in a second; at once {run}");
    assert!(error("[[parameter]]\nname = \"v\"\nrange = [0, 1]\n[[state]]\nname = \"walk\"\nblend = { clip = \"run\", by = \"v\", seconds = 5 }\n")
        .contains("blend: seconds: expected 0 to"));
}
