// The site's page in several browsers, without a driver: `node browsers.mjs SITE`, a folder with the site; CHROMIUM, FIREFOX and WEBKIT (its MiniBrowser) name the programs. Each
// browser opens the page with essentials.js in it, which uses the page and sends what it saw. All browsers must see what Chromium sees. Prints the names of the browsers.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { extname, join } from "node:path";

const [, , site] = process.argv;
// A browser takes some seconds; this is for a machine that does other things.
const PATIENCE_MS = 300_000;
const CHECK = "/essentials.js";
const KINDS = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".json": "application/json", ".svg": "image/svg+xml", ".wasm": "application/wasm" };

// What the present browser sends: the step that it begins, or what it saw.
let began, saw;

const server = createServer(async ({ method, url }, response) => {
  const path = url === "/" ? "/index.html" : url.split("?")[0];
  if (method === "POST") {
    let text = "";
    for await (const part of response.req) text += part;
    (path === "/began" ? began : saw)(JSON.parse(text));
    return response.end();
  }
  try {
    let content = readFileSync(path === CHECK ? new URL(`.${CHECK}`, import.meta.url) : join(site, path));
    if (path === "/index.html") content = String(content).replace("<head>", `<head><script type="module" src="${CHECK}"></script>`);
    response.writeHead(200, { "Content-Type": KINDS[extname(path)] ?? "application/octet-stream" }).end(content);
  } catch {
    response.writeHead(404).end();
  }
});
await new Promise((done) => server.listen(0, "127.0.0.1", done));
const page = `http://127.0.0.1:${server.address().port}/`;

// Starts a program, and keeps the end of what it prints for errors.
function start(program, words, options) {
  const child = spawn(program, words, { stdio: ["ignore", "pipe", "pipe"], ...options });
  const ended = new Promise((done) => child.on("exit", done).on("error", done));
  let said = "";
  for (const stream of [child.stdout, child.stderr]) stream.on("data", (text) => (said = (said + text).slice(-2000)));
  return { child, said: () => said, ended, end: () => (child.kill(), ended) };
}

// A screen in memory, and its name.
async function screen() {
  const xvfb = start("Xvfb", ["-displayfd", "1", "-screen", "0", "1280x1024x24", "-nolisten", "tcp"]);
  const name = new Promise((done) => xvfb.child.stdout.on("data", () => /\d+\n/.test(xvfb.said()) && done(/(\d+)\n/.exec(xvfb.said())[1])));
  return { ...xvfb, name: await Promise.race([name, xvfb.ended.then(() => Promise.reject(new Error(`Xvfb ended: ${xvfb.said()}`)))]) };
}

// What the page sees in a browser whose settings are in a folder of their own.
async function seen(name, program, words, environment = {}) {
  const home = mkdtempSync(join(tmpdir(), "pantin-browser-"));
  let step = "the start";
  began = (name) => (step = name);
  const sent = new Promise((done) => (saw = done));
  const browser = start(program, words(home), { env: { ...process.env, HOME: home, ...environment } });
  let timer;
  const late = new Promise((done) => (timer = setTimeout(done, PATIENCE_MS, "is still there")));
  try {
    const found = await Promise.race([sent, browser.ended.then(() => "has ended"), late]);
    if (typeof found === "string") throw new Error(`${name} ${found} at: ${step}\n${browser.said()}`);
    return found;
  } finally {
    clearTimeout(timer);
    await browser.end();
    rmSync(home, { recursive: true, force: true, maxRetries: 20, retryDelay: 100 });
  }
}

// No page of Firefox's own stands before ours.
const FIREFOX_PREFERENCES = ["browser.aboutwelcome.enabled", "datareporting.policy.dataSubmissionEnabled", "browser.shell.checkDefaultBrowser"].map((name) => `user_pref("${name}", false);\n`).join("");

const { CHROMIUM, FIREFOX, WEBKIT } = process.env;
const sandbox = process.getuid?.() === 0 ? ["--no-sandbox"] : [];
const all = {};
try {
  all.Chromium = await seen("Chromium", CHROMIUM, (home) => ["--headless", "--disable-gpu", "--no-first-run", ...sandbox, `--user-data-dir=${home}`, "--window-size=1280,900", page]);
  if (FIREFOX) all.Firefox = await seen("Firefox", FIREFOX, (home) => {
    writeFileSync(join(home, "user.js"), FIREFOX_PREFERENCES);
    return ["--headless", "--no-remote", "--profile", home, "--width", "1280", "--height", "900", page];
  });
  if (WEBKIT) {
    const shown = await screen();
    try {
      all.WebKit = await seen("WebKit", WEBKIT, () => ["--private", "--geometry=1280x900", page], { DISPLAY: `:${shown.name}`, GDK_BACKEND: "x11", NO_AT_BRIDGE: "1" });
    } finally {
      await shown.end();
    }
  }
  for (const [name, found] of Object.entries(all)) {
    assert.deepEqual(found.troubles, [], name);
    assert.deepEqual(found, all.Chromium, name);
  }
  console.log(JSON.stringify(Object.keys(all)));
} finally {
  server.closeAllConnections();
  server.close();
}
