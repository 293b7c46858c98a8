//! The paper's action units, after its algorithms on feature points: for Pantin's own head and for any mesh (docs/METHOD.md 3.1).

use super::blueprint::{Arc, Shape, Turn};
use super::head::{Head, Vector, dot, minus, plus};
use super::subject::{LIPS, Lead, Subject, cosine_law, distance, led, nearest};
use pantin_face::shape::{Interpolation, ShapeKind};
use std::f64::consts::FRAC_PI_2;

/// The increase of the distance between the cheeks by unit 5.
pub const PUFF: f64 = 0.2;
/// How far skin follows a lip or a brow, in widths of the mouth: the paper says that it follows, not how far.
const FOLLOWS: f64 = 0.45;
/// How far below the chin the region that unit 1 rotates ends, in widths of the mouth: the chin's underside rotates too, the throat does not.
const BELOW_CHIN: f64 = 0.04;
/// How far the lower lip's outer contour rises with its inner one in a smile: our rule, the paper gives none.
const LOWER_LIP: f64 = 0.5;
/// The wider smile: how far its corners go aside, and how much its cheeks bulge, as parts of the mouth's width.
const WIDER: f64 = 0.17;
const BULGE: f64 = 0.12;
/// Points of Pantin's head that follow puffed cheeks, and how far, in millimetres: our rule, the paper moves the cheek alone. The outline runs between the cheek and
/// the jaw's corner, and the jaw's curve below it, so that they would stay inside the cheeks. Forwards, because a corner that only went aside would stand out from the
/// neck of a head seen from the side.
pub const PUFF_FOLLOWERS: [(&str, Vector); 2] = [("jaw-corner", [23.0, 0.0, 16.0]), ("jaw", [8.0, 0.0, 0.0])];

/// A unit of the paper, or one that its text mentions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rule {
    /// The name of its shape.
    pub name: &'static str,
    /// Its number in the paper.
    pub number: &'static str,
    /// Whether it has a left and a right version.
    pub sided: bool,
    /// The feature points that it needs.
    pub needs: &'static [&'static str],
}

/// The feature points of the lips.
const MOUTH: &[&str] = &[
    "2.2", "2.3", "2.4", "2.5", "2.6", "2.7", "2.8", "2.9", "8.1", "8.2", "8.3", "8.4", "8.5", "8.6", "8.7", "8.8", "8.9", "8.10",
];

/// The rules, in the order of the paper.
pub const RULES: [Rule; 7] = [
    Rule {
        name: "open_mouth",
        number: "1",
        sided: false,
        needs: &["2.1", "2.3", "2.4", "2.5", "2.8", "2.9", "2.13", "2.14", "5.1", "5.2", "8.3", "8.4"],
    },
    Rule { name: "smile", number: "2", sided: true, needs: MOUTH },
    Rule { name: "lower_corners", number: "3", sided: true, needs: MOUTH },
    Rule {
        name: "brow_inner_lower",
        number: "4a",
        sided: true,
        needs: &["4.1", "4.2", "4.3", "4.4", "4.5", "4.6", "8.3", "8.4"],
    },
    Rule { name: "brow_outer_raise", number: "4b", sided: true, needs: &["4.3", "4.4", "4.5", "4.6", "8.3", "8.4"] },
    Rule { name: "puff_cheeks", number: "5", sided: true, needs: &["2.11", "2.12", "2.13", "2.14", "5.1", "5.2", "8.3", "8.4"] },
    Rule {
        name: "wide_smile",
        number: "2, wider",
        sided: true,
        needs: &[
            "2.2", "2.3", "2.4", "2.5", "2.6", "2.7", "2.8", "2.9", "5.1", "5.2", "8.1", "8.2", "8.3", "8.4", "8.5", "8.6",
            "8.7", "8.8", "8.9", "8.10",
        ],
    },
];

/// A displacement for each point that moves.
pub type Ways = Vec<(usize, Vector)>;

/// Returns the feature points that a rule needs and a mesh lacks.
pub fn missing(subject: &Subject, rule: &Rule) -> Vec<&'static str> {
    rule.needs.iter().copied().filter(|name| subject.index(name).is_none()).collect()
}

/// What a rule does to a mesh that has all its points: both sides together.
pub enum Effect {
    /// Points and their displacements.
    Moved(Ways),
    /// A rotation about the axis through `centre` that is parallel to x, of these points.
    Rotated {
        /// A point of the axis.
        centre: Vector,
        /// Degrees at full weight.
        degrees: f64,
        /// The points that rotate, each with its part of the angle.
        members: Vec<(usize, f64)>,
    },
}

