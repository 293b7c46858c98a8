# Pictures of the module in C: checksums of faces, and those of figures, in the lines that the programs of bindings/c/tests print.
#
#     micropython tests/pictures.py faces FACE.model SMALL.model
#     micropython tests/pictures.py figure CLIP.ptn [RIG.rig]
import sys

import pantin
from checksums import fold

FORMATS = (pantin.I1, pantin.I1_LSB, pantin.L8, pantin.RGB565, pantin.RGB565_SWAPPED)
BAND = 13
START = 0x811C9DC5
SHOTS = (("cartoon", 64, 48, 0, 0), ("cartoon", 128, 64, 0, 0), ("cartoon", 240, 240, 0, 0), ("cartoon", 171, 320, -20, 10),
         ("small", 84, 48, 0, 0), ("face", 128, 64, 0, 0), ("face", 125, 160, 40, -5), ("face", 240, 240, 0, 0))  # fmt: skip
VIEWS = ((128, 64, -50, 12, False, 255), (240, 240, 0, 0, True, 255), (84, 48, -90, 35, False, 255), (171, 320, 140, -20, False, 255),
         (480, 300, 20, 60, True, 6))  # fmt: skip
buffer = memoryview(bytearray(480 * 2 * BAND))


def checksum(drawn, **options):
    # The picture in all formats, in bands of rows. Bits past the last column are not part of it.
    total = START
    width, height = drawn.width, drawn.height
    for format in FORMATS:
        stride = (width + 7) // 8 if format < pantin.L8 else width if format == pantin.L8 else 2 * width
        for y in range(0, height, BAND):
            end = min(y + BAND, height)
            size = stride * (end - y)
            drawn.draw(buffer[:size], format, y, end, **options)
            if format < pantin.L8 and width % 8:
                for row in range(stride - 1, size, stride):
                    buffer[row] &= (0xFF00 >> width % 8 if format == pantin.I1 else 0xFF >> (8 - width % 8)) & 0xFF
            total = fold(total, buffer, size)
    return total


def with_sum(total, sum):
    return fold(total, sum.to_bytes(4, "little"), 4)


def speaking(face):
    face.viseme_weight(13, 20000 / 32768)
    face.speaking(0.75)
    sum = checksum(face)
    face.viseme_weight(0, 0)
    face.speaking(0)
    return sum


def faces(models):
    for name, width, height, orbit, tilt in SHOTS:
        print("%s %dx%d %d %d" % (name, width, height, orbit, tilt))
        face = pantin.Face(width, height, models[name])
        face.aim(orbit, tilt)
        face.transition(0)
        for emote in face.emotes:
            total = START
            face.emote(emote)
            for frame in range(face.frames):
                assert face.frame == frame
                total = with_sum(total, checksum(face))
                if frame + 1 == face.frames:
                    total = with_sum(total, speaking(face))
                face.step(33 + (frame % 3 == 0))
            print(emote, "%08x" % total)


def figure(clip):
    for width, height, orbit, tilt, fixed, up in VIEWS:
        clip.restart()
        try:
            drawn = pantin.Figure(clip, width, height, orbit=orbit, tilt=tilt, fixed=fixed, up=up)
        except ValueError:
            print("none")
            continue
        assert clip.frame == 0
        print("build", drawn.build)
        for frame in range(0, clip.frames, 3):
            clip.seek(frame)
            print("%08x %08x" % (checksum(drawn), checksum(drawn, lines=True)))


def file(path):
    with open(path, "rb") as opened:
        return opened.read()


if sys.argv[1] == "faces":
    faces({"cartoon": "cartoon", "face": file(sys.argv[2]), "small": file(sys.argv[3])})
else:
    figure(pantin.Clip(file(sys.argv[2]), *(pantin.Rig(file(path)) for path in sys.argv[3:])))
