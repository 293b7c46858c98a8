// Runs the WebAssembly image of the conformance program: node conformance.mjs IMAGE.
import { readFileSync, writeSync } from 'node:fs';

const lines = [];
const print = (text, length) => {
  lines.push(Buffer.from(new Uint8Array(instance.exports.memory.buffer, text, length)));
};
const { instance } = await WebAssembly.instantiate(readFileSync(process.argv[2]), { env: { print } });
const code = instance.exports.run();
writeSync(1, Buffer.concat(lines));
process.exitCode = code;
