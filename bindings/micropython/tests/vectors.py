# Compares every frame of the test vectors with their records: micropython tests/vectors.py FOLDER
import json
import os
import sys

import pantin


def pose_crc(pose):
    return "%04x" % pantin._crc(pose, 0, 4 * len(pose), 0xFFFF)


def crcs(clip):
    found = [pose_crc(clip.pose)]
    while clip.step():
        found.append(pose_crc(clip.pose))
    return found


folder = sys.argv[1]
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
print(files, "files,", frames, "frames")
