"""The native half: functions of bytes. Arrays are bytes in the machine's order."""

from typing import Callable, List, Optional, Sequence, Tuple

class PantinError(ValueError):
    """What is wrong with a motion, a clip or a bank."""

    path: Optional[str]
    """The file, if the error concerns one."""
    line: Optional[int]
    """Its line, from 1, if the format has lines."""

def convert(
    path: str,
    max_error_cm: float,
    max_scalar_error: float,
    effort: str,
    fps: Optional[float],
    cm_per_unit: Optional[float],
    up: Optional[str],
    animation: Optional[str],
    skeleton: Optional[str],
    jobs: int,
    progress: Optional[Callable[[float], object]],
) -> Tuple[bytes, str]: ...
def convert_arrays(
    joints: Sequence[Tuple[str, Optional[int], Sequence[float], bool]],
    rotations: bytes,
    places: bytes,
    scalars: Sequence[Tuple[str, float, bytes]],
    frames: int,
    rate: float,
    cm_per_unit: float,
    up: str,
    max_error_cm: float,
    max_scalar_error: float,
    effort: str,
    fps: Optional[float],
    jobs: int,
    progress: Optional[Callable[[float], object]],
) -> Tuple[bytes, str]: ...
def facts(clip: bytes) -> str: ...
def rotations(clip: bytes) -> bytearray: ...
def positions(clip: bytes) -> bytearray: ...
def places(clip: bytes) -> bytearray: ...
def scalars(clip: bytes) -> bytearray: ...
def raw(clip: bytes) -> bytearray: ...
def image(clip: bytes, frame: int) -> bytes: ...
def bvh(clip: bytes) -> bytes: ...
def with_rig(clip: bytes, rig: bytes) -> bytes: ...
def bank_names(bank: bytes) -> List[str]: ...
def bank_clip(bank: bytes, name: str) -> bytes: ...
def pack(clips: Sequence[Tuple[str, bytes]]) -> bytes: ...
