// Checks the decoder against the golden vectors and against the independent decoder: `node vectors.mjs [DECODER]`, by default index.js beside this folder.
import assert from "node:assert/strict";
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { decode } from "../../../../tests/independent/decode.mjs";

const { openBank, openClip, openRig } = await import(process.argv[2] ? pathToFileURL(resolve(process.argv[2])) : "../index.js");
const { degrees, findJoint } = await import("../turns.js");
const { keys } = await import("../keys.js");
const folder = new URL("../../../../tests/vectors/", import.meta.url);
const keyFolder = new URL("../../../../tests/key-vectors/", import.meta.url);
const read = (name, from = folder) => readFileSync(new URL(name, from));
const json = (name) => JSON.parse(read(name));
const tables = json("tables.json");
const LARGEST = 2 ** 16;

function crc16(words) {
  let crc = 0xffff;
  for (const byte of new Uint8Array(words.buffer)) {
    crc ^= byte << 8;
    for (let bit = 0; bit < 8; bit++) crc = crc & 0x8000 ? (crc << 1) ^ 0x11021 : crc << 1;
  }
  return crc.toString(16).padStart(4, "0");
}

let [poses, vectors] = [0, 0];

// Section 11 of the format by matrices, which the decoder does not use.
const product = (a, b) => a.map((row) => [0, 1, 2].map((column) => row.reduce((sum, value, index) => sum + value * b[index][column], 0)));
const about = ([x, y, z], angle) => {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const t = 1 - c;
  return [[t * x * x + c, t * x * y - s * z, t * x * z + s * y], [t * x * y + s * z, t * y * y + c, t * y * z - s * x], [t * x * z - s * y, t * y * z + s * x, t * z * z + c]];
};
const IDENTITY = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
function placed(clip, raw) {
  const result = [];
  for (const [joint, { parent, kinds, first, offset }] of clip.joints.entries()) {
    // Euler angles coded as an exponential map stand before the joint's own quaternion and map.
    const [at, coded, w, axis] = [[...offset], [0, 0, 0], [0, 0, 0, 0], [0, 0, 0]];
    let matrix = IDENTITY;
    kinds.forEach((kind, index) => {
      const value = raw[first + index];
      if (kind < 3) at[kind] = value * 2 ** clip.exponent;
      else if (kind < 6) matrix = product(matrix, about(IDENTITY[kind - 3], (value / 2 ** 31) * Math.PI));
      else if (kind < 10) w[kind - 6] = value;
      else (clip.rig.joints[joint].kinds[index] < 6 ? coded : axis)[kind - 10] = (value / 2 ** 31) * Math.PI;
    });
    const byMap = (axis) => {
      const angle = Math.hypot(...axis);
      if (angle) matrix = product(matrix, about(axis.map((value) => value / angle), angle));
    };
    byMap(coded);
    if (w.some(Boolean)) {
      const length = Math.hypot(...w);
      const half = Math.hypot(w[1], w[2], w[3]);
      if (half) matrix = product(matrix, about(w.slice(1).map((value) => value / half), 2 * Math.atan2(half / length, w[0] / length)));
    }
    byMap(axis);
    const above = result[parent];
    result.push(above ? { at: above.at.map((value, row) => value + above.matrix[row].reduce((sum, factor, index) => sum + factor * at[index], 0)), matrix: product(above.matrix, matrix) } : { at, matrix });
  }
  return result;
}
let joints = 0;
function poseIsThatOfMatrices(player) {
  const world = player.world();
  const largest = Math.max(1, ...world.map(Math.abs));
  placed(player.clip, player.raw).forEach(({ at }, joint) => {
    at.forEach((value, axis) => assert.ok(Math.abs(value - world[3 * joint + axis]) < 1e-9 * largest, `joint ${joint}: ${at} and ${world.subarray(3 * joint, 3 * joint + 3)}`));
    assert.ok(Math.abs(Math.hypot(...player.rotation(joint)) - 1) < 1e-12);
    joints++;
  });
}

