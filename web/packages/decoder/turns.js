// @pantin/decoder/turns: the rotations of joints in integers, with the same bits as the decoder in Rust.
//
// A player is all that this module needs of the decoder: programs that do not import it do not load it.
import { EVEN, PART, Q, atan2, computeOf, eulerOf, length, matrixOf, normalize, set } from "./turning.js";

const ORDERS = ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"];

// A name without the prefix of its program, in small letters.
const plain = (name) => name.split(":").pop().toLowerCase();

/** Finds a joint by its name, whose rotation is then read frame by frame. An Error suggests a joint with a similar name. */
export const findJoint = (player, name) => {
  const { clip, raw } = player;
  const index = clip.joints.findIndex((joint) => name && joint.name === name);
  if (index < 0) {
    const like = name && clip.joints.find((joint) => plain(joint.name) === plain(name));
    throw new Error("pantin: no joint " + name + (like ? "; there is " + like.name : ""));
  }
  const { first, kinds } = clip.joints[index];
  const compute = computeOf(clip, index);
  // The order of all of the joint's angles, which can be read where the clip does not code them as a map.
  const own = clip.rig.joints[index].kinds;
  const angles = own.flatMap((kind, at) => (kind > 2 && kind < 6 ? first + at : []));
  const letters = angles.map((channel) => "XYZ"[own[channel - first] - 3]).join("");
  const known = own.some((kind) => kind > 5) ? undefined : letters ? ORDERS.find((order) => order.startsWith(letters) && (letters.length > 1 || EVEN.includes(order))) : "XYZ";
  const order = letters ? known : undefined;
  const stored = kinds === own ? known : undefined;
  return {
    name, index, kinds, order,
    raw: () => kinds.map((_, at) => raw[first + at]),
    euler: (order, out = []) => {
      if (!ORDERS.includes(order)) throw new Error("pantin: no order of Euler angles " + order);
      if (order === stored) {
        for (let at = 0; at < 3; at++) out[at] = raw[angles[at]] ?? 0;
        return out;
      }
      compute(raw);
      return eulerOf(order, out);
    },
    angle: () => {
      compute(raw);
      set(0, Q[1], Q[2], Q[3]);
      normalize(PART);
      return (2 * atan2(length, Math.abs(Q[0]))) | 0;
    },
    quaternion: (out = []) => {
      compute(raw);
      for (let at = 0; at < 4; at++) out[at] = Q[at];
      return out;
    },
    matrix: (out = []) => {
      compute(raw);
      return matrixOf(out);
    },
  };
};

/** An angle in 2^-32 turns as degrees, -180 to 180. */
export const degrees = (angle) => (angle * 360) / 2 ** 32;
