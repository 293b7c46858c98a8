// The figure of a clip in lines: the firmware's figure code (pantin-figure) in JavaScript, with the same integers bit for bit. Its modules explain each step and state
// the bounds by which products fit 32 bits; here they are named in brackets.

// Sixteenths of a pixel, and other fixed-point numbers: 1 is 2^15.
const ONE = 1 << 15;
const HALF = ONE / 2;
const QUARTER_TURN = Math.PI / 2;
// Poses that the camera looks at before it knows its scale, and the scale at which it does.
const SAMPLES = 48;
// Of a clip with more bytes of motion, only the first of equal parts that are no larger is looked at.
const SURVEYED_BYTES = 16384;
const TRIAL = 1 << 14;
const LONGEST_ROW = 37000;
const DISTANCE = 4;
const GROUND_ROWS = 5;
const DOT_ROWS = 7;
// A picture of fewer pixels has dots on the ground in place of lines.
const DOTTED = 45000;
// Parts of the picture: a head is a circle, and a dot a point.
const GROUND = 0;
const MIDDLE = 1;
const LEFT = 2;
const RIGHT = 3;
const HEAD = 4;
const DOT = 5;
// What turns a joint, besides 0 to 2, a turn about x, y or z.
const OFFSET = 3;
const EXPONENTIAL = 4;
const QUATERNION = 5;

const clamp = (value, least, most) => Math.max(least, Math.min(most, value));
const bitLength = (value) => 32 - Math.clz32(value);
const rootOf = (square) => Math.floor(Math.sqrt(square));
const squareOf = (vector) => vector.reduce((sum, x) => sum + x * x, 0);
const anyBit = (vector) => vector.reduce((all, x) => all | Math.abs(x), 0);
const axes = (of) => [of(0), of(1), of(2)];
// value / 2^shift, rounded.
const shifted = (value, shift) => {
  if (shift > 31) return 0;
  if (shift > 0) return ((value >> (shift - 1)) + 1) >> 1;
  return clamp(value * 2 ** -shift, 1 - 2 ** 31, 2 ** 31 - 1);
};
const lengthOf = (vector) => {
  const shift = Math.max(0, bitLength(anyBit(vector)) - 15);
  return rootOf(squareOf(vector.map((x) => x >> shift))) << shift;
};
const crossed = (a, b) => axes((axis) => (a[(axis + 1) % 3] * b[(axis + 2) % 3] - a[(axis + 2) % 3] * b[(axis + 1) % 3]) >> 15);

// [trig, rotation] Tables of what a function makes of each index.
const tableOf = (length, of) => Array.from({ length }, (_, index) => of(index));
const Q22 = 2 ** 22;
const CIRCLE = tableOf(128, (index) => Math.round(Math.sin((index * Math.PI) / 64) * Q22));
const ROOTS = tableOf(386, (index) => Math.round(Q22 / Math.sqrt(1 + index / 128)));
const HALF_ANGLES = tableOf(194, (index) => {
  const half = (Math.sqrt(index) / 8) * QUARTER_TURN;
  return [Math.round(Math.cos(half) * Q22), Math.round((QUARTER_TURN * (index ? Math.sin(half) / half : 1) * Q22) / 2)];
});
let sine = 0;
let cosine = 0;
const turnTo = (angle) => {
  const nearest = angle + (1 << 24);
  const near = CIRCLE[nearest >>> 25];
  const along = CIRCLE[((nearest >>> 25) + 32) & 127];
  const rest = ((((nearest >>> 9) & 0xffff) - ONE) * 25736) >> 15;
  const square = (rest * rest) >> 14;
  sine = (near + (((along >> 7) * rest) >> 13) - (((near >> 7) * square) >> 20) + 64) >> 7;
  cosine = (along - (((near >> 7) * rest) >> 13) - (((along >> 7) * square) >> 20) + 64) >> 7;
};

