// Retargeting: a clip's motion on bones of other axes, proportions and rest pose. Directions of limbs are those of the clip.
//
// The world turn of a joint since its rest pose (that of the offsets alone) is put on what the bone's own rest pose has. M, the least turn that takes the
// direction of the bone's limb at rest to that of the joint's, makes an A pose of a T pose; bones without a limb of their own take that of their parent.
//
// Bones of one parent, such as thighs or shoulders, lie beside each other in both figures: they tell whether one faces another way, by quarters of a turn.
import { Matrix4, Quaternion, Vector3 } from "three";

const NONE = new Quaternion();

// What stands between a node and the object that is taken for the world.
function placed(node, top) {
  const matrix = new Matrix4();
  for (let other = node; other && other !== top; other = other.parent) {
    other.updateMatrix();
    matrix.premultiply(other.matrix);
  }
  return matrix;
}

const turnOf = (matrix) => {
  const turn = new Quaternion();
  matrix.decompose(new Vector3(), turn, new Vector3());
  return turn;
};

/** Puts frames on the bones of another figure. `bound` has joints and nodes, parents first; the figure stands in its rest pose. */
export class Retargeting {
  #places;
  #turns;
  #now = new Quaternion();
  #place = new Vector3();

  constructor(clip, bound, top, { inPlace = false } = {}) {
    const { joints, rig } = clip;
    const count = joints.length;
    this.#places = new Float64Array(3 * count);
    this.#turns = new Float64Array(4 * count);
    this.inPlace = inPlace;
    this.top = top;
    // Where the clip has the root, in the scene's unit.
    this.travel = new Vector3();
    // From the clip's axes to those of three.js, where y is up.
    this.upright = new Quaternion().setFromUnitVectors(new Vector3(...rig.up), new Vector3(0, 1, 0));
    const rest = [];
    joints.forEach(({ parent, offset }, index) => (rest[index] = new Vector3(...offset).add(rest[parent] ?? new Vector3())));
    const byJoint = new Map(bound.map((entry) => [entry.joint, entry]));
    const above = (joint) => {
      let parent = joints[joint].parent;
      while (parent >= 0 && !byJoint.has(parent)) parent = joints[parent].parent;
      return byJoint.get(parent);
    };
    const entries = bound.map((entry) => {
      const matrix = placed(entry.node, top);
      return { ...entry, parent: above(entry.joint), bind: turnOf(matrix), at: new Vector3().setFromMatrixPosition(matrix), world: new Quaternion(), children: [] };
    });
    entries.forEach((entry, index) => byJoint.set(bound[index].joint, entry));
    let [own, its] = [0, 0];
    for (const entry of entries) {
      entry.parent &&= byJoint.get(entry.parent.joint);
      entry.parent?.children.push(entry);
      if (!entry.parent) continue;
      own += entry.at.distanceTo(entry.parent.at);
      its += rest[entry.joint].distanceTo(rest[entry.parent.joint]);
    }
    const place = ({ joint }) => rest[joint].clone().applyQuaternion(this.upright);
    let [along, across] = [0, 0];
    for (const { children } of entries) {
      for (const [index, one] of children.entries()) {
        for (const other of children.slice(index + 1)) {
          const [a, b] = [one.at.clone().sub(other.at), place(one).sub(place(other))];
          along += a.x * b.x + a.z * b.z;
          across += a.x * b.z - a.z * b.x;
        }
      }
    }
    const quarters = Math.round(Math.atan2(across, along) / (Math.PI / 2));
    this.upright.premultiply(new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), (quarters * Math.PI) / 2));
    const upside = this.upright.clone().invert();
    this.scale = its > 0 && own > 0 ? own / its : 1;
    // The root moves, and what else moves in the clip and hangs in the same place: some figures travel by one joint and sway by the next. The others keep their bones' lengths.
    this.movers = entries.filter(({ joint, parent }) => !parent || (joints[joint].kinds.some((kind) => kind < 3) && rest[joint].distanceTo(rest[entries[0].joint]) <= its * 1e-6));
    for (const entry of entries) {
      const [child] = entry.children;
      const isLimb = entry.children.length === 1 && entry.parent;
      const way = isLimb && [child.at.clone().sub(entry.at), rest[child.joint].clone().sub(rest[entry.joint]).applyQuaternion(this.upright)];
      const least = way && way[0].length() > 0 && way[1].length() > 0 ? new Quaternion().setFromUnitVectors(way[0].normalize(), way[1].normalize()) : entry.parent?.least ?? NONE;
      entry.least = least;
      entry.fixed = least.clone().multiply(entry.bind);
      // Of the bone's parent against the bone above it, at rest.
      const parent = placed(entry.node.parent, top);
      entry.between = (entry.parent?.bind.clone().invert() ?? new Quaternion()).multiply(turnOf(parent));
      entry.outside = parent.invert();
    }
    this.entries = entries;
    this.upside = upside;
  }

  apply(player) {
    const [places, turns, now, place] = [this.#places, this.#turns, this.#now, this.#place];
    player.world(places, turns);
    for (const { joint, node, parent, world, fixed, between } of this.entries) {
      now.fromArray(turns, 4 * joint);
      world.copy(this.upright).multiply(now).multiply(this.upside).multiply(fixed);
      now.copy(parent ? parent.world : NONE).multiply(between).invert();
      node.quaternion.copy(now).multiply(world);
    }
    const [{ at: home }] = this.movers;
    for (const { joint, node, parent, outside } of this.movers) {
      place.fromArray(places, 3 * joint).applyQuaternion(this.upright).multiplyScalar(this.scale);
      if (!parent) this.travel.copy(place);
      if (this.inPlace) place.set(place.x - this.travel.x + home.x, place.y, place.z - this.travel.z + home.z);
      node.position.copy(place.applyMatrix4(parent ? placed(node.parent, this.top).invert() : outside));
    }
  }
}
