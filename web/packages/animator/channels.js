// Channels of a pose in groups that are one rotation, one place or one scalar, and rotations in them: the firmware's animator (pantin-animator) in JavaScript, with the
// same integers bit for bit. Its modules groups.rs, math.rs and layer.rs state each step. Integers of 64 bits are BigInts; a picture takes a few of them.
import { PART, Q, abs, atan2, cosine, dot, eulerOf, floor, length, matrixOf, max, min, normalize, set, sine, turn, turnAbout, turnByMap, turnTo, unturned } from "../decoder/turning.js";

export const big = BigInt;
export const FREE = 0;
const EULER = 1;
export const MAP = 2;
const QUATERNION = 3;
// A weight of 1.
export const WHOLE = 1 << 15;
const HALF_WAY = -(2 ** 31);
const QUARTER = 2 ** 30;
export const MOST = 2 ** 31 - 1;
// The order of angles whose first axis is the one that is up.
const FIRST_UP = [[0, 1, 2], [1, 0, 2], [2, 0, 1]];

export const clamp = (x, low, high) => (x < low ? low : x > high ? high : x);
export const wide = (x) => big.asIntN(64, x);
// x times 2^shift, rounded down.
export const wideShifted = (x, shift) => (shift < 0 ? x >> big(min(-shift, 63)) : wide(x << big(min(shift, 63))));
export const isTurn = (kind) => kind > 2 && kind < 6;
// x times factor / 2^shift, rounded down: x is a signed number of 32 bits, the factor below 2^33, and the shift 16 or more.
export const scaledDown = (x, factor, shift) => floor(((x >> 16) * factor + floor(((x & 65535) * factor) / 65536)) / 2 ** (shift - 16));
// A difference times a weight, rounded down.
export const weighted = (x, weight) => ((x >> 16) * weight * 2 + (((x & 65535) * weight) >> 15)) | 0;

// Of up to three numbers.
const lengthOf = (vector) => {
  const square = vector.reduce((sum, x) => sum + big(x) ** 2n, 0n);
  let root = big(floor(Math.sqrt(Number(square))));
  while (root * root > square) root--;
  while ((root + 1n) ** 2n <= square) root++;
  return root;
};

// Groups in the form of a clip: what each one is, its first channel and their number, and the index of its joint, or of its scalar behind those of the joints.
export const groupsOf = ({ rig, joints }) => {
  const groups = [];
  const familyOf = (kind) => (kind < 3 ? 0 : kind < 6 ? EULER : kind < 10 ? QUATERNION : MAP);
  rig.joints.forEach(({ kinds, first }, index) => {
    const isOrder = new Set(kinds.filter(isTurn).slice(0, 3)).size > 2;
    const euler = joints[index].kinds !== kinds ? MAP : isOrder ? EULER : FREE;
    for (let at = 0, from = 0; at < kinds.length; from = at) {
      const family = familyOf(kinds[at]);
      while (at < kinds.length && familyOf(kinds[at]) === family) at++;
      const count = at - from;
      const isWhole = count === (family === QUATERNION ? 4 : 3);
      groups.push([isWhole ? (family === EULER ? euler : family) : FREE, first + from, count, index]);
    }
  });
  rig.scalars.forEach((_, index) => groups.push([FREE, rig.channels - rig.scalars.length + index, 1, rig.joints.length + index]));
  return groups;
};

// Of what is the same rotation, the channels that are nearest to others.
export const nearest = (shape, from, to) => {
  if (shape === EULER) {
    const other = [(from[0] + HALF_WAY) | 0, (HALF_WAY - from[1]) | 0, (from[2] + HALF_WAY) | 0];
    const apart = (own) => own.reduce((sum, x, index) => sum + abs((x - to[index]) | 0), 0);
    if (apart(other) < apart(from)) return other;
  }
  if (shape === MAP) {
    const apart = (own) => own.reduce((sum, x, index) => sum + abs(x - to[index]), 0);
    // A turn less is 2^32 away in these sums or farther, less 3 for rounding.
    const now = apart(from);
    const size = now < 2 ** 31 - 3 ? 0n : lengthOf(from);
    if (!size) return from;
    const shorter = Array.from(from, (x) => Number((big(x) * (size - 2n ** 32n)) / size));
    if (shorter.every((x) => x === (x | 0)) && apart(shorter) < now) return shorter;
  }
  if (shape === QUATERNION && from.reduce((sum, x, index) => sum + ((big(x) * big(to[index])) >> 2n), 0n) < 0n) return Array.from(from, (x) => -x | 0);
  return from;
};

