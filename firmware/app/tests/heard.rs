//! Events of a clip, as a board hears them.
#![cfg(feature = "events")]

use pantin_app::{Board, Command, Entry, Exit, HeardEvent, MaxClip, Mode, Options, run};
use pantin_figure::rotation::Rotation;
use pantin_figure::surface::{Framebuffer, Gray4Rows};

/// 40 frames, not a loop; events at 0, twice at 7, at 30 and at 39.
const CLIP: &[u8] = include_bytes!("../../../tests/vectors/event-names.ptn");

/// A board whose timer ticks `ticks` times a picture, with commands at some pictures.
#[derive(Default)]
struct Mock {
    ticks: u32,
    picture: usize,
    commands: Vec<(usize, Command)>,
    heard: Vec<(u32, u32)>,
    line: Vec<u8>,
    own_ears: bool,
}

impl Board for Mock {
    type Layout = Gray4Rows<128, 64, 1024>;
    type Rotation = Rotation;
    type Capacity = MaxClip<144, 96, 36>;

    fn present(&mut self, _framebuffer: &mut Framebuffer<Self::Layout>) {
        self.picture += 1;
    }

    fn start_timer(&mut self, _period_ns: u32) {}

    fn ticks(&mut self) -> u32 {
        self.ticks
    }

    fn send(&mut self, bytes: &[u8]) {
        self.line.extend_from_slice(bytes);
    }

    fn poll(&mut self) -> Option<u8> {
        None
    }

    fn button(&mut self) -> Option<Command> {
        let (_, command) = self.commands.pop_if(|(picture, _)| *picture == self.picture)?;
        Some(command)
    }

    fn event(&mut self, event: HeardEvent) {
        self.heard.push((event.frame, event.id));
        if !self.own_ears {
            event.send(|bytes| self.line.extend_from_slice(bytes));
        }
    }
}

fn play(mut board: Mock, pictures: u32) -> Mock {
    board.ticks = board.ticks.max(1);
    let options = Options { mode: Mode::Frames(pictures), ..Options::parse([]) };
    let entries = [Entry { name: "events", bytes: CLIP, rig: &[] }];
    assert_eq!(run(&entries, options, &mut Framebuffer::new(), &mut board), Exit::Done);
    board
}

#[test]
fn events_are_heard_once_each_time_round() {
    let once = [(0, 0), (7, 3), (7, 1), (30, 9), (39, 0)];
    assert_eq!(play(Mock::default(), 7).heard, once[..1]);
    assert_eq!(play(Mock::default(), 8).heard, once[..3]);
    assert_eq!(play(Mock::default(), 40).heard, once);
    assert_eq!(play(Mock::default(), 80).heard, [once, once].concat());
}

#[test]
fn a_line_reports_frame_and_name_or_id() {
    let text = String::from_utf8(play(Mock::default(), 31).line).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "event 0 left_foot_down");
    assert!(lines[1].starts_with("event 7 long long"), "{}", lines[1]);
    assert_eq!(lines[2..], ["event 7 1", "event 30 9"]);
}

#[test]
fn backwards_and_by_commands_they_are_heard_too() {
    // Picture 3 shows frame 2; from there back, over frame 0 to the last one.
    let back = Mock { commands: vec![(3, Command::Reverse)], own_ears: true, ..Mock::default() };
    assert_eq!(play(back, 6).heard, [(0, 0), (0, 0), (39, 0)]);
    let paused = Mock { commands: vec![(4, Command::Pause)], own_ears: true, ..Mock::default() };
    assert_eq!(play(paused, 20).heard, [(0, 0)]);
}
