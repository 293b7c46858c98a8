//! Images that `cargo xtask images` gives away.

use harness::download::{BOARDS, DISPLAYS};
use xtask::packages;

#[test]
fn each_display_and_program_of_a_board_has_an_image() {
    let packages = packages::firmware().unwrap();
    for board in &BOARDS {
        let package = packages.iter().find(|package| package.name == board.package).unwrap();
        assert_eq!(package.targets, [board.target]);
        assert!(package.folder.ends_with(board.folder));
        let images = board.images();
        let manifest = std::fs::read_to_string(package.folder.join("Cargo.toml")).unwrap();
        let offered = DISPLAYS.iter().filter(|display| manifest.contains(&format!("\n{} = [", display.feature)));
        // The SSD1306 needs no feature.
        let displays = if board.wirings.is_empty() { 1 } else { 1 + offered.count() };
        assert_eq!(images.len(), displays + package.programs.len() - 1, "{}", board.package);
    }
}
