//! Lines a pixel wide: Bresenham's, with the end points in whole pixels.

use super::clip::Steps;
use crate::surface::{Cursor, Surface};

/// Draws a line; ends belong to it.
#[inline(never)]
pub fn line<S: Surface>(surface: &mut S, from: [i32; 2], to: [i32; 2], ink: S::Ink) {
    let Some(steps) = Steps::new(from, to, surface.size()) else { return };
    let [from, to] = steps.bounds();
    surface.mark(from, to);
    walk(surface, start(surface, &steps), steps.pace(), steps.last - steps.first, ink);
}

/// Draws every `gap`-th pixel of a line, counted from the end at the left, or at the top of a steep one.
#[inline(never)]
pub fn dotted<S: Surface>(surface: &mut S, from: [i32; 2], to: [i32; 2], ink: S::Ink, gap: u32) {
    let Some(steps) = Steps::new(from, to, surface.size()) else { return };
    let [from, to] = steps.bounds();
    surface.mark(from, to);
    let (mut cursor, mut pace) = (start(surface, &steps), steps.pace());
    let mut wait = (gap - steps.first as u32 % gap) % gap;
    for _ in steps.first..=steps.last {
        if wait == 0 {
            surface.put(cursor, ink);
            wait = gap;
        }
        wait -= 1;
        let Pace { steep, back, .. } = pace;
        pace.step(&mut cursor, steep, back);
    }
}

/// Draws a line several pixels wide, across its longer way; what would lie outside is left out.
#[inline(never)]
pub fn thick<S: Surface>(surface: &mut S, from: [i32; 2], to: [i32; 2], ink: S::Ink, width: i32) {
    let [columns, rows] = surface.size();
    let steep = (to[1] - from[1]).abs() > (to[0] - from[0]).abs();
    let moved = |[x, y]: [i32; 2], aside: i32| if steep { [x + aside, y] } else { [x, y + aside] };
    let (first, last) = (-(width / 2), width - width / 2 - 1);
    let within = |[x, y]: [i32; 2]| (0..columns).contains(&x) && (0..rows).contains(&y);
    if ![from, to].iter().all(|&end| within(moved(end, first)) && within(moved(end, last))) {
        return (first..=last).for_each(|aside| line(surface, moved(from, aside), moved(to, aside), ink));
    }
    let Some(steps) = Steps::new(moved(from, first), moved(to, first), [columns, rows]) else { return };
    let [least, most] = steps.bounds();
    surface.mark(least, moved(most, last - first));
    let (mut cursor, mut pace, mut left) = (start(surface, &steps), steps.pace(), steps.last - steps.first);
    loop {
        let mut beside = cursor;
        surface.put(beside, ink);
        for _ in 1..width {
            if steep {
                beside.across(true)
            } else {
                beside.along(true)
            }
            surface.put(beside, ink);
        }
        if left == 0 {
            break;
        }
        left -= 1;
        pace.step(&mut cursor, steep, steps.back);
    }
}

/// The cursor of the first step.
#[inline(always)]
fn start<S: Surface>(surface: &S, steps: &Steps) -> S::Cursor {
    let [along, across] = steps.at;
    if steps.steep { surface.cursor(across, along) } else { surface.cursor(along, across) }
}

/// How a line goes on: a pixel along its longer way each step, and one aside where `rest` comes to 0.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    /// Whether the longer way is down the rows.
    pub steep: bool,
    /// Whether the shorter way runs against the coordinate.
    pub back: bool,
    /// Added to `rest` a step: twice the pixels across.
    pub rise: i32,
    /// Taken from it with a step aside: twice the pixels along.
    pub fall: i32,
    /// Negative.
    pub rest: i32,
}

impl Pace {
    /// Makes the pace of a whole line that covers `along` pixels in its longer direction and `aside` pixels, at most as many, in the other.
    #[inline(always)]
    pub fn new(steep: bool, back: bool, along: i32, aside: i32) -> Pace {
        Pace { steep, back, rise: 2 * aside, fall: 2 * along, rest: -along }
    }

    #[inline(always)]
    fn step<C: Cursor>(&mut self, cursor: &mut C, steep: bool, back: bool) {
        self.rest += self.rise;
        let aside = self.rest >= 0;
        if aside {
            self.rest -= self.fall;
        }
        if steep {
            cursor.along(true);
            if aside {
                cursor.across(!back);
            }
        } else {
            cursor.across(true);
            if aside {
                cursor.along(!back);
            }
        }
    }
}

impl Steps {
    /// From its first step on.
    #[inline(always)]
    fn pace(&self) -> Pace {
        Pace { rest: self.rest - 2 * self.long, ..Pace::new(self.steep, self.back, self.long, self.short) }
    }
}

