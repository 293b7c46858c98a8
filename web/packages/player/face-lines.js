// The lines of a face: the firmware's face code (pantin-face) in JavaScript for its own model, with the same integers bit for bit. Its modules explain each step and
// state the bounds by which products fit 32 bits; here they are named in brackets. Lengths are steps of the model, and sixteenths of a pixel.

const UNIT = 1 << 15;
const HEAD_SHAPE = 2;
const [EASED, SPHERICAL] = [1, 2];
// [morph] Smaller factors move no vertex by more than 16 steps.
const LEAST_FACTOR = 32;
// [binding] Shapes that scalars drive together, at most.
const MOST_DRIVES = 80;
// [strokes] Brightness of the mesh and the outline; and curves end where the cosine between normal and camera falls below this, in 127ths.
const [MESH, OUTLINE] = [44, 200];
const GRAZING = 4;
// [strokes] Weights of four vertices for the points that are drawn between the second and the third of them, at details 0 to 3.
const HALVED = [-8, 72, 72, -8];
const QUARTERED = [[-9, 111, 29, -3], HALVED, [-3, 29, 111, -9]];
const FINE = [[], [HALVED], QUARTERED, QUARTERED];
// [camera] Heights of the face in pixels from which on details 1, 2 and 3 apply.
const DETAILS = [96, 150, 190];
// [opening_clip] Vertices of an edge, at most.
const EDGE = 10;

const within = (value, least, most) => Math.max(least, Math.min(most, value));
// The lower three bytes.
const hashOf = (bytes) => bytes.reduce((hash, byte) => Math.imul(hash ^ byte, 0x1000193), 0x811c9dc5) & 0xffffff;
const summed = (a, b) => (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) | 0;

// [checked] What a model's bytes say; an index takes one byte, the hash of a name three in place of four.
function modelOf(bytes) {
  let at = 3;
  const u8 = () => bytes[at++];
  const u16 = () => u8() + 256 * u8();
  const i8 = () => (u8() << 24) >> 24;
  const i16 = () => (u16() << 16) >> 16;
  const list = (length, of) => Array.from({ length }, of);
  const take = () => list(u8(), u8);
  const each = (bytes, of) => {
    const found = [];
    for (const end = at + bytes; at < end; ) found.push(of());
    return found;
  };
  const [middles, pairs, , , triangleCount, outline, names] = list(7, u16);
  const [fixed, curves, openings, shapes] = list(4, u8);
  const stored = middles + pairs;
  const image = (index) => (index < middles ? index : index < stored ? index + pairs : index - pairs);
  // A triangle is stored as the differences of its corners from those of the one before.
  let corners = [0, 0, 0];
  const model = {
    middles, pairs, stored, image,
    points: list(stored, () => list(3, i16)),
    normals: list(stored, () => list(3, i8)),
    // Those whose silhouette is the outline, and all; each with its mirror image.
    triangles: list(triangleCount, () => (corners = corners.map((index) => (index + u8()) & 255))).flatMap(([a, b, c]) => [[a, b, c], [image(a), image(c), image(b)]]),
    outline: 2 * outline,
    fixed: list(fixed, u8),
    curves: list(curves, () => {
      const [flags, shade] = [u8(), u8()];
      return { isClosed: flags & 1, isMirrored: flags & 2, detail: (flags >> 2) & 3, isSmall: flags & 32, shade, vertices: take() };
    }),
    openings: list(openings, () => {
      const [isMirrored, release, drop] = [u8(), u8(), i16()];
      const parts = list(3, u8).map((count) => list(count, u8));
      return { isMirrored, release, drop, parts };
    }),
    shapes: list(shapes, () => {
      const [head, scale, deltas, rotations] = [u8(), u16(), u16(), u16()];
      const runs = each(deltas, () => ({ first: u8(), deltas: list(u8(), () => list(3, i8)) }));
      const turns = each(rotations, () => {
        const [axis, count] = [u8(), u8()];
        return { axis, centre: list(3, i16), angle: i16(), members: list(count, () => list(3, u8)) };
      });
      return { interpolation: head & 3, kind: head >> 2, scale, runs, turns };
    }),
    // What a name drives, by its hash: shape and sides in one byte, and the value's factor.
    names: new Map(),
  };
  for (let count = names; count--; ) {
    const hash = u16() + 65536 * u8();
    model.names.set(hash, [...(model.names.get(hash) ?? []), [u8(), i8(), i8()]]);
  }
  model.neutral = [...model.points, ...model.points.slice(middles).map(([x, y, z]) => [-x, y, z])].flat();
  return model;
}

