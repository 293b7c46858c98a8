// How much a correct clip may exceed its bound here, and by how much the printed errors may differ from the evaluator's: what rounding explains, and no more.

/** Of lengths, as a part of the largest coordinate: 100 operations in 64 bits, whose steps are 2.2e-16. */
const OF_LENGTHS = 2e-14;
/** In degrees: an arc sine near 180 degrees turns steps of 2.2e-16 into 2e-8 radians, and quaternions have the same loss near half a turn. */
const OF_ANGLES = 2e-6;
/**
 * glTF, FBX and VRML hold numbers of 32 bits, whose steps turn a joint by 1e-5 degrees: the importers take each of three angles that stays below as 0, and places that waver
 * by less than 2e-7 of the largest coordinate as constant. (Of places, the tool subtracts what this takes from the bound.)
 */
const SINGLE_DEGREES = 1e-5 * Math.sqrt(3), SINGLE_PLACES = 2e-7;
const SINGLE = /\.(glb|gltf|fbx|wrl)$/i;

/** Half of a step on each axis: an End Site that the tool adds is only known from the rig, whose offsets are rounded. */
const OF_ADDED = Math.sqrt(3) / 2;

/**
 * The rounding of a comparison: `depth` is the number of joints in the longest chain, `reach` the greatest distance in cm of a bounded point from its joint, and `added`
 * the step in cm of the offsets of End Sites that the motion lacks, 0 if it has all.
 */
export function roundingOf(path, { extent, depth, reach, added }) {
  const single = SINGLE.test(path), turn = single ? SINGLE_DEGREES : 0, plain = OF_LENGTHS * extent * depth;
  const degrees = { rotation: OF_ANGLES + turn * depth, joint: OF_ANGLES + turn }, ofTurns = (turn * depth * reach * Math.PI) / 180;
  const cm = plain + ofTurns + OF_ADDED * added, printed = cm + (single ? SINGLE_PLACES * extent * depth : 0);
  return { bound: { place: cm, shell: cm, ...degrees }, printed: { place: printed, shell: printed, ...degrees } };
}
