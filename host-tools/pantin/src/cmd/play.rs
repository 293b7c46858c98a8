//! `pantin play`

use super::render::{Side, Size, StyleName, read_look};
use super::up_axis;
use super::{Files, rig_is_needed};
use crate::open::is_bank;
use crate::output::{noticed, report, take_stdout};
use crate::play::cells::Dots;
use crate::play::colours::Colours;
use crate::play::figure::Figure;
use crate::play::meters::Meters;
use crate::play::picture::{Show, Title, draw};
use crate::play::play_time::PlayTime;
use crate::play::playback::{Playback, Room};
use crate::play::session::{Outcome, Session};
use crate::play::settings::{PALETTE, Settings};
use crate::play::steering::Steering;
use crate::play::terminal::Terminal;
use anyhow::{Context, Result, bail, ensure};
use pantin::Clip;
use pantin::Up;
use pantin_convert::expand::expand_within;
use pantin_figure::solid::Look;
use pantin_figure::{CameraTarget, View};
use pantin_images::palette::Palette;
use pantin_pictures::face::cast::is_face;
use pantin_pictures::machine::playback::{Room as SteeringRoom, has_machine};
use pantin_pictures::render::figure::PlayerBuffers;
use serde_json::json;
use std::io::{IsTerminal, Write, stdin, stdout};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Play clips, or a bank's state machine, in the terminal, drawn by the firmware's own figure code.
///
/// A bank with a state machine is steered by keys: arrows and letters make its inputs, ? lists them, and the last row shows the state, the inputs, the parameters and, for a machine with `[feet]`, which joints are on the ground.
///
/// A clip without joints plays as a face, if its scalars have names listed in docs/FACE.md, otherwise as one bar per channel. Keys: space pause, comma and period step, r reverse, + and - speed, n and p next and
/// previous clip, arrows (or a, d, w, s) orbit and tilt, v view, f follow or fixed camera, g ground, o lines or solid, b braille or half blocks, ? help, q quit.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin play walk.ptn
  pantin play walk.ptn run.ptn --palette amber --dots half
  pantin play walk.ptn --style solid
  pantin play walk.ptn --style solid --look motions/looks/cat.look
  pantin play character.ptb
  pantin play walk.ptn --plain --once --frames 10 --size 60x20 > frames.txt

Palettes: grey, mono, phone (a hue for each side of the figure), oled, amber, green, blueprint, paper, dusk, or colours: RRGGBB,RRGGBB (paper and ink).
COLORTERM and TERM determine the number of colours; NO_COLOR disables them.")]
pub struct Arguments {
    /// The clips, or one bank with a state machine
    #[arg(required = true)]
    inputs: Vec<PathBuf>,
    /// The rig of clips that were made with --rig-out
    #[arg(long)]
    rig: Option<PathBuf>,
    /// How pixels become characters [default: auto]
    #[arg(long, default_value = "auto", hide_default_value = true)]
    dots: DotsOrAuto,
    /// The terminal's colours [default: from the environment]
    #[arg(long, conflicts_with = "plain")]
    colours: Option<Colours>,
    /// The picture's colours: a name, or paper and ink [see below]
    #[arg(long, default_value = PALETTE, conflicts_with = "plain")]
    palette: Palette,
    /// Side to see it from: front, side, left, right, back, quarter, or degrees
    /// [default: quarter; a face: front]
    #[arg(long, value_name = "SIDE", allow_hyphen_values = true)]
    view: Option<Side>,
    /// The direction that is vertical, instead of the one that the clip states: x, y, z, -x, -y or -z
    #[arg(long, value_name = "AXIS", value_parser = up_axis, allow_hyphen_values = true)]
    up: Option<Up>,
    /// What a body is drawn as at first
    #[arg(long, value_enum, default_value = "lines")]
    style: StyleName,
    /// The character that is drawn with volume: a .look file [default: a person in a pale shirt and blue trousers]
    #[arg(long, value_name = "FILE")]
    look: Option<PathBuf>,
    /// Start with a fixed camera instead of following the figure
    #[arg(long)]
    fixed: bool,
    /// Exit at the end of the last clip instead of repeating
    #[arg(long)]
    once: bool,
    /// Exit after N pictures
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    frames: Option<u32>,
    /// Print all frames as text, one below the other and without waiting; needs no terminal
    #[arg(long)]
    plain: bool,
    /// Columns and rows of characters for --plain
    #[arg(long, value_name = "COLUMNSxROWS", default_value = "80x24", requires = "plain")]
    size: Size,
}

