// <pantin-player src="walk.ptn" autoplay loop></pantin-player>: plays a clip while its bytes arrive, as a media element does. docs/WEB.md lists its attributes,
// properties, methods and events. The build puts decoder and figure into one file with it; other parts are modules, fetched at their first use.
import { checked, fieldsOf, openRawClip, openRawRig } from "@pantin/decoder/clip.js";
import { figureOf, maths, visitor } from "./figure.js";

// Bytes of a file that is not shown before all of it has arrived.
const PACKET = 1200;
// What a player without a clip knows.
const empty = () => ({ received: 0, total: 0, trouble: "", coming: "", error: null, events: [], clips: [], states: [], inputs: [], parameters: [], state: null });
// What is said, which a module has in other languages. What is wrong with a file the decoder says.
const ENGLISH = {
  figure: "animated figure", play: "Play", pause: "Pause", full: "Full screen", time: "Time", of: "of", seconds: "seconds", frames: "frames",
};
const HOME = { orbit: -50, tilt: 12 };
// What is behind the figure where the ground is transparent, on a light page and a dark one.
const PAPERS = [[250, 250, 247], [19, 22, 27]];
const AXES = ["x", "y", "z"];
const SIDES = { left: -1, right: 1 };
const isStill = () => matchMedia("(prefers-reduced-motion: reduce)").matches;

