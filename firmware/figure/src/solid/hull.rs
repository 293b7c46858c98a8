//! The convex hull of up to four circles as a span in each row of pixels, by integers: a table of a circle's half widths, and the outer
//! tangents of every two circles.

use super::MARGIN;
use pantin_math::rotation::inverse_length;

/// A circle in sixteenths of a pixel: centre and radius.
pub(super) type Circle = [i32; 3];

/// What circles cover, in sixteenths of a pixel: least and greatest column and row. The least ones are greater where there is none.
pub(super) struct Bounds {
    least: [i32; 2],
    most: [i32; 2],
}

impl Bounds {
    /// Of circles.
    #[inline(always)]
    pub(super) fn of(circles: &[Circle]) -> Self {
        let mut bounds = Bounds { least: [FAR; 2], most: [-FAR; 2] };
        for &[x, y, r] in circles.iter().filter(|circle| circle[2] > 0) {
            bounds.least = [bounds.least[0].min(x - r), bounds.least[1].min(y - r)];
            bounds.most = [bounds.most[0].max(x + r), bounds.most[1].max(y + r)];
        }
        bounds
    }

    /// The first and the last row of a hull with an outline, as far as they are on a surface of `height` rows; the first is greater if none is.
    #[inline(always)]
    pub(super) fn rows(&self, flat: bool, outline: i32, height: i32) -> [i32; 2] {
        let shift = if flat { 6 } else { 4 };
        [((self.least[1] >> shift) - outline).max(0), ((self.most[1] >> shift) + outline).min(height - 1)]
    }

    /// The first and the last column of a hull with an outline, as far as they are on a surface of `width` columns.
    #[inline(always)]
    pub(super) fn columns(&self, outline: i32, width: i32) -> [i32; 2] {
        [((self.least[0] >> 4) - outline).max(0), ((self.most[0] >> 4) + outline).min(width - 1)]
    }
}

/// Farther than any circle reaches.
const FAR: i32 = 1 << 28;

/// Rows that are drawn at a time, and those above and below them that are known too.
pub(super) const WINDOW: usize = 64;
const ROWS: usize = WINDOW + 2 * MARGIN as usize;

/// First and last pixel of a row; the first is greater where there is none.
pub(super) type Span = [i16; 2];
pub(super) const EMPTY: Span = [i16::MAX, i16::MIN];

/// Half the width of a circle of radius 255 at 64 heights: the middle of each.
static HALF_WIDTHS: [u8; 64] = {
    let mut table = [0; 64];
    let mut index = 0;
    while index < 64 {
        // sqrt(1 - ((index + 0.5) / 64)^2) * 255, rounded: the greatest integer whose square is not greater.
        let square = (128 * 128 - (2 * index + 1) * (2 * index + 1)) as u32 * 255 * 255;
        let mut width = 0u32;
        while (2 * width + 1) * (2 * width + 1) * 128 * 128 / 4 <= square {
            width += 1;
        }
        table[index] = width as u8;
        index += 1;
    }
    table
};

/// The rows of a hull from `first` on, of a window of a picture.
pub(super) struct Rows {
    spans: [Span; ROWS],
    /// The row of the picture that the first span is of.
    base: i32,
    /// The hull's first and last row in the window with its margins; the first is greater where there is none.
    pub first: i32,
    pub last: i32,
}

impl Rows {
    /// No hull.
    pub(super) const fn new() -> Rows {
        Rows { spans: [EMPTY; ROWS], base: 0, first: 0, last: -1 }
    }

    /// The span of a row of the picture.
    #[inline(always)]
    pub(super) fn span(&self, row: i32) -> Span {
        if row < self.first || row > self.last {
            return EMPTY;
        }
        self.spans.get((row - self.base) as usize).copied().unwrap_or(EMPTY)
    }

