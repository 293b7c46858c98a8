//! Wires of an I2C bus that something holds low: a display that was reset amid a byte, a wire on ground, a display without power.

use embedded_hal::digital::{InputPin, OutputPin};
use embedded_hal::i2c::{ErrorKind, ErrorType, I2c, Operation};

/// The most clocks that a device waits for before it lets go of the data wire: the rest of a byte, and the acknowledgement (UM10204, 3.1.16).
const MOST_CLOCKS: u8 = 9;

/// What the wires were like before the bus was set up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wires {
    /// Both are high.
    Idle,
    /// A device held the data wire, and let go of it after this number of clocks.
    Freed(u8),
    /// Something holds a wire low.
    Held,
}

/// Sends clocks until no device holds the data wire, then a stop. The pins are open-drain outputs with pull-ups; `wait` takes about 5 us, half a
/// clock of the slowest devices. It takes at most 0.2 ms.
pub fn free_wires<C, D>(scl: &mut C, sda: &mut D, mut wait: impl FnMut()) -> Wires
where
    C: InputPin + OutputPin,
    D: InputPin + OutputPin,
{
    // Pins of these chips cannot fail.
    let (_, _) = (scl.set_high(), sda.set_high());
    wait();
    if !scl.is_high().unwrap_or(false) {
        return Wires::Held;
    }
    let mut clocks = 0;
    while !sda.is_high().unwrap_or(false) {
        if clocks == MOST_CLOCKS {
            return Wires::Held;
        }
        clocks += 1;
        let _ = scl.set_low();
        wait();
        let _ = scl.set_high();
        wait();
    }
    if clocks == 0 {
        return Wires::Idle;
    }
    // A stop: the data wire rises while the clock is high.
    let _ = scl.set_low();
    wait();
    let _ = sda.set_low();
    wait();
    let _ = scl.set_high();
    wait();
    let _ = sda.set_high();
    wait();
    Wires::Freed(clocks)
}

/// How often both wires are read until the bus counts as held: the stop of the transfer before takes some microseconds.
const MOST_READS: u16 = 1000;

/// A bus whose driver waits for ever if a wire is held low: each transfer begins only when both wires are high. `W` returns whether they are.
pub struct Guarded<B, W> {
    bus: B,
    are_high: W,
}

impl<B: I2c, W: FnMut() -> bool> Guarded<B, W> {
    /// Guards a bus.
    pub fn new(bus: B, are_high: W) -> Self {
        Guarded { bus, are_high }
    }
}

impl<B, W> ErrorType for Guarded<B, W> {
    type Error = ErrorKind;
}

impl<B: I2c, W: FnMut() -> bool> I2c for Guarded<B, W> {
    /// # Errors
    /// [`ErrorKind::Bus`] if a wire is held low; what the bus itself reports.
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        use embedded_hal::i2c::Error;
        if !(0..MOST_READS).any(|_| (self.are_high)()) {
            return Err(ErrorKind::Bus);
        }
        self.bus.transaction(address, operations).map_err(|error| error.kind())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::convert::Infallible;
    use embedded_hal::digital;
    use std::cell::RefCell;
    use std::rc::Rc;

    /// Two wires with a device that holds the data wire for some clocks, or a wire for ever.
    struct Bus {
        scl: bool,
        sda: bool,
        clocks: u32,
        held: u32,
        ground: Option<Line>,
        stops: u32,
    }

    #[derive(Clone, Copy, PartialEq)]
    enum Line {
        Scl,
        Sda,
    }

    impl Bus {
        fn level(&self, line: Line) -> bool {
            self.ground != Some(line)
                && match line {
                    Line::Scl => self.scl,
                    Line::Sda => self.sda && self.clocks >= self.held,
                }
        }

        fn set(&mut self, line: Line, high: bool) {
            let before = [Line::Scl, Line::Sda].map(|line| self.level(line));
            match line {
                Line::Scl => {
                    self.clocks += u32::from(self.scl && !high);
                    self.scl = high;
                }
                Line::Sda => self.sda = high,
            }
            self.stops += u32::from(before == [true, false] && line == Line::Sda && self.level(Line::Sda));
        }
    }

    struct Pin(Rc<RefCell<Bus>>, Line);

    impl digital::ErrorType for Pin {
        type Error = Infallible;
    }

    impl OutputPin for Pin {
        fn set_low(&mut self) -> Result<(), Infallible> {
            self.0.borrow_mut().set(self.1, false);
            Ok(())
        }
        fn set_high(&mut self) -> Result<(), Infallible> {
            self.0.borrow_mut().set(self.1, true);
            Ok(())
        }
    }

    impl InputPin for Pin {
        fn is_high(&mut self) -> Result<bool, Infallible> {
            Ok(self.0.borrow().level(self.1))
        }
        fn is_low(&mut self) -> Result<bool, Infallible> {
            Ok(!self.0.borrow().level(self.1))
        }
    }

    /// What is found, and the clocks, stops and waits that it took.
    fn freed(held: u32, ground: Option<Line>) -> (Wires, u32, u32, u32) {
        let bus = Rc::new(RefCell::new(Bus { scl: true, sda: true, clocks: 0, held, ground, stops: 0 }));
        let mut waits = 0;
        let wires = free_wires(&mut Pin(bus.clone(), Line::Scl), &mut Pin(bus.clone(), Line::Sda), || waits += 1);
        let bus = bus.borrow();
        assert!(bus.scl && bus.sda, "both pins are let go");
        (wires, bus.clocks, bus.stops, waits)
    }

    #[test]
    fn an_idle_bus_is_left_alone() {
        assert_eq!(freed(0, None), (Wires::Idle, 0, 0, 1));
    }

    #[test]
    fn a_device_that_holds_the_data_wire_is_clocked_free() {
        for held in 1..=9 {
            let (wires, _, stops, waits) = freed(held, None);
            assert_eq!((wires, stops), (Wires::Freed(held as u8), 1));
            assert!(waits * 5 <= 200);
        }
        assert_eq!(freed(10, None).0, Wires::Held);
    }

    #[test]
    fn a_wire_on_ground_is_found() {
        assert_eq!(freed(0, Some(Line::Sda)), (Wires::Held, 9, 0, 19));
        assert_eq!(freed(0, Some(Line::Scl)), (Wires::Held, 0, 0, 1));
    }

    /// A driver that would wait for ever.
    struct Driver(Rc<RefCell<bool>>, usize);

    impl ErrorType for Driver {
        type Error = ErrorKind;
    }

    impl I2c for Driver {
        fn transaction(&mut self, _: u8, _: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
            assert!(*self.0.borrow(), "a transfer begins only on an idle bus");
            self.1 += 1;
            Ok(())
        }
    }

    #[test]
    fn a_transfer_on_a_held_bus_is_an_error() {
        let idle = Rc::new(RefCell::new(true));
        let mut bus = Guarded::new(Driver(idle.clone(), 0), || *idle.borrow());
        assert_eq!(bus.write(0x3c, &[0]), Ok(()));
        *idle.borrow_mut() = false;
        assert_eq!(bus.write(0x3c, &[0]), Err(ErrorKind::Bus));
        *idle.borrow_mut() = true;
        assert_eq!(bus.write(0x3c, &[0]), Ok(()));
        assert_eq!(bus.bus.1, 2);
    }

    #[test]
    fn the_stop_of_the_transfer_before_is_waited_for() {
        let mut reads = 0;
        let mut bus = Guarded::new(Driver(Rc::new(RefCell::new(true)), 0), || {
            reads += 1;
            reads > 20
        });
        assert_eq!(bus.write(0x3c, &[0]), Ok(()));
    }
}
