//! A clip in the Pico's own flash region, in rp2040js: flashed as one drags it onto the board, and sent over the serial line, at the line's speed and
//! while the board draws. The flash is written by the boot ROM's functions as `tests/pico/rom.mjs` has them: that program, not the chip, is what
//! power is cut from here.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use harness::build::Firmware;
use harness::display::Picture;
use harness::rp2040::{self, Answered, OLED, Outcome, Request};
use harness::update::{line, requests};
use harness::{clips, paths, screen, setup, simulator};
use pantin_figure::rotation::Rotation;
use pantin_line::update::image;
use pantin_link::packet::Receiver;
use pantin_store::message::MAX_RESPONSE;
use pantin_store::region::Region;
use pantin_store::{ClipInfo, Response};
use pantin_tools::board_clip;
use tempfile::TempDir;

/// Pictures that identify a clip.
const PICTURES: usize = 12;
/// Bytes of a sector and of a page.
const SECTOR: usize = 4096;
const PAGE: usize = 256;

/// The board's image with the run built in, the flash of one that plays the walk from its region, and a longer clip for it.
struct Bench {
    folder: TempDir,
    image: PathBuf,
    flash: PathBuf,
    old: Film,
    new: Film,
}

/// A clip and its pictures.
struct Film {
    bytes: Vec<u8>,
    info: ClipInfo,
    pictures: Vec<Picture>,
}

impl Film {
    fn of(path: &Path) -> Film {
        let (bytes, info) = board_clip::read(path, &board_clip::Sent::default()).unwrap();
        let keys = [&b""[..]; 60];
        let pictures = simulator::play::<Rotation>(OLED, &[path.to_owned()], &[], &keys).unwrap();
        Film { bytes, info, pictures: pictures.into_iter().map(|(_, picture)| picture).collect() }
    }

    /// The pictures are this clip's, in order and from its beginning on.
    fn is(&self, pictures: &[Picture], what: &str) {
        let mut from = 0;
        for (index, picture) in pictures.iter().enumerate() {
            // The first picture, which is sent whole, takes longer than a frame.
            let at = self.pictures[from..].iter().take(6).position(|expected| expected == picture);
            from += at.unwrap_or_else(|| {
                let nearest = screen::difference(picture, &self.pictures[from]).unwrap();
                panic!("{what}: picture {index} is none of the next from frame {from} on; of that, {nearest}")
            }) + 1;
        }
    }
}

static BENCH: LazyLock<Bench> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let own = |name: &str| paths::root().join("motions").join(name);
    let new = match paths::data() {
        Some(data) => clips::convert(&data.join("bvh_bandai1_kick.bvh"), folder.path()).unwrap(),
        None => clips::convert(&own("library/dance.keys"), folder.path()).unwrap(),
    };
    let firmware = Firmware::featuring("update", "pico", "pico", rp2040::TARGET, &[&own("run.ptn")]).unwrap();
    let image = folder.path().join("pico.uf2");
    fs::write(&image, harness::uf2::of_elf(&fs::read(firmware.elf()).unwrap()).unwrap()).unwrap();
    let (old, new) = (Film::of(&own("walk.ptn")), Film::of(&new));
    let beside = uf2(folder.path(), &old);
    let flash = folder.path().join("flash.bin");
    let outcome = Request::new(&image, OLED).beside(&beside).pictures(PICTURES).saving(&flash).run().unwrap();
    old.is(&outcome.pictures, "a flash image");
    Bench { folder, image, flash, old, new }
});

/// A file of a clip as one drags it onto the board.
fn uf2(folder: &Path, film: &Film) -> PathBuf {
    let path = folder.join("clips.uf2");
    fs::write(&path, image::uf2(Region::of("pico").unwrap(), &film.bytes, &film.info).unwrap()).unwrap();
    path
}

impl Bench {
    /// A board with this flash, to which the new clip is sent.
    fn sending(&self, flash: &Path) -> Request {
        let messages = requests(&self.new.bytes, &self.new.info).iter().map(|message| line(message).unwrap()).collect();
        Request::new(flash, OLED).timed().messages(messages, PICTURES)
    }

    /// What a board with this flash plays after it was switched on.
    fn plays(&self, flash: &Path) -> Vec<Picture> {
        let outcome = Request::new(flash, OLED).pictures(PICTURES).run().unwrap();
        assert_eq!(outcome.ended, "done");
        outcome.pictures
    }

    /// Sectors that are erased and pages that are written for the new clip.
    fn changes(&self) -> usize {
        let pages = self.new.bytes.len().div_ceil(PAGE);
        // The header's page is the first of its sector.
        (pages + 1).div_ceil(SECTOR / PAGE) + pages + 1
    }
}

fn answer(answered: &Answered) -> Response {
    let mut receiver = Receiver::<MAX_RESPONSE>::new();
    answered.bytes.iter().find_map(|&byte| Response::read(&receiver.push(byte)?)).expect("a packet that answers")
}

