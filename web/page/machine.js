// The text of the page's character, edited: a worker compiles it after a short pause, and the character goes on with the new machine. The last good one plays while the text is wrong.
const $ = (id) => document.getElementById(id);

// How long the text rests before it is compiled, in ms.
const PAUSE = 300;
const NAME = "character";

const [text, said, line, reset] = ["machine-text", "machine-said", "machine-line", "machine-reset"].map($);

async function fetched(file) {
  const response = await fetch(file);
  if (!response.ok) throw new Error(`${file}: the server answers ${response.status}`);
  return response;
}

// Of an error or a warning: where, what, and what to do.
function sentence({ line, column, text, remedy }) {
  const where = line ? `Line ${line}, column ${column}: ` : "";
  return `${where}${text}${remedy ? `; ${remedy}` : ""}.`;
}

function element(tag, properties, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

// Shows a place of the text, and puts the cursor there.
function go(to, column) {
  const lines = text.value.split("\n");
  const before = lines.slice(0, to - 1).reduce((sum, { length }) => sum + length + 1, 0);
  const at = before + [...lines[to - 1]].slice(0, column - 1).join("").length;
  text.focus();
  text.setSelectionRange(at, before + lines[to - 1].length);
  text.scrollTop = (to - 4) * parseFloat(getComputedStyle(text).lineHeight);
}

// A button of an input that the page has none for, and a slider of a parameter.
function button(name, isHeld) {
  const made = element("button", { type: "button", className: "added" }, name.replaceAll("_", " "));
  made.dataset[isHeld ? "hold" : "fire"] = name;
  if (isHeld) made.setAttribute("aria-pressed", false);
  return made;
}

// Values of parameters that the user has set, by their names: they stay with another machine.
const values = new Map();

function slider(character, { name, range: [min, max], value }) {
  const input = element("input", { type: "range", min, max, value });
  input.oninput = () => {
    values.set(name, +input.value);
    character.set(name, +input.value);
  };
  return element("label", {}, name.replaceAll("_", " "), input);
}

// Offers what the machine has. Buttons of the page stay where their inputs are there; one that fires an input that is to be held gives way to one that holds it.
function offerInputs(character, held) {
  const controls = () => [...$("inputs").querySelectorAll("button")];
  const names = ({ dataset }) => (dataset.hold ?? dataset.fire).split(" ");
  const fits = (control, name) => character.inputs.includes(name) && ("hold" in control.dataset ? !control.matches(".added") || held.includes(name) : !held.includes(name));
  for (const control of controls()) {
    control.hidden = !names(control).some((name) => fits(control, name));
    if (!control.hidden) continue;
    if (control.matches(".added")) control.remove();
    else if (control.dataset.hold) control.setAttribute("aria-pressed", false);
  }
  const there = controls().filter((control) => !control.hidden).flatMap((control) => names(control).filter((name) => fits(control, name)));
  $("inputs").append(...character.inputs.filter((name) => !there.includes(name)).map((name) => button(name, held.includes(name))));
  $("inputs").querySelectorAll("label").forEach((label) => label.remove());
  for (const { name } of character.parameters) if (values.has(name)) character.set(name, values.get(name));
  $("inputs").append(...character.parameters.map((parameter) => slider(character, parameter)));
}

// What the user made of the page's own text stays when the page is left; null without. A browser may refuse to keep it.
const KEPT = "pantin-machine";

function kept(own) {
  try {
    const [from, text] = JSON.parse(localStorage.getItem(KEPT)) ?? [];
    return from === own ? text : null;
  } catch {
    return null;
  }
}

function store(own, text) {
  try {
    if (text === own) localStorage.removeItem(KEPT);
    else localStorage.setItem(KEPT, JSON.stringify([own, text]));
  } catch {
    // The text stays as long as the page.
  }
}

// Lets the user edit the character's text.
export async function edit({ character, steered, bytes, offer }) {
  said.textContent = "Fetching the text and its compiler.";
  const [own, bank] = await Promise.all([
    fetched(`clips/${NAME}.toml`).then((response) => response.text()),
    fetched(`clips/${NAME}.ptb`).then(async (response) => new Uint8Array(await response.arrayBuffer())),
  ]);
  const worker = new Worker(new URL("machine-worker.js", import.meta.url), { type: "module" });
  // The bank that plays, and whether the worker compiles; the text has changed then or not.
  let playing = bank;
  let isBusy = false;
  let isStale = false;
  let timer = 0;

  const compile = () => {
    clearTimeout(timer);
    isStale = isBusy;
    if (isBusy) return;
    isBusy = true;
    worker.postMessage({ bank, name: NAME, text: text.value });
  };

  const warned = (warnings) => $("machine-warnings").replaceChildren(...warnings.map((warning) => element("li", { className: "warning" }, sentence(warning))));

  const wrong = (fault) => {
    warned([]);
    said.textContent = `${sentence(fault)} ${fault.line ? "The figure goes on with the last good text." : ""}`.trim();
    said.classList.add("wrong");
    text.setAttribute("aria-invalid", true);
    line.hidden = !fault.line;
    if (!fault.line) return;
    line.textContent = `Go to line ${fault.line}`;
    line.onclick = () => go(fault.line, fault.column);
  };

  const right = ({ states, transitions, table_bytes, bytes: whole, warnings }) => {
    const plural = (count, what) => `${count} ${what}${count === 1 ? "" : "s"}`;
    const counts = warnings.length ? `, ${plural(warnings.length, "warning")}` : "";
    said.textContent = `${plural(states, "state")}, ${plural(transitions, "transition")}: a table of ${bytes(table_bytes)}. With motions and figure, ${bytes(whole)}${counts}.`;
    warned(warnings);
    $("machine-clips").textContent = `Its motions: ${character.clips.join(", ")}.`;
    said.classList.remove("wrong");
    text.removeAttribute("aria-invalid");
    line.hidden = true;
  };

  // Plays another bank from its start, with the inputs that are held. The same one goes on.
  const play = async (next, report, graph) => {
    if (next.length === playing.length && next.every((byte, index) => byte === playing[index])) return;
    const wasPlaying = !character.paused;
    try {
      await character.load(next);
    } catch (error) {
      await character.load(playing);
      throw error;
    } finally {
      if (wasPlaying) character.play().catch(() => {});
    }
    playing = next;
    offerInputs(character, report.held);
    steered(report.inputs, graph);
  };

  worker.onmessage = async ({ data: { report, refused, error, bank: next, graph } }) => {
    try {
      if (error) throw new Error(error);
      // A text that has changed meanwhile is compiled again.
      if (!isStale && refused) wrong(refused);
      if (!isStale && report) {
        await play(next, report, graph);
        right(report);
      }
    } catch (error) {
      wrong({ text: `The text was not compiled: ${error.message}` });
    }
    isBusy = false;
    if (isStale) compile();
  };
  worker.onerror = ({ message }) => {
    isBusy = false;
    wrong({ text: `The compiler stopped: ${message ?? "it could not be loaded"}` });
  };

  text.value = kept(own) ?? own;
  // What was reset comes back, until the text is edited.
  let before = null;
  const keep = (value) => {
    before = value;
    reset.textContent = before === null ? "Reset" : "Undo reset";
  };
  text.oninput = () => {
    keep(null);
    store(own, text.value);
    clearTimeout(timer);
    timer = setTimeout(compile, PAUSE);
  };
  reset.onclick = () => {
    const { value } = text;
    text.value = before ?? own;
    store(own, text.value);
    keep(before === null ? value : null);
    compile();
  };
  $("machine-bank").onclick = () => offer(`${NAME}.ptb`, playing, "application/octet-stream");
  $("machine-save").onclick = () => offer(`${NAME}.toml`, text.value, "text/plain");
  for (const control of [text, reset, $("machine-bank"), $("machine-save")]) control.disabled = false;
  compile();
}
