//! A clip replaced over the serial line of an emulated board, whose flash controller writes it: what plays is the old clip or the new one,
//! picture by picture as the host draws them, whatever happens to the transfer.

use std::collections::BTreeSet;
use std::fs;
use std::io::{Read, Write};
use std::net::TcpListener;
use std::ops::Range;
use std::path::PathBuf;
use std::process::Command;
use std::sync::LazyLock;
use std::thread;
use std::time::Duration;

use harness::build::{self, Firmware};
use harness::display::Picture;
use harness::qemu::{Launch, MICROBIT};
use harness::sync::Session;
use harness::update::{line, request, requests, send};
use harness::{clips, paths, screen, setup, simulator};
use object::read::elf::{ElfFile32, ProgramHeader};
use object::{Endianness, Object, ObjectSymbol};
use pantin::OpenError;
use pantin_figure::rotation::Rotation;
use pantin_line::update::{self, RetryPolicy, image};
use pantin_store::region::{REGIONS, Region};
use pantin_store::{ClipInfo, Refusal, Request, Response};
use pantin_tools::board_clip;
use tempfile::TempDir;

/// Pictures that distinguish clips.
const PICTURES: usize = 4;

/// The board with the run built in, and clips for it: the walk as the old one, and a captured walk as the new one, or a wave where there is none.
struct Bench {
    folder: TempDir,
    firmware: Firmware,
    region: Region,
    built_in: Film,
    old: Film,
    new: Film,
}

/// A clip and how it begins.
struct Film {
    bytes: Vec<u8>,
    info: ClipInfo,
    path: PathBuf,
    pictures: Vec<(u32, Picture)>,
}

impl Film {
    fn of(path: PathBuf) -> Film {
        Film::sent(path, &board_clip::Sent::default())
    }

    fn sent(path: PathBuf, how: &board_clip::Sent) -> Film {
        let (bytes, info) = board_clip::read(&path, how).unwrap();
        let keys = [&b""[..]; PICTURES - 1];
        let pictures = simulator::play::<Rotation>(MICROBIT.display.unwrap(), std::slice::from_ref(&path), &[], &keys).unwrap();
        Film { bytes, info, path, pictures }
    }

    fn done(&self) -> Response {
        Response::Done { id: self.info.crc }
    }
}

static BENCH: LazyLock<Bench> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let own = |name: &str| paths::root().join("motions").join(name);
    let new = paths::data().map_or_else(|| own("wave.proc"), |data| data.join("bvh_bandai1_walk.bvh"));
    let new = Film::of(clips::convert(&new, folder.path()).unwrap());
    let built_in = own("run.ptn");
    let firmware = Firmware::featuring("update", MICROBIT.name, MICROBIT.name, MICROBIT.target, &[&built_in]).unwrap();
    let region = *Region::of(MICROBIT.name).unwrap();
    Bench { folder, firmware, region, built_in: Film::of(built_in), old: Film::of(own("walk.ptn")), new }
});

/// A clip of more channels than the board has room for.
fn wide() -> (Vec<u8>, ClipInfo) {
    board_clip::read(&paths::root().join("tests/vectors/channels-300.ptn"), &board_clip::Sent::default()).unwrap()
}

/// The bench; none where there is no emulator.
fn bench(what: &str) -> Option<&'static Bench> {
    (!setup::host_only(what)).then(|| &*BENCH)
}

impl Bench {
    fn launch(&self) -> Launch {
        Launch::new(MICROBIT, self.firmware.elf()).display().limit(Duration::from_secs(90))
    }

    /// The board as it comes out of its box.
    fn start(&self) -> Session {
        let mut session = Session::start(self.launch()).unwrap();
        shows(&mut session, &self.built_in, "a new board");
        session
    }

    /// One that plays the old clip from its flash.
    fn playing_old(&self) -> Session {
        let mut session = self.start();
        assert_eq!(send(&mut session, &self.old.bytes, &self.old.info).unwrap(), self.old.done());
        session.begins();
        shows(&mut session, &self.old, "the first update");
        session
    }

    /// All of the board's flash, as it is now.
    fn flash(&self, session: &mut Session) -> Vec<u8> {
        let path = self.file("saved");
        session.memory_of_processor(0, (self.region.address + 2 * self.region.slot) as usize, &path).unwrap();
        fs::read(path).unwrap()
    }

    /// Another board, with that flash: programs and clips.
    fn with_flash(&self, flash: &[u8]) -> Session {
        let path = self.file("flash");
        fs::write(&path, flash).unwrap();
        Session::start(Launch::new(MICROBIT, &path).display()).unwrap()
    }

