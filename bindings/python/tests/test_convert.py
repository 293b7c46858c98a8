"""Conversions: the bound by kinematics of the tests' own, progress, threads."""

import os
import signal
import subprocess
import threading
import time

import numpy as np
import pytest
from kinematics import matrices, of_bvh, places

import pantin


@pytest.mark.parametrize("bound", [0.3, 2.0])
def test_every_joint_keeps_the_bound(bvh, bound):
    clip = pantin.convert(bvh, max_error_cm=bound, effort="fast", cm_per_unit=1)
    names, expected = of_bvh(bvh)
    # An End Site has no name: it follows its parent.
    names = [name or f"{names[index - 1]}/end" for index, name in enumerate(names)]
    own = [joint.name or f"{clip.joints[joint.parent].name}/end" for joint in clip.joints]
    found = clip.positions()[:, [own.index(name) for name in names]]
    errors = np.linalg.norm(found - expected, axis=2)
    assert errors.max() <= bound
    assert errors.max() == pytest.approx(clip.report["max_error_cm"], rel=1e-4)
    frame, joint = np.unravel_index(errors.argmax(), errors.shape)
    assert (clip.report["worst_frame"], clip.report["worst_joint"]) == (frame, names[joint])


def test_a_looser_bound_takes_fewer_bytes(bvh):
    sizes = [pantin.convert(bvh, bound, effort="fast").nbytes for bound in (0.1, 0.5, 3.0)]
    assert sizes[0] > sizes[1] > sizes[2]


def test_clips_are_those_of_the_program(bvh, tmp_path):
    tool = os.environ.get("PANTIN_TOOL")
    if not tool:
        pytest.skip("PANTIN_TOOL names the program pantin")
    made = tmp_path / "walk.ptn"
    options = ["--effort", "fast", "--max-error", "0.4cm", "--fps", "30", "-q"]
    subprocess.run([tool, "convert", bvh, "-o", made, *options], check=True)
    assert bytes(pantin.convert(bvh, 0.4, effort="fast", fps=30)) == made.read_bytes()


def arm(frames=60):
    """A body that moves along x, with an arm that swings, and a light."""
    t = np.arange(frames) / 30
    rotations = np.zeros((frames, 3, 4))
    rotations[..., 0] = 1
    rotations[:, 1] = np.stack([np.cos(t), np.sin(t), 0 * t, 0 * t], axis=1) * 2
    translations = np.tile([[0.0, 0, 0], [0, 50, 0], [0, 30, 0]], (frames, 1, 1))
    translations[:, 0, 0] = 40 * t
    joints = [pantin.Joint("body"), pantin.Joint("arm", 0), pantin.Joint("hand", 1)]
    return pantin.Motion(joints, rotations, translations, {"light": np.sin(3 * t)}, rate=30)


def test_arrays_keep_the_bound():
    motion = arm()
    clip = pantin.convert(motion, max_error_cm=0.2, max_scalar_error=1)
    assert [joint.name for joint in clip.joints[:3]] == ["body", "arm", "hand"]
    expected = places([None, 0, 1], matrices(motion.rotations), motion.translations)
    errors = np.linalg.norm(clip.positions()[:, :3] - expected, axis=2)
    assert 0 < errors.max() <= 0.2 and clip.rate == 30 and clip.frames == 60
    assert np.abs(clip.scalars()["light"] - motion.scalars["light"]).max() <= 0.01 * np.abs(motion.scalars["light"]).max()


def test_a_clip_becomes_arrays_and_a_clip_again(walk):
    again = pantin.convert(walk.motion(), max_error_cm=0.5, effort="fast")
    assert [joint.name for joint in again.joints] == [joint.name for joint in walk.joints]
    assert np.linalg.norm(again.positions() - walk.positions(), axis=2).max() <= 0.5


def test_scalars_alone_are_a_motion():
    values = np.linspace(-2, 2, 50)
    clip = pantin.convert(pantin.Motion(scalars={"servo": values}, full_scales={"servo": 4}, rate=50), max_scalar_error=1)
    assert clip.joints == () and np.abs(clip.scalars()["servo"] - values).max() <= 0.04


def test_progress_rises_to_1_in_the_calling_thread(bvh):
    parts, threads = [], set()

    def progress(part):
        parts.append(part)
        threads.add(threading.get_ident())

    pantin.convert(bvh, effort="fast", progress=progress)
    assert parts == sorted(parts) and parts[-1] == 1 and 0 <= parts[0] and threads == {threading.get_ident()}


def test_an_exception_of_the_callback_ends_the_conversion(bvh):
    class Enough(Exception):
        pass

    def progress(part):
        raise Enough(part)

    started = time.monotonic()
    with pytest.raises(Enough):
        pantin.convert(bvh, 0.05, effort="best", progress=progress)
    assert time.monotonic() - started < 30


def test_ctrl_c_ends_a_conversion(bvh):
    # A shell starts programs in the background with the signal ignored, and Python leaves it so.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(0.3, signal.raise_signal, [signal.SIGINT])
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        for _ in range(100):
            pantin.convert(bvh, 0.05, effort="best", jobs=1)
    timer.join()


def test_other_threads_run_during_a_conversion(bvh):
    done = threading.Event()
    naps = []

    def nap():
        while not done.is_set():
            before = time.monotonic()
            time.sleep(0.001)
            naps.append(time.monotonic() - before)

    thread = threading.Thread(target=nap)
    thread.start()
    started = time.monotonic()
    pantin.convert(bvh, 0.2, jobs=1)
    took = time.monotonic() - started
    done.set()
    thread.join()
    # With the lock held, the other thread would sleep through all of it.
    assert max(naps) < max(0.5 * took, 0.1), (max(naps), took)
    assert len(naps) > 10


def test_conversions_run_in_several_threads(bvh):
    clips = [None] * 3

    def convert(index):
        clips[index] = bytes(pantin.convert(bvh, effort="fast", jobs=1))

    threads = [threading.Thread(target=convert, args=[index]) for index in range(3)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert clips[0] is not None and clips == [clips[0]] * 3


@pytest.mark.skipif(not hasattr(os, "fork"), reason="processes fork on Unix")
@pytest.mark.filterwarnings("ignore:.*fork")
def test_a_process_may_fork_after_a_conversion(bvh):
    expected = bytes(pantin.convert(bvh, effort="fast"))
    child = os.fork()
    if child == 0:
        os._exit(0 if bytes(pantin.convert(bvh, effort="fast")) == expected else 1)
    deadline = time.monotonic() + 120
    while time.monotonic() < deadline:
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            assert status == 0
            return
        time.sleep(0.05)
    os.kill(child, signal.SIGKILL)
    pytest.fail("the child hangs")
