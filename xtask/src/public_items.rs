//! `cargo xtask semver`: the public items of the published libraries against the list that the repository keeps.
//!
//! Items are read off the pages that rustdoc writes, which `cargo xtask docs` builds: everything that `all.html` of a crate leads to,
//! with the methods, variants, fields and constants of its own. An item that is gone breaks programs, so the change that removes it
//! changes the list too, where a reader of the change sees it.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use xtask::steps::say;
use xtask::{packages, paths};

const USAGE: &str = "Usage: cargo xtask semver [--update]

Compares the public items of the published libraries with xtask/public-items.txt; fails if one is gone or new

Options:
  --update  Writes the list; commit it with the change";

/// Not a library for programs: it is public for its own tests.
const NO_LIBRARY: &str = "pantin-tools";

/// What the pages call an item's own items.
const OWN: [&str; 6] = ["method", "tymethod", "variant", "structfield", "associatedconstant", "associatedtype"];

/// Compares, or writes the list.
pub fn run(arguments: &[String]) -> Result<()> {
    let update = match arguments {
        [] => false,
        [update] if update == "--update" => true,
        _ => bail!("{USAGE}"),
    };
    crate::publish::docs(&[])?;
    let mut items = BTreeSet::new();
    for package in packages::published()?.iter().filter(|package| package.name != NO_LIBRARY) {
        let name = package.name.replace('-', "_");
        let of_crate = of_crate(&paths::root().join("target/doc").join(&name), &name)?;
        ensure!(!of_crate.is_empty(), "{name}: its documentation lists no items");
        items.extend(of_crate);
    }
    let text: String = items.iter().map(|item| format!("{item}\n")).collect();
    if update {
        fs::write(list(), text).context("xtask/public-items.txt")?;
        say(&format!("xtask/public-items.txt: {} items", items.len()));
        return Ok(());
    }
    compare(&items)
}

fn list() -> PathBuf {
    paths::root().join("xtask/public-items.txt")
}

fn compare(items: &BTreeSet<String>) -> Result<()> {
    let kept = fs::read_to_string(list()).context("xtask/public-items.txt")?;
    let kept: BTreeSet<String> = kept.lines().map(String::from).collect();
    let gone: Vec<&String> = kept.difference(items).collect();
    let new: Vec<&String> = items.difference(&kept).collect();
    gone.iter().for_each(|item| say(&format!("gone: {item}")));
    new.iter().for_each(|item| say(&format!("new: {item}")));
    ensure!(
        gone.is_empty() && new.is_empty(),
        "{} public items are gone and {} are new; `cargo xtask semver --update` writes the list, and CHANGELOG.md tells users what to change",
        gone.len(),
        new.len()
    );
    say(&format!("all {} public items are as xtask/public-items.txt lists them", kept.len()));
    Ok(())
}

/// The items of a crate, as paths: `pantin::Clip::find`.
fn of_crate(folder: &Path, name: &str) -> Result<Vec<String>> {
    let all = read(&folder.join("all.html"))?;
    let mut items = Vec::new();
    for href in values(&all, "href=\"").filter(|href| href.ends_with(".html") && !href.contains("..")) {
        let (modules, file) = href.rsplit_once('/').unwrap_or(("", href));
        // `struct.Clip.html`; the crate's own page and others have no kind.
        let Some((_, item)) = file.strip_suffix(".html").and_then(|file| file.split_once('.')) else { continue };
        let mut path = vec![name];
        path.extend(modules.split('/').filter(|module| !module.is_empty()));
        path.push(item);
        let path = path.join("::");
        let page = read(&folder.join(href))?;
        items.extend(own(&page).map(|own| format!("{path}::{own}")));
        items.push(path);
    }
    Ok(items)
}

/// The names of an item's own items on its page. Items that come from traits follow them there, and are left out.
fn own(page: &str) -> impl Iterator<Item = &str> {
    let end =
        page.find("id=\"trait-implementations\"").or_else(|| page.find("id=\"synthetic-implementations\"")).unwrap_or(page.len());
    values(&page[..end], "id=\"").filter_map(|id| {
        let (kind, name) = id.split_once('.')?;
        // `variant.Other.field.0` is the variant's.
        (OWN.contains(&kind) && !name.contains('.')).then_some(name)
    })
}

/// What stands between `begin` and the next quotation mark, wherever `begin` does.
fn values<'t>(text: &'t str, begin: &'static str) -> impl Iterator<Item = &'t str> {
    text.split(begin).skip(1).filter_map(|rest| rest.split('"').next())
}

fn read(path: &Path) -> Result<String> {
    fs::read_to_string(path).with_context(|| path.display().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_items_stand_before_those_of_traits() {
        let page = r#"<h2 id="variants"><section id="variant.One"></section><section id="variant.One.field.0"></section>
            <section id="method.new"></section><h2 id="trait-implementations"><section id="method.fmt"></section>"#;
        assert_eq!(own(page).collect::<Vec<_>>(), ["One", "new"]);
        assert_eq!(values(r#"<a href="struct.A.html">A</a>"#, "href=\"").collect::<Vec<_>>(), ["struct.A.html"]);
    }
}