    /// A file of this thread's own.
    fn file(&self, name: &str) -> PathBuf {
        self.folder.path().join(format!("{name}-{:?}.bin", thread::current().id()))
    }
}

/// The session's next pictures, of which the first is not asked for where a clip has just begun, are a clip's first ones.
fn shows(session: &mut Session, film: &Film, what: &str) {
    for (index, (number, picture)) in film.pictures.iter().enumerate() {
        let shown = session.next(&[]).unwrap_or_else(|error| panic!("{what}: {error:#}"));
        assert_eq!(shown.0, *number, "{what}: picture {index}");
        if let Some(difference) = screen::difference(&shown.1, picture) {
            panic!("{what}: picture {index} of {}: {difference}", film.path.display());
        }
    }
}

/// The boards of the table: Rust target, all of the flash, and how far from the slots' place in it the processor reads them.
const FLASHES: [(&str, &str, Range<u64>, u64); 8] = [
    ("blackpill", "thumbv7em-none-eabihf", 0x0800_0000..0x0808_0000, 0),
    ("esp32-c3", "riscv32imc-unknown-none-elf", 0..0x40_0000, 0x3c40_0000 - 0x3e_0000),
    ("microbit", "thumbv6m-none-eabi", 0..0x4_0000, 0),
    ("microbit-v2", "thumbv7em-none-eabihf", 0..0x8_0000, 0),
    ("nrf52840-dk", "thumbv7em-none-eabihf", 0..0x10_0000, 0),
    ("nucleo-f411re", "thumbv7em-none-eabihf", 0x0800_0000..0x0808_0000, 0),
    ("pico", "thumbv6m-none-eabi", 0x1000_0000..0x1020_0000, 0),
    ("xiao-nrf52840", "thumbv7em-none-eabihf", 0x2_7000..0xa_d000, 0),
];
/// Where `espflash` puts a program, which it packs out of parts that are linked elsewhere, each into whole pages of the mapping.
const PACKED: u64 = 0x1_0000;

#[test]
fn memory_maps_keep_the_regions_of_the_table_free() {
    assert!(REGIONS.iter().map(|region| region.board).eq(FLASHES.iter().map(|(board, ..)| *board)));
    for (region, (board, target, flash, away)) in REGIONS.iter().zip(FLASHES) {
        let (features, package) = if board == "xiao-nrf52840" { ("update,pins-xiao", "nrf52840-dk") } else { ("update", board) };
        let firmware = Firmware::featuring(features, package, package, target, &[]).unwrap();
        let bytes = fs::read(firmware.elf()).unwrap();
        let file = ElfFile32::<Endianness>::parse(&*bytes).unwrap();
        let Region { address: start, slot, sector, word, .. } = *region;
        let clips = u64::from(start)..u64::from(start + 2 * slot);
        let address = |name| file.symbol_by_name(name).unwrap().address();
        let memory = clips.start + away..clips.end + away;
        assert_eq!(address("_clips_start")..address("_clips_end"), memory, "{board}");
        assert!(flash.start <= clips.start && clips.end <= flash.end, "{board}");
        assert_eq!((slot % sector, (u64::from(start) - flash.start) % u64::from(sector), 256 % word), (0, 0, 0), "{board}");
        for segment in file.elf_program_headers() {
            let endian = file.endian();
            let (from, len) = (u64::from(segment.p_paddr(endian)), u64::from(segment.p_filesz(endian)));
            assert!(from + len <= memory.start || from >= memory.end, "{board}: {len} bytes at {from:#x}");
        }
        if away > 0 {
            let packed = harness::image::loaded(firmware.elf()).unwrap() + file.elf_program_headers().len() as u64 * PACKED;
            assert!(flash.start + PACKED + packed <= clips.start, "{board}: {packed} bytes");
        }
    }
}

/// Bytes of flash that the feature costs: growth is to be meant.
/// Of them some for the limit on transfers that begin and never end, and 120 because clips follow one another by themselves: what plays them is called twice here.
const COST: u64 = 5520;

