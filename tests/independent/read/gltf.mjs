// Reads glTF 2.0 (.gltf, .glb): nodes, their animations, accessors.
import { UNMOVED, chained, determinant, diagonal, length, column, ofQuaternion, product } from "../maths.mjs";

const ARRAYS = { 5120: Int8Array, 5121: Uint8Array, 5122: Int16Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array };
const COMPONENTS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT2: 4, MAT3: 9, MAT4: 16 };
const LARGEST = { 5120: 127, 5121: 255, 5122: 32767, 5123: 65535 };

/** A motion over time, of the animation with this number; `companion(uri)` gives the bytes of a buffer beside the file. */
export function readGltf(bytes, companion, number = 0) {
  const file = opened(bytes, companion), nodes = file.json.nodes ?? [];
  const parents = nodes.map(() => -1);
  nodes.forEach(({ children = [] }, index) => children.forEach((child) => (parents[child] = index)));
  const tracks = readTracks(file, number), firsts = tracks.map(({ times }) => times[0]), lasts = tracks.map(({ times }) => times.at(-1));
  const order = depthFirst(nodes, parents), place = (index) => order.indexOf(index);
  const joints = order.map((index) => ({
    name: nodes[index].name?.trim() ? nodes[index].name : `node${index}`, parent: place(parents[index]), ends: [],
    moves: tracks.some(({ node, path }) => node === index && path !== "weights"),
  }));
  const locals = order.map((index) => localOf(nodes[index], tracks.filter(({ node }) => node === index)));
  const pose = (seconds) => {
    const found = [];
    locals.forEach((local, i) => {
      const { map, turn } = local(seconds), above = found[joints[i].parent] ?? { map: UNMOVED, turn: UNMOVED.turn };
      found.push({ map: chained(above.map, map), turn: product(above.turn, turn) });
    });
    return found.map(({ map, turn }) => ({ turn, place: map.place }));
  };
  return { joints, first: Math.min(...firsts), last: Math.max(...lasts), cmPerUnit: 100, pose };
}

function opened(bytes, companion) {
  let json = bytes, ofFile = null;
  if (bytes.toString("latin1", 0, 4) === "glTF") {
    const size = bytes.readUInt32LE(12);
    json = bytes.subarray(20, 20 + size);
    ofFile = bytes.subarray(28 + size);
  }
  json = JSON.parse(json.toString("utf8"));
  const buffers = (json.buffers ?? []).map(({ uri }) => {
    if (uri === undefined) return ofFile;
    const base64 = /^data:[^,]*;base64,(.*)$/s.exec(uri);
    return base64 ? Buffer.from(base64[1], "base64") : companion(decodeURIComponent(uri));
  });
  return { json, buffers };
}

/** The elements of an accessor, each a list of numbers. */
function elements(file, index) {
  const { count, type, componentType, normalized, bufferView, byteOffset = 0, sparse } = file.json.accessors[index];
  const width = COMPONENTS[type], toNumber = normalized ? (n) => Math.max(n / LARGEST[componentType], -1) : (n) => n;
  const all = bufferView === undefined ? Array.from({ length: count }, () => Array(width).fill(0)) : numbers(file, bufferView, byteOffset, componentType, width, count);
  if (sparse) {
    const at = numbers(file, sparse.indices.bufferView, sparse.indices.byteOffset ?? 0, sparse.indices.componentType, 1, sparse.count);
    const values = numbers(file, sparse.values.bufferView, sparse.values.byteOffset ?? 0, componentType, width, sparse.count);
    at.forEach(([index], i) => (all[index] = values[i]));
  }
  return all.map((element) => element.map(toNumber));
}

function numbers(file, viewIndex, offset, componentType, width, count) {
  const view = file.json.bufferViews[viewIndex], Numbers = ARRAYS[componentType], size = width * Numbers.BYTES_PER_ELEMENT;
  const stride = view.byteStride ?? size, begin = (view.byteOffset ?? 0) + offset, buffer = file.buffers[view.buffer];
  const element = (i) => new Numbers(Uint8Array.from(buffer.subarray(begin + i * stride, begin + i * stride + size)).buffer);
  return Array.from({ length: count }, (_, i) => [...element(i)]);
}

