//! The Arduino library as a folder to copy: the files of `bindings/arduino`, the decoder in C, and our clips as headers for the examples.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use pantin_convert::export::source::{c_header, c_header_of_bank, c_header_of_look};
use pantin_figure::solid::look_text;
use xtask::paths;

/// Our clips, a bank and a character of the solid figure, and the examples that include their headers.
const CLIPS: [(&str, &[&str]); 4] = [
    ("walk.ptn", &["OledAdafruit", "OledU8g2", "TftESPI", "Servos", "SolidGC9A01"]),
    ("face/hello.ptn", &["Face"]),
    ("character.ptb", &["SteerTFT", "SteerM5"]),
    ("looks/cat.look", &["SolidGC9A01"]),
];

/// The line of `library.properties` by which a folder is known to be this library.
const NAME: &str = "name=Pantin";

/// The folder of the files that are the library's own.
pub fn home() -> PathBuf {
    paths::root().join("bindings/arduino")
}

/// Writes the library to a folder, which is new or empty or has this library, whose sources are replaced then. Returns the number of files.
pub fn write(folder: &Path) -> Result<usize> {
    make_room(folder, is_library(folder), "src")?;
    let mut count = copy(&home(), folder)?;
    let sources = paths::root().join("bindings/c/src");
    count += copy(&sources, &folder.join("src"))?;
    for (clip, examples) in CLIPS {
        let path = paths::root().join("motions").join(clip);
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let bytes = fs::read(&path).with_context(|| path.display().to_string())?;
        let header = match path.extension().and_then(|extension| extension.to_str()) {
            Some("ptb") => c_header_of_bank(&pantin::Bank::new_checked(&bytes)?, &bytes, &name)?,
            Some("look") => {
                let look = look_text::compile(std::str::from_utf8(&bytes)?).map_err(|error| anyhow::anyhow!("{error}"))?;
                c_header_of_look(&look, &name)
            }
            _ => c_header(&pantin::Clip::new_checked(&bytes)?, &bytes, &name)?,
        };
        for example in examples {
            fs::write(folder.join("examples").join(example).join(format!("{name}.h")), &header)?;
            count += 1;
        }
    }
    Ok(count)
}

/// Whether the folder has this library.
fn is_library(folder: &Path) -> bool {
    fs::read_to_string(folder.join("library.properties")).is_ok_and(|text| text.lines().any(|line| line == NAME))
}

/// Makes the folder, or removes the sources of an older version from it. An error if the folder has anything else.
pub fn make_room(folder: &Path, is_older: bool, sources: &str) -> Result<()> {
    fs::create_dir_all(folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
    let is_empty = fs::read_dir(folder)?.next().is_none();
    ensure!(
        is_older || is_empty,
        "{} has other files: name a new folder, or one that this command has written",
        folder.display()
    );
    let sources = folder.join(sources);
    if sources.exists() {
        fs::remove_dir_all(&sources).with_context(|| sources.display().to_string())?;
    }
    Ok(())
}

/// Copies a folder, without tests. Links of its pages to what lies elsewhere in the repository become plain text. Returns the number of files.
pub fn copy(from: &Path, to: &Path) -> Result<usize> {
    fs::create_dir_all(to)?;
    let mut count = 0;
    for entry in fs::read_dir(from).with_context(|| from.display().to_string())? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default();
        if name == "tests" {
            continue;
        }
        if path.is_dir() {
            count += copy(&path, &to.join(name))?;
        } else if path.extension().is_some_and(|extension| extension == "md") {
            let page = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
            fs::write(to.join(name), without_links_out(&page))?;
            count += 1;
        } else {
            fs::copy(&path, to.join(name)).with_context(|| path.display().to_string())?;
            count += 1;
        }
    }
    Ok(count)
}

/// A page of `bindings/NAME` whose links to other folders say where in the repository that is.
fn without_links_out(page: &str) -> String {
    let mut parts = page.split("](../");
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (target, rest) = part.split_once(')').unwrap_or((part, ""));
        let file = target.split('#').next().unwrap_or_default();
        let place = file.strip_prefix("../").map_or_else(|| format!("bindings/{file}"), str::to_owned);
        if let Some(at) = text.rfind('[') {
            text.remove(at);
        }
        text += &format!(" (`{place}` in Pantin's repository){rest}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_folder_has_all_sources_headers_and_licences() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("libraries/Pantin");
        let count = write(&folder).unwrap();
        let sources = [
            "pantin.c",
            "pantin_turn.c",
            "pantin_figure.c",
            "pantin_solid.c",
            "pantin_animator.c",
            "pantin_feet.c",
            "pantin_face.c",
        ];
        for name in sources.into_iter().chain([
            "pantin_face_data.h",
            "pantin_format.h",
            "pantin_solid.h",
            "pantin_animator.h",
            "pantin.h",
        ]) {
            let source = paths::root().join("bindings/c/src").join(name);
            assert_eq!(fs::read(folder.join("src").join(name)).unwrap(), fs::read(source).unwrap());
        }
        for name in [
            "src/PantinPlayer.h",
            "src/PantinCharacter.h",
            "src/PantinSolid.h",
            "library.properties",
            "LICENSE-MIT",
            "LICENSE-APACHE",
            "examples/Servos/Servos.ino",
        ] {
            assert!(folder.join(name).is_file(), "{name}");
        }
        for name in ["Servos/walk.h", "Face/hello.h", "SteerTFT/character.h", "SolidGC9A01/cat.h"] {
            assert!(fs::read_to_string(folder.join("examples").join(name)).unwrap().contains("_LEN"), "{name}");
        }
        let readme = fs::read_to_string(folder.join("README.md")).unwrap();
        assert!(!readme.contains("](../"), "the README links to a file that the folder lacks");
        assert!(!folder.join("tests").exists());
        // Again: the sources of an older version go.
        fs::write(folder.join("src/old.c"), "").unwrap();
        assert_eq!(write(&folder).unwrap(), count);
        assert!(!folder.join("src/old.c").exists());
    }

    #[test]
    fn links_to_other_folders_become_text() {
        let page = "See [a page](../c/README.md#faces), [one](../../docs/FACE.md) and [this](examples/a.c).";
        let expected = "See a page (`bindings/c/README.md` in Pantin's repository), one (`docs/FACE.md` in Pantin's repository) and [this](examples/a.c).";
        assert_eq!(without_links_out(page), expected);
    }

    #[test]
    fn a_folder_with_other_files_is_refused() {
        let place = tempfile::tempdir().unwrap();
        let src = place.path().join("src");
        fs::create_dir(&src).unwrap();
        fs::write(src.join("mine.c"), "").unwrap();
        assert!(write(place.path()).unwrap_err().to_string().contains("has other files"));
        assert!(src.join("mine.c").exists());
    }
}
