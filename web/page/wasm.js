// A module of web/worker in a worker: files in, results out.
const text = (bytes) => new TextDecoder().decode(bytes);

// Starts the module of an address; what it imports besides is in `own`. `exports` are its functions.
export async function started(address, own = {}) {
  const response = await fetch(address);
  if (!response.ok) throw new Error(`${address.pathname.split("/").at(-1)} cannot be fetched: the server answers ${response.status}`);
  let panicked = "";
  const bytes = (place, length) => new Uint8Array(exports.memory.buffer, place, length);
  const env = { ...own, panicked: (place, length) => (panicked = text(bytes(place, length))) };
  const { exports } = (await WebAssembly.instantiate(await response.arrayBuffer(), { env })).instance;
  // Memory of the module that holds the bytes: an address and a length.
  const put = (content) => {
    const place = exports.room(content.length);
    bytes(place, content.length).set(content);
    return [place, content.length];
  };
  const output = (which) => {
    const at = exports.output(which);
    return bytes(Number(at & 0xffffffffn), Number(at >> 32n)).slice();
  };
  return {
    exports, put, output,
    give: (name, content) => exports.give(...put(new TextEncoder().encode(name)), ...put(content)),
    report: () => JSON.parse(text(output(0))),
    // Why a call failed, in words.
    reason: (error) => (error instanceof WebAssembly.RuntimeError ? panicked || "there is not memory enough" : error.message),
  };
}
