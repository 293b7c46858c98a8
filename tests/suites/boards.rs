//! Boards and images that `cargo xtask test --boards` alone runs: the core of the Pico 2, a Cortex-M33, shows in QEMU what the host shows, and so does the Nucleo's image in
//! Unicorn; the ESP32-C3 maps its flash as it must; a face speaks a sentence on an OLED and on a round display; an image that `cargo xtask images`
//! gives away has the same bytes each time.

use std::path::{Path, PathBuf};

use harness::build::Firmware;
use harness::display::{Depth, Display, Picture, Way};
use harness::download::{self, File};
use harness::icount::FRAME_REGIONS;
use harness::panel::{self, Colour, GC9A01, Mono, Panel, ST7789};
use harness::qemu::{MPS2_AN505, SX1};
use harness::rp2040::{self, OLED, Spi};
use harness::steered::{self, Program};
use harness::stm32::{Outcome, Pin, Request, TARGET};
use harness::{clips, equal, image, paths, pictures, screen, simulator, unicorn};
use pantin_figure::rotation::{Rotation, RotationBackend};
use pantin_figure::rotation_float::FloatRotation;
use pantin_pictures::face::speak;

/// Pictures of our walk, our run, and a face with its body.
const PICTURES: [(&str, usize); 3] = [("walk", 30), ("run", 26), ("greet", 20)];
/// Letters that turn the view and change what is drawn.
const LETTERS: [&[u8]; 12] = [b"v", b"w", b"sss", b"a", b"dd", b"f", b"i", b"l", b"g", b"r", b",", b"+"];

fn plays_as_the_host_does<R: RotationBackend>(features: &str) {
    let clips: Vec<PathBuf> = PICTURES.map(|(name, _)| paths::root().join("motions").join(name).with_extension("ptn")).into();
    let machine = MPS2_AN505;
    let files: Vec<&Path> = clips.iter().map(PathBuf::as_path).collect();
    let firmware = Firmware::featuring(features, machine.name, machine.name, machine.target, &files).unwrap();
    let through = |(_, pictures)| std::iter::repeat_n(&b""[..], pictures - 1).chain([&b"n"[..]]);
    let keys: Vec<&[u8]> = PICTURES.into_iter().flat_map(through).chain(LETTERS).collect();
    let expected = simulator::play::<R>(machine.display.unwrap(), &clips, &[], &keys).unwrap();
    let means: Vec<f64> = equal::shows(machine, &firmware, &expected, &keys).iter().map(|kind| kind.mean()).collect();
    println!("{features}: instructions per frame: {FRAME_REGIONS:?} {means:.0?}");
}

#[test]
fn a_cortex_m33_plays_bodies_and_faces_as_the_host_does() {
    plays_as_the_host_does::<Rotation>("face");
}

#[test]
fn a_cortex_m33_plays_in_floating_point_as_the_host_does() {
    plays_as_the_host_does::<FloatRotation>("face,micromath");
}

#[test]
fn the_phone_is_steered_as_on_the_host() {
    let shown = steered::on_board(SX1, Program::Steer, "lines").unwrap().len();
    assert_eq!(shown, 901);
    println!("{shown} pictures are equal");
}

/// Letters before each of the Nucleo's pictures but the first.
const KEYS: [&[u8]; 5] = [b"", b"", b"w", b"n", b""];

fn nucleo(features: &str) -> Firmware {
    Firmware::featuring(features, "nucleo-f411re", "nucleo-f411re", TARGET, &[]).unwrap()
}

fn request(image: &Firmware, display: Option<u8>) -> Request {
    // USART2, and D10, D9 and D8; there is no crystal.
    let (serial, spi_pins) = (0x4000_4400, ["B6", "C7", "A9"]);
    Request { display, crystal: false, serial, spi_pins, wires: ["B8", "B9"], ..Request::new(image.elf(), &KEYS) }
}

