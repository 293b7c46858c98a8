//! Folders to copy: the files of a binding with the sources in C that they compile.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use harness::paths;
use harness::web::arduino::{copy, make_room};

/// What a folder has beside its own files.
pub struct Packed {
    /// The folder of the binding in `bindings`.
    pub binding: &'static str,
    /// A file by which a folder is known to be this one.
    pub known_by: &'static str,
    /// Folders that are filled: where each is in the folder and the repository, and the sources; the headers that they include come along.
    pub filled: &'static [(&'static str, &'static str, &'static [&'static str])],
}

impl Packed {
    /// Writes the folder, which is new or empty or was written before: its sources are replaced then. Returns the number of files.
    pub fn write(&self, folder: &Path) -> Result<usize> {
        let is_older = folder.join(self.known_by).is_file();
        for (to, ..) in self.filled {
            make_room(folder, is_older, to)?;
            // The next one finds what this one has made.
            if !is_older {
                break;
            }
        }
        let mut count = copy(&paths::root().join("bindings").join(self.binding), folder)?;
        for (to, from, sources) in self.filled {
            let (to, from) = (folder.join(to), paths::root().join(from));
            fs::create_dir_all(&to)?;
            let files = with_includes(&from, sources)?;
            for name in &files {
                fs::copy(from.join(name), to.join(name)).with_context(|| name.clone())?;
            }
            count += files.len();
        }
        Ok(count)
    }
}

/// The names of sources and of the headers beside them that they include.
pub fn with_includes(folder: &Path, sources: &[&str]) -> Result<BTreeSet<String>> {
    let mut names = BTreeSet::new();
    let mut open: Vec<String> = sources.iter().map(|&name| name.to_owned()).collect();
    while let Some(name) = open.pop() {
        let text = fs::read_to_string(folder.join(&name)).with_context(|| name.clone())?;
        let quoted = |line: &str| Some(line.strip_prefix("#include \"")?.split_once('"')?.0.to_owned());
        if names.insert(name) {
            open.extend(text.lines().filter_map(quoted).filter(|name| folder.join(name).is_file()));
        }
    }
    Ok(names)
}
