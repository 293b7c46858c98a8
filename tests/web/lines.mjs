// The element's figure code beside the firmware's: `node lines.mjs MODULE.wasm CLIP... CHARACTER.ptb`. Over clips, frames and views, in pictures of several sizes, poses
// and strokes are equal to the last bit, also those of a character that travels.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { checked, fieldsOf, openRawClip, openRawRig } from "../../web/packages/decoder/clip.js";
import { openClip } from "../../web/packages/decoder/index.js";
import { bankOf } from "../../web/packages/player/bank.js";
import { steer } from "../../web/packages/player/character.js";
import { figureOf, maths, visitor } from "../../web/packages/player/figure.js";

const SIZES = [[128, 64], [320, 160], [640, 320], [390, 700]];
// Orbit, tilt, whether the camera follows the figure, and the axis that is up in place of the rig's.
const VIEWS = [[-50, 12, true], [0, 0, true], [140, 40, true], [-90, -20, false], [37, 85, true], [-50, 12, false, 1], [10, 5, true, 2]];
const STROKE = 12;
const [CHANNELS, POSE] = [5, 13];

const [, , module, ...clips] = process.argv;
const character = clips.pop();
const wasm = new WebAssembly.Instance(new WebAssembly.Module(readFileSync(module))).exports;
const slot = (wasm.base() + 15) & -16;
const file = slot + ((wasm.slot() + 15) & -16);

function put(bytes) {
  const missing = file + bytes.length - wasm.memory.buffer.byteLength;
  if (missing > 0) wasm.memory.grow(Math.ceil(missing / 65536));
  new Uint8Array(wasm.memory.buffer, file).set(bytes);
  wasm.start(slot);
}

function opened(bytes) {
  put(bytes);
  wasm.arrived(slot, file, bytes.length);
  return wasm.finish(slot);
}

function expected() {
  const count = wasm.strokes(slot);
  const view = new DataView(wasm.memory.buffer, wasm.picture(), STROKE * count);
  return Array.from({ length: count }, (_, index) => {
    const [x, y, u, v] = [0, 2, 4, 6].map((offset) => view.getInt16(STROKE * index + offset, true));
    const [shade, part, width] = [8, 9, 10].map((offset) => view.getUint8(STROKE * index + offset));
    return [x, y, u, v, shade, part, width];
  });
}

const summary = { clips: 0, pictures: 0, lines: 0, poses: 0 };
for (const clip of clips) {
  const bytes = readFileSync(clip);
  assert.equal(opened(bytes), 0, clip);
  const player = openClip(bytes).play();
  if (!player.clip.joints.length) continue;
  const { frames } = player.clip;
  const figure = figureOf(player.clip, player.raw);
  const chosen = [0, 1, 2, frames >> 2, frames >> 1, frames - 1].filter((frame) => frame < frames);
  summary.clips++;
  for (const frame of chosen) {
    wasm.go(slot, frame);
    player.seek(frame);
    const facts = new Uint32Array(wasm.memory.buffer, wasm.facts(slot), 18);
    assert.deepEqual([...new Int32Array(wasm.memory.buffer, facts[POSE], facts[CHANNELS])], [...player.raw], `${clip} frame ${frame}`);
    summary.poses++;
  }
  for (const [width, height] of SIZES) {
    for (const [orbit, tilt, isFollowing, axis] of VIEWS) {
      assert.equal(wasm.aim(slot, width, height, orbit, tilt, +!isFollowing + 2 * (axis === undefined ? 0 : axis + 1)), 0);
      figure.aim(width, height, orbit, tilt, isFollowing, axis, visitor(player.clip, frames, (frame) => player.seek(frame).raw));
      for (const frame of chosen) {
        wasm.go(slot, frame);
        player.seek(frame);
        figure.place(player.raw);
        const theirs = expected();
        const own = [];
        figure.each((x, y, u, v, shade, part, width) => own.push([x, y, u, v, shade, part, width]));
        const what = `${clip} frame ${frame}, ${width}x${height}, view ${[orbit, tilt, isFollowing, axis]}`;
        assert.equal(own.length, theirs.length, what);
        summary.pictures++;
        assert.deepEqual(own, theirs, what);
        summary.lines += own.length;
      }
    }
  }
}

// Rotations where the firmware's integers end. A map that turns by less than can be told is no rotation: the square of its angle is rounded down, to no less than 0. The square of a
// quaternion is no greater than 32 bits.
const turned = (kinds, values) => {
  const joints = [{ name: "", parent: -1, kinds, first: 0, rest: [0, 0, 0] }];
  const [, , , , , turns, , inWorld] = figureOf({ rig: { joints, exponent: 0 }, joints, exponent: 0 }, []).inner();
  inWorld(values, [0, 0, 0]);
  return [...turns.slice(0, 9)];
};
for (const map of [[-1, 0, 0], [0, -5000, 5], [-9, -9, -9]]) assert.deepEqual(turned([10, 11, 12], map), [32768, 0, 0, 0, 32768, 0, 0, 0, 32768], `${map}`);
assert.deepEqual(turned([6, 7, 8, 9], [33570, -34560421, 3585, 535762059]), [-32500, 4, -4209, -4, -32772, 0, -4209, 0, 32497]);

// The character's inputs are fired one after the other while it walks on and off.
const bytes = readFileSync(character);
put(bytes);
assert.equal(wasm.machine(slot, file, bytes.length), 0);
const player = { draw() {}, dispatchEvent() {} };
const actor = steer(bankOf(bytes, [fieldsOf, checked, openRawRig, openRawClip, figureOf, maths]), player, undefined);
const states = new Set();
let turn = 0;
const pass = (time) => {
  assert.equal(player.states[wasm.update(slot, time) & 255], (actor.pass(time), player.state));
  states.add(player.state);
};
pass(0);
for (const [width, height] of SIZES) {
  for (const [orbit, tilt, isFollowing, axis] of VIEWS) {
    assert.equal(wasm.aim(slot, width, height, orbit, tilt, +!isFollowing + 2 * (axis === undefined ? 0 : axis + 1)), 0);
    actor.aim([width, height, orbit, tilt, isFollowing, axis]);
    for (let picture = 0; picture < 60; picture++, turn++) {
      const act = (name, what) => (wasm.input(slot, player.inputs.indexOf(name), what), actor.input(name, what));
      if (turn % 400 === 0) act("go", 1);
      if (turn % 400 === 200) act("go", 0);
      if (turn % 31 === 0) act(player.inputs[(turn / 31) % player.inputs.length], 2);
      pass(33333 + (turn % 7) * 5000);
      const own = [];
      actor.each((...stroke) => own.push(stroke));
      assert.deepEqual(own, expected(), `${character} picture ${turn}, ${width}x${height}, view ${[orbit, tilt, isFollowing, axis]}`);
      summary.pictures++;
      summary.lines += own.length;
    }
  }
}
assert.ok(states.size > 10, `${states.size} states`);
console.log(JSON.stringify({ ...summary, states: states.size }));
