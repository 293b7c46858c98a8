// Characters of the solid figure as the element reads them: `node looks.mjs LIST`. The list has texts with the bytes that the library compiles of each, or the error
// that it reports. Text and bytes are the same character, and errors the same ones.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { lookOf } from "../../web/packages/player/looks.js";
import { STANDARD } from "../../web/packages/player/solid.js";

const REACH_AT = 86;
const outcome = (bytes) => {
  try {
    return lookOf(bytes, STANDARD);
  } catch (error) {
    assert.equal(error.constructor, Error, error.stack);
    return error.message;
  }
};
const summary = { characters: 0, attachments: 0, refused: 0, damaged: 0 };
for (const { text, bytes, error } of JSON.parse(readFileSync(process.argv[2]))) {
  const found = outcome(new TextEncoder().encode(text));
  if (error) {
    assert.equal(found, error, text);
    summary.refused++;
    continue;
  }
  const compiled = Uint8Array.from(bytes);
  assert.deepEqual(found, outcome(compiled), text);
  assert.deepEqual(found.reaches, [...compiled.subarray(REACH_AT, REACH_AT + 3)].map((reach) => 4 * reach), text);
  summary.characters++;
  summary.attachments += found.attachments.length;
  // Bytes that end early, and more of them.
  for (const wrong of [compiled.subarray(0, -1), Uint8Array.of(...compiled, 0), compiled.subarray(0, 9)]) {
    assert.equal(outcome(wrong), "these bytes are no character");
    summary.damaged++;
  }
}
assert.ok(summary.characters > 100 && summary.attachments > 50 && summary.refused > 100, JSON.stringify(summary));
console.log(JSON.stringify(summary));
