//! The console's ten buttons, and the commands that they give.

use crate::registers::KEYS;
use board_common::ButtonSource;
use pantin_app::Command;
#[cfg(feature = "steer")]
use pantin_app::SteerKey;

pub const A: u16 = 1 << 0;
const B: u16 = 1 << 1;
pub const SELECT: u16 = 1 << 2;
const START: u16 = 1 << 3;
const RIGHT: u16 = 1 << 4;
const LEFT: u16 = 1 << 5;
const UP: u16 = 1 << 6;
const DOWN: u16 = 1 << 7;
const R: u16 = 1 << 8;
const L: u16 = 1 << 9;
const ALL: u16 = (1 << 10) - 1;

/// The commands of the buttons, alone.
const ALONE: [(u16, Command); 9] = [
    (A, Command::NextClip),
    (B, Command::PreviousClip),
    (START, Command::Pause),
    (RIGHT, Command::OrbitRight),
    (LEFT, Command::OrbitLeft),
    (UP, Command::TiltUp),
    (DOWN, Command::TiltDown),
    (R, Command::Faster),
    (L, Command::Slower),
];

/// Their commands while select is held.
const WITH_SELECT: [(u16, Command); 9] = [
    #[cfg(not(feature = "solid"))]
    (A, Command::Smooth),
    #[cfg(feature = "solid")]
    (A, Command::Style),
    (B, Command::Ground),
    (START, Command::Hud),
    (RIGHT, Command::Step),
    (LEFT, Command::Back),
    (UP, Command::Track),
    (DOWN, Command::Reverse),
    (R, Command::Faster),
    (L, Command::Slower),
];

/// What the buttons do to our character.
#[cfg(feature = "steer")]
pub const STEER: [SteerKey<'static>; 11] = {
    const fn key(button: u16, input: &str, holds: bool) -> SteerKey<'_> {
        SteerKey { button, letter: 0, input, holds }
    }
    [
        key(UP, "go", true),
        key(B, "fast", true),
        key(A, "jump", false),
        key(LEFT, "left", false),
        key(RIGHT, "right", false),
        // Each state knows one of them.
        key(DOWN, "sit", false),
        key(DOWN, "stand", false),
        key(DOWN, "trip", false),
        key(R, "wave", false),
        key(L, "bow", false),
        key(START, "dance", true),
    ]
};

/// Returns the buttons that are held.
pub fn held() -> u16 {
    !KEYS.read() & ALL
}

/// The buttons. Select alone, pressed and released, goes to the next view.
#[derive(Debug)]
pub struct Keys {
    held: u16,
    /// Another button was pressed while select was held.
    chord: bool,
    command: Option<Command>,
}

impl Keys {
    /// Makes the buttons. Those that are held now give no command before they were released.
    pub fn new() -> Self {
        Keys { held: held(), chord: true, command: None }
    }
}

impl ButtonSource for Keys {
    fn read(&mut self, _ns: u32) {
        let now = held();
        let (pressed, released) = (now & !self.held, self.held & !now);
        self.held = now;
        if pressed & SELECT != 0 {
            self.chord = false;
        }
        let commands = if now & SELECT != 0 { &WITH_SELECT } else { &ALONE };
        self.command = commands.iter().find(|(key, _)| pressed & key != 0).map(|(_, command)| *command);
        self.chord |= self.command.is_some();
        if released & SELECT != 0 && !self.chord {
            self.command = Some(Command::View);
        }
    }

    fn take(&mut self) -> Option<Command> {
        self.command.take()
    }

    #[cfg(feature = "steer")]
    fn held(&self) -> u16 {
        self.held
    }
}
