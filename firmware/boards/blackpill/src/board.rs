//! The board: its display, serial line, buttons, timer and watchdog.

#[cfg(feature = "spi")]
use crate::spi_display::{PanicPicture, Picture};
use board_common::cortex_m::SysTick;
use board_common::{Capacity, NbSerial, PanicBoard, SharedBoard, five_buttons, report_restart};
#[cfg(not(feature = "spi"))]
use board_common::{OledPicture as Picture, OledPicture as PanicPicture, oled};
use board_drivers::Heartbeat;
use pantin_app::Board;
use pantin_figure::rotation::Rotation;
#[cfg(feature = "spi")]
use stm32f4xx_hal::gpio::{PA4, PA5, PA7, PB0, PB1};
#[cfg(feature = "buffered")]
use stm32f4xx_hal::interrupt;
use stm32f4xx_hal::pac::{Peripherals, RCC};
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc;
use stm32f4xx_hal::serial::{Config, Serial};

const CRYSTAL_HZ: u32 = 25_000_000;
/// The processor's clock: the highest at which the voltage regulator may stay as it is after reset (RM0383, 5.4.1), and that of the STM32F401.
pub const CPU_HZ: u32 = 84_000_000;
const _: () = assert!(CPU_HZ <= 84_000_000, "a higher clock needs PWR_CR.VOS, set while the PLL is off");
/// How often the crystal is asked for: each time takes at least 5 clocks of 16 MHz.
const CRYSTAL_POLLS: u32 = 300_000;
const BAUD: u32 = 115_200;

/// The serial port.
#[cfg(feature = "buffered")]
pub use stm32f4xx_hal::pac::USART1 as Port;
#[cfg(feature = "buffered")]
pub const PORT_INTERRUPT: stm32f4xx_hal::pac::Interrupt = stm32f4xx_hal::pac::Interrupt::USART1;
/// The pins of a display over SPI: chip select, clock, data, data/command, reset.
#[cfg(feature = "spi")]
pub type SpiPins = (PA4, PA5, PA7, PB0, PB1);

#[cfg(feature = "buffered")]
#[interrupt]
fn USART1() {
    crate::uart_rx::receive();
}

/// Sets the board up.
pub fn new(
    parts: Peripherals,
) -> impl Board<Layout = Picture, Rotation = Rotation, Capacity = Capacity> + PanicBoard<PanicPicture> {
    // First of all: it has its own clock.
    let mut watchdog = crate::watchdog::start(parts.IWDG, &parts.DBGMCU);
    let by_watchdog = crate::watchdog::has_reset(&parts.RCC);
    let source = if crystal_starts(&parts.RCC) { rcc::Config::hse(CRYSTAL_HZ.Hz()) } else { rcc::Config::hsi() };
    let mut clocks = parts.RCC.freeze(source.sysclk(CPU_HZ.Hz()));
    let (a, b, c) = (parts.GPIOA.split(&mut clocks), parts.GPIOB.split(&mut clocks), parts.GPIOC.split(&mut clocks));
    // Without an adapter, the pull-up keeps the line idle.
    let serial =
        Serial::new(parts.USART1, (a.pa9, a.pa10.internal_pull_up(true)), Config::default().baudrate(BAUD.bps()), &mut clocks);
    let Ok(serial) = serial else { unreachable!("the port supports this baud rate") };
    #[cfg(feature = "buffered")]
    let serial = crate::uart_rx::listen(serial);
    let mut serial = NbSerial(serial);
    report_restart(&mut serial, by_watchdog);
    #[cfg(not(feature = "spi"))]
    let display = oled(crate::i2c::new(parts.I2C1, b.pb6, b.pb7, &mut clocks, &mut serial));
    #[cfg(feature = "spi")]
    let display = crate::spi_display::new(parts.SPI1, (a.pa4, a.pa5, a.pa7, b.pb0, b.pb1), &mut clocks);
    // The board's own LED.
    let display = Heartbeat::new(display, c.pc13.into_push_pull_output());
    // The last one is the board's own.
    let buttons = five_buttons([
        b.pb12.into_pull_up_input().erase(),
        b.pb13.into_pull_up_input().erase(),
        b.pb14.into_pull_up_input().erase(),
        b.pb15.into_pull_up_input().erase(),
        a.pa0.into_pull_up_input().erase(),
    ]);
    SharedBoard::new(display, serial, buttons, SysTick::<CPU_HZ>::new(), move || watchdog.feed())
}

/// Starts the crystal, and returns whether it runs within about 0.1 s; usual ones take 2 ms. Without one the processor runs from its internal
/// oscillator, whose frequency is exact to 1 %.
fn crystal_starts(clocks: &RCC) -> bool {
    clocks.cr().modify(|_, w| w.hseon().set_bit());
    (0..CRYSTAL_POLLS).any(|_| clocks.cr().read().hserdy().bit_is_set())
}
