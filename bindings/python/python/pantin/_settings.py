"""Keyword arguments of conversions, as the native half takes them."""

from __future__ import annotations

import os
from typing import Any, Dict, Iterable, Mapping, Optional, Sequence, Tuple, Union

from ._files import StrPath

Moment = Union[int, str]
"""A frame's number from 0, or seconds as in '1.5s'."""

FILES = ("skeleton", "joint_map", "with_file")
"""Arguments that name files."""

ONLY_FILES = ("cm_per_unit", "up", "animation", "skeleton")
"""Arguments that say how a file is read."""


def settings(
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
    effort: str = "default",
    rotations: str = "by-cost",
    index: Optional[float] = None,
    rig_apart: bool = False,
    loop: bool = False,
    footsteps: bool = False,
    memory: Union[int, str, None] = None,
    source_rate: Optional[float] = None,
    fps: Optional[float] = None,
    events: Iterable[Tuple[Moment, str]] = (),
    first: Optional[Moment] = None,
    last: Optional[Moment] = None,
    joints: Union[str, Iterable[str]] = (),
    drop: Union[str, Iterable[str]] = (),
    mirror: bool = False,
    retarget: Optional[str] = None,
    joint_map: Optional[StrPath] = None,
    with_file: Optional[StrPath] = None,
    close_loop: bool = False,
    cm_per_unit: Optional[float] = None,
    up: Optional[str] = None,
    animation: Union[str, int, None] = None,
    skeleton: Optional[StrPath] = None,
) -> Dict[str, Any]:
    """The arguments as the native half takes them; `pantin.convert` documents them."""
    numbers = {
        "max_error_cm": max_error_cm,
        "max_error_percent": max_error_percent,
        "mean_error_cm": mean_error_cm,
        "mean_error_percent": mean_error_percent,
        "max_scalar_error": max_scalar_error,
        "max_rotation_error": max_rotation_error,
        "max_joint_error": max_joint_error,
        "shell_cm": shell_cm,
        "shell_percent": shell_percent,
        "max_channel_error": max_channel_error,
        "max_accel_error": max_accel_error,
        "index": index,
        "source_rate": source_rate,
        "fps": fps,
        "cm_per_unit": cm_per_unit,
    }
    flags = {
        "places_only": places_only,
        "exact": exact,
        "rig_apart": rig_apart,
        "loop": loop,
        "footsteps": footsteps,
        "mirror": mirror,
        "close_loop": close_loop,
    }
    paths = {"joint_map": joint_map, "with_file": with_file, "skeleton": skeleton}
    return {
        **{name: None if value is None else float(value) for name, value in numbers.items()},
        **{name: bool(value) for name, value in flags.items()},
        **{name: None if value is None else os.fspath(value) for name, value in paths.items()},
        "effort": effort,
        "rotations": rotations,
        "memory": None if memory is None else str(memory),
        "events": [(_moment("events", at), str(name)) for at, name in events],
        "first": None if first is None else _moment("first", first),
        "last": None if last is None else _moment("last", last),
        "joints": _globs(joints),
        "drop": _globs(drop),
        "retarget": retarget,
        "up": up,
        "animation": None if animation is None else str(animation),
    }


def refuse(given: Mapping[str, Any], names: Sequence[str], why: str) -> None:
    """Refuses arguments that are set."""
    for name in names:
        if given.get(name) is not None:
            raise TypeError(f"{name} {why}")


def _moment(name: str, moment: Moment) -> str:
    # A float may be a frame or seconds.
    if isinstance(moment, float):
        raise TypeError(f"{name}: {moment}: expected a frame's number from 0, or seconds as in '1.5s'")
    return str(moment)


def _globs(globs: Union[str, Iterable[str]]) -> Sequence[str]:
    return [globs] if isinstance(globs, str) else list(globs)