#[test]
fn the_store_brings_no_way_to_panic_and_little_code() {
    setup::rust_target(MICROBIT.target).unwrap();
    // A board has rooms for the clips that are built in, but all it can have where any may come: one that is too wide has both have all.
    let clips = [BENCH.built_in.path.as_path(), &paths::root().join("tests/vectors/channels-300.ptn")];
    let images = ["update", ""]
        .map(|feature| Firmware::featuring(feature, MICROBIT.name, MICROBIT.name, MICROBIT.target, &clips).unwrap());
    let [with, without] = images.each_ref().map(Firmware::elf);
    let cost = harness::image::loaded(with).unwrap() - harness::image::loaded(without).unwrap();
    println!("feature update: {cost} bytes of flash");
    assert!(cost <= COST, "{cost} bytes");
    let panics = |elf| {
        let bytes = fs::read(elf).unwrap();
        let file = object::File::parse(&*bytes).unwrap();
        let names = file.symbols().map(|symbol| format!("{:#}", rustc_demangle::demangle(symbol.name().unwrap_or_default())));
        names
            .filter(|name| ["panicking::", "_failed", "core::fmt"].iter().any(|part| name.contains(part)))
            .collect::<BTreeSet<_>>()
    };
    assert_eq!(panics(with), panics(without));
}

#[test]
fn a_clip_comes_over_the_line_while_another_plays_and_stays() {
    let Some(bench) = bench("a clip over the line") else { return };
    let mut session = bench.playing_old();
    session.reset().unwrap();
    shows(&mut session, &bench.old, "after a reset");
    // Between two messages the old clip goes on.
    let long = [&b""[..]; 100];
    let old = simulator::play::<Rotation>(MICROBIT.display.unwrap(), std::slice::from_ref(&bench.old.path), &[], &long).unwrap();
    let mut last = None;
    for (message, (number, picture)) in requests(&bench.new.bytes, &bench.new.info).iter().zip(&old[PICTURES..]) {
        assert_eq!(session.next(&[]).unwrap(), (*number, picture.clone()));
        last = Some(request(&mut session, message).unwrap());
    }
    assert_eq!(last, Some(bench.new.done()));
    session.begins();
    shows(&mut session, &bench.new, "the new clip");
    assert_eq!(request(&mut session, &Request::Begin(bench.new.info)).unwrap(), bench.new.done(), "it has it already");
    session.reset().unwrap();
    shows(&mut session, &bench.new, "the new clip after a reset");
    // The next one goes where the first was.
    assert_eq!(send(&mut session, &bench.old.bytes, &bench.old.info).unwrap(), bench.old.done());
    session.begins();
    shows(&mut session, &bench.old, "the old clip again");
    // The clips that it was built with come after it.
    session.send(b"n").unwrap();
    session.step(&[]).unwrap();
    session.end().unwrap();
}

/// Authored motion goes over the line as its keys, which are fewer bytes than its segments, and plays once it is there.
#[test]
fn a_key_clip_comes_over_the_line_whole() {
    let Some(bench) = bench("a key clip over the line") else { return };
    let path = bench.folder.path().join("keys.ptn");
    let walk = paths::root().join("motions/walk.keys");
    let mut tool = Command::new(build::host_tool().unwrap());
    assert!(tool.args(["convert", "--keys"]).arg(&walk).arg("-o").arg(&path).status().unwrap().success());
    let segments = Film::of(path.clone());
    let keys = Film::sent(path, &board_clip::Sent { keys: true, ..board_clip::Sent::default() });
    let [few, many] = [&keys, &segments]
        .map(|film| requests(&film.bytes, &film.info).iter().map(|message| line(message).unwrap().len()).sum::<usize>());
    println!("{few} bytes over the line as keys, {many} as segments");
    assert!(few < many);
    let built_in = &bench.built_in;
    let firmware = Firmware::featuring("update,keys", MICROBIT.name, MICROBIT.name, MICROBIT.target, &[&built_in.path]).unwrap();
    let launch = Launch::new(MICROBIT, firmware.elf()).display().limit(Duration::from_secs(90));
    let mut session = Session::start(launch).unwrap();
    shows(&mut session, built_in, "a new board");
    assert_eq!(send(&mut session, &keys.bytes, &keys.info).unwrap(), keys.done());
    session.begins();
    shows(&mut session, &keys, "the keys");
    session.reset().unwrap();
    shows(&mut session, &keys, "the keys after a reset");
    // Firmware without the feature refuses them, and says why.
    let refusal = Refusal::Clip(OpenError::UnsupportedVersion(2));
    assert_eq!(send(&mut bench.start(), &keys.bytes, &keys.info).unwrap(), Response::Refused { id: keys.info.crc, refusal });
}

