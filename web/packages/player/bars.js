// What <pantin-player> loads for scalars that are not a face's: a bar for each.

const [GROUND, LEFT] = [0, 2];
// The widest bar, in pixels.
const THICKEST = 24;

// Of scalars from a channel on: each bar extends from the middle by its fraction of full scale.
export function barsOf(first) {
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
  };
}
