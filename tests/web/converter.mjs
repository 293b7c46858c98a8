// The page's converter alone, in node: `node converter.mjs MODULE FOLDER-OF-ODD-MOTIONS`. Its notes and errors are those that notes.json lists, and a body and its
// face become one clip.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";

const [, , path, folder] = process.argv;
const module = new WebAssembly.Module(readFileSync(path));
const [REPORT, CLIP, HEADER, RIG, POSES] = [0, 1, 2, 3, 4];
const utf8 = (text) => new TextEncoder().encode(text);

// Converts files, as names and texts, in an instance of its own, as a worker does.
function convert(files, options) {
  const parts = [];
  let panicked = "";
  const env = {
    progress: (part) => parts.push(part),
    panicked: (place, length) => (panicked = new TextDecoder().decode(new Uint8Array(wasm.memory.buffer, place, length))),
  };
  const wasm = new WebAssembly.Instance(module, { env }).exports;
  const put = (bytes) => {
    const place = wasm.room(bytes.length);
    new Uint8Array(wasm.memory.buffer, place, bytes.length).set(bytes);
    return place;
  };
  const output = (which) => {
    const at = wasm.output(which);
    return new Uint8Array(wasm.memory.buffer, Number(at & 0xffffffffn), Number(at >> 32n)).slice();
  };
  for (const [name, content] of files) {
    const [letters, bytes] = [utf8(name), typeof content === "string" ? utf8(content) : content];
    wasm.give(put(letters), letters.length, put(bytes), bytes.length);
  }
  const words = utf8(JSON.stringify({ max_error_cm: 0.5, effort: "fast", ...options }));
  let good;
  try {
    good = wasm.convert(put(words), words.length);
  } catch (error) {
    throw new Error(panicked || error.message);
  }
  return { good, report: JSON.parse(new TextDecoder().decode(output(REPORT))), clip: output(CLIP), sizes: [CLIP, HEADER, RIG, POSES].map((which) => output(which).length), parts };
}

const read = (name) => [name, new Uint8Array(readFileSync(`${folder}/${name}`))];
const listed = JSON.parse(readFileSync(`${folder}/notes.json`));
assert.ok(listed.length >= 5);
for (const { file, fps, outcome } of listed) {
  const { good, report, sizes } = convert([read(file)], { fps });
  assert.equal(good === 1, outcome.notes !== undefined, file);
  const { kind, setting, remedy } = report;
  const found = good ? { notes: report.notes.map(({ severity, kind }) => `${severity} ${kind}`) } : { kind, setting, remedy };
  assert.deepEqual(found, outcome, file);
  for (const { text } of report.notes ?? [report]) assert.ok(text.length > 5 && !text.includes("--"), text);
  if (good) assert.ok(sizes.every((size) => size > 0) && sizes[3] === 4 * report.frames * report.channels, `${file} ${sizes}`);
}

// A body and its face, in either order; other files are named, whatever they are.
const frames = 30;
const body = read("guessed-unit.bvh");
const face = ["face.csv", `time,JawOpen,Smile\n${Array.from({ length: frames }, (_, frame) => `${(frame / 25).toFixed(3)},${Math.sin(frame).toFixed(3)},0.5`).join("\n")}\n`];
const sources = ({ notes }) => notes.filter(({ kind }) => kind === "sources").map(({ file, text, severity }) => `${severity} ${file}: ${text}`);
for (const files of [[body, face], [face, body]]) {
  const { good, report } = convert(files, {});
  assert.ok(good, report.text);
  assert.deepEqual(sources(report), ["info face.csv: body and face are one clip"]);
  assert.deepEqual([report.stem, report.channels], ["guessed-unit", 14]);
  assert.ok(report.notes.some(({ kind }) => kind === "joined"));
}
const many = convert([body, ["other.bvh", body[1]], face, ["notes.txt", "a word"], ["broken.csv", "a,b\n1"]], {});
assert.ok(many.good, many.report.text);
assert.deepEqual(sources(many.report).map((text) => text.slice(0, 45)), [
  "warning notes.txt: left out: nothing refers t",
  "warning other.bvh: left out: one body can be ",
  "warning broken.csv: left out: broken.csv:2: 1",
  "info face.csv: body and face are one clip",
]);
// A face whose values the body has already is left out, and the body is converted.
const twice = convert([["one.csv", face[1]], ["two.csv", face[1]]], {});
assert.deepEqual(sources(twice.report), ["warning two.csv: left out: one face can be converted at a time"]);

// A motion with keys becomes a key clip or segments, whichever is smaller, and a note has the bytes of both.
const own = (name) => [name.split("/").pop(), new Uint8Array(readFileSync(new URL(`../../motions/${name}`, import.meta.url)))];
for (const [name, cm, hasKeys] of [["walk.keys", 0.5, true], ["library/bow.keys", 3, false]]) {
  const { good, report, clip } = convert([own(name)], { max_error_cm: cm });
  assert.ok(good, report.text);
  assert.equal(clip[2], hasKeys ? 2 : 1, name);
  const { text, remedy } = report.notes.find(({ kind }) => kind === "keys");
  const [first, second] = text.match(/\d+/g).map(Number);
  assert.equal(first, clip.length, text);
  assert.ok(hasKeys ? second > first : second >= first, text);
  assert.equal(remedy, hasKeys ? "write-segments" : null);
}

// Refusals, by what is refused.
const refused = (files, options) => {
  const { good, report, sizes } = convert(files, options);
  assert.equal(good, 0);
  assert.ok(sizes.every((size) => size === 0));
  return [report.kind, report.setting, report.remedy, report.place];
};
assert.deepEqual(refused([body], { max_error_cm: 0 }), ["setting", "max-error", null, "guessed-unit.bvh"]);
assert.deepEqual(refused([body], { fps: 1e9 }).slice(0, 2), ["setting", "frame-rate"]);
assert.deepEqual(refused([["alone.amc", ":FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 0 0 0 0 0\n"]], {}).slice(0, 3), ["source", null, "give-skeleton"]);
// Keys that ask for more frames than memory holds: while they are read, and before the fit.
const keys = (seconds) => [["long.gltf", lengthened(seconds)]];
function lengthened(seconds) {
  const gltf = JSON.parse(new TextDecoder().decode(read("helpers.gltf")[1]));
  const bytes = Buffer.from(gltf.buffers[0].uri.split(",")[1], "base64");
  const times = gltf.accessors[0];
  bytes.writeFloatLE(seconds, 4 * (times.count - 1));
  times.max = [Math.fround(seconds)];
  gltf.buffers[0].uri = `data:application/octet-stream;base64,${bytes.toString("base64")}`;
  return JSON.stringify(gltf);
}
const words = [100_000, 5000].map((seconds) => refused(keys(seconds), { fps: 100 }));
assert.deepEqual(words.map(([kind, , remedy]) => [kind, remedy]), [["memory", "lower-frame-rate"], ["memory", "raise-memory"]]);

console.log(`${listed.length} odd motions, ${convert([body], {}).parts.length} steps of progress`);
