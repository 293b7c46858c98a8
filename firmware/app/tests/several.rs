//! Commands while several figures play: from the serial line, from a button, and between two pictures of [`Mode::Sync`].

use pantin_app::{Board, Command, Entry, Exit, FigureBuffers, MaxClip, Mode, NEXT, Options, QUIT, multi};
use pantin_figure::rotation::Rotation;
use pantin_figure::surface::{Framebuffer, Gray4Rows, Layout};
use std::collections::VecDeque;

type Oled = Gray4Rows<128, 64, 1024>;

const WALK: &[u8] = include_bytes!("../../../motions/walk.ptn");

/// A board on the host. Its timer ticks once a picture, and a command waits in each tick that `letters` or `buttons` name.
#[derive(Default)]
struct Mock {
    tick: usize,
    /// Bytes that [`Board::receive`] returns, in [`Mode::Sync`].
    line: VecDeque<u8>,
    /// A byte that the line has received in a tick.
    letter: Option<(usize, u8)>,
    /// A button that was pressed in a tick.
    button: Option<(usize, Command)>,
    pictures: Vec<Vec<u8>>,
    periods: Vec<u32>,
}

impl Board for Mock {
    type Layout = Oled;
    type Rotation = Rotation;
    type Capacity = MaxClip<144, 96, 36>;

    fn present(&mut self, framebuffer: &mut Framebuffer<Oled>) {
        let pixels = |row| (0..Oled::WIDTH).map(move |column| (column, row));
        let pixels = (0..Oled::HEIGHT).flat_map(pixels);
        self.pictures.push(
            pixels.map(|(column, row)| embedded_graphics::prelude::GrayColor::luma(&framebuffer.pixel(column, row))).collect(),
        );
    }

    fn start_timer(&mut self, period_ns: u32) {
        self.periods.push(period_ns);
    }

    fn ticks(&mut self) -> u32 {
        self.tick += 1;
        1
    }

    fn send(&mut self, _bytes: &[u8]) {}

    fn poll(&mut self) -> Option<u8> {
        let (_, letter) = self.letter.take_if(|(tick, _)| *tick == self.tick)?;
        Some(letter)
    }

    fn receive(&mut self) -> u8 {
        self.line.pop_front().unwrap_or(QUIT)
    }

    fn button(&mut self) -> Option<Command> {
        let (_, command) = self.button.take_if(|(tick, _)| *tick == self.tick)?;
        Some(command)
    }
}

fn play(mut board: Mock, mode: Mode) -> Mock {
    let options = Options { mode, ..Options::parse([]) };
    let mut buffers = [FigureBuffers::empty(), FigureBuffers::empty()];
    let entries = [Entry { name: "walk", bytes: WALK, rig: &[] }];
    assert_eq!(multi(&entries, options, &mut buffers, &mut Framebuffer::new(), &mut board), Exit::Done);
    board
}

const PICTURES: u32 = 4;

#[test]
fn a_letter_and_a_button_turn_the_view_of_all_figures() {
    let plain = play(Mock::default(), Mode::Frames(PICTURES));
    let typed = play(Mock { letter: Some((2, b'v')), ..Mock::default() }, Mode::Frames(PICTURES));
    let pressed = play(Mock { button: Some((2, Command::View)), ..Mock::default() }, Mode::Frames(PICTURES));
    let front = play(Mock { line: [b'v', NEXT].into(), ..Mock::default() }, Mode::Sync);
    assert_eq!(plain.pictures[..2], typed.pictures[..2]);
    assert_ne!(plain.pictures[2], typed.pictures[2]);
    assert_eq!(typed.pictures, pressed.pictures);
    let synced = play(Mock { line: [NEXT, b'v', NEXT].into(), ..Mock::default() }, Mode::Sync);
    assert_eq!(typed.pictures[..3], synced.pictures[..]);
    assert_ne!(front.pictures[1], plain.pictures[1]);
    assert_eq!(plain.pictures[0], front.pictures[0]);
}

#[test]
fn each_figure_stays_in_its_column_when_the_view_changes() {
    let turned = play(Mock { letter: Some((1, b'v')), ..Mock::default() }, Mode::Frames(PICTURES));
    for picture in &turned.pictures {
        // Above the floor, whose dots reach beyond a figure's column.
        let lit =
            |columns: std::ops::Range<usize>| columns.into_iter().any(|x| (4..40).any(|y| picture[y * Oled::WIDTH + x] > 0));
        assert!(lit(16..48) && lit(80..112) && !lit(0..16) && !lit(48..80) && !lit(112..128));
    }
}

#[test]
fn pause_and_speed_are_those_of_all_figures() {
    let paused = play(Mock { letter: Some((1, b' ')), ..Mock::default() }, Mode::Frames(PICTURES));
    assert!(paused.pictures.iter().all(|picture| *picture == paused.pictures[0]));
    let plain = play(Mock::default(), Mode::Frames(PICTURES));
    assert_ne!(plain.pictures[0], plain.pictures[1]);
    let faster = play(Mock { letter: Some((1, b'+')), ..Mock::default() }, Mode::Frames(PICTURES));
    assert_eq!(faster.periods, [plain.periods[0], plain.periods[0] / 2]);
}
