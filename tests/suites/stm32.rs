//! The Black Pill's own image in Unicorn, with models of the STM32F411's peripherals: what it writes to them, and the pictures on its displays.

use std::path::PathBuf;

use harness::build::Firmware;
use harness::display::{Depth, Display, Picture, Way};
use harness::panel::{self, Colour, GC9A01, ILI9341, Mono, Panel, ST7789};
use harness::rp2040::{OLED, Spi};
use harness::stm32::{Outcome, Pin, Request, TARGET};
use harness::{paths, screen, setup, simulator};
use pantin_figure::rotation::Rotation;

const KEYS: [&[u8]; 5] = [b"", b"", b"w", b"n", b""];

fn clips() -> [PathBuf; 2] {
    ["walk", "run"].map(|name| paths::root().join("motions").join(name).with_extension("ptn"))
}

fn image(features: &str) -> Firmware {
    // The image of the table of sizes, with our own clips.
    Firmware::featuring(features, "blackpill", "blackpill", TARGET, &[]).unwrap()
}

fn equal(outcome: &Outcome, panel: &mut impl Panel, display: Display, change: impl Fn(Picture) -> Picture) {
    assert!(outcome.done);
    let expected = simulator::play::<Rotation>(display, &clips(), &[], &KEYS).unwrap();
    let shown = panel::pictures(panel, &outcome.stream);
    assert_eq!(shown.len(), expected.len());
    for (index, (shown, (_, expected))) in shown.iter().zip(expected).enumerate() {
        if let Some(difference) = screen::difference(shown, &change(expected)) {
            panic!("picture {index}: {difference}");
        }
    }
}

/// The clocks, and what all displays have in common.
fn is_right(outcome: &Outcome) {
    assert_eq!(outcome.faults, [""; 0]);
    let last = outcome.switches.last().unwrap();
    assert_eq!(last.core, 84_000_000);
    // RM0383, table 5 and 5.4.1: 84 MHz need 2 wait states and at least scale 2, which is the one after reset.
    assert!(last.wait >= 2 && last.vos >= 2);
    assert!((950_000..=2_100_000).contains(&last.input) && (100_000_000..=432_000_000).contains(&last.vco));
    assert!(last.apb1 <= 42_000_000 && last.apb2 <= 84_000_000, "the F401's limits");
    assert!((outcome.baud / 115_200.0 - 1.0).abs() < 0.01);
    let pin = |mode, drain, speed, pull, function| Pin { mode, drain, speed, pull, function };
    assert_eq!(outcome.pins["PA9"], pin(2, 0, 0, 0, 7));
    assert_eq!(outcome.pins["PA10"], pin(2, 0, 0, 1, 7), "the receive pin is pulled up");
    for button in ["PA0", "PB12", "PB13", "PB14", "PB15"] {
        assert_eq!(outcome.pins[button], pin(0, 0, 0, 1, 0));
    }
}

#[test]
fn the_black_pill_shows_on_the_ssd1306_what_the_host_shows() {
    if setup::host_only("the Black Pill's image") {
        return;
    }
    let image = image("");
    for address in [0x3c, 0x3d] {
        let outcome = Request { display: Some(address), ..Request::new(image.elf(), &KEYS) }.run().unwrap();
        is_right(&outcome);
        assert_eq!(outcome.text, format!("I2C: {address:#04x}\r\n"));
        let led = Pin { mode: 1, drain: 0, speed: 0, pull: 0, function: 0 };
        assert_eq!(outcome.pins["PC13"], led);
        assert!(outcome.crystal_polls > 0 && outcome.watchdog_before_crystal);
        let bus = Pin { mode: 2, drain: 1, speed: 0, pull: 1, function: 4 };
        assert_eq!([outcome.pins["PB6"], outcome.pins["PB7"]], [bus; 2]);
        equal(&outcome, &mut Mono::ssd1306(address), OLED, |picture| picture);
    }
}

