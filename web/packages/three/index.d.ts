import type { Character } from "@pantin/animator";
import type { Clip, Joint, Player } from "@pantin/decoder";
import type { AnimationClip, Object3D, Skeleton, Vector3 } from "three";

/** A node, its name, or null for a joint that is to be left out. */
export type Target = Object3D | string | null | undefined;

/** How the names of a clip lead to nodes and morph targets. */
export interface Options {
  /** The node of a joint, by the joint's name. Joints that are not in the map are looked up by their own names; capital letters make no difference. */
  map?: Readonly<Record<string, Target>> | ((name: string, joint: Joint) => Target);
  /** The morph target of a scalar, by the scalar's name. Scalars that are not in the map are looked up by their own names. */
  morphs?: Readonly<Record<string, string | null>> | ((name: string) => string | null | undefined);
  /** Factor of the clip's translations, where its unit is not that of the scene. */
  scale?: number;
  /**
   * Whether the bones have other axes, another rest pose or other proportions than the clip's joints. Limbs then point where those of the clip do, and the root's
   * way is scaled by the lengths of the bones. The bones have to stand in their rest pose when the object is made.
   */
  retarget?: boolean;
  /** With `retarget`: whether the root stays above its place at rest. `PantinPose.retargeting.travel` says where the clip has it. */
  inPlace?: boolean;
}

/** What a pose moves. */
interface Binding {
  /** Names of joints and scalars that have no node or morph target. */
  readonly missing: { readonly joints: readonly string[]; readonly scalars: readonly string[] };
  /** With `retarget`: the factor from lengths of the motion to those of the scene, and where the motion has the root, in the unit of the scene. */
  readonly retargeting?: { readonly scale: number; readonly travel: Vector3 };
}

/** A figure that shows the frames of a clip. */
export declare class PantinPose implements Binding {
  /** Throws an Error if no joint and no scalar of the clip is found below `root`. */
  constructor(clip: Clip, root: Object3D | Skeleton, options?: Options);
  readonly clip: Clip;
  readonly player: Player;
  /** Seconds. */
  readonly time: number;
  readonly missing: Binding["missing"];
  readonly retargeting?: Binding["retargeting"];
  /** Goes on by a number of seconds. A looped clip repeats; another one stays at its last frame. */
  update(seconds: number): this;
  /** Shows the frame at a time in seconds. */
  setTime(seconds: number): this;
  /** Puts the frame of `player` on the nodes, after it was moved by its own methods. */
  apply(): void;
}

/**
 * A figure that shows a character of @pantin/animator: a bank's state machine, with its transitions, layers and held feet. It travels through the scene by its first joint;
 * set `character.inPlace` to move the figure by `character.placement` instead.
 */
export declare class PantinCharacter implements Binding {
  /** Throws an Error if no joint and no scalar of the character is found below `root`. */
  constructor(character: Character, root: Object3D | Skeleton, options?: Options);
  readonly character: Character;
  readonly missing: Binding["missing"];
  readonly retargeting?: Binding["retargeting"];
  /** Lets the character's time pass by a number of seconds, and shows its pose. */
  update(seconds: number): this;
  /** Puts the character's pose on the nodes, after it was moved by its own methods. */
  apply(): void;
}

/** The clip as keyframe tracks, for an AnimationMixer on `root`. */
export declare function toAnimationClip(
  clip: Clip,
  root: Object3D | Skeleton,
  options?: Options & {
    /** The name of the AnimationClip. */
    name?: string;
    /** Whether there are poses between frames, the default. */
    interpolate?: boolean;
  },
): AnimationClip;
