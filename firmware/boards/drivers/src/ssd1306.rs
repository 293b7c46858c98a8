//! The SSD1306 and the SH1106: monochrome displays of 128x64 pixels over I2C, and modules with an SSD1306 of 128x32 and 72x40 pixels.
//!
//! The crate `ssd1306` is not used: over I2C it copies what it sends into transfers of 16 bytes, each with an address and a control byte of
//! its own. This driver sends each page that changed in one transfer, straight from the framebuffer: 8 bytes and the page's columns.

use crate::Display;
use core::marker::PhantomData;
use embedded_hal::i2c::{I2c, Operation};
use pantin_figure::surface::{BAND, Framebuffer, MonoPages, Surface};

/// The layout of the memory of most modules.
pub type Mono128x64 = MonoPages<128, 64, 1024>;
/// That of modules half as high: 0.91".
pub type Mono128x32 = MonoPages<128, 32, 512>;
/// That of the smallest modules: 0.42", as on boards with an ESP32-C3.
pub type Mono72x40 = MonoPages<72, 40, 360>;

/// The I2C addresses: the first is that of most modules, a solder bridge changes it to the second.
pub const ADDRESSES: [u8; 2] = [0x3c, 0x3d];

/// Control bytes: one command and then another control byte follow; only commands follow; only data follow.
const ONE_COMMAND: u8 = 0x80;
const COMMANDS: u8 = 0x00;
const DATA: u8 = 0x40;

/// Display off, then the data sheet's set-up of a panel of 64 rows with a charge pump, whose connector is above the picture.
const SET_UP: [u8; 26] = [
    COMMANDS, 0xae, // display off
    0xd5, 0x80, 0xa8, 63, 0xd3, 0, 0x40, // clock divider, last row, row offset, start line
    0x8d, 0x14, // charge pump on
    0x20, 2, // page addressing
    0xa1, 0xc8, 0xda, 0x12, // columns and rows reversed, row pins
    0x81, 0xcf, 0xd9, 0xf1, 0xdb, 0x40, // contrast, precharge, deselect level
    0x2e, 0xa4, 0xa6, // scrolling off, picture from memory, not inverted
];
/// Display off, then the set-up of a panel of 32 rows, which are wired to the controller one after the other.
const SET_UP_128X32: [u8; 26] = [
    COMMANDS, 0xae, // display off
    0xd5, 0x80, 0xa8, 31, 0xd3, 0, 0x40, // clock divider, last row, row offset, start line
    0x8d, 0x14, // charge pump on
    0x20, 2, // page addressing
    0xa1, 0xc8, 0xda, 0x02, // columns and rows reversed, row pins
    0x81, 0x8f, 0xd9, 0xf1, 0xdb, 0x40, // contrast, precharge, deselect level
    0x2e, 0xa4, 0xa6, // scrolling off, picture from memory, not inverted
];
/// Display off, then the set-up of a panel of 40 rows. Its module has no resistor that sets the current: command 0xad chooses the controller's own reference.
const SET_UP_72X40: [u8; 28] = [
    COMMANDS, 0xae, // display off
    0xd5, 0x80, 0xa8, 39, 0xd3, 0, 0x40, // clock divider, last row, row offset, start line
    0x8d, 0x14, // charge pump on
    0xad, 0x30, // internal current reference
    0x20, 2, // page addressing
    0xa1, 0xc8, 0xda, 0x12, // columns and rows reversed, row pins
    0x81, 0xcf, 0xd9, 0x22, 0xdb, 0x20, // contrast, precharge, deselect level
    0x2e, 0xa4, 0xa6, // scrolling off, picture from memory, not inverted
];
/// The glass of 72 columns shows those in the middle.
const FIRST_COLUMN_72X40: u8 = 28;
/// Display off, then the set-up of a panel of 64 rows with an SH1106. Its charge pump has another command than the SSD1306's, and it has no modes of addressing.
const SET_UP_SH1106: [u8; 23] = [
    COMMANDS, 0xae, // display off
    0xd5, 0x80, 0xa8, 63, 0xd3, 0, 0x40, // clock divider, last row, row offset, start line
    0xad, 0x8b, // charge pump on
    0xa1, 0xc8, 0xda, 0x12, // columns and rows reversed, row pins
    0x81, 0xcf, 0xd9, 0xf1, 0xdb, 0x40, // contrast, precharge, deselect level
    0xa4, 0xa6, // picture from memory, not inverted
];
/// An SH1106 has 132 columns, of which the glass shows those in the middle.
const FIRST_COLUMN_SH1106: u8 = 2;
const DISPLAY_ON: [u8; 2] = [COMMANDS, 0xaf];

