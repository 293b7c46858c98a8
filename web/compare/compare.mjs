// Players of our walk side by side in Chromium: `node compare.mjs SITE LOTTIE LINES`, the built site, the walk as a Lottie file, and lines as JSON, each a name, a latency in
// ms and kilobits per second. Prints of each player the bytes that a page receives, compressed with brotli, the time to the first picture over each line in ms, and the part of
// a core's time that the page's main thread is busy while the walk is played.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { dirname, extname, join } from "node:path";
import { brotliCompressSync } from "node:zlib";
import { build } from "esbuild";

const require = createRequire(import.meta.url);
const { chromium } = createRequire(`${process.env.PLAYWRIGHT}/`)("playwright-core");
const [, , SITE, LOTTIE, LINES] = process.argv;
// How long a page plays before it is measured, and while it is, in ms.
const [BEFORE, WHILE] = [1000, 3000];

const sent = new Map();
const compressed = (bytes) => brotliCompressSync(bytes).length;
const page = (head, body) => `<!doctype html><html lang="en"><title>A walk</title><link rel="icon" href="data:,">${head}<body>${body}</body></html>`;
const three = (await build({ entryPoints: ["three.js"], bundle: true, minify: true, format: "esm", write: false, logLevel: "error" })).outputFiles[0].contents;
const read = (path) => () => readFileSync(path);
// Every page names in its head what it will need, so that it is asked for at once.
const PLAYERS = {
  Pantin: {
    "": () => page(
      '<link rel="modulepreload" href="pantin-player.js"><link rel="preload" as="fetch" crossorigin href="walk.ptn"><script type="module" src="pantin-player.js"></script>',
      '<pantin-player src="walk.ptn" autoplay loop style="width: 480px"></pantin-player><script>(function look() { document.querySelector("pantin-player").playable ? (window.first = performance.now()) : requestAnimationFrame(look) })()</script>',
    ),
    "pantin-player.js": read(join(SITE, "pantin-player.js")), "pantin-controls.js": read(join(SITE, "pantin-controls.js")), "walk.ptn": read(join(SITE, "clips/walk.ptn")),
  },
  "Lottie (light)": {
    "": () => page(
      '<link rel="preload" as="fetch" crossorigin href="walk.json"><script defer src="lottie.js"></script>',
      '<div id="figure" style="width: 480px; height: 240px"></div><script>addEventListener("DOMContentLoaded", () => lottie.loadAnimation({ container: document.getElementById("figure"), renderer: "svg", path: "walk.json" }).addEventListener("DOMLoaded", () => requestAnimationFrame(() => (window.first = performance.now()))))</script>',
    ),
    "lottie.js": read(require.resolve("lottie-web/build/player/lottie_light.min.js")), "walk.json": read(LOTTIE),
  },
  "three.js with glTF": {
    "": () => page('<link rel="modulepreload" href="three.js"><link rel="preload" as="fetch" crossorigin href="walk.glb"><script type="module" src="three.js"></script>', ""),
    "three.js": () => three, "walk.glb": read(join(SITE, "clips/walk.glb")),
  },
};
const KINDS = { "": "text/html", ".js": "text/javascript", ".json": "application/json" };

let files = {};
const server = createServer(({ url }, response) => {
  const name = url.slice(1);
  if (!(name in files)) return response.writeHead(404).end();
  // Clips are compressed already.
  const coding = extname(name) === ".ptn" ? {} : { "Content-Encoding": "br" };
  const body = coding["Content-Encoding"] ? brotliCompressSync(files[name]()) : files[name]();
  sent.set(name, body.length);
  response.writeHead(200, { "Content-Type": KINDS[extname(name)] ?? "application/octet-stream", "Content-Length": body.length, ...coding }).end(body);
});
await new Promise((done) => server.listen(0, "127.0.0.1", done));
const address = `http://127.0.0.1:${server.address().port}/`;
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args: ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"], chromiumSandbox: process.getuid?.() !== 0 });

async function opened(line) {
  const context = await browser.newContext();
  const page = await context.newPage();
  const troubles = [];
  page.on("pageerror", (error) => troubles.push(error.message));
  const session = await context.newCDPSession(page);
  await session.send("Network.enable");
  if (line) {
    const [latency, kilobits] = line;
    await session.send("Network.emulateNetworkConditions", { offline: false, latency, downloadThroughput: (kilobits * 1000) / 8, uploadThroughput: (kilobits * 1000) / 8 });
  }
  await page.goto(address, { waitUntil: "commit" });
  const first = await page.waitForFunction(() => window.first, undefined, { timeout: 120000 }).then((time) => time.jsonValue());
  assert.deepEqual(troubles, []);
  return { page, session, first, close: () => context.close() };
}

async function busy({ page, session }) {
  await session.send("Performance.enable");
  const times = async () => {
    const { metrics } = await session.send("Performance.getMetrics");
    return ["TaskDuration", "Timestamp"].map((name) => metrics.find((metric) => metric.name === name).value);
  };
  await page.waitForTimeout(BEFORE);
  const [before, begun] = await times();
  await page.waitForTimeout(WHILE);
  const [after, ended] = await times();
  return (after - before) / (ended - begun);
}

try {
  const measured = {};
  for (const [name, itsFiles] of Object.entries(PLAYERS)) {
    files = itsFiles;
    sent.clear();
    const one = await opened();
    const part = await busy(one);
    await one.close();
    const bytes = [...sent.values()].reduce((sum, bytes) => sum + bytes, 0);
    const first = {};
    for (const [line, ...numbers] of JSON.parse(LINES)) {
      const slow = await opened(numbers);
      first[line] = slow.first;
      await slow.close();
    }
    measured[name] = { bytes, first, busy: part };
  }
  const rive = dirname(require.resolve("@rive-app/canvas-lite"));
  const runtime = ["rive.js", "rive.wasm"].reduce((sum, name) => sum + compressed(readFileSync(join(rive, name))), 0);
  console.log(JSON.stringify({ ...measured, "Rive (canvas-lite), its runtime alone": { bytes: runtime } }));
} finally {
  await browser.close();
  server.close();
  server.closeAllConnections();
}
