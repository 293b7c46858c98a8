// What the raw values of a pose mean: rotations, places and scalars in floating point. The numbers in brackets are sections of decoder/FORMAT.md.
import { check } from "./clip.js";

const { cos, hypot, sin, PI } = Math;
// Half of an angle's raw value in radians.
const HALF_ANGLE = PI / 2 ** 32;

// A rotation that is being computed, and what of it follows Euler angles: a quaternion w, x, y, z, an exponential map, and one that stands for Euler angles.
const Q = new Float64Array(4);
const PARTS = new Float64Array(10);
const turn = (a, b, c, d) => {
  const x = Q[0];
  const y = Q[1];
  const z = Q[2];
  const w = Q[3];
  Q[0] = w * a + x * d + y * c - z * b;
  Q[1] = w * b - x * c + y * d + z * a;
  Q[2] = w * c + x * b - y * a + z * d;
  Q[3] = w * d - x * a - y * b - z * c;
};
// Turns by a vector's direction, scaled, and a real part.
const turnBy = (first, scale, real) => turn(PARTS[first] * scale, PARTS[first + 1] * scale, PARTS[first + 2] * scale, real);
const turnByMap = (first) => {
  const angle = hypot(PARTS[first], PARTS[first + 1], PARTS[first + 2]);
  if (angle) turnBy(first, sin(angle) / angle, cos(angle));
};

/** What the raw values of a pose mean [11]: of a clip's, or of any other of its form. The functions read `raw` when they are called. */
export const poseOf = (clip, raw) => {
  const { rig, joints } = clip;
  const rotation = (joint, out = [], place = 0) => {
    const { first, kinds } = joints[joint];
    let last = 0;
    Q.fill(0);
    PARTS.fill(0);
    Q[3] = 1;
    for (let index = 0; index < kinds.length; index++) {
      const kind = kinds[index];
      const half = raw[first + index] * HALF_ANGLE;
      if (kind > 5) PARTS[rig.joints[joint].kinds[index] < 6 ? kind - 3 : kind - 6] = half;
      else if (kind > 2) {
        const sine = sin(half);
        turn(kind === 3 ? sine : 0, kind === 4 ? sine : 0, kind > 4 ? sine : 0, cos(half));
      }
      last = Math.max(last, kind);
    }
    if (last > 5) {
      const length = hypot(PARTS[0], PARTS[1], PARTS[2], PARTS[3]);
      turnByMap(7);
      if (length) turnBy(1, 1 / length, PARTS[0] / length);
      turnByMap(4);
    }
    for (let index = 0; index < 4; index++) out[place + index] = Q[index];
    return out;
  };
  const translation = (joint, out = [], place = 0) => {
    const { first, kinds, offset } = joints[joint];
    for (let index = 0; index < 3; index++) out[place + index] = offset[index];
    for (let index = 0; index < kinds.length; index++) if (kinds[index] < 3) out[place + kinds[index]] = raw[first + index] * 2 ** clip.exponent;
    return out;
  };
  return {
    rotation, translation,
    world: (out = new Float64Array(3 * joints.length), turns = new Float64Array(4 * joints.length)) => {
      joints.forEach(({ parent }, joint) => {
        translation(joint, out, 3 * joint);
        rotation(joint, turns, 4 * joint);
        if (parent < 0) return;
        const above = turns.subarray(4 * parent, 4 * parent + 4);
        Q.set(above);
        turn(out[3 * joint], out[3 * joint + 1], out[3 * joint + 2], 0);
        turn(-above[0], -above[1], -above[2], above[3]);
        for (let index = 0; index < 3; index++) out[3 * joint + index] = out[3 * parent + index] + Q[index];
        Q.set(above);
        turn(...turns.subarray(4 * joint, 4 * joint + 4));
        turns.set(Q, 4 * joint);
      });
      return out;
    },
    scalar: (which) => {
      const index = which.at ? clip.scalar(which) : which;
      check(clip.scalars[index], "no scalar " + which);
      return raw[rig.channels - clip.scalars.length + index] * clip.scalars[index].scale;
    },
  };
};
