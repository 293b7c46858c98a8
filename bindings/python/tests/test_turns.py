"""Rotations of joints: the same bits as by the Rust decoder, in every order and at every frame."""

import os
from pathlib import Path

import numpy as np
import pantin
import pytest

ORDERS = ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX")


def folders(vectors):
    """The golden vectors, and a folder of captures where there is one."""
    captures = os.environ.get("PANTIN_TURNS")
    return [vectors] + ([Path(captures)] if captures else [])


def crc(numbers):
    value = 0xFFFF
    for byte in numbers.astype("<i4").tobytes():
        value ^= byte << 8
        for _ in range(8):
            value = (value << 1 ^ 0x11021) if value & 0x8000 else value << 1
    return "%04x" % value


def matrix_of(quaternions):
    w, x, y, z = np.moveaxis(quaternions, -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def about(axis, degrees):
    half = np.radians(degrees) / 2
    result = np.zeros((len(half), 4))
    result[:, 0] = np.cos(half)
    result[:, 1 + axis] = np.sin(half)
    return matrix_of(result)


def test_joints_turn_as_by_the_rust_decoder(vectors):
    compared = 0
    for folder in folders(vectors):
        for line in (folder / "turn-sums.txt").read_text().splitlines():
            words = line.split(" ")
            clip = pantin.Clip.open(folder / (words[0] + ".ptn"))
            joint, sums = " ".join(words[1 : -clip.frames]), words[-clip.frames :]
            # Degrees are multiples of 2^-32 turns.
            degrees = np.stack([clip.euler(joint, order) for order in ORDERS], axis=1)
            turns = np.rint(degrees * (2**32 / 360)).astype(np.int64)
            assert np.array_equal(turns * (360 / 2**32), degrees)
            assert [crc(frame) for frame in turns.astype(np.int32)] == [own[:4] for own in sums], line[:60]
            # Quaternions are floating point here: the same rotation.
            whole = matrix_of(clip.rotations(joint))
            for at, order in enumerate(ORDERS):
                product = np.eye(3)
                for axis, letter in enumerate(order):
                    product = product @ about("XYZ".index(letter), degrees[:, at, axis])
                assert np.abs(product - whole).max() < 1e-6, line[:60]
            compared += clip.frames
    assert compared > 2000


def test_a_joint_that_is_not_there_is_named(vectors):
    clip = pantin.Clip.open(vectors / "own-mixed.ptn")
    for read in (clip.joint_index, clip.rotations, lambda name: clip.euler(name, "XYZ")):
        with pytest.raises(KeyError, match="no joint 'nobody'\"$"):
            read("nobody")


def test_a_similar_name_is_suggested(walk):
    for name in ("LEFT-SHIN", "Beta:left-shin", "left-chin"):
        with pytest.raises(KeyError, match=f"no joint '{name}'; there is 'left-shin'"):
            walk.joint_index(name)


def test_joints_have_the_order_of_their_angles(walk, vectors):
    orders = {joint.name: joint.order for joint in walk.joints}
    assert (orders["left-shin"], orders["neck"], orders["chest"], orders["spine"]) == ("XYZ", "YXZ", "YZX", None)
    clip = pantin.Clip.open(vectors / "turn-orders.ptn")
    assert [clip.joints[clip.joint_index(name)].order for name in ("j7", "j8")] == ["YXZ", None]
    # Without an order, angles are in the joint's own: those that the clip stores.
    raw = walk.raw()[:, walk.channel_names.index("neck.Yrotation")]
    assert np.array_equal(walk.euler("neck")[:, 0], raw * (360 / 2**32))
    assert np.array_equal(clip.euler("j8"), clip.euler("j8", "XYZ"))
