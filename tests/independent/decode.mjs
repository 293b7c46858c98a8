// A decoder of the clip format, written from decoder/FORMAT.md alone; a number in brackets in a comment is a section of that page.
//   import { decode } from "./decode.mjs"     decode(clipBytes, tables, rigBytes?)
//   node decode.mjs FOLDER                    checks every FOLDER/*.ptn against its .json
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { KeyPlayer, checkFlags, checkHead } from "./keys.mjs";

const VERSION = 1, KEY_VERSION = 2, HAS_RIG = 1, LOOPED = 2, HAS_EXPONENTIALS = 4, HAS_EVENTS = 8, HAS_INDEX = 16, HAS_EVENT_NAMES = 32, HAS_SECTIONS = 64, BLOCK = 256, CRC_BYTES = 2;
const FRAME_RATES = [0, 120, 60, 30, 24, 25, 50, 100, 36, 15];
const LENGTHS = [1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 48, 64, 96];
const LENGTH_CLASSES = [0, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 3, 3, 3, 3, 3];
const RESTS = 0, CONSTANT = 1, FOLLOWS = 3, LISTED = 127, TYPE_W = 0, TYPE_K = 1, TYPE_WK = 2;
const START_MODE = 63, SECOND = 64, FIRST_STEP = 44, STEP_CHANGES = 24, MAX_STEP = 59, LOW = 2 ** 16;
const SCALAR = 13, isPosition = (kind) => kind <= 2, isEuler = (kind) => kind >= 3 && kind <= 5;

const need = (holds, sentence) => { if (!holds) throw new Error(sentence); };
const unzigzag = (n) => (n >>> 1) ^ -(n & 1);
const u32Bytes = (n) => [n & 255, (n >>> 8) & 255, (n >>> 16) & 255, n >>> 24];

/** CRC-16/IBM-3740; `crc` is what it goes on from. */
function crc16(bytes, crc = 0xffff) {
  const shift = (crc) => (crc & 0x8000 ? (crc << 1) ^ 0x11021 : crc << 1);
  for (const byte of bytes) for (let i = (crc ^= byte << 8, 0); i < 8; i++) crc = shift(crc);
  return crc;
}

/** Fields, one after the other. Those of a payload read zeros past its end [3]; those of file and rig refuse to. */
class Fields {
  constructor(bytes, what, isPayload = false) { Object.assign(this, { bytes, what, isPayload, at: 0 }); }
  u8() {
    need(this.isPayload || this.at < this.bytes.length, `The ${this.what} ends within a field.`);
    return this.bytes[this.at++] ?? 0;
  }
  i8() { return (this.u8() << 24) >> 24; }
  u32() { return (this.u8() | (this.u8() << 8) | (this.u8() << 16) | (this.u8() << 24)) >>> 0; }
  varint() {
    for (let n = 0, i = 0; ; i++) {
      const byte = this.u8();
      need(this.isPayload || i < 4 || byte <= 0x0f, `A varint of the ${this.what} does not fit 32 bits.`); // [1]
      n |= (byte & 127) << (7 * i); // of a payload's, bits that do not fit are dropped [4]
      if (byte < 128 || i === 4) return n >>> 0;
    }
  }
  zigzag() { return unzigzag(this.varint()); }
  take(n) {
    need(n <= this.bytes.length - this.at, `The ${this.what} ends before the ${n} bytes that it announces.`);
    return this.bytes.subarray(this.at, (this.at += n));
  }
  name() { return new TextDecoder().decode(this.take(this.varint())); }
}

