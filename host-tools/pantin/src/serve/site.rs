//! All that is served, by its path.

use crate::memory;
use crate::open::no_clip;
use crate::output::note;
use anyhow::{Context, Result, ensure};
use pantin::Clip;
use serde_json::json;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Bytes that all files may have together: they are kept in memory.
const MOST_BYTES: usize = 256 << 20;
/// Where the page's own clips are, below the site.
const CLIPS: &str = "clips";

/// A file and what a browser takes it for.
pub struct File {
    /// Its content.
    pub bytes: Vec<u8>,
    /// Its media type.
    pub kind: &'static str,
    /// What stands for its content in an `ETag`: equal for equal content.
    pub tag: String,
}

/// A content coding of HTTP, and what ends the name of a file that holds another one's content in it.
pub struct Coding {
    /// Its name in headers.
    pub name: &'static str,
    extension: &'static str,
}

/// The codings that are served, the smallest first. Files in them are made when the site is built.
pub const CODINGS: [Coding; 2] = [Coding { name: "br", extension: ".br" }, Coding { name: "gzip", extension: ".gz" }];

/// Files by their paths: `/app.js`.
#[derive(Default)]
pub struct Site {
    files: BTreeMap<String, File>,
    bytes: usize,
    /// Whether pages of other sites may read the files.
    pub shared: bool,
}

impl Site {
    /// Reads a site that `cargo xtask web` has built.
    pub fn read(folder: &Path) -> Result<Site> {
        let mut site = Site::default();
        let root = folder.canonicalize().with_context(|| format!("{}: cannot be read", folder.display()))?;
        site.add_folder(&root, folder, "/")?;
        ensure!(
            site.files.contains_key("/index.html"),
            "{}: no page in it; `cargo xtask web` builds one into target/web",
            folder.display()
        );
        Ok(site)
    }

    /// The site that the program has inside, if it was built with `PANTIN_SITE`.
    pub fn built_in() -> Option<Result<Site>> {
        #[cfg(site)]
        return Some(Site::unpack(include_bytes!(env!("PANTIN_SITE"))).context("the site that the program has inside"));
        #[cfg(not(site))]
        None
    }

    /// All files in one, for [`Site::unpack`]: of each the lengths of its path and its content in four bytes each, least significant first, then both.
    /// Those in gzip are left out, because a browser that takes gzip takes the file itself or brotli.
    pub fn pack(&self) -> Result<Vec<u8>> {
        let mut packed = vec![];
        for (path, File { bytes, .. }) in self.files.iter().filter(|(path, _)| !path.ends_with(".gz")) {
            for len in [path.len(), bytes.len()] {
                packed.extend(u32::try_from(len).with_context(|| path.clone())?.to_le_bytes());
            }
            packed.extend([path.as_bytes(), bytes].concat());
        }
        Ok(packed)
    }

    /// The site of [`Site::pack`].
    pub fn unpack(mut packed: &[u8]) -> Result<Site> {
        let mut site = Site::default();
        while !packed.is_empty() {
            let (lens, rest) = packed.split_first_chunk::<8>().context("a packed site ends early")?;
            let [path, bytes] =
                [0, 4].map(|at| u32::from_le_bytes([lens[at], lens[at + 1], lens[at + 2], lens[at + 3]]) as usize);
            let (path, rest) = rest.split_at_checked(path).context("a packed site ends early")?;
            let (bytes, rest) = rest.split_at_checked(bytes).context("a packed site ends early")?;
            site.add(String::from_utf8(path.to_vec()).context("a path that is not UTF-8")?, bytes.to_vec())?;
            packed = rest;
        }
        Ok(site)
    }

    /// Where the site is: as given, or beside the program, or where `cargo xtask web` puts it.
    pub fn find(given: Option<&Path>) -> Result<PathBuf> {
        if let Some(folder) = given {
            return Ok(folder.into());
        }
        let program = std::env::current_exe().ok();
        let near = program.iter().flat_map(|program| program.ancestors().skip(1).take(2)).map(|folder| folder.join("web"));
        let mut places = near.chain([PathBuf::from("target/web")]);
        let found = places.find(|folder| folder.join("index.html").is_file());
        found.context("the page is not built: run `cargo xtask web`, or give its folder by --site")
    }

