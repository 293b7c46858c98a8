// The face of the page: its emotes as buttons, and speech, whose script is fetched when it is asked for.
const $ = (id) => document.getElementById(id);
const face = $("face");
const [microphone, spoken] = ["microphone", "sentence"].map($);

// Sound that the browser does not give is not offered.
const missing = !globalThis.AudioContext ? "this browser plays no sound" : navigator.mediaDevices?.getUserMedia ? "" : "browsers give pages a microphone only over https, or from this computer";
for (const button of !missing ? [] : globalThis.AudioContext ? [microphone] : [microphone, spoken]) button.disabled = true;

// What ends the present speech.
let ends = null;
let current = "happy";
let filesOf;

const said = (text) => ($("face-why").textContent = text || (missing && `Greyed: ${missing}.`));
const buttons = () => [...document.querySelectorAll("#emotes button")];
const wantsStill = () => matchMedia("(prefers-reduced-motion: reduce)").matches;

function silence() {
  ends?.abort();
  ends = null;
}

// Shows an emote. One that a button asked for plays for who wants less motion, too.
async function feel(emote, isAsked) {
  silence();
  if (isAsked) said("");
  current = emote.name;
  buttons().forEach((button) => button.setAttribute("aria-pressed", button.dataset.name === emote.name));
  try {
    await face.load(emote.file);
    $("emote-files").replaceChildren(filesOf(emote));
    $("emote-size").textContent = `${emote.name}: ${emote.bytes} bytes for ${face.duration.toFixed(1)} seconds that repeat`;
    if (isAsked || !wantsStill()) await face.play();
  } catch (error) {
    if (error.name !== "AbortError") said(`The emote cannot be shown: ${error.message}.`);
  }
}

// Lets the face speak until it has, or something else is asked for; then it shows its emote again.
async function talk(button, isLive, emotes) {
  const isOn = button.getAttribute("aria-pressed") === "true";
  const again = () => feel(emotes.find(({ name }) => name === current), false);
  silence();
  if (isOn) {
    said("");
    return again();
  }
  const own = (ends = new AbortController());
  said(isLive ? "The browser asks whether this page may use the microphone." : "");
  buttons().forEach((other) => other.setAttribute("aria-pressed", false));
  button.setAttribute("aria-pressed", true);
  let reason = "";
  try {
    const { speak } = await import("./speech.js");
    await speak(face, {
      isLive,
      signal: own.signal,
      begun: () => {
        if (isLive) said("The mouth follows the microphone. The sound stays on this computer.");
        $("emote-size").textContent = "Integers turn sound into the weights of 14 visemes, 100 times a second";
      },
      heard: (viseme) => ($("viseme").textContent = viseme && `“${viseme}”`),
    });
  } catch (error) {
    reason = `The face cannot speak: ${error.message}.`;
  }
  button.setAttribute("aria-pressed", false);
  $("viseme").textContent = "";
  if (ends !== own) return;
  said(reason);
  again();
}

// Offers the emotes; `downloads` makes links to a clip's files.
export async function list(downloads) {
  filesOf = downloads;
  const response = await fetch("clips/emotes.json");
  if (!response.ok) throw new Error(`the server answers ${response.status}`);
  const emotes = await response.json();
  $("emotes").replaceChildren(...emotes.map((emote) => {
    const button = document.createElement("button");
    const size = document.createElement("small");
    Object.assign(button, { type: "button", onclick: () => feel(emote, true) });
    button.dataset.name = emote.name;
    button.setAttribute("aria-pressed", false);
    size.textContent = `${emote.bytes} bytes`;
    button.append(emote.name, " ", size);
    return button;
  }));
  microphone.onclick = () => talk(microphone, true, emotes);
  spoken.onclick = () => talk(spoken, false, emotes);
  const first = emotes.find(({ name }) => name === current);
  if (first) await feel(first, false);
}

said("");
