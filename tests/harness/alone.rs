//! A board on the host that plays the program of boards that one can buy (`board_common::run_forever`), with pins of buttons that a test presses. Its clock is
//! as fast as the host computes, so that hours pass in seconds.

use std::cell::{Cell, RefCell};
use std::convert::Infallible;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::PathBuf;
use std::rc::Rc;

use anyhow::{Context, Result};
use board_common::{Capacity, FnSerial, NoFlash, SharedBoard, TickSource, five_buttons, run_forever};
use board_drivers::Display;
use embedded_hal::digital::{ErrorType, InputPin};
use pantin::Bank;
use pantin_app::Entry;
use pantin_figure::rotation::Rotation;
use pantin_figure::surface::{Framebuffer, Layout};

/// The number of the button `select`, which may be the only one that is connected.
pub const SELECT: usize = 4;

/// A button that is pressed.
#[derive(Clone, Copy, Debug)]
pub struct Press {
    /// Up, down, left, right or [`SELECT`], from 0.
    pub button: usize,
    /// When, in milliseconds since the start.
    pub at_ms: u64,
    /// How long it is held.
    pub for_ms: u64,
}

/// Clips as a board is built with them: files, and the clips of banks.
pub struct Clips(Vec<(String, Vec<u8>)>);

impl Clips {
    /// Reads clips and banks.
    pub fn read(paths: &[PathBuf]) -> Result<Clips> {
        let read = |path: &PathBuf| {
            let bytes = std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
            Ok((path.file_stem().unwrap_or_default().to_string_lossy().into_owned(), bytes))
        };
        Ok(Clips(paths.iter().map(read).collect::<Result<_>>()?))
    }

    /// The clips, in their order.
    pub fn entries(&self) -> Vec<Entry<'_>> {
        let mut entries = vec![];
        for (name, bytes) in &self.0 {
            match Bank::new_checked(bytes) {
                Ok(bank) => entries.extend(bank.entries().map(|clip| Entry {
                    name: clip.name(),
                    bytes: clip.bytes(),
                    rig: bank.rig_bytes(),
                })),
                Err(_) => entries.push(Entry { name, bytes, rig: &[] }),
            }
        }
        entries
    }
}

/// What the board shows.
pub struct Shown<'a, L: Layout> {
    /// Milliseconds since the start.
    pub ms: u64,
    /// The picture, in which text is drawn unless `lines` has it.
    pub framebuffer: &'a mut Framebuffer<L>,
    /// The lines at the top and at the bottom, if text is hardware of the display's own.
    pub lines: &'a [String; 2],
}

/// A board, and what a person does with it.
pub struct Session<'a> {
    /// The clips that it is built with.
    pub entries: &'a [Entry<'a>],
    /// Buttons that are pressed.
    pub presses: &'a [Press],
    /// When it ends.
    pub seconds: u64,
    /// Whether text is hardware of the display's own.
    pub has_overlay: bool,
    /// The milliseconds between which a tick comes late, so that time passes with fewer pictures.
    pub slow_ms: Range<u64>,
}

/// The session is over: a board's program does not end otherwise.
struct Over;

impl Session<'_> {
    /// Plays it, and returns what was sent over the serial line.
    pub fn play<L: Layout>(&self, seen: impl FnMut(Shown<L>)) -> Vec<u8> {
        let now = Clock::default();
        let sent = Rc::new(RefCell::new(vec![]));
        let line = sent.clone();
        let serial = FnSerial { send: move |bytes: &[u8]| line.borrow_mut().extend(bytes), poll: || None };
        let display = Screen { now: now.clone(), session: self, seen, lines: Default::default() };
        let buttons = five_buttons(std::array::from_fn(|number| Pin { now: now.clone(), presses: self.presses, number }));
        let ticks = Ticks { now, period_ns: 0, slow_ms: self.slow_ms.clone() };
        let board = SharedBoard::<L, Capacity, Rotation, _, _, _, _, _>::new(display, serial, buttons, ticks, || {});
        match catch_unwind(AssertUnwindSafe(|| run_forever::<NoFlash, _>(self.entries, board))) {
            Err(reason) if reason.is::<Over>() => {}
            Err(panic) => resume_unwind(panic),
        }
        sent.take()
    }
}

/// Nanoseconds since the start.
type Clock = Rc<Cell<u64>>;

struct Screen<'a, S> {
    now: Clock,
    session: &'a Session<'a>,
    seen: S,
    lines: [String; 2],
}

impl<L: Layout, S: FnMut(Shown<L>)> Display<L> for Screen<'_, S> {
    fn present(&mut self, framebuffer: &mut Framebuffer<L>) {
        let ms = self.now.get() / 1_000_000;
        if ms >= self.session.seconds * 1000 {
            resume_unwind(Box::new(Over));
        }
        (self.seen)(Shown { ms, framebuffer, lines: &self.lines });
    }

    fn overlay(&mut self, lines: [&str; 2]) -> bool {
        if self.session.has_overlay {
            self.lines = lines.map(str::to_owned);
        }
        self.session.has_overlay
    }
}

/// The pin of a button, with a pull-up.
struct Pin<'a> {
    now: Clock,
    presses: &'a [Press],
    number: usize,
}

impl ErrorType for Pin<'_> {
    type Error = Infallible;
}

impl InputPin for Pin<'_> {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        self.is_low().map(|low| !low)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        let ms = self.now.get() / 1_000_000;
        let is_held = |press: &Press| press.button == self.number && (press.at_ms..press.at_ms + press.for_ms).contains(&ms);
        Ok(self.presses.iter().any(is_held))
    }
}

/// A timer that passes the time in no time.
struct Ticks {
    now: Clock,
    period_ns: u32,
    slow_ms: Range<u64>,
}

/// Ticks at once where they come late.
const LATE: u32 = 50;

impl TickSource for Ticks {
    fn start(&mut self, period_ns: u32) {
        self.period_ns = period_ns;
    }

    fn ticks(&mut self) -> u32 {
        let ticks = if self.slow_ms.contains(&(self.now.get() / 1_000_000)) { LATE } else { 1 };
        self.now.set(self.now.get() + u64::from(self.period_ns) * u64::from(ticks));
        ticks
    }

    fn wait(&mut self, _: impl FnMut()) -> u32 {
        self.ticks()
    }
}
