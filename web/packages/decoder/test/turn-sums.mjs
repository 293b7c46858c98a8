// Compares the rotations of joints at every frame with the checksums in turn-sums.txt, by the Rust decoder: `node turn-sums.mjs [FOLDER]`, by default the
// golden vectors.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { openClip } from "../index.js";
import { findJoint } from "../turns.js";

const folder = process.argv[2] ? pathToFileURL(`${resolve(process.argv[2])}/`) : new URL("../../../../tests/vectors/", import.meta.url);
const read = (name) => readFileSync(new URL(name, folder));
const ORDERS = ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"];

function crc(words) {
  let crc = 0xffff;
  for (const byte of new Uint8Array(Int32Array.from(words).buffer)) {
    crc ^= byte << 8;
    for (let bit = 0; bit < 8; bit++) crc = crc & 0x8000 ? (crc << 1) ^ 0x11021 : crc << 1;
  }
  return crc.toString(16).padStart(4, "0");
}

const clips = new Map();
for (const line of read("turn-sums.txt").toString().trim().split("\n")) {
  const words = line.split(" ");
  if (!clips.has(words[0])) clips.set(words[0], []);
  clips.get(words[0]).push(words);
}
let rotations = 0;
for (const [name, lines] of clips) {
  const clip = openClip(read(`${name}.ptn`));
  const player = clip.play();
  // A joint's name may have spaces.
  const joints = lines.map((words) => [findJoint(player, words.slice(1, -clip.frames).join(" ")), words.slice(-clip.frames)]);
  for (let frame = 0; frame < clip.frames; frame++, player.step()) {
    for (const [joint, wanted] of joints) {
      const angles = ORDERS.flatMap((order) => joint.euler(order));
      const others = [...joint.quaternion(), ...joint.matrix(), joint.angle()];
      const sums = crc(angles) + crc(others);
      // The checksums wrap numbers to 32 bits, and would hide one that is not.
      assert.ok([...angles, ...others].every((number) => number === (number | 0)), `${name}: ${joint.name}, frame ${frame}`);
      assert.equal(sums, wanted[frame], `${name}: ${joint.name}, frame ${frame}`);
      rotations++;
    }
  }
}
assert.ok(rotations);
console.log(`${clips.size} clips, ${rotations} rotations`);
