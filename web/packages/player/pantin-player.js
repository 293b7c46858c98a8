// <pantin-player src="walk.ptn" autoplay loop look="oled|lines" speed="1"></pantin-player>: plays a Pantin clip while its bytes arrive. docs/WEB.md lists
// its attributes, properties, methods and events.

const MOST = 64 << 20;
const WORDS = ["frames", "playable", "frame", "frameTime", "looped", "channels", "moving", "rigBytes", "motionBytes", "joints", "scalars", "scalarsAt", "scalarsLength", "pose", "eventFrame", "eventId", "eventNameAt", "eventNameLength"];
const none = () => Object.fromEntries(WORDS.map((word) => [word, 0]));
// What a player without a clip knows.
const empty = () => ({ received: 0, total: 0, trouble: "", events: [], clips: [], states: [], inputs: [], parameters: [], state: null, facts: none() });
// Events of a clip that are heard, at most.
const MOST_EVENTS = 4096;
// Bytes of a stroke, and how many of them there is room for.
const [STROKE, STROKES] = [12, 4096];
const TROUBLES = [
  "", "this is no Pantin clip", "the clip is of another version of the format", "the clip ends early", "the clip is damaged: a checksum does not match",
  "the clip contradicts itself", "the clip's rig is in another file", "the clip has more joints or channels than there is room for", "there is nothing to show",
];
const HOME = { orbit: -50, tilt: 12 };
// What is behind the figure where the ground is transparent, on a light page and a dark one.
const PAPERS = [[250, 250, 247], [19, 22, 27]];
// The axes that `up` names.
const AXES = { x: 1, y: 2, z: 3 };
const SIDES = { left: -1, right: 1 };
// Properties that may be set before the element is defined.
const SETTABLE = ["look", "loop", "autoplay", "fit", "align", "up", "from", "to", "speed", "backwards", "orbit", "tilt", "src", "currentTime"];

const bytes = (wasm, place, length) => new Uint8Array(wasm.memory.buffer, place, length);

