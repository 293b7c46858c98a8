//! Colour displays over SPI: ST7789, ILI9341, GC9A01. The crate `mipidsi` sets them up and encodes their commands. This driver sends the rows that
//! changed itself, because `mipidsi` takes pixels one by one, which takes a small processor twice as long.
//!
//! The framebuffer may have any layout whose pixels convert to RGB565. For 240x240 pixels `Rgb565Rows<240, 240, 28800>` takes 115,200 bytes and
//! distinguishes left and right limbs by hue, `Gray4Rows<240, 240, 7200>` takes a quarter of that, `MonoPages<240, 240, 7200>` a sixteenth. A
//! framebuffer that is smaller than the glass is shown in its middle.

use crate::Display;
use core::fmt::Debug;
use embedded_graphics::pixelcolor::Rgb565;
use embedded_graphics::pixelcolor::raw::{RawData, RawU16};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::spi::SpiDevice;
use mipidsi::Builder;
use mipidsi::dcs::{DcsCommand, InterfaceExt, SetAddressMode, SetColumnAddress, SetPageAddress, WriteMemoryStart};
use mipidsi::interface::{Interface, InterfaceKind};
use mipidsi::models::Model;
pub use mipidsi::models::{GC9A01, ILI9341Rgb565 as ILI9341, ST7789};
pub use mipidsi::options::Rotation;
use mipidsi::options::{ColorInversion, ColorOrder, ModelOptions, Orientation};
use pantin_figure::surface::{Cursor, Framebuffer, Layout, Window};

/// The most pixels in a row.
const MAX_WIDTH: usize = 256;

/// How long the reset pin is low, and the time after that until the panel takes commands.
const RESET_LOW_US: u32 = 20;
const RESET_MS: u32 = 120;

/// The bits of a controller's address mode (command 0x36).
const REVERSE_ROWS: u8 = 0x80;
const REVERSE_COLUMNS: u8 = 0x40;
const SWAP_ROWS_AND_COLUMNS: u8 = 0x20;

/// A display module: its controller, and the glass that is wired to it. Sizes and offsets are in pixels, and those of a picture that is
/// not turned.
#[derive(Debug)]
pub struct Module<M> {
    /// Makes `mipidsi`'s model of the controller.
    pub controller: fn() -> M,
    /// The glass's columns and rows.
    pub size: [u16; 2],
    /// The first column and row of the controller's memory that the glass shows.
    pub offset: [u16; 2],
    /// The glass's columns are in the opposite order to the memory's.
    pub mirrored: bool,
    /// The glass shows inverted colours by default, as IPS panels do.
    pub inverted: bool,
    /// The glass's pixels are blue, green and red from the left.
    pub bgr: bool,
    /// How far the picture is turned clockwise on the glass.
    pub rotation: Rotation,
}

/// Square modules of 240x240 pixels, also those without a chip select.
pub const ST7789_240X240: Module<ST7789> = Module {
    controller: || ST7789,
    size: [240, 240],
    offset: [0, 0],
    mirrored: false,
    inverted: true,
    bgr: false,
    rotation: Rotation::Deg0,
};
/// Narrow modules of 135x240 pixels, as on the T-Display and in the Pico display pack.
pub const ST7789_135X240: Module<ST7789> = Module { size: [135, 240], offset: [52, 40], ..ST7789_240X240 };
/// Modules of 170x320 pixels.
pub const ST7789_170X320: Module<ST7789> = Module { size: [170, 320], offset: [35, 0], ..ST7789_240X240 };
/// Modules of 240x320 pixels.
pub const ST7789_240X320: Module<ST7789> = Module { size: [240, 320], ..ST7789_240X240 };
/// Modules of 240x320 pixels with an ILI9341.
pub const ILI9341_240X320: Module<ILI9341> = Module {
    controller: || ILI9341,
    size: [240, 320],
    offset: [0, 0],
    mirrored: true,
    inverted: false,
    bgr: true,
    rotation: Rotation::Deg0,
};
/// Round modules of 240x240 pixels, of which a square of 168x168 is not cut.
pub const GC9A01_240X240: Module<GC9A01> = Module {
    controller: || GC9A01,
    size: [240, 240],
    offset: [0, 0],
    mirrored: false,
    inverted: true,
    bgr: true,
    rotation: Rotation::Deg0,
};