    /// Computes the rows of the hull of `circles`, which are in `bounds`, in the window from row `top` on; `around` rows above and below it are empty. With `flat`, heights
    /// are multiplied by 4: circles become ellipses, as discs on the floor are seen.
    #[inline(never)]
    pub(super) fn compute(&mut self, circles: &[Circle], bounds: &Bounds, top: i32, flat: bool, around: i32) {
        let (pitch, shift) = if flat { (64, 6) } else { (16, 4) };
        self.base = top - MARGIN;
        self.first = ((bounds.least[1] + pitch / 2 - 1) >> shift).max(self.base);
        self.last = ((bounds.most[1] - pitch / 2) >> shift).min(self.base + ROWS as i32 - 1);
        if self.first > self.last {
            (self.first, self.last) = (0, -1);
            return;
        }
        let (from, to) = ((self.first - self.base) as usize, (self.last - self.base) as usize);
        let around = around as usize;
        let cleared = from.saturating_sub(around)..(to + 1 + around).min(ROWS);
        self.spans.get_mut(cleared).unwrap_or_default().iter_mut().for_each(|span| *span = EMPTY);
        for (index, circle) in circles.iter().enumerate() {
            self.circle(circle, pitch, shift);
            for other in circles.get(index + 1..).unwrap_or(&[]) {
                self.tangents(circle, other, pitch, shift);
            }
        }
        for span in self.stretch_mut(self.first, self.last) {
            *span = pixels(*span);
        }
    }

    /// The spans from a row to another one; both are in the window with its margins, and within [`MARGIN`] of the hull.
    #[inline(always)]
    pub(super) fn stretch(&self, first: i32, last: i32) -> &[Span] {
        let from = self.spans.get((first - self.base) as usize..).unwrap_or_default();
        from.get(..(last - first + 1) as usize).unwrap_or_default()
    }

    /// Those spans to be changed.
    #[inline(always)]
    fn stretch_mut(&mut self, first: i32, last: i32) -> &mut [Span] {
        let from = self.spans.get_mut((first - self.base) as usize..).unwrap_or_default();
        from.get_mut(..(last - first + 1) as usize).unwrap_or_default()
    }

    /// Cuts off what lies outside a circle.
    #[inline(never)]
    pub(super) fn clip(&mut self, circle: &Circle) {
        let (pitch, shift) = (16, 4);
        let &[x, y, r] = circle;
        let first = ((y - r + pitch / 2 - 1) >> shift).max(self.first);
        let last = ((y + r - pitch / 2) >> shift).min(self.last);
        if first > last || r <= 0 {
            (self.first, self.last) = (0, -1);
            return;
        }
        (self.first, self.last) = (first, last);
        let reciprocal = (64 << 16) / r;
        let mut height = first * pitch + pitch / 2 - y;
        for span in self.stretch_mut(first, last) {
            let half = half_width(r, reciprocal, height);
            let own = pixels([(x - half) as i16, (x + half) as i16]);
            let [low, high] = *span;
            *span = if low > high { EMPTY } else { [own[0].max(low), own[1].min(high)] };
            height += pitch;
        }
    }

    /// Widens the spans, in sixteenths, to the left or to the right, from row `from` to row `to`, by places that begin at `x` and move by `slope`,
    /// both with 12 more bits.
    #[inline(always)]
    fn edge(&mut self, from: i32, to: i32, left: bool, mut x: i32, slope: i32) {
        let spans = self.stretch_mut(from, to);
        if left {
            for [low, _] in spans {
                *low = (*low).min((x >> 12) as i16);
                x = x.wrapping_add(slope);
            }
        } else {
            for [_, high] in spans {
                *high = (*high).max((x >> 12) as i16);
                x = x.wrapping_add(slope);
            }
        }
    }

    /// Widens the spans by a circle.
    #[inline(never)]
    fn circle(&mut self, &[x, y, r]: &Circle, pitch: i32, shift: u32) {
        if r <= 0 {
            return;
        }
        let reciprocal = (64 << 16) / r;
        let first = ((y - r + pitch / 2 - 1) >> shift).max(self.first);
        let last = ((y + r - pitch / 2) >> shift).min(self.last);
        if first > last {
            return;
        }
        let mut height = first * pitch + pitch / 2 - y;
        for [low, high] in self.stretch_mut(first, last) {
            let half = half_width(r, reciprocal, height);
            *low = (*low).min((x - half) as i16);
            *high = (*high).max((x + half) as i16);
            height += pitch;
        }
    }

