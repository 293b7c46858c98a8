// <pantin-player src="walk.ptn" autoplay loop look="oled|lines" speed="1"></pantin-player>: plays a Pantin clip while its bytes arrive.
//
// Properties: frame, frames, playable, received, total, paused, backwards, speed, orbit, tilt, facts, events, clips. Methods: load(what, clip), play(), pause(),
// seek(frame), step(by), grey(). `what` is a URL, a Response, a ReadableStream, bytes, or a table { rig, poses, frames, frameTime, lengthExponent }; of a bank
// (.ptb), `clip` or the URL's #fragment names the clip, and `clips` then lists the names of all. Events: progress, frame, ready, error, change, and heard with
// detail { frame, id, name } for each of the clip's `events` that playing or stepping passes.
// Keys: space plays, arrows step (with shift they turn the view), Home, End, R backwards, L look, + and - speed, 0 the usual view.

const MOST = 64 << 20;
const BANK = [0x50, 0x62];
const WORDS = ["frames", "playable", "frame", "frameTime", "looped", "channels", "moving", "rigBytes", "motionBytes", "joints", "scalars", "scalarsAt", "scalarsLength", "pose", "eventFrame", "eventId", "eventNameAt", "eventNameLength"];
// Events of a clip that are heard, at most.
const MOST_EVENTS = 4096;
// Bytes of a stroke, and how many of them there is room for.
const [STROKE, STROKES] = [12, 4096];
const TROUBLES = [
  "", "this is no Pantin clip", "the clip is of another version of the format", "the clip ends early", "the clip is damaged: a checksum does not match",
  "the clip contradicts itself", "the clip's rig is in another file", "the clip has more joints or channels than there is room for", "there is nothing to show",
];
const HOME = { orbit: -50, tilt: 12 };
const LOOKS = {
  light: { paper: [250, 250, 247], tones: [[105, 118, 126], [38, 44, 52], [198, 92, 8], [0, 104, 168], [38, 44, 52], [105, 118, 126]] },
  dark: { paper: [19, 22, 27], tones: [[170, 190, 195], [255, 240, 215], [255, 166, 77], [96, 196, 255], [255, 240, 215], [170, 190, 195]] },
};

