// @pantin/animator: the character of a bank (.ptb), steered by its state machine, in plain JavaScript, with the same integers as the firmware's. What follows from them in floating
// point, rotations and places, is of this module alone.
import { checked, fieldsOf, openRawBank, openRawClip } from "../decoder/clip.js";
import { keys } from "../decoder/keys.js";
import { LIVE_LINK } from "../decoder/names.js";
import { poseOf } from "../decoder/pose.js";
import { figureOf, maths } from "../player/figure.js";
import { opened } from "./open.js";

// Sections of a bank (decoder/FORMAT.md 16).
const MACHINE = 4;
const FEET = 5;
// An update takes at most 71 minutes, in microseconds.
const LONGEST_TIME = 2 ** 32 - 1;
const TURN = 2 ** 32;

// The product of two quaternions x, y, z, w.
const product = ([a, b, c, d], [x, y, z, w]) => [d * x + a * w + b * z - c * y, d * y - a * z + b * w + c * x, d * z + a * y - b * x + c * w, d * w - a * x - b * y - c * z];
const write = (values, out, at) => {
  values.forEach((value, index) => (out[at + index] = value));
  return out;
};

/** The character of a bank, in its first state. Throws an Error for bytes that are no bank, or whose state machine, feet or clips are no good. */
export const openCharacter = (data) => {
  const { rig, sections, files } = openRawBank(data, { names: LIVE_LINK, keys });
  if (!sections[MACHINE]) throw new Error("pantin: the bank has no state machine: `pantin machine` writes one into it");
  const character = opened({ clips: files, feet: sections[FEET], machine: sections[MACHINE], rig, tools: [fieldsOf, checked, undefined, openRawClip, figureOf, maths] }, keys);
  const { animator } = character;
  const { track } = animator;
  const [states, parameters, inputs] = character.names;
  const up = rig.up.findIndex(Boolean);
  // Of each clip what its raw values mean.
  const poses = new Map();
  const pose = () => {
    const { clip } = track;
    if (!poses.has(clip)) poses.set(clip, poseOf(clip, animator.pose));
    return poses.get(clip);
  };
  const indexOf = (names, name, kind) => {
    const index = names.indexOf(name);
    if (index < 0) throw new RangeError(`pantin: the state machine has no ${kind} ${name}; it has ${names.join(", ") || "none"}`);
    return index;
  };
  const angle = () => (animator.placement[1] * 2 * Math.PI) / TURN;
  const heading = () => {
    const turn = [0, 0, 0, Math.cos(angle() / 2)];
    turn[up] = Math.sin(angle() / 2);
    return turn;
  };
  const position = () => {
    const place = [0, 0, 0];
    animator.placement[0].forEach((x, index) => (place[(up + 1 + index) % 3] = Number(x) * 2 ** track.clip.exponent));
    return place;
  };
  // A point of the figure where it stands.
  const placed = (turn, [x, y, z], place) => {
    const [a, b, c, d] = turn;
    return product(product(turn, [x, y, z, 0]), [-a, -b, -c, d]).slice(0, 3).map((value, axis) => value + place[axis]);
  };
  const stands = (joint) => rig.joints[joint].parent < 0 && !self.inPlace;
  const self = {
    rig, states, inputs,
    joints: rig.joints,
    scalars: rig.scalars,
    raw: animator.pose,
    inPlace: false,
    parameters: parameters.map((name, index) => {
      const [low, high, value] = character.parameters[index];
      return { name, range: [low, high], value };
    }),
    get state() {
      return states[character.state];
    },
    get clip() {
      return track.clip;
    },
    get events() {
      return animator.events;
    },
    get placement() {
      return { position: position(), heading: angle() };
    },
    fire: (input) => character.fire(indexOf(inputs, input, "input")),
    hold: (input, isDown = true) => character.hold(indexOf(inputs, input, "input"), isDown),
    set: (name, value) => {
      const parameter = self.parameters[indexOf(parameters, name, "parameter")];
      const [low, high] = parameter.range;
      parameter.value = Math.max(low, Math.min(Math.round(value) || 0, high));
      character.set(self.parameters.indexOf(parameter), parameter.value);
    },
    update: (seconds) => {
      character.update(Math.max(0, Math.min(Math.round(seconds * 1e6), LONGEST_TIME)) || 0);
      return self;
    },
    rotation: (joint, out = [], at = 0) => {
      const turn = pose().rotation(joint);
      return write(stands(joint) ? product(heading(), turn) : turn, out, at);
    },
    translation: (joint, out = [], at = 0) => {
      const place = pose().translation(joint);
      return write(stands(joint) ? placed(heading(), place, position()) : place, out, at);
    },
    world: (out = new Float64Array(3 * rig.joints.length), turns = new Float64Array(4 * rig.joints.length)) => {
      pose().world(out, turns);
      const [turn, place] = [heading(), position()];
      rig.joints.forEach((_, joint) => {
        if (self.inPlace) return;
        write(placed(turn, out.subarray(3 * joint, 3 * joint + 3), place), out, 3 * joint);
        write(product(turn, turns.subarray(4 * joint, 4 * joint + 4)), turns, 4 * joint);
      });
      return out;
    },
    scalar: (which) => pose().scalar(which.at ? scalar(which) : which),
    joint: (name) => found(rig.joints, name, "joint"),
  };
  const found = (list, name, kind) => {
    const index = list.findIndex((entry) => name && entry.name === name);
    if (index < 0) throw new Error(`pantin: no ${kind} ${name}`);
    return index;
  };
  const scalar = (name) => found(rig.scalars, name, "scalar");
  return self;
};
