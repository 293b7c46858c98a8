// What <pantin-player> loads for a bank (decoder/FORMAT.md 16): its clips by name. What steers a state machine is a module of its own.
const RIG = 1;
const CONTENTS = 2;
const CLIPS = 3;
const MACHINE = 4;
const FEET = 5;

// The clips of a bank. `tools` are what the element's own script has: fields of bytes, bytes with a checksum, what opens rigs and clips, and figures.
export function bankOf(file, tools) {
  const [fieldsOf, checked, openRawRig] = tools;
  const names = [];
  const clips = [];
  const sections = {};
  const must = (holds, problem = "out of bounds") => {
    if (!holds) throw new Error(`pantin: ${problem}`);
  };
  let rig;
  try {
    const { u8, more, take } = fieldsOf(file.subarray(2));
    must((u8() - 1) >>> 1 === 0, "another version of the format");
    while (more()) {
      const kind = u8();
      // Of those that are known here, a bank has one each at most.
      must(!sections[kind] || !kind || kind > FEET);
      sections[kind] = take();
    }
    must(sections[RIG] && sections[CONTENTS] && sections[CLIPS], "ends early");
    const entries = fieldsOf(checked(sections[CONTENTS]));
    const bodies = fieldsOf(sections[CLIPS]);
    while (entries.more()) {
      const name = entries.take();
      must(name.length);
      names.push(new TextDecoder().decode(name));
      clips.push(bodies.take(entries.varint()));
    }
    must(names.length && !bodies.more());
    rig = openRawRig(sections[RIG]);
  } catch (error) {
    throw new Error(`problem with the bank: ${error.message.slice(8)}`);
  }
  return {
    names, clips, rig, tools,
    machine: sections[MACHINE],
    feet: sections[FEET],
    // The clip that was asked for, or the first, and the rig.
    clip(name) {
      const clip = clips[name === null ? 0 : names.indexOf(name)];
      if (!clip) throw new Error(`the bank has no clip ${name}; it has ${names.join(", ")}`);
      return [clip, rig];
    },
    // Lets a player steer the bank's state machine.
    async steer(player) {
      const [{ steer }, { keys }, { LIVE_LINK }] = await Promise.all([import("./pantin-character.js"), file[2] > 1 ? import("./pantin-keys.js") : {}, rig.scalars[0] ? import("./pantin-face.js") : {}]);
      // Layers name scalars, also such as the rig names by their numbers in the list.
      rig.scalars = openRawRig(sections[RIG], LIVE_LINK).scalars;
      return steer(this, player, keys);
    },
  };
}
