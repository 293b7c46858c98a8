// Drives the page in a headless Chromium as a user would: `node drive.mjs CASE JSON`. What a case asserts itself fails it; what it saw, it prints as JSON.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";

const { chromium } = createRequire(`${process.env.PLAYWRIGHT}/`)("playwright-core");
const [, , name, words] = process.argv;
const args = JSON.parse(words);
const LAUNCH = { executablePath: process.env.CHROMIUM, args: ["--disable-gpu"], chromiumSandbox: process.getuid?.() !== 0 };

// In the page: the canvas of a player as the greys of the display, a hexadecimal digit each, and a hash of any canvas.
const HELPERS = () => {
  window.greys = (player) => Array.from(player.context.getImageData(0, 0, 128, 64).data.filter((_, index) => index % 4 === 0), (grey) => (grey / 17).toString(16)).join("");
  window.seen = (player) => {
    const { width, height } = player.canvas;
    const pixels = new Uint32Array(player.context.getImageData(0, 0, width, height).data.buffer);
    return { colours: new Set(pixels).size, hash: pixels.reduce((hash, pixel) => (Math.imul(hash, 31) + pixel) | 0, 7) };
  };
};

// A context whose waits a busy machine does not end: there a picture may take minutes that takes a second elsewhere. Nothing stands between it and the server.
async function patient(browser, options) {
  const context = await browser.newContext({ serviceWorkers: "block", ...options });
  context.setDefaultTimeout(300_000);
  return context;
}

// The page; with a `policy`, as a server sends it that restricts where its parts come from.
async function opened(browser, { policy, ...options } = {}) {
  const context = await patient(browser, { viewport: { width: 1280, height: 900 }, acceptDownloads: true, ...options });
  const page = await context.newPage();
  page.troubles = [];
  page.on("pageerror", (error) => page.troubles.push(error.message));
  page.on("console", (message) => message.type() === "error" && page.troubles.push(message.text()));
  await page.addInitScript(HELPERS);
  if (policy) await page.route(args.site, async (route) => {
    const response = await route.fetch();
    await route.fulfill({ response, headers: { ...response.headers(), "content-security-policy": policy } });
  });
  await page.goto(args.site);
  await page.waitForFunction(() => document.querySelector("#player").playable > 1);
  // Who cannot be seen does not play.
  await page.evaluate(() => document.querySelector("#player").scrollIntoView());
  // The face beside it has come near, and fetches what it shows.
  await page.waitForFunction(() => face.readyState === 4);
  return page;
}

const load = (page, file) => page.evaluate((file) => player.load(file).then(() => "", (error) => error.message), file);
const state = (page) => page.evaluate(() => ({ ...player.facts, paused: player.paused, received: player.received, orbit: player.orbit }));
const said = (page) => page.locator("#player p[role=status]").textContent();

// The programs that the page offers for what was converted, by their languages.
async function programsOf(page) {
  await page.locator("#programs summary").click();
  await page.waitForFunction(() => document.querySelector("#program").textContent);
  const programs = {};
  for (const language of await page.locator("#language option").allTextContents()) {
    await page.locator("#language").selectOption(language);
    programs[language] = await page.locator("#program").textContent();
  }
  return programs;
}