/// Applies a rule to a mesh that has its points.
pub fn effect(subject: &Subject, rule: &Rule) -> Effect {
    Effect::Moved(match rule.name {
        "open_mouth" => {
            let centre = plus(subject.at("2.13"), minus(subject.at("2.14"), subject.at("2.13")), 0.5);
            return Effect::Rotated { centre, degrees: opening_angle(subject), members: opening(subject) };
        }
        "smile" => smile(subject),
        "lower_corners" => lower_corners(subject),
        "brow_inner_lower" => brow_inner_lower(subject),
        "brow_outer_raise" => brow_outer_raise(subject),
        "puff_cheeks" => puff_cheeks(subject),
        _ => wide_smile(subject),
    })
}

/// Returns the units of Pantin's own head: 1, 2, 3, 4a, 4b, 5 and the wider smile.
pub fn units(head: &Head) -> Vec<Shape> {
    let subject = Subject::of_head(head);
    RULES.iter().map(|rule| of_head(head, &subject, rule)).collect()
}

/// The stored half of a rule's effect.
fn of_head(head: &Head, subject: &Subject, rule: &Rule) -> Shape {
    let stored = |index: &usize| *index < head.middles + head.pairs;
    match effect(subject, rule) {
        Effect::Rotated { centre, degrees, members } => {
            let members = members.into_iter().filter(|entry| stored(&entry.0)).collect();
            let turn = Turn { axis: 0, centre, degrees, members };
            Shape { turns: vec![turn], ..shape(rule.name, Interpolation::Spherical, rule.sided) }
        }
        Effect::Moved(mut deltas) => {
            deltas.retain(|entry| stored(&entry.0));
            // Points in the middle follow both sides, each by half.
            deltas.iter_mut().filter(|entry| entry.0 < head.middles).for_each(|entry| entry.1 = entry.1.map(|x| x / 2.0));
            if rule.name == "puff_cheeks" {
                deltas.extend(PUFF_FOLLOWERS.iter().filter_map(|&(name, way)| head.find(name).ok().map(|index| (index, way))));
            }
            let arc = Some(arc(subject, rule));
            Shape { deltas, arc, ..shape(rule.name, Interpolation::ImprovedLinear, rule.sided) }
        }
    }
}

/// The arc on which the spherical interpolation of a rule moves points: about the middle of the mouth, of the left brow or of the cheeks, by the angle
/// between start and end of the point that moves farthest. An animator may choose others.
pub fn arc(subject: &Subject, rule: &Rule) -> Arc {
    let ends = match rule.name {
        "brow_inner_lower" | "brow_outer_raise" => ["4.1", "4.5"],
        "puff_cheeks" => ["5.1", "5.2"],
        _ => ["8.3", "8.4"],
    };
    let name = |name: &str| subject.feature(name).unwrap_or_default();
    let centre = plus(name(ends[0]), minus(name(ends[1]), name(ends[0])), 0.5);
    let Effect::Moved(ways) = effect(subject, rule) else { return Arc { centre, degrees: Arc::LEAST } };
    let farthest =
        ways.iter().filter(|(index, _)| subject.points[*index][0] > 0.0).max_by(|a, b| dot(a.1, a.1).total_cmp(&dot(b.1, b.1)));
    let degrees = farthest.map_or(0.0, |&(index, way)| {
        let start = minus(subject.points[index], centre);
        angle(start, plus(start, way, 1.0))
    });
    Arc { centre, degrees: degrees.clamp(Arc::LEAST, Arc::MOST) }
}

/// Degrees between two vectors.
pub fn angle(a: Vector, b: Vector) -> f64 {
    (dot(a, b) / (dot(a, a) * dot(b, b)).sqrt().max(1e-12)).clamp(-1.0, 1.0).acos().to_degrees()
}

/// The angle of unit 1 in degrees: it rotates 2.3 onto the line from the midpoint of 2.13 and 2.14 to 2.1.
pub fn opening_angle(subject: &Subject) -> f64 {
    let axis = subject.at("2.13");
    let below = |name: &str| (subject.at(name)[1] - axis[1]).atan2(subject.at(name)[2] - axis[2]);
    (below("2.3") - below("2.1")).to_degrees()
}

