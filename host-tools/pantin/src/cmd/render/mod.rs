//! `pantin render`

mod output;
mod values;

use super::{Files, check_read, default_output, format_of, up_axis};
use crate::memory;
use crate::output::{Staged, Wanted, check, commit, note, refuse_foreign, report};
use anyhow::{Context, Result, anyhow, bail, ensure};
use output::{Kind, Output};
use pantin::Up;
use pantin_convert::expand::expand_within;
use pantin_face::Model;
use pantin_figure::solid::{Build, Look, look_text};
use pantin_figure::{CameraTarget, View};
use pantin_images::palette::Palette;
use pantin_pictures::face::cast::drives;
use pantin_pictures::face::{Face, cartoon, compact};
use pantin_pictures::render::chart;
use pantin_pictures::render::figure::{FacePlace, Figure, LineStyle, MOST_PIXELS, PlayerBuffers, Style};
use serde_json::json;
use std::path::{Path, PathBuf};
pub use values::{Moment, Side, Size};

/// Pixels on the shorter side from which lines are smooth by default.
const SMOOTH_FROM: usize = 240;
/// Columns that a picture of pixels has about, enlarged: alone or in an animation, and in a sheet.
pub(super) const EASY_TO_SEE: usize = 512;
pub(super) const EASY_TO_SEE_IN_A_SHEET: usize = 256;
const MOST_ENLARGED: usize = 4;
/// Columns and rows of a picture without --size.
const SIZE: &str = "128x64";
/// Colours without --palette.
const PALETTE: &str = "grey";

/// Draw a clip with the firmware's own figure code: as small displays show it, or large and anti-aliased.
///
/// The output's extension selects the kind. .gif and .apng are animations at the clip's own rate (also .png with --animate); .png and .svg are a
/// sheet of twelve frames, or what --frame or --strip select. A clip with a body and a face shows both. A clip without joints is drawn as a face if its scalars have names listed in
/// docs/FACE.md, otherwise as a chart of its channels over time (.png).
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin render walk.ptn -o walk.gif
  pantin render walk.ptn --format png -o - > walk.png
  pantin render walk.ptn -o walk.png --view front,side,quarter
  pantin render walk.ptn -o walk.gif --size 480x480 --palette dusk --fps 25
  pantin render walk.ptn -o walk.gif --style solid --palette phone --size 240x240
  pantin render walk.ptn -o walk.gif --style solid --look motions/looks/dancer.look --palette phone --size 240x240
  pantin render walk.ptn -o stride.svg --strip 8 --from 20 --to 60 --size 160x240 --palette paper
  pantin render walk.ptn -o poster.png --frame 0.5s --size 1200x1600 --palette blueprint
  pantin render face.ptn -o face.png
  pantin render face.ptn --face cartoon --interpolation smile=spherical:60 -o face.gif