function readRig(bytes, tables) { // [2]
  const end = bytes.length - CRC_BYTES, body = bytes.subarray(0, Math.max(end, 0)), fields = new Fields(body, "rig");
  need(end >= 0 && crc16(body) === (bytes[end] | (bytes[end + 1] << 8)), "The rig's CRC is wrong.");
  const unit = fields.varint(), offsetExponent = fields.i8(), up = fields.u8(), joints = [], scalars = [], channels = [];
  const jointCount = fields.varint(), scalarCount = fields.varint();
  need(unit >= 1 && Math.abs(offsetExponent) <= 31, "The rig's unit is 0, or its offset exponent not from -31 to 31.");
  need(up < 7 && up % 4 !== 3, "The rig's up is no axis.");
  need(jointCount <= 1023 && scalarCount <= 1023, "The rig has more than 1023 joints or scalars.");
  for (let j = 0; j < jointCount; j++) {
    const head = fields.u8(), isEnd = (head & 16) !== 0, isHelper = (head & 32) !== 0, parent = fields.varint() - 1, kinds = [];
    need(j === 0 ? parent === -1 : parent >= 0 && parent < j, `Joint ${j}'s parent is not a joint before it.`);
    need(head < 64 && !(isEnd && head & 15), `Joint ${j}'s head sets bits 6 or 7, or it is an End Site with channels.`);
    for (let i = 0, byte = 0; i < (head & 15); i++, byte >>= 4) {
      if (i % 2 === 0) byte = fields.u8();
      need((byte & 15) < SCALAR, `Joint ${j} has a channel of a scalar's or of no kind.`);
      kinds.push(byte & 15);
    }
    const offset = [fields.zigzag(), fields.zigzag(), fields.zigzag()];
    joints.push({ parent, isEnd, isHelper, kinds, offset, name: isEnd ? "" : fields.name() });
    channels.push(...kinds.map((kind) => ({ kind, joint: j })));
  }
  while (scalars.length < scalarCount) {
    const exponent = fields.i8();
    if (exponent !== LISTED) scalars.push({ exponent, name: fields.name() });
    else {
      const first = fields.u8(), more = fields.u8(), itsExponent = fields.i8();
      for (let i = first; i <= first + more && scalars.length < scalarCount; i++) {
        scalars.push({ exponent: itsExponent, name: tables.live_link[i] ?? "" });
      }
    }
  }
  channels.push(...scalars.map((_, i) => ({ kind: SCALAR, scalar: i })));
  need(fields.at === end && channels.length <= 1023, "Bytes stand before the rig's CRC, or it has more than 1023 channels.");
  const id = body.reduce((hash, byte) => Math.imul(hash ^ byte, 0x01000193), 0x811c9dc5) >>> 0;
  return { unit, offsetExponent, up, joints, scalars, channels, id };
}

/** Checks the CRCs of blocks and takes them out [3]. The first block's goes on from `crc`, over `before`. */
function readBlocks(bytes, before, what, crc = 0xffff) {
  need(bytes.length > 0, `The ${what} has no block.`);
  const payload = [];
  let lastCrc;
  for (let at = 0; at < bytes.length; at += BLOCK) {
    const block = bytes.subarray(at, at + BLOCK), end = block.length - CRC_BYTES, body = block.subarray(0, Math.max(end, 0));
    need(end >= 0, `The ${what}'s last block is shorter than its CRC.`);
    lastCrc = block[end] | (block[end + 1] << 8);
    need(crc16(body, at === 0 ? crc16(before, crc) : 0xffff) === lastCrc, `The CRC of the ${what}'s block ${at / BLOCK} is wrong.`);
    payload.push(...body);
  }
  return { payload, lastCrc };
}

// A place among blocks, CRCs counted [14], as a place in the payload.
const inPayload = (at) => Math.floor(at / BLOCK) * (BLOCK - CRC_BYTES) + Math.min(at % BLOCK, (BLOCK - CRC_BYTES));

function readHead(fields, flags, rig, hasKeys) { // [4]
  const rate = FRAME_RATES[fields.u8()], exponentialJoints = [], events = [];
  need(rate !== undefined, "The frame rate's index is not from 0 to 9.");
  const frameTime = rate ? Math.floor((1e9 + (rate >> 1)) / rate) : fields.u32();
  const frames = fields.varint(), clipExponent = fields.i8();
  need(frameTime >= 1 && frames >= 1 && frames <= 2 ** 24, "The frame time is 0, or the number of frames not from 1 to 2^24.");
  need(clipExponent >= -63 && clipExponent <= 31, "The clip exponent is not from -63 to 31.");
  need(flags & HAS_RIG || fields.u32() === rig.id, "The clip is for another rig.");
  if (flags & HAS_EXPONENTIALS) {
    const able = [...rig.joints.keys()].filter((j) => rig.joints[j].kinds.filter(isEuler).length === 3);
    const bits = Array.from({ length: Math.ceil(able.length / 8) }, () => fields.u8());
    exponentialJoints.push(...able.filter((_, i) => (bits[i >> 3] >> (i % 8)) & 1));
  }
  const states = hasKeys ? fields.varint() : 0;
  if (hasKeys) checkHead(frames, states);
  for (let left = flags & HAS_EVENTS ? fields.varint() : 0, frame = 0; left > 0; left--) {
    frame = (frame + fields.varint()) >>> 0;
    events.push([frame, fields.varint()]);
    need(fields.at <= fields.bytes.length, "The events lead past the motion's end.");
  }
  return { frames, frame_time_ns: frameTime, length_exponent: clipExponent, exponential_joints: exponentialJoints, events, states };
}

