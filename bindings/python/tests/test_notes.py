"""Notes and warnings: those of the library, by the same kinds."""

import json
import warnings

import numpy as np
import pytest
from conftest import ROOT

import pantin

ODD = ROOT / "tests/odd"


def outcome(name, fps):
    """What is reported about an odd file, as `tests/odd/notes.json` has it."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            clip = pantin.convert(ODD / name, 0.5, effort="fast", fps=fps)
        except pantin.PantinError as error:
            kinds = {pantin.ReadError: "read", pantin.SourceError: "source", pantin.SettingError: "setting", pantin.MemoryLimitError: "memory"}
            return {"kind": kinds[type(error)], "setting": error.setting, "remedy": error.remedy}
    notes = clip.report["notes"]
    raised = [warning.message.note for warning in caught if issubclass(warning.category, pantin.ConversionWarning)]
    assert raised == [note for note in notes if note.severity == "warning"]
    assert clip.report["warnings"] == [note.text for note in raised]
    return {"notes": [f"{note.severity} {note.kind}" for note in notes]}


def test_odd_files_have_the_notes_that_are_listed():
    listed = json.loads((ODD / "notes.json").read_text())
    assert len(listed) >= 5
    for entry in listed:
        assert outcome(entry["file"], entry.get("fps")) == entry["outcome"], entry["file"]


def test_a_note_has_its_place_and_its_remedy_in_words_of_python():
    with pytest.warns(pantin.ConversionWarning, match=r"two-joints.bvh: 1 joint names stand more than once") as caught:
        clip = pantin.convert(ODD / "two-joints.bvh", effort="fast")
    assert caught[0].filename == __file__
    names, unit = clip.report["notes"]
    assert (names.kind, names.joint, names.hint) == ("names", "b", None)
    assert (unit.severity, unit.remedy, unit.hint) == ("info", "state-unit", "state the length of the unit (cm_per_unit=)")
    assert clip.report["units"] == unit.text and str(unit) == f"{unit.text}; {unit.hint}"


def test_a_setting_without_effect_is_named_as_in_python():
    motion = pantin.Motion(scalars={"servo": np.linspace(0, 1, 20)}, rate=25)
    for setting in ("max_error_percent", "max_rotation_error"):
        (note,) = [note for note in pantin.convert(motion, **{setting: 1}).report["notes"] if note.kind == "no-effect"]
        assert note.setting == setting and note.text.startswith(f"{setting} has no effect")


def test_a_warning_may_be_an_error():
    with warnings.catch_warnings():
        warnings.simplefilter("error", pantin.ConversionWarning)
        with pytest.raises(pantin.ConversionWarning):
            pantin.convert(ODD / "two-joints.bvh", effort="fast")