impl<M: Model> Module<M> {
    /// Returns the module with its picture turned clockwise.
    pub const fn rotated(&self, rotation: Rotation) -> Self {
        let Module { controller, size, offset, mirrored, inverted, bgr, rotation: _ } = *self;
        Module { controller, size, offset, mirrored, inverted, bgr, rotation }
    }

    fn options(&self) -> ModelOptions {
        let mut options = ModelOptions::full_size::<M>();
        let first = if self.mirrored { Orientation::new().flip_horizontal() } else { Orientation::new() };
        options.orientation = first.rotate(self.rotation);
        options.color_order = if self.bgr { ColorOrder::Bgr } else { ColorOrder::Rgb };
        options.invert_colors = if self.inverted { ColorInversion::Inverted } else { ColorInversion::Normal };
        options
    }

    /// Returns the address of the glass's first pixel, and the glass's columns and rows, as the picture is turned.
    fn area(&self) -> [[u16; 2]; 2] {
        let mut mode = [0];
        // The command has one byte.
        let _ = SetAddressMode::from(&self.options()).fill_params_buf(&mut mode);
        let has = |bit: u8| mode[0] & bit != 0;
        let ((wide, high), [x, y], [columns, rows]) = (M::FRAMEBUFFER_SIZE, self.offset, self.size);
        let x = if has(REVERSE_COLUMNS) { wide - columns - x } else { x };
        let y = if has(REVERSE_ROWS) { high - rows - y } else { y };
        if has(SWAP_ROWS_AND_COLUMNS) { [[y, x], [rows, columns]] } else { [[x, y], [columns, rows]] }
    }
}

/// An error of the display's bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error<S, D> {
    /// SPI failed.
    Bus(S),
    /// The data/command pin failed.
    Pin(D),
}

/// The bus, and a pin that is high for data. `mipidsi` has the same, but borrows a buffer of pixels as long as the display lives.
#[derive(Debug)]
struct Wires<S, D> {
    bus: S,
    data: D,
}

impl<S: SpiDevice<Error: Debug>, D: OutputPin<Error: Debug>> Interface for Wires<S, D> {
    type Word = u8;
    type Error = Error<S::Error, D::Error>;
    const KIND: InterfaceKind = InterfaceKind::Serial4Line;

    fn send_command(&mut self, command: u8, arguments: &[u8]) -> Result<(), Self::Error> {
        self.data.set_low().map_err(Error::Pin)?;
        self.bus.write(&[command]).map_err(Error::Bus)?;
        self.data.set_high().map_err(Error::Pin)?;
        self.bus.write(arguments).map_err(Error::Bus)
    }

    fn send_pixels<const N: usize>(&mut self, pixels: impl IntoIterator<Item = [u8; N]>) -> Result<(), Self::Error> {
        pixels.into_iter().try_for_each(|pixel| self.bus.write(&pixel).map_err(Error::Bus))
    }

    fn send_repeated_pixel<const N: usize>(&mut self, pixel: [u8; N], count: u32) -> Result<(), Self::Error> {
        self.send_pixels((0..count).map(|_| pixel))
    }
}

/// The display.
#[derive(Debug)]
pub struct ColorPanel<S, D> {
    wires: Wires<S, D>,
    /// The address of the glass's first pixel.
    first: [u16; 2],
    /// The glass's columns and rows.
    size: [u16; 2],
}

