// The errors of a clip against its motion, at every frame: places, shells and rotations of the joints that the tool bounds.
import { angleBetween, chained, column, length, minus, product, scaled, transposed } from "./maths.mjs";
import { carried } from "./figure.mjs";

export const KINDS = ["place", "shell", "rotation", "joint"];

/** Words of a name that say that a joint only steers others (docs/IMPORT.md). */
const STEERS = /^(ik|pole|target|ctrl|control|handle|effector|poletarget|iktarget)$/i;
const words = (name) => name.match(/\p{Lu}*[^\P{L}\p{Lu}]+|\p{Lu}+/gu) ?? [];

/** Fails if a joint is called a helper that the documents do not call so: it would be left out of every number below. */
function checkHelpers(joints) {
  const wrong = joints.find(({ name, isHelper }) => isHelper && !words(name).some((word) => STEERS.test(word)) && !/\.\d{3}$/.test(name));
  if (wrong) throw new Error(`${wrong.name} is left out as a helper, which its name does not say`);
}

/**
 * The joints of the clip, each with the joint of the motion that has its name; of several of one name, the n-th with the n-th. A root that only joins several figures
 * has none. Fails if a joint of the clip is missing in the motion, or one that moves in the clip.
 */
export function matched(joints, source) {
  const used = new Set(), clean = (name) => name.replace(/\s+/g, " ").trim();
  const pairs = joints.map(({ name, isEnd, kinds, parent }) => {
    if (isEnd) return null;
    const index = source.findIndex((joint, i) => !used.has(i) && clean(joint.name) === clean(name));
    if (index < 0 && !(parent < 0 && kinds.length === 0)) throw new Error(`the motion has no joint ${name}`);
    used.add(index);
    return index;
  });
  const lost = source.find((joint, i) => !used.has(i) && (joint.moves ?? true));
  if (lost) throw new Error(`the clip has no joint ${lost.name}`);
  return pairs;
}

/** End Sites of the clip with their place in the motion's joint: that of the file, or `null` where the tool adds one. */
function endSites(joints, pairs, source) {
  const taken = new Map();
  const sites = joints.map(({ isEnd, parent }) => {
    if (!isEnd) return null;
    const joint = source[pairs[parent]], number = taken.get(joint) ?? 0;
    taken.set(joint, number + 1);
    return joint?.ends[number] ?? null;
  });
  const lost = source.find((joint, i) => pairs.includes(i) && joint.ends.length > (taken.get(joint) ?? 0));
  if (lost) throw new Error(`the clip lacks an End Site of ${lost.name}`);
  return sites;
}

/** Whether each joint is bounded: helpers and what hangs on them are not. */
function boundedOf(joints) {
  const bounded = [];
  joints.forEach(({ isHelper, parent }) => bounded.push(!isHelper && (parent < 0 || bounded[parent])));
  return bounded;
}

const UNTURNED = { turn: [1, 0, 0, 0, 1, 0, 0, 0, 1], place: [0, 0, 0] };
const inParent = (above, own) => (above ? product(transposed(above.turn), own.turn) : own.turn);

/** The greatest distance of a joint's place and of three points along its axes from where they should be, in the unit of `radius`. */
function shellError(a, b, radius) {
  const apart = minus(a.place, b.place);
  const along = [0, 1, 2].map((axis) => length(minus(apart, scaled(minus(column(b.turn, axis), column(a.turn, axis)), radius))));
  return Math.max(length(apart), ...along);
}

/**
 * Compares all frames of a `figure` with `poses(frame)` of a motion whose joints are `source`; `shellCm` is the radius of the shells and `cmPerUnit` the length of a unit
 * of the motion. Returns for each kind of error the greatest one with its joint and frame, and `at(kind, joint, frame)`.
 */
export function compare(figure, source, poses, { shellCm, cmPerUnit, change = (world) => world }) {
  const { joints } = figure;
  checkHelpers(joints);
  const pairs = matched(joints, source), sites = endSites(joints, pairs, source), bounded = boundedOf(joints);
  const names = joints.map(({ name, isEnd, parent }) => (isEnd ? `${joints[parent].name}/end` : name));
  const errors = Object.fromEntries(KINDS.map((kind) => [kind, new Float64Array(joints.length * figure.frames)]));
  const added = joints.some(({ isEnd }, i) => isEnd && !sites[i]) ? figure.offsetUnit * cmPerUnit : 0;
  let extent = 0;
  for (let frame = 0; frame < figure.frames; frame++) {
    const found = change(figure.next(), frame), file = poses(frame), expected = [];
    joints.forEach(({ isEnd, parent, offset }, i) => {
      expected.push(isEnd ? { turn: null, place: carried(expected[parent], sites[i] ?? offset) } : file[pairs[i]] ?? UNTURNED);
      const [a, b] = [expected[i], scaledWorld(found[i], figure.cmPerUnit / cmPerUnit)], at = frame * joints.length + i;
      extent = Math.max(extent, length(a.place) * cmPerUnit);
      if (!bounded[i]) return;
      errors.place[at] = errors.shell[at] = length(minus(a.place, b.place)) * cmPerUnit;
      if (isEnd) return;
      errors.shell[at] = shellError(a, b, shellCm / cmPerUnit) * cmPerUnit;
      errors.rotation[at] = angleBetween(a.turn, b.turn);
      errors.joint[at] = angleBetween(inParent(expected[parent], a), inParent(found[parent], b));
    });
  }
  const worst = (kind) => {
    const index = errors[kind].reduce((most, error, i, all) => (error > all[most] || Number.isNaN(error) ? i : most), 0);
    return { error: errors[kind][index], joint: names[index % joints.length], frame: Math.floor(index / joints.length) };
  };
  const at = (kind, name, frame) => Math.max(...names.map((own, i) => (own === name ? errors[kind][frame * joints.length + i] : 0)));
  return { ...Object.fromEntries(KINDS.map((kind) => [kind, worst(kind)])), at, extent, added, joints: bounded.filter(Boolean).length };
}

const scaledWorld = ({ turn, place }, factor) => ({ turn, place: scaled(place, factor) });

/** Turns a joint of a pose, with what it carries, by the rotation `turn` in the world: a clip that is wrong on purpose. */
export function turned(joints, world, joint, turn) {
  const pivot = world[joint].place, moved = (own) => ({ turn: product(turn, own.turn), place: chained({ turn, place: pivot }, { turn, place: minus(own.place, pivot) }).place });
  const hangs = joints.map(() => false);
  joints.forEach(({ parent }, i) => (hangs[i] = i === joint || (parent >= 0 && hangs[parent])));
  return world.map((own, i) => (hangs[i] ? moved(own) : own));
}
