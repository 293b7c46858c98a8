// Plays key clips, which hold keys instead of segments: what `openClip` and `openBank` take to open them. The numbers in brackets are sections of the format's
// specification, decoder/FORMAT.md in the repository. Integers of 64 bits are BigInts: only opening a player needs them.
const { floor, min, max } = Math;
const MOST = 1n << 26n;
const PART = 64;
const QUANTA = [1n, 2n, 5n, 10n, 20n, 50n, 100n, 200n, 500n, 1000n, 2000n, 5000n];
const RATES = [40960, 25206, 18204, 14247, 11703, 9930, 8623, 7620, 6827, 6183, 5650, 5201, 4819, 4489, 4201, 3948];
// First contexts of each kind of bit [19].
const CONSTANT = 9;
const QUANTUM = 18;
const SAME_GRID = 21;
const NEW_GRID = 22;
const INTERPOLATION = 23;
const ENDS = 38;
const HALF = 42;
const COUNT = 43;
const GAP = 55;
const CLOSED = 79;
const BY_HALF = 85;
const BY_LEADER = 86;
const SAME_DISTANCE = 89;
const DISTANCE = 90;
const SIGN = 102;
const SHIFT = 104;
const EXACT = 105;
const LENGTH = 106;
const NEGATIVE = 202;
const CONTEXTS = 204;
// Words of a moving channel in the state of a player.
const STATE = 9;
// What predicts a key.
const BY_KEY_BEFORE = 0;
const BY_ITSELF = 1;
const BY_ANOTHER = 2;
const NATURAL = 2;
const CATMULL_ROM = 1;

const big = BigInt;
const magnitude = (number) => (number < 0n ? -number : number);
const divided = (number, by) => {
  const quotient = (magnitude(number) + (by >> 1n)) / by;
  return number < 0n ? -quotient : quotient;
};
const shifted = (number, bits) => (number + (1n << (bits - 1n))) >> bits;
const low = (number) => big.asIntN(32, number);
const wrapped = (number) => big.asIntN(64, number);
// A rule of the format that is broken: the clip then rests, as with every decoder.
const BROKEN = {};
const rule = (holds) => {
  if (!holds) throw BROKEN;
};
// A second difference, which fits 32 bits.
const second = (number) => {
  rule(low(number) === number);
  return number;
};

// The binary range decoder [19].
const bitsOf = (payload, at) => {
  const chances = new Uint16Array(CONTEXTS).fill(2048);
  const counts = new Uint8Array(CONTEXTS);
  let range = 0xffffffff;
  let code = 0;
  const shift = () => {
    code = ((code << 8) | (payload[at++] ?? 0)) >>> 0;
  };
  const split = (chance) => {
    const ones = (range >>> 12) * chance;
    const bit = code < ones;
    if (!bit) code -= ones;
    range = bit ? ones : range - ones;
    while (range < 2 ** 24) {
      range = (range << 8) >>> 0;
      shift();
    }
    return bit ? 1 : 0;
  };
  const bit = (context) => {
    const chance = chances[context];
    const rate = RATES[counts[context]];
    const one = split(chance);
    chances[context] = min(max(one ? chance + (((4096 - chance) * rate) >> 16) : chance - ((chance * rate) >> 16), 40), 4056);
    if (counts[context] < 15) counts[context]++;
    return one;
  };
  const raw = (count) => {
    let value = 0;
    while (count--) value = 2 * value + split(2048);
    return value;
  };
  const unary = (context, most) => {
    let ones = 0;
    while (ones < most && bit(context + min(ones, 11))) ones++;
    return ones;
  };
  const gamma = (context) => {
    const length = unary(context, 12);
    return 2 ** length - 1 + raw(length);
  };
  for (let byte = 0; byte < 4; byte++) shift();
  return { bit, raw, unary, gamma };
};