function readTracks(file, number) {
  const { channels, samplers } = file.json.animations[number];
  return channels.filter(({ target }) => target.node !== undefined).map(({ target, sampler }) => {
    const { input, output, interpolation = "LINEAR" } = samplers[sampler];
    return { node: target.node, path: target.path, times: elements(file, input).flat(), values: elements(file, output), interpolation };
  });
}

/** A node's transform in its parent over time: the map, and its rotation without scales. */
function localOf(node, tracks) {
  const rest = node.matrix ? fromMatrix(node.matrix) : { translation: [0, 0, 0], rotation: [0, 0, 0, 1], scale: [1, 1, 1], ...node };
  const track = (path) => tracks.findLast((track) => track.path === path);
  const read = (path) => { const found = track(path); return found ? (seconds) => sample(found, seconds) : () => rest[path]; };
  const [translation, rotation, scale] = ["translation", "rotation", "scale"].map(read);
  return (seconds) => {
    const turn = ofQuaternion(rotation(seconds));
    return { turn, map: { turn: product(turn, diagonal(scale(seconds))), place: translation(seconds) } };
  };
}

function fromMatrix(m) {
  const linear = [m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10]], scale = [0, 1, 2].map((axis) => length(column(linear, axis)));
  if (determinant(linear) < 0) scale[0] = -scale[0];
  return { translation: m.slice(12, 15), rotation: toQuaternion(product(linear, diagonal(scale.map((s) => 1 / s)))), scale };
}

/** The quaternion of a rotation: of four equal forms, the one whose first component is largest. */
function toQuaternion(m) {
  const forms = [
    [m[7] - m[5], m[2] - m[6], m[3] - m[1], 1 + m[0] + m[4] + m[8]],
    [1 + m[0] - m[4] - m[8], m[1] + m[3], m[2] + m[6], m[7] - m[5]],
    [m[1] + m[3], 1 - m[0] + m[4] - m[8], m[5] + m[7], m[2] - m[6]],
    [m[2] + m[6], m[5] + m[7], 1 - m[0] - m[4] + m[8], m[3] - m[1]],
  ];
  const traces = [forms[0][3], forms[1][0], forms[2][1], forms[3][2]];
  return unit(forms[traces.indexOf(Math.max(...traces))]);
}

const unit = (q) => { const size = Math.hypot(...q); return q.map((x) => x / size); };

/** A step begins with its key; a frame whose time is rounded may be this much before it, in seconds. */
const ROUNDED = 1e-5;

function sample({ times, values, interpolation, path }, seconds) {
  const cubic = interpolation === "CUBICSPLINE", key = (i) => values[cubic ? 3 * i + 1 : i], late = interpolation === "STEP" ? ROUNDED : 0;
  const next = times.findIndex((time) => time > seconds + late);
  if (next === 0 || next < 0) return key(next === 0 ? 0 : times.length - 1);
  const i = next - 1, span = times[next] - times[i], t = (seconds - times[i]) / span, [a, b] = [key(i), key(next)];
  if (interpolation === "STEP") return a;
  if (!cubic) return path === "rotation" ? slerp(unit(a), unit(b), t) : a.map((x, n) => x + t * (b[n] - x));
  const out = values[3 * i + 2], into = values[3 * next], [t2, t3] = [t * t, t * t * t];
  return a.map((x, n) => (2 * t3 - 3 * t2 + 1) * x + span * (t3 - 2 * t2 + t) * out[n] + (3 * t2 - 2 * t3) * b[n] + span * (t3 - t2) * into[n]);
}

function slerp(a, b, t) {
  const dot = a.reduce((sum, x, n) => sum + x * b[n], 0), near = dot < 0 ? scaledQuaternion(b, -1) : b;
  const half = Math.asin(Math.min(Math.hypot(...a.map((x, n) => near[n] - x)) / 2, 1)), angle = 2 * half;
  if (angle < 1e-9) return a.map((x, n) => x + t * (near[n] - x));
  const [p, q] = [Math.sin((1 - t) * angle) / Math.sin(angle), Math.sin(t * angle) / Math.sin(angle)];
  return a.map((x, n) => p * x + q * near[n]);
}

const scaledQuaternion = (q, factor) => q.map((x) => x * factor);

function depthFirst(nodes, parents) {
  const order = [], visit = (index) => { order.push(index); (nodes[index].children ?? []).forEach(visit); };
  nodes.forEach((_, index) => parents[index] < 0 && visit(index));
  return order;
}
