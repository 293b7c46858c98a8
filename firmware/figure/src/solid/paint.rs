//! Draws the rows of a hull: its outline, its fill, and the shaded side of it.

use super::MARGIN;
use super::hull::{Circle, EMPTY, Rows, Span, WINDOW};
use crate::ink::Ink;
use crate::surface::{Cursor, Surface};

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
        let slope = -(dy << 12) / dx;
        let aside = -(beyond * length) / dx;
        // Pixels' middles are at 8.
        let at = ((x + aside - 8) << 8) + ((slope * (8 - y)) >> 4);
        Cut::Columns { from_left: dx > 0, at, slope }
    }

    /// What is left of a span.
    #[inline(always)]
    fn apply(&self, row: i32, [low, high]: Span) -> Span {
        match *self {
            Cut::None => [low, high],
            Cut::Columns { from_left, at, slope } => {
                let place = ((at + slope * row) >> 12).clamp(-1, i32::from(i16::MAX) - 1) as i16;
                if from_left { [low.max(place), high] } else { [low, high.min(place)] }
            }
            Cut::Rows { above, row: limit } => {
                if (row < limit) == above && row != limit {
                    EMPTY
                } else {
                    [low, high]
                }
            }
        }
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
            self.rows.compute(circles, top, flat);
            paint(self.surface, &self.rows, top, outline, fill);
            top += WINDOW as i32;
        }
    }

    /// Fills what of a circle lies within the hull of others.
    #[inline(never)]
    pub(super) fn clipped(&mut self, circle: Circle, hull: &[Circle], fill: &Fill<S::Ink>) {
        let [first, last] = rows_of(&[circle], false, 0, self.surface.size()[1]);
        let (mut top, mut own) = (first, Rows::new());
        while top <= last {
            self.rows.compute(hull, top, false);
            own.compute(&[circle], top, false);
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

/// Draws a hull's rows in the window from row `top` on.
#[inline(never)]
fn paint<S: Surface>(surface: &mut S, rows: &Rows, top: i32, outline: &Outline<S::Ink>, fill: &Fill<S::Ink>) {
    let [width, height] = surface.size();
    let (first, last) =
        ((rows.first - outline.width).max(top), (rows.last + outline.width).min(top + WINDOW as i32 - 1).min(height - 1));
    if rows.first > rows.last || first > last {
        return;
    }
    let most = (width - 1) as i16;
    let inside = |[low, high]: Span| [low.max(0), high.min(most)];
    let (mut left, mut right) = (i16::MAX, -1);
    for row in first..=last {
        let own = rows.span(row);
        let inner = inside(own);
        if outline.width > 0 {
            let mut outer = inside(grown(rows, row, own, outline.width));
            for cut in &outline.cuts {
                outer = cut.apply(row, outer);
            }
            let [low, high] = outer;
            if low <= high {
                (left, right) = (left.min(low), right.max(high));
                if own[0] > own[1] {
                    span(surface, row, outer, outline.ink);
                } else {
                    span(surface, row, [low, high.min(own[0].saturating_sub(1))], outline.ink);
                    span(surface, row, [low.max(own[1].saturating_add(1)), high], outline.ink);
                }
            }
        }
        if inner[0] <= inner[1] {
            (left, right) = (left.min(inner[0]), right.max(inner[1]));
            fill_row(surface, rows, row, inner, fill);
        }
    }
    if left <= right {
        surface.mark([left.into(), first], [right.into(), last]);
    }
}

/// The rows' span with everything that is within `width` pixels of the hull.
#[inline(always)]
fn grown(rows: &Rows, row: i32, [low, high]: Span, width: i32) -> Span {
    let mut grown = if low <= high { [low - width as i16, high + width as i16] } else { EMPTY };
    let mut reach = width;
    for away in 1..=width.min(MARGIN) {
        while reach * reach + away * away > width * width + width / 2 {
            reach -= 1;
        }
        for other in [rows.span(row - away), rows.span(row + away)] {
            if other[0] <= other[1] {
                grown = [grown[0].min(other[0] - reach as i16), grown[1].max(other[1] + reach as i16)];
            }
        }
    }
    grown
}

#[inline(always)]
fn fill_row<S: Surface>(surface: &mut S, rows: &Rows, row: i32, inner: Span, fill: &Fill<S::Ink>) {
    match *fill {
        Fill::Plain(ink) => span(surface, row, inner, ink),
        Fill::Checkered(ink, other) => {
            span(surface, row, inner, other);
            every_other(surface, row, inner, row & 1, ink);
        }
        Fill::Dotted(ink, other) => {
            span(surface, row, inner, other);
            if row & 1 == 0 {
                every_other(surface, row, inner, 0, ink);
            }
        }
        Fill::Shaded(lit, shaded, [across, down]) => {
            let [low, high] = rows.span(row + down);
            let [low, high] = [low.saturating_sub(across as i16).max(inner[0]), high.saturating_sub(across as i16).min(inner[1])];
            if low > high {
                return span(surface, row, inner, shaded);
            }
            span(surface, row, [inner[0], low - 1], shaded);
            span(surface, row, [low, high], lit);
            span(surface, row, [high + 1, inner[1]], shaded);
        }
        Fill::Rimmed(rim, ink) => {
            let ([low, high], above, below) = (rows.span(row), rows.span(row - 1), rows.span(row + 1));
            span(surface, row, inner, rim);
            let low = (low + 1).max(above[0]).max(below[0]).max(inner[0]);
            let high = (high - 1).min(above[1]).min(below[1]).min(inner[1]);
            span(surface, row, [low, high], ink);
        }
    }
}

/// The pixels of a row, where there are any.
#[inline(always)]
pub(super) fn span<S: Surface>(surface: &mut S, row: i32, [low, high]: Span, ink: S::Ink) {
    if low <= high {
        surface.span(row, [low.into(), high.into()], ink);
    }
}

/// The even pixels of a row, or the odd ones.
#[inline(always)]
fn every_other<S: Surface>(surface: &mut S, row: i32, [low, high]: Span, odd: i32, ink: S::Ink) {
    let (low, high) = (i32::from(low), i32::from(high));
    let mut column = low + ((low ^ odd) & 1);
    let mut cursor = surface.cursor(column.min(high), row);
    while column <= high {
        surface.put(cursor, ink);
        column += 2;
        if column <= high {
            cursor.across(true);
            cursor.across(true);
        }
    }
}
