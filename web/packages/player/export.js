// What <pantin-player> shows as files: a picture, an animated GIF, or a video. The element loads this script once something is to be saved.

import { webm } from "./webm.js";

// Widths of a GIF, and of the display's picture, unless another one is asked for.
const [GIF_WIDTH, DISPLAY_WIDTH] = [480, 512];
// What the display's greys are multiplied by, as on the page.
const GLOW = "#bff1ff";
// GIF times are hundredths of a second, and viewers slow down what is shorter than two.
const MOST_FPS = 50;
const [PAPER, SAME, COLORS] = [0, 255, 254];
// Bits a second of a video, seconds from one picture that stands alone to the next, and pictures that may wait for the encoder.
const [BITRATE, KEY_SECONDS, MOST_QUEUED] = [5e6, 1, 4];
// How long a recorder of video is waited for: milliseconds between two questions, and questions before it gives anything.
const [ROUND, MOST_ROUNDS] = [100, 300];
// Pictures that the colors of a GIF are taken from.
const SAMPLES = 16;

// A canvas, and what paints onto it what the player shows.
function easel(player, paper, wide, isVideo) {
  const isDisplay = player.look === "oled";
  const { width, height } = player.canvas;
  wide = Math.max(1, Math.min(8192, Math.round(wide ?? (isDisplay ? DISPLAY_WIDTH : width))));
  // Encoders of video want even sizes.
  const size = [wide, Math.max(1, Math.round((wide * height) / width))].map((length) => (isVideo ? Math.ceil(length / 2) * 2 : length));
  const canvas = Object.assign(document.createElement("canvas"), { width: size[0], height: size[1] });
  const context = canvas.getContext("2d", { willReadFrequently: true });
  Object.assign(context, { imageSmoothingEnabled: !isDisplay, imageSmoothingQuality: "high" });
  const fill = (style, how) => {
    Object.assign(context, { fillStyle: style, globalCompositeOperation: how });
    context.fillRect(0, 0, ...size);
    context.globalCompositeOperation = "source-over";
  };
  return {
    canvas,
    paint() {
      fill(isDisplay ? "#000" : `rgb(${paper.slice(0, 3)})`, "source-over");
      context.drawImage(player.canvas, 0, 0, ...size);
      if (isDisplay) fill(GLOW, "multiply");
    },
    pixels: () => context.getImageData(0, 0, ...size).data,
  };
}

export async function picture(player, paper, { width, type = "image/png" } = {}) {
  const { canvas, paint } = easel(player, paper, width);
  paint();
  const blob = await new Promise((done) => canvas.toBlob(done, type));
  if (!blob) throw new Error("there is nothing to save");
  return blob;
}

export async function record(player, paper, options = {}) {
  const { type = "image/gif", width, seconds, progress, signal } = options;
  const isGif = type === "image/gif";
  const { frames, playable, frame, paused, states } = player;
  if (!frames || playable < frames) throw new Error("the clip has not arrived yet");
  const fps = Math.max(1, Math.min(MOST_FPS, options.fps ?? (isGif ? 25 : 30)));
  const from = options.from ?? player.from;
  const to = states.length ? from + (seconds ?? 3) : Math.min(options.to ?? player.to, Math.max(player.duration, 1 / fps));
  const count = Math.max(1, Math.round((to - from) * fps));
  const drawn = easel(player, paper, width ?? (isGif && player.look !== "oled" ? Math.min(GIF_WIDTH, player.canvas.width) : undefined), !isGif);
  const config = isGif ? null : await encoding(drawn.canvas, fps, type);
  if (!isGif && !config && !globalThis.MediaRecorder?.isTypeSupported(type)) throw new TypeError(`this browser cannot record ${type}`);
  // Of a character, each picture is a moment later.
  const show = (number) => {
    if (states.length) player.advance(number && 1 / fps);
    else player.currentTime = from + number / fps;
    drawn.paint();
  };
  let rested = performance.now();
  // After each picture; now and then, the page has its turn.
  const done = async (number) => {
    progress?.((number + 1) / count);
    if (performance.now() - rested > 30) {
      await new Promise((go) => setTimeout(go));
      rested = performance.now();
    }
    signal?.throwIfAborted();
  };
  player.pause();
  try {
    signal?.throwIfAborted();
    if (isGif) return await gif(drawn, show, count, fps, done, !states.length);
    return await (config ? encoded : recorded)(drawn, show, count, fps, type, done, config);
  } finally {
    if (!states.length) player.seek(frame);
    if (!paused) player.play();
  }
}