function crcs(clip, name, expected) {
  const player = clip.play();
  for (let frame = 0; frame < clip.frames; frame++) {
    assert.equal(player.frame, frame);
    assert.equal(crc16(player.raw), expected[frame], `${name}: frame ${frame} by steps`);
    if (frame % 9 === 0) poseIsThatOfMatrices(player);
    assert.equal(player.step(), frame + 1 < clip.frames);
  }
  // There and back, near and far.
  const order = [...expected.keys()].filter((frame) => frame % 7 === 0).flatMap((frame) => [frame, (frame * 31) % clip.frames, clip.frames - 1 - frame]);
  for (const [fresh, frames] of [[player, order], [clip.play(), [clip.frames - 1, 0, clip.frames >> 1]]]) {
    for (const frame of frames) {
      assert.equal(crc16(fresh.seek(frame).raw), expected[frame], `${name}: frame ${frame} by a seek`);
      poses++;
    }
  }
  poses += clip.frames;
}

// A bank against its record.
function bankIs(bank, expected) {
  assert.equal(bank.rig.joints.length, expected.joints);
  assert.deepEqual(bank.names, expected.clips.map(([name]) => name));
  for (const [name, , frames, looped, its] of expected.clips) {
    const clip = bank.open(name);
    assert.deepEqual([clip.frames, clip.looped], [frames, looped]);
    crcs(clip, name, its);
  }
  assert.throws(() => bank.open("absent"), /no clip absent/);
}

for (const file of readdirSync(folder).filter((name) => /\.pt[nb]$/.test(name))) {
  const [name, expected] = [file.slice(0, -4), json(`${file.slice(0, -4)}.json`)];
  vectors++;
  if (file.endsWith("b")) {
    bankIs(openBank(read(file)), expected);
    continue;
  }
  const rig = existsSync(new URL(`${name}.rig`, folder)) ? openRig(read(`${name}.rig`)) : undefined;
  const clip = openClip(read(file), rig);
  if (rig) assert.throws(() => openClip(read(file)), /rig is another file/);
  const helpers = clip.joints.flatMap(({ isHelper }, index) => (isHelper ? [index] : []));
  const up = clip.rig.up.findIndex(Boolean);
  assert.deepEqual(
    [clip.frames, clip.frameTimeNs, clip.looped, clip.exponent, clip.joints.length, clip.rig.channels, clip.joints.flatMap(({ kinds }, index) => (kinds === clip.rig.joints[index].kinds ? [] : [index])), helpers, clip.rig.up[up] < 0 ? up + 4 : up, clip.events.map(({ frame, id }) => [frame, id]), clip.eventNames],
    [expected.frames, expected.frame_time_ns, expected.looped, expected.length_exponent, expected.joints, expected.channels, expected.exponential_joints, expected.helpers, expected.up, expected.events, expected.event_names],
    name,
  );
  crcs(clip, name, expected.crcs);
  for (const frame in expected.poses) assert.deepEqual([...clip.play().seek(+frame).raw], expected.poses[frame]);
}

// A bank of key clips and one of segments.
{
  const bytes = read("bank.ptb", keyFolder);
  bankIs(openBank(bytes, keys), JSON.parse(read("bank.json", keyFolder)));
  assert.throws(() => openBank(bytes), /a bank with key clips needs/);
  vectors++;
}

// Key clips, which open with `keys` alone.
for (const file of readdirSync(keyFolder).filter((name) => name.endsWith(".ptn"))) {
  const [name, bytes] = [file.slice(0, -4), read(file, keyFolder)];
  const expected = JSON.parse(read(`${name}.json`, keyFolder));
  const rig = existsSync(new URL(`${name}.rig`, keyFolder)) ? openRig(read(`${name}.rig`, keyFolder)) : undefined;
  assert.throws(() => openClip(bytes, rig), /a key clip needs/);
  const clip = openClip(bytes, rig, false, keys);
  assert.deepEqual([clip.frames, clip.looped, clip.states, clip.events.map(({ frame, id }) => [frame, id]), clip.eventNames], [expected.frames, expected.looped, expected.moving, expected.events, expected.event_names], name);
  crcs(clip, name, expected.crcs);
  vectors++;
  // A part counts by whole blocks of the motion.
  if (clip.motionBytes < 260) continue;
  const arriving = openClip(bytes.subarray(0, -3), rig, true, keys).play();
  assert.deepEqual([arriving.dry, arriving.step(), arriving.frame], [true, false, 0], name);
}