/** The rANS decoder [5]. */
class Symbols {
  constructor(payload, at, x) {
    Object.assign(this, { payload, at });
    this.x = x ?? Math.max((this.next() << 16) | (this.next() << 8) | this.next(), LOW);
  }
  next() { return this.payload[this.at++] ?? 0; }
  refill() { while (this.x < LOW) this.x = 256 * this.x + this.next(); }
  symbol(sizes) {
    const low = this.x % 4096;
    let s = 0, start = 0;
    while (start + sizes[s] <= low) start += sizes[s++];
    this.x = sizes[s] * (this.x >> 12) + low - start;
    this.refill();
    return s;
  }
  bits(n) {
    if (n > 8) return this.bits(8) | (this.bits(n - 8) << 8); // the first part is the least significant
    const value = this.x % (1 << n);
    this.x >>= n;
    this.refill();
    return value;
  }
  magnitude(sizes) {
    const length = this.symbol(sizes), size = length === 0 ? 0 : (1 << (length - 1)) | this.bits(length - 1);
    return length !== 0 && this.bits(1) ? -size : size;
  }
  number(tables, { context, flipped }) { // [9]
    const s = this.symbol(tables.number[tables.number_in[context]]), index = (s + 1) >> 1;
    const n = index === 13 ? this.symbol(tables.far) : index - 6; // FAR_NUMBER, or GROUPS
    const size = index <= 6 ? index : (index === 13 ? 132 : 5) + (1 << n) + this.bits(n);
    return (s % 2 === 1) !== flipped ? -size : size;
  }
}

const mantissa = (step) => (step % 2 ? 3 : 2), channelStep = (step) => (mantissa(step) << (step >> 1)) >> 1; // M, S(i) [7]
const unit = (step, quotient) => ((mantissa(step) * Math.floor(quotient)) >> (30 - (step >> 1))) | 1;
const unitW = (step, L) => unit(step, 2 ** 30 / (L * (L + 1)));
const unitK = (step, L) => unit(step, (3 * 2 ** 30) / (L * (L + 1) * (L + 2)));

/** What a channel that rests holds [8]. */
function restValue(rig, { kind, joint }, clipExponent) {
  const offset = isPosition(kind) ? rig.joints[joint].offset[kind] : 0, d = rig.offsetExponent - clipExponent;
  return d >= 0 ? offset << (d % 32) : offset >> Math.min(-d, 31);
}

function readStarts(symbols, tables, rig, clipExponent, moving) { // [8]
  let status = RESTS, lastStep = [FIRST_STEP, FIRST_STEP]; // of either class
  const statusOf = Array(16).fill(RESTS); // of the last channel of each kind
  const moves = (channel) => { moving.push(channel); return channel; };
  return rig.channels.map((channel) => {
    const { kind } = channel, context = 16 * isPosition(kind) + 4 * status + statusOf[kind];
    status = statusOf[kind] = symbols.symbol(tables.status[tables.status_in[context]]);
    const rests = { p: restValue(rig, channel, clipExponent) };
    if (status === RESTS) return rests;
    if (status === FOLLOWS) {
      const leader = moving.length - 1 - symbols.bits(5), stands = { ...rests, v: 0, w: 0, k: 0, mode: START_MODE, ends: 0 };
      return moves({ ...stands, ...moving[leader], prevSign: 0, leader });
    }
    const c = symbols.symbol(tables.step_change), itsClass = isPosition(channel.kind) ? 1 : 0;
    const told = c < STEP_CHANGES ? (lastStep[itsClass] + unzigzag(c)) & 255 : symbols.bits(6);
    const step = (lastStep[itsClass] = Math.min(told, MAX_STEP)), S = channelStep(step);
    const p = Math.imul(symbols.magnitude(tables.position), Math.max(S >> 1, 1));
    if (status === CONSTANT) return { p };
    const v = Math.imul(symbols.magnitude(tables.velocity), Math.max(S >> 2, 1));
    return moves({ step, p, v, w: 0, k: 0, mode: START_MODE, prevSign: 0, ends: 0 }); // `ends`: the frame
  });
}

