"""Keyword arguments of conversions, as the native half takes them."""

from __future__ import annotations

import os
from typing import Any, Callable, Dict, Iterable, Mapping, Sequence, Union

Moment = Union[int, str]
"""A frame's number from 0, or seconds as in '1.5s'."""

FILES = ("skeleton", "joint_map", "with_file", "body")
"""Arguments that name files."""

ONLY_FILES = ("cm_per_unit", "up", "animation", "skeleton")
"""Arguments that say how a file is read."""


NUMBERS = (
    "max_error_cm",
    "max_error_percent",
    "mean_error_cm",
    "mean_error_percent",
    "max_scalar_error",
    "max_rotation_error",
    "max_joint_error",
    "shell_cm",
    "shell_percent",
    "max_channel_error",
    "max_accel_error",
    "index",
    "source_rate",
    "fps",
    "cm_per_unit",
    "speed",
    "scale",
    "smooth",
    "turn",
    "blend",
)
"""Arguments that are numbers, or None."""

FLAGS = ("places_only", "exact", "keys", "segments", "rig_apart", "loop", "footsteps", "mirror", "reverse", "close_loop")
"""Arguments that are true or false."""

WORDS = ("rotations", "retarget", "in_place", "up")
"""Arguments that are passed on as they are."""


def settings(arguments: Mapping[str, Any]) -> Dict[str, Any]:
    """The arguments of `pantin.convert` but for motion, jobs and progress, as the native half takes them."""

    def given(names: Sequence[str], kind: Callable[[Any], Any]) -> Dict[str, Any]:
        return {name: None if arguments[name] is None else kind(arguments[name]) for name in names}

    return {
        **given(NUMBERS, float),
        **given(FLAGS, bool),
        **given(FILES, os.fspath),
        **given(("memory", "animation", "effort", "pace"), str),
        **{name: arguments[name] for name in WORDS},
        **{name: None if arguments[name] is None else _moment(name, arguments[name]) for name in ("first", "last")},
        "events": [(_moment("events", at), str(name)) for at, name in arguments["events"]],
        "joints": _globs(arguments["joints"]),
        "drop": _globs(arguments["drop"]),
        "between": None if arguments["between"] is None else tuple(map(str, arguments["between"])),
        "rename": [(str(old), str(new)) for old, new in dict(arguments["rename"]).items()],
        "append": [os.fspath(path) for path in arguments["append"]],
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
