// Validates the files that are named by Khronos' gltf-validator, and prints its errors and warnings as one line of JSON.
import { createRequire } from "node:module";
import { readFileSync } from "node:fs";

const [folder, ...files] = process.argv.slice(2);
const validator = createRequire(`${folder}/`)("gltf-validator");
const report = [];
for (const file of files) {
  const { issues } = await validator.validateBytes(new Uint8Array(readFileSync(file)));
  // 0 are errors and 1 warnings; the rest is advice.
  report.push(issues.messages.filter((message) => message.severity < 2).map((message) => `${message.pointer}: ${message.message}`));
}
console.log("PANTIN " + JSON.stringify(report));
