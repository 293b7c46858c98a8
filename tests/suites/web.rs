//! The web page in a real Chromium: its pictures are the host's, pixel by pixel, and everything on it is driven as a user would.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;
use std::time::Duration;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use harness::display::{GREYS, Picture};
use harness::download::BOARDS;
use harness::web::browser::{Browser, skipped};
use harness::web::{self, browsers, slow};
use harness::{build, clips, paths, screen, setup, simulator, steered};
use pantin::Clip;
use pantin_convert::expand::expand;
use pantin_convert::export::gltf;
use pantin_convert::import::{self, ImportOptions};
use pantin_convert::motion::Motion;
use pantin_convert::verify;
use pantin_face::talk::{Talk, VISEMES};
use pantin_figure::rotation::Rotation;
use pantin_figure::solid::look_text;
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::animator;

/// Chromium, and the address of the page, built and served once for all tests, with some more files.
static STAGE: LazyLock<(Browser, String)> = LazyLock::new(|| {
    let clips = extras().into_iter().map(|(name, bytes)| (format!("/extra/{name}.ptn"), bytes));
    (Browser::ready().unwrap(), web::served(clips.chain(others()).collect()).unwrap())
});

/// The firmware's code as modules, in a folder of their own: decoder, figure and animator, and the face.
static MODULES: LazyLock<(TempDir, [PathBuf; 2])> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let paths = ["player.wasm", "face.wasm"].map(|name| folder.path().join(name));
    for (path, module) in paths.iter().zip([web::player_module(), web::face_module()]) {
        std::fs::write(path, module.unwrap()).unwrap();
    }
    (folder, paths)
});

/// Captured figures of different makers.
const CAPTURED: [&str; 5] = [
    "bvh_bandai1_dance.bvh",
    "bvh_cmu01_hops-and-turn.bvh",
    "bvh_diema_anger.bvh",
    "bvh_mixamo-beta_gangnam-dance.bvh",
    "gltf_khronos_fox.glb",
];

/// Files that are no good, and a long one.
fn extras() -> Vec<(&'static str, Vec<u8>)> {
    let long = std::fs::read(long()).unwrap();
    let mut damaged = long.clone();
    let late = long.len() * 3 / 4;
    damaged[late] ^= 0x10;
    let mut version = long.clone();
    version[2] = 3;
    vec![
        ("truncated", long[..late].to_vec()),
        ("damaged", damaged),
        ("version", version),
        ("head", long[..20].to_vec()),
        ("empty", vec![]),
        ("nonsense", b"<html>this is no clip</html>".repeat(100)),
        ("long", long),
    ]
}

/// Key clips and a bank of them, characters, and modules of the player by themselves.
fn others() -> Vec<(String, Vec<u8>)> {
    let read = |path: &str| std::fs::read(paths::root().join(path)).unwrap();
    let key = |name: &str| (format!("/extra/key-{name}"), read(&format!("tests/key-vectors/{name}")));
    let mut files: Vec<_> = ["walk.ptn", "greet.ptn", "events.ptn", "bank.ptb", "malformed-noise.ptn"].map(key).into();
    let walk = read("tests/key-vectors/walk.ptn");
    files.push(("/extra/key-truncated.ptn".into(), walk[..walk.len() - 20].to_vec()));
    files.push(("/extra/turn-orders.ptn".into(), read("tests/vectors/turn-orders.ptn")));
    let cat = String::from_utf8(read("motions/looks/cat.look")).unwrap();
    files.push(("/extra/cat.look".into(), look_text::compile(&cat).unwrap().to_vec()));
    files.push(("/extra/wrong.look".into(), b"# a comment\n\nradius hip 201\n".to_vec()));
    files.push(("/extra/smiling.ptb".into(), animator::smiling()));
    for (name, module) in [("tables", "decoder"), ("clip", "decoder"), ("figure", "player")] {
        files.push((format!("/source/{name}.js"), read(&format!("web/packages/{module}/{name}.js"))));
    }
    files
}