// Rotations are nine numbers in one array, the images of x, y and z; `at` is where one begins. Images of vectors are left in IMAGE.
const IMAGE = [0, 0, 0];
const image = (turns, at, x, y, z) => {
  for (let row = 0; row < 3; row++) IMAGE[row] = (turns[at + row] * x + turns[at + row + 3] * y + turns[at + row + 6] * z + HALF) >> 15;
};
const isSmall = (x) => x >= -TRIAL && x < TRIAL;
// Of a vector of any length, in two halves.
const imageOfAny = (turns, at, x, y, z) => {
  if (isSmall(x) && isSmall(y) && isSmall(z)) return image(turns, at, x, y, z);
  const parts = [x, y, z].map((value) => clamp(value, -(2 ** 29), 2 ** 29) >> 15);
  image(turns, at, x & (ONE - 1), y & (ONE - 1), z & (ONE - 1));
  for (let row = 0; row < 3; row++) IMAGE[row] += turns[at + row] * parts[0] + turns[at + row + 3] * parts[1] + turns[at + row + 6] * parts[2];
};
const turnAbout = (turns, at, axis, angle) => {
  if (!angle) return;
  turnTo(angle);
  for (let b = at + ((axis + 1) % 3) * 3, c = at + ((axis + 2) % 3) * 3, row = 3; row--; b++, c++) {
    const from = turns[b];
    turns[b] = (from * cosine + turns[c] * sine + HALF) >> 15;
    turns[c] = (turns[c] * cosine - from * sine + HALF) >> 15;
  }
};
// What a face is drawn with, too: a turn about an axis, sine and cosine, and the image of a vector.
export const maths = [turnAbout, (angle) => (turnTo(angle), [sine, cosine]), (turns, v) => (imageOfAny(turns, 0, ...v), [...IMAGE])];
const scaledBy = (x, scale) => (x * (scale >> 7) + ((x * (scale & 127)) >> 7) + HALF) >> 15;
// Turns by a quaternion of length 1.
const turnByUnit = (turns, at, w, x, y, z) => {
  const twice = (value) => (value + (1 << 13)) >> 14;
  const local = [
    ONE - twice(y * y + z * z), twice(x * y + w * z), twice(x * z - w * y), twice(x * y - w * z), ONE - twice(x * x + z * z), twice(y * z + w * x),
    twice(x * z + w * y), twice(y * z - w * x), ONE - twice(x * x + y * y),
  ];
  const columns = [0, 3, 6].map((column) => (image(turns, at, local[column], local[column + 1], local[column + 2]), [...IMAGE])).flat();
  columns.forEach((value, index) => (turns[at + index] = value));
};
const turnByExponential = (turns, at, map) => {
  const square = map.reduce((sum, x) => Math.max(0, sum + (x >> 16) * (x >> 16) + (((x >> 16) * ((x >> 4) & 0xfff)) >> 11)), 0);
  const entry = HALF_ANGLES[square >>> 24];
  const next = HALF_ANGLES[(square >>> 24) + 1];
  const [w, scale] = entry.map((from, index) => from + (((next[index] - from) * ((square >>> 12) & 0xfff)) >> 12));
  turnByUnit(turns, at, shifted(w, 7), ...map.map((x) => scaledBy(shifted(x, 15), scale)));
};
const turnByQuaternion = (turns, at, q) => {
  const largest = anyBit(q);
  if (!largest) return;
  let shift = bitLength(largest) - 15;
  const all = () => q.map((x) => shifted(x, shift));
  if (squareOf(all()) < 2 ** 30) shift--;
  const above = Math.min(3 * 2 ** 30 - 1, squareOf(all()) - 2 ** 30);
  const root = ROOTS[above >>> 23];
  const inverse = root + (((ROOTS[(above >>> 23) + 1] - root) * ((above >>> 8) & 0x7fff)) >> 15);
  turnByUnit(turns, at, ...all().map((x) => scaledBy(x, inverse)));
};

// [names] For two names that differ in their side's word alone: whether the first one is the left one.
const sideOf = (name) => /^(left|right|l|r)(.*)/s.exec(name);
const isLeftOf = (a, b) => {
  let same = 0;
  while (same < a.length && a[same] === b[same]) same++;
  const one = sideOf(a.slice(same));
  const other = sideOf(b.slice(same));
  if (one && other && one[1][0] !== other[1][0] && one[2] === other[2]) return one[1][0] === "l";
};

