// Puts the poses of Pantin clips on three.js objects: as an AnimationClip, or live.
import { AnimationClip, InterpolateDiscrete, Matrix4, NumberKeyframeTrack, PropertyBinding, Quaternion, QuaternionKeyframeTrack, Vector3, VectorKeyframeTrack } from "three";
import { Retargeting } from "./retarget.js";

const IDENTITY = new Matrix4();
const plain = (name) => PropertyBinding.sanitizeNodeName(name).toLowerCase();

// The nodes below an object by their names as three.js writes them; bones come before other nodes.
function nodesOf(root) {
  const nodes = new Map();
  const all = root.bones ? [...root.bones] : [];
  if (!root.bones) root.traverse((node) => all.push(node));
  for (const isBone of [true, false]) {
    for (const node of all) if (!!node.isBone === isBone && !nodes.has(plain(node.name))) nodes.set(plain(node.name), node);
  }
  return nodes;
}

/**
 * Finds the node of each joint, and what stands between it and its parent joint's node. Rotations and translations of a clip are those of the
 * joints alone: nodes in between (an armature that turns or scales) are taken out.
 */
function bindJoints(clip, root, { map = {}, scale = 1 } = {}) {
  const nodes = nodesOf(root);
  const nodeOf = (joint) => {
    const wanted = typeof map === "function" ? map(joint.name, joint) : joint.name in map ? map[joint.name] : joint.name;
    if (wanted === null || wanted === undefined) return null;
    return typeof wanted === "string" ? nodes.get(plain(wanted)) ?? null : wanted;
  };
  const found = clip.joints.map((joint) => (joint.isEnd ? null : nodeOf(joint)));
  const top = root.bones ? null : root;
  const bound = [];
  const scaleOf = new Map();
  clip.joints.forEach((joint, index) => {
    const node = found[index];
    if (!node) return;
    let parent = joint.parent;
    while (parent >= 0 && !found[parent]) parent = clip.joints[parent].parent;
    const above = parent >= 0 ? found[parent] : top;
    const between = new Matrix4();
    for (let other = node.parent; other && other !== above && other !== top; other = other.parent) {
      other.updateMatrix();
      between.premultiply(other.matrix);
    }
    const outer = parent >= 0 ? scaleOf.get(found[parent]) : 1;
    const size = new Vector3().setFromMatrixScale(between);
    scaleOf.set(node, outer * ((size.x + size.y + size.z) / 3) * ((node.scale.x + node.scale.y + node.scale.z) / 3));
    const isPlain = between.equals(IDENTITY);
    const inverse = between.clone().invert();
    const [turn, place, grown] = [new Quaternion(), new Vector3(), new Vector3()];
    between.decompose(place, turn, grown);
    bound.push({ joint: index, node, moves: joint.kinds.some((kind) => kind < 3), inverse: isPlain ? null : inverse, unturn: isPlain ? null : turn.invert(), scale: scale / outer });
  });
  const missing = clip.joints.filter((joint, index) => !joint.isEnd && !found[index]).map((joint) => joint.name);
  return { bound, missing };
}

// The morph targets of each scalar: meshes and indices. A glTF file's weights are called Mesh.weights[2].
function bindScalars(clip, root, { morphs = {} } = {}) {
  const meshes = [];
  if (!root.bones) root.traverse((node) => node.morphTargetInfluences && meshes.push(node));
  const bound = [];
  const missing = [];
  clip.scalars.forEach(({ name }, scalar) => {
    const wanted = typeof morphs === "function" ? morphs(name) : name in morphs ? morphs[name] : name;
    if (wanted === null || wanted === undefined) return;
    const [, mesh, number] = /^(.*)\.weights\[(\d+)\]$/.exec(wanted) ?? [];
    const before = bound.length;
    for (const node of meshes) {
      const names = Object.entries(node.morphTargetDictionary ?? {});
      const same = names.find(([target]) => target.toLowerCase() === wanted.toLowerCase());
      const isMesh = mesh !== undefined && (meshes.length === 1 || plain(node.name) === plain(mesh));
      const index = same ? same[1] : isMesh && +number < node.morphTargetInfluences.length ? +number : -1;
      if (index >= 0) bound.push({ scalar, node, index });
    }
    if (bound.length === before) missing.push(name);
  });
  return { bound, missing };
}

// What puts the pose of a player on nodes and morph targets: of a clip's, or a character.
class Binding {
  #rotation = [0, 0, 0, 1];
  #translation = [0, 0, 0];
  #turn = new Quaternion();
  #place = new Vector3();

  constructor(figure, player, root, options) {
    this.player = player;
    const [joints, scalars] = [bindJoints(figure, root, options), bindScalars(figure, root, options)];
    this.joints = joints.bound;
    this.scalars = scalars.bound;
    this.missing = { joints: joints.missing, scalars: scalars.missing };
    if (options.retarget && this.joints.length) {
      this.retargeting = new Retargeting(figure, this.joints, root.bones ? null : root, options);
      this.retargeting.entries.forEach((entry, index) => (this.joints[index].moves = this.retargeting.movers.includes(entry)));
    }
    if (!this.joints.length && !this.scalars.length) {
      const some = (names) => names.filter(Boolean).slice(0, 4).join(", ") || "none";
      throw new Error(`no joint and no scalar has a node or a morph target of its name: give a map. Joints: ${some(this.missing.joints)}; nodes: ${some([...nodesOf(root).keys()])}`);
    }
  }

