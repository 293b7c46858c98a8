//! Pictures as files: PNG, a contact sheet, an animated GIF.

use std::borrow::Cow;
use std::io::Write;
use std::path::Path;

use anyhow::{Context, Result, bail};

use crate::paths;
use crate::screen::Picture;

/// The 16 greys as RGB values.
const GREYS: [u8; 48] = {
    let mut palette = [0; 48];
    let mut index = 0;
    while index < 48 {
        palette[index] = 17 * (index / 3) as u8;
        index += 1;
    }
    palette
};

/// Pixels between the pictures of a contact sheet, before enlarging, and their grey.
const GAP: usize = 1;
const GAP_GREY: u8 = 5;

/// Writes a picture as PNG, each pixel `scale` by `scale`.
pub fn write_png(path: &Path, picture: &Picture, scale: usize) -> Result<()> {
    let (width, height) = (picture.width() * scale, picture.height() * scale);
    paths::write_whole(path, |file| {
        let mut encoder = png::Encoder::new(file, u32::try_from(width)?, u32::try_from(height)?);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(png::BitDepth::Eight);
        let bytes: Vec<u8> = enlarged(picture, scale).iter().map(|grey| 17 * grey).collect();
        Ok(encoder.write_header()?.write_image_data(&bytes)?)
    })
}

/// Lays pictures of equal size side by side, `columns` a row, with a line between them.
pub fn contact_sheet(pictures: &[Picture], columns: usize) -> Result<Picture> {
    let first = pictures.first().context("a contact sheet of no pictures")?;
    let (width, height) = (first.width() + GAP, first.height() + GAP);
    let columns = columns.clamp(1, pictures.len());
    let (total, rows) = (columns * width + GAP, pictures.len().div_ceil(columns));
    let mut greys = vec![GAP_GREY; total * (rows * height + GAP)];
    for (index, picture) in pictures.iter().enumerate() {
        if (picture.width(), picture.height()) != (first.width(), first.height()) {
            bail!("picture {index} is not as large as the first");
        }
        let corner = (index / columns * height + GAP) * total + index % columns * width + GAP;
        for (row, line) in picture.greys().chunks(picture.width()).enumerate() {
            greys[corner + row * total..][..line.len()].copy_from_slice(line);
        }
    }
    Picture::new(total, rows * height + GAP, greys)
}

/// Writes pictures of equal size as a GIF that plays in a loop, `rate` pictures a second, each pixel `scale` by `scale`.
///
/// GIF delays are hundredths of a second, and players slow down below two: pictures are left out where the rate is above
/// 50, and delays alternate, so that the speed is right on the whole.
pub fn write_gif(path: &Path, pictures: &[Picture], rate: f64, scale: usize) -> Result<()> {
    let first = pictures.first().context("a GIF of no pictures")?;
    let (width, height) = (u16::try_from(first.width() * scale)?, u16::try_from(first.height() * scale)?);
    paths::write_whole(path, |mut file| {
        let mut encoder = gif::Encoder::new(&mut file as &mut dyn Write, width, height, &GREYS)?;
        encoder.set_repeat(gif::Repeat::Infinite)?;
        for (index, delay) in delays(pictures.len(), rate) {
            let buffer = Cow::Owned(enlarged(&pictures[index], scale));
            encoder.write_frame(&gif::Frame { width, height, delay, buffer, ..gif::Frame::default() })?;
        }
        Ok(())
    })
}

/// Which pictures to show, and for how many hundredths of a second: at least two.
fn delays(pictures: usize, rate: f64) -> Vec<(usize, u16)> {
    let end = |index: usize| (100.0 * index as f64 / rate).round() as u64;
    let mut shown: Vec<(usize, u64)> = vec![];
    for index in 0..pictures {
        if shown.last().is_none_or(|&(_, start)| end(index) >= start + 2) {
            shown.push((index, end(index)));
        }
    }
    let ends = shown.iter().skip(1).map(|&(_, start)| start).chain([end(pictures)]);
    let delay = |start: u64, end: u64| u16::try_from(end.saturating_sub(start)).unwrap_or(u16::MAX).max(2);
    shown.iter().zip(ends).map(|(&(index, start), end)| (index, delay(start, end))).collect()
}

fn enlarged(picture: &Picture, scale: usize) -> Vec<u8> {
    let mut pixels = Vec::with_capacity(picture.greys().len() * scale * scale);
    for line in picture.greys().chunks(picture.width()) {
        let wide: Vec<u8> = line.iter().flat_map(|&grey| std::iter::repeat_n(grey, scale)).collect();
        (0..scale).for_each(|_| pixels.extend_from_slice(&wide));
    }
    pixels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gif_plays_at_the_motions_speed_whatever_its_rate() {
        for (pictures, rate) in [(160, 120.0), (26, 30.0), (300, 60.0), (100, 24.0), (1, 120.0)] {
            let shown = delays(pictures, rate);
            let total: u64 = shown.iter().map(|&(_, delay)| u64::from(delay)).sum();
            let wanted = 100.0 * pictures as f64 / rate;
            assert!((total as f64 - wanted).abs() <= 2.0, "{pictures} at {rate}: {total} for {wanted}");
            assert!(shown.iter().all(|&(_, delay)| delay >= 2));
        }
    }

    #[test]
    fn a_written_png_reads_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new/picture.png");
        let picture = Picture::new(2, 1, vec![15, 2]).unwrap();
        write_png(&path, &picture, 3).unwrap();
        let file = std::io::BufReader::new(std::fs::File::open(&path).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut pixels = [0; 6 * 3];
        let info = reader.next_frame(&mut pixels).unwrap();
        assert_eq!((info.width, info.height), (6, 3));
        assert_eq!(pixels[..], [255, 255, 255, 34, 34, 34].repeat(3));
        let names: Vec<_> = std::fs::read_dir(path.parent().unwrap()).unwrap().collect();
        assert_eq!(names.len(), 1, "no temporary file stays");
    }

    #[test]
    fn a_contact_sheet_keeps_every_picture_whole() {
        let pictures: Vec<Picture> = (0..3).map(|grey| Picture::new(2, 1, vec![grey, 15 - grey]).unwrap()).collect();
        let sheet = contact_sheet(&pictures, 2).unwrap();
        assert_eq!((sheet.width(), sheet.height()), (7, 5));
        assert_eq!(sheet.greys()[7..14], [5, 0, 15, 5, 1, 14, 5]);
        assert_eq!(sheet.greys()[21..28], [5, 2, 13, 5, 5, 5, 5]);
    }
}