// Mixes a group of another pose in: the shortest way, unless nothing is left of the own one.
export const mixGroup = (pose, to, [shape, first, count], weight) => {
  const end = first + count;
  let isFar = shape === QUATERNION;
  for (let channel = first; channel < end; channel++) isFar ||= (to[channel] - pose[channel] + QUARTER) >>> 0 > 2 * QUARTER;
  if (isFar && shape && weight !== WHOLE) pose.set(nearest(shape, pose.subarray(first, end), to.subarray(first, end)), first);
  for (let channel = first; channel < end; channel++) pose[channel] += weighted((to[channel] - pose[channel]) | 0, weight);
};

// Which component each channel of a map or a quaternion holds.
const placesOf = (shape, kinds) => {
  const isMap = shape === MAP;
  return kinds.filter((kind) => kind > 2).map((kind, at) => (kind > 9 ? kind - 10 + !isMap : kind > 5 ? max(0, kind - 6 - isMap) : at));
};
// The components of a map or a quaternion in their order. `kinds` are those of the joint.
export const partsOf = (shape, kinds, own) => {
  const parts = [0, 0, 0, 0];
  placesOf(shape, kinds).forEach((place, index) => index < own.length && (parts[place] = own[index]));
  return parts;
};
// Makes the rotation of a group's channels; false for channels that are each by themselves.
export const turnOf = (shape, kinds, own) => {
  unturned();
  if (shape === EULER) kinds.filter(isTurn).forEach((kind, index) => index < 3 && turnAbout(kind - 3, own[index]));
  else if (shape) {
    const parts = partsOf(shape, kinds, own);
    if (shape === MAP) turnByMap(parts[0], parts[1], parts[2]);
    else {
      set(...parts);
      normalize(PART);
      turn();
    }
  }
  return shape !== FREE;
};
// The exponential map of the rotation, of at most half a turn.
const mapOf = () => {
  const [w, ...vector] = Q;
  const size = lengthOf(vector);
  set(w, ...vector);
  normalize(PART);
  const real = abs(PART[0]);
  PART[0] = 0;
  normalize(PART);
  const angle = big(abs((2 * atan2(length, real)) | 0));
  return vector.map((x) => (size ? clamp(Number((big(w < 0 ? -x : x) * angle) / size), -MOST, MOST) : 0));
};
// What the rotation is in a group's channels; those that it cannot be written to stay.
export const writtenTo = (shape, kinds, own) => {
  if (shape === EULER) {
    normalize(Q);
    const letters = kinds.filter(isTurn).map((kind) => "XYZ"[kind - 3]).slice(0, 3).join("");
    return eulerOf(letters, []);
  }
  const parts = shape === MAP ? mapOf() : [...Q];
  const places = placesOf(shape, kinds);
  return own.map((_, index) => parts[places[index]] ?? 0);
};
// A rotation that another form holds in its channels.
export const rewritten = (was, shape, kinds, own) => (turnOf(was, kinds, own) ? writtenTo(shape, kinds, own) : own);

// Turns a joint about the axis that is up, in its channels: one that has up to two angles keeps them, but for one that turns about that axis first.
export const turnedBy = (angle, axis, shape, kinds, own) => {
  if (!angle) return own;
  if (turnOf(shape, kinds, own)) {
    const before = [...Q];
    unturned();
    turnAbout(axis, angle);
    set(...before);
    turn();
    return writtenTo(shape, kinds, own);
  }
  return own.map((x, index) => (!index && kinds.find((kind) => kind > 2) === axis + 3 ? (x + angle) | 0 : x));
};

// How far the rotation turns about the axis that is up: the first angle of its matrix.
export const yawOf = (axis) => {
  const [i, j, k] = FIRST_UP[axis];
  const rows = matrixOf([]);
  const sign = axis === 1 ? 1 : -1;
  turnTo(atan2(sign * rows[3 * i + j], rows[4 * i]));
  const along = (row) => dot(-sign * rows[3 * row + i], sine, rows[3 * row + j], cosine, 0, 0, 0, 0);
  return atan2(-sign * along(k), along(j));
};

// An angle with its sine and cosine, and what it makes of a vector.
export const headingOf = (angle) => {
  turnTo(angle);
  return [angle, big(sine), big(cosine)];
};
export const rotated = ([angle, across, along], a, b) => (angle ? [a * along - b * across, a * across + b * along].map((x) => wide((x + 2n ** 29n) >> 30n)) : [a, b]);
