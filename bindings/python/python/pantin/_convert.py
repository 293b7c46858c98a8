"""From motions to clips."""

from __future__ import annotations

import json
import os
from types import MappingProxyType
from typing import Any, Callable, Dict, Iterable, List, Mapping, Optional, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _pantin
from ._clip import Clip
from ._files import StrPath
from ._motion import Motion
from ._notes import notes_of, warn
from ._settings import FILES, ONLY_FILES, Moment, refuse, settings

Progress = Callable[[float], object]


def convert(
    motion: Union[StrPath, Motion],
    max_error_cm: Optional[float] = None,
    *,
    max_error_percent: Optional[float] = None,
    mean_error_cm: Optional[float] = None,
    mean_error_percent: Optional[float] = None,
    max_scalar_error: Optional[float] = None,
    max_rotation_error: Optional[float] = None,
    max_joint_error: Optional[float] = None,
    shell_cm: Optional[float] = None,
    shell_percent: Optional[float] = None,
    places_only: bool = False,
    max_channel_error: Optional[float] = None,
    max_accel_error: Optional[float] = None,
    exact: bool = False,
    keys: bool = False,
    segments: bool = False,
    effort: Union[int, str] = "default",
    rotations: str = "by-cost",
    index: Optional[float] = None,
    rig_apart: bool = False,
    loop: bool = False,
    footsteps: bool = False,
    source_rate: Optional[float] = None,
    fps: Optional[float] = None,
    events: Iterable[Tuple[Moment, str]] = (),
    first: Optional[Moment] = None,
    last: Optional[Moment] = None,
    joints: Union[str, Iterable[str]] = (),
    drop: Union[str, Iterable[str]] = (),
    speed: Optional[float] = None,
    between: Optional[Tuple[str, str]] = None,
    rename: Mapping[str, str] = MappingProxyType({}),
    mirror: bool = False,
    retarget: Optional[str] = None,
    body: Optional[StrPath] = None,
    joint_map: Optional[StrPath] = None,
    reverse: bool = False,
    scale: Optional[float] = None,
    smooth: Optional[float] = None,
    in_place: Optional[str] = None,
    turn: Optional[float] = None,
    pace: Union[None, float, str] = None,
    append: Iterable[StrPath] = (),
    blend: Optional[float] = None,
    with_file: Optional[StrPath] = None,
    close_loop: bool = False,
    cm_per_unit: Optional[float] = None,
    up: Optional[str] = None,
    animation: Union[str, int, None] = None,
    skeleton: Optional[StrPath] = None,
    memory: Union[int, str, None] = None,
    jobs: Optional[int] = None,
    progress: Optional[Progress] = None,
) -> Clip:
    """Converts a motion file (BVH, AMC, glTF, FBX, VRML, CSV and more) or a `Motion` of arrays to a clip.

    The bound is verified: the device's own decoder plays the clip, and every bounded point is compared with the motion at every frame.
    What was measured is in the clip's `report`, with `notes` about what was done and what is odd. Notes that are warnings are raised as
    `pantin.ConversionWarning`, too.

    What the clip must keep:

    max_error_cm, max_error_percent: largest distance of any bounded point from its position, in cm or in percent of the figure's height; above 0.
        These points are each joint, each End Site, and the three points of each joint's shell. Default: 0.5 cm, or 6 times the mean error if
        that is set.
    shell_cm, shell_percent: distance of the shell's points from their joint, along the joint's axes, so that the bound holds how joints are turned,
        too. Default: 3 cm, or 3 % of the height of a figure below 1 m.
    places_only: bound joints and End Sites alone, without their shells, for figures that are drawn as lines.
    mean_error_cm, mean_error_percent: mean distance of all joints, End Sites left out. The clip is as small as this mean allows.
    max_scalar_error: largest error of channels that move no joint, in percent of their full scale, above 0. Default: 2.
    max_rotation_error: largest rotation error of any joint in the world, in degrees, above 0 and at most 180. Default: no bound of its own.
    max_joint_error: largest angle, in degrees, between a joint's true and decoded rotation in its parent, for skinned meshes. It bounds the whole rotation: a single Euler angle can be off by more.
    max_channel_error: largest error of each channel, in place of all bounds above: degrees for each Euler angle in its joint's own order, as for servos, and
        percent of the range for others.
    max_accel_error: largest error of each channel's second difference, in place of all bounds above: degrees or percent per frame squared.
    exact: code known curves as they are, in place of all bounds above.
    keys, segments: what the clip holds. A key clip holds a motion's keys and their interpolation, and only players with key clips play it. Default: keys
        for .keys files and other curves whose keys lie on frames, if they take fewer bytes than segments; else segments. `keys=True` fails if there
        is no key clip of the motion.
    effort: 1 to 9, or 'fast' (1), 'default' (6) or 'best' (9): speed against size. Each level takes at most 1.8 times the time of the one below.
    rotations: how joints with three Euler angles are coded: 'by-cost', 'euler', 'exponential' or 'quaternion'.
    index: seconds between snapshots for seeking. Default: no snapshots.
    rig_apart: keep the rig out of the clip's file, to be shared by several; `Clip.save` takes a file for each.
    loop: close the seam between the last frame and the first, which makes the clip a loop. What that moves is part of the bound.
    footsteps: add an event at each frame at which a foot touches down.

    How the motion is changed first, in this order:

    source_rate: frames a second of the source's frames, whatever the source says. All frames stay; the motion gets slower or faster.
    speed: how many times faster the motion goes; all frames stay.
    fps: frames a second of the clip; the motion is resampled.
    events: markers to add: pairs of a moment and a name. A moment is a frame's number from 0, or seconds as in '1.5s'.
    first, last: the first and the last frame to keep: moments, counted after `fps`.
    between: names of two events: keep what is between the first event of the one and the next one of the other.
    joints, drop: names of joints and scalars to keep, and to drop: a glob such as 'Left*', or several; case-insensitive.
    rename: other names of joints and scalars, by the old ones; one `*` in both stands for the same letters, as in {'mixamorig:*': '*'}.
    mirror: exchange left and right.
    retarget: 'display' puts the motion on a body of 15 joints.
    body: a motion, a clip or a bank on whose figure the motion is put. Motions on one body can be in one bank.
    joint_map: a file with the names of joints that `retarget` and `body` do not recognize.
    reverse: play the motion backwards.
    scale: how many times larger the figure becomes, with its way.
    smooth: frequency in Hz above which motion is smoothed away: it keeps 0.707 of its size there, a quarter at twice the frequency.
    in_place: 'way' takes the figure's horizontal way out, 'way-and-heading' its heading too.
    turn: degrees by which the whole motion is turned about the vertical, to the figure's left.
    pace: a way for a figure that treads on the spot, as on a treadmill: cm a second in the direction in which it faces, such text as '1.2m/s', or 'feet': as
        fast as its feet on the ground slide, the opposite way.
    append: motions that follow, each from where the figure then stands.
    blend: seconds in which a motion goes over to the next one of `append`. Default: 0.25.
    with_file: another file whose scalars are added, such as a face that was recorded with the body.
    close_loop: take the motion as one cycle, whose first frame follows its last.

    How a file is read:

    cm_per_unit, up: length of the unit in cm and vertical direction (x, y, z, -x, -y or -z), instead of what the file says or of a guess.
    animation: name or number (from 0) of one of several animations in a file.
    skeleton: the .asf of an .amc.

    memory: limit of the memory that the conversion may take: bytes, or text such as '2GB'. Default: 1 GB.
    jobs: number of threads; default: the number of CPUs. Other threads of Python run meanwhile.
    progress: is called in this thread with the part that is done, from 0 to 1. An exception that it raises ends the conversion, as does Ctrl-C.

    Raises FileNotFoundError and other OSErrors for a file that cannot be read, and a PantinError for what cannot be converted. It is a
    ValueError with the attributes `path`, `line`, `place`, `setting` and `remedy`, and is one of SettingError (a keyword argument is out of range or
    does not fit), SourceError (the motion is damaged or of an unknown format), ReadError (a file that the motion names), MemoryLimitError and BoundError.
    """
    arguments = dict(locals())
    given = settings(arguments)
    threads = 0 if jobs is None else max(1, int(jobs))
    path = None if isinstance(motion, Motion) else os.fspath(motion)
    if path is None:
        refuse(given, ONLY_FILES, "is for files: a Motion has its own fields")
    for needed in [path, *(given[name] for name in FILES), *given["append"]]:
        if needed is not None:
            with open(needed, "rb"):
                pass
    if isinstance(motion, Motion):
        data, rig, text = _pantin.convert_arrays(_arrays(motion), given, threads, progress)
    else:
        data, rig, text = _pantin.convert(os.fspath(motion), given, threads, progress)
    clip = Clip(data, rig if rig_apart else None)
    clip.report = json.loads(text)
    clip.report["notes"] = notes_of(clip.report["notes"])
    warn(clip.report["notes"], path)
    return clip


def _arrays(motion: Motion) -> Dict[str, Any]:
    frames = motion._frames()
    joints: List[Tuple[str, Optional[int], Tuple[float, ...], bool]] = [
        (joint.name, joint.parent, tuple(map(float, joint.offset)), joint.end_site) for joint in motion.joints
    ]
    scalars = [(name, float(motion.full_scales.get(name, 0.0)), _data(values)) for name, values in motion.scalars.items()]
    return {
        "joints": joints,
        "rotations": _data(motion.rotations) if joints else b"",
        "places": b"" if motion.translations is None or not joints else _data(motion.translations),
        "scalars": scalars,
        "frames": frames,
        "rate": float(motion.rate),
        "cm_per_unit": float(motion.cm_per_unit),
        "up": motion.up,
    }


def _data(array: npt.ArrayLike) -> bytes:
    return np.ascontiguousarray(array, np.float64).tobytes()
