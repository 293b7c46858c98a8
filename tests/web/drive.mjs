// Drives the page in a headless Chromium as a user would: `node drive.mjs CASE JSON`. What a case asserts itself fails it; what it saw, it prints as JSON.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

const { chromium } = createRequire(`${process.env.PLAYWRIGHT}/`)("playwright-core");
const [, , name, words] = process.argv;
const args = JSON.parse(words);

// In the page: the canvas of a player as the greys of the display, a hexadecimal digit each, and a hash of any canvas.
const HELPERS = () => {
  window.greys = (player) => Array.from(player.context.getImageData(0, 0, 128, 64).data.filter((_, index) => index % 4 === 0), (grey) => (grey / 17).toString(16)).join("");
  window.seen = (player) => {
    const { width, height } = player.canvas;
    const pixels = new Uint32Array(player.context.getImageData(0, 0, width, height).data.buffer);
    return { colours: new Set(pixels).size, hash: pixels.reduce((hash, pixel) => (Math.imul(hash, 31) + pixel) | 0, 7) };
  };
};

async function opened(browser, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, acceptDownloads: true, ...options });
  const page = await context.newPage();
  page.troubles = [];
  page.on("pageerror", (error) => page.troubles.push(error.message));
  page.on("console", (message) => message.type() === "error" && page.troubles.push(message.text()));
  await page.addInitScript(HELPERS);
  await page.goto(args.site);
  await page.waitForFunction(() => document.querySelector("#player").playable > 1);
  return page;
}

const load = (page, file) => page.evaluate((file) => player.load(file).then(() => "", (error) => error.message), file);
const state = (page) => page.evaluate(() => ({ ...player.facts, paused: player.paused, received: player.received, orbit: player.orbit }));
const said = (page) => page.locator("#player p[role=status]").textContent();

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

  async controls(page) {
    assert.equal((await state(page)).paused, false, "it plays by itself");
    await page.locator("#player button").click();
    assert.equal((await state(page)).paused, true, "the button pauses");
    const { frames } = await state(page);
    const scrubber = page.locator("#player input");
    await scrubber.fill("40");
    assert.equal((await state(page)).frame, 40);
    await scrubber.press("ArrowRight");
    assert.equal((await state(page)).frame, 41, "the scrubber's own keys step");
    const stage = page.locator("#player .stage");
    await stage.focus();
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
    await page.locator("#player button").click();
    await page.waitForFunction(() => window.shown.some((frame, index) => index && frame < window.shown[index - 1]));
    await page.locator("#player button").click();
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
    await page.locator("#oled").click();
    assert.equal(await page.evaluate(() => player.look + player.canvas.width), "oled128");
    assert.equal(await page.locator("#oled").getAttribute("aria-pressed"), "true");
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

  // Who wants less motion gets none before asking.
  async quiet(page, browser) {
    const still = await opened(browser, { reducedMotion: "reduce", colorScheme: "dark" });
    await still.waitForTimeout(300);
    assert.equal((await state(still)).paused, true);
    const dark = await still.evaluate(() => window.seen(player));
    assert.ok(dark.colours > 10);
    await still.emulateMedia({ colorScheme: "light" });
    await still.waitForFunction((hash) => window.seen(player).hash !== hash, dark.hash);
    assert.deepEqual(still.troubles, []);
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
      window.parts = [];
      new MutationObserver(() => window.parts.push(+document.querySelector("#progress").value)).observe(document.querySelector("#step"), { childList: true });
      const data = new DataTransfer();
      for (const { name, bytes } of files) data.items.add(new File([Uint8Array.from(atob(bytes), (letter) => letter.charCodeAt(0))], name));
      const over = new DragEvent("dragover", { dataTransfer: data, bubbles: true, cancelable: true });
      document.querySelector("#drop").dispatchEvent(over);
      document.querySelector("#drop").dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
    }, files);
    await page.waitForFunction(() => !document.querySelector("#result").hidden || document.querySelector("#trouble").textContent, null, { timeout: 120000 });
    assert.equal(await page.locator("#trouble").textContent(), "");
    await page.waitForFunction(() => converted.frame > 2);
    await page.evaluate(() => (converted.pause(), converted.seek(converted.frames >> 1)));
    const saved = {};
    for (const id of ["save", "save-c"]) {
      const [download] = await Promise.all([page.waitForEvent("download"), page.locator(`#${id}`).click()]);
      saved[download.suggestedFilename()] = readFileSync(await download.path()).toString("base64");
    }
    if (args.shot) await page.locator(".convert").screenshot({ path: args.shot });
    const sides = await page.evaluate(() => [original, converted].map((one) => ({ frame: one.frame, frames: one.frames, ...window.seen(one) })));
    const greys = await page.evaluate(() => {
      [original, converted].forEach((one) => (one.look = "oled"));
      return [original, converted].map(window.greys);
    });
    const report = await page.locator("#report").innerText();
    const seconds = +/converted in\s*([\d.]+)/.exec(report)[1];
    return { saved, sides, greys, seconds, report, parts: await page.evaluate(() => window.parts) };
  },

  // Files that cannot be converted, chosen by the button: what is said, and how soon.
  async refused(page) {
    const outcomes = [];
    for (const path of args.files) {
      const begun = Date.now();
      await page.locator("#files").setInputFiles(path);
      await page.waitForFunction(() => document.querySelector("#trouble").textContent && document.querySelector("#working").hidden, null, { timeout: 60000 });
      outcomes.push({ said: await page.locator("#trouble").textContent(), ms: Date.now() - begun, shown: await page.locator("#result").isVisible() });
    }
    return outcomes;
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
      const one = await (await browser.newContext()).newPage();
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
    const frames = {};
    for (const clip of args.clips) {
      assert.equal(await load(page, clip), "");
      for (const look of ["oled", "lines"]) {
        frames[`${clip} ${look}`] = await page.evaluate((look) => {
          player.pause();
          player.look = look;
          const count = 600;
          const begun = performance.now();
          for (let index = 0; index < count; index++) player.seek(index % player.frames);
          // What was drawn is done once it can be read.
          player.context.getImageData(0, 0, 1, 1);
          return { ms: (performance.now() - begun) / count, width: player.canvas.width, height: player.canvas.height };
        }, look);
      }
    }
    return { first: first.sort((a, b) => a - b)[2], frames };
  },
};

const browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args: ["--disable-gpu"], chromiumSandbox: process.getuid?.() !== 0 });
try {
  const page = await opened(browser);
  const result = await cases[name](page, browser);
  assert.deepEqual(page.troubles, [], "the page has no errors of its own");
  console.log(JSON.stringify(result ?? null));
} finally {
  await browser.close();
}
