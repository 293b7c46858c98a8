// An SSD1306 of 128x64 pixels, as its data sheet has it take commands and data over I2C.

const ADDRESS = 0x3c;
const [WIDTH, PAGES] = [128, 8];

// The Pico's pins, and the state of one that is an output and low.
const [SDA, SCL] = [4, 5];
const LOW = 0;

// Registers of the bus: target address, data, enable, the abort's source; the bits of an abort and of the controller being on.
const [TARGET, DATA_CMD, ABORT_SOURCE] = [0x04, 0x10, 0x80];
const [ABORTED, ENABLED] = [1 << 6, 1];

// Arguments that follow a command.
const ARGUMENTS = {
  0x20: 1, 0x21: 2, 0x22: 2, 0x26: 6, 0x27: 6, 0x29: 5, 0x2a: 5, 0x81: 1, 0x8d: 1, 0xa3: 2, 0xa8: 1, 0xd3: 1, 0xd5: 1, 0xd9: 1, 0xda: 1,
  0xdb: 1,
};

export class Ssd1306 {
  constructor() {
    this.bytes = 0;
    this.plugged = true;
    this.powerOn();
  }

  powerOn() {
    // It holds anything when it gets power.
    this.memory = Uint8Array.from({ length: WIDTH * PAGES }, (_, index) => (index * 37) & 0xff);
    this.lit = false;
    this.mode = 2;
    [this.page, this.column] = [0, 0];
    [this.columns, this.pages] = [[0, WIDTH - 1], [0, PAGES - 1]];
    this.command = [];
    this.control = null;
  }

  // "in": it gets power. "out": it has none, and nobody answers, as where its wires are swapped. "stuck": nor can anything be sent, since a wire
  // holds the bus low. "amid a byte": the chip was reset while it sent a bit, and it holds SDA for five clocks.
  plug(state) {
    this.plugged = state === 'in' || state === 'amid a byte';
    this.stuck = state === 'stuck';
    this.clocks = state === 'amid a byte' ? 5 : 0;
    this.powerOn();
    this.level();
    if (!this.stuck) this.held?.();
    this.held = null;
  }

  // What the chip reads of its pins.
  level() {
    this.sda?.setInputValue(!this.stuck && !this.clocks);
    this.scl?.setInputValue(!this.stuck);
  }

  // Puts it on a bus whose bytes take as long as the bus's registers say, or no time.
  attach(chip, bus, timed) {
    [this.sda, this.scl] = [chip.gpio[SDA], chip.gpio[SCL]];
    this.level();
    this.scl.addListener((state) => {
      if (state !== LOW || !this.clocks) return;
      this.clocks -= 1;
      this.level();
    });
    const bit = () => (1e9 * (bus.sclLowPeriod + bus.sclHighPeriod)) / chip.clkSys;
    const after = (bits, then) => {
      if (!timed) return then();
      chip.clock.createAlarm(then).schedule(bits * bit());
    };
    const start = () => after(1, () => bus.completeStart());
    bus.onStart = () => (this.stuck ? (this.held = start) : start());
    bus.onConnect = (address) => {
      this.control = null;
      this.bytes += 1;
      after(9, () => bus.completeConnect(this.plugged && !this.clocks && address === ADDRESS));
    };
    bus.onWriteByte = (byte) => {
      // Without power it takes nothing of a transfer that goes on.
      if (this.plugged) this.take(byte);
      this.bytes += 1;
      after(9, () => bus.completeWrite(this.plugged));
    };
    bus.onStop = () => after(1, () => bus.completeStop());
    // Where the emulator is less strict than the chip (RP2040 data sheet, 4.3.9 and 4.3.17): after an abort the transmit queue drops everything until
    // the register that clears the abort is read; reading the abort's source does not clear it; the target is set only while the controller is off.
    const [read, write] = [bus.readUint32.bind(bus), bus.writeUint32.bind(bus)];
    bus.readUint32 = (offset) => (offset === ABORT_SOURCE ? bus.abortSource : read(offset));
    bus.writeUint32 = (offset, value) => {
      if (offset === DATA_CMD && bus.intRaw & ABORTED) return;
      if (offset === TARGET && bus.enable & ENABLED) throw new Error('the target is set while the controller is on');
      write(offset, value);
    };
  }

  take(byte) {
    if (this.control === null) {
      if (byte & 0x3f) throw new Error(`control byte 0x${byte.toString(16)}`);
      this.control = byte;
      return;
    }
    if (this.control & 0x40) this.write(byte);
    else this.obey(byte);
    // Another control byte follows where the first bit says so.
    if (this.control & 0x80) this.control = null;
  }

  obey(byte) {
    this.command.push(byte);
    const [code, ...values] = this.command;
    if (values.length < (ARGUMENTS[code] ?? 0)) return;
    this.command = [];
    if (code === 0x20) this.mode = values[0] & 3;
    else if (code === 0x21) [this.columns, this.column] = [values.map((value) => value & 127), values[0] & 127];
    else if (code === 0x22) [this.pages, this.page] = [values.map((value) => value & 7), values[0] & 7];
    else if (code >= 0xb0 && code < 0xb8) this.page = code & 7;
    else if (code < 0x10) this.column = (this.column & 0x70) | code;
    else if (code < 0x20) this.column = (this.column & 0x0f) | ((code & 7) << 4);
    else if (code === 0xae || code === 0xaf) this.lit = code === 0xaf;
  }

  write(byte) {
    this.memory[this.page * WIDTH + this.column] = byte;
    if (this.mode === 2) {
      this.column = (this.column + 1) % WIDTH;
      return;
    }
    if (this.column !== this.columns[1]) {
      this.column += 1;
      return;
    }
    this.column = this.columns[0];
    this.page = this.page === this.pages[1] ? this.pages[0] : this.page + 1;
  }

  // Its pixels, row by row: 0 or 1.
  picture() {
    const pixel = (index) => (this.memory[(index >> 10) * WIDTH + (index % WIDTH)] >> ((index >> 7) & 7)) & 1;
    return Uint16Array.from({ length: WIDTH * PAGES * 8 }, (_, index) => (this.lit ? pixel(index) : 0));
  }
}
