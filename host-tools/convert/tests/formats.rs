//! The table of formats in docs/IMPORT.md and the formats that are read are the same.

use pantin_convert::import::FORMATS;
use std::collections::BTreeSet;
use std::path::Path;

/// Extensions of files that belong to a motion and hold none.
const COMPANIONS: [&str; 2] = ["asf", "bin"];

/// The first cells of the rows of the page's first table.
fn cells() -> Vec<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/IMPORT.md");
    let page = std::fs::read_to_string(path).unwrap();
    let table = page.lines().skip_while(|line| !line.starts_with("| format |")).take_while(|line| line.starts_with('|'));
    table.skip(2).map(|row| row.split('|').nth(1).unwrap().trim().to_string()).collect()
}

/// The extensions that a cell names: `bvh` of `` `.bvh` ``.
fn extensions(cell: &str) -> BTreeSet<&str> {
    cell.split('`').skip(1).step_by(2).filter_map(|code| code.strip_prefix('.')).collect()
}

#[test]
fn every_format_and_extension_has_a_row() {
    let cells = cells();
    for format in FORMATS {
        let name = format.name.to_lowercase();
        let row = cells.iter().find(|cell| {
            let named = extensions(cell);
            cell.to_lowercase().contains(&name) && format.extensions.iter().all(|extension| named.contains(extension))
        });
        assert!(row.is_some(), "docs/IMPORT.md: no row of {}", format.sentence());
    }
}

#[test]
fn every_row_is_of_a_format() {
    let known: BTreeSet<&str> = FORMATS.iter().flat_map(|format| format.extensions).copied().chain(COMPANIONS).collect();
    let cells = cells();
    assert_eq!(cells.len(), FORMATS.len(), "{cells:?}");
    for cell in &cells {
        let named = extensions(cell);
        assert!(!named.is_empty() && named.is_subset(&known), "docs/IMPORT.md: {cell}");
    }
}

#[test]
fn formats_of_one_extension_are_told_apart_by_their_first_bytes() {
    let mut last: Vec<(&str, &str)> = Vec::new();
    for format in FORMATS {
        for extension in format.extensions {
            if let Some((_, other)) = last.iter().find(|(seen, _)| seen == extension) {
                assert_eq!((*other, format.name, *extension), ("Live Link Face", "table", "csv"));
            }
            last.push((extension, format.name));
        }
    }
}