// [rig] The scalars of a rig: hashes of their names, and exponents. `listed` are the names that rigs refer to by number.
function scalarsOf(bytes, count, listed) {
  const found = [];
  const letters = new TextEncoder();
  let at = 0;
  const i8 = () => (bytes[at++] << 24) >> 24;
  while (found.length < count) {
    let exponent = i8();
    if (exponent < 127) {
      let length = 0;
      for (let shift = 0, byte = 128; byte > 127; shift += 7) length |= ((byte = bytes[at++]) & 127) << shift;
      found.push([hashOf(bytes.subarray(at, (at += length))), exponent]);
    } else {
      let index = bytes[at++];
      const last = index + bytes[at++];
      for (exponent = i8(); index <= last && found.length < count; index++) found.push([hashOf(letters.encode(listed[index] ?? "")), exponent]);
    }
  }
  return found;
}

let model;

/**
 * The face that scalars drive: `bytes` are those of the model, `scalars` those of the rig from the first of `count` on, and `first` is its channel. `maths` is that of figure.js.
 * Nothing if the scalars are not those of a face.
 */
export function faceLinesOf(bytes, scalars, count, first, listed, [turnAbout, sines, imageOf]) {
  model ??= modelOf(bytes);
  const { middles, pairs, stored, image, neutral } = model;
  // [binding]
  const drives = [];
  let driving = 0;
  scalarsOf(scalars, count, listed).forEach(([hash, exponent], index) => {
    const entries = model.names.get(hash) ?? [];
    driving += entries.length > 0;
    for (const [target, mantissa, shift] of entries) if (drives.length < MOST_DRIVES) drives.push([first + index, target, mantissa, within(shift + exponent, -128, 127)]);
  });
  if (driving < 3 && !(driving && driving === count)) return;

  const vertices = new Int16Array(neutral.length);
  const points = new Int16Array(2 * (stored + pairs));
  const facing = new Int8Array(stored + pairs);
  let weights;
  let angles;
  let pivot;
  // [weights] Pairs in Q14, for the side that is stored and its mirror image, and the same in Q15 as they are used.
  const read = (raw) => {
    weights = model.shapes.map(() => [0, 0]);
    for (const [channel, target, mantissa, shift] of drives) {
      const value = ((raw[channel] ?? 0) >> 16) * mantissa;
      const shifted = shift < -30 ? 0 : shift < 0 ? value >> -shift : shift < 8 ? value << shift : Math.sign(value) * 2 * UNIT;
      const weight = within(within(shifted, -2 * UNIT, 2 * UNIT) >> 1, -UNIT, UNIT - 1);
      for (const side of [0, 1]) if (target & (64 << side)) weights[target & 63][side] = within(weights[target & 63][side] + weight, -UNIT, UNIT - 1);
    }
    weights = weights.map((pair) => pair.map((weight) => within(weight << 1, -UNIT, UNIT)));
  };
  // [shape] The part of its distance that a vertex has moved at a weight.
  const eased = (interpolation, weight) => {
    if (interpolation !== EASED) return sines(weight << 15)[0];
    const part = (UNIT - sines(weight << 16)[1]) >> 1;
    return weight < 0 ? -part : part;
  };
  const addRun = (deltas, first, across, factor) => {
    deltas.flat().forEach((delta, index) => (vertices[3 * first + index] += (delta * (index % 3 ? factor : across) + 128) >> 8));
  };
  // [rotate] Cosine and sine of a part of an angle at a weight, or what a line between both ends has in their place.
  const coefficients = (angle, part, interpolation, weight) => {
    const some = (angle * (part + (part >> 7))) >> 8;
    if (interpolation === SPHERICAL) return sines((some * weight) << 1);
    const moved = eased(interpolation, weight);
    const [sine, cosine] = sines(some << 16);
    return [(moved * sine) >> 15, UNIT + ((Math.abs(moved) * ((cosine - UNIT) >> 1)) >> 14)];
  };
  const rotate = ({ axis, centre, members, angle }, interpolation, [own, mirrored]) => {
    const [b, c] = [(axis + 1) % 3, (axis + 2) % 3];
    const turn = (first, count, part, weight, sign) => {
      if (!weight) return;
      const [sine, cosine] = coefficients(axis ? angle * sign : angle, part, interpolation, weight);
      const about = [centre[0] * sign, centre[1], centre[2]];
      for (let index = first; index < first + count; index++) {
        const [fromB, fromC] = [b, c].map((axis) => vertices[3 * index + axis] - about[axis]);
        vertices[3 * index + b] = ((fromB * cosine - fromC * sine + UNIT / 2) >> 15) + about[b];
        vertices[3 * index + c] = ((fromC * cosine + fromB * sine + UNIT / 2) >> 15) + about[c];
      }
    };
    for (const [first, count, part] of members) {
      if (first < middles) turn(first, count, part, (own + mirrored) >> 1, 1);
      else turn(first, count, part, own, 1), turn(image(first), count, part, mirrored, -1);
    }
  };
  // [morph]
  const apply = () => {
    vertices.set(neutral);
    [angles, pivot] = [[0, 0, 0], [0, 0, 0]];
    model.shapes.forEach(({ kind, interpolation, scale, runs, turns }, index) => {
      const pair = kind ? weights[index] : weights[index].map((weight) => Math.max(0, weight));
      if (kind === HEAD_SHAPE) {
        for (const { axis, centre, angle } of turns) {
          pivot = centre;
          angles[axis] = (angles[axis] + ((angle * pair[0]) << 1)) | 0;
        }
        return;
      }
      if (!pair[0] && !pair[1]) return;
      const [own, mirrored] = pair.map((weight) => (runs.length ? (eased(interpolation, weight) * scale) >> 15 : 0));
      for (const { first, deltas } of runs) {
        if (Math.abs(own) >= LEAST_FACTOR) addRun(deltas, first, own, own);
        if (Math.abs(mirrored) >= LEAST_FACTOR) addRun(deltas, image(first), -mirrored, mirrored);
      }
      for (const turn of turns) rotate(turn, interpolation, pair);
    });
  };

  // [opening_clip] What lies behind lids and lips is drawn no farther than the edges of their opening.
  const edgeOf = (indices) => {
    const ends = indices.slice(0, EDGE).map((index) => [vertices[3 * index], vertices[3 * index + 1]]);
    const inner = ends.slice(1, -1);
    const all = (axis, some) => some.map((end) => end[axis]);
    const [least, most] = [Math.min(...all(0, inner)), Math.max(...all(0, inner))];
    return {
      least: Math.min(...all(0, ends)), most: Math.max(...all(0, ends)), lowest: Math.min(...all(1, inner)), highest: Math.max(...all(1, inner)),
      holds: (x) => least <= x && x <= most,
      // By bisection.
      height(x) {
        const next = ends.findIndex((to, index) => index && Math.min(ends[index - 1][0], to[0]) <= x && x <= Math.max(ends[index - 1][0], to[0]));
        if (next < 0) return ends.at(-1)[1];
        let [from, to] = [ends[next - 1], ends[next]];
        if (from[0] > to[0]) [from, to] = [to, from];
        for (let times = 4; times--; ) {
          const middle = [(from[0] + to[0]) >> 1, (from[1] + to[1]) >> 1];
          if (x <= middle[0]) to = middle;
          else from = middle;
        }
        return (from[1] + to[1]) >> 1;
      },
    };
  };
  const clip = () => {
    for (const { isMirrored, release, drop, parts } of model.openings) {
      const released = (drop * Math.max(0, weights[release]?.[0] ?? 0)) >> 15;
      for (const [upper, lower, members] of [parts, ...(isMirrored ? [parts.map((indices) => indices.map(image))] : [])]) {
        const [above, below] = [upper, lower].map(edgeOf);
        for (const index of members) {
          const x = Math.min(Math.max(vertices[3 * index], above.least), above.most);
          let y = vertices[3 * index + 1];
          if (!above.holds(x) || y > above.lowest) y = Math.min(y, above.height(x));
          if (!below.holds(x) || y < below.highest) y = Math.max(y, below.height(x) - released);
          vertices[3 * index] = x;
          vertices[3 * index + 1] = y;
        }
      }
    }
  };

  // [camera, projection]
  let rows, scale, shift, nearer, middle, centre, detail;
  const still = () => [UNIT, 0, 0, 0, UNIT, 0, 0, 0, UNIT];
  const rowTimes = (row, turns) => [0, 3, 6].map((column) => (summed(row, turns.slice(column, column + 3)) + UNIT / 2) >> 15);
  const headOf = ([x, y, z]) => {
    const turns = still();
    [[1, y], [0, x], [2, z]].forEach(([axis, angle]) => turnAbout(turns, 0, axis, angle));
    return turns;
  };
  const projection = (head, offset) => {
    const scaled = (row) => row.map((x) => (x * scale + UNIT / 2) >> 15);
    const flat = [rows[0], rows[1].map((x) => -x)];
    const across = flat.map((row) => scaled(rowTimes(row, head)));
    const moved = flat.map((row) => (summed(scaled(row), offset) + ((1 << shift) >> 1)) | 0);
    const towards = rowTimes(rows[2], head);
    return (index) => {
      const vertex = vertices.subarray(3 * index, 3 * index + 3);
      const magnification = 4096 + (((summed(towards, vertex) >> 15) * nearer) >> 16);
      for (const axis of [0, 1]) points[2 * index + axis] = (Math.imul((summed(across[axis], vertex) + moved[axis]) >> shift, magnification) >> 12) + centre[axis];
    };
  };
  const project = () => {
    // Facing and outline depend on the head's rotation alone, rounded to 5.6 degrees.
    const towards = rowTimes(rows[2], headOf(angles.map((angle) => (((angle >> 25) + 1) >> 1) << 26)));
    model.normals.forEach((normal, index) => {
      const across = towards[0] * normal[0];
      const along = towards[1] * normal[1] + towards[2] * normal[2];
      facing[index] = (along + across) >> 15;
      if (index >= middles) facing[index + pairs] = (along - across) >> 15;
    });
    const head = headOf(angles);
    const carried = imageOf(head, pivot);
    const whole = projection(head, pivot.map((x, axis) => x - carried[axis] - middle[axis]));
    facing.forEach((_, index) => whole(index));
    model.fixed.forEach(projection(still(), middle.map((x) => -x)));
  };

  return {
    // The camera for a part of the picture of these pixels, `right` of its left edge, seen from degrees around the face and above the horizon.
    aim(width, height, right, orbit, tilt) {
      const turns = still();
      [[0, tilt], [1, -orbit]].forEach(([axis, degrees]) => turnAbout(turns, 0, axis, Math.imul(degrees, 11930465)));
      rows = [0, 1, 2].map((row) => [turns[row], turns[row + 3], turns[row + 6]]);
      const all = (axis) => model.points.map((point) => point[axis]);
      const high = Math.max(...all(1));
      const [tall, wide] = [high - Math.min(...all(1)), 2 * Math.max(...all(0).map(Math.abs))];
      const [columns, lines] = [width, height].map((pixels) => within(pixels, 1, 2047) * 16);
      const fit = (available, size) => Math.floor((Math.min(available, 65536) << 14) / size) << 2;
      const full = within(Math.min(fit(Math.floor((lines * 60) / 64), tall), fit(columns, wide)), 1, 1 << 20);
      const excess = Math.max(0, 17 - Math.clz32(full));
      const covered = ((tall >> 4) * (full >> 4)) >> 12;
      detail = DETAILS.filter((least) => covered >= least).length;
      [scale, shift, nearer] = [full >> excess, 16 - excess, Math.min(Math.floor(2 ** 28 / (tall << 2)), 1 << 14)];
      middle = [0, high - Math.floor(tall / 60) * 31, 0];
      centre = [columns / 2 + 16 * right, lines / 2];
    },
    // Passes the lines of a pose, the brighter ones after the darker ones.
    each(raw, stroke) {
      read(raw);
      apply();
      clip();
      project();
      let shade = MESH;
      const line = (from, to) => stroke(from[0], from[1], to[0], to[1], shade, 1, 1);
      const end = (index) => [points[2 * index], points[2 * index + 1], facing[index]];
      const crossing = (from, to) => (Math.abs(from) * Math.floor(UNIT / Math.abs(from - to))) >> 7;
      const between = (from, to, part) => [0, 1].map((axis) => from[axis] + (((to[axis] - from[axis]) * part) >> 8));
      const cut = (from, to) => between(from, to, crossing(from[2] - GRAZING, to[2] - GRAZING));
      // The part of a line that faces the camera.
      const visible = (from, to) => {
        if (from[2] > GRAZING) line(from, to[2] > GRAZING ? to : cut(from, to));
        else if (to[2] > GRAZING) line(to, cut(to, from));
      };
      if (detail > 2) {
        for (const corners of model.triangles) {
          const ends = corners.map(end);
          if (ends.every(([, , cosine]) => cosine <= GRAZING)) continue;
          for (const [from, to] of [[0, 1], [1, 2], [2, 0]]) if (corners[from] < corners[to]) visible(ends[from], ends[to]);
        }
      }
      // [outline] A line through each triangle that has corners on both sides.
      shade = OUTLINE;
      for (const [x, y, z] of model.triangles.slice(0, model.outline)) {
        const [a, b, c] = [x, y, z].map((index) => facing[index] < 0);
        if (a === b && a === c) continue;
        const [apex, ...others] = (a === b ? [z, x, y] : a === c ? [y, z, x] : [x, y, z]).map(end);
        line(...others.map((other) => between(apex, other, Math.min(255, crossing(apex[2], other[2])))));
      }
      for (const { isClosed, isMirrored, detail: least, isSmall, shade: own, vertices: indices } of model.curves) {
        if (least > detail || (isSmall && detail)) continue;
        shade = own;
        for (const curve of [indices, ...(isMirrored ? [indices.map(image)] : [])]) {
          const last = curve.length - 1;
          const at = (position) => end(curve[isClosed ? (position + curve.length) % curve.length : within(position, 0, last)]);
          for (let segment = 0; segment < last + isClosed; segment++) {
            const ends = [-1, 0, 1, 2].map((next) => at(segment + next));
            const [, from, to] = ends;
            let before = from;
            if (from[2] <= GRAZING && to[2] <= GRAZING) continue;
            for (const factors of FINE[detail]) {
              const quarters = factors[1] > factors[2] ? 1 : factors[1] < factors[2] ? 3 : 2;
              const next = [0, 1].map((axis) => ends.reduce((sum, end, index) => sum + end[axis] * factors[index], 64) >> 7);
              visible(before, (before = [...next, from[2] + (((to[2] - from[2]) * quarters) >> 2)]));
            }
            visible(before, to);
          }
        }
      }
    },
  };
}
