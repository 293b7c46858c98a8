//! `cargo xtask esphome [FOLDER]`: the ESPHome component as a folder to copy: the files of `bindings/esphome`, and the C sources of faces.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::Args;
use harness::paths;
use harness::web::arduino::{copy, make_room};

use crate::packed::with_includes;

/// Sources in C, and headers with data, that the component compiles.
const SOURCES: [&str; 5] = ["pantin.c", "pantin_face.c", "pantin_talk.c", "pantin_face_data.h", "pantin_face_themes.h"];

/// The component in the folder. ESPHome compiles the sources in it.
const COMPONENT: &str = "components/pantin";

/// Writes the ESPHome component of a talking face to a folder
#[derive(Args)]
pub struct Esphome {
    /// The folder, for example beside your configuration [default: target/esphome/pantin of the repository]
    folder: Option<PathBuf>,
}

impl Esphome {
    /// Writes the folder, and prints how to use it.
    pub fn run(self) -> Result<()> {
        let folder = self.folder.unwrap_or_else(|| paths::root().join("target/esphome/pantin"));
        let count = write(&folder)?;
        let place = folder.display();
        println!("{place}: {count} files");
        println!();
        println!("In your configuration, with the path from its folder or from the root of the disk:");
        println!();
        println!("external_components:");
        println!("  - source:");
        println!("      type: local");
        println!("      path: {place}/components");
        println!();
        println!("Try the examples: esphome config {place}/examples/display.yaml");
        Ok(())
    }
}

/// The folder of the files that are the component's own.
pub fn home() -> PathBuf {
    paths::root().join("bindings/esphome")
}

/// Writes the component to a folder, which is new or empty or has this component, whose sources are replaced then. Returns the number of files.
pub fn write(folder: &Path) -> Result<usize> {
    make_room(folder, folder.join(COMPONENT).join("face.h").is_file(), COMPONENT)?;
    let count = copy(&home(), folder)?;
    let from = paths::root().join("bindings/c/src");
    let files = with_includes(&from, &SOURCES)?;
    for name in &files {
        fs::copy(from.join(name), folder.join(COMPONENT).join(name)).with_context(|| name.clone())?;
    }
    // The clip of an example.
    fs::copy(paths::root().join("motions/face/hello.ptn"), folder.join("examples/hello.ptn"))?;
    Ok(count + files.len() + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_component_has_its_sources_and_every_header_that_they_include() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("config/pantin");
        let count = write(&folder).unwrap();
        let component = folder.join(COMPONENT);
        for name in ["__init__.py", "face.cpp", "speaker/face_speaker.cpp", "pantin_tables.h", "pantin_format.h"] {
            assert!(component.join(name).is_file(), "{name}");
        }
        for name in SOURCES {
            let source = paths::root().join("bindings/c/src").join(name);
            assert_eq!(fs::read(component.join(name)).unwrap(), fs::read(source).unwrap());
        }
        assert!(folder.join("examples/display.yaml").is_file() && folder.join("LICENSE-MIT").is_file());
        assert!(!folder.join("tests").exists() && !component.join("pantin_solid.c").exists());
        assert!(!fs::read_to_string(folder.join("README.md")).unwrap().contains("](../"));
        // Again: the sources of an older version are removed.
        fs::write(component.join("old.c"), "").unwrap();
        assert_eq!(write(&folder).unwrap(), count);
        assert!(!component.join("old.c").exists());
    }
}
