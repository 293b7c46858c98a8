//! The program: plays clips one after the other, in the only loop over frames.

use crate::board::{Board, Exit};
use crate::capacity::Capacity;
use crate::commands::{Command, LETTERS};
use crate::content::build::build;
use crate::content::{AnyContent, Content};
use crate::hud;
use crate::log::{error, info};
use crate::menu;
use crate::options::{Mode, NEXT, Options, QUIT, SHOWN};
use crate::session::{Entry, Outcome, PlayContext};
use crate::source::Source;
use crate::update::Listener;
use crate::view_state::{Effect, ViewState};
use heapless::Deque;
use pantin::{Clip, Player};
use pantin_figure::surface::Framebuffer;

/// Effects of commands that were received since the last picture. A user who gives more between two pictures loses them.
type Effects = Deque<Effect, 8>;

/// Plays clips until the mode ends. Without a clip it returns at once.
///
/// Returns [`Exit::BadClip`] for a clip that is damaged or larger than [`Board::Capacity`].
pub fn run<B: Board>(entries: &[Entry], options: Options, framebuffer: &mut Framebuffer<B::Layout>, board: &mut B) -> Exit {
    let mut view_state = ViewState::new(&options);
    view_state.idle.several = entries.len() > 1;
    let mut at = 0;
    while let Some(entry) = entries.get(at) {
        let listener = Listener::default();
        let mut context = PlayContext { mode: options.mode, view_state: &mut view_state, framebuffer, board, listener };
        match open(entry, Task::Play { from: 0 }, &mut context) {
            Outcome::Clip(steps) => at = (at as i32 + steps).rem_euclid(entries.len() as i32) as usize,
            Outcome::Exit(exit) => return exit,
            #[cfg(feature = "update")]
            Outcome::Received(_) | Outcome::Playable => {}
        }
    }
    Exit::Done
}

/// What to do with a clip that is set up.
#[derive(Clone, Copy)]
pub(crate) enum Task {
    /// Play it from a frame.
    Play { from: u32 },
    /// Report that it can be played.
    #[cfg(feature = "update")]
    Check,
}

/// Opens a clip, builds its content and plays it.
pub(crate) fn open<B: Board>(entry: &Entry, task: Task, context: &mut PlayContext<B>) -> Outcome {
    let clip = match Clip::with_rig(entry.bytes, entry.rig) {
        Ok(clip) => clip,
        Err(error) => {
            error!("the clip cannot be opened: {}", error);
            return Outcome::Exit(Exit::BadClip);
        }
    };
    // One by one: as a pair they would be copied, which takes their stack twice.
    let mut states = B::Capacity::states();
    let mut pose = B::Capacity::pose();
    let mut player = match Player::new(clip, states.as_mut(), pose.as_mut()) {
        Ok(player) => player,
        Err(error) => {
            error!("the clip is too big: {}", error);
            return Outcome::Exit(Exit::BadClip);
        }
    };
    info!(
        "{}: {} frames of {} ns, {} channels, {} of them moving",
        entry.name,
        player.clip().frames(),
        player.clip().frame_time_ns(),
        player.clip().rig().channels(),
        player.states().len()
    );
    build(&mut player, context, |player, content, context| match task {
        Task::Play { from } => start(entry, player, from, content, context),
        #[cfg(feature = "update")]
        Task::Check => Outcome::Playable,
    })
}

/// Plays a clip's content from a frame, with poses of the clip or of the link.
fn start<B: Board>(
    entry: &Entry,
    player: &mut Player,
    from: u32,
    content: &mut AnyContent<B>,
    context: &mut PlayContext<B>,
) -> Outcome {
    if from > 0 {
        player.seek(from);
    }
    #[cfg(feature = "link")]
    if context.view_state.link {
        let line = crate::source::link::LineSettings {
            parity: context.view_state.fec,
            #[cfg(feature = "key")]
            key: context.view_state.key,
            // The letters of the mode `sync` come from a test's line.
            #[cfg(feature = "key")]
            sync: context.mode == Mode::Sync,
        };
        return crate::source::link::open::<B>(player, line, |source| play(&mut [Actor { entry, source, content }], context));
    }
    play(&mut [Actor { entry, source: player, content }], context)
}

/// A figure on the display: what gives its poses, and what draws them.
pub(crate) struct Actor<'a, B: Board, S> {
    /// The clip.
    pub entry: &'a Entry<'a>,
    pub source: &'a mut S,
    pub content: &'a mut AnyContent<'a, B>,
}

