//! Charts of channels over time: a strip each, with its name and its own range.

use anyhow::Result;
use embedded_graphics::Drawable;
use embedded_graphics::geometry::{Point, Size};
use embedded_graphics::mono_font::ascii::{FONT_6X10, FONT_8X13};
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle};
use embedded_graphics::pixelcolor::Gray8;
use embedded_graphics::primitives::{Line, Polyline, Primitive, PrimitiveStyle, Rectangle};
use embedded_graphics::text::{Alignment, Baseline, Text, TextStyleBuilder};
use pantin_convert::motion::Motion;
use pantin_images::canvas::Canvas;
use std::io::Write;

/// Strips in the first column before a second is begun.
const ONE_COLUMN: usize = 20;
/// Letters of a name that fit before its strip.
const LETTERS: usize = 24;
/// A column: names, strips, and the gap after it. A strip has a pixel for each of `PLOT` times.
const NAMES: usize = LETTERS * 8 + 8;
const PLOT: usize = 560;
const COLUMN: usize = NAMES + PLOT + MARGIN;
/// From strip to strip, and what of it is the strip.
const PITCH: usize = 38;
const STRIP: usize = 34;
/// Above the strips the title, below them the seconds.
const MARGIN: usize = 16;
const TITLE: usize = 34;
const AXIS: usize = 24;
/// Seconds stand at most this often.
const TICKS: f64 = 8.0;

const PAPER: u8 = 255;
const GROUND: u8 = 240;
const RULE: u8 = 200;
const FAINT: u8 = 110;
const INK: u8 = 0;

/// A channel that moves: its index, least and greatest value.
type Moving = (usize, f64, f64);

/// Writes the channels of `motion` that move as a PNG; how many do not is said in its title.
pub fn write(out: impl Write, motion: &Motion) -> Result<()> {
    let moving: Vec<Moving> = (0..motion.values.len()).filter_map(|channel| range(channel, &motion.values[channel])).collect();
    let columns = if moving.len() <= ONE_COLUMN { 1 } else { 2 };
    let rows = moving.len().div_ceil(columns);
    let mut canvas = Canvas::new(MARGIN + columns * COLUMN, TITLE + rows * PITCH + AXIS, PAPER);
    text(&mut canvas, &title(motion, moving.len()), MARGIN, 10, &FONT_8X13, INK, Alignment::Left);
    for (index, channel) in moving.iter().enumerate() {
        let (left, top) = (MARGIN + index / rows * COLUMN, TITLE + index % rows * PITCH);
        strip(&mut canvas, motion, channel, left, top);
    }
    for column in 0..moving.len().min(columns) {
        seconds(&mut canvas, motion, MARGIN + column * COLUMN + NAMES, TITLE + rows * PITCH);
    }
    canvas.write(out)
}

fn range(channel: usize, values: &[f64]) -> Option<Moving> {
    let (least, most) = values.iter().fold((f64::MAX, f64::MIN), |(least, most), x| (least.min(*x), most.max(*x)));
    (most > least).then_some((channel, least, most))
}

fn title(motion: &Motion, moving: usize) -> String {
    let (frames, seconds) = (motion.frames, motion.frames as f64 * motion.frame_time);
    let still = match motion.values.len() - moving {
        0 => String::new(),
        still => format!(" ({still} do not and are left out)"),
    };
    let fps = 1.0 / motion.frame_time;
    format!("{moving} of {} channels move{still}; {frames} frames, {seconds:.2} s at {fps:.2} a second", motion.values.len())
}

fn strip(canvas: &mut Canvas, motion: &Motion, &(channel, least, most): &Moving, left: usize, top: usize) {
    let name: String = motion.rig.channel_name(channel).chars().take(LETTERS).collect();
    text(canvas, &name, left, top + 3, &FONT_8X13, INK, Alignment::Left);
    let span = format!("{} .. {}", short(least), short(most));
    text(canvas, &span, left, top + 19, &FONT_6X10, FAINT, Alignment::Left);
    let left = left + NAMES;
    let ground = Rectangle::new(at(left, top), Size::new(PLOT as u32, STRIP as u32));
    let Ok(()) = ground.into_styled(PrimitiveStyle::with_fill(Gray8::new(GROUND))).draw(canvas);
    // One pixel of ground stays free above and below the curve.
    let height = |value: f64| top + 1 + ((most - value) / (most - least) * (STRIP - 3) as f64).round() as usize;
    if (least..=most).contains(&0.0) {
        let zero = Line::new(at(left, height(0.0)), at(left + PLOT - 1, height(0.0)));
        let Ok(()) = zero.into_styled(PrimitiveStyle::with_stroke(Gray8::new(RULE), 1)).draw(canvas);
    }
    let places: Vec<Point> = points(&motion.values[channel]).map(|(x, value)| at(left + x, height(value))).collect();
    let Ok(()) = Polyline::new(&places).into_styled(PrimitiveStyle::with_stroke(Gray8::new(INK), 1)).draw(canvas);
}

