// Key clips, version 2 of the clip format, written from decoder/FORMAT.md alone; a number in brackets in a comment is a section of that page.
// Numbers of 64 bits are BigInts.

const KNOWN_FLAGS = 1 | 2 | 8 | 32 | 64, MAX_FRAMES = 8191, MAX_STATES = 14130, MAX_WORDS = 65535, MOST = 1n << 26n, PART = 64;
const RATES = [40960, 25206, 18204, 14247, 11703, 9930, 8623, 7620, 6827, 6183, 5650, 5201, 4819, 4489, 4201, 3948];
const QUANTA = [1n, 2n, 5n, 10n, 20n, 50n, 100n, 200n, 500n, 1000n, 2000n, 5000n];
const KEYED = 0, CONSTANT = 9, QUANTUM = 18, SAME_GRID = 21, NEW_GRID = 22, INTERPOLATION = 23, ENDS = 38, HALF = 42, COUNT = 43, GAP = 55, CLOSED = 79, BY_HALF = 85;
const BY_LEADER = 86, SAME_DISTANCE = 89, DISTANCE = 90, SIGN = 102, SHIFT = 104, EXACT = 105, LENGTH = 106, NEGATIVE = 202, CONTEXTS = 204;
const LINEAR = 0, CATMULL_ROM = 1, NATURAL = 2;

const need = (holds, sentence) => { if (!holds) throw new Error(sentence); };
class Malformed extends Error {}
const keep = (holds, sentence) => { if (!holds) throw new Malformed(sentence); };
const size = (a) => (a < 0n ? -a : a);
const round = (a, b) => ((quotient) => (a < 0n ? -quotient : quotient))((size(a) + (b >> 1n)) / b); // [18]
const shift = (a, n) => (a + (1n << (n - 1n))) >> n;
const word = (a) => Number(BigInt.asIntN(32, a)), fits = (a) => BigInt.asIntN(32, a) === a;
const words = (n) => BigInt.asIntN(64, n);

/** Flags, frames and states that a key clip may have [18]. */
export const checkFlags = (flags) => need((flags & ~KNOWN_FLAGS) === 0, "The key clip sets a flag that is unknown or not for key clips.");
export const checkHead = (frames, states) => need(frames <= MAX_FRAMES && states <= MAX_STATES, "The key clip has too many frames or states.");

const isPosition = (kind) => kind <= 2, isScalar = (kind) => kind === 13;
const classOf = (kind) => (isPosition(kind) ? 1 : (kind >= 6 && kind <= 9) || isScalar(kind) ? 2 : 0);

/** Thousandths as a raw value [18]. */
function rawOf(kind, clipExponent, scalarExponent) {
  if (classOf(kind) === 0) return (V) => shift(3127499741n * V, 18n);
  const f = isPosition(kind) ? -clipExponent : isScalar(kind) ? 31 - scalarExponent : 30;
  return f < 0 || f > 32 ? null : (V) => shift(2199023256n * V, BigInt(41 - f));
}

/** A channel's value at rest in thousandths [20]. */
function restOf(rig, { kind, joint }) {
  if (!isPosition(kind)) return 0n;
  const thousandths = 1000n * BigInt(rig.joints[joint].offset[kind]), e = BigInt(rig.offsetExponent);
  const rest = e < 0n ? shift(thousandths, -e) : thousandths << e;
  return size(rest) < MOST ? rest : 0n;
}

