//! What is shown of the clip, and in which file format.

use super::{Arguments, EASY_TO_SEE, EASY_TO_SEE_IN_A_SHEET, Side, StyleName, easy_scale};
use crate::output::{note, progress};
use anyhow::{Result, ensure};
use pantin_figure::solid::Look;
use pantin_images::animation::{Animation, Timing};
use pantin_images::apng::{self, Apng};
use pantin_images::gif::{self, Gif};
use pantin_images::image::Image;
use pantin_images::sheet::{Layout, arrange};
use pantin_pictures::render::figure::{Figure, LineStyle};
use pantin_pictures::render::svg;
use std::io::Write;

/// Pictures of a contact sheet of one view, and how many of them are in a row.
const SHEET: u32 = 12;
const COLUMNS: usize = 3;
/// Pictures in a row of several views.
const ROW: u32 = 6;
/// Most pixels of a whole sheet, or of an animation's picture.
const MOST_PIXELS: usize = 64 << 20;
/// Fewest pictures of an animation in a second: some viewers show none for longer.
const LEAST_A_SECOND: f64 = 0.1;
/// Most pictures of an animation: ten minutes at the most that displays show in a second.
const MOST_PICTURES: f64 = 36_000.0;
/// The fractional part of the golden ratio: its multiples leave no two alike gaps in step with anything.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// What the file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// An animation in 256 colours.
    Gif,
    /// An animation in all colours.
    Apng,
    /// A still.
    Png,
    /// Lines.
    Svg,
}

/// A picture to be made.
pub struct Output<'a, 'm> {
    pub arguments: &'a Arguments,
    pub sides: Vec<Side>,
    pub figure: Figure<'a, 'm>,
    pub kind: Kind,
    pub look: LineStyle,
    pub character: Look,
    pub frames: u32,
    pub frame_time: f64,
}

impl Output<'_, '_> {
    /// Writes the file's bytes to `out`.
    pub fn write(mut self, out: &mut impl Write) -> Result<()> {
        if matches!(self.kind, Kind::Gif | Kind::Apng) {
            return self.animation(out);
        }
        if let Some(moment) = self.arguments.frame {
            let frame = moment.frame(self.frames, self.frame_time)?;
            return self.frame(frame, out);
        }
        self.sheet(out)
    }

    /// The frames `from..to` that are asked for.
    fn stretch(&self) -> Result<(u32, u32)> {
        let frame = |moment: super::Moment| moment.frame(self.frames, self.frame_time);
        let from = self.arguments.from.map(frame).transpose()?.unwrap_or(0);
        let to = self.arguments.to.map(frame).transpose()?.unwrap_or(self.frames - 1);
        ensure!(from <= to, "--from is frame {from}, behind --to, frame {to}");
        Ok((from, to + 1))
    }

    fn views(&self) -> usize {
        self.sides.len()
    }

    fn scale(&self, easy: usize) -> usize {
        let own = if self.look == LineStyle::Smooth { 1 } else { easy_scale(easy, self.arguments.size.0) };
        self.arguments.scale.map_or(own, usize::from)
    }

    fn image(&mut self, view: usize, scale: usize) -> Image {
        let mut image = self.figure.image(view, self.look, &self.arguments.palette);
        if self.arguments.round {
            image.keep_circle(self.arguments.palette.paper());
        }
        if scale == 1 { image } else { image.enlarged(scale) }
    }

