// The firmware's modules alone, in node: `node module.mjs PLAYER FACE CLIP...`. Whatever bytes they get, they answer and go on; however these come, the frames
// are the same.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";

const [, , player, facial, ...clips] = process.argv;
const [module, faces] = [player, facial].map((path) => new WebAssembly.Module(readFileSync(path)));
const [OLED, TRUNCATED] = [[128, 64, -50, 12], 3];
// Places of what is known of a clip.
const [PLAYABLE, CHANNELS, SCALARS, SCALARS_AT, SCALARS_LENGTH, POSE] = [1, 5, 10, 11, 12, 13];

// One instance plays all clips, each in a slot and a file of its own; the files of some players move while they come.
const shared = (module) => {
  const wasm = new WebAssembly.Instance(module).exports;
  const free = {};
  let end = (wasm.base() + 15) & -16;
  const take = (size) => {
    if (free[size]?.length) return free[size].pop();
    end += (size + 15) & -16;
    const missing = end - wasm.memory.buffer.byteLength;
    if (missing > 0) wasm.memory.grow(Math.ceil(missing / 65536));
    return end - ((size + 15) & -16);
  };
  const give = (place, size) => (free[size] ??= []).push(place);
  return { ...wasm, take, give };
};
const [wasm, face] = [module, faces].map(shared);
const [SLOT, FILE] = [wasm.take(wasm.slot()), 16384];
const files = [wasm.take(FILE), wasm.take(FILE)];
const faceSlot = face.take(face.slot());
const facePose = face.take(4096);

function fed(bytes, piece, moves, slot = SLOT, places = files) {
  // What was there before is no matter.
  new Uint8Array(wasm.memory.buffer, slot, wasm.slot()).fill(0xa5);
  wasm.start(slot);
  wasm.aim(slot, ...OLED, 0);
  let trouble = 0;
  for (let at = 0, turn = 0; at < bytes.length; at += piece, turn++) {
    const part = bytes.subarray(at, at + piece);
    const place = places[moves ? turn % 2 : 0];
    new Uint8Array(wasm.memory.buffer, place).set(bytes.subarray(0, at + part.length));
    trouble ||= wasm.arrived(slot, place, at + part.length);
    // The old one is another player's from now on.
    if (moves) new Uint8Array(wasm.memory.buffer, places[1 - (turn % 2)], FILE).fill(0x5a);
  }
  return { slot, trouble };
}

const facts = (slot) => new Uint32Array(wasm.memory.buffer, wasm.facts(slot), 14);

// Whether the clip drives a face.
function binds(slot) {
  const known = facts(slot);
  const scalars = new Uint8Array(wasm.memory.buffer, known[SCALARS_AT], known[SCALARS_LENGTH]);
  new Uint8Array(face.memory.buffer, facePose).set(scalars);
  if (!face.bind(faceSlot, facePose, scalars.length, known[SCALARS], known[CHANNELS] - known[SCALARS])) return false;
  face.aim(faceSlot, 64, 64, 64, 0, 0);
  return true;
}

// What the display shows of a frame, the face on the picture's right.
function grey(slot, frame) {
  wasm.go(slot, frame);
  let count = wasm.strokes(slot);
  if (binds(slot) && facts(slot)[PLAYABLE]) {
    const known = facts(slot);
    const pose = new Uint8Array(wasm.memory.buffer, known[POSE], 4 * known[CHANNELS]);
    new Uint8Array(face.memory.buffer, facePose).set(pose);
    const strokes = new Uint8Array(face.memory.buffer, face.picture(), 12 * face.place(faceSlot, facePose, known[CHANNELS]));
    new Uint8Array(wasm.memory.buffer, wasm.picture() + 12 * count).set(strokes);
    count += strokes.length / 12;
  }
  return Buffer.from(new Uint8Array(wasm.memory.buffer, wasm.grey(count), 8192)).toString("latin1");
}

let [troubles, runs] = [new Map(), 0];
for (const clip of clips) {
  const bytes = new Uint8Array(readFileSync(clip));
  const [slot, file] = [wasm.take(wasm.slot()), wasm.take(FILE)];
  const whole = fed(bytes, bytes.length, false, slot, [file]).slot;
  assert.equal(wasm.finish(whole), 0);
  const [frames] = facts(whole);
  // Before the last byte's word, by streams that step and restart; after it, by a player that seeks and goes back.
  for (const piece of [1, 7, 300, bytes.length]) {
    for (const moves of [false, true]) {
      const { slot, trouble } = fed(bytes, piece, moves);
      assert.equal(trouble, 0);
      assert.equal(facts(slot)[PLAYABLE], frames, "all frames are playable before the end is announced");
      wasm.aim(slot, ...OLED, 0);
      for (const frame of [0, 5, 4, 3, frames - 1, frames >> 1, frames + 9, 1]) assert.equal(grey(slot, frame), grey(whole, frame), `${clip} ${piece} ${frame}`);
    }
  }
  for (let frame = frames - 1; frame >= 0; frame--) {
    const back = grey(whole, frame);
    if (frame % 16 === 0) {
      const again = fed(bytes, bytes.length, false).slot;
      wasm.finish(again);
      assert.equal(back, grey(again, frame), `${clip} back to ${frame}`);
    }
  }
  const play = (damaged, piece) => {
    const { slot, trouble } = fed(damaged, piece, runs % 2 > 0);
    const outcome = trouble || wasm.finish(slot);
    for (const frame of [0, 1, 3, 1, 0xffffffff]) grey(slot, frame);
    wasm.strokes(slot);
    runs++;
    troubles.set(outcome, (troubles.get(outcome) ?? 0) + 1);
    return outcome;
  };
  for (let length = 0; length < bytes.length; length++) assert.equal(play(bytes.subarray(0, length), 64), TRUNCATED, `${clip} cut to ${length}`);
  for (let bit = 0; bit < 8 * bytes.length; bit += 3) {
    const damaged = bytes.slice();
    damaged[bit >> 3] ^= 1 << (bit & 7);
    assert.notEqual(play(damaged, 100), 0, `${clip} bit ${bit}`);
  }
}
// Nothing, and tables that end early.
const { slot } = fed(new Uint8Array(), 1, false);
assert.equal(wasm.finish(slot), TRUNCATED);
wasm.start(SLOT);
assert.notEqual(wasm.poses(SLOT, files[0], FILE, 4, 1e9, 1, 0), 0);
console.log(JSON.stringify({ runs, troubles: [...troubles] }));