    /// The two outer tangents of two circles; none if one lies within the other.
    #[inline(never)]
    fn tangents(&mut self, one: &Circle, other: &Circle, pitch: i32, shift: u32) {
        let (&[x0, y0, r0], &[x1, y1, r1]) = (one, other);
        let (dx, dy, k) = (x1 - x0, y1 - y0, r0 - r1);
        if r0 <= 0 || r1 <= 0 || dx.abs() >= FARTHEST || dy.abs() >= FARTHEST {
            return;
        }
        let square = (dx * dx + dy * dy) as u32;
        if square <= (k * k) as u32 {
            return;
        }
        // Along the line through both middles: a vector 2^15 long, and what the tangents lean towards it, as a sine and a cosine.
        let (inverse, up) = inverse_root(square);
        let [ux, uy, sine] = [(dx * inverse) >> (15 - up), (dy * inverse) >> (15 - up), (k * inverse) >> (15 - up)];
        let cosine = root_of_fraction(((1 << 30) - sine * sine) as u32);
        let (along, across) = ([sine * ux, sine * uy], [cosine * uy, cosine * ux]);
        self.tangent([one, other], [(along[0] - across[0]) >> 15, (along[1] + across[1]) >> 15], pitch, shift);
        self.tangent([one, other], [(along[0] + across[0]) >> 15, (along[1] - across[1]) >> 15], pitch, shift);
    }

    /// The tangent of two circles whose normal is given, 2^15 long.
    #[inline(never)]
    fn tangent(&mut self, circles: [&Circle; 2], normal: [i32; 2], pitch: i32, shift: u32) {
        let touch = |&[x, y, r]: &Circle| [x + ((r * normal[0]) >> 15), y + ((r * normal[1]) >> 15)];
        let (mut from, mut to) = (touch(circles[0]), touch(circles[1]));
        if from[1] > to[1] {
            (from, to) = (to, from);
        }
        let first = ((from[1] + pitch / 2 - 1) >> shift).max(self.first);
        let last = ((to[1] - pitch / 2) >> shift).min(self.last);
        if first > last || to[1] <= from[1] {
            return;
        }
        let slope = ((to[0] - from[0]) << 12) / (to[1] - from[1]).max(1);
        let start = (from[0] << 12).wrapping_add(slope.wrapping_mul(first * pitch + pitch / 2 - from[1]));
        self.edge(first, last, normal[0] < 0, start, slope.wrapping_mul(pitch));
    }
}

/// Half the width of a circle at a height above or below its middle; `reciprocal` is 2^22 by its radius.
#[inline(always)]
fn half_width(r: i32, reciprocal: i32, height: i32) -> i32 {
    let index = (height.abs() * reciprocal) >> 16;
    let half = i32::from(HALF_WIDTHS.get(index as usize).copied().unwrap_or(0));
    (r * half + 128) >> 8
}

/// 2^15 over the root of a square from 1 on, without a division: a number of 15 bits, and by how many bits more it is to be shifted up.
#[inline(always)]
fn inverse_root(square: u32) -> (i32, u32) {
    let up = square.leading_zeros() & !1;
    (inverse_length(square << up).unwrap_or(0) >> 7, up / 2)
}

/// The root of a number of at most 2^30, within 6: of its 15 bits, products have 14.
#[inline(always)]
fn root_of_fraction(square: u32) -> i32 {
    if square == 0 {
        return 0;
    }
    let (inverse, up) = inverse_root(square);
    (((square << (2 * up)) >> 17) as i32 * inverse) >> (13 + up)
}

/// Circles farther apart, in sixteenths of a pixel, have no tangents: squares stay below 2^31.
const FARTHEST: i32 = 1 << 15;

/// The pixels whose middles are between two places in sixteenths; a narrow span has the pixel in its middle.
#[inline(always)]
fn pixels([low, high]: Span) -> Span {
    let (low, high) = (i32::from(low), i32::from(high));
    let (first, last) = ((low + 7) >> 4, (high - 8) >> 4);
    if first <= last {
        return [first as i16, last as i16];
    }
    if high - low < NARROW {
        return EMPTY;
    }
    let middle = ((low + high) >> 5) as i16;
    [middle, middle]
}