/// A clip of several blocks: our walk, exact, eight times as many frames.
fn long() -> &'static Path {
    static LONG: LazyLock<(TempDir, PathBuf)> = LazyLock::new(|| {
        let folder = tempfile::tempdir().unwrap();
        let clip = folder.path().join("long.ptn");
        let mut tool = Command::new(build::host_tool().unwrap());
        tool.arg("convert").arg(paths::root().join("motions/wave.proc")).arg("-o").arg(&clip);
        assert!(tool.args(["--max-error", "0.005cm", "--effort", "fast", "--quiet"]).status().unwrap().success());
        (folder, clip)
    });
    &LONG.1
}

/// Drives the page.
pub(crate) fn drive(case: &str, mut arguments: Value) -> Value {
    let (browser, address) = &*STAGE;
    arguments["site"] = json!(address);
    browser.drive(case, &arguments).unwrap_or_else(|error| panic!("{error:#}"))
}

/// A file of ours.
pub(crate) fn own(name: &str) -> PathBuf {
    paths::root().join("motions").join(name)
}

fn picture(greys: &Value) -> Picture {
    let pixels = greys.as_str().unwrap().chars().map(|grey| grey.to_digit(16).unwrap() as u16).collect::<Vec<_>>();
    assert_eq!(pixels.len(), GREYS.width * GREYS.height);
    Picture { display: GREYS, pixels }
}

/// Our own walk, a face, both, and key clips of a walk and of a body with a face: a file for the page, one for the host, and frames in an order that goes back and forth.
#[test]
fn the_canvas_shows_what_the_host_shows() {
    if skipped("the page's pictures") {
        return;
    }
    let views: [(&[u8], i32, i32); 4] = [(b"", -50, 12), (b"aa", -80, 12), (b"ddddw", 10, 17), (b"vvss", -90, 2)];
    let (mut parts, mut expected) = (vec![], vec![]);
    let key = |name: &str| (paths::root().join("tests/key-vectors").join(name), format!("extra/key-{name}"));
    let clip = |name: &str| (own(name), format!("clips/{}", Path::new(name).file_name().unwrap().to_string_lossy()));
    let clips = ["walk.ptn", "face/hello.ptn", "greet.ptn", "face/wink.ptn"].map(clip);
    for (path, file) in clips.into_iter().chain(["walk.ptn", "greet.ptn"].map(key)) {
        let frames = Clip::new_checked(&std::fs::read(&path).unwrap()).unwrap().frames() as usize;
        let mut order: Vec<usize> = (0..frames.min(40)).chain([frames - 1, 7, 6, 5, frames / 2, frames / 2 - 1, 0]).collect();
        order.extend((0..frames).rev().step_by(3));
        for (letters, orbit, tilt) in views {
            let keys: Vec<&[u8]> = std::iter::once(letters).chain(vec![&b""[..]; frames]).collect();
            let shown = simulator::play::<Rotation>(GREYS, std::slice::from_ref(&path), &[], &keys).unwrap();
            parts.push(json!({ "clip": file, "frames": order, "orbit": orbit, "tilt": tilt }));
            let of = |&frame: &usize| shown[1..].iter().find(|(number, _)| *number as usize == frame).unwrap().1.clone();
            expected.push((file.clone(), orbit, order.clone(), order.iter().map(of).collect::<Vec<_>>()));
        }
    }
    let shown = drive("pixels", json!({ "parts": parts }));
    let mut count = 0;
    for ((clip, orbit, frames, pictures), shown) in expected.iter().zip(shown.as_array().unwrap()) {
        for ((frame, expected), shown) in frames.iter().zip(pictures).zip(shown.as_array().unwrap()) {
            assert!(!expected.is_dark());
            if let Some(difference) = screen::difference(&picture(shown), expected) {
                panic!("{clip}, frame {frame} from {orbit} degrees: {difference}");
            }
            count += 1;
        }
    }
    assert!(count > 500);
    println!("{count} pictures are equal");
}

