// An ST7789 of 240x240 pixels, as its data sheet has it take commands and data over SPI.

const SIDE = 240;
// The pins of select, of data or command, and of reset.
const [SELECT, DATA, RESET] = [17, 20, 21];
// The bits of the bus's clock polarity and phase, both of which a module without select needs.
const MODE_3 = 0xc0;
const [COLUMNS, ROWS, WRITE, ON, OFF, SLEEP, WAKE, FORMAT] = [0x2a, 0x2b, 0x2c, 0x29, 0x28, 0x10, 0x11, 0x3a];

export class St7789 {
  constructor() {
    // It holds anything when it gets power.
    this.memory = Uint16Array.from({ length: SIDE * SIDE }, (_, index) => (index * 37) & 0xffff);
    [this.on, this.awake, this.format] = [false, false, 0];
    this.bytes = 0;
    this.command = 0;
    this.values = [];
    this.window = { [COLUMNS]: [0, SIDE - 1], [ROWS]: [0, SIDE - 1] };
    this.at = [0, 0];
  }

  // Puts it on a bus whose bytes take as long as the bus's registers say, or no time.
  attach(chip, bus, timed) {
    bus.onTransmit = (byte) => {
      this.bytes += 1;
      if ((bus.control0 & MODE_3) !== MODE_3) throw new Error('the bus is not in SPI mode 3');
      if (chip.gpio[RESET].value === 0) throw new Error('a byte is sent while the panel is being reset');
      // 0 is low.
      if (chip.gpio[SELECT].value === 0) this.take(byte, chip.gpio[DATA].value === 1);
      if (!timed) return bus.completeTransmit(0);
      chip.clock.createAlarm(() => bus.completeTransmit(0)).schedule((8e9 / bus.clockFrequency));
    };
  }

  take(byte, isData) {
    if (!isData) {
      [this.command, this.values] = [byte, []];
      if (byte === WRITE) this.at = [this.window[COLUMNS][0], this.window[ROWS][0]];
      if (byte === ON || byte === OFF) this.on = byte === ON;
      if (byte === SLEEP || byte === WAKE) this.awake = byte === WAKE;
      return;
    }
    this.values.push(byte);
    const values = this.values;
    if (this.command === WRITE && values.length === 2) {
      this.write((values[0] << 8) | values[1]);
      this.values = [];
    } else if (this.command in this.window && values.length === 4) {
      this.window[this.command] = [(values[0] << 8) | values[1], (values[2] << 8) | values[3]];
    } else if (this.command === FORMAT) {
      this.format = byte & 7;
    }
  }

  write(pixel) {
    const [column, row] = this.at;
    if (column >= SIDE || row > this.window[ROWS][1]) throw new Error(`a pixel for column ${column}, row ${row}`);
    this.memory[row * SIDE + column] = pixel;
    this.at = column === this.window[COLUMNS][1] ? [this.window[COLUMNS][0], row + 1] : [column + 1, row];
  }

  // Its pixels, row by row, of 5, 6 and 5 bits.
  picture() {
    const shows = this.on && this.awake && this.format === 5;
    return shows ? this.memory.slice() : new Uint16Array(SIDE * SIDE);
  }
}