/// Plays figures side by side until the mode ends or a command chooses another clip: the loop over frames. Frame time and frame number are
/// those of the first figure; commands apply to all.
#[inline(never)]
pub(crate) fn play<B: Board, S: Source>(actors: &mut [Actor<B, S>], context: &mut PlayContext<B>) -> Outcome {
    let PlayContext { mode, view_state, framebuffer, board, listener } = context;
    let (mode, view_state, framebuffer, board) = (*mode, &mut **view_state, &mut **framebuffer, &mut **board);
    // A live source and a state machine go on by themselves, and a host or a test asks for its pictures.
    let idles = mode == Mode::Play && S::COMMANDS && !S::LIVE;
    let mut frame_ns = actors.first().map_or(0, |first| first.source.frame_time_ns());
    let (mut frames, mut shown, mut late) = (0, 0u32, 0u32);
    let mut effects = Effects::new();
    if mode != Mode::Sync {
        board.start_timer(view_state.tick_ns(frame_ns));
    }
    loop {
        let before = actors.first().map_or(0, |first| first.source.frame());
        advance(actors, frames, board);
        if let Some(exit) = actors.first().and_then(|first| first.source.ended()) {
            return Outcome::Exit(exit);
        }
        set_poses(actors, board);
        draw(actors, view_state, framebuffer, board);
        let Some(first) = actors.first_mut() else { break };
        if idles && frames > 0 && first.source.frame() < before && view_state.idle.is_over() {
            view_state.idle.begin_clip();
            return Outcome::Clip(1);
        }
        if S::LIVE && mode != Mode::Sync && first.source.frame_time_ns() != frame_ns {
            frame_ns = first.source.frame_time_ns();
            board.start_timer(frame_ns);
        }
        show_text(first, view_state, idles, framebuffer, board);
        present(framebuffer, board);
        // Between the pictures of `Sync`, the line has its own protocol.
        #[cfg(feature = "events")]
        if mode != Mode::Sync {
            let since = if shown == 0 { crate::events::Since::Start } else { crate::events::Since::Frame(before) };
            first.source.hear(since, frames, &mut |event| board.event(event));
        }
        shown = shown.wrapping_add(1);
        listener.frame_shown();
        let ticks = match mode {
            Mode::Sync => wait_for_request(first.source, view_state, &mut effects, listener, board),
            Mode::Frames(count) if shown >= count => None,
            Mode::Frames(_) | Mode::Play => Some(wait_for_tick(first.source, view_state, &mut effects, listener, board)),
        };
        let Some(ticks) = ticks else { break };
        late = late.wrapping_add(ticks.saturating_sub(1));
        view_state.idle.pass(ticks, view_state.tick_ns(frame_ns));
        if idles && view_state.idle.is_alone() {
            view_state.menu = None;
        }
        #[cfg(feature = "update")]
        if listener.is_complete() {
            return Outcome::Received(first.source.frame());
        }
        // In real time a board that is too slow for every frame skips some.
        frames = view_state.frames(if mode == Mode::Play { ticks } else { 1 });
        while let Some(effect) = effects.pop_front() {
            match effect {
                Effect::Nothing => {}
                Effect::Aim => aim(actors, view_state),
                _ if S::LIVE => {}
                Effect::Rate if mode == Mode::Sync => {}
                Effect::Rate => board.start_timer(view_state.tick_ns(frame_ns)),
                Effect::Move(by) => frames = by,
                Effect::Clip(steps) => {
                    view_state.idle.begin_clip();
                    return Outcome::Clip(steps);
                }
                Effect::Help => help(board),
            }
        }
        if S::LIVE {
            frames = 1;
        }
    }
    info!("{} pictures, {} ticks late", shown, late);
    if let Some(first) = actors.first() {
        first.source.log();
    }
    Outcome::Exit(Exit::Done)
}

/// Shows the menu, what the display reports of the source, or a caption; on a display that is to be dark, nothing, the picture neither.
fn show_text<B: Board, S: Source>(
    first: &Actor<B, S>,
    view_state: &ViewState,
    idles: bool,
    framebuffer: &mut Framebuffer<B::Layout>,
    board: &mut B,
) {
    if idles && view_state.idle.is_dark() {
        framebuffer.clear();
        board.overlay([""; 2]);
    } else if let Some(at) = view_state.menu {
        let [top, bottom] = menu::lines(view_state, at, hud::columns::<B::Layout>());
        hud::lines([&top, &bottom], framebuffer, board);
    } else if view_state.hud {
        hud::show(view_state, first.entry.name, &first.source.status(), framebuffer, board);
    } else if idles && view_state.idle.has_caption() {
        hud::caption(first.entry, framebuffer, board);
    } else {
        board.overlay([""; 2]);
    }
}

