//! The geometric law of each action unit of the paper (docs/METHOD.md 3.1), and of the interpolations (3.3, 3.4).

use pantin_face::shape::Interpolation;
use pantin_pictures::face::compare::{jaw, under};
use pantin_pictures::face::head::{Vector, dot, minus, plus};
use pantin_pictures::face::subject::{Subject, cosine_law};
use pantin_pictures::face::{Face, action_units, compare, exact, pose};

fn face() -> Face {
    Face::new().unwrap()
}

fn posed(face: &Face, sum: &str) -> Vec<Vector> {
    exact::places(&face.blueprint, &pose::parse(&face.blueprint, sum).unwrap())
}

fn height(face: &Face, places: &[Vector], point: &str) -> f64 {
    places[face.head.find(point).unwrap()][1]
}

fn distance(a: Vector, b: Vector) -> f64 {
    dot(minus(a, b), minus(a, b)).sqrt()
}

/// Ends of the named points, against a height of the neutral face.
fn at_height(face: &Face, places: &[Vector], points: &[&str], neutral: &str) {
    for point in points {
        let gap = height(face, places, point) - face.head.at(neutral)[1];
        assert!(gap.abs() < 1e-9, "{point} ends {gap} mm above {neutral}");
    }
}

#[test]
fn every_feature_point_that_the_method_uses_is_named() {
    let face = face();
    // All of MPEG-4's feature points: groups 2 to 11.
    let groups: [(u8, u8); 10] = [(2, 14), (3, 14), (4, 6), (5, 4), (6, 4), (7, 1), (8, 10), (9, 15), (10, 10), (11, 6)];
    for (group, points) in groups {
        for point in 1..=points {
            face.head.find(&format!("{group}.{point}")).unwrap();
        }
    }
    for pair in [("2.4", "2.5"), ("8.10", "8.9"), ("5.1", "5.2"), ("2.13", "2.14"), ("4.1", "4.2")] {
        let [left, right] = [pair.0, pair.1].map(|point| face.head.at(point));
        assert!(left[0] > 0.0, "the face's left is +x");
        assert_eq!([-left[0], left[1], left[2]], right);
    }
}

#[test]
fn the_head_has_its_proportions_and_no_triangle_crosses_the_middle() {
    let face = face();
    let head = &face.head;
    assert!((150..=240).contains(&head.points.len()), "{} points", head.points.len());
    let (crown, chin) = (head.at("11.4")[1], head.at("2.1")[1]);
    let middle = (crown + chin) / 2.0;
    assert!(((head.at("3.7")[1] + head.at("3.11")[1]) / 2.0 - middle).abs() < 5.0, "the eyes are half way up");
    let (inner, outer) = (head.at("3.11")[0], head.at("3.7")[0]);
    assert!((2.0 * inner / (outer - inner) - 1.0).abs() < 0.1, "an eye's width lies between the eyes");
    let thirds = [head.at("4.3")[1] - head.at("9.15")[1], head.at("9.15")[1] - chin];
    assert!((thirds[0] / thirds[1] - 1.25).abs() < 0.15, "{thirds:?}");
    // Each edge off the middle belongs to two triangles of the half, but where eyes, mouth and neck are open.
    for triangle in &head.triangles {
        assert!(triangle.iter().any(|&corner| corner >= head.middles), "a triangle in the middle");
    }
    for index in (0..head.points.len()).filter(|&index| head.is_skin(index)) {
        assert!(
            head.triangles.iter().flatten().any(|&corner| corner == head.stored(index)),
            "{} is in no triangle",
            head.label(index)
        );
    }
}

#[test]
fn opening_brings_the_lower_lip_onto_the_line_from_the_jaws_axis_to_the_chin() {
    let face = face();
    let places = posed(&face, "open_mouth");
    let axis = plus(face.head.at("2.13"), minus(face.head.at("2.14"), face.head.at("2.13")), 0.5);
    let lip = minus(places[face.head.find("2.3").unwrap()], axis);
    let chin = minus(face.head.at("2.1"), axis);
    let between = (dot(lip, chin) / (dot(lip, lip) * dot(chin, chin)).sqrt()).acos().to_degrees();
    assert!(between < 1e-5, "{between} degrees beside the line");
    assert!(action_units::opening_angle(&Subject::of_head(&face.head)) > 20.0);
}

