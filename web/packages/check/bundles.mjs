// The element in bundles of Vite, webpack and esbuild, in Vite's development server, on a plain page below a folder, and from another origin, in Chromium:
// `node bundles.mjs CLIPS`, a folder with clips. Prints where it played.
import assert from "node:assert/strict";
import { copyFileSync, cpSync, existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { extname, join, resolve } from "node:path";
import { build as esbuild } from "esbuild";
import { build, createServer as createVite } from "vite";
import webpack from "webpack";

const { chromium } = createRequire(`${process.env.PLAYWRIGHT}/`)("playwright-core");
const CLIPS = process.argv[2];
// A clip of each kind: of a body, of a face beside it, and a character.
const [BODY, FACE, CHARACTER] = ["walk.ptn", "greet.ptn", "character.ptb"];
const player = resolve("node_modules/@pantin/player");
// All of it is served below this folder.
const site = resolve("site");
rmSync(site, { recursive: true, force: true });

const page = (script) => `<!doctype html><html lang="en"><title>Pantin</title><link rel="icon" href="data:,"><script type="module" src="${script}"></script><pantin-player></pantin-player></html>`;
const put = (folder, script) => {
  mkdirSync(join(site, folder), { recursive: true });
  writeFileSync(join(site, folder, "index.html"), page(script));
};

// What the page of Vite's project names.
mkdirSync("public", { recursive: true });
copyFileSync(join(CLIPS, BODY), join("public", BODY));
await build({ base: "./", logLevel: "error", build: { outDir: join(site, "in/vite"), emptyOutDir: true } });

put("in/webpack", "main.js");
await new Promise((done, failed) => webpack({
  mode: "production", entry: "./main.ts", output: { path: join(site, "in/webpack"), publicPath: "auto" }, experiments: { outputModule: true }, performance: false,
}, (error, stats) => (error || stats.hasErrors() ? failed(error ?? new Error(stats.toString())) : done())));

put("in/esbuild", "main.js");
await esbuild({ entryPoints: ["main.ts"], bundle: true, minify: true, format: "esm", outdir: join(site, "in/esbuild"), logLevel: "error" });

put("in/plain", "pantin-player.js");
cpSync(player, join(site, "in/plain"), { recursive: true });
cpSync(CLIPS, join(site, "clips"), { recursive: true });

const KINDS = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm" };
const listen = (answer) => new Promise((done) => {
  const server = createServer(answer).listen(0, "127.0.0.1", () => done({ server, address: `http://127.0.0.1:${server.address().port}` }));
});
// Pages of other origins may read it.
const { server, address } = await listen(({ url }, response) => {
  const path = join(site, url.endsWith("/") ? `${url}index.html` : url);
  const found = path.startsWith(site) && existsSync(path);
  response.writeHead(found ? 200 : 404, { "Content-Type": KINDS[extname(path)] ?? "application/octet-stream", "Access-Control-Allow-Origin": "*" });
  response.end(found ? readFileSync(path) : "");
});
const { server: other, address: elsewhere } = await listen((_, response) => response.writeHead(200, { "Content-Type": "text/html" }).end(page(`${address}/in/plain/pantin-player.js`)));
const vite = await createVite({ logLevel: "error", server: { port: 0, host: "127.0.0.1" } });
await vite.listen();

const places = {
  "a bundle of Vite's": `${address}/in/vite/`,
  "a bundle of webpack's": `${address}/in/webpack/`,
  "a bundle of esbuild's": `${address}/in/esbuild/`,
  "Vite's development server": `http://127.0.0.1:${vite.httpServer.address().port}/`,
  "a plain page": `${address}/in/plain/`,
  "a page of another origin": `${elsewhere}/`,
};

// In the page: all modules play, and a picture is saved.
async function used(clips, [body, face, character]) {
  await customElements.whenDefined("pantin-player");
  const player = document.createElement("pantin-player");
  document.body.replaceChildren(player);
  await player.load(`${clips}/${body}`);
  const { type, size } = await player.picture();
  const frames = [player.playable === player.frames && player.frames];
  await player.load(`${clips}/${face}`);
  frames.push(player.playable === player.frames && player.frames, player.facts.scalars);
  await player.load(`${clips}/${character}`);
  return JSON.stringify({ frames, type, isPicture: size > 500, isCharacter: player.states.includes(player.state) });
}
const expected = JSON.stringify({ frames: [160, 160, 5], type: "image/png", isPicture: true, isCharacter: true });

const browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args: ["--disable-gpu"], chromiumSandbox: process.getuid?.() !== 0 });
try {
  for (const [place, url] of Object.entries(places)) {
    const one = await browser.newPage();
    const troubles = [];
    one.on("pageerror", (error) => troubles.push(error.message));
    one.on("console", (message) => message.type() === "error" && troubles.push(message.text()));
    await one.goto(url);
    const got = await one.evaluate(`(${used})(${JSON.stringify(`${address}/clips`)}, ${JSON.stringify([BODY, FACE, CHARACTER])})`).catch((error) => error.message);
    assert.deepEqual([place, got, troubles], [place, expected, []]);
    await one.close();
  }
  console.log(JSON.stringify(Object.keys(places)));
} finally {
  await browser.close();
  await vite.close();
  [server, other].forEach((one) => (one.closeAllConnections(), one.close()));
}
