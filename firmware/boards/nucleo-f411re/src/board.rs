//! The board: its display, serial line, buttons, timer and watchdog.

#[cfg(feature = "spi")]
use crate::spi_display::{PanicPicture, Picture};
use board_common::cortex_m::SysTick;
use board_common::{Capacity, NbSerial, PanicBoard, SharedBoard, five_buttons, report_restart};
#[cfg(not(feature = "spi"))]
use board_common::{OledPicture as Picture, OledPicture as PanicPicture, oled};
#[cfg(not(feature = "spi"))]
use board_drivers::Heartbeat;
use pantin_app::Board;
use pantin_figure::rotation::Rotation;
#[cfg(feature = "spi")]
use stm32f4xx_hal::gpio::{PA5, PA7, PA9, PB6, PC7};
#[cfg(feature = "buffered")]
use stm32f4xx_hal::interrupt;
use stm32f4xx_hal::pac::Peripherals;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc;
use stm32f4xx_hal::serial::{Config, Serial};

/// The processor's clock, from the internal oscillator, which is exact to 1 %: whether the debug chip provides a clock depends on the board's
/// solder bridges. It is the highest at which the voltage regulator may stay as it is after reset (RM0383, 5.4.1).
pub const CPU_HZ: u32 = 84_000_000;
/// The serial port, which the board's debug chip passes on over USB.
#[cfg(feature = "buffered")]
pub use stm32f4xx_hal::pac::USART2 as Port;
#[cfg(feature = "buffered")]
pub const PORT_INTERRUPT: stm32f4xx_hal::pac::Interrupt = stm32f4xx_hal::pac::Interrupt::USART2;
/// The pins of a display over SPI: chip select, clock, data, data/command, reset. They are D10, D13, D11, D9 and D8.
#[cfg(feature = "spi")]
pub type SpiPins = (PB6, PA5, PA7, PC7, PA9);

#[cfg(feature = "buffered")]
#[interrupt]
fn USART2() {
    crate::uart_rx::receive();
}

/// Sets the board up.
pub fn new(
    parts: Peripherals,
) -> impl Board<Layout = Picture, Rotation = Rotation, Capacity = Capacity> + PanicBoard<PanicPicture> {
    let by_watchdog = crate::watchdog::has_reset(&parts.RCC);
    let mut clocks = parts.RCC.freeze(rcc::Config::hsi().sysclk(CPU_HZ.Hz()));
    let mut watchdog = crate::watchdog::start(parts.IWDG, &parts.DBGMCU);
    let (a, b, c) = (parts.GPIOA.split(&mut clocks), parts.GPIOB.split(&mut clocks), parts.GPIOC.split(&mut clocks));
    let config = Config::default().baudrate(115_200.bps());
    let Ok(serial) = Serial::new(parts.USART2, (a.pa2, a.pa3.internal_pull_up(true)), config, &mut clocks) else {
        unreachable!("the port supports this baud rate")
    };
    #[cfg(feature = "buffered")]
    let serial = crate::uart_rx::listen(serial);
    let mut serial = NbSerial(serial);
    report_restart(&mut serial, by_watchdog);
    #[cfg(not(feature = "spi"))]
    let display = {
        // D15 and D14.
        let bus = crate::i2c::new(parts.I2C1, b.pb8, b.pb9, &mut clocks, &mut serial);
        // The board's own LED, whose pin is the clock of displays over SPI.
        Heartbeat::new(oled(bus), a.pa5.into_push_pull_output())
    };
    #[cfg(feature = "spi")]
    let display = crate::spi_display::new(parts.SPI1, (b.pb6, a.pa5, a.pa7, c.pc7, a.pa9), &mut clocks);
    // D2, D4, D6, D7, and the board's own.
    let buttons = five_buttons([
        a.pa10.into_pull_up_input().erase(),
        b.pb5.into_pull_up_input().erase(),
        b.pb10.into_pull_up_input().erase(),
        a.pa8.into_pull_up_input().erase(),
        c.pc13.into_pull_up_input().erase(),
    ]);
    SharedBoard::new(display, serial, buttons, SysTick::<CPU_HZ>::new(), move || watchdog.feed())
}
