// The player's modules alone, in node: `node module.mjs PLAYER FACE CLIP...`. Whatever bytes they get, they answer and go on; however these come, the frames
// are the same.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";

const [, , player, facial, ...clips] = process.argv;
const [module, faces] = [player, facial].map((path) => new WebAssembly.Module(readFileSync(path)));
const [OLED, TRUNCATED] = [[128, 64, -50, 12], 3];
// Places of what is known of a clip.
const [PLAYABLE, CHANNELS, SCALARS, SCALARS_AT, SCALARS_LENGTH, POSE] = [1, 5, 10, 11, 12, 13];

function fed(bytes, piece) {
  const wasm = new WebAssembly.Instance(module).exports;
  wasm.aim(...OLED);
  let trouble = 0;
  for (let at = 0; at < bytes.length; at += piece) {
    const part = bytes.subarray(at, at + piece);
    const place = wasm.room(at + part.length);
    assert.notEqual(place, 0);
    new Uint8Array(wasm.memory.buffer, place + at, part.length).set(part);
    trouble ||= wasm.arrived(at + part.length);
  }
  return { wasm, trouble };
}

const facts = (wasm) => new Uint32Array(wasm.memory.buffer, wasm.facts(), 14);

// The face that a clip drives, if it does.
function faceOf(wasm) {
  const known = facts(wasm);
  const scalars = new Uint8Array(wasm.memory.buffer, known[SCALARS_AT], known[SCALARS_LENGTH]);
  const face = new WebAssembly.Instance(faces).exports;
  new Uint8Array(face.memory.buffer, face.room(scalars.length)).set(scalars);
  if (!face.bind(scalars.length, known[SCALARS], known[CHANNELS] - known[SCALARS])) return null;
  face.aim(64, 64, 64, 0, 0);
  return face;
}

// What the display shows of a frame, the face on the picture's right.
function grey(wasm, frame) {
  wasm.go(frame);
  let count = wasm.strokes();
  const face = faceOf(wasm);
  if (face && facts(wasm)[PLAYABLE]) {
    const known = facts(wasm);
    const pose = new Uint8Array(wasm.memory.buffer, known[POSE], 4 * known[CHANNELS]);
    new Uint8Array(face.memory.buffer, face.room(pose.length)).set(pose);
    const strokes = new Uint8Array(face.memory.buffer, face.picture(), 12 * face.place(known[CHANNELS]));
    new Uint8Array(wasm.memory.buffer, wasm.picture() + 12 * count).set(strokes);
    count += strokes.length / 12;
  }
  return Buffer.from(new Uint8Array(wasm.memory.buffer, wasm.grey(count), 8192)).toString("latin1");
}

let [troubles, runs] = [new Map(), 0];
for (const clip of clips) {
  const bytes = new Uint8Array(readFileSync(clip));
  const whole = fed(bytes, bytes.length).wasm;
  assert.equal(whole.finish(), 0);
  const [frames] = facts(whole);
  // Before the last byte's word, by streams that step and restart; after it, by a player that seeks and goes back.
  for (const piece of [1, 7, 300, bytes.length]) {
    const { wasm, trouble } = fed(bytes, piece);
    assert.equal(trouble, 0);
    assert.equal(facts(wasm)[PLAYABLE], frames, "all frames are playable before the end is announced");
    wasm.aim(...OLED);
    for (const frame of [0, 5, 4, 3, frames - 1, frames >> 1, frames + 9, 1]) assert.equal(grey(wasm, frame), grey(whole, frame), `${clip} ${piece} ${frame}`);
  }
  for (let frame = frames - 1; frame >= 0; frame--) {
    const back = grey(whole, frame);
    if (frame % 16 === 0) {
      const again = fed(bytes, bytes.length).wasm;
      again.finish();
      assert.equal(back, grey(again, frame), `${clip} back to ${frame}`);
    }
  }
  const play = (damaged, piece) => {
    const { wasm, trouble } = fed(damaged, piece);
    const outcome = trouble || wasm.finish();
    for (const frame of [0, 1, 3, 1, 0xffffffff]) grey(wasm, frame);
    wasm.strokes();
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
// Nothing, more than there may be, and tables that end early.
const { wasm } = fed(new Uint8Array(), 1);
assert.equal(wasm.finish(), TRUNCATED);
assert.equal(wasm.room((64 << 20) + 1), 0);
assert.notEqual(wasm.poses(4, 1e9, 1, 0), 0);
console.log(JSON.stringify({ runs, troubles: [...troubles] }));
