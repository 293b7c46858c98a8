// The page about the player: its buttons, the gallery, and motions that are dropped.
import "./pantin-player.js";

// Bytes of a motion that the page reads: what the encoder makes of them has to fit into its memory many times over.
const MOST = 100 << 20;

const $ = (id) => document.getElementById(id);
const [player, original, converted] = ["player", "original", "converted"].map($);
const bytes = (count) => `${count.toLocaleString("en")} ${count === 1 ? "byte" : "bytes"}`;

function table(list, rows) {
  list.replaceChildren(...rows.filter(Boolean).map(([name, value]) => {
    const [row, term, text] = ["div", "dt", "dd"].map((tag) => document.createElement(tag));
    term.textContent = name;
    text.textContent = value;
    row.append(term, text);
    return row;
  }));
}

// ---- the player

function told() {
  const { frames, playable, frameTime, channels, moving, rigBytes, motionBytes } = player.facts;
  const seconds = (frames * frameTime) / 1e9;
  const last = heard ? `; last: ${heard.name || heard.id} at frame ${heard.frame}` : "";
  table($("facts"), [
    ["received", player.total > player.received ? `${player.received.toLocaleString("en")} of ${bytes(player.total)}` : bytes(player.received)],
    ["frames playable", `${playable.toLocaleString("en")} of ${frames.toLocaleString("en")}`],
    frames && ["length", `${seconds.toFixed(2)} s at ${(1e9 / frameTime).toFixed(1).replace(".0", "")} frames per second`],
    moving && ["channels moving", `${moving} of ${channels}`],
    moving && ["motion, rig", `${motionBytes} + ${rigBytes} bytes`],
    moving && ["motion per second", `${(motionBytes / seconds).toFixed(0)} bytes`],
    player.events.length > 0 && ["events", player.events.length + last],
  ]);
  const names = player.clips;
  $("bank").hidden = names.length < 2;
  if ([...$("of-bank").options].map((option) => option.value).join("\n") !== names.join("\n"))
    $("of-bank").replaceChildren(...names.map((name) => new Option(name, name)));
}

// The event that was passed last.
let heard = null;

function changed() {
  $("backwards").setAttribute("aria-pressed", player.backwards);
  $("loop").setAttribute("aria-pressed", player.loop);
  const [, character] = /(\w+)\.look$/.exec(player.getAttribute("character-look")) ?? [];
  $("figure").value = player.look === "solid" && character ? `solid ${character}` : player.look;
  $("speed").value = player.speed;
}

["progress", "ready", "error"].forEach((name) => player.addEventListener(name, told));
player.addEventListener("change", changed);
player.addEventListener("heard", ({ detail }) => ((heard = detail), told()));
$("of-bank").onchange = () => show(current, $("of-bank").value);
const button = (id, act) => ($(id).onclick = () => (act(), changed()));
button("backwards", () => (player.backwards = !player.backwards));
button("loop", () => (player.loop = !player.loop));
button("home", () => player.turn(-50 - player.orbit, 12 - player.tilt));
$("figure").onchange = () => {
  const [look, character] = $("figure").value.split(" ");
  if (character) player.setAttribute("character-look", `clips/${character}.look`);
  else player.removeAttribute("character-look");
  player.look = look;
};
$("speed").onchange = () => (player.speed = +$("speed").value);
$("link").onchange = () => show(current);

// ---- the character

const character = $("character");
const pressed = (button) => button.getAttribute("aria-pressed") === "true";
const namesOf = ({ dataset }) => (dataset.hold ?? dataset.fire).split(" ");
// The buttons of inputs that the state machine has, and those that its text adds.
const inputs = () => [...document.querySelectorAll("#inputs button:not([hidden])")];
const [go, fast] = inputs();

// The inputs that do something in each state, once they are known.
let possible = {};

