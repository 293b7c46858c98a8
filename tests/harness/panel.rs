//! Models of displays' controllers, after their data sheets: what a display shows of the bytes on its bus. They know nothing of the drivers.

use embedded_graphics::pixelcolor::raw::{RawData, RawU16};
use embedded_graphics::pixelcolor::{BinaryColor, Gray4, Rgb565};

use crate::display::{Depth, Display, Picture, Way};

/// Marks in a recorded stream: an address over I2C, the end of a transfer, and the end of a picture.
const ADDRESS: u16 = 0x200;
const STOP: u16 = 0x400;
const PICTURE: u16 = 0xffff;
/// The bit of a byte that was sent over SPI with the data pin high.
const DATA: u16 = 0x100;

/// A display that takes a recorded stream.
pub trait Panel {
    /// Takes a word of a stream.
    fn take(&mut self, word: u16);

    /// Returns what it shows.
    fn picture(&self) -> Picture;
}

/// Returns the pictures that a recorded stream makes.
pub fn pictures(panel: &mut impl Panel, stream: &[u16]) -> Vec<Picture> {
    let mut pictures = vec![];
    for &word in stream {
        match word {
            PICTURE => pictures.push(panel.picture()),
            _ => panel.take(word),
        }
    }
    pictures
}

/// The glass of a colour display, and how it is wired to the controller's memory.
#[derive(Clone, Copy, Debug)]
pub struct Glass {
    /// Columns and rows of the controller's memory.
    pub memory: [usize; 2],
    /// Columns and rows of the glass.
    pub size: [usize; 2],
    /// The place of the glass's first pixel in the memory.
    pub offset: [usize; 2],
    /// The first column is on the right.
    pub mirrored: bool,
    /// Colours are inverted unless the controller inverts them again.
    pub inverted: bool,
    /// The left stripe of a pixel is blue.
    pub bgr: bool,
    /// Only the pixels in the circle exist.
    pub round: bool,
}

/// The ST7789 with 240x240 pixels; others differ in size and offset.
pub const ST7789: Glass =
    Glass { memory: [240, 320], size: [240, 240], offset: [0, 0], mirrored: false, inverted: true, bgr: false, round: false };
/// The ILI9341.
pub const ILI9341: Glass =
    Glass { memory: [240, 320], size: [240, 320], offset: [0, 0], mirrored: true, inverted: false, bgr: true, round: false };
/// The round GC9A01.
pub const GC9A01: Glass =
    Glass { memory: [240, 240], size: [240, 240], offset: [0, 0], mirrored: false, inverted: true, bgr: true, round: true };

/// A controller of the MIPI display command set, as the ST7789, ILI9341 and GC9A01.
pub struct Colour {
    glass: Glass,
    memory: Vec<u16>,
    command: u8,
    arguments: Vec<u8>,
    /// First and last column, and row, of the window.
    window: [[usize; 2]; 2],
    at: [usize; 2],
    mode: u8,
    format: u8,
    is_inverting: bool,
    is_on: bool,
    is_awake: bool,
}

impl Colour {
    /// A display that has just got power: its memory holds anything.
    pub fn new(glass: Glass) -> Self {
        let [wide, high] = glass.memory;
        let memory = (0..wide * high).map(|index| (index * 37) as u16).collect();
        let mut panel = Colour {
            glass,
            memory,
            command: 0,
            arguments: vec![],
            window: [[0; 2]; 2],
            at: [0; 2],
            mode: 0,
            format: 0,
            is_inverting: false,
            is_on: false,
            is_awake: false,
        };
        panel.reset();
        panel
    }

    fn reset(&mut self) {
        let [wide, high] = self.glass.memory;
        (self.window, self.mode, self.format) = ([[0, wide - 1], [0, high - 1]], 0, 6);
        (self.is_inverting, self.is_on, self.is_awake) = (false, false, false);
    }

    fn command(&mut self, command: u8) {
        (self.command, self.arguments) = (command, vec![]);
        match command {
            0x01 => self.reset(),
            0x10 | 0x11 => self.is_awake = command == 0x11,
            0x20 | 0x21 => self.is_inverting = command == 0x21,
            0x28 | 0x29 => self.is_on = command == 0x29,
            0x2c => self.at = self.window.map(|[first, _]| first),
            _ => {}
        }
    }

    fn argument(&mut self, byte: u8) {
        self.arguments.push(byte);
        match (self.command, &*self.arguments) {
            (0x2a | 0x2b, &[a, b, c, d]) => {
                self.window[usize::from(self.command - 0x2a)] = [[a, b], [c, d]].map(|end| u16::from_be_bytes(end).into());
            }
            (0x2c, &[high, low]) => {
                self.write(u16::from_be_bytes([high, low]));
                self.arguments.clear();
            }
            (0x36, &[mode]) => self.mode = mode,
            (0x3a, &[format]) => self.format = format & 7,
            _ => {}
        }
    }

