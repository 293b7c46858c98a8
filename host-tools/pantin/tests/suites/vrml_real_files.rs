//! VRML worlds of others, where they are at hand: places against an evaluation of the scene graph that shares nothing with the importer,
//! and conversion within a bound.

use crate::real::{SAME, converts, distance, files, height};
use pantin_convert::fk;
use pantin_convert::import::ImportOptions;
use std::collections::HashMap;

type Matrix = [[f64; 4]; 4];
/// w, x, y, z.
type Quaternion = [f64; 4];

/// A node of the file: the transform that it stands in, and its numbers by field.
#[derive(Default)]
struct Node {
    kind: String,
    above: Option<String>,
    fields: HashMap<String, Vec<f64>>,
}

#[derive(Default)]
struct World {
    nodes: HashMap<String, Node>,
    /// What comes from where: `node.event` by `node.event`.
    routes: HashMap<String, String>,
}

fn parse(text: &str) -> World {
    let lines = text.lines().filter(|line| !line.trim_start().starts_with('#'));
    let spaced: String = lines.flat_map(|line| line.chars().chain(['\n'])).flat_map(spaces).collect();
    let mut words = spaced.split_whitespace().peekable();
    let mut world = World::default();
    let mut open: Vec<String> = Vec::new();
    let (mut def, mut field) = (None, String::new());
    while let Some(word) = words.next() {
        match word {
            "DEF" => def = words.next(),
            "ROUTE" => {
                let from = words.next().unwrap();
                assert_eq!(words.next(), Some("TO"));
                world.routes.insert(words.next().unwrap().into(), from.into());
            }
            "}" => drop(open.pop()),
            "[" | "]" | "{" => {}
            _ if words.peek() == Some(&"{") => {
                let name = def.take().map_or_else(|| format!("#{}", world.nodes.len()), str::to_string);
                let above = open.iter().rev().find(|name| world.nodes[*name].kind == "Transform").cloned();
                world.nodes.insert(name.clone(), Node { kind: word.into(), above, fields: HashMap::new() });
                open.push(name);
            }
            _ => match (word.parse::<f64>(), open.last()) {
                (Ok(number), Some(name)) => {
                    world.nodes.get_mut(name).unwrap().fields.entry(field.clone()).or_default().push(number);
                }
                _ => field = word.into(),
            },
        }
    }
    world
}

fn spaces(c: char) -> Vec<char> {
    match c {
        '{' | '}' | '[' | ']' => vec![' ', c, ' '],
        ',' => vec![' '],
        _ => vec![c],
    }
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..4).map(|k| a[i][k] * b[k][j]).sum()))
}

fn times(a: Quaternion, b: Quaternion) -> Quaternion {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}

fn from_axis(v: &[f64]) -> Quaternion {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    let (s, c) = (v[3] / 2.0).sin_cos();
    if length == 0.0 { [1.0, 0.0, 0.0, 0.0] } else { [c, s * v[0] / length, s * v[1] / length, s * v[2] / length] }
}

/// From a to b by the part t of the turn that leads from one to the other.
fn between(a: Quaternion, b: Quaternion, t: f64) -> Quaternion {
    let [w, x, y, z] = times([a[0], -a[1], -a[2], -a[3]], b);
    let sign = if w < 0.0 { -1.0 } else { 1.0 };
    let angle = 2.0 * (x * x + y * y + z * z).sqrt().atan2(w.abs());
    times(a, from_axis(&[sign * x, sign * y, sign * z, t * angle]))
}

fn turn(q: Quaternion) -> Matrix {
    // Rows of q v q*, column by column.
    let column = |axis: usize| {
        let mut v = [0.0; 4];
        v[axis + 1] = 1.0;
        times(times(q, v), [q[0], -q[1], -q[2], -q[3]])
    };
    let columns = [column(0), column(1), column(2)];
    std::array::from_fn(|i| std::array::from_fn(|j| if i < 3 && j < 3 { columns[j][i + 1] } else { f64::from(u8::from(i == j)) }))
}

fn moved(v: &[f64], sign: f64) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| if j == 3 && i < 3 { sign * v[i] } else { f64::from(u8::from(i == j)) }))
}

