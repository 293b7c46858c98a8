//! Parts of the face, enlarged about their middles and moved.

use crate::face::head::{Head, Vector, minus, plus};
use crate::face::subject::distance;

/// A part of the face, enlarged about its middle, which moves.
pub(super) struct Zoom {
    /// The part.
    pub part: Part,
    /// The factor, 0.1 to 10.
    pub factor: f64,
    /// Where the middle goes, in mm: aside, up.
    pub to: [f64; 2],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    Eye,
    Brow,
    Mouth,
}

/// The middle of each part of the head, on the left: of the eyeball, of the brow, of the lips.
const MIDDLES: [(Part, Vector); 3] =
    [(Part::Eye, [32.0, 0.0, 62.0]), (Part::Brow, [34.0, 25.0, 82.0]), (Part::Mouth, [0.0, -67.0, 88.0])];

/// The depth on the head, in mm, at which its lips meet in the middle.
const LIPS: f64 = 94.0;

/// How far a tongue rises on the head, in mm, so that it shows behind the lower lip of an open mouth.
const TONGUE_UP: f64 = 4.0;

/// Whether a rotation about this centre is one of the eyeball.
pub(super) fn is_eyeball(centre: Vector) -> bool {
    distance(centre, MIDDLES[0].1) < 1e-6
}

/// The part to which a point with this label belongs.
fn part(label: &str) -> Option<Part> {
    let label = label.trim_start_matches('-');
    let begins = |starts: &[&str]| starts.iter().any(|start| label.starts_with(start));
    if begins(&["eye-", "lid-", "iris", "pupil", "crease"]) {
        Some(Part::Eye)
    } else if begins(&["brow"]) {
        Some(Part::Brow)
    } else if begins(&["lip-", "inner-", "teeth", "tongue"]) {
        Some(Part::Mouth)
    } else {
        None
    }
}

impl Zoom {
    /// What is added to a place after it is multiplied by the factor.
    fn offset(&self) -> Vector {
        let middle = MIDDLES.iter().find(|entry| entry.0 == self.part).map_or([0.0; 3], |entry| entry.1);
        minus([self.to[0], self.to[1], middle[2]], middle.map(|x| x * self.factor))
    }
}

/// The head with its enlarged parts.
pub(super) struct Enlarged<'h> {
    /// The head.
    pub head: &'h Head,
    /// The enlarged parts, each once.
    pub zooms: &'h [Zoom],
}

impl Enlarged<'_> {
    fn find(&self, part: Part) -> Option<&Zoom> {
        self.zooms.iter().find(|zoom| zoom.part == part)
    }

    /// The factor and the offset for a point: place * factor + offset.
    pub fn factor_and_offset(&self, index: usize) -> (f64, Vector) {
        let zoom = part(self.head.label(index)).and_then(|part| self.find(part));
        zoom.map_or((1.0, [0.0; 3]), |zoom| (zoom.factor, zoom.offset()))
    }

    /// The new place of a point. A tongue lies in the plane of the lips, which clip it: deeper, it would show above them when the head nods.
    pub fn place(&self, index: usize) -> Vector {
        let (factor, offset) = self.factor_and_offset(index);
        let [aside, up, depth] = self.head.points[index];
        let is_tongue = self.head.label(index).trim_start_matches('-').starts_with("tongue");
        let place = if is_tongue { [aside, up + TONGUE_UP, LIPS] } else { [aside, up, depth] };
        plus(place.map(|x| x * factor), offset, 1.0)
    }

    /// The offset of the mouth.
    pub fn mouth_offset(&self) -> Vector {
        self.find(Part::Mouth).map_or([0.0; 3], Zoom::offset)
    }
}
