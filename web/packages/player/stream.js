// What <pantin-player> loads for a file that takes a while to arrive: the clip is opened again and again, and plays as far as it has come.

const MOST = 64 << 20;

// The bytes of all that a player receives. `open` opens what has come of a clip, and resolves with what is wrong with it; `problem` makes an error of that; `tell` shows
// the line below the picture again.
export async function arrived(player, stream, signal, open, problem, tell) {
  if (player.total > MOST) throw new Error(`the file has ${player.total} bytes; a clip may have ${MOST} here`);
  const reader = stream.getReader();
  const parts = [];
  let opened = 0;
  const join = async () => {
    const file = new Uint8Array(await new Blob(parts).arrayBuffer());
    signal.throwIfAborted();
    return file;
  };
  try {
    for (;;) {
      const { done, value } = await reader.read().catch(() => ({ done: true }));
      signal.throwIfAborted();
      if (done) return await join();
      parts.push(value);
      const length = (player.received += value.length);
      if (length > MOST) throw new Error(`a clip may have ${MOST} bytes here`);
      // A bank's clips may lie anywhere in it. A clip is looked at again once it has an eighth more, a short one at once.
      if (parts[0][1] === 98) continue;
      if (length < (player.total || Infinity) && length * 8 > opened * 9 - 4096) {
        opened = length;
        const wrong = await open(await join());
        // A file of another kind need not be read to its end.
        if (wrong && wrong !== "ends early") throw problem(wrong);
      }
      const { playable, frames, words } = player;
      const { bytes = "bytes", first = "the first pose is still to come" } = words;
      player.coming = !playable ? `${length} ${bytes}; ${first}` : playable < frames ? `${length} ${bytes}, ${playable} ${words.of} ${frames} ${words.frames}` : "";
      tell();
      player.dispatchEvent(new CustomEvent("progress", { detail: null }));
    }
  } finally {
    player.coming = "";
    reader.cancel().catch(() => {});
  }
}
