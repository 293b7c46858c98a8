"""A library of motions on a cluster: Ray schedules and retries, fsspec reads and writes."""

from __future__ import annotations

import functools
import hashlib
import importlib
import inspect
import json
import os
import posixpath
import tempfile
import time
import uuid
import warnings
from importlib.metadata import version
from pathlib import Path
from typing import Any, Callable, Dict, List, Mapping, Optional, Tuple

from . import _pantin
from ._convert import convert
from ._files import StrPath
from ._notes import ConversionWarning
from ._settings import FILES, refuse, settings

RECORDS = ".pantin"
"""The folder of the records in the target: what each clip was made of."""

MEASURED = ("frames", "bytes", "max_error_cm", "max_scalar_error_percent", "seconds", "warnings")
"""Columns of the report that a record keeps."""

NOT_HERE = (*FILES, "append", "animation", "rig_apart")
"""Options of `pantin.convert` that name a file or a part of one."""

Row = Dict[str, Any]


def ray_convert(
    source: StrPath,
    target: StrPath,
    max_error_cm: Optional[float] = None,
    *,
    report: Optional[StrPath] = None,
    storage_options: Optional[Mapping[str, Any]] = None,
    max_retries: int = 3,
    progress: Optional[Callable[[float], object]] = None,
    **options: Any,
) -> Any:
    """Converts all motions in and below the folder `source` to clips in the folder `target`, on a Ray cluster. Needs `pip install 'pantin[ray]'`.

    Each motion is a Ray task that takes one CPU; its clip has the bytes that `pantin.convert` gives. One that cannot be converted stops nothing:
    the report says why. A clip is up to date, and is not made again, if it was made of the same bytes by the same options and version of this
    package; records of that are in the folder `.pantin` of `target`. So a run that was interrupted goes on where it was.

    Returns the report as a `pyarrow.Table` with a row for each motion, in the order of names: `source` and `target` (paths below the folders),
    `source_bytes`, `frames`, `bytes`, `max_error_cm`, `max_scalar_error_percent`, `seconds` (of the conversion), `warnings` (texts), `up_to_date`,
    `node` (Ray's id of the node) and `refused` (why there is no clip, or null).

    source, target: folders or URLs that fsspec opens, such as s3://bucket/captures. Every node of the cluster must reach them.
    max_error_cm, options: as in `pantin.convert`, but jobs and those that name a file or a part of one: animation, skeleton, joint_map, with_file, body, append, rig_apart.
    report: the Parquet file of the report; default: report.parquet in `target`.
    storage_options: what fsspec needs to open both folders, such as the key, the secret and the endpoint_url of an object store.
    max_retries: how often Ray repeats a task whose worker died, or whose storage failed.
    progress: is called with the part of the motions that is done, from 0 to 1. Ray's dashboard shows the tasks under the name pantin.convert.

    Raises ImportError without Ray, FileNotFoundError for a folder that does not exist or has no motions, and PantinError for options that are wrong.
    """
    ray, pyarrow, parquet = _needed("ray"), _needed("pyarrow"), _needed("pyarrow.parquet")
    url_to_fs = _needed("fsspec").core.url_to_fs
    storage = dict(storage_options or {})
    refuse(options, (*NOT_HERE, "jobs"), "is no option for many motions")
    options["max_error_cm"] = max_error_cm
    arguments = inspect.signature(convert).bind(source, **options)
    arguments.apply_defaults()
    given = settings(arguments.arguments)
    _pantin.check_options(given)
    # Those of `convert` as they were read: an iterable may be read once. What is not set is left out, and so in the records.
    options = {name: value for name, value in given.items() if name not in NOT_HERE and value is not None}
    source_fs, source_root = url_to_fs(os.fspath(source), **storage)
    target_fs, target_root = url_to_fs(os.fspath(target), **storage)
    motions, skeletons = _motions(source_fs, source_root)
    if not motions:
        raise FileNotFoundError(f"{os.fspath(source)}: no motions in it")
    clips = clip_names(motions)
    for folder in sorted({posixpath.dirname(path) for clip in clips for path in _paths(target_root, clip)}):
        target_fs.makedirs(folder, exist_ok=True)

    task = ray.remote(_task).options(name="pantin.convert", max_retries=max_retries, retry_exceptions=True)
    source_ref, target_ref = ray.put((source_fs, source_root)), ray.put((target_fs, target_root))
    rows: List[Optional[Row]] = [None] * len(motions)
    refs = {}
    try:
        for index, (motion, clip) in enumerate(zip(motions, clips)):
            beside = skeletons.get(posixpath.dirname(motion), ()) if motion.lower().endswith(".amc") else ()
            refs[task.remote(source_ref, target_ref, motion, clip, tuple(beside), options)] = index
        while refs:
            done, _ = ray.wait(list(refs), num_returns=len(refs), timeout=0.5)
            for ref in done:
                index = refs.pop(ref)
                try:
                    rows[index] = ray.get(ref)
                except ray.exceptions.RayError as error:
                    rows[index] = {"refused": _sentence(error)}
            if done and progress is not None:
                progress(1 - len(refs) / len(motions))
    finally:
        # After an exception, or Ctrl-C.
        for ref in refs:
            ray.cancel(ref)

    columns = _columns(pyarrow)
    full = [{"up_to_date": False, **(row or {}), "source": motion, "target": clip} for row, motion, clip in zip(rows, motions, clips)]
    table = pyarrow.table({name: pyarrow.array([row.get(name) for row in full], kind) for name, kind in columns.items()})
    if report is None:
        report_fs, report_path = target_fs, posixpath.join(target_root, "report.parquet")
    else:
        report_fs, report_path = url_to_fs(os.fspath(report), **storage)
    sink = pyarrow.BufferOutputStream()
    parquet.write_table(table, sink)
    _write(report_fs, report_path, sink.getvalue().to_pybytes())
    return table


