"""From motions to clips."""

from __future__ import annotations

import json
import os
from typing import Callable, List, Optional, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _pantin
from ._clip import Clip
from ._files import StrPath
from ._motion import Motion

Progress = Callable[[float], object]


def convert(
    motion: Union[StrPath, Motion],
    max_error_cm: float = 0.5,
    *,
    max_scalar_error: float = 2.0,
    effort: str = "default",
    fps: Optional[float] = None,
    cm_per_unit: Optional[float] = None,
    up: Optional[str] = None,
    animation: Optional[str] = None,
    skeleton: Optional[StrPath] = None,
    jobs: Optional[int] = None,
    progress: Optional[Progress] = None,
) -> Clip:
    """Converts a motion file (BVH, AMC, glTF, FBX, VRML, CSV and more) or a `Motion` of arrays to a clip.

    The bound is verified: the device's own decoder plays the clip, and every joint is compared with the motion at every frame.
    What was measured is in the clip's `report`.

    max_error_cm: largest distance of any joint or End Site from its position, in cm.
    max_scalar_error: largest error of channels that move no joint, in percent of their full scale.
    effort: 'fast', 'default' or 'best': speed against size.
    fps: frames a second of the clip; the motion is resampled.
    cm_per_unit, up: unit of length and vertical direction, instead of what the file says or of a guess.
    animation: name or number of one of several animations in a file.
    skeleton: the .asf of an .amc.
    jobs: number of threads; default: the number of CPUs. Other threads of Python run meanwhile.
    progress: is called in this thread with the part that is done, from 0 to 1. An exception that it raises ends the conversion, as does Ctrl-C.

    Raises FileNotFoundError and other OSErrors for a file that cannot be read, and PantinError, a ValueError with the attributes `path` and
    `line`, for one that cannot be converted.
    """
    shared = (float(max_error_cm), float(max_scalar_error), effort, None if fps is None else float(fps))
    threads = 0 if jobs is None else max(1, int(jobs))
    if isinstance(motion, Motion):
        given = [("cm_per_unit", cm_per_unit), ("up", up), ("animation", animation), ("skeleton", skeleton)]
        for name, value in given:
            if value is not None:
                raise TypeError(f"{name} is for files: a Motion has its own fields")
        data, report = _pantin.convert_arrays(*_arrays(motion), *shared, threads, progress)
    else:
        path = os.fspath(motion)
        for needed in [path] if skeleton is None else [path, os.fspath(skeleton)]:
            with open(needed, "rb"):
                pass
        named = None if skeleton is None else os.fspath(skeleton)
        data, report = _pantin.convert(path, *shared, cm_per_unit, up, animation, named, threads, progress)
    clip = Clip(data)
    clip.report = json.loads(report)
    return clip


_Arrays = Tuple[List[Tuple[str, Optional[int], Tuple[float, ...], bool]], bytes, bytes, List[Tuple[str, float, bytes]], int, float, float, str]


def _arrays(motion: Motion) -> _Arrays:
    frames = motion._frames()
    joints = [(joint.name, joint.parent, tuple(map(float, joint.offset)), joint.end_site) for joint in motion.joints]
    rotations = _data(motion.rotations) if joints else b""
    places = b"" if motion.translations is None or not joints else _data(motion.translations)
    scalars = [(name, float(motion.full_scales.get(name, 0.0)), _data(values)) for name, values in motion.scalars.items()]
    return joints, rotations, places, scalars, frames, float(motion.rate), float(motion.cm_per_unit), motion.up


def _data(array: npt.ArrayLike) -> bytes:
    return np.ascontiguousarray(array, np.float64).tobytes()
