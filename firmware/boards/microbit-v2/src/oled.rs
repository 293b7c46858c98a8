//! The display over I2C. The HAL's driver waits for ever if a wire is held low: the wires are freed first, and read before each transfer.
#![allow(unsafe_code)]

use crate::CPU_HZ;
use crate::nrf_hal::gpio::{Floating, Input, Level, OpenDrainConfig, Pin, Port};
use crate::nrf_hal::pac::{P0, P1, TWIM0, p0};
use crate::nrf_hal::twim::{Frequency, Pins, Twim};
use board_common::OledPicture;
use board_drivers::Ssd1306;
use board_drivers::i2c_wires::{Guarded, Wires, free_wires};
use embedded_hal::i2c::{ErrorKind, I2c};

/// 5 us.
const HALF_CLOCK: u32 = CPU_HZ / 200_000;

/// Sets up the display that the features choose, on a bus that is reported first. The pins get pull-ups, which keep the bus idle without a display.
pub fn new(
    twim: TWIM0,
    scl: Pin<Input<Floating>>,
    sda: Pin<Input<Floating>>,
    report: &mut dyn FnMut(Wires, &mut dyn I2c<Error = ErrorKind>),
) -> Ssd1306<impl I2c + use<>, OledPicture> {
    // A panic may have interrupted a transfer.
    twim.enable.reset();
    let levels = [Wire::of(&scl), Wire::of(&sda)];
    let mut scl = scl.into_open_drain_input_output(OpenDrainConfig::Standard0Disconnect1, Level::High);
    let mut sda = sda.into_open_drain_input_output(OpenDrainConfig::Standard0Disconnect1, Level::High);
    levels.iter().for_each(Wire::pull_up);
    let wires = free_wires(&mut scl, &mut sda, || cortex_m::asm::delay(HALF_CLOCK));
    let pins = Pins { scl: scl.into_floating_input(), sda: sda.into_floating_input() };
    let mut bus = Guarded::new(Twim::new(twim, pins, Frequency::K400), move || levels.iter().all(Wire::is_high));
    report(wires, &mut bus);
    board_common::oled(bus)
}

/// What the HAL does not offer of a pin: its pull-up while it is an output, and its level while the bus has it.
struct Wire {
    port: &'static p0::RegisterBlock,
    number: u8,
}

impl Wire {
    fn of<M>(pin: &Pin<M>) -> Wire {
        let port = match pin.port() {
            Port::Port0 => P0::ptr(),
            Port::Port1 => P1::ptr(),
        };
        // Safety: registers are always there; this type writes only those of pins that the display's module owns.
        Wire { port: unsafe { &*port }, number: pin.pin() }
    }

    fn pull_up(&self) {
        self.port.pin_cnf[usize::from(self.number & 31)].modify(|_, w| w.pull().pullup());
    }

    fn is_high(&self) -> bool {
        self.port.in_.read().bits() >> (self.number & 31) & 1 == 1
    }
}
