//! The OLED's pixels, read back from QEMU's window, and the difference between two pictures.

use std::fmt;

use anyhow::{Context, Result, bail, ensure};

/// QEMU shows each pixel of the SSD0323 as a square of this side.
const SCALE: usize = 4;

/// QEMU shows the grey `v` of 0..=15 as the RGB value `17 v`.
const GREY_STEP: u8 = 17;

/// A picture in 16 greys, row by row from the top left.
#[derive(Clone, PartialEq, Eq)]
pub struct Picture {
    width: usize,
    height: usize,
    greys: Vec<u8>,
}

impl Picture {
    /// A picture of greys 0..=15; refuses a wrong number of pixels or a grey out of range.
    pub fn new(width: usize, height: usize, greys: Vec<u8>) -> Result<Self> {
        ensure!(greys.len() == width * height, "{} pixels for a picture of {width}x{height}", greys.len());
        ensure!(greys.iter().all(|&grey| grey < 16), "a grey above 15");
        Ok(Self { width, height, greys })
    }

    /// Reads QEMU's window (a binary portable pixmap) back into the display's pixels. Refuses a picture that is not made
    /// of whole 4x4 squares in the 16 greys: then it is not the display.
    pub fn from_window(pixmap: &[u8]) -> Result<Self> {
        let (columns, rows, pixels) = parse_pixmap(pixmap)?;
        ensure!(
            columns > 0 && rows > 0 && columns % SCALE == 0 && rows % SCALE == 0,
            "a window of {columns}x{rows} is not made of squares of {SCALE}"
        );
        let mut greys = vec![0; columns / SCALE * (rows / SCALE)];
        for (index, rgb) in pixels.chunks_exact(3).enumerate() {
            let (x, y) = (index % columns, index / columns);
            let corner = &pixels[3 * ((y - y % SCALE) * columns + x - x % SCALE)..][..3];
            ensure!(rgb == corner, "the window's pixel ({x}, {y}) is {rgb:?}, the first of its square {corner:?}");
            let grey = rgb[0] / GREY_STEP;
            ensure!(rgb == [grey * GREY_STEP; 3], "the window's pixel ({x}, {y}) is {rgb:?}, none of the 16 greys");
            greys[y / SCALE * (columns / SCALE) + x / SCALE] = grey;
        }
        Self::new(columns / SCALE, rows / SCALE, greys)
    }

    /// Pixels a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The pixels, row by row.
    pub fn greys(&self) -> &[u8] {
        &self.greys
    }

    /// Where and how this picture differs from what was expected; `None` where every pixel is equal.
    pub fn difference(&self, expected: &Self) -> Option<Difference> {
        if (self.width, self.height) != (expected.width, expected.height) {
            return Some(Difference { count: 0, first: None, seen: self.clone(), expected: expected.clone() });
        }
        let unequal = |&index: &usize| self.greys[index] != expected.greys[index];
        let first = (0..self.greys.len()).find(unequal)?;
        let count = (0..self.greys.len()).filter(unequal).count();
        let first = Some((first % self.width, first / self.width));
        Some(Difference { count, first, seen: self.clone(), expected: expected.clone() })
    }
}

impl fmt::Debug for Picture {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        writeln!(formatter, "picture of {}x{}", self.width, self.height)?;
        for row in self.greys.chunks(self.width) {
            let line: String = row.iter().map(|&grey| shade(grey)).collect();
            writeln!(formatter, "|{}", line.trim_end())?;
        }
        Ok(())
    }
}

/// How a picture differs from the expected one.
#[derive(Debug)]
pub struct Difference {
    /// Number of unequal pixels.
    pub count: usize,
    /// Column and row of the first; `None` where the sizes differ.
    pub first: Option<(usize, usize)>,
    seen: Picture,
    expected: Picture,
}

impl fmt::Display for Difference {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        let (seen, expected) = (&self.seen, &self.expected);
        let Some((x, y)) = self.first else {
            let sizes = (seen.width, seen.height, expected.width, expected.height);
            return write!(formatter, "a picture of {}x{}, expected {}x{}", sizes.0, sizes.1, sizes.2, sizes.3);
        };
        let at = y * seen.width + x;
        let (is, should) = (seen.greys[at], expected.greys[at]);
        writeln!(formatter, "{} pixels differ, first ({x}, {y}): {is}, expected {should}", self.count)?;
        writeln!(formatter, "(+ too bright, - too dark, else as expected)")?;
        let rows = seen.greys.chunks(seen.width).zip(expected.greys.chunks(seen.width));
        for (row, (seen, expected)) in rows.enumerate().filter(|(_, (seen, expected))| seen != expected) {
            let line: String = seen.iter().zip(expected).map(|(&is, &should)| mark(is, should)).collect();
            writeln!(formatter, "{row:4} {}", line.trim_end())?;
        }
        Ok(())
    }
}

