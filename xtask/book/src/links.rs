//! The links of a page, which lead to files of the repository.

use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};

use regex::{Captures, Regex};

/// A page for the book, and the pictures that it shows.
pub struct Page {
    /// Its text: links to what is not in the book are words.
    pub text: String,
    /// Paths in the repository.
    pub pictures: BTreeSet<PathBuf>,
}

/// Rewrites the page `path`. Links to pages of `book` and to addresses stay.
pub fn rewritten(path: &Path, text: &str, book: &BTreeSet<&Path>) -> Page {
    let mut pictures = BTreeSet::new();
    let link = Regex::new(r"(!?)\[((?:[^\[\]]|\[[^\[\]]*\])*)\]\(([^()\s]+)\)").unwrap_or_else(|error| unreachable!("{error}"));
    let source = Regex::new(r#"<(?:img|source) [^>]*?(?:src|srcset)="([^":]+)""#).unwrap_or_else(|error| unreachable!("{error}"));
    let text = link.replace_all(text, |found: &Captures<'_>| {
        let [whole, mark, words, target] = [0, 1, 2, 3].map(|group| &found[group]);
        let place = target.split('#').next().unwrap_or_default();
        if place.is_empty() || place.contains(':') {
            return whole.to_owned();
        }
        let file = in_repository(path, place);
        match mark {
            "!" => {
                pictures.insert(file);
                whole.to_owned()
            }
            // The page of a folder's README is its index.
            _ if book.contains(file.as_path()) => format!("[{words}]({})", target.replace("README.md", "index.md")),
            // What is in no page is in the source.
            _ => words.to_owned(),
        }
    });
    for found in source.captures_iter(&text) {
        pictures.insert(in_repository(path, &found[1]));
    }
    Page { text: text.clone().into_owned(), pictures }
}

/// The path in the repository of what a page links to.
fn in_repository(page: &Path, target: &str) -> PathBuf {
    let mut path = page.parent().unwrap_or(Path::new("")).to_path_buf();
    for component in Path::new(target).components() {
        match component {
            Component::ParentDir => drop(path.pop()),
            Component::Normal(name) => path.push(name),
            _ => (),
        }
    }
    path
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::{Path, PathBuf};

    use super::rewritten;

    #[test]
    fn links_to_pages_stay_and_others_become_words() {
        let book = BTreeSet::from(["decoder/FORMAT.md", "decoder/README.md", "docs/WEB.md"].map(Path::new));
        let page = |text| rewritten(Path::new("docs/WEB.md"), text, &book);
        assert_eq!(page("[it](../decoder/README.md#use)").text, "[it](../decoder/index.md#use)");
        for same in ["[format](../decoder/FORMAT.md#rigs)", "[here](#page)", "[other](https://example.org/a.md)"] {
            assert_eq!(page(same).text, same);
        }
        assert_eq!(page("see [`clip.rs`](../decoder/src/clip.rs) and [it](.)").text, "see `clip.rs` and it");
        let shown = page("![a walk](pictures/walk.gif) <img src=\"pictures/face.png\">");
        assert_eq!(shown.pictures, ["docs/pictures/face.png", "docs/pictures/walk.gif"].map(PathBuf::from).into());
    }
}
