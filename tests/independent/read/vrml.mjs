// Reads VRML97: Transforms whose places and rotations routes from interpolators move. All interpolators belong to one TimeSensor.
import { UNMOVED, add, chained, diagonal, nearestRotation, ofQuaternion, product, scaled, transposed } from "../maths.mjs";

/** The fields that routes move, with their values where a node gives none. */
const RESTS = { translation: [0, 0, 0], rotation: [0, 0, 1, 0], scale: [1, 1, 1], scaleOrientation: [0, 0, 1, 0] };

/** A motion over time. */
export function readVrml(bytes) {
  const { roots, routes, named } = readWorld(bytes.toString("latin1"));
  const track = (name, field) => {
    const route = routes.find(({ to, into }) => to === name && into.replace(/^set_/, "") === field);
    return route && named.get(route.from);
  };
  const joints = [], locals = [];
  const visit = (nodes, parent) => nodes.filter(({ type }) => type === "Transform").forEach(({ name, fields }) => {
    const index = joints.length, tracks = Object.fromEntries(Object.keys(RESTS).map((field) => [field, track(name, field)]));
    joints.push({ name, parent, ends: [], moves: Object.values(tracks).some(Boolean) });
    locals.push(localOf(fields, tracks));
    visit(fields.children ?? [], index);
  });
  visit(roots, -1);
  const sensor = [...named.values()].find(({ type }) => type === "TimeSensor"), [last] = sensor.fields.cycleInterval;
  const pose = (seconds) => {
    const maps = [];
    locals.forEach((local, i) => maps.push(chained(maps[joints[i].parent] ?? UNMOVED, local(Math.min(seconds / last, 1)))));
    return maps.map(({ turn, place }) => ({ turn: nearestRotation(turn), place }));
  };
  return { joints, first: 0, last, pose };
}

/** A transform in its parent at a part of the cycle. */
function localOf(fields, tracks) {
  const center = fields.center ?? [0, 0, 0], at = (field, part) => {
    const rest = fields[field] ?? RESTS[field];
    return tracks[field] ? sample(tracks[field].fields, rest.length, part) : rest;
  };
  return (part) => {
    const [turn, across] = ["rotation", "scaleOrientation"].map((field) => ofQuaternion(quaternionOf(at(field, part))));
    const linear = product(turn, product(product(across, diagonal(at("scale", part))), transposed(across)));
    return chained({ turn: linear, place: add(at("translation", part), center) }, { ...UNMOVED, place: scaled(center, -1) });
  };
}

/** A rotation is an axis with an angle, or, between keys, a quaternion in a fifth place. */
const quaternionOf = ([x, y, z, angle, between]) => {
  const size = Math.hypot(x, y, z), sine = size === 0 ? 0 : Math.sin(angle / 2) / size;
  return between ?? [sine * x, sine * y, sine * z, Math.cos(angle / 2)];
};

function sample({ key, keyValue }, size, part) {
  const next = key.findIndex((time) => time > part), value = (i) => keyValue.slice(size * i, size * i + size);
  if (next <= 0) return value(next === 0 ? 0 : key.length - 1);
  const [a, b] = [value(next - 1), value(next)], t = (part - key[next - 1]) / (key[next] - key[next - 1]);
  if (size === 3) return a.map((x, axis) => x + t * (b[axis] - x));
  return [0, 0, 1, 0, evenly(quaternionOf(a), quaternionOf(b), t)];
}

function evenly(a, b, t) {
  const dot = a.reduce((sum, x, i) => sum + x * b[i], 0), near = b.map((x) => (dot < 0 ? -x : x)), angle = Math.acos(Math.min(Math.abs(dot), 1));
  const [p, q] = angle < 1e-6 ? [1 - t, t] : [Math.sin((1 - t) * angle) / Math.sin(angle), Math.sin(t * angle) / Math.sin(angle)];
  return a.map((x, i) => p * x + q * near[i]);
}

/** The world's nodes: each has a type, the name of its DEF, and fields, which are numbers, words or nodes. */
function readWorld(text) {
  const tokens = text.replace(/#.*/g, "").match(/"(?:[^"\\]|\\.)*"|[{}[\]]|[^\s,{}[\]"]+/g), named = new Map(), roots = [], routes = [];
  let at = 0;
  const isNumber = (token) => /^[-+.\d]/.test(token);
  function node() {
    let name = "";
    if (tokens[at] === "USE") return named.get(tokens[(at += 2) - 1]);
    if (tokens[at] === "DEF") name = tokens[(at += 2) - 1];
    const found = { type: tokens[at], name, fields: {} };
    for (at += 2; tokens[at] !== "}";) if (!route()) found.fields[tokens[at++]] = value();
    at++;
    if (name) named.set(name, found);
    return found;
  }
  function value() {
    if (tokens[at] === "[") {
      const list = [];
      for (at++; tokens[at] !== "]";) list.push(isNumber(tokens[at]) ? Number(tokens[at++]) : tokens[at][0] === '"' ? tokens[at++] : node());
      at++;
      return list;
    }
    if (isNumber(tokens[at])) {
      const numbers = [];
      while (isNumber(tokens[at])) numbers.push(Number(tokens[at++]));
      return numbers;
    }
    return tokens[at + 1] === "{" || tokens[at] === "DEF" || tokens[at] === "USE" ? node() : tokens[at++];
  }
  function route() { // a statement that stands among nodes or among fields
    if (tokens[at] !== "ROUTE") return false;
    const [[from], [to, into]] = [tokens[at + 1].split("."), tokens[at + 3].split(".")];
    routes.push({ from, to, into });
    at += 4;
    return true;
  }
  while (at < tokens.length) if (!route()) roots.push(node());
  return { roots, routes, named };
}
