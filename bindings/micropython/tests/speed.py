# Microseconds for a frame of a clip, without drawing: micropython tests/speed.py CLIP.ptn
import sys
import time

import pantin

with open(sys.argv[1], "rb") as file:
    clip = pantin.Clip(file.read())
best = None
for _ in range(5):
    clip.restart()
    start = time.ticks_us()
    while clip.step():
        pass
    taken = time.ticks_diff(time.ticks_us(), start)
    best = taken if best is None else min(best, taken)
print(best / (clip.frames - 1))
