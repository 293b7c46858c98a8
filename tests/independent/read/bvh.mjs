// Reads BVH: the tree of its joints, and their values frame by frame.
import { IDENTITY, aboutAxis, chained, product, radians } from "../maths.mjs";

const AXES = { X: 0, Y: 1, Z: 2 };

/** A motion whose frames are those of the file. */
export function readBvh(bytes) {
  const tokens = bytes.toString("utf8").split(/\s+/).filter(Boolean), joints = [];
  const start = tokens.indexOf("MOTION"), columns = readTree(tokens.slice(0, start), joints);
  const stated = Number(tokens[tokens.findIndex((token, i) => i > start && /^frames:?$/i.test(token)) + 1]);
  const from = tokens.findIndex((token, i) => i > start && /^time:?$/i.test(token)) + 1;
  const numbers = Float64Array.from(tokens.slice(from + 1), Number);
  if (numbers.some(Number.isNaN)) throw new Error("a frame has a word that is no number");
  return {
    joints,
    rows: Math.min(stated, Math.floor(numbers.length / columns)), // frames beyond the stated number are left out
    frame: (frame) => worlds(joints, numbers.subarray(frame * columns, (frame + 1) * columns)),
  };
}

/** Adds the joints of a HIERARCHY; returns the number of values in a frame. */
function readTree(tokens, joints) {
  const open = []; // the joints whose braces are open, and the End Sites, as null
  let columns = 0, next = null;
  for (let at = 1; at < tokens.length; at++) {
    const word = tokens[at], numbers = (count) => tokens.slice(at + 1, (at += count) + 1).map(Number);
    if (word === "ROOT" || word === "JOINT") {
      const end = tokens.indexOf("{", at), parent = open.findLast(Boolean), name = tokens.slice(at + 1, end).join(" ");
      joints.push((next = { name, parent: parent ? joints.indexOf(parent) : -1, offset: [0, 0, 0], channels: [], ends: [] }));
      at = end - 1;
    } else if (word === "End") {
      next = null;
      at = tokens.indexOf("{", at) - 1;
    } else if (word === "{") open.push(next);
    else if (word === "}") open.pop();
    else if (word === "OFFSET") {
      const offset = numbers(3), joint = open.at(-1);
      if (joint) joint.offset = offset;
      else open.findLast(Boolean).ends.push(offset);
    } else if (word === "CHANNELS") {
      const [count] = numbers(1);
      for (let i = 0; i < count; i++) open.at(-1).channels.push({ word: tokens[++at], column: columns++ });
    }
  }
  return columns;
}

/** Places and rotations of the joints in the world. A position replaces the offset on its axis; rotations apply in their order. */
function worlds(joints, values) {
  const found = [];
  for (const joint of joints) {
    const place = [...joint.offset];
    let turn = IDENTITY;
    for (const { word, column } of joint.channels) {
      const axis = AXES[word[0].toUpperCase()];
      if (/position$/i.test(word)) place[axis] = values[column];
      else turn = product(turn, aboutAxis(axis, radians(values[column])));
    }
    found.push(joint.parent < 0 ? { turn, place } : chained(found[joint.parent], { turn, place }));
  }
  return found;
}
