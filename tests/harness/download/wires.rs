//! Which pin of a part goes to which pin of a board. A test compares the pins with those of the boards' crates and READMEs.

use super::Format;

/// How a display is connected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bus {
    /// By two wires: SSD1306, SH1106.
    I2c,
    /// By five: the colour displays.
    Spi,
}

/// The wires of a part.
#[derive(Debug)]
pub struct Wiring {
    /// The part.
    pub part: &'static str,
    /// The bus, if the part is a display.
    pub bus: Option<Bus>,
    /// The part's pins, and the board's.
    pub wires: &'static [[&'static str; 2]],
    /// The file of the board's crate that sets the pins up, and the code that does, with `{}` in place of each pin.
    pub source: [&'static str; 2],
}

/// A board that images are made for.
#[derive(Debug)]
pub struct Board {
    /// What commands and files call it.
    pub name: &'static str,
    /// Its package, and the name of its program.
    pub package: &'static str,
    /// Its set of pins, if it is another than the package's first: the feature `pins-...` without that prefix.
    pub pins: Option<&'static str>,
    /// The only displays that it takes, by name; none if it takes all of its buses.
    pub displays: &'static [&'static str],
    /// How far the picture is turned on these displays, in degrees.
    pub rotation: u16,
    /// Its folder under `firmware/boards`.
    pub folder: &'static str,
    /// Its name.
    pub title: &'static str,
    /// The Rust target.
    pub target: &'static str,
    /// How it takes an image.
    pub format: Format,
    /// Features of all of its images.
    pub features: &'static str,
    /// Programs beside that of the package's name, for the first display.
    pub programs: &'static [&'static str],
    /// How an image gets onto it, in HTML. `FILE` is the image.
    pub flashing: &'static str,
    /// The pins that a display is supplied from: 3.3 V and ground.
    pub supply: [&'static str; 2],
    /// The wires of each part. Without any, the display is the board's own.
    pub wirings: &'static [Wiring],
}

impl Board {
    /// How the board's crate names a pin.
    pub fn spelled(&self, pin: &str) -> String {
        match (self.package, pin) {
            ("pico" | "pico2", _) => pin.replace("GP", "$pins.gpio"),
            ("blackpill" | "nucleo-f411re", _) => pin.replace("PA", "a.pa").replace("PB", "b.pb").replace("PC", "c.pc"),
            ("nrf52840-dk", _) => pin.replace("P0.", "$p0.p0_").replace("P1.", "$p1.p1_"),
            // Schematic of the micro:bit v2.
            ("microbit-v2", "P19") => "p0.p0_26".into(),
            ("microbit-v2", "P20") => "p1.p1_00".into(),
            _ => pin.into(),
        }
    }
}

const I2C_PART: &str = "SSD1306 or SH1106";
const SPI_PART: &str = "colour display (BL, the light, goes to 3.3 V; a module without CS works too, with RES at its pin)";
const BUTTONS: &str = "buttons to GND (optional)";
const SERIAL: &str = "serial adapter, 3.3 V, 115200 baud (optional)";

/// The Pico 2 has the Pico's pins, and shares its module.
const PICO_SOURCE: &str = "../pico/src/pins.rs";
const PICO_SUPPLY: [&str; 2] = ["3V3 (OUT)", "GND"];
/// What stands in a table of pins of the RP2040 and the RP2350.
const RP_I2C: &str = "// SDA, SCL, and their bus. ({}, {}, $parts.I2C";
const RP_SERIAL: &str = "// TX and RX. ({}, {})";
const RP_BUTTONS: &str = "// Up, down, left, right and select. ({}, {}, {}, {}, {})";
const PICO_I2C: Wiring =
    Wiring { part: I2C_PART, bus: Some(Bus::I2c), wires: &[["SDA", "GP4"], ["SCL", "GP5"]], source: [PICO_SOURCE, RP_I2C] };
