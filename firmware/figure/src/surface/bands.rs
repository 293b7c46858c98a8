//! What changed of a picture: a stretch of columns in each band of rows. What is clean need neither be cleared nor sent.

/// Rows of a band: a page of the displays that take bytes of eight rows.
pub const BAND: usize = 8;

/// Bands of the highest display: 320 rows.
const MOST: usize = 40;

/// First and last column that changed in a band; the first is greater where none did. Displays are at most 256 wide.
type Stretch = [u8; 2];
const CLEAN: Stretch = [u8::MAX, 0];

/// A rectangle of pixels; ends belong to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// First and last column.
    pub columns: [usize; 2],
    /// First and last row.
    pub rows: [usize; 2],
}

/// The changed stretch of every band.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bands([Stretch; MOST]);

impl Bands {
    /// Nothing changed.
    pub const CLEAN: Bands = Bands([CLEAN; MOST]);

    /// Everything of a display did.
    pub fn all(width: usize, height: usize) -> Bands {
        let mut bands = Bands::CLEAN;
        bands.mark([0, 0], [width as i32 - 1, height as i32 - 1]);
        bands
    }

    /// Takes in a rectangle whose ends are on the display.
    #[inline(always)]
    pub fn mark(&mut self, from: [i32; 2], to: [i32; 2]) {
        let (first, last) = (from[1] as usize / BAND, to[1] as usize / BAND);
        for stretch in self.0.get_mut(first..=last).unwrap_or_default() {
            stretch[0] = stretch[0].min(from[0] as u8);
            stretch[1] = stretch[1].max(to[0] as u8);
        }
    }

    /// Takes in another's of the same display.
    pub fn join(&mut self, other: &Bands, height: usize) {
        for (own, other) in self.0.iter_mut().zip(&other.0).take(height.div_ceil(BAND)) {
            *own = [own[0].min(other[0]), own[1].max(other[1])];
        }
    }

    /// A window for each band that changed, from the top of a display of `height` rows.
    #[inline(always)]
    pub fn windows(self, height: usize) -> impl Iterator<Item = Window> {
        (0..height.div_ceil(BAND)).filter_map(move |band| {
            let &[from, to] = self.0.get(band).filter(|stretch| stretch[0] <= stretch[1])?;
            Some(Window { columns: [from.into(), to.into()], rows: [band * BAND, (band * BAND + BAND).min(height) - 1] })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_marks_every_band_that_it_touches() {
        let mut bands = Bands::CLEAN;
        assert_eq!(bands.windows(64).count(), 0);
        bands.mark([10, 7], [20, 8]);
        bands.mark([3, 15], [3, 15]);
        let windows: Vec<_> = bands.windows(64).collect();
        assert_eq!(windows, [Window { columns: [10, 20], rows: [0, 7] }, Window { columns: [3, 20], rows: [8, 15] }]);
        let mut joined = Bands::all(128, 60);
        joined.join(&bands, 60);
        assert_eq!(joined, Bands::all(128, 60));
        assert_eq!(joined.windows(60).last(), Some(Window { columns: [0, 127], rows: [56, 59] }));
    }
}
