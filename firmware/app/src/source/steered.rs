//! Poses of a state machine, which buttons and letters steer.

use super::{Source, Status, TextLine};
use crate::board::Exit;
use crate::keys::SteerKey;
use crate::log::error;
use crate::options::{Mode, NEXT, QUIT};
use pantin::{Player, Pose};
use pantin_animator::Character;
use pantin_animator::machine::Machine;
use pantin_figure::Stand;

/// Time between two pictures that are due. A board that is too slow for it shows fewer; the motion keeps its speed.
const PERIOD_NS: u32 = 16_666_668;
const PERIOD_US: u32 = PERIOD_NS / 1000;
/// Pictures in a second of [`Mode::Sync`], whose time is that of its pictures.
const SYNC_RATE: u64 = 30;

/// A character and its keys.
pub(crate) struct SteeredSource<'k, 'c, 'm> {
    pub(super) character: Character<'c, 'm>,
    keys: &'k [SteerKey<'k>],
    /// The buttons that end the program.
    leave: u16,
    mode: Mode,
    /// The buttons that were held before the last picture.
    buttons: u16,
    /// A bit for each of the keys whose input a letter holds.
    letters: u32,
    /// Pictures so far.
    pictures: u32,
    ended: Option<Exit>,
}

impl<'k, 'c, 'm> SteeredSource<'k, 'c, 'm> {
    /// A character with the buttons that are held at first.
    pub fn new(character: Character<'c, 'm>, keys: &'k [SteerKey<'k>], leave: u16, mode: Mode, buttons: u16) -> Self {
        SteeredSource { character, keys, leave, mode, buttons, letters: 0, pictures: 0, ended: None }
    }

    /// Moves on by a number of periods, or in [`Mode::Sync`] by a picture. Returns the time in microseconds.
    pub(super) fn go_on(&mut self, frames: i32) -> u32 {
        if self.ended.is_some() {
            return 0;
        }
        let time_us = |picture: u32| (u64::from(picture) * 1_000_000 / SYNC_RATE) as u32;
        let elapsed_us = match self.mode {
            Mode::Sync => time_us(self.pictures).wrapping_sub(time_us(self.pictures.saturating_sub(1))),
            Mode::Frames(_) | Mode::Play => frames.unsigned_abs().saturating_mul(PERIOD_US),
        };
        self.pictures = self.pictures.wrapping_add(1);
        if let Err(error) = self.character.update(elapsed_us) {
            error!("the state machine cannot go on: {}", defmt::Display2Format(&error));
            self.ended = Some(Exit::BadClip);
        }
        elapsed_us
    }

    /// Gives the machine what a letter does.
    fn take(&mut self, letter: u8) {
        let machine = self.character.machine();
        for (index, key) in self.keys.iter().enumerate().filter(|(_, key)| key.letter == letter) {
            let bit = 1u32.wrapping_shl(index as u32);
            if key.holds {
                self.letters ^= bit;
            }
            press(machine, key, !key.holds || self.letters & bit != 0);
        }
    }
}

/// Presses a key, or lets it go. A state machine without its input passes over it.
fn press(machine: &mut Machine, key: &SteerKey, down: bool) {
    match machine.table().input(key.input) {
        Some(input) if key.holds => machine.hold(input, down),
        Some(input) if down => machine.fire(input),
        _ => {}
    }
}

impl Source for SteeredSource<'_, '_, '_> {
    const LIVE: bool = false;
    const COMMANDS: bool = false;

    fn hold(&mut self, buttons: u16) {
        let (changed, machine) = (self.buttons ^ buttons, self.character.machine());
        for key in self.keys.iter().filter(|key| changed & key.button != 0) {
            press(machine, key, buttons & key.button != 0);
        }
        if changed & buttons & self.leave != 0 {
            self.ended = Some(Exit::Done);
        }
        self.buttons = buttons;
    }

    fn advance(&mut self, frames: i32) {
        self.go_on(frames);
    }

    fn ended(&self) -> Option<Exit> {
        self.ended
    }

    fn pose(&self) -> Pose<'_> {
        let (pose, _) = self.character.pose();
        pose
    }

    fn stand(&self) -> Option<Stand> {
        let (_, placement) = self.character.pose();
        Some(Stand { place: placement.place, heading: placement.heading })
    }

    /// The number of the picture, from 0.
    fn frame(&self) -> u32 {
        self.pictures.wrapping_sub(1)
    }

    fn frame_time_ns(&self) -> u32 {
        PERIOD_NS
    }

    fn status(&self) -> Status {
        let mut line = TextLine::new();
        // What is longer than the line is cut off.
        let _ = self.character.table().state_name(self.character.state()).chars().try_for_each(|letter| line.push(letter));
        Status::State(line)
    }

    /// The camera stays as it was set up for all states.
    fn with_player(&mut self, _then: impl FnOnce(&mut Player)) {}

    #[cfg(feature = "events")]
    fn hear(&mut self, _since: crate::events::Since, _frames: i32, _heard: &mut dyn FnMut(crate::HeardEvent)) {}

    fn receive(&mut self, byte: u8) -> Option<u8> {
        match byte {
            NEXT | QUIT if self.mode == Mode::Sync => return Some(byte),
            QUIT => self.ended = Some(Exit::Done),
            letter => self.take(letter),
        }
        None
    }
}
