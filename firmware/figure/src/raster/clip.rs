//! Which steps of a line lie on the surface: exactly the pixels that the whole line would have there.

/// A line as steps along its longer way, from the end where that coordinate is least. Step i lies i pixels along and
/// floor((2 short i + long) / (2 long)) across.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Steps {
    /// Whether the longer way is down the rows.
    pub steep: bool,
    /// Whether the shorter way runs against the coordinate.
    pub back: bool,
    /// Pixels along, at most 2^13, and across.
    pub long: i32,
    pub short: i32,
    /// First and last step on the surface.
    pub first: i32,
    pub last: i32,
    /// Place of the first: along, across.
    pub at: [i32; 2],
    /// What is left of the division at the first step.
    pub rest: i32,
}

/// Farthest coordinate: products of two differences stay below 2^27.
const FARTHEST: i32 = 1 << 12;

impl Steps {
    /// The part on a surface of `size`; `None` where there is none.
    #[inline(always)]
    pub fn new(from: [i32; 2], to: [i32; 2], size: [i32; 2]) -> Option<Self> {
        let inside = |[x, y]: [i32; 2]| (x as u32) < size[0] as u32 && (y as u32) < size[1] as u32;
        if inside(from) && inside(to) { Some(Steps::whole(from, to)) } else { Steps::part(from, to, size) }
    }

    /// All of it.
    #[inline(always)]
    fn whole(from: [i32; 2], to: [i32; 2]) -> Self {
        let steep = (to[1] - from[1]).abs() > (to[0] - from[0]).abs();
        let turned = |[x, y]: [i32; 2]| if steep { [y, x] } else { [x, y] };
        let (from, to) = (turned(from), turned(to));
        let (from, to) = if from[0] <= to[0] { (from, to) } else { (to, from) };
        let (long, across) = (to[0] - from[0], to[1] - from[1]);
        Steps { steep, back: across < 0, long, short: across.abs(), first: 0, last: long, at: from, rest: long }
    }

    #[inline(never)]
    fn part(from: [i32; 2], to: [i32; 2], size: [i32; 2]) -> Option<Self> {
        let [from, to] = [from, to].map(|end| end.map(|x| x.clamp(-FARTHEST, FARTHEST)));
        let mut steps = Steps::whole(from, to);
        steps.clip(if steps.steep { [size[1], size[0]] } else { size })?;
        Some(steps)
    }

    fn clip(&mut self, size: [i32; 2]) -> Option<()> {
        let (first, last) = (0.max(-self.at[0]), self.long.min(size[0] - 1 - self.at[0]));
        // Steps across that are inside.
        let (low, high) =
            if self.back { (self.at[1] - size[1] + 1, self.at[1]) } else { (-self.at[1], size[1] - 1 - self.at[1]) };
        if high < 0 || low > self.short {
            return None;
        }
        let (twice, rise) = (2 * self.long, 2 * self.short);
        // The least i with floor((rise i + long) / twice) >= j.
        let reach = |j: i32| (j * twice - self.long + rise - 1).checked_div(rise).unwrap_or(0);
        self.first = if low > 0 { first.max(reach(low)) } else { first };
        self.last = if high < self.short { last.min(reach(high + 1) - 1) } else { last };
        if self.first > self.last {
            return None;
        }
        let passed = rise * self.first + self.long;
        let across = passed.checked_div(twice).unwrap_or(0);
        self.rest = passed - across * twice;
        self.at = [self.at[0] + self.first, if self.back { self.at[1] - across } else { self.at[1] + across }];
        Some(())
    }

    /// The corners of the rectangle that the steps lie in: columns and rows.
    pub fn bounds(&self) -> [[i32; 2]; 2] {
        let [along, across] = self.at;
        let count = self.last - self.first;
        // Not beyond the line's end, and a pixel wide of the exact place at most.
        let far = if self.first == 0 && self.last == self.long {
            self.short
        } else {
            (2 * self.short * count + self.rest).checked_div(2 * self.long).unwrap_or(0)
        };
        let (least, most) = if self.back { (across - far, across) } else { (across, across + far) };
        match self.steep {
            true => [[least, along], [most, along + count]],
            false => [[along, least], [along + count, most]],
        }
    }
}
