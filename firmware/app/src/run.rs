//! The program: open the clip, then decode, place, draw and flush frame by frame.

use crate::board::{Board, Exit};
use crate::options::{Mode, Options};
use embedded_graphics::framebuffer::{Framebuffer, buffer_size};
use embedded_graphics::pixelcolor::Gray4;
use embedded_graphics::pixelcolor::raw::{BigEndian, RawU4};
use pantin::{ChannelState, Clip, Player};
use pantin_figure::{Canvas, Stage, View};

/// Pixels in a row of the display.
pub const WIDTH: usize = 128;
/// Rows of the display.
pub const HEIGHT: usize = 64;
/// Bytes of a picture.
pub const BYTES: usize = buffer_size::<Gray4>(WIDTH, HEIGHT);

/// Most channels of a clip's pose, and of those that move.
const CHANNELS: usize = 256;
/// Most joints of the figure, without fingers and the like.
const JOINTS: usize = 48;

type Frame = Framebuffer<Gray4, RawU4, BigEndian, WIDTH, HEIGHT, BYTES>;

/// Plays the clip until the mode's end.
pub fn run<B: Board>(clip: &[u8], options: Options, board: &mut B) -> Exit {
    let clip = match Clip::new_checked(clip) {
        Ok(clip) => clip,
        Err(error) => {
            defmt::error!("the clip cannot be opened: {}", defmt::Display2Format(&error));
            return Exit::BadClip;
        }
    };
    let mut states = [ChannelState::default(); CHANNELS];
    let mut pose = [0; CHANNELS];
    let mut player = match Player::new(clip, &mut states, &mut pose) {
        Ok(player) => player,
        Err(error) => {
            defmt::error!("the clip is too big: {}", defmt::Display2Format(&error));
            return Exit::BadClip;
        }
    };
    let view = View { orbit: options.orbit.unwrap_or(View::default().orbit), ..View::default() };
    let canvas = Canvas { width: WIDTH as u16, height: HEIGHT as u16 };
    let mut stage = match Stage::<JOINTS>::of_clip(&mut player, canvas, view) {
        Ok(stage) => stage,
        Err(error) => {
            defmt::error!("the rig is too big: {}", defmt::Display2Format(&error));
            return Exit::BadClip;
        }
    };
    defmt::info!(
        "{} frames of {} ns, {} channels, {} of them moving; {} joints drawn",
        clip.frames(),
        clip.frame_time_ns(),
        clip.rig().channels(),
        clip.moving(),
        stage.skeleton().bones.len()
    );
    play(&mut player, &mut stage, options.mode, board);
    Exit::Done
}

#[inline(never)]
fn play<B: Board>(player: &mut Player, stage: &mut Stage<JOINTS>, mode: Mode, board: &mut B) {
    let mut frame = Frame::new();
    let (mut due, mut shown, mut late) = (0, 0u32, 0u32);
    if mode != Mode::Sync {
        board.start_timer(player.clip().frame_time_ns());
    }
    loop {
        decode(player, due, board);
        place(player, stage, board);
        draw(stage, &mut frame, board);
        flush(&frame, board);
        shown = shown.wrapping_add(1);
        due = match mode {
            Mode::Play => {
                // The clip keeps its time on a board that is too slow for every frame.
                let ticks = board.wait_ticks();
                late = late.wrapping_add(ticks - 1);
                ticks
            }
            Mode::Frames(count) if shown >= count => break,
            Mode::Frames(_) => {
                late = late.wrapping_add(board.wait_ticks() - 1);
                1
            }
            Mode::Sync => match next(player.frame(), board) {
                true => 1,
                false => break,
            },
        };
    }
    defmt::info!("{} pictures, {} ticks late", shown, late);
}

/// Tells the other end of the line which frame is on the display; whether it wants another one.
fn next<B: Board>(frame: u32, board: &mut B) -> bool {
    board.send(&frame.to_le_bytes());
    loop {
        match board.receive() {
            b'n' => return true,
            b'q' => return false,
            _ => {}
        }
    }
}

#[inline(never)]
fn decode<B: Board>(player: &mut Player, frames: u32, board: &mut B) {
    board.mark_start();
    for _ in 0..frames {
        player.step();
    }
    board.mark_stop();
}

#[inline(never)]
fn place<B: Board>(player: &Player, stage: &mut Stage<JOINTS>, board: &mut B) {
    board.mark_start();
    stage.look(player.pose());
    board.mark_stop();
}

#[inline(never)]
fn draw<B: Board>(stage: &Stage<JOINTS>, frame: &mut Frame, board: &mut B) {
    board.mark_start();
    let Ok(()) = stage.lines().draw(frame);
    board.mark_stop();
}

#[inline(never)]
fn flush<B: Board>(frame: &Frame, board: &mut B) {
    board.mark_start();
    board.flush(frame.data());
    board.mark_stop();
}
