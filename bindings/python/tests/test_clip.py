"""Clips: every frame of the golden vectors, and arrays that agree with each other."""

import binascii
import json

import numpy as np
import pytest
from kinematics import matrices, of_bvh, places

import pantin


def crcs(clip):
    return [f"{binascii.crc_hqx(frame.astype('<i4').tobytes(), 0xFFFF):04x}" for frame in clip.raw()]


def test_golden_vectors_are_equal_to_the_bit(vectors):
    files = sorted(vectors.glob("*.ptn"))
    assert len(files) > 20
    for path in files:
        record = json.loads(path.with_suffix(".json").read_text())
        rig = path.with_suffix(".rig")
        clip = pantin.Clip.open(path, rig if rig.exists() else None)
        assert crcs(clip) == record["crcs"], path.name
        for frame, pose in record["poses"].items():
            assert clip.raw()[int(frame)].tolist() == pose, (path.name, frame)
        facts = {
            "frames": len(clip),
            "frame_time_ns": clip.frame_time_ns,
            "looped": clip.looped,
            "joints": len(clip.joints),
            "channels": len(clip.channel_names),
        }
        assert {key: record[key] for key in facts} == facts, path.name
        names = record.get("event_names") or []
        named = [(frame, names[n] if n < len(names) and names[n] else str(n)) for frame, n in record["events"]]
        assert clip.events == [event for event in named if event[0] < len(clip)], path.name


def test_golden_banks_are_equal_to_the_bit(vectors):
    record = json.loads((vectors / "bank.json").read_text())
    bank = pantin.Bank.open(vectors / "bank.ptb")
    assert list(bank) == [clip[0] for clip in record["clips"]]
    for name, _, frames, looped, expected in record["clips"]:
        clip = bank[name]
        assert (clip.frames, clip.looped, crcs(clip)) == (frames, looped, expected), name


def test_arrays_have_the_shapes_that_their_docs_state(walk):
    joints = len(walk.joints)
    assert walk.frames == 160 and walk.rate == 120 and walk.looped and walk.up == "y"
    assert walk.rotations().shape == (160, joints, 4)
    assert walk.positions().shape == walk.translations().shape == (160, joints, 3)
    assert walk.scalars() == {} and walk.raw().shape == (160, len(walk.channel_names))
    assert np.allclose(np.linalg.norm(walk.rotations(), axis=2), 1)
    positions = walk.positions()
    assert positions.dtype == np.float64
    positions += 1  # arrays can be written, and belong to nobody else
    assert not np.allclose(walk.positions(), positions)


def test_rotations_and_translations_give_the_positions(motions, vectors):
    for path in [motions / "walk.ptn", motions / "greet.ptn", vectors / "quaternion.ptn", vectors / "exponential-map.ptn"]:
        clip = pantin.Clip.open(path)
        parents = [joint.parent for joint in clip.joints]
        found = places(parents, matrices(clip.rotations()), clip.translations())
        size = max(1, np.abs(found).max())
        assert np.abs(found - clip.positions()).max() < 1e-9 * size, path.name


def test_the_bvh_has_the_positions(walk, bvh):
    names, positions = of_bvh(bvh)
    order = [names.index(joint.name) for joint in walk.joints if not joint.end_site]
    own = [index for index, joint in enumerate(walk.joints) if not joint.end_site]
    unit = pantin.convert(bvh, max_error_cm=3, effort="fast").report["max_error_cm"]
    assert unit <= 3
    scale = np.ptp(walk.positions()[0]) / np.ptp(positions[0])
    assert np.abs(positions[:, order] * scale - walk.positions()[:, own]).max() < 1e-5


def test_joints_with_quaternions_become_bvh(bvh, tmp_path):
    clip = pantin.convert(bvh, max_error_cm=0.5, rotations="quaternion", effort="fast", cm_per_unit=1)
    assert any("Wquaternion" in name for name in clip.channel_names)
    clip.to_bvh(tmp_path / "back.bvh")
    names, positions = of_bvh(tmp_path / "back.bvh")
    own = [index for index, joint in enumerate(clip.joints) if not joint.end_site]
    order = [names.index(clip.joints[index].name) for index in own]
    assert np.abs(positions[:, order] - clip.positions()[:, own]).max() < 1e-4


