// Evaluates a curve of an FBX file: constant, linear, or cubic with the slopes and weights that the file states for each key.

const CONSTANT = 2, LINEAR = 4, NEXT = 0x100, CUBIC = 8, WEIGHTED_RIGHT = 0x1000000, WEIGHTED_NEXT_LEFT = 0x2000000;
const SECOND = 46186158000, THIRD = 1 / 3;

/** The curve of an object of the file: `at(time)`, in its units of time, and whether it changes. */
export function curveOf(object) {
  const [times, values, flags, data, counts] = ["KeyTime", "KeyValueFloat", "KeyAttrFlags", "KeyAttrDataFloat", "KeyAttrRefCount"].map(object.values);
  const entries = counts.flatMap((count, i) => Array(count).fill({ flags: flags[i], slopes: data.slice(4 * i, 4 * i + 2), weights: weightsOf(data[4 * i + 2], flags[i]) }));
  const keys = entries.map((entry, i) => ({ ...entry, time: Number(times[i]), value: values[i] }));
  const at = (time) => {
    const next = keys.findIndex((key) => key.time > time);
    if (next <= 0) return keys[next === 0 ? 0 : keys.length - 1].value;
    return between(keys[next - 1], keys[next], time);
  };
  return { at, moves: values.some((value) => value !== values[0]) };
}

/** The weights are two whole numbers of 16 bits, in ten thousandths, in the place of one number of 32. */
function weightsOf(float, flags) {
  const bits = Buffer.alloc(4);
  bits.writeFloatLE(float);
  return [flags & WEIGHTED_RIGHT ? bits.readInt16LE(0) / 1e4 : THIRD, flags & WEIGHTED_NEXT_LEFT ? bits.readInt16LE(2) / 1e4 : THIRD];
}

function between(a, b, time) {
  const part = (time - a.time) / (b.time - a.time), seconds = (b.time - a.time) / SECOND;
  if (a.flags & CONSTANT) return a.flags & NEXT ? b.value : a.value;
  if (a.flags & LINEAR) return a.value + part * (b.value - a.value);
  if (!(a.flags & CUBIC)) throw new Error("a key has an interpolation of no kind");
  const [right, left] = a.weights, bezier = (p, q, r, s, u) => { const v = 1 - u; return v * v * v * p + 3 * v * v * u * q + 3 * v * u * u * r + u * u * u * s; };
  let [low, high] = [0, 1];
  for (let i = 0; i < 60; i++) {
    const middle = (low + high) / 2;
    if (bezier(0, right, 1 - left, 1, middle) < part) low = middle;
    else high = middle;
  }
  return bezier(a.value, a.value + right * seconds * a.slopes[0], b.value - left * seconds * a.slopes[1], b.value, (low + high) / 2);
}