    /// Shows these clips in place of the site's own.
    pub fn show(&mut self, clips: &[PathBuf]) -> Result<()> {
        self.files.retain(|path, _| !path.starts_with(&format!("/{CLIPS}/")));
        let mut list = vec![];
        for (number, path) in clips.iter().enumerate() {
            let bytes = memory::read(path)?;
            if let Err(error) = Clip::new_checked(&bytes) {
                return Err(no_clip(path, &bytes, error).context(path.display().to_string()));
            }
            // A name of the server's own needs no escapes.
            let file = format!("{CLIPS}/{number}.ptn");
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            list.push(json!({ "name": name, "file": file, "bytes": bytes.len() }));
            self.add(format!("/{file}"), bytes)?;
        }
        self.add("/clips.json".into(), json!(list).to_string().into_bytes())
    }

    /// The file of a request's path: of a folder, its page.
    pub fn file(&self, path: &str) -> Option<&File> {
        self.files.get(&*named(path))
    }

    /// The file of a request's path in a coding.
    pub fn coded(&self, path: &str, coding: &Coding) -> Option<&File> {
        self.files.get(&format!("{}{}", named(path), coding.extension))
    }

    /// Adds a file.
    pub fn add(&mut self, path: String, bytes: Vec<u8>) -> Result<()> {
        self.bytes += bytes.len();
        ensure!(self.bytes <= MOST_BYTES, "{path}: all files together have more than {MOST_BYTES} bytes");
        // What was made of other content is no longer the file's.
        CODINGS.iter().for_each(|coding| drop(self.files.remove(&format!("{path}{}", coding.extension))));
        let (kind, tag) = (kind(&path), tag(&bytes));
        self.files.insert(path, File { bytes, kind, tag });
        Ok(())
    }

    /// Adds the files in `folder` and in the folders below it, except links that lead out of the site's folder `root`. Links to folders are not followed.
    fn add_folder(&mut self, root: &Path, folder: &Path, prefix: &str) -> Result<()> {
        let entries = fs::read_dir(folder).with_context(|| format!("{}: cannot be read", folder.display()))?;
        let mut found = vec![];
        for entry in entries {
            let path = entry.with_context(|| folder.display().to_string())?.path();
            found.push(path);
        }
        // A file comes before what was made of it.
        found.sort();
        for path in found {
            let Some(name) = path.file_name().and_then(|name| name.to_str()) else { continue };
            if path.is_dir() && !path.is_symlink() {
                self.add_folder(root, &path, &format!("{prefix}{name}/"))?;
            } else if path.is_file() {
                if !path.canonicalize().is_ok_and(|file| file.starts_with(root)) {
                    note!("warning: {}: not served, because it is a link to a file outside of the site's folder", path.display());
                    continue;
                }
                let bytes = memory::read(&path)?;
                self.add(format!("{prefix}{name}"), bytes)?;
            }
        }
        Ok(())
    }
}

/// The path of the file that a path names.
fn named(path: &str) -> Cow<'_, str> {
    if path.ends_with('/') { format!("{path}index.html").into() } else { path.into() }
}

/// A hash of 64 bits (FNV-1a) and the length.
fn tag(bytes: &[u8]) -> String {
    let hash = bytes.iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3));
    format!("\"{hash:016x}-{:x}\"", bytes.len())
}

fn kind(path: &str) -> &'static str {
    match path.rsplit_once('.').map(|(_, extension)| extension) {
        Some("html") => "text/html; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("json") => "application/json",
        Some("wasm") => "application/wasm",
        Some("svg") => "image/svg+xml",
        Some("png") => "image/png",
        Some("gif") => "image/gif",
        Some("woff2") => "font/woff2",
        _ => "application/octet-stream",
    }
}
