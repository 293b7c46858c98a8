//! Draws the rows of a hull: its outline, its fill, and the shaded side of it.

use super::hull::{Circle, EMPTY, Rows, Span, WINDOW};
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
    /// Edges from a row on.
    #[inline(always)]
    fn edges(&self, row: i32) -> [Edge; 2] {
        self.cuts.map(|cut| match cut {
            Cut::Columns { from_left, at, slope } => Edge { at: at.wrapping_add(slope.wrapping_mul(row)), slope, from_left },
            _ => Edge { at: i32::MIN, slope: 0, from_left: true },
        })
    }

    /// The first and the last row that are not cut off as a whole.
    #[inline(always)]
    fn rows(&self) -> [i32; 2] {
        let mut rows = [i32::MIN, i32::MAX];
        for cut in &self.cuts {
            match *cut {
                Cut::Rows { above: true, row } => rows[0] = rows[0].max(row),
                Cut::Rows { above: false, row } => rows[1] = rows[1].min(row),
                _ => {}
            }
        }
        rows
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
        let [width, height] = self.surface.size();
        let [first, last] = rows_of(circles, flat, outline.width, height);
        let columns = columns_of(circles, outline.width, width);
        let mut top = first;
        while top <= last {
            self.rows.compute(circles, top, flat, 2 * outline.width);
            paint(self.surface, &self.rows, top, columns, outline, fill);
            top += WINDOW as i32;
        }
    }

    /// Fills what of a circle lies within the hull that was drawn last, which is `hull`.
    #[inline(never)]
    pub(super) fn clipped(&mut self, circle: Circle, hull: &[Circle], fill: &Fill<S::Ink>) {
        let [width, height] = self.surface.size();
        let [first, last] = rows_of(&[circle], false, 0, height);
        let columns = columns_of(&[circle], 0, width);
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
            paint(self.surface, &own, top, columns, &Outline { ink: S::Ink::DARK, width: 0, cuts: [Cut::None; 2] }, fill);
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

/// The first and the last column of a hull and its outline, as far as they are on a surface of `width` columns; the first is greater if none is.
#[inline(always)]
fn columns_of(circles: &[Circle], outline: i32, width: i32) -> [i32; 2] {
    let (mut low, mut high) = (i32::MAX, i32::MIN);
    for [x, _, r] in circles {
        low = low.min(x - r);
        high = high.max(x + r);
    }
    [((low >> 4) - outline).max(0), ((high >> 4) + outline).min(width - 1)]
}

/// Spans of at most this many pixels are drawn over what lies below them: two spans beside them would take longer.
const NARROW: i32 = 8;

/// Draws a hull's rows in the window from row `top` on, whose pixels are all in `columns` and on the surface: the outline first, then the
/// fill, which covers parts of it. Apart, both loops keep in registers what they need.
#[inline(never)]
fn paint<S: Surface>(surface: &mut S, rows: &Rows, top: i32, columns: [i32; 2], outline: &Outline<S::Ink>, fill: &Fill<S::Ink>) {
    let height = surface.size()[1];
    let wide = outline.width.clamp(0, WIDEST as i32);
    let (first, last) = ((rows.first - wide).max(top), (rows.last + wide).min(top + WINDOW as i32 - 1).min(height - 1));
    if rows.first > rows.last || first > last || columns[0] > columns[1] {
        return;
    }
    if wide > 0 {
        draw_outline(surface, rows, [first, last], outline);
    }
    draw_fill(surface, rows, [first.max(rows.first), last.min(rows.last)], fill);
    surface.mark([columns[0], first], [columns[1], last]);
}

/// A span in 32 bits. Where `map` is a loop over memory, this is two loads.
#[inline(always)]
fn wide_of(&[low, high]: &Span) -> [i32; 2] {
    [low.into(), high.into()]
}

/// Draws an outline in rows that are on the surface.
#[inline(always)]
fn draw_outline<S: Surface>(surface: &mut S, rows: &Rows, [first, last]: [i32; 2], outline: &Outline<S::Ink>) {
    let most = surface.size()[0] - 1;
    let [from, to] = outline.rows();
    let (first, last) = (first.max(from), last.min(to));
    let mut edges = outline.edges(first);
    let cut = edges.iter().any(|edge| edge.at != i32::MIN);
    let mut beside = |row: i32, own: [i32; 2], mut low: i32, mut high: i32| {
        if cut {
            edges.iter_mut().for_each(|edge| edge.cut(&mut low, &mut high));
        }
        (low, high) = (low.max(0), high.min(most));
        if low > high {
            return;
        }
        let inner = [own[0].max(0), own[1].min(most)];
        if inner[1] - inner[0] < NARROW {
            return span(surface, row, [low, high], outline.ink);
        }
        span(surface, row, [low, high.min(inner[0] - 1)], outline.ink);
        span(surface, row, [low.max(inner[1] + 1), high], outline.ink);
    };
    let wide = outline.width.min(WIDEST as i32);
    let spans = if first <= last { rows.stretch(first - wide, last + wide) } else { &[] };
    if wide == 1 {
        let [above, own, rest @ ..] = spans else { return };
        let (mut above, mut own) = (wide_of(above), wide_of(own));
        for (below, row) in rest.iter().zip(first..) {
            let below = wide_of(below);
            beside(row, own, (own[0] - 1).min(above[0]).min(below[0]), (own[1] + 1).max(above[1]).max(below[1]));
            (above, own) = (own, below);
        }
        return;
    }
    let reaches = outline.reaches();
    for (window, row) in spans.windows(2 * wide as usize + 1).zip(first..) {
        let Some((above, [middle, below @ ..])) = window.split_at_checked(wide as usize) else { continue };
        let own = wide_of(middle);
        let (mut low, mut high) = (own[0] - wide, own[1] + wide);
        for ((above, below), reach) in above.iter().rev().zip(below).zip(&reaches) {
            low = low.min(i32::from(above[0].min(below[0])) - reach);
            high = high.max(i32::from(above[1].max(below[1])) + reach);
        }
        beside(row, own, low, high);
    }
}

/// Fills rows that are on the surface.
#[inline(always)]
fn draw_fill<S: Surface>(surface: &mut S, rows: &Rows, [first, last]: [i32; 2], fill: &Fill<S::Ink>) {
    if first > last {
        return;
    }
    let most = surface.size()[0] - 1;
    let inners = rows.stretch(first, last).iter().zip(first..).map(|(own, row)| {
        let [low, high] = wide_of(own);
        (row, [low.max(0), high.min(most)])
    });
    match *fill {
        Fill::Plain(ink) => inners.for_each(|(row, inner)| span(surface, row, inner, ink)),
        Fill::Checkered(ink, other) | Fill::Dotted(ink, other) => {
            let every_row = matches!(fill, Fill::Checkered(..));
            for (row, inner) in inners {
                span(surface, row, inner, other);
                let begin = inner[0] + ((inner[0] ^ row) & 1);
                if begin <= inner[1] && (row & 1 == 0 || every_row) {
                    surface.alternate(row, [begin, inner[1]], ink);
                }
            }
        }
        Fill::Shaded(lit, shaded, [across, down]) => {
            // There are none below the hull's last row.
            let mut below = rows.stretch(first + down, rows.last).iter();
            for (row, inner) in inners {
                let [low, high] = wide_of(below.next().unwrap_or(&EMPTY));
                nested(surface, row, inner, [low - across, high - across], [shaded, lit]);
            }
        }
        Fill::Rimmed(rim, ink) => {
            for (row, inner) in inners {
                let [[low, high], above, below] = [0, -1, 1].map(|away| wide_of(&rows.span(row + away)));
                let core = [(low + 1).max(above[0]).max(below[0]), (high - 1).min(above[1]).min(below[1])];
                nested(surface, row, inner, core, [rim, ink]);
            }
        }
    }
}

/// Draws a span within another one, each in its ink.
#[inline(always)]
fn nested<S: Surface>(surface: &mut S, row: i32, outer: [i32; 2], inner: [i32; 2], [around, ink]: [S::Ink; 2]) {
    if outer[0] > outer[1] {
        return;
    }
    let inner = [inner[0].max(outer[0]), inner[1].min(outer[1])];
    if outer[1] - outer[0] < NARROW || inner[0] > inner[1] {
        span(surface, row, outer, around);
    } else {
        span(surface, row, [outer[0], inner[0] - 1], around);
        span(surface, row, [inner[1] + 1, outer[1]], around);
    }
    span(surface, row, inner, ink);
}

/// The pixels of a row, where there are any.
#[inline(never)]
fn span<S: Surface>(surface: &mut S, row: i32, [low, high]: [i32; 2], ink: S::Ink) {
    if low <= high {
        surface.span(row, [low, high], ink);
    }
}