/// Reports the frame that is on the display and takes commands until the next picture is asked for. Returns 1, or `None` if the program is
/// to end.
#[inline(never)]
fn wait_for_request<B: Board>(
    source: &mut impl Source,
    view_state: &mut ViewState,
    effects: &mut Effects,
    listener: &mut Listener,
    board: &mut B,
) -> Option<u32> {
    board.send(&[SHOWN]);
    board.send(&source.frame().to_le_bytes());
    while !listener.is_complete() {
        let byte = board.receive();
        match listener.receive(byte, board).and_then(|byte| source.receive(byte)) {
            Some(NEXT) => break,
            Some(QUIT) => return None,
            letter => queue(letter.and_then(Command::from_letter), view_state, effects),
        }
    }
    Some(1)
}

/// Waits until the timer ticks and takes the commands that arrived meanwhile. Returns the number of ticks: at least 1.
///
/// With a clip the processor may sleep meanwhile; a live source reads the line all the time, because a serial port holds few bytes.
fn wait_for_tick<B: Board, S: Source>(
    source: &mut S,
    view_state: &mut ViewState,
    effects: &mut Effects,
    listener: &mut Listener,
    board: &mut B,
) -> u32 {
    let mut ticks = if S::LIVE { 0 } else { board.wait_ticks() };
    let mut silent = true;
    while !listener.is_complete() {
        match board.poll() {
            Some(byte) => {
                silent = false;
                let letter = listener.receive(byte, board).and_then(|byte| source.receive(byte));
                queue(letter.and_then(Command::from_letter), view_state, effects);
            }
            None if ticks > 0 => break,
            None => ticks = board.ticks(),
        }
    }
    if S::LIVE && silent {
        queue(source.receive_nothing().and_then(Command::from_letter), view_state, effects);
    }
    while S::COMMANDS
        && let Some(command) = board.button()
    {
        queue(Some(command), view_state, effects);
    }
    ticks
}

fn queue(command: Option<Command>, view_state: &mut ViewState, effects: &mut Effects) {
    if let Some(command) = command
        && view_state.idle.touch()
    {
        let _ = effects.push_back(menu::apply(view_state, command));
    }
}

fn aim<B: Board, S: Source>(actors: &mut [Actor<B, S>], view_state: &ViewState) {
    for Actor { source, content, .. } in actors {
        source.with_player(|player| Content::<B::Layout>::aim(*content, player, view_state.view, view_state.style));
    }
}

/// Sends the list of letters and their commands, one per line.
#[inline(never)]
fn help<B: Board>(board: &mut B) {
    for (letter, _, words) in LETTERS {
        board.send(&[letter, b' ']);
        board.send(words.as_bytes());
        board.send(b"\r\n");
    }
}

// The four sections of a frame whose instructions an emulator counts. They are not inlined, so that a profile names them.

#[inline(never)]
fn advance<B: Board, S: Source>(actors: &mut [Actor<B, S>], frames: i32, board: &mut B) {
    #[cfg(feature = "steer")]
    for actor in &mut *actors {
        actor.source.hold(board.held());
    }
    board.mark_start();
    for actor in actors {
        actor.source.advance(frames);
    }
    board.mark_stop();
}

#[inline(never)]
fn set_poses<B: Board, S: Source>(actors: &mut [Actor<B, S>], board: &mut B) {
    board.mark_start();
    for Actor { source, content, .. } in actors {
        #[cfg(feature = "steer")]
        if let Some(stand) = source.stand() {
            Content::<B::Layout>::set_pose_at(*content, source.pose(), stand);
            continue;
        }
        Content::<B::Layout>::set_pose(*content, source.pose());
    }
    board.mark_stop();
}

#[inline(never)]
fn draw<B: Board, S: Source>(
    actors: &mut [Actor<B, S>],
    view_state: &ViewState,
    framebuffer: &mut Framebuffer<B::Layout>,
    board: &mut B,
) {
    board.mark_start();
    framebuffer.clear();
    let mut style = view_state.style;
    for actor in actors {
        actor.content.draw(framebuffer, style);
        // The first figure's floor is everyone's.
        style.lines.ground &= !S::ONE_WORLD;
    }
    board.mark_stop();
}

#[inline(never)]
fn present<B: Board>(framebuffer: &mut Framebuffer<B::Layout>, board: &mut B) {
    board.mark_start();
    board.present(framebuffer);
    board.mark_stop();
}
