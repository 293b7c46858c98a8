//! A character that the user steers: the board's buttons, and letters over its serial line, are the inputs of its state machine.

use crate::board::{Board, BoardRenderer, Exit};
use crate::capacity::Renderer;
use crate::hud;
use crate::options::Mode;
use crate::run::{NEXT, QUIT, SHOWN};
use pantin::{ChannelState, Player};
use pantin_animator::machine::Machine;
use pantin_animator::{Character, Error, LayerMemory, Workspace, first_clip, visit_poses};
use pantin_figure::surface::{Framebuffer, Layout};
use pantin_figure::{Canvas, DrawStyle, Stand, View};

/// What a button does, and a letter that does the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SteerKey<'a> {
    /// The button's bit in [`Board::held`], or 0.
    pub button: u16,
    /// The letter, or 0. A line tells nobody that a key was released: a letter that holds an input releases it when it comes again.
    pub letter: u8,
    /// The input that it gives. A state machine without such an input passes over it.
    pub input: &'a str,
    /// Whether it holds the input as long as it is held, or fires it once.
    pub holds: bool,
}

/// What five buttons (up, down, left, right, select, from the lowest bit) and letters do to the character of `motions/character.toml`.
pub const CHARACTER_KEYS: [SteerKey<'static>; 11] = {
    const fn key(button: u16, letter: u8, input: &str, holds: bool) -> SteerKey<'_> {
        SteerKey { button, letter, input, holds }
    }
    let [up, down, left, right, select] = [1 << 0, 1 << 1, 1 << 2, 1 << 3, 1 << 4];
    [
        key(up, b'w', "go", true),
        key(0, b'f', "fast", true),
        key(select, b' ', "jump", false),
        key(left, b'a', "left", false),
        key(right, b'd', "right", false),
        // Each state knows one of them.
        key(down, b's', "sit", false),
        key(down, b's', "stand", false),
        key(down, b's', "trip", false),
        key(0, b'h', "wave", false),
        key(0, b'b', "bow", false),
        key(0, b'n', "dance", true),
    ]
};

/// Time between two pictures that are due. A board that is too slow for it shows fewer; the motion keeps its speed.
const PERIOD_NS: u32 = 16_666_668;
const PERIOD_US: u32 = PERIOD_NS / 1000;
/// Pictures in a second of [`Mode::Sync`], whose time is that of its pictures.
const SYNC_RATE: u64 = 30;
/// Words of a layer's mask: a bit for each joint.
const MASK_WORDS: usize = crate::RIG.div_ceil(32);

/// Plays the state machine of a bank until a button in `leave` is pressed, the letter `q` comes, or the mode ends. The rig has at most `CHANNELS`
/// channels. The machine's first layer plays; further layers, and the second clips of blends, do not.
///
/// Returns [`Exit::BadClip`] for a bank without a state machine, one that is damaged, or a rig that is too large.
#[inline(never)]
pub fn steer<B: Board, const CHANNELS: usize>(
    bank: &[u8],
    keys: &[SteerKey],
    leave: u16,
    mode: Mode,
    framebuffer: &mut Framebuffer<B::Layout>,
    board: &mut B,
) -> Exit {
    match play::<B, CHANNELS>(bank, keys, leave, mode, framebuffer, board) {
        Ok(()) => Exit::Done,
        Err(_) => Exit::BadClip,
    }
}