/// How pixels become characters.
#[derive(Clone, Copy, clap::ValueEnum)]
enum DotsOrAuto {
    /// Half blocks in a terminal with many rows, otherwise braille.
    Auto,
    /// Two pixels per character, each in its colour.
    Half,
    /// Eight pixels per character, in one colour.
    Braille,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    let files =
        arguments.inputs.iter().map(|input| Files::read_to_show(input, arguments.rig.as_deref())).collect::<Result<Vec<_>>>()?;
    if files.iter().any(|file| is_bank(file.clip()) && has_machine(file.clip())) {
        return arguments.steer(&files);
    }
    let opened =
        files.iter().zip(&arguments.inputs).map(|(file, input)| file.open().with_context(|| input.display().to_string()));
    let clips: Vec<Clip> = opened.collect::<Result<_>>()?;
    rig_is_needed(arguments.rig.as_deref(), &clips)?;
    let joints = clips.iter().any(|clip| clip.rig().joint_count() > 0);
    ensure!(joints || arguments.up.is_none(), "--up has no effect: no clip has joints");
    ensure!(joints || !arguments.fixed, "--fixed has no effect: no clip has joints");
    let is_seen = |clip: &Clip| is_face(clip).map(|face| face || clip.rig().joint_count() > 0);
    let seen = clips.iter().map(is_seen).collect::<Result<Vec<_>>>()?;
    ensure!(seen.contains(&true) || arguments.view.is_none(), "--view has no effect: no clip has joints or a face");
    // Pictures are all that is printed there.
    take_stdout();
    let shown = |(clip, input): (&Clip, &PathBuf)| json!({"file": input.display().to_string(), "frames": clip.frames(), "seconds": clip.duration_ns() as f64 * 1e-9});
    report(json!({"clips": clips.iter().zip(&arguments.inputs).map(shown).collect::<Vec<_>>()}));
    if arguments.plain {
        return arguments.plainly(&clips);
    }
    ensure!(
        stdin().is_terminal() && stdout().is_terminal(),
        "play needs a terminal for its pictures and keys; --plain writes text to a pipe or a file, and pantin render pictures"
    );
    let settings = arguments.settings()?;
    let mut session = Session::new(Terminal::enter(settings.colours)?, settings, arguments.once, arguments.frames);
    let mut index = 0;
    loop {
        let clip = clips[index];
        let title = arguments.title(&clip, index);
        let outcome = with_show(&clip, arguments.ahead(), |show| session.play(show, &title, clip.frame_time_ns()))
            .with_context(|| arguments.inputs[index].display().to_string())?;
        index = match outcome {
            Outcome::Quit => break,
            Outcome::Over if index + 1 == clips.len() => break,
            Outcome::Over => index + 1,
            Outcome::Clip(clips_on) => (index as isize + clips_on).rem_euclid(clips.len() as isize) as usize,
        };
    }
    Ok(())
}

/// Sets up what shows a clip.
fn with_show<T>(clip: &Clip, ahead: View, play: impl FnOnce(&mut dyn Show) -> Result<T>) -> Result<T> {
    if clip.rig().joint_count() == 0 && !is_face(clip)? {
        return play(&mut Meters::of(expand_within(clip, crate::memory::limit())?));
    }
    let (mut room, mut memory) = (Room::of(clip), PlayerBuffers::of(clip));
    let playback = Playback::new(*clip, &mut room)?;
    play(&mut Figure::new(playback, memory.player(*clip)?, ahead))
}

