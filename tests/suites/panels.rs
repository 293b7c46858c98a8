//! Displays: each driver's bytes, fed to a model of the controller, make the picture of the framebuffer.

use std::cell::RefCell;
use std::convert::Infallible;
use std::path::PathBuf;

use board_drivers::color_panels::{
    self, ColorPanel, GC9A01_240X240, ILI9341_240X320, Module, Rotation, ST7789_135X240, ST7789_170X320, ST7789_240X240,
    ST7789_240X320,
};
use board_drivers::ssd1306::{ADDRESSES, Ssd1306};
use embedded_graphics::pixelcolor::raw::{RawData, RawU16};
use embedded_graphics::pixelcolor::{BinaryColor, Rgb565};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::i2c::{ErrorKind, I2c, NoAcknowledgeSource, Operation};
use embedded_hal::spi::SpiDevice;
use harness::display::{Depth, Display, Picture, Way};
use harness::panel::{Colour, GC9A01, Glass, ILI9341, Mono, Panel, ST7789};
use harness::{paths, screen, simulator};
use mipidsi::models::Model;
use pantin_figure::surface::{Framebuffer, Gray4Rows, Layout, MonoPages, Rgb565Rows};

/// A bus, its pins and the time, all of which do nothing but pass bytes to a display.
struct Wire<'a, P>(&'a RefCell<(P, bool)>);

impl<P> embedded_hal::spi::ErrorType for Wire<'_, P> {
    type Error = Infallible;
}

impl<P: Panel> SpiDevice for Wire<'_, P> {
    fn transaction(&mut self, operations: &mut [embedded_hal::spi::Operation<'_, u8>]) -> Result<(), Infallible> {
        let (panel, data) = &mut *self.0.borrow_mut();
        for operation in operations {
            let embedded_hal::spi::Operation::Write(bytes) = operation else { panic!("nothing is read") };
            bytes.iter().for_each(|byte| panel.take(u16::from(*data) << 8 | u16::from(*byte)));
        }
        Ok(())
    }
}

impl<P> embedded_hal::digital::ErrorType for Wire<'_, P> {
    type Error = Infallible;
}

impl<P> OutputPin for Wire<'_, P> {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.borrow_mut().1 = false;
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.borrow_mut().1 = true;
        Ok(())
    }
}

struct Nothing;

impl embedded_hal::digital::ErrorType for Nothing {
    type Error = Infallible;
}