def _needed(name: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(f"pantin.ray_convert needs {name}: pip install 'pantin[ray]'") from error


def _columns(pyarrow: Any) -> Dict[str, Any]:
    return {
        "source": pyarrow.string(),
        "target": pyarrow.string(),
        "source_bytes": pyarrow.int64(),
        "frames": pyarrow.int64(),
        "bytes": pyarrow.int64(),
        "max_error_cm": pyarrow.float64(),
        "max_scalar_error_percent": pyarrow.float64(),
        "seconds": pyarrow.float64(),
        "warnings": pyarrow.list_(pyarrow.string()),
        "up_to_date": pyarrow.bool_(),
        "node": pyarrow.string(),
        "refused": pyarrow.string(),
    }


def _motions(fs: Any, root: str) -> Tuple[List[str], Dict[str, List[str]]]:
    """The motions in and below a folder, and the skeletons in each folder, as paths below `root`."""
    fs.invalidate_cache()
    prefix = root.rstrip("/") + "/"
    below = sorted(path[len(prefix) :] for path in fs.find(root) if path.startswith(prefix))
    skeletons: Dict[str, List[str]] = {}
    for path in below:
        if path.lower().endswith(".asf"):
            skeletons.setdefault(posixpath.dirname(path), []).append(path)
    return [path for path in below if _pantin.is_motion(path)], skeletons


def clip_names(motions: List[str]) -> List[str]:
    """Names of the clips of motions: their own with the ending .ptn instead. Motions that would share one keep their whole names before .ptn."""
    whole = [False] * len(motions)
    while True:
        clips = [(motion if keeps else posixpath.splitext(motion)[0]) + ".ptn" for motion, keeps in zip(motions, whole)]
        counts: Dict[str, int] = {}
        for clip in clips:
            counts[clip] = counts.get(clip, 0) + 1
        again = [keeps or counts[clip] > 1 for clip, keeps in zip(clips, whole)]
        if again == whole:
            return clips
        whole = again


def _paths(root: str, clip: str) -> Tuple[str, str]:
    """Where a clip and its record are."""
    return posixpath.join(root, clip), posixpath.join(root, RECORDS, clip + ".json")


def _task(source: Tuple[Any, str], target: Tuple[Any, str], motion: str, clip: str, beside: Tuple[str, ...], options: Dict[str, Any]) -> Row:
    """Converts a motion on a node of the cluster. Errors of the storage are raised, so that Ray repeats the task."""
    row: Row = {"node": _needed("ray").get_runtime_context().get_node_id()}
    (target_fs, target_root), begun = target, time.perf_counter()
    with tempfile.TemporaryDirectory(prefix="pantin-") as folder:
        read = _fetch(source, Path(folder), motion, beside)
        row["source_bytes"] = sum(size for _, size, _ in read)
        fingerprint = _digest(json.dumps([_version(), options, [[name, digest] for name, _, digest in read]]).encode())
        clip_path, record_path = _paths(target_root, clip)
        record = _record(target_fs, clip_path, record_path)
        if record.get("fingerprint") == fingerprint:
            return {**row, **{name: record.get(name) for name in MEASURED}, "up_to_date": True}
        try:
            with warnings.catch_warnings():
                # They are in the report.
                warnings.simplefilter("ignore", ConversionWarning)
                made = convert(Path(folder, motion), jobs=1, **options)
        except Exception as error:
            # The file's own name, not that of the copy.
            return {**row, "seconds": time.perf_counter() - begun, "refused": _sentence(error).replace(folder + os.sep, "")}
        except BaseException as error:
            if type(error).__name__ != "PanicException":
                raise
            return {**row, "refused": f"{motion}: a fault of pantin stopped the conversion; please report it: {_sentence(error)}"}
    data = bytes(made)
    measured: Row = {"frames": made.frames, "bytes": len(data), "seconds": time.perf_counter() - begun}
    measured.update({name: made.report.get(name) for name in ("max_error_cm", "max_scalar_error_percent", "warnings")})
    _write(target_fs, clip_path, data)
    # After the clip: a record without its clip would be believed.
    _write(target_fs, record_path, json.dumps({"fingerprint": fingerprint, "clip": _digest(data), **measured}).encode())
    return {**row, **measured}


@functools.lru_cache(None)
def _version() -> str:
    return version("pantin")


def _fetch(source: Tuple[Any, str], folder: Path, motion: str, beside: Tuple[str, ...]) -> List[Tuple[str, int, str]]:
    """Copies a motion and the files that it is read with to `folder`, under their names; returns name, size and digest of each."""
    fs, root = source
    read: List[Tuple[str, int, str]] = []

    def take(name: str) -> None:
        data = fs.cat_file(posixpath.join(root, name))
        place = folder / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(data)
        read.append((name, len(data), _digest(data)))

    take(motion)
    for name in beside:
        take(name)
    for path in _pantin.companions(folder / motion):
        name = os.path.relpath(path, folder).replace(os.sep, "/")
        # Not what lies outside the folder `source`, and nothing twice. One that is missing fails the conversion, if that needs it.
        if not name.startswith("../") and not posixpath.isabs(name) and name not in (other for other, _, _ in read):
            try:
                take(name)
            except FileNotFoundError:
                pass
    return read


def _record(fs: Any, clip_path: str, record_path: str) -> Dict[str, Any]:
    """The record of a clip; empty if there is none, or it is that of other bytes."""
    try:
        record = json.loads(fs.cat_file(record_path))
        whole = isinstance(record, dict) and record.get("clip") == _digest(fs.cat_file(clip_path))
    except (FileNotFoundError, ValueError):
        return {}
    return record if whole else {}


def _write(fs: Any, path: str, data: bytes) -> None:
    """Writes a file: all of it, or the one that is there stays. Stores of objects do so by themselves."""
    if "file" not in ((fs.protocol,) if isinstance(fs.protocol, str) else fs.protocol):
        fs.pipe_file(path, data)
        return
    # A name of its own: Ray may repeat a task while a worker that it has lost goes on.
    part = f"{path}.{uuid.uuid4().hex}.part"
    try:
        fs.pipe_file(part, data)
        os.replace(part, path)
    finally:
        Path(part).unlink(missing_ok=True)


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def _sentence(error: BaseException) -> str:
    """An error in one line, without a traceback."""
    cause = getattr(error, "cause", None)
    if isinstance(cause, BaseException):
        return _sentence(cause)
    text = " ".join(str(error).split())
    return text if isinstance(error, _pantin.PantinError) else f"{type(error).__name__}: {text}"
