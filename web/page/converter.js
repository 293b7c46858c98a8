// A worker that converts motions: the encoder, compiled to WebAssembly. A worker is for one motion; its memory goes with it.
const MODULE = new URL("pantin-converter.wasm", import.meta.url);
const OUTPUTS = { REPORT: 0, CLIP: 1, HEADER: 2, RIG: 3, POSES: 4 };

let wasm;
let told = -1;
let panicked = "";

function text(place, length) {
  return new TextDecoder().decode(new Uint8Array(wasm.memory.buffer, place, length));
}

const env = {
  progress(part) {
    if (part - told < 0.01 && part < 1) return;
    told = part;
    postMessage({ progress: Math.max(0, Math.min(1, part)) });
  },
  panicked(place, length) {
    panicked = text(place, length);
  },
};

function put(bytes) {
  const place = wasm.room(bytes.length);
  new Uint8Array(wasm.memory.buffer, place, bytes.length).set(bytes);
  return place;
}

function output(which) {
  const at = wasm.output(which);
  return new Uint8Array(wasm.memory.buffer, Number(at & 0xffffffffn), Number(at >> 32n)).slice();
}

async function convert({ files, options }) {
  const module = await fetch(MODULE);
  if (!module.ok) throw new Error(`the encoder cannot be fetched: ${module.status}`);
  wasm = (await WebAssembly.instantiate(await module.arrayBuffer(), { env })).instance.exports;
  for (const { name, bytes } of files) {
    const [letters, content] = [new TextEncoder().encode(name), new Uint8Array(bytes)];
    wasm.give(put(letters), letters.length, put(content), content.length);
  }
  const words = new TextEncoder().encode(JSON.stringify(options));
  const begun = performance.now();
  const good = wasm.convert(put(words), words.length);
  const seconds = (performance.now() - begun) / 1000;
  const report = JSON.parse(new TextDecoder().decode(output(OUTPUTS.REPORT)));
  if (!good) return { refused: report };
  const [clip, header, rig, poses] = [OUTPUTS.CLIP, OUTPUTS.HEADER, OUTPUTS.RIG, OUTPUTS.POSES].map(output);
  return { report, clip, header, rig, poses: new Int32Array(poses.buffer), seconds };
}

onmessage = async ({ data }) => {
  try {
    postMessage(await convert(data));
  } catch (error) {
    const trapped = error instanceof WebAssembly.RuntimeError;
    postMessage({ error: trapped ? `The converter stopped: ${panicked || "there is not memory enough"}` : error.message });
  }
};