const compiled = {};
const compile = async (url) => {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status}`);
  return WebAssembly.compile(await response.arrayBuffer());
};
// A module's exports, in an instance of its own.
const instance = async (name) => (await WebAssembly.instantiate(await (compiled[name] ??= compile(new URL(name, import.meta.url))))).exports;
const bytes = (wasm, place, length) => new Uint8Array(wasm.memory.buffer, place, length);

const TEMPLATE = `<style>
:host { display: block; font: 14px/1.4 system-ui, sans-serif; color: CanvasText; }
:host([hidden]) { display: none; }
.stage { position: relative; aspect-ratio: 2; border-radius: 10px; overflow: hidden; touch-action: pan-y; cursor: grab; outline-offset: 3px; }
.stage:active { cursor: grabbing; }
canvas { width: 100%; height: 100%; display: block; }
:host([look=oled]) .stage { background: #000; }
:host([look=oled]) canvas { image-rendering: pixelated; }
:host([look=oled]) .stage::after { content: ""; position: absolute; inset: 0; background: #bff1ff; mix-blend-mode: multiply; pointer-events: none; }
.bar { display: flex; gap: .6em; align-items: center; margin-top: .5em; }
button { font: inherit; width: 2.6em; height: 2.2em; border: 1px solid color-mix(in srgb, currentColor 30%, transparent); border-radius: 7px; background: none; color: inherit; cursor: pointer; }
input { flex: 1; min-width: 4em; accent-color: #c65c08; }
output { font-variant-numeric: tabular-nums; min-width: 6em; text-align: right; }
p { margin: .3em 0 0; min-height: 1.4em; }
:host([bare]) .bar, :host([bare]) p { display: none; }
</style>
<div class="stage" part="stage" tabindex="0" role="img" aria-label="animated figure"><canvas></canvas></div>
<div class="bar" part="bar"><button type="button" aria-label="Play"><svg viewBox="0 0 10 10" width="14" height="14" fill="currentColor" aria-hidden="true"><path/></svg></button><input type="range" min="0" max="0" step="1" value="0" aria-label="Frame"><output></output></div>
<p role="status"></p>`;

// The clips of a bank (decoder/FORMAT.md 16): its rig, and each clip's name and file.
function bankOf(file) {
  let at = 3;
  const number = () => {
    for (let value = 0, shift = 0; shift < 35; shift += 7) {
      if (at >= file.length) break;
      const byte = file[at++];
      value += (byte & 127) * 2 ** shift;
      if (byte < 128) return value;
    }
    throw new Error("the bank ends early");
  };
  const take = (length) => {
    if (at + length > file.length) throw new Error("the bank ends early");
    return file.subarray(at, (at += length));
  };
  const sections = {};
  while (at < file.length) sections[file[at++]] = take(number());
  const [rig, contents, clips] = [1, 2, 3].map((kind) => sections[kind]);
  if (!rig || !contents || !clips) throw new Error("the bank ends early");
  const found = [];
  let next = 0;
  file = contents;
  // The last two bytes are a checksum; each clip has its own.
  for (at = 0; at < contents.length - 2; ) {
    const name = new TextDecoder().decode(take(number()));
    const length = number();
    found.push({ name, file: clips.subarray(next, (next += length)) });
  }
  return { rig, clips: found };
}
const isBank = (file) => file[0] === BANK[0] && file[1] === BANK[1];

const mix = (paper, ink, part) => `rgb(${paper.map((value, index) => Math.round(value + (ink[index] - value) * part))})`;

export class PantinPlayer extends HTMLElement {
  static observedAttributes = ["src", "look", "speed"];
  #root = this.attachShadow({ mode: "open" });
  #wasm = null;
  #face = null;
  #abort = null;
  #request = 0;
  #before = 0;
  #at = 0;
  #inks = {};
  paused = true;
  backwards = false;
  speed = 1;
  received = 0;
  total = 0;
  orbit = HOME.orbit;
  tilt = HOME.tilt;
  events = [];
  clips = [];
  facts = Object.fromEntries(WORDS.map((word) => [word, 0]));

  constructor() {
    super();
    this.#root.innerHTML = TEMPLATE;
    const find = (what) => this.#root.querySelector(what);
    [this.stage, this.canvas, this.button, this.range, this.output, this.status] = [".stage", "canvas", "button", "input", "output", "p"].map(find);
    this.context = this.canvas.getContext("2d", { willReadFrequently: true });
    this.button.onclick = () => (this.paused ? this.play() : this.pause());
    this.range.oninput = () => this.seek(+this.range.value);
    this.addEventListener("keydown", (event) => this.#key(event));
    this.stage.onpointerdown = (event) => this.stage.setPointerCapture(event.pointerId);
    this.stage.onpointermove = (event) => {
      if (event.buttons & 1) this.turn(-event.movementX / 2, event.movementY / 3);
    };
    this.#told();
  }

  connectedCallback() {
    this.resizing = new ResizeObserver(() => this.#aim());
    this.resizing.observe(this.stage);
    this.dark = matchMedia("(prefers-color-scheme: dark)");
    this.dark.onchange = () => this.draw();
  }

  disconnectedCallback() {
    this.pause();
    this.#abort?.abort();
    this.resizing.disconnect();
    this.dark.onchange = null;
  }

  attributeChangedCallback(name, old, value) {
    if (name === "src" && value !== null) this.load(value).catch(() => {});
    if (name === "speed") this.speed = +value || 1;
    if (name === "look") {
      this.#aim();
      this.#tell("change");
    }
  }

  get frames() { return this.facts.frames; }
  get playable() { return this.facts.playable; }
  get frame() { return this.facts.frame; }
  get look() { return this.getAttribute("look") === "oled" ? "oled" : "lines"; }
  set look(look) { this.setAttribute("look", look); }
  get loop() { return this.hasAttribute("loop"); }
  set loop(loop) { this.toggleAttribute("loop", loop); }

  // Loads a clip in place of the one before, or one of a bank's; resolves when all of it is there, and rejects with what is wrong with it.
  async load(what, clip = null) {
    this.#abort?.abort();
    const abort = (this.#abort = new AbortController());
    this.pause();
    Object.assign(this, { received: 0, total: 0, trouble: "", events: [], clips: [] });
    if (typeof what === "string") clip ??= decodeURIComponent(new URL(what, document.baseURI).hash.slice(1)) || null;
    this.#at = 0;
    // Clip and module come at the same time.
    const { signal } = abort;
    const coming = typeof what === "string" ? fetch(new URL(what, document.baseURI), { signal }) : Promise.resolve(what);
    coming.catch(() => {});
    try {
      const wasm = await instance("pantin-player.wasm");
      if (signal.aborted) return;
      this.#wasm = wasm;
      this.#face = null;
      this.#aim();
      await (what.poses ? this.#table(what) : this.#receive(await coming, signal, clip));
      if (!signal.aborted) this.#tell("ready");
    } catch (error) {
      if (signal.aborted) return;
      this.trouble = error.message;
      this.#told();
      this.#tell("error", error.message);
      throw error;
    }
  }

  async #table({ rig, poses, frames, frameTime, lengthExponent }) {
    const wasm = this.#wasm;
    const start = Math.ceil(rig.length / 4) * 4;
    const place = wasm.room(start + poses.byteLength);
    if (!place) throw new Error("there is not enough memory for the poses");
    bytes(wasm, place).set(rig);
    new Int32Array(wasm.memory.buffer, place + start).set(poses);
    this.#check(wasm.poses(rig.length, frames, frameTime, lengthExponent));
    await this.#meet();
    this.#shown();
  }

  // The face of a clip that may drive one: it is loaded only then. Until it has loaded, no event reports the clip.
  async #meet() {
    const wasm = this.#wasm;
    const { channels, scalars, scalarsAt, scalarsLength } = this.#known();
    if (this.#face || !scalars) return;
    const face = await instance("pantin-face.wasm");
    if (wasm !== this.#wasm) return;
    bytes(face, face.room(scalarsLength)).set(bytes(wasm, scalarsAt, scalarsLength));
    this.#face = { ...face, drawn: face.bind(scalarsLength, scalars, channels - scalars) };
    this.facts = this.#known();
    this.#aim();
  }

  async #receive(what, signal, clip) {
    if (what instanceof Response) {
      if (!what.ok) throw new Error(`the clip cannot be fetched: ${what.status} ${what.statusText}`);
      // With an encoding, it is the length of something else.
      if (!what.headers.get("Content-Encoding")) this.total = +what.headers.get("Content-Length") || 0;
      what = what.body;
    }
    if (!(what instanceof ReadableStream)) what = new Blob([what]).stream();
    if (this.total > MOST) throw new Error(`the file has ${this.total} bytes; a clip may have ${MOST} here`);
    const reader = what.getReader();
    let [trouble, whole] = [0, null];
    for (;;) {
      let { done, value } = await reader.read().catch(() => ({ done: true }));
      if (signal.aborted) return reader.cancel();
      if (!this.received && value && isBank(value)) whole = [];
      if (whole) {
        // A bank's clips may lie anywhere in it.
        if (!done) {
          whole.push(value);
          if (whole.reduce((sum, part) => sum + part.length, 0) > MOST) throw new Error(`a bank may have ${MOST} bytes here`);
          continue;
        }
        value = this.#chosen(new Uint8Array(await new Blob(whole).arrayBuffer()), clip);
        [done, whole] = [false, null];
      }
      if (done) break;
      const place = this.#wasm.room(this.received + value.length);
      if (!place) {
        reader.cancel();
        throw new Error(`a clip may have ${MOST} bytes here`);
      }
      bytes(this.#wasm, place + this.received).set(value);
      this.received += value.length;
      trouble ||= this.#wasm.arrived(this.received);
      await this.#meet();
      if (signal.aborted) return reader.cancel();
      this.#shown();
      if (this.hasAttribute("autoplay") && this.paused && !this.#at && this.playable > 1 && !matchMedia("(prefers-reduced-motion: reduce)").matches) this.play();
      this.#tell("progress");
      // A file of another kind need not be read to its end.
      if (trouble && !this.frames && !this.playable) break;
    }
    if (!trouble || this.playable) trouble = this.#wasm.finish() || trouble;
    this.events = this.#events();
    reader.cancel().catch(() => {});
    this.total ||= this.received;
    this.#shown();
    this.#check(trouble);
  }

  // Puts a bank's rig into the module's memory, and returns the clip that was asked for, or the first, behind it.
  #chosen(file, name) {
    const { rig, clips } = bankOf(file);
    this.clips = clips.map((clip) => clip.name);
    const clip = name === null ? clips[0] : clips.find((clip) => clip.name === name);
    const names = this.clips.join(", ");
    if (!clip) throw new Error(`the bank has no clip ${name}; it has ${names}`);
    this.#wasm.apart(rig.length);
    const both = new Uint8Array(rig.length + clip.file.length);
    both.set(rig);
    both.set(clip.file, rig.length);
    this.total = both.length;
    return both;
  }

  // The clip's events, in the order of their frames.
  #events() {
    const [wasm, events] = [this.#wasm, []];
    while (events.length < MOST_EVENTS && wasm.event(events.length)) {
      const { eventFrame, eventId, eventNameAt, eventNameLength } = this.#known();
      events.push({ frame: eventFrame, id: eventId, name: new TextDecoder().decode(bytes(wasm, eventNameAt, eventNameLength)) });
    }
    return events;
  }

  // Reports the events from one frame on, which was shown, to another, which is.
  #hear(from, to, backwards) {
    const count = this.playable || 1;
    const way = (frame) => (((backwards ? from - frame : frame - from) + 2 * count - 1) % count) + 1;
    const passed = this.events.filter(({ frame }) => way(frame) <= way(to));
    (backwards ? passed.reverse() : passed).sort((a, b) => way(a.frame) - way(b.frame)).forEach((event) => this.#tell("heard", event));
  }

  #check(code) {
    if (!code) return;
    const left = this.playable && this.playable < this.frames ? `; ${this.playable} of ${this.frames} frames can be played` : "";
    throw new Error(TROUBLES[code] + left);
  }

  #aim() {
    if (!this.#wasm || !this.isConnected) return;
    const scale = Math.min(devicePixelRatio || 1, 2047 / this.stage.clientWidth);
    const [width, height] = this.look === "oled" ? [128, 64] : [this.stage.clientWidth, this.stage.clientHeight].map((length) => Math.max(1, Math.floor(length * scale)));
    Object.assign(this.canvas, { width, height });
    const [orbit, tilt] = [Math.round(this.orbit), Math.round(this.tilt)];
    // A face stands beside the body as the firmware divides its displays, or has all of the picture.
    const [face, wide] = [this.#face?.drawn, 2 * width >= 3 * height];
    const side = !this.facts.joints ? width : wide ? height : Math.floor(width / 5) * 2;
    this.#wasm.aim(!face ? width : !this.facts.joints ? 0 : wide ? width - side : width, height, orbit, tilt);
    if (face) this.#face.aim(side, this.facts.joints ? side : height, width - side, orbit - HOME.orbit, tilt - HOME.tilt);
    this.#shown();
  }

  // Orbits and tilts the camera, in degrees.
  turn(orbit, tilt) {
    this.orbit = ((this.orbit + orbit + 540) % 360) - 180;
    this.tilt = Math.max(-30, Math.min(85, this.tilt + tilt));
    this.#aim();
    this.#tell("change");
  }

  // Shows exactly this frame, or the last one that is playable.
  seek(frame) {
    this.#at = Math.max(0, Math.min(frame, this.playable - 1));
    this.#wasm?.go(this.#at);
    this.#shown();
    this.#tell("frame");
  }

  step(by) {
    this.pause();
    const before = this.frame;
    this.seek((this.frame + by + this.playable) % (this.playable || 1));
    this.#hear(before, this.frame, by < 0);
  }

  play() {
    if (!this.#wasm || !this.paused) return;
    this.paused = false;
    const last = this.playable - 1;
    const ended = this.playable === this.frames && !this.loop && this.frame === (this.backwards ? 0 : last);
    this.#at = ended ? (this.backwards ? last : 0) : this.frame;
    this.#before = performance.now();
    this.#request = requestAnimationFrame((now) => this.#tick(now));
    this.#told();
    this.#tell("change");
    // What happens at the first frame happens when it begins.
    if (this.frame === (this.backwards ? last : 0)) this.events.filter(({ frame }) => frame === this.frame).forEach((event) => this.#tell("heard", event));
  }

  pause() {
    cancelAnimationFrame(this.#request);
    if (this.paused) return;
    this.paused = true;
    this.#told();
    this.#tell("change");
  }

  #tick(now) {
    const { frames, playable, frameTime } = this.facts;
    const passed = Math.max(0, now - this.#before) * 1e6 / (frameTime || 1e9);
    this.#before = now;
    let at = this.#at + passed * this.speed * (this.backwards ? -1 : 1);
    // Time waits for frames that have not come.
    if (playable < frames && at >= playable) at = playable - 0.001;
    if (playable && (at < 0 || at >= playable)) {
      if (this.loop) at = ((at % playable) + playable) % playable;
      else {
        const end = at < 0 ? 0 : playable - 1;
        const before = this.frame;
        if (before !== end) this.seek(end), this.#hear(before, end, this.backwards);
        return this.pause();
      }
    }
    this.#at = at;
    if (Math.floor(at) !== this.frame) {
      const before = this.frame;
      this.#wasm.go(Math.floor(at));
      this.#shown();
      this.#tell("frame");
      this.#hear(before, this.frame, this.backwards);
    }
    this.#request = requestAnimationFrame((next) => this.#tick(next));
  }

  #key(event) {
    const [on] = event.composedPath();
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    // What the button and the scrubber do with their own keys they do themselves.
    if ((on === this.button && event.key === " ") || (on === this.range && event.key.startsWith("Arrow"))) return;
    const [turn, step] = [event.shiftKey, event.shiftKey ? 15 : 1];
    const act = {
      " ": () => (this.paused ? this.play() : this.pause()),
      ArrowLeft: () => (turn ? this.turn(-step, 0) : this.step(-1)),
      ArrowRight: () => (turn ? this.turn(step, 0) : this.step(1)),
      ArrowUp: () => this.turn(0, 5),
      ArrowDown: () => this.turn(0, -5),
      Home: () => this.seek(0),
      End: () => this.seek(this.playable - 1),
      r: () => (this.backwards = !this.backwards),
      l: () => (this.look = this.look === "oled" ? "lines" : "oled"),
      "+": () => (this.speed = Math.min(8, this.speed * 2)),
      "-": () => (this.speed = Math.max(1 / 8, this.speed / 2)),
      0: () => this.turn(HOME.orbit - this.orbit, HOME.tilt - this.tilt),
    }[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act) return;
    event.preventDefault();
    act();
    this.#tell("change");
  }

  // The greys of the 128x64 display, 17 times 0 to 15; in that look alone.
  grey() {
    const count = this.#gather();
    return bytes(this.#wasm, this.#wasm.grey(count), 128 * 64);
  }

  // Puts the frame's strokes into the module's memory, from far to near, and counts them.
  #gather() {
    const [wasm, face] = [this.#wasm, this.#face];
    const count = wasm.strokes();
    if (!face?.drawn || !this.playable) return count;
    const { channels, pose } = this.facts;
    bytes(face, face.room(4 * channels)).set(bytes(wasm, pose, 4 * channels));
    const more = Math.min(face.place(channels), STROKES - count);
    bytes(wasm, wasm.picture() + STROKE * count).set(bytes(face, face.picture(), STROKE * more));
    return count + more;
  }

  #known() {
    const words = new Uint32Array(this.#wasm.memory.buffer, this.#wasm.facts());
    return Object.fromEntries(WORDS.map((word, index) => [word, words[index]]));
  }

  #shown() {
    this.facts = this.#known();
    this.draw();
    this.#told();
  }

  draw() {
    if (!this.#wasm) return;
    if (this.look === "oled") return this.#drawGrey();
    this.#drawLines();
  }

  #drawGrey() {
    const image = this.context.createImageData(128, 64);
    const pixels = new Uint32Array(image.data.buffer);
    this.grey().forEach((grey, index) => (pixels[index] = 0xff000000 | (grey * 0x10101)));
    this.context.putImageData(image, 0, 0);
  }

  #drawLines() {
    const { context, canvas } = this;
    const look = LOOKS[this.dark?.matches ? "dark" : "light"];
    const end = this.#gather() * STROKE;
    const view = new DataView(this.#wasm.memory.buffer, this.#wasm.picture(), end);
    context.fillStyle = mix(look.paper, look.paper, 0);
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.lineCap = context.lineJoin = "round";
    const thin = Math.max(1, canvas.height / 280);
    for (let place = 0, before = ""; place < end; place += STROKE) {
      const [x, y, u, v] = [0, 2, 4, 6].map((offset) => view.getInt16(place + offset, true) / 16);
      const [shade, what, width] = [8, 9, 10].map((offset) => view.getUint8(place + offset));
      const ink = (this.#inks[look.paper + [what, shade]] ??= mix(look.paper, look.tones[what], shade / 255));
      const style = ink + width;
      if (style !== before || what > 3) {
        if (before) context.stroke();
        context.beginPath();
        context.strokeStyle = ink;
        context.lineWidth = what === 0 ? thin / 1.5 : Math.max(thin, width);
      }
      before = style;
      if (what === 4) context.arc(x, y, u, 0, 7), context.fill();
      else context.moveTo(x, y), context.lineTo(u, v);
    }
    context.stroke();
  }

  #told() {
    const { frame, frames, playable } = this.facts;
    this.button.querySelector("path").setAttribute("d", this.paused ? "M2 1v8l7-4z" : "M2 1h2v8H2zM6 1h2v8H6z");
    this.button.setAttribute("aria-label", this.paused ? "Play" : "Pause");
    this.range.max = Math.max(0, playable - 1);
    this.range.value = frame;
    this.output.textContent = frames ? `${frame + 1} / ${frames}` : "";
    const coming = this.received && playable < frames ? `${this.received} bytes, ${playable} of ${frames} frames` : "";
    const words = this.trouble || coming;
    if (this.status.textContent !== words) this.status.textContent = words;
  }

  #tell(name, detail = null) {
    this.dispatchEvent(new CustomEvent(name, { detail }));
  }
}

customElements.define("pantin-player", PantinPlayer);
