//! Pictures that a firmware sends over the serial port, put together from the windows that changed.

use std::io::Read;

use anyhow::{Context, Result, bail, ensure};

use crate::display::{Depth, Display, Picture};

/// A display's memory as the firmware has sent it so far.
pub struct Memory {
    display: Display,
    bytes: Vec<u8>,
}

/// Columns, rows and bytes of a cell of the layout: `MonoPages`, `Gray4Rows`, `Rgb565Rows` of `pantin_figure::surface`.
const fn cell(depth: Depth) -> [usize; 3] {
    match depth {
        Depth::Mono => [1, 8, 1],
        Depth::Gray4 => [8, 1, 4],
        Depth::Rgb565 | Depth::Bgr555 => [2, 1, 4],
    }
}

impl Memory {
    /// All dark.
    pub fn new(display: Display) -> Self {
        let [across, down, bytes] = cell(display.depth);
        Self { display, bytes: vec![0; display.width / across * (display.height / down) * bytes] }
    }

    /// Reads a window, after its first byte.
    pub fn take(&mut self, mut line: impl Read) -> Result<()> {
        let mut ends = [0; 4];
        line.read_exact(&mut ends).context("a window without its ends")?;
        let [left, right, top, bottom] = ends.map(usize::from);
        let [across, down, bytes] = cell(self.display.depth);
        let (columns, rows) = (self.display.width / across, self.display.height / down);
        ensure!(
            left <= right && right < columns && top <= bottom && bottom < rows,
            "a window of columns {left} to {right}, rows {top} to {bottom} on a display of {columns}x{rows} cells"
        );
        for row in top..=bottom {
            let [from, to] = [left, right + 1].map(|column| (row * columns + column) * bytes);
            line.read_exact(&mut self.bytes[from..to]).context("a window cut short")?;
        }
        Ok(())
    }

    /// Returns the picture.
    pub fn picture(&self) -> Picture {
        let Display { width, height, depth, .. } = self.display;
        let bytes = &self.bytes;
        let value = |index: usize| match depth {
            Depth::Mono => u16::from(bytes[index / width / 8 * width + index % width] >> (index / width % 8) & 1),
            Depth::Gray4 => u16::from(bytes[index / 2] >> (4 * (1 - index % 2)) & 15),
            Depth::Rgb565 | Depth::Bgr555 => u16::from_be_bytes([bytes[2 * index], bytes[2 * index + 1]]),
        };
        Picture { display: self.display, pixels: (0..width * height).map(value).collect() }
    }
}

/// Reads what the firmware sends up to the number of the frame that it shows.
pub fn shown(line: &mut impl Read, mut memory: Option<&mut Memory>) -> Result<u32> {
    loop {
        let mut letter = [0];
        line.read_exact(&mut letter).context("no frame number from the firmware")?;
        match (letter[0], &mut memory) {
            (pantin_app::SHOWN, _) => {
                let mut number = [0; 4];
                line.read_exact(&mut number).context("a frame number cut short")?;
                return Ok(u32::from_le_bytes(number));
            }
            (pantin_app::frame_stream::WINDOW, Some(memory)) => memory.take(&mut *line)?,
            (other, _) => bail!("the firmware sent {other:#x} in place of a frame's number"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::display::{GREYS, PAGES};

    #[test]
    fn windows_lie_where_their_ends_say() {
        let mut mono = Memory::new(PAGES);
        mono.take(&[2, 3, 1, 1, 0x01, 0x80][..]).unwrap();
        let lit: Vec<usize> = (0..128 * 64).filter(|&index| mono.picture().pixels[index] == 1).collect();
        assert_eq!(lit, [8 * 128 + 2, 15 * 128 + 3]);
        let mut greys = Memory::new(GREYS);
        greys.take(&[15, 15, 63, 63, 0x12, 0x34, 0x56, 0x78][..]).unwrap();
        assert_eq!(greys.picture().pixels[128 * 64 - 8..], [1, 2, 3, 4, 5, 6, 7, 8]);
    }

    #[test]
    fn what_is_no_window_is_refused() {
        let mut mono = Memory::new(PAGES);
        assert!(mono.take(&[0, 128, 0, 0][..]).unwrap_err().to_string().contains("columns 0 to 128"));
        assert!(mono.take(&[0, 1, 0, 0, 7][..]).is_err());
        let error = shown(&mut &b"x"[..], None).unwrap_err().to_string();
        assert!(error.contains("sent 0x78"), "{error}");
        assert!(shown(&mut &b"W\0\0\0\0\0F\x01\0\0\0"[..], None).is_err(), "this display sends no windows");
        assert_eq!(shown(&mut &b"W\0\0\0\0\0F\x01\x02\0\0"[..], Some(&mut mono)).unwrap(), 513);
    }
}
