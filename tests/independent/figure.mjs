// Plays a clip as a figure: places and rotations of its joints, from the rig and the raw values that decode.mjs reads. A number in
// brackets is a section of decoder/FORMAT.md.
import { IDENTITY, aboutAxis, applied, chained, ofExponential, ofQuaternion, product, scaled } from "./maths.mjs";

const EULER = 3, QUATERNION = 6, EXPONENTIAL = 10, SCALAR = 13; // the first of each kind [2]
const RADIANS = (2 * Math.PI) / 2 ** 32; // of a raw angle [11]

/** The joints of a decoded clip, and its frames: `next()` gives each in turn, as the joints' rotations and places in units of the source. */
export function figureOf(clip) {
  const offsetUnit = 2 ** clip.rig.offsetExponent, byMap = new Set(clip.exponential_joints);
  let first = 0;
  const joints = clip.rig.joints.map(({ name, parent, isEnd, isHelper, kinds, offset }, index) => {
    const joint = { name, parent, isEnd, isHelper, kinds, first, byMap: byMap.has(index), offset: scaled(offset, offsetUnit) };
    first += kinds.length;
    return joint;
  });
  const player = clip.player(), positionUnit = 2 ** clip.length_exponent;
  let started = false;
  return {
    joints, frames: clip.frames, seconds: secondsOf(clip.frame_time_ns), cmPerUnit: clip.rig.unit / 1e6, offsetUnit,
    next() {
      if (started) player.step();
      started = true;
      return worlds(joints, player.pose(), positionUnit);
    },
  };
}

/** A frame's time, which is written in whole ns, of a usual rate. */
function secondsOf(ns) {
  const rates = [...Array(1000).keys()].map((n) => n + 1).concat(12.5, 23.976, 29.97, 59.94);
  const rate = rates.find((rate) => Math.abs(1e9 / rate - ns) <= 0.5);
  return rate ? 1 / rate : ns / 1e9;
}

function worlds(joints, pose, positionUnit) {
  const found = [];
  for (const joint of joints) {
    const own = local(joint, pose.slice(joint.first, joint.first + joint.kinds.length), positionUnit);
    found.push(joint.parent < 0 ? own : chained(found[joint.parent], own));
  }
  return found;
}

/** A joint in its parent [11]: its Euler angles in their order, then its quaternion, then its exponential map. */
function local({ kinds, offset, byMap }, values, positionUnit) {
  const place = [...offset], quaternion = [0, 0, 0, 0], map = [0, 0, 0];
  let turn = IDENTITY, angles = 0, hasQuaternion = false;
  kinds.forEach((kind, i) => {
    if (kind < EULER) place[kind] = values[i] * positionUnit;
    else if (kind < QUATERNION && byMap) map[angles++] = values[i] * RADIANS;
    else if (kind < QUATERNION) turn = product(turn, aboutAxis(kind - EULER, values[i] * RADIANS));
    else if (kind < EXPONENTIAL) [quaternion[(kind - QUATERNION + 3) % 4], hasQuaternion] = [values[i], true]; // w comes first
    else if (kind < SCALAR) map[kind - EXPONENTIAL] = values[i] * RADIANS;
  });
  if (hasQuaternion) turn = product(turn, ofQuaternion(quaternion));
  return { place, turn: map.some((x) => x !== 0) ? product(turn, ofExponential(map)) : turn };
}

/** Where a point that a joint carries is. */
export const carried = ({ turn, place }, point) => applied(turn, point).map((x, axis) => x + place[axis]);