// By name, by time, and scalars.
{
  const clip = openClip(read("scalars.ptn"));
  const expected = json("scalars.json");
  const player = clip.play();
  clip.scalars.forEach(({ name, scale }, index) => {
    assert.equal(player.scalar(index), expected.poses[0][expected.channels - clip.scalars.length + index] * scale);
    if (name) assert.equal(player.scalar(name), player.scalar(clip.scalar(name)));
  });
  assert.throws(() => clip.scalar("nothing"), /no scalar nothing/);
  assert.throws(() => player.scalar("nothing"), /no scalar nothing/);
  assert.throws(() => player.scalar(""), /no scalar/);
  assert.throws(() => player.scalar(clip.scalars.length), /no scalar/);
  const walk = openClip(Uint8Array.from(read("walk.ptn")).buffer);
  const seconds = walk.frameTimeNs / 1e9;
  const later = walk.play();
  assert.equal(later.seekTime(3 * seconds).frame, 3);
  assert.equal(later.seekTime(walk.duration + 2.5 * seconds).frame, walk.looped ? 2 : walk.frames - 1);
  assert.equal(later.seekTime(-seconds).frame, walk.looped ? walk.frames - 1 : 0);
  walk.joints.forEach(({ name, isEnd }, index) => isEnd || assert.equal(walk.joints[walk.joint(name)].name, walk.joints[index].name));
  assert.throws(() => walk.joint("nobody"), /no joint nobody/);
}

// Rotations by joints that were found once, as the decoder in Rust computes them.
let turned = 0;
{
  const ORDERS = ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"];
  const players = new Map();
  const handles = new Map();
  for (const line of read("turns.txt").toString().trim().split("\n")) {
    const [file, name, frame, ...values] = line.split(" ");
    if (!players.has(file)) players.set(file, openClip(read(`${file}.ptn`)).play());
    const player = players.get(file).seek(+frame);
    const key = `${file} ${name}`;
    if (!handles.has(key)) handles.set(key, findJoint(player, name));
    const joint = handles.get(key);
    const checksum = values.pop();
    assert.deepEqual([...joint.euler("XYZ"), ...joint.euler("ZXY"), ...joint.quaternion()], values.map(Number), line);
    const numbers = [...joint.matrix(), joint.angle(), ...ORDERS.flatMap((order) => joint.euler(order))];
    assert.equal(crc16(Int32Array.from(numbers)), checksum, line);
    // The checksum wraps them to 32 bits, and would hide one that is not.
    assert.ok(numbers.every((number) => number === (number | 0)), line);
    // The same rotation in floating point, of either sign.
    const [x, y, z, w] = player.rotation(joint.index);
    const along = joint.quaternion().reduce((sum, value, index) => sum + value * [w, x, y, z][index], 0);
    assert.ok(Math.abs(Math.abs(along) / 2 ** 30 - 1) < 1e-6, line);
    assert.deepEqual(joint.raw(), [...player.raw.subarray(player.clip.joints[joint.index].first)].slice(0, joint.kinds.length));
    turned++;
  }
  const player = players.get("turn-orders");
  assert.deepEqual([findJoint(player, "j7").order, findJoint(player, "j8").order], ["YXZ", undefined]);
  assert.throws(() => findJoint(player, "nobody"), /no joint nobody$/);
  assert.throws(() => findJoint(player, "Rig:J7"), /no joint Rig:J7; there is j7/);
  assert.throws(() => findJoint(player), /no joint undefined$/);
  assert.throws(() => findJoint(player, ""), /no joint/);
  assert.throws(() => findJoint(player, "j0").euler("XYX"), /no order of Euler angles XYX/);
  assert.throws(() => findJoint(player, "j8").euler(), /no order of Euler angles/);
  assert.equal(degrees(-(2 ** 30)), -90);
}