const PICO_SPI: Wiring = Wiring {
    part: SPI_PART,
    bus: Some(Bus::Spi),
    wires: &[["CS", "GP17"], ["SCL (SCK)", "GP18"], ["SDA (MOSI)", "GP19"], ["DC", "GP20"], ["RES", "GP21"]],
    source: [PICO_SOURCE, "reset of a display over SPI. ({}, {}, {}, {}, {})"],
};
const PICO_BUTTONS: Wiring = Wiring {
    part: BUTTONS,
    bus: None,
    wires: &[["up", "GP10"], ["down", "GP11"], ["left", "GP12"], ["right", "GP13"], ["select", "GP14"]],
    source: [PICO_SOURCE, RP_BUTTONS],
};
const PICO_SERIAL: Wiring =
    Wiring { part: SERIAL, bus: None, wires: &[["RX", "GP0"], ["TX", "GP1"]], source: [PICO_SOURCE, RP_SERIAL] };

const ESP_I2C: [&str; 2] = ["src/pins.rs", "// SDA and SCL. ($parts.{}, $parts.{})"];
const ESP_SERIAL: [&str; 2] = ["src/pins.rs", "// TX and RX. ($parts.{}, $parts.{})"];
const ESP_BUTTONS: [&str; 2] =
    ["src/pins.rs", "which is the board's own, BOOT. ($parts.{}, $parts.{}, $parts.{}, $parts.{}, $parts.{})"];

const ESP32_C3_BUTTONS: Wiring = Wiring {
    part: BUTTONS,
    bus: None,
    wires: &[["up", "GPIO0"], ["down", "GPIO1"], ["left", "GPIO3"], ["right", "GPIO4"], ["select, on the board: BOOT", "GPIO9"]],
    source: ESP_BUTTONS,
};

