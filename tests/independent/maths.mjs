// Rotations as nine numbers, row by row, and affine maps as { turn, place }: what the readers of motions and the player of clips share.

export const IDENTITY = [1, 0, 0, 0, 1, 0, 0, 0, 1];
export const ORIGIN = [0, 0, 0];
export const UNMOVED = { turn: IDENTITY, place: ORIGIN };

export const radians = (degrees) => (degrees * Math.PI) / 180;
export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scaled = (a, factor) => [a[0] * factor, a[1] * factor, a[2] * factor];
export const length = (a) => Math.hypot(a[0], a[1], a[2]);

/** The map `b`, then the map `a`. */
export function product(a, b) {
  const c = new Array(9);
  for (let i = 0; i < 9; i += 3) for (let j = 0; j < 3; j++) c[i + j] = a[i] * b[j] + a[i + 1] * b[j + 3] + a[i + 2] * b[j + 6];
  return c;
}

export const transposed = (m) => [m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]];
export const applied = (m, v) => [0, 3, 6].map((i) => m[i] * v[0] + m[i + 1] * v[1] + m[i + 2] * v[2]);
export const diagonal = ([x, y, z]) => [x, 0, 0, 0, y, 0, 0, 0, z];
export const column = (m, axis) => [m[axis], m[axis + 3], m[axis + 6]];

/** `own` in what `above` moves. */
export const chained = (above, own) => ({ turn: product(above.turn, own.turn), place: add(above.place, applied(above.turn, own.place)) });

/** The rotation by `angle` radians about the x, y or z axis (0, 1, 2). */
export function aboutAxis(axis, angle) {
  const [sine, cosine] = [Math.sin(angle), Math.cos(angle)], m = [...IDENTITY], [j, k] = [(axis + 1) % 3, (axis + 2) % 3];
  m[4 * j] = m[4 * k] = cosine;
  m[3 * j + k] = -sine;
  m[3 * k + j] = sine;
  return m;
}

/** The rotation of a quaternion of any length; length 0 turns nothing. */
export function ofQuaternion([x, y, z, w]) {
  const square = x * x + y * y + z * z + w * w;
  if (square === 0) return IDENTITY;
  const s = 2 / square;
  return [
    1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),
    s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x),
    s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y),
  ];
}

/** The rotation about `axis`, of any length but 0, by `angle` radians. */
export function aboutVector(axis, angle) {
  const size = length(axis);
  return size === 0 ? IDENTITY : ofQuaternion([...scaled(axis, Math.sin(angle / 2) / size), Math.cos(angle / 2)]);
}

/** The exponential map: about a vector, by its length in radians. */
export const ofExponential = (vector) => aboutVector(vector, length(vector));

/** The angle in degrees between two rotations: the sine from the part of their quotient that changes its sign, the cosine from its trace. */
export function angleBetween(a, b) {
  const q = product(transposed(a), b), sine = Math.hypot(q[7] - q[5], q[2] - q[6], q[3] - q[1]);
  return (Math.atan2(sine, q[0] + q[4] + q[8] - 1) * 180) / Math.PI;
}

/** The rotation nearest to a linear map whose columns are brought to length 1 first; of a mirroring map, that of its opposite. `null` if a column is 0. */
export function nearestRotation(linear) {
  const lengths = [0, 1, 2].map((axis) => length(column(linear, axis)));
  if (!lengths.every((size) => size > 1e-9 * Math.max(...lengths))) return null;
  let m = product(linear, diagonal(lengths.map((size) => 1 / size)));
  if (determinant(m) < 0) m = scaledMap(m, -1);
  for (let change = 1, rounds = 0; change > 1e-15 && rounds < 50; rounds++) {
    const next = transposed(inverse(m)).map((entry, i) => (entry + m[i]) / 2);
    change = Math.max(...next.map((entry, i) => Math.abs(entry - m[i])));
    m = next;
  }
  return m;
}

const scaledMap = (m, factor) => m.map((entry) => entry * factor);

export function determinant(m) {
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
}

export function inverse(m) {
  const minor = (a, b, c, d) => m[a] * m[d] - m[b] * m[c];
  const adjugate = [
    minor(4, 5, 7, 8), minor(2, 1, 8, 7), minor(1, 2, 4, 5),
    minor(5, 3, 8, 6), minor(0, 2, 6, 8), minor(2, 0, 5, 3),
    minor(3, 4, 6, 7), minor(1, 0, 7, 6), minor(0, 1, 3, 4),
  ];
  return scaledMap(adjugate, 1 / determinant(m));
}