Palettes: grey, mono, phone (a hue for each side of the figure), oled, amber, green, blueprint, paper, dusk, or colours: RRGGBB,RRGGBB (paper and ink) or
RRGGBB,RRGGBB,RRGGBB (paper, far, near).")]
pub struct Arguments {
    /// The clip, or a motion file, which is converted first
    input: PathBuf,
    /// The picture to write: .gif, .apng, .png or .svg [default: the clip's name, ending in .gif, or in .png for a still or a chart; a file
    /// that is there already is kept]
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// The format, where the output's name does not say it, as in `-o -`
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// The rig of a clip that was made with --rig-out
    #[arg(long)]
    rig: Option<PathBuf>,
    /// Columns and rows of a picture
    #[arg(long, value_name = "COLUMNSxROWS", default_value = SIZE)]
    size: Size,
    /// Magnify each pixel N times [default: chosen for the picture's size]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=64))]
    scale: Option<u16>,
    /// Colours: a name, or paper and ink [see below]
    #[arg(long, default_value = PALETTE)]
    palette: Palette,
    /// What a body is drawn as
    #[arg(long, value_enum, default_value = "lines")]
    style: StyleName,
    /// The character of --style solid: a .look file [default: a person in a pale shirt and blue trousers]
    #[arg(long, value_name = "FILE")]
    look: Option<PathBuf>,
    /// Draw lines of whole pixels, as the firmware does [default below 240 pixels]
    #[arg(long, conflicts_with = "smooth")]
    pixels: bool,
    /// Draw anti-aliased lines, nearer ones thicker [default from 240 pixels on]
    #[arg(long)]
    smooth: bool,
    /// Sides to see the figure from: front, side, left, right, back, quarter, or degrees (0: it faces the camera, 90: it walks to the left).
    /// With several sides, stills have one row per side and animations show them side by side [default: quarter; a face: front]
    #[arg(long, value_name = "SIDES", value_delimiter = ',', allow_hyphen_values = true)]
    view: Vec<Side>,
    /// Degrees of the camera above the horizon [default: 12; a face: 0]
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = tilt)]
    tilt: Option<i16>,
    /// The direction that is vertical, instead of the one that the clip states: x, y, z, -x, -y or -z
    #[arg(long, value_name = "AXIS", value_parser = up_axis, allow_hyphen_values = true)]
    up: Option<Up>,
    /// Use a fixed camera instead of following the figure
    #[arg(long)]
    fixed: bool,
    /// The face that the clip drives: cartoon, eyes, minimal, or a model of `pantin face model` [default: Pantin's wireframe head; with --face-at neck: cartoon]
    #[arg(long, value_name = "MODEL")]
    face: Option<PathBuf>,
    /// Where a clip with a body and a face shows its face; neck is for --style solid
    #[arg(long, value_enum, value_name = "PLACE", default_value = "beside")]
    face_at: FaceAt,
    /// How a unit of the face moves: linear, improved, eased, or spherical with an angle of 2 to 120 degrees; may be given several times
    #[arg(long, value_name = "UNIT=KIND[:DEGREES]")]
    interpolation: Vec<String>,
    /// Leave out what lies outside the circle that fits the picture, as on a round display
    #[arg(long)]
    round: bool,
    /// First frame to show: a number, or seconds as in 1.5s
    #[arg(long, value_name = "MOMENT")]
    from: Option<Moment>,
    /// Last frame to show
    #[arg(long, value_name = "MOMENT")]
    to: Option<Moment>,
    /// Pictures per second of an animation [default: the clip's rate, or an integer fraction of it if viewers cannot show it]
    #[arg(long)]
    fps: Option<f64>,
    /// Draw one frame
    #[arg(long, value_name = "MOMENT", conflicts_with_all = ["strip", "from", "to"])]
    frame: Option<Moment>,
    /// Draw N frames side by side: evenly spaced with --from or --to, otherwise unevenly, to show different phases of the strides
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=64))]
    strip: Option<u32>,
    /// Write the .png as an animation
    #[arg(long, conflicts_with_all = ["strip", "frame"])]
    animate: bool,
}

/// What a body is drawn as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum StyleName {
    /// A line for each bone
    Lines,
    /// A body with volume
    Solid,
}

/// Where the face of a clip with a body and a face is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum FaceAt {
    /// Beside the body
    Beside,
    /// On the body's neck: the cartoon face on a head that is the larger the fewer rows the picture has
    Neck,
}

/// What the file is, by its extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// An animation in 256 colours
    Gif,
    /// An animation in all colours
    Apng,
    /// A still, or an animation with --animate
    Png,
    /// A still of lines
    Svg,
}

/// An angle of the camera.
fn tilt(text: &str) -> Result<i16, String> {
    let degrees = text.parse().ok().filter(|degrees| (-90..=90).contains(degrees));
    degrees.ok_or_else(|| "expected whole degrees from -90 to 90".into())
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    if let Some(output) = &arguments.output {
        arguments.check(output)?;
        format_of(output, arguments.format)?;
    }
    let files = Files::read_to_show(&arguments.input, arguments.rig.as_deref())?;
    let clip = files.open_alone().with_context(|| arguments.input.display().to_string())?;
    let model = arguments.model()?;
    let model = Model::new_checked(&model).with_context(|| arguments.face.clone().unwrap_or_default().display().to_string())?;
    let has_face = drives(&clip, &model);
    let face = has_face && clip.rig().joint_count() == 0;
    let of_faces = [("--face", arguments.face.is_some()), ("--interpolation", !arguments.interpolation.is_empty())];
    if let Some((option, _)) = of_faces.into_iter().find(|entry| entry.1 && !has_face) {
        bail!(
            "{}: {option} is for clips that drive the face, and no three channels have names that it knows",
            arguments.input.display()
        );
    }
    let output = &match &arguments.output {
        Some(output) => output.clone(),
        None => arguments.default_output(clip.rig().joint_count() == 0 && !face)?,
    };
    check_read(&files.from, &[output])?;
    let kind = arguments.kind(output)?;
    let mut file = Staged::create(output)?;
    if clip.rig().joint_count() == 0 && !face {
        if kind != Kind::Png {
            bail!("{}: a clip without joints has no figure to draw; a name that ends in .png gives a chart", output.display());
        }
        if let Some(option) = arguments.option_of_figures() {
            bail!("{}: {option} does not apply to a clip without joints, which is drawn as a chart", arguments.input.display());
        }
        chart::write(&mut file, &expand_within(&clip, memory::limit())?)?;
    } else {
        let joints = clip.rig().joint_count() > 0;
        ensure!(joints || arguments.up.is_none(), "{}: --up does not apply to a clip without joints", arguments.input.display());
        ensure!(
            arguments.face_at == FaceAt::Beside || arguments.style == StyleName::Solid,
            "--face-at neck is for --style solid"
        );
        ensure!(joints || !arguments.fixed, "{}: --fixed does not apply to a clip without joints", arguments.input.display());
        let look = arguments.line_style(kind)?;
        let character = arguments.character()?;
        let mut memory = PlayerBuffers::of(&clip);
        let sides = arguments.sides(face);
        let style = match arguments.style {
            StyleName::Lines => Style::Lines,
            StyleName::Solid => Style::Solid(character, arguments.face_place()),
        };
        let views = arguments.views(&sides, face);
        let figure = Figure::new(memory.player(clip)?, arguments.size.0, &views, model, (style, look))?;
        if let (Style::Solid(..), Some(build)) = (style, figure.build()) {
            warn_of(build);
        }
        let on_neck = arguments.face_at == FaceAt::Neck;
        ensure!(!on_neck || has_face && joints, "--face-at neck is for clips with a body and a face");
        if on_neck && !figure.is_face_on_neck() {
            note!("warning: only a person has a neck: the face is drawn beside the body");
        }
        let frame_time = f64::from(clip.frame_time_ns()) * 1e-9;
        Output { arguments, sides, figure, kind, look, character, frames: clip.frames(), frame_time }.write(&mut file)?;
    }
    commit(vec![file])?;
    report(json!({"frames": clip.frames(), "kind": format!("{kind:?}").to_lowercase()}));
    if arguments.output.is_none() {
        note!("{}: written", output.display());
    }
    Ok(())
}

