# What the module in C refuses, and what it keeps alive: micropython tests/module.py REPOSITORY
import framebuf
import gc
import sys

import pantin


def refused(kind, act, *arguments, **named):
    try:
        act(*arguments, **named)
    except kind:
        return
    raise AssertionError((kind, arguments, named))


def file(path):
    with open(sys.argv[1] + "/" + path, "rb") as opened:
        return opened.read()


data = file("motions/walk.ptn")
clip = pantin.Clip(data)
for bad in (data[:-1], b"", b"Pn"):
    refused(ValueError, pantin.Clip, bad)
for bad in ((), (3,), (data, 5)):
    refused(TypeError, pantin.Clip, *bad)
for bad in ("a\0b", "left-thigh\0", "nobody", ""):
    refused(KeyError, clip.find, bad)
refused(TypeError, clip.find, 3)
refused(AttributeError, lambda: clip.nothing)
joint = clip.find("left-thigh")
assert (joint.name, joint.order, joint.kinds) == ("left-thigh", "XYZ", b"\x03") and joint.raw() == (clip.pose[joint.first],)
for bad in ("XYX", "", "ZXYZ", None):
    refused(ValueError, joint.euler, bad)
clip.seek(1000000)
assert clip.frame == clip.frames - 1 and not clip.step()
clip.seek(-3)
assert clip.frame == 0 and clip.update(500) and clip.frame == 60 and not clip.update(500)

# Figures.
for width, height in ((0, 10), (2048, 10), (10, -1)):
    refused(ValueError, pantin.Figure, clip, width, height)
refused(TypeError, pantin.Figure, data, 64, 64)
refused(ValueError, pantin.Figure, clip, 64, 64, look=b"none")
figure = pantin.Figure(clip, 64, 64)
assert clip.frame == 60
rows = bytearray(64 * 64 * 2)
figure.draw(rows)
assert any(rows)
for bad in ((bytearray(10),), (rows, 5), (rows, -1), (rows, 2, 5, 3), (rows, 2, 0, 65), (rows, 2, -1, 3), (rows, 2, 0, 64, 10), (memoryview(rows)[1:], 3, 0, 9)):
    refused(ValueError, figure.draw, *bad)
refused(TypeError, figure.draw, data)
assert len(figure.lines()) > 10 and len(figure.head()) == 4

# Faces.
for bad in ((0, 10), (10, 2048), (10, 10, data), (10, 10, b"")):
    refused(ValueError, pantin.Face, *bad)
refused(KeyError, pantin.Face, 10, 10, "nobody")
for model in ("eyes", "minimal", "cartoon"):
    face = pantin.Face(64, 64, model)
    face.draw(rows)
    assert any(rows)
assert len(face.emotes) == 23
refused(KeyError, face.emote, "hungry")
face.emote("happy")
face.live(3)
refused(ValueError, face.sound, bytes(64), 100)
for rate in (16000, 8000):
    face.sound(bytes(3200), rate)
for ms in (33, -5, 10000000):
    face.step(ms)
face.viseme(10, 50)
for bad in ((15, 0), (-1, 0), (3, 10), (3, -1)):
    refused(ValueError, face.viseme, *bad)
for bad in (3, float("nan"), float("inf")):
    refused(ValueError, face.mouth, bad)
    refused(ValueError, face.weight, "smile_left", bad)
refused(KeyError, face.weight, "nose", 1)
refused(ValueError, face.palette, [1, 2])
face.palette(list(range(16)))
face.palette(None)
refused(ValueError, face.play, data)

# The lips move by sound: a vowel opens the mouth, silence closes it.
face = pantin.Face(64, 64)
face.draw(rows, pantin.L8)
closed = bytes(rows)
for n in range(20):
    face.sound(bytes([0, 0x30] * 12 + [0, 0xD0] * 12) * 22)
    face.step(33)
face.draw(rows, pantin.L8)
assert bytes(rows) != closed
face.step(2000)
face.draw(rows, pantin.L8)
assert bytes(rows) == closed


# A bank, a rig and a clip live as long as what came of them.
def of_a_bank():
    clip = pantin.Bank(file("tests/vectors/bank.ptb")).clip("walk")
    return clip.find([joint.name for joint in clip.rig.joints if joint.kinds][-1])


def of_a_rig():
    rig = pantin.Rig(file("tests/vectors/rig-apart.rig"))
    return pantin.Clip(file("tests/vectors/rig-apart.ptn"), rig).find(rig.joints[0].name)


joints = [of_a_bank(), of_a_rig()]
before = [(joint.name, joint.quaternion()) for joint in joints]
for n in range(300):
    garbage = [bytearray(1000) for _ in range(20)]
gc.collect()
assert [(joint.name, joint.quaternion()) for joint in joints] == before


# A display whose lines fail.
class Broken:
    def line(self, *arguments):
        raise OSError(5)


refused(OSError, clip.draw, Broken(), 128, 64)
screen = bytearray(1024)
clip.draw(framebuf.FrameBuffer(screen, 128, 64, framebuf.MONO_VLSB), 128, 64)
assert any(screen)
# A flipped bit is refused, or decoded and drawn as something else.
for at in range(0, len(data), 1 + len(data) // 100):
    damaged = bytearray(data)
    damaged[at] ^= 16
    try:
        pantin.Figure(pantin.Clip(damaged), 64, 64).draw(rows)
    except (ValueError, UnicodeError):
        pass
print("the module refuses what is wrong, and keeps what is used")
