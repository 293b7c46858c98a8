# Loops over bytes and channels, compiled to machine code. All sums are stored through 32-bit pointers, which wrap as the format asks.
# Interpreters without `viper`, such as CircuitPython, refuse this file; pantin.py then takes pantin_slow.py.
import micropython


@micropython.viper
def _crc(data: ptr8, at: int, end: int, crc: int) -> int:
    while at < end:
        x = (crc >> 8) ^ data[at]
        x ^= x >> 4
        crc = ((crc << 8) ^ (x << 12) ^ (x << 5) ^ x) & 0xFFFF
        at += 1
    return crc


@micropython.viper
def _find(sizes: ptr8, low: int) -> int:
    # The symbol in the low byte, above it what is left of `low`. Bytes need not be aligned.
    s = 0
    while True:
        size = sizes[2 * s] | (sizes[2 * s + 1] << 8)
        if low < size:
            return low << 8 | s
        low -= size
        s += 1
    return 0


@micropython.viper
def _advance(pose: ptr32, v: ptr32, w: ptr32, k: ptr32, channel: ptr16, left: ptr8, count: int) -> int:
    # One frame of every moving channel. Returns 1 if a segment has ended.
    i = 0
    ended = 0
    while i < count:
        c = channel[i]
        pose[c] = pose[c] + v[i]
        v[i] = v[i] + w[i]
        w[i] = w[i] + k[i]
        n = left[i] - 1
        left[i] = n
        if n == 0:
            ended = 1
        i += 1
    return ended
