//! A display of 128x64 pixels, lit or dark, over I2C: SSD1306.
//!
//! Not by the crate `ssd1306`: over I2C that copies what it sends, 16 bytes a transfer, each with an address and a control byte of
//! its own. Here a page that changed is one transfer, straight from the framebuffer: 8 bytes and its columns.

use embedded_hal::i2c::{I2c, Operation};
use pantin_figure::surface::{BAND, Framebuffer, Layout, MonoPages, Surface};

/// The display's memory.
pub type Pages = MonoPages<128, 64, 1024>;

/// Where a display answers whose address no solder bridge has changed; else it is 0x3d.
pub const ADDRESS: u8 = 0x3c;

/// Control bytes: a command follows, and then another control byte; nothing but commands, or nothing but data follow.
const ONE: u8 = 0x80;
const COMMANDS: u8 = 0x00;
const DATA: u8 = 0x40;

/// Off, then as the data sheet sets up a panel of 64 rows that feeds itself by its charge pump, with the connector above the picture.
const START: [u8; 26] = [
    COMMANDS, 0xae, // off
    0xd5, 0x80, 0xa8, 63, 0xd3, 0, 0x40, // clock, rows, the first of them
    0x8d, 0x14, // charge pump
    0x20, 2, // page by page
    0xa1, 0xc8, 0xda, 0x12, // both directions turned, pins of the rows
    0x81, 0xcf, 0xd9, 0xf1, 0xdb, 0x40, // contrast, charging, level
    0x2e, 0xa4, 0xa6, // still, from memory, lit is 1
];
const LIGHT: [u8; 2] = [COMMANDS, 0xaf];

/// The display.
#[derive(Debug)]
pub struct Ssd1306<B> {
    bus: B,
    address: u8,
    /// It shows what was last sent.
    ready: bool,
}

impl<B: I2c> Ssd1306<B> {
    /// On a bus of at most 400 kHz, at [`ADDRESS`] as a rule. Nothing is sent before the first picture.
    pub fn new(bus: B, address: u8) -> Self {
        Ssd1306 { bus, address, ready: false }
    }

    /// Sends what changed of a picture: after an error all of the next one, so that a display whose plug was loose comes back.
    pub fn show(&mut self, frame: &mut Framebuffer<Pages>) -> Result<(), B::Error> {
        let sent = self.send(frame);
        self.ready = sent.is_ok();
        if !self.ready {
            frame.mark([0, 0], [Pages::WIDTH as i32 - 1, Pages::HEIGHT as i32 - 1]);
        }
        sent
    }

    fn send(&mut self, frame: &mut Framebuffer<Pages>) -> Result<(), B::Error> {
        if !self.ready {
            self.bus.write(self.address, &START)?;
        }
        for window in frame.send() {
            let (column, page) = (window.columns[0] as u8, (window.rows[0] / BAND) as u8);
            let head = [ONE, 0xb0 | page, ONE, column & 15, ONE, 0x10 | column >> 4, DATA];
            for cells in frame.stretches(window) {
                self.bus.transaction(self.address, &mut [Operation::Write(&head), Operation::Write(cells)])?;
            }
        }
        if !self.ready {
            // Not before: its memory holds anything when it gets power.
            self.bus.write(self.address, &LIGHT)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_graphics::pixelcolor::BinaryColor;
    use embedded_hal::i2c::{ErrorKind, ErrorType};

    /// A panel that keeps what it was sent, and counts bytes with their addresses.
    struct Panel {
        memory: [u8; 1024],
        lit: bool,
        bytes: usize,
        plugged: bool,
    }

    impl ErrorType for Panel {
        type Error = ErrorKind;
    }

    impl I2c for Panel {
        fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
            assert_eq!(address, ADDRESS);
            if !self.plugged {
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
                [ONE, page, ONE, low, ONE, high, DATA, ref data @ ..] => {
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
        Ssd1306::new(Panel { memory: [0xaa; 1024], lit: false, bytes: 0, plugged: true }, ADDRESS)
    }

    fn put(frame: &mut Framebuffer<Pages>, x: i32, y: i32) {
        frame.mark([x, y], [x, y]);
        frame.put(Pages::cursor(x as usize, y as usize), BinaryColor::On);
    }

    #[test]
    fn the_first_picture_is_sent_whole_and_then_what_changed() {
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
            assert_eq!(display.bus.bytes, bytes, "a page for the columns that changed in it");
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
        frame.clear();
        put(&mut frame, 7, 7);
        display.show(&mut frame).unwrap();
        assert!(display.bus.lit && display.bus.memory == frame.cells());
    }
}
