// Instances of the WebAssembly modules, each of which all players share. A module's memory is divided here, in blocks that are used again.

const modules = {};

// The module of a URL. What failed is tried again by the next clip.
export const open = (url) => (modules[url] ??= start(url).catch((error) => {
  delete modules[url];
  throw error;
}));

async function start(url) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status}`);
  const { instance } = await WebAssembly.instantiate(await response.arrayBuffer());
  const free = {};
  let end = (instance.exports.base() + 15) & -16;
  return {
    ...instance.exports,
    // The address of a new block of `size` bytes, a multiple of 16.
    take(size) {
      const known = free[size]?.pop();
      if (known) return known;
      const { memory } = instance.exports;
      const missing = end + size - memory.buffer.byteLength;
      if (missing > 0) memory.grow(Math.ceil(missing / 65536));
      end += size;
      return end - size;
    },
    give: (place, size) => (free[size] ??= []).push(place),
  };
}

const bytes = (wasm, place, length) => new Uint8Array(wasm.memory.buffer, place, length);

function release({ wasm, blocks }) {
  for (const [place, size] of blocks.splice(0)) wasm.give(place, size);
}
const gone = globalThis.FinalizationRegistry && new FinalizationRegistry(release);

// Memory of a player: `close` gives it back, and so does the garbage collector when `owner` is gone.
export function seat(wasm, owner) {
  const held = { wasm, blocks: [] };
  gone?.register(owner, held);
  return {
    take(size) {
      // Sizes of files are powers of two.
      size = size === wasm.slot() ? size : 2 ** Math.max(12, Math.ceil(Math.log2(size)));
      let place;
      try {
        place = wasm.take(size);
      } catch {
        throw new Error("there is not enough memory");
      }
      held.blocks.push([place, size]);
      return place;
    },
    close: () => release(held),
  };
}

const STROKE = 12;
// Passes the strokes that the module has at an address.
function strokes(wasm, place, count, stroke) {
  const view = new DataView(wasm.memory.buffer, place, STROKE * count);
  for (let at = 0; at < STROKE * count; at += STROKE) {
    const end = (offset) => view.getInt16(at + offset, true);
    stroke(end(0), end(2), end(4), end(6), view.getUint8(at + 8), view.getUint8(at + 9), view.getUint8(at + 10));
  }
}

export { bytes, strokes };