    /// Writes the next pixel of the window: data sheet of the ST7789, 8.12 (memory data write/read direction).
    fn write(&mut self, pixel: u16) {
        let [[left, right], [_, bottom]] = self.window;
        let [column, row] = self.at;
        assert!(row <= bottom, "more pixels than the window has");
        self.at = if column == right { [left, row + 1] } else { [column + 1, row] };
        let [wide, high] = self.glass.memory;
        let has = |bit: u8| self.mode & bit != 0;
        let [x, y] = if has(0x20) { [row, column] } else { [column, row] };
        assert!(x < wide && y < high, "a pixel at {column}, {row} is outside of the memory");
        let (x, y) = (if has(0x40) { wide - 1 - x } else { x }, if has(0x80) { high - 1 - y } else { y });
        self.memory[y * wide + x] = pixel;
    }

    /// What one sees at a place of the glass.
    fn seen(&self, x: usize, y: usize) -> u16 {
        let Glass { memory, size: [wide, high], offset, mirrored, inverted, bgr, round } = self.glass;
        if !(self.is_on && self.is_awake && self.format == 5) || round && !in_circle(wide, high, x, y) {
            return 0;
        }
        let x = if mirrored { wide - 1 - x } else { x };
        let pixel = self.memory[(offset[1] + y) * memory[0] + offset[0] + x];
        let pixel = if self.is_inverting == inverted { pixel } else { !pixel };
        let [red, green, blue] = [pixel >> 11, pixel >> 5 & 63, pixel & 31];
        if (self.mode & 8 != 0) == bgr { pixel } else { blue << 11 | green << 5 | red }
    }
}

fn in_circle(wide: usize, high: usize, x: usize, y: usize) -> bool {
    let [x, y] = [(x, wide), (y, high)].map(|(at, all)| (2 * at + 1) as i64 - all as i64);
    // With the pixel's farthest corner.
    (x.abs() + 1).pow(2) + (y.abs() + 1).pow(2) <= (wide * wide) as i64
}

impl Panel for Colour {
    fn take(&mut self, word: u16) {
        match word & DATA {
            0 => self.command(word as u8),
            _ => self.argument(word as u8),
        }
    }

    fn picture(&self) -> Picture {
        let [width, height] = self.glass.size;
        let display = Display { width, height, depth: Depth::Rgb565, way: Way::Bus("spi") };
        Picture { display, pixels: (0..width * height).map(|index| self.seen(index % width, index / width)).collect() }
    }
}

/// A monochrome display over I2C.
pub struct Mono {
    glass: MonoGlass,
    address: u16,
    memory: Vec<u8>,
    is_lit: bool,
    /// Page and column.
    at: [usize; 2],
    /// The bytes of a transfer to the display.
    transfer: Option<Vec<u8>>,
    /// The last command, and arguments of it that are still to come.
    command: u8,
    skip: usize,
    /// Rows that the controller drives, less one, and how it takes the glass's rows to be wired.
    rows: u8,
    row_pins: u8,
    /// Whether the current comes from the controller's own reference.
    has_current: bool,
}

/// The glass of a monochrome display, and how it is wired.
#[derive(Clone, Copy, Debug)]
struct MonoGlass {
    /// Columns of the memory, and the first that the glass shows.
    columns: [usize; 2],
    /// Columns and rows of the glass.
    size: [usize; 2],
    /// The argument of the command 0xda that says how its rows are wired.
    row_pins: u8,
    /// There is no resistor for the current on the module.
    lacks_resistor: bool,
    is_sh1106: bool,
}

const SSD1306: MonoGlass =
    MonoGlass { columns: [128, 0], size: [128, 64], row_pins: 0x12, lacks_resistor: false, is_sh1106: false };

impl Mono {
    /// An SH1106: 132 columns, of which the glass shows 128 from the third on.
    pub fn sh1106(address: u8) -> Self {
        Self::new(MonoGlass { columns: [132, 2], is_sh1106: true, ..SSD1306 }, address)
    }

    /// An SSD1306.
    pub fn ssd1306(address: u8) -> Self {
        Self::new(SSD1306, address)
    }

    /// An SSD1306 with a glass of 128x32 pixels, whose rows are wired one after the other.
    pub fn of_128x32(address: u8) -> Self {
        Self::new(MonoGlass { size: [128, 32], row_pins: 0x02, ..SSD1306 }, address)
    }

    /// One with a glass of 72x40 pixels, which shows the columns in the middle.
    pub fn of_72x40(address: u8) -> Self {
        Self::new(MonoGlass { columns: [128, 28], size: [72, 40], lacks_resistor: true, ..SSD1306 }, address)
    }

    fn new(glass: MonoGlass, address: u8) -> Self {
        let memory = (0..glass.columns[0] * 8).map(|index| (index * 37) as u8).collect();
        Mono {
            glass,
            address: address.into(),
            memory,
            is_lit: false,
            at: [0; 2],
            transfer: None,
            command: 0,
            skip: 0,
            rows: 63,
            row_pins: 0x12,
            has_current: !glass.lacks_resistor,
        }
    }

