// The keys of <pantin-player>, dragging, and its markers: loaded once the pointer comes near its picture, one of its parts has the focus, or a clip with events is there.

const attached = new WeakSet();
// Pixels from a marker within which its name is shown.
const NEAR = 12;

// Frames with markers, and their names: of a marker without one, its number.
function markersOf({ events, frames }) {
  const names = new Map();
  for (const { frame, id, name } of events) if (frame < frames) names.set(frame, [...(names.get(frame) ?? []), name || id]);
  return [...names].map(([frame, all]) => ({ frame, name: all.join(", ") })).sort((a, b) => a.frame - b.frame);
}

// Goes to the next marker, or to the one before; from the last one to the first.
function toMarker(player, way) {
  const frames = markersOf(player).map(({ frame }) => frame);
  if (way < 0) frames.reverse();
  if (frames.length) player.seek(frames.find((frame) => (frame - player.frame) * way > 0) ?? frames[0]);
}

// Shows the markers as ticks of the scrubber, whose texts and title have their names.
function mark(player) {
  const { scrubber } = player;
  const list = document.createElement("datalist");
  list.id = "markers";
  scrubber.after(list);
  scrubber.setAttribute("list", list.id);
  let markers;
  const fill = () => {
    markers = markersOf(player);
    list.replaceChildren(...markers.map(({ frame, name }) => new Option(name, frame)));
  };
  fill();
  ["canplaythrough", "emptied"].forEach((name) => player.addEventListener(name, fill));
  const say = () => {
    const here = markers.find(({ frame }) => frame === player.frame);
    const text = scrubber.getAttribute("aria-valuetext");
    if (here && text && !text.endsWith(here.name)) scrubber.setAttribute("aria-valuetext", `${text}, ${here.name}`);
  };
  ["frame", "change"].forEach((name) => player.addEventListener(name, say));
  scrubber.addEventListener("pointermove", ({ offsetX }) => {
    const { clientWidth } = scrubber;
    const last = Math.max(1, player.playable - 1);
    scrubber.title = markers.find(({ frame }) => Math.abs((frame / last) * clientWidth - offsetX) < NEAR)?.name ?? "";
  });
}

// What a key asks for. `home` is the view at the start.
function actOf(player, { key, shiftKey }, home) {
  const step = shiftKey ? 15 : 1;
  return {
    " ": () => player.toggle(),
    ArrowLeft: () => (shiftKey ? player.turn(-step, 0) : player.step(-1)),
    ArrowRight: () => (shiftKey ? player.turn(step, 0) : player.step(1)),
    ArrowUp: () => player.turn(0, 5),
    ArrowDown: () => player.turn(0, -5),
    Home: () => player.seek(0),
    End: () => player.seek(player.playable - 1),
    n: () => toMarker(player, 1),
    p: () => toMarker(player, -1),
    r: () => (player.backwards = !player.backwards),
    l: () => (player.look = { lines: "solid", solid: "oled", oled: "lines" }[player.look]),
    f: () => (document.fullscreenElement ? document.exitFullscreen() : player.requestFullscreen()),
    "+": () => (player.playbackRate = Math.min(8, player.playbackRate * 2)),
    "-": () => (player.playbackRate = Math.max(1 / 8, player.playbackRate / 2)),
    0: () => player.turn(home.orbit - player.orbit, home.tilt - player.tilt),
  }[key.length === 1 ? key.toLowerCase() : key];
}

export function attach(player, home) {
  if (attached.has(player)) return;
  attached.add(player);
  mark(player);
  player.addEventListener("keydown", (event) => {
    const [on] = event.composedPath();
    const { key } = event;
    const act = actOf(player, event, home);
    // What a button and the scrubber do with their own keys they do themselves.
    const isOwn = on.localName === "button" ? key === " " : on === player.scrubber && key.startsWith("Arrow");
    if (!act || isOwn || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    act();
    player.dispatchEvent(new CustomEvent("change", { detail: null }));
  });
  const { stage } = player;
  let from = null;
  const place = ({ clientX, clientY }) => [clientX, clientY];
  stage.addEventListener("pointerdown", (event) => {
    from = place(event);
    stage.setPointerCapture(event.pointerId);
    stage.style.cursor = "grabbing";
  });
  stage.addEventListener("lostpointercapture", () => (stage.style.cursor = ""));
  stage.addEventListener("pointermove", (event) => {
    if (!(event.buttons & 1)) return;
    const [[x, y], [oldX, oldY]] = [place(event), from ?? place(event)];
    from = [x, y];
    player.turn((oldX - x) / 2, (y - oldY) / 3);
  });
}
