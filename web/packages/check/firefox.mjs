// What a page of a headless Firefox answers, by WebDriver BiDi: a fresh profile, one page, one promise of a text.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";

const { ws: WebSocket } = createRequire(`${process.env.PLAYWRIGHT}/`)("playwright-core/lib/utilsBundle");

export async function firefox(program, url, expression) {
  const profile = mkdtempSync(join(tmpdir(), "firefox-"));
  const browser = spawn(program, ["--headless", "--no-remote", "--profile", profile, "--remote-debugging-port", "0", "about:blank"], { stdio: ["ignore", "ignore", "pipe"], env: { ...process.env, MOZ_REMOTE_ALLOW_SYSTEM_ACCESS: "1" } });
  const ended = new Promise((done) => browser.on("exit", done));
  try {
    const address = await new Promise((done, failed) => {
      let said = "";
      browser.stderr.on("data", (text) => {
        said += text;
        const found = /WebDriver BiDi listening on (ws:\S+)/.exec(said);
        if (found) done(found[1]);
      });
      ended.then(() => failed(new Error(`Firefox ended: ${said}`)));
      setTimeout(() => failed(new Error(`Firefox does not answer: ${said}`)), 60000).unref();
    });
    const socket = new WebSocket(`${address}/session`);
    const waiting = new Map();
    await new Promise((done, failed) => (socket.on("open", done), socket.on("error", failed)));
    socket.on("message", (data) => {
      const { id, type, result, message } = JSON.parse(data);
      const [done, failed] = waiting.get(id) ?? [];
      if (type === "success") done?.(result);
      else if (type === "error") failed?.(new Error(message));
    });
    let last = 0;
    const send = (method, params) => new Promise((done, failed) => {
      waiting.set(++last, [done, failed]);
      socket.send(JSON.stringify({ id: last, method, params }));
    });
    await send("session.new", { capabilities: {} });
    const { contexts: [{ context }] } = await send("browsingContext.getTree", {});
    await send("browsingContext.navigate", { context, url, wait: "complete" });
    const { result, exceptionDetails } = await send("script.evaluate", { expression, target: { context }, awaitPromise: true });
    socket.close();
    if (!result) throw new Error(exceptionDetails?.text);
    return result.value;
  } finally {
    browser.kill();
    await ended;
    rmSync(profile, { recursive: true, force: true });
  }
}
