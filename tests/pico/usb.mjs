// The PC at the other end of the USB port: it enumerates the board, opens the serial port, and sends and receives bytes.

import { USBCDC } from 'rp2040js';

// The chip's identification, of silicon version 2: version 1, which the emulator reports, needs a workaround (RP2040-E5) that drives the port's
// wires, and these are not modelled.
const [SYSINFO, CHIP_ID, VERSION_2] = [0x40000, 0, 0x20002927];

export class Pc {
  // `onByte` hears what the board sends.
  constructor(chip, onByte) {
    const info = chip.peripherals[SYSINFO];
    const read = info.readUint32.bind(info);
    info.readUint32 = (offset) => (offset === CHIP_ID ? VERSION_2 : read(offset));
    this.usb = chip.usbCtrl;
    this.isOpen = false;
    this.onOpen = () => {};
    // Packets that arrived.
    this.packets = 0;
    this.unsent = [];
    // The size of the buffer that the board waits with, or null.
    this.room = null;
    const port = new USBCDC(this.usb);
    this.port = port;
    port.onDeviceConnected = () => {
      this.isOpen = true;
      this.onOpen();
    };
    port.onSerialData = (bytes) => {
      this.packets += 1;
      bytes.forEach((byte) => onByte(byte));
    };
    // The emulator answers at once, with an empty packet if there is no byte; a PC sends none of these.
    this.usb.onEndpointRead = (endpoint, size) => {
      if (endpoint !== port.outEndpoint) return;
      this.room = size;
      this.fill();
    };
  }

  // Sends bytes, in packets, as the board takes them.
  send(bytes) {
    this.unsent.push(...bytes);
    this.fill();
  }

  fill() {
    if (this.room === null || this.unsent.length === 0) return;
    const packet = Uint8Array.from(this.unsent.splice(0, this.room));
    this.room = null;
    this.usb.endpointReadDone(this.port.outEndpoint, packet);
  }
}
