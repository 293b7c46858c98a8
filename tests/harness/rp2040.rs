//! The Raspberry Pi Pico's own flash image in `rp2040js`, with displays on its buses: `tests/pico`.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;

use anyhow::{Context, Result, bail, ensure};
use serde::{Deserialize, Serialize};
use tempfile::TempDir;

use crate::display::{Depth, Display, Picture, Way};
use crate::{paths, setup, uf2};

/// The Rust target of its programs.
pub const TARGET: &str = "thumbv6m-none-eabi";
/// Clocks of the processor a second.
pub const CLOCK: f64 = 125e6;
/// Where a program's vectors are: behind the second stage of the boot.
const VECTORS: u32 = 0x1000_0100;

/// The SSD1306's pictures, and the ST7789's.
pub const OLED: Display = Display { width: 128, height: 64, depth: Depth::Mono, way: Way::Bus("ssd1306") };
/// The ST7789's.
pub const LCD: Display = Display { width: 240, height: 240, depth: Depth::Rgb565, way: Way::Bus("st7789") };

/// What to run, as `run.mjs` says.
#[derive(Clone, Debug, Serialize)]
pub struct Request {
    images: Vec<PathBuf>,
    vectors: u32,
    display: Option<&'static str>,
    timed: bool,
    keys: Option<Vec<Vec<u8>>>,
    pictures: usize,
    messages: Option<Vec<Vec<u8>>>,
    servos: usize,
    harm: Option<&'static str>,
    plugs: Option<Vec<(f64, &'static str)>>,
    cables: Option<Vec<(f64, &'static str)>>,
    presses: Option<Vec<(u32, f64, f64)>>,
    noise: bool,
    usb: bool,
    packets: bool,
    deaf: Option<[usize; 2]>,
    cut: Option<u64>,
    seconds: f64,
    save: Option<PathBuf>,
    every: usize,
    out: Option<PathBuf>,
    #[serde(skip)]
    shown: Option<Display>,
}

/// A frame's measures.
#[derive(Clone, Debug, Deserialize)]
pub struct Frame {
    /// Clocks of decode, place, draw and show.
    pub cycles: [u64; 4],
    /// Since the start.
    pub nanos: f64,
    /// Over the display's bus.
    pub bytes: u64,
    /// What the firmware says that it is, in step.
    pub number: Option<u32>,
}

/// What the program answered to a message.
#[derive(Clone, Debug, Deserialize)]
pub struct Answered {
    /// The packet.
    pub bytes: Vec<u8>,
    /// Frames shown by then.
    pub frames: usize,
    /// Since the start.
    pub nanos: f64,
}

/// A pulse width was set.
#[derive(Clone, Debug, Deserialize)]
pub struct Pulse {
    /// Number of the pair of outputs.
    pub channel: u32,
    /// The register's value: the second output's in the upper half.
    pub value: u32,
    /// Since the start.
    pub nanos: f64,
}

/// What sets a pair's period.
#[derive(Clone, Debug, Deserialize)]
pub struct Slice {
    /// Counts of a period, less one.
    pub top: u32,
    /// Clocks of a count, in sixteenths.
    pub div: u32,
}

/// How an SPI bus is set up.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct Spi {
    /// The SPI mode.
    pub mode: u32,
    /// The clock's frequency.
    pub hz: f64,
}

/// What came of it.
#[derive(Clone, Debug, Deserialize)]
pub struct Outcome {
    /// Why it ended: `done`, `limit`, `watchdog`, or with a code of the program.
    pub ended: String,
    /// The frames shown.
    pub frames: Vec<Frame>,
    /// The pulse widths set, in order.
    pub pulses: Vec<Pulse>,
    /// The pairs of outputs at the end.
    pub slices: Vec<Slice>,
    /// What the program printed.
    pub printed: String,
    /// The answers to messages.
    pub answers: Vec<Answered>,
    /// Sectors erased and pages written.
    pub changes: u64,
    /// What the program said over the pins of the serial line before its first picture, or between packets.
    pub spoken: Vec<u8>,
    /// The bytes that came over the USB port.
    pub usb: Vec<u8>,
    /// How often the USB port had to wait because the board's receive buffer was full.
    pub held: u64,
    /// The SPI bus of the ST7789 at the end.
    pub spi: Spi,
    /// The pins with a pull-up at the end.
    #[serde(rename = "pulledUp")]
    pub pulled_up: Vec<u32>,
    /// What the display showed after each frame.
    #[serde(skip)]
    pub pictures: Vec<Picture>,
    /// What it showed at the end.
    #[serde(skip)]
    pub last: Option<Picture>,
}

impl Request {
    /// An image of the Pico as a UF2 file.
    pub fn new(image: &Path, display: impl Into<Option<Display>>) -> Request {
        let display = display.into();
        let name = display.and_then(|display| if let Way::Bus(name) = display.way { Some(name) } else { None });
        Request {
            images: vec![image.to_owned()],
            vectors: VECTORS,
            display: name,
            timed: false,
            keys: None,
            pictures: 0,
            messages: None,
            servos: 0,
            harm: None,
            plugs: None,
            cables: None,
            presses: None,
            noise: false,
            usb: false,
            packets: false,
            deaf: None,
            cut: None,
            seconds: 60.0,
            save: None,
            every: 1,
            out: None,
            shown: display,
        }
    }

