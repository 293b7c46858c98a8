// Builds each example, and uses what was built in Chromium: `node check.mjs CLIP`. Prints where it worked.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, readFileSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { extname, join } from "node:path";

const { chromium } = createRequire(`${process.env.PLAYWRIGHT}/`)("playwright-core");
const CLIP = process.argv[2];
// Each example's folder for files that are served as they are, and the folder of the built site.
const EXAMPLES = { react: ["public", "dist"], vue: ["public", "dist"], svelte: ["public", "dist"], next: ["public", "out"], sveltekit: ["static", "build"], astro: ["public", "dist"] };
const KINDS = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css" };

function build(name, files) {
  mkdirSync(join(name, files), { recursive: true });
  copyFileSync(CLIP, join(name, files, "walk.ptn"));
  try {
    execFileSync("npm", ["run", "build"], { cwd: name, stdio: "pipe", env: { ...process.env, CI: "1", NEXT_TELEMETRY_DISABLED: "1", ASTRO_TELEMETRY_DISABLED: "1" } });
  } catch ({ stdout, stderr }) {
    throw new Error(`${name}: ${stdout}${stderr}`);
  }
}

function serve(folder) {
  const server = createServer(({ url }, response) => {
    const path = join(folder, new URL(url, "http://host").pathname);
    const file = existsSync(path) && statSync(path).isDirectory() ? join(path, "index.html") : path;
    const isThere = file.startsWith(folder) && existsSync(file);
    response.writeHead(isThere ? 200 : 404, { "Content-Type": KINDS[extname(file)] ?? "application/octet-stream" }).end(isThere ? readFileSync(file) : "");
  });
  return new Promise((done) => server.listen(0, "127.0.0.1", () => done(server)));
}

// It plays, counts its rounds, pauses and plays at the press of the button.
async function use(page) {
  await page.waitForFunction(() => document.querySelector("pantin-player")?.frame > 5);
  await page.waitForFunction(() => +document.querySelector("output").textContent > 0);
  const paused = () => page.evaluate(() => [document.querySelector("pantin-player").paused, document.querySelector("main > button").textContent]);
  const button = page.locator("main > button");
  assert.deepEqual(await paused(), [false, "Pause"]);
  await button.click();
  await page.waitForFunction(() => document.querySelector("main > button").textContent === "Play");
  assert.deepEqual(await paused(), [true, "Play"]);
  await button.click();
  await page.waitForFunction(() => document.querySelector("main > button").textContent === "Pause");
  assert.deepEqual(await paused(), [false, "Pause"]);
  // A module that is fetched when it is needed.
  const size = await page.evaluate(async () => (await document.querySelector("pantin-player").picture()).size);
  assert.ok(size > 500, `a picture of ${size} bytes`);
}

const browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args: ["--disable-gpu"], chromiumSandbox: process.getuid?.() !== 0 });
try {
  for (const [name, [files, built]] of Object.entries(EXAMPLES)) {
    build(name, files);
    const server = await serve(join(process.cwd(), name, built));
    const page = await browser.newPage();
    const troubles = [];
    page.on("pageerror", (error) => troubles.push(error.message));
    page.on("console", (message) => message.type() === "error" && troubles.push(message.text()));
    await page.goto(`http://127.0.0.1:${server.address().port}/`);
    await use(page).catch((error) => troubles.push(error.message));
    assert.deepEqual([name, troubles], [name, []]);
    await page.close();
    server.close();
    server.closeAllConnections();
  }
  console.log(JSON.stringify(Object.keys(EXAMPLES)));
} finally {
  await browser.close();
}
