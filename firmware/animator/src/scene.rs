//! Several figures with places.

use crate::root::Placement;
use heapless::Vec;

/// The places of up to `N` figures in one world, nearest last: the order in which they are drawn over each other.
#[derive(Clone, Debug, Default)]
pub struct Scene<const N: usize> {
    figures: Vec<(usize, Placement), N>,
}

impl<const N: usize> Scene<N> {
    /// No figures.
    pub const fn new() -> Scene<N> {
        Scene { figures: Vec::new() }
    }

    /// Puts a figure (an index of the program's) to a place, where [`crate::Animator::placement`] says or anywhere else. False if there is no room for
    /// another one.
    pub fn set(&mut self, figure: usize, placement: Placement) -> bool {
        match self.figures.iter_mut().find(|(own, _)| *own == figure) {
            Some((_, own)) => *own = placement,
            None => return self.figures.push((figure, placement)).is_ok(),
        }
        true
    }

    /// Takes a figure out.
    pub fn remove(&mut self, figure: usize) {
        self.figures.retain(|(own, _)| *own != figure);
    }

    /// Where a figure is, seen from a viewer: the viewer's own place is the origin, and its heading is 0. Places farther than 2^31 raw units are
    /// cut off.
    pub fn seen_from(&self, viewer: Placement, figure: usize) -> Option<Placement> {
        let (_, placement) = self.figures.iter().find(|(own, _)| *own == figure)?;
        let place = viewer.to_pose(placement.place).map(i64::from);
        Some(Placement { place, heading: placement.heading - viewer.heading })
    }

    /// The figures in the order in which a viewer draws them: the one that is farthest along the first of the horizontal axes, seen from it, first.
    pub fn order(&mut self, viewer: Placement) -> impl Iterator<Item = usize> + '_ {
        let depth = |placement: &Placement| {
            let [along, _] = viewer.to_pose(placement.place);
            along
        };
        self.figures.sort_unstable_by_key(|(figure, placement)| (core::cmp::Reverse(depth(placement)), *figure));
        self.figures.iter().map(|(figure, _)| *figure)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pantin::Angle;

    #[test]
    fn figures_are_seen_from_a_viewer_and_drawn_far_to_near() {
        let at = |a, b| Placement { place: [a, b], heading: Angle::ZERO };
        let mut scene = Scene::<3>::new();
        assert!(scene.set(7, at(100, 0)) && scene.set(8, at(300, 10)) && scene.set(9, at(200, 0)) && !scene.set(10, at(0, 0)));
        assert!(scene.set(7, at(150, 0)));
        assert!(scene.order(Placement::default()).eq([8, 9, 7]));
        // From behind, half a turn round.
        let viewer = Placement { place: [1000, 0], heading: Angle::from_bits(i32::MIN) };
        assert!(scene.order(viewer).eq([7, 9, 8]));
        let seen = scene.seen_from(viewer, 7).unwrap();
        assert_eq!((seen.place, seen.heading), ([850, 0], Angle::from_bits(i32::MIN)));
        scene.remove(7);
        assert_eq!(scene.seen_from(viewer, 7), None);
        assert!(scene.order(viewer).eq([9, 8]));
    }
}
