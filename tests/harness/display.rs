//! The displays of the emulated machines, and pictures of them.

use pantin_images::image::Image;

/// The meaning of a pixel's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// 0 dark, 1 lit.
    Mono,
    /// 16 greys, 15 the brightest.
    Gray4,
    /// Five bits of red, six of green, five of blue.
    Rgb565,
    /// Five bits of blue, of green and of red, which are the lowest.
    Bgr555,
}

/// How a display's pictures reach the host.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// QEMU shows it in a window, each pixel magnified by this factor.
    Window(usize),
    /// The firmware sends the changes over the serial port in the format of `pantin_app::frame_stream`.
    Wire,
    /// A model of this display on an emulated bus.
    Bus(&'static str),
}

/// A display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Display {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The pixels' format.
    pub depth: Depth,
    /// How pictures are read.
    pub way: Way,
}

/// The reference machine's display, an SSD0323.
pub const OLED: Display = Display { width: 128, height: 64, depth: Depth::Gray4, way: Way::Window(4) };
/// The same layout without the display.
pub const GREYS: Display = Display { way: Way::Wire, ..OLED };
/// The layout of an SSD1306, without the display.
pub const PAGES: Display = Display { width: 128, height: 64, depth: Depth::Mono, way: Way::Wire };
/// The display of the Siemens SX1.
pub const LCD: Display = Display { width: 176, height: 220, depth: Depth::Rgb565, way: Way::Window(1) };

/// One picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// The display that shows it.
    pub display: Display,
    /// The pixels' values as [`Depth`] says, row by row.
    pub pixels: Vec<u16>,
}

impl Picture {
    /// Makes a dark picture.
    pub fn dark(display: Display) -> Self {
        Picture { display, pixels: vec![0; display.width * display.height] }
    }

    /// Returns whether no pixel is lit.
    pub fn is_dark(&self) -> bool {
        self.pixels.iter().all(|&value| value == 0)
    }

    /// Returns the picture in colours, each pixel magnified by `scale`.
    pub fn image(&self, scale: usize) -> Image {
        let colours = self.pixels.iter().map(|&value| self.display.depth.rgb(value)).collect();
        Image::of(self.display.width, colours).enlarged(scale)
    }
}

impl Depth {
    /// The colour of a value.
    pub fn rgb(self, value: u16) -> [u8; 3] {
        let spread = |bits: u32, low: u32| {
            let most = (1 << bits) - 1;
            ((u32::from(value >> low) & most) * 255 / most) as u8
        };
        match self {
            Depth::Mono => [spread(1, 0); 3],
            Depth::Gray4 => [spread(4, 0); 3],
            Depth::Rgb565 => [spread(5, 11), spread(6, 5), spread(5, 0)],
            Depth::Bgr555 => [spread(5, 0), spread(5, 5), spread(5, 10)],
        }
    }

    /// The brightness of a value, 0 to 255.
    pub fn brightness(self, value: u16) -> u8 {
        let [red, green, blue] = self.rgb(value).map(u32::from);
        ((3 * red + 6 * green + blue) / 10) as u8
    }
}
