// The PC at the other end of the USB port: it enumerates the board, opens the serial port, and sends and receives bytes.

import { USBCDC } from 'rp2040js';

// The chip's identification, of silicon version 2: version 1, which the emulator reports, needs a workaround (RP2040-E5) that drives the port's
// wires, and these are not modelled.
const [SYSINFO, CHIP_ID, VERSION_2] = [0x40000, 0, 0x20002927];

// A request to the first interface: the PC is ready (DTR, RTS). The emulator sends it to the device, to which it does not belong.
const READY = Uint8Array.of(0x21, 0x22, 3, 0, 0, 0, 0, 0);
// The register that disables interrupts (NVIC_ICER), and the port's one, as a bit.
const [DISABLE, INTERRUPT] = [0x180, 1 << 5];
// The registers of buffers for the PC, and the bit that is set until it has taken one.
const [IN_CONTROL, AVAILABLE] = [0x80, 1 << 10];
// The status register, and the bit that says that the bus is suspended, which a written 1 clears on the chip and not in the emulator.
const [STATUS, SUSPENDED] = [0x50, 1 << 4];
// Nanoseconds until a program opens the port, and until it uses it.
const OPENS = 1e6;

export class Pc {
  // `onByte` hears what the board sends.
  constructor(chip, onByte) {
    const info = chip.peripherals[SYSINFO];
    const read = info.readUint32.bind(info);
    info.readUint32 = (offset) => (offset === CHIP_ID ? VERSION_2 : read(offset));
    this.usb = chip.usbCtrl;
    this.isPlugged = true;
    const write = this.usb.writeUint32.bind(this.usb);
    this.usb.writeUint32 = (offset, value) => {
      if (offset === STATUS && value & SUSPENDED) this.suspend(false);
      write(offset, value);
    };
    this.isOpen = false;
    this.onOpen = () => {};
    // How often the board disabled the interrupt, because its receive buffer was full.
    this.held = 0;
    this.unsent = [];
    // What the board wants to send while no program on the PC reads, and the function that takes it.
    this.unread = null;
    this.isReading = true;
    // The sizes of the buffers that the board waits with, by their endpoint.
    this.rooms = new Map();
    const port = new USBCDC(this.usb);
    this.port = port;
    // A program opens the port some time after the PC has chosen the configuration.
    const opens = chip.clock.createAlarm(() => {
      if (!this.isPlugged) return;
      this.usb.sendSetupPacket(READY);
      opened.schedule(OPENS);
    });
    const opened = chip.clock.createAlarm(() => {
      if (!this.isPlugged) return;
      this.isOpen = true;
      this.onOpen();
    });
    port.cdcSetControlLineState = () => {
      port.initialized = true;
      opens.schedule(OPENS);
    };
    // The emulator takes a packet as soon as the board offers it. A PC does that only while a program reads.
    const take = this.usb.indicateBufferReady.bind(this.usb);
    this.usb.indicateBufferReady = (endpoint, isOut) => {
      if (this.isReading || isOut || endpoint !== port.inEndpoint) return take(endpoint, isOut);
      const control = IN_CONTROL + 8 * endpoint;
      const memory = chip.usbDPRAMView;
      memory.setUint32(control, memory.getUint32(control, true) | AVAILABLE, true);
      this.unread = {
        taken: () => {
          memory.setUint32(control, memory.getUint32(control, true) & ~AVAILABLE, true);
          take(endpoint, isOut);
        },
      };
    };
    port.onSerialData = (bytes) => {
      if (!this.isPlugged) return;
      if (this.unread) this.unread.bytes = bytes;
      else bytes.forEach((byte) => onByte(byte));
    };
    this.onByte = onByte;
    const set = chip.ppb.writeUint32.bind(chip.ppb);
    chip.ppb.writeUint32 = (offset, value) => {
      if (offset === DISABLE && value & INTERRUPT) this.held += 1;
      set(offset, value);
    };
    // The emulator answers at once, with an empty packet if there is no byte; a PC sends none of these.
    this.usb.onEndpointRead = (endpoint, size) => {
      this.rooms.set(endpoint, size);
      this.fill();
    };
  }

  // Pulls the cable out, or plugs it in: the board has other power. Without frames of the bus the chip says that it is suspended; the PC resets a
  // device that is plugged in.
  plug(isIn) {
    this.isPlugged = isIn;
    this.isOpen = false;
    this.unsent = [];
    this.rooms.clear();
    this.unread = null;
    const { usb, port } = this;
    for (const alarm of [...usb.endpointReadAlarms, ...usb.endpointWriteAlarms]) alarm.buffers = [];
    if (!isIn) return this.suspend(true);
    Object.assign(port, { initialized: false, descriptorsSize: null, descriptors: [], inEndpoint: -1, outEndpoint: -1 });
    usb.resetDevice();
  }

  suspend(isSuspended) {
    this.usb.sieStatus = isSuspended ? this.usb.sieStatus | SUSPENDED : this.usb.sieStatus & ~SUSPENDED;
    this.usb.sieStatusUpdated();
  }

  // Sends bytes, in packets, as the board takes them.
  send(bytes) {
    this.unsent.push(...bytes);
    this.fill();
  }

  // Whether a program on the PC reads what arrives.
  reads(isReading) {
    this.isReading = isReading;
    if (!isReading || !this.unread?.bytes) return;
    const { bytes, taken } = this.unread;
    this.unread = null;
    bytes.forEach((byte) => this.onByte(byte));
    taken();
  }

  fill() {
    const endpoint = this.port.outEndpoint;
    const room = this.rooms.get(endpoint);
    if (!room || this.unsent.length === 0) return;
    this.rooms.delete(endpoint);
    this.usb.endpointReadDone(endpoint, Uint8Array.from(this.unsent.splice(0, room)));
  }
}