#[test]
fn a_transfer_that_ends_at_any_sixteenth_leaves_the_old_clip_playing() {
    let Some(bench) = bench("interrupted transfers") else { return };
    let mut session = bench.playing_old();
    let messages = requests(&bench.new.bytes, &bench.new.info);
    let all: usize = messages.iter().map(|message| line(message).unwrap().len()).sum();
    for part in 0..16 {
        let mut left = all * part / 16;
        for message in &messages {
            let bytes = line(message).unwrap();
            if left < bytes.len() {
                session.send(&bytes[..left]).unwrap();
                break;
            }
            left -= bytes.len();
            let answer = request(&mut session, message).unwrap();
            assert!(matches!(answer, Response::Next { .. }), "{answer:?}");
        }
        // What is still on its way would reach the board that starts, out of a packet's midst.
        thread::sleep(Duration::from_millis(100));
        session.reset().unwrap();
        session.send(&harness::update::nothing().unwrap()).unwrap();
        shows(&mut session, &bench.old, &format!("cut off at {part} sixteenths, reset"));
    }
    assert_eq!(send(&mut session, &bench.new.bytes, &bench.new.info).unwrap(), bench.new.done());
    session.reset().unwrap();
    shows(&mut session, &bench.new, "a whole transfer");
}

#[test]
fn a_board_killed_at_any_moment_plays_the_old_clip_and_takes_the_new_one() {
    let Some(bench) = bench("killed boards") else { return };
    let messages = requests(&bench.new.bytes, &bench.new.info);
    let mut session = bench.playing_old();
    let flash = bench.flash(&mut session);
    drop(session);
    for part in 0..16 {
        let mut session = bench.with_flash(&flash);
        shows(&mut session, &bench.old, &format!("before the transfer of {part} sixteenths"));
        let cut = messages.len() * part / 16;
        for message in &messages[..cut] {
            request(&mut session, message).unwrap();
        }
        // The machine stops while it takes this one: before, amid or after the flash is written.
        session.send(&line(&messages[cut]).unwrap()).unwrap();
        thread::sleep(Duration::from_micros(150 * part as u64));
        session.stop().unwrap();
        let left = bench.flash(&mut session);
        drop(session);
        let mut session = bench.with_flash(&left);
        shows(&mut session, &bench.old, &format!("killed at {part} sixteenths"));
        assert_eq!(send(&mut session, &bench.new.bytes, &bench.new.info).unwrap(), bench.new.done());
        session.begins();
        shows(&mut session, &bench.new, &format!("killed at {part} sixteenths, the next transfer"));
    }
}

#[test]
fn flipped_bits_on_the_line_cost_a_message_and_in_the_flash_a_clip() {
    let Some(bench) = bench("flipped bits") else { return };
    let mut session = bench.playing_old();
    for (index, message) in requests(&bench.new.bytes, &bench.new.info).iter().enumerate() {
        // The first zero stays: what is no packet would be letters of keys.
        let mut damaged = line(message).unwrap();
        let at = 1 + index * 37 % (damaged.len() - 1);
        damaged[at] ^= 1 << (index % 8);
        session.send(&damaged).unwrap();
        // Ends what a flipped zero left open.
        session.send(&[0]).unwrap();
        request(&mut session, message).unwrap();
    }
    session.begins();
    shows(&mut session, &bench.new, "each message damaged once");
    let flash = bench.flash(&mut session);
    drop(session);
    let first = bench.region.address as usize + 256;
    let second = first + bench.region.slot as usize;
    for (places, film) in
        [(vec![first + 40], &bench.new), (vec![second + 40], &bench.old), (vec![first + 40, second + 40], &bench.built_in)]
    {
        let mut flash = flash.clone();
        places.iter().for_each(|&at| flash[at] ^= 16);
        shows(&mut bench.with_flash(&flash), film, &format!("bits flipped at {places:?}"));
    }
}

#[test]
fn a_clip_that_the_board_cannot_play_is_refused_and_the_old_one_goes_on() {
    let Some(bench) = bench("refused clips") else { return };
    let mut session = bench.playing_old();
    let (wide, wide_claim) = wide();
    let too_big = Response::Refused { id: wide_claim.crc, refusal: Refusal::TooBig };
    let mut at = bench.old.pictures.last().unwrap().clone();
    let mut damaged = ClipInfo::of(&bench.new.bytes, "").unwrap();
    damaged.crc ^= 1;
    let spoilt = Response::Refused { id: damaged.crc, refusal: Refusal::BadCrc };
    for (bytes, info, expected) in [(&wide, &wide_claim, too_big), (&bench.new.bytes, &damaged, spoilt)] {
        assert_eq!(send(&mut session, bytes, info).unwrap(), expected);
        // It shows the picture again at which it was.
        session.begins();
        assert_eq!(session.next(&[]).unwrap(), at, "{expected:?}");
        at = session.next(&[]).unwrap();
    }
    let long = vec![0; bench.region.slot as usize];
    let info = ClipInfo::of(&long, "").unwrap();
    let refusal = Refusal::TooLong { capacity: bench.region.slot - 256 };
    assert_eq!(send(&mut session, &long, &info).unwrap(), Response::Refused { id: info.crc, refusal });
    session.reset().unwrap();
    shows(&mut session, &bench.old, "after refused clips");
}

