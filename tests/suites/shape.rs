//! The shape of the sources: no board repeats what boards share, and modules import downwards only. `cargo xtask shape` lists what
//! breaks these rules.

use harness::paths;
use xtask::shape::{self, LINES};

#[test]
fn no_six_equal_lines_stand_twice_among_the_boards() {
    let found = shape::among_boards().unwrap();
    assert!(found.is_empty(), "{LINES} equal lines or more: {found:#?}");
}

#[test]
fn the_apps_modules_import_downwards_only() {
    no_circles("firmware/app/src");
}

#[test]
fn the_faces_modules_import_downwards_only() {
    no_circles("firmware/face/src");
}

fn no_circles(folder: &str) {
    let found = shape::circles(&paths::root().join(folder)).unwrap();
    assert!(found.is_empty(), "{folder}: these modules import each other: {found:?}");
}
