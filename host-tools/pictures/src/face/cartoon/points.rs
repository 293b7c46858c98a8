//! The points of a cartoon face: those of the head that it uses, with new numbers, those that set the camera, and corners of blocks and hidden shapes.

use super::table::Table;
use super::zoom::Enlarged;
use super::{FRONT, blocks};
use crate::face::blueprint::Blueprint;
use crate::face::head::{Head, Vector};

/// Points in the middle that set the top and the bottom of the picture; one on the left sets its width.
const CAMERA_MIDDLES: usize = 2;
const CAMERA_PAIRS: usize = 1;

/// The points of the head that stay.
pub(super) struct Kept<'h> {
    head: &'h Head,
    /// Their indices in the head: first those in the middle, then those on the left.
    indices: Vec<usize>,
    /// Points in the middle that are not the head's: the camera's, and those of blocks.
    own_middles: usize,
    /// Points of the new face in the middle.
    pub middles: usize,
    /// Points of the new face on the left.
    pub pairs: usize,
}

/// The points of a cartoon face.
pub(super) struct Places {
    /// Where they are, in mm.
    pub points: Vec<Vector>,
    /// The corners of each block on the left and in the middle.
    pub blocks: Vec<Vec<usize>>,
    /// The first corner of each hidden shape.
    pub hidden: Vec<usize>,
}

impl<'h> Kept<'h> {
    /// Keeps the points of the table's curves and of the face's openings.
    pub fn of(head: &'h Head, face: &Blueprint, table: &Table) -> Kept<'h> {
        let drawn = table.curves.iter().flat_map(|curve| &curve.points);
        let openings = face.openings.iter().map(|entry| &entry.opening);
        let behind = openings.flat_map(|opening| [&opening.upper, &opening.lower, &opening.members]).flatten();
        let mut indices: Vec<usize> = drawn.chain(behind).map(|&point| head.stored(point)).collect();
        indices.sort_unstable();
        indices.dedup();
        let head_middles = indices.partition_point(|&index| index < head.middles);
        let head_pairs = indices.len() - head_middles;
        let hidden: usize = table.hidden.iter().map(|shape| shape.corners).sum();
        let corners = table.blocks.iter().flat_map(|block| block.places.iter().map(|&place| blocks::is_middle(block, place)));
        let (block_middles, block_pairs): (Vec<bool>, Vec<bool>) = corners.partition(|&middle| middle);
        let own_middles = CAMERA_MIDDLES + block_middles.len();
        let (middles, pairs) = (head_middles + own_middles, head_pairs + CAMERA_PAIRS + hidden + block_pairs.len());
        Kept { head, indices, own_middles, middles, pairs }
    }

    /// Whether a point or its mirror image stays.
    pub fn has(&self, index: usize) -> bool {
        self.indices.contains(&self.head.stored(index))
    }

    /// The new index of a point of the head.
    pub fn renumbered(&self, index: usize) -> usize {
        let stored = self.head.stored(index);
        let own = self.indices.iter().position(|&kept| kept == stored).unwrap_or(0);
        let own = if stored < self.head.middles { own } else { own + self.own_middles };
        if index == stored { own } else { own + self.pairs }
    }

    /// The new indices of points of the head.
    pub fn all_renumbered(&self, points: &[usize]) -> Vec<usize> {
        points.iter().map(|&index| self.renumbered(index)).collect()
    }

    /// The places of all points in mm, and which of them are the corners of blocks and hidden shapes.
    pub fn places(&self, enlarged: &Enlarged, table: &Table) -> Places {
        let [width, top, bottom] = table.view;
        let (middle, left) = self.indices.split_at(self.middles - self.own_middles);
        let mut points: Vec<Vector> = middle.iter().map(|&index| enlarged.place(index)).collect();
        points.extend([[0.0, top, FRONT], [0.0, bottom, FRONT]]);
        let mut blocks: Vec<Vec<usize>> = table.blocks.iter().map(|block| vec![0; block.places.len()]).collect();
        let mut place_corners = |middle: bool, points: &mut Vec<Vector>| {
            for (block, corners) in table.blocks.iter().zip(&mut blocks) {
                for (&[aside, up], corner) in block.places.iter().zip(corners) {
                    if blocks::is_middle(block, [aside, up]) == middle {
                        *corner = points.len();
                        points.push([aside, up, FRONT]);
                    }
                }
            }
        };
        place_corners(true, &mut points);
        points.extend(left.iter().map(|&index| enlarged.place(index)));
        points.push([width, 0.0, FRONT]);
        place_corners(false, &mut points);
        let mut hidden = Vec::new();
        for shape in &table.hidden {
            hidden.push(points.len());
            points.extend(std::iter::repeat_n([shape.place[0], shape.place[1], FRONT], shape.corners));
        }
        Places { points, blocks, hidden }
    }
}
