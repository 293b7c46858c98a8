//! A state machine as a picture: states in two bent columns, transitions as arrows with their causes, layers as lines below, as SVG.

use super::source::{Cause, Kind, Layer, Source, State, Transition};
use crate::render::svg::escaped;
use std::fmt::Write;

/// Width of a letter, height of a line, a state and a layer's line, and space around, in units of the picture.
const LETTER: f64 = 7.6;
const LINE: f64 = 15.0;
const STATE: f64 = 44.0;
const LAYER: f64 = LINE * 1.5;
const MARGIN: f64 = 90.0;
/// From a row of states to the next, and from a column to the middle beside half of a state. The picture is high rather than wide: a page that fits it
/// into a column of text shrinks its letters little.
const ROW: f64 = 88.0;
const COLUMN: f64 = 165.0;
/// How much nearer to the middle the columns are at their ends: arrows from a state to the one after the next pass beside the state between.
const BULGE: f64 = 0.45;
/// How far an arrow bends to its right, as a part of its length, and at least: there and back are two arrows.
const BEND: f64 = 0.16;
const LEAST_BEND: f64 = 52.0;

type Point = [f64; 2];

struct Node {
    name: String,
    clip: String,
    at: Point,
    /// Half of its width and height.
    half: Point,
}

/// A line from a state to another, for all transitions between them.
struct Arrow {
    /// Indices of states; one more than the last is any state.
    from: usize,
    to: usize,
    causes: Vec<String>,
}

/// The picture of a machine.
pub fn svg(source: &Source) -> String {
    let mut nodes = nodes(source);
    if !source.any.is_empty() {
        nodes.push(Node { name: "any state".into(), clip: String::new(), at: [0.0; 2], half: [44.0, 15.0] });
    }
    let layers: Vec<String> = source.layers.iter().map(|layer| layer_text(layer.get_ref())).collect();
    let half = half_size(&nodes, &layers);
    let mut out = head(half, LAYER * layers.len() as f64);
    let mut labels = Labels { text: String::new(), taken: nodes.iter().map(|node| (node.at, node.half)).collect() };
    for Arrow { from, to, causes } in &arrows(source) {
        arrow(&mut out, &mut labels, &nodes[*from], &nodes[*to], causes);
    }
    let start = source.start.as_ref().map_or(Some(0), |start| index(source, start.get_ref()));
    for (number, node) in nodes.iter().enumerate() {
        let role = match number {
            _ if number == source.states.len() => Role::Any,
            _ if Some(number) == start => Role::Start,
            _ => Role::State,
        };
        draw(&mut out, node, role);
    }
    out.push_str(&labels.text);
    for (line, text) in layers.iter().enumerate() {
        let y = half[1] + LAYER * line as f64;
        let _ = writeln!(out, r##"<text x="0" y="{y:.1}" fill="#567">{}</text>"##, escaped(text));
    }
    out.push_str("</svg>\n");
    out
}

fn index(source: &Source, name: &str) -> Option<usize> {
    source.states.iter().position(|state| state.name.get_ref() == name)
}

/// The arrows, each with the causes of all its transitions; those from any state come last.
fn arrows(source: &Source) -> Vec<Arrow> {
    let mut arrows: Vec<Arrow> = Vec::new();
    let lists = source.states.iter().map(|state| &state.transitions).chain([&source.any]);
    for (from, row) in lists.enumerate().flat_map(|(from, rows)| rows.iter().map(move |row| (from, row.get_ref()))) {
        let Some(to) = index(source, &row.to) else { continue };
        match arrows.iter_mut().find(|arrow| (arrow.from, arrow.to) == (from, to)) {
            Some(arrow) => arrow.causes.push(cause(row)),
            None => arrows.push(Arrow { from, to, causes: vec![cause(row)] }),
        }
    }
    arrows
}

/// Half the width and the height of the picture above the layers' lines.
fn half_size(nodes: &[Node], layers: &[String]) -> Point {
    let far = |axis: usize| nodes.iter().map(|node| node.at[axis].abs() + node.half[axis]).fold(0.0, f64::max) + MARGIN;
    let longest = layers.iter().map(|text| text.chars().count() as f64 * LETTER).fold(0.0, f64::max);
    [far(0).max(longest / 2.0 + LINE), far(1)]
}

/// The element `svg` of a picture with its middle at 0, 0 and `below` units of lines below it.
fn head([wide, high]: Point, below: f64) -> String {
    format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="{:.0} {:.0} {:.0} {:.0}" width="{:.0}" height="{:.0}" font-family="sans-serif" font-size="13" text-anchor="middle">
<defs><marker id="head" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="8" markerHeight="8" orient="auto"><path d="M0 0L10 5L0 10z" fill="#345"/></marker></defs>
<rect x="{:.0}" y="{:.0}" width="100%" height="100%" fill="#fff"/>
"##,
        -wide,
        -high,
        2.0 * wide,
        2.0 * high + below,
        2.0 * wide,
        2.0 * high + below,
        -wide,
        -high
    )
}