const hasNewW = (mode) => [TYPE_W, TYPE_WK].includes(mode >> 4), hasNewK = (mode) => [TYPE_K, TYPE_WK].includes(mode >> 4);

function contextOf(slope, now, prevSign, unit, lengthIndex) { // [9]
  const size = Math.abs(now), half = (unit + 1) >> 1;
  const a = size < half ? 0 : size < 2 * unit ? 1 : size < 6 * unit ? 2 : 3;
  const flipped = a === 0 ? prevSign < 0 : now < 0, g = flipped ? -prevSign : prevSign;
  return { context: ((4 * slope + LENGTH_CLASSES[lengthIndex]) * 4 + a) * 3 + g + 1, flipped, saw: a === 0 ? 0 : Math.sign(now) };
}

function readSegment(symbols, tables, channel, frame) { // [9]
  const m = symbols.symbol(tables.mode[tables.mode_after[channel.mode]]);
  const mode = m < 32 ? m : Math.min(32 + symbols.symbol(tables.mode[tables.mode_after[SECOND]]), 62);
  const index = mode & 15, L = LENGTHS[index], W = unitW(channel.step, L), K = unitK(channel.step, L);
  if (hasNewW(mode)) {
    const context = contextOf(0, channel.w, channel.prevSign, W, index);
    channel.w = Math.imul(symbols.number(tables, context), W);
    channel.prevSign = context.saw;
  }
  if (hasNewK(mode)) channel.k = Math.imul(symbols.number(tables, contextOf(1, channel.k, 0, K, index)), K);
  else if (mode >> 4 === TYPE_W) channel.k = 0;
  Object.assign(channel, { mode, ends: frame + L });
}

/** Plays a clip [10], from its start or from a snapshot [14]: `pose()` is that of `frame`, `step()` goes to the next. */
class Player {
  constructor(clip, snapshot) {
    Object.assign(this, { clip, frame: 0, symbols: new Symbols(clip.payload, clip.symbolsAt) });
    this.moving = []; // those that follow among them, with the index of their leader there
    this.channels = readStarts(this.symbols, clip.tables, clip.rig, clip.length_exponent, this.moving);
    if (snapshot) Object.assign(this, { frame: snapshot.frame, symbols: new Symbols(clip.payload, snapshot.at, snapshot.x) });
    if (snapshot) this.moving.forEach((channel, i) => Object.assign(channel, snapshot.channels[i]));
  }
  pose() { return this.channels.map((channel) => channel.p); }
  step() {
    const due = this.moving.filter((channel) => channel.ends === this.frame && this.frame + 2 < this.clip.frames);
    for (const channel of due) {
      const leader = this.moving[channel.leader];
      if (leader) Object.assign(channel, { w: leader.w, k: leader.k, mode: leader.mode, ends: leader.ends });
      else if (channel.leader === undefined) readSegment(this.symbols, this.clip.tables, channel, this.frame);
    }
    for (const c of this.moving) [c.p, c.v, c.w] = [(c.p + c.v) | 0, (c.v + c.w) | 0, (c.w + c.k) | 0];
    this.frame++;
  }
  state() { return JSON.stringify([Math.min(this.symbols.at, this.clip.payload.length), this.symbols.x, this.channels]); }
}

function readIndex(payload, frames, moving) { // [14]
  const fields = new Fields(payload, "index", true), spacing = fields.varint(), begins = [];
  for (let left = fields.varint(), at = 0; left > 0; left--) {
    begins.push((at += fields.varint()));
    need(Math.max(fields.at, inPayload(at)) <= payload.length, "The snapshots lead past the index's end.");
  }
  return begins.map((begin, i) => {
    const frame = (i + 1) * spacing;
    need(frame >= 1 && frame < frames, "A snapshot is of no frame of the clip.");
    fields.at = inPayload(begin);
    const at = inPayload(fields.varint()), x = (fields.u8() << 16) | (fields.u8() << 8) | fields.u8();
    need(x >= LOW, "A snapshot's x is below 2^16."); // from x = 0, a refill would never end
    const channels = Array.from({ length: moving }, () => {
      const head = fields.u8(), mode = head & 63, prevSign = (head >> 6) - 1;
      need(mode <= 62 && prevSign <= 1, "A snapshot's mode or sign is out of bounds.");
      const ends = frame + fields.i8(), p = fields.zigzag(), v = fields.zigzag(), w = fields.zigzag();
      return { mode, prevSign, ends, p, v, w, k: mode >> 4 === TYPE_W ? 0 : fields.zigzag() };
    });
    return { frame, at, x, channels };
  });
}