// Damaged files: both decoders refuse the same ones, and play the others alike. The generator is fixed, so that a failure repeats.
let random = 1;
const chance = (below) => {
  random = (Math.imul(random, 1664525) + 1013904223) >>> 0;
  return Math.floor((random / 2 ** 32) * below);
};
const crcAt = (bytes, from, to, crc = 0xffff) => {
  for (; from < to; from++) {
    crc ^= bytes[from] << 8;
    for (let bit = 0; bit < 8; bit++) crc = crc & 0x8000 ? (crc << 1) ^ 0x11021 : crc << 1;
  }
  return crc;
};
const outcome = (act) => {
  try {
    return act();
  } catch (error) {
    return error instanceof RangeError || error instanceof TypeError ? String(error.stack) : "refused";
  }
};
let [mutants, played] = [0, 0];
const LONG = ["channels-300.ptn", "most-frames.ptn"];
const filesOf = (from) => readdirSync(from).filter((name) => name.endsWith(".ptn") && !LONG.includes(name)).map((name) => [name, from]);
for (const [file, from] of [folder, keyFolder].flatMap(filesOf)) {
  for (let round = 0; round < 60; round++) {
    const bytes = new Uint8Array(read(file, from));
    for (let edits = 1 + chance(3); edits--; ) bytes[chance(bytes.length)] = chance(4) ? chance(256) : bytes[chance(bytes.length)] ^ (1 << chance(8));
    // Half of the changed motions get a checksum that fits, so that their symbols are read.
    if (round & 1 && bytes[3] & 1) {
      let [at, fields] = [4, []];
      for (let part = 0; part < 2; part++) {
        let [length, shift] = [0, 0];
        do length |= (bytes[at] & 127) << shift, (shift += 7); while (bytes[at++] & 128 && shift < 28);
        fields.push([at, length]);
        if (!part) at += length;
      }
      const [[rigAt, rig], [from, length]] = fields;
      if (rigAt + rig <= bytes.length && from + length <= bytes.length && rig > 2 && length > 2 && length <= bytes.length) {
        const put = (end, crc) => ([bytes[end], bytes[end + 1]] = [crc & 255, crc >> 8]);
        put(rigAt + rig - 2, crcAt(bytes, rigAt, rigAt + rig - 2));
        for (let block = from; block < from + length; block += 256) {
          const end = Math.min(block + 256, from + length) - 2;
          const head = [...bytes.subarray(0, 4), length & 255, (length >> 8) & 255, 0, 0];
          if (end >= block) put(end, crcAt(bytes, block, end, block === from ? crcAt(head, 0, 8) : 0xffff));
        }
      }
    }
    const frames = (count) => [0, 1, 2, 5, 20].map((frame) => Math.min(frame, count - 1));
    const theirs = outcome(() => {
      const clip = decode(bytes, tables, undefined, { index: false });
      return clip.frames > LARGEST ? "long" : frames(clip.frames).map(clip.pose);
    });
    const ours = outcome(() => {
      const clip = openClip(bytes, undefined, false, keys);
      return clip.frames > LARGEST ? "long" : frames(clip.frames).map((frame) => [...clip.play().seek(frame).raw]);
    });
    assert.deepEqual(ours, theirs, `${file}, round ${round}`);
    mutants++;
    played += ours !== "refused";
  }
}
assert.ok(played > mutants / 10, `${played} of ${mutants} changed clips could be played`);
console.log(`${vectors} vectors, ${poses} poses, ${joints} joints placed, ${turned} rotations; ${mutants} changed files, ${played} of them playable`);
