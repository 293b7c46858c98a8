"""Errors: exceptions with the file and the line."""

import numpy as np
import pytest

import pantin


def test_an_error_in_a_motion_names_file_and_line(bvh, tmp_path):
    lines = bvh.read_text().splitlines()
    row = lines.index("MOTION") + 5
    lines[row] = "x" + lines[row]
    broken = tmp_path / "broken.bvh"
    broken.write_text("\n".join(lines))
    with pytest.raises(pantin.PantinError) as caught:
        pantin.convert(broken)
    assert (caught.value.path, caught.value.line) == (str(broken), row + 1)
    assert str(caught.value).startswith(f"{broken}:{row + 1}: ")
    assert isinstance(caught.value, ValueError)


def test_missing_files_are_the_usual_exceptions(tmp_path, bvh):
    missing = tmp_path / "missing"
    for fails in [pantin.convert, pantin.Clip.open, pantin.Bank.open]:
        with pytest.raises(FileNotFoundError) as caught:
            fails(missing)
        assert caught.value.filename == str(missing)
    with pytest.raises(IsADirectoryError):
        pantin.convert(tmp_path)
    with pytest.raises(FileNotFoundError):
        pantin.convert(bvh, skeleton=missing)


def test_what_is_no_motion_is_named(motions, tmp_path):
    with pytest.raises(pantin.PantinError, match="not a motion") as caught:
        pantin.convert(motions / "walk.ptn")
    assert caught.value.path == str(motions / "walk.ptn") and caught.value.line is None
    odd = tmp_path / "odd.xyz"
    odd.write_bytes(b"nothing")
    with pytest.raises(pantin.PantinError, match="unknown kind of file"):
        pantin.convert(odd)


def test_damaged_clips_are_refused(motions, vectors, tmp_path):
    data = (motions / "walk.ptn").read_bytes()
    for place in range(0, len(data), 7):
        damaged = bytearray(data)
        damaged[place] ^= 16
        try:
            pantin.Clip(damaged).raw()
        except pantin.PantinError:
            pass
    path = tmp_path / "half.ptn"
    path.write_bytes(data[: len(data) // 2])
    with pytest.raises(pantin.PantinError) as caught:
        pantin.Clip.open(path)
    assert caught.value.path == str(path) and str(caught.value).startswith(f"{path}: ")
    with pytest.raises(pantin.PantinError, match="pantin.Bank opens"):
        pantin.Clip.open(vectors / "bank.ptb")
    with pytest.raises(pantin.PantinError):
        pantin.Bank.open(motions / "walk.ptn")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"max_error_cm": 0}, "max_error_cm=0"),
        ({"max_error_cm": float("nan")}, "max_error_cm=NaN"),
        ({"max_scalar_error": -1}, "max_scalar_error=-1"),
        ({"effort": "much"}, 'effort="much"'),
        ({"fps": 0}, "fps=0"),
        ({"up": "w"}, 'up="w"'),
        ({"animation": "run"}, "holds one motion"),
    ],
)
def test_options_are_checked(bvh, options, message):
    with pytest.raises(pantin.PantinError, match=message):
        pantin.convert(bvh, **options)


def test_arrays_are_checked():
    joints = [pantin.Joint("body"), pantin.Joint("arm", 0, (0, 1, 0))]
    still = np.tile([1.0, 0, 0, 0], (5, 2, 1))
    with pytest.raises(ValueError, match=r"rotations has the shape \(5, 1, 4\); expected \(5, 2, 4\)"):
        pantin.convert(pantin.Motion(joints, still[:, :1]))
    with pytest.raises(ValueError, match=r"scalars\['a'\] has the shape \(4,\)"):
        pantin.convert(pantin.Motion(joints, still, scalars={"a": np.zeros(4)}))
    with pytest.raises(ValueError, match="without joints and scalars"):
        pantin.convert(pantin.Motion())
    with pytest.raises(TypeError, match="cm_per_unit is for files"):
        pantin.convert(pantin.Motion(joints, still), cm_per_unit=1)
    still[3, 1] = 0
    with pytest.raises(pantin.PantinError, match="joint `arm` at frame 3"):
        pantin.convert(pantin.Motion(joints, still))
    still[3, 1] = np.nan
    with pytest.raises(pantin.PantinError, match="joint `arm` at frame 3"):
        pantin.convert(pantin.Motion(joints, still))


def test_a_bound_that_cannot_be_met_is_refused(bvh):
    with pytest.raises(pantin.PantinError) as caught:
        pantin.convert(bvh, max_error_cm=1e-9, effort="fast")
    assert caught.value.path == str(bvh)
