// Opens the character of a bank: its state machine, its clips, and the table of its feet.
import { feetOf } from "./feet.js";
import { characterOf } from "./machine.js";
import { tableOf } from "./machine-table.js";

// The character of a bank, whose key clips need the `keys` of keys.js. Throws an Error if its state machine, its
// table of feet, or a clip of it, is no good.
export function opened({ clips, feet, machine, rig, tools: [fieldsOf, checked, , openRawClip, figureOf, maths] }, keys) {
  const poseOf = (_, __, state, channels) => ({ state, channels });
  const open = (index) => {
    const clip = openRawClip(clips[index], rig, false, { poseOf, keys });
    if (clip.rig !== rig) throw new Error("pantin: out of bounds");
    return clip;
  };
  return characterOf(rig, tableOf(fieldsOf, checked(machine), clips.length), open, feet && ((animator) => feetOf(fieldsOf(checked(feet)), clips.length, animator, figureOf, maths)));
}
