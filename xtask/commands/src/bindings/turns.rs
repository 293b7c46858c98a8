//! Rotations of joints in every language, against those of the Rust decoder: of the golden vectors, and of captures whose joints have exponential maps or
//! quaternions.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::vectors::turns::{NAME, SUMS, sums_of};
use harness::{build, paths, vectors};
use tempfile::TempDir;
use xtask::setup;

use super::{Board, files, host_program, output};

/// Captures, and how they are converted; together they have joints in every form.
const CAPTURES: [(&str, &[&str]); 4] = [
    ("bvh_bandai1_walk.bvh", &["--to", "99"]),
    ("bvh_bandai1_bow.bvh", &["--to", "79", "--rotations", "quaternion"]),
    ("bvh_xia_neutral-walk.bvh", &["--to", "79", "--rotations", "exponential"]),
    ("gltf_khronos_fox.glb", &["--animation", "Walk"]),
];

/// Compares the rotations of the golden vectors in C.
pub fn vectors(folder: &TempDir) -> Result<()> {
    let program = host_program(folder, "gcc", "turns")?;
    let expected = std::fs::read_to_string(vectors::folder().join(NAME))?;
    let mut compared = 0;
    for (file, rig) in files()?.iter().filter(|(file, _)| file.extension().is_some_and(|extension| extension == "ptn")) {
        let mut command = Command::new(&program);
        command.arg(file).args(rig);
        let printed = String::from_utf8(output(command).with_context(|| file.display().to_string())?.stdout)?;
        let name = file.file_stem().unwrap_or_default().to_string_lossy();
        let wanted: Vec<&str> = expected.lines().filter_map(|line| line.strip_prefix(name.as_ref())?.strip_prefix(' ')).collect();
        if wanted.is_empty() {
            continue;
        }
        ensure!(printed.lines().count() == wanted.len(), "{name}: {} rotations", wanted.len());
        for (line, wanted) in printed.lines().zip(&wanted) {
            // Behind each line, the program prints the checksums of the other file.
            let actual = line.rsplit_once(' ').map_or(line, |(line, _)| line);
            ensure!(actual == *wanted, "{name}: {actual}, not {wanted}");
        }
        compared += wanted.len();
    }
    ensure!(compared > 600, "{compared} rotations");
    compared += sums(&vectors::folder(), &|clip| {
        let mut command = Command::new(&program);
        command.arg(clip);
        Ok(output(command)?.stdout)
    })?;
    println!("   {compared} rotations");
    Ok(())
}

/// Compares the rotations of captures in C.
pub fn captures(folder: &TempDir) -> Result<()> {
    let Some(captured) = captured(folder)? else { return Ok(()) };
    let program = host_program(folder, "gcc", "turns")?;
    let compared = sums(&captured, &|clip| {
        let mut command = Command::new(&program);
        command.arg(clip);
        Ok(output(command)?.stdout)
    })?;
    println!("   {} captures, {compared} rotations", CAPTURES.len());
    Ok(())
}

/// Compares the rotations of the golden vectors on an emulated board.
pub fn on_board(folder: &TempDir, board: &Board) -> Result<()> {
    let program = board.program(folder, "turns")?;
    let compared = sums(&vectors::folder(), &|clip| board.play(folder, &program, clip))?;
    println!("   {compared} rotations");
    Ok(())
}

/// Compares the rotations of the golden vectors and of captures in JavaScript.
pub fn javascript(folder: &TempDir) -> Result<()> {
    for place in [Some(vectors::folder()), captured(folder)?].into_iter().flatten() {
        let mut node = Command::new(setup::emulator("node")?);
        node.arg(paths::root().join("web/packages/decoder/test/turn-sums.mjs")).arg(place);
        print!("   {}", String::from_utf8_lossy(&output(node)?.stdout));
    }
    Ok(())
}

/// A folder of clips of captures with the checksums of their rotations; `None`, with a message, without captures.
pub fn captured(folder: &TempDir) -> Result<Option<PathBuf>> {
    let place = folder.path().join("captures");
    let Some(data) = xtask::paths::data() else {
        println!("   captures skipped: there is no folder of captures ($PANTIN_DATA)");
        return Ok(None);
    };
    if place.join(SUMS).is_file() {
        return Ok(Some(place));
    }
    std::fs::create_dir_all(&place)?;
    let tool = build::host_tool()?;
    let (mut text, mut mapped, mut quaternions) = (String::new(), 0, 0);
    for (index, (capture, arguments)) in CAPTURES.iter().enumerate() {
        let name = format!("capture-{index}");
        let clip = place.join(&name).with_extension("ptn");
        let fast = [arguments, &["--effort", "fast"][..]].concat();
        vectors::own::convert(&tool, &data.join(capture), &clip, &fast).with_context(|| (*capture).to_owned())?;
        let bytes = std::fs::read(&clip)?;
        let clip = pantin::Clip::new_checked(&bytes)?;
        mapped += (0..clip.rig().joint_count()).filter(|&joint| clip.is_exponential(joint)).count();
        quaternions +=
            clip.rig().joints().filter(|joint| joint.kinds.clone().any(|kind| kind == pantin::Kind::Wquaternion)).count();
        text += &sums_of(&name, &clip)?;
    }
    ensure!(mapped > 3 && quaternions > 3, "{mapped} exponential maps, {quaternions} quaternions");
    std::fs::write(place.join(SUMS), text)?;
    Ok(Some(place))
}

/// Compares the checksums of a folder with those that a program prints of each clip. Returns the number of rotations.
fn sums(folder: &Path, print: &dyn Fn(&Path) -> Result<Vec<u8>>) -> Result<usize> {
    let expected = std::fs::read_to_string(folder.join(SUMS))?;
    let mut clips: BTreeMap<&str, String> = BTreeMap::new();
    for line in expected.lines() {
        let name = line.split(' ').next().unwrap_or_default();
        *clips.entry(name).or_default() += &format!("{line}\n");
    }
    let mut compared = 0;
    for (name, wanted) in clips {
        let printed = String::from_utf8(print(&folder.join(name).with_extension("ptn")).with_context(|| name.to_owned())?)?;
        let mut joints: Vec<(String, Vec<&str>)> = vec![];
        for line in printed.lines() {
            // NAME FRAME, ten numbers, a checksum, and the two that are compared; a name may have spaces. A joint without a name is an End Site.
            let words: Vec<&str> = line.rsplitn(14, ' ').collect();
            let [sum, .., frame, joint] = words[..] else { continue };
            match joints.iter_mut().find(|(other, _)| other == joint) {
                // Of several joints of one name, the first.
                Some((_, sums)) if frame.parse() == Ok(sums.len()) => sums.push(sum),
                None if !joint.is_empty() && frame == "0" => joints.push((joint.to_owned(), vec![sum])),
                _ => {}
            }
        }
        let actual: String = joints.iter().map(|(joint, sums)| format!("{name} {joint} {}\n", sums.join(" "))).collect();
        for (actual, wanted) in actual.lines().zip(wanted.lines()) {
            ensure!(actual == wanted, "{actual}\nbut by the decoder in Rust\n{wanted}");
        }
        ensure!(actual.len() == wanted.len(), "{name}: not as many joints");
        compared += joints.iter().map(|(_, sums)| sums.len()).sum::<usize>();
    }
    Ok(compared)
}
