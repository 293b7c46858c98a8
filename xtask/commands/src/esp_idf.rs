//! `cargo xtask esp-idf [FOLDER]`: the component for ESP-IDF as a folder to copy: the files of `bindings/esp-idf`, the sources in C and the widget for LVGL.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;
use harness::paths;
use pantin_convert::export::source::c_header;

use crate::packed::Packed;

/// The component's folders of sources.
const COMPONENT: Packed = Packed {
    binding: "esp-idf",
    known_by: "panel/pantin_panel.c",
    filled: &[
        (
            "src",
            "bindings/c/src",
            &[
                "pantin.c",
                "pantin_keys.c",
                "pantin_turn.c",
                "pantin_figure.c",
                "pantin_solid.c",
                "pantin_animator.c",
                "pantin_feet.c",
                "pantin_face.c",
                "pantin_talk.c",
                "pantin_face_data.h",
                "pantin_face_themes.h",
            ],
        ),
        ("lvgl", "bindings/lvgl/src", &["lv_pantin.c", "lv_pantin_body.c"]),
    ],
};

/// Writes the component for ESP-IDF to a folder
#[derive(Args)]
pub struct EspIdf {
    /// The folder, for example `components/pantin` of a project [default: target/esp-idf/pantin of the repository]
    folder: Option<PathBuf>,
}

impl EspIdf {
    /// Writes the folder, and prints how to use it.
    pub fn run(self) -> Result<()> {
        let folder = self.folder.unwrap_or_else(|| paths::root().join("target/esp-idf/pantin"));
        let count = write(&folder)?;
        let place = folder.display();
        println!("{place}: {count} files");
        println!();
        println!("Put the folder into `components` of a project: `idf.py menuconfig` then has Component config > Pantin.");
        println!("An example:   cd {place}/examples/face_gc9a01 && idf.py set-target esp32c3 && idf.py build flash monitor");
        println!("Your motion:  cargo pantin expand CLIP.ptn -o clip.h writes the header that a program includes.");
        Ok(())
    }
}

/// Writes the folder. Returns the number of files.
pub fn write(folder: &Path) -> Result<usize> {
    let count = COMPONENT.write(folder)?;
    let bytes = fs::read(paths::root().join("motions/walk.ptn"))?;
    let header = c_header(&pantin::Clip::new_checked(&bytes)?, &bytes, "walk")?;
    fs::write(folder.join("examples/body_cyd/main/walk.h"), header)?;
    Ok(count + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_component_has_every_source_that_it_compiles() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("components/pantin");
        let count = write(&folder).unwrap();
        let list = fs::read_to_string(folder.join("CMakeLists.txt")).unwrap();
        let sources: Vec<&str> = list.split('"').skip(1).step_by(2).filter(|word| word.ends_with(".c")).collect();
        assert!(sources.len() == 12 && sources.iter().all(|name| folder.join(name).is_file()), "{sources:?}");
        for name in ["src/pantin_tables.h", "lvgl/lv_pantin.h", "examples/body_cyd/main/walk.h", "Kconfig", "LICENSE-MIT"] {
            assert!(folder.join(name).is_file(), "{name}");
        }
        assert!(!folder.join("tests").exists());
        fs::write(folder.join("src/old.c"), "").unwrap();
        assert_eq!(write(&folder).unwrap(), count);
        assert!(!folder.join("src/old.c").exists());
    }
}
