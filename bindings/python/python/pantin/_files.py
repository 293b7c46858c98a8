"""Files in and out."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path
from typing import Iterator, Union

from ._pantin import PantinError

StrPath = Union[str, "os.PathLike[str]"]


def write(path: StrPath, content: bytes) -> None:
    """Writes a file: all of it, or the one that is there stays."""
    path = Path(path)
    part = path.with_name(path.name + ".part")
    try:
        part.write_bytes(content)
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)


@contextlib.contextmanager
def named(path: StrPath) -> Iterator[None]:
    """Puts the file's name before the errors of what is done with its bytes."""
    try:
        yield
    except PantinError as error:
        renamed = PantinError(f"{os.fspath(path)}: {error}")
        renamed.path, renamed.line, renamed.place = os.fspath(path), None, os.fspath(path)
        renamed.setting, renamed.remedy = None, None
        raise renamed from None