/// Least length of a span that lights a pixel although it covers no pixel's middle, in sixteenths of a pixel.
const NARROW: i32 = 10;

/// The root of a square below 2^31, rounded down: Newton's, from a first value that is not smaller.
pub(super) fn root(square: u32) -> u32 {
    if square < 2 {
        return square;
    }
    let mut root = 1 << (33 - square.leading_zeros()).div_ceil(2);
    loop {
        let next = (root + square / root.max(1)) >> 1;
        if next >= root {
            return root;
        }
        root = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_rounded_down() {
        for square in (0..70_000).chain([(1 << 31) - 1, 1 << 30, (1 << 30) - 1, 46_340 * 46_340]) {
            let found = u64::from(root(square));
            assert!(found * found <= u64::from(square) && (found + 1) * (found + 1) > u64::from(square), "{square}: {found}");
        }
    }

    #[test]
    fn roots_by_table_are_within_six() {
        for square in (1..70_000).chain((0..1 << 20).map(|index| (1 << 30) - index * 1009)) {
            let exact = f64::from(square).sqrt();
            assert!((f64::from(root_of_fraction(square)) - exact).abs() <= 6.0, "{square}");
        }
        assert_eq!(root_of_fraction(0), 0);
    }

    #[test]
    fn half_widths_are_those_of_a_circle() {
        for (index, &width) in HALF_WIDTHS.iter().enumerate() {
            let height = (index as f64 + 0.5) / 64.0;
            assert_eq!(f64::from(width), ((1.0 - height * height).sqrt() * 255.0).round(), "{index}");
        }
    }

    /// Distance of a point to the hull of circles, less than 0 inside: the least over tapered segments between every two circles.
    fn distance(circles: &[Circle], x: f64, y: f64) -> f64 {
        let at = |a: &Circle, b: &Circle, u: f64| {
            let mix = |i: usize| f64::from(a[i]) * (1.0 - u) + f64::from(b[i]) * u;
            (x - mix(0)).hypot(y - mix(1)) - mix(2)
        };
        let steps = (0..=200).map(|step| f64::from(step) / 200.0);
        let pairs = circles.iter().flat_map(|a| circles.iter().map(move |b| (a, b)));
        pairs.flat_map(|(a, b)| steps.clone().map(move |u| at(a, b, u))).fold(f64::MAX, f64::min)
    }

    #[test]
    fn the_pixels_of_a_capsule_are_those_inside_it_within_a_sixth_of_a_pixel() {
        let mut random = fastrand::Rng::with_seed(7);
        for _ in 0..30 {
            let mut circle = || [random.i32(0..2000), random.i32(0..900), random.i32(9..150)];
            let circles = [circle(), circle()];
            let mut rows = Rows::new();
            rows.compute(&circles, &Bounds::of(&circles), 0, false, 0);
            for row in 0..56 {
                let [first, last] = rows.span(row);
                for column in 0..125i16 {
                    let apart = distance(&circles, f64::from(column) * 16.0 + 8.0, f64::from(row) * 16.0 + 8.0);
                    let drawn = (first..=last).contains(&column);
                    // A thin part shows a pixel where none has its middle inside.
                    let thin = drawn && first == last;
                    assert!(thin || drawn == (apart < 0.0) || apart.abs() < 3.0, "{circles:?} {column} {row}: {apart}");
                }
            }
        }
    }

    #[test]
    fn windows_of_a_picture_continue_each_other() {
        let circles = [[300, 100, 90], [900, 3000, 200], [200, 2500, 60]];
        let (mut one, mut other) = (Rows::new(), Rows::new());
        one.compute(&circles, &Bounds::of(&circles), 0, false, 0);
        other.compute(&circles, &Bounds::of(&circles), WINDOW as i32, false, 0);
        for row in WINDOW as i32 - MARGIN..WINDOW as i32 + MARGIN {
            assert_eq!(one.span(row), other.span(row), "{row}");
            assert_ne!(one.span(row), EMPTY, "{row}");
        }
        assert_eq!((one.span(-1), other.span(300)), (EMPTY, EMPTY));
    }
}
