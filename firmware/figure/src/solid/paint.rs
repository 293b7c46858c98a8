//! Draws the rows of a hull: its outline, its fill, and the shaded side of it.

use super::hull::{Circle, Rows, WINDOW};
use crate::ink::Ink;
use crate::surface::Surface;

/// What a hull is filled with.
#[derive(Clone, Copy)]
pub(super) enum Fill<I> {
    /// One colour.
    Plain(I),
    /// Every other pixel of the first one, the others of the second.
    Checkered(I, I),
    /// Every other pixel of every other row in the first one, the others of the second.
    Dotted(I, I),
    /// The lit side, and the other one: what is not covered by the hull moved by the vector from it, in pixels.
    Shaded(I, I, [i32; 2]),
    /// A rim of a pixel, and what is inside.
    Rimmed(I, I),
}

/// Half a plane that has no outline: where a neighbour that was drawn before goes on.
#[derive(Clone, Copy)]
pub(super) enum Cut {
    /// No such place.
    None,
    /// Columns before (`from_left`) or after a place, which moves by a slope a row: both in pixels with 12 more bits, from row 0 on.
    Columns { from_left: bool, at: i32, slope: i32 },
    /// Rows before or after a row.
    Rows { above: bool, row: i32 },
}

impl Cut {
    /// Where a neighbour goes on at a circle: all that lies half a radius and more beyond its middle, as seen from the rest of the part.
    pub(super) fn at(&[x, y, r]: &Circle, inwards: [i32; 2]) -> Cut {
        let [dx, dy] = inwards;
        let long = dx.abs().max(dy.abs());
        if long <= r / 4 {
            return Cut::None;
        }
        // The length of the way within 4 %: the longer part and 3/8 of the shorter one, 31/32 of them.
        let short = dx.abs().min(dy.abs());
        let length = (long + short * 3 / 8) * 31 / 32;
        // 0.45 of the radius.
        let beyond = r * 29 / 64;
        if dx.abs() * 16 < dy.abs() {
            let row = y - if dy > 0 { beyond } else { -beyond };
            return Cut::Rows { above: dy > 0, row: row >> 4 };
        }
        // dx (x' - x) + dy (y' - y) = -beyond length.
        let over = |part: i32| part.checked_div(dx).unwrap_or(0);
        let (slope, aside) = (over(-(dy << 12)), over(-(beyond * length)));
        // Pixels' middles are at 8.
        let at = ((x + aside - 8) << 8) + ((slope * (8 - y)) >> 4);
        Cut::Columns { from_left: dx > 0, at, slope }
    }
}

/// Where an outline begins or ends in a row, walked down row by row: a column with 12 more bits.
#[derive(Clone, Copy)]
struct Edge {
    at: i32,
    slope: i32,
    from_left: bool,
}

impl Edge {
    /// Takes what is cut off from a row's span, and goes a row down.
    #[inline(always)]
    fn cut(&mut self, low: &mut i32, high: &mut i32) {
        let place = self.at >> 12;
        if self.from_left {
            *low = (*low).max(place);
        } else {
            *high = (*high).min(place);
        }
        self.at = self.at.wrapping_add(self.slope);
    }
}

/// An outline.
#[derive(Clone, Copy)]
pub(super) struct Outline<I> {
    pub ink: I,
    /// Pixels across; 0 for none.
    pub width: i32,
    pub cuts: [Cut; 2],
}

/// Widest outline: two of them are within [`MARGIN`](super::MARGIN).
const WIDEST: usize = 8;

impl<I> Outline<I> {
    /// Edges from a row on, and the rows that are not cut off as a whole.
    fn edges(&self, row: i32) -> ([Edge; 2], [i32; 2]) {
        let mut rows = [i32::MIN, i32::MAX];
        let edges = self.cuts.map(|cut| match cut {
            Cut::Columns { from_left, at, slope } => Edge { at: at.wrapping_add(slope.wrapping_mul(row)), slope, from_left },
            _ => Edge { at: i32::MIN, slope: 0, from_left: true },
        });
        for cut in &self.cuts {
            match *cut {
                Cut::Rows { above: true, row } => rows[0] = rows[0].max(row),
                Cut::Rows { above: false, row } => rows[1] = rows[1].min(row),
                _ => {}
            }
        }
        (edges, rows)
    }

