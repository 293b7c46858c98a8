# python3 run.py REQUEST: runs a program of an STM32F411 in Unicorn (QEMU's processor without a machine), with a model of each peripheral that the
# program uses, and prints as JSON what it did to them.
#
# The request is a JSON file:
#   image     the program, as an ELF file
#   display   the I2C address of a display, or null for one over SPI
#   crystal   whether the crystal starts
#   serial    the address of the serial port, USART1 or USART2
#   spi_pins  chip select, data/command and reset of a display over SPI, as "B0" for PB0
#   wires     SCL and SDA of a display over I2C
#   held      clocks until a device lets go of SDA, which it holds at the start
#   ground    a wire that is held low for ever, or null
#   hangs_after  the bytes on the I2C bus after which the watchdog resets the chip, once, or null
#   keys      letters before each picture but the first, as arrays of bytes; the program plays in step
#   out       a file for the bytes on the display's bus, in 16 bits each with the low byte first: a byte over SPI has bit 8 where the data pin is
#             high; over I2C there are 0x200 and the address, bytes, 0x400 at a stop; 0xffff where a picture is complete
import json
import struct
import sys

from unicorn import UC_ARCH_ARM, UC_HOOK_MEM_UNMAPPED, UC_MODE_MCLASS, UC_MODE_THUMB, Uc, UcError
from unicorn import arm_const as arm

FLASH, RAM = 0x08000000, 0x20000000
RCC, PWR, ACR, IWDG = 0x40023800, 0x40007000, 0x40023C00, 0x40003000
PORTS = {0x40020000: "A", 0x40020400: "B", 0x40020800: "C", 0x40020C00: "D", 0x40021000: "E", 0x40021C00: "H"}
I2C1, SPI1 = 0x40005400, 0x40013000
IN_STEP, NEXT, SHOWN = 0x16, 0x0A, ord("F")
HSI_HZ, HSE_HZ = 16_000_000, 25_000_000
IWDGRSTF = 1 << 29
# Instructions at most.
LIMIT = 3_000_000_000

request = json.load(open(sys.argv[1]))
SERIAL = request["serial"]