    /// One without a second stage of the boot: its vectors are where the flash begins.
    pub fn bare(mut self) -> Request {
        self.vectors = 0x1000_0000;
        self
    }

    /// Plays in step: a picture, and one more after each of the keys' letters.
    pub fn in_step(mut self, keys: &[&[u8]]) -> Request {
        self.keys = Some(keys.iter().map(|letters| letters.to_vec()).collect());
        self
    }

    /// Plays a number of pictures at its own pace.
    pub fn pictures(mut self, count: usize) -> Request {
        self.pictures = count;
        self
    }

    /// Puts another image into the flash beside it: a UF2 file, or all of a flash.
    pub fn beside(mut self, image: &Path) -> Request {
        self.images.push(image.to_owned());
        self
    }

    /// Sends messages while it plays at its own pace, then waits for a number of pictures.
    pub fn messages(mut self, messages: Vec<Vec<u8>>, pictures: usize) -> Request {
        (self.messages, self.pictures) = (Some(messages), pictures);
        self
    }

    /// Power goes amid the change of the flash of this number: a sixteenth of a sector is erased, or of a page written.
    pub fn cut(mut self, change: u64) -> Request {
        self.cut = Some(change);
        self
    }

    /// Leaves all bytes of the flash in a file, as they are at the end.
    pub fn saving(mut self, flash: &Path) -> Request {
        self.save = Some(flash.to_owned());
        self
    }

    /// Waits for a number of pulse widths.
    pub fn servos(mut self, count: usize) -> Request {
        self.servos = count;
        self
    }

    /// Ends it after a number of seconds of the chip's time.
    pub fn seconds(mut self, seconds: f64) -> Request {
        self.seconds = seconds;
        self
    }

    /// Strikes it after a tenth of a second with a `fault` of the processor, or has it `hang`.
    pub fn harm(mut self, harm: &'static str) -> Request {
        self.harm = Some(harm);
        self
    }

