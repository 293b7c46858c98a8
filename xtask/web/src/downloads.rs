//! What the page offers to take along: our clips as files of other programs, and the C sources of faces and figures for LVGL and Arduino.

use std::io::{Cursor, Write};
use std::path::Path;

use anyhow::{Context, Result};
use pantin::Clip;
use pantin_convert::expand::expand;
use pantin_convert::export;
use pantin_convert::motion::Motion;
use xtask::paths;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use crate::arduino;
use crate::site::{listed, write};

/// The archives, in the site.
pub const LVGL: &str = "pantin-lvgl.zip";
pub const ARDUINO: &str = "pantin-arduino.zip";

/// Writes a clip as files of other programs beside it: as glTF, and as BVH, or with scalars, which BVH cannot hold, as a table. Returns the ends of their names.
pub fn exported(clip: &Path, bytes: &[u8]) -> Result<[&'static str; 2]> {
    let opened = Clip::new_checked(bytes).map_err(|error| anyhow::anyhow!("{error}"))?;
    let motion = Motion { looped: opened.looped(), ..expand(&opened)? };
    let mut table = vec![];
    let extension = if motion.rig.scalars.is_empty() {
        export::bvh::write(&motion, export::bvh::Columns::ThreeRotations, &mut table)?;
        "bvh"
    } else {
        export::table::write(&motion, &mut table)?;
        "csv"
    };
    write(&clip.with_extension(extension), &table)?;
    write(&clip.with_extension("glb"), &export::gltf::write(&motion)?)?;
    Ok([extension, "glb"])
}

/// Writes the archives.
pub fn archives(out: &Path) -> Result<()> {
    let bindings = paths::root().join("bindings");
    let lvgl = tempfile::tempdir().context("a folder for an archive")?;
    // Beside each other as in the repository: their pages name files of the others.
    for name in ["lvgl", "c", "xiaozhi"] {
        arduino::copy(&bindings.join(name), &lvgl.path().join("pantin").join(name))?;
    }
    write(&out.join(LVGL), &archive(lvgl.path())?)?;
    let library = tempfile::tempdir().context("a folder for an archive")?;
    arduino::write(&library.path().join("Pantin"))?;
    write(&out.join(ARDUINO), &archive(library.path())?)
}

/// A folder as an archive: equal bytes for equal files.
fn archive(folder: &Path) -> Result<Vec<u8>> {
    let mut zip = ZipWriter::new(Cursor::new(vec![]));
    add(&mut zip, folder, folder)?;
    Ok(zip.finish()?.into_inner())
}

fn add(zip: &mut ZipWriter<Cursor<Vec<u8>>>, root: &Path, folder: &Path) -> Result<()> {
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
    for file in listed(folder)? {
        let name: Vec<_> = file.strip_prefix(root)?.iter().map(|part| part.to_string_lossy()).collect();
        zip.start_file(name.join("/"), options)?;
        zip.write_all(&std::fs::read(&file).with_context(|| file.display().to_string())?)?;
    }
    let entries = std::fs::read_dir(folder).with_context(|| folder.display().to_string())?;
    let mut folders: Vec<_> = entries.filter_map(|entry| Some(entry.ok()?.path())).filter(|path| path.is_dir()).collect();
    folders.sort();
    folders.iter().try_for_each(|folder| add(zip, root, folder))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_archives_have_what_their_pages_name() {
        let out = tempfile::tempdir().unwrap();
        archives(out.path()).unwrap();
        let names = |name: &str| {
            let file = std::fs::File::open(out.path().join(name)).unwrap();
            zip::ZipArchive::new(file).unwrap().file_names().map(str::to_owned).collect::<Vec<_>>()
        };
        let [lvgl, arduino] = [LVGL, ARDUINO].map(names);
        for name in [
            "lvgl/README.md",
            "lvgl/src/lv_pantin.c",
            "c/src/pantin_face.c",
            "c/src/pantin_talk.h",
            "c/LICENSE-MIT",
            "xiaozhi/src/pantin_display.h",
        ] {
            assert!(lvgl.contains(&format!("pantin/{name}")), "{name}");
        }
        for name in ["library.properties", "src/pantin_face.c", "src/PantinFace.h", "examples/Face/hello.h"] {
            assert!(arduino.contains(&format!("Pantin/{name}")), "{name}");
        }
        assert!(lvgl.contains(&"pantin/lvgl/examples/speech.c".to_owned()));
        assert!(lvgl.iter().chain(&arduino).all(|name| !name.contains("/tests/")));
        for name in ["c", "lvgl", "xiaozhi"] {
            let mut zip = zip::ZipArchive::new(std::fs::File::open(out.path().join(LVGL)).unwrap()).unwrap();
            let page = std::io::read_to_string(zip.by_name(&format!("pantin/{name}/README.md")).unwrap()).unwrap();
            assert!(!page.contains("](../../") && !page.contains("](tests/"), "{name}");
        }
        let first = std::fs::read(out.path().join(LVGL)).unwrap();
        archives(out.path()).unwrap();
        assert_eq!(std::fs::read(out.path().join(LVGL)).unwrap(), first);
    }
}
