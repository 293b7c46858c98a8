//! `cargo xtask book [-o target/web/docs]`: the documentation of the repository as a site with search, ready for any server. Its pages are those of the repository.

mod chapters;
mod links;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail, ensure};
use mdbook_driver::MDBook;
use mdbook_driver::config::Config;
use regex::Regex;

const USAGE: &str = "Usage: cargo xtask book [-o FOLDER]

Writes the documentation as a site with search. FOLDER is target/web/docs by default, which is where the site's pages look for it.";

fn main() -> ExitCode {
    match run(std::env::args().skip(1).collect()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: Vec<String>) -> Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let root = root.canonicalize().context("the repository")?;
    let out = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => root.join("target/web/docs"),
        ["-o" | "--out", folder] => std::env::current_dir()?.join(folder),
        ["-h" | "--help"] => {
            println!("{USAGE}");
            return Ok(());
        }
        _ => bail!("{USAGE}"),
    };
    let folder = tempfile::tempdir().context("a folder for the pages")?;
    let pages = write_pages(&root, &folder.path().join("src"))?;
    build(folder.path(), &out)?;
    let checked = check(&out)?;
    println!("{}: {pages} pages, {checked} links between them lead somewhere", out.display());
    Ok(())
}

/// Writes all pages and their pictures, and the summary. Returns the number of pages.
fn write_pages(root: &Path, source: &Path) -> Result<usize> {
    let book: BTreeSet<&Path> = chapters::paths().map(Path::new).collect();
    let mut pictures = BTreeSet::new();
    for path in &book {
        let text = std::fs::read_to_string(root.join(path)).with_context(|| path.display().to_string())?;
        let mut page = links::rewritten(path, &text, &book);
        if *path == Path::new(chapters::FRONT) {
            page.text += "\n[The page with the player](../index.html) shows all of it moving.\n";
        }
        write(&source.join(path), page.text.as_bytes())?;
        pictures.extend(page.pictures);
    }
    for picture in pictures {
        let bytes = std::fs::read(root.join(&picture)).with_context(|| picture.display().to_string())?;
        write(&source.join(&picture), &bytes)?;
    }
    write(&source.join("SUMMARY.md"), chapters::summary().as_bytes())?;
    Ok(book.len())
}

fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    let folder = path.parent().unwrap_or(path);
    std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    std::fs::write(path, bytes).with_context(|| path.display().to_string())
}

fn build(folder: &Path, out: &Path) -> Result<()> {
    let mut config = Config::default();
    config.book.title = Some("Pantin".into());
    config.book.description = Some("Recorded character motion on small machines".into());
    config.build.build_dir = out.to_owned();
    config.build.create_missing = false;
    config.set("output.html.preferred-dark-theme", "navy")?;
    config.set("output.html.no-section-label", true)?;
    config.set("output.html.print.enable", false)?;
    // Tables and programs are wider than a book's lines.
    write(&folder.join("wide.css"), b":root { --content-max-width: 1000px; }\n")?;
    config.set("output.html.additional-css", ["wide.css"])?;
    // A page that is nobody's is the server's affair: the site may be in any folder.
    config.set("output.html.input-404", "")?;
    MDBook::load_with_config(folder, config)?.build()
}

/// Follows the links between the pages: each leads to a file, and to a place in it that is there. Returns their number.
fn check(out: &Path) -> Result<usize> {
    let (id, link) = (Regex::new(r#" id="([^"]+)""#)?, Regex::new(r#"<a [^>]*href="([^":]+)""#)?);
    let mut pages = BTreeMap::new();
    for path in files(out)? {
        if path.extension().is_some_and(|extension| extension == "html") {
            let text = std::fs::read_to_string(&path).with_context(|| path.display().to_string())?;
            let ids: BTreeSet<String> = id.captures_iter(&text).map(|found| found[1].to_owned()).collect();
            pages.insert(path, (text, ids));
        }
    }
    let (mut checked, mut lost) = (0, BTreeSet::new());
    for (path, (text, _)) in &pages {
        // The list of pages stands in each of them, too.
        if path.ends_with("toc.html") {
            continue;
        }
        for found in link.captures_iter(text) {
            let (file, place) = found[1].split_once('#').unwrap_or((&found[1], ""));
            let target = if file.is_empty() { path.clone() } else { joined(path, file) };
            // The site's own page is beside the book.
            let is_there = match pages.get(&target) {
                Some((_, ids)) => place.is_empty() || ids.contains(place),
                None => target.is_file() || target == out.with_file_name("index.html"),
            };
            checked += 1;
            if !is_there {
                lost.insert(format!("{}: {}", path.strip_prefix(out)?.display(), &found[1]));
            }
        }
    }
    let lost: Vec<String> = lost.into_iter().collect();
    ensure!(lost.is_empty(), "links that lead nowhere:\n{}", lost.join("\n"));
    Ok(checked)
}

fn joined(page: &Path, link: &str) -> PathBuf {
    let mut path = page.parent().unwrap_or(page).to_path_buf();
    for part in link.split('/') {
        match part {
            ".." => drop(path.pop()),
            "." | "" => (),
            name => path.push(name),
        }
    }
    path
}

fn files(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut found = vec![];
    for entry in std::fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let path = entry?.path();
        if path.is_dir() {
            found.extend(files(&path)?);
        } else {
            found.push(path);
        }
    }
    Ok(found)
}
