// Reads an image as one drags it onto the board: blocks of 512 bytes, each with a part of the flash and its address.

const BLOCK = 512;
const RP2040 = 0xe48bff56;

// Puts the parts of an image into the chip's flash.
export function load(image, flash) {
  if (image.length === 0 || image.length % BLOCK) throw new Error(`an image of ${image.length} bytes, no number of whole blocks`);
  for (let at = 0; at < image.length; at += BLOCK) {
    const word = (index) => image.readUInt32LE(at + 4 * index);
    const magics = word(0) === 0x0a324655 && word(1) === 0x9e5d5157 && image.readUInt32LE(at + BLOCK - 4) === 0x0ab16f30;
    if (!magics || word(7) !== RP2040) throw new Error(`block ${at / BLOCK} is none for this chip`);
    flash.set(image.subarray(at + 32, at + 32 + word(4)), word(3) - 0x10000000);
  }
}
