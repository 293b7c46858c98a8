//! Finds the skin's triangles: the convex hull of the points' directions from inside the head. No list of triangles is needed.

use super::head::{Head, Vector, cross, dot, minus, mirror, unit};

/// Three points, anticlockwise seen from outside.
pub type Triangle = [usize; 3];

/// The centre from which all of the skin is visible: low enough for the throat.
const CENTRE: Vector = [0.0, -14.0, 4.0];
/// Tolerance of the hull.
const NEAREST: f64 = 1e-9;

/// Returns the triangles of the left half over the points `stored`, of which those below `middles` are in the middle.
pub fn triangles(points: &[Vector], stored: &[usize], middles: usize) -> Vec<Triangle> {
    // A hull of both halves has edges along the middle wherever two neighbours in the middle are close enough.
    let mut indices = stored.to_vec();
    let images: Vec<(usize, Vector)> =
        stored.iter().filter(|&&index| index >= middles).map(|&index| (index, mirror(points[index]))).collect();
    let mut directions: Vec<Vector> = stored.iter().map(|&index| unit(minus(points[index], CENTRE))).collect();
    for (index, image) in images {
        indices.push(index);
        directions.push(unit(minus(image, CENTRE)));
    }
    let half = stored.len();
    let all = hull(&directions);
    let left = all.into_iter().filter(|triangle| triangle.iter().all(|&corner| corner < half));
    left.map(|triangle| triangle.map(|corner| indices[corner])).collect()
}

/// Returns the triangles of the convex hull of unit vectors.
fn hull(points: &[Vector]) -> Vec<Triangle> {
    let mut faces = first(points);
    for index in 0..points.len() {
        let sees = |face: &Triangle| {
            let [a, b, c] = face.map(|corner| points[corner]);
            dot(cross(minus(b, a), minus(c, a)), minus(points[index], a)) > NEAREST
        };
        let (seen, kept): (Vec<Triangle>, Vec<Triangle>) = faces.into_iter().partition(sees);
        faces = kept;
        let edges: Vec<[usize; 2]> = seen.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
        let border = edges.iter().filter(|&&[a, b]| !edges.contains(&[b, a]));
        faces.extend(border.map(|&[a, b]| [a, b, index]));
    }
    faces
}

/// Returns a tetrahedron to start with.
fn first(points: &[Vector]) -> Vec<Triangle> {
    let farthest =
        |way: Vector| (0..points.len()).max_by(|&a, &b| dot(points[a], way).total_cmp(&dot(points[b], way))).unwrap_or(0);
    let corners = [[1.0, 0.3, 0.2], [-1.0, 0.3, 0.25], [0.1, -1.0, 0.6], [0.05, -0.4, -1.0]].map(farthest);
    let [a, b, c, d] = corners;
    let outwards = |[a, b, c]: Triangle, inside: usize| {
        let volume = dot(cross(minus(points[b], points[a]), minus(points[c], points[a])), minus(points[inside], points[a]));
        if volume > 0.0 { [a, c, b] } else { [a, b, c] }
    };
    vec![outwards([a, b, c], d), outwards([a, b, d], c), outwards([a, c, d], b), outwards([b, c, d], a)]
}

/// Returns unit normals of the skin's points, the means of the triangles around them weighted by area; others are 0.
pub fn normals(head: &Head) -> Vec<Vector> {
    let mut sums = vec![[0.0; 3]; head.points.len()];
    for &triangle in &head.triangles {
        let image = [triangle[0], triangle[2], triangle[1]].map(|corner| head.mirror(corner));
        for triangle in [triangle, image] {
            let [a, b, c] = triangle.map(|corner| head.points[corner]);
            let normal = cross(minus(b, a), minus(c, a));
            for corner in triangle {
                sums[corner] = [0, 1, 2].map(|axis| sums[corner][axis] + normal[axis]);
            }
        }
    }
    sums.into_iter().map(|sum| if dot(sum, sum) > 0.0 { unit(sum) } else { sum }).collect()
}

/// The mean normal of the three skin points nearest to `place`.
pub fn normal_near(head: &Head, stored: &[usize], place: Vector) -> Vector {
    let away = |index: usize| dot(minus(head.points[index], place), minus(head.points[index], place));
    let mut nearest = stored.to_vec();
    nearest.sort_by(|&a, &b| away(a).total_cmp(&away(b)));
    let sum = nearest.iter().take(3).fold([0.0; 3], |sum, &index| [0, 1, 2].map(|axis| sum[axis] + head.normals[index][axis]));
    unit(if place[0] == 0.0 { [0.0, sum[1], sum[2]] } else { sum })
}