/** The binary range decoder [19]. */
class Bits {
  constructor(payload, at) {
    Object.assign(this, { payload, at, range: 0xffffffff, code: 0, contexts: Array.from({ length: CONTEXTS }, () => ({ p: 2048, count: 0 })) });
    for (let i = 0; i < 4; i++) this.code = ((this.code << 8) | this.next()) >>> 0;
  }
  next() { return this.payload[this.at++] ?? 0; }
  split(p) {
    const ones = (this.range >>> 12) * p, bit = this.code < ones ? 1 : 0;
    if (bit) this.range = ones;
    else [this.code, this.range] = [this.code - ones, this.range - ones];
    while (this.range < 2 ** 24) [this.range, this.code] = [(this.range << 8) >>> 0, ((this.code << 8) | this.next()) >>> 0];
    return bit;
  }
  bit(number) {
    const context = this.contexts[number], bit = this.split(context.p), rate = RATES[context.count];
    const moved = bit ? context.p + (((4096 - context.p) * rate) >> 16) : context.p - ((context.p * rate) >> 16);
    context.p = Math.min(Math.max(moved, 40), 4056);
    context.count = Math.min(context.count + 1, 15);
    return bit;
  }
  raw(n) {
    let value = 0;
    for (let i = 0; i < n; i++) value = 2 * value + this.split(2048);
    return value;
  }
  unary(first, most) {
    let n = 0;
    while (n < most && this.bit(first + Math.min(n, 11))) n++;
    return n;
  }
  gamma(first) { const n = this.unary(first, 12); return 2 ** n - 1 + this.raw(n); }
  residual(other, before) { // its value, and its length
    const itsClass = before === undefined ? 0 : before <= 2 ? 1 : before <= 4 ? 2 : 3, length = this.unary(LENGTH + 12 * (4 * other + itsClass), 27);
    if (length === 0) return [0n, 0];
    const negative = this.bit(NEGATIVE + other), magnitude = BigInt(2 ** (length - 1) + this.raw(length - 1));
    return [negative ? -magnitude : magnitude, length];
  }
}

/** What the channels are read with [20]. */
class Reading {
  constructor(bits, frames, looped) {
    const E = looped ? frames : frames - 1;
    Object.assign(this, { bits, looped, E, H: looped && E % 2 === 0 ? E / 2 : null, grids: [], keyed: [], status: 0, quanta: [6, 6, 6], distance: 1 });
  }

  channel({ itsClass, raw, rest }) {
    const { bits } = this, before = 3 * this.status + itsClass;
    this.status = bits.bit(KEYED + before) ? 2 : bits.bit(CONSTANT + before);
    if (this.status === 0) return {};
    keep(raw !== null, "A channel whose values cannot be coded does not rest.");
    if (!bits.bit(QUANTUM + itsClass)) this.quanta[itsClass] = bits.raw(4);
    keep(this.quanta[itsClass] <= 11, "A quantum's index is above 11.");
    const q = QUANTA[this.quanta[itsClass]];
    if (this.status === 1) return { constant: raw(this.value(round(rest, q) + bits.residual(0)[0], q)) };
    const grid = this.grid(), closed = bits.bit(CLOSED + 2 * itsClass + (grid.times.length === 2 ? 1 : 0));
    const values = this.values(grid, this.predictor(grid, itsClass), q, rest, closed), channel = { grid, values, P: values.map(raw) };
    this.keyed.push(channel);
    return channel;
  }

  value(n, q) {
    keep(size(n * q) < MOST, "A value is 2^26 thousandths or more.");
    return n * q;
  }

  grid() {
    const { bits, grids, keyed } = this, last = keyed.at(-1)?.grid;
    if (last) {
      if (bits.bit(SAME_GRID)) return last;
      if (!bits.bit(NEW_GRID)) {
        const back = bits.raw((grids.length - 1).toString(2).length * (grids.length > 1 ? 1 : 0));
        keep(back < grids.length, "A grid from before the first one.");
        return grids[grids.length - 1 - back];
      }
    }
    keep(this.E !== 0, "A clip of one frame has keys.");
    const context = INTERPOLATION + 3 * (last ? last.interpolation : 4), high = bits.bit(context), interpolation = 2 * high + bits.bit(context + 1 + high);
    grids.push({ interpolation, ...this.times(interpolation) });
    return grids.at(-1);
  }

  times(interpolation) {
    const { bits, E, H } = this;
    if (bits.bit(ENDS + interpolation)) return { half: 0, times: [0, E] };
    const half = H !== null ? bits.bit(HALF) : 0, end = half ? H : E, m = bits.gamma(COUNT), times = [0];
    keep(m < end, "A grid has more times than frames.");
    for (let i = 1; i <= m; i++) {
      const a = m - i, t = times.at(-1), left = end - t - a - 1;
      let b = 0;
      while ((a + 2) * 2 ** (b + 1) <= Math.floor((3 * left) / 4) + a + 1) b++;
      const high = bits.unary(GAP + (b === 0 ? 0 : 12), Math.floor((left - 1) / 2 ** b)), gap = high * 2 ** b + bits.raw(b);
      keep(gap < left, "A gap leaves no room for the times after it.");
      times.push(t + 1 + gap);
    }
    if (half) times.push(...times.map((time) => time + H));
    return { half, times: [...times, E] };
  }