    fn animation(&mut self, mut out: &mut impl Write) -> Result<()> {
        let (from, to) = self.stretch()?;
        let most = if self.kind == Kind::Gif { gif::MOST_A_SECOND } else { apng::MOST_A_SECOND };
        // Counted before they are listed: a small clip may last for years.
        let pictures = |fps: f64| (f64::from(to - from) * self.frame_time * fps).ceil();
        let rate = self.arguments.fps.unwrap_or(most.min(1.0 / self.frame_time));
        let count = pictures(rate.clamp(LEAST_A_SECOND, most));
        ensure!(
            count <= MOST_PICTURES,
            "the animation would have {count} pictures; the limit is {MOST_PICTURES}: --from and --to, or a lower --fps, take fewer"
        );
        let timing = self.timing(from, to, most)?;
        let scale = self.scale(EASY_TO_SEE);
        let [width, height] = self.arguments.size.0.map(|side| side * scale);
        let whole = [width * self.views(), height];
        ensure_size(whole)?;
        let palette = &self.arguments.palette;
        let mut animation: Box<dyn Animation + '_> = match (self.kind, self.look) {
            (Kind::Gif, _) if self.arguments.style == StyleName::Solid => {
                Box::new(Gif::new(&mut out, &palette.solid_colours(&self.character), timing.seconds))
            }
            (Kind::Gif, LineStyle::Pixels) => Box::new(Gif::new(&mut out, &palette.pixel_colours(), timing.seconds)),
            (Kind::Gif, LineStyle::Smooth) => Box::new(Gif::new(&mut out, &palette.smooth_colours(), timing.seconds)),
            _ => Box::new(Apng::new(&mut out, timing.frames.len() as u32, timing.seconds)),
        };
        let bar = progress(timing.frames.len() as u64, "{wide_bar} {pos} of {len} pictures {eta} left")?;
        for &frame in &timing.frames {
            self.figure.seek(frame);
            let mut picture = Image::new(whole[0], whole[1], palette.paper());
            (0..self.views()).for_each(|view| picture.put(view * width, 0, &self.image(view, scale)));
            animation.push(&picture)?;
            bar.inc(1);
        }
        bar.finish_and_clear();
        Ok(())
    }

    /// The pictures of the frames `from..to`: at rates that viewers do not show, others than the clip has.
    fn timing(&self, from: u32, to: u32, most: f64) -> Result<Timing> {
        let own = 1.0 / self.frame_time;
        let Some(fps) = self.arguments.fps else {
            let timing = Timing::of_clip(from, to, self.frame_time, most);
            let shown = 1.0 / timing.seconds;
            if shown < own * 0.999 {
                note!("{own:.3} frames a second are more than viewers show: {shown:.3} are drawn; --fps takes another rate");
            }
            return Ok(timing);
        };
        ensure!(fps.is_finite() && fps > 0.0, "--fps {fps}: expected a number above 0");
        let shown = fps.clamp(LEAST_A_SECOND, most);
        if shown != fps {
            note!("viewers show from {LEAST_A_SECOND} to {most} pictures a second of this format: {shown} are drawn");
        }
        Ok(Timing::at_rate(from, to, self.frame_time, shown))
    }

    fn frame(&mut self, frame: u32, out: &mut impl Write) -> Result<()> {
        ensure!(self.views() == 1, "--frame shows one view; --strip 1 shows several");
        self.figure.seek(frame);
        if self.kind == Kind::Svg {
            let text = svg::picture(&self.figure.scene(0), self.arguments.size.0, &self.arguments.palette);
            return Ok(out.write_all(text.as_bytes())?);
        }
        let scale = self.scale(EASY_TO_SEE);
        ensure_size(self.arguments.size.0.map(|side| side * scale))?;
        self.image(0, scale).write_png(out)
    }

    fn sheet(&mut self, out: &mut impl Write) -> Result<()> {
        let (from, to) = self.stretch()?;
        let frames = match self.arguments.strip {
            Some(count) if self.arguments.from.or(self.arguments.to).is_some() => evenly(from, to, count),
            Some(count) => unevenly(from, to, count),
            None if self.views() > 1 => unevenly(from, to, ROW),
            None => in_parts(from, to, SHEET),
        };
        let in_rows = self.views() == 1 && self.arguments.strip.is_none();
        let columns = if in_rows { COLUMNS.min(frames.len()) } else { frames.len() };
        let scale = if self.kind == Kind::Svg { 1 } else { self.scale(EASY_TO_SEE_IN_A_SHEET) };
        let picture = self.arguments.size.0.map(|side| side * scale);
        let rows = (frames.len() * self.views()).div_ceil(columns);
        let gap = if self.arguments.strip.is_some() { 2 } else { 6 };
        let layout = Layout { picture, columns, rows, gap };
        ensure_size(layout.size())?;
        let palette = &self.arguments.palette;
        if self.kind == Kind::Svg {
            let cells = self.cells(&frames, |output, view| output.figure.scene(view));
            Ok(out.write_all(svg::sheet(layout, &cells, palette).as_bytes())?)
        } else {
            let cells = self.cells(&frames, |output, view| output.image(view, scale));
            arrange(layout, &cells, palette).write_png(out)
        }
    }

    /// A row of the frames for each view, with their labels.
    fn cells<T>(&mut self, frames: &[u32], mut draw: impl FnMut(&mut Self, usize) -> T) -> Vec<(String, T)> {
        let mut cells = Vec::new();
        for view in 0..self.views() {
            for &frame in frames {
                self.figure.seek(frame);
                let side = if self.views() == 1 { "frame" } else { &self.sides[view].name };
                cells.push((format!("{side} {frame}"), draw(self, view)));
            }
        }
        cells
    }
}

