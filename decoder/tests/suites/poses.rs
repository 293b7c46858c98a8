//! What the values of a pose mean, by the rules of FORMAT.md 11 in double precision: for the joints of all vectors, at random values, coded as angles and as
//! exponential maps.

use std::f64::consts::TAU;
use std::path::Path;

use pantin::{Angle, Axis, Clip, EulerOrder, Form, Kind, Pose, Turn, WrongForm};

pub type Matrix = [[f64; 3]; 3];

const IDENTITY: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const ORDERS: [EulerOrder; 6] =
    [EulerOrder::XYZ, EulerOrder::XZY, EulerOrder::YXZ, EulerOrder::YZX, EulerOrder::ZXY, EulerOrder::ZYX];
/// Poses of each clip.
const POSES: usize = if cfg!(miri) { 2 } else { 40 };

fn times(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|row| std::array::from_fn(|column| (0..3).map(|i| a[row][i] * b[i][column]).sum()))
}

/// The rotation about a unit vector, by Rodrigues' formula.
fn about([x, y, z]: [f64; 3], angle: f64) -> Matrix {
    let (sin, cos) = angle.sin_cos();
    let cross = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    let twice = times(&cross, &cross);
    std::array::from_fn(|row| {
        std::array::from_fn(|column| IDENTITY[row][column] + sin * cross[row][column] + (1.0 - cos) * twice[row][column])
    })
}

fn axis(index: usize) -> [f64; 3] {
    IDENTITY[index]
}

fn of_map(map: [f64; 3]) -> Matrix {
    let length = map.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length == 0.0 { IDENTITY } else { about(map.map(|x| x / length), length * TAU) }
}

pub fn of_quaternion([w, x, y, z]: [f64; 4]) -> Matrix {
    let length = [x, y, z].iter().map(|x| x * x).sum::<f64>().sqrt();
    if length == 0.0 { IDENTITY } else { about([x, y, z].map(|x| x / length), 2.0 * length.atan2(w)) }
}

/// The rotation of a joint with these kinds, as section 11 has it.
pub fn expected(kinds: &[Kind], values: &[i32], exponential: bool) -> Matrix {
    let turns = |raw: i32| f64::from(raw) / 4_294_967_296.0;
    let (mut matrix, mut coded) = (IDENTITY, vec![]);
    let (mut quaternion, mut map) = ([0.0; 4], [0.0; 3]);
    for (kind, &raw) in kinds.iter().zip(values) {
        let of = kind.axis();
        match of {
            Some(of) if kind.is_rotation() && !exponential => matrix = times(&matrix, &about(axis(of), turns(raw) * TAU)),
            Some(_) if kind.is_rotation() => coded.push(turns(raw)),
            Some(of) if kind.is_exponential() => map[of] = turns(raw),
            _ if kind.is_quaternion() => quaternion[of.map_or(0, |of| of + 1)] = f64::from(raw),
            _ => {}
        }
    }
    if let Ok(coded) = coded.try_into() {
        matrix = of_map(coded);
    }
    times(&times(&matrix, &of_quaternion(quaternion)), &of_map(map))
}

pub fn of_turn(turn: Turn) -> Matrix {
    turn.matrix().rows.map(|row| row.map(|element| f64::from(element.to_bits()) / f64::from(1 << 30)))
}

fn of_angles(order: EulerOrder, angles: [Angle; 3]) -> Matrix {
    order.axes().into_iter().zip(angles).fold(IDENTITY, |matrix, (of, angle)| {
        times(&matrix, &about(axis(of as usize), f64::from(angle.to_bits()) / 4_294_967_296.0 * TAU))
    })
}

pub fn difference(a: &Matrix, b: &Matrix) -> f64 {
    a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Numbers of all magnitudes.
pub struct Noise(pub u64);

impl Noise {
    pub fn next(&mut self) -> i32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 32) as i32 >> (self.0 >> 8 & 3)
    }
}

/// The vectors, each with its rig if that stands apart; none in a packaged crate.
fn vectors() -> Vec<(String, Vec<u8>, Option<Vec<u8>>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/vectors");
    let paths = std::fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().path());
    let clips = paths.filter(|path| path.extension().is_some_and(|extension| extension == "ptn"));
    let mut clips: Vec<_> = clips
        .map(|path| (path.display().to_string(), std::fs::read(&path).unwrap(), std::fs::read(path.with_extension("rig")).ok()))
        .collect();
    clips.sort();
    clips
}