// What a button would do nothing with is greyed, and the line below says why.
function offered() {
  const known = possible[character.state];
  const can = (input) => !known || pressed(input) || namesOf(input).some((name) => known.includes(name)) || (input === fast && known.includes(go.dataset.hold));
  inputs().forEach((input) => input.setAttribute("aria-disabled", !can(input)));
  const missing = inputs().filter((input) => !can(input)).map((input) => input.textContent.toLowerCase());
  const said = missing.length ? `Not from “${character.state.replaceAll("_", " ")}”: ${missing.length > 4 ? "what is greyed" : missing.join(", ")}.` : "";
  // What is held is let go by another press; most figures stand then, as at first.
  const held = inputs().filter(pressed).map((input) => `“${input.textContent}”`);
  const first = possible[character.states[0]];
  const waits = inputs().some((input) => !can(input) && namesOf(input).some((name) => first?.includes(name)));
  const whole = waits && held.length ? `${said} Press ${held.join(" and ")} again: it stops, and can do the rest.` : said;
  if ($("why").textContent !== whole) $("why").textContent = whole;
}

function lit() {
  offered();
  for (const state of document.querySelectorAll("#graph [data-state]")) state.classList.toggle("lit", state.dataset.state === character.state);
}

// What a button holds it holds until it is pressed again.
function hold(input, down) {
  const [name] = namesOf(input);
  if (!character.inputs.includes(name)) return;
  character.hold(name, down);
  input.setAttribute("aria-pressed", down);
  // To run is to walk fast.
  if (input === fast && down && !pressed(go)) hold(go, true);
  if (input === go && !down && pressed(fast)) hold(fast, false);
  offered();
}

function press(input) {
  if (!character.inputs.length || input.getAttribute("aria-disabled") === "true") return;
  if (input.dataset.hold) hold(input, !pressed(input));
  // Each state knows one of them.
  else namesOf(input).filter((name) => character.inputs.includes(name)).forEach((name) => character.fire(name));
}
$("inputs").onclick = ({ target }) => {
  const input = target.closest("button");
  if (input) press(input);
};

// Keys steer while the figure has the focus, so that they scroll the page elsewhere.
function key(event) {
  const input = inputs().find((input) => input.dataset.key === (event.key.length === 1 ? event.key.toLowerCase() : event.key));
  if (!input || event.ctrlKey || event.metaKey || event.altKey || !character.inputs.length) return;
  event.preventDefault();
  event.stopPropagation();
  if (input.dataset.hold) hold(input, event.type === "keydown");
  else if (event.type === "keydown" && !event.repeat) press(input);
}
["keydown", "keyup"].forEach((type) => character.addEventListener(type, key, true));
character.addEventListener("blur", () => inputs().filter((input) => input.dataset.hold).forEach((input) => hold(input, false)));
character.addEventListener("state", lit);
character.addEventListener("ready", () => {
  $("character-size").textContent = `${character.states.length} states, ${character.clips.length} motions and the figure are ${bytes(character.total)}.`;
});
// It walks at first.
character.addEventListener("ready", () => hold(go, true), { once: true });

// The picture of the state machine.
function draw(svg) {
  const { documentElement } = new DOMParser().parseFromString(svg, "image/svg+xml");
  ["width", "height"].forEach((name) => documentElement.removeAttribute(name));
  $("graph").replaceChildren(document.importNode(documentElement, true));
  lit();
}

async function graph() {
  const response = await fetch("clips/character.svg");
  if (response.ok) draw(await response.text());
}
graph().catch(() => {});
fetch("clips/character.json").then((response) => response.json()).then((known) => ((possible = known), offered()), () => {});

// The character goes on with another machine: `known` are the inputs that do something in each state, and what was held is held.
function steered(known, svg) {
  possible = known;
  inputs().filter(pressed).forEach((input) => hold(input, true));
  draw(svg);
}

// The text of the state machine, once it is opened. What failed is tried again when it is opened again.
async function edit() {
  if (!$("edit").open) return;
  $("edit").ontoggle = null;
  try {
    const machine = await import("./machine.js");
    await machine.edit({ character, steered, bytes, offer });
  } catch (error) {
    $("machine-said").textContent = `The state machine cannot be edited: ${error.message}.`;
    $("edit").ontoggle = edit;
  }
}
$("edit").ontoggle = edit;

// ---- the face, once it comes near the screen

const faces = new IntersectionObserver((entries) => {
  if (!entries.some(({ isIntersecting }) => isIntersecting)) return;
  faces.disconnect();
  import("./faces.js").then(({ list }) => list(downloads)).catch((error) => ($("face-why").textContent = `The emotes cannot be fetched: ${error.message}.`));
}, { rootMargin: "400px" });
faces.observe($("face").closest("section"));

// ---- links