// How an encoder is to compress, or null where there is none: outside secure contexts, and of other types than WebM.
async function encoding({ width, height }, fps, type) {
  const config = { codec: "vp8", width, height, bitrate: BITRATE, framerate: fps };
  // WebKitGTK's encoder ends the page's process with an error unless another call has set up its media first.
  globalThis.MediaRecorder?.isTypeSupported(type);
  const isKnown = type === "video/webm" && (await globalThis.VideoEncoder?.isConfigSupported(config).catch(() => null))?.supported;
  return isKnown ? config : null;
}

// The colors that players suppose VP8 to hold, as nothing in the file tells them otherwise: of ITU-R BT.601, black at 16 and white at 235.
const COLOR_SPACE = { primaries: "smpte170m", transfer: "smpte170m", matrix: "smpte170m", fullRange: false };

// A picture of an even size in that space: a byte of brightness for each pixel, then one of blue and one of red for each four. Browsers convert canvases differently.
function i420(pixels, width, height) {
  const out = new Uint8Array((width * height * 3) / 2);
  const [blue, red] = [width * height, (width * height * 5) / 4];
  for (let at = 0; at < width * height; at++) out[at] = 16.5 + (65.738 * pixels[4 * at] + 129.057 * pixels[4 * at + 1] + 25.064 * pixels[4 * at + 2]) / 256;
  for (let y = 0, at = 0; y < height; y += 2) {
    for (let x = 0; x < width; x += 2, at++) {
      const corner = 4 * (y * width + x);
      const [r, g, b] = [0, 1, 2].map((channel) => [0, 4, 4 * width, 4 * width + 4].reduce((all, place) => all + pixels[corner + channel + place], 0) / 4);
      out[blue + at] = 128.5 + (-37.945 * r - 74.494 * g + 112.439 * b) / 256;
      out[red + at] = 128.5 + (112.439 * r - 94.154 * g - 18.285 * b) / 256;
    }
  }
  return out;
}

// An encoder gets each picture in its time, and the page waits for it.
async function encoded({ canvas: { width, height }, pixels }, show, count, fps, type, done, config) {
  const pictures = [];
  let failure;
  const encoder = new VideoEncoder({
    output(chunk) {
      const data = new Uint8Array(chunk.byteLength);
      chunk.copyTo(data);
      pictures.push({ data, isKey: chunk.type === "key", time: Math.round(chunk.timestamp / 1000) });
    },
    error: (error) => (failure = error),
  });
  encoder.configure(config);
  try {
    for (let number = 0; number < count; number++) {
      show(number);
      const timing = { timestamp: Math.round((number * 1e6) / fps), duration: Math.round(1e6 / fps) };
      const frame = new VideoFrame(i420(pixels(), width, height), { ...timing, format: "I420", codedWidth: width, codedHeight: height, colorSpace: COLOR_SPACE });
      encoder.encode(frame, { keyFrame: number % Math.round(KEY_SECONDS * fps) === 0 });
      frame.close();
      while (encoder.encodeQueueSize > MOST_QUEUED && !failure) await new Promise((go) => setTimeout(go, 5));
      if (failure) throw failure;
      await done(number);
    }
    await encoder.flush();
  } finally {
    if (encoder.state !== "closed") encoder.close();
  }
  return new Blob(webm(pictures, width, height, (1000 * count) / fps), { type });
}