// The channels with keys, and the values of the constant ones by channel [20].
const read = (clip, payload, at, put) => {
  const { rig, frames, looped } = clip;
  const { bit, raw, unary, gamma } = bitsOf(payload, at);
  const end = looped ? frames : frames - 1;
  const half = looped && !(end & 1) ? end / 2 : 0;
  const quanta = [6, 6, 6];
  const grids = [];
  const keyed = [];
  let words = 0;
  let longest = 0;
  let status = 0;
  let distance = 1;
  let channel = 0;

  let lengthOf;
  const residual = (other) => {
    const length = unary(LENGTH + 12 * (4 * other + (lengthOf[other] ?? 0)), 27);
    lengthOf[other] = length < 3 ? 1 : length < 5 ? 2 : 3;
    if (!length) return 0n;
    const isNegative = bit(NEGATIVE + other);
    const size = big(2 ** (length - 1) + raw(length - 1));
    return isNegative ? -size : size;
  };
  const valueOf = (count, quantum) => {
    rule(magnitude(count * quantum) < MOST);
    return count * quantum;
  };
  const newTimes = (grid) => {
    if (bit(ENDS + grid.interpolation)) return;
    grid.isTwice = half && bit(HALF);
    const to = grid.isTwice ? half : end;
    const { times } = grid;
    times.pop();
    let after = gamma(COUNT);
    rule(after < to);
    while (after--) {
      const time = times.at(-1);
      const left = to - time - after - 1;
      let bits = 0;
      while ((after + 2) * 2 ** (bits + 1) <= floor((3 * left) / 4) + after + 1) bits++;
      const gap = unary(GAP + (bits ? 12 : 0), floor((left - 1) / 2 ** bits)) * 2 ** bits + raw(bits);
      rule(gap < left);
      times.push(time + 1 + gap);
    }
    if (grid.isTwice) times.push(...times.map((time) => time + half));
    times.push(end);
  };
  const gridOf = () => {
    const last = keyed.at(-1)?.grid;
    if (last) {
      if (bit(SAME_GRID)) return last;
      if (!bit(NEW_GRID)) {
        const back = raw(32 - Math.clz32(grids.length - 1));
        rule(back < grids.length);
        return grids.at(-1 - back);
      }
    }
    rule(end);
    const context = INTERPOLATION + 3 * (last ? last.interpolation : 4);
    const high = bit(context);
    const grid = { interpolation: 2 * high + bit(context + 1 + high), times: [0, end], isTwice: 0 };
    newTimes(grid);
    grids.push(grid);
    words += 1 + ((grid.times.length + 1) >> 1);
    if (grid.interpolation >= NATURAL) longest = max(longest, grid.times.length);
    return grid;
  };
  const keysOf = (kindClass, rest, quantum, grid, isClosed) => {
    const { times } = grid;
    const last = times.length - 1;
    const values = [];
    let source = BY_KEY_BEFORE;
    let sign = 1n;
    let isExact = 0;
    let later = 0;
    let leader;
    let offset = 0n;
    let count = divided(rest, quantum);
    if (grid.isTwice && bit(BY_HALF)) {
      source = BY_ITSELF;
      if (bit(SIGN)) sign = -1n;
      isExact = bit(EXACT);
    } else if (keyed.length && bit(BY_LEADER + kindClass)) {
      source = BY_ANOTHER;
      if (!bit(SAME_DISTANCE)) distance = 1 + gamma(DISTANCE);
      if (bit(SIGN + 1)) sign = -1n;
      if (half && bit(SHIFT)) later = half;
      leader = keyed[keyed.length - distance];
      rule(leader);
    }
    times.forEach((time, key) => {
      if (isClosed && key === last) return values.push(values[0]);
      let base;
      if (source === BY_ITSELF && 2 * key >= last && key < last) base = values[key - last / 2];
      if (source === BY_ANOTHER) {
        const isNext = looped && time + later >= end;
        const index = leader.grid.times.indexOf(time + later - (isNext ? end : 0));
        rule(index >= 0);
        base = leader.values[index] + (isNext ? leader.values.at(-1) - leader.values[0] : 0n);
      }
      const other = base === undefined ? 0 : 1;
      if (other) count = sign * divided(base, quantum) + offset;
      if (!other || !isExact) {
        const more = residual(other);
        count += more;
        if (!key && source === BY_ANOTHER) offset = more;
      }
      values.push(valueOf(count, quantum));
    });
    return values;
  };
  const begin = (kind, rest, fraction) => {
    const kindClass = kind < 3 ? 1 : (kind > 5 && kind < 10) || kind === 13 ? 2 : 0;
    const context = 3 * status + kindClass;
    const slot = channel++;
    status = bit(context) ? 2 : bit(CONSTANT + context);
    if (!status) return;
    rule(!kindClass || (fraction >= 0 && fraction <= 32));
    const rawOf = (value) => (kindClass ? shifted(2199023256n * value, big(41 - fraction)) : shifted(3127499741n * value, 18n));
    if (!bit(QUANTUM + kindClass)) quanta[kindClass] = raw(4);
    const quantum = QUANTA[quanta[kindClass]];
    rule(quantum);
    lengthOf = [];
    if (status < 2) return put(slot, Number(low(rawOf(valueOf(divided(rest, quantum) + residual(0), quantum)))));
    const grid = gridOf();
    const isClosed = bit(CLOSED + 2 * kindClass + (grid.times.length < 3 ? 1 : 0));
    const values = keysOf(kindClass, rest, quantum, grid, isClosed);
    keyed.push({ slot, grid, values, raws: values.map(rawOf) });
    words += values.length * (grid.interpolation >= NATURAL ? 2 : 1);
  };
  rig.joints.forEach((joint) => joint.kinds.forEach((kind) => {
    const exponent = big(rig.exponent);
    const offset = kind < 3 ? 1000n * big(joint.rest[kind]) : 0n;
    const rest = exponent < 0n ? shifted(offset, -exponent) : offset << exponent;
    begin(kind, magnitude(rest) < MOST ? rest : 0n, kind < 3 ? -clip.exponent : 30);
  }));
  // A scalar's scale is 2^(exponent - 31).
  rig.scalars.forEach(({ scale }) => begin(13, 0n, -Math.log2(scale)));
  words += 3 * longest;
  rule(words < 65536 && keyed.length + Math.ceil(words / 5) === clip.states);
  return keyed;
};

