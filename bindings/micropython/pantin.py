# Plays Pantin clips (.ptn) and banks (.ptb) in MicroPython, to the same bits as the decoders in Rust and C.
# Numbers in parentheses are sections of FORMAT.md. Damaged files raise ValueError.
import math
from array import array

import pantin_tables as T

_M = 0xFFFFFFFF
_NO_LEADER = 255


# Loops over bytes and channels: in machine code, or in Python where the interpreter makes none.
try:
    from pantin_fast import _advance, _crc, _find
except (ImportError, SyntaxError):
    from pantin_slow import _advance, _crc, _find


def _signed(x):
    x &= _M
    return x - 0x100000000 if x & 0x80000000 else x


def _int8(x):
    return x - 256 if x > 127 else x


def _unzigzag(n):
    return (n >> 1) ^ -(n & 1)


def _check(held, what):
    if not held:
        raise ValueError(what)


class _Fields:
    def __init__(self, data, at, end):
        self.data = data
        self.at = at
        self.end = end

    def byte(self):
        _check(self.at < self.end, "length")
        self.at += 1
        return self.data[self.at - 1]

    def varint(self):
        value = shift = 0
        while True:
            b = self.byte()
            _check(shift < 28 or b <= 15, "length")
            value |= (b & 127) << shift
            if b < 128:
                return value
            shift += 7

    def skip(self, count):
        _check(count <= self.end - self.at, "length")
        self.at += count
        return self.at - count

    def name(self):
        at = self.skip(self.varint())
        return bytes(self.data[at : self.at]).decode()


def _check_crc(data, at, end, crc=0xFFFF):
    crc = _crc(data, at, end, crc)
    _check(data[end] | data[end + 1] << 8 == crc, "crc")
    return crc


def _check_blocks(data, at, end, crc):
    _check(at < end, "length")
    while at < end:
        stop = min(at + 256, end)
        _check(stop - at >= 2, "length")
        crc = _check_crc(data, at, stop - 2, crc)
        last = crc
        at = stop
        crc = 0xFFFF
    return last


class Joint:
    """A joint: name (empty for an End Site), parent (index or None), offset, first (channel), kinds."""


