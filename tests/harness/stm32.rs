//! A program of an STM32F411 in Unicorn (QEMU's processor without a machine) with models of the peripherals that it uses: `tests/stm32`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};

use crate::unicorn;

/// The Rust target of its programs.
pub const TARGET: &str = "thumbv7em-none-eabihf";

/// What to run, as `run.py` says.
#[derive(Clone, Debug, Serialize)]
pub struct Request {
    /// The program.
    pub image: PathBuf,
    /// The I2C address of a display; none for one over SPI.
    pub display: Option<u8>,
    /// Whether the crystal starts.
    pub crystal: bool,
    /// The address of the serial port.
    pub serial: u32,
    /// Chip select, data/command and reset of a display over SPI.
    pub spi_pins: [&'static str; 3],
    /// SCL and SDA of a display over I2C.
    pub wires: [&'static str; 2],
    /// Clocks until a device lets go of SDA, which it holds at the start.
    pub held: u32,
    /// A wire that is held low for ever.
    pub ground: Option<&'static str>,
    /// The watchdog resets the chip after this many bytes on the display's bus, once.
    pub hangs_after: Option<usize>,
    /// Letters before each picture but the first.
    pub keys: Vec<Vec<u8>>,
    /// Bytes of RAM.
    pub ram: usize,
    /// The file for the bus's bytes; [`Request::run`] sets it.
    pub out: PathBuf,
}

/// A pin's registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub struct Pin {
    /// 0 input, 1 output, 2 alternate function, 3 analog.
    pub mode: u32,
    /// Whether it is an open drain.
    pub drain: u32,
    /// 0 low to 3 very high.
    pub speed: u32,
    /// 1 is up, 2 is down.
    pub pull: u32,
    /// The alternate function.
    pub function: u32,
}

/// The clocks when the processor's was switched to another source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub struct Switch {
    /// The processor's clock.
    pub core: u32,
    /// The PLL's input and oscillator.
    pub input: u32,
    /// The PLL's oscillator.
    pub vco: u32,
    /// The clock of I2C1.
    pub apb1: u32,
    /// The clock of SPI1 and USART1.
    pub apb2: u32,
    /// The flash's wait states.
    pub wait: u32,
    /// The voltage scale in PWR_CR: 3 is the highest, 2 that after reset.
    pub vos: u32,
}

/// What came of it.
#[derive(Clone, Debug, Deserialize)]
pub struct Outcome {
    /// Whether all pictures were sent.
    pub done: bool,
    /// What the program said over the serial line before the first picture.
    pub text: String,
    /// What the data sheet forbids.
    pub faults: Vec<String>,
    /// Changes of the processor's clock.
    pub switches: Vec<Switch>,
    /// Pins that were set up.
    pub pins: BTreeMap<String, Pin>,
    /// How often the crystal was asked for.
    pub crystal_polls: u32,
    /// Whether the watchdog ran before the crystal was asked for.
    pub watchdog_before_crystal: bool,
    /// SPI mode and clock.
    pub spi: crate::rp2040::Spi,
    /// The serial port's rate.
    pub baud: f64,
    /// The bytes on the display's bus.
    #[serde(skip)]
    pub stream: Vec<u16>,
}

impl Request {
    /// A program of the Black Pill with an SSD1306 of usual address, a crystal, and 64 KiB of RAM.
    pub fn new(image: &Path, keys: &[&[u8]]) -> Self {
        let keys = keys.iter().map(|letters| letters.to_vec()).collect();
        Request {
            image: image.to_owned(),
            display: Some(0x3c),
            crystal: true,
            serial: 0x4001_1000,
            spi_pins: ["A4", "B0", "B1"],
            wires: ["B6", "B7"],
            held: 0,
            ground: None,
            hangs_after: None,
            keys,
            ram: 64 << 10,
            out: PathBuf::new(),
        }
    }

    /// Runs it.
    pub fn run(mut self) -> Result<Outcome> {
        let folder = tempfile::Builder::new().prefix("pantin-stm32-").tempdir().context("cannot make a temporary folder")?;
        self.out = folder.path().join("stream");
        let request = folder.path().join("request.json");
        std::fs::write(&request, serde_json::to_vec(&self)?).context("cannot write the request")?;
        let mut outcome: Outcome = unicorn::run("stm32/run.py", &[request.as_os_str()])?;
        let stream = std::fs::read(&self.out).context("there is no stream")?;
        outcome.stream = stream.chunks_exact(2).map(|word| u16::from_le_bytes([word[0], word[1]])).collect();
        Ok(outcome)
    }
}
