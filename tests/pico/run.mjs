// node run.mjs REQUEST: runs an image, and prints what came of it as JSON.
//
// The request is a JSON file:
//   images    UF2 files, or all bytes of the flash, put into the flash in this order, and vectors, the address of the vector table
//   display   "ssd1306", "st7789" or null; timed: whether the buses take the time that they are set to, or none
//   keys      where the program is to play in step: letters before each picture but the first, as arrays of bytes; else null
//   pictures  where it plays at its own pace: as many are waited for
//   messages  or such that go over the line while it plays, arrays of bytes at the line's speed: the first after a picture, each other one when
//             the one before was answered; after the last answer it waits for this number of pictures
//   usb       whether keys and messages go over the USB port once it is open, and answers come over it. In step, playing begins over the pins
//   deaf      [first, last]: after these pictures, and between them, the PC takes nothing from the USB port; else null
//   packets   whether keys have the wish for the next picture among them, as they share the line with packets
//   servos    how many writes of pulse widths are waited for
//   plugs     when what happens to the SSD1306's wires, in seconds: [[0.1, "out"], ...], as ssd1306.mjs says; or null
//   cables    the same of the USB cable, which then does not supply the board: "out" and "in"; whenever a program on the PC has opened the port, it
//             asks for the list of letters
//   presses   the board's buttons: [[pin, seconds, seconds that it is held], ...]; or null
//   noise     whether a byte with a framing error comes before each byte of a message
//   harm      "fault", "hang" or null: what strikes after a tenth of a second
//   cut       the change of the flash, counted from 0, amid which power goes; else null
//   seconds   of the chip's time at most
//   save      a file for all bytes of the flash at the end, or null
//   every     of how many pictures one is kept
//   out       a file for the pictures: their pixels, 16 bits each with the low byte first; the last one is what is shown at the end

import { closeSync, openSync, readFileSync, writeFileSync, writeSync } from 'node:fs';
import { Chip } from './chip.mjs';
import { Ssd1306 } from './ssd1306.mjs';
import { St7789 } from './st7789.mjs';
import { Pc } from './usb.mjs';

const [IN_STEP, NEXT, SHOWN, HELP] = [0x16, 0x0a, 0x46, 0x3f];
// Marked stretches of a frame: decode, place, draw, show.
const STRETCHES = 4;
// Register of a pair of pulse widths.
const COMPARE = 0x0c;
// Nanoseconds of a byte on the line: ten bits of 115,200 a second.
const BYTE = 10e9 / 115200;
// Nanoseconds in which the last packet over USB arrives.
const LAST = 1e6;
// The bit of the port's data register beside a byte.
const FRAMING_ERROR = 1 << 8;

const request = JSON.parse(readFileSync(process.argv[2]));
const machine = new Chip(request.images, request.vectors, request.cut);
const { chip } = machine;
const [line] = chip.uart;
const display = request.display && new { ssd1306: Ssd1306, st7789: St7789 }[request.display]();
if (request.display === 'ssd1306') display.attach(chip, chip.i2c[0], request.timed);
for (const [seconds, state] of request.plugs ?? []) {
  if (seconds === 0) display.plug(state);
  else chip.clock.createAlarm(() => display.plug(state)).schedule(seconds * 1e9);
}
for (const [pin, seconds, held] of request.presses ?? []) {
  chip.clock.createAlarm(() => chip.gpio[pin].setInputValue(false)).schedule(seconds * 1e9);
  chip.clock.createAlarm(() => chip.gpio[pin].setInputValue(true)).schedule((seconds + held) * 1e9);
}
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
  if (out && frames.length % request.every === 0) writeSync(out, Buffer.from(display.picture().buffer));
  if (request.messages) {
    if (frames.length === 1 && !request.usb) say(request.messages[0]);
    if (answers.length === request.messages.length && frames.length === answers.at(-1).frames + request.pictures) machine.end('done');
  } else if (!request.keys && frames.length === request.pictures) machine.end('done');
};

// Sends bytes one after the other.
const say = (message) => (pc ? pc.send(message) : sayByLine(message));
const sayByLine = ([byte, ...rest]) => {
  const alarm = chip.clock.createAlarm(() => {
    if (request.noise) line.feedByte(FRAMING_ERROR | (byte ^ 0xff));
    line.feedByte(byte);
    if (rest.length > 0) sayByLine(rest);
  });
  alarm.schedule(BYTE);
};

// What the program says over the line before its first picture, or between packets.
const spoken = [];

// A packet ends with a zero, and begins with one.
const answers = [];
let packet = [];
const hear = (byte) => {
  // What the program says as text is no packet.
  if (packet.length === 0 && byte !== 0) return spoken.push(byte);
  packet.push(byte);
  if (byte !== 0 || packet.length === 1) return;
  answers.push({ bytes: packet, frames: frames.length, nanos: machine.time });
  packet = [];
  const next = request.messages[answers.length];
  if (next) say(next);
};

// The line's other end: a frame's number, in four bytes, is answered with letters and the wish for another picture.
const told = [];
line.onByte = (byte) => {
  if (request.messages) return request.usb ? undefined : hear(byte);
  // At its own pace it sends the message of a panic, if anything.
  if (!request.keys) return spoken.push(byte);
  if (frames.length === 0 && byte !== SHOWN) return spoken.push(byte);
  told.push(byte);
  if (told[0] !== SHOWN) throw new Error(`the firmware sent 0x${byte.toString(16)} in place of a frame's number`);
  if (told.length < 5) return;
  frames.at(-1).number = Buffer.from(told.splice(0)).readUInt32LE(1);
  const letters = request.keys[frames.length - 1];
  // What the board has sent over USB is still on its way.
  if (!letters) return pc ? chip.clock.createAlarm(() => machine.end('done')).schedule(LAST) : machine.end('done');
  if (request.deaf && pc.isOpen) pc.reads(frames.length <= request.deaf[0] || frames.length > request.deaf[1]);
  const reply = request.packets ? letters : [...letters, NEXT];
  if (!pc) return reply.forEach((letter) => line.feedByte(letter));
  if (pc.isOpen) return pc.send(reply);
  pc.onOpen = () => pc.send(reply);
};

// What the board sends over USB. In step it says there what it says over the pins.
const usb = [];
const pc =
  request.usb &&
  new Pc(chip, (byte) => {
    usb.push(byte);
    if (request.messages) hear(byte);
  });
if (request.cables) pc.onOpen = () => pc.send([HELP]);
for (const [seconds, state] of request.cables ?? []) {
  chip.clock.createAlarm(() => pc.plug(state === 'in')).schedule(seconds * 1e9);
}
if (request.usb && request.messages) pc.onOpen = () => say(request.messages[0]);
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
if (request.save) writeFileSync(request.save, chip.flash);
const { changes } = machine.rom;
const [bus] = chip.spi;
// The bits of clock polarity and phase.
const spi = { mode: (bus.control0 >> 6) & 3, hz: bus.clockFrequency };
const pulledUp = chip.gpio.flatMap((pin, index) => (pin.pullupEnabled ? [index] : []));
const slices = chip.pwm.channels.map(({ top, div }) => ({ top, div }));
console.log(JSON.stringify({ ended, frames, pulses, slices, answers, changes, spi, pulledUp, spoken, usb, held: pc?.held ?? 0, printed: Buffer.from(machine.printed).toString() }));