// Second differences of a spline's keys [21].
const solved = ({ grid: { interpolation, times }, raws }, looped) => {
  const one = 1n << 30n;
  const last = times.length - 1;
  const lengths = times.slice(1).map((time, key) => big(time - times[key]));
  const part = (length) => (interpolation === NATURAL ? 0n : divided(65536n, length));
  const reach = lengths.map((length) => 65536n * length - part(length));
  const hold = lengths.map((length) => 131072n * length + part(length));
  const chord = lengths.map((length, key) => divided(256n * (raws[key + 1] - raws[key]), length));
  const factor = [0n];
  const depends = times.map(() => one);
  const w = times.map(() => 0n);
  for (let key = 1; key < last; key++) {
    const pivot = hold[key - 1] + hold[key] - shifted(reach[key - 1] * factor[key - 1], 30n);
    factor[key] = divided(reach[key] << 30n, pivot);
    depends[key] = divided(-reach[key - 1] * depends[key - 1], pivot);
    w[key] = second(divided(wrapped(1536n * (chord[key] - chord[key - 1]) - reach[key - 1] * w[key - 1]), pivot));
  }
  for (let key = last; --key > 0; ) {
    depends[key] -= shifted(factor[key] * depends[key + 1], 30n);
    w[key] = second(w[key] - shifted(factor[key] * w[key + 1], 30n));
  }
  if (!looped) return w;
  const pivot = hold[last - 1] + hold[0] + shifted(reach[last - 1] * depends[last - 1] + reach[0] * depends[1], 30n);
  const first = second(divided(1536n * (chord[0] - chord[last - 1]) - reach[last - 1] * w[last - 1] - reach[0] * w[1], pivot));
  return w.map((own, key) => second(own + shifted(depends[key] * first, 30n)));
};

// Second differences at both ends of every span [21].
const bends = (keys, looped) => {
  const { grid: { interpolation, times }, raws } = keys;
  const last = times.length - 1;
  if (interpolation >= NATURAL) {
    const w = solved(keys, looped);
    return (key) => [w[key], w[key + 1]];
  }
  if (interpolation < CATMULL_ROM) return () => [0n, 0n];
  const length = (key) => big(times[key + 1] - times[key]);
  const rise = (key) => raws[key + 1] - raws[key];
  const chord = (key) => divided(256n * rise(key), length(key));
  const through = (from, to) => divided(256n * (rise(from) + rise(to)), length(from) + length(to));
  const slope = (key) => (key && key < last ? through(key - 1, key) : looped && last > 1 ? through(last - 1, 0) : chord(key && last - 1));
  return (key) => {
    const by = 256n * length(key);
    const straight = 6n * chord(key);
    const from = slope(key);
    const to = slope(key + 1);
    return [low(divided(straight - 4n * from - 2n * to, by)), low(divided(2n * from + 4n * to - straight, by))];
  };
};