#[test]
fn a_flash_image_plays_and_one_that_the_board_has_no_memory_for_does_not() {
    let Some(bench) = bench("flash images") else { return };
    let mut session = bench.playing_old();
    let firmware = bench.flash(&mut session);
    drop(session);
    let flashed = |bytes: &[u8], info: &ClipInfo| {
        let mut flash = firmware.clone();
        let image = image::binary(&bench.region, bytes, info).unwrap();
        flash[bench.region.address as usize..][..image.len()].copy_from_slice(&image);
        bench.with_flash(&flash)
    };
    shows(&mut flashed(&bench.new.bytes, &bench.new.info), &bench.new, "a flash image");
    let (wide, info) = wide();
    shows(&mut flashed(&wide, &info), &bench.built_in, "a clip of too many channels");
}

/// Connects a board that plays at its own pace to a port of this machine, for one connection.
fn behind_a_port(bench: &Bench) -> (u16, thread::JoinHandle<()>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    let launch = bench.launch().serial();
    let thread = thread::spawn(move || {
        let mut qemu = launch.start().unwrap();
        let (mut host, _) = listener.accept().unwrap();
        let mut board = qemu.serial().unwrap().try_clone().unwrap();
        let (mut from_host, mut to_board) = (host.try_clone().unwrap(), board.try_clone().unwrap());
        let writer = thread::spawn(move || std::io::copy(&mut from_host, &mut to_board));
        let mut bytes = [0; 4096];
        // Ends when the host has gone.
        while let Ok(len @ 1..) = board.read(&mut bytes) {
            if host.write_all(&bytes[..len]).is_err() {
                break;
            }
        }
        drop(qemu);
        let _ = writer.join();
    });
    (port, thread)
}

#[test]
fn the_host_tool_updates_a_board_that_plays() {
    let Some(bench) = bench("the host tool") else { return };
    let (port, thread) = behind_a_port(bench);
    let tool = build::host_tool().unwrap();
    let output = Command::new(tool).arg("update").arg(&bench.new.path).arg("--to").arg(format!("tcp:127.0.0.1:{port}")).output();
    let output = output.unwrap();
    let words = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{words}");
    println!("{words}");
    assert!(words.contains(&format!("plays; {} bytes", bench.new.bytes.len())), "{words}");
    thread.join().unwrap();
}

#[test]
fn one_connection_after_another_takes_a_transfer_up() {
    let Some(bench) = bench("connections") else { return };
    let mut qemu = bench.launch().serial().start().unwrap();
    let board = qemu.serial().unwrap();
    board.set_read_timeout(Some(Duration::from_millis(20))).unwrap();
    let mut line = Breaking { line: board, left: 1000.min(bench.new.bytes.len() * 3 / 4) };
    let patience = RetryPolicy { answer: Duration::from_millis(300), tries: 2 };
    let mut told = vec![];
    let first = update::send(&mut line, &bench.new.bytes, &bench.new.info, patience, &mut |bytes| told.push(bytes));
    let first = first.unwrap_err().to_string();
    let reached = *told.last().unwrap();
    assert!(reached > 0 && first.contains(&format!("after {reached} bytes")), "{first}");
    line.left = usize::MAX;
    told.clear();
    let patience = RetryPolicy { answer: Duration::from_secs(2), tries: 5 };
    let outcome = update::send(&mut line, &bench.new.bytes, &bench.new.info, patience, &mut |bytes| told.push(bytes)).unwrap();
    assert!(told[0] >= reached, "it goes on at {} of {reached}", told[0]);
    assert_eq!(outcome.sent, bench.new.bytes.len() as u32 - told[0]);
}

/// A line that loses everything after a given number of bytes.
struct Breaking<'a, L> {
    line: &'a mut L,
    left: usize,
}

impl<L: Read> Read for Breaking<'_, L> {
    fn read(&mut self, bytes: &mut [u8]) -> std::io::Result<usize> {
        self.line.read(bytes)
    }
}

impl<L: Write> Write for Breaking<'_, L> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let len = bytes.len().min(self.left);
        self.left -= len;
        self.line.write_all(&bytes[..len]).map(|()| bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.line.flush()
    }
}
