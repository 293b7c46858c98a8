# Compares every frame of the test vectors with their records: micropython tests/vectors.py FOLDER
import json
import os
import sys
from array import array

import pantin
from checksums import crc

# The module in C plays key clips and has figures; the decoder in Python places joints itself.
IN_C = hasattr(pantin, "Figure")


def pose_crc(pose):
    return "%04x" % crc(pose)


def crcs(clip):
    found = [pose_crc(clip.pose)]
    while clip.step():
        found.append(pose_crc(clip.pose))
    return found


def turn_matches(line, joint):
    # The line's angles, quaternion, and checksum of the matrix, the whole angle and all orders.
    values = [int(x) for x in line[3:13]]
    assert list(joint.euler("XYZ") + joint.euler("ZXY") + joint.quaternion()) == values, line
    rest = array("i", [x for row in joint.matrix() for x in row] + [joint.angle()])
    for order in ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"):
        rest.extend(array("i", joint.euler(order)))
    assert pose_crc(rest) == line[13], line
    for degrees, raw in zip(joint.degrees("ZXY"), values[3:]):
        assert abs(degrees - raw * 360 / 2.0**32) < 1e-3


def raises_key_error(act, name):
    try:
        act(name)
    except KeyError as error:
        assert name in str(error)
        return True


def product(a, b):
    return [[sum(a[i][n] * b[n][k] for n in range(3)) for k in range(3)] for i in range(3)]


folder = sys.argv[1]
turns = {}
with open(folder + "/turns.txt") as lines:
    for line in lines:
        line = line.split()
        turns.setdefault(line[0], []).append(line)
turned = 0
files = frames = 0
for name in sorted(os.listdir(folder)):
    stem, ending = name[:-4], name[-4:]
    if ending not in (".ptn", ".ptb"):
        continue
    data = open(folder + "/" + name, "rb").read()
    record = json.load(open(folder + "/" + stem + ".json"))
    if ending == ".ptb":
        bank = pantin.Bank(data)
        for own, expected in zip(bank.names, record["clips"]):
            assert own in expected and crcs(bank.clip(own)) in expected, own
        assert len(bank.names) == len(record["clips"])
        files += 1
        continue
    rig = None
    if stem + ".rig" in os.listdir(folder):
        rig = pantin.Rig(open(folder + "/" + stem + ".rig", "rb").read())
    clip = pantin.Clip(data, rig)
    assert crcs(clip) == record["crcs"], name
    own = {
        "frames": clip.frames,
        "frame_time_ns": clip.frame_time_ns,
        "looped": clip.looped,
        "exponential_joints": clip.exponential,
        "events": [list(event) for event in clip.events],
        "event_names": clip.event_names,
        "scalars": [list(scalar) for scalar in clip.rig.scalars],
        "moving": clip.moving,
    }
    for key, value in own.items():
        assert record.get(key, value) == value, (name, key, value, record[key])
    for frame, pose in record.get("poses", {}).items():
        clip.seek(int(frame))
        assert list(clip.pose) == pose, (name, frame)
    # Rotations by joints that were found once, in the order of the file: frame by frame.
    if stem in turns:
        joints = {}
        for line in turns[stem]:
            clip.seek(int(line[2]))
            if line[1] not in joints:
                joints[line[1]] = clip.find(line[1])
            turn_matches(line, joints[line[1]])
            turned += 1
        world = None
        for j, (_, axes) in () if IN_C else zip(clip.rig.joints, pantin._place(clip)):
            own = [[x / 2.0**30 for x in row] for row in joints[j.name].matrix()]
            world = product(world, own) if j.parent is not None else own
            for i in range(3):
                assert all(abs(axes[i][k] - world[i][k]) < 1e-5 for k in range(3)), (name, j.name)
        assert raises_key_error(clip.find, "nobody") and raises_key_error(clip.rig.joint, "nobody")
        assert raises_key_error(clip.scalar, "nothing")
    # A flipped bit is refused, or decoded to something else, without any other error.
    for at in range(0, len(data), 1 + len(data) // 50):
        damaged = bytearray(data)
        damaged[at] ^= 16
        try:
            pantin.Clip(damaged, rig)
        except (ValueError, UnicodeError):
            pass
    files += 1
    frames += clip.frames
# Key clips, alone and in a bank with others: the module in C plays them, the decoder in Python refuses them by name.
key_vectors = folder.rstrip("/") + "/../key-vectors/"
for name in sorted(os.listdir(key_vectors)) if IN_C else ():
    if name[-4:] == ".ptn":
        record = json.load(open(key_vectors + name[:-4] + ".json"))
        rig = None
        if name[:-4] + ".rig" in os.listdir(key_vectors):
            rig = pantin.Rig(open(key_vectors + name[:-4] + ".rig", "rb").read())
        clip = pantin.Clip(open(key_vectors + name, "rb").read(), rig)
        assert crcs(clip) == record["crcs"], name
        files += 1
        frames += clip.frames
with open(key_vectors + "walk.ptn", "rb") as file:
    data = file.read()
with open(key_vectors + "bank.ptb", "rb") as file:
    bank = pantin.Bank(file.read())
for opens in () if IN_C else (lambda: pantin.Clip(data), lambda: bank.clip("keys")):
    try:
        opens()
        raise AssertionError("a key clip opens")
    except ValueError as error:
        assert "--segments" in str(error)
assert bank.clip("walk").frames == 30 and (not IN_C or bank.clip("keys").frames > 1)
assert turned == sum(len(lines) for lines in turns.values()) > 600
print(files, "files,", frames, "frames,", turned, "rotations")
