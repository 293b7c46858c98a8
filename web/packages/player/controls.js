// The keys of <pantin-player>, and dragging: loaded once the pointer comes near its picture, or one of its parts has the focus.

const attached = new WeakSet();

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
