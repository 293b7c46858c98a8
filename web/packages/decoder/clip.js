// Opens clips of character motion (.ptn) and banks of them (.ptb), and plays their raw values, which are those of every other decoder of the format. The numbers in
// brackets are sections of the format's specification, decoder/FORMAT.md in the repository.
//
// Values live in closures and are declared one by one: a minifier shortens names of variables, but no names of properties and no destructured arrays.
import { FAR, MODE, MODE_AFTER, NUMBER, NUMBER_IN, POSITION, STATUS, STATUS_IN, STEP_CHANGE, VELOCITY } from "./tables.js";

const { abs, ceil, floor, imul, max, min, sign } = Math;
const FRAME_RATES = [0, 120, 60, 30, 24, 25, 50, 100, 36, 15];
const LENGTHS = [1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 48, 64, 96];
// Flags of a file.
const HAS_RIG = 1;
const LOOPED = 2;
const HAS_EXPONENTIALS = 4;
const HAS_EVENTS = 8;
const HAS_INDEX = 16;
const HAS_EVENT_NAMES = 32;
const HAS_SECTIONS = 64;
// A moving channel's words of state; position, velocity, acceleration and its slope are the first. All are in one array, so that a snapshot is a copy of it.
const V = 1;
const W = 2;
const K = 3;
const TYPE = 4;
const SIGN = 5;
const ENDS = 6;
const STEP = 7;
const LEADER = 8;
const STATE = 9;
// Leaders that are none: the channel reads its own segments, or stands still.
const OWN = -1;
// A player keeps about this many snapshots, at least this many frames apart.
const SPACING = 64;

export const check = (holds, problem) => {
  if (!holds) throw new Error("pantin: " + problem);
};
const signed = (number) => (number >>> 1) ^ -(number & 1);
const bytesOf = (data) => (ArrayBuffer.isView(data) ? new Uint8Array(data.buffer, data.byteOffset, data.byteLength) : new Uint8Array(data));
const u32Bytes = (number) => [0, 8, 16, 24].map((shift) => (number >> shift) & 255);

// Of the bytes, and of those before them whose checksum is given.
const crc16 = (bytes, crc = 0xffff) => {
  bytes.forEach((byte) => {
    crc ^= byte << 8;
    for (let bit = 8; bit--; ) crc = crc & 0x8000 ? (crc << 1) ^ 0x11021 : crc << 1;
  });
  return crc;
};
const isWhole = (bytes, crc) => bytes.length > 1 && crc16(bytes.subarray(0, -2), crc) === crcOf(bytes);
// The bytes before the checksum at their end, once that is known to be right.
export const checked = (bytes, crc) => {
  check(isWhole(bytes, crc), "wrong checksum");
  return bytes.subarray(0, -2);
};
const crcOf = (bytes) => bytes.at(-2) + 256 * bytes.at(-1);

// Fields, one after the other. Those of a payload read zeros past its end [3].
export const fieldsOf = (bytes, isPayload) => {
  let at = 0;
  const more = () => at < bytes.length;
  const u8 = () => {
    check(isPayload || more(), "ends early");
    return bytes[at++] ?? 0;
  };
  const varint = () => {
    for (let number = 0, shift = 0; ; shift += 7) {
      const byte = u8();
      check(isPayload || shift < 28 || byte < 16, "out of bounds");
      number |= (byte & 127) << shift;
      if (byte < 128 || shift > 27) return number >>> 0;
    }
  };
  const take = (length = varint()) => {
    check(length <= bytes.length - at, "ends early");
    return bytes.subarray(at, (at += length));
  };
  return { at: () => at, more, u8, i8: () => (u8() << 24) >> 24, u32: () => (u8() | (u8() << 8) | (u8() << 16) | (u8() << 24)) >>> 0, varint, take, name: () => new TextDecoder().decode(take()) };
};

