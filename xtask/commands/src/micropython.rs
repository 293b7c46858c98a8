//! `cargo xtask micropython [FOLDER]`: the module in C for MicroPython as a folder to build with, and the decoder in Python.

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;
use harness::paths;

use crate::packed::Packed;

/// The module compiles the sources in its folder `src`.
const MODULE: Packed = Packed {
    binding: "micropython",
    known_by: "usermod/pantin/mod_pantin.c",
    filled: &[(
        "usermod/pantin/src",
        "bindings/c/src",
        &[
            "pantin.c",
            "pantin_keys.c",
            "pantin_turn.c",
            "pantin_figure.c",
            "pantin_solid.c",
            "pantin_face.c",
            "pantin_talk.c",
            "pantin_face_data.h",
            "pantin_face_themes.h",
        ],
    )],
};

/// Writes the MicroPython module in C, and the decoder in Python, to a folder
#[derive(Args)]
pub struct Micropython {
    /// The folder [default: target/micropython/pantin of the repository]
    folder: Option<PathBuf>,
}

impl Micropython {
    /// Writes the folder, and prints how to use it.
    pub fn run(self) -> Result<()> {
        let folder = self.folder.unwrap_or_else(|| paths::root().join("target/micropython/pantin"));
        let count = write(&folder)?;
        let place = std::path::absolute(&folder)?;
        let place = place.display();
        println!("{place}: {count} files");
        println!();
        println!("In a port of MicroPython's source, for example ports/unix:  make USER_C_MODULES={place}/usermod");
        println!("In ports/esp32 or ports/rp2:  make USER_C_MODULES={place}/usermod/pantin/micropython.cmake");
        println!("Without a build of your own:  mpremote fs cp {place}/pantin*.py :");
        Ok(())
    }
}

/// Writes the folder. Returns the number of files.
pub fn write(folder: &Path) -> Result<usize> {
    MODULE.write(folder)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn the_folder_has_the_module_and_every_source_that_it_compiles() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("pantin");
        let count = write(&folder).unwrap();
        let module = folder.join("usermod/pantin");
        let listed = fs::read_to_string(module.join("micropython.cmake")).unwrap();
        let sources: Vec<&str> =
            listed.split_whitespace().map(|word| word.trim_end_matches(')')).filter(|word| word.ends_with(".c")).collect();
        assert!(sources.len() == 10 && sources.iter().all(|name| module.join(name).is_file()), "{sources:?}");
        assert!(module.join("src/pantin_tables.h").is_file() && folder.join("LICENSE-MIT").is_file());
        assert!(!folder.join("tests").exists());
        // Again: the sources of an older version are removed, and another folder is refused.
        fs::write(module.join("src/old.c"), "").unwrap();
        assert_eq!(write(&folder).unwrap(), count);
        assert!(!module.join("src/old.c").exists());
        assert!(write(place.path()).is_err());
    }
}