#[test]
fn the_black_pill_frees_a_bus_and_plays_on_where_it_cannot() {
    if setup::host_only("the Black Pill's wires") {
        return;
    }
    let image = image("");
    let held = Request { held: 5, ..Request::new(image.elf(), &KEYS) }.run().unwrap();
    assert_eq!(held.text, "I2C: a device held SDA low and let go after 5 clocks\r\nI2C: 0x3c\r\n");
    is_right(&held);
    equal(&held, &mut Mono::ssd1306(0x3c), OLED, |picture| picture);
    for ground in ["B6", "B7"] {
        let outcome = Request { ground: Some(ground), ..Request::new(image.elf(), &KEYS) }.run().unwrap();
        assert_eq!(outcome.text, "I2C: SDA or SCL is held low: a wire on GND, or a display without power\r\n");
        is_right(&outcome);
        // Pictures without a byte.
        assert!(outcome.done);
        assert_eq!(outcome.stream, vec![0xffff; KEYS.len() + 1]);
    }
}

#[test]
fn the_black_pill_says_what_hung() {
    if setup::host_only("the Black Pill's restart") {
        return;
    }
    let image = image("");
    // The set-up scans the bus, one byte for each address; the first picture has more than a thousand.
    for (bytes, words) in [(20, "while it set the board up"), (600, "while it sent a picture to the display")] {
        let outcome = Request { hangs_after: Some(bytes), ..Request::new(image.elf(), &KEYS) }.run().unwrap();
        let start = if bytes == 20 { "I2C:" } else { "I2C: 0x3c\r\n" };
        assert_eq!(outcome.text, format!("{start}Restarted by the watchdog: the program hung {words}\r\nI2C: 0x3c\r\n"));
        is_right(&outcome);
        equal(&outcome, &mut Mono::ssd1306(0x3c), OLED, |picture| picture);
    }
}

#[test]
fn the_black_pill_runs_without_a_crystal() {
    if setup::host_only("the Black Pill without a crystal") {
        return;
    }
    let image = image("");
    let outcome = Request { crystal: false, ..Request::new(image.elf(), &KEYS) }.run().unwrap();
    is_right(&outcome);
    // At 16 MHz and at least 5 clocks each: 0.1 s at least, and not for ever.
    assert!((300_000..1_000_000).contains(&outcome.crystal_polls));
    equal(&outcome, &mut Mono::ssd1306(0x3c), OLED, |picture| picture);
}

#[test]
fn the_black_pill_shows_on_the_st7789_what_the_host_shows() {
    if setup::host_only("the Black Pill's SPI") {
        return;
    }
    let image = image("st7789");
    let outcome = Request { display: None, ..Request::new(image.elf(), &KEYS) }.run().unwrap();
    is_right(&outcome);
    assert_eq!(outcome.spi, Spi { mode: 3, hz: 21e6 });
    // Clock and data at the highest speed, as are chip select and data/command; reset may be slow.
    let spi = Pin { mode: 2, drain: 0, speed: 3, pull: 0, function: 5 };
    assert_eq!([outcome.pins["PA5"], outcome.pins["PA7"]], [spi; 2]);
    let output = Pin { mode: 1, drain: 0, speed: 3, pull: 0, function: 0 };
    assert_eq!([outcome.pins["PA4"], outcome.pins["PB0"]], [output; 2]);
    let greys = Display { width: 240, height: 240, depth: Depth::Gray4, way: Way::Bus("spi") };
    equal(&outcome, &mut Colour::new(ST7789), greys, |picture| picture.in_colour());
}

#[test]
fn the_black_pill_shows_on_other_displays_what_the_host_shows() {
    if setup::host_only("the Black Pill's displays") {
        return;
    }
    let greys = |width, height| Display { width, height, depth: Depth::Gray4, way: Way::Bus("spi") };
    let round = image("gc9a01");
    let outcome = Request { display: None, ..Request::new(round.elf(), &KEYS) }.run().unwrap();
    let whole = Display { depth: Depth::Rgb565, ..greys(240, 240) };
    equal(&outcome, &mut Colour::new(GC9A01), greys(168, 168), |picture| picture.in_colour().framed(whole));
    // Its picture needs the STM32F411's RAM.
    let large = image("ili9341");
    let outcome = Request { display: None, ram: 128 << 10, ..Request::new(large.elf(), &KEYS) }.run().unwrap();
    equal(&outcome, &mut Colour::new(ILI9341), greys(240, 320), |picture| picture.in_colour());
}
