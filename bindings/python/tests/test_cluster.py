"""A library of motions on a cluster: the same clips as one process makes, whatever happens to its workers."""

import importlib.util
import json
from pathlib import Path

import pytest

import pantin
from pantin._cluster import _fetch, clip_names

MISSING = [name for name in ("ray", "fsspec", "pyarrow", "s3fs", "moto", "psutil") if importlib.util.find_spec(name) is None]


def test_clips_are_named_as_by_the_program():
    assert clip_names(["a/walk.bvh", "b.x/run.amc"]) == ["a/walk.ptn", "b.x/run.ptn"]
    assert clip_names(["walk.bvh", "walk.fbx", "run.bvh"]) == ["walk.bvh.ptn", "walk.fbx.ptn", "run.ptn"]
    # A whole name may be another one's own.
    assert clip_names(["walk.bvh", "walk.fbx", "walk.bvh.csv"]) == ["walk.bvh.ptn", "walk.fbx.ptn", "walk.bvh.csv.ptn"]


class Folder:
    """A file system as fsspec has them."""

    def cat_file(self, path):
        return Path(path).read_bytes()


def test_files_that_a_motion_is_read_with_are_fetched(tmp_path):
    source, copy = tmp_path / "source", tmp_path / "copy"
    uris = ["walk.bin", "missing.bin", "../secret.bin", "/etc/hostname", "walk.bin"]
    gltf = {"asset": {"version": "2.0"}, "buffers": [{"uri": uri, "byteLength": 4} for uri in uris]}
    for name, text in [("figures/fox.gltf", json.dumps(gltf)), ("figures/walk.bin", "walk"), ("secret.bin", "none"), ("07/07_01.amc", "a"), ("07/07.asf", "s")]:
        (source / name).parent.mkdir(parents=True, exist_ok=True)
        (source / name).write_text(text)
    read = _fetch((Folder(), str(source)), copy, "figures/fox.gltf", ())
    assert [(name, size) for name, size, _ in read] == [("figures/fox.gltf", len(json.dumps(gltf))), ("figures/walk.bin", 4)]
    assert sorted(path.name for path in copy.rglob("*.*")) == ["fox.gltf", "walk.bin"]
    read = _fetch((Folder(), str(source)), copy, "07/07_01.amc", ("07/07.asf",))
    assert [name for name, _, _ in read] == ["07/07_01.amc", "07/07.asf"]


@pytest.mark.skipif("ray" not in MISSING, reason="ray is installed")
def test_a_missing_package_is_named(tmp_path):
    with pytest.raises(ImportError, match=r"pip install 'pantin\[ray\]'"):
        pantin.ray_convert(tmp_path, tmp_path / "clips")


@pytest.mark.skipif(bool(MISSING), reason=f"not installed: {', '.join(MISSING)}")
def test_a_killed_worker_loses_nothing(bvh, tmp_path):
    import io

    import pyarrow.parquet
    import s3fs
    from cluster_trial import OPTIONS, clips_in, cut, kill_worker, one_process, s3_server, two_nodes, upload

    folder = tmp_path / "captures"
    cut([bvh], folder, 20)
    (folder / "broken.bvh").write_text("HIERARCHY\nROOT\n")
    (folder / "readme.txt").write_text("no motion")
    expected, _ = one_process(folder)
    assert len(expected) == 20
    with s3_server() as storage, two_nodes() as cluster:
        source, target = "s3://motions/captures", "s3://motions/clips"
        upload(folder, source, storage)
        killed, parts = [], []

        def progress(part):
            parts.append(part)
            if not killed:
                killed.append(kill_worker(cluster))

        def run(**more):
            return pantin.ray_convert(source, target, storage_options=storage, **{**OPTIONS, **more}).to_pylist()

        rows = pantin.ray_convert(source, target, storage_options=storage, progress=progress, **OPTIONS).to_pylist()
        assert killed and parts == sorted(parts) and parts[-1] == 1
        assert clips_in(target, storage) == expected
        assert [row["source"] for row in rows] == sorted(row["source"] for row in rows) and len(rows) == 21
        refused = [row for row in rows if row["refused"]]
        assert [row["source"] for row in refused] == ["broken.bvh"] and refused[0]["refused"].startswith("broken.bvh:"), refused
        made = [row for row in rows if not row["refused"]]
        assert all(row["bytes"] == len(expected[row["target"][:-4]]) and 0 < row["max_error_cm"] <= 0.5 for row in made)
        assert all(row["seconds"] > 0 and row["frames"] > 1 for row in made) and not any(row["up_to_date"] for row in rows)

        fs = s3fs.S3FileSystem(**storage, use_listings_cache=False)
        report = pyarrow.parquet.read_table(io.BytesIO(fs.cat_file("motions/clips/report.parquet")))
        assert report.to_pylist() == rows

        # What is unchanged is not made again: not the clip whose source changed, nor one that is damaged or gone.
        changed, damaged, gone = made[3], made[5], made[7]
        fs.pipe_file(f"motions/captures/{changed['source']}", fs.cat_file(f"motions/captures/{changed['source']}") + b"\n")
        fs.pipe_file(f"motions/clips/{damaged['target']}", b"damaged")
        fs.rm_file(f"motions/clips/{gone['target']}")
        again = run()
        fresh = [row["source"] for row in again if not row["up_to_date"] and not row["refused"]]
        assert fresh == [changed["source"], damaged["source"], gone["source"]]
        assert clips_in(target, storage) == expected
        assert [row["bytes"] for row in again] == [row["bytes"] for row in rows]
        looser = run(max_error_cm=2)
        assert not any(row["up_to_date"] for row in looser) and sum(row["bytes"] or 0 for row in looser) < sum(map(len, expected.values()))

        # Folders, options, and sources that are not there.
        rows = pantin.ray_convert(folder, tmp_path / "clips", report=tmp_path / "report.parquet", **OPTIONS).to_pylist()
        assert sum(row["refused"] is None for row in rows) == 20 and (tmp_path / "report.parquet").is_file()
        assert {path.relative_to(tmp_path / "clips").with_suffix("").as_posix(): path.read_bytes() for path in (tmp_path / "clips").rglob("*.ptn")} == expected
        assert not list((tmp_path / "clips").rglob("*.part"))
        with pytest.raises(pantin.PantinError, match="effort"):
            run(effort="much")
        with pytest.raises(FileNotFoundError, match="no motions"):
            pantin.ray_convert(tmp_path / "clips", tmp_path / "more")

        class Enough(Exception):
            pass

        def enough(part):
            raise Enough

        with pytest.raises(Enough):
            pantin.ray_convert(folder, tmp_path / "half", progress=enough, **OPTIONS)
