//! The service worker's list of files: the page works without a network once it has been there.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use serde_json::json;

use crate::site::{MACHINE, listed};

/// Its script among the page's, and what it has in place of the build's name and of the list.
pub const SCRIPT: &str = "offline.js";
const BUILD: &str = "@BUILD@";
const FILES: &str = "[\"@FILES@\"]";
/// The ends of names of files that the page needs from the start on. Others, such as the converter, are kept once they were fetched.
const KEPT: [&str; 8] = ["js", "css", "json", "ptn", "ptb", "look", "svg", "toml"];
/// A module among them: it is small.
const KEPT_MODULE: &str = MACHINE[2];

/// The script for a site whose other files are there.
pub fn filled(site: &Path, script: &str) -> Result<String> {
    ensure!([BUILD, FILES].iter().all(|mark| script.contains(mark)), "{SCRIPT} has no place for the list of files");
    let files: Vec<PathBuf> =
        [site.to_owned(), site.join("clips")].iter().map(|folder| listed(folder)).collect::<Result<Vec<_>>>()?.concat();
    let end = |file: &Path| file.extension().map(|end| end.to_string_lossy().into_owned()).unwrap_or_default();
    let files = files.into_iter().filter(|file| !["br", "gz"].contains(&&*end(file)) && !file.ends_with(SCRIPT));
    let (mut names, mut hash) = (vec![String::new()], 0xcbf2_9ce4_8422_2325_u64);
    for file in files {
        let name: Vec<_> = file.strip_prefix(site)?.iter().map(|part| part.to_string_lossy()).collect();
        let name = name.join("/");
        let bytes = std::fs::read(&file).with_context(|| file.display().to_string())?;
        // FNV-1a.
        for byte in name.bytes().chain([0]).chain(bytes) {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
        }
        if KEPT.contains(&&*end(&file)) || file.ends_with(KEPT_MODULE) {
            names.push(name);
        }
    }
    Ok(script.replace(BUILD, &format!("{hash:016x}")).replace(FILES, &json!(names).to_string()))
}

#[cfg(test)]
mod tests {
    use super::filled;

    const SCRIPT: &str = "const CACHE = \"@BUILD@\"; const FILES = [\"@FILES@\"];";

    #[test]
    fn the_build_s_name_changes_with_any_file() {
        let site = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| std::fs::write(site.path().join(name), text).unwrap();
        std::fs::create_dir(site.path().join("clips")).unwrap();
        for name in [
            "index.html",
            "app.js",
            "app.js.br",
            "offline.js",
            "large.wasm",
            "pantin-machine.wasm",
            "clips/walk.ptn",
            "clips/walk.bvh",
        ] {
            write(name, "1");
        }
        let first = filled(site.path(), SCRIPT).unwrap();
        assert!(first.ends_with(r#"FILES = ["","app.js","pantin-machine.wasm","clips/walk.ptn"];"#), "{first}");
        for (name, is_part) in [("app.js.br", false), ("offline.js", false), ("clips/walk.bvh", true), ("index.html", true)] {
            let before = filled(site.path(), SCRIPT).unwrap();
            write(name, "2");
            assert_eq!(filled(site.path(), SCRIPT).unwrap() != before, is_part, "{name}");
        }
        assert!(filled(site.path(), "const CACHE = 1;").is_err());
    }
}