/// The display, of the layout `L`.
#[derive(Debug)]
pub struct Ssd1306<B, L = Mono128x64> {
    bus: B,
    /// The address that the display answers, or is tried next.
    address: u8,
    set_up: &'static [u8],
    /// The column of the display's memory that the glass shows first.
    first_column: u8,
    /// The display is set up and shows what was last sent.
    ready: bool,
    layout: PhantomData<fn() -> L>,
}

impl<B: I2c> Ssd1306<B> {
    /// Makes a driver for an SSD1306 on a bus of at most 400 kHz. It has one of [`ADDRESSES`]. Nothing is sent before the first picture.
    pub fn new(bus: B) -> Self {
        Ssd1306::of_glass(bus, &SET_UP, 0)
    }

    /// Makes a driver for an SH1106.
    pub fn sh1106(bus: B) -> Self {
        Ssd1306::of_glass(bus, &SET_UP_SH1106, FIRST_COLUMN_SH1106)
    }
}

impl<B: I2c> Ssd1306<B, Mono128x32> {
    /// Makes a driver for a module of 128x32 pixels.
    pub fn of_128x32(bus: B) -> Self {
        Ssd1306::of_glass(bus, &SET_UP_128X32, 0)
    }
}

impl<B: I2c> Ssd1306<B, Mono72x40> {
    /// Makes a driver for a module of 72x40 pixels.
    pub fn of_72x40(bus: B) -> Self {
        Ssd1306::of_glass(bus, &SET_UP_72X40, FIRST_COLUMN_72X40)
    }
}

impl<B: I2c, const W: usize, const H: usize, const BYTES: usize> Ssd1306<B, MonoPages<W, H, BYTES>> {
    fn of_glass(bus: B, set_up: &'static [u8], first_column: u8) -> Self {
        Ssd1306 { bus, address: ADDRESSES[0], set_up, first_column, ready: false, layout: PhantomData }
    }

    /// Sends what changed since the last call. After an error it sets the display up again and sends the whole picture, so that a display
    /// can be unplugged while the program runs.
    ///
    /// # Errors
    /// The bus failed, or the display did not answer.
    pub fn show(&mut self, frame: &mut Framebuffer<MonoPages<W, H, BYTES>>) -> Result<(), B::Error> {
        let sent = self.send(frame);
        self.ready = sent.is_ok();
        if !self.ready {
            frame.mark([0, 0], [W as i32 - 1, H as i32 - 1]);
        }
        sent
    }

    /// Sets the display up, at the address that it answers.
    fn find(&mut self) -> Result<(), B::Error> {
        if self.bus.write(self.address, self.set_up).is_ok() {
            return Ok(());
        }
        let [one, other] = ADDRESSES;
        self.address = if self.address == one { other } else { one };
        self.bus.write(self.address, self.set_up)
    }

    fn send(&mut self, frame: &mut Framebuffer<MonoPages<W, H, BYTES>>) -> Result<(), B::Error> {
        if !self.ready {
            self.find()?;
        }
        for window in frame.send() {
            let (column, page) = (window.columns[0] as u8 + self.first_column, (window.rows[0] / BAND) as u8);
            let head = [ONE_COMMAND, 0xb0 | page, ONE_COMMAND, column & 15, ONE_COMMAND, 0x10 | column >> 4, DATA];
            for cells in frame.stretches(window) {
                self.bus.transaction(self.address, &mut [Operation::Write(&head), Operation::Write(cells)])?;
            }
        }
        if !self.ready {
            // Only now: at power-on the display's memory holds random pixels.
            self.bus.write(self.address, &DISPLAY_ON)?;
        }
        Ok(())
    }
}