// The instance of a module that all players share. Its memory is divided here, in blocks that are used again. What failed is tried again by the next clip.
const modules = {};
const open = (url) => (modules[url] ??= start(url).catch((error) => {
  delete modules[url];
  throw error;
}));
async function start(url) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status}`);
  const { instance } = await WebAssembly.instantiate(await response.arrayBuffer());
  const free = {};
  let end = (instance.exports.base() + 15) & -16;
  return {
    ...instance.exports,
    // The address of a new block of `size` bytes, a multiple of 16.
    take(size) {
      const known = free[size]?.pop();
      if (known) return known;
      const { memory } = instance.exports;
      const missing = end + size - memory.buffer.byteLength;
      if (missing > 0) memory.grow(Math.ceil(missing / 65536));
      end += size;
      return end - size;
    },
    give: (place, size) => (free[size] ??= []).push(place),
  };
}
// Blocks of a file have sizes of powers of two.
const block = (size) => 2 ** Math.max(12, Math.ceil(Math.log2(size)));

// Returns the memory of a player that is gone.
function release(seat) {
  for (const [wasm, place, size] of seat.blocks) wasm.give(place, size);
  seat.blocks = [];
}
const gone = globalThis.FinalizationRegistry && new FinalizationRegistry(release);

const CSS = `
:host { display: flex; flex-direction: column; font: 14px/1.4 system-ui, sans-serif; transition: color 1ms; }
:host([hidden]) { display: none; }
.stage { --p: #fafaf7; --m: #262c34; --l: #c65c08; --r: #0068a8; --g: #69767e; }
.dark { --p: #13161b; --m: #fff0d7; --l: #ffa64d; --r: #60c4ff; --g: #aabec3; }
.stage { position: relative; flex: 1 1 auto; min-height: 0; aspect-ratio: 2; border-radius: 10px; overflow: hidden; touch-action: pan-y; cursor: grab; outline-offset: 3px; background: var(--pantin-paper, var(--p)); color: var(--pantin-body, var(--m)); fill: var(--pantin-left, var(--l)); stroke: var(--pantin-right, var(--r)); stop-color: var(--pantin-ground, var(--g)); }
.stage:active { cursor: grabbing; }
canvas { position: absolute; inset: 0; width: 100%; height: 100%; }
:host([look=oled]) .stage { background: #000; }
:host([look=oled]) canvas { image-rendering: pixelated; }
:host([look=oled]) .stage::after { content: ""; position: absolute; inset: 0; background: #bff1ff; mix-blend-mode: multiply; pointer-events: none; }
.bar { display: flex; gap: .6em; align-items: center; margin-top: .5em; }
button { font: inherit; width: 2.6em; height: 2.2em; border: 1px solid color-mix(in srgb, currentColor 30%, transparent); border-radius: 7px; background: none; color: inherit; cursor: pointer; }
input { flex: 1; min-width: 4em; accent-color: var(--pantin-accent, #c65c08); }
output { font-variant-numeric: tabular-nums; min-width: 6em; text-align: right; }
p { margin: .3em 0 0; min-height: 1.4em; }
:host([bare]) .bar, :host([bare]) p { display: none; }
@media (pointer: coarse), (max-width: 40rem) { button { width: 44px; height: 44px; } input { height: 44px; } }
@media (forced-colors: active) { .stage { forced-color-adjust: none; background: Canvas; color: CanvasText; fill: CanvasText; stroke: CanvasText; stop-color: GrayText; } }
`;
let sheet;
let pixel;

// A color of CSS as red, green, blue and opacity, 0 to 255.
function parts(color) {
  pixel ??= Object.assign(document.createElement("canvas"), { width: 1, height: 1 }).getContext("2d", { willReadFrequently: true });
  pixel.clearRect(0, 0, 1, 1);
  pixel.fillStyle = color;
  pixel.fillRect(0, 0, 1, 1);
  return [...pixel.getImageData(0, 0, 1, 1).data];
}

function make(parent, name, attributes, space = "http://www.w3.org/1999/xhtml") {
  const element = document.createElementNS(space, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  parent.append(element);
  return element;
}

const SVG = "http://www.w3.org/2000/svg";

const isBank = (file) => file[0] === 0x50 && file[1] === 0x62;

// Where there is no page, as in Node, the class can be imported but not used.
export class PantinPlayer extends (globalThis.HTMLElement ?? Object) {
  static observedAttributes = ["src", "look", "speed", "fit", "align", "up", "bare"];
  #seat = null;
  #abort = null;
  // Where the last clip that removal kept from loading is to be loaded from.
  #cut = false;
  // A source that waits until the element is seen.
  #lazy = null;
  #request = 0;
  #before = 0;
  #at = 0;
  // A frame, or seconds, that were asked for and have not come.
  #wanted = null;
  #seen = false;
  #held = false;
  // What steers a character.
  #actor = null;
  // Sixteenths of a pixel by which strokes are moved to the right.
  #aside = 0;
  #tones = [];
  #inks = {};
  #paused = true;
  // What the button shows: whether it plays or pauses.
  #offered = null;
  #backwards = false;
  #speed = 1;
  #told = 0;
  #orbit = HOME.orbit;
  #tilt = HOME.tilt;
  received = 0;
  total = 0;
  trouble = "";
  events = [];
  clips = [];
  states = [];
  inputs = [];
  parameters = [];
  state = null;
  facts = none();

  constructor() {
    super();
    const root = this.attachShadow({ mode: "open" });
    if (!sheet) (sheet = new CSSStyleSheet()).replaceSync(CSS);
    root.adoptedStyleSheets = [sheet];
    this.stage = make(root, "div", { class: "stage", part: "stage", tabindex: 0, role: "img", "aria-label": "animated figure" });
    this.canvas = make(this.stage, "canvas", {});
    const bar = make(root, "div", { class: "bar", part: "bar" });
    this.button = make(bar, "button", { type: "button" });
    this.icon = make(make(this.button, "svg", { viewBox: "0 0 10 10", width: 14, height: 14, fill: "currentColor", "aria-hidden": true }, SVG), "path", {}, SVG);
    this.scrubber = make(bar, "input", { type: "range", min: 0, max: 0, step: 1, value: 0, "aria-label": "Frame" });
    this.output = make(bar, "output", {});
    this.status = make(root, "p", { role: "status" });
    this.context = this.canvas.getContext("2d", { willReadFrequently: true });
    this.button.onclick = () => this.#toggle();
    this.scrubber.oninput = () => this.seek(+this.scrubber.value);
    // While the scrubber is held, the frame is held.
    this.scrubber.onpointerdown = () => (this.#held = true);
    this.scrubber.onpointerup = this.scrubber.onpointercancel = () => (this.#held = false);
    this.addEventListener("keydown", (event) => this.#key(event));
    // The page's text has another color.
    this.addEventListener("transitionend", ({ target }) => target === this && this.#aim());
    let from;
    const place = ({ clientX, clientY }) => [clientX, clientY];
    this.stage.onpointerdown = (event) => {
      from = place(event);
      this.stage.setPointerCapture(event.pointerId);
    };
    this.stage.onpointermove = (event) => {
      if (!(event.buttons & 1) || !from) return;
      const [[x, y], [oldX, oldY]] = [place(event), from];
      from = [x, y];
      this.turn((oldX - x) / 2, (y - oldY) / 3);
    };
    this.#tell();
  }

  connectedCallback() {
    for (const name of SETTABLE.filter((name) => Object.hasOwn(this, name))) {
      const value = this[name];
      delete this[name];
      this[name] = value;
    }
    this.resizing = new ResizeObserver(() => this.#aim());
    this.resizing.observe(this.stage);
    // Who cannot be seen does not play.
    this.watching = new IntersectionObserver((entries) => this.#see(entries.at(-1).isIntersecting), { rootMargin: "100px" });
    this.watching.observe(this.stage);
    const { src } = this;
    if (this.#cut && src !== null) this.#load(src);
    this.#cut = false;
  }

  disconnectedCallback() {
    this.resizing.disconnect();
    this.watching.disconnect();
    // A player that is moved within the page goes on.
    queueMicrotask(() => {
      if (this.isConnected) return;
      this.pause();
      this.#seen = false;
      this.#cut = this.#abort && !this.#abort.done;
      if (this.#cut) this.#abort.abort();
    });
  }

  attributeChangedCallback(name, old, value) {
    if (name === "src") {
      if (value === null) this.#unload();
      else if (this.getAttribute("loading") === "lazy" && !this.#seen) this.#lazy = value;
      else this.#load(value);
    } else if (name === "speed") this.#speed = +value || 1;
    else {
      this.#aim();
      this.#dispatch("change");
    }
  }

  get src() { return this.getAttribute("src"); }
  set src(src) { this.setAttribute("src", src); }
  get frames() { return this.facts.frames; }
  get playable() { return this.facts.playable; }
  get frame() { return this.facts.frame; }
  get paused() { return this.#paused; }
  get look() { return this.getAttribute("look") === "oled" ? "oled" : "lines"; }
  set look(look) { this.setAttribute("look", look); }
  get loop() { return this.hasAttribute("loop"); }
  set loop(loop) { this.toggleAttribute("loop", loop); }
  get autoplay() { return this.hasAttribute("autoplay"); }
  set autoplay(autoplay) { this.toggleAttribute("autoplay", autoplay); }
  get fit() { return this.getAttribute("fit") === "whole" ? "whole" : "follow"; }
  set fit(fit) { this.setAttribute("fit", fit); }
  get up() { return this.getAttribute("up") ?? ""; }
  set up(up) { this.setAttribute("up", up); }
  get align() { return this.getAttribute("align") ?? "center"; }
  set align(align) { this.setAttribute("align", align); }
  // Seconds.
  get from() { return +this.getAttribute("from") || 0; }
  set from(from) { this.setAttribute("from", from); }
  get to() { return +this.getAttribute("to") || Infinity; }
  set to(to) { this.setAttribute("to", to); }
  get speed() { return this.#speed; }
  set speed(speed) { this.#speed = +speed || 1; }
  get backwards() { return this.#backwards; }
  set backwards(backwards) { this.#backwards = !!backwards; }
  get orbit() { return this.#orbit; }
  set orbit(orbit) { this.turn(orbit - this.#orbit, 0); }
  get tilt() { return this.#tilt; }
  set tilt(tilt) { this.turn(0, tilt - this.#tilt); }
  // Seconds. In a loop, the last frame lasts as long as the others.
  get duration() { return this.frames ? ((this.frames - !this.facts.looped) * this.facts.frameTime) / 1e9 : NaN; }
  get currentTime() { return (this.frame * this.facts.frameTime) / 1e9; }
  set currentTime(seconds) { this.#want([seconds, true]); }

  // Loads a clip in place of the one before, or one of a bank's; resolves when all of it is there, and rejects with what is wrong with it.
  async load(what, clip = null) {
    if (this.#abort) this.#wanted = null;
    this.#abort?.abort();
    const abort = (this.#abort = new AbortController());
    this.pause();
    Object.assign(this, empty());
    this.#lazy = null;
    this.#at = 0;
    const { signal } = abort;
    try {
      let coming = what;
      if (typeof what === "string" || what instanceof URL) {
        const url = new URL(what, document.baseURI);
        clip ??= decodeURIComponent(url.hash.slice(1)) || null;
        // Clip and module come at the same time.
        coming = fetch(url, { signal });
        coming.catch(() => {});
      }
      const wasm = await open(new URL("./pantin-player.wasm", import.meta.url));
      signal.throwIfAborted();
      this.#sit(wasm);
      this.#aim();
      if (this.from) this.#wanted ??= [this.from, true];
      await (what.poses ? this.#table(what, signal) : this.#receive(await coming, signal, clip));
      signal.throwIfAborted();
      this.#want(this.#wanted);
      abort.done = true;
      this.#tell();
      this.#dispatch("ready");
    } catch (error) {
      // Another clip was loaded instead, or the element was removed.
      if (signal.aborted) throw signal.reason;
      this.#wanted = null;
      abort.done = true;
      this.trouble = error.message;
      this.#tell();
      this.#dispatch("error", error.message);
      throw error;
    }
  }

  #load(src) {
    this.load(src).catch(() => {});
  }

  // Without a clip.
  #unload() {
    this.#abort?.abort();
    [this.#abort, this.#lazy, this.#wanted, this.#at] = [null, null, null, 0];
    this.pause();
    if (this.#seat) release(this.#seat);
    this.#seat = null;
    Object.assign(this, empty());
    this.context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    this.#tell();
    this.#dispatch("change");
  }

  // Memory of a player without a clip.
  #sit(wasm) {
    if (this.#seat) release(this.#seat);
    else {
      this.#seat = {};
      gone?.register(this, this.#seat);
    }
    const seat = this.#seat;
    Object.assign(seat, { wasm, face: null, file: 0, size: 0, blocks: [] });
    seat.at = this.#take(wasm, wasm.slot());
    wasm.start(seat.at);
  }

  #take(wasm, size) {
    let place;
    try {
      place = wasm.take(size);
    } catch {
      throw new Error("there is not enough memory");
    }
    this.#seat.blocks.push([wasm, place, size]);
    return place;
  }

  // The address of the file, with room for its bytes; what has come stays.
  #room(size) {
    const seat = this.#seat;
    const { wasm, file } = seat;
    if (size > MOST) throw new Error(`a clip may have ${MOST} bytes here`);
    if (size > seat.size) {
      seat.file = this.#take(wasm, (seat.size = block(size)));
      bytes(wasm, seat.file).set(bytes(wasm, file, this.received));
      // The clip goes on to read the old block until it knows of the new one, in the same task.
      const old = seat.blocks.findIndex(([, place]) => place === file);
      if (file) wasm.give(...seat.blocks.splice(old, 1)[0].slice(1));
    }
    return seat.file;
  }

  // Moves to the module that plays more than clips: it is loaded only then.
  async #change(signal) {
    const wasm = await open(new URL("./pantin-character.wasm", import.meta.url));
    signal.throwIfAborted();
    this.#sit(wasm);
    return this.#seat;
  }

  async #table({ rig, poses, frames, frameTime, lengthExponent }, signal) {
    const { wasm, at } = await this.#change(signal);
    const start = Math.ceil(rig.length / 4) * 4;
    const size = start + poses.byteLength;
    const place = this.#take(wasm, block(size));
    bytes(wasm, place).set(rig);
    new Int32Array(wasm.memory.buffer, place + start).set(poses);
    this.#check(wasm.poses(at, place, size, rig.length, frames, frameTime, lengthExponent));
    await this.#meet(signal);
    this.#aim();
    this.#shown();
  }

  // The face of a clip that may drive one: it is loaded only then. Until it has loaded, no event reports the clip.
  async #meet(signal) {
    const { channels, scalars, scalarsAt, scalarsLength } = this.#known();
    if (this.#seat.face || !scalars) return;
    const face = await open(new URL("./pantin-face.wasm", import.meta.url));
    signal.throwIfAborted();
    const at = this.#take(face, face.slot());
    const pose = this.#take(face, block(Math.max(scalarsLength, 4 * channels)));
    bytes(face, pose).set(bytes(this.#seat.wasm, scalarsAt, scalarsLength));
    this.#seat.face = { face, at, pose, drawn: face.bind(at, pose, scalarsLength, scalars, channels - scalars) };
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
    const { wasm, at } = this.#seat;
    const reader = what.getReader();
    try {
      let [trouble, whole, eager] = [0, null, this.autoplay && !matchMedia("(prefers-reduced-motion: reduce)").matches];
      for (;;) {
        let { done, value } = await reader.read().catch(() => ({ done: true }));
        signal.throwIfAborted();
        if (!this.received && value && isBank(value)) whole = [];
        if (whole) {
          // A bank's clips may lie anywhere in it.
          if (!done) {
            whole.push(value);
            if (whole.reduce((sum, part) => sum + part.length, 0) > MOST) throw new Error(`a bank may have ${MOST} bytes here`);
            continue;
          }
          const file = new Uint8Array(await new Blob(whole).arrayBuffer());
          signal.throwIfAborted();
          const known = await import("./pantin-character.js");
          signal.throwIfAborted();
          const bank = known.bankOf(file);
          if (bank.machine && clip === null) return await this.#steer(file, bank, known, signal, eager);
          this.clips = bank.clips.map(({ name }) => name);
          value = known.chosen(bank, clip);
          this.total = value.length;
          wasm.apart(at, bank.rig.length);
          [done, whole] = [false, null];
        }
        if (done) break;
        const file = this.#room(Math.max(this.total, this.received + value.length));
        bytes(wasm, file + this.received).set(value);
        this.received += value.length;
        // A file may have moved, whatever is wrong with it.
        trouble = wasm.arrived(at, file, this.received) || trouble;
        await this.#meet(signal);
        this.#shown();
        this.#want(this.#wanted);
        if (eager && this.playable > 1) {
          this.play();
          eager = false;
        }
        this.#dispatch("progress");
        // A file of another kind need not be read to its end.
        if (trouble && !this.frames && !this.playable) break;
      }
      if (!trouble || this.playable) trouble = wasm.finish(at) || trouble;
      this.events = this.#events();
      this.total ||= this.received;
      this.#shown();
      this.#check(trouble);
    } finally {
      reader.cancel().catch(() => {});
    }
  }

  // Plays the state machine of a bank.
  async #steer(file, { clips }, { steer }, signal, eager) {
    const { wasm, at } = await this.#change(signal);
    const place = this.#room(file.length);
    bytes(wasm, place).set(file);
    [this.received, this.total, this.clips] = [file.length, file.length, clips.map(({ name }) => name)];
    this.#check(wasm.machine(at, place, file.length));
    this.#actor = steer(this, wasm, at, () => this.#event(), () => this.#shown(), (name, detail) => this.#dispatch(name, detail));
    this.#actor.pass(0);
    this.#aim();
    if (eager) this.play();
  }

  // The event that the module's facts have; or a name alone.
  #event() {
    const { eventFrame, eventId, eventNameAt, eventNameLength } = this.#known();
    return { frame: eventFrame, id: eventId, name: new TextDecoder().decode(bytes(this.#seat.wasm, eventNameAt, eventNameLength)) };
  }

  #steering() {
    if (!this.#actor) throw new RangeError("there is no state machine");
    return this.#actor;
  }

  // Lets a character's time pass, in seconds, as playing does.
  advance(seconds) {
    if (this.states.length) this.#actor.pass(Math.round(seconds * 1e6));
  }

  // Fires an input of the state machine once.
  fire(name) {
    this.#steering().input(name, 2);
  }

  // Holds an input down, or lets it go.
  hold(name, down = true) {
    this.#steering().input(name, +!!down);
  }

  // Sets a parameter, within its range.
  set(name, value) {
    this.#steering().set(name, value);
  }

  // The clip's events, in the order of their frames.
  #events() {
    const [{ wasm, at }, events] = [this.#seat, []];
    while (events.length < MOST_EVENTS && wasm.event(at, events.length)) events.push(this.#event());
    return events;
  }

  // Reports the events from one frame on, which was shown, to another, which is.
  #hear(from, to, backwards, [first, end] = [0, this.playable || 1]) {
    const count = end - first;
    const way = (frame) => (((backwards ? from - frame : frame - from) + 2 * count - 1) % count) + 1;
    const passed = this.events.filter(({ frame }) => frame >= first && frame < end && way(frame) <= way(to));
    (backwards ? passed.reverse() : passed).sort((a, b) => way(a.frame) - way(b.frame)).forEach((event) => this.#dispatch("heard", event));
  }

  #check(code) {
    if (!code) return;
    const left = this.playable && this.playable < this.frames ? `; ${this.playable} of ${this.frames} frames can be played` : "";
    throw new Error(TROUBLES[code] + left);
  }

  #aim() {
    if (!this.#seat?.wasm || !this.isConnected) return;
    const { wasm, at, face: known } = this.#seat;
    const scale = Math.min(devicePixelRatio || 1, 2047 / this.stage.clientWidth);
    const [width, height] = this.look === "oled" ? [128, 64] : [this.stage.clientWidth, this.stage.clientHeight].map((length) => Math.max(1, Math.floor(length * scale)));
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    this.#colors();
    const [orbit, tilt] = [Math.round(this.#orbit), Math.round(this.#tilt)];
    // A face stands beside the body as the firmware divides its displays, or has all of the picture.
    const [face, wide] = [known?.drawn, 2 * width >= 3 * height];
    const side = !this.facts.joints ? width : wide ? height : Math.floor(width / 5) * 2;
    // A figure at one side is the middle of a wider picture, of which the rest is not seen.
    const small = Math.min(width, height);
    const way = face || this.fit === "whole" ? 0 : (SIDES[this.align] ?? 0);
    const broad = way ? Math.min(2047, 2 * width - small) : width;
    this.#aside = way * 8 * (way < 0 ? broad - small : 2 * width - small - broad);
    wasm.aim(at, !face ? broad : !this.facts.joints ? 0 : wide ? width - side : width, height, orbit, tilt, (this.fit === "whole") + 2 * (AXES[this.up] ?? 0));
    if (face) known.face.aim(known.at, side, this.facts.joints ? side : height, width - side, orbit - HOME.orbit, tilt - HOME.tilt);
    this.#shown();
  }

  // Takes the colors from the style sheets. A page is dark if its text is light.
  #colors() {
    const [red, green, blue] = parts(getComputedStyle(this).color);
    const dark = red + 2 * green + blue > 512;
    this.stage.classList.toggle("dark", dark);
    const { backgroundColor, color, fill, stroke, stopColor } = getComputedStyle(this.stage);
    const [paper, middle, left, right, ground] = [backgroundColor, color, fill, stroke, stopColor].map(parts);
    this.#tones = [ground, middle, left, right, middle, ground, paper[3] ? paper : PAPERS[+dark]];
    this.#inks = {};
  }

  #see(seen) {
    this.#seen = seen;
    if (!seen) return;
    if (this.#lazy !== null) this.#load(this.#lazy);
    this.#run();
  }

  // Orbits and tilts the camera, in degrees.
  turn(orbit, tilt) {
    this.#orbit = ((this.#orbit + orbit + 540) % 360) - 180;
    this.#tilt = Math.max(-30, Math.min(85, this.#tilt + tilt));
    this.#aim();
    this.#dispatch("change");
  }

  // Shows exactly this frame. One that has not come is shown once it has, and until then the last one that has.
  seek(frame) {
    this.#want([frame]);
  }

  #want(wanted) {
    this.#wanted = wanted;
    if (!wanted || !this.frames) return;
    const [value, seconds] = wanted;
    const frame = Math.max(0, Math.min(seconds ? Math.floor((value * 1e9) / this.facts.frameTime + 1e-6) : value, this.frames - 1));
    if (frame < this.playable) this.#wanted = null;
    this.#go(Math.min(frame, this.playable - 1));
  }

  #go(frame) {
    if (frame < 0) return;
    this.#at = frame;
    this.#seat.wasm.go(this.#seat.at, frame);
    this.#shown();
    this.#dispatch("frame");
  }

  step(by) {
    this.pause();
    const before = this.frame;
    this.seek((this.frame + by + this.playable) % (this.playable || 1));
    this.#hear(before, this.frame, by < 0);
  }

  // Before there is a clip, it begins once there is one.
  play() {
    if (!this.#paused) return;
    this.#paused = false;
    const [first, end] = this.#range();
    const [start, last] = this.#backwards ? [end - 1, first] : [first, end - 1];
    const ended = end <= this.playable && !this.loop && this.frame === last;
    this.#at = ended ? start : this.frame;
    if (this.frame < first || this.frame >= end) this.seek(start);
    this.#run();
    this.#tell();
    this.#dispatch("play");
    this.#dispatch("change");
    // What happens at the first frame happens when it begins.
    if (this.frame === start) this.events.filter(({ frame }) => frame === this.frame).forEach((event) => this.#dispatch("heard", event));
  }

  // Plays what lies between two times in seconds, or without them the whole clip.
  range(from = 0, to = Infinity) {
    Object.assign(this, { from, to });
  }

  // The frames that are played, of those that there will be: the first, and the one after the last.
  #range() {
    const { frames, frameTime } = this.facts;
    const frame = (seconds) => Math.ceil((seconds * 1e9) / frameTime - 1e-6);
    const first = Math.max(0, Math.min(frame(this.from), frames - 1)) || 0;
    return [first, Math.max(first + 1, Math.min(frame(this.to), frames)) || 1];
  }

  pause() {
    cancelAnimationFrame(this.#request);
    this.#request = 0;
    if (this.#paused) return;
    this.#paused = true;
    this.#tell();
    this.#dispatch("pause");
    this.#dispatch("change");
  }

  #toggle() {
    if (this.#paused) this.play();
    else this.pause();
  }

  // Goes on playing, unless it goes on already.
  #run() {
    if (this.#paused || this.#request || !this.#seen) return;
    this.#before = performance.now();
    const turn = (now) => {
      this.#request = 0;
      if (this.#paused || !this.#seen) return;
      this.#tick(now);
      if (!this.#paused) this.#request = requestAnimationFrame(turn);
    };
    this.#request = requestAnimationFrame(turn);
  }

  #tick(now) {
    const { playable, frameTime } = this.facts;
    const elapsed = Math.max(0, now - this.#before);
    this.#before = now;
    // A character has no frames of its own.
    if (this.states.length) return this.advance((Math.min(elapsed, 1000) / 1000) * this.#speed);
    if (!playable || this.#held || this.#wanted) return;
    const range = this.#range();
    const [first, end] = range;
    let at = this.#at + ((elapsed * 1e6) / (frameTime || 1e9)) * this.#speed * (this.#backwards ? -1 : 1);
    // Time waits for frames that have not come.
    if (playable < end && at >= playable) at = playable - 0.001;
    let looped = false;
    if (this.#backwards ? at < first : at >= end) {
      if (this.loop) {
        at = first + ((((at - first) % (end - first)) + end - first) % (end - first));
        looped = true;
      } else {
        const last = this.#backwards ? first : end - 1;
        const before = this.frame;
        if (before !== last) this.#go(last), this.#hear(before, last, this.#backwards, range);
        this.pause();
        this.#dispatch("ended");
        return;
      }
    }
    const frame = Math.floor(at);
    if (frame !== this.frame) {
      const before = this.frame;
      this.#go(frame);
      this.#hear(before, frame, this.#backwards, range);
    }
    this.#at = at;
    if (looped) this.#dispatch("loop");
    if (now - this.#told > 250) {
      this.#told = now;
      this.#dispatch("timeupdate");
    }
  }

  #key(event) {
    const [on] = event.composedPath();
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    // What the button and the scrubber do with their own keys they do themselves.
    if ((on === this.button && event.key === " ") || (on === this.scrubber && event.key.startsWith("Arrow"))) return;
    const [turn, step] = [event.shiftKey, event.shiftKey ? 15 : 1];
    const act = {
      " ": () => this.#toggle(),
      ArrowLeft: () => (turn ? this.turn(-step, 0) : this.step(-1)),
      ArrowRight: () => (turn ? this.turn(step, 0) : this.step(1)),
      ArrowUp: () => this.turn(0, 5),
      ArrowDown: () => this.turn(0, -5),
      Home: () => this.seek(0),
      End: () => this.seek(this.playable - 1),
      r: () => (this.backwards = !this.#backwards),
      l: () => (this.look = this.look === "oled" ? "lines" : "oled"),
      "+": () => (this.#speed = Math.min(8, this.#speed * 2)),
      "-": () => (this.#speed = Math.max(1 / 8, this.#speed / 2)),
      0: () => this.turn(HOME.orbit - this.#orbit, HOME.tilt - this.#tilt),
    }[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act) return;
    event.preventDefault();
    act();
    this.#dispatch("change");
  }

  // The greys of the 128x64 display, 17 times 0 to 15; in that look alone.
  grey() {
    const count = this.#gather();
    const { wasm } = this.#seat;
    return bytes(wasm, wasm.grey(count), 128 * 64);
  }

  // Puts the frame's strokes into the module's memory, from far to near, and counts them.
  #gather() {
    const { wasm, at, face: known } = this.#seat;
    const count = wasm.strokes(at);
    if (this.#aside) {
      const places = new Int16Array(wasm.memory.buffer, wasm.picture(), (STROKE / 2) * count);
      // The second x of a head is its radius.
      for (let at = 0; at < places.length; at += 6) (places[at] += this.#aside), places[at + 4] >> 8 !== 4 && (places[at + 2] += this.#aside);
    }
    if (!known?.drawn || !this.playable) return count;
    const { channels, pose } = this.facts;
    const { face } = known;
    bytes(face, known.pose).set(bytes(wasm, pose, 4 * channels));
    const more = Math.min(face.place(known.at, known.pose, channels), STROKES - count);
    bytes(wasm, wasm.picture() + STROKE * count).set(bytes(face, face.picture(), STROKE * more));
    return count + more;
  }

  // What is shown, as a file. The script that writes it is loaded only now.
  async picture(options) {
    return (await import("./pantin-export.js")).picture(this, this.#tones[6], options);
  }

  // The range, or a character's next seconds, as a GIF or a video.
  async record(options) {
    return (await import("./pantin-export.js")).record(this, this.#tones[6], options);
  }

  #known() {
    const { wasm, at } = this.#seat;
    const words = new Uint32Array(wasm.memory.buffer, wasm.facts(at));
    return Object.fromEntries(WORDS.map((word, index) => [word, words[index]]));
  }

  #shown() {
    this.facts = this.#known();
    this.draw();
    this.#tell();
  }

  draw() {
    if (!this.#seat?.wasm) return;
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
    const end = this.#gather() * STROKE;
    const { wasm } = this.#seat;
    const view = new DataView(wasm.memory.buffer, wasm.picture(), end);
    const paper = this.#tones[6];
    const mix = (ink, part) => `rgb(${[0, 1, 2].map((index) => Math.round(paper[index] + (ink[index] - paper[index]) * part))})`;
    context.clearRect(0, 0, canvas.width, canvas.height);
    const thin = Math.max(1, canvas.height / 280);
    for (let place = 0; place < end; place += STROKE) {
      const [x, y, u, v] = [0, 2, 4, 6].map((offset) => view.getInt16(place + offset, true) / 16);
      const [shade, what, width] = [8, 9, 10].map((offset) => view.getUint8(place + offset));
      context.strokeStyle = this.#inks[[what, shade]] ??= mix(this.#tones[what], shade / 255);
      // A path of its own for each, without round ends and one pixel wide where nobody sees the difference: a face has 900 lines, and browsers take several
      // times as long for one path of them all.
      context.lineWidth = what === 0 || (width < 2 && shade < 128) ? 1 : Math.max(thin, width);
      context.lineCap = width > 1 ? "round" : "butt";
      context.beginPath();
      if (what === 4) {
        // A head hides what is behind it.
        context.arc(x, y, u, 0, 7);
        context.globalCompositeOperation = "destination-out";
        context.fill();
        context.globalCompositeOperation = "source-over";
      } else context.moveTo(x, y), context.lineTo(u, v);
      context.stroke();
    }
  }

  #tell() {
    const { frame, frames, playable } = this.facts;
    if (this.#paused !== this.#offered) {
      this.#offered = this.#paused;
      this.icon.setAttribute("d", this.#paused ? "M2 1v8l7-4z" : "M2 1h2v8H2zM6 1h2v8H6z");
      this.button.setAttribute("aria-label", this.#paused ? "Play" : "Pause");
    }
    // Nobody sees the bar of a bare player, which may be one of many.
    if (this.hasAttribute("bare")) return;
    this.scrubber.max = Math.max(0, playable - 1);
    this.scrubber.value = frame;
    this.output.textContent = frames ? `${frame + 1} / ${frames}` : "";
    const loads = this.#abort && !this.#abort.done && this.received;
    const coming = !loads ? "" : !playable ? `${this.received} bytes; the first pose is still to come` : playable < frames ? `${this.received} bytes, ${playable} of ${frames} frames` : "";
    const words = this.trouble || coming;
    if (this.status.textContent !== words) this.status.textContent = words;
  }

  #dispatch(name, detail = null) {
    this.dispatchEvent(new CustomEvent(name, { detail }));
  }
}

// Another copy of this script may have defined it.
if (globalThis.customElements && !customElements.get("pantin-player")) customElements.define("pantin-player", PantinPlayer);
