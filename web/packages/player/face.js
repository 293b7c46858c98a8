// What <pantin-player> loads for a clip with scalars: the face that they drive.
import { LIVE_LINK } from "@pantin/decoder/names.js";
import { faceLinesOf } from "./face-lines.js";
import { FACE_MODEL } from "./face-model.js";

export { LIVE_LINK };

// Of a clip: what draws its scalars; those that are not a face's are bars, in a rig without joints. `maths` is that of figure.js.
export async function faceOf({ rig, joints, scalars }, maths) {
  const first = rig.channels - scalars.length;
  // The model is text, each letter a byte modulo 256.
  const bytes = Uint8Array.from(FACE_MODEL, (letter) => letter.charCodeAt());
  const face = faceLinesOf(bytes, rig.scalarBytes, scalars.length, first, LIVE_LINK, maths);
  if (face) return { isFace: true, ...face };
  if (joints.length) return { aim() {}, each() {} };
  const { barsOf } = await import("./pantin-bars.js");
  return barsOf(first);
}
