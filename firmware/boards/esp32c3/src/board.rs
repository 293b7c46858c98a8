//! The board: its display, serial line, buttons, timer and watchdog.

use board_common::{Capacity, OledPicture, PanicBoard, SharedBoard, TickTimer, five_buttons, oled, report_bus, report_restart};
use board_drivers::i2c_wires::free_wires;
use esp_hal::delay::Delay;
use esp_hal::gpio::{AnyPin, DriveMode, Flex, Input, InputConfig, OutputConfig, Pull};
use esp_hal::i2c::master::{self, BusTimeout, I2c, SoftwareTimeout};
use esp_hal::interrupt::wait_for_interrupt;
use esp_hal::peripherals::{Peripherals, SYSTIMER};
use esp_hal::rtc_cntl::SocResetReason;
use esp_hal::system::reset_reason;
use esp_hal::time::{Duration, Instant, Rate};
use esp_hal::timer::PeriodicTimer;
use esp_hal::timer::systimer::SystemTimer;
use esp_hal::timer::timg::{MwdtStage, TimerGroup};
use pantin_app::Board;
use pantin_figure::rotation::Rotation;

/// The frequency of the clock that [`Instant`] counts.
const CLOCK_HZ: u32 = 1_000_000;
/// The watchdog resets the board when the program hangs for this time.
const WATCHDOG: Duration = Duration::from_secs(2);

/// A device may keep the clock low for this many clocks of 400 kHz, 1 ms.
const BUS_CYCLES: u32 = 400;
/// A byte takes 23 us.
const BYTE_TIMEOUT: Duration = Duration::from_millis(2);

/// An interrupt ends the processor's sleep after this time at the latest.
const WAKE_PERIOD: Duration = Duration::from_millis(1);

#[esp_hal::handler]
fn on_wake() {
    SYSTIMER::regs().int_clr().write(|bits| bits.target(0).clear_bit_by_one());
}

/// Sets the board up.
pub fn new(
    parts: Peripherals,
) -> impl Board<Layout = OledPicture, Rotation = Rotation, Capacity = Capacity> + PanicBoard<OledPicture> {
    // Before all that can hang.
    let mut watchdog = TimerGroup::new(parts.TIMG0).wdt;
    watchdog.set_timeout(MwdtStage::Stage0, WATCHDOG);
    watchdog.enable();
    let ((mut sda, mut scl), (tx, rx), (up, down, left, right, select)) = pins!(parts);
    let wires = {
        let (mut sda, mut scl) = (open_drain(sda.reborrow().into()), open_drain(scl.reborrow().into()));
        free_wires(&mut scl, &mut sda, || Delay::new().delay_micros(5))
    };
    let config = master::Config::default()
        .with_frequency(Rate::from_khz(400))
        .with_timeout(BusTimeout::BusCycles(BUS_CYCLES))
        .with_software_timeout(SoftwareTimeout::PerByte(BYTE_TIMEOUT));
    let Ok(i2c) = I2c::new(parts.I2C0, config) else { unreachable!("the bus supports these settings") };
    #[cfg(not(feature = "usb"))]
    let (mut serial, receive) = (crate::uart::new(parts.UART0, tx, rx), || {});
    #[cfg(feature = "usb")]
    let (mut serial, mut receive) = {
        // The pins of the other port stay free.
        let _ = (tx, rx);
        crate::usb::new(parts.USB_DEVICE)
    };
    let by_watchdog = matches!(reset_reason(), Some(SocResetReason::CoreMwdt0 | SocResetReason::Cpu0Mwdt0));
    report_restart(&mut serial, by_watchdog);
    let mut bus = i2c.with_sda(sda).with_scl(scl);
    report_bus(&mut serial, wires, &mut bus);
    let display = oled(bus);
    let pull_up = InputConfig::default().with_pull(Pull::Up);
    let buttons = five_buttons([
        Input::new(up, pull_up),
        Input::new(down, pull_up),
        Input::new(left, pull_up),
        Input::new(right, pull_up),
        Input::new(select, pull_up),
    ]);
    let mut wake = PeriodicTimer::new(SystemTimer::new(parts.SYSTIMER).alarm0);
    wake.set_interrupt_handler(on_wake);
    wake.listen();
    let Ok(()) = wake.start(WAKE_PERIOD) else { unreachable!("the timer supports this period") };
    let now = move || {
        // Held, so that it goes on.
        let _ = &wake;
        Instant::now().duration_since_epoch().as_micros() as u32
    };
    let timer = TickTimer::<CLOCK_HZ, _, _>::new(now, wait_for_interrupt);
    let feed = move || {
        watchdog.feed();
        receive();
    };
    SharedBoard::new(display, serial, buttons, timer, feed)
}

/// A pin of the I2C bus before the bus has it.
fn open_drain(pin: AnyPin<'_>) -> Flex<'_> {
    let mut pin = Flex::new(pin);
    pin.apply_output_config(&OutputConfig::default().with_drive_mode(DriveMode::OpenDrain).with_pull(Pull::Up));
    pin.set_high();
    pin.set_output_enable(true);
    pin.set_input_enable(true);
    pin
}
