# Compares the rotations of joints at every frame with the checksums in turn-sums.txt, by the Rust decoder: micropython tests/turn_sums.py FOLDER
import sys
from array import array

import pantin
from checksums import crc as crc_of

ORDERS = ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX")


def crc(values):
    return crc_of(array("i", values))


def sums(joint):
    angles = [x for order in ORDERS for x in joint.euler(order)]
    others = list(joint.quaternion()) + [x for row in joint.matrix() for x in row] + [joint.angle()]
    return "%04x%04x" % (crc(angles), crc(others))


folder = sys.argv[1]
expected = {}
with open(folder + "/turn-sums.txt") as lines:
    for line in lines:
        line = line.split()
        expected.setdefault(line[0], []).append(line)
rotations = 0
for name, lines in expected.items():
    clip = pantin.Clip(open(folder + "/" + name + ".ptn", "rb").read())
    # A joint's name may have spaces.
    joints = [(clip.find(" ".join(line[1 : -clip.frames])), line[-clip.frames :]) for line in lines]
    for frame in range(clip.frames):
        for joint, wanted in joints:
            assert sums(joint) == wanted[frame], (name, joint.name, frame)
            rotations += 1
        clip.step()
assert rotations
print(len(expected), "clips,", rotations, "rotations")