/// The members of unit 1, and the part of the angle of each: all of it, but where the lower lip runs into a corner, which stays, the part falls off, so that
/// the open mouth is round. The paper rotates all points alike; its feature points keep the whole angle.
fn opening(subject: &Subject) -> Vec<(usize, f64)> {
    let features: Vec<usize> =
        ["2.1", "2.3", "2.8", "2.9", "8.2", "8.7", "8.8"].iter().filter_map(|name| subject.index(name)).collect();
    let part = |index: usize| {
        let [x, ..] = subject.points[index];
        if features.contains(&index) || !subject.is_lip(index) {
            return 1.0;
        }
        let (corner, full) = if x > subject.at("2.3")[0] { ("8.3", "2.8") } else { ("8.4", "2.9") };
        let (corner, full) = (subject.at(corner)[0], subject.at(full)[0]);
        ((corner - x) / (corner - full) * FRAC_PI_2).clamp(0.0, FRAC_PI_2).sin()
    };
    jaw_region(subject).into_iter().map(|index| (index, part(index))).filter(|entry| entry.1 > 0.0).collect()
}

/// The points inside the curve 2.14-5.2-8.4-2.5-2.9-2.3-2.8-2.4-8.3-5.1-2.13, seen from the front, and the lower lip on the curve. The curve
/// is closed below the chin. Points behind the axis do not belong to the region.
pub fn jaw_region(subject: &Subject) -> Vec<usize> {
    let curve = ["2.14", "5.2", "8.4", "2.5", "2.9", "2.3", "2.8", "2.4", "8.3", "5.1", "2.13"];
    let floor = subject.at("2.1")[1] - BELOW_CHIN * subject.mouth_width();
    let axis = subject.at("2.13");
    let mut polygon: Vec<[f64; 2]> = curve.iter().map(|name| [subject.at(name)[0], subject.at(name)[1]]).collect();
    polygon.extend([[axis[0], floor], [-axis[0], floor]]);
    let named = |names: &[&str]| names.iter().filter_map(|name| subject.index(name)).collect::<Vec<_>>();
    let (on_curve, lip) = (named(&curve), named(&["2.9", "2.3", "2.8"]));
    // Points of the upper lip touch the curve where the lips are closed.
    let upper = named(&["2.2", "2.6", "2.7", "8.1", "8.5", "8.6", "8.9", "8.10"]);
    let inside = |&index: &usize| {
        let [x, y, z] = subject.points[index];
        let enclosed = if subject.on_mouth_line(index) { subject.lower[index] } else { encloses(&polygon, [x, y]) };
        let within = !on_curve.contains(&index) && !upper.contains(&index) && enclosed;
        subject.hangs[index] && z > axis[2] && (lip.contains(&index) || within)
    };
    (0..subject.points.len()).filter(inside).collect()
}

fn encloses(polygon: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let edges = polygon.iter().zip(polygon.iter().cycle().skip(1));
    let crossed = edges.filter(|(a, b)| (a[1] > y) != (b[1] > y) && x < (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]) + a[0]);
    crossed.count() % 2 == 1
}

/// Returns a shape without deltas and rotations.
pub fn shape(name: &str, interpolation: Interpolation, sided: bool) -> Shape {
    Shape {
        name: name.into(),
        interpolation,
        kind: ShapeKind::Unsigned,
        sided,
        reach: 0.0,
        deltas: Vec::new(),
        turns: Vec::new(),
        arc: None,
    }
}

/// Feature points on the left, and their images.
const PARTNERS: [(&str, &str); 9] = [
    ("2.4", "2.5"),
    ("2.6", "2.7"),
    ("2.8", "2.9"),
    ("8.3", "8.4"),
    ("8.5", "8.6"),
    ("8.7", "8.8"),
    ("8.10", "8.9"),
    ("4.1", "4.2"),
    ("4.3", "4.4"),
];

/// The image of a feature point on the left; of one in the middle itself.
pub fn partner(name: &str) -> &str {
    let others = [("4.5", "4.6"), ("5.1", "5.2"), ("2.11", "2.12"), ("2.13", "2.14")];
    PARTNERS.iter().chain(&others).find(|pair| pair.0 == name).map_or(name, |pair| pair.1)
}

/// Feature points of one side, by the numbers of the left side.
struct Side<'m> {
    subject: &'m Subject,
    right: bool,
}

impl Side<'_> {
    fn height(&self, left: &str) -> f64 {
        self.subject.at(if self.right { partner(left) } else { left })[1]
    }
}

