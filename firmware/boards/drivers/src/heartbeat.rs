//! An LED that shows that the program runs, whether the display works or not.

use crate::Display;
use embedded_hal::digital::OutputPin;
use pantin_figure::surface::{Framebuffer, Layout};

/// The LED changes after this many pictures: at 30 a second it blinks once a second.
const PICTURES: u8 = 16;

/// A display, and an LED that blinks as pictures are sent to it.
#[derive(Debug)]
pub struct Heartbeat<D, P> {
    display: D,
    led: P,
    on: bool,
    pictures: u8,
}

impl<D, P: OutputPin> Heartbeat<D, P> {
    /// Turns the LED's pin high, which says that the board is set up.
    pub fn new(display: D, mut led: P) -> Self {
        // A pin that fails has nothing to say.
        let _ = led.set_high();
        Heartbeat { display, led, on: true, pictures: 0 }
    }
}

impl<L: Layout, D: Display<L>, P: OutputPin> Display<L> for Heartbeat<D, P> {
    fn present(&mut self, framebuffer: &mut Framebuffer<L>) {
        self.pictures += 1;
        if self.pictures == PICTURES {
            self.pictures = 0;
            self.on = !self.on;
            let _ = self.led.set_state(self.on.into());
        }
        self.display.present(framebuffer);
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
    fn the_led_blinks_with_the_pictures_that_a_display_gets() {
        let (lit, shown) = (Cell::new(false), Cell::new(0));
        let display = |_: &mut Framebuffer<Mono128x64>| shown.set(shown.get() + 1);
        let mut display = Heartbeat::new(display, Led(&lit));
        assert!(lit.get());
        let mut frame = Framebuffer::new();
        let mut was = vec![];
        for _ in 0..48 {
            display.present(&mut frame);
            was.push(lit.get());
        }
        assert_eq!(was, [vec![true; 15], vec![false; 16], vec![true; 16], vec![false; 1]].concat());
        assert_eq!(shown.get(), 48);
    }
}
