//! Pictures of displays as files.

use crate::display::Picture;
use anyhow::{Context, Result};
use pantin_images::animation::{Animation, stride};
use pantin_images::gif::{Gif, MOST_A_SECOND};
use pantin_images::palette::{Palette, Rgb};
use pantin_images::sheet::{Layout, arrange};

/// Columns that an animation's picture has at most.
const ANIMATED: usize = 512;
/// And one on a sheet.
const ON_SHEET: usize = 256;
/// Colours that a GIF holds.
const COLOURS: usize = 256;

/// A GIF of pictures at `rate` a second, without those that come too fast for viewers.
pub fn animation(pictures: &[Picture], rate: f64) -> Result<Vec<u8>> {
    let stride = stride(1.0 / rate, MOST_A_SECOND) as usize;
    let scale = scale(pictures.first().context("no pictures")?, ANIMATED);
    let mut file = vec![];
    let mut gif = Gif::new(&mut file, &colours(pictures), stride as f64 / rate);
    pictures.iter().step_by(stride).try_for_each(|picture| gif.push(&picture.image(scale)))?;
    drop(gif);
    Ok(file)
}

/// A PNG of pictures with their labels, in rows of `columns`.
pub fn sheet(pictures: &[(String, &Picture)], columns: usize) -> Result<Vec<u8>> {
    let scale = scale(pictures.first().context("no pictures")?.1, ON_SHEET);
    let cells: Vec<_> = pictures.iter().map(|(label, picture)| (label.clone(), picture.image(scale))).collect();
    let (columns, rows) = (cells.len().clamp(1, columns), cells.len().div_ceil(columns).max(1));
    let layout = Layout { picture: [cells[0].1.width(), cells[0].1.height()], columns, rows, gap: 6 };
    let mut file = vec![];
    arrange(layout, &cells, &Palette::default()).write_png(&mut file)?;
    Ok(file)
}

fn scale(picture: &Picture, columns: usize) -> usize {
    (columns / picture.display.width).max(1)
}

/// The pictures' colours, or as many as a GIF holds of those that are seen most; it takes the nearest for the others.
fn colours(pictures: &[Picture]) -> Vec<Rgb> {
    let mut seen = vec![0u32; 1 << 16];
    pictures.iter().flat_map(|picture| &picture.pixels).for_each(|&value| seen[usize::from(value)] += 1);
    let mut values: Vec<u16> = (0..=u16::MAX).filter(|&value| seen[usize::from(value)] > 0).collect();
    values.sort_by_key(|&value| std::cmp::Reverse(seen[usize::from(value)]));
    values.truncate(COLOURS);
    let depth = pictures.first().map(|picture| picture.display.depth);
    depth.map_or(vec![], |depth| values.into_iter().map(|value| depth.rgb(value)).collect())
}
