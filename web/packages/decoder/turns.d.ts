import type { Player } from "./index.js";

/** An order of Euler angles: each turns about the axis as turned by those before it, as in BVH. "ZYX" is the rotation matrix Rz Ry Rx. */
export type EulerOrder = "XYZ" | "XZY" | "YXZ" | "YZX" | "ZXY" | "ZYX";

type Numbers = { [index: number]: number };

/**
 * A joint of a player, found once. Its functions read the frame that the player shows, and give the joint's rotation against its parent however the clip
 * codes it: as Euler angles, an exponential map or a quaternion. All numbers are integers, with the same bits as in every other decoder of the format.
 * Without `out`, results are new arrays.
 */
export interface JointRef {
  readonly name: string;
  /** The index in `Clip.joints`. */
  readonly index: number;
  /** The joint's own order, that of the Euler angles in the clip's rig; undefined if it has none, or others than one to three about different axes. */
  readonly order: EulerOrder | undefined;
  /** What each of `raw()` is: 0-2 position x, y, z; 3-5 Euler angle x, y, z; 6-9 quaternion w, x, y, z; 10-12 exponential map x, y, z. */
  readonly kinds: readonly number[];
  /**
   * Three Euler angles in 2^-32 turns, the first about the order's first axis: within 2e-6 degrees of the rotation. Throws an Error if it is no order.
   *
   * Pass the joint's own `order`: if the clip codes the joint as Euler angles, they are the clip's own. Otherwise the second angle is within 90 degrees of
   * zero, so that the first and the third can jump by 180 degrees from one frame to the next; and where the second is near 90 or -90 degrees, only the first plus
   * or minus the third is determined.
   */
  euler<T extends Numbers = number[]>(order: EulerOrder, out?: T): T;
  /** How far the joint is turned in all, about whatever axis, in 2^-32 turns: 0 to 2^31, which wraps to -2^31. */
  angle(): number;
  /** The unit quaternion w, x, y, z in 2^-30. `Player.rotation` has x, y, z, w in floating point. */
  quaternion<T extends Numbers = number[]>(out?: T): T;
  /** The rotation matrix row by row, nine elements in 2^-30. Its columns are the images of the axes. */
  matrix<T extends Numbers = number[]>(out?: T): T;
  /** The values that the clip stores for this joint, one for each of `kinds`. The components of a quaternion or an exponential map are no angles about axes. */
  raw(): number[];
}

/** Finds a joint by its name, of several the first. Throws an Error that names the joint if the clip has none, and suggests one with a similar name. */
export function findJoint(player: Player, name: string): JointRef;

/** Converts an angle from 2^-32 turns to degrees, -180 to 180. */
export function degrees(angle: number): number;