// Recorders take the time that the pictures take, and drop what they have not encoded once they are stopped: on a busy machine that can be all.
async function recorded({ canvas }, show, count, fps, type, done) {
  const stream = canvas.captureStream(0);
  // Firefox asks the stream for pictures, other browsers its track.
  const source = stream.requestFrame ? stream : stream.getVideoTracks()[0];
  const recorder = new MediaRecorder(stream, { mimeType: type, videoBitsPerSecond: BITRATE });
  const parts = [];
  let given;
  recorder.ondataavailable = ({ data }) => {
    if (data.size) parts.push(data);
    given?.(data.size);
  };
  const ended = new Promise((stop, fail) => Object.assign(recorder, { onstop: stop, onerror: ({ error }) => fail(error) }));
  show(0);
  recorder.start();
  try {
    const begun = performance.now();
    for (let number = 0; number < count; number++) {
      if (number) show(number);
      source.requestFrame();
      await done(number);
      await new Promise((go) => setTimeout(go, begun + ((number + 1) * 1000) / fps - performance.now()));
    }
    // What is still being encoded: until nothing more comes. An encoder may wait for a picture more before it gives the first.
    for (let round = 0, size = 1; size || (!parts.length && round < MOST_ROUNDS); round++) {
      const answered = new Promise((go) => (given = go));
      await new Promise((go) => setTimeout(go, ROUND));
      if (!parts.length) source.requestFrame();
      recorder.requestData();
      size = await answered;
    }
  } finally {
    recorder.stop();
  }
  await ended;
  return new Blob(parts, { type: type.split(";")[0] });
}

const cell = (pixels, at) => ((pixels[at] >> 3) << 10) | ((pixels[at + 1] >> 3) << 5) | (pixels[at + 2] >> 3);

// At most COLORS colors that stand for those of some pictures, by median cuts, and what finds the one for a pixel. The first is the paper.
function palette(pictures, paper) {
  const sums = new Map();
  for (const pixels of pictures) {
    for (let at = 0; at < pixels.length; at += 4) {
      const key = cell(pixels, at);
      let sum = sums.get(key);
      if (!sum) sums.set(key, (sum = [key, 0, 0, 0, 0]));
      sum[1] += pixels[at];
      sum[2] += pixels[at + 1];
      sum[3] += pixels[at + 2];
      sum[4] += 1;
    }
  }
  sums.delete(cell(paper, 0));
  const level = (sum, channel) => sum[channel] / sum[4];
  // A box of colors: along the channel in which they are farthest apart, and how much it matters.
  const box = (colors) => {
    const spans = [1, 2, 3].map((channel) => {
      const levels = colors.map((sum) => level(sum, channel));
      return Math.max(...levels) - Math.min(...levels);
    });
    const span = Math.max(...spans);
    const channel = spans.indexOf(span) + 1;
    const weight = colors.reduce((all, sum) => all + sum[4], 0);
    return { colors: colors.sort((a, b) => level(a, channel) - level(b, channel)), weight, rank: span * Math.sqrt(weight) };
  };
  const boxes = sums.size ? [box([...sums.values()])] : [];
  while (boxes.length && boxes.length < COLORS - 1) {
    const most = boxes.reduce((most, one) => (one.rank > most.rank ? one : most));
    if (!most.rank) break;
    let [half, cut] = [0, 0];
    while (half < most.weight / 2) half += most.colors[cut++][4];
    cut = Math.max(1, Math.min(cut, most.colors.length - 1));
    boxes.splice(boxes.indexOf(most), 1, box(most.colors.slice(0, cut)), box(most.colors.slice(cut)));
  }
  const colors = [paper, ...boxes.map(({ colors, weight }) => [1, 2, 3].map((channel) => Math.round(colors.reduce((all, sum) => all + sum[channel], 0) / weight)))];
  const known = new Uint8Array(1 << 15).fill(SAME);
  boxes.forEach((one, index) => one.colors.forEach(([key]) => (known[key] = index + 1)));
  known[cell(paper, 0)] = PAPER;
  const find = (pixels, at) => {
    const key = cell(pixels, at);
    if (known[key] === SAME) {
      const apart = colors.map((color) => color.reduce((all, value, channel) => all + (value - pixels[at + channel]) ** 2, 0));
      known[key] = apart.indexOf(Math.min(...apart));
    }
    return known[key];
  };
  return { colors, find };
}

