# Emotes in Python: after a transition the weights are those of the clips at every frame, and a transition has no jump.
import pantin
from pantin_emotes import EMOTES, Emotes

face = Emotes()
assert len(Emotes.names) == 23 and face.name == "neutral"
try:
    face.show("hungry")
    raise AssertionError("an unknown emote is shown")
except KeyError as error:
    assert "hungry" in str(error) and face.name == "neutral"
now = frames = 0
for name in Emotes.names:
    before = face.weights()
    face.show(name)
    for unit, weight in face.weights().items():
        assert abs(weight - before.get(unit, 0)) < 1e-6, (name, unit)
    clip = pantin.Clip(EMOTES[name])
    start = now
    now += 300
    for frame in range(clip.frames):
        ms = 300 + frame * clip.frame_time_ns // 1000000
        face.update(start + ms)
        clip.update(ms)
        for scalar in clip.rig.scalars:
            assert face.weight(scalar[2]) == clip.scalar(scalar[2]), (name, frame)
        frames += 1
    now = start + ms
    assert face.weight("no such unit") == 0
face = Emotes("neutral", transition_ms=0)
face.show("surprised")
assert face.weight("amazed") > 0
print(len(Emotes.names), "emotes,", frames, "frames")
