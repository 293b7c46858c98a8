//! Runs the firmware's program on the host, with a display in memory: every machine's pictures must equal its pictures.

use std::collections::VecDeque;
use std::marker::PhantomData;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use anyhow::{Context, Result, ensure};
use board_drivers::indexed::{Indexed, IndexedRows};
use embedded_graphics::pixelcolor::raw::{RawData, RawU16};
use embedded_graphics::pixelcolor::{BinaryColor, Gray4, GrayColor, Rgb565};
use pantin_app::{Board, CHARACTER_KEYS, Entry, Exit, Options, SteerKey};
use pantin_figure::rotation::{Rotation, RotationBackend};
use pantin_figure::solid::{Look, look_text};
use pantin_figure::surface::{Framebuffer, Gray4Rows, Layout, MonoPages, Rgb565Rows};

use crate::display::{self, Depth, Display, Picture, Way};
use crate::sync;

/// Larger than any board's capacity; the pictures do not depend on it.
type Capacity = pantin_app::MaxClip<1024, 1024, 96>;

/// A clip's file and its name, as a firmware is built with it.
pub struct File {
    name: String,
    bytes: Vec<u8>,
}

impl File {
    /// Reads it.
    pub fn read(path: &Path) -> Result<Self> {
        let bytes = std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
        Ok(Self { name: path.file_stem().unwrap_or_default().to_string_lossy().into_owned(), bytes })
    }
}

/// The pictures of a display that plays `clips` in step, with their frames' numbers: the first, then one after each of the keys'
/// letters. `words` are those of the firmware's command line; `R` is what turns its joints.
pub fn play<R: RotationBackend>(
    display: Display,
    clips: &[PathBuf],
    words: &[&str],
    keys: &[&[u8]],
) -> Result<Vec<(u32, Picture)>> {
    let files: Vec<File> = clips.iter().map(|path| File::read(path)).collect::<Result<_>>()?;
    let entries: Vec<Entry> = files.iter().map(|file| Entry { name: &file.name, bytes: &file.bytes, rig: &[] }).collect();
    let options = Options::parse(words.iter().copied().chain([sync::ARGUMENT]));
    let mut wishes: VecDeque<u8> = keys.iter().flat_map(|letters| letters.iter().copied().chain([pantin_app::NEXT])).collect();
    wishes.push_back(pantin_app::QUIT);
    simulate_on::<R>(display, &entries, options, wishes)
}

/// Passes the framebuffers to `present`, as a display's driver gets them: the first, and one after each of the keys' letters.
pub fn present<L: Layout>(clips: &[PathBuf], keys: &[&[u8]], present: impl FnMut(&mut Framebuffer<L>)) -> Result<()> {
    let files: Vec<File> = clips.iter().map(|path| File::read(path)).collect::<Result<_>>()?;
    let entries: Vec<Entry> = files.iter().map(|file| Entry { name: &file.name, bytes: &file.bytes, rig: &[] }).collect();
    let mut wishes: VecDeque<u8> = keys.iter().flat_map(|letters| letters.iter().copied().chain([pantin_app::NEXT])).collect();
    wishes.push_back(pantin_app::QUIT);
    let mut simulator = Simulator::<Rotation, L, _> { wishes, ..Simulator::new(present) };
    let mut frame = Box::new(Framebuffer::<L>::new());
    let exit = pantin_app::run(&entries, Options::parse([sync::ARGUMENT]), &mut frame, &mut simulator);
    ensure!(exit == Exit::Done, "a clip cannot be played");
    Ok(())
}

/// The pictures of the OLED while `line` brings the motion of the clip's figure: the first, then one after each of the line's stretches.
pub fn link(clip: &Path, words: &[&str], line: &[Vec<u8>]) -> Result<Vec<(u32, Picture)>> {
    link_on(display::OLED, clip, words, line)
}

/// The same on another display.
pub fn link_on(display: Display, clip: &Path, words: &[&str], line: &[Vec<u8>]) -> Result<Vec<(u32, Picture)>> {
    let file = File::read(clip)?;
    let entries = [Entry { name: &file.name, bytes: &file.bytes, rig: &[] }];
    let options = Options::parse(words.iter().copied().chain(["link", sync::ARGUMENT]));
    let ticks = line.iter().flat_map(|bytes| bytes.iter().copied().chain(sync::letter(pantin_app::NEXT)));
    let wishes = ticks.chain(sync::letter(pantin_app::QUIT)).collect();
    simulate_on::<Rotation>(display, &entries, options, wishes)
}

/// What a program reads before a picture.
#[derive(Clone, Copy, Debug)]
pub struct Reading {
    /// The timer's ticks since the picture before.
    pub ticks: u32,
    /// Buttons that are held.
    pub held: u16,
}

