// Our figure in lines as a Lottie file, to compare sizes: `node lottie.mjs CLIP OUT`. Limbs are paths; a path has a key where straight lines between keys would be
// more than half a pixel from the figure, in a picture of 480x240 pixels.
import { readFileSync, writeFileSync } from "node:fs";
import { openClip } from "../packages/decoder/index.js";
import { figureOf, visitor } from "../packages/player/figure.js";

const [WIDTH, HEIGHT, APART] = [480, 240, 0.5];
const [, , from, to] = process.argv;
const player = openClip(readFileSync(from)).play();
const { clip } = player;
const figure = figureOf(clip, player.raw);
figure.aim(WIDTH, HEIGHT, -50, 12, true, undefined, visitor(clip, clip.frames, (frame) => player.seek(frame).raw));
const [bones, , , , , , points] = figure.inner();

// Bones one after the other are one path.
const chains = [];
bones.forEach(({ parent, isShown }, index) => {
  if (!isShown) return;
  const above = chains.find((chain) => chain.at(-1) === parent);
  if (above) above.push(index);
  else chains.push([parent, index]);
});
const frames = Array.from({ length: clip.frames }, (_, frame) => {
  figure.place(player.seek(frame).raw);
  return chains.map((chain) => chain.map((joint) => [points[3 * joint] / 16, points[3 * joint + 1] / 16]));
});

// The longest straight lines that stay near enough.
function keysOf(path) {
  const keys = [0];
  const holds = (first, last) => {
    for (let frame = first + 1; frame < last; frame++) {
      const part = (frame - first) / (last - first);
      const off = path[frame].map(([x, y], index) => [0, 1].map((axis) => path[first][index][axis] + part * (path[last][index][axis] - path[first][index][axis]) - [x, y][axis]));
      if (off.some(([x, y]) => Math.hypot(x, y) > APART)) return false;
    }
    return true;
  };
  while (keys.at(-1) < path.length - 1) {
    let last = keys.at(-1) + 1;
    while (last + 1 < path.length && holds(keys.at(-1), last + 1)) last++;
    keys.push(last);
  }
  return keys;
}

const rounded = (place) => place.map((x) => Math.round(x * 10) / 10);
const none = (count) => Array.from({ length: count }, () => [0, 0]);
const shapes = chains.map((chain, which) => {
  const path = frames.map((frame) => frame[which]);
  const k = keysOf(path).map((frame) => ({ t: frame, s: [{ i: none(chain.length), o: none(chain.length), v: path[frame].map(rounded), c: false }], i: { x: 1, y: 1 }, o: { x: 0, y: 0 } }));
  return {
    ty: "gr",
    it: [
      { ty: "sh", ks: { a: 1, k } },
      { ty: "st", c: { a: 0, k: [0.15, 0.17, 0.2, 1] }, o: { a: 0, k: 100 }, w: { a: 0, k: 4 }, lc: 2, lj: 2 },
      { ty: "tr", p: { a: 0, k: [0, 0] }, a: { a: 0, k: [0, 0] }, s: { a: 0, k: [100, 100] }, r: { a: 0, k: 0 }, o: { a: 0, k: 100 } },
    ],
  };
});
const ks = { o: { a: 0, k: 100 }, r: { a: 0, k: 0 }, p: { a: 0, k: [0, 0, 0] }, a: { a: 0, k: [0, 0, 0] }, s: { a: 0, k: [100, 100, 100] } };
const layer = { ty: 4, ip: 0, op: clip.frames, st: 0, sr: 1, ks, shapes };
writeFileSync(to, JSON.stringify({ v: "5.7.0", fr: 1e9 / clip.frameTimeNs, ip: 0, op: clip.frames, w: WIDTH, h: HEIGHT, layers: [layer] }));
