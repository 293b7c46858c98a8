//! The board's display, buttons, timer and line for the program.

use crate::clocks;
use crate::display::{Display, Lit, Words};
use board_common::Buttons;
use board_common::cortex_m::SysTick;
use pantin_app::{Board, Command};
use pantin_figure::rotation::Rotation;
use pantin_figure::surface::Framebuffer;
use stm32f4xx_hal::gpio::{ErasedPin, Input};
use stm32f4xx_hal::pac::{Peripherals, USART1};
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::serial::{Config, Serial};
use stm32f4xx_hal::watchdog::IndependentWatchdog;

/// Bits a second of the line.
const BAUD: u32 = 115_200;
/// The watchdog starts the board anew when the program was stuck for so long, in milliseconds of a clock that may be half as fast again.
#[cfg(not(feature = "update"))]
const PATIENCE: u32 = 2000;
/// Longer than a sector's erasing, in which nobody feeds it: four seconds.
#[cfg(feature = "update")]
const PATIENCE: u32 = 7000;

/// The board.
pub struct BlackPill {
    display: Display,
    line: Serial<USART1>,
    /// Up, down, left and right on PB12 to PB15, and for select the board's own on PA0: to ground while they are pressed.
    pins: [ErasedPin<Input>; 5],
    buttons: Buttons,
    ticks: SysTick<{ clocks::RATE * 1000 }>,
    watchdog: IndependentWatchdog,
}

impl BlackPill {
    /// Sets it up.
    pub fn new(parts: Peripherals) -> Self {
        let mut control = clocks::start(parts.RCC);
        let (a, b) = (parts.GPIOA.split(&mut control), parts.GPIOB.split(&mut control));
        let config = Config::default().baudrate(BAUD.bps());
        let Ok(line) = Serial::new(parts.USART1, (a.pa9, a.pa10), config, &mut control) else {
            unreachable!("the rate is one that the line can have")
        };
        #[cfg(feature = "update")]
        let mut line = line;
        #[cfg(feature = "update")]
        crate::received::listen(&mut line);
        #[cfg(not(feature = "st7789"))]
        let display = Display::new(parts.I2C1, b.pb6, b.pb7, &mut control);
        #[cfg(feature = "st7789")]
        let display = Display::new(parts.SPI1, (a.pa4, a.pa5, a.pa7, b.pb0), &mut control);
        let pins = [
            b.pb12.into_pull_up_input().erase(),
            b.pb13.into_pull_up_input().erase(),
            b.pb14.into_pull_up_input().erase(),
            b.pb15.into_pull_up_input().erase(),
            a.pa0.into_pull_up_input().erase(),
        ];
        let mut watchdog = IndependentWatchdog::new(parts.IWDG);
        watchdog.stop_on_debug(&parts.DBGMCU, true);
        watchdog.start(PATIENCE.millis());
        BlackPill { display, line, pins, buttons: Buttons::new(0), ticks: SysTick::new(), watchdog }
    }

    /// Shows words.
    pub fn tell(&mut self, page: &mut Framebuffer<Words>) {
        self.display.show(page);
    }

    /// Tells the watchdog that the program goes on.
    pub fn feed(&mut self) {
        self.watchdog.feed();
    }

    /// Those that are held, each in its bit.
    fn held(&self) -> u32 {
        self.pins.iter().rev().fold(0, |held, pin| held << 1 | u32::from(pin.is_low()))
    }
}

impl Board for BlackPill {
    type Layout = Lit;
    type Rotation = Rotation;
    type Capacity = board_common::Capacity;

    fn present(&mut self, framebuffer: &mut Framebuffer<Lit>) {
        self.display.show(framebuffer);
        self.feed();
    }

    fn start_timer(&mut self, period_ns: u32) {
        self.ticks.start(period_ns);
    }

    fn ticks(&mut self) -> u32 {
        let ticks = self.ticks.ticks();
        if ticks > 0 {
            let held = self.held();
            self.buttons.look(held);
        }
        ticks
    }

    fn wait_ticks(&mut self) -> u32 {
        let ticks = self.ticks.wait(|| self.watchdog.feed());
        let held = self.held();
        self.buttons.look(held);
        ticks
    }

    fn send(&mut self, bytes: &[u8]) {
        // The line has no handshake: none of them fails.
        let _ = self.line.bwrite_all(bytes);
    }

    fn poll(&mut self) -> Option<u8> {
        self.feed();
        #[cfg(feature = "update")]
        return crate::received::take();
        #[cfg(not(feature = "update"))]
        self.line.read().ok()
    }

    fn button(&mut self) -> Option<Command> {
        self.buttons.wish()
    }
}
