# Checksums of poses and pictures, in machine code: the interpreters of the tests have `viper`.
import micropython


@micropython.viper
def _crc(data: ptr8, count: int) -> int:
    crc = 0xFFFF
    for at in range(count):
        x = (crc >> 8) ^ data[at]
        x ^= x >> 4
        crc = ((crc << 8) ^ (x << 12) ^ (x << 5) ^ x) & 0xFFFF
    return crc


def crc(values):
    """CRC-16 of an array of 32-bit numbers."""
    return _crc(values, 4 * len(values))


@micropython.viper
def fold(hash: int, data: ptr8, count: int) -> int:
    """FNV-1a of bytes, going on from `hash`."""
    for at in range(count):
        hash = ((hash ^ data[at]) * 0x01000193) & 0xFFFFFFFF
    return hash
