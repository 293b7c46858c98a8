# python3 map.py IMAGE START: runs the function of an ESP32-C3 that maps the slots of the flash, in Unicorn (QEMU's processor without a machine), with
# models of the boot ROM's functions and of the mapping's table, and prints as JSON what it did.
#
# IMAGE is the program's ELF file, START the function's address. Prints
#   steps   what happened, in order: "suspend", "resume ARGUMENT", "invalidate ADDRESS BYTES", "entry INDEX VALUE"
#   faults  what must not happen: code or constants of the flash, or interrupts, while the cache is off; other memory that is written
import json
import struct
import sys

from unicorn import UC_ARCH_RISCV, UC_HOOK_CODE, UC_HOOK_MEM_READ, UC_HOOK_MEM_WRITE, UC_MODE_RISCV32, Uc, UcError
from unicorn import riscv_const as riscv

# The chip's memory: ROM, RAM as code and as data, the flash as code and as data (ESP32-C3 technical reference, 3.3), the mapping's table (ESP-IDF,
# hal/esp32c3/mmu_ll.h).
ROM, CODE, DATA = (0x40000000, 0x60000), (0x40370000, 0x70000), (0x3FC80000, 0x60000)
FLASH, CONSTANTS, TABLE = (0x42000000, 0x800000), (0x3C000000, 0x800000), (0x600C5000, 0x1000)
# Functions of the boot ROM (ESP-IDF, esp_rom/esp32c3/ld/esp32c3.rom.ld), and what the cache says when it is turned off.
INVALIDATE, SUSPEND, RESUME, AUTOLOAD = 0x400004D4, 0x40000524, 0x40000528, 0x5A
END = ROM[0] + 0x100
MIE = 1 << 3

image, start = open(sys.argv[1], "rb").read(), int(sys.argv[2], 0)
uc = Uc(UC_ARCH_RISCV, UC_MODE_RISCV32)
for base, size in (ROM, CODE, DATA, FLASH, CONSTANTS, TABLE):
    uc.mem_map(base, size)
offset, = struct.unpack_from("<I", image, 28)
entry, count = struct.unpack_from("<HH", image, 42)
for kind, at, address, _, size in (struct.unpack_from("<5I", image, offset + entry * i) for i in range(count)):
    if kind == 1 and size:
        uc.mem_write(address, image[at:at + size])
# Each function of the ROM returns at once.
for function in (INVALIDATE, SUSPEND, RESUME):
    uc.mem_write(function, struct.pack("<H", 0x8082))
uc.mem_write(END, struct.pack("<H", 0x0001))

steps, faults = [], []
off = False


def inside(address, region):
    return region[0] <= address < region[0] + region[1]


def on_code(uc, address, size, _):
    global off
    a0, a1 = (uc.reg_read(register) & 0xFFFFFFFF for register in (riscv.UC_RISCV_REG_A0, riscv.UC_RISCV_REG_A1))
    if address == SUSPEND:
        off = True
        steps.append("suspend")
        uc.reg_write(riscv.UC_RISCV_REG_A0, AUTOLOAD)
    elif address == RESUME:
        off = False
        steps.append(f"resume {a0:#x}")
    elif address == INVALIDATE:
        steps.append(f"invalidate {a0:#x} {a1:#x}")
    if off and not inside(address, CODE) and not inside(address, ROM):
        faults.append(f"code at {address:#x} with the cache off")
    if off and uc.reg_read(riscv.UC_RISCV_REG_MSTATUS) & MIE:
        faults.append(f"interrupts at {address:#x} with the cache off")


def on_write(uc, _, address, size, value, __):
    if inside(address, TABLE):
        if not off or size != 4:
            faults.append(f"entry at {address:#x} of {size} bytes, the cache {'off' if off else 'on'}")
        steps.append(f"entry {(address - TABLE[0]) // 4} {value & 0xFFFFFFFF:#x}")
    elif not inside(address, DATA):
        faults.append(f"a write to {address:#x}")


def on_read(uc, _, address, size, value, __):
    if off and not inside(address, DATA):
        faults.append(f"a read of {address:#x} with the cache off")


uc.hook_add(UC_HOOK_CODE, on_code)
uc.hook_add(UC_HOOK_MEM_READ, on_read)
uc.hook_add(UC_HOOK_MEM_WRITE, on_write)
uc.reg_write(riscv.UC_RISCV_REG_SP, DATA[0] + DATA[1] - 16)
uc.reg_write(riscv.UC_RISCV_REG_RA, END)
uc.reg_write(riscv.UC_RISCV_REG_MSTATUS, uc.reg_read(riscv.UC_RISCV_REG_MSTATUS) | MIE)
try:
    uc.emu_start(start, END, count=10_000)
    if uc.reg_read(riscv.UC_RISCV_REG_PC) != END:
        faults.append("it does not return")
except UcError as error:
    faults.append(f"{error} at {uc.reg_read(riscv.UC_RISCV_REG_PC):#x}")
if not uc.reg_read(riscv.UC_RISCV_REG_MSTATUS) & MIE:
    faults.append("interrupts stay off")
print(json.dumps({"steps": steps, "faults": faults}))