/// Pixel and value of each frame; of many frames at one pixel the least and the greatest, so that no peak is lost.
fn points(values: &[f64]) -> impl Iterator<Item = (usize, f64)> {
    let last = (values.len() - 1).max(1);
    let pixel = move |frame: usize| frame * (PLOT - 1) / last;
    let stretches = values.iter().enumerate().map(move |(frame, &value)| (pixel(frame), value)).collect::<Vec<_>>();
    let stretches: Vec<Vec<(usize, f64)>> = stretches.chunk_by(|a, b| a.0 == b.0).map(<[_]>::to_vec).collect();
    stretches.into_iter().flat_map(|stretch| {
        if stretch.len() <= 2 {
            return stretch;
        }
        let by_value = |a: &&(usize, f64), b: &&(usize, f64)| a.1.total_cmp(&b.1);
        [stretch.first(), stretch.iter().min_by(by_value), stretch.iter().max_by(by_value), stretch.last()]
            .into_iter()
            .flatten()
            .copied()
            .collect()
    })
}

fn seconds(canvas: &mut Canvas, motion: &Motion, left: usize, top: usize) {
    let last = motion.frames.saturating_sub(1).max(1) as f64 * motion.frame_time;
    let step = round_step(last / TICKS);
    for tick in 0..=(last / step + 1e-9) as usize {
        let x = left + (tick as f64 * step / last * (PLOT - 1) as f64).round() as usize;
        let mark = Line::new(at(x, top - 2), at(x, top + 3));
        let Ok(()) = mark.into_styled(PrimitiveStyle::with_stroke(Gray8::new(FAINT), 1)).draw(canvas);
        text(canvas, &format!("{} s", short(tick as f64 * step)), x, top + 6, &FONT_6X10, FAINT, Alignment::Center);
    }
}

/// The next of 1, 2 and 5 times a power of ten that is not smaller.
fn round_step(least: f64) -> f64 {
    let ten = 10f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * ten).find(|&step| step >= least * (1.0 - 1e-9)).unwrap_or(least)
}

/// Three digits, or as many as a whole number has.
fn short(value: f64) -> String {
    let digits = if value == 0.0 { 0 } else { (2 - value.abs().log10().floor() as i32).clamp(0, 9) as usize };
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}

fn text(canvas: &mut Canvas, text: &str, x: usize, y: usize, font: &MonoFont, grey: u8, alignment: Alignment) {
    let place = TextStyleBuilder::new().baseline(Baseline::Top).alignment(alignment).build();
    let Ok(_) = Text::with_text_style(text, at(x, y), MonoTextStyle::new(font, Gray8::new(grey)), place).draw(canvas);
}

fn at(x: usize, y: usize) -> Point {
    Point::new(x as i32, y as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pantin_convert::motion::{Rig, Scalar};

    #[test]
    fn numbers_are_short_and_steps_are_round() {
        assert_eq!([0.0, 0.001234, -0.5, 12.345, 1234.5].map(short), ["0", "0.00123", "-0.5", "12.3", "1234"]);
        assert_eq!([0.3, 1.0, 2.1, 0.07].map(round_step), [0.5, 1.0, 5.0, 0.1]);
    }

    #[test]
    fn no_peak_is_lost() {
        let mut values = vec![0.0; 20_000];
        values[12_345] = 7.0;
        assert!(points(&values).any(|(x, value)| value == 7.0 && x == 12_345 * (PLOT - 1) / 19_999));
        assert_eq!(points(&[3.0]).collect::<Vec<_>>(), [(0, 3.0)]);
    }

    #[test]
    fn channels_that_rest_have_no_strip() {
        let scalars = (0..3).map(|index| Scalar { name: format!("c{index}"), full_scale: 1.0 }).collect();
        let values = vec![vec![0.0, 1.0], vec![0.5, 0.5], vec![-1.0, 0.0]];
        let rig = Rig { joints: Vec::new(), scalars, cm_per_unit: 1.0, ..Rig::default() };
        let motion = Motion {
            rig,
            frame_time: 0.5,
            frames: 2,
            keys: vec![None; 3],
            values,
            looped: false,
            events: Vec::new(),
            origin: Default::default(),
        };
        assert_eq!(title(&motion, 2), "2 of 3 channels move (1 do not and are left out); 2 frames, 1.00 s at 2.00 a second");
        let mut out = Vec::new();
        write(&mut out, &motion).unwrap();
        let info = png::Decoder::new(std::io::Cursor::new(out)).read_info().unwrap().info().size();
        assert_eq!(info, ((MARGIN + COLUMN) as u32, (TITLE + 2 * PITCH + AXIS) as u32));
    }
}
