# Rotations of joints to the same bits as in Rust: decoder/src/turn.rs and trig.rs state each step. Plain integers, no floating point but in `degrees`.
_M = 0xFFFFFFFF
_ONE = 1 << 30
_IDENTITY = (_ONE, 0, 0, 0)
_SINE = (4941520, 85555982, 693598003, 1686629708)
_COSINE = (973605, 22399895, 272375455, 1324675878)
_ARCTANGENT = (34631066, 69146217, 96821929, 136665923, 227854097, 683565272)
# Whether the axes are in the order of x, y, z, wherever it begins.
_ORDERS = {"XYZ": True, "XZY": False, "YXZ": False, "YZX": True, "ZXY": True, "ZYX": False}


def _signed(x):
    return ((x + 0x80000000) & _M) - 0x80000000


def _zeros(n):
    # Leading zeros of a number of 1 to 2^32 - 1.
    up = 0
    while n < 0x80000000:
        n <<= 1
        up += 1
    return up


def _alternating(coefficients, u):
    total = 0
    for c in coefficients:
        total = c - (u * total >> 32)
    return total


def _scaled(a, b):
    return (a * b + 0x20000000) >> 30


def _sin_cos(angle):
    # Both in Q30, of an angle in 2^-32 turns.
    quarter = ((angle & _M) + 0x20000000 & _M) >> 30
    rest = _signed(angle - (quarter << 30))
    t = abs(rest) << 2
    u = t * t >> 32
    sin = t * _alternating(_SINE, u) >> 32
    if rest < 0:
        sin = -sin
    cos = _ONE - (u * _alternating(_COSINE, u) >> 32)
    if quarter == 0:
        return sin, cos
    if quarter == 1:
        return cos, -sin
    if quarter == 2:
        return -sin, -cos
    return -cos, sin


def _atan2(y, x):
    # In 2^-32 turns.
    across, along = abs(y), abs(x)
    small, large = min(across, along), max(across, along)
    if large == 0:
        return 0
    up = _zeros(large)
    small, large = small << up >> 1, large << up >> 1
    far = small > large >> 1
    if far:
        small, large = large - small, large + small
    if large < 0x80000000:
        small, large = small << 1, large << 1
    r = 0xB4B4B4B5 - (large * 0x78787878 >> 32)
    for _ in range(3):
        r = r * (0x80000000 - (large * r >> 32)) >> 32 << 2
    z = small * r >> 32 << 2
    angle = z * _alternating(_ARCTANGENT, z * z >> 32) >> 32
    if far:
        angle = 0x20000000 - angle
    if across > along:
        angle = 0x40000000 - angle
    if x < 0:
        angle = 0x80000000 - angle
    return _signed(-angle if y < 0 else angle)


def _direction(q):
    # The quaternion of length 1, and the length that `q` has.
    largest = 0
    for x in q:
        largest |= abs(x)
    if largest == 0:
        return _IDENTITY, 0
    up = _zeros(largest)
    raised = [abs(x) << up >> 1 for x in q]
    square = sum(x * x >> 32 for x in raised)
    twice = 1 if square < _ONE else 0
    square <<= 2 * twice
    inverse = 0x887D9C55 - (square * 0x4DFEA27A >> 32)
    for _ in range(4):
        inverse = inverse * (0xC0000000 - ((square * inverse >> 32 << 2) * inverse >> 32)) >> 32 << 1
    inverse += 2
    unit = []
    for x, large in zip(q, raised):
        x = -((large << twice) * inverse >> 32) if x < 0 else (large << twice) * inverse >> 32
        unit.append(x)
    return tuple(unit), (square * inverse >> 32) << 3 >> up + twice


def _product(a, b):
    # The rotation by `a`, then by `b` about the axes that `a` has turned.
    p, q, r, s = a
    w, x, y, z = b
    half = 0x20000000
    return (
        (p * w - q * x - r * y - s * z + half) >> 30,
        (p * x + q * w + r * z - s * y + half) >> 30,
        (p * y - q * z + r * w + s * x + half) >> 30,
        (p * z + q * y - r * x + s * w + half) >> 30,
    )


def _about(axis, angle):
    sin, cos = _sin_cos(angle >> 1)
    q = [cos, 0, 0, 0]
    q[axis + 1] = sin
    return q


def _of_exponential(x, y, z):
    (_, x, y, z), length = _direction((0, x, y, z))
    sin, cos = _sin_cos(length >> 1)
    return cos, _scaled(x, sin), _scaled(y, sin), _scaled(z, sin)


def _polar(y, x):
    angle = _atan2(y, x)
    sin, cos = _sin_cos(angle)
    return angle, _scaled(x, cos) + _scaled(y, sin)


def _order(axes):
    # The order of one to three Euler angles about different axes.
    order = "".join("XYZ"[axis] for axis in axes)
    for full in ("XYZ", "YZX", "ZXY") if len(order) < 2 else _ORDERS:
        if full[: len(order)] == order:
            return full