impl<S: SpiDevice<Error: Debug>, D: OutputPin<Error: Debug>> ColorPanel<S, D> {
    /// Sets the display up, which takes about 500 ms, and darkens it. The bus has at most 62.5 MHz (an ILI9341 is specified for 10 MHz, and works
    /// at 31 MHz) and SPI mode 3: modules without a chip select need it, and those with one take it too. `data` is the data/command pin, `reset` the
    /// pin of a wire to the panel's RES. Only a module with a chip select may lack that wire, as it is reset by a command too: one without counts the clock's
    /// first rise as a bit, and takes the command for another one. Returns `None` if bus or pin fails.
    pub fn new<M: Model<ColorFormat = Rgb565>>(
        module: Module<M>,
        bus: S,
        data: D,
        reset: &mut impl OutputPin,
        delay: &mut impl DelayNs,
    ) -> Option<Self> {
        // At least 10 us low, then 120 ms until the first command (ST7789V data sheet, 7.4.5).
        reset.set_low().ok()?;
        delay.delay_us(RESET_LOW_US);
        reset.set_high().ok()?;
        delay.delay_ms(RESET_MS);
        let ([first, size], options) = (module.area(), module.options());
        let builder = Builder::new((module.controller)(), Wires { bus, data }).orientation(options.orientation);
        let builder = builder.color_order(options.color_order).invert_colors(options.invert_colors);
        let display = builder.init(delay).ok()?;
        let mut panel = ColorPanel { wires: display.release().0, first, size };
        panel.darken().ok()?;
        Some(panel)
    }

    /// Addresses the pixels that are written next, by their first and last columns and rows on the glass.
    fn address(&mut self, columns: [usize; 2], rows: [usize; 2]) -> Result<(), Error<S::Error, D::Error>> {
        let [[left, right], [top, bottom]] =
            [(columns, self.first[0]), (rows, self.first[1])].map(|(ends, first)| ends.map(|end| end as u16 + first));
        self.wires.write_command(SetColumnAddress::new(left, right))?;
        self.wires.write_command(SetPageAddress::new(top, bottom))?;
        self.wires.write_command(WriteMemoryStart)
    }

    /// Darkens the whole glass: at power-on the memory holds random pixels, and a small framebuffer leaves margins.
    fn darken(&mut self) -> Result<(), Error<S::Error, D::Error>> {
        let [columns, rows] = self.size.map(usize::from);
        self.address([0, columns - 1], [0, rows - 1])?;
        // Not pixel by pixel, since each write takes time of its own.
        const BLOCK: [u8; 64] = [0; 64];
        let mut left = 2 * columns * rows;
        while left > 0 {
            let part = BLOCK.get(..left).unwrap_or(&BLOCK);
            self.wires.bus.write(part).map_err(Error::Bus)?;
            left -= part.len();
        }
        Ok(())
    }

    /// Sends what changed since the last call. Nothing is shown of a framebuffer that is larger than the glass.
    ///
    /// # Errors
    /// Bus or pin failed; the pixels not sent are lost until they change again.
    pub fn show<L: Layout<Ink: Into<Rgb565>>>(&mut self, frame: &mut Framebuffer<L>) -> Result<(), Error<S::Error, D::Error>> {
        const { assert!(L::WIDTH <= MAX_WIDTH) };
        let [columns, rows] = self.size.map(usize::from);
        let (Some(wide), Some(high)) = (columns.checked_sub(L::WIDTH), rows.checked_sub(L::HEIGHT)) else { return Ok(()) };
        let (x, y) = (wide / 2, high / 2);
        let mut buffer = [[0; 2]; MAX_WIDTH];
        for Window { columns: [left, right], rows: [top, bottom] } in frame.send() {
            self.address([x + left, x + right], [y + top, y + bottom])?;
            let row = buffer.get_mut(left..=right).unwrap_or_default();
            for y in top..=bottom {
                encode::<L>(frame.cells(), L::cursor(left, y), row);
                self.wires.bus.write(row.as_flattened()).map_err(Error::Bus)?;
            }
        }
        Ok(())
    }
}