// The most bytes of a clip that fits into a link.
const MOST_SHARED = 6000;
const base64 = (bytes) => btoa(String.fromCharCode(...bytes)).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
const unbase64 = (text) => Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (letter) => letter.charCodeAt(0));

async function copy(button, text) {
  const words = button.textContent;
  try {
    await navigator.clipboard.writeText(text);
    button.textContent = "Copied";
  } catch {
    button.textContent = "Cannot copy here";
  }
  setTimeout(() => (button.textContent = words), 1500);
}

// Copies a link to a clip: by its name in the gallery, or with the clip itself.
function share(button, clip) {
  const url = new URL(location.pathname, location);
  if (clip?.data) {
    const data = new Uint8Array(clip.data);
    if (data.length > MOST_SHARED) return trouble(`The clip is too large for a link: ${bytes(data.length)}, at most ${bytes(MOST_SHARED)}.`);
    url.hash = `ptn=${base64(data)}`;
  } else if (clip) url.searchParams.set("clip", clip.name);
  copy(button, url.href);
}
$("share").onclick = () => share($("share"), current);
$("copy").onclick = () => copy($("copy"), $("embed").textContent);
$("copy-npm").onclick = () => copy($("copy-npm"), $("npm").textContent);

// ---- pictures of what plays

const VIDEO = "video/webm";
$("save-video").hidden = !globalThis.VideoEncoder && !globalThis.MediaRecorder?.isTypeSupported(VIDEO);

async function saved(button, ending, make) {
  const words = button.textContent;
  button.disabled = true;
  try {
    const content = await make((part) => (button.textContent = `${Math.floor(100 * part)} %`));
    offer(`${current?.name.replace(/\.pt[nb]$/i, "") ?? "figure"}.${ending}`, content, content.type);
    trouble("");
  } catch (error) {
    trouble(`Nothing was saved: ${error.message}.`);
  }
  [button.textContent, button.disabled] = [words, false];
}
$("save-picture").onclick = () => saved($("save-picture"), "png", () => player.picture());
$("save-gif").onclick = () => saved($("save-gif"), "gif", (progress) => player.record({ progress }));
$("save-video").onclick = () => saved($("save-video"), "webm", (progress) => player.record({ type: VIDEO, progress }));

// ---- the gallery

let current = null;

// The response, its bytes no faster than ten bits a byte over a serial line.
function slowed(response, baud) {
  const every = 50;
  const piece = Math.max(1, Math.round((baud / 10 / 1000) * every));
  const slow = new TransformStream({
    async transform(chunk, out) {
      for (let at = 0; at < chunk.length; at += piece) {
        await new Promise((go) => setTimeout(go, every));
        out.enqueue(chunk.subarray(at, at + piece));
      }
    },
  });
  return new Response(response.body.pipeThrough(slow), { headers: response.headers, status: response.status });
}

async function show(clip, name = null) {
  if (!clip) return;
  [current, heard] = [clip, null];
  document.querySelectorAll("#clips [aria-current]").forEach((other) => other.removeAttribute("aria-current"));
  clip.button?.setAttribute("aria-current", "true");
  if (clip.button?.matches(":focus, :hover")) history.replaceState(null, "", `?clip=${encodeURIComponent(clip.name)}`);
  const baud = +$("link").value;
  try {
    const what = clip.data ?? clip.file;
    await player.load(baud ? slowed(clip.data ? new Response(clip.data) : await fetch(clip.file), baud) : what, name);
  } catch {
    // The player says what is wrong.
  }
}

// One player draws all small pictures, each once it comes near the screen; another one plays where the pointer is.
const [sketch, moving] = ["sketch", "moving"].map((name) => {
  const small = document.createElement("pantin-player");
  Object.assign(small, { className: name, inert: true, loop: true });
  small.setAttribute("bare", "");
  return small;
});
$("sketch").append(sketch);
const waiting = [];
let drawing = false;

async function drawAll() {
  if (drawing) return;
  drawing = true;
  for (let picture; (picture = waiting.shift()); ) {
    try {
      await sketch.load(picture.clip.file);
    } catch {
      continue;
    }
    sketch.seek(sketch.frames >> 1);
    const { width, height } = sketch.canvas;
    Object.assign(picture, { width, height });
    picture.getContext("2d").drawImage(sketch.canvas, 0, 0);
  }
  drawing = false;
}

