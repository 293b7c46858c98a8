import type { Bytes, Clip, ClipEvent, Joint, Pose, Rig, Scalar } from "@pantin/decoder";

/** A number that steers a character, such as its speed. */
export interface Parameter {
  readonly name: string;
  /** Its least and its greatest value. */
  readonly range: readonly [number, number];
  readonly value: number;
}

/** Where a figure stands. */
export interface Placement {
  /** Its way since the start along both horizontal axes of the rig, in units of the source; 0 along the vertical one. */
  readonly position: readonly [number, number, number];
  /** Radians about the rig's vertical axis, from -pi to pi. */
  readonly heading: number;
}

/**
 * A character of a bank. `rotation`, `translation` and `world` read the pose of this instant. They include where the figure stands, for the joint without a parent
 * and for `world`, unless it is `inPlace`.
 */
export interface Character extends Pose {
  readonly rig: Rig;
  readonly joints: readonly Joint[];
  readonly scalars: readonly Scalar[];
  readonly states: readonly string[];
  readonly inputs: readonly string[];
  readonly parameters: readonly Parameter[];
  /** The name of the state that plays. */
  readonly state: string;
  /** The clip that plays, in whose form `raw` is. */
  readonly clip: Omit<Clip, "joint" | "play" | "scalar">;
  /** The raw values of the pose, without the figure's place: the same integers as on every device. */
  readonly raw: Int32Array;
  /** The events that the last update passed, the first 16 of them. */
  readonly events: readonly ClipEvent[];
  readonly placement: Placement;
  /** Whether `rotation`, `translation` and `world` leave out where the figure stands, for programs that move the character by its `placement`. False at first. */
  inPlace: boolean;
  /** Fires an input: the next update sees it once. Throws a RangeError if there is no such input. */
  fire(input: string): void;
  /** Holds an input down, or lets it go if `isDown` is false. Throws a RangeError if there is no such input. */
  hold(input: string, isDown?: boolean): void;
  /** Sets a parameter, rounded and within its range. Throws a RangeError if there is no such parameter. */
  set(parameter: string, value: number): void;
  /** Lets time pass, and takes the transitions that are due. Throws an Error if a clip that a state begins to play is damaged; the state before then plays on. */
  update(seconds: number): this;
  /** The index of a joint by its name. Throws an Error if there is none. */
  joint(name: string): number;
}

/** Opens the character of a bank, in its first state. Throws an Error for bytes that are no bank with a state machine, or that are damaged. */
export function openCharacter(data: Bytes): Character;