/** Reads a rig on its own [2], which clips without one need. `names` are those that rigs refer to by number. */
export const openRawRig = (data, names = []) => {
  const body = checked(bytesOf(data));
  const { at, more, u8, i8, varint, name } = fieldsOf(body);
  const cmPerUnit = varint() / 1e6;
  const exponent = i8();
  const axis = u8();
  const jointCount = varint();
  const scalarCount = varint();
  const joints = [];
  const scalars = [];
  const up = [0, 0, 0];
  let channels = 0;
  check(cmPerUnit && abs(exponent) < 32 && axis < 7 && axis % 4 < 3 && jointCount < 1024 && scalarCount < 1024, "out of bounds");
  up[axis % 4] = axis < 4 ? 1 : -1;
  while (joints.length < jointCount) {
    const head = u8();
    const count = head & 15;
    const isEnd = (head & 16) > 0;
    const parent = varint() - 1;
    const kinds = [];
    check(head < 64 && !(isEnd && count) && (joints.length ? parent >= 0 && parent < joints.length : parent < 0), "bad joint");
    for (let byte; kinds.length < count; byte >>= 4) {
      if (!(kinds.length & 1)) byte = u8();
      check((byte & 15) < 13, "bad joint");
      kinds.push(byte & 15);
    }
    const rest = up.map(() => signed(varint()));
    joints.push({ name: isEnd ? "" : name(), parent, isEnd, isHelper: head > 31, offset: rest.map((value) => value * 2 ** exponent), kinds, first: channels, rest });
    channels += count;
  }
  const add = (exponent, name) => scalars.length < scalarCount && scalars.push({ name, scale: 2 ** (exponent - 31) });
  const scalarBytes = body.subarray(at());
  while (scalars.length < scalarCount) {
    const exponent = i8();
    if (exponent < 127) add(exponent, name());
    else {
      let first = u8();
      const last = first + u8();
      const listed = i8();
      for (; first <= last; first++) add(listed, names[first] ?? "");
    }
  }
  check(!more() && channels + scalarCount < 1024, "out of bounds");
  const id = body.reduce((hash, byte) => imul(hash ^ byte, 0x1000193), 0x811c9dc5) >>> 0;
  return { id, joints, scalars, scalarBytes, up, cmPerUnit, exponent, channels: channels + scalarCount };
};

// The bytes of blocks without their checksums [3]. The first one's checksum continues from `crc`. Of a part, those before the first damaged block.
const unblocked = (bytes, crc, isPartial) => {
  const payload = [];
  check(bytes.length, "ends early");
  for (let from = 0; from < bytes.length; from += 256, crc = 0xffff) {
    const block = bytes.subarray(from, from + 256);
    if (isPartial && !isWhole(block, crc)) break;
    payload.push(...(isPartial ? block.subarray(0, -2) : checked(block, crc)));
  }
  return payload;
};

/**
 * Opens a clip (.ptn) [1]. One without a rig needs that of `openRig` or of a bank. With `isPartial`, the bytes are the beginning of a file: blocks count up to
 * the first that is missing or damaged, and a player is `dry` once it has read past them. Of the programs that use it, `names` are those of `openRawRig`, `named` adds to a clip, and players have what
 * `poseOf` makes of a clip and its raw values. Key clips need the `keys` of keys.js.
 */
