"""Every edit and option of a conversion, as keyword arguments."""

import inspect
import os
import subprocess

import numpy as np
import pytest
from test_convert import arm

import pantin
from pantin._settings import settings


def kinds(clip):
    return [note.kind for note in clip.report["notes"]]


def test_all_arguments_reach_the_native_half():
    arguments = inspect.signature(pantin.convert).bind("a.bvh")
    arguments.apply_defaults()
    assert set(settings(arguments.arguments)) == set(arguments.arguments) - {"motion", "jobs", "progress"}


def test_frames_are_cut_by_number_and_by_seconds(bvh):
    whole = pantin.convert(bvh, effort="fast")
    assert (whole.frames, round(whole.rate)) == (160, 120)
    numbers = pantin.convert(bvh, effort="fast", first=12, last=np.int64(60))
    seconds = pantin.convert(bvh, effort="fast", first="0.1s", last="0.5s")
    assert numbers.frames == 49 and bytes(numbers) == bytes(seconds)
    assert np.linalg.norm(numbers.positions() - whole.positions()[12:61], axis=2).max() <= 1
    with pytest.raises(TypeError, match="first: 0.1: expected a frame's number"):
        pantin.convert(bvh, first=0.1)
    with pytest.raises(pantin.SettingError, match='first="soon": expected a frame') as caught:
        pantin.convert(bvh, first="soon")
    assert caught.value.setting == "first"
    with pytest.raises(pantin.SettingError, match="last=9999: the last frame is 159") as caught:
        pantin.convert(bvh, last=9999)
    assert (caught.value.setting, caught.value.path) == ("last", str(bvh))


def test_rates(bvh):
    slow = pantin.convert(bvh, effort="fast", source_rate=30)
    assert (slow.frames, slow.rate) == (160, 30)
    few = pantin.convert(bvh, effort="fast", fps=30)
    assert (few.frames, few.rate) == (40, 30) and "frame-rate" in kinds(few)


def test_events(bvh):
    clip = pantin.convert(bvh, effort="fast", events=[(3, "clap"), ("0.5s", "step")])
    assert clip.events == [(3, "clap"), (60, "step")]
    with pytest.raises(pantin.SettingError, match="events=clap: frame 900 is not in the clip"):
        pantin.convert(bvh, events=[(900, "clap")])


def test_joints_are_picked(bvh):
    whole = pantin.convert(bvh, effort="fast")
    name = whole.joints[1].name
    without = pantin.convert(bvh, effort="fast", drop=name)
    assert name in [joint.name for joint in whole.joints] and without.nbytes != whole.nbytes
    with pytest.raises(pantin.SettingError, match=r'joints=\["nobody"\]'):
        pantin.convert(bvh, joints="nobody")


def test_a_motion_is_mirrored_and_put_on_another_body(bvh, tmp_path):
    clip = pantin.convert(bvh, effort="fast")
    mirrored = pantin.convert(bvh, effort="fast", mirror=True)
    back = pantin.convert(mirrored.motion(), effort="fast", mirror=True)
    assert bytes(mirrored) != bytes(clip)
    assert np.linalg.norm(back.positions()[:, 0] - clip.positions()[:, 0], axis=1).max() <= 1.6
    body = pantin.convert(bvh, effort="fast", retarget="display")
    assert len([joint for joint in body.joints if not joint.end_site]) == 15 and "retarget" in kinds(body)
    with pytest.raises(pantin.SettingError, match="mirror=True: ") as caught:
        pantin.convert(arm(), mirror=True)
    assert caught.value.setting == "mirror"
    with pytest.raises(pantin.SettingError, match="joint_map=") as caught:
        pantin.convert(arm(), retarget="display")
    assert (caught.value.setting, caught.value.remedy) == ("retarget", "map-joints")
    with pytest.raises(pantin.SettingError, match="joint_map=.*not set"):
        pantin.convert(bvh, joint_map=bvh)
    with pytest.raises(FileNotFoundError):
        pantin.convert(bvh, retarget="display", joint_map=tmp_path / "missing")


def test_a_face_is_added(bvh, tmp_path):
    face = tmp_path / "face.csv"
    rows = "".join(f"{frame / 120:.5f},{0.5 + 0.4 * np.sin(frame / 9):.4f}\n" for frame in range(160))
    face.write_text(f"time,JawOpen\n{rows}")
    for motion in (bvh, pantin.convert(bvh, effort="fast").motion()):
        clip = pantin.convert(motion, effort="fast", with_file=face)
        assert clip.scalar_names == ("JawOpen",) and clip.frames == 160 and "joined" in kinds(clip)
    with pytest.raises(pantin.SettingError, match="with_file=.*no scalars"):
        pantin.convert(bvh, with_file=bvh)


def test_loops(motions):
    # Our walk is a loop; its frames alone are one cycle.
    walk = motions / "walk.keys"
    assert pantin.convert(walk, effort="fast").looped
    part = pantin.convert(walk, effort="fast", last=100)
    (note,) = [note for note in part.report["notes"] if note.kind == "loop"]
    assert not part.looped and note.remedy == "make-loop" and "loop=True" in note.hint
    with pytest.raises(pantin.SettingError) as caught:
        pantin.convert(walk, effort="fast", last=1, close_loop=True)
    assert caught.value.setting == "close_loop" and "close_loop=True: 2 frames are no loop" in str(caught.value)
    assert pantin.convert(pantin.Clip.open(motions / "walk.ptn").motion(), effort="fast", loop=True, max_error_cm=3).looped