    /// Takes a transfer: control bytes, commands and data.
    fn transfer(&mut self, bytes: &[u8]) {
        let mut rest = bytes.iter();
        while let Some(control) = rest.next() {
            assert_eq!(control & 0x3f, 0, "a control byte");
            let is_data = control & 0x40 != 0;
            for &byte in rest.by_ref().take(if control & 0x80 != 0 { 1 } else { usize::MAX }) {
                if is_data { self.write(byte) } else { self.command(byte) }
            }
        }
    }

    fn write(&mut self, byte: u8) {
        let [page, column] = self.at;
        let columns = self.glass.columns[0];
        let index = page * columns + column;
        assert!(column < columns, "a byte in column {column}");
        self.memory[index] = byte;
        self.at[1] += 1;
    }

    fn command(&mut self, code: u8) {
        if self.skip > 0 {
            self.skip -= 1;
            match self.command {
                0xa8 => self.rows = code,
                0xda => self.row_pins = code,
                0xad => self.has_current |= code & 0x30 == 0x30,
                _ => {}
            }
            return;
        }
        self.command = code;
        let MonoGlass { is_sh1106, lacks_resistor, .. } = self.glass;
        match code {
            0x00..=0x0f => self.at[1] = self.at[1] & 0xf0 | usize::from(code),
            0x10..=0x1f => self.at[1] = self.at[1] & 0x0f | usize::from(code & 15) << 4,
            0xb0..=0xb7 => self.at[0] = usize::from(code & 7),
            0xae | 0xaf => self.is_lit = code == 0xaf,
            0x81 | 0xa8 | 0xd3 | 0xd5 | 0xd9 | 0xda | 0xdb => self.skip = 1,
            0xad if is_sh1106 || lacks_resistor => self.skip = 1,
            0x20 | 0x8d if !is_sh1106 => self.skip = 1,
            0x2e if !is_sh1106 => {}
            0x40..=0x7f | 0xa0 | 0xa1 | 0xa4 | 0xa6 | 0xc0 | 0xc8 => {}
            _ => panic!("the controller has no command {code:#04x}"),
        }
    }
}

impl Panel for Mono {
    fn take(&mut self, word: u16) {
        if word & STOP != 0 {
            if let Some(bytes) = self.transfer.take() {
                self.transfer(&bytes);
            }
        } else if word & ADDRESS != 0 {
            self.transfer = (word & 0x7f == self.address).then(Vec::new);
        } else if let Some(bytes) = &mut self.transfer {
            bytes.push(word as u8);
        }
    }

    fn picture(&self) -> Picture {
        let MonoGlass { columns: [columns, first], size: [width, height], row_pins, .. } = self.glass;
        let display = Display { width, height, depth: Depth::Mono, way: Way::Bus("i2c") };
        let is_lit = self.is_lit && self.has_current && (usize::from(self.rows) + 1, self.row_pins) == (height, row_pins);
        let pixel = |index: usize| {
            let (row, column) = (index / width, index % width);
            let at = row / 8 * columns + first + column;
            u16::from(is_lit && self.memory[at] >> (row % 8) & 1 != 0)
        };
        Picture { display, pixels: (0..width * height).map(pixel).collect() }
    }
}

impl Picture {
    /// Returns the picture turned clockwise by a number of right angles.
    pub fn turned(&self, quarters: usize) -> Picture {
        let mut picture = self.clone();
        for _ in 0..quarters % 4 {
            let Display { width, height, .. } = picture.display;
            let display = Display { width: height, height: width, ..picture.display };
            let pixels = (0..width * height).map(|index| picture.pixels[(height - 1 - index % height) * width + index / height]);
            picture = Picture { pixels: pixels.collect(), display };
        }
        picture
    }

    /// Returns the picture in the middle of a larger dark one.
    pub fn framed(&self, display: Display) -> Picture {
        let [x, y] = [display.width - self.display.width, display.height - self.display.height].map(|margin| margin / 2);
        let mut framed = Picture::dark(display);
        for (row, pixels) in self.pixels.chunks_exact(self.display.width).enumerate() {
            let at = (y + row) * display.width + x;
            framed.pixels[at..at + pixels.len()].copy_from_slice(pixels);
        }
        framed
    }

    /// Returns greys or black and white in the colours of RGB565.
    pub fn in_colour(&self) -> Picture {
        let colour = |&value: &u16| {
            let colour: Rgb565 = match self.display.depth {
                Depth::Mono => BinaryColor::from(value != 0).into(),
                Depth::Gray4 => Gray4::new(value as u8).into(),
                Depth::Rgb565 | Depth::Bgr555 => return value,
            };
            RawU16::from(colour).into_inner()
        };
        let display = Display { depth: Depth::Rgb565, ..self.display };
        Picture { display, pixels: self.pixels.iter().map(colour).collect() }
    }
}
