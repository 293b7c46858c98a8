//! The OLED's pixels, read back from QEMU's window, and the difference between two pictures.

use std::fmt;

use anyhow::{Context, Result, bail, ensure};
use pantin_tools::render::screen::{HEIGHT, Picture, WIDTH};

/// QEMU shows each pixel of the SSD0323 as a square of this side.
const SCALE: usize = 4;

/// QEMU shows the grey `v` of 0..=15 as the RGB value `17 v`.
const GREY_STEP: u8 = 17;

/// Reads QEMU's window (a binary portable pixmap) back into the display's pixels. Refuses a picture that is not made of
/// whole 4x4 squares in the 16 greys: then it is not the display.
pub fn from_window(pixmap: &[u8]) -> Result<Picture> {
    let (columns, rows, window) = parse_pixmap(pixmap)?;
    ensure!(
        (columns, rows) == (SCALE * WIDTH, SCALE * HEIGHT),
        "a window of {columns}x{rows}, not {WIDTH}x{HEIGHT} squares of {SCALE}"
    );
    let mut pixels = vec![0; WIDTH * HEIGHT];
    for (index, rgb) in window.chunks_exact(3).enumerate() {
        let (x, y) = (index % columns, index / columns);
        let corner = &window[3 * ((y - y % SCALE) * columns + x - x % SCALE)..][..3];
        ensure!(rgb == corner, "the window's pixel ({x}, {y}) is {rgb:?}, the first of its square {corner:?}");
        let grey = rgb[0] / GREY_STEP;
        ensure!(rgb == [grey * GREY_STEP; 3], "the window's pixel ({x}, {y}) is {rgb:?}, none of the 16 greys");
        pixels[y / SCALE * WIDTH + x / SCALE] = grey;
    }
    Ok(Picture { pixels })
}

/// Where and how a picture differs from what was expected; `None` where every pixel is equal.
pub fn difference(seen: &Picture, expected: &Picture) -> Option<Difference> {
    let pairs = || seen.pixels.iter().zip(&expected.pixels);
    let first = pairs().position(|(is, should)| is != should)?;
    let count = pairs().filter(|(is, should)| is != should).count();
    Some(Difference { count, first: (first % WIDTH, first / WIDTH), seen: seen.clone(), expected: expected.clone() })
}

/// How a picture differs from the expected one.
#[derive(Debug)]
pub struct Difference {
    /// Number of unequal pixels.
    pub count: usize,
    /// Column and row of the first.
    pub first: (usize, usize),
    seen: Picture,
    expected: Picture,
}

impl fmt::Display for Difference {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        let (seen, expected) = (&self.seen.pixels, &self.expected.pixels);
        let (x, y) = self.first;
        let at = y * WIDTH + x;
        let (is, should) = (seen[at], expected[at]);
        writeln!(formatter, "{} pixels differ, first ({x}, {y}): {is}, expected {should}", self.count)?;
        writeln!(formatter, "(+ too bright, - too dark, else as expected)")?;
        let rows = seen.chunks(WIDTH).zip(expected.chunks(WIDTH));
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

    fn gradient() -> Picture {
        Picture { pixels: (0..WIDTH * HEIGHT).map(|index| (index % 16) as u8).collect() }
    }

    fn window(picture: &Picture) -> Vec<u8> {
        let mut pixmap = format!("P6\n{} {}\n255\n", SCALE * WIDTH, SCALE * HEIGHT).into_bytes();
        pixmap.extend(picture.enlarged(SCALE).into_iter().flat_map(|grey| [grey; 3]));
        pixmap
    }

    #[test]
    fn a_window_is_read_back_into_its_greys() {
        assert_eq!(from_window(&window(&gradient())).unwrap(), gradient());
    }

    #[test]
    fn a_pixel_unlike_its_square_is_refused_by_place() {
        let mut pixmap = window(&gradient());
        *pixmap.last_mut().unwrap() ^= 1;
        let error = from_window(&pixmap).unwrap_err().to_string();
        assert!(error.contains("pixel (511, 255)"), "{error}");
    }

    #[test]
    fn a_colour_between_the_greys_is_refused() {
        let mut pixmap = window(&gradient());
        let pixels = pixmap.len() - 3 * 512 * 256;
        pixmap[pixels..].fill(52);
        let error = from_window(&pixmap).unwrap_err().to_string();
        assert!(error.contains("none of the 16 greys"), "{error}");
    }

    #[test]
    fn a_cut_or_foreign_pixmap_is_refused() {
        let pixmap = window(&gradient());
        for length in (0..40).chain([pixmap.len() - 1]) {
            assert!(from_window(&pixmap[..length]).is_err(), "{length} bytes");
        }
        let error = from_window(b"P6 4 4 255\n0123456789ab0123456789ab0123456789ab0123456789ab").unwrap_err().to_string();
        assert!(error.contains("a window of 4x4"), "{error}");
        assert!(from_window(b"\x89PNG").is_err());
    }

    #[test]
    fn a_difference_names_count_place_and_greys() {
        let blank = || vec![0; WIDTH * HEIGHT];
        let (mut seen, mut expected) = (Picture { pixels: blank() }, Picture { pixels: blank() });
        assert!(difference(&seen, &expected).is_none());
        seen.pixels[WIDTH..WIDTH + 3].copy_from_slice(&[15, 7, 0]);
        expected.pixels[WIDTH..WIDTH + 3].copy_from_slice(&[15, 0, 9]);
        let difference = difference(&seen, &expected).unwrap();
        assert_eq!((difference.count, difference.first), (2, (1, 1)));
        let text = difference.to_string();
        assert!(text.starts_with("2 pixels differ, first (1, 1): 7, expected 0\n"), "{text}");
        assert!(text.ends_with("   1 #+-\n"), "{text}");
    }
}