  apply() {
    const { player } = this;
    const [rotation, translation] = [this.#rotation, this.#translation];
    this.retargeting?.apply(player);
    for (const { joint, node, moves, inverse, unturn, scale } of this.retargeting ? [] : this.joints) {
      player.rotation(joint, rotation);
      if (unturn) node.quaternion.copy(unturn).multiply(this.#turn.fromArray(rotation));
      else node.quaternion.set(rotation[0], rotation[1], rotation[2], rotation[3]);
      if (!moves) continue;
      player.translation(joint, translation);
      if (inverse) node.position.copy(this.#place.fromArray(translation).multiplyScalar(scale).applyMatrix4(inverse));
      else node.position.set(translation[0] * scale, translation[1] * scale, translation[2] * scale);
    }
    for (const { scalar, node, index } of this.scalars) node.morphTargetInfluences[index] = player.scalar(scalar);
  }
}

/** A figure that shows the frames of a clip. */
export class PantinPose extends Binding {
  constructor(clip, root, options = {}) {
    super(clip, clip.play(), root, options);
    this.clip = clip;
    this.time = 0;
    this.apply();
  }

  /** Goes on by a number of seconds. */
  update(seconds) {
    return this.setTime(this.time + seconds);
  }

  /** Shows the frame at a time in seconds. A looped clip repeats. */
  setTime(seconds) {
    const { clip, player } = this;
    const before = player.frame;
    this.time = clip.looped && clip.duration ? ((seconds % clip.duration) + clip.duration) % clip.duration : Math.max(0, seconds);
    player.seekTime(this.time);
    if (player.frame !== before) this.apply();
    return this;
  }
}

/** A figure that shows a character of @pantin/animator. */
export class PantinCharacter extends Binding {
  constructor(character, root, options = {}) {
    super(character, character, root, options);
    this.character = character;
    // The figure travels by its first joint, whatever channels that has.
    for (const bound of this.joints) bound.moves ||= character.joints[bound.joint].parent < 0;
    this.apply();
  }

  /** Lets the character's time pass. */
  update(seconds) {
    this.character.update(seconds);
    this.apply();
    return this;
  }
}

/** The clip as keyframe tracks for an AnimationMixer on `root`. */
export function toAnimationClip(clip, root, options = {}) {
  const pose = new PantinPose(clip, root, options);
  const { player } = pose;
  const frameTime = clip.frameTimeNs / 1e9;
  // A loop ends where it began.
  const count = clip.frames + (clip.looped ? 1 : 0);
  const times = Float32Array.from({ length: count }, (_, frame) => frame * frameTime);
  const turns = pose.joints.map(() => new Float32Array(4 * count));
  const places = pose.joints.map(({ moves }) => moves && new Float32Array(3 * count));
  const values = pose.scalars.map(() => new Float32Array(count));
  const kept = pose.joints.map(({ node }) => [node.quaternion.clone(), node.position.clone()]);
  const influences = pose.scalars.map(({ node, index }) => node.morphTargetInfluences[index]);
  for (let frame = 0; frame < count; frame++) {
    player.seek(frame % clip.frames);
    pose.apply();
    pose.joints.forEach(({ node }, index) => {
      const turn = turns[index];
      node.quaternion.toArray(turn, 4 * frame);
      // Of both quaternions of a rotation, the one that is nearer to the frame before.
      if (frame) {
        let dot = 0;
        for (let part = 0; part < 4; part++) dot += turn[4 * frame + part] * turn[4 * frame + part - 4];
        if (dot < 0) for (let part = 0; part < 4; part++) turn[4 * frame + part] *= -1;
      }
      if (places[index]) node.position.toArray(places[index], 3 * frame);
    });
    pose.scalars.forEach(({ scalar }, index) => (values[index][frame] = player.scalar(scalar)));
  }
  // The character stands as before.
  pose.joints.forEach(({ node }, index) => {
    node.quaternion.copy(kept[index][0]);
    node.position.copy(kept[index][1]);
  });
  pose.scalars.forEach(({ node, index }, at) => (node.morphTargetInfluences[index] = influences[at]));
  const address = (node) => (root.bones ? `.bones[${node.name}]` : node.name || node.uuid);
  const interpolation = options.interpolate === false ? InterpolateDiscrete : undefined;
  const tracks = pose.joints.flatMap(({ node, moves }, index) => [
    new QuaternionKeyframeTrack(`${address(node)}.quaternion`, times, turns[index], interpolation),
    ...(moves ? [new VectorKeyframeTrack(`${address(node)}.position`, times, places[index], interpolation)] : []),
  ]);
  tracks.push(...pose.scalars.map(({ node, index }, at) => new NumberKeyframeTrack(`${node.name || node.uuid}.morphTargetInfluences[${index}]`, times, values[at], interpolation)));
  return new AnimationClip(options.name ?? "pantin", times[count - 1] || frameTime, tracks);
}