const near = new IntersectionObserver((entries) => {
  for (const { isIntersecting, target } of entries) {
    if (!isIntersecting) continue;
    near.unobserve(target);
    waiting.push(target);
  }
  drawAll();
}, { rootMargin: "200px" });
// In other colors, all are drawn again.
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => document.querySelectorAll("#clips canvas").forEach((picture) => near.observe(picture)));

// Links to a clip's file, and to what the build has made of it for other programs.
function downloads({ name, file, others = [] }) {
  const links = document.createElement("p");
  for (const ending of ["ptn", ...others]) {
    const link = document.createElement("a");
    Object.assign(link, { href: file.replace(/ptn$/, ending), download: "", textContent: `.${ending}` });
    link.setAttribute("aria-label", `Download ${name}.${ending}`);
    links.append(link, " ");
  }
  return links;
}

async function gallery() {
  const list = await (await fetch("clips.json")).json();
  for (const clip of list) {
    const item = document.createElement("li");
    clip.button = document.createElement("button");
    clip.button.type = "button";
    clip.button.onclick = () => show(clip);
    const [picture, name, size] = ["canvas", "strong", "small"].map((tag) => document.createElement(tag));
    picture.clip = clip;
    clip.button.onpointerenter = () => {
      picture.after(moving);
      moving.load(clip.file).then(() => moving.play(), () => {});
    };
    clip.button.onpointerleave = () => moving.remove();
    name.textContent = clip.name;
    size.textContent = bytes(clip.bytes);
    clip.button.append(picture, name, size);
    item.append(clip.button, downloads(clip));
    $("clips").append(item);
    near.observe(picture);
  }
  const [start, shared] = location.hash.split("=");
  if (start === "#ptn") return show({ name: "shared", data: unbase64(shared).buffer });
  const wanted = new URLSearchParams(location.search).get("clip");
  show(list.find((clip) => clip.name === wanted) ?? list.find((clip) => clip.name === "greet") ?? list[0]);
}

gallery().catch((error) => table($("facts"), [["gallery", error.message]]));

// ---- motions that are dropped

let worker = null;
// The effort that shows something at once.
const QUICK = "fast";

// The page's words for what the converter reports by name: its own fields, where it has one.
const SETTINGS = {
  "frame-rate": "\u201cFrames per second\u201d",
  unit: "\u201ccm per unit\u201d",
  animation: "\u201cAnimation\u201d",
  "max-error": "\u201cLargest error\u201d",
  effort: "\u201cEffort\u201d",
};
const REMEDIES = {
  "state-frame-rate": "\u201cFrames per second\u201d states it",
  "change-frame-rate": "\u201cFrames per second\u201d changes it",
  "lower-frame-rate": "lower \u201cFrames per second\u201d",
  "state-unit": "\u201ccm per unit\u201d changes it",
  "state-centimetre": "if its unit is the centimetre, enter 1 as \u201ccm per unit\u201d",
  "choose-animation": "\u201cAnimation\u201d takes another",
  "give-skeleton": "drop it together with the motion",
  "choose-skeleton": "drop the motion with one skeleton",
  "write-segments": "other programs may need segments: the command-line tool writes them with --segments",
  "raise-memory": "the command-line tool converts larger motions",
  "loosen-bound": "raise \u201cLargest error\u201d",
};

// A note or an error as a sentence: its own words, or the page's where it has a field for it.
function sentence({ kind, text, file, place, setting, remedy }) {
  const name = SETTINGS[setting];
  if (kind === "no-effect" && name) text = `${name} has no effect on this motion`;
  else if (kind === "setting" && name) text = `${name}: ${text}`;
  const where = place ?? file;
  return [where, text].filter(Boolean).join(": ") + (REMEDIES[remedy] ? `; ${REMEDIES[remedy]}` : "");
}

function trouble(text) {
  $("trouble").textContent = text;
}

function done() {
  worker?.terminate();
  worker = null;
  $("working").hidden = true;
}

// What was converted last: files with their content.
let last = null;

