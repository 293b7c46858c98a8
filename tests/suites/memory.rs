//! The root `memory.x` is the map that the reference board links with: a copy of the sources with another map moves the image.

use std::fs;
use std::path::Path;
use std::process::Command;

use harness::build::Firmware;
use harness::qemu::LM3S6965EVB;
use harness::{clips, paths};
use object::{Object, ObjectSection};

/// Where the image and its variables begin.
fn origins(root: &Path, clip: &Path) -> (u64, u64) {
    let firmware = Firmware::copied(root, LM3S6965EVB.name, LM3S6965EVB.target, &[clip]).unwrap();
    let elf = fs::read(firmware.elf()).unwrap();
    let file = object::File::parse(&*elf).unwrap();
    let address = |name| file.section_by_name(name).map(|section| section.address());
    (address(".vector_table").unwrap(), address(".data").unwrap())
}

/// Copies what git knows, or would know, of a folder of the repository.
fn copy(name: &str, to: &Path) {
    let mut files = Command::new("git");
    files.args(["ls-files", "--cached", "--others", "--exclude-standard", name]);
    let listed = files.current_dir(paths::root()).output().unwrap();
    assert!(listed.status.success(), "git must list the sources: {}", String::from_utf8_lossy(&listed.stderr));
    for file in String::from_utf8(listed.stdout).unwrap().lines() {
        let target = to.join(file);
        fs::create_dir_all(target.parent().unwrap()).unwrap();
        fs::copy(paths::root().join(file), target).unwrap();
    }
}

#[test]
fn the_root_memory_map_places_the_boards_image() {
    let folder = tempfile::tempdir().unwrap();
    let clip = clips::convert(&paths::root().join("motions/walk.keys"), folder.path()).unwrap();
    let root = folder.path().join("copy");
    for name in ["Cargo.toml", "decoder", "firmware", "memory.x"] {
        copy(name, &root);
    }
    assert_eq!(origins(&root, &clip), (0, 0x2000_0000));
    let map = fs::read_to_string(root.join("memory.x")).unwrap();
    let moved = map.replace("0x00000000", "0x00008000").replace("256K", "224K");
    let moved = moved.replace("0x20000000", "0x20000400").replace("64K", "63K");
    assert_ne!(map, moved);
    fs::write(root.join("memory.x"), moved).unwrap();
    assert_eq!(origins(&root, &clip), (0x8000, 0x2000_0400));
}