impl OutputPin for Nothing {
    fn set_low(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

impl DelayNs for Nothing {
    fn delay_ns(&mut self, _: u32) {}
}

/// A walk and a face in body.
fn clips() -> Vec<PathBuf> {
    ["walk", "greet"].map(|name| paths::root().join("motions").join(name).with_extension("ptn")).into()
}

/// The walk's first frames, one of another view, and the other clip's.
const KEYS: [&[u8]; 8] = [b"", b"", b"", b"w", b"n", b"", b"", b""];

/// Leaves the last picture of a display where someone can look at it, if `PANTIN_PANELS` names a folder.
fn keep(name: &str, picture: &Picture) {
    if let Some(folder) = std::env::var_os("PANTIN_PANELS") {
        let file = std::fs::File::create(PathBuf::from(folder).join(format!("{name}.png"))).unwrap();
        picture.image(1).write_png(file).unwrap();
    }
}

/// Plays on a colour display, and compares what one sees with the framebuffer, turned and in the middle of the glass.
fn shows<M, L>(name: &str, module: Module<M>, glass: Glass, quarters: usize)
where
    M: Model<ColorFormat = Rgb565>,
    L: Layout<Ink: Into<Rgb565>>,
{
    let wires = RefCell::new((Colour::new(glass), false));
    let mut driver = ColorPanel::new(module, Wire(&wires), Wire(&wires), &mut Nothing, &mut Nothing).unwrap();
    let [width, height] = glass.size;
    let whole = Display { width, height, depth: Depth::Rgb565, way: Way::Bus("spi") };
    // As the picture is turned before it is on the glass.
    let before = if quarters.is_multiple_of(2) { whole } else { Display { width: height, height: width, ..whole } };
    let mut count = 0;
    simulator::present::<L>(&clips(), &KEYS, |frame: &mut Framebuffer<L>| {
        driver.show(frame).unwrap();
        let pixels = (0..L::WIDTH * L::HEIGHT).map(|index| {
            let ink: Rgb565 = frame.pixel(index % L::WIDTH, index / L::WIDTH).into();
            RawU16::from(ink).into_inner()
        });
        let display = Display { width: L::WIDTH, height: L::HEIGHT, ..whole };
        let drawn = Picture { display, pixels: pixels.collect() };
        assert!(!drawn.is_dark());
        let shown = wires.borrow().0.picture();
        if let Some(difference) = screen::difference(&shown, &drawn.framed(before).turned(quarters)) {
            panic!("{name}, turned {quarters} times, picture {count}: {difference}");
        }
        count += 1;
        if count == KEYS.len() {
            keep(&format!("{name}-{}", 90 * quarters), &shown);
        }
    })
    .unwrap();
    assert_eq!(count, KEYS.len() + 1);
}

const TURNS: [Rotation; 4] = [Rotation::Deg0, Rotation::Deg90, Rotation::Deg180, Rotation::Deg270];

/// As above, not turned and upside down.
fn upright<M: Model<ColorFormat = Rgb565>, L: Layout<Ink: Into<Rgb565>>>(name: &str, module: Module<M>, glass: Glass) {
    for quarters in [0, 2] {
        shows::<M, L>(name, module.rotated(TURNS[quarters]), glass, quarters);
    }
}

/// As above, on its sides.
fn aside<M: Model<ColorFormat = Rgb565>, L: Layout<Ink: Into<Rgb565>>>(name: &str, module: Module<M>, glass: Glass) {
    for quarters in [1, 3] {
        shows::<M, L>(name, module.rotated(TURNS[quarters]), glass, quarters);
    }
}

#[test]
fn colour_displays_show_the_framebuffer_in_all_rotations() {
    upright::<_, Rgb565Rows<240, 240, 28800>>("st7789", ST7789_240X240, ST7789);
    aside::<_, Rgb565Rows<240, 240, 28800>>("st7789", ST7789_240X240, ST7789);
    let narrow = Glass { size: [135, 240], offset: [52, 40], ..ST7789 };
    upright::<_, Rgb565Rows<134, 240, 16080>>("st7789-135x240", ST7789_135X240, narrow);
    aside::<_, Rgb565Rows<240, 134, 16080>>("st7789-135x240", ST7789_135X240, narrow);
    let tall = Glass { size: [170, 320], offset: [35, 0], ..ST7789 };
    upright::<_, Rgb565Rows<170, 320, 27200>>("st7789-170x320", ST7789_170X320, tall);
    let large = Glass { size: [240, 320], ..ST7789 };
    upright::<_, Rgb565Rows<240, 320, 38400>>("st7789-240x320", ST7789_240X320, large);
    upright::<_, Rgb565Rows<240, 320, 38400>>("ili9341", ILI9341_240X320, ILI9341);
}

#[test]
fn nothing_is_cut_on_a_round_display() {
    upright::<_, Rgb565Rows<168, 168, 14112>>("gc9a01", GC9A01_240X240, GC9A01);
    aside::<_, Rgb565Rows<168, 168, 14112>>("gc9a01", GC9A01_240X240, GC9A01);
}

#[test]
fn greys_and_the_panic_screen_have_the_same_place() {
    let narrow = Glass { size: [135, 240], offset: [52, 40], ..ST7789 };
    upright::<_, Gray4Rows<128, 240, 3840>>("st7789-135x240-greys", ST7789_135X240, narrow);
    upright::<_, MonoPages<134, 240, 4020>>("st7789-135x240-mono", ST7789_135X240, narrow);
    upright::<_, Gray4Rows<240, 320, 9600>>("ili9341-greys", ILI9341_240X320, ILI9341);
    upright::<_, Gray4Rows<168, 168, 3528>>("gc9a01-greys", GC9A01_240X240, GC9A01);
}

#[test]
fn a_framebuffer_larger_than_the_glass_shows_nothing() {
    let wires = RefCell::new((Colour::new(Glass { size: [135, 240], offset: [52, 40], ..ST7789 }), false));
    let mut driver =
        ColorPanel::new(color_panels::ST7789_135X240, Wire(&wires), Wire(&wires), &mut Nothing, &mut Nothing).unwrap();
    simulator::present::<Rgb565Rows<240, 240, 28800>>(&clips(), &[b""], |frame| driver.show(frame).unwrap()).unwrap();
    assert!(wires.borrow().0.picture().is_dark());
}

/// A bus with a display of an address on it.
struct Bus<'a>(&'a RefCell<Mono>, u8);

impl embedded_hal::i2c::ErrorType for Bus<'_> {
    type Error = ErrorKind;
}

impl I2c for Bus<'_> {
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        if address != self.1 {
            return Err(ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address));
        }
        let mut panel = self.0.borrow_mut();
        panel.take(0x200 | u16::from(address));
        for operation in operations {
            let Operation::Write(bytes) = operation else { panic!("nothing is read") };
            bytes.iter().for_each(|byte| panel.take((*byte).into()));
        }
        panel.take(0x400);
        Ok(())
    }
}

#[test]
fn monochrome_displays_are_found_at_both_addresses() {
    for address in ADDRESSES {
        monochrome("ssd1306", Mono::ssd1306(address), address, Ssd1306::new);
        monochrome("sh1106", Mono::sh1106(address), address, Ssd1306::sh1106);
        monochrome("ssd1306-128x32", Mono::of_128x32(address), address, Ssd1306::of_128x32);
        monochrome("ssd1306-72x40", Mono::of_72x40(address), address, Ssd1306::of_72x40);
    }
}

/// Plays on a monochrome display at an address, and compares what one sees with the framebuffer.
fn monochrome<const W: usize, const H: usize, const BYTES: usize>(
    name: &str,
    panel: Mono,
    address: u8,
    driver: fn(Bus<'static>) -> Ssd1306<Bus<'static>, MonoPages<W, H, BYTES>>,
) {
    // Not outlived by the driver.
    let panel: &'static RefCell<Mono> = Box::leak(Box::new(RefCell::new(panel)));
    let mut driver = driver(Bus(panel, address));
    let mut count = 0;
    simulator::present::<MonoPages<W, H, BYTES>>(&clips(), &KEYS, |frame| {
        driver.show(frame).unwrap();
        let shown = panel.borrow().picture();
        let pixels = (0..W * H).map(|index| (frame.pixel(index % W, index / W) == BinaryColor::On).into());
        let drawn = Picture { display: shown.display, pixels: pixels.collect() };
        assert_eq!((shown.display.width, shown.display.height), (W, H));
        if let Some(difference) = screen::difference(&shown, &drawn) {
            panic!("{name} at {address:#x}, picture {count}: {difference}");
        }
        assert!(!shown.is_dark());
        count += 1;
        keep(name, &shown);
    })
    .unwrap();
}
