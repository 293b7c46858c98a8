//! Drivers that do nothing, so that the template builds. Remove this file once nothing uses it.

use core::convert::Infallible;
use embedded_hal::digital::{self, InputPin, OutputPin};
use embedded_hal::i2c::{self, I2c, NoAcknowledgeSource, Operation};
use embedded_hal_nb::nb::{self, Error::WouldBlock};
use embedded_hal_nb::serial::{self, Read, Write};

/// An I2C bus on which nothing answers.
pub struct Bus;

impl i2c::ErrorType for Bus {
    type Error = i2c::ErrorKind;
}

impl I2c for Bus {
    fn transaction(&mut self, _: u8, _: &mut [Operation<'_>]) -> Result<(), i2c::ErrorKind> {
        Err(i2c::ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address))
    }
}

/// A serial port that drops what is sent and receives nothing.
pub struct Port;

impl serial::ErrorType for Port {
    type Error = serial::ErrorKind;
}

impl Write for Port {
    fn write(&mut self, _: u8) -> nb::Result<(), serial::ErrorKind> {
        Ok(())
    }

    fn flush(&mut self) -> nb::Result<(), serial::ErrorKind> {
        Ok(())
    }
}

impl Read for Port {
    fn read(&mut self) -> nb::Result<u8, serial::ErrorKind> {
        Err(WouldBlock)
    }
}

/// The pin of a button that is never pressed, and of an LED that never shines.
#[derive(Clone, Copy)]
pub struct Pin;

impl digital::ErrorType for Pin {
    type Error = Infallible;
}

impl InputPin for Pin {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(true)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(false)
    }
}

impl OutputPin for Pin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}
