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
#[cfg(feature = "meet")]
use pantin_app::meet as character;
#[cfg(all(feature = "steer", not(feature = "meet")))]
use pantin_app::steer as character;
use pantin_app::{Board, Options, TextScreen, run};
use pantin_figure::surface::Framebuffer;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// What the start screen shows.
#[cfg(not(feature = "steer"))]
const HELP: &str = "\n Pantin\n\n A, B          next, previous clip\n arrows        turn, tilt\n L, R          slower, faster\n Start         pause\n Select        front, side, behind\n\n Select and\n  arrows       step, follow, reverse\n  A, B, Start  style, ground, text\n\n Press a button.";
#[cfg(feature = "steer")]
const HELP: &str = "\n              Pantin\n\n A: steer a character\n  up, with B  walk, run\n  left, right turn\n  down        sit down, stand up\n  A, L, R     jump, bow, wave\n  Start       dance\n  Select      the motions\n\n Others: the motions\n  A, B, Start  next, previous, pause\n  arrows, L, R turn, slower, faster\n  Select       view; with others more";
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
    #[cfg(feature = "steer")]
    if keys::held() & keys::A != 0 {
        framebuffer.clear();
        character::<_, CHANNELS>(board_common::CHARACTER, &keys::STEER, keys::SELECT, options(), &mut framebuffer, &mut board);
        board.overlay([""; 2]);
    }
    loop {
        run(CLIPS, options(), &mut framebuffer, &mut board);
        // It returns only for a clip that cannot be played.
        board.overlay([""; 2]);
        show("A clip cannot be played.", &mut framebuffer, &mut board);
        while keys::held() == 0 {
            start::sleep();
        }
    }
}

/// Text at first, and with the feature `solid` a body with volume.
fn options() -> Options {
    Options {
        hud: true,
        // Most pictures would take two frames of the display.
        #[cfg(feature = "steer")]
        feet: false,
        #[cfg(feature = "solid")]
        solid: true,
        #[cfg(feature = "solid")]
        look: board_common::LOOK,
        #[cfg(all(feature = "meet", feature = "solid"))]
        other_look: board_common::OTHER_LOOK,
        #[cfg(feature = "neck")]
        neck: true,
        ..Options::parse([])
    }
}

/// Channels of the steered character's rig, at most.
#[cfg(feature = "steer")]
const CHANNELS: usize = 64;

fn show(text: &str, framebuffer: &mut Framebuffer<Lcd>, board: &mut impl Board<Layout = Lcd>) {
    // Writing on a text screen cannot fail.
    let _ = TextScreen::new(framebuffer).write_str(text);
    board.present(framebuffer);
}
