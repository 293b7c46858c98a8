import type { Keys } from "./keys.js";

/** Bytes of a file. */
export type Bytes = ArrayBuffer | ArrayBufferView;

/** A joint of a figure. */
export interface Joint {
  /** The name; empty for an End Site. */
  readonly name: string;
  /** The index of the parent, which is smaller than the joint's own; -1 for the root. */
  readonly parent: number;
  /** Whether the joint only marks the end of a bone. */
  readonly isEnd: boolean;
  /** Whether the joint only steers other joints, and is no part of the figure. */
  readonly isHelper: boolean;
  /** The position in the parent while no channel moves it: x, y, z in units of the source. */
  readonly offset: readonly number[];
  /** The kinds of its channels as the clip codes them: 0-2 position x, y, z; 3-5 Euler angle x, y, z; 6-9 quaternion w, x, y, z; 10-12 exponential map x, y, z. */
  readonly kinds: readonly number[];
  /** The index of its first channel in `Player.raw`. */
  readonly first: number;
}

/** A channel that moves no joint, such as the weight of a face's shape. */
export interface Scalar {
  readonly name: string;
  /** The value of the raw value 1. */
  readonly scale: number;
}

/** A figure, which several clips may share. */
export interface Rig {
  readonly id: number;
  readonly joints: readonly Joint[];
  readonly scalars: readonly Scalar[];
  /** The direction that is up, a unit vector. */
  readonly up: readonly number[];
  /** Centimetres in a unit of the source. */
  readonly cmPerUnit: number;
  /** Offsets are stored in units of 2^exponent. */
  readonly exponent: number;
  /** The number of channels of a pose, at most 1023. */
  readonly channels: number;
}

/** A marker in a clip. */
export interface ClipEvent {
  readonly frame: number;
  readonly id: number;
  /** The name, such as "left_foot_down"; empty if the clip has none for this id. */
  readonly name: string;
}

/** A motion of one figure. */
export interface Clip {
  readonly rig: Rig;
  readonly joints: readonly Joint[];
  readonly scalars: readonly Scalar[];
  readonly events: readonly ClipEvent[];
  readonly eventNames: readonly string[];
  /** The number of frames, 1 to 2^24. */
  readonly frames: number;
  /** Nanoseconds from one frame to the next. */
  readonly frameTimeNs: number;
  /** Seconds. */
  readonly duration: number;
  /** Raw positions are in units of 2^exponent. */
  readonly exponent: number;
  /** Bytes of the rig in the file, and of the motion. */
  readonly rigBytes: number;
  readonly motionBytes: number;
  /** Whether frame 0 follows the last frame. */
  readonly looped: boolean;
  /** The index of the joint with this name, of several the first. Throws an Error that names it if there is none. */
  joint(name: string): number;
  /** The index of the scalar with this name. Throws an Error if there is none. */
  scalar(name: string): number;
  /** Returns a player at frame 0. Any number of players may play one clip. */
  play(): Player;
}

/** What the raw values of a pose mean. */
export interface Pose {
  /** Writes a joint's rotation against its parent, the quaternion x, y, z, w, to `out` from `at` on, and returns `out`. */
  rotation<T extends { [index: number]: number } = number[]>(joint: number, out?: T, at?: number): T;
  /** Writes a joint's position in its parent, x, y, z in units of the source, to `out` from `at` on, and returns `out`. */
  translation<T extends { [index: number]: number } = number[]>(joint: number, out?: T, at?: number): T;
  /** Returns the world positions of all joints, x, y, z each. `turns` receives their world rotations, x, y, z, w each. */
  world(out?: Float64Array, turns?: Float64Array): Float64Array;
  /** Returns the value of a scalar by its index or its name. Throws an Error if the clip has no such scalar. */
  scalar(which: number | string): number;
}

/** Shows the frames of a clip, one at a time. */
export interface Player extends Pose {
  readonly clip: Clip;
  /** The number of channels that move. */
  readonly moving: number;
  /** Of the beginning of a file: whether the frame that is shown takes bytes that are missing. */
  readonly dry: boolean;
  /** The frame that is shown. */
  readonly frame: number;
  /**
   * The raw values of all channels at this frame: Euler angles and exponential maps in 2^-32 turns, positions in 2^`Clip.exponent` units of the source,
   * quaternions in 2^-30. The components of an exponential map or a quaternion are no angles about axes: `rotation`, and `findJoint` of
   * "@pantin/decoder/turns", read rotations. The array is changed by every step and seek.
   */
  readonly raw: Int32Array;
  /** Shows the next frame. Returns false at the last one. */
  step(): boolean;
  /** Shows this frame exactly, or the nearest one that the clip has. */
  seek(frame: number): Player;
  /** Shows the frame at a time in seconds. A looped clip repeats. */
  seekTime(seconds: number): Player;
}

/** The clips of one rig. */
export interface Bank {
  readonly rig: Rig;
  readonly names: readonly string[];
  /** Opens a clip by its name; without one, the first clip. Throws an Error if there is none, or if it is damaged. */
  open(name?: string): Clip;
}

/**
 * Opens a clip (.ptn). Throws an Error if the bytes are damaged or are no clip. `rig` is that of a clip whose file contains none. With `isPartial`, the bytes are the
 * beginning of a file: step a player until it is `dry`, then seek back to the frame before, the last one that can be shown. Names of events are missing.
 * Key clips need `keys` of "@pantin/decoder/keys": a player of them is `dry` at frame 0 until the whole motion is there.
 */
export function openClip(data: Bytes, rig?: Rig, isPartial?: boolean, keys?: Keys): Clip;
/** Reads raw values of a clip's form, such as a mixture of two poses. The functions read `raw` when they are called. */
export function poseOf(clip: Clip, raw: Int32Array): Pose;
/** Opens a bank of clips (.ptb). One with key clips needs `keys` of "@pantin/decoder/keys". */
export function openBank(data: Bytes, keys?: Keys): Bank;
/** Opens a rig that is a file of its own. */
export function openRig(data: Bytes): Rig;
