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
from ._pantin import PantinError

__all__ = ["Bank", "Clip", "Joint", "Motion", "PantinError", "convert", "ray_convert"]
