//! Buttons, and the commands that they give.
//!
//! Alone, up and down change the speed, left and right orbit the camera, and select pauses. While select is held, left and
//! right step back and forward, up selects the next clip and down reverses; releasing select after that does not pause.

use embedded_hal::digital::InputPin;
use pantin_app::Command;

/// Where a board's button commands come from.
pub trait ButtonSource {
    /// Reads the buttons. Call it once a timer tick and no more often: a contact that bounces then counts once.
    fn read(&mut self);

    /// Returns the command that the last [`read`](ButtonSource::read) found, once.
    fn take(&mut self) -> Option<Command>;

    /// Returns the buttons that were held at the last [`read`](ButtonSource::read), each in its bit.
    #[cfg(feature = "steer")]
    fn held(&self) -> u16 {
        0
    }
}

/// A board without buttons.
#[derive(Clone, Copy, Debug)]
pub struct NoButtons;

impl ButtonSource for NoButtons {
    #[inline(always)]
    fn read(&mut self) {}

    #[inline(always)]
    fn take(&mut self) -> Option<Command> {
        None
    }
}

/// Up to five buttons: up, down, left, right and select. `R` returns those that are held, each in its bit.
#[derive(Debug)]
pub struct Buttons<R> {
    held_now: R,
    held: u32,
    /// Another button was pressed while select was held.
    chord: bool,
    command: Option<Command>,
}

/// The bits of the buttons.
#[allow(missing_docs)]
impl Buttons<()> {
    pub const UP: u32 = 1 << 0;
    pub const DOWN: u32 = 1 << 1;
    pub const LEFT: u32 = 1 << 2;
    pub const RIGHT: u32 = 1 << 3;
    pub const SELECT: u32 = 1 << 4;
}

/// Makes buttons of five pins with pull-ups, which are low while up, down, left, right and select are held.
pub fn five_buttons<P: InputPin>(mut pins: [P; 5]) -> Buttons<impl FnMut() -> u32> {
    Buttons::new(0, move || pins.iter_mut().rev().fold(0, |held, pin| held << 1 | u32::from(is_low(pin))))
}

/// Makes buttons of two pins with pull-ups: the first is select; the second is right, or up where it was pressed after the first.
pub fn two_buttons<P: InputPin>(mut pins: [P; 2]) -> Buttons<impl FnMut() -> u32> {
    let mut second = 0;
    Buttons::new(0, move || {
        let [a, b] = pins.each_mut().map(is_low);
        if !b {
            second = if a { Buttons::UP } else { Buttons::RIGHT };
        }
        let first = if a { Buttons::SELECT } else { 0 };
        if b { first | second } else { first }
    })
}

fn is_low<P: InputPin>(pin: &mut P) -> bool {
    matches!(pin.is_low(), Ok(true))
}

impl<R: FnMut() -> u32> Buttons<R> {
    /// Makes buttons that `held_now` reads. Those in `held` give no command before they were released.
    pub const fn new(held: u32, held_now: R) -> Self {
        Buttons { held_now, held, chord: true, command: None }
    }
}

impl<R: FnMut() -> u32> ButtonSource for Buttons<R> {
    fn read(&mut self) {
        let now = (self.held_now)();
        let (pressed, released) = (now & !self.held, self.held & !now);
        self.held = now;
        self.command = command(pressed, released, now & Buttons::SELECT != 0, &mut self.chord);
    }

    fn take(&mut self) -> Option<Command> {
        self.command.take()
    }

    #[cfg(feature = "steer")]
    fn held(&self) -> u16 {
        self.held as u16
    }
}

/// Returns the command of buttons that were pressed and released since the last reading.
fn command(pressed: u32, released: u32, select: bool, chord: &mut bool) -> Option<Command> {
    if pressed & Buttons::SELECT != 0 {
        *chord = false;
    }
    if released & Buttons::SELECT != 0 && !*chord {
        return Some(Command::Pause);
    }
    let command = match (pressed & !Buttons::SELECT, select) {
        (Buttons::UP, false) => Command::Faster,
        (Buttons::DOWN, false) => Command::Slower,
        (Buttons::LEFT, false) => Command::OrbitLeft,
        (Buttons::RIGHT, false) => Command::OrbitRight,
        (Buttons::UP, true) => Command::NextClip,
        (Buttons::DOWN, true) => Command::Reverse,
        (Buttons::LEFT, true) => Command::Back,
        (Buttons::RIGHT, true) => Command::Step,
        _ => return None,
    };
    *chord = true;
    Some(command)
}