class JointRef:
    """A joint of a clip, found once by `clip.find(name)`, which reads the pose that the clip shows: its rotation against its
    parent, however the clip codes it."""

    def __init__(self, clip, index):
        j = clip.rig.joints[index]
        self.name = j.name
        self.index = index
        self.first = j.first
        # The kinds of its channels as this clip codes them.
        self.kinds = clip.kinds(index)
        self._pose = clip.pose
        # Kinds of Euler angles that the clip codes as an exponential map are channels of `_coded`.
        self._coded = []
        self._angles = []
        self._map = [None] * 3
        self._quaternion = [None] * 4
        axes = []
        for c, kind in enumerate(j.kinds):
            if 3 <= kind <= 5:
                axes.append(kind - 3)
                (self._angles if self.kinds[c] == kind else self._coded).append(j.first + c)
            elif 6 <= kind <= 9:
                self._quaternion[kind - 6] = j.first + c
            elif kind > 9:
                self._map[kind - 10] = j.first + c
        self._has_map = any(c is not None for c in self._map)
        self._has_quaternion = any(c is not None for c in self._quaternion)
        self._axes = axes
        order = None if self._has_map or self._has_quaternion else _order(axes)
        # The order of the Euler angles in the rig, such as "ZXY"; None if it has none, or others than three different ones.
        self.order = order if axes else None
        self._own = None if self._coded else order
        # Whether it has several forms at once, or Euler angles of no order: a product of many, whose length is made 1.
        forms = bool(axes) + self._has_map + self._has_quaternion
        self._chain = forms > 1 or forms == 1 and bool(self._angles) and not order

    def raw(self):
        """The raw values of its channels in the order of `kinds`: 0-2 position x, y, z; 3-5 Euler angle x, y, z; 6-9 quaternion
        w, x, y, z; 10-12 exponential map x, y, z. The components of a map or a quaternion are no angles about axes."""
        return tuple(self._pose[self.first + c] for c in range(len(self.kinds)))

    def euler(self, order):
        """Three Euler angles in 2^-32 turns, in any order: "XYZ", "XZY", "YXZ", "YZX", "ZXY" or "ZYX". Each turns about the axis as
        turned by those before it, as in BVH. In `self.order` they are the clip's own if it codes the joint as Euler angles; otherwise the second
        is within 90 degrees of zero, and near 90 or -90 degrees only the first plus or minus the third is determined."""
        if order not in _ORDERS:
            raise ValueError("no order of Euler angles: %r" % (order,))
        if order == self._own:
            angles = [self._pose[c] for c in self._angles]
            return tuple(angles + [0] * (3 - len(angles)))
        q = self.quaternion()
        w, own, other, third = (q[0],) + tuple(q["XYZ".index(axis) + 1] for axis in order)
        even = _ORDERS[order]
        if not even:
            third = -third
        total, longer = _polar(own + third, w + other)
        difference, shorter = _polar(own - third, w - other)
        last = total - difference
        return (
            _signed(total + difference),
            _signed(_ONE - 2 * _atan2(shorter, longer)),
            _signed(last if even else -last),
        )

    def degrees(self, order):
        """`euler` in degrees, -180 to 180."""
        return tuple(x * (360 / 4294967296) for x in self.euler(order))

    def angle(self):
        """How far it is turned in all, about whatever axis, in 2^-32 turns: 0 to 2^31, which wraps to -2^31."""
        w, x, y, z = self.quaternion()
        return _signed(2 * _atan2(_direction((0, x, y, z))[1], abs(w)))

    def quaternion(self):
        """The unit quaternion w, x, y, z in 2^-30."""
        pose = self._pose
        q = None
        for c, axis in zip(self._angles, self._axes):
            part = _about(axis, pose[c])
            q = _product(q, part) if q else part
        if self._coded:
            part = _of_exponential(*(pose[c] for c in self._coded))
            q = _product(q, part) if q else part
        if self._has_quaternion:
            part = _direction([0 if c is None else pose[c] for c in self._quaternion])[0]
            q = _product(q, part) if q else part
        if self._has_map:
            part = _of_exponential(*(0 if c is None else pose[c] for c in self._map))
            q = _product(q, part) if q else part
        if q is None:
            return _IDENTITY
        return _direction(q)[0] if self._chain else tuple(q)

    def matrix(self):
        """The rotation matrix in 2^-30, row by row: its columns are the images of the axes."""
        w, x, y, z = self.quaternion()
        half = 1 << 28
        one = _ONE
        return (
            (one + ((-y * y - z * z + half) >> 29), (x * y - w * z + half) >> 29, (x * z + w * y + half) >> 29),
            ((x * y + w * z + half) >> 29, one + ((-x * x - z * z + half) >> 29), (y * z - w * x + half) >> 29),
            ((x * z - w * y + half) >> 29, (y * z + w * x + half) >> 29, one + ((-x * x - y * y + half) >> 29)),
        )