#[test]
fn opening_turns_what_the_curve_bounds_and_nothing_else() {
    let face = face();
    let places = posed(&face, "open_mouth");
    let neutral = face.blueprint.neutral();
    let moved = |point: &str| places[face.head.find(point).unwrap()] != neutral[face.head.find(point).unwrap()];
    for point in ["2.1", "2.3", "2.8", "2.9", "2.10", "2.11", "2.12", "8.2", "8.7", "8.8", "6.1"] {
        assert!(moved(point), "{point} is inside");
    }
    for point in [
        "2.13",
        "2.14",
        "5.1",
        "5.2",
        "8.3",
        "8.4",
        "2.4",
        "2.5",
        "2.2",
        "2.6",
        "8.1",
        "9.10",
        "9.3",
        "3.3",
        "throat",
        "neck-side",
    ] {
        assert!(!moved(point), "{point} is on the curve or outside");
    }
}

#[test]
fn a_smile_raises_the_corners_to_the_cupids_bow() {
    let face = face();
    let places = posed(&face, "smile");
    at_height(&face, &places, &["8.3", "8.4", "8.5", "8.6", "8.9", "8.10"], "8.10");
    at_height(&face, &places, &["2.4", "2.5", "2.8", "2.9"], "8.5");
}

#[test]
fn lowered_corners_sink_to_the_lower_lip() {
    let face = face();
    let places = posed(&face, "lower_corners");
    at_height(&face, &places, &["8.3", "8.4", "8.7", "8.8", "8.2"], "8.2");
    at_height(&face, &places, &["2.4", "2.5", "2.6", "2.7"], "2.8");
}

#[test]
fn lips_never_pass_through_each_other() {
    let face = face();
    for step in 0..=100 {
        for sum in ["smile", "lower_corners", "smile_left", "lower_corners_right", "open_mouth"] {
            let places = posed(&face, &format!("{sum}={}", f64::from(step) / 100.0));
            for (upper, lower) in [("2.2", "2.3"), ("2.6", "2.8"), ("2.7", "2.9")] {
                let gap = height(&face, &places, upper) - height(&face, &places, lower);
                assert!(gap >= 0.0, "{sum} at {step} %: {upper} is {gap} mm above {lower}");
            }
        }
    }
}

#[test]
fn brows_go_by_as_much_outside_as_inside() {
    let face = face();
    let raised = posed(&face, "brow_outer_raise");
    at_height(&face, &raised, &["4.5", "4.6"], "4.3");
    let up = height(&face, &raised, "4.5") - face.head.at("4.5")[1];
    let lowered = posed(&face, "brow_inner_lower");
    for point in ["4.1", "4.2"] {
        assert!((height(&face, &lowered, point) - face.head.at(point)[1] + up).abs() < 1e-9);
    }
}

#[test]
fn puffed_cheeks_are_a_fifth_farther_apart_fall_off_by_the_cosine_law_and_take_only_the_outline_with_them() {
    let face = face();
    let subject = Subject::of_head(&face.head);
    let places = posed(&face, "puff_cheeks");
    let (left, right) = (face.head.find("5.1").unwrap(), face.head.find("5.2").unwrap());
    let growth = distance(places[left], places[right]) / distance(face.head.at("5.1"), face.head.at("5.2"));
    assert!((growth - 1.2).abs() < 1e-9, "{growth}");
    let reach = action_units::puff_reach(&subject);
    let centre = plus(face.head.at("5.1"), minus(face.head.at("5.2"), face.head.at("5.1")), 0.5);
    let puffed = posed(&face, "puff_cheeks_left");
    let mut seen = 0;
    for index in (0..face.head.points.len()).filter(|&index| face.head.points[index][0] > 0.0) {
        let place = face.head.points[index];
        let follows = action_units::PUFF_FOLLOWERS.iter().find(|entry| entry.0 == face.head.label(index));
        if let Some((name, way)) = follows {
            let moved = [0, 1, 2].map(|axis| puffed[index][axis] - place[axis] - way[axis]);
            assert!(moved.iter().all(|gap| gap.abs() < 1e-9), "{name}: {moved:?} too far");
            continue;
        }
        let cheek = action_units::is_cheek(&subject, index);
        let part = if cheek { cosine_law(distance(place, face.head.at("5.1")), reach) } else { 0.0 };
        let growth = distance(puffed[index], centre) / distance(place, centre) - 1.0;
        assert!((growth - 0.2 * part).abs() < 1e-9, "{}: {growth}, not {}", face.head.label(index), 0.2 * part);
        seen += usize::from(part > 0.0);
    }
    assert!(seen >= 4, "{seen} points of a cheek");
    for point in ["8.3", "9.1", "3.3", "3.9", "2.4", "lid-lower-out", "wing-base"] {
        assert!(!action_units::is_cheek(&subject, face.head.find(point).unwrap()), "{point} is no cheek");
    }
}