fn ensure_size([width, height]: [usize; 2]) -> Result<()> {
    let fits = width.saturating_mul(height) <= MOST_PIXELS && width.max(height) <= usize::from(u16::MAX);
    ensure!(
        fits,
        "the whole picture would have {width}x{height} pixels, more than is sensible: choose a smaller --size or --scale"
    );
    Ok(())
}

/// `count` of the frames `from..to`, each the first of an equal part.
fn in_parts(from: u32, to: u32, count: u32) -> Vec<u32> {
    let (frames, count) = (u64::from(to - from), u64::from(count.min(to - from)));
    (0..count).map(|index| from + (index * frames / count) as u32).collect()
}

/// `count` frames from the first to the last.
fn evenly(from: u32, to: u32, count: u32) -> Vec<u32> {
    let (last, parts) = (u64::from(to - 1 - from), u64::from(count.max(2) - 1));
    let mut frames: Vec<u32> = (0..u64::from(count)).map(|index| from + ((index * last + parts / 2) / parts) as u32).collect();
    frames.dedup();
    frames
}

/// `count` frames all over the stretch, in no step.
fn unevenly(from: u32, to: u32, count: u32) -> Vec<u32> {
    let place = |index: u32| (f64::from(index) * GOLDEN + 0.25).fract();
    let mut frames: Vec<u32> = (0..count).map(|index| from + (place(index) * f64::from(to - from)) as u32).collect();
    frames.sort_unstable();
    frames.dedup();
    frames
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_spread_over_the_stretch() {
        assert_eq!(in_parts(0, 160, 4), [0, 40, 80, 120]);
        assert_eq!(in_parts(3, 5, 12), [3, 4]);
        assert_eq!(evenly(20, 61, 5), [20, 30, 40, 50, 60]);
        assert_eq!((evenly(7, 8, 3), evenly(7, 20, 1)), (vec![7], vec![7]));
    }

    #[test]
    fn a_strip_of_a_whole_clip_is_not_in_step_with_any_gait() {
        let frames = unevenly(0, 1000, 8);
        assert_eq!(frames.len(), 8);
        let gaps: Vec<u32> = frames.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(gaps.iter().all(|gap| (60..250).contains(gap)), "{gaps:?}");
        // For any gait between 30 and 300 frames, the poses are of several phases.
        for gait in 30..300 {
            let mut phases: Vec<u32> = frames.iter().map(|frame| frame % gait * 8 / gait).collect();
            phases.sort_unstable();
            phases.dedup();
            assert!(phases.len() >= 3, "{gait}: {phases:?}");
        }
    }
}
