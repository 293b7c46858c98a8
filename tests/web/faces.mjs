// The element's face beside the firmware's: `node faces.mjs MODULE.wasm SCRIPT.js CLIP...`. Over clips, frames, sizes and views, lines are equal to the last bit.
import assert from "node:assert/strict";
import { copyFileSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { openClip } from "../../web/packages/decoder/index.js";
import { maths } from "../../web/packages/player/figure.js";

// Pixels of the part of the picture, and of what is left of it.
const SIZES = [[64, 64, 0], [120, 130, 7], [300, 200, 100], [700, 700, 0]];
// Orbit and tilt.
const VIEWS = [[0, 0], [30, 10], [-70, -20], [140, 60]];
const STROKE = 12;

const [, , module, script, ...clips] = process.argv;
// Node takes a script for a module by its name.
const folder = mkdtempSync(join(tmpdir(), "pantin-faces-"));
copyFileSync(script, join(folder, "face.mjs"));
const { faceOf } = await import(join(folder, "face.mjs"));
rmSync(folder, { recursive: true });
const wasm = new WebAssembly.Instance(new WebAssembly.Module(readFileSync(module))).exports;
const slot = (wasm.base() + 15) & -16;
const pose = slot + ((wasm.slot() + 15) & -16);
wasm.memory.grow(4);
const memory = () => wasm.memory.buffer;

function expected(raw, camera) {
  // The camera is set up again for each pose: while the head does not turn, the firmware projects some points of the neck as if they turned with it, a sixteenth of a pixel off.
  wasm.aim(slot, ...camera);
  new Int32Array(memory(), pose, raw.length).set(raw);
  const count = wasm.place(slot, pose, raw.length);
  const view = new DataView(memory(), wasm.picture(), STROKE * count);
  return Array.from({ length: count }, (_, index) => {
    const at = STROKE * index;
    return [...[0, 2, 4, 6].map((offset) => view.getInt16(at + offset, true)), ...[8, 9, 10].map((offset) => view.getUint8(at + offset))];
  });
}

const summary = { faces: 0, pictures: 0, lines: 0 };
for (const file of clips) {
  const player = openClip(readFileSync(file)).play();
  const { clip } = player;
  const { scalarBytes, channels } = clip.rig;
  const count = clip.scalars.length;
  new Uint8Array(memory(), pose, scalarBytes.length).set(scalarBytes);
  const isFace = !!wasm.bind(slot, pose, scalarBytes.length, count, channels - count);
  const face = await faceOf(clip, maths);
  assert.equal(!!face.isFace, isFace, file);
  if (!isFace) continue;
  summary.faces++;
  const stride = Math.max(1, Math.ceil(clip.frames / 40));
  for (const [width, height, right] of SIZES) {
    for (const [orbit, tilt] of VIEWS) {
      const view = [width, height, right, orbit, tilt];
      face.aim(...view);
      for (let frame = 0; frame < clip.frames; frame += stride) {
        const { raw } = player.seek(frame);
        const own = [];
        face.each(raw, (...stroke) => own.push(stroke));
        assert.deepEqual(own, expected(raw, view), `${file}, frame ${frame}, ${width}x${height}, ${orbit} and ${tilt} degrees`);
        summary.pictures++;
        summary.lines += own.length;
      }
    }
  }
}
assert.ok(summary.faces > 15 && summary.lines > 1e5);
console.log(JSON.stringify(summary));
