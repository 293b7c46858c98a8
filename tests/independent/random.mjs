// Rigs and motions of chance, as BVH or glTF: chains and branching figures, odd orders of angles, bones that spin and carry nothing, bones of no
// length, twists alone, clips of one frame, fast turns, odd units, scales, helpers.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { asBvh } from "./write-bvh.mjs";
import { asGltf } from "./write-gltf.mjs";

/** Numbers from 0 to 1 of a seed: xorshift of 32 bits. */
export function chance(seed) {
  let x = (Math.imul(seed, 0x9e3779b1) ^ 0x5bf03635) | 1;
  const next = () => {
    x ^= x << 13;
    x ^= x >>> 17;
    x ^= x << 5;
    return (x >>> 0) / 2 ** 32;
  };
  for (let i = 0; i < 8; i++) next();
  return { next, between: (low, high) => low + (high - low) * next(), below: (n) => Math.floor(n * next()), one: (list) => list[Math.floor(list.length * next())], is: (part) => next() < part };
}

const ORDERS = ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "X", "Y", "Z", "XY", "ZX", "XYX", "ZXZ", "YZY"];
const BOUNDS = [
  "", "--max-error 0.3cm", "--max-error 2cm", "--max-rotation-error 3", "--max-joint-error 2", "--places-only", "--max-error 1cm --shell 8cm", "--shell 2%",
  "--max-error 3cm --max-rotation-error 1 --max-joint-error 0.7", "--places-only --max-rotation-error 4", "--mean-error 0.1cm",
  "--rotations euler --max-rotation-error 2", "--rotations exponential --max-error 1cm", "--rotations exponential --max-joint-error 1", "--rotations quaternion --max-rotation-error 1.5",
];
const UNITS = [1, 1, 1, 2.54, 100, 5.6444, 0.1, 0.001];

/** Edits that cut a motion of these frames, with the frames that are left; of a loop, the last one is left out, as the first one comes again. */
function editOf(random, frames) {
  if (frames < 12 || !random.is(0.25)) return { options: [], from: 0, count: frames };
  const from = random.below(4), to = frames - 1 - random.below(4);
  return { options: ["--from", String(from), "--to", String(to)], from, count: to - from + 1 };
}

/** The motion of a seed, written into a folder, with the options of its conversion and the bound to convert it with. */
export function randomMotion(seed, folder) {
  const random = chance(seed), isGltf = random.is(0.4), cmPerUnit = isGltf ? 100 : random.one(UNITS), frames = random.is(0.1) ? 1 : 2 + random.below(60), fps = random.one([24, 30, 60]);
  const isLoop = frames > 20 && random.is(0.15), figure = { joints: joints(random, { unit: 1 / cmPerUnit, isGltf, cycle: isLoop ? (frames - 1) / fps : null }), frames, fps };
  const path = join(folder, `random-${seed}.${isGltf ? "gltf" : "bvh"}`), stated = isGltf ? ["--fps", String(fps)] : ["--cm-per-unit", String(cmPerUnit)];
  writeFileSync(path, isGltf ? asGltf(figure) : asBvh(figure));
  const edit = isLoop ? { options: ["--loop"], from: 0, count: frames - 1 } : editOf(random, frames);
  return { name: `random ${seed}`, path, options: [...stated, ...edit.options], animation: 0, cmPerUnit, cut: edit, bound: random.one(BOUNDS), mayBeRefused: isLoop };
}

/** The joints of a figure; with `cycle`, in seconds, all but a little comes again after it. */
function joints(random, { unit, isGltf, cycle }) {
  const kind = random.one(["chain", "tree", "spin", "twist", "fast"]), count = kind === "spin" ? 1 + random.below(3) : 2 + random.below(14), all = [];
  const size = random.between(5, 40) * unit;
  for (let i = 0; i < count; i++) {
    const parent = i === 0 ? -1 : kind === "chain" || kind === "fast" ? i - 1 : random.below(i), noLength = i > 0 && random.is(0.12);
    const axis = () => random.between(-size, size), offset = i === 0 || noLength ? [0, 0, 0] : [axis(), axis(), axis()];
    const order = kind === "twist" ? random.one(["X", "Y", "Z"]) : random.is(i > 0 ? 0.1 : 0) ? "" : random.one(ORDERS);
    const moves = i === 0 ? random.is(0.7) : random.is(0.1), isHelper = isGltf && i > 1 && random.is(0.08);
    all.push({
      name: isHelper ? `bone${i}_IK_target` : random.is(0.05) ? "twin" : `bone ${i}`, parent, offset, order, end: random.is(0.3) ? [axis() / 3, size / 3, axis() / 3] : null,
      turns: [...order].map(() => curve(random, kind === "fast" ? 400 : random.one([0, 3, 40, 120]), cycle)), still: random.is(0.1) ? random.between(-90, 90) : 0,
      places: moves ? offset.map((x) => ({ rest: x, at: curve(random, random.one([0.2, 3]) * size, cycle) })) : null,
      scale: isGltf && random.is(0.15) ? [random.between(0.5, 2), random.between(0.5, 2), random.between(0.5, 2)] : null,
      grows: isGltf && random.is(0.06) ? curve(random, 0.3, cycle) : null, asMatrix: isGltf && random.is(0.5),
      smooth: random.one(["LINEAR", "LINEAR", "CUBICSPLINE", "STEP"]), every: random.one([1, 1, 1, 4]),
    });
  }
  return all;
}

/** A value over the seconds: two waves, and sometimes a jump, or, in a cycle, a little drift. */
function curve(random, size, cycle) {
  const rate = () => (cycle ? (2 * Math.PI * (1 + random.below(3))) / cycle : random.between(0.2, 6));
  const waves = [0, 1].map(() => ({ size: random.between(0, size), rate: rate(), phase: random.between(0, 6.3) })), jumps = random.is(0.1) && !cycle ? random.between(0, 1) : Infinity;
  const drift = cycle ? (random.between(-0.002, 0.002) * size) / cycle : 0;
  return (seconds) => waves.reduce((sum, wave) => sum + wave.size * Math.sin(wave.rate * seconds + wave.phase), drift * seconds + (seconds > jumps ? size / 2 : 0));
}
