//! Pantin on the Game Boy Advance: plays the clips that it was built with.
#![no_std]
#![no_main]

mod board;
mod display;
mod keys;
mod panic;
mod registers;
mod sprites;
mod start;
mod timer;

use core::fmt::Write;
use display::Lcd;
use pantin_app::{Board, Options, TextScreen, run};
use pantin_figure::surface::Framebuffer;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// What the start screen shows.
const HELP: &str = "\n Pantin\n\n A, B          next, previous clip\n arrows        turn, tilt\n L, R          slower, faster\n Start         pause\n Select        front, side, behind\n\n Select and\n  arrows       step, follow, reverse\n  A, B, Start  smooth, ground, text\n\n Press a button.";
/// How long it is shown if no button is pressed: 5 s.
const HELP_BLANKS: u32 = 300;

fn main() -> ! {
    let mut board = board::new();
    let mut framebuffer = Framebuffer::new();
    show(HELP, &mut framebuffer, &mut board);
    let begun = start::blanks();
    while keys::held() == 0 && start::blanks().wrapping_sub(begun) < HELP_BLANKS {
        start::sleep();
    }
    loop {
        let options = Options { hud: true, ..Options::parse([]) };
        run(CLIPS, options, &mut framebuffer, &mut board);
        // It returns only for a clip that cannot be played.
        board.overlay([""; 2]);
        show("A clip cannot be played.", &mut framebuffer, &mut board);
        while keys::held() == 0 {
            start::sleep();
        }
    }
}

fn show(text: &str, framebuffer: &mut Framebuffer<Lcd>, board: &mut impl Board<Layout = Lcd>) {
    // Writing on a text screen cannot fail.
    let _ = TextScreen::new(framebuffer).write_str(text);
    board.present(framebuffer);
}