// Bytes in blocks of at most 255 of them, compressed as GIF does: LZW of 8 bits.
function* blocks(pixels) {
  const [clear, end] = [256, 257];
  const codes = new Map();
  let [block, bits, held, next, size] = [[], 0, 0, end + 1, 9];
  const out = [];
  const put = (code) => {
    held |= code << bits;
    for (bits += size; bits >= 8; bits -= 8, held >>>= 8) block.push(held & 255);
    while (block.length >= 255) out.push(255, ...block.splice(0, 255));
  };
  put(clear);
  let before = pixels[0];
  for (let at = 1; at < pixels.length; at++) {
    const key = (before << 8) | pixels[at];
    const code = codes.get(key);
    if (code !== undefined) {
      before = code;
      continue;
    }
    put(before);
    before = pixels[at];
    codes.set(key, next);
    // The reader is one code behind.
    if (next >> size) size += 1;
    next += 1;
    if (next > 4095) {
      put(clear);
      codes.clear();
      [next, size] = [end + 1, 9];
    }
  }
  put(before);
  if (next >> size) size += 1;
  put(end);
  if (bits) block.push(held & 255);
  if (block.length) out.push(block.length, ...block);
  yield* [out, [0]].map((bytes) => Uint8Array.from(bytes));
}

async function gif({ canvas: { width, height }, pixels }, show, count, fps, done, isAgain) {
  const words = (...values) => values.flatMap((value) => [value & 255, value >> 8]);
  const seen = [];
  const every = Math.ceil(count / SAMPLES);
  for (let number = 0; number < count && (isAgain || !number); number += every) {
    show(number);
    seen.push(pixels());
  }
  const { colors, find } = palette(seen, [...seen[0].slice(0, 3)]);
  const parts = [Uint8Array.from([
    ...new TextEncoder().encode("GIF89a"), ...words(width, height), 0xf7, PAPER, 0, ...Array.from({ length: 256 }, (_, index) => colors[index] ?? [0, 0, 0]).flat(),
    0x21, 0xff, 11, ...new TextEncoder().encode("NETSCAPE2.0"), 3, 1, 0, 0, 0,
  ])];
  let before = null;
  for (let number = 0; number < count; number++) {
    if (isAgain || number) show(number);
    const data = pixels();
    const now = new Uint8Array(width * height);
    for (let place = 0; place < now.length; place++) now[place] = find(data, 4 * place);
    // What has changed, and within it, what has not.
    let [left, top, right, bottom] = before ? [width, height, 0, 0] : [0, 0, width, height];
    if (before) {
      for (let y = 0, place = 0; y < height; y++) {
        for (let x = 0; x < width; x++, place++) {
          if (now[place] === before[place]) continue;
          [left, top, right, bottom] = [Math.min(left, x), Math.min(top, y), Math.max(right, x + 1), y + 1];
        }
      }
      if (!right) [left, top, right, bottom] = [0, 0, 1, 1];
    }
    const area = new Uint8Array((right - left) * (bottom - top));
    for (let y = top, at = 0; y < bottom; y++) {
      for (let place = y * width + left; place < y * width + right; place++) area[at++] = before?.[place] === now[place] ? SAME : now[place];
    }
    const [since, until] = [number, number + 1].map((end) => Math.round((100 * end) / fps));
    parts.push(Uint8Array.from([0x21, 0xf9, 4, 5, ...words(until - since), SAME, 0, 0x2c, ...words(left, top, right - left, bottom - top), 0, 8]), ...blocks(area));
    before = now;
    await done(number);
  }
  parts.push(Uint8Array.of(0x3b));
  return new Blob(parts, { type: "image/gif" });
}