    /// Pixels that the outline reaches to the side of a row that is 1, 2, ... rows away.
    fn reaches(&self) -> [i32; WIDEST] {
        let mut reach = self.width;
        let mut away = 0;
        [(); WIDEST].map(|()| {
            away += 1;
            while reach > 0 && reach * reach + away * away > self.width * self.width + self.width / 2 {
                reach -= 1;
            }
            reach
        })
    }
}

/// Draws hulls on a surface, one after the other.
pub(super) struct Painter<'a, S: Surface> {
    pub surface: &'a mut S,
    rows: Rows,
}

impl<'a, S: Surface> Painter<'a, S> {
    /// Draws on `surface`.
    #[inline(always)]
    pub(super) fn on(surface: &'a mut S) -> Self {
        Painter { surface, rows: Rows::new() }
    }

    /// Draws the hull of circles; `flat` ones as [`Rows::compute`] says.
    #[inline(never)]
    pub(super) fn hull(&mut self, circles: &[Circle], flat: bool, outline: &Outline<S::Ink>, fill: &Fill<S::Ink>) {
        let [first, last] = rows_of(circles, flat, outline.width, self.surface.size()[1]);
        let mut top = first;
        while top <= last {
            self.rows.compute(circles, top, flat, 2 * outline.width);
            paint(self.surface, &self.rows, top, outline, fill);
            top += WINDOW as i32;
        }
    }

    /// Fills what of a circle lies within the hull that was drawn last, which is `hull`.
    #[inline(never)]
    pub(super) fn clipped(&mut self, circle: Circle, hull: &[Circle], fill: &Fill<S::Ink>) {
        let [first, last] = rows_of(&[circle], false, 0, self.surface.size()[1]);
        let (mut top, mut own) = (first, Rows::new());
        // Most heads are within one window, whose rows are known.
        let known = rows_of(hull, false, 0, i32::MAX);
        let known = (self.rows.first <= known[0] + 1 && self.rows.last >= known[1] - 1) || first > last;
        while top <= last {
            if !known {
                self.rows.compute(hull, top, false, 0);
            }
            own.compute(&[circle], top, false, 0);
            own.clip(&self.rows);
            paint(self.surface, &own, top, &Outline { ink: S::Ink::DARK, width: 0, cuts: [Cut::None; 2] }, fill);
            top += WINDOW as i32;
        }
    }
}

/// The first and the last row of a hull and its outline, as far as they are on a surface of `height` rows.
#[inline(always)]
fn rows_of(circles: &[Circle], flat: bool, outline: i32, height: i32) -> [i32; 2] {
    let shift = if flat { 6 } else { 4 };
    let (mut low, mut high) = (i32::MAX, i32::MIN);
    for [_, y, r] in circles {
        low = low.min(y - r);
        high = high.max(y + r);
    }
    [((low >> shift) - outline).max(0), ((high >> shift) + outline).min(height - 1)]
}

/// Spans of at most this many pixels are drawn over what lies below them: two spans beside them would take longer.
const NARROW: i32 = 8;

