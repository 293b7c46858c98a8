// The chip: an image in its flash, run until something says enough.

import { readFileSync } from 'node:fs';
import { LogLevel, ConsoleLogger, RP2040 } from 'rp2040js';
import { Rom } from './rom.mjs';
import { load } from './uf2.mjs';

// `mov r9, r9` and `mov r10, r10`: the firmware's markers, around each stretch that is measured.
const [START, STOP] = [0x46c9, 0x46d2];
const FLASH = 0x10000000;
// Where the boot ROM ends, and in which part of the addresses the RAM lies.
const [ROM_END, RAM] = [0x4000, 0x2];
// Nanoseconds of a step while the program hangs.
const HANGS = 1e6;
// Instructions between looks at the time.
const STRIDE = 4096;

export class Chip {
  // `images` are put into the flash one after the other: UF2 files, or all bytes of the flash. `vectors` is the address of the program's vector
  // table: the chip's boot ROM, which would have gone there, is no part of the emulator. `cut` is as in rom.mjs.
  constructor(images, vectors, cut) {
    const chip = new RP2040();
    // It warns of every register that it does not model.
    chip.logger = new ConsoleLogger(LogLevel.Error, false);
    for (const path of images) {
      if (path.endsWith('.uf2')) load(readFileSync(path), chip.flash);
      else chip.flash.set(readFileSync(path));
    }
    chip.core.VTOR = vectors;
    chip.core.SP = chip.readUint32(vectors);
    chip.core.PC = chip.readUint32(vectors + 4) & ~1;
    // Buttons are pulled up.
    for (const pin of [10, 11, 12, 13, 14]) chip.gpio[pin].setInputValue(true);
    // The emulator enters a handler with the vector's lowest bit in the program counter, which handlers with tables of jumps add to.
    const enter = chip.core.exceptionEntry.bind(chip.core);
    chip.core.exceptionEntry = (number) => {
      enter(number);
      chip.core.PC &= ~1;
    };
    this.chip = chip;
    this.ended = null;
    this.rom = new Rom(chip, { cut, end: this });
    // Called with the cycles of each marked stretch.
    this.onStretch = () => {};
    chip.onBreak = (code) => this.break(code);
    const watchdog = chip.peripherals[0x40058];
    watchdog.onWatchdogTrigger = () => {
      // It would bite for ever.
      watchdog.alarm.enable = false;
      this.end('watchdog');
    };
    this.hangs = false;
  }

  // In nanoseconds since the start.
  get time() {
    return this.chip.clock.nanos;
  }

  // Runs until `end` was called, or for a number of seconds of the chip's own time.
  run(seconds) {
    const { chip } = this;
    const { core, clock, flash16 } = chip;
    const isMemory = (pc) => pc < ROM_END || pc >>> 28 === RAM || (pc >= FLASH && pc < FLASH + flash16.length * 2);
    const nanos = 1e9 / 125e6;
    let begun = 0;
    for (let count = 0; this.ended === null; count += 1) {
      if (core.waiting || this.hangs) {
        clock.tick(this.hangs ? HANGS : Math.max(clock.nanosToNextAlarm, nanos));
        // An interrupt ends the sleep, also one that is held back; the emulator forgets that of the processor's own timer.
        if (core.pendingSystick || core.pendingInterrupts & core.enabledInterrupts) core.waiting = false;
        if (this.time > seconds * 1e9) this.end('limit');
        continue;
      }
      const at = core.PC - FLASH;
      const opcode = flash16[at >> 1];
      clock.tick(core.executeInstruction() * nanos);
      if (opcode === START) begun = core.cycles;
      else if (opcode === STOP) this.onStretch(core.cycles - begun);
      if (count % STRIDE === 0) {
        if (this.time > seconds * 1e9) this.end('limit');
        if (!isMemory(core.PC)) throw new Error(`the program went astray, to 0x${core.PC.toString(16)}`);
      }
    }
    return this.ended;
  }

  // A failure after a number of seconds: a fault of the processor, or a hang.
  harm(kind, seconds) {
    const { chip } = this;
    const strike = () => {
      if (kind === 'hang') this.hangs = true;
      else chip.core.PC = chip.readUint32(chip.core.VTOR + 12) & ~1;
    };
    chip.clock.createAlarm(strike).schedule(seconds * 1e9);
  }

  end(why) {
    this.ended ??= why;
  }

  // The boot ROM's functions, or semihosting: what the conformance image prints and ends with. Any other breakpoint ends the run.
  break(code) {
    const { chip } = this;
    if (chip.core.PC < ROM_END) return this.rom.call(code);
    const { registers } = chip.core;
    const word = (index) => chip.readUint32(registers[1] + 4 * index);
    if (code !== 0xab) return this.end(`breakpoint ${code}`);
    switch (registers[0]) {
      case 0x01: // open
        registers[0] = 1;
        break;
      case 0x05: // write
        for (let index = 0; index < word(2); index += 1) this.printed.push(chip.readUint8(word(1) + index));
        registers[0] = 0;
        break;
      case 0x20: // exit
        this.end(`code ${word(1)}`);
        break;
      default:
        registers[0] = 0xffffffff;
    }
  }

  printed = [];
}