function readNames(bytes) { // [15]
  const end = bytes.length - CRC_BYTES, body = bytes.subarray(0, Math.max(end, 0)), fields = new Fields(body, "list of event names"), names = [];
  need(end >= 0 && crc16(body) === (bytes[end] | (bytes[end + 1] << 8)), "The CRC of the event names is wrong.");
  while (fields.at < end) names.push(fields.name());
  return names;
}

/**
 * Reads and checks a clip [1]. What the vectors' .json files hold has their names; `pose(frame)` gives raw values [11]. With `index: false` it
 * checks the CRCs of the index and leaves its snapshots out [14].
 */
export function decode(clipBytes, tables, rigBytes, { index: withSnapshots = true } = {}) {
  const file = new Fields(clipBytes, "file"), before = file.take(4), [P, n, version, flags] = before;
  need(P === 0x50 && n === 0x6e, "The file does not begin with the magic of a clip.");
  const hasKeys = version === KEY_VERSION;
  need((version === VERSION || hasKeys) && flags < 128, "The file's version, or a flag that it sets, is unknown.");
  if (hasKeys) checkFlags(flags);
  const itsRig = flags & HAS_RIG ? file.take(file.varint()) : rigBytes;
  const motion = file.take(file.varint()), index = flags & HAS_INDEX ? file.take(file.varint()) : null;
  const names = flags & HAS_EVENT_NAMES ? readNames(file.take(file.varint())) : [];
  need(flags & HAS_SECTIONS || file.at === clipBytes.length, "Bytes follow the last part.");
  need(itsRig, "The clip has no rig of its own, and none was given.");
  const rig = readRig(itsRig, tables), { payload, lastCrc } = readBlocks(motion, [...before, ...u32Bytes(motion.length)], "motion");
  const fields = new Fields(payload, "motion", true), head = readHead(fields, flags, rig, hasKeys);
  const clip = {
    ...head, looped: (flags & LOOPED) !== 0, event_names: names, up: rig.up, helpers: [...rig.joints.keys()].filter((j) => rig.joints[j].isHelper), joints: rig.joints.length, channels: rig.channels.length,
    rig, tables, payload, symbolsAt: fields.at, snapshots: [], player: (snapshot) => (hasKeys ? new KeyPlayer(clip, rig.channels.map((channel) => restValue(rig, channel, clip.length_exponent))) : new Player(clip, snapshot)),
    pose: (frame) => {
      need(Number.isInteger(frame) && frame >= 0 && frame < clip.frames, "The clip has no such frame.");
      const player = clip.player(clip.snapshots.findLast((snapshot) => snapshot.frame <= frame));
      while (player.frame < frame) player.step();
      return player.pose();
    },
  };
  clip.moving = hasKeys ? head.states : clip.player().moving.length;
  const snapshots = index && readBlocks(index, u32Bytes(index.length), "index", lastCrc).payload;
  if (snapshots && withSnapshots) clip.snapshots = readIndex(snapshots, clip.frames, clip.moving);
  return clip;
}