#[test]
fn the_neutral_pose_has_every_property_that_the_paper_names() {
    let face = face();
    let at = |point: &str| face.head.at(point);
    // Gaze ahead: a pupil lies before the centre of its eyeball, and between the lids.
    for (pupil, lids) in [("3.5", ["3.1", "3.3"]), ("3.6", ["3.2", "3.4"])] {
        assert!((at(pupil)[0].abs() - 32.0).abs() < 1e-9 && at(pupil)[1].abs() < 1.0, "{pupil} looks aside");
        assert!(at(lids[0])[1] > at(pupil)[1] && at(pupil)[1] > at(lids[1])[1], "{pupil} is covered");
    }
    // Muscles relaxed: no unit has a weight, so both halves are equal.
    for (index, &point) in face.head.points.iter().enumerate() {
        let image = face.head.points[face.head.mirror(index)];
        assert_eq!([-point[0], point[1], point[2]], image, "{} is not symmetric", face.head.label(index));
    }
    // Lips closed: the inner contours touch, and no lip passes through the other.
    for (upper, lower) in [("2.2", "2.3"), ("2.6", "2.8"), ("2.7", "2.9"), ("inner-upper-in", "inner-lower-in")] {
        let gap = minus(at(upper), at(lower));
        assert!(gap[1] >= 0.0 && dot(gap, gap).sqrt() < 0.75, "{upper} and {lower} are {gap:?} mm apart");
    }
    // Teeth touching.
    assert!(distance(at("9.10"), at("9.11")) < 0.25, "the teeth are {} mm apart", distance(at("9.10"), at("9.11")));
    assert!(at("9.8")[1] > at("9.10")[1] && at("9.9")[1] < at("9.11")[1], "roots of teeth lie behind their edges");
    // Tongue flat, its tip at the contact of the teeth.
    let contact = plus(at("9.10"), minus(at("9.11"), at("9.10")), 0.5);
    assert!(distance(at("6.1"), contact) < 1.0, "6.1 is {} mm from the contact", distance(at("6.1"), contact));
    let heights = ["6.1", "6.2", "6.3", "6.4"].map(|point| at(point)[1]);
    assert!(heights.iter().all(|height| (height - heights[0]).abs() < 2.0), "the tongue is not flat: {heights:?}");
    // Head upright: its pivot, the nose and the chin lie in the middle, and the ears at one height.
    for point in ["7.1", "9.3", "2.1", "11.4"] {
        assert_eq!(at(point)[0], 0.0, "{point} is not in the middle");
    }
    assert_eq!(at("10.1")[1], at("10.2")[1]);
    assert!(at("11.4")[1] > at("3.1")[1] && at("3.1")[1] > at("9.3")[1] && at("9.3")[1] > at("2.1")[1]);
}

#[test]
fn lowered_and_raised_corners_of_the_lips_stay_together() {
    let face = face();
    let apart = |places: &[Vector]| distance(places[face.head.find("8.3").unwrap()], places[face.head.find("2.4").unwrap()]);
    let rest = apart(&face.blueprint.neutral());
    for unit in ["smile", "lower_corners", "sadness", "wide_smile"] {
        let gap = apart(&posed(&face, unit));
        assert!(gap - rest < 6.0, "{unit}: outer and inner corner are {gap} mm apart, {rest} mm at rest");
    }
}

#[test]
fn cells_of_the_tables_differ_wherever_their_number_exceeds_a_pixel() {
    let face = face();
    let (mut shown, mut measured) = (0, 0);
    for table in &compare::TABLES {
        for action in table.actions {
            let pictures = compare::pictures(&face, action).unwrap();
            assert_ne!(pictures.ends[0], pictures.ends[1], "{}: nothing happens", action.label);
            for three in pictures.cells.chunks(compare::METHODS.len()) {
                assert_eq!(three[0].deviation, compare::Deviation::default());
                for cell in &three[1..] {
                    let differs = cell.pixels != three[0].pixels;
                    let label = format!("{} {} at {}", action.label, compare::METHODS[cell.method].1, cell.weight);
                    if cell.deviation.pixels > 1.0 {
                        assert!(differs, "{label}: {:?}, and an equal picture", cell.deviation);
                        shown += 1;
                    }
                    assert!(!differs || cell.deviation.pixels > 0.0, "{label}: other pixels, and no deviation");
                    measured += usize::from(cell.deviation.mm > 0.0);
                }
            }
        }
    }
    assert!(shown >= 20 && measured >= 50, "{shown} cells differ by more than a pixel, {measured} at all");
}

