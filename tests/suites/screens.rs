//! What a person sees of the program on each kind of display: a walk, a clip's name, a body with its face, an emote, every item of the menu, and a dark
//! display. `PANTIN_PANELS=FOLDER cargo test -p harness screens::` leaves a sheet of each display in a folder, to be looked at.

use std::path::PathBuf;
use std::sync::LazyLock;

use harness::alone::{Clips, Press, SELECT, Session, Shown};
use harness::clips::{self, Drawn};
use harness::display::{Display, Picture};
use harness::simulator;
use pantin_figure::surface::{Gray4Rows, Layout, MonoPages, Rgb565Rows};
use pantin_images::image::Image;
use tempfile::TempDir;

/// A walk, a body with its face, and an emote.
static CLIPS: LazyLock<(TempDir, Clips)> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let own = clips::own(folder.path(), Drawn::Lines).unwrap();
    let find = |name: &str| own.iter().find(|clip| clip.file_stem().is_some_and(|stem| stem == name)).unwrap().clone();
    let clips = Clips::read(&["walk", "greet", "loving"].map(find)).unwrap();
    (folder, clips)
});

/// The menu's items.
const ITEMS: u64 = 8;
/// When the menu is open, and the time from item to item.
const OPEN_MS: u64 = 10_000;
const ITEM_MS: u64 = 500;
/// Ten minutes after the last press.
const DARK_MS: u64 = OPEN_MS + ITEMS * ITEM_MS + 600_500;

/// Presses: two more clips, the menu, and its items.
fn presses() -> Vec<Press> {
    let short = |at_ms| Press { button: SELECT, at_ms, for_ms: 100 };
    let hold = Press { button: SELECT, at_ms: 9_000, for_ms: 800 };
    let items = (1..ITEMS).map(|item| short(OPEN_MS + item * ITEM_MS));
    [short(1_000), short(5_000), hold].into_iter().chain(items).collect()
}

/// When which picture is taken.
fn moments() -> Vec<(u64, String)> {
    let first = [(500, "walk"), (2_000, "name"), (4_500, "body and face"), (8_500, "emote")];
    let items = (0..ITEMS).map(|item| (OPEN_MS + item * ITEM_MS + 400, format!("menu {item}")));
    let first = first.into_iter().map(|(ms, name)| (ms, name.to_owned()));
    first.chain(items).chain([(DARK_MS, "dark".to_owned())]).collect()
}

/// The pictures of a display at the moments.
fn taken<L: Layout<Ink: simulator::Value>>(display: Display) -> Vec<(String, Picture)> {
    let (entries, presses, moments) = (CLIPS.1.entries(), presses(), moments());
    // Only the end of the ten minutes is looked at.
    let slow_ms = OPEN_MS + (ITEMS + 1) * ITEM_MS..DARK_MS - 2_000;
    let session = Session { entries: &entries, presses: &presses, seconds: DARK_MS / 1000 + 2, has_overlay: false, slow_ms };
    let mut pictures = vec![];
    session.play::<L>(|Shown { ms, framebuffer, .. }| {
        if let Some((_, name)) = moments.get(pictures.len()).filter(|(at, _)| ms >= *at) {
            pictures.push((name.clone(), simulator::picture(display, framebuffer)));
        }
    });
    assert_eq!(pictures.len(), moments.len());
    pictures
}

/// Leaves the pictures on one sheet where someone can look at them, if `PANTIN_PANELS` names a folder.
fn keep(name: &str, pictures: &[(String, Picture)]) {
    const COLUMNS: usize = 4;
    const GAP: usize = 4;
    let Some(folder) = std::env::var_os("PANTIN_PANELS") else { return };
    let Display { width, height, .. } = pictures[0].1.display;
    let (wide, high) = (width + GAP, height + GAP);
    let mut sheet = vec![[64, 64, 160]; COLUMNS * wide * pictures.len().div_ceil(COLUMNS) * high];
    for (index, (_, picture)) in pictures.iter().enumerate() {
        let (x, y) = (index % COLUMNS * wide, index / COLUMNS * high);
        for (at, value) in picture.pixels.iter().enumerate() {
            sheet[(y + at / width) * COLUMNS * wide + x + at % width] = picture.display.depth.rgb(*value);
        }
    }
    let file = std::fs::File::create(PathBuf::from(folder).join(format!("screens-{name}.png"))).unwrap();
    let scale = if width <= 128 { 2 } else { 1 };
    Image::of(COLUMNS * wide, sheet).enlarged(scale).write_png(file).unwrap();
}

fn shows<L: Layout<Ink: simulator::Value>>(name: &str) {
    let pictures = taken::<L>(simulator::display_of::<L>());
    keep(name, &pictures);
    for (index, (name, picture)) in pictures.iter().enumerate() {
        assert_eq!(picture.is_dark(), name == "dark", "{name}");
        assert!(index == 0 || pictures[index - 1].1 != *picture, "{name}");
    }
}

#[test]
fn monochrome_displays_show_names_menu_and_emotes() {
    shows::<MonoPages<128, 64, 1024>>("ssd1306");
    shows::<MonoPages<128, 32, 512>>("ssd1306-128x32");
    shows::<MonoPages<72, 40, 360>>("ssd1306-72x40");
}

#[test]
fn displays_of_greys_show_names_menu_and_emotes() {
    shows::<Gray4Rows<128, 64, 1024>>("greys-128x64");
    shows::<Gray4Rows<128, 240, 3840>>("greys-128x240");
    shows::<Gray4Rows<240, 320, 9600>>("greys-240x320");
}

#[test]
fn colour_displays_show_names_menu_and_emotes() {
    shows::<Rgb565Rows<134, 240, 16080>>("st7789-135x240");
    shows::<Rgb565Rows<240, 134, 16080>>("st7789-240x135");
    shows::<Rgb565Rows<168, 168, 14112>>("gc9a01");
    shows::<Rgb565Rows<170, 320, 27200>>("st7789-170x320");
    shows::<Rgb565Rows<240, 240, 28800>>("st7789");
    shows::<Rgb565Rows<240, 320, 38400>>("ili9341");
}
