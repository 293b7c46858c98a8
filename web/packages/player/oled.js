// The display of 128x64 pixels and 16 greys: the pixels that the firmware's rasterizer draws, from the same strokes.

const [WIDTH, HEIGHT, HEAD] = [128, 64, 4];
// The pixel that a sixteenth belongs to.
const pixel = (place) => place >> 4;

function put(greys, x, y, grey) {
  if (x >= 0 && x < WIDTH && y >= 0 && y < HEIGHT) greys[y * WIDTH + x] = grey;
}

// Bresenham's lines side by side, across the longer way: step i of one lies i pixels along and floor((2 short i + long) / (2 long)) across, from the end where the
// coordinate along is smallest.
function thick(greys, from, to, width, grey) {
  const isSteep = Math.abs(to[1] - from[1]) > Math.abs(to[0] - from[0]);
  if (isSteep) [from, to] = [from, to].map(([x, y]) => [y, x]);
  if (from[0] > to[0]) [from, to] = [to, from];
  const [long, across] = [to[0] - from[0], to[1] - from[1]];
  for (let step = 0; step <= long; step++) {
    const first = Math.floor((2 * Math.abs(across) * step + long) / Math.max(1, 2 * long)) * Math.sign(across) - (width >> 1);
    for (let aside = first; aside < first + width; aside++) {
      const [x, y] = [from[0] + step, from[1] + aside];
      if (isSteep) put(greys, y, x, grey);
      else put(greys, x, y, grey);
    }
  }
}

// A dark disc with an edge: x^2 + y^2 is at most r^2 + r there, and not with either of them a pixel farther out.
function disc(greys, x, y, radius, grey) {
  const isWithin = (x, y) => x * x + y * y <= radius * radius + radius;
  for (let down = -radius; down <= radius; down++) {
    for (let right = -radius; right <= radius; right++) {
      if (!isWithin(right, down)) continue;
      const isInside = isWithin(Math.abs(right) + 1, down) && isWithin(right, Math.abs(down) + 1);
      put(greys, x + right, y + down, isInside ? 0 : grey);
    }
  }
}

// 17 times the grey of each pixel, from 0 to 15. `each` passes the strokes of a picture.
export function greysOf(each) {
  const greys = new Uint8Array(WIDTH * HEIGHT);
  each((x, y, u, v, shade, part, width) => {
    const grey = (shade >> 4) * 17;
    if (part === HEAD) disc(greys, pixel(x), pixel(y), Math.min(WIDTH, Math.max(1, pixel(u + 8))), grey);
    else thick(greys, [pixel(x), pixel(y)], [pixel(u), pixel(v)], width, grey);
  });
  return greys;
}

// The display's color lies over its greys.
const CSS = `
:host([look=oled]) .stage { background: #000; }
:host([look=oled]) canvas { image-rendering: pixelated; }
:host([look=oled]) .stage::after { content: ""; position: absolute; inset: 0; background: #bff1ff; mix-blend-mode: multiply; pointer-events: none; }
`;
let sheet;

// Draws them.
export function draw(context, each) {
  const { adoptedStyleSheets } = context.canvas.getRootNode();
  if (!sheet) (sheet = new CSSStyleSheet()).replaceSync(CSS);
  if (!adoptedStyleSheets.includes(sheet)) adoptedStyleSheets.push(sheet);
  const image = context.createImageData(WIDTH, HEIGHT);
  const pixels = new Uint32Array(image.data.buffer);
  greysOf(each).forEach((grey, index) => (pixels[index] = 0xff000000 | (grey * 0x10101)));
  context.putImageData(image, 0, 0);
}
