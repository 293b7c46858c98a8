// What <pantin-player> loads for a bank: its clips, and what steers its state machine.

// The clips of a bank (decoder/FORMAT.md 16): its rig, and each clip's name and file.
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
  // A fourth section is a state machine.
  const machine = !!sections[4];
  const found = [];
  let next = 0;
  file = contents;
  // The last two bytes are a checksum; each clip has its own.
  for (at = 0; at < contents.length - 2; ) {
    const name = new TextDecoder().decode(take(number()));
    const length = number();
    found.push({ name, file: clips.subarray(next, (next += length)) });
  }
  return { rig, clips: found, machine };
}

// The clip that was asked for, or the first, behind the bank's rig.
export function chosen({ rig, clips }, name) {
  const clip = name === null ? clips[0] : clips.find((clip) => clip.name === name);
  if (!clip) throw new Error(`the bank has no clip ${name}; it has ${clips.map((clip) => clip.name).join(", ")}`);
  const both = new Uint8Array(rig.length + clip.file.length);
  both.set(rig);
  both.set(clip.file, rig.length);
  return both;
}

// Steers the state machine in a slot of the module, for a player that gets its names. `event` reads the event, or the name, that the module was asked for.
export function steer(player, wasm, at, event, shown, dispatch) {
  const names = (kind) => {
    const found = [];
    while (wasm.name(at, kind, found.length)) found.push(event().name);
    return found;
  };
  const [states, inputs, parameters] = [0, 1, 2].map(names);
  Object.assign(player, { states, inputs });
  player.parameters = parameters.map((name, index) => ({ name, range: [0, 1].map((which) => wasm.range(at, index, which)), value: wasm.range(at, index, 2) }));
  return {
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
      const index = player.inputs.indexOf(name);
      if (index < 0) throw new RangeError(`the state machine has no input ${name}; it has ${player.inputs.join(", ") || "none"}`);
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
  };
}