const CSS = `
:host { display: flex; flex-direction: column; font: 14px/1.4 system-ui, sans-serif; transition: color 1ms; }
:host([hidden]) { display: none; }
.frame { position: relative; flex: auto; min-height: 0; width: 100%; aspect-ratio: 2; }
.stage { --p: #fafaf7; --m: #262c34; --l: #c65c08; --r: #0068a8; --g: #69767e; }
.dark { --p: #13161b; --m: #fff0d7; --l: #ffa64d; --r: #60c4ff; --g: #aabec3; }
.stage { position: absolute; inset: 0; border-radius: 10px; overflow: hidden; touch-action: pan-y; cursor: grab; outline-offset: 3px; background: var(--pantin-paper, var(--p)); color: var(--pantin-body, var(--m)); fill: var(--pantin-left, var(--l)); stroke: var(--pantin-right, var(--r)); stop-color: var(--pantin-ground, var(--g)); }
canvas, .poster { position: absolute; inset: 0; width: 100%; height: 100%; }
.poster { display: block; object-fit: contain; }
.shown .poster { display: none; }
.bar { display: flex; gap: .6em; align-items: center; margin-top: .5em; }
button { font: inherit; width: 2.6em; height: 2.2em; border: 1px solid color-mix(in srgb, currentColor 30%, transparent); border-radius: 7px; background: none; color: inherit; cursor: pointer; }
i { display: block; width: 11px; height: 13px; margin: auto; background: currentColor; forced-color-adjust: none; clip-path: polygon(0 0, 100% 50%, 0 100%); }
.full i { background: none; border: 2px solid; }
.runs i, .full i { clip-path: polygon(0 0, 35% 0, 35% 100%, 65% 100%, 65% 0, 100% 0, 100% 100%, 0 100%); }
.big { display: none; position: absolute; inset: auto auto 10px 10px; width: 44px; height: 44px; border-radius: 50%; border-color: currentColor; color: #fff; background: #000b; }
.waits .big, :host([bare]) .runs:is(:hover, :focus-within) .big { display: block; }
.waits .big { inset: 50% auto auto 50%; width: 64px; height: 64px; margin: -32px; }
input { flex: 1; min-width: 4em; accent-color: var(--pantin-accent, #c65c08); }
output { font-variant-numeric: tabular-nums; min-width: 7em; text-align: right; }
p { margin: .3em 0 0; min-height: 1.4em; }
:host([bare]) .bar, :host([bare]) p { display: none; }
:host(:fullscreen) { background: Canvas; padding: 1em; }
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

function make(parent, name, attributes) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  parent.append(element);
  return element;
}

// A button whose sign is that for play, or for pause while it has the class `runs`.
function playButton(parent, className, act) {
  const button = make(parent, "button", { type: "button", class: className });
  make(button, "i", {});
  button.onclick = act;
  return button;
}

// Where there is no page, as in Node, the class can be imported but not used.
export class PantinPlayer extends (globalThis.HTMLElement ?? Object) {
  static observedAttributes = ["src", "look", "speed", "fit", "align", "up", "bare", "poster", "aria-label", "character-look"];
  #abort = null;
  // Where the last clip that removal kept from loading is to be loaded from.
  #cut = false;
  // A source that waits until the element is seen.
  #lazy = null;
  // The clip: what the decoder opened, what plays it, its figure, and how many frames can be shown.
  #clip = null;
  #player = null;
  #figure = null;
  #playable = 0;
  #isWhole = false;
  // Frames that the camera has looked at.
  #surveyed = 0;
  // What draws the clip's scalars, and what steers a character.
  #face = null;
  #actor = null;
  // The modules of the looks that were shown.
  #looks = {};
  #request = 0;
  #before = 0;
  #at = 0;
  // The time that was set, until another frame is shown; and a frame, or seconds, that were asked for and have not come.
  #time = null;
  #wanted = null;
  #seen = false;
  #held = false;
  #aside = 0;
  #tones = [];
  #inks = {};
  #paused = true;
  // Promises of play() that wait for a clip, and whether a user who wants less motion has not asked for any.
  #waiting = [];
  #waits = false;
  #ended = false;
  // Parts of the element, and what the buttons show.
  #frame;
  #slot;
  #big;
  #full;
  #status;
  #resizing;
  #watching;
  #offered = null;
  #backwards = false;
  #rate = 1;
  #told = 0;
  #orbit = HOME.orbit;
  #tilt = HOME.tilt;
  words = ENGLISH;

  constructor() {
    super();
    Object.assign(this, empty());
    const root = this.attachShadow({ mode: "open" });
    if (!sheet) (sheet = new CSSStyleSheet()).replaceSync(CSS);
    root.adoptedStyleSheets = [sheet];
    const frame = (this.#frame = make(root, "div", { class: "frame" }));
    this.stage = make(frame, "div", { class: "stage", part: "stage", tabindex: 0, role: "img" });
    this.#slot = make(this.stage, "slot", { name: "poster", class: "poster" });
    this.canvas = make(this.stage, "canvas", {});
    const bar = make(root, "div", { class: "bar", part: "bar" });
    const toggle = () => this.toggle();
    this.button = playButton(bar, "", toggle);
    this.#big = playButton(frame, "big", toggle);
    this.scrubber = make(bar, "input", { type: "range", min: 0, max: 0, step: 1, value: 0 });
    this.output = make(bar, "output", {});
    if (document.fullscreenEnabled) this.#full = playButton(bar, "full", () => (document.fullscreenElement ? document.exitFullscreen() : this.requestFullscreen()));
    this.#status = make(root, "p", { role: "status" });
    this.context = this.canvas.getContext("2d", { willReadFrequently: true });
    this.scrubber.oninput = () => this.seek(+this.scrubber.value);
    // While the scrubber is held, the frame is held.
    this.scrubber.onpointerdown = () => (this.#held = true);
    this.scrubber.onpointerup = this.scrubber.onpointercancel = () => (this.#held = false);
    // The page's text has another color.
    this.addEventListener("transitionend", ({ target }) => target === this && this.#aim());
    root.addEventListener("focusin", () => this.#control());
    this.stage.addEventListener("pointerenter", () => this.#control());
    this.#tell();
  }

  // Keys, dragging, and markers.
  #control() {
    import("./pantin-controls.js").then(({ attach }) => attach(this, HOME), () => {});
  }

  connectedCallback() {
    // Properties that were set before the element was defined.
    for (const name of Object.keys(this).filter((name) => name in PantinPlayer.prototype)) {
      const value = this[name];
      delete this[name];
      this[name] = value;
    }
    const language = (this.closest("[lang]")?.lang ?? "").slice(0, 2);
    if (language && language !== "en") import("./pantin-words.js").then(({ WORDS }) => WORDS[language] && ((this.words = WORDS[language]), (this.#offered = null), this.#tell()), () => {});
    this.#resizing = new ResizeObserver(() => this.#aim());
    this.#resizing.observe(this.stage);
    // Who cannot be seen does not play.
    this.#watching = new IntersectionObserver((entries) => this.#see(entries.at(-1).isIntersecting), { rootMargin: "100px" });
    this.#watching.observe(this.stage);
    const { src } = this;
    if (this.#cut && src !== null) this.#load(src);
    this.#cut = false;
  }

  disconnectedCallback() {
    this.#resizing.disconnect();
    this.#watching.disconnect();
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
      else if (this.loading === "lazy" && !this.#seen) this.#lazy = value;
      else this.#load(value);
    } else if (name === "speed") this.playbackRate = value;
    else if (name === "poster") {
      this.#slot.replaceChildren();
      if (value) make(this.#slot, "img", { class: "poster", alt: "", src: value });
    } else if (name === "aria-label") this.#tell((this.#offered = null));
    else {
      this.#aim();
      this.#dispatch("change");
    }
  }

  get currentSrc() { return this.src === null ? "" : new URL(this.src, document.baseURI).href; }
  get playbackRate() { return this.#rate; }
  set playbackRate(rate) {
    this.#rate = +rate || 1;
    this.#dispatch("ratechange");
  }
  // The name before playbackRate.
  get speed() { return this.#rate; }
  set speed(speed) { this.playbackRate = speed; }
  get backwards() { return this.#backwards; }
  set backwards(backwards) { this.#backwards = !!backwards; }
  get orbit() { return this.#orbit; }
  set orbit(orbit) { this.turn(orbit - this.#orbit, 0); }
  get tilt() { return this.#tilt; }
  set tilt(tilt) { this.turn(0, tilt - this.#tilt); }
  get facts() {
    if (this.#actor) return this.#actor.facts;
    const [clip, player] = [this.#clip, this.#player];
    const { joints = [], scalars = [], rig = {} } = clip ?? {};
    const isWhole = this.#isWhole;
    return {
      frames: this.frames, playable: this.#playable, frame: this.frame, frameTime: this.#frameTime, looped: +(clip?.looped ?? 0), channels: rig.channels ?? 0,
      moving: (isWhole && player.moving) || 0, rigBytes: (isWhole && clip.rigBytes) || 0, motionBytes: (isWhole && clip.motionBytes) || 0, joints: joints.length, scalars: scalars.length,
    };
  }
  get frames() { return this.#actor ? 1 : (this.#clip?.frames ?? 0); }
  get playable() { return this.#playable; }
  get frame() { return this.#player?.frame ?? 0; }
  get paused() { return this.#paused; }
  get ended() { return this.#ended; }
  get seeking() { return !!this.#wanted && !!this.#abort && !this.#abort.done; }
  // As of a media element: 0 nothing, 1 the clip's numbers, 2 the present frame, 3 frames after it, 4 the whole clip.
  get readyState() { return !this.frames ? 0 : !this.playable ? 1 : this.playable === this.frames && this.#isWhole ? 4 : this.playable > this.frame + 1 ? 3 : 2; }
  get #frameTime() { return this.#clip?.frameTimeNs ?? 0; }
  // Seconds. In a loop, the last frame lasts as long as the others.
  get duration() { return this.#clip ? ((this.frames - !this.#clip.looped) * this.#frameTime) / 1e9 : NaN; }
  get currentTime() { return this.#time ?? ((this.#paused ? this.frame : this.#at) * this.#frameTime) / 1e9; }
  set currentTime(seconds) {
    this.#want([+seconds, true]);
    this.#time = Math.max(0, this.#clip ? Math.min(seconds, this.duration) : seconds);
  }

  // Loads a clip in place of the one before, or one of a bank's; resolves when all of it is there, and rejects with what is wrong with it.
  async load(what = this.src, clip = null) {
    if (this.#abort) this.#wanted = this.#time = null;
    this.#forget();
    const abort = (this.#abort = new AbortController());
    const { signal } = abort;
    this.#dispatch("loadstart");
    try {
      if (typeof what === "string" || what instanceof URL) {
        const url = new URL(what, document.baseURI);
        clip ??= decodeURIComponent(url.hash.slice(1)) || null;
        what = await fetch(url, { signal, credentials: this.crossOrigin === "use-credentials" ? "include" : "same-origin" });
      }
      if (this.from) this.#wanted ??= [this.from, true];
      await this.#display();
      if (what.poses) {
        const { tableOf } = await import("./pantin-table.js");
        signal.throwIfAborted();
        await this.#meet(tableOf(what, openRawRig), signal, true);
      } else await this.#receive(what, signal, clip);
      signal.throwIfAborted();
      this.#isWhole = abort.done = true;
      this.#want(this.#wanted);
      this.#tell();
      if (this.events.length) this.#control();
      ["canplaythrough", "ready"].forEach((name) => this.#dispatch(name));
    } catch (error) {
      // Another clip was loaded instead, or the element was removed.
      if (signal.aborted) throw signal.reason;
      this.#wanted = null;
      abort.done = true;
      this.error = error;
      this.trouble = error.message;
      if (!this.playable) this.#settle(error);
      this.#tell();
      this.#dispatch("error", error.message);
      throw error;
    }
  }

  #load(src) {
    this.load(src).catch(() => {});
  }

  // Without a clip.
  #forget() {
    this.#abort?.abort();
    const had = this.frames;
    const wanted = !this.#paused && !had;
    // Who asked to play before there was a clip gets the next one.
    if (!wanted) this.pause();
    this.#clip = this.#player = this.#figure = this.#face = this.#actor = this.#abort = this.#lazy = null;
    this.#playable = this.#at = this.#surveyed = 0;
    this.#isWhole = this.#ended = false;
    Object.assign(this, empty());
    if (had) this.#dispatch("emptied");
  }

  #unload() {
    this.#forget();
    this.pause();
    this.#wanted = this.#time = null;
    this.context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    this.#tell();
    this.#dispatch("change");
  }

  // Keeps what play() has promised.
  #settle(error) {
    for (const [done, failed] of this.#waiting.splice(0)) error ? failed(error) : done();
  }

  async #receive(what, signal, name) {
    const { url } = what;
    if (what instanceof Response) {
      if (!what.ok) throw new Error(`the clip cannot be fetched: ${what.status} ${what.statusText}`);
      // With an encoding, it is the length of something else.
      if (!what.headers.get("Content-Encoding")) this.total = +what.headers.get("Content-Length") || 0;
      what = what.body;
    }
    let file;
    // What is in the page (data:, blob:), or comes in one packet, has nothing to show before.
    if (!(what instanceof ReadableStream) || /^[bd]/.test(url) || (url && this.total && this.total < PACKET)) file = new Uint8Array(await new Response(what).arrayBuffer());
    else {
      const { arrived } = await import("./pantin-stream.js");
      file = await arrived(this, what, signal, (file) => this.#open(file, undefined, signal, true), (problem) => this.#problem(problem), () => this.#tell());
    }
    signal.throwIfAborted();
    this.received = file.length;
    let rig;
    if (file[0] === 80 && file[1] === 98) {
      const { bankOf } = await import("./pantin-bank.js");
      signal.throwIfAborted();
      const bank = bankOf(file, [fieldsOf, checked, openRawRig, openRawClip, figureOf, maths]);
      this.clips = bank.names;
      if (bank.machine && name === null) return this.#steer(await bank.steer(this), signal);
      [file, rig] = bank.clip(name);
    }
    this.total ||= this.received;
    const problem = await this.#open(file, rig, signal);
    if (!problem) return this.#dispatch("progress");
    // What is good of it can be played.
    if (problem === "ends early" || problem === "wrong checksum") await this.#open(file, rig, signal, true);
    this.#dispatch("progress");
    throw this.#problem(problem);
  }

  #problem(problem) {
    const { frames, playable, words } = this;
    return new Error((words[problem] ?? `problem with the file: ${problem}`) + (playable && playable < frames ? `; ${playable} ${words.of} ${frames} ${words.frames}` : ""));
  }

  // Opens what has come of a file; returns what the decoder finds wrong with it. A file of version 2 has keys.
  async #open(file, rig, signal, isPartial) {
    const extras = file[2] === 2 ? await import("./pantin-keys.js") : {};
    signal.throwIfAborted();
    let player;
    try {
      player = openRawClip(file, rig, isPartial, extras).play();
    } catch (error) {
      return error.message.slice(8);
    }
    await this.#meet(player, signal, !isPartial);
  }

  // Plays what was opened, from the frame that is shown. Until the module for its scalars has loaded, no event reports the clip.
  async #meet(player, signal, isWhole) {
    const { clip } = player;
    // It runs ahead to find out how far it goes.
    while (!isWhole && !player.dry && player.step());
    const playable = isWhole ? clip.frames : player.dry ? player.frame : clip.frames;
    if (playable < this.#playable) return;
    const [frame, isFirst, had] = [this.frame, !this.#clip, this.#playable];
    if (clip.scalars.length && !this.#face) {
      const { faceOf } = await import("./pantin-face.js");
      const face = await faceOf(clip, maths);
      signal.throwIfAborted();
      this.#face = face;
    }
    this.#clip = clip;
    this.#player = player.seek(Math.min(frame, Math.max(0, playable - 1)));
    this.#playable = playable;
    this.#isWhole = isWhole;
    this.events = clip.events;
    if (isFirst) ["durationchange", "loadedmetadata"].forEach((name) => this.#dispatch(name));
    if (playable && (playable > 2 * this.#surveyed || isWhole)) this.#aim();
    else this.#shown();
    if (!playable) return;
    if (!had) this.#begin();
    if (playable > 1 || isWhole) this.#autoplay();
    this.#want(this.#wanted);
  }

  #steer(actor, signal) {
    signal.throwIfAborted();
    this.#actor = actor;
    this.#playable = 1;
    this.total = this.received;
    actor.pass(0);
    this.#aim();
    this.#begin();
    this.#autoplay();
  }

  // There is something to be seen.
  #begin() {
    this.#frame.classList.add("shown");
    ["loadeddata", "canplay"].forEach((name) => this.#dispatch(name));
    if (!this.#paused) {
      this.#settle();
      this.#dispatch("playing");
    }
  }

  // Who wants less motion is asked.
  #autoplay() {
    if (!this.autoplay || !this.#paused || this.#abort?.began) return;
    this.#abort.began = true;
    if (isStill()) this.#tell((this.#waits = true));
    else this.play();
  }

  #steering() {
    if (!this.#actor) throw new RangeError("there is no state machine");
    return this.#actor;
  }

  // Lets a character's time pass, in seconds, as playing does.
  advance(seconds) {
    this.#actor?.pass(Math.round(seconds * 1e6));
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

  // Reports the events from one frame on, which was shown, to another, which is.
  #hear(from, to, backwards, [first, end] = [0, this.playable || 1]) {
    const count = end - first;
    const way = (frame) => (((backwards ? from - frame : frame - from) + 2 * count - 1) % count) + 1;
    const passed = this.events.filter(({ frame }) => frame >= first && frame < end && way(frame) <= way(to));
    (backwards ? passed.reverse() : passed).sort((a, b) => way(a.frame) - way(b.frame)).forEach((event) => this.#dispatch("heard", event));
  }

  #aim() {
    const [clip, face, actor] = [this.#clip, this.#face, this.#actor];
    if (!this.isConnected || !this.playable) return;
    const { clientWidth, clientHeight } = this.stage;
    const scale = Math.min(devicePixelRatio || 1, 2047 / clientWidth);
    const isOled = this.look === "oled";
    const [width, height] = isOled ? [128, 64] : [clientWidth, clientHeight].map((length) => Math.max(1, Math.floor(length * scale)));
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    if (this.look !== "lines" && !this.#looks[this.look]) this.#display().then(() => this.#aim(), () => {});
    this.#colors();
    const [orbit, tilt] = [Math.round(this.#orbit), Math.round(this.#tilt)];
    const hasBody = actor || clip.joints.length;
    // A face stands beside the body as the firmware divides its displays, or has all of the picture.
    const isWide = 2 * width >= 3 * height;
    const side = !hasBody ? width : isWide ? height : Math.floor(width / 5) * 2;
    const isFace = face?.isFace;
    // A figure at one side is the middle of a wider picture, of which the rest is not seen.
    const small = Math.min(width, height);
    const way = isFace || this.fit === "whole" ? 0 : (SIDES[this.align] ?? 0);
    const broad = way ? Math.min(2047, 2 * width - small) : width;
    this.#aside = way * 8 * (way < 0 ? broad - small : 2 * width - small - broad);
    const axis = AXES.indexOf(this.up);
    const view = [isFace && isWide ? width - side : broad, height, orbit, tilt, this.fit !== "whole", axis < 0 ? undefined : axis];
    const look = this.#looks[this.look]?.aim;
    if (actor) (this.#figure = actor).aim(view, look);
    else if (hasBody) {
      const player = this.#player;
      const { frame } = player;
      const figure = (this.#figure ??= figureOf(clip, player.seek(0).raw));
      const visit = visitor(clip, this.#playable, (frame) => player.seek(frame).raw);
      if (look) look(clip, figure, view, visit, this.#playable, this);
      else figure.aim(...view, visit);
      player.seek(frame);
    }
    face?.aim(side, hasBody ? side : height, width - side, orbit - HOME.orbit, tilt - HOME.tilt);
    this.#surveyed = this.#playable;
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
    const frame = Math.max(0, Math.min(seconds ? Math.floor((value * 1e9) / this.#frameTime + 1e-6) : value, this.frames - 1));
    if (frame < this.playable) this.#wanted = null;
    const time = this.#time;
    this.#go(Math.min(frame, this.playable - 1));
    // What was set before there was a clip.
    if (seconds && time !== null) this.#time = Math.min(time, this.duration);
    if (!this.#wanted) this.#dispatch("seeked");
  }

  #go(frame) {
    if (frame < 0) return;
    this.#at = frame;
    this.#time = null;
    this.#ended = false;
    this.#player?.seek(frame);
    this.#shown();
    this.#dispatch("frame");
  }

  step(by) {
    this.pause();
    const before = this.frame;
    this.seek((this.frame + by + this.playable) % (this.playable || 1));
    this.#hear(before, this.frame, by < 0);
  }

  // Before there is a clip, it begins once there is one. The promise resolves when it plays.
  play() {
    const played = this.playable ? Promise.resolve() : this.error ? Promise.reject(this.error) : new Promise((done, failed) => this.#waiting.push([done, failed]));
    // Who does not wait for it is told by `error`.
    played.catch(() => {});
    if (!this.#paused) return played;
    this.#paused = this.#waits = false;
    const [first, end] = this.#range();
    const [start, last] = this.#backwards ? [end - 1, first] : [first, end - 1];
    const ended = end <= this.playable && !this.loop && this.frame === last;
    this.#at = ended ? start : this.frame;
    if (this.frame < first || this.frame >= end) this.seek(start);
    this.#ended = false;
    this.#run();
    this.#tell();
    ["play", "change", ...(this.playable ? ["playing"] : [])].forEach((name) => this.#dispatch(name));
    // What happens at the first frame happens when it begins.
    if (this.frame === start) this.events.filter(({ frame }) => frame === this.frame).forEach((event) => this.#dispatch("heard", event));
    return played;
  }

  // Plays what lies between two times in seconds, or without them the whole clip.
  range(from = 0, to = Infinity) {
    Object.assign(this, { from, to });
  }

  // The frames that are played, of those that there will be: the first, and the one after the last. A segment ends at the next marker.
  #range() {
    const { frames, events, segment } = this;
    const begins = events.find(({ name }) => name && name === segment)?.frame;
    if (begins >= 0) return [begins, Math.max(begins + 1, events.find(({ frame }) => frame > begins)?.frame ?? frames)];
    const frame = (seconds) => Math.ceil((seconds * 1e9) / this.#frameTime - 1e-6);
    const first = Math.max(0, Math.min(frame(this.from), frames - 1)) || 0;
    return [first, Math.max(first + 1, Math.min(frame(this.to), frames)) || 1];
  }

  pause() {
    cancelAnimationFrame(this.#request);
    this.#request = 0;
    if (this.#paused) return;
    this.#paused = true;
    this.#settle(new DOMException("paused", "AbortError"));
    this.#tell();
    this.#dispatch("pause");
    this.#dispatch("change");
  }

  // What the buttons do.
  toggle() {
    if (this.#paused) this.play();
    else {
      this.#waits = this.hasAttribute("bare");
      this.pause();
    }
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
    const playable = this.#playable;
    const elapsed = Math.max(0, now - this.#before);
    this.#before = now;
    // A character has no frames of its own.
    if (this.#actor) return this.advance((Math.min(elapsed, 1000) / 1000) * this.#rate);
    if (!playable || this.#held || this.#wanted) return;
    const range = this.#range();
    const [first, end] = range;
    let at = this.#at + ((elapsed * 1e6) / (this.#frameTime || 1e9)) * this.#rate * (this.#backwards ? -1 : 1);
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
        this.#ended = true;
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
    this.#time = null;
    if (looped) this.#dispatch("loop");
    if (now - this.#told > 250) {
      this.#told = now;
      this.#dispatch("timeupdate");
    }
  }

  // Passes the frame's strokes, from far to near: all, or those of a face beside a body.
  #each(stroke, hasBody = true) {
    const aside = this.#aside;
    const body = aside ? (x, y, u, v, shade, part, width) => stroke(x + aside, y, part === 4 ? u : u + aside, v, shade, part, width) : stroke;
    if (!this.playable) return;
    if (hasBody) this.#figure?.each(body);
    this.#face?.each(this.#player.raw, stroke);
  }

  // The greys of the 128x64 display, 17 times 0 to 15; in that look alone, once its module has loaded.
  grey() {
    return this.#looks.oled.greysOf((stroke) => this.#each(stroke));
  }

  // The module of another look than lines.
  async #display() {
    if (this.look === "oled") this.#looks.oled ??= await import("./pantin-oled.js");
    if (this.look === "solid") await (this.#looks.solid ??= await import("./pantin-solid.js")).dressed(this);
  }

  // Calls the script that writes files, which is loaded only now.
  async #save(what, options) {
    const saves = await import("./pantin-export.js");
    await this.#display();
    this.draw();
    return saves[what](this, this.#tones[6], options);
  }

  // What is shown, as a file.
  picture(options) {
    return this.#save("picture", options);
  }

  // The range, or a character's next seconds, as a GIF or a video.
  record(options) {
    return this.#save("record", options);
  }

  #shown() {
    if (this.#player) this.#figure?.place(this.#player.raw);
    this.draw();
    this.#tell();
  }

  draw() {
    if (this.look !== "oled") this.#drawLines();
    else this.#looks.oled?.draw(this.context, (stroke) => this.#each(stroke));
  }

  #drawLines() {
    const { context, canvas } = this;
    const paper = this.#tones[6];
    const mix = (ink, part) => `rgb(${[0, 1, 2].map((index) => Math.round(paper[index] + (ink[index] - paper[index]) * part))})`;
    context.clearRect(0, 0, canvas.width, canvas.height);
    const thin = Math.max(1, canvas.height / 280);
    const solid = this.look === "solid" && this.#figure?.solid;
    if (solid) solid.draw(context, this.#tones, canvas.height, this.#aside / 16);
    this.#each((x, y, u, v, shade, part, width) => {
      context.strokeStyle = this.#inks[part * 256 + shade] ??= mix(this.#tones[part], shade / 255);
      // A path of its own for each, without round ends and one pixel wide where nobody sees the difference: a face has 900 lines, and browsers take several
      // times as long for one path of them all.
      context.lineWidth = part === 0 || (width < 2 && shade < 128) ? 1 : Math.max(thin, width);
      context.lineCap = width > 1 ? "round" : "butt";
      context.beginPath();
      if (part === 4) {
        // A head hides what is behind it.
        context.arc(x / 16, y / 16, u / 16, 0, 7);
        context.globalCompositeOperation = "destination-out";
        context.fill();
        context.globalCompositeOperation = "source-over";
      } else context.moveTo(x / 16, y / 16), context.lineTo(u / 16, v / 16);
      context.stroke();
    }, !solid);
  }

  #tell() {
    const [{ frame, frames, playable, words }, paused] = [this, this.#paused];
    const offered = paused + 2 * this.#waits;
    if (offered !== this.#offered) {
      this.#offered = offered;
      for (const button of [this.button, this.#big]) {
        button.classList.toggle("runs", !paused);
        button.setAttribute("aria-label", paused ? words.play : words.pause);
      }
      this.stage.setAttribute("aria-label", this.getAttribute("aria-label") ?? words.figure);
      this.scrubber.setAttribute("aria-label", words.time);
      this.#full?.setAttribute("aria-label", words.full);
      this.#frame.classList.toggle("waits", this.#waits && paused);
      this.#frame.classList.toggle("runs", !paused);
    }
    // Nobody sees the bar of a bare player, which may be one of many.
    if (this.hasAttribute("bare")) return;
    this.scrubber.max = Math.max(0, playable - 1);
    this.scrubber.value = frame;
    const [now, all] = [(frame * this.#frameTime) / 1e9, this.duration || 0].map((seconds) => seconds.toFixed(2));
    this.output.textContent = frames ? `${now} / ${all}` : "";
    this.scrubber.setAttribute("aria-valuetext", `${now} ${words.of} ${all} ${words.seconds}`);
    const said = this.trouble || this.coming;
    if (this.#status.textContent !== said) this.#status.textContent = said;
  }

  #dispatch(name, detail = null) {
    this.dispatchEvent(new CustomEvent(name, { detail }));
  }
}

// Properties that are attributes of the same name, and what they make of the attribute's text.
const isThere = (text) => text !== null;
const anyText = (text) => text ?? "";
const oneOf = (...words) => (text) => words.find((word) => word === text) ?? words[0];
for (const [name, read] of Object.entries({
  src: (text) => text, look: oneOf("lines", "solid", "oled"), fit: oneOf("follow", "whole"), align: oneOf("center", "left", "right"), loading: oneOf("eager", "lazy"),
  from: (text) => +text || 0, to: (text) => +text || Infinity, poster: anyText, crossOrigin: (text) => text, segment: anyText, up: anyText, loop: isThere, autoplay: isThere,
})) {
  Object.defineProperty(PantinPlayer.prototype, name, {
    configurable: true,
    enumerable: true,
    get() { return read(this.getAttribute(name)); },
    set(value) { read === isThere ? this.toggleAttribute(name, value) : this.setAttribute(name, value); },
  });
}

// Another copy of this script may have defined it.
if (globalThis.customElements && !customElements.get("pantin-player")) customElements.define("pantin-player", PantinPlayer);