impl World {
    /// A field at a fraction of the cycle.
    fn field(&self, name: &str, field: &str, fraction: f64) -> Option<Vec<f64>> {
        let Some(from) = self.routes.get(&format!("{name}.set_{field}")) else {
            return self.nodes[name].fields.get(field).cloned();
        };
        let interpolator = &self.nodes[from.strip_suffix(".value_changed").unwrap()];
        let (keys, values) = (&interpolator.fields["key"], &interpolator.fields["keyValue"]);
        let width = values.len() / keys.len();
        let value = |key: usize| &values[key * width..][..width];
        let next = keys.partition_point(|&key| key <= fraction);
        if next == 0 || next == keys.len() {
            return Some(value(next.saturating_sub(1)).to_vec());
        }
        let t = (fraction - keys[next - 1]) / (keys[next] - keys[next - 1]);
        let (a, b) = (value(next - 1), value(next));
        if width == 3 {
            return Some((0..3).map(|i| a[i] + (b[i] - a[i]) * t).collect());
        }
        let [w, x, y, z] = between(from_axis(a), from_axis(b), t);
        let length = (x * x + y * y + z * z).sqrt();
        Some(vec![x, y, z, 2.0 * length.atan2(w)])
    }

    /// Of a transform in the world.
    fn matrix(&self, name: &str, fraction: f64) -> Matrix {
        let of = |field: &str, rest: &[f64]| self.field(name, field, fraction).unwrap_or_else(|| rest.to_vec());
        let (place, center) = (of("translation", &[0.0; 3]), of("center", &[0.0; 3]));
        let (rotation, leaning) = (from_axis(&of("rotation", &[0.0; 4])), from_axis(&of("scaleOrientation", &[0.0; 4])));
        let back = [leaning[0], -leaning[1], -leaning[2], -leaning[3]];
        let scale = of("scale", &[1.0; 3]);
        let scale: Matrix =
            std::array::from_fn(|i| std::array::from_fn(|j| if i != j { 0.0 } else { *scale.get(i).unwrap_or(&1.0) }));
        let chain =
            [moved(&place, 1.0), moved(&center, 1.0), turn(rotation), turn(leaning), scale, turn(back), moved(&center, -1.0)];
        let local = chain[1..].iter().fold(chain[0], |left, right| product(&left, right));
        match &self.nodes[name].above {
            Some(above) => product(&self.matrix(above, fraction), &local),
            None => local,
        }
    }
}

#[test]
fn joints_stand_where_the_scene_graph_has_them() {
    for path in files(&["wrl"]) {
        let motion = crate::told::load(&path, &ImportOptions::new()).unwrap_or_else(|error| panic!("{error:#}")).motion;
        let world = parse(&std::fs::read_to_string(&path).unwrap());
        let sensor = world.nodes.values().find(|node| node.kind == "TimeSensor").unwrap();
        let cycle = sensor.fields["cycleInterval"][0];
        let transforms = world.nodes.values().filter(|node| node.kind == "Transform").count();
        assert_eq!(motion.rig.joints.iter().filter(|joint| !joint.end_site).count(), transforms);
        let (height, cm) = (height(&motion), motion.rig.cm_per_unit);
        let mut worst = 0f64;
        for frame in 0..motion.frames {
            let fraction = (frame as f64 * motion.frame_time / cycle).min(1.0);
            let places = fk::positions(&motion.rig, &motion.values, frame);
            for (joint, place) in motion.rig.joints.iter().zip(places).filter(|(joint, _)| !joint.end_site) {
                let matrix = world.matrix(&joint.name, fraction);
                worst = worst.max(distance(place, [0, 1, 2].map(|i| matrix[i][3] * cm)) / height);
            }
        }
        println!("{}: {transforms} joints off by at most {worst:.1e} of {height:.1} cm", path.display());
        assert!(worst < SAME, "{}: {worst}", path.display());
    }
}

#[test]
fn worlds_convert_and_expand_within_the_bound() {
    for path in files(&["wrl"]) {
        let motion = crate::told::load(&path, &ImportOptions::new()).unwrap().motion;
        converts(&path.display().to_string(), &motion);
    }
}