fn shows(outcome: &Outcome, panel: &mut impl Panel, display: Display, change: impl Fn(&Picture) -> Picture) {
    assert!(outcome.done);
    assert_eq!(outcome.faults, [""; 0]);
    let clips = ["walk", "run"].map(|name| paths::root().join("motions").join(name).with_extension("ptn"));
    let expected = simulator::play::<Rotation>(display, &clips, &[], &KEYS).unwrap();
    let shown = panel::pictures(panel, &outcome.stream);
    assert_eq!(shown.len(), expected.len());
    for (shown, (number, expected)) in shown.iter().zip(&expected) {
        assert_eq!(screen::difference(shown, &change(expected)).map(|difference| difference.to_string()), None, "{number}");
    }
    // RM0383, table 5 and 5.4.1: 84 MHz need 2 wait states and at least scale 2, which is the one after reset.
    let last = outcome.switches.last().unwrap();
    assert!(last.core == 84_000_000 && last.wait >= 2 && last.vos >= 2 && last.apb1 <= 50_000_000 && last.apb2 <= 100_000_000);
    assert_eq!(outcome.crystal_polls, 0);
    assert!((outcome.baud / 115_200.0 - 1.0).abs() < 0.01);
    let pin = |mode, drain, speed, pull, function| Pin { mode, drain, speed, pull, function };
    assert_eq!([outcome.pins["PA2"], outcome.pins["PA3"]], [pin(2, 0, 0, 0, 7), pin(2, 0, 0, 1, 7)]);
    for button in ["PA10", "PB5", "PB10", "PA8", "PC13"] {
        assert_eq!(outcome.pins[button], pin(0, 0, 0, 1, 0), "{button}");
    }
}

#[test]
fn the_nucleo_shows_on_the_ssd1306_what_the_host_shows() {
    let outcome = request(&nucleo(""), Some(0x3c)).run().unwrap();
    shows(&outcome, &mut Mono::ssd1306(0x3c), OLED, Picture::clone);
    let bus = Pin { mode: 2, drain: 1, speed: 0, pull: 1, function: 4 };
    assert_eq!([outcome.pins["PB8"], outcome.pins["PB9"]], [bus; 2]);
}

#[test]
fn the_nucleo_shows_on_the_st7789_what_the_host_shows() {
    let outcome = request(&nucleo("st7789"), None).run().unwrap();
    let greys = Display { width: 240, height: 240, depth: Depth::Gray4, way: Way::Bus("spi") };
    shows(&outcome, &mut Colour::new(ST7789), greys, |picture| picture.clone().in_colour());
    assert_eq!(outcome.spi, Spi { mode: 3, hz: 21e6 });
    let spi = Pin { mode: 2, drain: 0, speed: 3, pull: 0, function: 5 };
    assert_eq!([outcome.pins["PA5"], outcome.pins["PA7"]], [spi; 2]);
    let output = Pin { mode: 1, drain: 0, speed: 3, pull: 0, function: 0 };
    assert_eq!([outcome.pins["PB6"], outcome.pins["PC7"]], [output; 2]);
}

/// The Black Pill, as its pictures are of the size that each display shows. The sheets are for who wants to look: target/talking.
#[test]
fn a_face_speaks_on_an_oled_and_on_a_round_display_as_on_the_host() {
    let folder = tempfile::tempdir().unwrap();
    let sentence = speak::keys(&speak::of_text("Hello, my name is Pantin.").unwrap(), "A sentence.");
    let motion = folder.path().join("talking.keys");
    std::fs::write(&motion, sentence).unwrap();
    let clip = clips::convert(&motion, folder.path()).unwrap();
    let keys = vec![&b""[..]; 40];
    let sheets = paths::root().join("target/talking");
    std::fs::create_dir_all(&sheets).unwrap();
    let round = Display { width: 168, height: 168, depth: Depth::Gray4, way: Way::Bus("spi") };
    let whole = Display { width: 240, height: 240, depth: Depth::Rgb565, ..round };
    for (features, address, display) in [("face", Some(0x3c), OLED), ("face,gc9a01", None, round)] {
        let image = Firmware::featuring(features, "blackpill", "blackpill", TARGET, &[&clip]).unwrap();
        let outcome = Request { display: address, ram: 128 << 10, ..Request::new(image.elf(), &keys) }.run().unwrap();
        assert!(outcome.done && outcome.faults.is_empty(), "{:?}", outcome.faults);
        let expected = simulator::play::<Rotation>(display, std::slice::from_ref(&clip), &[], &keys).unwrap();
        let expected = expected.into_iter().map(|(_, picture)| picture);
        let (shown, expected): (Vec<Picture>, Vec<Picture>) = match address {
            Some(address) => (panel::pictures(&mut Mono::ssd1306(address), &outcome.stream), expected.collect()),
            None => {
                let framed = expected.map(|picture| picture.in_colour().framed(whole));
                (panel::pictures(&mut Colour::new(GC9A01), &outcome.stream), framed.collect())
            }
        };
        assert_eq!(shown.len(), expected.len());
        for (number, (shown, expected)) in shown.iter().zip(&expected).enumerate() {
            assert_eq!(screen::difference(shown, expected).map(|difference| difference.to_string()), None, "picture {number}");
        }
        let labelled: Vec<(String, &Picture)> =
            shown.iter().enumerate().step_by(4).map(|(number, picture)| (format!("picture {number}"), picture)).collect();
        let name = if address.is_some() { "ssd1306.png" } else { "gc9a01.png" };
        std::fs::write(sheets.join(name), pictures::sheet(&labelled, 5).unwrap()).unwrap();
    }
}

