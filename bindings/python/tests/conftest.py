"""Files of the repository that the tests read."""

import os
from pathlib import Path

import pytest

import pantin

# The tests run in a copy of this folder, from which the package cannot be imported.
ROOT = Path(os.environ["PANTIN_ROOT"])


@pytest.fixture(scope="session")
def motions():
    return ROOT / "motions"


@pytest.fixture(scope="session")
def vectors():
    return ROOT / "tests/vectors"


@pytest.fixture
def walk(motions):
    return pantin.Clip.open(motions / "walk.ptn")


@pytest.fixture(scope="session")
def bvh(motions, tmp_path_factory):
    """A walk as a BVH file."""
    path = tmp_path_factory.mktemp("bvh") / "walk.bvh"
    pantin.Clip.open(motions / "walk.ptn").to_bvh(path)
    return path