impl<B: I2c, const W: usize, const H: usize, const BYTES: usize> Display<MonoPages<W, H, BYTES>>
    for Ssd1306<B, MonoPages<W, H, BYTES>>
{
    fn present(&mut self, framebuffer: &mut Framebuffer<MonoPages<W, H, BYTES>>) {
        // The next picture tries again.
        let _ = self.show(framebuffer);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_graphics::pixelcolor::BinaryColor;
    use embedded_hal::i2c::{ErrorKind, ErrorType};
    use pantin_figure::surface::Layout;

    /// A panel that stores what it was sent, and counts bytes with their addresses.
    struct Panel {
        memory: [u8; 1024],
        lit: bool,
        bytes: usize,
        plugged: bool,
        address: u8,
    }

    impl ErrorType for Panel {
        type Error = ErrorKind;
    }

    impl I2c for Panel {
        fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
            assert!(ADDRESSES.contains(&address));
            if !self.plugged || address != self.address {
                return Err(ErrorKind::Bus);
            }
            let mut bytes = vec![];
            for operation in operations {
                let Operation::Write(part) = operation else { panic!("nothing is read") };
                bytes.extend_from_slice(part);
            }
            self.bytes += 1 + bytes.len();
            match *bytes {
                [COMMANDS, ref commands @ ..] => self.lit = commands.last() == Some(&0xaf),
                [ONE_COMMAND, page, ONE_COMMAND, low, ONE_COMMAND, high, DATA, ref data @ ..] => {
                    assert!((0xb0..0xb8).contains(&page) && low < 16 && (0x10..0x18).contains(&high));
                    let at = usize::from(page & 15) * 128 + usize::from(high & 15) * 16 + usize::from(low);
                    self.memory[at..at + data.len()].copy_from_slice(data);
                }
                ref other => panic!("{other:x?}"),
            }
            Ok(())
        }
    }

    fn panel() -> Ssd1306<Panel> {
        Ssd1306::new(Panel { memory: [0xaa; 1024], lit: false, bytes: 0, plugged: true, address: ADDRESSES[0] })
    }

    fn put(frame: &mut Framebuffer<Mono128x64>, x: i32, y: i32) {
        frame.mark([x, y], [x, y]);
        frame.put(Mono128x64::cursor(x as usize, y as usize), BinaryColor::On);
    }

    #[test]
    fn the_first_picture_is_sent_whole_and_then_only_changes() {
        let (mut display, mut frame) = (panel(), Framebuffer::new());
        put(&mut frame, 0, 0);
        display.show(&mut frame).unwrap();
        assert!(display.bus.lit && display.bus.memory == frame.cells());
        assert_eq!(display.bus.bytes, 27 + 8 * (8 + 128) + 3);
        for (x, bytes) in [(21, (8 + 1) + (8 + 1)), (28, 8 + 8)] {
            frame.clear();
            put(&mut frame, x, 17);
            display.bus.bytes = 0;
            display.show(&mut frame).unwrap();
            assert_eq!(display.bus.memory, frame.cells());
            assert_eq!(display.bus.bytes, bytes, "one transfer for the columns of the page that changed");
        }
    }

    #[test]
    fn a_display_that_was_unplugged_shows_everything_again() {
        let (mut display, mut frame) = (panel(), Framebuffer::new());
        put(&mut frame, 5, 5);
        display.show(&mut frame).unwrap();
        display.bus.plugged = false;
        frame.clear();
        put(&mut frame, 6, 40);
        assert_eq!(display.show(&mut frame), Err(ErrorKind::Bus));
        display.bus = panel().bus;
        // Plugged in again with its solder bridge changed.
        display.bus.address = ADDRESSES[1];
        frame.clear();
        put(&mut frame, 7, 7);
        display.show(&mut frame).unwrap();
        assert!(display.bus.lit && display.bus.memory == frame.cells());
    }
}