#[test]
fn improved_linear_interpolation_is_the_papers_formula() {
    for (percent, part) in [(0, 0.0), (20, 0.309), (50, 0.707), (80, 0.951), (100, 1.0)] {
        let weight = f64::from(percent) / 100.0;
        let formula = (std::f64::consts::PI * (1.0 - weight) / 2.0).cos();
        let found = exact::eased(Interpolation::ImprovedLinear, weight);
        assert!((found - formula).abs() < 1e-12 && (found - part).abs() < 1e-3, "{percent} %: {found}");
    }
    let face = face();
    for unit in ["smile", "lower_corners", "brow_inner_lower", "brow_outer_raise", "puff_cheeks", "wide_smile"] {
        let shape = &face.blueprint.shapes[face.blueprint.shape(unit).unwrap()];
        assert_eq!(shape.interpolation, Interpolation::ImprovedLinear, "{unit}");
    }
}

#[test]
fn spherical_deltas_move_on_an_arc_about_their_centre() {
    let face = face();
    let under = under(&face.blueprint, Interpolation::Spherical);
    let shape = &under.shapes[under.shape("smile").unwrap()];
    assert_eq!(shape.interpolation, Interpolation::Spherical);
    let arc = shape.arc.unwrap();
    let corner = face.head.find("8.3").unwrap();
    let at =
        |weight: f64| minus(exact::places(&under, &pose::parse(&under, &format!("smile={weight}")).unwrap())[corner], arc.centre);
    let (start, end) = (at(0.0), at(1.0));
    assert!((action_units::angle(start, end) - arc.degrees).abs() < 0.01, "the angle is that of the corner");
    // In equal times equal angles, and never far inside the chord's ends.
    for step in 0..=10 {
        let weight = f64::from(step) / 10.0;
        let angle = action_units::angle(start, at(weight));
        assert!((angle - weight * arc.degrees).abs() < 0.6, "{weight}: {angle} degrees");
    }
    // Without an arc it is refused.
    let mut bare = under.clone();
    bare.shapes.iter_mut().for_each(|shape| shape.arc = None);
    let refused = pantin_pictures::face::compact::encode(&bare).unwrap_err().to_string();
    assert!(refused.contains("centre"), "{refused}");
}

#[test]
fn units_are_symmetric_and_their_sides_add_up() {
    let face = face();
    let neutral = face.blueprint.neutral();
    let ways =
        |sum: &str| -> Vec<Vector> { posed(&face, sum).iter().zip(&neutral).map(|(&to, &from)| minus(to, from)).collect() };
    for shape in face.blueprint.shapes.iter().filter(|shape| shape.sided && shape.turns.is_empty()) {
        let (left, right, both) =
            (ways(&format!("{}_left", shape.name)), ways(&format!("{}_right", shape.name)), ways(&shape.name));
        for index in 0..neutral.len() {
            let image = left[face.blueprint.mirror(index)];
            assert!(distance(right[index], [-image[0], image[1], image[2]]) < 1e-9, "{} is not symmetric", shape.name);
            let sum = plus(left[index], right[index], 1.0);
            assert!(distance(sum, both[index]) < 1e-9, "{}: the sides do not add up", shape.name);
        }
    }
}

#[test]
fn a_spherical_opening_keeps_the_jaws_length_and_a_straight_one_does_not() {
    let face = face();
    let spherical = jaw(&face, Interpolation::Spherical).unwrap();
    assert!(spherical.shortest > 0.99 && spherical.longest < 1.01, "{spherical:?}");
    let linear = jaw(&face, Interpolation::Linear).unwrap();
    assert!(linear.shortest < 0.99, "{linear:?}");
    // All ways end at the same place.
    let ends = [Interpolation::Linear, Interpolation::Eased, Interpolation::ImprovedLinear, Interpolation::Spherical].map(
        |interpolation| {
            let face = under(&face.blueprint, interpolation);
            exact::places(&face, &pose::parse(&face, "joy+sadness+open_mouth").unwrap())
        },
    );
    for end in &ends {
        assert!(end.iter().zip(&ends[0]).all(|(&a, &b)| distance(a, b) < 1e-9));
    }
}

#[test]
fn a_closed_lid_meets_the_lower_one_and_stays_on_the_eyeball() {
    let face = face();
    let closed = posed(&face, "blink");
    for (upper, lower) in [("3.1", "3.3"), ("3.2", "3.4"), ("lid-upper-in", "lid-lower-in"), ("lid-upper-out", "lid-lower-out")] {
        let gap = height(&face, &closed, upper) - face.head.at(lower)[1];
        assert!(gap.abs() < 0.1, "{upper} stops {gap} mm above {lower}");
    }
    let eyeball = [face.head.at("3.1")[0], 0.0, 62.0];
    let radius = distance(face.head.at("3.1"), eyeball);
    for step in 0..=20 {
        let places = posed(&face, &format!("blink={}", f64::from(step) / 20.0));
        assert!((distance(places[face.head.find("3.1").unwrap()], eyeball) / radius - 1.0).abs() < 0.01);
    }
}
