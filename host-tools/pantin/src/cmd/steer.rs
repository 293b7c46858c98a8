//! `pantin steer`

use super::format_of;
use super::render::{EASY_TO_SEE, EASY_TO_SEE_IN_A_SHEET, Side, Size, easy_scale, is_smooth};
use crate::memory;
use crate::output::{Staged, Wanted, check, commit, note, progress, refuse_foreign, report};
use anyhow::{Context, Result, anyhow, bail, ensure};
use pantin::Bank;
use pantin_animator::Character;
use pantin_animator::machine::{FeetTable, Table};
use pantin_animator::session::Replay;
use pantin_convert::Moment;
use pantin_figure::{CameraTarget, View};
use pantin_images::animation::Animation;
use pantin_images::apng::{self, Apng};
use pantin_images::gif::{self, Gif};
use pantin_images::palette::Palette;
use pantin_images::sheet::{Layout, arrange};
use pantin_pictures::machine::playback::{Stage, has_machine, joints, play, session, view_at_start};
use serde_json::json;
use std::io::Write;
use std::ops::Range;
use std::path::PathBuf;

/// Columns and rows of a picture, and pictures of a sheet, where nothing else is asked for.
const SIZE: [usize; 2] = [128, 64];
const SHEET: u32 = 24;
/// Pictures in a row of a sheet.
const COLUMNS: usize = 6;

/// Play a recorded session of a bank's state machine, as pictures or as places of the joints.
///
/// The session is a text of inputs and their times (see firmware/animator/MACHINE.md). The output's extension selects the kind: .gif and .apng are
/// animations, .png is a contact sheet, .csv has a row for each picture with the state, the heading of the figure, the joint at which each foot is held
/// (empty while it is free), and where every joint is in the world, in cm.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin steer character.ptb session.txt -o steer.gif
  pantin steer character.ptb session.txt -o steer.png --sheet 24
  pantin steer character.ptb session.txt -o change.png --from 1.9s --to 2.8s --sheet 30 --view side
  pantin steer character.ptb session.txt -o joints.csv --fps 60

A small session:
  1.0 hold go
  2.5 press jump
  4.0 release go
  6.0 end")]
pub struct Arguments {
    /// The bank with the state machine: .ptb
    bank: PathBuf,
    /// The session: a text file
    session: PathBuf,
    /// The file to write: .gif, .apng, .png or .csv
    #[arg(short, long)]
    output: PathBuf,
    /// The format, where the output's name does not say it, as in `-o -`
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// Pictures per second
    #[arg(long, default_value_t = 30, value_parser = clap::value_parser!(u16).range(1..=120))]
    fps: u16,
    /// Columns and rows of a picture [default: 128x64]
    #[arg(long, value_name = "COLUMNSxROWS")]
    size: Option<Size>,
    /// Colours: a name, or paper and ink, as for pantin render [default: grey]
    #[arg(long)]
    palette: Option<Palette>,
    /// Side to see the figure from, as it stands at the start: front, side, left, right, back, quarter, or degrees [default: quarter]
    #[arg(long, value_name = "SIDE", allow_hyphen_values = true)]
    view: Option<Side>,
    /// Use a fixed camera that sees the whole session instead of following the figure
    #[arg(long)]
    fixed: bool,
    /// First picture, by its number or as a time such as 1.9s: the session is played to there unseen
    #[arg(long, value_name = "PICTURE")]
    from: Option<Moment>,
    /// Last picture, by its number or as a time such as 2.8s
    #[arg(long, value_name = "PICTURE")]
    to: Option<Moment>,
    /// Pictures of a contact sheet [default: 24]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=600))]
    sheet: Option<u32>,
}

/// What the file is, by its extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// An animation in 256 colours
    Gif,
    /// An animation in all colours
    Apng,
    /// A contact sheet
    Png,
    /// Places of the joints
    Csv,
}

impl Arguments {
    /// Numbers of the pictures that are asked for, of all that a session has.
    fn range(&self, all: u32) -> Result<Range<u32>> {
        let number = |moment: Moment| moment.nearest(1.0 / f64::from(self.fps)).min(all as usize) as u32;
        let (from, end) = (self.from.map_or(0, number), self.to.map_or(all, |to| (number(to) + 1).min(all)));
        ensure!(from < end, "--from and --to leave no picture of {:.1} s", f64::from(all) / f64::from(self.fps));
        Ok(from..end)
    }

