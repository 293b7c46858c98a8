// Opens a motion with the readers of this folder, by the end of its name.
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { readAcclaim } from "./read/acclaim.mjs";
import { readBvh } from "./read/bvh.mjs";
import { readFbx } from "./read/fbx.mjs";
import { readGltf } from "./read/gltf.mjs";
import { readVrml } from "./read/vrml.mjs";

/** Opens the motion `path`; `animation` is a number. */
export function openMotion(path, animation = 0) {
  const bytes = readFileSync(path), beside = (name) => readFileSync(join(dirname(path), name));
  switch (path.slice(path.lastIndexOf(".")).toLowerCase()) {
    case ".bvh": return readBvh(bytes);
    case ".amc": return readAcclaim(bytes, readFileSync(skeletonOf(path)));
    case ".gltf": case ".glb": return readGltf(bytes, beside, animation);
    case ".fbx": return readFbx(bytes, animation);
    case ".wrl": return readVrml(bytes);
    default: throw new Error(`no reader for ${path}`);
  }
}

/** The .asf of the motion's name, or the one that begins as it does. */
function skeletonOf(path) {
  const own = path.replace(/amc$/i, "asf");
  if (existsSync(own)) return own;
  const near = readdirSync(dirname(path)).filter((name) => name.endsWith(".asf")).find((name) => own.includes(name.slice(0, -4)));
  return join(dirname(path), near);
}

/** The joints' worlds on the frames of a clip, which has all frames of the motion, or `count` of them from the frame `from`. In a motion over time, the first key is at frame 0. */
export function posesOf(motion, figure, cut = null) {
  const count = cut?.count ?? motion.rows ?? Math.ceil((motion.last - motion.first) / figure.seconds - 1e-3) + 1, from = cut?.from ?? 0;
  if (count !== figure.frames) throw new Error(`the clip has ${figure.frames} frames, the motion ${count}`);
  return (frame) => (motion.frame ? motion.frame(from + frame) : motion.pose(motion.first + (from + frame) * figure.seconds));
}
