// The evaluator over many motions and bounds:
//   node campaign.mjs PANTIN [--captures FOLDER] [--random N] [--seed S] [--own FOLDER] [--verbose]
// Prints a table of the bounds. Exits with 1 if a bound is broken or a printed error is wrong.
import { mkdtempSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { execFileSync } from "node:child_process";
import { parseArgs } from "node:util";
import { BOUNDS } from "./bounds.mjs";
import { clipIn, evaluate } from "./evaluate.mjs";
import { KINDS } from "./compare.mjs";
import { randomMotion } from "./random.mjs";
import { checkThatFaultsAreFound } from "./mistakes.mjs";

const { positionals: [tool], values } = parseArgs({
  allowPositionals: true,
  options: {
    captures: { type: "string" }, random: { type: "string", default: "0" }, seed: { type: "string", default: "1" }, own: { type: "string" },
    verbose: { type: "boolean", default: false }, only: { type: "string", default: "" },
  },
});
const folder = mkdtempSync(join(tmpdir(), "independent-"));

/** Formats with several animations; a motion for each. */
const ANIMATED = /\.(glb|gltf|fbx|wrl)$/i, CAPTURED = /\.(bvh|amc|glb|gltf|fbx|wrl)$/i;

function captures(place) {
  return readdirSync(place).filter((name) => CAPTURED.test(name) && name.includes(values.only)).sort().flatMap((name) => {
    const path = join(place, name);
    if (!ANIMATED.test(name)) return [{ name, path, options: [], animation: 0 }];
    const list = execFileSync(tool, ["convert", "--list", path, "-q"]).toString().split("\n").filter((line) => /^ *\d+ /.test(line));
    return list.map((_, animation) => ({ name: `${name} ${animation}`, path, options: ["--animation", String(animation)], animation }));
  });
}

/** Our own motions of bodies, as BVH and as glTF files. */
const OWN = ["walk", "run", "kneebend"];

function own(place) {
  return OWN.flatMap((name) => ["bvh", "glb"].map((format) => {
    const path = join(folder, `${name}.${format}`);
    execFileSync(tool, ["expand", join(place, `${name}.ptn`), "-o", path, "-q"]);
    return { name, path, options: [], animation: 0 };
  }));
}

const rows = new Map();
let faults = 0;

function run(motion, options, effort) {
  let result;
  try { result = evaluate(tool, motion, options, { clip: clipIn(folder), effort }); }
  catch (error) { result = { faults: [String(error.stack)] }; }
  add(rows, options || "(defaults)", result);
  const command = [basename(motion.path), ...motion.options, options].join(" ");
  for (const fault of result.faults) console.log(`FAULT: ${command}: ${fault}`);
  faults += result.faults.length;
  const errors = () => KINDS.map((kind) => `${kind} ${result[kind]?.error.toFixed(4)}`).join(", ");
  if (values.verbose || (result.refused && !motion.mayBeRefused)) console.log(`${command}: ${result.refused ?? (result.jointless ? "no joints" : errors())}`);
}

/** Counts, the greatest error of each kind as a part of its bound, and the greatest difference from what was printed. */
function add(rows, name, { refused, jointless, most, apart, frames = 0, joints = 0, maps = 0, quaternions = 0, ...result }) {
  if (!rows.has(name)) rows.set(name, { clips: 0, refused: 0, jointless: 0, frames: 0, poses: 0, maps: 0, quaternions: 0, parts: {}, apart: { cm: 0, degrees: 0 } });
  const row = rows.get(name);
  row.refused += refused ? 1 : 0;
  row.jointless += jointless ? 1 : 0;
  if (!most) return;
  Object.assign(row, { clips: row.clips + 1, frames: row.frames + frames, poses: row.poses + frames * joints, maps: row.maps + maps, quaternions: row.quaternions + quaternions });
  for (const kind of KINDS) {
    const unit = kind === "place" || kind === "shell" ? "cm" : "degrees";
    row.parts[kind] = Math.max(row.parts[kind] ?? 0, result[kind].error / most[kind]);
    row.apart[unit] = Math.max(row.apart[unit], apart[kind]);
  }
}

function print() {
  const percent = (part) => (part > 0 ? `${(100 * part).toFixed(2)} %` : "-");
  const head = ["bound", "clips", "refused", "frames", "joint frames", "maps", "quaternions", ...KINDS, "printed: cm", "degrees"];
  const lines = [...rows].map(([name, { clips, refused, frames, poses, maps, quaternions, parts, apart }]) => [
    name, clips, refused, frames, poses, maps, quaternions, ...KINDS.map((kind) => percent(parts[kind])), apart.cm.toExponential(1), apart.degrees.toExponential(1),
  ]);
  console.log(`| ${head.join(" | ")} |\n|${head.map(() => "---|").join("")}`);
  for (const line of lines) console.log(`| ${line.join(" | ")} |`);
}

try {
  faults += checkThatFaultsAreFound(tool, folder);
  if (values.captures) for (const motion of captures(values.captures)) for (const options of BOUNDS) run(motion, options, options === "" ? "default" : "fast");
  if (values.own) for (const motion of own(values.own)) for (const options of BOUNDS.filter((_, i) => i % 3 === 0)) run(motion, options, "fast");
  for (let i = 0; i < Number(values.random); i++) {
    const motion = randomMotion(Number(values.seed) + i, folder);
    run(motion, motion.bound, "fast");
  }
  print();
  console.log(faults === 0 ? "no bound is broken, and every printed error is right" : `${faults} faults`);
} finally { rmSync(folder, { recursive: true }); }
process.exitCode = faults === 0 ? 0 : 1;
