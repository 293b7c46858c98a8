"""What a conversion reports beside its clip."""

from __future__ import annotations

import os
import sys
import warnings
from typing import Any, Dict, Iterable, List, NamedTuple, Optional


class ConversionWarning(UserWarning):
    """The clip may not be what you want, or a part of the motion was left out. `note` has the details."""

    note: Note

    def __init__(self, text: str, note: Note) -> None:
        super().__init__(text)
        self.note = note


class Note(NamedTuple):
    """One sentence about a conversion. What is not known is None."""

    kind: str
    """What it is about: unit, frame-rate, names, unread, loop and so on."""
    severity: str
    """`warning` if the clip may not be what you want or a part of the motion was left out; else `info`."""
    text: str
    """The sentence, without a full stop."""
    file: Optional[str] = None
    """The file."""
    line: Optional[int] = None
    """Its line, from 1."""
    joint: Optional[str] = None
    """The joint, scalar or channel."""
    frame: Optional[int] = None
    """The frame, from 0."""
    setting: Optional[str] = None
    """The keyword argument of `pantin.convert` that the note is about."""
    remedy: Optional[str] = None
    """What would change it, as a word for programs: state-unit, choose-animation and so on."""
    hint: Optional[str] = None
    """What would change it, as a sentence with the keyword argument."""

    def __str__(self) -> str:
        return self.text if self.hint is None else f"{self.text}; {self.hint}"


def notes_of(fields: Iterable[Dict[str, Any]]) -> List[Note]:
    """Notes of a report."""
    return [Note(**note) for note in fields]


def warn(notes: Iterable[Note], path: Optional[str]) -> None:
    """Raises the warnings among notes about a motion, at the line outside of this package that asked for the conversion."""
    level, frame = 1, sys._getframe(0)
    while frame.f_back is not None and os.path.dirname(frame.f_code.co_filename) == os.path.dirname(__file__):
        level, frame = level + 1, frame.f_back
    for note in notes:
        if note.severity == "warning":
            place = note.file or path
            text = str(note) if place is None else f"{place}: {note}"
            warnings.warn(ConversionWarning(text, note), stacklevel=level)
