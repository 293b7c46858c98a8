// What three.js shows of glTF files as their own animations move them, and as clips of these do: `node pixels.mjs FOLDER`, a folder with pairs of files
// NAME.glb and NAME.ptn, of each file's animation number N where its name ends in -N, else of its first. Prints the part of the figure's pixels that differ.
import assert from "node:assert/strict";
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { join } from "node:path";
import { build } from "esbuild";

const { chromium } = createRequire(`${process.env.PLAYWRIGHT}/`)("playwright-core");
const folder = process.argv[2];
const { outputFiles } = await build({ entryPoints: ["pixels.js"], bundle: true, format: "esm", write: false, logLevel: "error" });
const server = createServer(({ url }, response) => {
  const own = { "/": ["text/html", () => readFileSync("pixels.html")], "/pixels.js": ["text/javascript", () => outputFiles[0].contents] }[url];
  response.writeHead(200, { "Content-Type": own?.[0] ?? "application/octet-stream" }).end(own ? own[1]() : readFileSync(join(folder, url)));
});
await new Promise((done) => server.listen(0, "127.0.0.1", done));
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args: ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"], chromiumSandbox: process.getuid?.() !== 0 });
try {
  const page = await browser.newPage();
  const troubles = [];
  page.on("pageerror", (error) => troubles.push(error.message));
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  await page.waitForFunction("globalThis.isReady");
  const found = {};
  for (const name of readdirSync(folder).filter((name) => name.endsWith(".ptn")).map((name) => name.slice(0, -4))) {
    const animation = Number(name.match(/-(\d+)$/)?.[1] ?? 0);
    const { worst, ...told } = await page.evaluate(`compare("/${name}.glb", "/${name}.ptn", ${animation})`);
    worst.forEach((picture, index) => writeFileSync(join(folder, `${name}-${["own", "clip"][index]}.png`), Buffer.from(picture.split(",")[1], "base64")));
    found[name] = told;
  }
  assert.deepEqual(troubles, []);
  console.log(JSON.stringify(found));
} finally {
  await browser.close();
  server.close();
  server.closeAllConnections();
}