#[test]
fn turns_are_what_the_channels_of_a_joint_make() {
    let mut seen = [0; 3];
    for (name, bytes, rig) in vectors() {
        let clip = rig.map_or_else(|| Clip::new_checked(&bytes), |rig| Clip::with_rig(&bytes, rig.leak())).unwrap();
        let rig = clip.rig();
        let mut noise = Noise(bytes.len() as u64);
        let forms = [Form::new(rig.id(), 0, []), Form::new(rig.id(), 0, [255; 43]), Form::new(rig.id(), 0, [0x5a; 43])];
        for pose in 0..POSES {
            let (form, values) = (&forms[pose % 3], (0..rig.channels()).map(|_| noise.next()).collect::<Vec<_>>());
            let pose = Pose { values: &values, form: form.into() };
            let mut choices = 0;
            for (index, joint) in rig.joints().enumerate() {
                let kinds: Vec<Kind> = joint.kinds.collect();
                let choice = kinds.iter().filter(|kind| kind.is_rotation()).count() == 3;
                let exponential = choice && form.exponentials().nth(choices / 8).unwrap() >> (choices % 8) & 1 != 0;
                choices += usize::from(choice);
                assert_eq!(form.is_exponential(&rig, index), exponential, "{name}: joint {index}");
                let Some(found) = clip.find(joint.name()).filter(|found| found.index() == index) else { continue };
                let own = &values[usize::from(joint.first_channel)..][..kinds.len()];
                let (turn, wanted) = (pose.turn(&found).unwrap(), expected(&kinds, own, exponential));
                seen[match turn {
                    Turn::Euler { .. } => 0,
                    Turn::Exponential(_) => 1,
                    Turn::Quaternion(_) => 2,
                }] += 1;
                assert!(difference(&of_turn(turn), &wanted) < 2e-6, "{name}: joint {index}: {turn:?}");
                let [w, x, y, z] = turn.quaternion().map(|component| f64::from(component.to_bits()));
                assert!(difference(&of_quaternion([w, x, y, z]), &wanted) < 2e-6, "{name}: joint {index}: {turn:?}");
                assert!(((w * w + x * x + y * y + z * z).sqrt() / f64::from(1 << 30) - 1.0).abs() < 1e-6);
                let cosine = (wanted[0][0] + wanted[1][1] + wanted[2][2] - 1.0) / 2.0;
                let angle = (f64::from(turn.angle().to_bits()) / 4_294_967_296.0).abs() * TAU;
                assert!((angle.cos() - cosine).abs() < 1e-5, "{name}: joint {index}: {angle}");
                for order in ORDERS {
                    let of_order = of_angles(order, turn.euler(order));
                    assert!(difference(&of_order, &wanted) < 5e-4, "{name}: joint {index}: {turn:?} as {order:?}");
                }
                let position = pose.position(&found).unwrap();
                for (of, value) in position.into_iter().enumerate() {
                    let at = kinds.iter().position(|kind| kind.is_position() && kind.axis() == Some(of));
                    assert_eq!(value, at.map(|at| own[at]), "{name}: joint {index}");
                }
            }
            for scalar in rig.scalars() {
                let found = clip.find_scalar(scalar.name()).unwrap();
                assert_eq!(pose.scalar(&found).unwrap().to_bits(), values[found.channel()]);
            }
        }
    }
    assert!(vectors().is_empty() || seen.iter().all(|&seen| seen > 10), "{seen:?}");
}

#[test]
fn angles_in_a_joints_own_order_come_back_as_they_are() {
    let angles = [1, -2, i32::MIN].map(Angle::from_bits);
    for order in ORDERS {
        assert_eq!(Turn::Euler { order, angles }.euler(order), angles);
        let [first, second, third] = order.axes();
        assert_eq!(EulerOrder::of(first, second), Some(order));
        assert!(first != second && second != third && third != first);
    }
    assert!([Axis::X, Axis::Y, Axis::Z].iter().all(|&axis| EulerOrder::of(axis, axis).is_none()));
}

#[test]
fn values_of_another_form_are_refused_by_its_first_difference() {
    let form = Form::new(7, -3, [1, 2]);
    assert_eq!(form.check(&Form::new(7, -3, [1, 2, 0])), Ok(()));
    assert_eq!(pantin::FormRef::from(&form), pantin::FormRef::from(&Form::new(7, -3, [1, 2, 0])));
    assert_eq!(form.check(&Form::new(8, -3, [1, 2])), Err(WrongForm::Rig));
    assert_eq!(form.check(&Form::new(7, -2, [1, 2])), Err(WrongForm::LengthExponent));
    for other in [&[1, 3][..], &[1], &[1, 2, 4], &[]] {
        let other = Form::new(7, -3, other.iter().copied());
        assert_eq!((form.check(&other), other.check(&form)), (Err(WrongForm::Exponentials), Err(WrongForm::Exponentials)));
        assert_ne!(pantin::FormRef::from(&form), pantin::FormRef::from(&other));
    }
    let said = [WrongForm::Rig, WrongForm::LengthExponent, WrongForm::Exponentials].map(|error| error.to_string());
    assert!(said[0].contains("rig") && said[1].contains("unit") && said[2].contains("exponential"), "{said:?}");
    for (_, bytes, rig) in vectors().into_iter().filter(|(.., rig)| rig.is_none()) {
        assert!(rig.is_none());
        let clip = Clip::new_checked(&bytes).unwrap();
        let (values, other) = (vec![0; clip.rig().channels()], Form::new(!clip.rig().id(), 0, []));
        let pose = Pose { values: &values, form: (&other).into() };
        if let Some(joint) = clip.rig().joints().next().and_then(|joint| clip.find(joint.name())) {
            assert_eq!(pose.turn(&joint), Err(WrongForm::Rig));
            assert_eq!(pose.position(&joint), Err(WrongForm::Rig));
        }
        if let Some(scalar) = clip.rig().scalars().next().and_then(|scalar| clip.find_scalar(scalar.name())) {
            assert_eq!(pose.scalar(&scalar).err(), Some(WrongForm::Rig));
        }
    }
}
