// Opens the character of a bank: its state machine, its clips, and the table of its feet.
import { Q, normalize } from "../decoder/turning.js";
import { clamp, headingOf, nearest, partsOf, rotated, weighted, wide, wideShifted, writtenTo } from "./channels.js";
import { characterOf } from "./machine.js";
import { must, tableOf } from "./machine-table.js";

// The character of a bank, whose key clips need the `keys` of keys.js, and whose feet, if it has a table of them, `feetOf` of feet.js. Throws an Error if its state machine, its
// table of feet, or a clip of it, is no good.
export function opened({ clips, feet, machine, rig, tools: [fieldsOf, checked, , openRawClip, figureOf, maths] }, keys, feetOf) {
  const poseOf = (_, __, state, channels) => ({ state, channels });
  const open = (index) => {
    const clip = openRawClip(clips[index], rig, false, { poseOf, keys });
    if (clip.rig !== rig) throw new Error("pantin: out of bounds");
    return clip;
  };
  return characterOf(rig, tableOf(fieldsOf, checked(machine), clips.length), open, feet && ((animator) => feetOf(fieldsOf(checked(feet)), clips.length, animator, figureOf, maths, [Q, clamp, headingOf, must, nearest, normalize, partsOf, rotated, weighted, wide, wideShifted, writtenTo])));
}
