// A worker that converts motions: the encoder, compiled to WebAssembly. A worker is for one motion; its memory goes with it.
import { started } from "./wasm.js";

const OUTPUTS = { CLIP: 1, HEADER: 2, RIG: 3, POSES: 4, GLB: 5 };

let module;
let told = -1;

function progress(part) {
  if (part - told < 0.01 && part < 1) return;
  told = part;
  postMessage({ progress: Math.max(0, Math.min(1, part)) });
}

async function convert({ files, options }) {
  module = await started(new URL("pantin-converter.wasm", import.meta.url), { progress });
  for (const { name, bytes } of files) module.give(name, new Uint8Array(bytes));
  const begun = performance.now();
  const good = module.exports.convert(...module.put(new TextEncoder().encode(JSON.stringify(options))));
  const seconds = (performance.now() - begun) / 1000;
  const report = module.report();
  if (!good) return { refused: report };
  const [clip, header, rig, poses, glb] = [OUTPUTS.CLIP, OUTPUTS.HEADER, OUTPUTS.RIG, OUTPUTS.POSES, OUTPUTS.GLB].map(module.output);
  return { report, clip, header, rig, poses: new Int32Array(poses.buffer), glb, seconds };
}

onmessage = async ({ data }) => {
  try {
    postMessage(await convert(data));
  } catch (error) {
    const trapped = error instanceof WebAssembly.RuntimeError;
    postMessage({ error: trapped ? `The converter stopped: ${module.reason(error)}` : error.message });
  }
};