// The animations of a glTF file, by their names.
function animationsOf({ name, bytes }) {
  try {
    const isBinary = /\.glb$/i.test(name);
    if (!isBinary && !/\.gltf$/i.test(name)) return [];
    const view = new DataView(bytes);
    const json = isBinary ? new Uint8Array(bytes, 20, view.getUint32(12, true)) : new Uint8Array(bytes);
    return (JSON.parse(new TextDecoder().decode(json)).animations ?? []).map(({ name }, index) => name || `animation ${index}`);
  } catch {
    // The importer says what is wrong with it.
    return [];
  }
}

async function take(files) {
  files = [...files];
  // Text, or a link, was dropped: what there is stays.
  if (!files.length) return trouble("That was no file.");
  done();
  trouble("");
  const size = files.reduce((sum, file) => sum + file.size, 0);
  const [first] = files;
  const empty = files.find((file) => !file.size);
  const clip = files.find((file) => /\.pt[nb]$/i.test(file.name));
  if (size > MOST) trouble(`${first.name}: ${bytes(size)}; the page reads motions of at most ${bytes(MOST)}. The command-line tool reads larger ones.`);
  else if (empty) trouble(`${empty.name}: the file is empty; expected a motion.`);
  else if (clip) {
    const others = files.filter((file) => file !== clip).map((file) => file.name);
    if (others.length) trouble(`${clip.name} is played; ${others.join(", ")} ${others.length > 1 ? "were" : "was"} left out.`);
    player.scrollIntoView({ block: "nearest", behavior: "smooth" });
    return show({ name: clip.name, data: await clip.arrayBuffer() });
  } else {
    $("working").hidden = false;
    $("step").textContent = `reading ${first.name}`;
    const given = await Promise.all(files.map(async (file) => ({ name: file.name, bytes: await file.arrayBuffer() }))).catch(() => null);
    if (given) {
      last = given;
      const names = given.flatMap(animationsOf);
      $("animations").hidden = names.length < 2;
      $("animation").replaceChildren(...names.map((name, index) => new Option(name, index)));
      return convert(QUICK, $("effort").value);
    }
    done();
    trouble(`${first.name}: cannot be read.`);
  }
  $("result").hidden = true;
}

// Converts the last files, as the fields say. What was converted before stays until there is something else. `then` is an effort with which they are converted once more.
function convert(effort = $("effort").value, then = effort, doing = "fitting") {
  done();
  trouble("");
  $("working").hidden = false;
  $("progress").removeAttribute("value");
  $("step").textContent = "reading the motion";
  const [given, animation] = [last, $("animations").hidden ? null : $("animation").value];
  const options = { max_error_cm: +$("cm").value, effort, fps: +$("fps").value || null, cm_per_unit: +$("unit").value || null, animation };
  worker = new Worker("converter.js", { type: "module" });
  const failed = (text) => {
    done();
    trouble(text);
    $("result").hidden = true;
  };
  worker.onerror = (event) => failed(`The converter stopped: ${event.message ?? "it could not be loaded"}`);
  worker.onmessage = ({ data }) => {
    if (data.progress !== undefined) {
      $("progress").value = data.progress;
      $("step").textContent = `${doing}, ${Math.floor(100 * data.progress)} %`;
    } else if (data.refused) failed(sentence(data.refused));
    else if (data.error) failed(data.error);
    else {
      done();
      shown(data, given).catch((error) => trouble(error.message));
      if (then !== effort) convert(then, then, "making it smaller");
    }
  };
  worker.postMessage({ files: given, options });
}

// Other values convert again. While the slider moves, quickly.
let soon = 0;
function again(effort) {
  clearTimeout(soon);
  if (last) soon = setTimeout(() => convert(effort), 150);
}
$("slide").oninput = () => {
  $("cm").value = +(10 ** $("slide").value).toPrecision(2);
  again(QUICK);
};
$("slide").onchange = () => again();
$("cm").oninput = () => ($("slide").value = Math.log10(+$("cm").value || 0.5));
for (const id of ["cm", "effort", "fps", "unit", "animation"]) $(id).onchange = () => again();
$("try").onclick = async () => {
  const response = await fetch("clips/walk.bvh").catch(() => null);
  if (!response?.ok) return trouble("Our walk cannot be fetched.");
  take([new File([await response.arrayBuffer()], "walk.bvh")]);
};