    /// What happens to the SSD1306's wires after these seconds: `in`, `out`, `stuck` where one holds the bus low, or `amid a byte` where the
    /// display holds SDA for five clocks.
    pub fn plugs(mut self, plugs: &[(f64, &'static str)]) -> Request {
        self.plugs = Some(plugs.to_vec());
        self
    }

    /// Pulls the USB cable `out` and plugs it `in` after these seconds, while the board has other power. Whenever the port is open again, the PC asks
    /// for the list of letters.
    pub fn cables(mut self, plugs: &[(f64, &'static str)]) -> Request {
        self.cables = Some(plugs.to_vec());
        self.usb()
    }

    /// Keeps one picture of each `count`, the last one.
    pub fn every(mut self, count: usize) -> Request {
        self.every = count;
        self
    }

    /// Presses the buttons of these pins after seconds, for seconds.
    pub fn presses(mut self, presses: &[(u32, f64, f64)]) -> Request {
        self.presses = Some(presses.to_vec());
        self
    }

    /// Sends a byte with a framing error before each byte of a message.
    pub fn noise(mut self) -> Request {
        self.noise = true;
        self
    }

    /// Sends keys and messages over the USB port, and takes answers from it.
    pub fn usb(mut self) -> Request {
        self.usb = true;
        self
    }

    /// In step, the PC takes nothing from the USB port between these pictures.
    pub fn deaf(mut self, first: usize, last: usize) -> Request {
        self.deaf = Some([first, last]);
        self
    }

    /// In step, the keys are all bytes that are sent, among which the wish for the next picture is between packets.
    pub fn packets(mut self) -> Request {
        self.packets = true;
        self
    }

    /// Lets the buses take the time that they are set to; else they take none.
    pub fn timed(mut self) -> Request {
        self.timed = true;
        self
    }

    /// Runs it.
    pub fn run(mut self) -> Result<Outcome> {
        let folder = tempfile::Builder::new().prefix("pantin-pico-").tempdir().context("cannot make a temporary folder")?;
        let pixels = folder.path().join("pictures");
        self.out = self.shown.map(|_| pixels.clone());
        let request = folder.path().join("request.json");
        std::fs::write(&request, serde_json::to_vec(&self)?).context("cannot write the request")?;
        let mut command = Command::new(setup::emulator("node")?);
        command.arg(emulator()?.join("run.mjs")).arg(&request).stdin(Stdio::null());
        let output = command.output().context("cannot start node")?;
        let words = String::from_utf8_lossy(&output.stderr);
        ensure!(output.status.success(), "rp2040js ended with {}: {}", output.status, words.trim());
        let mut outcome: Outcome = serde_json::from_slice(&output.stdout).context("run.mjs printed no JSON")?;
        if let Some(display) = self.shown {
            outcome.pictures = pictures(display, &std::fs::read(&pixels).context("there are no pictures")?);
            outcome.last = outcome.pictures.pop();
        }
        Ok(outcome)
    }
}

fn pictures(display: Display, pixels: &[u8]) -> Vec<Picture> {
    let pixels: Vec<u16> = pixels.chunks_exact(2).map(|pixel| u16::from_le_bytes([pixel[0], pixel[1]])).collect();
    let whole = pixels.chunks_exact(display.width * display.height);
    whole.map(|pixels| Picture { display, pixels: pixels.to_vec() }).collect()
}

/// A UF2 file of a linked image, in a folder that goes with it.
pub fn image(elf: &Path) -> Result<(TempDir, PathBuf)> {
    written(uf2::of_elf(&read(elf)?)?)
}

/// That of one for [`Request::bare`].
pub fn bare_image(elf: &Path) -> Result<(TempDir, PathBuf)> {
    written(uf2::of_bare_elf(&read(elf)?)?)
}

fn read(elf: &Path) -> Result<Vec<u8>> {
    std::fs::read(elf).with_context(|| format!("cannot read {}", elf.display()))
}

fn written(image: Vec<u8>) -> Result<(TempDir, PathBuf)> {
    let folder = tempfile::Builder::new().prefix("pantin-uf2-").tempdir().context("cannot make a temporary folder")?;
    let path = folder.path().join("image.uf2");
    std::fs::write(&path, image).context("cannot write the image")?;
    Ok((folder, path))
}

/// The four outputs of two pairs after each frame, which sets one after the other, with the time of the last. Before the first frame there
/// are no pulses.
pub fn pulses(writes: &[Pulse], pairs: [u32; 2]) -> Vec<(f64, [u16; 4])> {
    let mut now = [0; 4];
    let set: Vec<&Pulse> = writes.iter().skip_while(|write| write.value == 0).collect();
    let frames = set.chunks_exact(now.len()).map(|frame| {
        for write in frame {
            let pair = 2 * usize::from(write.channel == pairs[1]);
            now[pair..pair + 2].copy_from_slice(&[write.value as u16, (write.value >> 16) as u16]);
        }
        (frame[frame.len() - 1].nanos, now)
    });
    frames.collect()
}

/// The emulator's folder: `tests/pico` under `target`, with what its lock file names, which npm fetches the first time.
pub fn emulator() -> Result<PathBuf> {
    static TURN: Mutex<()> = Mutex::new(());
    let _turn = TURN.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let (from, to) = (paths::root().join("tests/pico"), paths::root().join("target/rp2040js"));
    std::fs::create_dir_all(&to).with_context(|| format!("cannot make {}", to.display()))?;
    let fetched = to.join("node_modules/fetched.json");
    let lock = std::fs::read(from.join("package-lock.json")).context("tests/pico has no lock file")?;
    for entry in std::fs::read_dir(&from).context("cannot list tests/pico")? {
        let path = entry?.path();
        copy_if_other(&path, &to.join(path.file_name().unwrap_or_default()))?;
    }
    if std::fs::read(&fetched).ok() != Some(lock.clone()) {
        fetch(&to)?;
        std::fs::write(&fetched, lock).context("cannot note what was fetched")?;
    }
    Ok(to)
}

/// Tests of several processes may do this at once: what is right already stays as it is.
fn copy_if_other(from: &Path, to: &Path) -> Result<()> {
    let bytes = std::fs::read(from).with_context(|| format!("cannot read {}", from.display()))?;
    if std::fs::read(to).ok().as_ref() != Some(&bytes) {
        let part = to.with_extension(format!("part{}", std::process::id()));
        std::fs::write(&part, bytes).and_then(|()| std::fs::rename(&part, to)).context("cannot copy tests/pico")?;
    }
    Ok(())
}

fn fetch(folder: &Path) -> Result<()> {
    let Some(npm) = paths::program("npm") else {
        bail!("npm is missing, which fetches rp2040js, the Pico's emulator; {}", setup::advice("npm"));
    };
    eprintln!("fetching rp2040js, the Pico's emulator: npm ci in {}", folder.display());
    let mut command = Command::new(npm);
    command.args(["ci", "--no-audit", "--no-fund", "--ignore-scripts"]).current_dir(folder).stdin(Stdio::null());
    let output = command.output().context("cannot start npm")?;
    let words = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "`npm ci` in {} failed (is there a network?): {}", folder.display(), words.trim());
    Ok(())
}