class Machine:
    def __init__(self):
        self.hangs_after = request["hangs_after"]
        self.text = bytearray()
        self.stream = []
        self.faults = []
        self.reset(0)

    # Everything but the RAM is as after a reset, for these reasons.
    def reset(self, reasons):
        # Registers at their addresses, with their values after reset where these matter (RM0383).
        self.registers = {RCC: 0x83, RCC + 0x74: reasons, RCC + 4: 0x24003010, PWR: 0x8000, ACR: 0, PORTS_A: 0xA8000000, PORTS_A + 12: 0x64000000, PORTS_A + 8: 0x0C000000,
                          PORTS_A + 0x400: 0x280, PORTS_A + 0x40C: 0x100, PORTS_A + 0x408: 0xC0}
        self.received = [IN_STEP]
        self.keys = list(request["keys"])
        self.told = []
        self.pictures = 0
        self.watchdog_ms = None
        self.crystal_polls = 0
        self.watchdog_before_crystal = False
        self.switches = []
        # The I2C bus: idle, or after a start, an address.
        self.bus = None
        self.answered = False
        self.held = request["held"]
        self.spi_unread = False
        self.done = False
        self.hung = False

    def clocks(self):
        cr, pll, cfgr = self.registers[RCC], self.registers[RCC + 4], self.registers.get(RCC + 8, 0)
        source = HSE_HZ if pll >> 22 & 1 else HSI_HZ
        vco = source // (pll & 63) * (pll >> 6 & 511)
        hz = {0: HSI_HZ, 1: HSE_HZ, 2: vco // (((pll >> 16 & 3) + 1) * 2)}[cfgr & 3]
        divided = lambda bits, first: hz >> (0 if bits < first else bits - first + 1)
        return {"core": hz, "input": source // (pll & 63), "vco": vco, "apb1": divided(cfgr >> 10 & 7, 4), "apb2": divided(cfgr >> 13 & 7, 4)}

    def read(self, at):
        value = self.registers.get(at, 0)
        if at == RCC:
            ready = (value & 1) << 1 | (value >> 16 & request["crystal"]) << 17 | (value >> 24 & 1) << 25
            self.crystal_polls += value >> 16 & 1
            return value & ~(1 << 1 | 1 << 17 | 1 << 25) | ready
        if at == RCC + 8:
            return value & ~12 | (value & 3) << 2
        if at == PWR + 4:
            return value | 1 << 14
        if at & ~0x3FF in PORTS and at & 0x3FF == 0x10:
            # Buttons are released.
            return 0xFFFF & ~sum(1 << int(wire[1:]) for wire in request["wires"] if PORTS[at & ~0x3FF] == wire[0] and not self.level(wire))
        if at == I2C1 + 0x14:
            if self.bus == "start":
                return 1
            # Address sent, or not acknowledged; then there is always room for a byte.
            return {"address": 0x82 if self.answered else 0x400, "bytes": 0x84, None: 0}[self.bus]
        if at == I2C1 + 0x18:
            if self.bus == "address" and self.answered:
                self.bus = "bytes"
            return 7 if self.bus else 0
        if at == SPI1 + 8:
            return 2 | self.spi_unread
        if at == SPI1 + 0xC:
            self.spi_unread = False
            return 0xFF
        if at == SERIAL:
            return 0xC0 | (0x20 if self.received else 0)
        if at == SERIAL + 4:
            return self.received.pop(0) if self.received else 0
        if at == IWDG + 0xC:
            return 0
        return value

    def write(self, at, value):
        before = self.registers.get(at, 0)
        self.registers[at] = value
        port, offset = at & ~0x3FF, at & 0x3FF
        if port in PORTS and offset == 0x18:
            output = self.registers.get(port + 0x14, 0)
            scl = self.level(request["wires"][0])
            self.registers[port + 0x14] = (output | value & 0xFFFF) & ~(value >> 16 & ~value)
            self.held -= scl and not self.level(request["wires"][0]) and self.held > 0
        elif at == PWR and value >> 14 & 3 != before >> 14 & 3 and self.registers[RCC] >> 24 & 1:
            self.faults.append("VOS changes while the PLL is on")
        elif at == RCC and value >> 16 & 1 and not before >> 16 & 1:
            self.watchdog_before_crystal = self.watchdog_ms is not None
        elif at == RCC + 4 and self.registers[RCC] >> 24 & 1:
            self.faults.append("the PLL is configured while it is on")
        elif at == RCC + 8 and value & 3 != before & 3:
            self.switches.append(self.clocks() | {"wait": self.registers[ACR] & 15, "vos": self.registers[PWR] >> 14 & 3})
        elif at == IWDG and value == 0xCCCC:
            self.watchdog_ms = self.registers.get(IWDG + 8, 0xFFF)
        elif at == I2C1:
            if value >> 8 & 1:
                self.bus = "start"
                self.registers[at] &= ~(1 << 8)
            if value >> 9 & 1:
                self.stream.append(0x400)
                self.bus = None
                self.registers[at] &= ~(1 << 9)
        elif at == I2C1 + 0x14:
            # A written 0 clears an error.
            if self.bus == "address" and not self.answered and not value >> 10 & 1:
                self.bus = None
        elif at == I2C1 + 0x10:
            if not all(map(self.level, request["wires"])):
                self.faults.append("a transfer on a bus whose wires are held low")
            if self.bus == "start":
                self.bus, self.answered = "address", value >> 1 == request["display"]
                self.stream.append(0x200 | value >> 1)
            else:
                self.stream.append(value & 0xFF)
            if len(self.stream) == self.hangs_after:
                self.hung = True
                self.hangs_after = None
        elif at == RCC + 0x74 and value >> 24 & 1:
            self.registers[at] = 0
        elif at == SPI1 + 0xC:
            self.spi_unread = True
            select, data, reset = map(self.pin, request["spi_pins"])
            if select == 0:
                self.stream.append((value & 0xFF) | data << 8)
            if reset == 0:
                self.faults.append("a byte is sent while the panel is being reset")
        elif at == SERIAL + 4:
            self.tell(value & 0xFF)

    def pin(self, name):
        base = next(address for address, port in PORTS.items() if port == name[0])
        return self.registers.get(base + 0x14, 0) >> int(name[1:]) & 1

    # A wire of the I2C bus is high unless something holds it low: ground, a device, or the program's own pin while it is an output.
    def level(self, wire):
        base = next(address for address, port in PORTS.items() if port == wire[0])
        driven = self.registers.get(base, 0) >> int(wire[1:]) * 2 & 3 == 1 and not self.pin(wire)
        return not (driven or wire == request["ground"] or self.held and wire == request["wires"][1])

    # A frame's number, in five bytes, ends a picture; letters and the wish for another one answer it.
    def tell(self, byte):
        if not self.pictures and not self.told and byte != SHOWN:
            self.text.append(byte)
            return
        self.told.append(byte)
        if self.told[0] != SHOWN:
            raise ValueError(f"the program sent {byte:#x} in place of a frame's number")
        if len(self.told) < 5:
            return
        self.told.clear()
        self.stream.append(0xFFFF)
        self.pictures += 1
        if not self.keys:
            self.done = True
            return
        self.received += [*self.keys.pop(0), NEXT]

    def pins(self):
        # Mode, output type, speed, pull and alternate function of each pin that is not as after reset.
        pins = {}
        for base, name in PORTS.items():
            field = lambda offset, number, bits: self.registers.get(base + offset, 0) >> number * bits & (1 << bits) - 1
            for number in range(16):
                mode, speed, pull = (field(offset, number, 2) for offset in (0, 8, 12))
                function = self.registers.get(base + 0x20 + number // 8 * 4, 0) >> number % 8 * 4 & 15
                if mode or pull:
                    pins[f"P{name}{number}"] = {"mode": mode, "drain": field(4, number, 1), "speed": speed, "pull": pull, "function": function}
        return pins


PORTS_A = 0x40020000
machine = Machine()
elf = open(request["image"], "rb").read()
emulator = Uc(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
emulator.ctl_set_cpu_model(arm.UC_CPU_ARM_CORTEX_M4)
emulator.mem_map(FLASH, 512 << 10)
# 64 KiB: the F401's, which the program must not leave.
emulator.mem_map(RAM, request["ram"])
(heads,), (size, count) = struct.unpack_from("<I", elf, 28), struct.unpack_from("<HH", elf, 42)
for head in range(count):
    kind, offset, _, address, length = struct.unpack_from("<5I", elf, heads + head * size)
    if kind == 1 and length:
        emulator.mem_write(address, elf[offset:offset + length])
for start in (0x40000000, 0xE0000000):
    emulator.mmio_map(start, 0x100000, lambda _, offset, size, base: machine.read(base + offset), start,
                      lambda uc, offset, size, value, base: (machine.write(base + offset, value), (machine.done or machine.hung) and uc.emu_stop()), start)
# Each word of this region is a bit of the peripherals' registers.
bit = lambda offset: (0x40000000 + offset // 32 & ~3, offset // 4 % 32)


def write_bit(_, offset, size, value, __):
    at, number = bit(offset)
    machine.write(at, machine.read(at) & ~(1 << number) | (value & 1) << number)


emulator.mmio_map(0x42000000, 0x2000000, lambda _, offset, size, __: machine.read(bit(offset)[0]) >> bit(offset)[1] & 1, 0, write_bit, 0)
stack, start = struct.unpack("<II", emulator.mem_read(FLASH, 8))
emulator.hook_add(UC_HOOK_MEM_UNMAPPED, lambda uc, kind, at, size, value, _: sys.exit(f"access {kind} of {at:#x} at {uc.reg_read(arm.UC_ARM_REG_PC):#x}"))
try:
    while True:
        emulator.reg_write(arm.UC_ARM_REG_FPEXC, 1 << 30)
        emulator.reg_write(arm.UC_ARM_REG_SP, stack)
        emulator.emu_start(start, 0, count=LIMIT)
        if not machine.hung:
            break
        machine.reset(IWDGRSTF)
        machine.stream.clear()
except UcError as error:
    sys.exit(f"{error} at {emulator.reg_read(arm.UC_ARM_REG_PC):#x}")
with open(request["out"], "wb") as out:
    out.write(struct.pack(f"<{len(machine.stream)}H", *machine.stream))
control = machine.registers.get(SPI1, 0)
clocks = machine.clocks()
print(json.dumps({
    "done": machine.done, "text": machine.text.decode("latin-1"), "pictures": machine.pictures, "faults": machine.faults, "switches": machine.switches, "pins": machine.pins(),
    "crystal_polls": machine.crystal_polls, "watchdog_before_crystal": machine.watchdog_before_crystal, "clocks": clocks,
    "spi": {"mode": control & 3 if control & 3 in (0, 3) else (control & 1) | control & 2, "hz": clocks["apb2"] / (2 << (control >> 3 & 7))},
    "baud": clocks["apb2" if SERIAL >> 16 & 1 else "apb1"] / max(machine.registers.get(SERIAL + 8, 0), 1),
}))
