//! The shape of the repository: crates need each other in one direction, modules import downwards, boards repeat nothing, no function is
//! long, and no file is large, forgotten or there twice. `cargo xtask shape` lists what breaks these rules.

use xtask::shape::{self, LINES};
use xtask::{crates, functions, paths, repository_files};

/// What stands around the crates' graph in ARCHITECTURE.md.
const GRAPH: [&str; 2] = ["<!-- crates begin: written by xtask/tests/shape.rs -->\n```text\n", "```\n<!-- crates end -->\n"];

#[test]
fn no_six_equal_lines_stand_twice_among_the_boards() {
    let found = shape::among_boards().unwrap();
    assert!(found.is_empty(), "{LINES} equal lines or more: {found:#?}");
}

#[test]
fn modules_import_downwards_only() {
    for folder in shape::CRATES {
        let found = shape::circles(&paths::root().join(folder)).unwrap();
        assert!(found.is_empty(), "{folder}: these modules import each other: {found:?}");
    }
}

#[test]
fn crates_need_each_other_in_one_direction() {
    let crates = crates::all().unwrap();
    assert_eq!(crates::circles(&crates), Vec::<String>::new(), "crates that need themselves");
    assert_eq!(crates::forbidden(&crates), Vec::<String>::new(), "arrows that xtask/src/crates.rs does not allow");
}

#[test]
fn the_architecture_page_draws_the_crates_as_they_are() {
    let path = paths::root().join("docs/ARCHITECTURE.md");
    let text = std::fs::read_to_string(&path).unwrap();
    let [begin, end] = GRAPH.map(|mark| text.find(mark).unwrap_or_else(|| panic!("docs/ARCHITECTURE.md lacks {mark:?}")));
    let drawn = crates::drawn(&crates::all().unwrap());
    let begin = begin + GRAPH[0].len();
    if std::env::var_os("PANTIN_UPDATE").is_some() {
        return std::fs::write(&path, format!("{}{drawn}{}", &text[..begin], &text[end..])).unwrap();
    }
    assert!(
        text[begin..end] == drawn,
        "docs/ARCHITECTURE.md: the crates changed; PANTIN_UPDATE=1 cargo test -p xtask writes them:\n{drawn}"
    );
}

/// A page and what it must name: every one of these, as it stands there.
fn names_all(page: &str, wanted: impl IntoIterator<Item = String>) {
    let text = std::fs::read_to_string(paths::root().join(page)).unwrap();
    let missing: Vec<String> = wanted.into_iter().filter(|name| !text.contains(name.as_str())).collect();
    assert!(missing.is_empty(), "{page} does not name {missing:?}");
}

#[test]
fn the_pages_name_every_crate_and_every_board() {
    let published = xtask::packages::published().unwrap();
    names_all("docs/ARCHITECTURE.md", published.iter().map(|package| format!("`{}`", package.name)));
    let boards = xtask::packages::firmware().unwrap().into_iter().filter(|package| package.is_board());
    let boards: Vec<String> = boards.map(|board| board.folder.file_name().unwrap().to_string_lossy().into_owned()).collect();
    assert!(boards.len() > 10, "{boards:?}");
    names_all("docs/BOARDS.md", boards.iter().cloned());
    names_all("README.md", boards.iter().filter(|board| *board != "TEMPLATE").map(|board| format!("firmware/boards/{board}")));
}

#[test]
fn the_tree_holds_what_it_should() {
    let Some(files) = repository_files::files().unwrap() else { return eprintln!("SKIPPED: no checkout of git") };
    assert_eq!(
        repository_files::strangers(&files),
        Vec::<&str>::new(),
        "entries of the root that xtask/src/repository_files.rs does not list"
    );
    assert_eq!(repository_files::large(&files).unwrap(), [], "files of more than {} bytes", repository_files::MOST_BYTES);
    assert_eq!(repository_files::twice(&files).unwrap(), Vec::<Vec<&str>>::new(), "files of equal bytes");
}

#[test]
fn no_function_is_long() {
    let Some(files) = repository_files::files().unwrap() else { return eprintln!("SKIPPED: no checkout of git") };
    let found = functions::long(&files).unwrap();
    assert!(found.is_empty(), "functions of more than {} lines: {found:#?}", functions::MOST_LINES);
}
