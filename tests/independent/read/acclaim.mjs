// Reads Acclaim's figure (.asf) and motion (.amc). A bone begins where its parent ends. A joint's axes at rest are those of the world.
import { ORIGIN, aboutAxis, add, chained, product, radians, scaled, transposed } from "../maths.mjs";

const AXES = { x: 0, y: 1, z: 2 };

/** A motion whose frames are those of the .amc. */
export function readAcclaim(amc, asf) {
  const skeleton = readSkeleton(asf.toString("latin1")), rows = readRows(amc.toString("latin1"));
  const joints = skeleton.bones.map((bone) => ({ name: bone.name, parent: bone.parent, ends: bone.isLeaf ? [bone.vector] : [] }));
  return { joints, cmPerUnit: skeleton.cmPerUnit, rows: rows.length, frame: (frame) => worlds(skeleton, rows[frame]) };
}

/** The turn by three angles about fixed axes, in the order of `axes`. */
const aboutFixed = (axes, angles) => axes.reduce((turn, axis, i) => product(aboutAxis(axis, angles[i]), turn), [1, 0, 0, 0, 1, 0, 0, 0, 1]);

function readSkeleton(text) {
  const lines = text.split(/\r?\n/).map((line) => line.replace(/#.*/, "").trim()), bones = [];
  const toRadians = lines.some((line) => /^angle\s+rad/i.test(line)) ? (angle) => angle : radians;
  const axesOf = (angles, order) => aboutFixed([...order.toLowerCase()].map((letter) => AXES[letter]), angles.map(toRadians));
  const unit = Number(lines.map((line) => /^length\s+(\S+)$/i.exec(line)).find(Boolean)?.[1] ?? 1); // in inches of the motion
  let section = "", bone = null, turnOfRoot = { order: "XYZ", angles: [0, 0, 0] };
  const root = { name: "root", parent: -1, vector: ORIGIN, dofs: [], position: [0, 0, 0] };
  for (const line of lines) {
    const [word, ...rest] = line.split(/\s+/), numbers = rest.map(Number);
    if (word.startsWith(":")) section = word.toLowerCase();
    else if (section === ":root") {
      if (word === "order") root.dofs = rest.map((dof) => dof.toLowerCase());
      if (word === "axis") turnOfRoot.order = rest[0];
      if (word === "position") root.position = numbers;
      if (word === "orientation") turnOfRoot.angles = numbers;
    } else if (section === ":bonedata") {
      if (word === "begin") bones.push((bone = { dofs: [], parent: null }));
      if (word === "name") bone.name = rest[0];
      if (word === "direction") bone.direction = numbers;
      if (word === "length") bone.size = numbers[0];
      if (word === "axis") bone.axes = axesOf(numbers.slice(0, 3), rest[3] ?? "XYZ");
      if (word === "dof") bone.dofs = rest.map((dof) => dof.toLowerCase());
    } else if (section === ":hierarchy" && word && word !== "begin" && word !== "end") {
      for (const child of rest) bones.find(({ name }) => name === child).above = word;
    }
  }
  root.axes = axesOf(turnOfRoot.angles, turnOfRoot.order);
  bones.forEach((each) => (each.vector = scaled(each.direction, each.size)));
  return { bones: sorted([root, ...bones]), toRadians, cmPerUnit: 2.54 / unit };
}

/** Parents before children, with the parents' indices. */
function sorted(bones) {
  const order = [bones[0]];
  for (const bone of order) order.push(...bones.filter(({ above }) => above === bone.name));
  for (const bone of order) {
    bone.parent = order.findIndex(({ name }) => name === bone.above);
    bone.isLeaf = !order.some(({ above }) => above === bone.name);
  }
  return order;
}

function readRows(text) {
  const rows = [];
  for (const line of text.split(/\r?\n/)) {
    const [word, ...values] = line.trim().split(/\s+/);
    if (/^\d+$/.test(word) && values.length === 0) rows.push(new Map());
    else if (rows.length > 0 && word) rows.at(-1).set(word, values.map(Number));
  }
  return rows;
}

function worlds({ bones, toRadians }, row) {
  const found = [];
  for (const bone of bones) {
    const values = row.get(bone.name) ?? bone.dofs.map(() => 0), turns = [], moved = [0, 0, 0];
    bone.dofs.forEach((dof, i) => {
      if (dof[0] === "r") turns.push([AXES[dof[1]], toRadians(values[i])]);
      else if (dof[0] === "t") moved[AXES[dof[1]]] = values[i];
    });
    const turned = aboutFixed(turns.map(([axis]) => axis), turns.map(([, angle]) => angle));
    const turn = product(product(bone.axes, turned), transposed(bone.axes));
    const above = bones[bone.parent];
    found.push(above ? chained(found[bone.parent], { turn, place: above.vector }) : { turn, place: add(bone.position, moved) });
  }
  return found;
}
