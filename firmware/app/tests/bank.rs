//! The clips of a bank: built in, and in a board's flash.
#![cfg(feature = "bank")]

#[path = "../../store/tests/suites/mock.rs"]
mod mock;

use pantin::Bank;
use pantin_app::{Board, Command, Entry, Exit, MaxClip, Mode, Options, run, run_stored};
use pantin_figure::rotation::Rotation;
use pantin_figure::surface::{Framebuffer, Gray4Rows, Layout};
use pantin_store::header::Header;
use pantin_store::{BLOCK_BYTES, ClipInfo, Store};

const BANK: &[u8] = include_bytes!("../../../tests/vectors/bank.ptb");
const RUN: &[u8] = include_bytes!("../../../motions/run.ptn");

type Oled = Gray4Rows<128, 64, 1024>;

/// A board on which a person chooses the next clip after each picture.
#[derive(Default)]
struct Mock {
    pictures: Vec<Vec<u8>>,
    asked: usize,
}

impl Board for Mock {
    type Layout = Oled;
    type Rotation = Rotation;
    type Capacity = MaxClip<144, 96, 60>;

    fn present(&mut self, framebuffer: &mut Framebuffer<Oled>) {
        use embedded_graphics::prelude::GrayColor;
        let pixels = (0..Oled::HEIGHT).flat_map(|row| (0..Oled::WIDTH).map(move |column| (column, row)));
        self.pictures.push(pixels.map(|(column, row)| framebuffer.pixel(column, row).luma()).collect());
    }

    fn start_timer(&mut self, _period_ns: u32) {}

    fn ticks(&mut self) -> u32 {
        1
    }

    fn send(&mut self, _bytes: &[u8]) {}

    fn poll(&mut self) -> Option<u8> {
        None
    }

    fn button(&mut self) -> Option<Command> {
        let chosen = self.asked < self.pictures.len() && self.asked < 4;
        self.asked = self.pictures.len();
        chosen.then_some(Command::NextClip)
    }
}

/// With the name on the display.
fn options() -> Options {
    Options { mode: Mode::Frames(2), hud: true, ..Options::parse([]) }
}

#[test]
fn a_stored_banks_clips_are_played_before_those_of_the_program() {
    let bank = Bank::new_checked(BANK).unwrap();
    let own = bank.entries().map(|entry| Entry { name: entry.name(), bytes: entry.bytes(), rig: bank.rig_bytes() });
    let run_clip = Entry { name: "run", bytes: RUN, rig: &[] };
    let all: Vec<Entry> = own.chain([run_clip]).collect();
    assert!(all.len() > 2, "the bank has clips");
    let mut built_in = Mock::default();
    assert_eq!(run(&all, options(), &mut Framebuffer::new(), &mut built_in), Exit::Done);

    let (store, _) = mock::store::<4, 1024>(64);
    let [mut first, second] = store.into_slots();
    let header = Header { info: ClipInfo::of(BANK, "moves").unwrap(), sequence: 1 };
    first.flash[..header.bytes().len()].copy_from_slice(&header.bytes());
    first.flash[BLOCK_BYTES..][..BANK.len()].copy_from_slice(BANK);
    let mut stored = Mock::default();
    let exit = run_stored(&mut Store::new([first, second]), &[run_clip], options(), &mut Framebuffer::new(), &mut stored);
    assert_eq!(exit, Exit::Done);
    assert!(built_in.pictures.len() > 4 && built_in.pictures == stored.pictures);
    let clips: Vec<&Vec<u8>> = built_in.pictures.iter().take(all.len()).collect();
    assert!(clips.iter().enumerate().all(|(index, picture)| !clips[..index].contains(picture)), "each has its name");
}
