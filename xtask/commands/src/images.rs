//! The images that the boards can be flashed with.

use std::path::Path;

use anyhow::{Context, Result, bail};
use harness::build::Firmware;
use harness::{image, setup};

use xtask::packages::{self, Package};

/// An image of a board.
pub struct Image {
    /// The board's, and what is other about it: `pico`, `pico-face`, `pico-servo`.
    pub name: String,
    /// The board's package.
    pub package: String,
    /// The program of that package.
    pub program: String,
    /// Its Rust target.
    pub target: String,
    /// The features that it is built with beside its own.
    pub features: String,
}

impl Image {
    /// Builds it, with these clips or its own.
    pub fn build(&self, clips: &[&Path]) -> Result<Firmware> {
        let firmware = Firmware::featuring(&self.features, &self.package, &self.program, &self.target, clips);
        firmware.with_context(|| self.name.clone())
    }
}

/// Bytes of flash and of static RAM of a built image.
pub fn flash_and_ram(firmware: &Firmware) -> Result<[u64; 2]> {
    Ok([image::loaded(firmware.elf())?, image::statics(firmware.elf())?])
}

/// The boards of these names, or all; Rust can compile for them.
pub fn boards(names: &[String]) -> Result<Vec<Package>> {
    let boards: Vec<Package> = packages::firmware()?.into_iter().filter(Package::is_board).collect();
    if let Some(name) = names.iter().find(|name| boards.iter().all(|board| board.name != **name)) {
        let there: Vec<&str> = boards.iter().map(|board| board.name.as_str()).collect();
        bail!("no board is called {name}; there are {}", there.join(", "));
    }
    let wanted = boards.into_iter().filter(|board| names.is_empty() || names.contains(&board.name));
    let wanted: Vec<Package> = wanted.collect();
    wanted.iter().flat_map(|board| &board.targets).try_for_each(|target| setup::rust_target(target))?;
    Ok(wanted)
}

/// A board's images: that of its defaults, one with each feature that makes another, and its further programs.
pub fn of(board: &Package) -> Vec<Image> {
    let mut images = vec![];
    for target in &board.targets {
        // A second target's images are named after it too.
        let suffix = if target == &board.targets[0] { String::new() } else { format!("-{target}") };
        let image = |program: &str, features: &str, different: &str| Image {
            name: format!("{}{different}{suffix}", board.name),
            package: board.name.clone(),
            program: program.to_owned(),
            target: target.clone(),
            features: features.to_owned(),
        };
        images.push(image(&board.name, "", ""));
        images.extend(board.features.iter().map(|feature| image(&board.name, feature, &format!("-{feature}"))));
        let others = board.programs.iter().filter(|program| **program != board.name);
        images.extend(others.map(|program| image(program, "", &format!("-{program}"))));
    }
    images
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_feature_target_and_further_program_makes_an_image() {
        let strings = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect::<Vec<_>>();
        let board = Package {
            name: "pico".into(),
            targets: strings(&["thumbv6m-none-eabi", "riscv32imac"]),
            programs: strings(&["pico", "servo"]),
            features: strings(&["face"]),
            daily: false,
            folder: "firmware/boards/pico".into(),
            version: "0.1.0".into(),
            rust_version: "1.90".into(),
        };
        assert!(board.is_board());
        let images = of(&board);
        let names: Vec<&str> = images.iter().map(|image| image.name.as_str()).collect();
        assert_eq!(names[..3], ["pico", "pico-face", "pico-servo"]);
        assert_eq!(names[3..], ["pico-riscv32imac", "pico-face-riscv32imac", "pico-servo-riscv32imac"]);
        assert_eq!((images[1].program.as_str(), images[1].features.as_str()), ("pico", "face"));
        assert_eq!((images[2].program.as_str(), images[2].features.as_str()), ("servo", ""));
    }
}