// Writes the values of a channel at every frame, and its velocities there [22].
const playInto = (out, speeds, keys, frames, looped) => {
  const { grid: { times }, raws } = keys;
  const bend = bends(keys, looped);
  let frame = 0;
  for (let key = 0; key + 1 < times.length; key++) {
    const whole = times[key + 1] - times[key];
    const length = big(whole);
    const [w0, w1] = bend(key);
    const at = (from) => {
      const s = big(from);
      if (!from) return [raws[key], w0];
      if (from === whole) return [raws[key + 1], w1];
      const bent = wrapped(s * (length - s) * ((2n * length - s) * w0 + (length + s) * w1));
      return [raws[key] + divided(s * (raws[key + 1] - raws[key]), length) - divided(bent, 6n * length), w0 + divided(s * (w1 - w0), length)];
    };
    for (let from = 0; from < whole; from += PART) {
      const count = min(PART, whole - from);
      const n = big(count);
      const [begin, bent] = at(from);
      const [to, bentTo] = at(from + count);
      const slope = divided(bentTo - bent, n);
      const pairs = (n * (n - 1n)) / 2n;
      let p = Number(low(begin));
      let v = Number(low(divided(wrapped(to - begin - pairs * (bent + slope) - ((pairs * (n - 2n)) / 3n) * slope), n)));
      let w = Number(low(bent + slope));
      const k = Number(low(slope));
      for (let left = count; left--; ) {
        if (frame < frames) {
          out[frame] = p;
          speeds[frame++] = v;
        }
        p = (p + v) | 0;
        v = (v + w) | 0;
        w = (w + k) | 0;
      }
    }
  }
  if (frame < frames) out[frame] = Number(low(raws.at(-1)));
};

// Each channel that moves, with its values and velocities at all frames. Keys that break a rule of the format leave the rig at rest.
const framesOf = (clip, payload, at, raw) => {
  const rests = raw.slice();
  try {
    return read(clip, payload, at, (channel, value) => (raw[channel] = value)).map((keys) => {
      const [values, speeds] = [0, 0].map(() => new Int32Array(clip.frames));
      playInto(values, speeds, keys, clip.frames, clip.looped);
      return [keys.slot, values, speeds];
    });
  } catch (error) {
    if (error !== BROKEN) throw error;
    raw.set(rests);
    return [];
  }
};

/** Plays key clips: pass it to `openClip` or `openBank`. */
export const keys = {
  // Checks flags and head [18].
  check: (flags, frames, states) => {
    if (flags & 0x94 || frames > 8191 || states > 14130) throw new Error("pantin: out of bounds");
  },
  // Plays a key clip: what clip.js has for other clips, with the same words of state. Before the whole motion is there, it rests at frame 0. Else all frames are computed here: 8 bytes for each.
  player: (clip, poseOf, payload, at, isPartial, eachRest, frameAt) => {
    const { rig, frames } = clip;
    const raw = new Int32Array(rig.channels);
    let frame = 0;
    let channel = 0;
    eachRest(clip, (_, rest) => (raw[channel++] = rest));
    const own = isPartial ? [] : framesOf(clip, payload, at, raw);
    const channels = own.map(([channel]) => channel);
    const state = new Int32Array(own.length * STATE);
    const show = (to) => {
      frame = to;
      own.forEach(([channel, values, speeds], index) => {
        raw[channel] = state[index * STATE] = values[frame];
        state[index * STATE + 1] = speeds[frame];
      });
    };
    const step = () => {
      if (isPartial || frame + 1 >= frames) return false;
      show(frame + 1);
      return true;
    };
    const seek = (to) => {
      show(isPartial ? 0 : max(0, min(floor(to) || 0, frames - 1)));
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
        return isPartial;
      },
      seekTime: (seconds) => seek(frameAt(clip, seconds)),
    };
    return seek(0);
  },
};
