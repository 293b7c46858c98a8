"""Key clips: the poses of the golden vectors, and which kind of clip is written."""

import binascii
import json

import pytest

import pantin


def test_key_vectors_are_equal_to_the_bit(vectors):
    files = sorted((vectors.parent / "key-vectors").glob("*.ptn"))
    assert len(files) > 20
    for path in files:
        record = json.loads(path.with_suffix(".json").read_text())
        rig = path.with_suffix(".rig")
        clip = pantin.Clip.open(path, rig if rig.exists() else None)
        assert clip.has_keys
        frames = clip.raw().astype("<i4")
        assert [f"{binascii.crc_hqx(frame.tobytes(), 0xFFFF):04x}" for frame in frames] == record["crcs"], path.name


def test_the_smaller_clip_is_written(motions):
    walk = motions / "walk.keys"
    smaller = pantin.convert(walk, effort="fast")
    segments = pantin.convert(walk, effort="fast", segments=True)
    assert smaller.has_keys and not segments.has_keys and smaller.nbytes < segments.nbytes
    assert bytes(pantin.convert(walk, effort="fast", keys=True)) == bytes(smaller)
    assert any("key clip" in note.text for note in smaller.report["notes"])
    assert not pantin.convert(walk, effort="fast", index=0.5).has_keys


def test_keys_that_are_not_there_are_refused(motions, bvh, tmp_path):
    with pytest.raises(pantin.BoundError, match="no key clip of this motion.*keys=False"):
        pantin.convert(bvh, effort="fast", keys=True)
    with pytest.raises(pantin.SettingError, match="keys or segments"):
        pantin.convert(motions / "walk.keys", keys=True, segments=True)
    with pytest.raises(pantin.PantinError, match="segments, no keys"):
        pantin.Clip.open(motions / "walk.ptn").to_keys(tmp_path / "walk.keys")


def test_keys_come_back_as_text(motions, tmp_path):
    greet = pantin.convert(motions / "greet.keys", effort="fast", keys=True)
    greet.to_keys(tmp_path / "greet.keys")
    assert bytes(pantin.convert(tmp_path / "greet.keys", effort="fast", keys=True)) == bytes(greet)
