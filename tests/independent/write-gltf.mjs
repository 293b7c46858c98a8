// Writes a figure of random.mjs as glTF: a rotation track for each joint that turns, with its own kind of keys, and a translation track for each that moves.

/** The text of a glTF file whose buffer is within it. */
export function asGltf({ joints, frames, fps }) {
  const bytes = [], bufferViews = [], accessors = [], samplers = [], channels = [];
  const store = (rows, type) => {
    const numbers = Float32Array.from(rows.flat()), at = bytes.reduce((sum, part) => sum + part.length, 0);
    bytes.push(Buffer.from(numbers.buffer));
    bufferViews.push({ buffer: 0, byteOffset: at, byteLength: 4 * numbers.length });
    const ends = type === "SCALAR" ? { min: [numbers[0]], max: [numbers.at(-1)] } : {};
    return accessors.push({ bufferView: bufferViews.length - 1, componentType: 5126, count: rows.length, type, ...ends }) - 1;
  };
  const track = (node, path, keys, values, type, interpolation) => {
    const zero = values[0].map(() => 0), rows = interpolation === "CUBICSPLINE" ? values.flatMap((value) => [zero, value, zero]) : values;
    samplers.push({ input: store(keys.map((frame) => [frame / fps]), "SCALAR"), output: store(rows, type), interpolation });
    channels.push({ sampler: samplers.length - 1, target: { node, path } });
  };
  const nodes = joints.map(({ name, offset, scale, order, places, grows, asMatrix }, index) => {
    const children = joints.flatMap(({ parent }, i) => (parent === index ? [i] : []));
    const [x, y, z] = scale ?? [1, 1, 1], stands = !order && !places && !grows; // what tracks move has no matrix
    if (stands && asMatrix) return { name, matrix: [0, x, 0, 0, -y, 0, 0, 0, 0, 0, z, 0, ...offset, 1], ...(children.length > 0 && { children }) };
    return { name, translation: offset, ...(scale && { scale }), ...(children.length > 0 && { children }) };
  });
  joints.forEach(({ order, turns, places, still, smooth, every, grows }, node) => {
    const keys = Array.from({ length: frames }, (_, frame) => frame).filter((frame) => frame % every === 0 || frame === frames - 1);
    if (order) track(node, "rotation", keys, keys.map((frame) => quaternion(order, turns.map((turn) => still + turn(frame / fps)))), "VEC4", smooth);
    if (places) track(node, "translation", keys, keys.map((frame) => places.map(({ rest, at }) => rest + at(frame / fps))), "VEC3", smooth);
    if (grows) track(node, "scale", keys, keys.map((frame) => [1 + Math.abs(grows(frame / fps)), 1, 1.5]), "VEC3", "LINEAR");
  });
  if (channels.length === 0) track(0, "rotation", [0], [[0, 0, 0, 1]], "VEC4", "LINEAR");
  const buffer = Buffer.concat(bytes), uri = `data:application/octet-stream;base64,${buffer.toString("base64")}`;
  return JSON.stringify({
    asset: { version: "2.0" }, scene: 0, scenes: [{ nodes: [0] }], nodes, animations: [{ samplers, channels }], skins: [{ joints: nodes.map((_, i) => i) }],
    buffers: [{ uri, byteLength: buffer.length }], bufferViews, accessors,
  });
}

/** Turns about the axes of `order` in degrees, each about the axis as turned before, as x, y, z, w. */
function quaternion(order, degrees) {
  return [...order].reduce((q, letter, i) => {
    const half = (degrees[i] * Math.PI) / 360, axis = "XYZ".indexOf(letter), r = [0, 0, 0, Math.cos(half)];
    r[axis] = Math.sin(half);
    const [x, y, z, w] = q, [a, b, c, d] = r;
    return [w * a + x * d + y * c - z * b, w * b - x * c + y * d + z * a, w * c + x * b - y * a + z * d, w * d - x * a - y * b - z * c];
  }, [0, 0, 0, 1]);
}