#[test]
fn a_character_is_steered_as_on_the_host() {
    if skipped("the page's character") {
        return;
    }
    let session = std::fs::read_to_string(steered::script()).unwrap();
    let seen = drive("character", json!({ "session": session }));
    let expected = steered::pictures().unwrap();
    let shown = seen["shown"].as_array().unwrap();
    assert_eq!(shown.len(), 91);
    for (number, (shown, expected)) in shown.iter().zip(expected.iter().step_by(10)).enumerate() {
        if let Some(difference) = screen::difference(&picture(shown), expected) {
            panic!("picture {}: {difference}", 10 * number);
        }
    }
    let states: Vec<&str> = seen["states"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
    assert_eq!(states[..4], ["idle", "start", "walk", "run"]);
}

/// A text with a state more, compiled by the page, is the bank that `pantin machine` makes of it.
#[test]
fn the_text_of_a_state_machine_is_edited_in_the_page() {
    if skipped("the page's state machine") {
        return;
    }
    let text = std::fs::read_to_string(own("character.toml")).unwrap();
    let dance = "    { to = \"dance\", input = \"dance\" },\n";
    assert!(text.contains(dance));
    let edited = text.replace(dance, &format!("{dance}    {{ to = \"cheer\", input = \"cheer\" }},\n"))
        + "\n[[state]]\nname = \"cheer\"\nclip = \"bow\"\ntransitions = [{ to = \"idle\", released = \"cheer\" }]\n"
        + "\n[[parameter]]\nname = \"pace\"\nrange = [0, 10]\n";
    let folder = tempfile::tempdir().unwrap();
    let [file, bank] = ["edited.toml", "edited.ptb"].map(|name| folder.path().join(name));
    std::fs::write(&file, &edited).unwrap();
    let mut tool = Command::new(build::host_tool().unwrap());
    tool.arg("machine").arg(&file).arg("--bank").arg(own("character.ptb")).arg("-o").arg(&bank).arg("--quiet");
    assert!(tool.status().unwrap().success());
    let bytes = std::fs::metadata(own("character.ptb")).unwrap().len();
    drive("machine", json!({ "text": text, "edited": edited, "bank": bank, "bytes": bytes }));
}

#[test]
fn the_modules_stand_whatever_bytes_they_get() {
    if skipped("the player's modules") {
        return;
    }
    let mut node = Command::new(setup::emulator("node").unwrap());
    node.arg(paths::root().join("tests/web/module.mjs"))
        .args(&MODULES.1)
        .args(["walk.ptn", "greet.ptn", "face/hello.ptn"].map(own));
    let output = node.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    println!("{}", String::from_utf8_lossy(&output.stdout));
}

/// The element's decoder and figure are JavaScript; the firmware's are in a module.
#[test]
fn the_element_draws_the_strokes_of_the_firmware() {
    if skipped("the element's figure") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut clips: Vec<PathBuf> = ["walk.ptn", "run.ptn", "greet.ptn", "kneebend.ptn"].map(own).into();
    let vectors = std::fs::read_dir(paths::root().join("tests/vectors")).unwrap().map(|entry| entry.unwrap().path());
    // A clip whose rig is apart is no clip of the module's.
    clips.extend(vectors.filter(|path| path.extension().is_some_and(|end| end == "ptn") && !path.ends_with("rig-apart.ptn")));
    for name in CAPTURED {
        let Some(data) = paths::data() else { break };
        let clip = folder.path().join(name).with_extension("ptn");
        let mut tool = Command::new(build::host_tool().unwrap());
        tool.arg("convert").arg(data.join(name)).arg("-o").arg(&clip).args(["--to", "60", "--effort", "fast", "--quiet"]);
        assert!(tool.status().unwrap().success(), "{name}");
        clips.push(clip);
    }
    clips.sort();
    let mut node = Command::new(setup::emulator("node").unwrap());
    node.arg(paths::root().join("tests/web/lines.mjs")).arg(&MODULES.1[0]);
    let output = node.args(clips).arg(own("character.ptb")).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    println!("{}", String::from_utf8_lossy(&output.stdout));
}

/// Our faces, every unit of the face by itself and by the names of Live Link Face, and a captured one.
#[test]
fn the_element_draws_the_lines_of_the_firmwares_face() {
    if skipped("the element's face") {
        return;
    }
    assert!(!STAGE.1.is_empty(), "the script was built");
    let folder = tempfile::tempdir().unwrap();
    let mut sources: Vec<PathBuf> = std::fs::read_dir(own("face")).unwrap().map(|entry| entry.unwrap().path()).collect();
    let names: Vec<&str> = pantin_face::NAMES.lines().collect();
    for (number, names) in names.chunks(20).enumerate() {
        let rows = (0..2 * names.len()).map(|row| {
            let value = |index: usize| {
                if row / 2 != index {
                    "0"
                } else if row % 2 == 0 {
                    "0.8"
                } else {
                    "-0.6"
                }
            };
            (0..names.len()).map(value).collect::<Vec<_>>().join(",")
        });
        let table = folder.path().join(format!("units-{number}.csv"));
        std::fs::write(&table, format!("{}\n{}\n", names.join(","), rows.collect::<Vec<_>>().join("\n"))).unwrap();
        sources.push(table);
    }
    sources.extend(paths::data().map(|data| data.join("face_neurosync_angry_arkit.csv")).filter(|path| path.is_file()));
    sources.sort();
    let mut clips = vec![own("greet.ptn"), own("walk.ptn")];
    for source in sources {
        if source.extension().is_some_and(|end| end == "ptn") {
            clips.push(source);
            continue;
        }
        let clip = folder.path().join(source.file_stem().unwrap()).with_extension("ptn");
        let mut tool = Command::new(build::host_tool().unwrap());
        tool.arg("convert").arg(&source).arg("-o").arg(&clip).args(["--effort", "fast", "--quiet", "--segments"]);
        if source.extension().is_some_and(|end| end == "csv") {
            tool.args(["--fps", "30"]);
        }
        assert!(tool.status().unwrap().success(), "{}", source.display());
        clips.push(clip);
    }
    let mut node = Command::new(setup::emulator("node").unwrap());
    node.arg(paths::root().join("tests/web/faces.mjs"))
        .arg(&MODULES.1[1])
        .arg(paths::root().join("target/web").join(web::FACE[0]));
    let output = node.args(clips).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    println!("{}", String::from_utf8_lossy(&output.stdout));
}

/// The page's lips are the firmware's, whatever they hear, and the page's own sentence has vowels that can be told apart.
#[test]
fn the_pages_lips_are_the_firmwares() {
    if skipped("the page's lips") {
        return;
    }
    let (mut count, mut strongest) = (0, BTreeSet::new());
    for case in drive("talk", json!({})).as_array().unwrap() {
        let number = |field: &str| case[field].as_u64().unwrap();
        let bytes = decoded(case["samples"].as_str().unwrap());
        let samples: Vec<i16> = bytes.chunks_exact(2).map(|pair| i16::from_le_bytes([pair[0], pair[1]])).collect();
        let mut talk = Talk::new(number("rate") as u32).unwrap();
        let expected: Vec<[u16; 14]> = serde_json::from_value(case["weights"].clone()).unwrap();
        assert_eq!(expected.len(), samples.len().div_ceil(number("part") as usize));
        for (index, (part, shown)) in samples.chunks(number("part") as usize).zip(&expected).enumerate() {
            talk.push(part);
            talk.step(number("ms") as u16);
            assert_eq!(talk.weights(), shown, "{} at {} Hz, part {index}", case["name"], number("rate"));
            let most = (0..14).max_by_key(|&viseme| shown[viseme]).unwrap();
            if case["name"] == "sentence" && shown[most] > 8000 {
                strongest.insert(VISEMES[most]);
            }
            count += 1;
        }
    }
    assert!(
        ["viseme_aa", "viseme_e", "viseme_i", "viseme_o", "viseme_ss"].iter().all(|name| strongest.contains(name)),
        "{strongest:?}"
    );
    println!("{count} parts of sound, {strongest:?}");
}

#[test]
fn the_pages_face_feels_and_speaks() {
    if skipped("the page's face") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("sound.wav");
    std::fs::write(&sound, open_vowels()).unwrap();
    drive("faces", json!({ "sound": sound }));
}

/// A WAV file of open vowels and gaps: harmonics of 125 Hz, the loudest of them near 700 and 1100 Hz.
fn open_vowels() -> Vec<u8> {
    const RATE: u32 = 16_000;
    let sample = |at: u32| {
        let time = f64::from(at) / f64::from(RATE);
        let tones = (1..20).map(|harmonic| 125.0 * f64::from(harmonic)).map(|hz| {
            let near = |formant: f64| 1.0 / (1.0 + ((hz - formant) / 120.0).powi(2));
            (near(730.0) + 0.7 * near(1090.0)) * (std::f64::consts::TAU * hz * time).sin()
        });
        let loud = if (at / 8000).is_multiple_of(2) { 4000.0 } else { 0.0 };
        (loud * tones.sum::<f64>()) as i16
    };
    let samples: Vec<u8> = (0..4 * RATE).flat_map(|at| sample(at).to_le_bytes()).collect();
    let u32s = |value: usize| (value as u32).to_le_bytes();
    let mut wav = [&b"RIFF"[..], &u32s(36 + samples.len()), b"WAVEfmt ", &u32s(16), &[1, 0, 1, 0]].concat();
    wav.extend(
        [&u32s(RATE as usize)[..], &u32s(2 * RATE as usize), &[2, 0, 16, 0], b"data", &u32s(samples.len()), &samples].concat(),
    );
    wav
}

#[test]
fn the_page_names_every_board_that_has_images() {
    let page = std::fs::read_to_string(paths::root().join("web/page/index.html")).unwrap();
    let titles = BOARDS.map(|board| board.title).into_iter().collect::<BTreeSet<_>>();
    let (_, list) = page.split_once("There are images for: ").unwrap();
    let named = list.split_once(". ").unwrap().0.split(", ").collect::<BTreeSet<_>>();
    assert_eq!(named, titles);
}

#[test]
fn the_page_stays_when_the_network_goes() {
    if !skipped("the page without a network") {
        drive("offline", json!({}));
    }
}

#[test]
fn the_converter_reports_what_the_library_does() {
    if skipped("the page's converter") {
        return;
    }
    assert!(!STAGE.1.is_empty(), "it was built");
    let mut node = Command::new(setup::emulator("node").unwrap());
    node.arg(paths::root().join("tests/web/converter.mjs")).arg(paths::root().join("target/web").join(web::CONVERTER[1]));
    let output = node.arg(paths::root().join("tests/odd")).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    println!("{}", String::from_utf8_lossy(&output.stdout));
}

#[test]
fn everything_on_the_page_can_be_used() {
    if !skipped("the page's controls") {
        drive("controls", json!({ "clip": own("run.ptn"), "frames": 26 }));
        drive("media", json!({ "events": paths::root().join("tests/vectors/event-names.ptn") }));
        drive("quiet", json!({}));
        drive("embed", json!({}));
        drive("crowd", json!({}));
        drive("range", json!({ "events": paths::root().join("tests/vectors/event-names.ptn") }));
        drive("saves", json!({}));
        let vector = |name: &str| paths::root().join("tests/vectors").join(name);
        drive("bank", json!({ "bank": vector("bank.ptb"), "events": vector("event-names.ptn") }));
    }
}

#[test]
fn key_clips_play_as_other_clips_do() {
    if skipped("key clips") {
        return;
    }
    let long = std::fs::read(paths::root().join("tests/key-vectors/channels-300.ptn")).unwrap();
    let total = long.len();
    let slow = slow::serve(long, total, total / 8, Duration::from_millis(100)).unwrap();
    let clip = |name: &str| format!("extra/key-{name}");
    let files = json!({
        "slow": slow, "clip": clip("walk.ptn"), "events": clip("events.ptn"), "bank": clip("bank.ptb"), "malformed": clip("malformed-noise.ptn"),
        "truncated": clip("truncated.ptn"),
    });
    drive("keys", files);
}

#[test]
fn the_page_is_accessible() {
    if !skipped("axe-core") {
        drive("accessible", json!({ "folder": shots() }));
    }
}

#[test]
fn frames_are_played_while_bytes_arrive() {
    if skipped("a slow network") {
        return;
    }
    let bytes = std::fs::read(long()).unwrap();
    let total = bytes.len() as u64;
    assert!(total > 1500, "{total} bytes are too few to be slow");
    let clip = slow::serve(bytes, total as usize, 100, Duration::from_millis(100)).unwrap();
    let log = drive("slow", json!({ "clip": clip }));
    let log: Vec<[u64; 5]> = serde_json::from_value(log).unwrap();
    let during: Vec<_> = log.iter().filter(|[received, ..]| *received < total).collect();
    let steps: BTreeSet<u64> = during.iter().map(|[_, _, playable, ..]| *playable).collect();
    assert!(steps.len() > 4, "playable while bytes came: {steps:?}");
    assert!(during.iter().any(|[.., frame, _]| *frame > 10), "frames were shown while bytes came");
    assert!(log.iter().all(|[_, said, ..]| *said == total));
    assert!(log.iter().all(|[_, _, playable, frame, _]| *frame < (*playable).max(1)));
    let Some([received, _, playable, _, frames]) = log.last() else { panic!("nothing happened") };
    assert_eq!((received, playable), (&total, frames));
}

#[test]
fn clips_that_are_no_good_are_told_and_played_as_far_as_they_go() {
    if skipped("damaged clips") {
        return;
    }
    let names = ["truncated", "damaged", "version", "head", "empty", "nonsense"];
    // And a server that hangs up before the end.
    let long = std::fs::read(long()).unwrap();
    let sent = long.len() * 3 / 4;
    let broken = slow::serve(long, sent, 200, Duration::from_millis(20)).unwrap();
    let clips: Vec<String> =
        names.iter().map(|name| format!("extra/{name}.ptn")).chain(["extra/absent.ptn".into(), broken]).collect();
    let outcomes = drive("bad", json!({ "clips": clips, "good": "extra/long.ptn" }));
    let words = ["ends early", "checksum", "another version", "ends early", "ends early", "no Pantin clip", "404", "ends early"];
    for ((outcome, words), clip) in outcomes.as_array().unwrap().iter().zip(words).zip(&clips) {
        let [error, said] = ["error", "said"].map(|field| outcome[field].as_str().unwrap());
        assert!(error.contains(words) && said == error, "{clip}: {error:?}, on the page {said:?}");
    }
    for partly in [0, 1, 7].map(|clip| &outcomes[clip]) {
        let [playable, frames] = ["playable", "frames"].map(|field| partly[field].as_u64().unwrap());
        assert!(playable > frames / 4 && playable < frames, "{partly}");
        assert!(partly["said"].as_str().unwrap().contains(&format!("{playable} of {frames} frames")), "{partly}");
    }
}

/// What a drop left, and the motion that was dropped.
struct Dropped {
    saved: Value,
    outcome: Value,
}

fn dropped(files: &[&Path], arguments: Value) -> Dropped {
    let mut arguments = arguments;
    arguments["files"] = json!(files);
    let mut outcome = drive("drop", arguments);
    Dropped { saved: outcome["saved"].take(), outcome }
}

impl Dropped {
    fn file(&self, name: &str) -> Vec<u8> {
        decoded(self.saved[name].as_str().unwrap_or_else(|| panic!("{name} was not saved")))
    }

    /// The clip keeps the bound, its header holds it, and both players show the same frame of it.
    fn is_good(&self, motion: &Path, fps: Option<f64>) {
        let stem = motion.file_stem().unwrap().to_str().unwrap();
        let bytes = self.file(&format!("{stem}.ptn"));
        let motion = import::load(motion, &ImportOptions::new().fps(fps)).unwrap().motion;
        let clip = Clip::new_checked(&bytes).unwrap();
        let report = verify::compare(&motion, &expand(&clip).unwrap(), verify::shell_radius_cm(&motion)).unwrap();
        assert!(report.shell_cm.error <= 0.5 && report.max_scalar <= 0.02, "{report:?}");
        let header = String::from_utf8(self.file(&format!("{stem}.h"))).unwrap();
        assert!(header.contains(&format!("_LEN {}\n", bytes.len())), "{header:.300}");
        let moving = Motion { looped: clip.looped(), ..expand(&clip).unwrap() };
        assert_alike(&self.file(&format!("{stem}.glb")), &gltf::write(&moving).unwrap());
        let programs = self.outcome["programs"].as_object().unwrap();
        assert!(programs.len() == 7 && programs.values().all(|text| text.as_str().unwrap().contains(&format!("{stem}."))));
        let sides = self.outcome["sides"].as_array().unwrap();
        assert!(sides.iter().all(|side| side["frame"] == clip.frames() / 2 && side["frames"] == clip.frames()), "{sides:?}");
        assert!(sides.iter().all(|side| side["colours"].as_u64().unwrap() > 3), "{sides:?}");
        // Within half a centimetre, the original and the clip are nearly the same picture.
        let [original, shown] = [0, 1].map(|side| picture(&self.outcome["greys"][side]));
        let different = screen::difference(&shown, &original).map_or(0, |difference| difference.count);
        let lit = original.pixels.iter().filter(|pixel| **pixel > 0).count();
        assert!(lit > 20 && different < lit, "{different} of {lit} pixels differ");
        let words = self.outcome["report"].as_str().unwrap();
        assert!(
            words.contains("error, largest") && words.contains(&format!("{} bytes", bytes.len())) || fps.is_some(),
            "{words}"
        );
    }
}

/// Two .glb files have the same JSON, and numbers that differ as sines of two machines do.
fn assert_alike(a: &[u8], b: &[u8]) {
    let json = 20 + u32::from_le_bytes(a[12..16].try_into().unwrap()) as usize;
    assert_eq!((a.len(), String::from_utf8_lossy(&a[..json])), (b.len(), String::from_utf8_lossy(&b[..json])));
    let numbers = |bytes: &[u8]| -> Vec<f32> {
        bytes[json + 8..].chunks_exact(4).map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap())).collect()
    };
    let farthest = numbers(a).iter().zip(numbers(b)).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(farthest < 1e-6, "numbers differ by up to {farthest}");
}

