"""A motion as arrays."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import List, Mapping, NamedTuple, Optional, Sequence, Tuple

import numpy as np
import numpy.typing as npt


class Joint(NamedTuple):
    """A joint of a figure, or the end of a bone."""

    name: str
    """Its name; empty for an End Site."""
    parent: Optional[int] = None
    """Index of its parent, which is smaller than its own; None for the root."""
    offset: Tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Where it stands in its parent; in cm for the joints of a clip."""
    end_site: bool = False
    """Whether it is only the end of a bone."""
    helper: bool = False
    """Whether it only steers other joints and is not drawn."""
    order: Optional[str] = None
    """The order of its Euler angles in a clip's rig, such as 'ZXY'; None if it has none, or others than one to three about different axes. `pantin.convert`
    does not read it: the joints of a `Motion` become ZXY."""


@dataclass
class Motion:
    """A motion as arrays, which `pantin.convert` takes and `Clip.motion` gives."""

    joints: Sequence[Joint] = ()
    """Parents before children."""
    rotations: npt.ArrayLike = ()
    """(frames, joints, 4): the rotation of each joint in its parent, as a quaternion w, x, y, z of any length."""
    translations: Optional[npt.ArrayLike] = None
    """(frames, joints, 3): the place of each joint in its parent. None: every joint stays at its offset."""
    scalars: Mapping[str, npt.ArrayLike] = field(default_factory=dict)
    """Channels that move no joint, (frames,) each: weights of a face, angles of servos."""
    full_scales: Mapping[str, float] = field(default_factory=dict)
    """Full scales of scalars, of which `max_scalar_error` is a part. Default: the greatest value of each."""
    rate: float = 30.0
    """Frames a second."""
    cm_per_unit: float = 1.0
    """Length of the unit of `translations` and offsets in cm."""
    up: str = "y"
    """The direction that is vertical: x, y, z, -x, -y or -z."""

    def _frames(self) -> int:
        """The number of frames; fails if arrays have other shapes than those above."""
        rotations = np.asarray(self.rotations, np.float64)
        values = {name: np.asarray(values, np.float64) for name, values in self.scalars.items()}
        lengths = [len(rotations)] if self.joints else [array.shape[0] for array in values.values() if array.ndim]
        if not lengths:
            raise ValueError("a motion without joints and scalars")
        frames = lengths[0]
        shapes: List[Tuple[str, npt.NDArray[np.float64], Tuple[int, ...]]] = []
        if self.joints:
            shapes.append(("rotations", rotations, (frames, len(self.joints), 4)))
        if self.joints and self.translations is not None:
            shapes.append(("translations", np.asarray(self.translations, np.float64), (frames, len(self.joints), 3)))
        shapes += [(f"scalars[{name!r}]", array, (frames,)) for name, array in values.items()]
        for name, array, shape in shapes:
            if array.shape != shape:
                raise ValueError(f"{name} has the shape {array.shape}; expected {shape}")
        return frames
