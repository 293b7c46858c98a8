//! Buttons, and the commands that they give.
//!
//! Alone, up and down change the speed, left and right orbit the camera, and select pauses, or on boards where it may be the only button plays the next
//! clip. While select is held, left and right step back and forward, up selects the next clip and down reverses; releasing select after that does nothing.
//! Held alone for 0.7 s, on boards that one can buy, select opens the menu, and in the menu chooses.

use embedded_hal::digital::InputPin;
use pantin_app::Command;

/// Where a board's button commands come from.
pub trait ButtonSource {
    /// Reads the buttons. Call it once a timer tick and no more often: a contact that bounces then counts once. `ns` is the time since the last call, in nanoseconds.
    fn read(&mut self, ns: u32);

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
    fn read(&mut self, _ns: u32) {}

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
    /// Select was pressed for something else than what its release does: another button was pressed too, or the menu was meant.
    chord: bool,
    /// Nanoseconds for which select has been held, up to [`HOLD_NS`].
    held_ns: u32,
    /// What a press of select does.
    press: Command,
    /// Whether select opens the menu when it is held.
    menu: bool,
    command: Option<Command>,
}

/// Select opens the menu when it is held for this time.
const HOLD_NS: u32 = 700_000_000;

/// The bits of the buttons.
#[allow(missing_docs)]
impl Buttons<()> {
    pub const UP: u32 = 1 << 0;
    pub const DOWN: u32 = 1 << 1;
    pub const LEFT: u32 = 1 << 2;
    pub const RIGHT: u32 = 1 << 3;
    pub const SELECT: u32 = 1 << 4;
}

/// Makes buttons of five pins with pull-ups, which are low while up, down, left, right and select are held. Select, which may be the only one that is
/// connected, plays the next clip.
pub fn five_buttons<P: InputPin>(mut pins: [P; 5]) -> Buttons<impl FnMut() -> u32> {
    Buttons::with_menu(Command::NextClip, move || pins.iter_mut().rev().fold(0, |held, pin| held << 1 | u32::from(is_low(pin))))
}

/// Makes buttons of two pins with pull-ups: the first is select; the second is right, or up where it was pressed after the first.
pub fn two_buttons<P: InputPin>(mut pins: [P; 2]) -> Buttons<impl FnMut() -> u32> {
    let mut second = 0;
    Buttons::with_menu(Command::Pause, move || {
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
    /// Makes buttons that `held_now` reads, without a menu. Those in `held` give no command before they were released.
    pub const fn new(held: u32, held_now: R) -> Self {
        Buttons { held_now, held, chord: true, held_ns: 0, press: Command::Pause, menu: false, command: None }
    }

    /// Makes buttons with a menu. A press of select gives `press`.
    fn with_menu(press: Command, held_now: R) -> Self {
        Buttons { press, menu: true, ..Buttons::new(0, held_now) }
    }
}

impl<R: FnMut() -> u32> ButtonSource for Buttons<R> {
    fn read(&mut self, ns: u32) {
        let now = (self.held_now)();
        let before = core::mem::replace(&mut self.held, now);
        let (pressed, released) = (now & !before, before & !now);
        let select = now & Buttons::SELECT != 0;
        self.held_ns = if select { self.held_ns.saturating_add(ns) } else { 0 };
        self.command = if self.menu && self.held_ns >= HOLD_NS && !self.chord {
            self.chord = true;
            Some(Command::Menu)
        } else {
            command(pressed, released, select, self.press, &mut self.chord)
        };
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
fn command(pressed: u32, released: u32, select: bool, press: Command, chord: &mut bool) -> Option<Command> {
    if pressed & Buttons::SELECT != 0 {
        *chord = false;
    }
    if released & Buttons::SELECT != 0 && !*chord {
        return Some(press);
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
