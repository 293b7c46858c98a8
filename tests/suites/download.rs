//! Images that `cargo xtask images` gives away.

use std::path::Path;

use harness::download::{self, BOARDS, DISPLAYS, File};
use harness::rp2040::{OLED, Request};
use harness::{paths, setup};
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

#[test]
fn an_image_has_the_same_bytes_each_time_and_none_of_this_machine() {
    if setup::host_only("an image to give away") {
        return;
    }
    let images = BOARDS[0].images();
    let file = images[0].build().unwrap();
    // Another program of the same folder, after which the first is built again.
    let other = images[2].build().unwrap();
    let again = images[0].build().unwrap();
    assert!(file.bytes == again.bytes, "two builds differ");
    let home = std::env::var("HOME").unwrap_or("/nowhere".into());
    for path in [paths::root().to_string_lossy().into_owned(), format!("{home}/.")] {
        for File { name, bytes, .. } in [&file, &other] {
            assert!(!bytes.windows(path.len()).any(|bytes| bytes == path.as_bytes()), "{name} contains {path}");
        }
    }
    let page = download::page(std::slice::from_ref(&file));
    assert!(page.contains("<td>GP4</td>") && page.contains(&file.sum()) && page.contains("BOOTSEL"));
    assert_eq!(download::sums(std::slice::from_ref(&file)), format!("{}  pantin-pico-ssd1306.uf2\n", file.sum()));
    says_why_it_panics_over_usb(&file.bytes);
}

fn says_why_it_panics_over_usb(image: &[u8]) {
    let folder = tempfile::tempdir().unwrap();
    let path: &Path = &folder.path().join("image.uf2");
    std::fs::write(path, image).unwrap();
    let outcome = Request::new(path, OLED).pictures(usize::MAX).usb().seconds(0.2).harm("fault").run().unwrap();
    let text = String::from_utf8_lossy(&outcome.usb).into_owned();
    assert!(text.contains("processor fault: an invalid access, or a stack overflow"), "{text:?}");
}