export const openRawClip = (data, rig, isPartial, { names, named, poseOf, keys } = {}) => {
  const bytes = bytesOf(data);
  const file = fieldsOf(bytes);
  const head = [...file.take(4)];
  const flags = head[3];
  const eventNames = [];
  const events = [];
  check(head[0] === 80 && head[1] === 110, "no Pantin clip");
  const hasKeys = head[2] === 2;
  check(!hasKeys || keys, "a key clip needs the keys of @pantin/decoder/keys");
  check((head[2] === 1 || hasKeys) && flags < 128, "another version of the format");
  const rigBytes = flags & HAS_RIG ? file.varint() : 0;
  if (flags & HAS_RIG) rig = openRawRig(file.take(rigBytes), names);
  const motionBytes = file.varint();
  const here = bytes.length - file.at();
  // An incomplete block cannot be checked.
  const motion = file.take(isPartial && here < motionBytes ? here & -256 : motionBytes);
  const index = !isPartial && flags & HAS_INDEX && file.take();
  if (!isPartial) {
    if (flags & HAS_EVENT_NAMES) for (const names = fieldsOf(checked(file.take())); names.more(); ) eventNames.push(names.name());
    check(flags & HAS_SECTIONS || !file.more(), "out of bounds");
  }
  check(rig, "the rig is another file");
  const payload = Uint8Array.from(unblocked(motion, crc16([...head, ...u32Bytes(motionBytes)]), isPartial));
  // A player keeps snapshots of its own: of the file's, only the checksums are read.
  if (index) unblocked(index, crc16(u32Bytes(index.length), crcOf(motion)));
  const { at, u8, i8, u32, varint } = fieldsOf(payload, true); // [4]
  const rate = FRAME_RATES[u8()];
  const frameTimeNs = rate ? floor((1e9 + (rate >> 1)) / rate) : rate === 0 ? u32() : 0;
  const frames = varint();
  const exponent = i8();
  check(frameTimeNs && frames && frames <= 2 ** 24 && exponent > -64 && exponent < 32, "out of bounds");
  check(flags & HAS_RIG || u32() === rig.id, "another rig");
  let count = 0;
  let bits;
  const joints = rig.joints.map((joint) => {
    const isEuler = (kind) => kind > 2 && kind < 6;
    if (!(flags & HAS_EXPONENTIALS) || joint.kinds.filter(isEuler).length !== 3) return joint;
    if (!(count++ & 7)) bits = u8();
    const isExponential = bits & 1;
    let component = 10;
    bits >>= 1;
    return isExponential ? { ...joint, kinds: joint.kinds.map((kind) => (isEuler(kind) ? component++ : kind)) } : joint;
  });
  const states = hasKeys ? varint() : 0;
  if (hasKeys) keys.check(flags, frames, states);
  for (let left = flags & HAS_EVENTS ? varint() : 0, frame = 0; left--; ) {
    frame = (frame + varint()) >>> 0;
    const id = varint();
    check(at() <= payload.length, "ends early");
    events.push({ frame, id, name: eventNames[id] ?? "" });
  }
  const { scalars } = rig;
  const looped = (flags & LOOPED) > 0;
  const clip = {
    rig, joints, scalars, events, eventNames, frames, frameTimeNs, exponent, looped, hasKeys, states, rigBytes, motionBytes,
    // Seconds. In a loop, the last frame lasts as long as the others.
    duration: ((frames - !looped) * frameTimeNs) / 1e9,
    play: () => (hasKeys ? keys.player : play)(clip, poseOf, payload, at(), payload.length + 2 * ceil(motionBytes / 256) < motionBytes, eachRest, frameAt),
  };
  named?.(clip);
  return clip;
};

/** Opens a bank (.ptb), the clips of one rig by name [16]. */
export const openRawBank = (data, extras) => {
  const { u8, more, take } = fieldsOf(bytesOf(data));
  const sections = [];
  const clips = new Map();
  // All of them by their index: of one name there may be several.
  const files = [];
  check(u8() === 80 && u8() === 98, "not a bank");
  const version = u8();
  check(version !== 2 || extras.keys, "a bank with key clips needs the keys of @pantin/decoder/keys");
  check(version === 1 || version === 2, "unknown version");
  while (more()) {
    const type = u8();
    check(!sections[type] || type < 1 || type > 3, "bad bank");
    sections[type] = take();
  }
  check(sections[1] && sections[2] && sections[3], "bad bank");
  const rig = openRawRig(sections[1], extras.names);
  const entries = fieldsOf(checked(sections[2]));
  const bodies = fieldsOf(sections[3]);
  while (entries.more()) {
    const name = entries.name();
    const body = bodies.take(entries.varint());
    check(name, "bad bank");
    files.push(body);
    if (!clips.has(name)) clips.set(name, body);
  }
  check(clips.size && !bodies.more(), "bad bank");
  const names = [...clips.keys()];
  return {
    rig, names, sections, files,
    open: (name = names[0]) => {
      const body = clips.get(name);
      check(body, "no clip " + name);
      check(!(body[3] & HAS_RIG), "bad bank");
      return openRawClip(body, rig, false, extras);
    },
  };
};