def test_rotations_by_name_are_those_of_the_decoder(vectors):
    clips, found = {}, {}
    lines = [line.split() for line in (vectors / "turns.txt").read_text().splitlines()]
    assert len(lines) > 600
    for file, joint, frame, *values in lines:
        clip = clips.setdefault(file, pantin.Clip.open(vectors / f"{file}.ptn"))
        if (file, joint) not in found:
            orders = [np.round(clip.euler(joint, order) * (2**32 / 360)).astype(int).tolist() for order in ("XYZ", "ZXY")]
            found[file, joint] = (*orders, clip.rotations(joint))
        xyz, zxy, quaternions = found[file, joint]
        numbers = [int(value) for value in values[:-1]]
        assert xyz[int(frame)] + zxy[int(frame)] == numbers[:6], (file, joint, frame)
        alike = abs(np.dot(quaternions[int(frame)], numbers[6:])) / 2**30
        assert abs(alike - 1) < 1e-6, (file, joint, frame)


def test_raw_channels_are_named_by_their_coding(vectors):
    clip = pantin.Clip.open(vectors / "exponential-choice.ptn")
    names = clip.channel_names
    assert names[:6] == ("j0.Zrotation", "j0.Xrotation", "j0.Yrotation", "j1.Xexponential", "j1.Yexponential", "j1.Zexponential")
    assert len(set(names)) == clip.raw().shape[1]


def test_missing_joints_and_unknown_orders_are_named(walk):
    for act in (lambda: walk.euler("nobody", "XYZ"), lambda: walk.rotations("nobody"), lambda: walk.joint_index("nobody")):
        with pytest.raises(KeyError, match="nobody"):
            act()
    with pytest.raises(KeyError):
        walk.joint_index("")
    with pytest.raises(pantin.PantinError, match="XYX"):
        walk.euler("left-shin", "XYX")


def test_scalars_are_by_name(motions):
    clip = pantin.Clip.open(motions / "face/joy.ptn")
    scalars = clip.scalars()
    assert tuple(scalars) == clip.scalar_names and len(scalars) > 0
    assert all(values.shape == (clip.frames,) and values.dtype == np.float64 for values in scalars.values())
    assert max(np.ptp(values) for values in scalars.values()) > 0.1
    with pytest.raises(pantin.PantinError, match="BVH cannot hold"):
        clip.to_bvh("joy.bvh")


def test_bytes_of_channels_are_part_of_the_file(walk, vectors):
    found = walk.channel_bytes()
    assert found.shape == (len(walk.channel_names),) and found.min() >= 0
    moving = np.ptp(walk.raw(), axis=0) > 0
    assert (found[~moving] == 0).all() and found[moving].mean() > 3
    for path in [path for path in sorted(vectors.glob("*.ptn")) if not path.with_suffix(".rig").exists()]:
        clip = pantin.Clip.open(path)
        assert 0 <= clip.channel_bytes().sum() < clip.nbytes, path.name


def test_a_picture_is_that_of_the_display(walk):
    image = walk.image(0)
    assert image.shape == (64, 128) and image.dtype == np.bool_ and 100 < image.sum() < 2000
    assert (image != walk.image(40)).any()
    for frame in (160, -1):
        with pytest.raises(pantin.PantinError, match=f"frame {frame}; the clip has frames 0 to 159"):
            walk.image(frame)


def test_files_are_saved_whole(walk, tmp_path):
    walk.save(tmp_path / "copy.ptn")
    again = pantin.Clip.open(tmp_path / "copy.ptn")
    assert bytes(again) == bytes(walk) and again.nbytes == (tmp_path / "copy.ptn").stat().st_size
    assert [path.name for path in tmp_path.iterdir()] == ["copy.ptn"]


def test_banks_are_packed_and_opened(motions, walk, tmp_path):
    bank = pantin.Bank.pack({"walk": walk, "again": walk})
    bank.save(tmp_path / "bank.ptb")
    opened = pantin.Bank.open(tmp_path / "bank.ptb")
    assert opened.names == ("walk", "again") and len(opened) == 2
    assert (opened["again"].raw() == walk.raw()).all()
    with pytest.raises(KeyError):
        opened["run"]
    figure = "joint base offset 0 0 0 channels Xposition Zposition\njoint hips parent base offset 0 90 0 channels Xposition Zposition\n"
    clips = {}
    for name, base, hips in [("walk", 200, 0), ("kick", 0, 200)]:
        rows = f"keys linear base\n 0 0 0\n 30 0 {base}\nkeys linear hips\n 0 0 0\n 30 0 {hips}\n"
        motion = tmp_path / f"{name}.keys"
        motion.write_text(f"keyframes 1\nfps 30\nframes 31\ncm-per-unit 1\n{figure}end parent hips offset 0 40 0\n{rows}")
        clips[name] = pantin.convert(motion, segments=True)
    with pytest.warns(pantin.ConversionWarning, match="`walk` by `base`; `kick` by `hips`; put all of the motions on the same body .body=."):
        pantin.Bank.pack(clips)
    run = pantin.Clip.open(motions / "face/joy.ptn")
    with pytest.raises(pantin.PantinError, match="another rig"):
        pantin.Bank.pack({"walk": walk, "joy": run})
