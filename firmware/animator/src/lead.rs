//! The way of a figure that two clips move in step: each of them leads it by its part.

use crate::animator::Animator;
use crate::layer::Weight;
use crate::root::{Root, Seam};
use crate::track::{Track, Traveller};
use pantin::Angle;

/// Where a clip is, and its root.
#[derive(Clone, Copy, Debug)]
struct Instant {
    frame: u32,
    part: u16,
    place: [i32; 2],
}

/// Where two clips were in the update before.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instants([Instant; 2]);

impl Instant {
    fn of(track: &Track<'_, '_>, place: [i32; 2]) -> Instant {
        Instant { frame: track.frame(), part: track.part().to_bits(), place }
    }

    /// The way since another instant of a loop, less than a lap before, in the clip's axes; `None` over a seam that turns the figure.
    fn since(&self, before: &Instant, seam: Option<&Seam>, forward: bool) -> Option<[i32; 2]> {
        let ([a, b], [before_a, before_b]) = (self.place, before.place);
        let way = [a.wrapping_sub(before_a), b.wrapping_sub(before_b)];
        let [now, then] = [(self.frame, self.part), (before.frame, before.part)];
        if if forward { now >= then } else { now <= then } {
            return Some(way);
        }
        let seam = seam.filter(|seam| seam.yaw == Angle::ZERO)?;
        let lap = seam.place.map(|x| if forward { x as i32 } else { (x as i32).wrapping_neg() });
        let ([a, b], [lap_a, lap_b]) = (way, lap);
        Some([a.wrapping_add(lap_a), b.wrapping_add(lap_b)])
    }
}

impl Track<'_, '_> {
    /// Goes to the first frame of a loop, with where a lap of it takes the root.
    pub(crate) fn begin_lap(&mut self, root: &Root<'_>) {
        self.seek(u32::MAX);
        self.step(Some(&mut Traveller { root, spare: None }));
    }

    /// Where the root is in the clip.
    fn root_place(&self, root: &Root<'_>) -> [i32; 2] {
        root.place.map(|channel| channel.map_or(0, |channel| self.value(channel.into())))
    }
}

impl Animator<'_, '_> {
    /// Lets a second loop, in step with the one that plays, lead the figure too: by a weight of its way since the instants that were returned before.
    pub(crate) fn lead(&mut self, second: &Track<'_, '_>, weight: Weight, before: Option<Instants>) -> Instants {
        let now = [Instant::of(&self.track, self.place), Instant::of(second, second.root_place(&self.root))];
        if let Some(Instants([own_before, its_before])) = before {
            let ([own, its], forward) = (&now, self.track.speed() >= 0);
            let ways = (own.since(&own_before, self.track.seam(), forward), its.since(&its_before, second.seam(), forward));
            if let (Some([a, b]), Some([x, y])) = ways {
                self.travel.lead([x.wrapping_sub(a), y.wrapping_sub(b)].map(|x| weight.of(x)));
                self.locate();
            }
        }
        Instants(now)
    }
}