  predictor(grid, itsClass) {
    const { bits, keyed } = this;
    if (grid.half && bits.bit(BY_HALF)) return { by: "half", sign: bits.bit(SIGN) ? -1n : 1n, exact: bits.bit(EXACT) };
    if (keyed.length === 0 || !bits.bit(BY_LEADER + itsClass)) return { by: "before" };
    if (!bits.bit(SAME_DISTANCE)) this.distance = 1 + bits.gamma(DISTANCE);
    const sign = bits.bit(SIGN + 1) ? -1n : 1n, later = this.H !== null && bits.bit(SHIFT) ? this.H : 0;
    keep(this.distance <= keyed.length, "A leader from before the first channel with keys.");
    return { by: "leader", sign, later, leader: keyed[keyed.length - this.distance] };
  }

  values(grid, { by, sign, exact, later, leader }, q, rest, closed) {
    const z = grid.times.length - 1, values = [], lengths = [];
    let n = round(rest, q), c = 0n;
    for (let i = 0; i <= z; i++) {
      if (i === z && closed) { values.push(values[0]); break; }
      let V;
      if (by === "half" && i >= z / 2 && i < z) V = values[i - z / 2];
      if (by === "leader") V = this.led(leader, grid.times[i] + later);
      const other = V === undefined ? 0 : 1;
      if (other) n = sign * round(V, q) + c;
      if (!(other && exact)) {
        const [residual, length] = this.bits.residual(other, lengths[other]);
        lengths[other] = length;
        n += residual;
        if (i === 0 && by === "leader") c = residual;
      }
      values.push(this.value(n, q));
    }
    return values;
  }

  led({ grid, values }, T) {
    const wraps = this.looped && T >= this.E, key = grid.times.indexOf(wraps ? T - this.E : T);
    keep(key >= 0, "A leader has no key at a frame.");
    return values[key] + (wraps ? values.at(-1) - values[0] : 0n);
  }

  /** States that a player needs [18]. */
  states() {
    const isSpline = ({ interpolation }) => interpolation >= NATURAL, splines = this.grids.filter(isSpline);
    let count = 3 * Math.max(0, ...splines.map(({ times }) => times.length));
    for (const { grid } of this.keyed) count += grid.times.length * (isSpline(grid) ? 2 : 1);
    for (const { times } of this.grids) count += 1 + Math.ceil(times.length / 2);
    keep(count <= MAX_WORDS, "The clip has more than 65535 words.");
    return this.keyed.length + Math.ceil(count / 5);
  }
}

/** Second differences of a spline's keys [21]. */
function solve({ grid: { interpolation, times }, P }, looped) {
  const z = times.length - 1, L = times.slice(1).map((time, i) => BigInt(time - times[i])), one = 1n << 30n;
  const g = (L) => (interpolation === NATURAL ? 0n : round(65536n, L)), reach = L.map((L) => 65536n * L - g(L)), hold = L.map((L) => 131072n * L + g(L));
  const chord = L.map((L, i) => round(256n * (P[i + 1] - P[i]), L)), pivot = [], factor = [0n], dependence = Array(z + 1).fill(one), w = Array(z + 1).fill(0n);
  for (let i = 1; i < z; i++) {
    pivot[i] = hold[i - 1] + hold[i] - shift(reach[i - 1] * factor[i - 1], 30n);
    factor[i] = round(reach[i] << 30n, pivot[i]);
    dependence[i] = round(-reach[i - 1] * dependence[i - 1], pivot[i]);
    w[i] = round(words(1536n * (chord[i] - chord[i - 1]) - reach[i - 1] * w[i - 1]), pivot[i]);
    keep(fits(w[i]), "An acceleration does not fit 32 bits.");
  }
  for (let i = z - 1; i >= 1; i--) {
    dependence[i] -= shift(factor[i] * dependence[i + 1], 30n);
    w[i] -= shift(factor[i] * w[i + 1], 30n);
    keep(fits(w[i]), "An acceleration does not fit 32 bits.");
  }
  if (!looped) return w;
  const first = hold[z - 1] + hold[0] + shift(reach[z - 1] * dependence[z - 1] + reach[0] * dependence[1], 30n);
  const x = round(1536n * (chord[0] - chord[z - 1]) - reach[z - 1] * w[z - 1] - reach[0] * w[1], first);
  const all = w.map((w, i) => w + shift(dependence[i] * x, 30n));
  keep([x, ...all].every(fits), "An acceleration does not fit 32 bits.");
  return all;
}