fn decoded(base64: &str) -> Vec<u8> {
    STANDARD.decode(base64).unwrap()
}

fn shots() -> PathBuf {
    let folder = paths::root().join("target/web-shots");
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

#[test]
fn a_dropped_motion_is_converted_shown_and_saved() {
    if skipped("conversion in the page") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let bvh = folder.path().join("our-walk.bvh");
    let tool = build::host_tool().unwrap();
    let clip = clips::convert(&own("walk.keys"), folder.path()).unwrap();
    for made in ["our-walk.bvh", "our-walk.glb"] {
        assert!(Command::new(&tool).arg("expand").arg(&clip).arg("-o").arg(folder.path().join(made)).status().unwrap().success());
    }
    let shot = json!({ "effort": "default", "shot": shots().join("converted.png") });
    let walk = dropped(&[&bvh], shot);
    walk.is_good(&bvh, None);
    let parts: BTreeMap<String, Vec<f64>> = serde_json::from_value(walk.outcome["parts"].clone()).unwrap();
    assert!(parts.keys().eq(["fitting", "making it smaller"]), "{parts:?}");
    assert!(parts.values().all(|parts| parts.is_sorted()) && parts["making it smaller"].len() > 3, "progress {parts:?}");
    let glb = folder.path().join("our-walk.glb");
    dropped(&[&glb], json!({ "effort": "fast" })).is_good(&glb, None);
    let leg = paths::root().join("host-tools/pantin/tests/data/leg.fbx");
    dropped(&[&leg], json!({ "effort": "fast" })).is_good(&leg, None);
    let table = folder.path().join("servos.csv");
    let row = |frame: usize| format!("{:.4},{:.4}\n", (frame as f64 / 9.0).sin(), (frame as f64 / 23.0).cos());
    std::fs::write(&table, format!("pan,tilt\n{}", (0..120).map(row).collect::<String>())).unwrap();
    dropped(&[&table], json!({ "effort": "fast", "fps": 50 })).is_good(&table, Some(50.0));
}

#[test]
fn what_was_converted_is_converted_again_with_other_values_and_what_is_left_out_is_named() {
    if skipped("further conversions") {
        return;
    }
    assert!(!STAGE.1.is_empty(), "the site was built");
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let walk = std::fs::read(paths::root().join("target/web/clips/walk.bvh")).unwrap();
    let row = |frame: usize| {
        let [time, value] = [frame as f64 / 120.0, frame as f64 / 9.0];
        format!("{time:.5},{:.3},{:.3}\n", 0.5 + value.sin() / 2.0, 0.5 + value.cos() / 2.0)
    };
    let face = format!("time,JawOpen,Smile\n{}", (0..160).map(row).collect::<String>());
    let skeleton_missing = file("alone.amc", b":FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 0 0 0 0 0\n");
    let arguments = json!({
        "clip": own("run.ptn"),
        "bvh": file("our-walk.bvh", &walk),
        "other": file("other.bvh", &walk),
        "text": file("notes.txt", b"a word"),
        "face": file("face.csv", face.as_bytes()),
        "gltf": paths::root().join("tests/web/two-animations.gltf"),
        "alone": [skeleton_missing, file("alone.fbx", b"; FBX 7.3.0 project file\n")],
    });
    drive("again", arguments);
}

#[test]
fn what_cannot_be_converted_is_refused_in_words() {
    if skipped("bad drops") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let huge = file("huge.bvh", b"");
    std::fs::File::options().write(true).open(&huge).unwrap().set_len(1 << 30).unwrap();
    let files = [
        file("empty.bvh", b""),
        huge,
        file("nonsense.bvh", b"HIERARCHY\nROOT hip\n{\nnonsense"),
        file("picture.png", b"\x89PNG\r\n\x1a\n0000"),
        file("short.glb", b"glTF\x02\0\0\0\xff\xff\0\0"),
        file("no-rate.csv", b"a,b\n1,2\n3,4\n"),
    ];
    let outcomes = drive("refused", json!({ "files": files }));
    let words = [
        "empty.bvh: the file is empty; expected a motion",
        "1,073,741,824 bytes; the page reads motions of at most 104,857,600 bytes",
        "nonsense.bvh:4",
        "picture.png: unknown kind of file",
        "short.glb: the file is shorter than its head says",
        "“Frames per second” states it",
    ];
    for (outcome, words) in outcomes.as_array().unwrap().iter().zip(words) {
        assert!(outcome["said"].as_str().unwrap().contains(words), "{outcome} should say {words}");
        assert_eq!(outcome["shown"], false);
    }
    assert!(outcomes[1]["ms"].as_u64().unwrap() < 3000, "it was read: {}", outcomes[1]);
    if let Some(data) = paths::data() {
        drive("cancel", json!({ "file": data.join("bvh_cmu01_hops-and-turn.bvh") }));
    }
}

/// A character that is steered, a face, all looks, files that are saved, a conversion. In WebKit, a picture once was wider than its element; in Firefox, no video was saved.
#[test]
fn the_page_does_the_same_in_every_browser_that_is_installed() {
    if skipped("the page in other browsers") {
        return;
    }
    LazyLock::force(&STAGE);
    let tried = browsers::check(Path::new("target/web")).unwrap_or_else(|error| panic!("{error:#}"));
    println!("tried in {}", tried.browsers.join(", "));
    tried.notes.iter().for_each(|note| println!("{note}"));
}

#[test]
fn the_page_is_there_to_be_looked_at() {
    if !skipped("pictures of the page") {
        drive("shots", json!({ "folder": shots() }));
        println!("{}", shots().display());
    }
}
