// Prints what the element's animator makes of scripts, for comparison with the crate pantin-animator:
//   node animator.mjs play SCRIPT CLIP...  : an animator that begins with the first clip
//   node animator.mjs steer SCRIPT BANKS   : the state machines of banks, each behind its length as a u32
import { readFileSync } from "node:fs";
import { keys } from "../../web/packages/decoder/keys.js";
import { LIVE_LINK } from "../../web/packages/decoder/names.js";
import { checked, fieldsOf, openRawClip, openRawRig } from "../../web/packages/decoder/clip.js";
import { animatorOf } from "../../web/packages/animator/animator.js";
import { bankOf } from "../../web/packages/player/bank.js";
import { opened } from "../../web/packages/animator/open.js";
import { figureOf, maths } from "../../web/packages/player/figure.js";
import { partOf, setSpeed } from "../../web/packages/animator/track.js";

const [, , what, script, ...files] = process.argv;
const lines = readFileSync(script, "utf8").split("\n").filter(Boolean).map((line) => [line[0], ...line.slice(1).split(" ").filter(Boolean).map(Number)]);
const out = [];

function print(start, { left, lost, track, pose, placement: [place, heading], events }) {
  const hash = pose.reduce((hash, value) => Math.imul(hash ^ value, 0x01000193), 0x811c9dc5) >>> 0;
  const fired = events.map(({ id, frame }) => ` ${id}:${frame}`).join("");
  out.push(`${start}${track.player.frame} ${partOf(track)} ${track.speed} ${+track.ended} ${left} ${place.join(" ")} ${heading} ${hash.toString(16).padStart(8, "0")}${fired} ${lost}\n`);
}

// What is refused is an Error; anything else is a fault of the program.
function refuses(act) {
  try {
    act();
  } catch (error) {
    if (error.constructor !== Error || !error.message.startsWith("pantin: ") && !error.message.startsWith("problem with the bank: ")) throw error;
    return true;
  }
}

function play() {
  const poseOf = (_, __, state, channels) => ({ state, channels });
  const clips = files.map((file) => openRawClip(readFileSync(file), undefined, false, { poseOf, keys }));
  const place = (kinds) => kinds.some((kind) => kind < 3);
  let animator;
  if (refuses(() => (animator = animatorOf(clips[0], Math.max(0, clips[0].rig.joints.findIndex(({ kinds }) => place(kinds))))))) return out.push("refused\n");
  print("", animator);
  for (const [word, ...n] of lines) {
    let start = "";
    if (word === "w") start = refuses(() => animator.change(clips[n[0]], n[1], n[2], n[3], n[4])) ? "refused " : "";
    else if (word === "k") animator.seek(n[0]);
    else if (word === "v") setSpeed(animator.track, n[0]);
    else if (word === "s") animator.stand([[BigInt(n[0]), BigInt(n[1])], n[2]]);
    else animator.hold(animator.play(n[0] * 1000));
    print(start, animator);
    if (n.length === 1) animator.events.shift();
    else animator.forget();
  }
}

function steer(file) {
  let character;
  const open = () => {
    // The element tells a bank by its first bytes.
    if (file[0] !== 80 || file[1] !== 98) throw new Error("pantin: not a bank");
    // The element names scalars only where it steers a bank.
    const bank = bankOf(file, [fieldsOf, checked, (bytes) => openRawRig(bytes, LIVE_LINK), openRawClip, figureOf, maths]);
    // The element plays the clips of such a bank.
    if (!bank.machine) throw new Error("pantin: no state machine");
    character = opened(bank, keys);
  };
  if (refuses(open)) return out.push("refused\n");
  const { animator } = character;
  print(`${character.state} `, animator);
  for (const [word, ...n] of lines) {
    if (word === "f") character.fire(n[0]);
    else if (word === "h" || word === "r") character.hold(n[0], word === "h");
    else if (word === "s") character.set(...n);
    else {
      const isRefused = refuses(() => character.update(n[0]));
      print(`${isRefused ? "refused" : +character.entered} ${character.state} `, animator);
    }
  }
}

if (what === "play") play();
else {
  const all = readFileSync(files[0]);
  for (let at = 0; at < all.length; ) {
    const length = all.readUInt32LE(at);
    steer(all.subarray(at + 4, (at += 4 + length)));
  }
}
process.stdout.write(out.join(""));
