// Prints what decode.mjs reads of many damaged clips or banks, one line each:
//   node mutants.mjs VECTORS MUTANTS VALUES FRAMES EVENTS [banks]
// MUTANTS holds for each clip or bank its length as a u32 and its bytes. The numbers limit what is compared of a clip.
import { readFileSync } from "node:fs";
import { decode, decodeBank } from "./decode.mjs";

const [vectors, mutants, ...rest] = process.argv.slice(2), [VALUES, FRAMES, EVENTS] = rest.map(Number), banks = rest.length > 3;
const tables = JSON.parse(readFileSync(`${vectors}/tables.json`)), rig = readFileSync(`${vectors}/rig-apart.rig`);
const all = readFileSync(mutants);

const hash = (pose) => pose.reduce((hash, value) => Math.imul(hash ^ value, 0x01000193), 0x811c9dc5) >>> 0;

/** What a decoder makes of bytes; null if it refuses them. */
function opened(open) {
  try { return open(); }
  catch (error) { if (error.constructor !== Error) throw error; return null; }
}

const describe = (bytes) => describeClip(opened(() => decode(bytes, tables, rig, { index: false })));

function describeBank(bytes) {
  const bank = opened(() => decodeBank(bytes, tables, (open) => opened(open), { index: false }));
  if (!bank) return "refused";
  return [`${bank.rig.joints.length} joints`, ...bank.clips.map(({ bytes, clip }) => `${bytes.length} bytes: ${describeClip(clip)}`)].join("; ");
}

function describeClip(clip) {
  if (!clip) return "refused";
  const events = clip.events.slice(0, EVENTS).map(([frame, id]) => ` ${frame}:${id}`).join(""), player = clip.player(), poses = [];
  const frames = Math.min(clip.frames, 1 + Math.floor(VALUES / Math.max(clip.channels, 1)), FRAMES);
  for (let frame = 0; frame < frames; frame++) {
    if (frame > 0) player.step();
    poses.push(` ${hash(player.pose()).toString(16).padStart(8, "0")}`);
  }
  return `${clip.frames} frames of ${clip.frame_time_ns} ns, exponent ${clip.length_exponent}, looped ${clip.looped}, ` +
    `${clip.joints} joints, ${clip.channels} channels, ${clip.moving} moving, ${clip.events.length} events${events}, poses${poses.join("")}`;
}

const lines = [];
for (let at = 0; at < all.length;) {
  const length = all.readUInt32LE(at);
  lines.push((banks ? describeBank : describe)(all.subarray(at + 4, (at += 4 + length))));
}
process.stdout.write(lines.join("\n") + "\n");
