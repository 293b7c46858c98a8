// What <pantin-player> loads for a clip with scalars: the face that they drive, or, for a rig without joints, a bar for each.
import { bytes, open, seat, strokes } from "./wasm.js";

const [GROUND, LEFT] = [0, 2];
// The widest bar, in pixels.
const THICKEST = 24;

// Each bar extends from the middle by its fraction of full scale.
function barsOf(first) {
  let [width, height] = [0, 0];
  return {
    aim: (wide, high) => ([width, height] = [wide * 16, high * 16]),
    each(raw, stroke) {
      const middle = width >> 1;
      const count = Math.max(1, raw.length - first);
      const breadth = Math.max(1, Math.min(THICKEST, Math.floor(height / 32 / count)));
      stroke(middle, 0, middle, height, 80, GROUND, 1);
      for (let index = 0; index < raw.length - first; index++) {
        const y = Math.floor(((2 * index + 1) * height) / (2 * count));
        stroke(middle, y, middle + (((raw[first + index] >> 16) * middle) >> 15), y, 208, LEFT, breadth);
      }
    },
    close() {},
  };
}

// Of a clip: what draws its scalars.
export async function faceOf({ rig, joints, scalars }) {
  const wasm = await open(new URL("./pantin-face.wasm", import.meta.url));
  const first = rig.channels - scalars.length;
  const { scalarBytes } = rig;
  const owner = { isFace: true };
  const { take, close } = seat(wasm, owner);
  const at = take(wasm.slot());
  const pose = take(Math.max(scalarBytes.length, 4 * rig.channels));
  bytes(wasm, pose, scalarBytes.length).set(scalarBytes);
  if (!wasm.bind(at, pose, scalarBytes.length, scalars.length, first)) {
    close();
    return joints.length ? { aim() {}, each() {}, close() {} } : barsOf(first);
  }
  return Object.assign(owner, {
    close,
    aim: (width, height, right, orbit, tilt) => wasm.aim(at, width, height, right, orbit, tilt),
    each(raw, stroke) {
      new Int32Array(wasm.memory.buffer, pose, raw.length).set(raw);
      const count = wasm.place(at, pose, raw.length);
      strokes(wasm, wasm.picture(), count, stroke);
    },
  });
}