/// Encodes pixels from a cursor to the right as the display takes them: RGB565, high byte first.
#[inline(never)]
fn encode<L: Layout<Ink: Into<Rgb565>>>(cells: &[L::Cell], mut cursor: L::Cursor, row: &mut [[u8; 2]]) {
    for pixel in row {
        let ink: Rgb565 = L::get(cells, cursor).into();
        *pixel = RawU16::from(ink).into_inner().to_be_bytes();
        cursor.across(true);
    }
}

impl<L, S, D> Display<L> for ColorPanel<S, D>
where
    L: Layout<Ink: Into<Rgb565>>,
    S: SpiDevice<Error: Debug>,
    D: OutputPin<Error: Debug>,
{
    fn present(&mut self, framebuffer: &mut Framebuffer<L>) {
        // What is lost is sent when it changes again.
        let _ = self.show(framebuffer);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: usize = 240;
    use embedded_graphics::pixelcolor::{BinaryColor, Gray4, RgbColor};
    use embedded_hal::spi::Operation;
    use pantin_figure::surface::{Gray4Rows, MonoPages, Rgb565Rows, Surface};
    use std::cell::RefCell;
    use std::convert::Infallible;

    /// A panel that keeps what it was sent.
    struct Panel {
        memory: Vec<u16>,
        data: bool,
        command: u8,
        arguments: Vec<u8>,
        commands: Vec<u8>,
        /// First and last column, and row, of the window.
        ends: [[usize; 2]; 2],
        pixels: usize,
    }

    impl Panel {
        fn new() -> Self {
            let memory = vec![0x5a5a; SIDE * SIDE];
            Panel { memory, data: false, command: 0, arguments: vec![], commands: vec![], ends: [[0; 2]; 2], pixels: 0 }
        }

        fn take(&mut self, byte: u8) {
            if !self.data {
                (self.command, self.arguments) = (byte, vec![]);
                self.commands.push(byte);
                self.pixels = if byte == 0x2c { 0 } else { self.pixels };
                return;
            }
            self.arguments.push(byte);
            match (self.command, &*self.arguments) {
                (0x2a, &[a, b, c, d]) => self.window(0, [a, b, c, d]),
                (0x2b, &[a, b, c, d]) => self.window(1, [a, b, c, d]),
                (0x2c, &[high, low]) => {
                    let [[left, right], [top, bottom]] = self.ends;
                    let wide = right - left + 1;
                    let (x, y) = (left + self.pixels % wide, top + self.pixels / wide);
                    assert!(y <= bottom, "more pixels than the window has");
                    self.memory[y * SIDE + x] = u16::from_be_bytes([high, low]);
                    self.pixels += 1;
                    self.arguments = vec![];
                }
                _ => {}
            }
        }

        fn window(&mut self, axis: usize, [a, b, c, d]: [u8; 4]) {
            self.ends[axis] = [[a, b], [c, d]].map(|end| u16::from_be_bytes(end).into());
        }
    }

    /// The bus, and the pin: both ends of one panel.
    struct Bus<'a>(&'a RefCell<Panel>);
    struct Pin<'a>(&'a RefCell<Panel>);

    impl embedded_hal::spi::ErrorType for Bus<'_> {
        type Error = Infallible;
    }

    impl SpiDevice for Bus<'_> {
        fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
            for operation in operations {
                let Operation::Write(bytes) = operation else { panic!("nothing is read") };
                bytes.iter().for_each(|byte| self.0.borrow_mut().take(*byte));
            }
            Ok(())
        }
    }

    impl embedded_hal::digital::ErrorType for Pin<'_> {
        type Error = Infallible;
    }

    impl OutputPin for Pin<'_> {
        fn set_low(&mut self) -> Result<(), Infallible> {
            self.0.borrow_mut().data = false;
            Ok(())
        }

        fn set_high(&mut self) -> Result<(), Infallible> {
            self.0.borrow_mut().data = true;
            Ok(())
        }
    }

    /// The reset pin, and the time: what happened to both.
    #[derive(Default)]
    struct Reset(RefCell<Vec<(&'static str, u32)>>);
    struct ResetPin<'a>(&'a Reset);
    struct Time<'a>(&'a Reset);

    impl embedded_hal::digital::ErrorType for ResetPin<'_> {
        type Error = Infallible;
    }

    impl OutputPin for ResetPin<'_> {
        fn set_low(&mut self) -> Result<(), Infallible> {
            self.0.0.borrow_mut().push(("low", 0));
            Ok(())
        }

        fn set_high(&mut self) -> Result<(), Infallible> {
            self.0.0.borrow_mut().push(("high", 0));
            Ok(())
        }
    }

    impl DelayNs for Time<'_> {
        fn delay_ns(&mut self, nanoseconds: u32) {
            if let Some((_, passed)) = self.0.0.borrow_mut().last_mut() {
                *passed += nanoseconds;
            }
        }
    }

    #[test]
    fn the_reset_pin_is_low_for_10_us_and_120_ms_pass_before_the_first_command() {
        let (panel, reset) = (RefCell::new(Panel::new()), Reset::default());
        ColorPanel::new(ST7789_240X240, Bus(&panel), Pin(&panel), &mut ResetPin(&reset), &mut Time(&reset)).unwrap();
        let [(first, low), (second, high)] = reset.0.borrow()[..] else { panic!("the pin changes twice") };
        assert_eq!((first, second), ("low", "high"));
        assert!((10_000..1_000_000).contains(&low) && high >= 120_000_000);
        assert_eq!(panel.borrow().commands[0], 0x01, "a module whose RES is not wired is reset by a command");
    }

    struct NoTime;

    impl DelayNs for NoTime {
        fn delay_ns(&mut self, _: u32) {}
    }

    /// Shows three pictures of moving squares, and compares the panel's memory with each.
    fn shows<L: Layout<Ink: Into<Rgb565>>>(ink: L::Ink) {
        let panel = RefCell::new(Panel::new());
        let mut display =
            ColorPanel::new(ST7789_240X240, Bus(&panel), Pin(&panel), &mut ResetPin(&Reset::default()), &mut NoTime).unwrap();
        assert!(panel.borrow().commands.contains(&0x29), "it is on");
        let mut frame = Box::new(Framebuffer::<L>::new());
        for at in [0, 100, 220] {
            frame.clear();
            frame.mark([at, at], [at + 19, at + 19]);
            for (x, y) in (0..20).flat_map(|y| (0..20).map(move |x| (at + x, at + y))) {
                frame.put(L::cursor(x as usize, y as usize), ink);
            }
            panel.borrow_mut().commands.clear();
            display.show(&mut frame).unwrap();
            for (index, &shown) in panel.borrow().memory.iter().enumerate() {
                let pixel: Rgb565 = frame.pixel(index % SIDE, index / SIDE).into();
                assert_eq!(shown, RawU16::from(pixel).into_inner(), "pixel {index} at {at}");
            }
        }
        let windows = panel.borrow().commands.iter().filter(|&&command| command == 0x2c).count();
        assert_eq!(windows, 3 + 3, "20 rows from 100 and 20 from 220 touch three bands each");
    }

    #[test]
    fn colours_greys_and_light_are_shown_as_they_are() {
        shows::<Rgb565Rows<240, 240, 28800>>(Rgb565::new(31, 5, 30));
        shows::<Gray4Rows<240, 240, 7200>>(Gray4::new(9));
        shows::<MonoPages<240, 240, 7200>>(BinaryColor::On);
        assert_eq!(Rgb565::from(Gray4::new(15)), Rgb565::WHITE);
        assert_eq!(Rgb565::from(BinaryColor::On), Rgb565::WHITE);
    }
}
