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
// Times are in units of this many microseconds.
const TIME_UNIT = 15625;

export const must = (holds) => {
  if (!holds) throw new Error("pantin: bad state machine");
};
// Nothing for bytes that are no text.
const textOf = (bytes) => {
  try {
    return new TextDecoder("utf-8", { fatal: true, ignoreBOM: true }).decode(bytes);
  } catch {}
};
// Texts as letters that are bytes.
const lettersOf = (bytes) => String.fromCharCode(...bytes);

// The rows of a table whose checksum is right, for a bank with a number of clips: every row that another names is there.
export const tableOf = (fieldsOf, bytes, clips) => {
  const { u8, i8, take, more } = fieldsOf(bytes);
  const i16 = () => u8() | (i8() << 8);
  const rows = (length, of) => Array.from({ length }, of);
  const [version, states, transitions, parameters, inputs, first, any, layers] = take(8);
  must(version === 1 && states < 65 && parameters < 9 && inputs < 33 && layers < 5 && first < states);
  const table = {
    first, any,
    states: rows(states, () => ({ clip: u8(), other: u8(), by: u8(), follow: u8() * TIME_UNIT, speed: 256 * i16(), from: u8(), count: u8() })),
    transitions: rows(transitions, () => ({ cause: u8(), argument: u8(), threshold: i16(), to: u8(), kind: u8(), frames: u8(), start: u8() })),
    parameters: rows(parameters, () => [i16(), i16(), i16()]),
    layers: rows(layers, () => ({ clip: u8(), input: u8(), fade: u8() * TIME_UNIT, flags: u8(), states: take(8) })),
  };
  // A name that is no text is empty, but a layer's has to be one.
  const found = [states, parameters, inputs].map((count) => rows(count, () => textOf(take(u8())) ?? ""));
  table.layers.forEach((layer) => {
    const name = take(u8());
    must(textOf(name) !== undefined);
    layer.patterns = lettersOf(name).split("\n");
  });
  must(!more());
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
    must(row.clip < clips && abs(row.speed) <= 4 * NORMAL && (row.other === NOTHING ? !row.follow : (row.other < clips && row.by < parameters)));
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
