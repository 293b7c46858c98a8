//! The element's animator, in JavaScript: poses, placements, events and states are those of the crate pantin-animator, to the last bit.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use harness::animator::{self as reference, Lent, Sequence};
use harness::vectors::{self, keyed};
use harness::{build, feet, paths, setup};
use pantin::{Bank, Clip};
use pantin_animator::machine::Table;
use tempfile::TempDir;

/// Scripts for each group of clips, their lines, and updates of the state machine of our character.
const SCRIPTS: u64 = 3;
const LINES: u32 = 300;
const UPDATES: u32 = 4000;
/// Pictures a second at which the recorded session is played.
const RATES: [u64; 4] = [24, 60, 90, 144];
/// Banks with random tables, damaged banks, and updates of each.
const TABLES: u32 = 1500;
const MUTANTS: u32 = 1500;
const FEW_UPDATES: u32 = 25;
/// Random tables of feet and damaged ones for each bank, and updates of each.
const FEET_TABLES: u32 = 150;
const FEET_UPDATES: u32 = 200;

/// A smile over a walk.
const LAYER: &str = r#"
bank = "clips.ptb"

[[layer]]
clip = "smiles"
input = "smile"
joints = ["MouthSmile*"]

[[state]]
name = "rests"
transitions = []
"#;

fn motion(name: &str) -> PathBuf {
    paths::root().join("motions").join(name)
}