/// Reads a character.
pub(super) fn read_look(path: &Path) -> Result<Look> {
    let place = || path.display().to_string();
    let text = String::from_utf8(memory::read(path).with_context(place)?).ok();
    let bytes = look_text::compile(&text.with_context(|| format!("{}: the file is no text", place()))?);
    let bytes = bytes.map_err(|error| anyhow!("{}: {error}", place()))?;
    // A character lives as long as the program.
    Look::new(bytes.to_vec().leak()).with_context(place)
}

/// Notes that a solid figure is not a person's.
pub(super) fn warn_of(build: Build) {
    match build {
        Build::Person => {}
        Build::Bones => note!("the joints' names are not those of a person: each bone is drawn as a capsule"),
        Build::Lines => note!("warning: the rig has too many bones, or none, for a solid figure: lines are drawn"),
    }
}

/// Whether lines of pictures of this size are smooth by default.
pub(super) fn is_smooth([width, height]: [usize; 2], palette: &Palette) -> bool {
    width.min(height) >= SMOOTH_FROM && !palette.is_mono()
}

/// How many times each pixel is enlarged, so that the picture has about `easy` columns.
pub(super) fn easy_scale(easy: usize, [width, _]: [usize; 2]) -> usize {
    (easy / width).clamp(1, MOST_ENLARGED)
}

/// The model of one of our faces of filled shapes.
fn named(face: &Path) -> Option<(&str, &'static [u8])> {
    let models = [("cartoon", pantin_face::CARTOON), ("eyes", pantin_face::EYES), ("minimal", pantin_face::MINIMAL)];
    models.into_iter().find(|own| face.as_os_str() == own.0)
}

impl Arguments {
    /// The bytes of the face's model.
    fn model(&self) -> Result<Vec<u8>> {
        let on_neck = (self.face_at == FaceAt::Neck).then_some(Path::new("cartoon"));
        let named = self.face.as_deref().or(on_neck).and_then(named);
        if let Some(path) = self.face.as_ref().filter(|_| named.is_none()) {
            let place = || path.display().to_string();
            ensure!(
                self.interpolation.is_empty(),
                "{}: a model has its interpolations; `pantin face model --interpolation` writes one with others",
                place()
            );
            return memory::read(path).with_context(place);
        }
        if self.interpolation.is_empty() {
            return Ok(named.map_or(pantin_face::MODEL, |own| own.1).to_vec());
        }
        let face = Face::new()?;
        let mut blueprint = match named.and_then(|own| cartoon::named(own.0)) {
            Some(table) => cartoon::build(&face.head, &face.blueprint, table)?,
            None => face.blueprint,
        };
        blueprint.choose_all(&self.interpolation)?;
        compact::encode(&blueprint)
    }

    fn face_place(&self) -> FacePlace {
        match self.face_at {
            FaceAt::Beside => FacePlace::Beside,
            FaceAt::Neck => FacePlace::Neck,
        }
    }

    /// The solid figure's character.
    fn character(&self) -> Result<Look> {
        let Some(path) = &self.look else { return Ok(Look::DEFAULT) };
        ensure!(self.style == StyleName::Solid, "--look is for --style solid");
        read_look(path)
    }

