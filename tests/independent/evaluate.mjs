// Converts a motion with the tool, evaluates the clip without it, and compares what it promised, what it printed and what is.
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { promiseOf } from "./bounds.mjs";
import { KINDS, compare } from "./compare.mjs";
import { decode } from "./decode.mjs";
import { figureOf } from "./figure.mjs";
import { length } from "./maths.mjs";
import { openMotion, posesOf } from "./motion.mjs";
import { roundingOf } from "./rounding.mjs";

const TABLES = JSON.parse(readFileSync(new URL("../vectors/tables.json", import.meta.url)));
const PRINTED = {
  place: ["max_error_cm", "worst_joint", "worst_frame"], shell: ["max_shell_cm", "worst_shell_joint", "worst_shell_frame"],
  rotation: ["max_rotation_deg", "worst_rotation_joint", "worst_rotation_frame"],
  joint: ["max_joint_rotation_deg", "worst_joint_rotation_joint", "worst_joint_rotation_frame"],
};
/** What the tool prints in words has so many decimals. */
const DECIMALS = { place: 4, shell: 4, rotation: 3, joint: 3 };
const LINES = {
  place: /^.*error max ([\d.]+) cm.*?(?:\(([^()]*(?:\([^()]*\)[^()]*)*) at frame (\d+)\))?, mean/, shell: /^ *shell error max \(points.*?\) ([\d.]+) cm.*?(?:\((.*) at frame (\d+)\))?, mean/,
  rotation: /^ *rotation error max ([\d.]+) degrees(?: \((.*) at frame (\d+)\))?, against/, joint: /against the parent ([\d.]+) degrees(?: \((.*) at frame (\d+)\))?$/,
};

/** Runs the tool; its report, or `{ refused }` with its message. */
export function convert(tool, motion, clip, options) {
  const words = [motion.path, ...motion.options, ...options.split(" ").filter(Boolean)];
  try {
    const json = execFileSync(tool, ["convert", "--segments", ...words, "-o", clip, "--json"], { stdio: ["ignore", "pipe", "pipe"], maxBuffer: 1 << 28 });
    return JSON.parse(json);
  } catch (error) {
    if (error.status !== 1) throw error;
    return { refused: JSON.parse(error.stdout.toString() || "{}").error ?? error.stderr.toString() };
  }
}

/** The errors of a clip against its motion, whatever the tool says of them. */
export function measure(bytes, motion, radiusCm, change) {
  const clip = decode(bytes, TABLES), figure = figureOf(clip), { joints } = figure;
  const source = openMotion(motion.path, motion.animation), cmPerUnit = motion.cmPerUnit ?? source.cmPerUnit ?? figure.cmPerUnit;
  const moves = change && ((world, frame) => change(joints, world, frame));
  const found = compare(figure, source.joints, posesOf(source, figure, motion.cut), { shellCm: radiusCm, cmPerUnit, change: moves });
  const chain = [], reach = joints.filter(({ isEnd }) => isEnd).map(({ offset }) => length(offset) * cmPerUnit);
  joints.forEach(({ parent }) => chain.push(1 + (chain[parent] ?? 0)));
  const codings = { maps: clip.exponential_joints.length, quaternions: joints.filter(({ kinds }) => kinds.includes(6)).length };
  return { ...found, ...codings, frames: figure.frames, depth: Math.max(...chain), reach: Math.max(radiusCm, ...reach) };
}

/** Converts `motion` and evaluates the clip; `faults` lists broken promises and wrong reports, `null` figures have none. */
export function evaluate(tool, motion, options, { clip, effort = "fast", change, promised = options }) {
  const report = convert(tool, motion, clip, `--effort ${effort} ${options}`);
  if (report.refused) return { refused: report.refused, faults: [] };
  if (report.max_error_cm === undefined) return { jointless: true, faults: [] };
  const { radiusCm, most } = promiseOf(promised, report.figure_height_cm), faults = [];
  const found = measure(readFileSync(clip), motion, radiusCm, change), { bound, printed } = roundingOf(motion.path, found), apart = {};
  if (promised === options && Math.abs(report.shell_radius_cm - radiusCm) > 1e-9 * radiusCm) faults.push(`the shell is ${report.shell_radius_cm} cm, not ${radiusCm}`);
  for (const kind of KINDS) {
    const { error, joint, frame } = found[kind], unit = kind === "place" || kind === "shell" ? "cm" : "degrees";
    if (!(error <= most[kind] + bound[kind])) faults.push(`${kind} of ${joint} at frame ${frame}: ${error} ${unit}, bound ${most[kind]}`);
    faults.push(...wrongReport(kind, found, report, printed[kind]));
    apart[kind] = Math.abs(error - report[PRINTED[kind][0]]);
  }
  return { ...found, most, apart, faults };
}

/** What is wrong in the tool's report of one kind of error: the number, its joint and frame, and the same in words. */
function wrongReport(kind, found, report, slack) {
  const [error, joint, frame] = PRINTED[kind].map((field) => report[field]), faults = [], own = found[kind].error;
  if (!(Math.abs(own - error) <= slack)) faults.push(`${kind}: printed ${error} (${joint} at ${frame}), found ${own} (${found[kind].joint} at ${found[kind].frame})`);
  if (error > slack && !(Math.abs(found.at(kind, joint, frame) - error) <= slack)) faults.push(`${kind}: ${joint} at ${frame} is off by ${found.at(kind, joint, frame)}, printed ${error}`);
  const lines = report.notes.flatMap((note) => note.split("\n")).map((line) => LINES[kind].exec(line)).filter(Boolean), line = lines.at(-1);
  const same = line && line[1] === error.toFixed(DECIMALS[kind]) && (line[2] ?? "") === joint && Number(line[3] ?? 0) === frame;
  if (!same) faults.push(`${kind}: the line says ${line?.slice(1)}, JSON ${[error, joint, frame]}`);
  return faults;
}

/** A new file for a clip in a folder. */
export const clipIn = (folder) => join(folder, "evaluated.ptn");
