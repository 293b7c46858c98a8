// Writes a figure of random.mjs as BVH.

/** The text of a BVH file. */
export function asBvh({ joints, frames, fps }) {
  const lines = ["HIERARCHY"], columns = [];
  const write = (index, indent) => {
    const { name, parent, offset, order, end, turns, places, still } = joints[index], inner = `${indent}  `;
    const positions = places ? ["Xposition", "Yposition", "Zposition"] : [], rotations = [...order].map((axis) => `${axis}rotation`);
    lines.push(`${indent}${parent < 0 ? "ROOT" : "JOINT"} ${name}`, `${indent}{`, `${inner}OFFSET ${offset.join(" ")}`);
    lines.push(`${inner}CHANNELS ${positions.length + rotations.length} ${[...positions, ...rotations].join(" ")}`.trimEnd());
    columns.push(...(places ?? []).map(({ rest, at }) => (seconds) => rest + at(seconds)), ...turns.map((turn) => (seconds) => still + turn(seconds)));
    joints.forEach((child, i) => child.parent === index && write(i, inner));
    const isLeaf = !joints.some((child) => child.parent === index);
    if (end || (isLeaf && rotations.length === 0)) lines.push(`${inner}End Site`, `${inner}{`, `${inner}  OFFSET ${(end ?? [0, 0, 0]).join(" ")}`, `${inner}}`);
    lines.push(`${indent}}`);
  };
  write(0, "");
  const row = (frame) => columns.map((column) => column(frame / fps).toFixed(6)).join(" ");
  lines.push("MOTION", `Frames: ${frames}`, `Frame Time: ${1 / fps}`, ...Array.from({ length: frames }, (_, frame) => row(frame)), "");
  return lines.join("\n");
}
