//! The animator in C: poses, placements and events of the crate pantin-animator, at every frame.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::animator::{self as reference, Lent, Sequence};
use harness::{feet, paths, vectors};
use pantin::Clip;
use pantin_animator::machine::Table;
use tempfile::TempDir;

use super::face::same;
use super::{KEYS, host_program_with, output};

/// Bytes of code that the animator may take on a Cortex-M0 or RV32IMC, without the decoder and rotations: 20 KB on a Cortex-M0 are the goal. Two clips that
/// lead the figure take 1.3 KB of it.
pub const MOST_CODE: u64 = 49 * 512;

/// Bytes of code that feet may take on a Cortex-M0 or RV32IMC, beside the animator and figures.
pub const MOST_FEET_CODE: u64 = 25 * 512;

/// Scripts for each group of clips, their lines, and updates of the state machine of our character.
const SCRIPTS: u64 = 6;
const LINES: u32 = 300;
const UPDATES: u32 = 4000;
/// Banks with random tables, and updates of each.
const TABLES: u32 = 3000;
const FEW_UPDATES: u32 = 25;
/// Damaged banks.
const DAMAGED: u32 = 3000;
/// Random tables of feet for each bank, and updates of each.
const FEET_TABLES: u32 = 150;
const FEET_UPDATES: u32 = 200;
/// Pictures a second at which the recorded session is played.
const RATES: [u64; 4] = [7, 30, 60, 144];

/// What the program in C returns for a bank with layers and feet: of `enum pantin_result`.
const UNSUPPORTED: &str = "17";

/// Our files.
fn motion(name: &str) -> PathBuf {
    paths::root().join("motions").join(name)
}

/// Programs by two compilers, with sanitizers.
fn programs(folder: &TempDir) -> Result<Vec<PathBuf>> {
    ["gcc", "clang"].into_iter().map(|compiler| host_program_with(folder, compiler, "animator", &[KEYS])).collect()
}

/// Writes a file for the programs.
fn write(folder: &TempDir, name: &str, bytes: impl AsRef<[u8]>) -> Result<PathBuf> {
    let path = folder.path().join(format!("animator-{name}"));
    std::fs::write(&path, bytes)?;
    Ok(path)
}

/// Compares animators over random scripts: clips of every rig of the vectors in several forms, key clips, and our motions.
pub fn transitions(folder: &TempDir) -> Result<()> {
    let mut files: Vec<Vec<u8>> = vectors::load(&vectors::folder())?.into_iter().map(|vector| vector.clip).collect();
    for name in ["walk.ptn", "run.ptn", "greet.ptn", "kneebend.ptn"] {
        files.push(std::fs::read(motion(name))?);
    }
    files.extend(vectors::load(&vectors::keyed::folder())?.into_iter().map(|vector| vector.clip));
    let others: Vec<Vec<u8>> = files.iter().filter_map(|bytes| reference::in_another_form(bytes)).collect();
    files.extend(others);
    let groups = reference::by_rig(&files);
    let (programs, mut lines, mut forms) = (programs(folder)?, 0, 0);
    for (rig, bytes) in &groups {
        let clips: Vec<Clip> = bytes.iter().filter_map(|bytes| Clip::new_checked(bytes).ok()).collect();
        let own =
            clips.iter().enumerate().filter(|(at, clip)| clips[..*at].iter().all(|before| before.form_ref() != clip.form_ref()));
        forms += own.count() - 1;
        let paths: Vec<PathBuf> = bytes
            .iter()
            .enumerate()
            .map(|(at, bytes)| write(folder, &format!("{rig:08x}-{at}.ptn"), bytes))
            .collect::<Result<_>>()?;
        for seed in 0..SCRIPTS {
            let text = reference::script(&clips, LINES, &mut Sequence(seed));
            let (script, expected) = (write(folder, "script", &text)?, reference::play(&clips, &text));
            lines += expected.lines().count();
            for program in &programs {
                let mut command = Command::new(program);
                command.arg("play").arg(&script).args(&paths);
                same(&format!("rig {rig:08x}, script {seed}"), &expected, &String::from_utf8(output(command)?.stdout)?)?;
            }
        }
    }
    println!("   {} rigs, {forms} further forms, {lines} instants", groups.len());
    ensure!(groups.len() > 10 && forms > 3, "few rigs or forms");
    Ok(())
}

/// Compares state machines: our character over a recorded session and random inputs, and banks with random tables.
pub fn machines(folder: &TempDir) -> Result<()> {
    let programs = programs(folder)?;
    let character = std::fs::read(motion("character.ptb"))?;
    let table = Table::of_bank(&character).map_err(|error| anyhow::anyhow!("{error}"))?;
    let session = std::fs::read_to_string(motion("steer.txt"))?;
    let mut scripts: Vec<String> =
        RATES.iter().map(|&rate| reference::recorded(&session, &table, rate)).collect::<Option<_>>().context("a session")?;
    scripts.push(reference::inputs(&table, UPDATES, &mut Sequence(1)));
    for (at, script) in scripts.iter().enumerate() {
        for second in [true, false] {
            let lent = Lent { second, feet: false };
            compare(folder, &programs, &format!("script {at} of the character"), &[&character], script, lent)?;
        }
    }
    let bank = std::fs::read(vectors::folder().join("bank.ptb"))?;
    let clips = pantin::Bank::new_checked(&bank)?.len() as u32;
    let mut numbers = Sequence(5);
    let banks: Vec<Vec<u8>> = (0..TABLES).map(|_| reference::with_table(&bank, clips, &mut numbers)).collect();
    let any = banks.iter().find_map(|bank| Table::of_bank(bank).ok().filter(|table| table.inputs() == 4)).context("a table")?;
    let script = reference::inputs(&any, FEW_UPDATES, &mut numbers);
    let lent = Lent { second: true, feet: false };
    let all = |banks: &[Vec<u8>], what| {
        compare(folder, &programs, what, &banks.iter().map(Vec::as_slice).collect::<Vec<_>>(), &script, lent)
    };
    let played = all(&banks, "random tables")?;
    println!("   {} scripts of our character, {TABLES} random tables, {played} of them play", scripts.len());
    ensure!(played > TABLES as usize / 10, "few tables play");
    let play = |bank: &&Vec<u8>| Table::of_bank(bank).is_ok();
    let sources: Vec<Vec<u8>> = banks.iter().filter(play).take(20).cloned().chain(vec![character.clone(); 10]).collect();
    let damaged: Vec<Vec<u8>> = (0..DAMAGED).map(|_| reference::damaged(&sources, &mut numbers)).collect();
    let played = all(&damaged, "damaged banks")?;
    println!("   {DAMAGED} damaged banks, {played} of them play");
    ensure!((DAMAGED / 10..DAMAGED * 9 / 10).contains(&(played as u32)), "nearly all or none of the damaged banks play");
    parts(folder, &programs, &character)?;
    reads(folder, &motion("character.ptb"))
}