/// Draws a hull's rows in the window from row `top` on.
#[inline(never)]
fn paint<S: Surface>(surface: &mut S, rows: &Rows, top: i32, outline: &Outline<S::Ink>, fill: &Fill<S::Ink>) {
    let [width, height] = surface.size();
    let wide = outline.width.clamp(0, WIDEST as i32);
    let (first, last) = ((rows.first - wide).max(top), (rows.last + wide).min(top + WINDOW as i32 - 1).min(height - 1));
    if rows.first > rows.last || first > last {
        return;
    }
    let most = width - 1;
    let (mut edges, [from, to]) = outline.edges(first);
    let cut = edges.iter().any(|edge| edge.at != i32::MIN);
    let reaches = if wide > 1 { outline.reaches() } else { [0; WIDEST] };
    let (mut left, mut right) = (most, 0);
    for (window, row) in rows.stretch(first - wide, last + wide).windows(2 * wide as usize + 1).zip(first..) {
        let (own, mut low, mut high);
        if let [above, middle, below] = window {
            own = middle.map(i32::from);
            low = (own[0] - 1).min(above[0].min(below[0]).into());
            high = (own[1] + 1).max(above[1].max(below[1]).into());
        } else {
            let Some((above, [middle, below @ ..])) = window.split_at_checked(wide as usize) else { continue };
            own = middle.map(i32::from);
            (low, high) = (own[0] - wide, own[1] + wide);
            for ((above, below), reach) in above.iter().rev().zip(below).zip(&reaches) {
                low = low.min(i32::from(above[0].min(below[0])) - reach);
                high = high.max(i32::from(above[1].max(below[1])) + reach);
            }
        }
        if cut {
            edges.iter_mut().for_each(|edge| edge.cut(&mut low, &mut high));
        }
        (low, high) = (low.max(0), high.min(most));
        if wide == 0 || !(from..=to).contains(&row) {
            (low, high) = (most, -1);
        }
        let inner = [own[0].max(0), own[1].min(most)];
        let narrow = inner[1] - inner[0] < NARROW;
        if low <= high {
            (left, right) = (left.min(low), right.max(high));
            if narrow {
                span(surface, row, [low, high], outline.ink);
            } else {
                span(surface, row, [low, high.min(inner[0] - 1)], outline.ink);
                span(surface, row, [low.max(inner[1] + 1), high], outline.ink);
            }
        }
        if inner[0] <= inner[1] {
            (left, right) = (left.min(inner[0]), right.max(inner[1]));
            fill_row(surface, rows, row, inner, fill, narrow);
        }
    }
    if left <= right {
        surface.mark([left, first], [right, last]);
    }
}

/// Fills a row.
#[inline(always)]
fn fill_row<S: Surface>(surface: &mut S, rows: &Rows, row: i32, inner: [i32; 2], fill: &Fill<S::Ink>, narrow: bool) {
    let inside = |[low, high]: [i32; 2]| [low.max(inner[0]), high.min(inner[1])];
    let (lit, around, ink) = match *fill {
        Fill::Plain(ink) => return span(surface, row, inner, ink),
        Fill::Checkered(ink, other) | Fill::Dotted(ink, other) => {
            span(surface, row, inner, other);
            let begin = inner[0] + ((inner[0] ^ row) & 1);
            if begin <= inner[1] && (row & 1 == 0 || matches!(fill, Fill::Checkered(..))) {
                surface.alternate(row, [begin, inner[1]], ink);
            }
            return;
        }
        Fill::Shaded(lit, shaded, [across, down]) => {
            let [low, high] = rows.span(row + down).map(i32::from);
            (inside([low - across, high - across]), shaded, lit)
        }
        Fill::Rimmed(rim, ink) => {
            let [[low, high], above, below] = [0, -1, 1].map(|away| rows.span(row + away).map(i32::from));
            (inside([(low + 1).max(above[0]).max(below[0]), (high - 1).min(above[1]).min(below[1])]), rim, ink)
        }
    };
    if narrow || lit[0] > lit[1] {
        span(surface, row, inner, around);
    } else {
        span(surface, row, [inner[0], lit[0] - 1], around);
        span(surface, row, [lit[1] + 1, inner[1]], around);
    }
    span(surface, row, lit, ink);
}

/// The pixels of a row, where there are any.
#[inline(never)]
fn span<S: Surface>(surface: &mut S, row: i32, [low, high]: [i32; 2], ink: S::Ink) {
    if low <= high {
        surface.span(row, [low, high], ink);
    }
}
