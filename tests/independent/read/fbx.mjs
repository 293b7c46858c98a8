// Reads FBX: the nodes of a binary file and the curves of one animation stack. What is not in the captured clips is refused.
import { UNMOVED, aboutAxis, add, chained, determinant, diagonal, inverse, nearestRotation, product, radians, scaled } from "../maths.mjs";
import { curveOf } from "./fbx-curve.mjs";
import { scene } from "./fbx-file.mjs";

const SECOND = 46186158000; // units of time
const NONE = [0, 0, 0], ONE = [1, 1, 1], Y_UP = { UpAxis: 1, UpAxisSign: 1, FrontAxis: 2, FrontAxisSign: 1, CoordAxis: 0, CoordAxisSign: 1 };
const PLAYS = /^(LimbNode|Limb|Root|Null|Mesh)$/;

/** A motion over time, of the stack with this number. */
export function readFbx(bytes, number = 0) {
  const file = scene(bytes), stack = file.objects.filter(({ type }) => type === "AnimationStack")[number];
  for (const [name, value] of Object.entries(Y_UP)) if (file.settings[name]?.[0] !== value) throw new Error(`${name} is not that of y up`);
  const layers = file.owned(stack.id, "AnimationLayer");
  if (layers.length !== 1) throw new Error("the stack has more than one layer");
  const curveNodes = new Set(file.owned(layers[0].id, "AnimationCurveNode").map(({ id }) => id));
  const joints = [], locals = [];
  const visit = (id, parent) => file.owned(id, "Model").forEach((model) => {
    const curves = curvesOf(file, model, curveNodes), index = joints.length;
    joints.push({ name: model.name, parent, ends: [], moves: PLAYS.test(model.kind) && !/footsteps$/i.test(model.name) && Object.values(curves).some((curve) => curve.moves) });
    locals.push(localOf(model, curves));
    visit(model.id, index);
  });
  visit(0n, -1);
  const moment = (name) => Number(stack.properties[name]?.[0] ?? 0) / SECOND;
  const pose = (seconds) => {
    const maps = [];
    locals.forEach((local, i) => maps.push(chained(maps[joints[i].parent] ?? UNMOVED, local(seconds * SECOND))));
    return maps.map(({ turn, place }) => ({ turn: nearestRotation(turn), place }));
  };
  return { joints, first: moment("LocalStart"), last: moment("LocalStop"), cmPerUnit: file.settings.UnitScaleFactor[0], pose };
}

/** The curves of a node by property and axis, as in `Lcl Rotation.0`. */
function curvesOf(file, model, curveNodes) {
  const found = {};
  for (const node of file.owned(model.id, "AnimationCurveNode").filter(({ id }) => curveNodes.has(id))) {
    for (const curve of file.owned(node.id, "AnimationCurve")) found[`${node.property}.${"XYZ".indexOf(curve.property.at(-1))}`] = curveOf(curve);
  }
  return found;
}

/** The node's transform in its parent, in the order in which FBX applies pivots and offsets. */
function localOf({ name, properties }, curves) {
  const fixed = (property, otherwise = NONE) => properties[property] ?? otherwise;
  if ((properties.RotationOrder?.[0] ?? 0) !== 0) throw new Error(`${name} has an order of rotations other than xyz`);
  if ((properties.InheritType?.[0] ?? 1) !== 1) throw new Error(`${name} inherits scales in a way of its own`);
  const active = properties.RotationActive?.[0] === 1, [pre, post] = ["PreRotation", "PostRotation"].map((property) => byEuler(active ? fixed(property) : NONE));
  const now = (property, otherwise, time) => fixed(property, otherwise).map((value, axis) => curves[`${property}.${axis}`]?.at(time) ?? value);
  const [rotationPivot, scalingPivot] = [fixed("RotationPivot"), fixed("ScalingPivot")];
  const moved = (by) => ({ ...UNMOVED, place: by });
  return (time) => {
    const turn = product(product(pre, byEuler(now("Lcl Rotation", NONE, time))), inverse(post)), scale = diagonal(now("Lcl Scaling", ONE, time));
    if (determinant(scale) === 0) throw new Error(`${name} has no size`);
    return [
      moved(add(now("Lcl Translation", NONE, time), add(fixed("RotationOffset"), rotationPivot))), { turn, place: NONE },
      moved(add(scaled(rotationPivot, -1), add(fixed("ScalingOffset"), scalingPivot))), { turn: scale, place: NONE }, moved(scaled(scalingPivot, -1)),
    ].reduce(chained);
  };
}

/** Turns about the fixed axes x, y and z, in this order. */
const byEuler = (degrees) => degrees.reduce((turn, angle, axis) => product(aboutAxis(axis, radians(angle)), turn), UNMOVED.turn);
