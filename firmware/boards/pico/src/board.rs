//! The board's display, buttons, timer and line for the program.

use crate::clocks;
use crate::display::{Display, Lit, Words};
use board_common::cortex_m::SysTick;
use board_common::{Buttons, markers};
use embedded_hal::digital::InputPin;
use pantin_app::{Board, Command};
use pantin_figure::rotation::Rotation;
use pantin_figure::surface::Framebuffer;
use rp2040_hal::fugit::{ExtU32, RateExtU32};
use rp2040_hal::gpio::bank0::{Gpio0, Gpio1};
use rp2040_hal::gpio::{DynPinId, FunctionSio, FunctionUart, Pin, PullDown, PullUp, SioInput};
use rp2040_hal::pac::{Peripherals, UART0};
use rp2040_hal::uart::{self, DataBits, StopBits, UartConfig, UartPeripheral};
use rp2040_hal::{Sio, Watchdog};

/// Bits a second of the line.
const BAUD: u32 = 115_200;
/// The watchdog starts the board anew when the program was stuck for so long, in milliseconds.
const PATIENCE: u32 = 2000;

type Button = Pin<DynPinId, FunctionSio<SioInput>, PullUp>;
type Line = UartPeripheral<uart::Enabled, UART0, (Pin<Gpio0, FunctionUart, PullDown>, Pin<Gpio1, FunctionUart, PullDown>)>;

/// The board.
pub struct Pico {
    display: Display,
    line: Line,
    /// Up, down, left, right and select: GP10 to GP14, to ground while they are pressed.
    pins: [Button; 5],
    buttons: Buttons,
    ticks: SysTick<{ clocks::RATE / 1000 }>,
    watchdog: Watchdog,
}

impl Pico {
    /// Sets it up.
    pub fn new(parts: Peripherals) -> Self {
        let mut resets = parts.RESETS;
        let mut watchdog = Watchdog::new(parts.WATCHDOG);
        clocks::start(parts.XOSC, parts.CLOCKS, (parts.PLL_SYS, parts.PLL_USB), &mut resets, &mut watchdog);
        let pins = rp2040_hal::gpio::Pins::new(parts.IO_BANK0, parts.PADS_BANK0, Sio::new(parts.SIO).gpio_bank0, &mut resets);
        let config = UartConfig::new(BAUD.Hz(), DataBits::Eight, None, StopBits::One);
        let line = UartPeripheral::new(parts.UART0, (pins.gpio0.into_function(), pins.gpio1.into_function()), &mut resets);
        let Ok(line) = line.enable(config, clocks::RATE.Hz()) else { unreachable!("the rate is one that the line can have") };
        #[cfg(feature = "update")]
        let mut line = line;
        #[cfg(feature = "update")]
        crate::received::listen(&mut line);
        #[cfg(not(feature = "st7789"))]
        let display = Display::new(parts.I2C0, pins.gpio4, pins.gpio5, &mut resets);
        #[cfg(feature = "st7789")]
        let display = Display::new(parts.SPI0, (pins.gpio17, pins.gpio18, pins.gpio19, pins.gpio20), &mut resets);
        let pins = [
            pins.gpio10.into_pull_up_input().into_dyn_pin(),
            pins.gpio11.into_pull_up_input().into_dyn_pin(),
            pins.gpio12.into_pull_up_input().into_dyn_pin(),
            pins.gpio13.into_pull_up_input().into_dyn_pin(),
            pins.gpio14.into_pull_up_input().into_dyn_pin(),
        ];
        watchdog.pause_on_debug(true);
        watchdog.start(PATIENCE.millis());
        Pico { display, line, pins, buttons: Buttons::new(0), ticks: SysTick::new(), watchdog }
    }

    /// Shows words.
    pub fn tell(&mut self, page: &mut Framebuffer<Words>) {
        self.display.show(page);
    }

    /// Tells the watchdog that the program goes on.
    pub fn feed(&self) {
        self.watchdog.feed();
    }

    /// Those that are held, each in its bit.
    fn held(&mut self) -> u32 {
        self.pins.iter_mut().rev().fold(0, |held, pin| held << 1 | u32::from(pin.is_low() == Ok(true)))
    }
}

impl Board for Pico {
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
        self.line.write_full_blocking(bytes);
    }

    fn poll(&mut self) -> Option<u8> {
        self.feed();
        #[cfg(feature = "update")]
        return crate::received::take();
        #[cfg(not(feature = "update"))]
        {
            let mut byte = [0];
            self.line.read_raw(&mut byte).ok().map(|_| byte[0])
        }
    }

    fn button(&mut self) -> Option<Command> {
        self.buttons.wish()
    }

    #[inline(always)]
    fn mark_start(&mut self) {
        markers::start();
    }

    #[inline(always)]
    fn mark_stop(&mut self) {
        markers::stop();
    }
}
