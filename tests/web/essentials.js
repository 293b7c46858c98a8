// In the site's page, before its own scripts: uses what the page is there for, and sends what it saw to browsers.mjs. What it waits for it waits for without a limit, which
// browsers.mjs has. What it sends is equal in every browser.
const send = (path, value) => fetch(path, { method: "POST", body: JSON.stringify(value) });
const troubles = [];
const trouble = (text) => troubles.push(String(text));
addEventListener("error", ({ message, target }) => trouble(message ?? `cannot load ${target.src ?? target.href}`), true);
addEventListener("unhandledrejection", ({ reason }) => trouble(reason));
console.error = (...words) => trouble(words.join(" "));

const $ = (id) => document.getElementById(id);
async function until(holds) {
  for (;;) {
    const value = await holds();
    if (value) return value;
    await new Promise((go) => setTimeout(go, 20));
  }
}
function must(holds, text) {
  if (!holds) throw new Error(text);
}
const hash = (values) => values.reduce((hash, value) => (Math.imul(hash, 31) + value) | 0, 7);
const picture = ({ context, canvas: { width, height } }) => new Uint32Array(context.getImageData(0, 0, width, height).data.buffer);
const input = (id, value) => ($(id).value = value, $(id).dispatchEvent(new Event("change")));
// The file that a button of the page saves: what its link would have downloaded.
async function saved(button) {
  const { click } = HTMLAnchorElement.prototype;
  const file = new Promise((done) => (HTMLAnchorElement.prototype.click = function () { done(this.href); }));
  button.click();
  const url = await Promise.race([file, until(() => $("trouble").textContent).then((text) => Promise.reject(new Error(text)))]);
  HTMLAnchorElement.prototype.click = click;
  return (await fetch(url)).blob();
}
// Width and height of a picture, and whether it shows more than its paper.
async function decoded(blob) {
  const image = Object.assign(new Image(), { src: URL.createObjectURL(blob) });
  await image.decode();
  const { naturalWidth: width, naturalHeight: height } = image;
  const context = Object.assign(document.createElement("canvas"), { width, height }).getContext("2d");
  context.drawImage(image, 0, 0);
  return { width, height, isDrawn: new Set(picture({ context, canvas: image })).size > 10 };
}

const steps = {
  async "a character walks by itself, and keeps walking"() {
    const character = $("character");
    await until(() => character.state && !character.paused);
    const first = hash(picture(character));
    await until(() => hash(picture(character)) !== first);
    return character.states.length;
  },
  async "the page's buttons steer it"() {
    const character = $("character");
    const buttons = [...document.querySelectorAll("#inputs button")];
    const [walk, wave] = [buttons[0], buttons[5]];
    character.pause();
    const reach = (state) => {
      for (let turns = 0; character.state !== state; turns++) {
        must(turns < 200, `the character stays at ${character.state} and does not come to ${state}`);
        character.advance(0.05);
      }
    };
    if (walk.getAttribute("aria-pressed") === "true") walk.click();
    reach("idle");
    wave.click();
    reach("wave");
    reach("idle");
    character.play();
  },
  async "the face shows an emote"() {
    $("face").scrollIntoView();
    const emotes = await until(() => document.querySelectorAll("#emotes button").length && [...document.querySelectorAll("#emotes button")]);
    await until(() => $("face").readyState === 4);
    emotes[3].click();
    await until(() => emotes[3].getAttribute("aria-pressed") === "true" && $("face").readyState === 4 && !$("face").paused);
    return [emotes.length, $("face").frames];
  },
  async "no picture is wider than its element"() {
    $("player").scrollIntoView();
    await until(() => $("player").readyState === 4);
    for (const { id, clientWidth, stage } of document.querySelectorAll("pantin-player")) must(stage.clientWidth <= clientWidth, `the picture of ${id} is ${stage.clientWidth} pixels wide, its element ${clientWidth}`);
  },
  async "all clips play"() {
    const list = [...document.querySelectorAll("#clips button")];
    const frames = [];
    for (const clip of list) {
      clip.click();
      await until(() => clip.getAttribute("aria-current") && $("player").readyState === 4);
      await until(() => !$("player").paused && $("player").frame > 0);
      frames.push($("player").frames);
    }
    return frames;
  },
  async "lines, solid figures and the display"() {
    const player = $("player");
    await player.load("clips/walk.ptn");
    player.pause();
    const pictures = new Set();
    for (const { value } of $("figure").options) {
      input("figure", value);
      // Waits for the look's module.
      await player.picture();
      player.seek(20);
      must(!player.trouble, player.trouble);
      pictures.add(hash(picture(player)));
    }
    must(pictures.size === $("figure").options.length, "two figures look the same");
    const greys = player.grey();
    input("figure", "lines");
    return hash(greys);
  },
  async "the scrubber seeks"() {
    const { scrubber } = $("player");
    scrubber.value = 33;
    scrubber.dispatchEvent(new Event("input"));
    return [$("player").frame, scrubber.getAttribute("aria-valuetext")];
  },
  async "a saved picture"() {
    const { width, height, isDrawn } = await decoded(await saved($("save-picture")));
    const { canvas } = $("player");
    must(width === canvas.width && height === canvas.height, `the picture has ${width}x${height} pixels, the canvas ${canvas.width}x${canvas.height}`);
    return isDrawn;
  },
  async "a saved GIF"() {
    const { width, isDrawn } = await decoded(await saved($("save-gif")));
    return [width, isDrawn];
  },
  async "a saved video, where the browser writes them"() {
    if ($("save-video").hidden) return;
    const { type, size } = await saved($("save-video"));
    must(type === "video/webm" && size > 1000, `${size} bytes of ${type}`);
  },
  async "a clip over a slow line"() {
    const player = $("player");
    input("link", 9600);
    await until(() => player.playable > 1 && player.playable < player.frames);
    input("link", 0);
    await until(() => player.readyState === 4);
  },
  async "a conversion"() {
    const files = new DataTransfer();
    files.items.add(new File([await (await fetch("clips/walk.bvh")).arrayBuffer()], "walk.bvh"));
    $("files").files = files.files;
    $("files").dispatchEvent(new Event("change"));
    await until(() => $("trouble").textContent || (!$("result").hidden && $("converted").readyState === 4 && $("original").readyState === 4));
    must(!$("trouble").textContent, $("trouble").textContent);
    const clip = new Uint8Array(await (await fetch($("save").href)).arrayBuffer());
    return [clip.length, hash(clip), $("converted").frames, $("original").frames];
  },
};

addEventListener("load", async () => {
  const found = {};
  for (const [name, step] of Object.entries(steps)) {
    await send("/began", name);
    try {
      found[name] = (await step()) ?? true;
    } catch (error) {
      trouble(`${name}: ${error.message}`);
    }
  }
  await send("/saw", { ...found, troubles });
});