impl Arguments {
    fn settings(&self) -> Result<Settings> {
        let track = if self.fixed { CameraTarget::Fixed } else { CameraTarget::Follow };
        let of_environment = Settings::of_environment()?;
        let dots = match self.dots {
            DotsOrAuto::Auto => of_environment.dots,
            DotsOrAuto::Half => Some(Dots::Half),
            DotsOrAuto::Braille => Some(Dots::Braille),
        };
        let view = View {
            orbit: self.view.as_ref().map_or(View::default().orbit, |side| side.orbit),
            track,
            up: self.up,
            ..View::default()
        };
        let look = self.look.as_deref().map_or(Ok(Look::DEFAULT), read_look)?;
        Ok(Settings {
            view,
            solid: self.style == StyleName::Solid,
            look,
            dots,
            colours: self.colours.unwrap_or(of_environment.colours),
            palette: self.palette.clone(),
            ..of_environment
        })
    }

    /// Plays a bank's state machine.
    fn steer(&self, files: &[Files]) -> Result<()> {
        let [file] = files else { bail!("a bank with a state machine plays alone") };
        let place = || self.inputs[0].display().to_string();
        ensure!(self.rig.is_none(), "{}: --rig has no effect: a bank holds its rig", place());
        ensure!(self.look.is_none(), "{}: --look has no effect: a character of a state machine is drawn as lines", place());
        ensure!(!self.once, "{}: --once has no effect: a state machine does not end", place());
        ensure!(self.up.is_none(), "{}: --up has no effect: a figure that travels goes by its rig's up", place());
        let name = self.inputs[0].file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let mut steering = Steering::new(file.clip(), name).with_context(place)?;
        take_stdout();
        report(json!({"file": place()}));
        if self.plain {
            let frames =
                self.frames.with_context(|| format!("{}: --plain needs --frames: a state machine does not end", place()))?;
            let settings = Settings { colours: Colours::None, ..self.settings()? };
            let (mut room, mut feet) = (SteeringRoom::of(file.clip())?, pantin_animator::Feet::new());
            let mut character = room.character(file.clip(), &mut feet).with_context(place)?;
            let mut out = stdout().lock();
            for _ in 0..frames {
                let grid = steering.draw(&character, &settings, self.size.0).with_context(place)?;
                noticed(out.write_all(grid.text().as_bytes())).context("the text cannot be written")?;
                character.update(33_333).with_context(place)?;
            }
            return Ok(());
        }
        ensure!(
            stdin().is_terminal() && stdout().is_terminal(),
            "play needs a terminal for its pictures and keys; --plain writes text, and pantin steer pictures of a session"
        );
        let settings = self.settings()?;
        let mut session = Session::new(Terminal::enter(settings.colours)?, settings, false, self.frames);
        steering.play(&mut session).with_context(place)
    }

    /// The view from which a face is looked in the eyes.
    fn ahead(&self) -> View {
        View { orbit: if self.view.is_some() { 0 } else { View::default().orbit }, ..View::default() }
    }

    fn title(&self, clip: &Clip, index: usize) -> Title {
        let name = Path::new(&self.inputs[index]).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let frame_time = f64::from(clip.frame_time_ns()) * 1e-9;
        Title { name, place: [index, self.inputs.len()], frames: clip.frames(), frame_time }
    }

    /// All frames of all clips, or as many as are asked for (of one clip, more than it has if it is not to play once).
    fn plainly(&self, clips: &[Clip]) -> Result<()> {
        let settings = Settings { colours: Colours::None, ..self.settings()? };
        let mut out = stdout().lock();
        let mut left = self.frames.unwrap_or(u32::MAX);
        for (index, clip) in clips.iter().enumerate() {
            let title = self.title(clip, index);
            let loops = !self.once && self.frames.is_some() && index + 1 == clips.len();
            let frames = if loops { left } else { left.min(clip.frames()) };
            with_show(clip, self.ahead(), |show| {
                for frame in 0..frames {
                    let clock = PlayTime::new(clip.frame_time_ns(), Duration::ZERO);
                    let grid = draw(show, &title, frame % clip.frames(), &clock, &settings, self.size.0)?;
                    noticed(out.write_all(grid.text().as_bytes())).context("the text cannot be written")?;
                }
                Ok(())
            })
            .with_context(|| self.inputs[index].display().to_string())?;
            left -= frames;
        }
        Ok(())
    }
}