/// Sets a pixel and `left` further ones of a line that stays on the surface.
#[inline(always)]
pub fn walk<S: Surface>(surface: &mut S, cursor: S::Cursor, pace: Pace, left: i32, ink: S::Ink) {
    // Four loops without a choice inside.
    match (pace.steep, pace.back) {
        (false, false) => walk_so::<S, false, false>(surface, cursor, pace, left, ink),
        (false, true) => walk_so::<S, false, true>(surface, cursor, pace, left, ink),
        (true, false) => walk_so::<S, true, false>(surface, cursor, pace, left, ink),
        (true, true) => walk_so::<S, true, true>(surface, cursor, pace, left, ink),
    }
}

#[inline(always)]
fn walk_so<S: Surface, const STEEP: bool, const BACK: bool>(
    surface: &mut S,
    mut cursor: S::Cursor,
    mut pace: Pace,
    left: i32,
    ink: S::Ink,
) {
    surface.put(cursor, ink);
    for _ in 0..left {
        pace.step(&mut cursor, STEEP, BACK);
        surface.put(cursor, ink);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{Framebuffer, MonoPages};
    use embedded_graphics::pixelcolor::BinaryColor;

    type Small = Framebuffer<MonoPages<32, 16, 64>>;
    type Large = Framebuffer<MonoPages<160, 144, 2880>>;

    fn picture(frame: &Small) -> String {
        let row = |y: usize| (0..32).map(|x| if frame.pixel(x, y).is_on() { '#' } else { '.' }).collect::<String>();
        (0..16).map(row).map(|row| row + "\n").collect()
    }

    #[test]
    fn a_line_is_what_it_should_be() {
        let mut frame = Small::new();
        line(&mut frame, [1, 1], [12, 4], BinaryColor::On);
        line(&mut frame, [31, 2], [28, 15], BinaryColor::On);
        dotted(&mut frame, [0, 12], [20, 12], BinaryColor::On, 5);
        line(&mut frame, [5, 8], [5, 8], BinaryColor::On);
        let expected = "\
................................
.##.............................
...####........................#
.......####....................#
...........##..................#
..............................#.
..............................#.
..............................#.
.....#........................#.
.............................#..
.............................#..
.............................#..
#....#....#....#....#........#..
............................#...
............................#...
............................#...
";
        assert_eq!(picture(&frame), expected, "{}", picture(&frame));
    }

    #[test]
    fn a_thick_line_is_thin_ones_beside_each_other() {
        let mut next = sequence();
        for _ in 0..5_000 {
            let ends = [[next(-9, 40), next(-9, 24)], [next(-9, 40), next(-9, 24)]];
            let width = next(2, 4);
            let (mut whole, mut parts) = (Small::new(), Small::new());
            thick(&mut whole, ends[0], ends[1], BinaryColor::On, width);
            let steep = (ends[1][1] - ends[0][1]).abs() > (ends[1][0] - ends[0][0]).abs();
            for aside in -(width / 2)..width - width / 2 {
                let [from, to] = ends.map(|[x, y]| if steep { [x + aside, y] } else { [x, y + aside] });
                line(&mut parts, from, to, BinaryColor::On);
            }
            assert_eq!(picture(&whole), picture(&parts), "{ends:?} {width}");
        }
    }

    /// Numbers from a fixed sequence.
    fn sequence() -> impl FnMut(i32, i32) -> i32 {
        let mut random = fastrand::Rng::with_seed(5);
        move |least, most| random.i32(least..=most)
    }

    #[test]
    fn a_clipped_line_is_the_whole_one_where_it_is_inside_and_marks_what_it_changes() {
        let mut next = sequence();
        for _ in 0..20_000 {
            let ends = [[next(-60, 90), next(-60, 75)], [next(-60, 90), next(-60, 75)]];
            let gap = next(1, 4) as u32;
            let (mut small, mut large) = (Small::new(), Large::new());
            small.send().count();
            dotted(&mut small, ends[0], ends[1], BinaryColor::On, gap);
            // The same on a surface that holds all of it.
            let [from, to] = ends.map(|[x, y]| [x + 64, y + 64]);
            dotted(&mut large, from, to, BinaryColor::On, gap);
            if gap == 1 {
                let mut other = Small::new();
                line(&mut other, ends[1], ends[0], BinaryColor::On);
                assert_eq!(picture(&small), picture(&other), "{ends:?}");
            }
            let windows: Vec<_> = small.send().collect();
            for (x, y) in (0..16).flat_map(|y| (0..32).map(move |x| (x, y))) {
                assert_eq!(small.pixel(x, y), large.pixel(x + 64, y + 64), "{ends:?} at {x} {y}\n{}", picture(&small));
                let sent = windows.iter().any(|window| {
                    (window.columns[0]..=window.columns[1]).contains(&x) && (window.rows[0]..=window.rows[1]).contains(&y)
                });
                assert!(sent || !small.pixel(x, y).is_on(), "{ends:?} at {x} {y}, {windows:?}");
            }
        }
    }
}