// [joint_info, skeleton] The bones that make a clear picture, as a pose places them: no fingers but the longest, nothing in the head, nothing too short to see.
const skeletonOf = (clip, raw) => {
  const { rig } = clip;
  const { joints } = rig;
  const isPosition = (kind) => kind < 3;
  const hips = +(joints.filter(({ parent, isHelper }) => !parent && !isHelper).length === 1 && joints[1].kinds.filter(isPosition).length === 3 && !anyBit(joints[1].rest));
  // Components of a bone, and the exponents of their units.
  const bones = joints.map(({ rest, kinds, first }) => {
    const bone = rest.map((value) => [value, rig.exponent]);
    kinds.forEach((kind, index) => isPosition(kind) && (bone[kind] = [raw[first + index], clip.exponent]));
    return bone;
  });
  let longest = -Infinity;
  bones.slice(hips + 1).flat().forEach(([value, exponent]) => value && (longest = Math.max(longest, exponent + bitLength(Math.abs(value)))));
  const unit = (longest > -Infinity ? longest : 0) - 14;
  let hasHead = false;
  const infos = joints.map(({ name, parent, isHelper }, index) => {
    const isPlace = index <= hips;
    const isHead = !hasHead && /head/i.test(name);
    hasHead ||= isHead;
    const bone = bones[index].map(([value, exponent]) => (isPlace || isHelper ? 0 : shifted(value, unit - exponent)));
    return { index, name: name.toLowerCase(), parent, isPlace, isHead, bone, length: lengthOf(bone), isKept: !isHelper, reach: 0, longest: -1, children: [], finger: -1, weight: 0 };
  });
  const backwards = [...infos].reverse();
  for (const info of infos) {
    info.above = infos[info.parent];
    if (info.above && !info.above.isKept) Object.assign(info, { isKept: false, length: 0 });
  }
  for (const { above, index, reach, length } of backwards) {
    if (!above) continue;
    above.children.push(infos[index]);
    const chain = Math.min(65535, reach + (length >> 3));
    if (chain >= above.reach) Object.assign(above, { reach: chain, longest: index });
  }
  const reach = infos[hips].reach * 8;
  const size = reach ? reach + (reach >> 2) : TRIAL;
  const eighths = size >> 3;
  for (const info of infos) {
    const { above, index } = info;
    if (!above) continue;
    const finger = above.children.length > 1 && above.reach < Math.floor(eighths / 6) ? 0 : above.finger;
    info.isKept &&= above.isKept && !above.isHead && (finger < 0 || (above.longest === index && above.finger < Math.floor(eighths / 25)));
    info.finger = finger < 0 ? finger : Math.min(65534, finger + (info.length >> 3));
  }
  for (const info of backwards) {
    info.isKept &&= info.isPlace || info.isHead || info.weight > 0 || info.length >= size >> 6;
    info.weight += info.isKept;
    if (info.above) info.above.weight += info.weight;
  }
  const kept = infos.filter(({ isKept }) => isKept);
  const found = [];
  const result = { unit, size, hips, sides: null, bones: found, radius: 0 };
  let best = Infinity;
  // Parents first; of siblings, the one with most on it last.
  const add = (info) => {
    const { index, above, bone, length, isHead, isPlace } = info;
    const { kinds, first } = joints[index];
    const own = clip.joints[index].kinds;
    const drives = [];
    const channel = (kind) => (kinds.indexOf(kind) < 0 ? -1 : first + kinds.indexOf(kind));
    const group = (act, ...kinds) => kinds.map(channel).some((at) => at >= 0) && drives.push([act, ...kinds.map(channel)]);
    const isMoved = kinds.some(isPosition);
    group(OFFSET, 0, 1, 2);
    const coded = kinds.flatMap((kind, index) => (kind > 2 && kind < 6 ? (own[index] === kind ? (drives.push([kind - 3, first + index]), []) : first + index) : []));
    if (coded.length) drives.push([EXPONENTIAL, ...coded]);
    group(QUATERNION, 6, 7, 8, 9);
    group(EXPONENTIAL, 10, 11, 12);
    let part = above ? found[above.at].part : MIDDLE;
    let isLeft;
    const other = kept.find((other) => other !== info && (isLeft = isLeftOf(info.name, other.name)) !== undefined);
    if (other) {
      part = isLeft ? LEFT : RIGHT;
      const pair = Math.min(index, other.index) * 256 + Math.max(index, other.index);
      if (pair < best && `${bone}` !== `${other.bone}`) {
        best = pair;
        result.sides = isLeft ? [info, other] : [other, info];
      }
    }
    info.at = found.length;
    const parent = above ? above.at : -1;
    const place = isPlace ? joints[index].rest.map((value) => shifted(value, unit - rig.exponent)) : bone;
    found.push({ offset: place, parent, part, drives, isMoved, isShown: !isPlace && length > 0 && parent >= 0, index });
    if (isHead) {
      const tenth = Math.floor(size / 10);
      const end = infos.find((end) => joints[end.index].isEnd && end.above === info && end.length > Math.floor(tenth / 3));
      const offset = end ? end.bone : bone.map((x) => Math.trunc(Math.trunc(((Math.trunc((x * 64) / Math.max(1, length >> 6))) * (tenth >> 6)) / 64)));
      result.radius = Math.min(Math.max(lengthOf(offset) >> 1, Math.floor(size / 22)), Math.floor(size / 14));
      result.crown = found.length;
      found.push({ offset, parent: info.at, part, drives: [], isMoved: false, isShown: false });
    }
    info.children.filter(({ isKept }) => isKept).sort((a, b) => a.weight - b.weight || a.index - b.index).forEach(add);
  };
  if (infos[0].isKept) add(infos[0]);
  return result;
};

