// node run.mjs REQUEST: runs an image, and prints what came of it as JSON.
//
// The request is a JSON file:
//   image     an UF2 file, and vectors, the address of its vector table
//   display   "ssd1306", "st7789" or null; timed: whether the buses take the time that they are set to, or none
//   keys      where the program is to play in step: letters before each picture but the first, as arrays of bytes; else null
//   pictures  where it plays at its own pace: as many are waited for
//   servos    how many writes of pulse widths are waited for
//   harm      "fault", "hang" or null: what strikes after a tenth of a second
//   seconds   of the chip's time at most
//   out       a file for the pictures: their pixels, 16 bits each with the low byte first; the last one is what is shown at the end

import { closeSync, openSync, readFileSync, writeSync } from 'node:fs';
import { Chip } from './chip.mjs';
import { Ssd1306 } from './ssd1306.mjs';
import { St7789 } from './st7789.mjs';

const [IN_STEP, NEXT, SHOWN] = [0x16, 0x0a, 0x46];
// Marked stretches of a frame: decode, place, draw, show.
const STRETCHES = 4;
// Register of a pair of pulse widths.
const COMPARE = 0x0c;

const request = JSON.parse(readFileSync(process.argv[2]));
const machine = new Chip(request.image, request.vectors);
const { chip } = machine;
const [line] = chip.uart;
const display = request.display && new { ssd1306: Ssd1306, st7789: St7789 }[request.display]();
if (request.display === 'ssd1306') display.attach(chip, chip.i2c[0], request.timed);
if (request.display === 'st7789') display.attach(chip, chip.spi[0], request.timed);

const out = request.out && openSync(request.out, 'w');
const frames = [];
const pulses = [];
let cycles = [];
let bytes = 0;

machine.onStretch = (count) => {
  cycles.push(count);
  if (cycles.length < STRETCHES) return;
  frames.push({ cycles, nanos: machine.time, bytes: (display?.bytes ?? 0) - bytes, number: null });
  cycles = [];
  bytes = display?.bytes ?? 0;
  if (out) writeSync(out, Buffer.from(display.picture().buffer));
  if (!request.keys && frames.length === request.pictures) machine.end('done');
};

// The line's other end: a frame's number, in four bytes, is answered with letters and the wish for another picture.
const told = [];
line.onByte = (byte) => {
  told.push(byte);
  if (told[0] !== SHOWN) throw new Error(`the firmware sent 0x${byte.toString(16)} in place of a frame's number`);
  if (told.length < 5) return;
  frames.at(-1).number = Buffer.from(told.splice(0)).readUInt32LE(1);
  const letters = request.keys[frames.length - 1];
  if (!letters) return machine.end('done');
  [...letters, NEXT].forEach((letter) => line.feedByte(letter));
};
if (request.keys) {
  // As soon as it listens.
  const set = line.writeUint32.bind(line);
  line.writeUint32 = (offset, value) => {
    const deaf = !line.enabled;
    set(offset, value);
    if (deaf && line.enabled) line.feedByte(IN_STEP);
  };
}

chip.pwm.channels.forEach((channel, index) => {
  const set = channel.writeRegister.bind(channel);
  channel.writeRegister = (offset, value) => {
    if (offset === COMPARE) pulses.push({ channel: index, value, nanos: machine.time });
    if (request.servos && pulses.length === request.servos) machine.end('done');
    set(offset, value);
  };
});

if (request.harm) machine.harm(request.harm, 0.1);
const ended = machine.run(request.seconds);
if (out) {
  writeSync(out, Buffer.from(display.picture().buffer));
  closeSync(out);
}
const slices = chip.pwm.channels.map(({ top, div }) => ({ top, div }));
console.log(JSON.stringify({ ended, frames, pulses, slices, printed: Buffer.from(machine.printed).toString() }));