const cases = {
  // Frames in the order asked for, from the sides asked for, as they stand on the canvas.
  async pixels(page) {
    await page.evaluate(() => (player.pause(), (player.look = "oled")));
    const pictures = [];
    for (const { clip, frames, orbit, tilt } of args.parts) {
      assert.equal(await load(page, clip), "");
      pictures.push(await page.evaluate(({ frames, orbit, tilt }) => {
        player.pause();
        player.turn(orbit - player.orbit, tilt - player.tilt);
        return frames.map((frame) => (player.seek(frame), window.greys(player)));
      }, { frames, orbit, tilt }));
    }
    return pictures;
  },

  // The session of our character, each tenth picture; then the page's own keys, buttons and graph.
  async character(page) {
    await page.waitForFunction(() => character.states.length);
    const pictures = await page.evaluate(async (session) => {
      const stage = document.createElement("pantin-player");
      document.body.append(stage);
      stage.look = "oled";
      await stage.load("clips/character.ptb");
      const lines = session.split("\n").map((line) => line.replace(/#.*/, "").trim().split(/\s+/)).filter(([time]) => time);
      const end = +lines.at(-1)[0];
      const at = (picture) => Math.floor((picture * 1e6) / 30);
      const [shown, states] = [[], [stage.state]];
      stage.addEventListener("state", ({ detail }) => states.push(detail));
      let next = 0;
      for (let picture = 0; picture <= end * 30; picture += 1) {
        if (picture) {
          for (; Math.round(lines[next][0] * 1e6) <= at(picture) && lines[next][1] !== "end"; next += 1) {
            const [, what, name] = lines[next];
            if (what === "press") stage.fire(name);
            else stage.hold(name, what === "hold");
          }
          stage.advance((at(picture) - at(picture - 1)) / 1e6);
        }
        if (picture % 10 === 0) shown.push(window.greys(stage));
      }
      let refused = "";
      try {
        stage.fire("fly");
      } catch (error) {
        refused = error.message;
      }
      // A clip of the same bank by its name is a clip.
      await stage.load("clips/character.ptb#walk");
      const clip = [stage.states.length, stage.frames > 10];
      stage.remove();
      return { shown, states, refused, clip };
    }, args.session);
    assert.match(pictures.refused, /no input fly; it has go, /);
    assert.deepEqual(pictures.clip, [0, true]);
    const is = (name) => page.waitForFunction((name) => character.state === name && document.querySelector("#graph .lit")?.dataset.state === name, name);
    await page.evaluate(() => scrollTo(0, 0));
    // It walks already; what it cannot do now is greyed, and does nothing.
    await is("walk");
    const offers = async () => Object.fromEntries(await page.locator("#inputs button").evaluateAll((all) => all.map((one) => [one.textContent, one.getAttribute("aria-disabled") !== "true"])));
    await page.waitForFunction(() => document.querySelector("#inputs [data-fire=bow]").getAttribute("aria-disabled") === "true");
    assert.deepEqual(await offers(), { Walk: true, Run: true, "Turn left": false, "Turn right": false, Jump: true, Wave: true, Bow: false, "Sit, stand": true, Dance: false });
    assert.match(await page.locator("#why").textContent(), /Not from “walk”: turn left, turn right, bow, dance\. Press “Walk” again: it stops/);
    await page.getByRole("button", { name: "Bow", exact: true }).dispatchEvent("click");
    await page.getByRole("button", { name: "Walk", exact: true }).click();
    await is("idle");
    assert.ok(Object.values(await offers()).every(Boolean), "all of it can be done");
    assert.equal(await page.locator("#why").textContent(), "");
    await page.locator("#character .stage").click();
    await page.keyboard.down("ArrowUp");
    await is("walk");
    await page.keyboard.down("Shift");
    await is("run");
    await page.keyboard.up("Shift");
    await page.keyboard.up("ArrowUp");
    await is("idle");
    const button = (name) => page.getByRole("button", { name, exact: true });
    await button("Run").click();
    assert.equal(await button("Walk").getAttribute("aria-pressed"), "true", "to run is to walk fast");
    await is("run");
    await button("Walk").click();
    await is("idle");
    await button("Sit, stand").click();
    await is("sit_down");
    return pictures;
  },

  // The text of the character's state machine, edited: what is right plays at once, what is wrong is named with its line, and the host's compiler makes the same bank.
  async machine(_, browser) {
    const policy = "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; img-src 'self' data:; object-src 'none'; base-uri 'none'";
    const page = await opened(browser, { policy });
    await page.evaluate(() => {
      scrollTo(0, 0);
      window.loads = 0;
      character.addEventListener("loadstart", () => window.loads++);
    });
    const is = (name) => page.waitForFunction((name) => character.state === name && document.querySelector("#graph .lit")?.dataset.state === name, name);
    const says = (pattern) => page.waitForFunction((pattern) => new RegExp(pattern).test(document.querySelector("#machine-said").textContent), pattern);
    const button = (name) => page.locator("#inputs").getByRole("button", { name, exact: true });
    const parts = () => page.evaluate(() => performance.getEntriesByType("resource").map(({ name }) => name).filter((name) => /machine|wasm|toml/.test(name)).length);
    const states = () => page.evaluate(() => character.states.length);
    const loads = () => page.evaluate(() => window.loads);
    const text = page.locator("#machine-text");
    await is("walk");
    assert.equal(await parts(), 0, "nothing is fetched before it is asked for");
    await page.locator("#edit summary").click();
    const size = args.bytes.toLocaleString("en-US");
    await says(`^16 states, 29 transitions: a table of [0-9]+ bytes. With motions and figure, ${size} bytes\\.$`);
    assert.ok((await parts()) >= 2);
    assert.equal(await text.inputValue(), args.text);
    assert.ok(await text.evaluate((text) => parseFloat(getComputedStyle(text).fontSize) >= 14));
    assert.deepEqual([await loads(), await page.evaluate(() => character.state)], [0, "walk"], "the same machine goes on");
    // The keyboard leaves the text.
    await text.focus();
    await page.keyboard.press("Tab");
    assert.equal(await page.evaluate(() => document.activeElement.id), "machine-reset");

    // A new state with an input that is held, and a parameter that nothing uses. What was held is held.
    await text.fill(args.edited);
    await says("^17 states, 31 transitions: .*, 1 warning\\.$");
    assert.match(await page.locator("#machine-warnings").textContent(), /^Line \d+, column 8: parameter `pace`: no blend and no transition uses it\.$/);
    assert.equal(await states(), 17);
    await is("walk");
    await button("Walk").click();
    await is("idle");
    assert.equal(await button("cheer").getAttribute("aria-pressed"), "false");
    await button("cheer").click();
    await is("cheer");
    assert.equal(await button("Bow").getAttribute("aria-disabled"), "true");
    await button("cheer").click();
    await is("idle");
    await page.locator("#inputs").getByRole("slider", { name: "pace" }).fill("7");
    const file = async (name) => {
      const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name, exact: true }).click()]);
      return [download.suggestedFilename(), readFileSync(await download.path())];
    };
    assert.deepEqual(await file("Save .ptb"), ["character.ptb", readFileSync(args.bank)]);
    assert.deepEqual(await file("Save text"), ["character.toml", Buffer.from(args.edited)]);

    // What is wrong is named, and the last machine plays.
    const before = await loads();
    await text.fill(args.edited.replace('to = "run", input = "fast"', 'to = "nowhere", input = "fast"'));
    await says("^Line \\d+, column 5: state `walk`: no state `nowhere`; there are .* The figure goes on with the last good text\\.$");
    assert.deepEqual([await text.getAttribute("aria-invalid"), await loads(), await states()], ["true", before, 17]);
    await button("cheer").click();
    await is("cheer");
    await button("cheer").click();
    await is("idle");
    await page.getByRole("button", { name: /^Go to line/ }).click();
    assert.match(await text.evaluate((text) => (document.activeElement === text ? text.value.slice(text.selectionStart, text.selectionEnd) : "")), /^\{ to = "nowhere", /);
    await text.fill(`${args.text}\n[[state`);
    await says("^Line \\d+, column \\d+: unclosed");

    // An input that is gone takes its button along; one that fires becomes one that holds.
    const less = args.text.replace('    { to = "bow", input = "bow" },\n', "").replace(/\[\[state\]\]\nname = "bow"\n.*\n/, "").replace('name = "wave"\ntransitions = [', 'name = "wave"\ntransitions = [{ to = "idle", released = "wave" }, ');
    await text.fill(less);
    await says("^15 states, 28 transitions");
    assert.equal(await text.getAttribute("aria-invalid"), null);
    assert.deepEqual([await button("Bow").count(), await button("cheer").count(), await button("Wave").count(), await button("wave").getAttribute("aria-pressed")], [0, 0, 0, "false"]);
    assert.equal(await page.locator("#inputs label").count(), 0);

    // Back to the page's own text, and that again.
    await page.getByRole("button", { name: "Reset", exact: true }).click();
    await says(`^16 states, 29 transitions: .* ${size} bytes\\.$`);
    assert.deepEqual([await text.inputValue(), await states(), await button("Bow").count(), await button("wave").count()], [args.text, 16, 1, 0]);
    await page.getByRole("button", { name: "Undo reset", exact: true }).click();
    await says("^15 states");
    assert.equal(await text.inputValue(), less);
    // Left and opened again, the page has the user's text.
    await page.reload();
    await page.locator("#edit summary").click();
    await says("^15 states");
    assert.equal(await text.inputValue(), less);
    await page.getByRole("button", { name: "Reset", exact: true }).click();
    await says("^16 states");
    assert.deepEqual(page.troubles, []);
  },

  async controls(page) {
    assert.equal((await state(page)).paused, false, "it plays by itself");
    await page.locator("#player .bar button:first-child").click();
    assert.equal((await state(page)).paused, true, "the button pauses");
    const { frames } = await state(page);
    const scrubber = page.locator("#player input");
    await scrubber.fill("40");
    assert.equal((await state(page)).frame, 40);
    await scrubber.press("ArrowRight");
    assert.equal((await state(page)).frame, 41, "the scrubber's own keys step");
    const stage = page.locator("#player .stage");
    await stage.focus();
    await page.evaluate(() => import("/pantin-controls.js"));
    const key = async (...keys) => {
      for (const key of keys) await page.keyboard.press(key);
      return state(page);
    };
    assert.equal((await key("ArrowLeft", "ArrowLeft")).frame, 39);
    assert.equal((await key("End")).frame, frames - 1);
    assert.equal((await key("ArrowRight")).frame, 0, "a step from the last frame leads to the first");
    assert.equal((await key("ArrowLeft")).frame, frames - 1);
    assert.equal((await key("Shift+ArrowRight")).orbit, -35);
    // Backwards: the frames that are shown fall.
    await page.evaluate(() => {
      window.shown = [];
      player.loop = false;
      player.addEventListener("frame", () => window.shown.push(player.frame));
    });
    await key("r", " ");
    await page.waitForFunction(() => player.paused && player.frame === 0);
    let shown = await page.evaluate(() => window.shown.splice(0));
    assert.ok(shown.length > 5 && shown.every((frame, index) => !index || frame < shown[index - 1]), `${shown}`);
    // Forwards, to the end, where it stops; then as a loop, past it.
    await key("r", " ");
    await page.waitForFunction((last) => player.paused && player.frame === last, frames - 1);
    shown = await page.evaluate(() => window.shown.splice(0));
    assert.ok(shown.every((frame, index) => !index || frame > shown[index - 1]), `${shown}`);
    await page.locator("#loop").click();
    await page.locator("#speed").selectOption("4");
    await page.locator("#player .bar button:first-child").click();
    await page.waitForFunction(() => window.shown.some((frame, index) => index && frame < window.shown[index - 1]));
    await page.locator("#player .bar button:first-child").click();
    // Dragging orbits the figure.
    const before = await page.evaluate(() => [player.orbit, window.seen(player).hash]);
    const box = await stage.boundingBox();
    await page.mouse.move(box.x + 300, box.y + 100);
    await page.mouse.down();
    await page.mouse.move(box.x + 200, box.y + 100, { steps: 5 });
    await page.mouse.up();
    const after = await page.evaluate(() => [player.orbit, window.seen(player).hash]);
    assert.ok(Math.abs(after[0] - before[0]) > 30 && after[1] !== before[1], `${before} ${after}`);
    await page.locator("#home").click();
    assert.equal((await state(page)).orbit, -50);
    const figure = page.locator("#figure");
    await figure.selectOption("oled");
    assert.equal(await page.evaluate(() => player.look + player.canvas.width), "oled128");
    await figure.selectOption("solid cat");
    assert.deepEqual(await page.evaluate(() => [player.look, player.getAttribute("character-look")]), ["solid", "clips/cat.look"]);
    await stage.focus();
    await page.keyboard.press("l");
    assert.equal(await figure.inputValue(), "oled", "the key's choice is shown");
    await page.keyboard.press("l");
    await page.keyboard.press("l");
    assert.equal(await figure.inputValue(), "solid cat");
    await figure.selectOption("lines");
    assert.deepEqual(await page.evaluate(() => [player.look, player.hasAttribute("character-look")]), ["lines", false]);
    // A clip of the gallery over a slow line, then one from this machine at once.
    await page.locator("#link").selectOption("1200");
    await page.locator("#clips button", { hasText: "wink" }).click();
    await page.waitForFunction(() => player.received > 0 && player.received < player.total);
    await page.locator("#link").selectOption("0");
    await page.locator("#files").setInputFiles(args.clip);
    await page.waitForFunction((frames) => player.frames === frames && player.playable === frames, args.frames);
    assert.equal(await page.locator("#trouble").textContent(), "");
  },

  // A bank's clips are chosen by name; events are heard once each when their frames are passed.
  async bank(page) {
    await page.locator("#files").setInputFiles(args.bank);
    await page.waitForFunction(() => player.clips.length === 3 && player.playable === 30);
    await page.locator("#of-bank").selectOption("a longer one");
    await page.waitForFunction(() => player.playable === 200);
    assert.equal(await page.locator("#of-bank").inputValue(), "a longer one");
    await page.locator("#files").setInputFiles(args.events);
    await page.waitForFunction(() => player.events.length === 5 && player.playable === 40);
    assert.equal(await page.locator("#bank").isVisible(), false);
    await page.evaluate(() => {
      window.heard = [];
      player.addEventListener("heard", ({ detail }) => window.heard.push([detail.frame, detail.id]));
      player.pause();
      player.loop = false;
      player.seek(6);
      window.heard = [];
      player.step(1);
    });
    assert.deepEqual(await page.evaluate(() => window.heard.splice(0)), [[7, 3], [7, 1]]);
    await page.evaluate(() => (player.seek(0), (player.speed = 4), player.play()));
    await page.waitForFunction(() => player.paused && player.frame === 39);
    assert.deepEqual(await page.evaluate(() => window.heard.splice(0)), [[0, 0], [7, 3], [7, 1], [30, 9], [39, 0]]);
    await page.evaluate(() => ((player.backwards = true), player.play()));
    await page.waitForFunction(() => player.paused && player.frame === 0);
    assert.deepEqual(await page.evaluate(() => window.heard.splice(0)), [[39, 0], [30, 9], [7, 1], [7, 3], [0, 0]]);
    assert.match(await page.locator("#facts").textContent(), /5; last: left_foot_down at frame 0/);
  },

  // A range is played, looped and heard; the figure stands at a side of the picture.
  async range(page) {
    await page.locator("#files").setInputFiles(args.events);
    await page.waitForFunction(() => player.events.length === 5 && player.playable === 40);
    await page.evaluate(() => {
      const at = (frame) => (frame * player.facts.frameTime) / 1e9;
      Object.assign(window, { shown: [], heard: [], told: [] });
      player.pause();
      player.loop = false;
      player.seek(0);
      player.range(at(5), at(31));
      player.addEventListener("frame", () => window.shown.push(player.frame));
      player.addEventListener("heard", ({ detail }) => window.heard.push(detail.frame));
      for (const name of ["ended", "loop"]) player.addEventListener(name, () => window.told.push(name));
      Object.assign(player, { speed: 4, backwards: false });
      player.play();
    });
    const seen = () => page.evaluate(() => ({ shown: window.shown.splice(0), heard: window.heard.splice(0), told: window.told.splice(0) }));
    await page.waitForFunction(() => player.paused);
    let { shown, heard, told } = await seen();
    assert.deepEqual([shown[0], shown.at(-1), heard, told], [5, 30, [7, 7, 30], ["ended"]]);
    // Backwards in a loop, from a frame outside.
    await page.evaluate(() => (player.seek(35), Object.assign(player, { loop: true, backwards: true }), window.shown.splice(0), player.play()));
    await page.waitForFunction(() => window.told.length > 1);
    await page.evaluate(() => player.pause());
    ({ shown, heard, told } = await seen());
    assert.equal(shown[0], 30);
    assert.ok(shown.every((frame) => frame >= 5 && frame < 31), `${shown}`);
    assert.deepEqual([heard.slice(0, 6), told.slice(0, 2)], [[30, 7, 7, 30, 7, 7], ["loop", "loop"]]);
    // Attributes are the same; a clip that is loaded shows the range's start; without it all is played.
    await page.evaluate(async () => {
      Object.assign(player, { autoplay: false, from: 0.5 });
      await player.load("clips/walk.ptn");
    });
    assert.ok(Math.abs(await page.evaluate(() => player.currentTime) - 0.5) < 0.02);
    assert.deepEqual(await page.evaluate(() => (player.range(), [player.from, player.to])), [0, Infinity]);
    // How far the figure's middle is from the left, of the canvas's width; the ground goes from side to side. The picture is much wider than the figure.
    await page.evaluate(() => Object.assign(player.style, { flex: "none", height: "320px" }));
    for (const look of ["oled", "lines"]) {
      const [left, center, right] = await page.evaluate(async (look) => ((player.look = look), await player.picture(), ["left", "center", "right"].map((align) => {
        player.align = align;
        const { width, height } = player.canvas;
        const { data } = player.context.getImageData(0, 0, width, Math.floor(height / 2));
        const columns = [];
        // Bright ones: the ground is not.
        for (let at = 0; at < data.length; at += 4) if (data[at + 3] > 200 && (look === "oled" ? data[at] > 100 : true)) columns.push(((at / 4) % width) / width);
        return columns.sort((a, b) => a - b)[columns.length >> 1];
      })), look);
      assert.ok(left < 0.35 && Math.abs(center - 0.5) < 0.1 && right > 0.65, `${look}: ${[left, center, right]}`);
    }
    await page.evaluate(() => (player.removeAttribute("style"), (player.align = "center")));
  },

  // Pictures, GIFs and videos show what the player shows; their script is loaded only for them.
  async saves(page) {
    assert.equal(await page.evaluate(() => performance.getEntriesByName(`${location.origin}/pantin-export.js`).length), 0);
    const [width, height] = await page.evaluate(() => [player.canvas.width, player.canvas.height]);
    const file = async (id) => {
      const [download] = await Promise.all([page.waitForEvent("download"), page.locator(id).click()]);
      return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
    };
    const picture = await file("#save-picture");
    assert.equal(picture.name, "greet.png");
    assert.deepEqual([picture.bytes.readUInt32BE(16), picture.bytes.readUInt32BE(20)], [width, height]);
    await page.evaluate(() => player.range(0, 0.5));
    const gif = await file("#save-gif");
    assert.deepEqual([gif.name, gif.bytes.subarray(0, 6).toString(), gif.bytes.readUInt16LE(6)], ["greet.gif", "GIF89a", Math.min(480, width)]);
    for (const look of ["lines", "oled"]) {
      const differences = await page.evaluate(async (look) => {
        player.look = look;
        player.play();
        const size = { width: 256 };
        const blob = await player.record({ fps: 10, ...size });
        if (player.paused) throw new Error("it does not go on");
        player.pause();
        const decoder = new ImageDecoder({ data: await blob.arrayBuffer(), type: "image/gif" });
        await Promise.all([decoder.tracks.ready, decoder.completed]);
        if (decoder.tracks.selectedTrack.frameCount !== 5) throw new Error(`${decoder.tracks.selectedTrack.frameCount} pictures`);
        const pixels = (image, width, height) => {
          const context = Object.assign(document.createElement("canvas"), { width, height }).getContext("2d");
          context.drawImage(image, 0, 0);
          return context.getImageData(0, 0, width, height).data;
        };
        const differences = [];
        for (let frameIndex = 0; frameIndex < 5; frameIndex++) {
          const { image } = await decoder.decode({ frameIndex });
          if (image.duration !== 100000) throw new Error(`${image.duration} us`);
          player.currentTime = frameIndex / 10;
          const bitmap = await createImageBitmap(await player.picture(size));
          const [shown, expected] = [image, bitmap].map((one) => pixels(one, bitmap.width, bitmap.height));
          image.close();
          let [most, lit] = [0, 0];
          for (let at = 0; at < shown.length; at++) {
            most = Math.max(most, Math.abs(shown[at] - expected[at]));
            lit += Math.abs(expected[at] - expected[at % 4]) > 30;
          }
          differences.push([most, lit]);
        }
        return differences;
      }, look);
      assert.ok(differences.every(([most, lit]) => most <= 24 && lit > 100), `${look}: ${differences.join("; ")}`);
    }
    // A video: as long as its pictures last, and each of them where one seeks it, beyond the first picture that stands alone.
    await page.evaluate(() => player.range(0, 1.25));
    const video = await page.evaluate(async () => {
      player.look = "lines";
      const parts = [];
      const blob = await player.record({ type: "video/webm", fps: 20, progress: (part) => parts.push(part) });
      const video = Object.assign(document.createElement("video"), { src: URL.createObjectURL(blob), muted: true });
      await new Promise((done, failed) => Object.assign(video, { onloadeddata: done, onerror: () => failed(new Error(`no video: ${video.error.message}`)) }));
      const pixels = (image) => {
        const context = Object.assign(document.createElement("canvas"), { width: video.videoWidth, height: video.videoHeight }).getContext("2d");
        context.drawImage(image, 0, 0, video.videoWidth, video.videoHeight);
        return context.getImageData(0, 0, video.videoWidth, video.videoHeight).data;
      };
      const [shown, expected] = [[], []];
      for (let number = 0; number < 25; number++) {
        video.currentTime = (number + 0.5) / 20;
        await new Promise((done) => (video.onseeked = done));
        shown.push(pixels(video));
        player.currentTime = number / 20;
        expected.push(pixels(await createImageBitmap(await player.picture())));
      }
      const apart = (one, other) => one.reduce((all, value, at) => all + Math.abs(value - other[at]), 0) / one.length;
      const table = shown.map((image) => expected.map((other) => apart(image, other)));
      const nearest = table.map((row) => row.indexOf(Math.min(...row)));
      const most = Math.max(...table.map((row, number) => row[number]));
      const [type, ...failures] = [blob.type];
      for (const options of [{ type: "video/none" }, { signal: AbortSignal.abort() }]) failures.push(await player.record(options).then(() => "", (error) => error.name));
      return { facts: { width: video.videoWidth, seconds: video.duration, parts: [parts.length, parts.at(-1)], type, failures }, nearest, most };
    });
    assert.deepEqual(video.facts, { width: Math.ceil(width / 2) * 2, seconds: 1.25, parts: [25, 1], type: "video/webm", failures: ["TypeError", "AbortError"] });
    assert.deepEqual(video.nearest, [...Array(25).keys()]);
    assert.ok(video.most < 1.2, `a video's pictures are apart by ${video.most} of 255`);
    // Where there is no encoder, a recorder makes one, whatever else the machine does.
    const still = await page.evaluate(async () => {
      const encoder = globalThis.VideoEncoder;
      delete globalThis.VideoEncoder;
      const blob = await player.record({ type: "video/webm", to: 0.5 });
      globalThis.VideoEncoder = encoder;
      const video = Object.assign(document.createElement("video"), { src: URL.createObjectURL(blob), muted: true });
      await new Promise((done, failed) => Object.assign(video, { onloadeddata: done, onerror: () => failed(new Error(`no video of a recorder: ${video.error.message}`)) }));
      return video.videoWidth;
    });
    assert.equal(still, Math.ceil(width / 2) * 2);
    // A page in one file shows its clip without another request: of segments, and of keys with a face.
    for (const name of ["walk", "greet"]) {
      const alone = await page.context().newPage();
      alone.on("pageerror", (error) => page.troubles.push(error.message));
      await alone.addInitScript(HELPERS);
      const requests = [];
      alone.on("request", (request) => request.url().startsWith("http") && requests.push(new URL(request.url()).pathname));
      await alone.goto(`${args.site}${name}.html`);
      await alone.waitForFunction(() => document.querySelector("pantin-player").playable === 160);
      assert.equal(await alone.evaluate(() => window.seen(document.querySelector("pantin-player")).colours > 10), true);
      assert.deepEqual(requests, [`/${name}.html`]);
      await alone.close();
    }
    // A character: its next seconds.
    assert.ok(await page.evaluate(async () => (await character.record({ seconds: 0.4, width: 100 })).size) > 500);
  },

  // The names and promises of a media element.
  async media(page) {
    const events = await page.evaluate(async (file) => {
      const same = (got, expected, what) => {
        if (JSON.stringify(got) !== JSON.stringify(expected)) throw new Error(`${what}: ${JSON.stringify(got)} in place of ${JSON.stringify(expected)}`);
      };
      const outcome = (promise) => promise.then(() => "", (error) => error.name);
      const made = (attributes) => {
        const one = document.createElement("pantin-player");
        for (const [name, value] of Object.entries(attributes)) one.setAttribute(name, value);
        document.body.prepend(one);
        return one;
      };
      const one = made({ lang: "de", "aria-label": "eine Frau geht", poster: "data:image/gif;base64,R0lGODlhAQABAAAAACwAAAAAAQABAAA=" });
      scrollTo(0, 0);
      same([one.readyState, one.error, one.ended, one.seeking, one.currentSrc, one.currentTime, Number.isNaN(one.duration)], [0, null, false, false, "", 0, true], "without a clip");
      const told = [];
      const names = ["loadstart", "durationchange", "loadedmetadata", "loadeddata", "canplay", "canplaythrough", "play", "playing", "seeked", "ratechange", "pause", "ended", "emptied", "error"];
      for (const name of names) one.addEventListener(name, () => told.push(name));
      // Playing begins once there is a clip; pausing before rejects.
      const [early, other] = [one.play(), made({})];
      const never = outcome(other.play());
      other.pause();
      other.remove();
      same(await never, "AbortError", "paused before");
      one.src = "clips/run.ptn";
      same([await outcome(early), one.paused, one.error], ["", false, null], "play() before a clip");
      one.pause();
      same(one.readyState >= 2, true, "readyState");
      while (one.readyState < 4) await new Promise((go) => setTimeout(go, 10));
      one.currentTime = 0.5;
      same([one.currentTime, one.seeking], [0.5, false], "currentTime");
      one.currentTime = 1e9;
      same([one.currentTime, one.frame], [one.duration, one.frames - 1], "currentTime past the end");
      one.playbackRate = 8;
      same([one.playbackRate, one.speed], [8, 8], "playbackRate");
      const ended = new Promise((go) => one.addEventListener("ended", go, { once: true }));
      one.currentTime = 0;
      same(await outcome(one.play()), "", "play()");
      await ended;
      same([one.ended, one.paused], [true, true], "ended");
      one.seek(0);
      same(one.ended, false, "ended after a seek");
      // Its words.
      const [label] = [one.button, one.scrubber].map((part) => part.getAttribute("aria-label"));
      same([label, one.stage.getAttribute("aria-label")], ["Abspielen", "eine Frau geht"], "words");
      same(/^0\.00 von \d\.\d\d Sekunden$/.test(one.scrubber.getAttribute("aria-valuetext")), true, "the slider's text");
      // A segment lies between two markers.
      await one.load(Uint8Array.from(atob(file), (letter) => letter.charCodeAt(0)));
      const [first] = one.events.filter(({ name }) => name);
      Object.assign(one, { segment: first.name, playbackRate: 4 });
      const end = one.events.find(({ frame }) => frame > first.frame).frame;
      const shown = [];
      one.addEventListener("frame", () => shown.push(one.frame));
      const over = new Promise((go) => one.addEventListener("ended", go, { once: true }));
      one.seek(one.frames - 1);
      shown.length = 0;
      one.play();
      await over;
      same([shown[0], shown.at(-1)], [first.frame, end - 1], "segment");
      // What is no good.
      one.src = "clips/none.ptn";
      const failed = outcome(one.play());
      same([await failed, one.error instanceof Error, one.readyState], ["Error", true, 0], "a clip that is not there");
      one.remove();
      // Eager is the other word for loading; what is lazy waits until it comes near the screen.
      const far = document.createElement("div");
      far.style.cssText = "position: absolute; top: 30000px";
      document.body.append(far);
      const late = document.createElement("pantin-player");
      same(late.loading, "eager", "loading");
      Object.assign(late, { loading: "lazy", src: "clips/run.ptn" });
      far.append(late);
      await new Promise((go) => setTimeout(go, 300));
      same([late.loading, late.readyState, late.received], ["lazy", 0, 0], "lazy, far away");
      late.scrollIntoView();
      while (late.readyState < 4) await new Promise((go) => setTimeout(go, 10));
      far.remove();
      scrollTo(0, 0);
      // Its poster, as an attribute and as an element in the slot, until the first frame is there.
      const seen = (image) => getComputedStyle(image.assignedSlot ?? image).display !== "none";
      const posted = made({ poster: "data:image/gif;base64,R0lGODlhAQABAAAAACwAAAAAAQABAAA=" });
      const image = posted.stage.querySelector("img");
      same([seen(image), posted.poster.length > 10], [true, true], "poster");
      const slotted = made({});
      slotted.innerHTML = "<img slot=poster alt=''>";
      same(seen(slotted.firstChild), true, "the poster's slot");
      for (const player of [posted, slotted]) await player.load("clips/run.ptn");
      same([seen(image.parentElement), seen(slotted.firstChild)], [false, false], "posters after the first frame");
      [posted, slotted].forEach((player) => player.remove());
      // Cookies are sent to other origins where they are asked for.
      const { fetch } = window;
      const sent = [];
      // The gallery's pictures fetch clips, too, as they come near.
      const clip = "clips/run.ptn?asked";
      window.fetch = (what, options) => (String(what).endsWith(clip) && sent.push(options.credentials), fetch(what, options));
      for (const crossorigin of [null, "anonymous", "use-credentials"]) {
        const asked = made(crossorigin === null ? {} : { crossorigin });
        same(asked.crossOrigin, crossorigin, "crossOrigin");
        await asked.load(clip);
        asked.remove();
      }
      window.fetch = fetch;
      same(sent, ["same-origin", "same-origin", "include"], "credentials");
      // In Russian, and in a language that it does not know.
      for (const [lang, words] of [["ru", ["Воспроизвести", "Во весь экран", "Время"]], ["fr", ["Play", "Full screen", "Time"]]]) {
        const spoken = made({ lang });
        const labels = () => [spoken.button, spoken.shadowRoot.querySelector(".full"), spoken.scrubber].map((part) => part.getAttribute("aria-label"));
        for (let turns = 0; turns < 100 && labels().join() !== words.join(); turns++) await new Promise((go) => setTimeout(go, 20));
        same(labels(), words, lang);
        spoken.remove();
      }
      return told;
    }, readFileSync(args.events).toString("base64"));
    // Markers: ticks of the scrubber, with their names in its text, and keys that go to them.
    await page.evaluate(async (file) => {
      await player.load(Uint8Array.from(atob(file), (letter) => letter.charCodeAt(0)));
      player.pause();
    }, readFileSync(args.events).toString("base64"));
    const ticks = page.locator("#player input[list=markers] + datalist option");
    await page.waitForFunction(() => player.shadowRoot.querySelectorAll("datalist option").length);
    const marks = await ticks.evaluateAll((all) => all.map((one) => [+one.value, one.label]));
    assert.deepEqual(marks.map(([frame]) => frame), [...new Set(await page.evaluate(() => player.events.map(({ frame }) => frame).sort((a, b) => a - b)))]);
    await page.evaluate(() => player.seek(1));
    await page.locator("#player .stage").focus();
    for (const [key, frame] of [["n", marks.find(([frame]) => frame > 1)[0]], ["p", marks.findLast(([frame]) => frame < marks.find(([frame]) => frame > 1)[0])[0]], ["p", marks.at(-1)[0]], ["n", marks[0][0]]]) {
      await page.keyboard.press(key);
      assert.equal((await state(page)).frame, frame, `${key} leads to ${frame}`);
      const [, name] = marks.find(([at]) => at === frame);
      const text = await page.locator("#player input").getAttribute("aria-valuetext");
      assert.ok(text.endsWith(`seconds, ${name}`), `${text}, marker ${name} at ${frame}`);
    }
    const box = await page.locator("#player input").boundingBox();
    await page.locator("#player input").hover({ position: { x: box.width - 2, y: box.height / 2 } });
    await page.waitForFunction((name) => player.scrubber.title === name, marks.at(-1)[1]);
    // The whole screen, and back; the key does it, too.
    const full = page.locator("#player .bar .full");
    assert.equal(await full.getAttribute("aria-label"), "Full screen");
    const fills = (it) => page.waitForFunction((it) => (document.fullscreenElement === player) === it, it);
    await full.click();
    await fills(true);
    await full.click();
    await fills(false);
    await page.locator("#player .stage").focus();
    await page.keyboard.press("f");
    await fills(true);
    await page.keyboard.press("f");
    await fills(false);
    page.troubles = page.troubles.filter((trouble) => !/404/.test(trouble));
    assert.deepEqual(events.slice(0, 6), ["play", "loadstart", "durationchange", "loadedmetadata", "loadeddata", "canplay"]);
    for (const name of ["playing", "canplaythrough", "seeked", "ratechange", "pause", "ended", "emptied", "error"]) assert.ok(events.includes(name), name);
  },

  // A key clip does all that other clips do, and its module is fetched for it alone.
  async keys(page) {
    const fetched = () => page.evaluate(() => performance.getEntriesByName(`${location.origin}/pantin-keys.js`).length);
    await page.waitForFunction(() => player.readyState === 4);
    assert.equal(await fetched(), 0, "clips of segments do without it");
    // While it arrives there is nothing to show; then there is all of it, and playing that was asked for begins.
    await page.evaluate((clip) => {
      window.log = [];
      ["progress", "ready"].forEach((name) => player.addEventListener(name, () => window.log.push([player.received < player.total, player.playable])));
      player.pause();
      player.look = "oled";
      player.loop = false;
      window.loaded = player.load(clip);
      player.currentTime = 0.1;
    }, args.slow);
    await page.waitForFunction(() => player.received > 0 && player.received < player.total);
    assert.match(await said(page), /^\d+ bytes; the first pose is still to come$/);
    await page.evaluate(() => window.loaded);
    const log = await page.evaluate(() => window.log);
    const { frames } = await state(page);
    assert.ok(log.length > 3 && log.every(([isArriving, playable]) => playable === 0 || (playable === frames && !isArriving)), JSON.stringify(log));
    assert.equal(log.at(-1)[1], frames);
    assert.ok((await state(page)).frame > 1, "a time that was set before it came");
    assert.equal(await fetched(), 1);
    // Every frame, however it is reached.
    assert.equal(await load(page, args.clip), "");
    await page.evaluate(async () => {
      player.pause();
      player.autoplay = false;
      await player.picture();
      const pictures = Array.from({ length: player.frames }, (_, frame) => (player.seek(frame), window.greys(player)));
      if (new Set(pictures).size < player.frames / 2) throw new Error("its pictures do not change");
      const is = (what) => {
        if (window.greys(player) !== pictures[player.frame]) throw new Error(`${what}: frame ${player.frame}`);
      };
      for (let count = 0; count < 40; count++) player.step(1), is("steps");
      for (let count = 0; count < 60; count++) player.step(-1), is("steps back");
      for (const frame of [99, 3, 98, player.frames - 1, 0, 1e9, -4]) player.seek(frame), is("seeks");
      window.is = is;
    });
    // A range in a loop, forwards and backwards.
    for (const backwards of [false, true]) {
      const shown = await page.evaluate(async (backwards) => {
        const at = (frame) => (frame * player.facts.frameTime) / 1e9;
        const shown = [];
        const note = () => (shown.push(player.frame), window.is("a range"));
        player.range(at(20), at(31));
        Object.assign(player, { loop: true, backwards });
        player.addEventListener("frame", note);
        let laps = 0;
        const lap = () => laps++;
        player.addEventListener("loop", lap);
        await player.play();
        while (laps < 2) await new Promise((go) => setTimeout(go, 10));
        player.pause();
        player.removeEventListener("frame", note);
        player.removeEventListener("loop", lap);
        player.range();
        player.backwards = false;
        return shown;
      }, backwards);
      assert.ok(shown.length > 1 && shown.every((frame) => frame >= 20 && frame < 31), `${shown}`);
    }
    // Its other looks, and what is saved of it.
    for (const look of ["lines", "solid"]) {
      const saved = await page.evaluate(async (look) => {
        player.look = look;
        const { size } = await player.record({ fps: 5, width: 100, from: 0, to: 1 });
        return [size > 1000, window.seen(player).colours > 10];
      }, look);
      assert.deepEqual(saved, [true, true], look);
    }
    // Events of one with scalars alone, a bank of them, and one whose rules are broken, which rests.
    assert.equal(await load(page, args.events), "");
    const heard = await page.evaluate(async () => {
      const heard = [];
      player.addEventListener("heard", ({ detail }) => heard.push([detail.frame, detail.name]));
      for (let frame = 0; frame < 30; frame++) player.step(1);
      return heard;
    });
    assert.deepEqual(heard, [[12, "left_foot_down"], [29, ""], [0, "left_foot_down"], [0, "clap"]].map(([frame, name]) => [frame, name]));
    assert.equal(await load(page, args.bank), "");
    const names = await page.evaluate(() => player.clips);
    for (const name of names) {
      assert.equal(await load(page, `${args.bank}#${name}`), "");
      assert.ok(await page.evaluate(() => player.playable === player.frames && player.facts.moving > 0), name);
    }
    assert.equal(await load(page, args.malformed), "");
    assert.deepEqual(await page.evaluate(() => [player.playable === player.frames, player.facts.moving]), [true, 0]);
    // What ends early shows nothing, and what comes next plays.
    assert.match(await load(page, args.truncated), /ends early/);
    assert.equal((await state(page)).playable, 0);
    assert.equal(await load(page, args.clip), "");
    assert.equal((await state(page)).playable > 100, true);
  },

  // Characters of the solid figure: by text and compiled; another one, none, and what is no good.
  async looks(page) {
    const fetched = () => page.evaluate(() => performance.getEntriesByName(`${location.origin}/pantin-looks.js`).length);
    const outcome = await page.evaluate(async ({ compiled }) => {
      Object.assign(player, { autoplay: false, loop: false });
      player.pause();
      await player.load("clips/walk.ptn");
      player.seek(30);
      player.look = "solid";
      await player.picture();
      const plain = window.seen(player).hash;
      const counted = performance.getEntriesByName(`${location.origin}/pantin-looks.js`).length;
      // The picture once it is another one than these.
      const shown = async (...others) => {
        for (let turns = 0; others.includes(window.seen(player).hash); turns++) {
          if (turns > 250) throw new Error("the picture stays");
          await new Promise((go) => setTimeout(go, 20));
        }
        return window.seen(player).hash;
      };
      const wear = (look) => (look ? player.setAttribute("character-look", look) : player.removeAttribute("character-look"));
      const has = (color, { canvas, context } = player) => {
        const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
        for (let at = 0; at < data.length; at += 4) if (color.every((value, index) => Math.abs(value - data[at + index]) < 3)) return true;
        return false;
      };
      wear("clips/cat.look");
      const cat = await shown(plain);
      const muzzle = has([0xff, 0xf0, 0xdc]);
      wear("clips/dancer.look");
      const dancer = await shown(plain, cat);
      wear(compiled);
      const again = await shown(dancer);
      wear(null);
      const none = await shown(again);
      // One that is set before the clip is there when it is.
      const other = document.createElement("pantin-player");
      other.style.width = getComputedStyle(player).width;
      other.setAttribute("look", "solid");
      other.setAttribute("character-look", "clips/ranger.look");
      document.body.prepend(other);
      await other.load("clips/walk.ptn");
      const [first, ranger] = [window.seen(other).hash, (await other.picture(), window.seen(other).hash)];
      // A character that is steered has it as a clip does, and lines again after it.
      other.setAttribute("character-look", "clips/cat.look");
      await other.load("clips/character.ptb");
      const ears = [];
      for (const look of ["solid", "lines", "solid"]) {
        other.look = look;
        await other.picture();
        other.hold("go");
        other.advance(2);
        ears.push(has([0xff, 0xf0, 0xdc], other));
      }
      other.remove();
      const told = [];
      player.addEventListener("error", ({ detail }) => told.push(detail));
      const troubles = [];
      for (const look of ["clips/none.look", "clips/walk.ptn", "extra/wrong.look", "http://["]) {
        wear(look);
        while (told.length <= troubles.length) await new Promise((go) => setTimeout(go, 20));
        await new Promise((go) => setTimeout(go, 50));
        troubles.push([player.trouble, window.seen(player).hash === plain, player.shadowRoot.querySelector("p").textContent === player.trouble]);
      }
      // An attribute without a name is none; another one takes back what was said.
      wear("clips/none.look");
      player.setAttribute("character-look", "");
      await player.picture();
      wear("clips/cat.look");
      await shown(plain);
      const { trouble } = player;
      await new Promise((go) => setTimeout(go, 50));
      return { counted, muzzle, ears, isSame: again === cat, isPlain: none === plain, isThere: first === ranger, troubles, told: told.length, trouble, status: player.shadowRoot.querySelector("p").textContent };
    }, args);
    page.troubles = page.troubles.filter((trouble) => !/404/.test(trouble));
    assert.deepEqual(outcome.ears, [true, false, true]);
    assert.deepEqual([outcome.counted, outcome.muzzle, outcome.isSame, outcome.isPlain, outcome.isThere], [0, true, true, true, true]);
    assert.equal(await fetched(), 1);
    const words = [/^clips\/none\.look: 404$/, /^clips\/walk\.ptn: line 1: expected one of radius, outline, colour, attach$/, /^extra\/wrong\.look: line 3: expected a whole number from 1 to 200$/, /^http:\/\/\[: /];
    outcome.troubles.forEach(([trouble, isPlain, isSaid], index) => {
      assert.match(trouble, words[index]);
      assert.deepEqual([isPlain, isSaid], [true, true], trouble);
    });
    assert.deepEqual([outcome.told >= 4, outcome.trouble, outcome.status], [true, "", ""]);
  },

  // The silhouettes of solid figures: a bit for each pixel, row by row.
  async silhouettes(page) {
    return page.evaluate(async ({ parts, size: [width, height] }) => {
      const [{ openRawClip }, { figureOf, visitor }, { solidOf, dressed }] = await Promise.all(["source/clip.js", "source/figure.js", "pantin-solid.js"].map((script) => import(`/${script}`)));
      const { keys } = await import("/pantin-keys.js");
      const context = Object.assign(document.createElement("canvas"), { width, height }).getContext("2d", { willReadFrequently: true });
      // The ground is drawn in the paper's color, which no part has.
      const paper = [4, 255, 4, 255];
      const tones = [paper, [0, 0, 0, 255], [255, 160, 60, 255], [80, 190, 255, 255], null, null, paper];
      const pictures = [];
      for (const { clip: file, look, frames, orbit, tilt } of parts) {
        const player = openRawClip(await (await fetch(file)).arrayBuffer(), undefined, false, { keys }).play();
        const { clip } = player;
        const wearer = { trouble: "", getAttribute: () => look, dispatchEvent: ({ detail }) => { throw new Error(detail); } };
        await dressed(wearer);
        const figure = figureOf(clip, player.raw);
        const solid = solidOf(clip, figure, undefined, wearer);
        const visit = visitor(clip, clip.frames, (frame) => player.seek(frame).raw);
        figure.aim(width, height, orbit, tilt, true, undefined, visit, solid.cover);
        solid.learn(visit, clip.frames);
        pictures.push(frames.map((frame) => {
          figure.place(player.seek(frame).raw);
          context.fillStyle = `rgb(${paper.slice(0, 3)})`;
          context.fillRect(0, 0, width, height);
          solid.draw(context, tones, height, 0);
          const { data } = context.getImageData(0, 0, width, height);
          const bits = new Uint8Array(Math.ceil((width * height) / 8));
          for (let at = 0; at < width * height; at++) {
            const [red, green, blue] = data.subarray(4 * at);
            if (green < 128 || red > 64 || blue > 64) bits[at >> 3] |= 1 << (at & 7);
          }
          return btoa(String.fromCharCode(...bits));
        }));
      }
      return pictures;
    }, args);
  },

  // No fault that axe-core knows, at three sizes, in light and dark, with and without a result; letters of at least 14 pixels; nothing wider than the page.
  async accessible(page, browser) {
    const axe = createRequire(`${process.env.PLAYWRIGHT}/`).resolve("axe-core");
    const faults = [];
    for (const width of [390, 768, 1280]) {
      for (const colorScheme of ["light", "dark"]) {
        const one = await opened(browser, { viewport: { width, height: 844 }, colorScheme, reducedMotion: "reduce" });
        await one.waitForFunction(() => character.states.length && document.querySelector("#graph svg"));
        await one.evaluate(() => document.querySelector("#face").scrollIntoView());
        await one.waitForFunction(() => document.querySelectorAll("#emotes button").length === 23 && face.readyState === 4);
        await one.addScriptTag({ path: axe });
        const check = async (what) => {
          const found = await one.evaluate(async () => {
            document.querySelector("#fold").open = true;
            const { violations } = await window.axe.run();
            const all = [document, ...[...document.querySelectorAll("pantin-player")].map((player) => player.shadowRoot)].flatMap((root) => [...root.querySelectorAll("*")]);
            const small = all.filter((element) => {
              const text = [...element.childNodes].some((node) => node.nodeType === 3 && node.data.trim());
              if (!text || ["SCRIPT", "STYLE", "TITLE", "OPTION"].includes(element.tagName.toUpperCase()) || !element.getClientRects().length) return false;
              const scale = element.getScreenCTM?.()?.a ?? 1;
              return parseFloat(getComputedStyle(element).fontSize) * scale < 14;
            });
            return [
              ...violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target.join(" ")).slice(0, 3).join("; ")}`),
              ...small.slice(0, 5).map((element) => `small letters: ${element.tagName} ${element.textContent.slice(0, 30)}`),
              ...(document.documentElement.scrollWidth > innerWidth ? [`${document.documentElement.scrollWidth} pixels wide`] : []),
            ];
          });
          faults.push(...found.map((fault) => `${width} ${colorScheme} ${what}: ${fault}`));
        };
        await check("page");
        await one.evaluate(() => (document.querySelector("#edit").open = true));
        await one.waitForFunction(() => document.querySelector("#machine-said").textContent.startsWith("16 states"));
        await check("the text of the state machine");
        if (args.folder) await one.locator("#steer").screenshot({ path: `${args.folder}/machine-${width}-${colorScheme}.png` });
        await one.locator("#machine-text").fill(`${await one.locator("#machine-text").inputValue()}\n[[state]]\nname = "fly"\n`);
        await one.waitForFunction(() => document.querySelector("#machine-said").textContent.startsWith("Line "));
        await check("a wrong text of the state machine");
        if (args.folder) await one.locator("#steer").screenshot({ path: `${args.folder}/machine-wrong-${width}-${colorScheme}.png` });
        await one.evaluate(() => (document.querySelector("#edit").open = false));
        await one.evaluate(() => scrollTo(0, document.body.scrollHeight));
        await one.context().grantPermissions([]);
        await one.locator("#microphone").click();
        await one.waitForFunction(() => document.querySelector("#face-why").textContent.startsWith("The face cannot speak"));
        await check("a face without a microphone");
        await one.evaluate(() => (document.querySelector("#fold").open = false));
        if (args.folder) await one.screenshot({ path: `${args.folder}/page-${width}-${colorScheme}.png`, fullPage: true });
        if (width === 390) {
          await one.locator("#effort").selectOption("fast");
          await one.locator("#try").click();
          await one.waitForFunction(() => !document.querySelector("#result").hidden && converted.readyState === 4);
          await check("a result");
          if (args.folder) await one.screenshot({ path: `${args.folder}/result-${width}-${colorScheme}.png`, fullPage: true });
        }
        assert.deepEqual(one.troubles, []);
        await one.context().close();
      }
    }
    assert.deepEqual(faults, []);
  },

  // The page's lips for its own sentence, noise and strange sound at several rates: samples of 16 bits, and the weights after each part of them.
  async talk(page) {
    return page.evaluate(async () => {
      const [{ Talk, samplesOf }, { sentence }] = await Promise.all([import("./talk.js"), import("./speech.js")]);
      const base64 = (samples) => btoa(Array.from(new Uint8Array(Int16Array.from(samples).buffer), (byte) => String.fromCharCode(byte)).join(""));
      const cases = [];
      const add = (name, rate, samples, part, ms) => {
        const talk = new Talk(rate);
        const weights = [];
        for (let at = 0; at < samples.length; at += part) {
          talk.push(samples.slice(at, at + part));
          talk.step(ms);
          weights.push([...talk.weights]);
        }
        cases.push({ name, rate, part, ms, samples: base64(samples), weights });
      };
      for (const rate of [16000, 44100]) {
        const context = new OfflineAudioContext(1, 4 * rate, rate);
        const [heard] = sentence(context);
        heard.connect(context.destination);
        add("sentence", rate, samplesOf((await context.startRendering()).getChannelData(0)), Math.round(rate / 100), 10);
      }
      let random = 7;
      const noise = () => (random = (Math.imul(random, 1664525) + 1013904223) | 0) >> 16;
      const list = (length, of) => Array.from({ length }, (_, index) => of(index));
      for (const rate of [8000, 11025, 22050, 48000]) {
        add("noise", rate, list(rate, noise), 97, 3);
        add("soft noise", rate, list(rate, () => noise() >> 8), 480, 20);
        add("the largest steps", rate, list(rate, (index) => ((index >> (1 + (index >> 11))) & 1 ? 32767 : -32768)), 333, 7);
        add("a tone that rises", rate, list(2 * rate, (index) => Math.round(20000 * Math.sin((index * index * 0.8) / rate))), 128, 3);
        add("gaps", rate, list(rate, (index) => ((index >> 10) & 1 ? noise() >> 2 : 0)), 64, 0);
      }
      return cases;
    });
  },

  // The face: emotes, a sentence, a microphone that is refused, and one that hears what a file has.
  async faces(page, browser) {
    const ready = async (page) => {
      await page.evaluate(() => document.querySelector("#face").scrollIntoView({ block: "center" }));
      await page.waitForFunction(() => document.querySelectorAll("#emotes button").length === 23 && face.readyState === 4);
    };
    const pressed = (page) => page.locator(".face button[aria-pressed=true]").evaluateAll((all) => all.map((one) => one.dataset.name ?? one.id));
    await ready(page);
    await page.waitForFunction(() => !face.paused);
    assert.deepEqual(await pressed(page), ["happy"]);
    const names = await page.locator("#emotes button").evaluateAll((all) => all.map((one) => one.dataset.name));
    const seen = new Set();
    for (const name of names) {
      await page.locator(`#emotes [data-name=${name}]`).click();
      await page.waitForFunction((name) => document.querySelector("#emote-size").textContent.startsWith(`${name}: `) && face.src === null && face.readyState === 4, name);
      assert.deepEqual(await pressed(page), [name]);
      seen.add(await page.evaluate(() => (face.pause(), face.seek(face.frames >> 1), window.seen(face).hash)));
    }
    assert.equal(seen.size, 23, "each emote is another picture");
    // Speech is fetched when it is asked for, moves the mouth, and ends by itself.
    const fetched = () => page.evaluate(() => performance.getEntriesByType("resource").map(({ name }) => name).filter((name) => /(speech|talk)\.js$/.test(name)).length);
    assert.equal(await fetched(), 0);
    const watch = (page) => page.evaluate(() => {
      window.visemes = new Set();
      new MutationObserver(() => window.visemes.add(document.querySelector("#viseme").textContent)).observe(document.querySelector("#viseme"), { childList: true });
    });
    await watch(page);
    await page.locator("#sentence").click();
    await page.waitForFunction(() => [...window.visemes].some((text) => text));
    assert.deepEqual(await pressed(page), ["sentence"]);
    assert.ok((await fetched()) > 0);
    await page.waitForFunction(() => document.querySelector("#sentence").getAttribute("aria-pressed") === "false" && face.frames > 1);
    assert.deepEqual(await pressed(page), ["winking"]);
    // An emote ends it.
    await page.locator("#sentence").click();
    await page.waitForFunction(() => face.frames === 1);
    await page.locator("#emotes [data-name=sad]").click();
    await page.waitForFunction(() => document.querySelector("#emote-size").textContent.startsWith("sad: ") && document.querySelector("#sentence").getAttribute("aria-pressed") === "false");
    // A microphone that is refused, and one that hears what a file has.
    const sounds = ["--use-fake-device-for-media-stream", `--use-file-for-fake-audio-capture=${args.sound}`];
    const other = await chromium.launch({ ...LAUNCH, args: [...LAUNCH.args, ...sounds] });
    try {
      const one = await opened(other, { reducedMotion: "reduce" });
      await ready(one);
      await one.context().grantPermissions([]);
      await one.locator("#microphone").click();
      await one.waitForFunction(() => document.querySelector("#face-why").textContent.includes("not allowed to use the microphone"));
      await one.waitForFunction(() => document.querySelector("#microphone").getAttribute("aria-pressed") === "false" && face.frames > 1);
      await one.context().grantPermissions(["microphone"]);
      assert.equal(await one.evaluate(() => face.paused), true);
      await watch(one);
      await one.locator("#microphone").click();
      await one.waitForFunction(() => window.visemes.has("\u201caa\u201d"));
      assert.match(await one.locator("#face-why").textContent(), /follows the microphone/);
      await one.locator("#microphone").click();
      await one.waitForFunction(() => document.querySelector("#microphone").getAttribute("aria-pressed") === "false" && face.frames > 1);
      assert.equal(await one.locator("#face-why").textContent(), "");
      // Without worklets, as on a page that is not served by https.
      await one.evaluate(() => Object.defineProperty(BaseAudioContext.prototype, "audioWorklet", { value: undefined }));
      await one.evaluate(() => window.visemes.clear());
      await one.locator("#microphone").click();
      await one.waitForFunction(() => window.visemes.has("\u201caa\u201d"));
      await one.locator("#microphone").click();
      assert.deepEqual(one.troubles, []);
      // What the browser does not give is greyed.
      const none = await patient(other, {});
      await none.addInitScript(() => Object.defineProperty(navigator, "mediaDevices", { value: undefined }));
      const bare = await none.newPage();
      await bare.goto(args.site);
      await ready(bare);
      assert.equal(await bare.locator("#microphone").isDisabled(), true);
      assert.match(await bare.locator("#face-why").textContent(), /Greyed: .* over https/);
      assert.equal(await bare.locator("#sentence").isDisabled(), false);
    } finally {
      await other.close();
    }
    // What is offered to take along is there.
    for (const name of ["pantin-lvgl.zip", "pantin-arduino.zip"]) {
      const [download] = await Promise.all([page.waitForEvent("download"), page.locator(`.face a[href="${name}"]`).click()]);
      assert.equal(readFileSync(await download.path()).subarray(0, 2).toString(), "PK", name);
    }
  },

  // The network goes away, and the page stays: from a folder of a server, and a newer build takes the older one's place.
  async offline(page, browser) {
    let build = "";
    let asked = 0;
    const server = createServer(async ({ url, headers }, response) => {
      asked++;
      const path = url.replace("/some/folder/", "");
      const found = url.startsWith("/some/folder/") ? await fetch(args.site + path, { headers: { ...headers, host: new URL(args.site).host, "accept-encoding": "identity" } }) : { status: 404, headers: new Headers(), arrayBuffer: () => new ArrayBuffer() };
      let body = Buffer.from(await found.arrayBuffer());
      if (path === "offline.js" && build) body = Buffer.from(body.toString().replace(/[0-9a-f]{16}/g, build));
      response.writeHead(found.status, { "content-type": found.headers.get("content-type") ?? "text/plain", "cache-control": "no-store" }).end(body);
    });
    const listening = (port) => new Promise((go) => server.listen(port, "127.0.0.1", go));
    await listening(0);
    const { port } = server.address();
    const stop = () => new Promise((go) => (server.close(go), server.closeAllConnections()));
    const context = await patient(browser, { serviceWorkers: "allow", viewport: { width: 1280, height: 900 } });
    const one = await context.newPage();
    const site = `http://127.0.0.1:${port}/some/folder/`;
    const caches = () => one.evaluate(async () => Promise.all((await window.caches.keys()).map(async (name) => [name, (await (await window.caches.open(name)).keys()).length])));
    await one.goto(site);
    await one.evaluate(() => navigator.serviceWorker.ready);
    await one.waitForFunction(() => navigator.serviceWorker.controller);
    const [[first, kept], ...others] = await caches();
    assert.ok(kept > 50 && !others.length, `${kept} files are kept`);
    assert.ok(first.includes(site));
    // A file that the page needs only later is kept once it was there.
    const later = () => one.evaluate(async () => (await fetch("clips/run.bvh")).text().then((text) => text.length, () => 0));
    const length = await later();
    assert.ok(length > 1000);
    await one.waitForFunction((kept) => window.caches.keys().then(([name]) => window.caches.open(name)).then((cache) => cache.keys()).then(({ length }) => length === kept + 1), kept);
    await stop();
    asked = 0;
    for (const address of [site, `${site}index.html`, `${site}?clip=run`]) {
      await one.goto(address);
      await one.waitForFunction(() => document.querySelector("#player").playable > 1 && document.querySelector("#character").states.length);
      assert.ok((await one.evaluate((helpers) => (eval(`(${helpers})()`), window.seen(player).colours), HELPERS.toString())) > 3, "the figure is there");
    }
    assert.equal(await one.evaluate(() => player.facts.frames), 26, "the clip that the address names");
    assert.equal(await later(), length);
    await one.evaluate(() => document.querySelector("#face").scrollIntoView());
    await one.waitForFunction(() => document.querySelectorAll("#emotes button").length === 23 && face.readyState === 4);
    // The text of the state machine and its compiler are kept from the start on.
    await one.locator("#edit summary").click();
    await one.waitForFunction(() => document.querySelector("#machine-said").textContent.startsWith("16 states, 29 transitions"));
    await one.locator("#machine-text").evaluate((text) => {
      text.value += '\n[[any]]\nto = "bow"\ninput = "greet"\n';
      text.dispatchEvent(new Event("input"));
    });
    await one.waitForFunction(() => document.querySelector("#machine-said").textContent.startsWith("16 states, 30 transitions"));
    await one.locator("#inputs").getByRole("button", { name: "greet" }).click();
    await one.waitForFunction(() => document.querySelector("#character").state === "bow");
    assert.equal(asked, 0);
    // Another build: its files are kept in place of the older ones.
    build = "0123456789abcdef";
    await listening(port);
    await one.goto(site);
    await one.waitForFunction((build) => window.caches.keys().then((names) => names.length === 1 && names[0].endsWith(build)), build);
    await stop();
    await one.reload();
    await one.waitForFunction(() => document.querySelector("#player").playable > 1);
  },

  // Who wants less motion gets none before asking, and a button to ask with.
  async quiet(page, browser) {
    const still = await opened(browser, { reducedMotion: "reduce", colorScheme: "dark" });
    await still.waitForTimeout(300);
    assert.equal((await state(still)).paused, true);
    // The character has no bar: the button in its picture starts it and stops it.
    await still.evaluate(() => scrollTo(0, 0));
    await still.waitForFunction(() => character.states.length);
    const big = still.locator("#character button.big");
    assert.equal(await big.isVisible(), true);
    assert.equal(await big.getAttribute("aria-label"), "Play");
    await big.click();
    assert.equal(await still.evaluate(() => character.paused), false);
    assert.equal(await big.getAttribute("aria-label"), "Pause");
    await big.click();
    assert.equal(await still.evaluate(() => character.paused), true);
    const dark = await still.evaluate(() => window.seen(player));
    assert.ok(dark.colours > 10);
    await still.emulateMedia({ colorScheme: "light" });
    await still.waitForFunction((hash) => window.seen(player).hash !== hash, dark.hash);
    assert.deepEqual(still.troubles, []);
  },

  // The element on a page of another's: with a strict security policy, moved, removed, in large numbers, in other colors.
  async embed(page, browser) {
    const context = await patient(browser, { viewport: { width: 800, height: 600 } });
    const plain = await context.newPage();
    plain.on("pageerror", (error) => page.troubles.push(`embedded: ${error.message}`));
    plain.on("console", (message) => message.type() === "error" && page.troubles.push(`embedded: ${message.text()}`));
    await plain.addInitScript(HELPERS);
    await plain.addInitScript(() => {
      window.memories = [];
      const { instantiate } = WebAssembly;
      WebAssembly.instantiate = async (...given) => {
        const made = await instantiate.apply(WebAssembly, given);
        window.memories.push(made.instance.exports.memory);
        return made;
      };
      window.until = async (holds, what) => {
        for (let turns = 0; !holds(); turns++) {
          if (turns > 250) throw new Error(`never: ${what ?? holds}`);
          await new Promise((go) => setTimeout(go, 20));
        }
      };
      window.same = (got, expected) => {
        if (JSON.stringify(got) !== JSON.stringify(expected)) throw new Error(`${JSON.stringify(got)} in place of ${JSON.stringify(expected)}`);
      };
      window.made = (attributes = {}) => {
        const player = document.createElement("pantin-player");
        for (const [name, value] of Object.entries(attributes)) player.setAttribute(name, value);
        document.body.append(player);
        return player;
      };
      window.outcome = (promise) => promise.then(() => "", (error) => error.name);
    });
    const policy = "default-src 'self'; script-src 'self'; style-src 'self'; require-trusted-types-for 'script'; trusted-types 'none'";
    const body = "<!doctype html><title>another's page</title><link rel=icon href=data:,><body><pantin-player id=early></pantin-player>";
    await plain.route("**/plain.html", (route) => route.fulfill({ body, contentType: "text/html", headers: { "Content-Security-Policy": policy.replace("default-src 'self'", "default-src 'self' data:") } }));
    await plain.route("**/late.ptn", async (route) => {
      await new Promise((go) => setTimeout(go, 200));
      await route.continue({ url: `${args.site}clips/walk.ptn` });
    });
    await plain.goto(`${args.site}plain.html`);

    // Properties from before the definition count; a second copy is no error; the canvas keeps its size.
    await plain.evaluate(async () => {
      const early = document.querySelector("#early");
      Object.assign(early, { speed: 2, loop: true, orbit: 20, currentTime: 0.5, src: new URL("clips/walk.ptn", location) });
      await import("/pantin-player.js");
      await import("/pantin-player.js?another");
      await until(() => early.playable > 1 && early.frame > 0);
      same([early.speed, early.loop, early.orbit, early.currentTime > 0.4 && early.currentTime <= 0.5, early.paused], [2, true, 20, true, true]);
      const { offsetHeight } = early;
      await new Promise((go) => setTimeout(go, 200));
      same(early.offsetHeight, offsetHeight);
      same([early.canvas.height, early.stage.clientHeight], [early.stage.clientWidth / 2, early.stage.clientWidth / 2]);
      if (window.seen(early).colours < 10) throw new Error("nothing is drawn");
      // As high as the page says, the bar included.
      early.style.height = "300px";
      await until(() => early.canvas.height < 280 && early.canvas.height > 200);
      same(early.output.getBoundingClientRect().bottom < early.getBoundingClientRect().bottom, true);
      early.remove();
    });

    // With the style sheet of docs/WEB.md nothing moves when the script runs, nor when there is a clip.
    const [, reserved] = /```css\n(pantin-player:not[^]*?)```/.exec(readFileSync(new URL("../../docs/WEB.md", import.meta.url), "utf8"));
    for (const width of [800, 390]) {
      const narrow = await context.newPage();
      await narrow.setViewportSize({ width, height: 600 });
      await narrow.route("**/plain.html", (route) => route.fulfill({ body: body.replace("<body>", "<body><pantin-player bare></pantin-player>"), contentType: "text/html" }));
      await narrow.goto(`${args.site}plain.html`);
      const heights = await narrow.evaluate(async (reserved) => {
        const sheet = new CSSStyleSheet();
        sheet.replaceSync(reserved);
        document.adoptedStyleSheets = [sheet];
        const all = [...document.querySelectorAll("pantin-player")];
        const measured = () => all.map((player) => player.getBoundingClientRect().height);
        const before = measured();
        await import("/pantin-player.js");
        const defined = measured();
        await Promise.all(all.map((player) => player.load("clips/walk.ptn")));
        return [before, defined, measured()];
      }, reserved);
      for (const after of heights.slice(1)) after.forEach((height, index) => assert.ok(Math.abs(height - heights[0][index]) < 0.1, `${width}: ${heights.join("; ")}`));
      await narrow.close();
    }

    // Its life: moved, removed, attached again, never attached, another clip instead, another try.
    await plain.evaluate(async () => {
      const one = made({ loop: "" });
      const other = document.body.appendChild(document.createElement("div"));
      let loading = one.load("late.ptn");
      one.seek(30);
      one.play();
      other.append(one);
      same(await outcome(loading), "");
      same([one.frame >= 30 && one.frame < 40, one.paused], [true, false]);
      await until(() => one.frame > 41, "it plays after it was moved while it loaded");
      document.body.append(one);
      await new Promise((go) => setTimeout(go, 50));
      const { frame } = one;
      same(one.paused, false);
      await until(() => one.frame !== frame, "it plays on after it was moved");
      loading = one.load("late.ptn");
      const next = one.load(new URL("clips/run.ptn", location));
      same([await outcome(loading), await outcome(next)], ["AbortError", ""]);
      one.play();
      one.remove();
      await Promise.resolve();
      same(one.paused, true);
      one.src = "late.ptn";
      await new Promise((go) => setTimeout(go, 10));
      other.append(one);
      await until(() => one.playable > 40);
      one.src = "late.ptn";
      one.remove();
      await new Promise((go) => setTimeout(go, 300));
      same(one.playable, 0);
      other.append(one);
      await until(() => one.playable > 40, "it loads again what its removal stopped");
      one.removeAttribute("src");
      same([one.frames, one.received, one.src], [0, 0, null]);
      same(await outcome(one.load("clips/character.ptb")), "");
      same(await outcome(one.load("http://[")), "TypeError");
      const never = document.createElement("pantin-player");
      never.currentTime = 0.5;
      same(await outcome(never.load("clips/walk.ptn")), "");
      same([never.playable === never.frames, never.currentTime > 0.4], [true, true]);
      // What playing tells.
      const told = [];
      for (const name of ["play", "pause", "ended", "loop", "timeupdate"]) one.addEventListener(name, () => told.at(-1) === name || told.push(name));
      await one.load("clips/run.ptn");
      one.speed = 8;
      one.play();
      await until(() => told.includes("loop"));
      one.loop = false;
      await until(() => told.includes("ended"));
      same([told[0], ...told.slice(-2)], ["play", "pause", "ended"]);
      // The scrubber holds the frame while it is held.
      one.loop = true;
      one.speed = 1;
      one.play();
      one.scrubber.dispatchEvent(new PointerEvent("pointerdown"));
      one.seek(9);
      await new Promise((go) => setTimeout(go, 150));
      same([one.frame, one.paused], [9, false]);
      one.scrubber.dispatchEvent(new PointerEvent("pointerup"));
      await until(() => one.frame > 9);
      document.body.replaceChildren();
    });

    // 300 players; where none of them can be seen, none plays; what is gone gives its memory back.
    const crowd = () => plain.evaluate(async () => {
      const all = Array.from({ length: 300 }, () => made({ bare: "", loop: "", autoplay: "", src: "clips/walk.ptn" }));
      for (const one of all) one.style.width = "100px";
      await until(() => all.every((one) => one.playable > 40));
      await until(() => all.some((one) => one.frame > 2));
      scrollTo(0, 0);
      await new Promise((go) => setTimeout(go, 100));
      const hidden = all.filter((one) => one.getBoundingClientRect().top > innerHeight + 200);
      const before = hidden.map((one) => one.frame);
      await new Promise((go) => setTimeout(go, 100));
      same([hidden.length > 250, hidden.map((one) => one.frame)], [true, before]);
      document.body.replaceChildren();
    });
    const session = await context.newCDPSession(plain);
    const heap = async () => {
      await plain.waitForTimeout(50);
      await session.send("HeapProfiler.collectGarbage");
      return (await session.send("Runtime.getHeapUsage")).usedSize;
    };
    const before = await heap();
    await crowd();
    const after = await heap();
    await crowd();
    // Of 300 players, each of which has more than 4 KB, none is left.
    const again = await heap();
    assert.ok(again - after < 300 * 4096, `${[before, after, again]}`);

    // Nothing but scripts of the site is needed for all that the element plays.
    await plain.route("**/strict.html", (route) => route.fulfill({ body, contentType: "text/html", headers: { "Content-Security-Policy": policy.replace("default-src", "img-src data:; default-src") } }));
    await plain.goto(`${args.site}strict.html`);
    await plain.evaluate(async () => {
      await import("/pantin-player.js");
      const one = made({ autoplay: "", src: "clips/walk.ptn" });
      await until(() => one.frame > 2);
      one.look = "oled";
      await one.picture();
      if (window.seen(one).colours < 4) throw new Error("nothing is drawn");
      one.look = "solid";
      await one.picture();
      if (window.seen(one).colours < 20) throw new Error("nothing is drawn");
      await one.load("clips/greet.ptn");
      await one.load("clips/character.ptb#walk");
      same([one.playable === one.frames, one.readyState], [true, 4]);
      for (one.look of ["lines", "oled"]) {
        await one.load("clips/character.ptb");
        one.hold("go");
        one.advance(0.5);
        same([one.state, one.frames, one.facts.channels, window.memories.length], ["start", 1, 37, 0]);
        await one.picture();
        if (window.seen(one).colours < 4) throw new Error("nothing is drawn");
      }
      // A layer names scalars of a list.
      await one.load("extra/smiling.ptb");
      one.fire("smile");
      one.advance(0.5);
      same([one.state, one.facts.scalars], ["rests", 2]);
      one.remove();
    });

    // Colors: of a dark page that says nothing of it, of properties, forced ones; no ground at all.
    const light = await plain.evaluate(async () => {
      window.one = made();
      await one.load("clips/walk.ptn");
      const isDark = () => one.stage.classList.contains("dark");
      same(isDark(), false);
      document.body.style.color = "white";
      await until(isDark);
      document.body.style.color = "";
      await until(() => !isDark());
      const has = (color) => {
        const { data } = one.context.getImageData(0, 0, one.canvas.width, one.canvas.height);
        for (let at = 0; at < data.length; at += 4) if (color.every((value, index) => Math.abs(value - data[at + index]) < 60)) return true;
        return false;
      };
      same([has([0, 255, 0, 255]), one.context.getImageData(0, 0, 1, 1).data[3]], [false, 0]);
      one.style.setProperty("--pantin-left", "rgb(0 255 0)");
      one.style.setProperty("--pantin-paper", "transparent");
      one.turn(1, 0);
      same([has([0, 255, 0, 255]), getComputedStyle(one.stage).backgroundColor], [true, "rgba(0, 0, 0, 0)"]);
      return has([0, 255, 0, 255]);
    });
    assert.equal(light, true);
    await plain.emulateMedia({ forcedColors: "active" });
    await plain.evaluate(async () => {
      one.turn(1, 0);
      const style = getComputedStyle(one.stage);
      same([style.fill, style.stroke], [style.color, style.color]);
    });
    await context.close();
  },

  // A gallery of 1,000 clips: each small picture is drawn once, when it comes near the screen, by one player.
  async crowd(page, browser) {
    const many = await (await patient(browser, { viewport: { width: 1280, height: 900 } })).newPage();
    many.on("pageerror", (error) => page.troubles.push(error.message));
    const list = Array.from({ length: 1000 }, (_, index) => ({ name: `clip ${index}`, file: "clips/walk.ptn", bytes: 1 }));
    await many.route("**/clips.json", (route) => route.fulfill({ json: list }));
    await many.goto(args.site);
    // A canvas that was not drawn has the usual width.
    const drawn = (most) => many.waitForFunction((most) => {
      const all = [...document.querySelectorAll("#clips canvas")];
      return all.length === 1000 && all.filter((picture) => picture.width < 300).length > most && all.filter((picture) => picture.width < 300).length;
    }, most).then((count) => count.jsonValue());
    await many.waitForFunction(() => document.querySelectorAll("#clips canvas").length === 1000);
    await many.evaluate(() => document.querySelector("#clips").scrollIntoView());
    const first = await drawn(3);
    assert.ok(first < 500, `${first} drawn`);
    // The five of the page, and the one that draws the pictures.
    assert.ok(await many.evaluate(() => document.querySelectorAll("pantin-player").length) <= 6);
    assert.equal(await many.evaluate(() => {
      const picture = document.querySelector("#clips canvas");
      return picture.getContext("2d").getImageData(0, 0, picture.width, picture.height).data.some(Boolean);
    }), true, "it shows something");
    await many.evaluate(() => scrollTo(0, document.documentElement.scrollHeight / 2));
    await drawn(first + 8);
    await many.close();
  },

  // A server that sends a piece now and then: frames become playable, and are played, before the rest is there.
  async slow(page) {
    await page.evaluate((clip) => {
      window.log = [];
      const note = () => window.log.push([player.received, player.total, player.playable, player.frame, player.frames]);
      ["progress", "frame"].forEach((name) => player.addEventListener(name, note));
      player.loop = false;
      window.loaded = player.load(clip).then(() => "", (error) => error.message);
    }, args.clip);
    await page.waitForFunction(() => player.playable > 0 && player.received < player.total);
    const facts = await page.locator("#facts").textContent();
    assert.match(facts, /received[\d,]+ of [\d,]+ bytes/);
    assert.match(await said(page), /^\d+ bytes, \d+ of \d+ frames$/);
    assert.equal(await page.evaluate(() => window.loaded), "");
    return page.evaluate(() => window.log);
  },

  // Files that are no good, or not good to their end: what is said, and how much can be played.
  async bad(page) {
    const outcomes = [];
    for (const clip of args.clips) {
      const error = await load(page, clip);
      const { playable, frames } = await state(page);
      outcomes.push({ error, playable, frames, said: await said(page) });
    }
    // What comes after it is played all the same.
    assert.equal(await load(page, args.good), "");
    assert.equal(await said(page), "");
    page.troubles = page.troubles.filter((trouble) => !/404|ERR_CONTENT_LENGTH_MISMATCH/.test(trouble));
    return outcomes;
  },

  // Drops a motion, watches it, saves both files.
  async drop(page) {
    const files = args.files.map((path) => ({ name: path.split("/").pop(), bytes: readFileSync(path).toString("base64") }));
    if (args.fps) await page.locator("#fps").fill(String(args.fps));
    await page.locator("#effort").selectOption(args.effort);
    await page.evaluate((files) => {
      // The parts that are done, of the first conversion and of the one that replaces it.
      window.parts = {};
      const step = document.querySelector("#step");
      new MutationObserver(() => {
        const [doing] = step.textContent.split(",");
        if (/%/.test(step.textContent)) (window.parts[doing] ??= []).push(+document.querySelector("#progress").value);
      }).observe(step, { childList: true });
      const data = new DataTransfer();
      for (const { name, bytes } of files) data.items.add(new File([Uint8Array.from(atob(bytes), (letter) => letter.charCodeAt(0))], name));
      const over = new DragEvent("dragover", { dataTransfer: data, bubbles: true, cancelable: true });
      document.querySelector("#drop").dispatchEvent(over);
      document.querySelector("#drop").dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
    }, files);
    await page.waitForFunction(() => !document.querySelector("#result").hidden || document.querySelector("#trouble").textContent);
    assert.equal(await page.locator("#trouble").textContent(), "");
    // A better result replaces the first one, and plays.
    await page.waitForFunction(() => document.querySelector("#working").hidden && converted.frame > 2);
    await page.evaluate(() => (converted.pause(), converted.seek(converted.frames >> 1)));
    const saved = {};
    for (const id of ["save", "save-glb", "save-c"]) {
      const [download] = await Promise.all([page.waitForEvent("download"), page.locator(`#${id}`).click()]);
      saved[download.suggestedFilename()] = readFileSync(await download.path()).toString("base64");
    }
    const programs = await programsOf(page);
    if (args.shot) await page.locator(".convert").screenshot({ path: args.shot });
    const sides = await page.evaluate(() => [original, converted].map((one) => ({ frame: one.frame, frames: one.frames, ...window.seen(one) })));
    const greys = await page.evaluate(async () => {
      for (const one of [original, converted]) (one.look = "oled"), await one.picture();
      return [original, converted].map(window.greys);
    });
    const report = await page.locator("#report").innerText();
    const seconds = +/converted in\s*([\d.]+)/.exec(report)[1];
    return { saved, sides, greys, seconds, report, programs, parts: await page.evaluate(() => window.parts) };
  },

  // Files that cannot be converted, chosen by the button: what is said, and how soon.
  async refused(page) {
    const outcomes = [];
    for (const path of args.files) {
      const begun = Date.now();
      await page.locator("#files").setInputFiles(path);
      await page.waitForFunction(() => document.querySelector("#trouble").textContent && document.querySelector("#working").hidden);
      outcomes.push({ said: await page.locator("#trouble").textContent(), ms: Date.now() - begun, shown: await page.locator("#result").isVisible() });
    }
    return outcomes;
  },

  // What was converted is converted again with other values; files that are left out are named; a link carries a clip.
  async again(page, browser) {
    const result = () => page.evaluate(() => ({ report: document.querySelector("#report").innerText, said: document.querySelector("#said").innerText, trouble: document.querySelector("#trouble").textContent, hidden: document.querySelector("#result").hidden }));
    const converts = async (act) => {
      await page.evaluate(() => (document.querySelector("#report").textContent = ""));
      await act();
      await page.waitForFunction(() => document.querySelector("#working").hidden && (document.querySelector("#report").textContent || document.querySelector("#trouble").textContent));
      return result();
    };
    const clipBytes = ({ report }) => +/clip\s+([\d,]+) bytes/.exec(report)[1].replace(",", "");
    await page.locator("#effort").selectOption("fast");
    const files = (...paths) => converts(() => page.locator("#files").setInputFiles(paths));
    const first = await converts(() => page.locator("#try").click());
    assert.equal(first.trouble, "");
    // Another error, from the slider and from the field; the file is not asked for.
    const coarse = await converts(() => page.locator("#cm").fill("5").then(() => page.locator("#cm").press("Enter")));
    assert.ok(clipBytes(coarse) < clipBytes(first), `${first.report} ${coarse.report}`);
    const fine = await converts(() => page.locator("#slide").fill("-1.3"));
    assert.ok(clipBytes(fine) > clipBytes(first), fine.report);
    assert.equal(await page.locator("#cm").inputValue(), "0.05");
    await page.locator("#cm").fill("0.5");
    // Text that is dropped takes nothing away.
    await page.evaluate(() => {
      const data = new DataTransfer();
      data.setData("text/plain", "a word");
      document.querySelector("#drop").dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
    });
    const kept = await result();
    assert.deepEqual([kept.trouble, kept.hidden], ["That was no file.", false]);
    // Two bodies; a body and a face; a file that nothing needs.
    const two = await files(args.bvh, args.other, args.text);
    assert.match(two.said, /other\.bvh: left out: one body/);
    assert.match(two.said, /notes\.txt: left out: nothing refers to it/);
    const both = await files(args.face, args.bvh);
    assert.match(both.said, /body and face are one clip/);
    await page.waitForFunction(() => converted.readyState === 4);
    assert.deepEqual(await page.evaluate(() => [converted.facts.joints > 10, converted.facts.scalars]), [true, 2]);
    assert.equal(await page.locator("#save").getAttribute("download"), "our-walk.ptn");
    // A glTF file's animations.
    const gltf = await files(args.gltf);
    assert.doesNotMatch(gltf.said + gltf.trouble, /--/);
    assert.deepEqual(await page.locator("#animation option").allTextContents(), ["Turn", "animation 1"]);
    await page.waitForFunction(() => converted.readyState === 4);
    const shown = await page.evaluate(() => converted.duration);
    await converts(() => page.locator("#animation").selectOption("1"));
    await page.waitForFunction((shown) => converted.duration > 1.5 * shown, shown);
    // What was converted, in a link.
    await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
    await page.locator("#share-clip").click();
    await page.waitForFunction(() => document.querySelector("#share-clip").textContent === "Copied");
    const turning = await page.context().newPage();
    await turning.goto(await page.evaluate(() => navigator.clipboard.readText()));
    await turning.waitForFunction((duration) => player.duration === duration, await page.evaluate(() => converted.duration));
    // Messages have the page's words.
    for (const path of args.alone) {
      const alone = await files(path);
      assert.ok(alone.trouble.length > 10 && !/--|`/.test(alone.trouble), alone.trouble);
      assert.equal(alone.hidden, true);
    }
    // A clip in a link.
    await page.locator("#files").setInputFiles(args.clip);
    await page.waitForFunction(() => player.frames === 26 && player.playable === 26);
    await page.locator("#share").click();
    await page.waitForFunction(() => document.querySelector("#share").textContent === "Copied");
    const link = await page.evaluate(() => navigator.clipboard.readText());
    assert.ok(link.length < 1000, link);
    const received = await page.context().newPage();
    await received.goto(link);
    await received.waitForFunction(() => player.playable === 26);
    await page.locator("#clips button", { hasText: "walk" }).click();
    assert.match(page.url(), /\?clip=walk$/);
    await page.locator("#copy").click();
    assert.match(await page.evaluate(() => navigator.clipboard.readText()), /^<script.*<pantin-player/);
  },

  async cancel(page) {
    await page.locator("#effort").selectOption("best");
    await page.locator("#files").setInputFiles(args.file);
    await page.locator("#cancel").click();
    assert.equal(await page.locator("#trouble").textContent(), "Cancelled.");
    assert.equal(await page.locator("#working").isVisible(), false);
  },

  // Pictures to be looked at.
  async shots(page, browser) {
    const looks = { light: {}, dark: { colorScheme: "dark" }, phone: { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2 } };
    for (const [look, options] of Object.entries(looks)) {
      const one = await opened(browser, options);
      await one.waitForTimeout(500);
      await one.evaluate((oled) => (player.pause(), player.seek(30), (player.look = oled ? "oled" : "lines")), look === "dark");
      await one.screenshot({ path: `${args.folder}/page-${look}.png`, fullPage: true });
    }
  },

  // Milliseconds: from the request of the page to the first frame, and of a frame in both looks.
  async times(page, browser) {
    const first = [];
    for (let run = 0; run < 5; run++) {
      const one = await (await patient(browser)).newPage();
      await one.goto(`${args.site}clips.json`);
      first.push(await one.evaluate(async (clip) => {
        const begun = performance.now();
        await import("/pantin-player.js");
        const player = document.createElement("pantin-player");
        document.body.append(player);
        const shown = new Promise((go) => player.addEventListener("progress", () => player.playable && go(performance.now() - begun)));
        player.setAttribute("src", clip);
        return shown;
      }, args.clips[0]));
    }
    // The same over slow lines, of a page with preload links: from the request of the page to the first figure.
    const slow = {};
    for (const [line, path, latency, kilobits] of args.lines) {
      const context = await patient(browser);
      const one = await context.newPage();
      const session = await context.newCDPSession(one);
      await session.send("Network.enable");
      await session.send("Network.emulateNetworkConditions", { offline: false, latency, downloadThroughput: (kilobits * 1000) / 8, uploadThroughput: (kilobits * 1000) / 8 });
      await one.addInitScript(() => {
        const look = () => (document.querySelector("pantin-player")?.playable ? (window.first = performance.now()) : requestAnimationFrame(look));
        look();
      });
      await one.goto(`${args.site}${path}`, { waitUntil: "commit" });
      slow[line] = await one.waitForFunction(() => window.first).then((time) => time.jsonValue());
      await context.close();
    }
    // The part of a core's time that 30 players on the screen take, and 30 that cannot be seen.
    const crowd = {};
    for (const [where, top] of [["on screen", 0], ["off screen", 5000]]) {
      const context = await patient(browser, { viewport: { width: 1280, height: 900 } });
      const one = await context.newPage();
      await one.goto(`${args.site}clips.json`);
      await one.evaluate(async ({ clip, top }) => {
        await import("/pantin-player.js");
        document.body.replaceChildren();
        document.body.style.cssText = `margin: ${top}px 0 0; display: grid; grid-template-columns: repeat(6, 1fr); gap: 4px`;
        const all = Array.from({ length: 30 }, () => {
          const player = document.createElement("pantin-player");
          for (const name of ["bare", "loop", "autoplay"]) player.setAttribute(name, "");
          player.setAttribute("src", clip);
          document.body.append(player);
          return player;
        });
        while (!all.every((player) => player.playable > 1)) await new Promise((go) => setTimeout(go, 20));
      }, { clip: args.clips[0], top });
      const session = await context.newCDPSession(one);
      await session.send("Performance.enable");
      const busy = async () => {
        const { metrics } = await session.send("Performance.getMetrics");
        return ["TaskDuration", "Timestamp"].map((name) => metrics.find((metric) => metric.name === name).value);
      };
      await one.waitForTimeout(500);
      const [before, begun] = await busy();
      await one.waitForTimeout(3000);
      const [after, ended] = await busy();
      crowd[where] = (after - before) / (ended - begun);
      await context.close();
    }
    const frames = {};
    for (const clip of args.clips) {
      assert.equal(await load(page, clip), "");
      for (const look of ["oled", "lines"]) {
        frames[`${clip} ${look}`] = await page.evaluate((look) => {
          player.pause();
          player.look = look;
          const count = 200;
          const begun = performance.now();
          for (let index = 0; index < count; index++) {
            player.seek(index % player.frames);
            // What was drawn is done once it can be read; what nobody reads before the next frame may never be drawn.
            player.context.getImageData(0, 0, 1, 1);
          }
          return { ms: (performance.now() - begun) / count, width: player.canvas.width, height: player.canvas.height };
        }, look);
      }
    }
    return { first: first.sort((a, b) => a - b)[2], slow, crowd, frames };
  },
};

const browser = await chromium.launch(LAUNCH);
try {
  const page = await opened(browser);
  const result = await cases[name](page, browser);
  assert.deepEqual(page.troubles, [], "the page has no errors of its own");
  console.log(JSON.stringify(result ?? null));
} finally {
  await browser.close();
}
