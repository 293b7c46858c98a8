//! The show that comes over the line: packets in, a picture a frame out. The clip that the program was built with gives the rig, and the camera.
//!
//! In [`Mode::Sync`] a frame's time is a letter between two zeros, [`NEXT`]; letters of the view's keys come in the same way.

use crate::board::{Board, Exit};
use crate::commands::Command;
use crate::content::Content;
use crate::hud;
use crate::log::{error, info};
use crate::options::Mode;
use crate::run::{NEXT, Outcome, PlayContext, QUIT, SHOWN, show};
use crate::view_state::{Effect, ViewState};
use pantin::Player;
use pantin_link::packet::Receiver;
use pantin_link::{Channel, ClipMismatch, Counts, Link, MAX_PACKET, QUEUE_PACKETS, fits};

/// Most channels of the rig.
const CHANNELS: usize = 144;
/// What is shown of the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct LinkStatus {
    pub counts: Counts,
    pub damaged: u32,
    /// Channels that are exact, and all of them.
    pub exact: [u16; 2],
    pub refusal: Option<ClipMismatch>,
}

/// The line's end.
struct End<'m> {
    receiver: Receiver<MAX_PACKET>,
    link: Link<'m, QUEUE_PACKETS>,
    refusal: Option<ClipMismatch>,
}

impl End<'_> {
    /// Takes a byte, and hands on the letter that it ends.
    fn take(&mut self, byte: u8) -> Option<u8> {
        if let Some(packet) = self.receiver.push(byte) {
            self.refusal = self.link.receive(&packet).err();
        }
        self.receiver.take_key()
    }

    fn status(&self) -> LinkStatus {
        let channels = self.link.head().map_or(0, |head| head.channels);
        let exact = [self.link.exact_channels() as u16, channels];
        LinkStatus { counts: self.link.counts(), damaged: self.receiver.damaged(), exact, refusal: self.refusal }
    }
}

/// Plays what comes over the line until the mode's end, on a stage that is set up.
#[inline(never)]
pub(crate) fn play<B: Board, S: Content<B::Layout> + ?Sized>(
    player: &mut Player,
    renderer: &mut S,
    context: PlayContext<B>,
) -> Outcome {
    let PlayContext { entry, mode, view_state, frame, board, .. } = context;
    let (mut channels, mut pose) = ([Channel::default(); CHANNELS], [0; CHANNELS]);
    let form = player.clip().form();
    if !fits(&form) || player.pose().values.len() > CHANNELS {
        error!("the rig is too big for the line");
        return Outcome::Exit(Exit::BadClip);
    };
    pose.iter_mut().zip(player.pose().values).for_each(|(value, own)| *value = *own);
    let link = Link::new(form, &mut channels, &mut pose);
    let receiver = if view_state.fec { Receiver::with_parity() } else { Receiver::new() };
    let mut end = End { receiver, link, refusal: None };
    let (mut shown, mut frame_ns) = (0u32, player.clip().frame_time_ns());
    board.start_timer(frame_ns);
    loop {
        renderer.set_pose(end.link.pose());
        frame.clear();
        renderer.draw(frame, view_state.style);
        if view_state.hud {
            hud::draw_line(entry, &end.status(), frame);
        }
        show(frame, board);
        shown = shown.wrapping_add(1);
        if mode == Mode::Sync {
            board.send(&[SHOWN]);
            board.send(&end.link.frame().unwrap_or(0).to_le_bytes());
        }
        if matches!(mode, Mode::Frames(count) if shown >= count) || !wait(&mut end, mode, player, renderer, view_state, board) {
            break;
        }
        let exact = end.link.exact_channels();
        end.link.step();
        if exact != end.link.exact_channels() {
            log(&end);
        }
        if let Some(head) = end.link.head().filter(|head| head.frame_time_ns != frame_ns) {
            frame_ns = head.frame_time_ns;
            board.start_timer(frame_ns);
        }
    }
    info!("{} pictures", shown);
    log(&end);
    Outcome::Exit(Exit::Done)
}

/// Listens until it is time for the next frame; false if it is time to end.
fn wait<B: Board, S: Content<B::Layout> + ?Sized>(
    end: &mut End,
    mode: Mode,
    player: &mut Player,
    renderer: &mut S,
    view_state: &mut ViewState,
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
            letter => see(letter.and_then(Command::from_letter), player, renderer, view_state),
        }
        if mode != Mode::Sync && byte.is_none() && board.ticks() > 0 {
            // A letter that was typed has nothing behind it.
            let typed = if heard { None } else { end.receiver.take_key_after_timeout() };
            see(board.button().or(typed.and_then(Command::from_letter)), player, renderer, view_state);
            return true;
        }
    }
}

/// Takes a key of the view; time is the sender's.
fn see<L: pantin_figure::surface::Layout, S: Content<L> + ?Sized>(
    key: Option<Command>,
    player: &mut Player,
    renderer: &mut S,
    view_state: &mut ViewState,
) {
    if let Some(key) = key
        && view_state.take(key) == Effect::Aim
    {
        renderer.aim(player, view_state.view);
    }
}

fn log(end: &End) {
    let LinkStatus { counts, damaged, exact, refusal } = end.status();
    info!(
        "{} packets, {} missing, {} damaged, {} foreign, {} crowded; {} states lost; {} of {} channels exact",
        counts.packets, counts.missing, damaged, counts.rejected, counts.dropped, counts.desyncs, exact[0], exact[1]
    );
    if let Some(refusal) = refusal {
        error!("the line's clip cannot be played: {}", refusal);
    }
    let _ = (counts, damaged, exact);
}