/// The chip has no emulator that one can install: its processor runs the one function that must not err, with models of what it calls and writes.
#[test]
fn the_esp32_c3_maps_its_slots_with_the_cache_and_interrupts_off() {
    #[derive(serde::Deserialize)]
    struct Mapping {
        steps: Vec<String>,
        faults: Vec<String>,
    }
    let image = Firmware::featuring("update", "esp32-c3", "esp32-c3", "riscv32imc-unknown-none-elf", &[]).unwrap();
    let start = image::function(image.elf(), "Flash>::start").unwrap().to_string();
    let mapping: Mapping = unicorn::run("esp32/map.py", &[image.elf().as_os_str(), start.as_ref()]).unwrap();
    assert_eq!(mapping.faults, [""; 0]);
    // 128 KiB of the flash from 0x3e0000, which lie at 0x3c400000 for the processor: pages of 64 KiB.
    assert_eq!(mapping.steps, ["suspend", "entry 64 0x3e", "entry 65 0x3f", "invalidate 0x3c400000 0x20000", "resume 0x5a"]);
}

#[test]
fn an_image_has_the_same_bytes_each_time_and_none_of_this_machine() {
    let images = download::BOARDS[0].images();
    let folder = tempfile::tempdir().unwrap();
    let clips = clips::own(folder.path(), clips::Drawn::Lines).unwrap();
    let file = images[0].build(&clips).unwrap();
    // Another program of the same folder, after which the first is built again.
    let other = images[2].build(&clips).unwrap();
    let again = images[0].build(&clips).unwrap();
    assert!(file.bytes == again.bytes, "two builds differ");
    let home = std::env::var("HOME").unwrap_or("/nowhere".into());
    for path in [paths::root().to_string_lossy().into_owned(), format!("{home}/.")] {
        for File { name, bytes, .. } in [&file, &other] {
            assert!(!bytes.windows(path.len()).any(|bytes| bytes == path.as_bytes()), "{name} contains {path}");
        }
    }
    let page = download::page(std::slice::from_ref(&file));
    assert!(page.contains("<td>GP4</td>") && page.contains(&file.sum()) && page.contains("BOOTSEL"));
    assert_eq!(download::sums(std::slice::from_ref(&file)), format!("{}  pantin-pico-ssd1306.uf2\n", file.sum()));
    says_why_it_panics_over_usb(&file.bytes);
}

fn says_why_it_panics_over_usb(image: &[u8]) {
    let folder = tempfile::tempdir().unwrap();
    let path: &Path = &folder.path().join("image.uf2");
    std::fs::write(path, image).unwrap();
    let outcome = rp2040::Request::new(path, OLED).pictures(usize::MAX).usb().seconds(0.2).harm("fault").run().unwrap();
    let text = String::from_utf8_lossy(&outcome.usb).into_owned();
    assert!(text.contains("processor fault: an invalid access, or a stack overflow"), "{text:?}");
}