/// The boards that one can buy, and the Game Boy Advance.
pub const BOARDS: [Board; 9] = [
    Board {
        name: "pico",
        package: "pico",
        pins: None,
        displays: &[],
        rotation: 0,
        folder: "pico",
        title: "Raspberry Pi Pico",
        target: "thumbv6m-none-eabi",
        format: Format::Uf2,
        features: "face,bank,events,usb",
        programs: &["servo"],
        flashing: "Hold BOOTSEL while you plug the board in, and drag <code>FILE</code> onto the drive RPI-RP2. The board's USB port is then a serial \
                   port (<code>/dev/ttyACM0</code>, <code>COM3</code>): <code>cargo pantin update walk.ptn --to serial:/dev/ttyACM0</code> \
                   gives it another clip.",
        supply: PICO_SUPPLY,
        wirings: &[
            PICO_I2C,
            PICO_SPI,
            PICO_BUTTONS,
            PICO_SERIAL,
            Wiring {
                part: "servos (images pantin-pico-servo; supplied with 5 V of their own, with a common GND)",
                bus: None,
                wires: &[["left thigh", "GP6"], ["right thigh", "GP7"], ["left arm", "GP8"], ["right arm", "GP9"]],
                source: [
                    "src/bin/servo.rs",
                    "legs.channel_a.output_to({}); legs.channel_b.output_to({}); \
                     arms.channel_a.output_to({}); arms.channel_b.output_to({});",
                ],
            },
        ],
    },
    Board {
        name: "blackpill",
        package: "blackpill",
        pins: None,
        displays: &[],
        rotation: 0,
        folder: "blackpill",
        title: "STM32F411 \"Black Pill\"",
        target: "thumbv7em-none-eabihf",
        format: Format::Bin(0x0800_0000),
        features: "face,bank,events",
        programs: &[],
        flashing: "Hold BOOT0, press and release NRST, release BOOT0: the chip's boot loader is on the USB port. Then \
                   <code>dfu-util -a 0 -s 0x08000000:leave -D FILE</code>, or STM32CubeProgrammer with the address 0x08000000.",
        supply: ["3V3", "GND"],
        wirings: &[
            Wiring {
                part: I2C_PART,
                bus: Some(Bus::I2c),
                wires: &[["SCL", "PB6"], ["SDA", "PB7"]],
                source: ["src/board.rs", "crate::i2c::new(parts.I2C1, {}, {}, &mut clocks"],
            },
            Wiring {
                part: SPI_PART,
                bus: Some(Bus::Spi),
                wires: &[["CS", "PA4"], ["SCL (SCK)", "PA5"], ["SDA (MOSI)", "PA7"], ["DC", "PB0"], ["RES", "PB1"]],
                source: ["src/board.rs", "parts.SPI1, ({}, {}, {}, {}, {}), &mut clocks"],
            },
            Wiring {
                part: BUTTONS,
                bus: None,
                wires: &[
                    ["up", "PB12"],
                    ["down", "PB13"],
                    ["left", "PB14"],
                    ["right", "PB15"],
                    ["select, on the board: KEY", "PA0"],
                ],
                source: [
                    "src/board.rs",
                    "five_buttons([ {}.into_pull_up_input().erase(), {}.into_pull_up_input().erase(), {}.into_pull_up_input().erase(), \
                     {}.into_pull_up_input().erase(), {}.into_pull_up_input().erase(), ])",
                ],
            },
            Wiring {
                part: SERIAL,
                bus: None,
                wires: &[["RX", "PA9"], ["TX", "PA10"]],
                source: ["src/board.rs", "Serial::new(parts.USART1, ({}, {}.internal_pull_up(true))"],
            },
        ],
    },
    Board {
        name: "microbit-v2",
        package: "microbit-v2",
        pins: None,
        displays: &[],
        rotation: 0,
        folder: "microbit-v2",
        title: "BBC micro:bit v2",
        target: "thumbv7em-none-eabihf",
        format: Format::Hex,
        features: "face,bank,events",
        programs: &[],
        flashing: "Plug it in, and drag <code>FILE</code> onto the drive MICROBIT. The board's own 5x5 LEDs show a small figure; the display is \
                   optional. Buttons and serial port are the board's. A first micro:bit (without a loudspeaker) has too little memory.",
        supply: ["3V", "0V"],
        wirings: &[Wiring {
            part: I2C_PART,
            bus: Some(Bus::I2c),
            wires: &[["SCL", "P19"], ["SDA", "P20"]],
            source: ["src/board.rs", "let (scl, sda) = ({}.into_floating_input().degrade(), {}.into_floating_input().degrade())"],
        }],
    },
    Board {
        name: "esp32-c3",
        package: "esp32-c3",
        pins: None,
        displays: &[],
        rotation: 0,
        folder: "esp32c3",
        title: "ESP32-C3",
        target: "riscv32imc-unknown-none-elf",
        format: Format::Elf,
        features: "face,bank,events,usb",
        programs: &[],
        flashing: "<code>cargo install espflash --locked</code>, once; then <code>espflash flash --monitor FILE</code>. If the board is not found, \
                   hold BOOT while you plug it in.",
        supply: ["3V3", "GND"],
        wirings: &[
            Wiring { part: I2C_PART, bus: Some(Bus::I2c), wires: &[["SDA", "GPIO5"], ["SCL", "GPIO6"]], source: ESP_I2C },
            ESP32_C3_BUTTONS,
            Wiring { part: SERIAL, bus: None, wires: &[["RX", "GPIO21"], ["TX", "GPIO20"]], source: ESP_SERIAL },
        ],
    },
    Board {
        name: "pico2",
        package: "pico2",
        pins: None,
        displays: &[],
        rotation: 0,
        folder: "pico2",
        title: "Raspberry Pi Pico 2",
        target: "thumbv8m.main-none-eabihf",
        format: Format::Uf2Rp2350,
        features: "face,events,usb",
        programs: &[],
        flashing: "Hold BOOTSEL while you plug the board in, and drag <code>FILE</code> onto the drive RP2350. The board's USB port is then a serial \
                   port (<code>/dev/ttyACM0</code>, <code>COM3</code>).",
        supply: PICO_SUPPLY,
        wirings: &[PICO_I2C, PICO_SPI, PICO_BUTTONS, PICO_SERIAL],
    },
    Board {
        name: "nucleo-f411re",
        package: "nucleo-f411re",
        pins: None,
        displays: &[],
        rotation: 0,
        folder: "nucleo-f411re",
        title: "Nucleo-F411RE",
        target: "thumbv7em-none-eabihf",
        format: Format::Bin(0x0800_0000),
        features: "face,bank,events",
        programs: &[],
        flashing: "Plug it in, and drag <code>FILE</code> onto the drive NODE_F411RE. The serial port is the board's.",
        supply: ["3V3", "GND"],
        wirings: &[
            Wiring {
                part: I2C_PART,
                bus: Some(Bus::I2c),
                wires: &[["SCL", "PB8"], ["SDA", "PB9"]],
                source: ["src/board.rs", "crate::i2c::new(parts.I2C1, {}, {}, &mut clocks"],
            },
            Wiring {
                part: SPI_PART,
                bus: Some(Bus::Spi),
                wires: &[["CS", "PB6"], ["SCL (SCK)", "PA5"], ["SDA (MOSI)", "PA7"], ["DC", "PC7"], ["RES", "PA9"]],
                source: ["src/board.rs", "parts.SPI1, ({}, {}, {}, {}, {}), &mut clocks"],
            },
            Wiring {
                part: BUTTONS,
                bus: None,
                wires: &[
                    ["up", "PA10"],
                    ["down", "PB5"],
                    ["left", "PB10"],
                    ["right", "PA8"],
                    ["select, on the board: B1", "PC13"],
                ],
                source: [
                    "src/board.rs",
                    "five_buttons([ {}.into_pull_up_input().erase(), {}.into_pull_up_input().erase(), {}.into_pull_up_input().erase(), \
                     {}.into_pull_up_input().erase(), {}.into_pull_up_input().erase(), ])",
                ],
            },
        ],
    },
    Board {
        name: "nrf52840-dk",
        package: "nrf52840-dk",
        pins: None,
        displays: &[],
        rotation: 0,
        folder: "nrf52840-dk",
        title: "nRF52840 DK",
        target: "thumbv7em-none-eabihf",
        format: Format::Hex,
        features: "face,bank,events",
        programs: &[],
        flashing: "Plug it in, and drag <code>FILE</code> onto the drive JLINK. Buttons and serial port are the board's.",
        supply: ["VDD", "GND"],
        wirings: &[Wiring {
            part: I2C_PART,
            bus: Some(Bus::I2c),
            wires: &[["SCL", "P0.27"], ["SDA", "P0.26"]],
            source: ["src/pins.rs", "// SCL and SDA. ({}, {})"],
        }],
    },
    Board {
        name: "esp32-c6",
        package: "esp32-c6",
        pins: None,
        displays: &[],
        rotation: 0,
        folder: "esp32c6",
        title: "ESP32-C6",
        target: "riscv32imac-unknown-none-elf",
        format: Format::Elf,
        features: "face,events,usb",
        programs: &[],
        flashing: "<code>cargo install espflash --locked</code>, once; then <code>espflash flash --monitor FILE</code>. If the board is not found, \
                   hold BOOT while you plug it in.",
        supply: ["3V3", "GND"],
        wirings: &[
            Wiring { part: I2C_PART, bus: Some(Bus::I2c), wires: &[["SDA", "GPIO6"], ["SCL", "GPIO7"]], source: ESP_I2C },
            Wiring {
                part: BUTTONS,
                bus: None,
                wires: &[
                    ["up", "GPIO0"],
                    ["down", "GPIO1"],
                    ["left", "GPIO2"],
                    ["right", "GPIO3"],
                    ["select, on the board: BOOT", "GPIO9"],
                ],
                source: ESP_BUTTONS,
            },
            Wiring { part: SERIAL, bus: None, wires: &[["RX", "GPIO16"], ["TX", "GPIO17"]], source: ESP_SERIAL },
        ],
    },
    Board {
        name: "gba",
        package: "gba",
        pins: None,
        displays: &[],
        rotation: 0,
        folder: "gba",
        title: "Game Boy Advance",
        target: crate::gba::TARGET,
        format: Format::Gba,
        features: "face",
        programs: &[],
        flashing: "Open <code>FILE</code> in an emulator. A console also needs the logo in the cartridge's header, which \
                   <code>gbafix FILE</code> adds. It has all our motions.",
        supply: ["", ""],
        wirings: &[],
    },
];