fn mark(is: u8, should: u8) -> char {
    match is.cmp(&should) {
        std::cmp::Ordering::Greater => '+',
        std::cmp::Ordering::Less => '-',
        std::cmp::Ordering::Equal => shade(is),
    }
}

fn shade(grey: u8) -> char {
    match grey {
        0 => ' ',
        1..=5 => '.',
        6..=10 => 'o',
        _ => '#',
    }
}

/// Columns, rows and the pixels (three bytes each) of a binary portable pixmap.
fn parse_pixmap(pixmap: &[u8]) -> Result<(usize, usize, &[u8])> {
    let mut rest = pixmap.strip_prefix(b"P6").context("not a binary portable pixmap (P6)")?;
    let mut numbers = [0_usize; 3];
    for number in &mut numbers {
        rest = rest.trim_ascii_start();
        let digits = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
        *number = std::str::from_utf8(&rest[..digits])?.parse().context("a damaged pixmap header")?;
        rest = &rest[digits..];
    }
    let [columns, rows, maximum] = numbers;
    ensure!(maximum == 255, "a pixmap with values up to {maximum}, expected 255");
    let Some((_blank, pixels)) = rest.split_first() else { bail!("a pixmap without pixels") };
    ensure!(Some(pixels.len()) == columns.checked_mul(rows).and_then(|count| count.checked_mul(3)), "a pixmap cut short");
    Ok((columns, rows, pixels))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window(greys: &[u8], columns: usize) -> Vec<u8> {
        let rows = greys.len() / columns;
        let mut pixmap = format!("P6\n{} {}\n255\n", SCALE * columns, SCALE * rows).into_bytes();
        for y in 0..SCALE * rows {
            for x in 0..SCALE * columns {
                pixmap.extend([greys[y / SCALE * columns + x / SCALE] * GREY_STEP; 3]);
            }
        }
        pixmap
    }

    #[test]
    fn a_window_is_read_back_into_its_greys() {
        let greys: Vec<u8> = (0..16).collect();
        let picture = Picture::from_window(&window(&greys, 8)).unwrap();
        assert_eq!((picture.width(), picture.height(), picture.greys()), (8, 2, &greys[..]));
    }

    #[test]
    fn a_pixel_unlike_its_square_is_refused_by_place() {
        let mut pixmap = window(&[3, 4], 2);
        let last = pixmap.len() - 1;
        pixmap[last] ^= 1;
        let error = Picture::from_window(&pixmap).unwrap_err().to_string();
        assert!(error.contains("pixel (7, 3)"), "{error}");
    }

    #[test]
    fn a_colour_between_the_greys_is_refused() {
        let mut pixmap = window(&[3], 1);
        let header = pixmap.len() - 48;
        pixmap[header..].fill(52);
        let error = Picture::from_window(&pixmap).unwrap_err().to_string();
        assert!(error.contains("none of the 16 greys"), "{error}");
    }

    #[test]
    fn a_cut_or_foreign_pixmap_is_refused() {
        let pixmap = window(&[3, 4], 2);
        for length in 0..pixmap.len() {
            assert!(Picture::from_window(&pixmap[..length]).is_err(), "{length} bytes");
        }
        assert!(Picture::from_window(b"\x89PNG").is_err());
    }

    #[test]
    fn a_difference_names_count_place_and_greys() {
        let seen = Picture::new(4, 2, vec![0, 0, 0, 0, 15, 7, 0, 0]).unwrap();
        let expected = Picture::new(4, 2, vec![0, 0, 0, 0, 15, 0, 9, 0]).unwrap();
        assert!(seen.difference(&seen).is_none());
        let difference = seen.difference(&expected).unwrap();
        assert_eq!((difference.count, difference.first), (2, Some((1, 1))));
        let text = difference.to_string();
        assert!(text.starts_with("2 pixels differ, first (1, 1): 7, expected 0\n"), "{text}");
        assert!(text.ends_with("   1 #+-\n"), "{text}");
    }

    #[test]
    fn pictures_of_unequal_size_differ() {
        let (wide, high) = (Picture::new(2, 1, vec![0; 2]).unwrap(), Picture::new(1, 2, vec![0; 2]).unwrap());
        assert_eq!(wide.difference(&high).unwrap().to_string(), "a picture of 2x1, expected 1x2");
    }
}