/// The pictures of the Game Boy Advance's display while `keys` steer the character of a bank: one for each reading.
/// No feet are held there. `words` are those of the firmware's command line; with `meets` it meets another character.
pub fn steer(bank: &[u8], meets: bool, keys: &[SteerKey], words: &[&str], readings: &[Reading]) -> Result<Vec<Picture>> {
    /// In place of the buttons that leave.
    const LEAVE: u16 = 1 << 15;
    let mut pictures = vec![];
    let present =
        |framebuffer: &mut Framebuffer<IndexedRows<240, 160, 19200>>| pictures.push(picture(crate::gba::LCD, framebuffer));
    let readings = readings.iter().copied().chain([Reading { ticks: 1, held: LEAVE }]).collect();
    let mut simulator = Simulator::<Rotation, _, _> { readings, ..Simulator::new(present) };
    let options = Options { feet: false, other_look: dancer()?, ..Options::parse(words.iter().copied()) };
    let program = if meets { pantin_app::meet::<_, 64> } else { pantin_app::steer::<_, 64> };
    let exit = program(bank, keys, LEAVE, options, &mut Framebuffer::new(), &mut simulator);
    ensure!(exit == Exit::Done, "the character cannot be played");
    Ok(pictures)
}

/// The character that the other one meets.
fn dancer() -> Result<Look> {
    static BYTES: OnceLock<Vec<u8>> = OnceLock::new();
    let text = std::fs::read_to_string(crate::paths::root().join("motions/looks/dancer.look"))?;
    let bytes = look_text::compile(&text).map_err(|error| anyhow::anyhow!("{error}"))?;
    Look::new(BYTES.get_or_init(|| bytes.to_vec())).map_err(|error| anyhow::anyhow!("{error}"))
}

/// The pictures of a display while letters steer the character of a bank in step: the first, then one after each of `letters`. `words` are those of the
/// firmware's command line; with `meets` it meets another character.
pub fn steer_in_step(bank: &[u8], meets: bool, display: Display, words: &[&str], letters: &[Vec<u8>]) -> Result<Vec<Picture>> {
    match display.depth {
        Depth::Gray4 => steered::<Gray4Rows<128, 64, 1024>>(bank, meets, display, words, letters),
        _ => steered::<Rgb565Rows<176, 220, 19360>>(bank, meets, display, words, letters),
    }
}

fn steered<L: Layout<Ink: Value>>(
    bank: &[u8],
    meets: bool,
    display: Display,
    words: &[&str],
    letters: &[Vec<u8>],
) -> Result<Vec<Picture>> {
    let mut pictures = vec![];
    let present = |framebuffer: &mut Framebuffer<L>| pictures.push(picture(display, framebuffer));
    let wishes = letters.iter().flat_map(|letters| letters.iter().copied().chain([pantin_app::NEXT])).collect();
    let mut simulator = Simulator::<Rotation, L, _> { wishes, ..Simulator::new(present) };
    let mut frame = Box::new(Framebuffer::<L>::new());
    let program = if meets { pantin_app::meet::<_, 64> } else { pantin_app::steer::<_, 64> };
    let options = Options { other_look: dancer()?, ..Options::parse(words.iter().copied().chain([sync::ARGUMENT])) };
    let exit = program(bank, &CHARACTER_KEYS, 0, options, &mut frame, &mut simulator);
    ensure!(exit == Exit::Done, "the character cannot be played");
    Ok(pictures)
}

fn simulate_on<R: RotationBackend>(
    display: Display,
    entries: &[Entry],
    options: Options,
    wishes: VecDeque<u8>,
) -> Result<Vec<(u32, Picture)>> {
    match (display.width, display.height, display.depth) {
        (128, 64, Depth::Mono) => simulate::<R, MonoPages<128, 64, 1024>>(display, entries, options, wishes),
        (128, 64, Depth::Gray4) => simulate::<R, Gray4Rows<128, 64, 1024>>(display, entries, options, wishes),
        (176, 220, Depth::Rgb565) => simulate::<R, Rgb565Rows<176, 220, 19360>>(display, entries, options, wishes),
        (168, 168, Depth::Gray4) => simulate::<R, Gray4Rows<168, 168, 3528>>(display, entries, options, wishes),
        (240, 320, Depth::Gray4) => simulate::<R, Gray4Rows<240, 320, 9600>>(display, entries, options, wishes),
        (168, 168, Depth::Rgb565) => simulate::<R, Rgb565Rows<168, 168, 14112>>(display, entries, options, wishes),
        (240, 240, Depth::Gray4) => simulate::<R, Gray4Rows<240, 240, 7200>>(display, entries, options, wishes),
        (240, 240, Depth::Rgb565) => simulate::<R, Rgb565Rows<240, 240, 28800>>(display, entries, options, wishes),
        (240, 160, Depth::Bgr555) => simulate::<R, IndexedRows<240, 160, 19200>>(display, entries, options, wishes),
        _ => anyhow::bail!("no machine has a display like {display:?}"),
    }
}

