//! The board's display, buttons, timer and line for the program.

use board_common::{Buttons, Pace};
use board_parts::ssd1306::{ADDRESS, Pages, Ssd1306};
use core::fmt::Write;
use core::panic::PanicInfo;
use esp_hal::Blocking;
use esp_hal::gpio::{Input, InputConfig, Pull};
use esp_hal::i2c::master::{self, I2c};
use esp_hal::peripherals::{Peripherals, TIMG0};
use esp_hal::time::{Duration, Instant, Rate};
use esp_hal::timer::timg::{MwdtStage, TimerGroup, Wdt};
use esp_hal::uart::{self, Uart};
use pantin_app::{Board, Command};
use pantin_figure::rotation::Rotation;
use pantin_figure::surface::Framebuffer;

/// The watchdog starts the board anew when the program was stuck for so long.
const PATIENCE: Duration = Duration::from_secs(2);

/// The board.
pub struct Esp32C3 {
    /// SDA on GPIO5, SCL on GPIO6.
    display: Ssd1306<I2c<'static, Blocking>>,
    /// TX on GPIO21, RX on GPIO20.
    line: Uart<'static, Blocking>,
    /// Up, down, left and right on GPIO0, GPIO1, GPIO3 and GPIO4, and for select the board's own, BOOT, on GPIO9: to ground while they are pressed.
    pins: [Input<'static>; 5],
    buttons: Buttons,
    pace: Pace,
    watchdog: Wdt<TIMG0<'static>>,
}

/// Microseconds.
fn now() -> u32 {
    Instant::now().duration_since_epoch().as_micros() as u32
}

impl Esp32C3 {
    /// Sets it up.
    pub fn new(parts: Peripherals) -> Self {
        let (Ok(bus), Ok(line)) = (
            I2c::new(parts.I2C0, master::Config::default().with_frequency(Rate::from_khz(400))),
            Uart::new(parts.UART0, uart::Config::default().with_baudrate(115_200)),
        ) else {
            unreachable!("bus and line can have these rates")
        };
        #[cfg(feature = "update")]
        let mut line = line;
        #[cfg(feature = "update")]
        crate::received::listen(&mut line);
        let pull = InputConfig::default().with_pull(Pull::Up);
        let mut watchdog = TimerGroup::new(parts.TIMG0).wdt;
        watchdog.set_timeout(MwdtStage::Stage0, PATIENCE);
        watchdog.enable();
        Esp32C3 {
            display: Ssd1306::new(bus.with_sda(parts.GPIO5).with_scl(parts.GPIO6), ADDRESS),
            line: line.with_tx(parts.GPIO21).with_rx(parts.GPIO20),
            pins: [
                Input::new(parts.GPIO0, pull),
                Input::new(parts.GPIO1, pull),
                Input::new(parts.GPIO3, pull),
                Input::new(parts.GPIO4, pull),
                Input::new(parts.GPIO9, pull),
            ],
            buttons: Buttons::new(0),
            pace: Pace::new(1),
            watchdog,
        }
    }

    /// Shows a panic's page, and says it over the line.
    pub fn tell(&mut self, page: &mut Framebuffer<Pages>, info: &PanicInfo) {
        let _ = self.display.show(page);
        let _ = write!(self.line, "\r\n{info}\r\n");
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

impl Board for Esp32C3 {
    type Layout = Pages;
    type Rotation = Rotation;
    type Capacity = board_common::Capacity;

    /// A display that does not answer is asked again with the next picture.
    fn present(&mut self, framebuffer: &mut Framebuffer<Pages>) {
        let _ = self.display.show(framebuffer);
        self.feed();
    }

    fn start_timer(&mut self, period_ns: u32) {
        self.pace.start(period_ns, now());
    }

    fn ticks(&mut self) -> u32 {
        self.feed();
        let ticks = self.pace.ticks(now());
        if ticks > 0 {
            let held = self.held();
            self.buttons.look(held);
        }
        ticks
    }

    fn send(&mut self, mut bytes: &[u8]) {
        while !bytes.is_empty() {
            // The line has no handshake: none of them fails.
            let sent = self.line.write(bytes).unwrap_or(bytes.len());
            bytes = bytes.get(sent..).unwrap_or_default();
        }
    }

    fn poll(&mut self) -> Option<u8> {
        self.feed();
        #[cfg(feature = "update")]
        return crate::received::take();
        #[cfg(not(feature = "update"))]
        {
            let mut byte = [0];
            // One that came damaged is left out.
            self.line.read_buffered(&mut byte).ok().filter(|read| *read > 0).map(|_| byte[0])
        }
    }

    fn button(&mut self) -> Option<Command> {
        self.buttons.wish()
    }
}
