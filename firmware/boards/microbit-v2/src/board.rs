//! The board's display, lights, buttons, timer and line for the program.

use crate::dog;
use crate::leds::{self, Leds};
use crate::line::Line;
use crate::oled::Oled;
use board_common::{Buttons, Pace};
use board_parts::ssd1306::Pages;
use board_parts::tiny;
use embedded_hal::digital::InputPin;
use nrf52833_hal::gpio::{Floating, Input, Level, Pin, p0, p1};
use nrf52833_hal::pac::{Peripherals, TIMER0};
use nrf52833_hal::timer::Periodic;
use nrf52833_hal::wdt::WatchdogHandle;
use nrf52833_hal::wdt::handles::Hdl0;
use nrf52833_hal::{Clocks, Timer};
use pantin_app::{Board, Command};
use pantin_figure::rotation::Rotation;
use pantin_figure::surface::Framebuffer;

/// Counts of the timer a microsecond.
const RATE: u32 = 1;

type Button = Pin<Input<Floating>>;

/// The board.
pub struct Microbit {
    oled: Oled,
    _leds: Leds,
    line: Line,
    /// A and B.
    pins: [Button; 2],
    /// What B was pressed for.
    second: u32,
    buttons: Buttons,
    timer: Timer<TIMER0, Periodic>,
    pace: Pace,
    watchdog: Option<WatchdogHandle<Hdl0>>,
}

impl Microbit {
    /// Sets it up, once.
    pub fn new(parts: Peripherals) -> Self {
        Clocks::new(parts.CLOCK).enable_ext_hfosc();
        let (p0, p1) = (p0::Parts::new(parts.P0), p1::Parts::new(parts.P1));
        let clock = p0.p0_26.into_floating_input().degrade();
        let oled = Oled::new(parts.TWIM0, clock, p1.p1_00.into_floating_input().degrade());
        let rows = [p0.p0_21.degrade(), p0.p0_22.degrade(), p0.p0_15.degrade(), p0.p0_24.degrade(), p0.p0_19.degrade()];
        let columns = [p0.p0_28.degrade(), p0.p0_11.degrade(), p0.p0_31.degrade(), p1.p1_05.degrade(), p0.p0_30.degrade()];
        let out = p0.p0_06.into_push_pull_output(Level::High).degrade();
        let mut timer = Timer::periodic(parts.TIMER0);
        timer.start(u32::MAX);
        Microbit {
            oled,
            _leds: Leds::new(rows, columns, parts.TIMER1),
            line: Line::new(parts.UARTE0, out, p1.p1_08.into_floating_input().degrade()),
            pins: [p0.p0_14.into_floating_input().degrade(), p0.p0_23.into_floating_input().degrade()],
            second: 0,
            buttons: Buttons::new(0),
            timer,
            pace: Pace::new(RATE),
            watchdog: dog::start(parts.WDT),
        }
    }

    /// Tells the watchdog that the program goes on.
    fn feed(&mut self) {
        feed(&mut self.watchdog);
    }

    /// Those that are held, each in the bit of the one it stands for: A is select; B is right, or up where it was pressed after A.
    fn held(&mut self) -> u32 {
        let [a, b] = self.pins.each_mut().map(|pin| pin.is_low() == Ok(true));
        if !b {
            self.second = if a { Buttons::UP } else { Buttons::RIGHT };
        }
        let first = if a { Buttons::SELECT } else { 0 };
        if b { first | self.second } else { first }
    }
}

fn feed(watchdog: &mut Option<WatchdogHandle<Hdl0>>) {
    if let Some(watchdog) = watchdog {
        watchdog.pet();
    }
}

impl Board for Microbit {
    type Layout = Pages;
    type Rotation = Rotation;
    type Capacity = board_common::Capacity;

    fn present(&mut self, framebuffer: &mut Framebuffer<Pages>) {
        leds::set(&tiny(framebuffer));
        self.oled.show(framebuffer);
        self.feed();
    }

    fn start_timer(&mut self, period_ns: u32) {
        self.pace.start(period_ns, self.timer.read());
    }

    fn ticks(&mut self) -> u32 {
        self.feed();
        let ticks = self.pace.ticks(self.timer.read());
        if ticks > 0 {
            let held = self.held();
            self.buttons.look(held);
        }
        ticks
    }

    fn send(&mut self, bytes: &[u8]) {
        self.line.send(bytes);
    }

    fn poll(&mut self) -> Option<u8> {
        self.feed();
        self.line.receive()
    }

    fn button(&mut self) -> Option<Command> {
        self.buttons.wish()
    }
}
