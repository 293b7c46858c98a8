//! A board to which nobody gives commands: it plays clip after clip, says which one begins, and gets dark.

use pantin_app::{Board, Command, Entry, Exit, MaxClip, Mode, Options, run};
use pantin_figure::rotation::Rotation;
use pantin_figure::surface::{Framebuffer, Gray4Rows, Layout};

type Oled = Gray4Rows<128, 64, 1024>;

const WALK: Entry = Entry { name: "walk", bytes: include_bytes!("../../../motions/walk.ptn"), rig: &[] };
const RUN: Entry = Entry { name: "run", bytes: include_bytes!("../../../motions/run.ptn"), rig: &[] };
/// It ends the program.
const BROKEN: Entry = Entry { name: "broken", bytes: &[], rig: &[] };

/// A board on the host, whose timer ticks once a picture.
struct Mock {
    /// What buttons give, and at which picture.
    presses: Vec<(usize, Command)>,
    overlays: Vec<[String; 2]>,
    lit: Vec<bool>,
}

impl Board for Mock {
    type Layout = Oled;
    type Rotation = Rotation;
    type Capacity = MaxClip<144, 96, 36>;

    fn present(&mut self, framebuffer: &mut Framebuffer<Oled>) {
        let is_lit =
            |row| (0..Oled::WIDTH).any(|column| embedded_graphics::prelude::GrayColor::luma(&framebuffer.pixel(column, row)) > 0);
        self.lit.push((0..Oled::HEIGHT).any(is_lit));
    }

    fn overlay(&mut self, lines: [&str; 2]) -> bool {
        self.overlays.push(lines.map(str::to_owned));
        true
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
        let (_, command) = self.presses.pop_if(|(picture, _)| *picture == self.lit.len())?;
        Some(command)
    }
}

/// Plays until the broken clip. Presses are in order.
fn play(entries: &[Entry], presses: &[(usize, Command)]) -> Mock {
    let presses = presses.iter().rev().copied().collect();
    let mut board = Mock { presses, overlays: vec![], lit: vec![] };
    let options = Options { mode: Mode::Play, ..Options::parse([]) };
    assert_eq!(run(entries, options, &mut Framebuffer::new(), &mut board), Exit::BadClip);
    assert_eq!(board.presses, [], "every press was taken");
    board
}

/// Number of pictures until a clip is left that stays for `seconds`, and number of pictures in `seconds`. A clip is left at the end of a round.
fn round(entry: Entry, seconds: u64) -> (usize, usize) {
    let clip = pantin::Clip::new_checked(entry.bytes).unwrap();
    let pictures = (seconds * 1_000_000_000).div_ceil(clip.frame_time_ns().into()) as usize;
    (pictures.next_multiple_of(clip.frames() as usize), pictures)
}

#[test]
fn clip_follows_clip_with_its_name_and_size() {
    let board = play(&[WALK, RUN, BROKEN], &[]);
    let (walk, run) = (round(WALK, 10).0, round(RUN, 10).0);
    assert_eq!(board.lit.len(), walk + run);
    assert!(board.lit.iter().all(|lit| *lit));
    let caption = ["run".to_owned(), format!("{} bytes", RUN.bytes.len())];
    let captions: Vec<usize> = (0..board.overlays.len()).filter(|picture| board.overlays[*picture] == caption).collect();
    assert_eq!((captions[0], captions.last()), (walk, Some(&(walk + captions.len() - 1))));
    assert!(captions.len().abs_diff(round(RUN, 2).1) <= 1, "{}", captions.len());
    assert!(board.overlays[..walk].iter().all(|lines| lines[0].is_empty()), "the first clip has no caption");
}

#[test]
fn a_clip_that_somebody_chose_stays_a_minute() {
    let board = play(&[WALK, RUN, BROKEN], &[(100, Command::NextClip)]);
    assert_eq!(board.lit.len(), 100 + round(RUN, 60).0);
}

#[test]
fn the_display_gets_dark_after_ten_minutes_and_a_press_lights_it() {
    /// Pictures at 120 a second.
    const TEN_MINUTES: usize = 72_001;
    // A paused clip is not left.
    let presses = [(1, Command::Pause), (TEN_MINUTES + 100, Command::Reverse), (TEN_MINUTES + 200, Command::NextClip)];
    let board = play(&[WALK, BROKEN], &presses);
    let dark: Vec<usize> = (0..board.lit.len()).filter(|picture| !board.lit[*picture]).collect();
    assert!(dark[0].abs_diff(TEN_MINUTES) <= 1, "{}", dark[0]);
    assert_eq!((dark.last(), board.lit.len()), (Some(&(TEN_MINUTES + 99)), TEN_MINUTES + 200));
}