// [lines] Brightness by depth.
const shadeOf = (depth) => clamp(176 - ((depth * 5) >> 7), 80, 255);
const narrow = (x) => clamp(x, -32768, 32767);

/**
 * The figure of a clip, for poses of its raw values; `raw` is the first of them. `aim` sets the camera up by poses that `visit` passes to its argument one by one.
 * `place` takes a pose, and `each` passes its strokes, from far to near: two ends in sixteenths of a pixel (of a head, its middle and its radius), a shade of at
 * most 255, the part of the picture, and a width in pixels. `ground` passes those of the ground alone.
 */
export const figureOf = (clip, raw) => {
  const { unit, size, hips, sides, bones, radius, crown } = skeletonOf(clip, raw);
  const count = bones.length;
  const positionShift = unit - clip.exponent;
  const places = new Int32Array(3 * count);
  // The last one is the camera's.
  const turns = new Int32Array(9 * (count + 1));
  const VIEW = 9 * count;
  const points = new Int32Array(3 * count);
  const lines = bones.map(({ isShown }, index) => isShown && index + 1).filter(Boolean).map((next) => next - 1);
  let shift, spare, factor, depthShift, fixed, centre, scale, seen, axis, height, spacing, isDotted;
  let target = [0, 0, 0];

  // [kinematics] Places the first joints about an origin, in the axes of the view.
  const placeIn = (raw, origin, some = count) => {
    for (let index = 0; index < some; index++) {
      const { offset, parent, drives, isMoved } = bones[index];
      const above = parent < 0 ? VIEW : 9 * parent;
      let [x, y, z] = offset;
      if (isMoved) {
        const [, a, b, c] = drives[0];
        if (a >= 0) x = shifted(raw[a], positionShift);
        if (b >= 0) y = shifted(raw[b], positionShift);
        if (c >= 0) z = shifted(raw[c], positionShift);
      }
      if (parent < 0) imageOfAny(turns, above, x - origin[0], y - origin[1], z - origin[2]);
      else if (isMoved) imageOfAny(turns, above, x, y, z);
      else image(turns, above, x, y, z);
      for (let at = 0; at < 3; at++) places[3 * index + at] = IMAGE[at] + (parent < 0 ? 0 : places[3 * parent + at]);
      const own = 9 * index;
      turns.copyWithin(own, above, above + 9);
      for (const drive of drives) {
        const act = drive[0];
        const members = () => drive.slice(1).map((channel) => (channel < 0 ? 0 : raw[channel]));
        if (act < OFFSET) turnAbout(turns, own, act, raw[drive[1]]);
        else if (act === EXPONENTIAL) turnByExponential(turns, own, members());
        else if (act === QUATERNION) turnByQuaternion(turns, own, members());
      }
    }
  };
  const inWorld = (raw, origin, some) => {
    for (let at = 0; at < 9; at++) turns[VIEW + at] = at % 4 ? 0 : ONE;
    placeIn(raw, origin, some);
  };
  const at = (index) => axes((axis) => places[3 * index + axis]);

  // [camera] Right, down and away from the target, to a place in the picture and a depth in 2^-15 of the camera's distance.
  const project = (x, y, away, to, from) => {
    const depth = (narrow(away >> shift) * factor) >> depthShift;
    const distance = clamp(depth + TRIAL, 0, ONE - 1);
    const near = 64 + (distance >> 8);
    const start = Math.floor((2 ** 21 + (near >> 1)) / near);
    const zoom = start + (((Math.floor((2 ** 21 + (near >> 1)) / (near + 1)) - start) * (distance & 255)) >> 8);
    to[from] = narrow(((narrow(x >> shift) * zoom) >> spare) + centre[0]);
    to[from + 1] = narrow(((narrow(y >> shift) * zoom) >> spare) + centre[1]);
    to[from + 2] = narrow(depth);
    return zoom;
  };
  let view = [];
  const setScale = (to) => {
    scale = to;
    const cut = Math.max(0, bitLength(seen) - 13);
    const short = Math.max(1, seen >> cut);
    let room = 0;
    while (Math.floor((scale << (room + 1)) / short) <= LONGEST_ROW && room < 16) room++;
    const ratio = Math.floor((scale << room) / short);
    const fine = room + cut - 15;
    shift = Math.max(0, fine - 2);
    spare = 14 + fine - shift;
    let depthBits = 0;
    while (Math.floor(2 ** (depthBits + 1) / (DISTANCE * scale)) < ONE && depthBits < 29) depthBits++;
    factor = Math.floor(2 ** depthBits / (DISTANCE * scale));
    depthShift = Math.max(0, depthBits - 15 + fine - shift);
    const rows = viewRows.map((row) => row.map((x) => (x * ratio + HALF) >> 15));
    view = [0, 1, 2].flatMap((axis) => rows.map((row) => row[axis]));
  };
  let viewRows;
  let zoomOfCrown = 0;
  // `stand` makes a place of a figure that stands elsewhere one in the world, or with `true`, after it has turned the view as that figure sees it, the reverse.
  const place = (raw, stand = (there) => there) => {
    inWorld(raw, [0, 0, 0], hips + 1);
    target = stand(at(hips)).map((x, axis) => fixed[axis] ?? x);
    turns.set(view, VIEW);
    placeIn(raw, stand(target, true));
    for (let index = 0; index < count; index++) {
      const zoom = project(places[3 * index], places[3 * index + 1], places[3 * index + 2], points, 3 * index);
      if (index === crown) zoomOfCrown = zoom;
    }
  };
  const depthOf = (index) => points[3 * index + 2] + points[3 * bones[index].parent + 2];
  const head = () => {
    const from = 3 * bones[crown].parent;
    const cut = Math.max(0, bitLength(seen) - 13);
    const wide = Math.floor((Math.min(radius >> cut, 32767) * scale) / Math.max(1, seen >> cut));
    return [...[0, 1].map((axis) => (points[3 * crown + axis] + points[from + axis]) >> 1), narrow((wide * zoomOfCrown) >> 14)];
  };

  const figure = {
    place,
    // What another look of the figure is made of, in a row: names of properties take bytes that lines need not have.
    inner: () => [bones, crown, size, hips, places, turns, points, inWorld, project, view, scale, seen, axis, height, target, positionShift],
    // Degrees; `upAxis` takes the place of the axis that the rig states. A camera that does not follow the figure stands still. `cover` passes circles for which it
    // makes room in place of the head's.
    aim(width, rows, orbit, tilt, isFollowing, upAxis, visit, cover) {
      let low = [0, 0, 0].fill(Infinity);
      let high = [0, 0, 0].fill(-Infinity);
      const leftward = [0, 0, 0];
      visit((raw) => {
        inWorld(raw, [0, 0, 0]);
        for (let index = hips; index < count; index++) {
          low = low.map((least, axis) => Math.min(least, places[3 * index + axis]));
          high = high.map((most, axis) => Math.max(most, places[3 * index + axis]));
        }
        if (sides) leftward.forEach((_, axis) => (leftward[axis] += (places[3 * sides[0].at + axis] - places[3 * sides[1].at + axis]) >> 6));
      });
      // [bounds]
      const { up } = clip.rig;
      axis = upAxis ?? up.findIndex(Boolean);
      const upward = [0, 0, 0];
      upward[axis] = ONE * (upAxis === undefined ? up[axis] : 1);
      leftward[axis] = 0;
      const most = anyBit(leftward);
      let facing = axis === 2 ? [0, -ONE, 0] : [0, 0, ONE];
      if (most) {
        const shift = bitLength(most) - 15;
        const short = leftward.map((x) => (shift < 0 ? x << -shift : x >> shift));
        const length = Math.max(1, rootOf(squareOf(short)));
        facing = crossed(short.map((x) => Math.trunc((x * ONE) / length)), upward);
      }
      const half = axes((axis) => (high[axis] >> 1) - (low[axis] >> 1));
      fixed = axes((index) => (!isFollowing || (index === axis && half[axis] <= size) ? (low[index] >> 1) + (high[index] >> 1) : null));
      seen = isFollowing ? size : Math.max(size, ...half);
      const mix = (a, level, b, up) => axes((axis) => (a * level[axis] + b * up[axis] + HALF) >> 15);
      turnTo(Math.imul(orbit, 11930465));
      const level = mix(cosine, facing, sine, crossed(upward, facing));
      turnTo(Math.imul(tilt, 11930465));
      viewRows = [crossed(upward, level), mix(sine, level, -cosine, upward), mix(-cosine, level, -sine, upward)];
      isDotted = width * rows < DOTTED;
      height = (upward[axis] > 0 ? low : high)[axis];
      spacing = Math.max(1, bitLength(size) - (isDotted ? 3 : 2));
      centre = [0, 0];
      // A camera that stands still sees as far as a size to all sides, in 16 bits.
      const trial = isFollowing ? TRIAL : TRIAL / 4;
      setScale(trial);
      // What the figure covers, from the target.
      let top = 0;
      let bottom = 0;
      let side = 0;
      const widen = (x, y, radius) => {
        side = Math.max(side, Math.abs(x) + radius);
        top = Math.min(top, y - radius);
        bottom = Math.max(bottom, y + radius);
      };
      visit((raw) => {
        place(raw);
        for (const index of lines) for (const end of [index, bones[index].parent]) widen(points[3 * end], points[3 * end + 1], 0);
        if (cover) cover(widen);
        else if (crown) widen(...head());
      });
      const fit = (pixels, covered) => Math.floor((16 * Math.floor((pixels * 9) / 10) * 64) / Math.max(1, Math.floor((covered * 64) / trial)));
      setScale(clamp(Math.min(fit(rows, bottom - top), fit(width, 2 * side)), 1, TRIAL));
      centre = [width * 8, rows * 8 - Math.trunc((Math.trunc((top + bottom) / 2) * scale) / trial)];
    },
    // [lines] The ground, about the target: a grid that stays in its place.
    ground(stroke) {
      const count = isDotted ? DOT_ROWS : GROUND_ROWS;
      const step = 1 << spacing;
      const inView = (vector) => (imageOfAny(view, 0, ...vector), [...IMAGE]);
      const steps = [1, 2].map((next) => axes((index) => (index === (axis + next) % 3 ? step : 0)));
      let corner = inView(axes((index) => (index === axis ? height - target[axis] : step / 2 - ((target[index] + step / 2) & (step - 1)) - (count >> 1) * step)));
      const [a, b] = steps.map(inView);
      const sum = (place, way, times = 1) => place.map((x, axis) => x + way[axis] * times);
      const dot = [0, 0, 0, 0, 0, 0];
      if (isDotted) {
        for (let row = 0; row < count; row++, corner = sum(corner, b)) {
          // Without the corners.
          const cut = Math.max(0, Math.abs(row - (count >> 1)) - 1);
          for (let column = cut; column < count - cut; column++) {
            project(...sum(corner, a, column), dot, 0);
            stroke(dot[0], dot[1], dot[0], dot[1], clamp(112 - (dot[2] >> 7), 32, 208), DOT, 1);
          }
        }
      } else {
        for (const [way, across] of [[a, b], [b, a]]) {
          for (let row = 0; row < count; row++) {
            const start = sum(corner, way, row);
            project(...start, dot, 0);
            project(...sum(start, across, count - 1), dot, 3);
            stroke(dot[0], dot[1], dot[3], dot[4], clamp(40 - ((dot[2] + dot[5]) >> 10), 24, 56), GROUND, 1);
          }
        }
      }
    },
    each(stroke) {
      figure.ground(stroke);
      const breadth = Math.floor(scale / 64);
      lines.sort((one, other) => depthOf(other) - depthOf(one) || one - other);
      for (const index of lines) {
        const { parent, part } = bones[index];
        const depth = depthOf(index) >> 1;
        stroke(points[3 * parent], points[3 * parent + 1], points[3 * index], points[3 * index + 1], shadeOf(depth), part, clamp((breadth - ((breadth * depth) >> 14)) >> 4, 1, 9));
      }
      if (crown) stroke(...head(), 0, shadeOf(depthOf(crown) >> 1), HEAD, 1);
    },
  };
  return figure;
};

// Passes some of a clip's poses, of the frames that there are: about as many as the camera needs. Of a long clip they are of a first part, as in the firmware.
export const visitor = (clip, playable, poseAt) => (visit) => {
  const frames = Math.min(playable, Math.ceil(clip.frames / Math.ceil((clip.motionBytes || 0) / SURVEYED_BYTES)));
  for (let frame = 0, stride = Math.max(1, Math.ceil(frames / SAMPLES)); frame < frames; frame += stride) visit(poseAt(frame));
};
