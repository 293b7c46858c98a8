//! The board: its display, serial line, buttons, timer and watchdog.

use crate::clocks::{self, CPU_HZ};
use crate::pins::pins;
use crate::rp_hal::fugit::{ExtU32, RateExtU32};
#[cfg(not(feature = "spi"))]
use crate::rp_hal::gpio::{FunctionI2c, InOutPin};
use crate::rp_hal::gpio::{Pins, PullUp};
use crate::rp_hal::pac::Peripherals;
use crate::rp_hal::uart::{DataBits, StopBits, UartConfig, UartPeripheral};
use crate::rp_hal::{Sio, Watchdog};
#[cfg(feature = "spi")]
use crate::spi_display::{PanicPicture, Picture};
use board_common::cortex_m::SysTick;
use board_common::{Capacity, NbSerial, PanicBoard, SharedBoard, five_buttons, report_restart};
#[cfg(not(feature = "spi"))]
use board_common::{OledPicture as Picture, OledPicture as PanicPicture, oled, report_bus};
use board_drivers::Heartbeat;
#[cfg(not(feature = "spi"))]
use board_drivers::i2c_wires::free_wires;
use pantin_app::Board;
use pantin_figure::rotation::Rotation;

const BAUD: u32 = 115_200;
/// The watchdog resets the board when the program hangs for this time.
const WATCHDOG_MS: u32 = 2000;

/// Sets the board up.
pub fn new(
    parts: Peripherals,
) -> impl Board<Layout = Picture, Rotation = Rotation, Capacity = Capacity> + PanicBoard<PanicPicture> {
    let mut resets = parts.RESETS;
    let by_watchdog = parts.WATCHDOG.reason().read().timer().bit_is_set();
    let mut watchdog = Watchdog::new(parts.WATCHDOG);
    let usb_clock = clocks::start(parts.XOSC, parts.CLOCKS, (parts.PLL_SYS, parts.PLL_USB), &mut resets, &mut watchdog);
    // Before all that can hang, but after the clocks, which it needs.
    watchdog.pause_on_debug(true);
    watchdog.start(WATCHDOG_MS.millis());
    let pins = Pins::new(parts.IO_BANK0, parts.PADS_BANK0, Sio::new(parts.SIO).gpio_bank0, &mut resets);
    let ((tx, rx), oled_pins, spi_pins, led, (up, down, left, right, select)) = pins!(parts, pins);
    // One of the two has a display.
    let _ = (&oled_pins, &spi_pins);
    let config = UartConfig::new(BAUD.Hz(), DataBits::Eight, None, StopBits::One);
    // Without an adapter, the pull-up keeps the line idle. A line that is low is one break after the other.
    let (tx, rx) = (tx.into_function(), rx.into_function().into_pull_type::<PullUp>());
    let serial = UartPeripheral::new(parts.UART0, (tx, rx), &mut resets);
    let Ok(serial) = serial.enable(config, CPU_HZ.Hz()) else { unreachable!("the port supports this baud rate") };
    #[cfg(feature = "buffered")]
    let serial = crate::uart_rx::listen(serial);
    let mut serial = NbSerial(serial);
    report_restart(&mut serial, by_watchdog);
    #[cfg(not(feature = "spi"))]
    let display = {
        let (sda, scl, port) = oled_pins;
        let (mut sda, mut scl) = (InOutPin::new(sda.into_pull_up_input()), InOutPin::new(scl.into_pull_up_input()));
        let wires = free_wires(&mut scl, &mut sda, || cortex_m::asm::delay(CPU_HZ / 200_000));
        let (sda, scl) = (sda.release().into_function::<FunctionI2c>(), scl.release().into_function::<FunctionI2c>());
        let bus = crate::rp_hal::I2C::new_controller(port, sda, scl, 400.kHz(), &mut resets, CPU_HZ.Hz());
        let mut bus = crate::i2c::Bus::new(bus);
        report_bus(&mut serial, wires, &mut bus);
        oled(bus)
    };
    #[cfg(feature = "spi")]
    let display = crate::spi_display::new(parts.SPI0, spi_pins, &mut resets);
    #[cfg(feature = "usb")]
    let serial = crate::usb::start(serial, usb_clock, &mut resets);
    #[cfg(not(feature = "usb"))]
    let _ = usb_clock;
    let display = Heartbeat::new(display, led.into_push_pull_output());
    let buttons = five_buttons([
        up.into_pull_up_input().into_dyn_pin(),
        down.into_pull_up_input().into_dyn_pin(),
        left.into_pull_up_input().into_dyn_pin(),
        right.into_pull_up_input().into_dyn_pin(),
        select.into_pull_up_input().into_dyn_pin(),
    ]);
    let feed = move || {
        watchdog.feed();
        #[cfg(feature = "usb")]
        crate::usb::resume();
    };
    SharedBoard::new(display, serial, buttons, SysTick::<CPU_HZ>::new(), feed)
}
