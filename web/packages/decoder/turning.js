// Rotations in integers, with the same bits as the decoder in Rust, whose modules turn.rs and trig.rs state each step: what turns.js and the element's animator share.
export const { abs, clz32, floor, imul, max, min, round } = Math;
const HALF_TURN = 2 ** 31;
const ONE = 2 ** 30;
const SINE = [4941520, 85555982, 693598003, 1686629708];
const COSINE = [973605, 22399895, 272375455, 1324675878];
const ARCTANGENT = [34631066, 69146217, 96821929, 136665923, 227854097, 683565272];
// The orders in which the axes follow one another as x, y, z do are parts of this text.
export const EVEN = "XYZXY";

// The upper half of the product of two numbers below 2^32. Floating point has it within 2^-20, and `imul` the lower half exactly.
const high = (a, b) => round((a * b - (imul(a, b) >>> 0)) / 2 ** 32);
// The sum of four products of signed 32-bit numbers, shifted to the right by 30 or 29 and rounded once; in two halves as above.
const sum = (shift, a, b, c, d, e, f, g, h) => {
  const half = 1 << (shift - 1);
  const low = (imul(a, b) + imul(c, d) + imul(e, f) + imul(g, h) + half) >>> 0;
  return (round((a * b + c * d + e * f + g * h + half - low) / 2 ** 32) * 2 ** (32 - shift) + (low >>> shift)) | 0;
};
export const dot = (a, b, c, d, e, f, g, h) => sum(30, a, b, c, d, e, f, g, h);
const scaled = (a, b) => dot(a, b, 0, 0, 0, 0, 0, 0);
const alternating = (coefficients, u) => {
  let total = coefficients[0];
  for (let index = 1; index < coefficients.length; index++) total = coefficients[index] - high(u, total);
  return total;
};

// Results of the functions below, in variables: arrays would be garbage in every frame.
export let sine = 0;
export let cosine = 0;
export let length = 0;
export const turnTo = (angle) => {
  const quarter = (angle + 2 ** 29) >>> 30;
  const rest = (angle - (quarter << 30)) | 0;
  const t = abs(rest) * 4;
  const u = high(t, t);
  const along = ONE - high(u, alternating(COSINE, u));
  let across = high(t, alternating(SINE, u));
  if (rest < 0) across = -across;
  sine = quarter === 1 ? along : quarter === 2 ? -across : quarter ? -along : across;
  cosine = quarter === 1 ? -across : quarter === 2 ? -along : quarter ? across : along;
};
export const atan2 = (y, x) => {
  const across = abs(y);
  const along = abs(x);
  let large = max(across, along);
  let small = min(across, along);
  if (!large) return 0;
  const up = 2 ** clz32(large);
  large = floor((large * up) / 2);
  small = floor((small * up) / 2);
  const isFar = small > floor(large / 2);
  if (isFar) {
    const whole = large + small;
    small = large - small;
    large = whole;
  }
  if (large < HALF_TURN) {
    large *= 2;
    small *= 2;
  }
  let r = 0xb4b4b4b5 - high(large, 0x78787878);
  for (let step = 3; step--; ) r = high(r, HALF_TURN - high(large, r)) * 4;
  const z = high(small, r) * 4;
  let angle = high(z, alternating(ARCTANGENT, high(z, z)));
  if (isFar) angle = 2 ** 29 - angle;
  if (across > along) angle = ONE - angle;
  if (x < 0) angle = HALF_TURN - angle;
  return (y < 0 ? -angle : angle) | 0;
};