    fn size(&self) -> [usize; 2] {
        self.size.map_or(SIZE, |size| size.0)
    }

    fn palette(&self) -> Palette {
        self.palette.clone().unwrap_or_default()
    }

    /// Refuses options that an output of this kind cannot use.
    fn check(&self, format: Format) -> Result<()> {
        let pictures = [
            ("--size", self.size.is_some()),
            ("--palette", self.palette.is_some()),
            ("--view", self.view.is_some()),
            ("--fixed", self.fixed),
        ];
        let drawn = pictures.iter().find(|(_, given)| *given && format == Format::Csv);
        ensure!(drawn.is_none(), "{} is for pictures", drawn.map_or("", |(name, _)| name));
        ensure!(self.sheet.is_none() || format == Format::Png, "--sheet is for contact sheets (.png)");
        Ok(())
    }
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    let Arguments { bank: path, session: script, output, .. } = arguments;
    check(&[path, script], &[output])?;
    let format = format_of(output, arguments.format)?;
    let format = format
        .with_context(|| format!("{}: expected a name that ends in .gif, .apng, .png or .csv, or --format", output.display()))?;
    arguments.check(format)?;
    refuse_foreign(output, if format == Format::Csv { Wanted::Motion } else { Wanted::Picture })?;
    let bytes = memory::read(path)?;
    let place = || path.display().to_string();
    ensure!(has_machine(&bytes), "{}: no bank with a state machine; `pantin machine` makes one", place());
    let text = String::from_utf8(memory::read(script)?).map_err(|_| anyhow!("{}: not text (UTF-8)", script.display()))?;
    let table = Table::of_bank(&bytes).with_context(place)?;
    let session = session(&text, &script.display().to_string(), &table)?;
    let pictures = arguments.range(Replay::new(session, arguments.fps).pictures())?;
    let count = pictures.len();
    let mut file = Staged::create(output)?;
    let shown = Shown { arguments, bytes: &bytes, replay: Replay::new(session, arguments.fps), pictures };
    match format {
        Format::Csv => shown.table(&mut file).with_context(place)?,
        Format::Png => shown.sheet(&mut file).with_context(place)?,
        Format::Gif | Format::Apng => shown.animation(format, &mut file).with_context(place)?,
    }
    commit(vec![file])?;
    let seconds = match (arguments.from, arguments.to) {
        (None, None) => f64::from(session.end_us()) * 1e-6,
        _ => count as f64 / f64::from(arguments.fps),
    };
    report(json!({"pictures": count, "seconds": seconds}));
    note!("{}: {count} pictures, {seconds:.1} s", output.display());
    Ok(())
}

struct Shown<'a> {
    arguments: &'a Arguments,
    bytes: &'a [u8],
    replay: Replay<'a>,
    pictures: Range<u32>,
}

impl<'a> Shown<'a> {
    /// Plays the session, and passes the pictures that are asked for by their numbers.
    fn play(&self, mut show: impl FnMut(u32, &mut Character<'a, '_>) -> Result<()>) -> Result<()> {
        let mut numbers = 0..;
        play(self.bytes, self.replay, |character| {
            let number = numbers.next().unwrap_or(0);
            if self.pictures.contains(&number) { show(number, character) } else { Ok(()) }
        })
    }

    fn stage(&self) -> Result<Stage> {
        let track = if self.arguments.fixed { CameraTarget::Fixed } else { CameraTarget::Follow };
        let view = View { track, ..View::default() };
        let view = match &self.arguments.view {
            Some(side) => view_at_start(self.bytes, View { orbit: side.orbit, ..view })?,
            // As boards show it.
            None => view,
        };
        Stage::new(self.bytes, self.arguments.size(), view, Some(&self.replay))
    }

    /// Whether lines are smooth, and by what pixels are enlarged.
    fn look(&self, easy: usize) -> (bool, usize) {
        let size = self.arguments.size();
        let smooth = is_smooth(size, &self.arguments.palette());
        (smooth, if smooth { 1 } else { easy_scale(easy, size) })
    }