// Lets the browser save a file.
function offer(name, content, type) {
  const link = document.createElement("a");
  save(link, name, content, type);
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

function save(link, name, content, type) {
  if (link.href) URL.revokeObjectURL(link.href);
  link.href = URL.createObjectURL(new Blob([content], { type }));
  link.download = name;
}

// What was converted, as a clip of the page.
let made = null;
$("share-clip").onclick = () => share($("share-clip"), made);

// Programs that play it, once they are asked for.
async function showPrograms() {
  if (!$("programs").open || !made) return;
  const { programs } = await import("./programs.js");
  const all = programs(made.name, made.header);
  if (!$("language").length) $("language").append(...all.map(({ language }) => new Option(language)));
  const { needs, text } = all.find(({ language }) => language === $("language").value);
  $("program-needs").textContent = needs;
  $("program").textContent = text;
}
$("programs").ontoggle = $("language").onchange = () => showPrograms().catch((error) => ($("program-needs").textContent = `The programs cannot be fetched: ${error.message}.`));
$("copy-program").onclick = () => copy($("copy-program"), $("program").textContent);

async function shown({ report, clip, header, rig, poses, glb, seconds }, files) {
  const isNew = $("result").hidden;
  $("result").hidden = false;
  if (isNew) $("result").scrollIntoView({ block: "nearest", behavior: "smooth" });
  const { stem } = report;
  const size = files.reduce((sum, file) => sum + file.bytes.byteLength, 0);
  const at = converted.currentTime;
  save($("save"), `${stem}.ptn`, clip, "application/octet-stream");
  save($("save-glb"), `${stem}.glb`, glb, "model/gltf-binary");
  save($("save-c"), `${stem}.h`, header, "text/x-c");
  $("save-glb").hidden = !glb.length;
  made = { name: stem, data: clip, header: new TextDecoder().decode(header) };
  showPrograms();
  const { frames, channels, frame_time_ns, length_exponent } = report;
  const raw = frames * channels * 2;
  table($("report"), [
    ["clip", bytes(clip.length)],
    [files.length > 1 ? "of the files" : "of the file", `${((100 * clip.length) / size).toFixed(clip.length < size / 100 ? 2 : 1)} % of ${bytes(size)}`],
    ["of 16 bits per value", `${((100 * clip.length) / raw).toFixed(1)} %`],
    report.max_error_cm !== undefined && ["error, largest", `${report.max_error_cm.toFixed(3)} cm (${report.worst_joint}, frame ${report.worst_frame})`],
    report.max_error_cm !== undefined && ["error, mean", `${report.mean_error_cm.toFixed(3)} cm`],
    report.max_scalar_error_percent !== undefined && ["values' error, largest", `${report.max_scalar_error_percent.toFixed(2)} % of full scale`],
    ["frames, channels", `${frames}, ${channels}`],
    ["converted in", `${seconds.toFixed(1)} s`],
  ]);
  // Warnings first.
  const notes = [...report.notes].sort((a, b) => (b.severity === "warning") - (a.severity === "warning"));
  $("said").replaceChildren(...notes.map((note) => {
    const item = document.createElement("li");
    item.className = note.severity;
    item.textContent = sentence(note);
    return item;
  }));
  const table_ = { rig, poses, frames, frameTime: frame_time_ns, lengthExponent: length_exponent };
  await Promise.all([original.load(table_), converted.load(clip)]);
  if (!isNew) converted.currentTime = at;
  follow();
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) converted.play();
}

// The original shows what the clip shows, from the same side.
function follow() {
  original.seek(converted.frame);
}
converted.addEventListener("frame", follow);
converted.addEventListener("change", () => original.turn(converted.orbit - original.orbit, converted.tilt - original.tilt));

$("cancel").onclick = () => (done(), trouble("Cancelled."));
$("files").onchange = (event) => (take(event.target.files), (event.target.value = ""));
const over = (on) => (event) => {
  // Text is moved within the page's own field.
  if (event.target === $("machine-text") && !event.dataTransfer.types.includes("Files")) return false;
  event.preventDefault();
  $("drop").classList.toggle("over", on);
  return true;
};
addEventListener("dragover", over(true));
addEventListener("dragleave", over(false));
addEventListener("drop", (event) => over(false)(event) && take(event.dataTransfer.files));

// Without a network the page is shown as it was last. Where there is no service worker, as in a file or a private window, it needs the network.
if (location.protocol.startsWith("http")) navigator.serviceWorker?.register(new URL("offline.js", import.meta.url)).catch(() => {});