/// Moves lines of feature points up, and what is near them: `lines` are the numbers of left points, `rise` returns how far each of them goes up on a side.
fn moved(subject: &Subject, lines: &[&[&str]], rise: impl Fn(&Side, &str) -> f64) -> Ways {
    let reach = FOLLOWS * subject.mouth_width();
    let mut leads: Vec<Lead> = Vec::new();
    let mut fixed: Ways = Vec::new();
    for right in [false, true] {
        let side = Side { subject, right };
        for line in lines {
            let mut lead = Lead::new();
            for left in *line {
                let name = if right { partner(left) } else { left };
                let way = [0.0, rise(&side, left), 0.0];
                fixed.extend(subject.index(name).map(|index| (index, way)));
                lead.push((subject.at(name), way));
            }
            leads.push(smooth(&lead));
        }
    }
    let mut ways: Ways = Vec::new();
    for index in 0..subject.points.len() {
        let exact = fixed.iter().find(|entry| entry.0 == index).map(|entry| entry.1);
        let way = exact.unwrap_or_else(|| if subject.soft[index] { led(subject.points[index], &leads, reach) } else { [0.0; 3] });
        if dot(way, way).sqrt() > 1e-4 * reach {
            ways.push((index, way));
        }
    }
    ways
}

/// Parts into which each segment of a line is divided.
const PARTS: usize = 8;

/// The line with displacements that bend instead of breaking at a point that has none: from there they grow with the square of the distance.
fn smooth(lead: &Lead) -> Lead {
    let mut out = Lead::new();
    for ends in lead.windows(2) {
        let [(from, a), (to, b)] = [ends[0], ends[1]];
        let still = |way: Vector| way == [0.0; 3];
        for part in 0..PARTS {
            let t = part as f64 / PARTS as f64;
            let eased = match (still(a), still(b)) {
                (true, false) => t * t,
                (false, true) => 1.0 - (1.0 - t) * (1.0 - t),
                _ => t,
            };
            out.push((plus(from, minus(to, from), t), plus(a, minus(b, a), eased)));
        }
    }
    out.extend(lead.last());
    out
}

/// Unit 2 as the paper prints it: the outer upper contour to the height of 8.10, the inner corner and 2.8 to that of 8.5. The upper inner contour moves with the
/// lower one, so that it stays above it; the lower lip follows by our rule.
fn smile(subject: &Subject) -> Ways {
    moved(subject, &LIPS, |side, name| match name {
        "8.3" | "8.5" => side.height("8.10") - side.height(name),
        "2.4" | "2.8" => side.height("8.5") - side.height(name),
        "2.6" => side.height("8.5") - side.height("2.8"),
        "8.7" => LOWER_LIP * (side.height("8.5") - side.height("2.8")),
        _ => 0.0,
    })
}

/// Unit 3 as the paper prints it (7.5 read as 8.7): the outer lower contour to the height of 8.2, the inner corner and 2.6 to that of 2.8, with which 2.8 moves.
fn lower_corners(subject: &Subject) -> Ways {
    moved(subject, &LIPS, |side, name| match name {
        "8.3" | "8.7" => side.height("8.2") - side.height(name),
        "2.4" | "2.6" => side.height("2.8") - side.height(name),
        "2.8" => side.height("2.8") - side.height("2.6"),
        _ => 0.0,
    })
}

/// The wider smile, which the paper calls harder "since the change in the cheeks' shape has to be taken into account": unit 2, with corners that go aside and
/// cheeks that bulge above them.
fn wide_smile(subject: &Subject) -> Ways {
    let width = subject.mouth_width();
    let half = width / 2.0;
    let mut ways: Ways = smile(subject);
    let middle = subject.at("8.2")[0];
    let mut add = |index: usize, way: Vector| match ways.iter_mut().find(|entry| entry.0 == index) {
        Some(entry) => entry.1 = plus(entry.1, way, 1.0),
        None => ways.push((index, way)),
    };
    for (cheek, corner) in [("5.1", "8.3"), ("5.2", "8.4")] {
        let (cheek, corner) = (subject.at(cheek), subject.at(corner));
        let aside = (corner[0] - middle).signum();
        // The bulge lies between the cheek's centre and the corner, above both.
        let centre = plus(cheek, minus(corner, cheek), 0.35);
        for index in (0..subject.points.len()).filter(|&index| subject.soft[index]) {
            let place = subject.points[index];
            if (place[0] - middle) * aside <= 0.0 {
                continue;
            }
            let lip = subject.is_lip(index);
            let part = if lip {
                ((place[0] - middle) / half).abs().min(1.0)
            } else {
                cosine_law(distance(place, corner), FOLLOWS * width)
            };
            let stretched = [aside * WIDER * width * part, 0.0, -0.08 * width * part];
            let bulge = if lip { 0.0 } else { cosine_law(distance(place, centre), 0.6 * width) };
            let bulged = [aside * BULGE * width * bulge, BULGE * width * bulge, BULGE * width * bulge];
            let way = plus(stretched, bulged, 1.0);
            if dot(way, way).sqrt() > 1e-3 * width {
                add(index, way);
            }
        }
    }
    ways.sort_by_key(|entry| entry.0);
    ways
}

