"""Clips."""

from __future__ import annotations

import difflib
import json
from pathlib import Path
from typing import Any, Dict, List, Optional, Tuple

import numpy as np
import numpy.typing as npt

from . import _pantin
from ._files import StrPath, named, write
from ._motion import Joint, Motion

Floats = npt.NDArray[np.float64]


class Clip:
    """A motion in a few bytes, played by the device's own decoder.

    `rig` is the content of the rig's file for a clip that was made without one.
    """

    report: Dict[str, Any]
    """What `pantin.convert` measured: `max_error_cm`, `worst_joint`, `bytes`, `notes` (a list of `pantin.Note`) and more. Empty for a clip that was
    opened."""

    def __init__(self, data: bytes, rig: Optional[bytes] = None) -> None:
        data = bytes(data)
        self._bytes = data if rig is None else _pantin.with_rig(data, bytes(rig))
        # The clip's own file and its rig's, if they are apart.
        self._apart = None if rig is None else (data, bytes(rig))
        self._facts: Dict[str, Any] = json.loads(_pantin.facts(self._bytes))
        self._joints = tuple(Joint(**{**joint, "offset": tuple(joint["offset"])}) for joint in self._facts["joints"])
        self.report = {}

    @classmethod
    def open(cls, path: StrPath, rig: Optional[StrPath] = None) -> Clip:
        """Opens a clip's file (.ptn); `rig` is the file of its rig, if that is apart."""
        data = Path(path).read_bytes()
        rig_data = None if rig is None else Path(rig).read_bytes()
        with named(path):
            return cls(data, rig_data)

    def save(self, path: StrPath, rig: Optional[StrPath] = None) -> None:
        """Writes the clip's file, with its rig.

        With `rig`, the clip's file has no rig, and the rig is written to the file `rig`. Needs a clip that was converted with `rig_apart`, or opened with
        its rig.
        """
        if rig is None:
            write(path, self._bytes)
        elif self._apart is None:
            raise ValueError("the clip has its rig inside: convert it with rig_apart=True")
        else:
            write(path, self._apart[0])
            write(rig, self._apart[1])

    def to_bvh(self, path: StrPath) -> None:
        """Writes the clip as BVH, with Euler angles in place of quaternions. Fails if the clip has scalars or no joints, which BVH cannot hold."""
        write(path, _pantin.bvh(self._bytes))

    def to_keys(self, path: StrPath) -> None:
        """Writes the keys of a key clip as key-frame text (.keys). Fails for a clip of segments, and for names that the text cannot hold."""
        write(path, _pantin.keys(self._bytes))

    def __bytes__(self) -> bytes:
        return self._bytes

    def __len__(self) -> int:
        return self.frames

    def __repr__(self) -> str:
        what = f"{len(self.joints)} joints, {len(self.scalar_names)} scalars"
        return f"<pantin.Clip: {self.frames} frames at {self.rate:g} a second, {what}, {self.nbytes} bytes>"

    @property
    def nbytes(self) -> int:
        """Bytes of the clip with its rig."""
        return len(self._bytes)

    @property
    def frames(self) -> int:
        """Number of frames."""
        return int(self._facts["frames"])

    @property
    def rate(self) -> float:
        """Frames a second, to the seven digits that a frame time in nanoseconds has."""
        return float(f"{1e9 / self.frame_time_ns:.7g}")

    @property
    def frame_time_ns(self) -> int:
        """Time from one frame to the next in nanoseconds."""
        return int(self._facts["frame_time_ns"])

    @property
    def looped(self) -> bool:
        """Whether frame 0 follows the last frame."""
        return bool(self._facts["looped"])

    @property
    def has_keys(self) -> bool:
        """Whether it is a key clip: it holds keys instead of segments."""
        return bool(self._facts["has_keys"])

    @property
    def up(self) -> str:
        """The direction of the world that is vertical: x, y, z, -x, -y or -z."""
        return str(self._facts["up"])

    @property
    def joints(self) -> Tuple[Joint, ...]:
        """The joints, parents before children, with offsets in cm and the orders of their Euler angles; End Sites included."""
        return self._joints

    @property
    def scalar_names(self) -> Tuple[str, ...]:
        """Names of the channels that move no joint."""
        return tuple(name for name, _ in self._facts["scalars"])

    @property
    def channel_names(self) -> Tuple[str, ...]:
        """Names of all channels, in the order of `raw`: the joint, and what the clip stores, such as `Spine.Xexponential`."""
        return tuple(self._facts["channels"])

    @property
    def events(self) -> List[Tuple[int, str]]:
        """The markers: frame and name, in the order of frames."""
        return [(frame, name) for frame, name in self._facts["events"]]

    def joint_index(self, name: str) -> int:
        """The index of the joint with this name, of several the first. Raises KeyError if there is none, and suggests the joint with the most similar name."""
        for index, joint in enumerate(self.joints):
            if name and joint.name == name:
                return index
        names = {joint.name.lower(): joint.name for joint in self.joints if joint.name}
        alike = difflib.get_close_matches(name.lower(), names, 1)
        raise KeyError(f"no joint {name!r}" + (f"; there is {names[alike[0]]!r}" if alike else ""))

    def rotations(self, joint: Optional[str] = None) -> Floats:
        """Rotations of the joints in their parents, as quaternions w, x, y, z of length 1: (frames, joints, 4). With a joint's name, those of this
        joint: (frames, 4).

        End Sites have the rotation 1, 0, 0, 0. From frame to frame, the sign is that of the nearer quaternion. Raises KeyError if there is no such joint.
        """
        index = None if joint is None else self.joint_index(joint)
        every = self._floats(_pantin.rotations(self._bytes), len(self.joints), 4)
        return every if index is None else every[:, index]

    def euler(self, joint: str, order: Optional[str] = None) -> Floats:
        """Rotations of a joint in its parent as Euler angles in degrees, -180 to 180, however the clip codes them: (frames, 3).

        `order` is one of the six from 'XYZ' to 'ZYX': each angle turns about the axis as turned by those before it, as in BVH. Default: the joint's own
        order (`Joint.order`), or 'XYZ' if it has none. In its own order, the angles of a joint that the clip codes as Euler angles are the clip's own. Otherwise
        the second angle is within 90 degrees of zero, so that the first and the third can jump by 180 degrees from one frame to the next; and where the
        second is near 90 or -90 degrees, only the first plus or minus the third is determined.

        The angles are those of the decoder on a device: multiples of 2^-32 turns. Raises KeyError if there is no such joint.
        """
        index = self.joint_index(joint)
        if order is None:
            order = self.joints[index].order or "XYZ"
        turns = np.frombuffer(_pantin.euler(self._bytes, index, order), np.int32)
        return turns.reshape(self.frames, 3).astype(np.float64) * (360 / 2**32)

    def positions(self) -> Floats:
        """Positions of the joints in the world, in cm: (frames, joints, 3)."""
        return self._floats(_pantin.positions(self._bytes), len(self.joints), 3)

    def translations(self) -> Floats:
        """Positions of the joints in their parents, in cm: (frames, joints, 3)."""
        return self._floats(_pantin.places(self._bytes), len(self.joints), 3)

    def scalars(self) -> Dict[str, Floats]:
        """Values of the channels that move no joint, by name: (frames,) each, in the units of the motion."""
        values = self._floats(_pantin.scalars(self._bytes), len(self.scalar_names))
        return {name: values[:, index] for index, name in enumerate(self.scalar_names)}

    def raw(self) -> npt.NDArray[np.int32]:
        """The decoder's own integers: (frames, channels). They are equal, bit for bit, on every machine.

        `channel_names` says what each is. FORMAT.md has their units: 2^-32 turns for Euler angles and exponential maps, 2^-30 for components of
        quaternions. The components of a map or a quaternion are no angles about axes: `euler` and `rotations` have rotations.
        """
        values = np.frombuffer(_pantin.raw(self._bytes), np.int32)
        return values.reshape(self.frames, len(self.channel_names))

    def channel_bytes(self) -> Floats:
        """Bytes that the motion of each channel takes in the file, in the order of `channel_names`: (channels,).

        Fractions of bytes are by the probabilities of the symbols. The rest of the file is the rig, how channels begin, events and checksums; a channel
        that follows another takes 0.
        """
        return np.frombuffer(_pantin.channel_bytes(self._bytes), np.float64)

    def image(self, frame: int) -> npt.NDArray[np.bool_]:
        """The figure at a frame as a display of 128x64 pixels shows it, drawn by the firmware's code: (64, 128), True where it is lit."""
        return np.frombuffer(bytearray(_pantin.image(self._bytes, frame)), np.bool_).reshape(64, 128)

    def motion(self) -> Motion:
        """The clip as arrays, to be edited and converted again. A loop becomes a motion that is none."""
        rotations, translations = self.rotations(), self.translations()
        scales = dict(self._facts["scalars"])
        return Motion(self.joints, rotations, translations, self.scalars(), scales, 1e9 / self.frame_time_ns, 1.0, self.up)

    def _floats(self, data: bytearray, *shape: int) -> Floats:
        return np.frombuffer(data, np.float64).reshape(self.frames, *shape)