    /// Checks the output before any work.
    fn check(&self, output: &Path) -> Result<()> {
        let face = self.face.as_deref().filter(|name| named(name).is_none());
        let more = [self.rig.as_deref(), face, self.look.as_deref()];
        let inputs: Vec<&Path> = [self.input.as_path()].into_iter().chain(more.into_iter().flatten()).collect();
        check(&inputs, &[output])?;
        refuse_foreign(output, Wanted::Picture)
    }

    /// The name of a picture that the user does not name; a `chart` is a still.
    fn default_output(&self, chart: bool) -> Result<PathBuf> {
        let still = chart || self.frame.is_some() || self.strip.is_some();
        let extension = match self.format {
            Some(Format::Gif) => "gif",
            Some(Format::Apng) => "apng",
            Some(Format::Png) => "png",
            Some(Format::Svg) => "svg",
            None if still || self.animate => "png",
            None => "gif",
        };
        let output = default_output(&self.input, extension)?;
        self.check(&output)?;
        Ok(output)
    }

    /// An option that was given and that a chart does not follow.
    fn option_of_figures(&self) -> Option<&'static str> {
        let given = [
            ("--size", SIZE.parse().is_ok_and(|size: Size| self.size != size)),
            ("--scale", self.scale.is_some()),
            ("--style", self.style != StyleName::Lines),
            ("--look", self.look.is_some()),
            ("--face-at", self.face_at != FaceAt::Beside),
            ("--palette", PALETTE.parse().is_ok_and(|palette: Palette| self.palette != palette)),
            ("--pixels", self.pixels),
            ("--smooth", self.smooth),
            ("--view", !self.view.is_empty()),
            ("--tilt", self.tilt.is_some()),
            ("--up", self.up.is_some()),
            ("--fixed", self.fixed),
            ("--round", self.round),
            ("--from", self.from.is_some()),
            ("--to", self.to.is_some()),
            ("--frame", self.frame.is_some()),
            ("--strip", self.strip.is_some()),
        ];
        given.into_iter().find_map(|(name, given)| given.then_some(name))
    }

    fn kind(&self, output: &Path) -> Result<Kind> {
        let name = output.display();
        let kind = match format_of(output, self.format)? {
            Some(Format::Gif) => Kind::Gif,
            Some(Format::Apng) => Kind::Apng,
            Some(Format::Png) if self.animate => Kind::Apng,
            Some(Format::Png) => Kind::Png,
            Some(Format::Svg) => Kind::Svg,
            None => bail!("{name}: expected a name that ends in .gif, .apng, .png or .svg, or --format"),
        };
        let animated = matches!(kind, Kind::Gif | Kind::Apng);
        ensure!(!animated || (self.strip.is_none() && self.frame.is_none()), "{name}: --strip and --frame make a .png or .svg");
        ensure!(animated || self.fps.is_none(), "{name}: --fps is for animations: .gif, .apng, or .png with --animate");
        ensure!(kind != Kind::Svg || !self.animate, "{name}: an .svg does not move; .gif and .apng do");
        ensure!(kind != Kind::Svg || self.scale.is_none(), "{name}: an .svg has no pixels to scale; --size says how big it is");
        ensure!(kind != Kind::Svg || !self.round, "{name}: --round is for pictures of pixels");
        ensure!(kind != Kind::Svg || self.style == StyleName::Lines, "{name}: an .svg has lines; solid figures are pixels");
        ensure!(kind != Kind::Svg || !self.pixels, "{name}: an .svg has lines, no pixels");
        Ok(kind)
    }

    fn line_style(&self, kind: Kind) -> Result<LineStyle> {
        let [width, height] = self.size.0;
        let smooth = self.smooth || !self.pixels && is_smooth(self.size.0, &self.palette);
        ensure!(!(self.smooth && self.palette.is_mono()), "the palette mono has no colours between that make lines smooth");
        let pixels = width.max(height) <= MOST_PIXELS || kind == Kind::Svg;
        ensure!(smooth || pixels, "--size {width}x{height}: displays of pixels have at most {MOST_PIXELS} a side; --smooth more");
        Ok(if smooth { LineStyle::Smooth } else { LineStyle::Pixels })
    }

    /// Those asked for; a face is looked in the eyes otherwise.
    fn sides(&self, face: bool) -> Vec<Side> {
        let orbit = if face { 0 } else { View::default().orbit };
        if self.view.is_empty() { vec![Side { name: "frame".into(), orbit }] } else { self.view.clone() }
    }

    fn views(&self, sides: &[Side], face: bool) -> Vec<View> {
        let track = if self.fixed { CameraTarget::Fixed } else { CameraTarget::Follow };
        let tilt = self.tilt.unwrap_or(if face { 0 } else { View::default().tilt });
        sides.iter().map(|side| View { orbit: side.orbit, tilt, track, up: self.up }).collect()
    }
}