/// Compares characters whose feet are held: our own in several forms and captured ones over a recorded session and random inputs, and random tables of feet.
pub fn feet(folder: &TempDir) -> Result<()> {
    let programs = programs(folder)?;
    let session = std::fs::read_to_string(motion("steer.txt"))?;
    let (mut numbers, mut scripts, mut played, mut held) = (Sequence(9), 0, 0, 0);
    for bank in feet::banks(folder)? {
        let table = Table::of_bank(&bank.bytes).map_err(|error| anyhow::anyhow!("{error}"))?;
        let mut texts: Vec<String> = RATES.iter().filter_map(|&rate| reference::recorded(&session, &table, rate)).collect();
        texts.push(reference::inputs(&table, UPDATES, &mut numbers));
        let lent = Lent { second: bank.same_form, feet: true };
        for text in &texts {
            compare(folder, &programs, &bank.name, &[&bank.bytes], text, lent)?;
            held += reference::held(&reference::steer(&bank.bytes, lent, text));
        }
        scripts += texts.len();
        let others: Vec<Vec<u8>> = (0..FEET_TABLES).map(|_| feet::with_feet(&bank.bytes, &mut numbers)).collect::<Result<_>>()?;
        let others: Vec<&[u8]> = others.iter().map(Vec::as_slice).collect();
        let script = reference::inputs(&table, FEET_UPDATES, &mut numbers);
        played += compare(folder, &programs, &format!("feet of {}", bank.name), &others, &script, lent)?;
        parts(folder, &programs, &bank.bytes)?;
        if bank.name == "ours" {
            reads(folder, &write(folder, "feet.ptb", &bank.bytes)?)?;
        }
    }
    println!("   {scripts} scripts, feet held in {held} updates, {played} random tables of feet play");
    ensure!(held > 10_000 && played > FEET_TABLES as usize, "little was held");
    Ok(())
}

/// Each read of a paged source that fails ends the call in which it happens, which then can be repeated.
fn reads(folder: &TempDir, bank: &Path) -> Result<()> {
    for compiler in ["gcc", "clang"] {
        let mut command = Command::new(host_program_with(folder, compiler, "reads", &[KEYS])?);
        command.arg(bank);
        let printed = String::from_utf8(output(command)?.stdout)?;
        if compiler == "gcc" {
            printed.lines().for_each(|line| println!("   {line}"));
        }
    }
    Ok(())
}

/// Compares what becomes of banks; the number of those that play.
fn compare(folder: &TempDir, programs: &[PathBuf], what: &str, banks: &[&[u8]], script: &str, lent: Lent) -> Result<usize> {
    let outcomes: Vec<String> = banks.iter().map(|bank| reference::steer(bank, lent, script)).collect();
    let (script, banks) = (write(folder, "inputs", script)?, write(folder, "banks", prefixed(banks))?);
    for program in programs {
        let mut command = Command::new(program);
        command.arg("steer").arg(&script).arg(&banks).arg((u8::from(lent.second) + 2 * u8::from(lent.feet)).to_string());
        same(what, &outcomes.concat(), &String::from_utf8(output(command)?.stdout)?)?;
    }
    Ok(outcomes.iter().filter(|outcome| *outcome != "refused\n").count())
}

/// Banks, each behind its length.
fn prefixed(banks: &[&[u8]]) -> Vec<u8> {
    banks.iter().flat_map(|bank| [&(bank.len() as u32).to_le_bytes()[..], bank].concat()).collect()
}

/// Layers and feet are refused unless the program does without them.
fn parts(folder: &TempDir, programs: &[PathBuf], character: &[u8]) -> Result<()> {
    let banks = write(folder, "parts", prefixed(&[character]))?;
    let feet = pantin::Bank::new_checked(character)?.section(pantin_animator::machine::FEET_SECTION)?.is_some();
    for program in programs {
        let mut command = Command::new(program);
        command.arg("parts").arg(Path::new(&banks));
        let text = String::from_utf8(output(command)?.stdout)?;
        let layers = Table::of_bank(character).is_ok_and(|table| table.layers() > 0);
        let expected =
            |without: usize| if (layers && without & 1 == 0) || (feet && without & 2 == 0) { UNSUPPORTED } else { "0" };
        for (without, result) in text.split_whitespace().enumerate() {
            ensure!(result == expected(without), "without {without} of its parts our character gives {result}");
        }
    }
    Ok(())
}
