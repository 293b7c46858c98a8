//! Contact sheets and strips: pictures in rows, each with a label below.

use crate::image::{Image, LETTER};
use crate::palette::Palette;

/// Below a picture for its label.
const LABEL: usize = LETTER[1] + 2;

/// Where pictures stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Of a picture: columns and rows of pixels.
    pub picture: [usize; 2],
    /// Pictures in a row.
    pub columns: usize,
    /// Rows of pictures.
    pub rows: usize,
    /// Pixels between pictures.
    pub gap: usize,
}

impl Layout {
    /// The whole sheet's size.
    pub fn size(&self) -> [usize; 2] {
        let [width, height] = self.picture;
        [self.gap + self.columns * (width + self.gap), self.gap + self.rows * (height + self.gap + LABEL)]
    }

    /// The upper left corner of a picture, counted row by row.
    pub fn corner(&self, index: usize) -> [usize; 2] {
        let [width, height] = self.picture;
        [self.gap + index % self.columns * (width + self.gap), self.gap + index / self.columns * (height + self.gap + LABEL)]
    }
}

/// Puts labelled pictures into their places.
pub fn arrange(layout: Layout, cells: &[(String, Image)], palette: &Palette) -> Image {
    let [width, height] = layout.size();
    let mut sheet = Image::new(width, height, palette.margin());
    for (index, (label, image)) in cells.iter().enumerate() {
        let [left, top] = layout.corner(index);
        sheet.put(left, top, image);
        let letters: String = label.chars().take(layout.picture[0] / LETTER[0]).collect();
        sheet.write_text(left + 2, top + layout.picture[1] + 2, &letters, palette.letters());
    }
    sheet
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_do_not_touch() {
        let layout = Layout { picture: [10, 20], columns: 2, rows: 2, gap: 3 };
        assert_eq!(layout.size(), [3 + 2 * 13, 3 + 2 * (23 + LABEL)]);
        assert_eq!((layout.corner(0), layout.corner(3)), ([3, 3], [16, 3 + 23 + LABEL]));
        let cells: Vec<_> = (0..4).map(|_| (String::new(), Image::new(10, 20, [255; 3]))).collect();
        let sheet = arrange(layout, &cells, &Palette::default());
        assert_eq!(sheet.pixels().iter().filter(|&&pixel| pixel == [255; 3]).count(), 4 * 200);
    }
}
