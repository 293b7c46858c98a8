"""Compresses motions to clips within a bound that is verified, and plays clips.

    import pantin
    clip = pantin.convert("walk.bvh", max_error_cm=0.5)
    clip.save("walk.ptn")
    pantin.Clip.open("walk.ptn").positions()   # (frames, joints, 3), in cm

Arrays are numpy's, of 64-bit floats, with frames first. Rotations are quaternions w, x, y, z. Lengths are in cm.
"""

from ._bank import Bank
from ._clip import Clip
from ._cluster import ray_convert
from ._convert import convert
from ._motion import Joint, Motion
from ._notes import ConversionWarning, Note
from ._pantin import BoundError, MemoryLimitError, PantinError, ReadError, SettingError, SourceError

__all__ = [
    "Bank",
    "BoundError",
    "Clip",
    "ConversionWarning",
    "Joint",
    "MemoryLimitError",
    "Motion",
    "Note",
    "PantinError",
    "ReadError",
    "SettingError",
    "SourceError",
    "convert",
    "ray_convert",
]