/// Every message was answered, each as one that came whole and but once; the answers' last.
fn answered(outcome: &Outcome, film: &Film) -> Response {
    let (id, length) = (film.info.crc, film.info.length);
    let (last, wants) = outcome.answers.split_last().unwrap();
    for (index, answered) in wants.iter().enumerate() {
        let offset = length.min((index * PAGE) as u32);
        assert_eq!(answer(answered), Response::Next { id, offset }, "message {index}");
    }
    answer(last)
}

#[test]
fn a_file_dragged_onto_the_board_plays_and_the_built_in_clips_without_it() {
    if setup::host_only("a clip in the Pico's flash") {
        return;
    }
    let bench = &*BENCH;
    let run = Film::of(&paths::root().join("motions/run.ptn"));
    run.is(&bench.plays(&bench.image), "a board without a clip in its region");
    let outcome =
        Request::new(&bench.image, OLED).beside(&uf2(bench.folder.path(), &bench.new)).pictures(PICTURES).run().unwrap();
    bench.new.is(&outcome.pictures, "a longer clip");
    // Another over it, as the board's drive does it: sectors that are in the file are erased.
    let outcome =
        Request::new(&bench.flash, OLED).beside(&uf2(bench.folder.path(), &bench.new)).pictures(PICTURES).run().unwrap();
    bench.new.is(&outcome.pictures, "one after another");
    assert_eq!(outcome.changes, 0, "playing writes nothing");
}

#[test]
fn a_clip_comes_over_the_line_while_the_board_draws_and_stays() {
    if setup::host_only("a clip over the Pico's line") {
        return;
    }
    let bench = &*BENCH;
    let saved = bench.folder.path().join("whole.bin");
    let outcome = bench.sending(&bench.flash).saving(&saved).run().unwrap();
    assert_eq!(outcome.ended, "done");
    assert_eq!(answered(&outcome, &bench.new), Response::Done { id: bench.new.info.crc });
    assert_eq!(outcome.changes as usize, bench.changes());
    let begins = outcome.answers.last().unwrap().frames;
    // The first picture was shown before the clock ran.
    bench.old.is(&outcome.pictures[..1], "before the transfer");
    // A picture that was drawn before the last message came, and waits for its time, is still shown.
    let drawn = usize::from(bench.old.pictures.contains(&outcome.pictures[begins]));
    bench.new.is(&outcome.pictures[begins + drawn..], "after the transfer");
    bench.new.is(&bench.plays(&saved), "switched off and on");
    let (first, last) = (&outcome.answers[0], outcome.answers.last().unwrap());
    let seconds = (last.nanos - first.nanos) / 1e9;
    println!("{} bytes in {seconds:.2} s, {} pictures meanwhile", bench.new.bytes.len(), begins - first.frames);
}

#[test]
fn a_clip_comes_over_the_usb_port() {
    if setup::host_only("a clip over the Pico's USB port") {
        return;
    }
    let bench = &*BENCH;
    let own = paths::root().join("motions/run.ptn");
    let firmware = Firmware::featuring("usb,update", "pico", "pico", rp2040::TARGET, &[&own]).unwrap();
    let (_folder, image) = rp2040::image(firmware.elf()).unwrap();
    let saved = bench.folder.path().join("usb.bin");
    let outcome = bench.sending(&image).usb().saving(&saved).run().unwrap();
    assert_eq!(outcome.ended, "done");
    assert_eq!(answered(&outcome, &bench.new), Response::Done { id: bench.new.info.crc });
    assert_eq!(outcome.changes as usize, bench.changes());
    bench.new.is(&bench.plays(&saved), "switched off and on");
    let (first, last) = (&outcome.answers[0], outcome.answers.last().unwrap());
    println!("{} bytes in {:.2} s over USB", bench.new.bytes.len(), (last.nanos - first.nanos) / 1e9);
}

#[test]
fn bytes_with_framing_errors_are_no_part_of_a_message() {
    if setup::host_only("noise on the Pico's line") {
        return;
    }
    let bench = &*BENCH;
    let outcome = bench.sending(&bench.flash).noise().run().unwrap();
    assert_eq!(outcome.ended, "done");
    assert_eq!(answered(&outcome, &bench.new), Response::Done { id: bench.new.info.crc });
}

#[test]
fn power_that_goes_amid_any_change_leaves_the_old_clip_playing() {
    if setup::host_only("power cuts on the Pico") {
        return;
    }
    let bench = &*BENCH;
    let changes = bench.changes();
    // The first sector's erasing, then eighths, and the header, which is written last.
    let cuts = (0..8).map(|part| changes * part / 8).chain([changes - 1]);
    for cut in cuts {
        let saved = bench.folder.path().join("cut.bin");
        let outcome = bench.sending(&bench.flash).cut(cut as u64).saving(&saved).run().unwrap();
        assert_eq!(outcome.ended, "cut", "change {cut}");
        bench.old.is(&bench.plays(&saved), &format!("power cut amid change {cut} of {changes}"));
    }
}