fn play<B: Board, const CHANNELS: usize>(
    bank: &[u8],
    keys: &[SteerKey],
    leave: u16,
    mode: Mode,
    framebuffer: &mut Framebuffer<B::Layout>,
    board: &mut B,
) -> Result<(), Error> {
    let mut memory = Workspace::<CHANNELS, CHANNELS>::new();
    let (mut states, mut values, mut sampled) = ([ChannelState::NEW; CHANNELS], [0; CHANNELS], [0; CHANNELS]);
    let mut words = [0; MASK_WORDS];
    let mut renderer = BoardRenderer::<B>::empty();
    aim::<B>(bank, &mut renderer, &mut states, &mut values, &mut sampled)?;
    let mut character = Character::new(bank, memory.lend())?;
    if character.table().layer(0).is_some() {
        let layer = LayerMemory { states: &mut states, values: &mut values, sampled: &mut sampled, words: &mut words };
        character.lend_layer(layer)?;
    }
    if mode != Mode::Sync {
        board.start_timer(PERIOD_NS);
    }
    let (mut held, mut elapsed_us, mut shown) = (board.held(), 0u32, 0u32);
    let mut letters = Letters { keys, held: 0 };
    loop {
        let now = board.held();
        if now & !held & leave != 0 {
            return Ok(());
        }
        steer_by(keys, held, now, character.machine());
        held = now;
        board.mark_start();
        character.update(elapsed_us)?;
        board.mark_stop();
        let (pose, placement) = character.pose();
        board.mark_start();
        renderer.set_pose_at(pose, Stand { place: placement.place, heading: placement.heading });
        board.mark_stop();
        board.mark_start();
        framebuffer.clear();
        renderer.draw(framebuffer, DrawStyle::default());
        board.mark_stop();
        hud::lines(["", character.table().state_name(character.state())], framebuffer, board);
        board.mark_start();
        board.present(framebuffer);
        board.mark_stop();
        shown = shown.wrapping_add(1);
        elapsed_us = match mode {
            Mode::Frames(count) if shown >= count => return Ok(()),
            Mode::Sync => {
                board.send(&[SHOWN]);
                board.send(&(shown - 1).to_le_bytes());
                loop {
                    match board.receive() {
                        NEXT => break,
                        QUIT => return Ok(()),
                        letter => letters.take(letter, character.machine()),
                    }
                }
                let time_us = |picture: u32| (u64::from(picture) * 1_000_000 / SYNC_RATE) as u32;
                time_us(shown).wrapping_sub(time_us(shown - 1))
            }
            Mode::Frames(_) | Mode::Play => {
                let ticks = board.wait_ticks();
                while let Some(letter) = board.poll() {
                    if letter == QUIT {
                        return Ok(());
                    }
                    letters.take(letter, character.machine());
                }
                ticks.saturating_mul(PERIOD_US)
            }
        };
    }
}

/// The letters of keys.
struct Letters<'k> {
    keys: &'k [SteerKey<'k>],
    /// A bit for each of the keys whose input a letter holds.
    held: u32,
}

impl Letters<'_> {
    fn take(&mut self, letter: u8, machine: &mut Machine) {
        for (index, key) in self.keys.iter().enumerate().filter(|(_, key)| key.letter == letter) {
            let Some(input) = machine.table().input(key.input) else { continue };
            if key.holds {
                let bit = 1u32.wrapping_shl(index as u32);
                self.held ^= bit;
                machine.hold(input, self.held & bit != 0);
            } else {
                machine.fire(input);
            }
        }
    }
}

/// Gives the machine what changed between two readings of the buttons.
fn steer_by(keys: &[SteerKey], before: u16, now: u16, machine: &mut Machine) {
    for key in keys.iter().filter(|key| (before ^ now) & key.button != 0) {
        let Some(input) = machine.table().input(key.input) else { continue };
        let pressed = now & key.button != 0;
        if key.holds {
            machine.hold(input, pressed);
        } else if pressed {
            machine.fire(input);
        }
    }
}

/// Sets the figure up, and the camera for the clips of all states.
#[inline(never)]
fn aim<B: Board>(
    bytes: &[u8],
    renderer: &mut BoardRenderer<B>,
    states: &mut [ChannelState],
    values: &mut [i32],
    sampled: &mut [i32],
) -> Result<(), Error> {
    let canvas = Canvas { width: B::Layout::WIDTH as u16, height: B::Layout::HEIGHT as u16 };
    let mut player = Player::new(first_clip(bytes)?, states, values)?;
    renderer.set_up(&mut player, canvas).map_err(|_| Error::NoSuchJoint)?;
    let mut visited = Ok(());
    renderer.look_at(canvas, View::default(), |visit| {
        visited = visited.and(visit_poses(bytes, states, values, sampled, &mut |_, values| visit(values)));
    });
    visited
}
