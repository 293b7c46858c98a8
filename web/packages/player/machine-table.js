// The table of a state machine in a bank, which MACHINE.md of the firmware's animator describes: its rows and names, and the joints of its layers.
import { abs } from "../decoder/turning.js";
import { NORMAL } from "./track.js";

// Causes of transitions.
export const END = 0;
export const INPUT = 1;
export const RELEASED = 2;
export const EVENT = 3;
export const ABOVE = 4;
// No second clip; of a transition, a start in step with the old clip.
export const NOTHING = 255;
// A layer's fade is in units of this many microseconds.
const FADE_UNIT = 15625;

const must = (holds) => {
  if (!holds) throw new Error("pantin: bad state machine");
};
const textOf = (bytes) => new TextDecoder("utf-8", { fatal: true, ignoreBOM: true }).decode(bytes);
// Texts as letters that are bytes.
const lettersOf = (bytes) => String.fromCharCode(...bytes);

// The rows of a table whose checksum is right, for a bank with a number of clips: every row that another names is there.
export const tableOf = (bytes, clips) => {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  must(bytes.length > 7);
  const [version, states, transitions, parameters, inputs, first, any, layers] = bytes;
  let at = 8;
  const rows = (count, length, of) => Array.from({ length: count }, () => {
    must(at + length <= bytes.length);
    at += length;
    return of((offset) => bytes[at - length + offset], (offset) => view.getInt16(at - length + offset, true));
  });
  must(version === 1 && states < 65 && parameters < 9 && inputs < 33 && layers < 5 && first < states);
  const table = {
    first, any,
    states: rows(states, 8, (byte, number) => ({ clip: byte(0), other: byte(1), by: byte(2), flags: byte(3), speed: 256 * number(4), from: byte(6), count: byte(7) })),
    transitions: rows(transitions, 8, (byte, number) => ({ cause: byte(0), argument: byte(1), threshold: number(2), to: byte(4), kind: byte(5), frames: byte(6), start: byte(7) })),
    parameters: rows(parameters, 6, (_, number) => [number(0), number(2), number(4)]),
    layers: rows(layers, 12, (byte) => ({ clip: byte(0), input: byte(1), fade: byte(2) * FADE_UNIT, flags: byte(3), states: [4, 5, 6, 7, 8, 9, 10, 11].map(byte) })),
  };
  const takeNames = (count) => {
    const found = [];
    while (found.length < count) {
      must(at < bytes.length);
      found.push(bytes.subarray(at + 1, (at += 1 + bytes[at])));
    }
    must(at <= bytes.length);
    return found;
  };
  // A name that is no text is empty, but a layer's has to be one.
  const texts = (count) => takeNames(count).map((name) => {
    try {
      return textOf(name);
    } catch {
      return "";
    }
  });
  const found = [texts(states), texts(parameters), texts(inputs)];
  takeNames(layers).forEach((name, index) => {
    let isText = true;
    try {
      textOf(name);
    } catch {
      isText = false;
    }
    must(isText);
    table.layers[index].patterns = lettersOf(name).split("\n");
  });
  must(at === bytes.length);
  must(table.parameters.every(([low, high, value]) => low < high && value >= low && value <= high));
  must(table.layers.every(({ clip, input, flags }) => clip < clips && input < inputs && !flags));
  const leads = ({ from, count }) => {
    const own = table.transitions.slice(from, from + count);
    const causes = own.map(({ cause, argument, threshold, to, kind }) => {
      must(cause < 6 && kind < 3 && to < states);
      must(cause === END || cause === EVENT || argument < (cause < ABOVE ? inputs : parameters));
      return [cause, cause && argument, cause < ABOVE ? 0 : threshold].join();
    });
    must(from + count <= transitions && new Set(causes).size === count);
    return own;
  };
  const anywhere = leads({ from: 0, count: any });
  const ways = table.states.map((row) => {
    must(row.clip < clips && !row.flags && abs(row.speed) <= 4 * NORMAL && (row.other === NOTHING || (row.other < clips && row.by < parameters)));
    return leads(row);
  });
  // Transitions lead from the first state to every other.
  const reached = new Set([first, ...anywhere.map(({ to }) => to)]);
  for (const state of reached) ways[state].forEach(({ to }) => reached.add(to));
  must(reached.size === states);
  return Object.assign(table, { anywhere, ways, names: found });
};

// Whether letters match a pattern, in which * stands for any of them and ? for one. Takes as many steps as the product of the lengths, at most.
const matches = (pattern, name) => {
  let from = 0;
  let behind = 0;
  let taken = 0;
  for (let at = 0; at < name.length; ) {
    if (pattern[from] === "*") {
      behind = ++from;
      taken = at;
    } else if (from < pattern.length && (pattern[from] === "?" || pattern[from] === name[at])) at++, from++;
    else if (behind) {
      from = behind;
      at = ++taken;
    } else return false;
  }
  while (pattern[from] === "*") from++;
  return from === pattern.length;
};
// What patterns name of a rig: joints, those below where a pattern ends with " +", and scalars behind the joints.
export const maskOf = ({ joints, scalars }, patterns) => {
  const mask = new Set();
  const letters = (name) => lettersOf(new TextEncoder().encode(name));
  for (const line of patterns) {
    const isBelow = line.endsWith(" +");
    const pattern = isBelow ? line.slice(0, -2) : line;
    const hanging = new Set();
    let found = false;
    joints.forEach(({ name, isEnd, parent }, index) => {
      const own = !isEnd && matches(pattern, letters(name));
      found ||= own;
      if (own || (isBelow && hanging.has(parent))) hanging.add(index);
    });
    scalars.forEach(({ name }, index) => matches(pattern, letters(name)) && ((found = true), hanging.add(joints.length + index)));
    must(found);
    hanging.forEach((index) => mask.add(index));
  }
  return mask;
};
