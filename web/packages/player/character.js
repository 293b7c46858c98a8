// What <pantin-player> loads for a bank: its clips, and what steers its state machine.
import { bytes, open, seat, strokes } from "./wasm.js";

const FACTS = ["frames", "playable", "frame", "frameTime", "looped", "channels", "moving", "rigBytes", "motionBytes", "joints", "scalars"];
// Where the facts have the event, or the name, that was asked for: its frame, id, address and length.
const EVENT = 14;

// The clips of a bank (decoder/FORMAT.md 16): their names, whether there is a state machine, and a clip's file with its rig.
export function bankOf(file) {
  let at = 3;
  const number = () => {
    for (let value = 0, shift = 0; shift < 35; shift += 7) {
      if (at >= file.length) break;
      const byte = file[at++];
      value += (byte & 127) * 2 ** shift;
      if (byte < 128) return value;
    }
    throw new Error("the bank ends early");
  };
  const take = (length) => {
    if (at + length > file.length) throw new Error("the bank ends early");
    return file.subarray(at, (at += length));
  };
  const sections = {};
  while (at < file.length) sections[file[at++]] = take(number());
  const [rig, contents, clips] = [1, 2, 3].map((kind) => sections[kind]);
  if (!rig || !contents || !clips) throw new Error("the bank ends early");
  const found = [];
  let next = 0;
  file = contents;
  // The last two bytes are a checksum; each clip has its own.
  for (at = 0; at < contents.length - 2; ) {
    const name = new TextDecoder().decode(take(number()));
    const length = number();
    found.push({ name, file: clips.subarray(next, (next += length)) });
  }
  const names = found.map(({ name }) => name);
  return {
    names,
    // A fourth section is a state machine.
    machine: !!sections[4],
    // The clip that was asked for, or the first.
    clip(name) {
      const clip = name === null ? found[0] : found.find((clip) => clip.name === name);
      if (!clip) throw new Error(`the bank has no clip ${name}; it has ${names.join(", ")}`);
      return [clip.file, rig];
    },
  };
}

// Steers the state machine of a bank for a player, which gets its names.
export async function steer(player, file, shown, dispatch) {
  const wasm = await open(new URL("./pantin-character.wasm", import.meta.url));
  const actor = {};
  const { take, close } = seat(wasm, actor);
  const at = take(wasm.slot());
  const place = take(file.length);
  wasm.start(at);
  bytes(wasm, place, file.length).set(file);
  if (wasm.machine(at, place, file.length)) {
    close();
    throw new Error("the bank contradicts itself");
  }
  const facts = () => new Uint32Array(wasm.memory.buffer, wasm.facts(at), EVENT + 4);
  const event = () => {
    const [frame, id, from, length] = facts().subarray(EVENT);
    return { frame, id, name: new TextDecoder().decode(bytes(wasm, from, length)) };
  };
  const names = (kind) => {
    const found = [];
    while (wasm.name(at, kind, found.length)) found.push(event().name);
    return found;
  };
  const [states, inputs, parameters] = [0, 1, 2].map(names);
  Object.assign(player, { states, inputs });
  player.parameters = parameters.map((name, index) => ({ name, range: [0, 1].map((which) => wasm.range(at, index, which)), value: wasm.range(at, index, 2) }));
  return Object.defineProperties(Object.assign(actor, {
    close,
    aim: (width, height, orbit, tilt, isFollowing, axis) => wasm.aim(at, width, height, orbit, tilt, +!isFollowing + (axis === undefined ? 0 : 2 * axis + 2)),
    each: (stroke) => strokes(wasm, wasm.picture(), wasm.strokes(at), stroke),
    // Lets time pass, in microseconds.
    pass(time) {
      const name = states[wasm.update(at, time) & 255];
      shown();
      for (let index = 0; wasm.passed(at, index); index += 1) dispatch("heard", event());
      if (name === player.state) return;
      player.state = name;
      dispatch("state", name);
    },
    // Fires an input (2), holds it down (1) or lets it go (0).
    input(name, what) {
      const index = inputs.indexOf(name);
      if (index < 0) throw new RangeError(`the state machine has no input ${name}; it has ${inputs.join(", ") || "none"}`);
      wasm.input(at, index, what);
    },
    set(name, value) {
      const index = player.parameters.findIndex((parameter) => parameter.name === name);
      if (index < 0) throw new RangeError(`the state machine has no parameter ${name}`);
      const parameter = player.parameters[index];
      const [least, most] = parameter.range;
      parameter.value = Math.max(least, Math.min(most, Math.round(value)));
      wasm.set(at, index, parameter.value);
    },
  }), { facts: { get: () => Object.fromEntries(FACTS.map((name, index) => [name, facts()[index]])) } });
}