class Rig:
    """A figure: joints, and scalars as (channel, exponent, name). `data` are the bytes of a .rig file."""

    def __init__(self, data, at=0, length=None):
        length = len(data) - at if length is None else length
        _check(2 <= length <= len(data) - at, "length")
        end = at + length - 2
        _check_crc(data, at, end)
        self.bytes = memoryview(data)[at:end]
        f = _Fields(data, at, end)
        self.unit_micro_cm = f.varint()
        self.offset_exponent = _int8(f.byte())
        self.up = f.byte()
        joints, scalars = f.varint(), f.varint()
        _check(self.unit_micro_cm and -31 <= self.offset_exponent <= 31 and self.up <= 6 and self.up & 3 != 3, "rig")
        _check(joints <= 1023 and scalars <= 1023, "rig")
        self.joints = []
        channels = 0
        for index in range(joints):
            j = Joint()
            head, parent = f.byte(), f.varint()
            count = head & 15
            j.end_site = bool(head & 16)
            j.helper = bool(head & 32)
            _check(head < 64 and not (j.end_site and count) and parent <= index and (parent == 0) == (index == 0), "rig")
            j.parent = parent - 1 if parent else None
            j.first = channels
            channels += count
            at = f.skip((count + 1) // 2)
            j.kinds = bytes((data[at + c // 2] >> (c & 1) * 4) & 15 for c in range(count))
            _check(all(kind < 13 for kind in j.kinds), "rig")
            j.offset = tuple(_unzigzag(f.varint()) for _ in range(3))
            j.name = "" if j.end_site else f.name()
            self.joints.append(j)
        self.channels = channels + scalars
        _check(self.channels <= 1023, "rig")
        self.scalars = []
        listed = None
        while len(self.scalars) < scalars:
            exponent = _int8(f.byte())
            names = []
            if exponent == T.LISTED:
                listed = listed or T.LIVE_LINK.split(" ")
                first, more = f.byte(), f.byte()
                exponent = _int8(f.byte())
                names = [listed[i] if i < len(listed) else "" for i in range(first, first + more + 1)]
            else:
                names = [f.name()]
            for name in names[: scalars - len(self.scalars)]:
                self.scalars.append((channels + len(self.scalars), exponent, name))
        _check(f.at == end, "length")

    def id(self):
        h = 0x811C9DC5
        for b in self.bytes:
            h = (h ^ b) * 0x01000193 & _M
        return h

    def joint(self, name):
        """The joint with this name. Raises KeyError if there is none."""
        return self.joints[self.index(name)]

    def index(self, name):
        """The index of the joint with this name, of several the first. Raises KeyError if there is none."""
        for index, j in enumerate(self.joints):
            if name and j.name == name:
                return index
        raise KeyError("no joint " + name)


class Clip:
    """A clip that plays: `pose` holds the raw values of all channels at `frame`. `rig` is used if the clip contains none."""

    def __init__(self, data, rig=None, at=0, length=None):
        end = len(data) if length is None else at + length
        _check(end <= len(data), "length")
        f = _Fields(data, at, end)
        _check(bytes((f.byte(), f.byte())) == T.MAGIC, "magic")
        version = f.byte()
        _check(version != 2, "a key clip, which this decoder does not play: convert its motion with --segments")
        _check(version == T.VERSION, "version")
        flags = f.byte()
        _check(flags < 128, "flags")
        self.data = data
        self.looped = bool(flags & 2)
        if flags & 1:
            length = f.varint()
            at = f.skip(length)
            rig = Rig(data, at, length)
        _check(rig, "no rig")
        self.rig = rig
        length = f.varint()
        self._start = f.skip(length)
        self._end = f.at
        head = T.MAGIC + bytes((T.VERSION, flags)) + length.to_bytes(4, "little")
        crc = _check_blocks(data, self._start, self._end, _crc(head, 0, 8, 0xFFFF))
        self._open_head(flags)
        if flags & 16:
            length = f.varint()
            at = f.skip(length)
            _check_blocks(data, at, f.at, _crc(length.to_bytes(4, "little"), 0, 4, crc))
        self.event_names = []
        if flags & 32:
            length = f.varint()
            _check(length >= 2, "length")
            at = f.skip(length)
            _check_crc(data, at, f.at - 2)
            n = _Fields(data, at, f.at - 2)
            while n.at < n.end:
                self.event_names.append(n.name())
        _check(f.at == end or flags & 64, "length")
        self.pose = array("i", bytes(4 * rig.channels))
        self._found = {}
        self.restart()

    def _open_head(self, flags):
        self._seek(self._start)
        rate = self._byte()
        _check(rate <= 9, "head")
        if rate == 0:
            self.frame_time_ns = self._u32()
        else:
            hz = T.FRAME_RATES[rate]
            self.frame_time_ns = (1000000000 + hz // 2) // hz
        self.frames = self._varint()
        self.exponent = _int8(self._byte())
        _check(self.frame_time_ns and 0 < self.frames <= 1 << 24 and -63 <= self.exponent <= 31, "head")
        _check(flags & 1 or self._u32() == self.rig.id(), "other rig")
        self.exponential = []
        if flags & 4:
            bits = count = 0
            for index, j in enumerate(self.rig.joints):
                if sum(3 <= kind <= 5 for kind in j.kinds) == 3:
                    if count & 7 == 0:
                        bits = self._byte()
                    if bits & 1:
                        self.exponential.append(index)
                    bits >>= 1
                    count += 1
        self.events = []
        frame = 0
        for _ in range(self._varint() if flags & 8 else 0):
            frame += self._varint()
            self.events.append((frame & _M, self._varint()))
            _check(self._at <= self._stop, "head")
        self._symbols = self._at

    # Payload (3)
    def _seek(self, at):
        self._at = at
        self._stop = self._end - 2

    def _byte(self):
        at = self._at
        if (at - self._start) & 255 == 254:
            at += 2
        if at >= self._stop:
            self._at = self._stop + 1
            return 0
        self._at = at + 1
        return self.data[at]

    def _u32(self):
        return self._byte() | self._byte() << 8 | self._byte() << 16 | self._byte() << 24

    def _varint(self):
        value = shift = 0
        while shift < 35:
            b = self._byte()
            value |= (b & 127) << shift
            if b < 128:
                break
            shift += 7
        return value & _M

    # Symbols (5)
    def _symbol(self, sizes):
        x = self._x
        found = _find(sizes, x & 4095)
        s = found & 255
        x = (sizes[2 * s] | sizes[2 * s + 1] << 8) * (x >> 12) + (found >> 8)
        while x < 0x10000:
            x = x << 8 | self._byte()
        self._x = x
        return s

    def _bits(self, n):
        value = shift = 0
        while n > 0:
            part = min(n, 8)
            value |= (self._x & ((1 << part) - 1)) << shift
            x = self._x >> part
            while x < 0x10000:
                x = x << 8 | self._byte()
            self._x = x
            shift += 8
            n -= part
        return value

    def _magnitude(self, sizes):
        b = self._symbol(sizes)
        if b == 0:
            return 0
        value = (1 << (b - 1)) + self._bits(b - 1)
        return -value if self._bits(1) else value

    # Channel starts (7, 8)
    def restart(self):
        """Shows frame 0."""
        self.frame = 0
        self._seek(self._symbols)
        x = self._byte() << 16
        x |= self._byte() << 8
        self._x = max(x | self._byte(), 0x10000)
        moving = []
        rig = self.rig
        steps = [T.FIRST_STEP, T.FIRST_STEP]
        last = 0
        last_of_kind = bytearray(14)
        index = 0
        shift = rig.offset_exponent - self.exponent
        for j in rig.joints:
            for kind in j.kinds:
                rest = 0
                if kind < 3:
                    rest = _signed(j.offset[kind] << (shift & 31)) if shift >= 0 else j.offset[kind] >> min(-shift, 31)
                last = self._start_channel(index, kind, rest, moving, steps, last, last_of_kind)
                index += 1
        while index < rig.channels:
            last = self._start_channel(index, 13, 0, moving, steps, last, last_of_kind)
            index += 1
        count = len(moving)
        self.moving = count
        self._v = array("i", [m[1] for m in moving] or [0])
        self._w = array("i", bytes(4 * count or 4))
        self._k = array("i", bytes(4 * count or 4))
        self._channel = array("H", [m[0] for m in moving] or [0])
        self._leader = bytes(m[2] for m in moving)
        self._step = bytes(m[3] for m in moving)
        self._mode = bytearray([T.START_MODE] * count)
        self._left = bytearray(count or 1)
        self._sign = array("b", bytes(count or 1))
        self._ended = 1

    def _start_channel(self, index, kind, rest, moving, steps, last, last_of_kind):
        class_ = 1 if kind < 3 else 0
        status = self._symbol(T.STATUS[T.STATUS_IN[16 * class_ + 4 * last + last_of_kind[kind]]])
        step = steps[class_]
        position = rest
        velocity = leader = 0
        if status == 3:
            leader = self._bits(5) + 1
            if leader > len(moving):
                leader = _NO_LEADER
            else:
                of = moving[-leader]
                position = self.pose[of[0]]
                velocity = of[1]
        elif status:
            c = self._symbol(T.STEP_CHANGE)
            step = (step + _unzigzag(c)) & 255 if c < 24 else self._bits(6)
            step = min(step, 59)
            unit = ((3 if step & 1 else 2) << (step >> 1)) >> 1
            position = self._magnitude(T.POSITION) * max(unit >> 1, 1)
            if status == 2:
                velocity = self._magnitude(T.VELOCITY) * max(unit >> 2, 1)
        self.pose[index] = _signed(position)
        if status >= 2:
            moving.append((index, _signed(velocity), leader, step))
        steps[class_] = step
        last_of_kind[kind] = status
        return status

    # Segments (9)
    def _number(self, i, slope, now, sign, unit, length_class):
        # The number, and the sign that is observed.
        size = abs(now)
        a = 0 if size < ((unit + 1) & _M) >> 1 else 1 if size < (2 * unit) & _M else 2 if size >> 1 < (3 * unit) & _M else 3
        flipped = sign < 0 if a == 0 else now < 0
        g = -sign if flipped else sign
        s = self._symbol(T.NUMBER[T.NUMBER_IN[((4 * slope + length_class) * 4 + a) * 3 + g + 1]])
        value = (s + 1) // 2
        if value == 13:
            n = self._symbol(T.FAR)
            value = 132 + (1 << n) + self._bits(n)
        elif value > 6:
            n = value - 6
            value = 5 + (1 << n) + self._bits(n)
        value *= unit
        if (s & 1) != flipped:
            value = -value
        return _signed(value), 0 if a == 0 else -1 if now < 0 else 1

    def _unit(self, i, quotient):
        step = self._step[i]
        return (((3 if step & 1 else 2) * T.STEPS[quotient]) & _M) >> (30 - (step >> 1)) | 1

    def _segment(self, i):
        mode = self._symbol(T.MODE[T.MODE_AFTER[self._mode[i]]])
        if mode == 32:
            mode = min(32 + self._symbol(T.MODE[T.MODE_AFTER[64]]), 62)
        self._mode[i] = mode
        kind = mode >> 4
        length = mode & 15
        length_class = (length + 1) // 2 if length < 3 else 2 if length < 7 else 3
        self._left[i] = T.LENGTHS[length]
        if kind == 0 or kind == 2:
            self._w[i], self._sign[i] = self._number(i, 0, self._w[i], self._sign[i], self._unit(i, length), length_class)
        if kind == 0:
            self._k[i] = 0
        elif kind != 3:
            self._k[i] = self._number(i, 1, self._k[i], 0, self._unit(i, 16 + length), length_class)[0]

    def step(self):
        """Shows the next frame. Returns False at the last one."""
        if self.frame + 1 >= self.frames:
            return False
        if self._ended and self.frame + 2 < self.frames:
            for i in range(self.moving):
                if self._left[i]:
                    continue
                leader = self._leader[i]
                if leader == 0:
                    self._segment(i)
                elif leader != _NO_LEADER:
                    of = i - leader
                    self._w[i] = self._w[of]
                    self._k[i] = self._k[of]
                    self._mode[i] = self._mode[of]
                    self._left[i] = self._left[of]
        self._ended = _advance(self.pose, self._v, self._w, self._k, self._channel, self._left, self.moving)
        self.frame += 1
        return True

    def seek(self, frame):
        """Shows a frame: from frame 0 if it lies back."""
        if frame < self.frame:
            self.restart()
        while self.frame < frame and self.step():
            pass

    def update(self, ms):
        """Shows the frame at a time in milliseconds since the start of the clip, which repeats. Returns True if the pose changed."""
        frame = ms * 1000000 // self.frame_time_ns % self.frames
        if frame == self.frame:
            return False
        self.seek(frame)
        return True

    def find(self, name):
        """The joint with this name, whose rotation is then read frame by frame: a pantin_turns.JointRef. Raises KeyError if there
        is none."""
        return _joint_ref(self, self.rig.index(name))

    def kinds(self, index):
        """The kinds of a joint's channels as this clip codes them: 0-2 position x, y, z; 3-5 Euler angle x, y, z; 6-9 quaternion
        w, x, y, z; 10-12 exponential map x, y, z."""
        kinds = self.rig.joints[index].kinds
        if index not in self.exponential:
            return kinds
        component = iter(b"\x0a\x0b\x0c")
        return bytes(next(component) if 3 <= kind <= 5 else kind for kind in kinds)

    def scalar(self, name):
        """The value of a scalar channel. Raises KeyError if there is none of this name."""
        for channel, exponent, own in self.rig.scalars:
            if own == name:
                return self.pose[channel] * 2.0 ** (exponent - 31)
        raise KeyError("no scalar " + name)

    def draw(self, fb, width, height, color=1, orbit=-50, scale=None):
        """Draws the figure into a framebuf.FrameBuffer, seen from `orbit` degrees about the vertical; the hips are in the middle.
        `scale` is pixels for each unit of the source; by default five of the longest bone fit the height."""
        up = self.rig.up & 3
        sin, cos = math.sin(math.radians(orbit)), math.cos(math.radians(orbit))
        placed = _place(self)
        if scale is None:
            longest = max([1e-9] + [max(abs(x) for x in j.offset) for j in self.rig.joints[2:]]) * 2.0**self.rig.offset_exponent
            scale = height / 5 / longest
        hips = placed[min(1, len(placed) - 1)][0]
        ends = []
        for p, _ in placed:
            x, y, z = p[(up + 2) % 3] - hips[(up + 2) % 3], p[up] - hips[up], p[(up + 1) % 3] - hips[(up + 1) % 3]
            # With y up, (up + 2) % 3 is x and (up + 1) % 3 is z.
            across = x * cos - z * sin
            ends.append((int(width / 2 + across * scale), int(height / 2 - (-y if self.rig.up & 4 else y) * scale)))
        for j, end in zip(self.rig.joints, ends):
            if j.parent is not None and not j.helper:
                start = ends[j.parent]
                fb.line(start[0], start[1], end[0], end[1], color)


def _joint_ref(clip, index):
    # Programs that read no rotations need no pantin_turns.py.
    if index not in clip._found:
        from pantin_turns import JointRef

        clip._found[index] = JointRef(clip, index)
    return clip._found[index]


def _place(clip):
    # Where each joint is, and its axes as three rows.
    placed = []
    rig, pose = clip.rig, clip.pose
    for index, j in enumerate(rig.joints):
        offset = [x * 2.0**rig.offset_exponent for x in j.offset]
        axes = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
        kinds = clip.kinds(index)
        # Quaternions and exponential maps in integers: most joints have Euler angles, which floating point turns faster.
        if kinds and max(kinds) > 5:
            axes = tuple(tuple(x / 1073741824 for x in row) for row in _joint_ref(clip, index).matrix())
        for c, kind in enumerate(kinds):
            raw = pose[j.first + c]
            if kind < 3:
                offset[kind] = raw * 2.0**clip.exponent
            elif kind < 6 and max(kinds) < 6:
                a = raw * (2 * math.pi / 4294967296)
                s, c = math.sin(a), math.cos(a)
                y, z = (kind - 2) % 3, (kind - 1) % 3
                turned = []
                for row in axes:
                    new = list(row)
                    new[y] = row[y] * c + row[z] * s
                    new[z] = row[z] * c - row[y] * s
                    turned.append(tuple(new))
                axes = tuple(turned)
        if j.parent is not None:
            above, m = placed[j.parent]
            offset = [above[i] + m[i][0] * offset[0] + m[i][1] * offset[1] + m[i][2] * offset[2] for i in range(3)]
            axes = tuple(tuple(sum(m[i][n] * axes[n][k] for n in range(3)) for k in range(3)) for i in range(3))
        placed.append((offset, axes))
    return placed


class Bank:
    """Clips of one rig by name: `names`, and `clip(name)`."""

    def __init__(self, data):
        f = _Fields(data, 0, len(data))
        _check(bytes((f.byte(), f.byte())) == b"Pb", "magic")
        # A bank of version 2 holds key clips, and may hold others.
        _check(f.byte() in (T.VERSION, 2), "version")
        sections = {}
        while f.at < f.end:
            kind, length = f.byte(), f.varint()
            at = f.skip(length)
            if 1 <= kind <= 3:
                _check(kind not in sections, "bank")
                sections[kind] = (at, length)
        _check(len(sections) == 3 and sections[2][1] >= 2, "bank")
        self.data = data
        self.rig = Rig(data, *sections[1])
        at, length = sections[2]
        _check_crc(data, at, at + length - 2)
        f = _Fields(data, at, at + length - 2)
        start, left = sections[3]
        self.names = []
        self._places = {}
        while f.at < f.end:
            name, length = f.name(), f.varint()
            _check(name and length <= left, "bank")
            self.names.append(name)
            self._places[name] = (start, length)
            start += length
            left -= length
        _check(self.names and left == 0, "bank")

    def clip(self, name):
        return Clip(self.data, self.rig, *self._places[name])