    fn animation(&self, format: Format, mut out: &mut impl Write) -> Result<()> {
        let rate = f64::from(self.arguments.fps);
        let most = if format == Format::Gif { gif::MOST_A_SECOND } else { apng::MOST_A_SECOND };
        ensure!(rate <= most, "--fps {rate}: viewers show at most {most} pictures a second of this format");
        let (palette, pictures) = (self.arguments.palette(), self.pictures.len() as u32);
        let (smooth, scale) = self.look(EASY_TO_SEE);
        let mut stage = self.stage()?;
        let mut animation: Box<dyn Animation + '_> = match (format, smooth) {
            (Format::Gif, false) => Box::new(Gif::new(&mut out, &palette.pixel_colours(), 1.0 / rate)),
            (Format::Gif, true) => Box::new(Gif::new(&mut out, &palette.smooth_colours(), 1.0 / rate)),
            _ => Box::new(Apng::new(&mut out, pictures, 1.0 / rate)),
        };
        let bar = progress(pictures.into(), "{wide_bar} {pos} of {len} pictures {eta} left")?;
        self.play(|_, character| {
            bar.inc(1);
            animation.push(&stage.image(character, smooth, &palette)?.enlarged(scale))
        })?;
        bar.finish_and_clear();
        Ok(())
    }

    fn sheet(&self, out: &mut impl Write) -> Result<()> {
        let palette = self.arguments.palette();
        let (smooth, scale) = self.look(EASY_TO_SEE_IN_A_SHEET);
        let mut stage = self.stage()?;
        let Range { start, end } = self.pictures;
        let count = self.arguments.sheet.unwrap_or(SHEET).min(end - start);
        // Each the middle of an equal part.
        let wanted: Vec<u32> = (0..u64::from(count))
            .map(|index| start + ((2 * index + 1) * u64::from(end - start) / (2 * u64::from(count))) as u32)
            .collect();
        let rate = f64::from(self.arguments.fps);
        let mut cells = Vec::new();
        self.play(|picture, character| {
            if wanted.binary_search(&picture).is_ok() {
                let state = character.table().state_name(character.state());
                let label = format!("{:.2} s {state}", f64::from(picture) / rate);
                cells.push((label, stage.image(character, smooth, &palette)?.enlarged(scale)));
            }
            Ok(())
        })?;
        let picture = self.arguments.size().map(|side| side * scale);
        let columns = COLUMNS.min(cells.len());
        let layout = Layout { picture, columns, rows: cells.len().div_ceil(columns), gap: 6 };
        if layout.size().iter().any(|&side| side > usize::from(u16::MAX)) {
            bail!("the sheet would have {:?} pixels: choose a smaller --size or --sheet", layout.size());
        }
        arrange(layout, &cells, &palette).write_png(out)
    }

    fn table(&self, out: &mut impl Write) -> Result<()> {
        let rate = f64::from(self.arguments.fps);
        let mut table = csv::Writer::from_writer(out);
        let feet = FeetTable::of(&Bank::new_checked(self.bytes)?)?;
        let rows = feet.iter().flat_map(|feet| (0..feet.feet()).filter_map(|foot| feet.foot(foot)));
        let ankles: Vec<usize> = rows.map(|row| row.ankle.into()).collect();
        let mut names = Vec::new();
        self.play(|picture, character| {
            let places = joints(character);
            if picture == self.pictures.start {
                let clip = *character.animator().track().clip();
                let name = |(index, joint): (usize, pantin::Joint)| match joint.end_site {
                    true => format!("end_{index}"),
                    false => String::from_utf8_lossy(joint.name_bytes()).into_owned(),
                };
                names = clip.rig().joints().enumerate().map(name).collect();
                let mut row: Vec<String> = ["seconds", "state", "clip_frame", "heading_degrees"].map(String::from).into();
                row.extend(ankles.iter().map(|&ankle| format!("held_{}", names[ankle])));
                row.extend(names.iter().flat_map(|name| ["x", "y", "z"].map(|axis| format!("{name}_{axis}"))));
                table.write_record(&row)?;
            }
            let (_, placement) = character.pose();
            let mut row = vec![
                format!("{:.4}", f64::from(picture) / rate),
                character.table().state_name(character.state()).to_string(),
                character.animator().track().frame().to_string(),
                format!("{:.3}", placement.heading.turns().to_num::<f64>() * 360.0),
            ];
            let held =
                |foot: usize| character.feet().and_then(|feet| feet.held(foot)).map(|joint| names[usize::from(joint)].clone());
            row.extend((0..ankles.len()).map(|foot| held(foot).unwrap_or_default()));
            row.extend(places.iter().flatten().map(|x| format!("{x:.3}")));
            table.write_record(&row)?;
            Ok(())
        })?;
        table.flush()?;
        Ok(())
    }
}
