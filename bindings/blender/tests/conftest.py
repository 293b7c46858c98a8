"""Ends the process with the outcome of the tests: the module bpy 4.2 crashes as it ends after Rigify has generated a rig, or glTF was exported, with and without the
add-on."""

import os
import sys

outcome = 0


def pytest_sessionfinish(exitstatus):
    global outcome
    outcome = int(exitstatus)


def pytest_unconfigure():
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(outcome)
