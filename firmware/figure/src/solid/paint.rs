//! Draws the rows of a hull: its outline, its fill, and the shaded side of it.

use super::hull::{Bounds, Circle, EMPTY, Rows, Span, WINDOW};
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

    /// Takes off what is cut off from the spans of rows from `first` on.
    #[inline(always)]
    fn take_off(&self, first: i32, spans: &mut [Span]) {
        let &Cut::Columns { from_left, at, slope } = self else { return };
        let mut at = at.wrapping_add(slope.wrapping_mul(first));
        // Places beyond all spans are like the last ones.
        if from_left {
            for [low, _] in spans {
                let place = at >> 12;
                if place > i32::from(*low) {
                    *low = place.min(i16::MAX.into()) as i16;
                }
                at = at.wrapping_add(slope);
            }
        } else {
            for [_, high] in spans {
                let place = at >> 12;
                if place < i32::from(*high) {
                    *high = place.max(i16::MIN.into()) as i16;
                }
                at = at.wrapping_add(slope);
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

/// Widest outline: two of them are within [`MARGIN`](super::MARGIN).
const WIDEST: usize = 8;

impl<I> Outline<I> {
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
    /// Outlines or cores of some rows.
    spans: [Span; AT_ONCE],
}

impl<'a, S: Surface> Painter<'a, S> {
    /// Draws on `surface`.
    #[inline(always)]
    pub(super) fn on(surface: &'a mut S) -> Self {
        Painter { surface, rows: Rows::new(), spans: [EMPTY; AT_ONCE] }
    }

    /// Draws the hull of circles; `flat` ones as [`Rows::compute`] says.
    #[inline(never)]
    pub(super) fn hull(&mut self, circles: &[Circle], flat: bool, outline: &Outline<S::Ink>, fill: &Fill<S::Ink>) {
        let bounds = Bounds::of(circles);
        let [first, last] = bounds.rows(flat, outline.width, self.surface.size()[1]);
        let columns = bounds.columns(outline.width, self.surface.size()[0]);
        let mut top = first;
        while top <= last {
            self.rows.compute(circles, &bounds, top, flat, 2 * outline.width);
            paint(self, top, columns, outline, fill);
            top += WINDOW as i32;
        }
    }

    /// Fills what of a circle lies within the hull that was drawn last, which is `hull`.
    #[inline(never)]
    pub(super) fn clipped(&mut self, circle: Circle, hull: &[Circle], fill: &Fill<S::Ink>) {
        let (bounds, around) = (Bounds::of(&[circle]), Bounds::of(hull));
        let [first, last] = bounds.rows(false, 0, self.surface.size()[1]);
        let columns = bounds.columns(0, self.surface.size()[0]);
        let mut top = first;
        // Most heads are within one window, whose rows are known.
        let known = around.rows(false, 0, i32::MAX);
        let known = self.rows.first <= known[0] + 1 && self.rows.last >= known[1] - 1;
        while top <= last {
            if !known {
                self.rows.compute(hull, &around, top, false, 0);
            }
            self.rows.clip(&circle);
            paint(self, top, columns, &Outline { ink: S::Ink::DARK, width: 0, cuts: [Cut::None; 2] }, fill);
            top += WINDOW as i32;
        }
    }
}

/// Rows whose outlines or cores are worked out before they are drawn: loops that do one thing keep in registers what they need.
const AT_ONCE: usize = 32;

/// Draws a hull's rows in the window from row `top` on, whose pixels are all in `columns` and on the surface: the outline first, then the
/// fill, which covers parts of it.
#[inline(never)]
fn paint<S: Surface>(
    Painter { surface, rows, spans }: &mut Painter<S>,
    top: i32,
    columns: [i32; 2],
    outline: &Outline<S::Ink>,
    fill: &Fill<S::Ink>,
) {
    let surface = &mut **surface;
    let height = surface.size()[1];
    let wide = outline.width.clamp(0, WIDEST as i32);
    let (first, last) = ((rows.first - wide).max(top), (rows.last + wide).min(top + WINDOW as i32 - 1).min(height - 1));
    if rows.first > rows.last || first > last || columns[0] > columns[1] {
        return;
    }
    surface.mark([columns[0], first], [columns[1], last]);
    if wide > 0 {
        draw_outline(surface, rows, [first, last], outline, spans);
    }
    draw_fill(surface, rows, [first.max(rows.first), last.min(rows.last)], fill, spans);
}

/// A span in 32 bits. Where `map` is a loop over memory, this is two loads.
#[inline(always)]
fn wide_of(&[low, high]: &Span) -> [i32; 2] {
    [low.into(), high.into()]
}

/// Draws an outline in rows that are on the surface.
#[inline(always)]
fn draw_outline<S: Surface>(
    surface: &mut S,
    rows: &Rows,
    [first, last]: [i32; 2],
    outline: &Outline<S::Ink>,
    spans: &mut [Span; AT_ONCE],
) {
    let (mut first, mut last) = (first, last);
    for cut in &outline.cuts {
        match *cut {
            Cut::Rows { above: true, row } => first = first.max(row),
            Cut::Rows { above: false, row } => last = last.min(row),
            _ => {}
        }
    }
    let wide = outline.width.min(WIDEST as i32);
    while first <= last {
        let count = (last - first + 1).min(AT_ONCE as i32);
        let around = rows.stretch(first - wide, first + count - 1 + wide);
        let spans = spans.get_mut(..count as usize).unwrap_or_default();
        if wide == 1 {
            thin(around, spans);
        } else {
            thick(around, outline, spans);
        }
        outline.cuts.iter().for_each(|cut| cut.take_off(first, spans));
        surface.spans(first, spans, around.get(wide as usize..).unwrap_or_default(), outline.ink);
        first += count;
    }
}

/// What an outline of a pixel covers.
#[inline(always)]
fn thin(around: &[Span], spans: &mut [Span]) {
    let [above, own, rest @ ..] = around else { return };
    let (mut above, mut own) = (wide_of(above), wide_of(own));
    for (below, span) in rest.iter().zip(spans) {
        let below = wide_of(below);
        let (low, high) = ((own[0] - 1).min(above[0]).min(below[0]), (own[1] + 1).max(above[1]).max(below[1]));
        *span = [low as i16, high as i16];
        (above, own) = (own, below);
    }
}

/// What one of more pixels covers.
#[inline(always)]
fn thick<I>(around: &[Span], outline: &Outline<I>, spans: &mut [Span]) {
    let (wide, reaches) = (outline.width.min(WIDEST as i32), outline.reaches());
    for (window, span) in around.windows(2 * wide as usize + 1).zip(spans) {
        let Some((above, [middle, below @ ..])) = window.split_at_checked(wide as usize) else { continue };
        let own = wide_of(middle);
        let (mut low, mut high) = (own[0] - wide, own[1] + wide);
        for ((above, below), reach) in above.iter().rev().zip(below).zip(&reaches) {
            low = low.min(i32::from(above[0].min(below[0])) - reach);
            high = high.max(i32::from(above[1].max(below[1])) + reach);
        }
        *span = [low as i16, high as i16];
    }
}

/// Fills rows that are on the surface.
#[inline(always)]
fn draw_fill<S: Surface>(
    surface: &mut S,
    rows: &Rows,
    [mut first, last]: [i32; 2],
    fill: &Fill<S::Ink>,
    cores: &mut [Span; AT_ONCE],
) {
    while first <= last {
        let count = (last - first + 1).min(AT_ONCE as i32);
        let own = rows.stretch(first, first + count - 1);
        let cores = cores.get_mut(..count as usize).unwrap_or_default();
        match *fill {
            Fill::Plain(ink) => surface.spans(first, own, &[], ink),
            // Where there are none, no code for them.
            Fill::Checkered(..) | Fill::Dotted(..) | Fill::Rimmed(..) if S::Ink::TONES => {}
            Fill::Shaded(..) if !S::Ink::SHADED => {}
            Fill::Checkered(ink, other) | Fill::Dotted(ink, other) => {
                surface.spans(first, own, &[], other);
                let most = surface.size()[0] - 1;
                for (own, row) in own.iter().zip(first..) {
                    let [low, high] = wide_of(own);
                    let low = low.max(0);
                    let (begin, high) = (low + ((low ^ row) & 1), high.min(most));
                    if begin <= high && (row & 1 == 0 || matches!(fill, Fill::Checkered(..))) {
                        surface.alternate(row, [begin, high], ink);
                    }
                }
            }
            Fill::Shaded(lit, shaded, [across, down]) => {
                // There are none below the hull's last row.
                let below = rows.stretch(first + down, (first + count - 1 + down).min(rows.last));
                for ((core, own), below) in cores.iter_mut().zip(own).zip(below) {
                    let ([low, high], own) = (wide_of(below), wide_of(own));
                    // What ends before the surface stays there.
                    *core = [(low - across).max(own[0]) as i16, (high.max(-1) - across).min(own[1]) as i16];
                }
                cores.iter_mut().skip(below.len()).for_each(|core| *core = EMPTY);
                surface.spans(first, own, cores, shaded);
                surface.spans(first, cores, &[], lit);
            }
            Fill::Rimmed(rim, ink) => {
                for (core, row) in cores.iter_mut().zip(first..) {
                    let [[low, high], above, below] = [0, -1, 1].map(|away| rows.span(row + away));
                    // What is empty stays so.
                    let (low, high) = (low.saturating_add(1), high.saturating_sub(1));
                    *core = [low.max(above[0]).max(below[0]), high.min(above[1]).min(below[1])];
                }
                surface.spans(first, own, cores, rim);
                surface.spans(first, cores, &[], ink);
            }
        }
        first += count;
    }
}
