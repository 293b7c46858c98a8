// Clips that are wrong on purpose: whether the evaluator finds it.
import { randomMotion } from "./random.mjs";
import { clipIn, evaluate } from "./evaluate.mjs";
import { aboutAxis, product, radians, transposed } from "./maths.mjs";
import { turned } from "./compare.mjs";

/** A figure of several joints, all within reach of every kind of mistake. */
const SEEDS = Array.from({ length: 40 }, (_, i) => 5000 + i), LOOSE = "--max-error 5cm --max-rotation-error 20", TIGHT = "--max-error 0.2cm --max-rotation-error 0.5";

/** A turn by a quarter of a degree of the last joint about its own y axis, in one frame. */
function twistOfLeaf(joints, world, frame) {
  const leaf = joints.findLastIndex(({ isEnd, isHelper }) => !isEnd && !isHelper), own = world[leaf].turn;
  return frame === 0 ? turned(joints, world, leaf, product(product(own, aboutAxis(1, radians(0.25))), transposed(own))) : world;
}

/** Returns the number of mistakes that were not found, each with a message. */
export function checkThatFaultsAreFound(tool, folder) {
  const motions = SEEDS.map((seed) => randomMotion(seed, folder)), clip = clipIn(folder);
  const found = (options, more) => motions.find((motion) => {
    const { faults, joints = 0 } = evaluate(tool, motion, options, { clip, ...more });
    return joints > 2 && faults.length > 0 && (more.wanted ?? /bound/).test(faults.join());
  });
  const checks = {
    "a loose bound for a tight one": found(LOOSE, { promised: TIGHT, wanted: /place .*bound|shell .*bound/ }),
    "a loose rotation for a tight one": found(LOOSE, { promised: TIGHT, wanted: /rotation of .*bound 0.5/ }),
    "a turned joint": found("--max-joint-error 0.1", { change: twistOfLeaf, wanted: /joint of .*bound 0.1/ }),
    "a report of another pose": found("", { change: twistOfLeaf, wanted: /printed/ }),
  };
  const missed = Object.entries(checks).filter(([, motion]) => !motion).map(([name]) => name);
  for (const name of missed) console.log(`FAULT: the evaluator does not find ${name}`);
  return missed.length;
}