/// Adds the skin within each leader's radius, except points that have a displacement already and the edges of lips and lids.
pub fn follow(head: &Head, ways: Ways, leaders: &[(usize, f64)]) -> Ways {
    let bound = |index: usize| {
        let edges = head
            .openings
            .iter()
            .any(|opening| [index, head.mirror(index)].iter().any(|i| opening.upper.contains(i) || opening.lower.contains(i)));
        let lips = head.curves.iter().filter(|curve| curve.name.starts_with("lip")).any(|curve| curve.points.contains(&index));
        edges || lips || !head.is_skin(index)
    };
    let mut all = ways.clone();
    for index in 0..head.points.len() {
        if bound(index) || ways.iter().any(|entry| entry.0 == index) {
            continue;
        }
        let pull = |&(leader, reach): &(usize, f64)| {
            let gap = minus(head.points[index], head.points[leader]);
            let way = ways.iter().find(|entry| entry.0 == leader).map_or([0.0; 3], |entry| entry.1);
            (cosine_law(dot(gap, gap).sqrt(), reach), way)
        };
        let strongest = leaders.iter().map(pull).max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((part, way)) = strongest.filter(|entry| entry.0 > 0.02) {
            all.push((index, way.map(|x| x * part)));
        }
    }
    all
}

/// The distance by which 4b raises the outer end of a brow: to the height of its top.
fn raise(side: &Side) -> f64 {
    side.height("4.3") - side.height("4.5")
}

/// 4a: the inner end goes down by as much as 4b raises the outer one, the points between by less.
fn brow_inner_lower(subject: &Subject) -> Ways {
    moved(subject, &[&["4.1", "4.3"]], |side, name| if name == "4.1" { -raise(side) } else { 0.0 })
}

/// 4b: the outer end rises to the height of the top, the points between by less.
fn brow_outer_raise(subject: &Subject) -> Ways {
    moved(subject, &[&["4.3", "4.5"]], |side, name| if name == "4.5" { raise(side) } else { 0.0 })
}

/// The radius around 5.1 of the cheek that unit 5 puffs: the distance of the curve 2.11-2.13 along the jaw.
pub fn puff_reach(subject: &Subject) -> f64 {
    let (from, to) = (subject.at("2.11"), subject.at("2.13"));
    let cheek = subject.at("5.1");
    distance(cheek, nearest(cheek, from, to).0)
}

/// Whether a point is skin of a cheek: between the lower lid, the wing of the nose, the mouth's corner and the jaw.
pub fn is_cheek(subject: &Subject, index: usize) -> bool {
    let [x, y, _] = subject.points[index];
    let beside = |name: &str| subject.feature(name).is_none_or(|place| x.abs() > place[0].abs());
    let lid = ["3.9", "3.3", "3.7"].iter().find_map(|name| subject.feature(name)).map_or(f64::MAX, |place| place[1]);
    subject.soft[index] && !subject.is_lip(index) && y < lid && beside("9.1") && beside("8.3")
}

/// Unit 5: cheek points go away from the midpoint of 5.1 and 5.2, by a fifth of their distance times the cosine law.
fn puff_cheeks(subject: &Subject) -> Ways {
    let (left, right, reach) = (subject.at("5.1"), subject.at("5.2"), puff_reach(subject));
    let centre = plus(left, minus(right, left), 0.5);
    let way = |index: usize| {
        let place = subject.points[index];
        let part = cosine_law(distance(place, left).min(distance(place, right)), reach);
        (index, minus(place, centre).map(|x| x * PUFF * part))
    };
    let cheeks = (0..subject.points.len()).filter(|&index| is_cheek(subject, index));
    cheeks.map(way).filter(|(_, way)| *way != [0.0; 3]).collect()
}