/** w0 and w1 of every span [21]. */
function seconds(channel, looped) {
  const { grid: { interpolation, times }, P } = channel, z = times.length - 1;
  if (interpolation === LINEAR) return P.slice(1).map(() => [0n, 0n]);
  if (interpolation !== CATMULL_ROM) {
    const w = solve(channel, looped);
    return w.slice(1).map((w1, i) => [w[i], w1]);
  }
  const L = (i) => BigInt(times[i + 1] - times[i]), rise = (i) => P[i + 1] - P[i], chord = (i) => round(256n * rise(i), L(i));
  const between = (before, after) => round(256n * (rise(before) + rise(after)), L(before) + L(after));
  const slope = (i) => (i > 0 && i < z ? between(i - 1, i) : looped && z > 1 ? between(z - 1, 0) : chord(i === 0 ? 0 : z - 1));
  const low = (a) => BigInt.asIntN(32, a);
  return P.slice(1).map((_, i) => {
    const c = 6n * chord(i), [s, t] = [slope(i), slope(i + 1)], by = 256n * L(i);
    return [low(round(c - 4n * s - 2n * t, by)), low(round(2n * s + 4n * t - c, by))];
  });
}

/** Raw values of a channel at every frame [22]. */
function played({ grid: { times }, P, w }, frames) {
  const out = [];
  for (let key = 0; key + 1 < times.length; key++) {
    const L = times[key + 1] - times[key], [w0, w1] = w[key], l = BigInt(L);
    const at = (frame) => {
      const s = BigInt(frame);
      if (frame === 0 || frame === L) return [frame === 0 ? P[key] : P[key + 1], frame === 0 ? w0 : w1];
      const bend = words(s * (l - s) * ((2n * l - s) * w0 + (l + s) * w1));
      return [P[key] + round(s * (P[key + 1] - P[key]), l) - round(bend, 6n * l), w0 + round(s * (w1 - w0), l)];
    };
    for (let from = 0; from < L; from += PART) {
      const frame = Math.min(PART, L - from), n = BigInt(frame), [p0, W0] = at(from), [p1, W1] = at(from + frame);
      const k = round(W1 - W0, n), w = W0 + k, c2 = (n * (n - 1n)) / 2n, c3 = (c2 * (n - 2n)) / 3n;
      let state = [p0, round(words(p1 - p0 - c2 * w - c3 * k), n), w, k].map(word);
      for (let i = 0; i < frame; i++) {
        out.push(state[0]);
        const [p, v, w, k] = state;
        state = [(p + v) | 0, (v + w) | 0, (w + k) | 0, k];
      }
    }
  }
  out.push(word(P.at(-1)));
  return out.slice(0, frames);
}

/** The values of a channel with keys at every frame, of another the one value that it has; `rests` are raw values. */
function channelsOf({ rig, payload, symbolsAt, frames, looped, length_exponent: clipExponent, states }, rests) {
  const reading = new Reading(new Bits(payload, symbolsAt), frames, looped);
  const channels = rig.channels.map((channel) => reading.channel({
    itsClass: classOf(channel.kind), raw: rawOf(channel.kind, clipExponent, rig.scalars[channel.scalar]?.exponent), rest: restOf(rig, channel),
  }));
  keep(reading.states() === states, "The clip needs another number of states than its head says.");
  return channels.map((channel, i) => {
    if (!channel.grid) return [channel.constant === undefined ? rests[i] : word(channel.constant)];
    return played({ ...channel, w: seconds(channel, looped) }, frames);
  });
}

/** Plays a key clip: `pose()` is that of `frame`, `step()` goes to the next. A malformed clip rests [18]. */
export class KeyPlayer {
  constructor(clip, rests) {
    Object.assign(this, { clip, frame: 0, malformed: false });
    try {
      this.channels = channelsOf(clip, rests);
    } catch (error) {
      if (!(error instanceof Malformed)) throw error;
      Object.assign(this, { channels: rests.map((p) => [p]), malformed: true });
    }
  }
  pose() { return this.channels.map((values) => values[this.frame] ?? values[0]); }
  step() { this.frame++; }
  state() { return JSON.stringify(this.pose()); }
}
