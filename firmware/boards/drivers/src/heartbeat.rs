//! An LED that shows that the program runs, whether the display works or not.

use crate::Display;
use embedded_hal::digital::OutputPin;
use pantin_figure::surface::{Framebuffer, Layout};

/// The LED changes twice a second.
const HALF_NS: u32 = 500_000_000;

/// A display, and an LED that blinks once a second while the program runs.
#[derive(Debug)]
pub struct Heartbeat<D, P> {
    display: D,
    led: P,
    on: bool,
    /// Since the LED changed.
    ns: u32,
}

impl<D, P: OutputPin> Heartbeat<D, P> {
    /// Turns the LED's pin high, which says that the board is set up.
    pub fn new(display: D, mut led: P) -> Self {
        // A pin that fails has nothing to say.
        let _ = led.set_high();
        Heartbeat { display, led, on: true, ns: 0 }
    }
}

impl<L: Layout, D: Display<L>, P: OutputPin> Display<L> for Heartbeat<D, P> {
    fn present(&mut self, framebuffer: &mut Framebuffer<L>) {
        self.display.present(framebuffer);
    }

    fn pass(&mut self, ns: u32) {
        self.ns = self.ns.saturating_add(ns);
        if self.ns >= HALF_NS {
            // Where more than half a second passes at a time, the LED changes each time.
            self.ns = (self.ns - HALF_NS).min(HALF_NS);
            self.on = !self.on;
            let _ = self.led.set_state(self.on.into());
        }
    }

    fn overlay(&mut self, lines: [&str; 2]) -> bool {
        self.display.overlay(lines)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mono128x64;
    use core::cell::Cell;
    use core::convert::Infallible;
    use embedded_hal::digital::ErrorType;

    struct Led<'a>(&'a Cell<bool>);

    impl ErrorType for Led<'_> {
        type Error = Infallible;
    }

    impl OutputPin for Led<'_> {
        fn set_low(&mut self) -> Result<(), Infallible> {
            self.0.set(false);
            Ok(())
        }

        fn set_high(&mut self) -> Result<(), Infallible> {
            self.0.set(true);
            Ok(())
        }
    }

    #[test]
    fn the_led_blinks_once_a_second_at_any_rate() {
        for rate in [24, 30, 60, 120] {
            let lit = Cell::new(false);
            let mut display = Heartbeat::new(|_: &mut Framebuffer<Mono128x64>| (), Led(&lit));
            assert!(lit.get());
            let (mut changes, mut was) = (0, true);
            for _ in 0..rate * 60 {
                Display::<Mono128x64>::pass(&mut display, 1_000_000_000 / rate);
                changes += i32::from(lit.get() != was);
                was = lit.get();
            }
            assert!((119..=120).contains(&changes), "{changes} changes in a minute at {rate} ticks a second");
        }
    }
}