// A rotation that is being computed, and the next part of it: quaternions w, x, y, z.
export const Q = new Int32Array(4);
export const PART = new Int32Array(4);
export const set = (w, x, y, z) => {
  PART[0] = w;
  PART[1] = x;
  PART[2] = y;
  PART[3] = z;
};
// Makes the length of a quaternion 1, and notes what it was.
export const normalize = (q) => {
  const up = clz32(abs(q[0]) | abs(q[1]) | abs(q[2]) | abs(q[3]));
  if (up > 31) {
    q[0] = ONE;
    length = 0;
    return;
  }
  const raised = (index) => floor((abs(q[index]) * 2 ** up) / 2);
  let square = 0;
  for (let index = 0; index < 4; index++) square += high(raised(index), raised(index));
  const twice = square < ONE ? 2 : 1;
  square *= twice * twice;
  let inverse = 0x887d9c55 - high(square, 0x4dfea27a);
  for (let step = 4; step--; ) inverse = high(inverse, 3 * ONE - high(high(square, inverse) * 4, inverse)) * 2;
  inverse += 2;
  for (let index = 0; index < 4; index++) {
    const size = high(raised(index) * twice, inverse);
    q[index] = q[index] < 0 ? -size : size;
  }
  length = floor((high(square, inverse) * 8) / 2 ** up / twice);
};
// Begins with no rotation.
export const unturned = () => {
  Q.fill(0);
  Q[0] = ONE;
};
// Turns by the part about the axes that are turned already.
export const turn = () => {
  const a = Q[0];
  const b = Q[1];
  const c = Q[2];
  const d = Q[3];
  const w = PART[0];
  const x = PART[1];
  const y = PART[2];
  const z = PART[3];
  Q[0] = dot(a, w, b, -x, c, -y, d, -z);
  Q[1] = dot(a, x, b, w, c, z, d, -y);
  Q[2] = dot(a, y, b, -z, c, w, d, x);
  Q[3] = dot(a, z, b, y, c, -x, d, w);
};
export const turnAbout = (axis, angle) => {
  turnTo(angle >> 1);
  set(cosine, 0, 0, 0);
  PART[axis + 1] = sine;
  turn();
};
export const turnByMap = (x, y, z) => {
  set(0, x, y, z);
  normalize(PART);
  turnTo(floor(length / 2));
  set(cosine, scaled(PART[1], sine), scaled(PART[2], sine), scaled(PART[3], sine));
  turn();
};
// The Euler angles of the rotation.
export const eulerOf = (order, out) => {
  const component = (at) => Q["XYZ".indexOf(order[at]) + 1];
  const w = Q[0];
  const sign = EVEN.includes(order) ? 1 : -1;
  const own = component(0);
  const other = component(1);
  const third = sign * component(2);
  const total = atan2(own + third, w + other);
  turnTo(total);
  const longer = scaled(w + other, cosine) + scaled(own + third, sine);
  const difference = atan2(own - third, w - other);
  turnTo(difference);
  const shorter = scaled(w - other, cosine) + scaled(own - third, sine);
  out[0] = (total + difference) | 0;
  out[1] = (ONE - 2 * atan2(shorter, longer)) | 0;
  out[2] = (sign * (total - difference)) | 0;
  return out;
};
// Its matrix, row by row.
export const matrixOf = (out) => {
  const twice = (a, b, c, d) => sum(29, a, b, c, d, 0, 0, 0, 0);
  for (let i = 0; i < 3; i++) {
    const j = (i + 1) % 3;
    const w = Q[0];
    const x = Q[i + 1];
    const y = Q[j + 1];
    const z = Q[4 - i - j];
    out[4 * i] = (ONE + twice(-y, y, -z, z)) | 0;
    out[3 * i + j] = twice(x, y, -w, z);
    out[3 * j + i] = twice(x, y, w, z);
  }
  return out;
};

// What makes the rotation of a joint of a clip from a pose's raw values: by angles, or by the components of what the clip codes as an exponential map in their place, then by the joint's
// own quaternion and its own exponential map.
export const computeOf = (clip, index) => {
  const { first, kinds } = clip.rig.joints[index];
  const isCoded = clip.joints[index].kinds !== kinds;
  // Axes and channels.
  const angles = kinds.flatMap((kind, at) => (kind > 2 && kind < 6 ? [[kind - 3, first + at]] : []));
  const hasMap = kinds.some((kind) => kind > 9);
  const hasQuaternion = kinds.some((kind) => kind > 5 && kind < 10);
  const isChain = hasQuaternion + hasMap + (angles.length > 0) > 1 || (!isCoded && new Set(angles.map(([axis]) => axis)).size < angles.length);
  return (raw) => {
    const value = (kind) => (kinds.includes(kind) ? raw[first + kinds.lastIndexOf(kind)] : 0);
    unturned();
    if (isCoded) turnByMap(...angles.map(([, channel]) => raw[channel]));
    else for (const [axis, channel] of angles) turnAbout(axis, raw[channel]);
    if (hasQuaternion) {
      set(value(6), value(7), value(8), value(9));
      normalize(PART);
      turn();
    }
    if (hasMap) turnByMap(value(10), value(11), value(12));
    if (isChain) normalize(Q);
  };
};
