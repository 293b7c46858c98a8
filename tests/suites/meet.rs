//! Two characters that meet: boards show what the host shows, picture by picture.

use harness::display::{Display, Picture};
use harness::qemu::{LM3S6965EVB, Machine, SX1};
use harness::steered::{self, Program};
use harness::{paths, pictures, setup};
use std::ops::Range;

fn shows_what_the_host_shows(machine: Machine, style: &str) -> Vec<Picture> {
    let shown = steered::on_board(machine, Program::Meet, style).unwrap();
    println!("{}: {} pictures are equal", machine.name, shown.len());
    assert_eq!(shown.len(), 451);
    shown
}

#[test]
fn two_characters_meet_on_the_reference_board_as_on_the_host() {
    if setup::host_only("a meeting on a board") {
        return;
    }
    shows_what_the_host_shows(LM3S6965EVB, "lines");
}

/// A picture's rows.
fn rows(picture: &Picture, rows: Range<usize>) -> Picture {
    let width = picture.display.width;
    let pixels = picture.pixels[rows.start * width..rows.end * width].to_vec();
    Picture { display: Display { height: rows.len(), ..picture.display }, pixels }
}

/// `PANTIN_UPDATE=1` draws the README's picture again.
#[test]
fn two_characters_meet_on_the_phone_in_colour_as_on_the_host() {
    if setup::host_only("a meeting on a phone") {
        return;
    }
    let shown = shows_what_the_host_shows(SX1, "solid");
    if std::env::var_os("PANTIN_UPDATE").is_some() {
        // Those between the bow and the end, 7.5 a second, without the dark rows above and below the figures.
        let shown: Vec<Picture> = shown[90..435].iter().step_by(4).map(|picture| rows(picture, 38..180)).collect();
        std::fs::write(paths::root().join("docs/pictures/meet.gif"), pictures::animation(&shown, 7.5).unwrap()).unwrap();
    }
}