const DISPLAY_PACK_SOURCE: &str = "../pico/src/pins/display_pack.rs";
const DISPLAY_PACK: &[Wiring] = &[
    Wiring {
        part: "on the pack: nothing is wired",
        bus: Some(Bus::Spi),
        wires: &[["CS", "GP17"], ["SCK", "GP18"], ["MOSI", "GP19"], ["DC", "GP16"], ["light", "GP20"]],
        source: [DISPLAY_PACK_SOURCE, "after the pulse of a reset it stays on. ({}, {}, {}, {}, {})"],
    },
    Wiring {
        part: "buttons of the pack",
        bus: None,
        wires: &[["up, X", "GP14"], ["down, Y", "GP15"], ["left (free)", "GP10"], ["right, B", "GP13"], ["select, A", "GP12"]],
        source: [DISPLAY_PACK_SOURCE, "Left is a free pin. ({}, {}, {}, {}, {})"],
    },
];

/// Other boards with the same chips, whose pins are tables beside those of the boards above.
pub const SETS: [Board; 7] = [
    Board {
        name: "pico-display-pack",
        pins: Some("display-pack"),
        displays: &["st7789-135x240"],
        rotation: 90,
        title: "Raspberry Pi Pico with Pimoroni's Pico Display Pack",
        programs: &[],
        supply: ["", ""],
        wirings: DISPLAY_PACK,
        ..BOARDS[0]
    },
    Board {
        name: "pico2-display-pack",
        pins: Some("display-pack"),
        displays: &["st7789-135x240"],
        rotation: 90,
        title: "Raspberry Pi Pico 2 with Pimoroni's Pico Display Pack",
        supply: ["", ""],
        wirings: DISPLAY_PACK,
        ..BOARDS[4]
    },
    Board {
        name: "feather-rp2040",
        pins: Some("feather"),
        title: "Adafruit Feather RP2040 with a Qwiic OLED",
        programs: &[],
        supply: ["3V", "GND"],
        wirings: &[
            Wiring {
                part: "SSD1306 or SH1106, on the STEMMA QT (Qwiic) connector",
                bus: Some(Bus::I2c),
                wires: &[["SDA", "GP2"], ["SCL", "GP3"]],
                source: ["src/pins/feather.rs", RP_I2C],
            },
            Wiring {
                part: BUTTONS,
                bus: None,
                wires: &[
                    ["up, D24", "GP24"],
                    ["down, D25", "GP25"],
                    ["left, D5", "GP7"],
                    ["right, D6", "GP8"],
                    ["select, D9", "GP9"],
                ],
                source: ["src/pins/feather.rs", RP_BUTTONS],
            },
            Wiring {
                part: SERIAL,
                bus: None,
                wires: &[["RX", "GP0"], ["TX", "GP1"]],
                source: ["src/pins/feather.rs", RP_SERIAL],
            },
        ],
        ..BOARDS[0]
    },
    Board {
        name: "xiao-rp2040",
        pins: Some("xiao"),
        title: "Seeed XIAO RP2040",
        programs: &[],
        supply: ["3V3", "GND"],
        wirings: &[
            Wiring {
                part: I2C_PART,
                bus: Some(Bus::I2c),
                wires: &[["SDA, D4", "GP6"], ["SCL, D5", "GP7"]],
                source: ["src/pins/xiao.rs", RP_I2C],
            },
            Wiring {
                part: BUTTONS,
                bus: None,
                wires: &[
                    ["up, D1", "GP27"],
                    ["down, D2", "GP28"],
                    ["left, D3", "GP29"],
                    ["right, D9", "GP4"],
                    ["select, D0", "GP26"],
                ],
                source: ["src/pins/xiao.rs", RP_BUTTONS],
            },
            Wiring { part: SERIAL, bus: None, wires: &[["RX", "GP0"], ["TX", "GP1"]], source: ["src/pins/xiao.rs", RP_SERIAL] },
        ],
        ..BOARDS[0]
    },
    Board {
        name: "esp32-c3-oled",
        displays: &["ssd1306-72x40"],
        title: "ESP32-C3 with an OLED of 72x40 pixels (0.42\")",
        supply: ["", ""],
        wirings: &[
            Wiring {
                part: "on the board: nothing is wired",
                bus: Some(Bus::I2c),
                wires: &[["SDA", "GPIO5"], ["SCL", "GPIO6"]],
                source: ESP_I2C,
            },
            ESP32_C3_BUTTONS,
        ],
        ..BOARDS[3]
    },
    Board {
        name: "xiao-esp32c3",
        pins: Some("xiao"),
        title: "Seeed XIAO ESP32C3",
        wirings: &[
            Wiring {
                part: I2C_PART,
                bus: Some(Bus::I2c),
                wires: &[["SDA, D4", "GPIO6"], ["SCL, D5", "GPIO7"]],
                source: ["src/pins.rs", "// SDA and SCL: D4 and D5. ($parts.{}, $parts.{})"],
            },
            Wiring {
                part: BUTTONS,
                bus: None,
                wires: &[
                    ["up, D1", "GPIO3"],
                    ["down, D2", "GPIO4"],
                    ["left, D3", "GPIO5"],
                    ["right, D10", "GPIO10"],
                    ["select, on the board: BOOT", "GPIO9"],
                ],
                source: [
                    "src/pins.rs",
                    "Select is the board's own, BOOT. ($parts.{}, $parts.{}, $parts.{}, $parts.{}, $parts.{})",
                ],
            },
        ],
        ..BOARDS[3]
    },
    Board {
        name: "xiao-nrf52840",
        pins: Some("xiao"),
        format: Format::Uf2Nrf52840,
        title: "Seeed XIAO nRF52840",
        flashing: "Press the reset button twice, and drag <code>FILE</code> onto the drive XIAO-SENSE or XIAO-BOOT.",
        supply: ["3V3", "GND"],
        wirings: &[
            Wiring {
                part: I2C_PART,
                bus: Some(Bus::I2c),
                wires: &[["SCL, D5", "P0.05"], ["SDA, D4", "P0.04"]],
                source: ["src/pins/xiao.rs", "// SCL and SDA: D5 and D4. ({}, {})"],
            },
            Wiring {
                part: BUTTONS,
                bus: None,
                wires: &[["1, D0", "P0.02"], ["2, D1", "P0.03"]],
                source: ["src/pins/xiao.rs", "// Buttons: D0 and D1. ({}, {})"],
            },
            Wiring {
                part: SERIAL,
                bus: None,
                wires: &[["RX, D6", "P1.11"], ["TX, D7", "P1.12"]],
                source: ["src/pins/xiao.rs", "// TX and RX: D6 and D7. ({}, {})"],
            },
        ],
        ..BOARDS[6]
    },
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paths;

    fn read(board: &Board, file: &str) -> String {
        std::fs::read_to_string(paths::firmware().join("boards").join(board.folder).join(file)).unwrap()
    }

    /// A line's words, without what is between or around them.
    fn has_word(line: &str, word: &str) -> bool {
        line.match_indices(word).any(|(at, _)| {
            let around = [line[..at].chars().next_back(), line[at + word.len()..].chars().next()];
            around.iter().flatten().all(|letter| !letter.is_alphanumeric())
        })
    }

    #[test]
    fn the_boards_crates_set_up_the_pins_of_the_page() {
        for board in BOARDS.iter().chain(&SETS) {
            for wiring in board.wirings {
                let [file, code] = wiring.source;
                let pins = wiring.wires.iter().map(|[_, pin]| board.spelled(pin));
                let code = pins.fold(code.to_owned(), |code, pin| code.replacen("{}", &pin, 1));
                assert!(!code.contains("{}"), "{}: {}: a pin is missing", board.name, wiring.part);
                let source = read(board, file).split_whitespace().collect::<Vec<_>>().join(" ");
                // Tables of pins are macros; programs name pins without them.
                assert!(
                    source.replace('$', "").contains(&code.replace('$', "")),
                    "{}: {file} does not contain `{code}`",
                    board.name
                );
            }
        }
        // What the five pins of a colour display are.
        for board in &BOARDS[..2] {
            assert!(read(board, "src/spi_display.rs").contains("(select, clock, out, data, reset)"));
        }
    }

    #[test]
    fn the_boards_readmes_have_the_pins_of_the_page() {
        for board in BOARDS.iter().chain(&SETS) {
            let text = read(board, "README.md");
            let rows: Vec<&str> = text.lines().filter(|line| line.starts_with('|')).collect();
            let has = |pin: &str| rows.iter().any(|row| has_word(row, pin));
            for wiring in board.wirings {
                for [part, pin] in wiring.wires {
                    assert!(has(pin), "{}: {part} {pin}", board.name);
                }
            }
            assert!(
                board.supply[0].is_empty() || rows.iter().any(|row| row.contains(&board.supply.join(", "))),
                "{}",
                board.name
            );
        }
    }
}
