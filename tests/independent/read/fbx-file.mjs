// Reads the records of a binary FBX file, and its objects with their properties and connections.
import { inflateSync } from "node:zlib";

const HEADER = 27, WIDE = 7500; // bytes before the first record; the version from which on lengths have 64 bits
const NUMBERS = { Y: [2, "readInt16LE"], C: [1, "readInt8"], B: [1, "readInt8"], I: [4, "readInt32LE"], F: [4, "readFloatLE"], D: [8, "readDoubleLE"], L: [8, "readBigInt64LE"] };
const ARRAYS = { f: NUMBERS.F, d: NUMBERS.D, i: NUMBERS.I, l: NUMBERS.L, b: NUMBERS.B };

/** The records of a file: each has a name, values and records of its own. */
export function records(bytes) {
  const wide = bytes.readUInt32LE(23) >= WIDE, field = wide ? 8 : 4;
  const size = (at) => (wide ? Number(bytes.readBigUInt64LE(at)) : bytes.readUInt32LE(at));
  const list = (at, end) => {
    const found = [];
    while (at < end && size(at) !== 0) {
      const [next, count] = [size(at), size(at + field)], nameAt = at + 3 * field + 1, from = nameAt + bytes[nameAt - 1];
      const [values, after] = readValues(bytes, from, count);
      found.push({ name: bytes.toString("latin1", nameAt, from), values, records: after < next ? list(after, next) : [] });
      at = next;
    }
    return found;
  };
  return list(HEADER, bytes.length);
}

function readValues(bytes, at, count) {
  const values = [];
  for (let i = 0; i < count; i++) {
    const type = String.fromCharCode(bytes[at++]);
    if (NUMBERS[type]) {
      values.push(bytes[NUMBERS[type][1]](at));
      at += NUMBERS[type][0];
    } else if (type === "S" || type === "R") {
      const end = at + 4 + bytes.readUInt32LE(at);
      values.push(bytes.toString("utf8", at + 4, end));
      at = end;
    } else {
      const [length, packed, stored] = [0, 4, 8].map((offset) => bytes.readUInt32LE(at + offset)), [width, read] = ARRAYS[type];
      const raw = bytes.subarray(at + 12, at + 12 + stored), data = packed ? inflateSync(raw) : raw;
      values.push(Array.from({ length }, (_, n) => data[read](n * width)));
      at += 12 + stored;
    }
  }
  return [values, at];
}

/** The objects of a file by their ids, the objects that each one has, and the properties of the scene. */
export function scene(bytes) {
  const all = records(bytes), inside = (name) => all.find((record) => record.name === name)?.records ?? [];
  const objects = new Map(inside("Objects").map((record) => [record.values[0], objectOf(record)]));
  const links = inside("Connections").map(({ values: [, child, parent, property] }) => ({ child, parent, property }));
  const settings = propertiesOf(all.find(({ name }) => name === "GlobalSettings"));
  const owned = (id, type) => links.filter(({ parent, child }) => parent === id && objects.get(child)?.type === type).map((link) => ({ ...objects.get(link.child), property: link.property }));
  return { objects: [...objects.values()], owned, settings };
}

function objectOf(record) {
  const [id, name, kind] = record.values, values = (wanted) => record.records.find(({ name }) => name === wanted)?.values[0];
  return { id, type: record.name, name: name.split("\0")[0], kind, properties: propertiesOf(record), values };
}

/** Properties by name, as lists of numbers or texts. */
function propertiesOf(record) {
  const list = record?.records.find(({ name }) => name === "Properties70")?.records ?? [];
  return Object.fromEntries(list.map(({ values: [name, , , , ...rest] }) => [name, rest]));
}