/** Reads a bank [16]: its rig, and its clips in their order, each with the bytes of its file. A damaged clip is an error unless `each` catches it. */
export function decodeBank(bytes, tables, each = (open) => open(), options = {}) {
  const file = new Fields(bytes, "bank"), [P, b, version] = file.take(3), sections = new Map();
  need(P === 0x50 && b === 0x62, "The file does not begin with the magic of a bank.");
  need(version === VERSION || version === KEY_VERSION, "The bank's version is unknown.");
  while (file.at < bytes.length) {
    const type = file.u8(), body = file.take(file.varint());
    need(!sections.has(type) || type < 1 || type > 3, "The bank has two sections of one type.");
    sections.set(type, body);
  }
  need([1, 2, 3].every((type) => sections.has(type)), "The bank lacks its rig, its contents or its clips.");
  const contents = sections.get(2), end = contents.length - CRC_BYTES, body = contents.subarray(0, Math.max(end, 0));
  need(end >= 0 && crc16(body) === (contents[end] | (contents[end + 1] << 8)), "The CRC of the bank's contents is wrong.");
  const entries = new Fields(body, "bank's contents"), clips = new Fields(sections.get(3), "clips of the bank"), found = [];
  while (entries.at < end) {
    const name = entries.name(), clip = clips.take(entries.varint());
    need(name !== "", "A clip of the bank has no name.");
    found.push({ name, bytes: clip, clip: each(() => {
      need(!(clip[3] & HAS_RIG), "A clip of the bank holds a rig.");
      return decode(clip, tables, sections.get(1), options);
    }) });
  }
  need(found.length > 0 && clips.at === sections.get(3).length, "The bank is empty, or its clips are longer than its contents say.");
  return { rig: readRig(sections.get(1), tables), clips: found };
}

/** What differs from a bank's .json: name, bytes, frames, loop and the CRC of each pose of its clips. */
export function compareBank(bank, expected) {
  const crcs = (clip) => {
    const player = clip.player(), all = [];
    for (; player.frame < clip.frames; player.step()) all.push(crc16(player.pose().flatMap(u32Bytes)).toString(16).padStart(4, "0"));
    return all;
  };
  const clips = bank.clips.map(({ name, bytes, clip }) => [name, bytes.length, clip.frames, clip.looped, crcs(clip)]);
  return JSON.stringify({ joints: bank.rig.joints.length, clips }) === JSON.stringify(expected) ? [] : ["the clips of the bank"];
}

/** What differs from a vector's .json, whose `crcs` are of each pose's raw values as i32; also checks the snapshots. */
export function compare(clip, expected) {
  const same = (a, b) => JSON.stringify(a) === JSON.stringify(b), { poses, crcs, ...plain } = expected, player = clip.player();
  const differs = Object.keys(plain).filter((key) => !same(clip[key], plain[key]));
  for (; player.frame < clip.frames; player.step()) {
    const snapshot = clip.snapshots.find(({ frame }) => frame === player.frame);
    const crc = crc16(player.pose().flatMap(u32Bytes)).toString(16).padStart(4, "0");
    if (crcs[player.frame] !== crc) differs.push(`the CRC of frame ${player.frame}`);
    if (snapshot && clip.player(snapshot).state() !== player.state()) differs.push(`the snapshot of frame ${player.frame}`);
  }
  if (crcs.length !== clip.frames) differs.push("the number of CRCs");
  for (const frame in poses) if (!same(clip.pose(+frame), poses[frame])) differs.push(`the pose of frame ${frame}`);
  return differs;
}

function checkFolder(folder) {
  const read = (name) => readFileSync(`${folder}/${name}`);
  // A bank of key clips may hold clips of segments: their tables are those of version 1.
  const tables = Object.assign({}, ...["../vectors/tables.json", "tables.json"].filter((name) => existsSync(`${folder}/${name}`)).map((name) => JSON.parse(read(name))));
  const rigOf = (name) => (existsSync(`${folder}/${name}.rig`) ? read(`${name}.rig`) : undefined);
  const check = (name) => {
    try {
      if (existsSync(`${folder}/${name}.ptb`)) return compareBank(decodeBank(read(`${name}.ptb`), tables), JSON.parse(read(`${name}.json`)));
      return compare(decode(read(`${name}.ptn`), tables, rigOf(name)), JSON.parse(read(`${name}.json`)));
    } catch (error) { return [error.message]; }
  };
  const names = readdirSync(folder).filter((name) => /\.pt[nb]$/.test(name)).map((name) => name.slice(0, -4)).sort();
  const results = names.map((name) => {
    const differs = check(name);
    console.log(`${name}: ${differs.slice(0, 8).join(", ") || "ok"}${differs.length > 8 ? ` and ${differs.length - 8} more` : ""}`);
    return differs.length === 0;
  });
  process.exitCode = results.length > 0 && results.every(Boolean) ? 0 : 1;
}

if (process.argv[1] && import.meta.url === pathToFileURL(process.argv[1]).href) checkFolder(process.argv[2] ?? ".");