// Calls `each` with the kind of every channel and its value at rest.
const eachRest = ({ rig, exponent }, each) => {
  const shift = rig.exponent - exponent;
  rig.joints.forEach((joint) => joint.kinds.forEach((kind) => each(kind, kind > 2 ? 0 : shift < 0 ? joint.rest[kind] >> min(-shift, 31) : joint.rest[kind] << shift % 32)));
  rig.scalars.forEach(() => each(13, 0));
};

const frameAt = ({ frames, frameTimeNs, looped }, seconds) => {
  const to = floor((seconds * 1e9) / frameTimeNs + 1e-6);
  return looped ? ((to % frames) + frames) % frames : to;
};

const play = (clip, poseOf, payload, at, isPartial) => {
  const { rig, frames } = clip;
  const raw = new Int32Array(rig.channels);
  // Channels that move, and their state.
  const channels = [];
  const start = [];
  let frame = 0;

  const byte = () => (at < payload.length ? payload[at++] : 0);
  let x = max((byte() << 16) | (byte() << 8) | byte(), 65536);
  const refill = () => {
    while (x < 65536) x = (x << 8) | byte();
  };
  const symbolOf = (sizes) => { // [5]
    let low = x & 4095;
    let symbol = 0;
    while (low >= sizes[symbol]) low -= sizes[symbol++];
    x = sizes[symbol] * (x >> 12) + low;
    refill();
    return symbol;
  };
  const bitsOf = (count) => {
    if (count > 8) return bitsOf(8) | (bitsOf(count - 8) << 8);
    const value = x & ((1 << count) - 1);
    x >>= count;
    refill();
    return value;
  };
  const magnitude = (sizes, unit) => {
    const length = symbolOf(sizes);
    if (!length) return 0;
    const size = (1 << (length - 1)) | bitsOf(length - 1);
    return imul(bitsOf(1) ? -size : size, max(unit, 1));
  };
  // A mantissa of 2 or 3 with this exponent [7].
  const mantissa = (step) => 2 + (step & 1);

  // Reads the start of every channel [8].
  const statusOf = Array(16).fill(0);
  const lastStep = [44, 44];
  let status = 0;
  let channel = 0;
  const begin = (kind, rest) => {
    const isPosition = kind < 3 ? 1 : 0;
    let step = 0;
    let velocity = 0;
    let leader = OWN;
    status = statusOf[kind] = symbolOf(STATUS[STATUS_IN[16 * isPosition + 4 * status + statusOf[kind]]]);
    if (status > 2) {
      leader = channels.length - 1 - bitsOf(5);
      if (leader < 0) leader = -2;
      else {
        rest = start[leader * STATE];
        velocity = start[leader * STATE + V];
      }
    } else if (status) {
      step = symbolOf(STEP_CHANGE);
      step = step < 24 ? (lastStep[isPosition] + signed(step)) & 255 : bitsOf(6);
      step = lastStep[isPosition] = min(step, 59);
      const unit = (mantissa(step) << (step >> 1)) >> 1;
      rest = magnitude(POSITION, unit >> 1);
      if (status > 1) velocity = magnitude(VELOCITY, unit >> 2);
    }
    if (status > 1) {
      channels.push(channel);
      start.push(rest, velocity, 0, 0, 63, 0, 0, step, leader);
    }
    raw[channel++] = rest;
  };
  eachRest(clip, begin);
  const state = Int32Array.from(start);
  const snapshots = [[0, at, x, state.slice()]];

  // Reads an acceleration, or a slope, in its context [9].
  const number = (base, slope, lengthIndex, length) => {
    const now = state[base + W + slope];
    const earlier = slope ? 0 : state[base + SIGN];
    const step = state[base + STEP];
    const quotient = ((slope ? 3 : 1) * 2 ** 30) / (length * (length + 1) * (slope ? length + 2 : 1));
    const unit = ((mantissa(step) * floor(quotient)) >> (30 - (step >> 1))) | 1;
    const size = abs(now);
    const near = size < (unit + 1) >> 1 ? 0 : size < 2 * unit ? 1 : size < 6 * unit ? 2 : 3;
    const flipped = (near ? now : earlier) < 0;
    const lengthClass = lengthIndex < 3 ? (lengthIndex + 1) >> 1 : lengthIndex < 7 ? 2 : 3;
    const symbol = symbolOf(NUMBER[NUMBER_IN[((4 * slope + lengthClass) * 4 + near) * 3 + (flipped ? -earlier : earlier) + 1]]);
    let value = (symbol + 1) >> 1;
    if (value > 6) {
      const isFar = value > 12;
      const bits = isFar ? symbolOf(FAR) : value - 6;
      value = (isFar ? 132 : 5) + (1 << bits) + bitsOf(bits);
    }
    state[base + W + slope] = imul(!(symbol & 1) === flipped ? -value : value, unit);
    if (!slope) state[base + SIGN] = near && sign(now);
  };
  const segment = (base) => {
    let mode = symbolOf(MODE[MODE_AFTER[state[base + TYPE]]]);
    if (mode > 31) mode = min(32 + symbolOf(MODE[MODE_AFTER[64]]), 62);
    const type = mode >> 4;
    const lengthIndex = mode & 15;
    const length = LENGTHS[lengthIndex];
    if (!(type & 1)) number(base, 0, lengthIndex, length);
    if (!type) state[base + K] = 0;
    else if (type < 3) number(base, 1, lengthIndex, length);
    state[base + TYPE] = mode;
    state[base + ENDS] = frame + length;
  };

  const step = () => {
    const reads = frame + 2 < frames;
    if (frame + 1 >= frames) return false;
    for (let base = 0, index = 0; base < state.length; base += STATE) {
      if (reads && state[base + ENDS] === frame) {
        const leader = state[base + LEADER] * STATE;
        if (leader >= 0) {
          // The leader has made its step already: its acceleration before it is what the follower has.
          state[base + K] = state[leader + K];
          state[base + W] = state[leader + W] - state[leader + K];
          state[base + TYPE] = state[leader + TYPE];
          state[base + ENDS] = state[leader + ENDS];
        } else if (leader === OWN * STATE) segment(base);
      }
      raw[channels[index++]] = state[base] += state[base + V];
      state[base + V] += state[base + W];
      state[base + W] += state[base + K];
    }
    if (++frame === snapshots.length * max(SPACING, ceil(frames / SPACING))) snapshots.push([frame, at, x, state.slice()]);
    return true;
  };

  const seek = (to) => {
    to = max(0, min(floor(to) || 0, frames - 1));
    const known = snapshots.filter((snapshot) => snapshot[0] <= to).pop();
    if (to < frame || known[0] > frame) {
      [frame, at, x] = known;
      state.set(known[3]);
      channels.forEach((channel, index) => (raw[channel] = state[index * STATE]));
    }
    while (frame < to) step();
    return player;
  };

  const player = {
    ...poseOf?.(clip, raw, state, channels),
    clip, raw, step, seek,
    moving: channels.length,
    get frame() {
      return frame;
    },
    get dry() {
      return isPartial && at >= payload.length;
    },
    seekTime: (seconds) => seek(frameAt(clip, seconds)),
  };
  return player;
};
