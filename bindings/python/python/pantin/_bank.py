"""Banks."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Iterator, Mapping, Tuple

from . import _pantin
from ._clip import Clip
from ._files import StrPath, named, write
from ._notes import notes_of, warn


class Bank(Mapping[str, Clip]):
    """Clips of one rig in one file: a mapping from names to clips, in the file's order."""

    def __init__(self, data: bytes) -> None:
        self._bytes = bytes(data)
        self._names = tuple(_pantin.bank_names(self._bytes))

    @classmethod
    def open(cls, path: StrPath) -> Bank:
        """Opens a bank's file (.ptb)."""
        data = Path(path).read_bytes()
        with named(path):
            return cls(data)

    @classmethod
    def pack(cls, clips: Mapping[str, Clip]) -> Bank:
        """Makes a bank of clips of one rig; fails if a clip has another. Warns (`ConversionWarning`) of clips that travel by different joints."""
        bank = cls(_pantin.pack([(name, bytes(clip)) for name, clip in clips.items()]))
        warn(notes_of(json.loads(_pantin.bank_notes(bytes(bank)))), None)
        return bank

    def save(self, path: StrPath) -> None:
        """Writes the bank's file."""
        write(path, self._bytes)

    @property
    def names(self) -> Tuple[str, ...]:
        """Names of the clips."""
        return self._names

    def __bytes__(self) -> bytes:
        return self._bytes

    def __getitem__(self, name: str) -> Clip:
        if name not in self._names:
            raise KeyError(name)
        return Clip(_pantin.bank_clip(self._bytes, name))

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __repr__(self) -> str:
        return f"<pantin.Bank: {len(self)} clips, {len(self._bytes)} bytes>"
