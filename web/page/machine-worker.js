// A worker that compiles texts of state machines: the compiler of `pantin machine`, as WebAssembly.
import { started } from "./wasm.js";

const OUTPUTS = { BANK: 1, GRAPH: 2 };

let module = null;

async function compiled({ bank, name, text }) {
  module ??= await started(new URL("pantin-machine.wasm", import.meta.url));
  module.give("bank", bank);
  module.give(name, new TextEncoder().encode(text));
  const good = module.exports.compile_text();
  const report = module.report();
  if (!good) return { refused: report };
  return { report, bank: module.output(OUTPUTS.BANK), graph: new TextDecoder().decode(module.output(OUTPUTS.GRAPH)) };
}

onmessage = async ({ data }) => {
  try {
    postMessage(await compiled(data));
  } catch (error) {
    const reason = module?.reason(error) ?? error.message;
    // A module that stopped is not called again.
    if (error instanceof WebAssembly.RuntimeError) module = null;
    postMessage({ error: reason });
  }
};
