//! The show that comes over the line: packets in, a picture a frame out. The clip that the program was built with gives the rig, and the camera.
//!
//! In [`Mode::Sync`] a frame's time is a letter between two zeros, [`NEXT`]; letters of the view's keys come in the same way.

use crate::board::{Board, Exit};
use crate::hud;
use crate::keys::Key;
use crate::log::{error, info};
use crate::options::Mode;
use crate::run::{After, NEXT, QUIT, SHOWN, Scenery, show};
use crate::scene::{Scene, Wish};
use crate::show::Show;
use pantin::Player;
use pantin_link::packet::Receiver;
use pantin_link::{Channel, Counts, Form, Link, PACKET, QUEUE, Refusal};

/// Most channels of the rig.
const CHANNELS: usize = 144;
/// What is shown of the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Told {
    pub counts: Counts,
    pub damaged: u32,
    /// Channels that are exact, and all of them.
    pub exact: [u16; 2],
    pub refusal: Option<Refusal>,
}

/// The line's end.
struct End<'m> {
    receiver: Receiver<PACKET>,
    link: Link<'m, QUEUE>,
    refusal: Option<Refusal>,
}

impl End<'_> {
    /// Takes a byte, and hands on the letter that it ends.
    fn take(&mut self, byte: u8) -> Option<u8> {
        if let Some(packet) = self.receiver.push(byte) {
            self.refusal = self.link.take(&packet).err();
        }
        self.receiver.letter()
    }

    fn told(&self) -> Told {
        let channels = self.link.head().map_or(0, |head| head.channels);
        let exact = [self.link.exact() as u16, channels];
        Told { counts: self.link.counts(), damaged: self.receiver.damaged(), exact, refusal: self.refusal }
    }
}

/// Plays what comes over the line until the mode's end, on a stage that is set up.
#[inline(never)]
pub(crate) fn play<B: Board, S: Show<B::Layout> + ?Sized>(player: &mut Player, stage: &mut S, scenery: Scenery<B>) -> After {
    let Scenery { entry, mode, scene, frame, board, .. } = scenery;
    let (mut channels, mut pose) = ([Channel::default(); CHANNELS], [0; CHANNELS]);
    let Some(form) = Form::of(player.clip()).filter(|_| player.pose().len() <= CHANNELS) else {
        error!("the rig is too big for the line");
        return After::Exit(Exit::BadClip);
    };
    pose.iter_mut().zip(player.pose()).for_each(|(value, own)| *value = *own);
    let link = Link::new(form, &mut channels, &mut pose);
    let receiver = if scene.fec { Receiver::mending() } else { Receiver::new() };
    let mut end = End { receiver, link, refusal: None };
    let (mut shown, mut frame_ns) = (0u32, player.clip().frame_time_ns());
    board.start_timer(frame_ns);
    loop {
        stage.place(end.link.pose());
        frame.clear();
        stage.draw(frame, scene.look);
        if scene.hud {
            hud::draw_line(entry, &end.told(), frame);
        }
        show(frame, board);
        shown = shown.wrapping_add(1);
        if mode == Mode::Sync {
            board.send(&[SHOWN]);
            board.send(&end.link.frame().unwrap_or(0).to_le_bytes());
        }
        if matches!(mode, Mode::Frames(count) if shown >= count) || !wait(&mut end, mode, player, stage, scene, board) {
            break;
        }
        let exact = end.link.exact();
        end.link.step();
        if exact != end.link.exact() {
            log(&end);
        }
        if let Some(head) = end.link.head().filter(|head| head.frame_time_ns != frame_ns) {
            frame_ns = head.frame_time_ns;
            board.start_timer(frame_ns);
        }
    }
    info!("{} pictures", shown);
    log(&end);
    After::Exit(Exit::Done)
}

/// Listens until it is time for the next frame; false if it is time to end.
fn wait<B: Board, S: Show<B::Layout> + ?Sized>(
    end: &mut End,
    mode: Mode,
    player: &mut Player,
    stage: &mut S,
    scene: &mut Scene,
    board: &mut B,
) -> bool {
    let mut heard = false;
    loop {
        let byte = if mode == Mode::Sync { Some(board.receive()) } else { board.poll() };
        let letter = byte.and_then(|byte| end.take(byte));
        heard |= byte.is_some();
        match letter {
            Some(NEXT) if mode == Mode::Sync => return true,
            Some(QUIT) if mode == Mode::Sync => return false,
            letter => see(letter.and_then(Key::of_letter), player, stage, scene),
        }
        if mode != Mode::Sync && byte.is_none() && board.ticks() > 0 {
            // A letter that was typed has nothing behind it.
            let typed = if heard { None } else { end.receiver.letter_of_silence() };
            see(board.button().or(typed.and_then(Key::of_letter)), player, stage, scene);
            return true;
        }
    }
}

/// Takes a key of the view; time is the sender's.
fn see<L: pantin_figure::surface::Layout, S: Show<L> + ?Sized>(
    key: Option<Key>,
    player: &mut Player,
    stage: &mut S,
    scene: &mut Scene,
) {
    if let Some(key) = key
        && scene.take(key) == Wish::Aim
    {
        stage.aim(player, scene.view);
    }
}

fn log(end: &End) {
    let Told { counts, damaged, exact, refusal } = end.told();
    info!(
        "{} packets, {} missing, {} damaged, {} foreign, {} crowded; {} states lost; {} of {} channels exact",
        counts.packets, counts.missing, damaged, counts.foreign, counts.crowded, counts.losses, exact[0], exact[1]
    );
    if let Some(refusal) = refusal {
        error!("the line's clip cannot be played: {}", refusal);
    }
    let _ = (counts, damaged, exact);
}