def test_bounds_of_other_kinds(bvh):
    part = pantin.convert(bvh, effort="fast", max_error_percent=0.3)
    assert part.report["max_error_percent_of_height"] <= 0.3
    mean = pantin.convert(bvh, effort="fast", mean_error_cm=0.1)
    assert mean.report["mean_joint_error_cm"] <= 0.1
    channels = pantin.convert(bvh, max_channel_error=0.5)
    assert channels.report["max_error"] <= 0.5 + 1e-3 and "worst_channel" in channels.report
    assert pantin.convert(bvh, max_accel_error=0.5).report["part_of_bound"] <= 1
    for given, message in [
        ({"max_error_cm": 1, "max_error_percent": 1}, "max_error_percent=1: expected cm or percent, not both"),
        ({"exact": True, "max_channel_error": 1}, "max_channel_error=1: it bounds each channel in place of exact"),
        ({"exact": True, "max_scalar_error": 1}, "exact=True: it bounds each channel in place of max_scalar_error"),
        ({"mean_error_cm": 2, "max_error_cm": 1}, "mean_error_cm=2: "),
        ({"rotations": "quaternions"}, 'rotations="quaternions": expected'),
        ({"retarget": "me"}, 'retarget="me": expected'),
        ({"index": 1e9}, "index=1000000000: expected seconds"),
    ]:
        with pytest.raises(pantin.SettingError) as caught:
            pantin.convert(bvh, effort="fast", **given)
        assert message in str(caught.value) and caught.value.setting == message.split("=")[0]


def test_how_a_clip_is_coded(bvh, tmp_path):
    quaternions = pantin.convert(bvh, effort="fast", rotations="quaternion")
    assert any("quaternion" in name.lower() for name in quaternions.channel_names)
    assert "index" in kinds(pantin.convert(bvh, effort="fast", index=0.5))
    assert "footsteps" in kinds(pantin.convert(bvh, effort="fast", footsteps=True))
    apart = pantin.convert(bvh, effort="fast", rig_apart=True)
    whole = pantin.convert(bvh, effort="fast")
    assert bytes(apart) == bytes(whole)
    clip, rig = tmp_path / "walk.ptn", tmp_path / "walk.rig"
    apart.save(clip, rig)
    assert clip.stat().st_size < whole.nbytes
    again = pantin.Clip.open(clip, rig)
    assert bytes(again) == bytes(whole) and apart.report["bytes"] == clip.stat().st_size
    with pytest.raises(ValueError, match="rig_apart=True"):
        whole.save(clip, rig)


def test_memory_is_limited(bvh):
    with pytest.raises(pantin.MemoryLimitError, match="the limit is .*; raise the limit of memory \\(memory=\\)") as caught:
        pantin.convert(bvh, memory="100kB")
    assert (caught.value.remedy, caught.value.setting) == ("raise-memory", None)
    with pytest.raises(pantin.MemoryLimitError, match='memory="much": expected a size'):
        pantin.convert(bvh, memory="much")
    assert pantin.convert(bvh, effort="fast", memory=1 << 30).frames == 160


def test_edits_are_those_of_the_program(bvh, tmp_path):
    tool = os.environ.get("PANTIN_TOOL")
    if not tool:
        pytest.skip("PANTIN_TOOL names the program pantin")
    made = tmp_path / "walk.ptn"
    options = ["--effort", "fast", "--fps", "60", "--from", "10", "--to", "50", "--mirror", "--event", "clap@20", "--index", "0.2", "-q"]
    subprocess.run([tool, "convert", bvh, "-o", made, *options], check=True)
    clip = pantin.convert(bvh, effort="fast", fps=60, first=10, last=50, mirror=True, events=[(20, "clap")], index=0.2)
    assert bytes(clip) == made.read_bytes()


def test_a_motion_turns_and_a_treadmill_gets_a_way(motions):
    walk = motions / "walk.keys"
    turned = pantin.convert(walk, effort="fast", turn=180)
    way = turned.positions()[-1, 0, 2] - turned.positions()[0, 0, 2]
    assert way < -100
    spot = pantin.convert(walk, effort="fast", in_place="way", pace="feet")
    paced = pantin.convert(walk, effort="fast", in_place="way", pace=90)
    for clip in (spot, paced):
        assert abs(clip.positions()[-1, 1, 2] - clip.positions()[0, 1, 2] - 120) < 15 and "travel" in kinds(clip)
    for given, message in [({"turn": 90}, "turn=90: "), ({"pace": "fast"}, 'pace="fast": expected a speed')]:
        with pytest.raises(pantin.SettingError) as caught:
            pantin.convert(walk, effort="fast", **given)
        assert message in str(caught.value) and caught.value.setting == message.split("=")[0]
    with pytest.raises(pantin.SettingError, match="body=.*not found in the figure") as caught:
        pantin.convert(arm(), body=walk)
    assert (caught.value.setting, caught.value.remedy) == ("body", "map-joints")