/// What the script in Node prints.
fn printed(what: &str, script: &Path, files: &[PathBuf]) -> String {
    let mut node = Command::new(setup::emulator("node").unwrap());
    node.arg(paths::root().join("tests/web/animator.mjs")).arg(what).arg(script).args(files);
    let output = node.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Fails with the first line that differs.
fn same(what: &str, expected: &str, got: &str) {
    for (number, (expected, got)) in expected.lines().zip(got.lines()).enumerate() {
        assert_eq!(got, expected, "{what}, line {number}");
    }
    assert_eq!(got.lines().count(), expected.lines().count(), "{what}");
}

fn write(folder: &TempDir, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

/// Random scripts for the clips of every rig of the vectors, in several forms and with keys, and for our motions.
#[test]
fn transitions_are_those_of_the_crate() {
    if setup::host_only("the animator in JavaScript") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut files: Vec<Vec<u8>> = vectors::load(&vectors::folder()).unwrap().into_iter().map(|vector| vector.clip).collect();
    files.extend(keyed::load().unwrap().into_iter().map(|vector| vector.clip));
    files.extend(["walk.ptn", "run.ptn", "greet.ptn", "kneebend.ptn"].map(|name| std::fs::read(motion(name)).unwrap()));
    let others: Vec<Vec<u8>> = files.iter().filter_map(|bytes| reference::in_another_form(bytes)).collect();
    files.extend(others);
    let groups = reference::by_rig(&files);
    let mut instants = 0;
    for (rig, bytes) in &groups {
        let clips: Vec<Clip> = bytes.iter().filter_map(|bytes| Clip::new_checked(bytes).ok()).collect();
        let paths: Vec<PathBuf> =
            bytes.iter().enumerate().map(|(at, bytes)| write(&folder, &format!("{rig:08x}-{at}.ptn"), bytes)).collect();
        for seed in 0..SCRIPTS {
            // The element has no steps of whole frames: it lets as much time pass.
            let step = format!("t {}", clips[0].frame_time_ns() / 1000);
            let lines = reference::script(&clips, LINES, &mut Sequence(seed));
            let text: String = lines.lines().flat_map(|line| [if line == "p" { &step } else { line }, "\n"]).collect();
            let expected = reference::play(&clips, &text);
            instants += expected.lines().count();
            same(&format!("rig {rig:08x}, script {seed}"), &expected, &printed("play", &write(&folder, "script", &text), &paths));
        }
    }
    println!("{} rigs, {instants} instants", groups.len());
    assert!(groups.len() > 10 && instants > 10_000);
}

/// What pages do: states blend, layers play, and feet are held if the bank has a table of them.
const LENT: Lent = Lent { second: true, feet: true };

/// What becomes of a bank. Poses show where feet are held: the columns of the joints that hold them are left out.
fn expected(bank: &[u8], script: &str) -> String {
    let text = reference::steer(bank, LENT, script);
    let mut out = String::new();
    for (number, line) in text.lines().enumerate() {
        let before = usize::from(number > 0) + 1;
        let columns = line.split(' ').enumerate().filter(|(column, _)| !(before..before + 2).contains(column));
        out += &columns.map(|(_, column)| column).collect::<Vec<_>>().join(" ");
        out.push('\n');
    }
    out
}

/// Compares what becomes of banks, and returns how many play.
fn compare(folder: &TempDir, what: &str, banks: &[&[u8]], script: &str) -> usize {
    let outcomes: Vec<String> = banks.iter().map(|bank| expected(bank, script)).collect();
    let all: Vec<u8> = banks.iter().flat_map(|bank| [&(bank.len() as u32).to_le_bytes()[..], bank].concat()).collect();
    let files = [write(folder, "banks", all)];
    same(what, &outcomes.concat(), &printed("steer", &write(folder, "inputs", script), &files));
    outcomes.iter().filter(|outcome| *outcome != "refused\n").count()
}

#[test]
fn our_character_is_that_of_the_crate_at_every_rate() {
    if setup::host_only("the animator in JavaScript") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let character = std::fs::read(motion("character.ptb")).unwrap();
    let table = Table::of_bank(&character).unwrap();
    let session = std::fs::read_to_string(motion("steer.txt")).unwrap();
    for rate in RATES {
        let script = reference::recorded(&session, &table, rate).unwrap();
        assert_eq!(compare(&folder, &format!("{rate} pictures a second"), &[&character], &script), 1);
    }
    compare(&folder, "random inputs", &[&character], &reference::inputs(&table, UPDATES, &mut Sequence(1)));
}

/// A bank whose layer names scalars of Live Link Face, of which its rig has the numbers alone.
pub fn smiling() -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let walk = motion("walk.keys").display().to_string();
    let mut list = String::new();
    for (name, smile) in [("rests", 0), ("smiles", 1)] {
        // The last row gives both the range of one rig.
        let rows: String = (0..30).map(|row| format!("{:.4},0.5,{smile}\n", f64::from(row) / 30.0)).collect();
        write(&folder, &format!("{name}.csv"), format!("time,JawOpen,MouthSmileLeft\n{rows}1,0.5,1\n"));
        list += &format!("{walk} --name {name} --with {name}.csv\n");
    }
    write(&folder, "clips.list", list);
    write(&folder, "machine.toml", LAYER);
    let bank = ["convert", "clips.list", "-o", "clips.ptb", "--segments"];
    for arguments in [bank, ["machine", "machine.toml", "-o", "character.ptb", "--quiet"]] {
        let mut tool = Command::new(build::host_tool().unwrap());
        let output = tool.args(arguments).current_dir(folder.path()).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    std::fs::read(folder.path().join("character.ptb")).unwrap()
}

#[test]
fn a_layer_finds_scalars_by_names_that_the_rig_does_not_spell() {
    if setup::host_only("the animator in JavaScript") {
        return;
    }
    let bank = smiling();
    let rig = Bank::new_checked(&bank).unwrap().rig();
    assert!(rig.scalars().any(|scalar| scalar.name() == "MouthSmileLeft"));
    let script = reference::inputs(&Table::of_bank(&bank).unwrap(), FEW_UPDATES, &mut Sequence(3));
    assert_eq!(compare(&tempfile::tempdir().unwrap(), "a layer of scalars", &[&bank], &script), 1);
}

/// The files of a bank's clips that have snapshots.
fn with_snapshots(bank: &[u8]) -> impl Iterator<Item = &[u8]> {
    Bank::new_checked(bank).into_iter().flat_map(|bank| {
        bank.entries().filter(move |entry| bank.open(entry).is_ok_and(|clip| clip.index_len() > 0)).map(|entry| entry.bytes())
    })
}

/// Characters whose feet are held: our own in several forms and captured ones over a recorded session and random inputs, and banks with random and with
/// damaged tables of feet.
#[test]
fn feet_are_those_of_the_crate() {
    if setup::host_only("the feet of characters in JavaScript") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let session = std::fs::read_to_string(motion("steer.txt")).unwrap();
    let (mut numbers, mut held, mut played, mut survived) = (Sequence(9), 0, 0, 0);
    let banks = feet::banks(&folder).unwrap();
    for bank in &banks {
        let table = Table::of_bank(&bank.bytes).unwrap();
        let mut scripts: Vec<String> = RATES.iter().filter_map(|&rate| reference::recorded(&session, &table, rate)).collect();
        scripts.push(reference::inputs(&table, UPDATES, &mut numbers));
        for script in &scripts {
            compare(&folder, &bank.name, &[&bank.bytes], script);
            held += reference::held(&reference::steer(&bank.bytes, LENT, script));
        }
        let script = reference::inputs(&table, FEET_UPDATES, &mut numbers);
        let all = |what, banks: Vec<Vec<u8>>| {
            compare(
                &folder,
                &format!("{what} tables of feet, {}", bank.name),
                &banks.iter().map(Vec::as_slice).collect::<Vec<_>>(),
                &script,
            )
        };
        played += all("random", (0..FEET_TABLES).map(|_| feet::with_feet(&bank.bytes, &mut numbers).unwrap()).collect());
        let damaged = (0..FEET_TABLES).map(|_| reference::with_damaged_feet(&bank.bytes, &mut numbers)).collect();
        survived += all("damaged", damaged);
    }
    let tables = banks.len() * FEET_TABLES as usize;
    println!(
        "{} banks, feet held in {held} updates; of {tables} tables each, {played} random ones and {survived} damaged ones play",
        banks.len()
    );
    assert!(held > 10_000 && (tables / 10..tables * 9 / 10).contains(&played), "{held} updates, {played} tables");
    assert!((tables / 10..tables * 9 / 10).contains(&survived), "{survived} of {tables} play");
}

/// Damaged banks. Rust seeks by a file's snapshots, which contradict a clip if it or they are damaged; the element reads none of them. Such banks are left out.
fn damaged(sources: &[Vec<u8>], count: u32, numbers: &mut Sequence) -> Vec<Vec<u8>> {
    let whole: HashSet<&[u8]> = sources.iter().flat_map(|bank| with_snapshots(bank)).collect();
    let mutants = (0..count).map(|_| reference::damaged(sources, numbers));
    mutants.filter(|bank| with_snapshots(bank).all(|clip| whole.contains(clip))).collect()
}

/// Banks with random tables, also such as the rules forbid, and damaged banks: both refuse them, or play alike.
#[test]
fn other_machines_are_those_of_the_crate() {
    if setup::host_only("the animator in JavaScript") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut numbers = Sequence(5);
    // Of segments, and of keys.
    let banks: Vec<Vec<u8>> = [vectors::folder(), keyed::folder()]
        .into_iter()
        .flat_map(|folder| {
            let bank = std::fs::read(folder.join("bank.ptb")).unwrap();
            let clips = Bank::new_checked(&bank).unwrap().len() as u32;
            (0..TABLES).map(|_| reference::with_table(&bank, clips, &mut numbers)).collect::<Vec<_>>()
        })
        .collect();
    let any = banks.iter().find_map(|bank| Table::of_bank(bank).ok().filter(|table| table.inputs() == 4)).unwrap();
    let script = reference::inputs(&any, FEW_UPDATES, &mut numbers);
    let played = compare(&folder, "random tables", &banks.iter().map(Vec::as_slice).collect::<Vec<_>>(), &script);
    assert!(played > TABLES as usize / 10, "{played} tables play");

    let character = std::fs::read(motion("character.ptb")).unwrap();
    let plays = |bank: &&Vec<u8>| Table::of_bank(bank).is_ok();
    let [segments, keys] = [&banks[..TABLES as usize], &banks[TABLES as usize..]];
    let machines = segments.iter().filter(plays).take(10).chain(keys.iter().filter(plays).take(10)).cloned();
    let sources: Vec<Vec<u8>> = machines.chain(vec![character; 10]).collect();
    let mutants = damaged(&sources, MUTANTS, &mut numbers);
    let played = compare(&folder, "damaged banks", &mutants.iter().map(Vec::as_slice).collect::<Vec<_>>(), &script);
    let count = mutants.len();
    assert!(count > MUTANTS as usize / 2 && (count / 10..count * 9 / 10).contains(&played), "{played} of {count} play");
    println!("{} random tables and {count} damaged banks; of these {played} play", banks.len());
}
