// The functions of the chip's boot ROM that erase and write the flash (RP2040 data sheet, 2.8.3.1.3), of which the emulator has none: where the
// ROM's table says that one is, there is a breakpoint, which does here what the function does.
//
// From leaving the mapped flash to the second stage of the boot, which maps it again, the flash is no memory: who reads it, and whom an interrupt may
// disturb, is in error. Written bits only become 0, whole pages at a time; erased sectors are all ones.

const [TABLE, LOOKUP] = [0x14, 0x18];
// Where the functions lie, in steps of a breakpoint and a return.
const [FIRST, STEP] = [0x100, 4];
const RETURN = 0x4770;
const [FLASH, MIRRORS] = [0x10000000, 0x14000000];
const [SECTOR, PAGE] = [4096, 256];
// Nanoseconds that a usual flash takes (W25Q16JV, 9.6): a sector, a page.
const [ERASES, WRITES] = [45e6, 0.4e6];
// Registers of the flash's interface.
const [CONTROL, ENABLE, COMMAND] = [0x00, 0x08, 0xf4];
const INTERFACE = 0x18000;

export class Rom {
  // `cut`: power goes amid the change of the flash of this number, counted from 0; else null.
  constructor(chip, { cut, end }) {
    Object.assign(this, { chip, cut, end, changes: 0, connected: false });
    this.functions = [['??', this.lookup], ['IF', this.connect], ['EX', this.exit], ['RE', this.erase], ['RP', this.program], ['FC', this.flush]];
    const words = new Uint16Array(chip.bootrom.buffer);
    words[TABLE / 2] = TABLE;
    words[LOOKUP / 2] = this.address(0);
    this.functions.forEach((_, index) => words.set([0xbe00 | index, RETURN], (FIRST + STEP * index) / 2));
    this.watch(chip.peripherals[INTERFACE]);
  }

  address(index) {
    return (FIRST + STEP * index) | 1;
  }

  // A breakpoint that is one of the functions: the first four registers are its arguments.
  call(code) {
    const [, act] = this.functions[code];
    act.call(this, ...this.chip.core.registers.slice(0, 4));
  }

  lookup(_table, tag) {
    const name = String.fromCharCode(tag & 0xff, tag >> 8);
    const index = this.functions.findIndex(([known]) => known === name);
    if (index < 1) throw new Error(`the program looks for the ROM's function ${name}`);
    this.chip.core.registers[0] = this.address(index);
  }

  connect() {
    this.alone();
    this.connected = true;
  }

  exit() {
    this.alone();
    if (!this.connected) throw new Error('the flash was left before it was connected');
    for (const name of ['readUint8', 'readUint16', 'readUint32']) {
      const read = this.chip[name];
      this.chip[name] = (address) => {
        if (address >>> 0 >= FLASH && address >>> 0 < MIRRORS) throw new Error(`0x${address.toString(16)} is read while the flash is no memory`);
        return read.call(this.chip, address);
      };
    }
    this.left = true;
  }

  erase(offset, count, block) {
    if (offset % SECTOR || count % SECTOR || !block) throw new Error(`${count} bytes from ${offset} on are erased, not whole sectors`);
    for (let at = offset; at < offset + count; at += SECTOR) {
      this.change(ERASES, SECTOR, (part) => this.chip.flash.fill(0xff, at, at + part));
    }
  }

  program(offset, data, count) {
    if (offset % PAGE || count % PAGE) throw new Error(`${count} bytes from ${offset} on are written, not whole pages`);
    const bytes = Array.from({ length: count }, (_, index) => this.chip.readUint8(data + index));
    for (let at = 0; at < count; at += PAGE) {
      this.change(WRITES, PAGE, (part) => {
        for (let index = at; index < at + part; index += 1) this.chip.flash[offset + index] &= bytes[index];
      });
    }
  }

  flush() {
    this.alone();
    this.flushed = true;
  }

  // Changes this number of bytes, or a sixteenth of them where power is cut: not all of a header.
  change(nanos, bytes, make) {
    this.alone();
    if (!this.left) throw new Error('the flash is changed while it is mapped');
    const cut = this.changes === this.cut;
    this.changes += 1;
    if (this.end.ended) return;
    make(cut ? bytes / 16 : bytes);
    this.flushed = false;
    this.chip.clock.tick(nanos);
    if (cut) this.end.end('cut');
  }

  alone() {
    if (!this.chip.core.PM) throw new Error('interrupts are not masked while the flash is changed');
  }

  // The flash is memory again when its interface reads it with four lines and without a command: that is what the second stage sets up last.
  watch(face) {
    const set = face.writeUint32.bind(face);
    face.writeUint32 = (offset, value) => {
      set(offset, value);
      const mapped = offset === ENABLE && value === 1 && ((face.readUint32(CONTROL) >> 21) & 3) === 2 && !(face.readUint32(COMMAND) & 0x300);
      if (!this.left || !mapped) return;
      if (!this.flushed) throw new Error("the flash is mapped while the cache holds what was before it was changed");
      for (const name of ['readUint8', 'readUint16', 'readUint32']) delete this.chip[name];
      Object.assign(this, { left: false, connected: false });
    };
  }
}
