//! Five buttons: up, down, left, right and select.
//!
//! Alone, up and down change the speed, left and right go round the figure, and select pauses. While select is held, left and
//! right step back and forward, up goes to the next clip and down plays the other way round; select let go after that does not pause.

use pantin_app::Command;

/// Which are held, and what that has meant so far.
#[derive(Debug)]
pub struct Buttons {
    held: u32,
    /// Another one was pressed while select was held.
    chord: bool,
    /// What was asked for when [`Buttons::look`] was last called.
    wish: Option<Command>,
}

impl Buttons {
    /// Bits of the buttons.
    pub const UP: u32 = 1 << 0;
    #[allow(missing_docs)]
    pub const DOWN: u32 = 1 << 1;
    #[allow(missing_docs)]
    pub const LEFT: u32 = 1 << 2;
    #[allow(missing_docs)]
    pub const RIGHT: u32 = 1 << 3;
    #[allow(missing_docs)]
    pub const SELECT: u32 = 1 << 4;

    /// These are held; that does not count until they are let go.
    pub const fn new(held: u32) -> Self {
        Buttons { held, chord: true, wish: None }
    }

    /// Looks which are held. Once a tick and no oftener: a contact that bounces then counts once.
    pub fn look(&mut self, now: u32) {
        self.wish = self.pressed(now);
    }

    /// What the last look saw, once.
    pub fn wish(&mut self) -> Option<Command> {
        self.wish.take()
    }

    /// What a button asks for that was pressed, or select when it is let go, since the last call; `now` those that are held.
    pub fn pressed(&mut self, now: u32) -> Option<Command> {
        let (down, up) = (now & !self.held, self.held & !now);
        self.held = now;
        let select = now & Self::SELECT != 0;
        if down & Self::SELECT != 0 {
            self.chord = false;
        }
        if up & Self::SELECT != 0 && !self.chord {
            return Some(Command::Pause);
        }
        let key = match (down & !Self::SELECT, select) {
            (Self::UP, false) => Command::Faster,
            (Self::DOWN, false) => Command::Slower,
            (Self::LEFT, false) => Command::OrbitLeft,
            (Self::RIGHT, false) => Command::OrbitRight,
            (Self::UP, true) => Command::NextClip,
            (Self::DOWN, true) => Command::Reverse,
            (Self::LEFT, true) => Command::Back,
            (Self::RIGHT, true) => Command::Step,
            _ => return None,
        };
        self.chord = true;
        Some(key)
    }
}
