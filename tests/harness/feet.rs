//! Banks with feet: our character in several forms, captured motions, and random tables of feet.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use pantin::Bank;
use pantin_animator::machine::{FEET_SECTION, FEET_VERSION, Table};
use pantin_convert::bank;
use tempfile::TempDir;

use crate::animator::Sequence;
use crate::{build, paths};

/// Banks with feet, each with a name.
pub struct FeetBank {
    /// How its motions are coded, or where they come from.
    pub name: String,
    /// The bank.
    pub bytes: Vec<u8>,
    /// Whether all clips have one form, without which layers and blends do not play.
    pub same_form: bool,
}

/// How motions of our library are converted.
const FORMS: [(&str, &[&str]); 4] = [
    ("quaternions", &["--rotations", "quaternion", "--same-form"]),
    ("maps", &["--rotations", "exponential", "--same-form"]),
    ("clips of several forms", &["--places-only"]),
    ("upside down", &["--places-only", "--same-form", "--up", "-y"]),
];

/// These motions, and a machine of them.
const MOTIONS: [&str; 5] = ["idle", "walk", "run", "stop", "bow"];
const MACHINE: &str = "start = \"idle\"
[feet]
[[parameter]]
name = \"speed\"
range = [0, 100]
[[state]]
name = \"idle\"
transitions = [{ to = \"walk\", input = \"go\" }, { to = \"bow\", input = \"bow\" }]
[[state]]
name = \"walk\"
BLEND
transitions = [{ to = \"run\", input = \"fast\", sync = \"feet\", frames = 12 }, { to = \"stop\", released = \"go\", sync = \"feet\", within = 1.0 }]
[[state]]
name = \"run\"
transitions = [{ to = \"walk\", released = \"fast\", sync = \"feet\", frames = 12 }, { to = \"stop\", released = \"go\", frames = 10 }]
[[state]]
name = \"stop\"
transitions = [{ to = \"idle\", end = true }]
[[state]]
name = \"bow\"
transitions = [{ to = \"idle\", end = true }]";

/// Captured motions, and a machine that goes over between them.
const CAPTURED: [&str; 2] = [
    "bvh_bandai1_walk.bvh --name walk --from 65 --to 129 --loop --footsteps
DATA/bvh_bandai1_kick.bvh --name kick --from 30
DATA/bvh_bandai1_kick.bvh --name idle --from 0 --to 30 --loop",
    "start = \"idle\"
[feet]
[[state]]
name = \"idle\"
transitions = [{ to = \"walk\", input = \"go\" }, { to = \"kick\", input = \"kick\" }]
[[state]]
name = \"walk\"
transitions = [{ to = \"idle\", released = \"go\", sync = \"feet\", seconds = 0.4 }, { to = \"kick\", input = \"kick\", sync = \"feet\" }]
[[state]]
name = \"kick\"
transitions = [{ to = \"idle\", end = true }]",
];

/// All banks; without captured clips those of our own.
pub fn banks(folder: &TempDir) -> Result<Vec<FeetBank>> {
    let mut banks = vec![FeetBank {
        name: "ours".into(),
        bytes: std::fs::read(paths::root().join("motions/character.ptb"))?,
        same_form: true,
    }];
    let motions: Vec<PathBuf> =
        MOTIONS.iter().map(|name| paths::root().join("motions/library").join(name).with_extension("keys")).collect();
    let motions: Vec<&Path> = motions.iter().map(PathBuf::as_path).collect();
    for (name, options) in FORMS {
        let same_form = options.contains(&"--same-form");
        let clips = convert(folder, &motions, &[options, &["--max-error", "1cm", "--effort", "1"]].concat()).context(name)?;
        // Two clips that are blended have one form.
        let text = MACHINE.replace("BLEND", if same_form { "blend = { clip = \"run\", by = \"speed\" }" } else { "" });
        banks.push(FeetBank { name: name.into(), bytes: machine(folder, &clips, &text).context(name)?, same_form });
    }
    let data = std::env::var_os("PANTIN_DATA").map_or_else(|| paths::root().join("../shared/data"), PathBuf::from);
    if data.join("bvh_bandai1_kick.bvh").is_file() {
        let [list, text] = CAPTURED;
        let listed = folder.path().join("feet.list");
        let data = format!("{}/", data.display());
        std::fs::write(&listed, format!("{data}{}", list.replace("DATA/", &data)))?;
        let clips = convert(folder, &[&listed], &["--same-form", "--max-error", "3.2cm", "--effort", "1"])?;
        let bytes = machine(folder, &clips, text)?;
        banks.push(FeetBank { name: "captured".into(), bytes, same_form: true });
    } else {
        println!("   no captured clips in {}: set PANTIN_DATA", data.display());
    }
    Ok(banks)
}

/// Runs the host tool.
fn run(mut tool: Command) -> Result<()> {
    let output = tool.output().context("cannot start the host tool")?;
    ensure!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Ok(())
}

/// Converts motions to a bank.
fn convert(folder: &TempDir, motions: &[&Path], options: &[&str]) -> Result<PathBuf> {
    let clips = folder.path().join("feet-clips.ptb");
    let mut convert = Command::new(build::host_tool()?);
    convert.args(["convert", "--quiet"]).args(options).args(motions).arg("-o").arg(&clips);
    run(convert)?;
    Ok(clips)
}

/// Adds a machine to a bank.
fn machine(folder: &TempDir, clips: &Path, text: &str) -> Result<Vec<u8>> {
    let [source, out] = ["feet.toml", "feet.ptb"].map(|name| folder.path().join(name));
    std::fs::write(&source, text)?;
    let mut machine = Command::new(build::host_tool()?);
    machine.arg("machine").arg(&source).arg("--bank").arg(clips).arg("-o").arg(&out);
    run(machine)?;
    Ok(std::fs::read(out)?)
}

/// A bank with another table of feet, with anything in it that its rules nearly allow.
pub fn with_feet(file: &[u8], numbers: &mut Sequence) -> Result<Vec<u8>> {
    let bank = Bank::new_checked(file)?;
    let first = bank.entries().next().context("a clip")?;
    let rig = bank.open(&first)?.rig();
    let parents: Vec<Option<u16>> = rig.joints().map(|joint| joint.parent).collect();
    let frames: Vec<u32> = bank.entries().map(|entry| Ok(bank.open(&entry)?.frames())).collect::<Result<_>>()?;
    let transitions =
        Table::of_bank(file).map_or(8, |table| (0..).take_while(|&index| table.transition(index).is_some()).count());
    let feet = 1 + numbers.below(2) as u8;
    let mut counts = vec![];
    let mut rows = vec![];
    for _ in 0..feet {
        let ankle = numbers.below(parents.len() as u32) as u16;
        let mut points: Vec<u16> = vec![];
        for (joint, parent) in parents.iter().enumerate() {
            let hangs = parent.is_some_and(|parent| parent == ankle || points.contains(&parent));
            if hangs && points.len() < 4 && numbers.below(4) > 0 {
                points.push(joint as u16);
            }
        }
        if numbers.below(20) == 0 {
            points.truncate(3);
            points.push(numbers.below(parents.len() as u32) as u16);
        }
        rows.extend(ankle.to_le_bytes());
        rows.extend([points.len() as u8, 0]);
        counts.push(points.len() as u32);
        points.resize(4, 0);
        rows.extend(points.into_iter().flat_map(u16::to_le_bytes));
    }
    let (mut ends, mut contacts, mut count) = (vec![], vec![], 0u16);
    for frames in &frames {
        for _ in 0..numbers.below(5) {
            let foot = numbers.below(feet.into());
            let from = numbers.below(*frames);
            let to = from + 1 + numbers.below(*frames);
            contacts.extend([foot as u8, numbers.below(counts[foot as usize] + 1) as u8]);
            contacts.extend([from as u16, to as u16].into_iter().flat_map(u16::to_le_bytes));
            count += 1;
        }
        ends.extend(count.to_le_bytes());
    }
    let entries = numbers.below(30) as u16;
    let mut body = vec![FEET_VERSION, feet, frames.len() as u8, 0];
    body.extend([count, entries].into_iter().flat_map(u16::to_le_bytes));
    body.extend([rows, ends, contacts].concat());
    for _ in 0..entries {
        body.extend([numbers.below(transitions as u32 + 1) as u8, 0]);
        body.extend([numbers.below(80) as u16, numbers.below(40) as u16].into_iter().flat_map(u16::to_le_bytes));
    }
    // Some tables are damaged in a place.
    if numbers.below(5) == 0 {
        let at = numbers.below(body.len() as u32) as usize;
        body[at] ^= 1 << numbers.below(8);
    }
    body.extend(pantin::codec::crc::of(&body).to_le_bytes());
    let mut bytes = bank::without_section(file, FEET_SECTION)?;
    bytes.push(FEET_SECTION);
    pantin::codec::varint::put(body.len() as u32, &mut |byte| bytes.push(byte));
    bytes.extend(body);
    Ok(bytes)
}
