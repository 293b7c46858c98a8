# The loops of pantin_fast.py in plain Python, to the same bits, for interpreters without `viper`. Sums wrap to 32 bits, as the format asks.
def _crc(data, at, end, crc):
    while at < end:
        x = (crc >> 8) ^ data[at]
        x ^= x >> 4
        crc = ((crc << 8) ^ (x << 12) ^ (x << 5) ^ x) & 0xFFFF
        at += 1
    return crc


def _find(sizes, low):
    s = 0
    while True:
        size = sizes[s] | sizes[s + 1] << 8
        if low < size:
            return low << 8 | s >> 1
        low -= size
        s += 2


def _advance(pose, v, w, k, channel, left, count):
    ended = 0
    for i in range(count):
        c = channel[i]
        pose[c] = ((pose[c] + v[i] + 0x80000000) & 0xFFFFFFFF) - 0x80000000
        v[i] = ((v[i] + w[i] + 0x80000000) & 0xFFFFFFFF) - 0x80000000
        w[i] = ((w[i] + k[i] + 0x80000000) & 0xFFFFFFFF) - 0x80000000
        n = left[i] - 1 & 255
        left[i] = n
        if n == 0:
            ended = 1
    return ended