fn simulate<R: RotationBackend, L: Layout<Ink: Value>>(
    display: Display,
    entries: &[Entry],
    options: Options,
    wishes: VecDeque<u8>,
) -> Result<Vec<(u32, Picture)>> {
    let mut shown = vec![];
    let present = |framebuffer: &mut Framebuffer<L>| shown.push(picture(display, framebuffer));
    let mut simulator = Simulator::<R, L, _> { wishes, ..Simulator::new(present) };
    // The display's memory and the player's would be much of a test thread's stack.
    let mut frame = Box::new(Framebuffer::<L>::new());
    let exit = pantin_app::run(entries, options, &mut frame, &mut simulator);
    ensure!(exit == Exit::Done, "a clip cannot be played");
    let told = simulator.told;
    ensure!(told.len() == 5 * shown.len(), "the program told something else than frames' numbers");
    let numbers = told.chunks_exact(5).map(|message| u32::from_le_bytes([message[1], message[2], message[3], message[4]]));
    Ok(numbers.zip(shown).collect())
}

/// What a framebuffer shows.
pub fn picture<L: Layout<Ink: Value>>(display: Display, framebuffer: &Framebuffer<L>) -> Picture {
    let Display { width, height, .. } = display;
    let pixels = (0..width * height).map(|index| framebuffer.pixel(index % width, index / width).value()).collect();
    Picture { display, pixels }
}

/// The board.
struct Simulator<R, L, P> {
    /// Bytes that the other end of the line sends.
    wishes: VecDeque<u8>,
    /// Bytes that it gets.
    told: Vec<u8>,
    /// Of ticks and buttons; without any it ticks at once.
    readings: VecDeque<Reading>,
    present: P,
    kind: PhantomData<(R, L)>,
}

impl<R, L, P> Simulator<R, L, P> {
    fn new(present: P) -> Self {
        Simulator { wishes: VecDeque::new(), told: vec![], readings: VecDeque::new(), present, kind: PhantomData }
    }
}

impl<R: RotationBackend, L: Layout, P: FnMut(&mut Framebuffer<L>)> Board for Simulator<R, L, P> {
    type Layout = L;
    type Rotation = R;
    type Capacity = Capacity;

    fn present(&mut self, framebuffer: &mut Framebuffer<L>) {
        (self.present)(framebuffer);
    }

    fn start_timer(&mut self, _period_ns: u32) {}

    fn ticks(&mut self) -> u32 {
        if self.readings.len() > 1 {
            self.readings.pop_front();
        }
        self.readings.front().map_or(1, |reading| reading.ticks)
    }

    fn send(&mut self, bytes: &[u8]) {
        self.told.extend(bytes);
    }

    fn receive(&mut self) -> u8 {
        self.wishes.pop_front().unwrap_or(pantin_app::QUIT)
    }

    fn poll(&mut self) -> Option<u8> {
        None
    }

    fn held(&mut self) -> u16 {
        self.readings.front().map_or(0, |reading| reading.held)
    }
}

/// A display of a layout's size and colours, on no bus.
pub fn display_of<L: Layout<Ink: Value>>() -> Display {
    Display { width: L::WIDTH, height: L::HEIGHT, depth: <L::Ink as Value>::DEPTH, way: Way::Bus("memory") }
}

/// A pixel as [`Depth`] counts it.
pub trait Value {
    /// How it counts.
    const DEPTH: Depth;

    /// The pixel's value.
    fn value(self) -> u16;
}

impl Value for BinaryColor {
    const DEPTH: Depth = Depth::Mono;

    fn value(self) -> u16 {
        self.is_on().into()
    }
}

impl Value for Gray4 {
    const DEPTH: Depth = Depth::Gray4;

    fn value(self) -> u16 {
        self.luma().into()
    }
}

/// A palette's colour as the Game Boy Advance takes it.
impl Value for Indexed {
    const DEPTH: Depth = Depth::Bgr555;

    fn value(self) -> u16 {
        let [red, green, blue] = self.rgb().map(|part| u16::from(part >> 3));
        blue << 10 | green << 5 | red
    }
}

impl Value for Rgb565 {
    const DEPTH: Depth = Depth::Rgb565;

    fn value(self) -> u16 {
        RawU16::from(self).into_inner()
    }
}
