//! The tutorial of a talking face, step by step as its page says.

use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::paths;
use tempfile::TempDir;
use xtask::setup;

use super::output;

/// Pictures of the sentence: it lasts 3.2 s.
const LEAST_PICTURES: usize = 60;

/// Runs the page's commands in a folder that has the repository in it, with its program. Fails unless the mouth moves.
pub fn talking_face(folder: &TempDir) -> Result<()> {
    setup::install_emulator("espeak-ng")?;
    let page = std::fs::read_to_string(paths::root().join("docs/tutorials/talking-face.md"))?;
    let blocks = |language: &str| -> Vec<String> {
        let fence = format!("```{language}\n");
        page.split(fence.as_str()).skip(1).filter_map(|rest| rest.split("```").next()).map(str::to_owned).collect()
    };
    let place = folder.path().join("tutorial");
    std::fs::create_dir_all(place.join("pantin/bindings"))?;
    let mut copy = Command::new("cp");
    copy.arg("-r").arg(paths::root().join("bindings/c")).arg(place.join("pantin/bindings"));
    output(copy)?;
    let [program] = &blocks("c")[..] else { anyhow::bail!("the page has one program") };
    let [first, last] = &blocks("sh")[..] else { anyhow::bail!("the page has two blocks of commands") };
    let mut shell = Command::new("bash");
    let script = format!("set -euo pipefail\n{first}\ncp ../face.c .\n{last}");
    std::fs::write(place.join("face.c"), program)?;
    shell.current_dir(&place).args(["-c", &script]);
    output(shell)?;
    let mut pictures = Vec::new();
    for entry in std::fs::read_dir(place.join("talking-face"))? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "pgm") {
            pictures.push(std::fs::read(path)?);
        }
    }
    ensure!(pictures.len() >= LEAST_PICTURES, "the program wrote {} pictures", pictures.len());
    // The mouth's rows: an open mouth is dark inside.
    let light = |picture: &Vec<u8>| -> Option<u32> {
        let mouth = picture.get(picture.len() - 240 * 240..)?.get(120 * 240..200 * 240)?;
        Some(mouth.iter().map(|&value| u32::from(value > 127)).sum())
    };
    let lights: Vec<u32> =
        pictures.iter().map(|picture| light(picture).context("a picture of 240 by 240")).collect::<Result<_>>()?;
    let (least, most) = (lights.iter().min().context("pictures")?, lights.iter().max().context("pictures")?);
    println!("   {} pictures, {least} to {most} light pixels of a mouth", pictures.len());
    ensure!(most - least > 500, "the mouth stays as it is");
    Ok(())
}
