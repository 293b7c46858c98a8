//! Milliseconds for `embassy-time` from the core's own timer; a chip's HAL brings a driver of its own.

use core::cell::{Cell, RefCell};
use core::task::Waker;
use cortex_m::peripheral::{SYST, syst::SystClkSource};
use critical_section::Mutex;
use embassy_time_driver::Driver;
use embassy_time_queue_utils::Queue;

struct SysTick {
    now: Mutex<Cell<u64>>,
    queue: Mutex<RefCell<Queue>>,
}

embassy_time_driver::time_driver_impl!(static DRIVER: SysTick = SysTick {
    now: Mutex::new(Cell::new(0)),
    queue: Mutex::new(RefCell::new(Queue::new())),
});

impl Driver for SysTick {
    fn now(&self) -> u64 {
        critical_section::with(|token| self.now.borrow(token).get())
    }

    fn schedule_wake(&self, at: u64, waker: &Waker) {
        critical_section::with(|token| self.queue.borrow_ref_mut(token).schedule_wake(at, waker));
    }
}

/// Starts the timer: a tick each millisecond.
pub fn start(cpu_hz: u32) {
    let mut syst = cortex_m::Peripherals::take().map(|core| core.SYST).expect("nothing else takes them");
    syst.set_clock_source(SystClkSource::Core);
    syst.set_reload(cpu_hz / 1000 - 1);
    syst.enable_counter();
    syst.enable_interrupt();
    let _: SYST = syst;
}

#[cortex_m_rt::exception]
fn SysTick() {
    critical_section::with(|token| {
        let now = DRIVER.now.borrow(token).get() + 1;
        DRIVER.now.borrow(token).set(now);
        DRIVER.queue.borrow_ref_mut(token).next_expiration(now);
    });
}