/// What a node stands for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Role {
    State,
    Start,
    Any,
}

fn draw(out: &mut String, node: &Node, role: Role) {
    let ([x, y], [w, h]) = (node.at, node.half);
    let (stroke, width, dash) = match role {
        Role::State => ("#345", 1, ""),
        Role::Start => ("#c40", 3, ""),
        Role::Any => ("#789", 1, r#" stroke-dasharray="4 3""#),
    };
    // A page lights the state that plays.
    let state = if role == Role::Any { String::new() } else { format!(r#" data-state="{}""#, escaped(&node.name)) };
    let _ = writeln!(
        out,
        r##"<rect x="{:.1}" y="{:.1}" width="{:.1}" height="{:.1}" rx="9" fill="#f4f7fb" stroke="{stroke}" stroke-width="{width}"{dash}{state}/>"##,
        x - w,
        y - h,
        2.0 * w,
        2.0 * h
    );
    let up = if node.clip.is_empty() { 4.5 } else { -2.5 };
    let _ = writeln!(out, r#"<text x="{x:.1}" y="{:.1}" font-weight="bold">{}</text>"#, y + up, escaped(&node.name));
    if !node.clip.is_empty() {
        let _ =
            writeln!(out, r##"<text x="{x:.1}" y="{:.1}" font-size="12" fill="#567">{}</text>"##, y + 13.0, escaped(&node.clip));
    }
}

fn nodes(source: &Source) -> Vec<Node> {
    let clip = |state: &State| {
        // A clip of the state's own name is not written twice.
        let own = state.clip.as_ref().map_or("", |clip| clip.get_ref());
        let with = state.blend.as_ref().map_or(String::new(), |blend| format!(" to {}", blend.get_ref().clip));
        let speed = state.speed.filter(|&speed| speed != 1.0).map_or(String::new(), |speed| format!(" at {speed}"));
        format!("{own}{with}{speed}")
    };
    let count = source.states.len();
    let named: Vec<(String, String)> = source.states.iter().map(|state| (state.name.get_ref().clone(), clip(state))).collect();
    let width = |(name, clip): &(String, String)| name.chars().count().max(clip.chars().count()) as f64 * LETTER + 24.0;
    let widest = named.iter().map(width).fold(80.0, f64::max);
    // The first at the top, down on the right, up on the left; an even number has one at the bottom.
    let (rows, even) = ((count - 1) / 2, count.is_multiple_of(2));
    let last = if even { rows + 1 } else { rows };
    let place = |index: usize| {
        let (side, row) = match index {
            0 => (0.0, 0),
            _ if index <= rows => (1.0, index),
            _ if even && index == rows + 1 => (0.0, last),
            _ => (-1.0, count - index),
        };
        // From the middle of the column, -1 to 1.
        let along = if rows < 2 { 0.0 } else { 2.0 * (row as f64 - 1.0) / (rows as f64 - 1.0) - 1.0 };
        let column = (widest / 2.0 + COLUMN) * (1.0 - BULGE * along * along);
        [side * column, ROW * (row as f64 - last as f64 / 2.0)]
    };
    let node = |(index, (name, clip)): (usize, (String, String))| {
        let half = [width(&(name.clone(), clip.clone())) / 2.0, STATE / 2.0];
        Node { at: place(index), name, clip, half }
    };
    named.into_iter().enumerate().map(node).collect()
}

/// A layer in a line.
fn layer_text(layer: &Layer) -> String {
    let over = layer.states.as_ref().map_or("all states".into(), |states| states.join(", "));
    format!("layer {}, by {}, over {over}", layer.clip, layer.input)
}

/// A cause in a few words, and how the poses change over, if not as usual.
fn cause(row: &Transition) -> String {
    let how = match row.kind {
        Kind::Inertialized => "",
        Kind::Cut => " (cut)",
        Kind::Faded => " (faded)",
    };
    format!("{}{how}", why(row))
}

fn why(row: &Transition) -> String {
    match row.causes().first() {
        Some(Cause::End(_)) => "end".into(),
        Some(Cause::Input(name)) => (*name).into(),
        Some(Cause::Released(name)) => format!("no {name}"),
        Some(Cause::Event(name)) => format!("event {name}"),
        Some(Cause::Above(name, threshold)) => format!("{name} > {threshold}"),
        Some(Cause::Below(name, threshold)) => format!("{name} < {threshold}"),
        None => String::new(),
    }
}

/// Texts beside arrows, and the boxes that they and the states take: their middles, and half of their sizes.
struct Labels {
    text: String,
    taken: Vec<(Point, Point)>,
}

impl Labels {
    /// Writes causes at the first of some places where nothing is in their way, else at the first of all.
    fn write(&mut self, causes: &[String], places: &[Point]) {
        let longest = causes.iter().map(|cause| cause.chars().count()).max().unwrap_or(0) as f64;
        let half = [longest * LETTER / 2.0, causes.len() as f64 * LINE / 2.0];
        let meets = |at: &Point, (other, its): &(Point, Point)| {
            (0..2).all(|axis| (at[axis] - other[axis]).abs() < half[axis] + its[axis])
        };
        let free = places.iter().find(|at| !self.taken.iter().any(|other| meets(at, other)));
        let Some(&at) = free.or(places.first()) else { return };
        self.taken.push((at, half));
        let top = at[1] - LINE * (causes.len() - 1) as f64 / 2.0 + 4.0;
        for (line, cause) in causes.iter().enumerate() {
            let _ = writeln!(
                self.text,
                r##"<text x="{:.1}" y="{:.1}" font-size="12" fill="#024" stroke="#fff" stroke-width="4" paint-order="stroke">{}</text>"##,
                at[0],
                top + LINE * line as f64,
                escaped(cause)
            );
        }
    }
}

/// Parts of an arrow's way at which its label may stand, the best first.
const LABEL_AT: [f64; 9] = [0.5, 0.43, 0.57, 0.36, 0.64, 0.29, 0.71, 0.22, 0.78];

/// Draws an arrow, and its label later, above all states.
fn arrow(out: &mut String, labels: &mut Labels, from: &Node, to: &Node, causes: &[String]) {
    let (a, b) = (from.at, to.at);
    let length = (b[0] - a[0]).hypot(b[1] - a[1]);
    let (path, places) = if length < 1.0 {
        // To itself: a loop on the side away from the centre.
        let away = a[0].hypot(a[1]).max(1.0);
        let [x, y] = if away > 1.0 { [a[0] / away, a[1] / away] } else { [0.0, -1.0] };
        let top = [a[0] + x * (from.half[0] + 60.0), a[1] + y * (from.half[1] + 60.0)];
        let (left, right) = ([top[0] - y * 40.0, top[1] + x * 40.0], [top[0] + y * 40.0, top[1] - x * 40.0]);
        let (start, end) = (border(from, left), border(from, right));
        let path = format!(
            "M{:.1} {:.1}C{:.1} {:.1} {:.1} {:.1} {:.1} {:.1}",
            start[0], start[1], left[0], left[1], right[0], right[1], end[0], end[1]
        );
        (path, vec![[top[0] - x * 14.0, top[1] - y * 14.0]])
    } else {
        let part = BEND.max(LEAST_BEND / length);
        let bend = [-(b[1] - a[1]) * part, (b[0] - a[0]) * part];
        let over = [(a[0] + b[0]) / 2.0 + bend[0], (a[1] + b[1]) / 2.0 + bend[1]];
        let (start, end) = (border(from, over), border(to, over));
        let path = format!("M{:.1} {:.1}Q{:.1} {:.1} {:.1} {:.1}", start[0], start[1], over[0], over[1], end[0], end[1]);
        let at = |t: f64| {
            let s = 1.0 - t;
            [0, 1].map(|axis| s * s * start[axis] + 2.0 * s * t * over[axis] + t * t * end[axis])
        };
        (path, LABEL_AT.map(at).to_vec())
    };
    let _ = writeln!(out, r##"<path d="{path}" fill="none" stroke="#345" marker-end="url(#head)"/>"##);
    labels.write(causes, &places);
}

/// Where the way from a state's middle to a point leaves the state.
fn border(node: &Node, towards: Point) -> Point {
    let way = [towards[0] - node.at[0], towards[1] - node.at[1]];
    let part = [0, 1].map(|axis| if way[axis] == 0.0 { f64::INFINITY } else { (node.half[axis] + 3.0) / way[axis].abs() });
    let part = part[0].min(part[1]).min(1.0);
    [node.at[0] + way[0] * part, node.at[1] + way[1] * part]
}
