"""Sending the pose live, and conversions in steps. `pantin_addon` is a copy of the add-on's folder."""

import math
import os
import socket
import struct
import subprocess
import sys
import time
from types import SimpleNamespace

import bpy
import pantin
import pytest
from mathutils import Quaternion, Vector
from test_addon import human, rig, scene  # noqa: F401

import pantin_addon
from pantin_addon import live
from pantin_addon.job import Cancelled, Job, in_thread
from pantin_addon.operators import PANTIN_OT_export, PANTIN_OT_live, conversion


def person(names):
    """An armature that stands with its arms down at 45 degrees, looking along -y, and the names of its bones."""
    data = bpy.data.armatures.new("Person")
    armature = bpy.data.objects.new("Person", data)
    bpy.context.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    armature.select_set(True)
    bpy.ops.object.mode_set(mode="EDIT")
    heads = [
        ("hips", None, (0, 0, 1), (0, 0, 1.1)),
        ("chest", "hips", (0, 0, 1.1), (0, 0, 1.4)),
        ("head", "chest", (0, 0, 1.5), (0, 0, 1.7)),
        ("upper_arm.L", "chest", (0.2, 0, 1.4), (0.4, 0, 1.2)),
        ("forearm.L", "upper_arm.L", (0.4, 0, 1.2), (0.6, 0, 1.0)),
        ("thigh.R", "hips", (-0.1, 0, 1), (-0.1, 0, 0.5)),
    ]
    for name, parent, head, tail in heads:
        bone = data.edit_bones.new(names.get(name, name))
        bone.head, bone.tail = head, tail
        bone.parent = data.edit_bones[names.get(parent, parent)] if parent else None
    bpy.ops.object.mode_set(mode="OBJECT")
    for bone in armature.pose.bones:
        bone.rotation_mode = "QUATERNION"
    return armature


def read(data):
    """The bones of a datagram: name to place and turn, as the protocol has them."""
    assert data[:16] == b"#bundle\0" + bytes(7) + b"\1" and len(data) % 4 == 0
    found, at = {}, 16
    while at < len(data):
        (length,) = struct.unpack_from(">i", data, at)
        body = data[at + 4 : at + 4 + length]
        parts = body.split(b"\0,sfffffff\0\0\0")
        assert parts[0].rstrip(b"\0") == b"/VMC/Ext/Bone/Pos", body
        numbers = struct.unpack(">7f", body[-28:])
        found[parts[1][:-28].rstrip(b"\0").decode()] = Vector(numbers[:3]), Quaternion((numbers[6], *numbers[3:6]))
        at += 4 + length
    return found


def poses(armature):
    bpy.context.view_layer.update()
    return read(live.datagram(live.pose_of(bpy.context, armature, live.humanoid(armature))))


def angle(one, two):
    return math.degrees(one.rotation_difference(two).angle)


def about(axis, degrees):
    return Quaternion(axis, math.radians(degrees))


def turn_in_world(armature, name, turn):
    """Turns a bone about the world's axes."""
    bone = armature.pose.bones[name]
    rest = bone.bone.matrix_local.to_quaternion()
    bone.rotation_quaternion = rest.inverted() @ turn @ rest


def test_names_of_bones():
    for name, expected in {
        "mixamorig:LeftForeArm": ("forearm", "Left"),
        "DEF-upper_arm.R": ("upperarm", "Right"),
        "left-upper-arm": ("upperarm", "Left"),
        "spine.003": ("spine003", ""),
        "R_Foot": ("foot", "Right"),
        "Hand_l": ("hand", "Left"),
        "LeftUpLeg": ("upleg", "Left"),
        "lower_leg": ("lowerleg", ""),
        "pelvis": ("pelvis", ""),
    }.items():
        assert live.plain(name) == expected, name


@pytest.mark.parametrize("names", [{}, {"hips": "mixamorig:Hips", "upper_arm.L": "mixamorig:LeftArm", "thigh.R": "mixamorig:RightUpLeg"}])
def test_turns_are_those_of_the_protocol(names):
    armature = person(names)
    left = names.get("upper_arm.L", "upper_arm.L")
    found = poses(armature)
    assert set(found) == {"Hips", "Chest", "Head", "LeftUpperArm", "LeftLowerArm", "RightUpperLeg"}
    # The figure is a metre high at its hips; arms that hang at 45 degrees are turned by 45 about z, which points ahead there. Unity's turns are left-handed.
    assert (found["Hips"][0] - Vector((0, 1, 0))).length < 1e-6
    assert angle(found["LeftUpperArm"][1], about((0, 0, 1), 45)) < 0.1
    assert angle(found["LeftLowerArm"][1], Quaternion()) < 0.1
    assert angle(found["RightUpperLeg"][1], Quaternion()) < 0.1 and angle(found["Head"][1], Quaternion()) < 0.1
    # Arms out, as in the protocol's rest pose.
    turn_in_world(armature, left, about((0, 1, 0), -45))
    assert angle(poses(armature)["LeftUpperArm"][1], Quaternion()) < 0.1
    # The head turns to the figure's left: about z, up, here. There it is about y, and the other way.
    turn_in_world(armature, "head", about((0, 0, 1), 30))
    assert angle(poses(armature)["Head"][1], about((0, 1, 0), -30)) < 0.1
    # The leg swings ahead, to -y: about -x here, and also there.
    turn_in_world(armature, names.get("thigh.R", "thigh.R"), about((1, 0, 0), -40))
    assert angle(poses(armature)["RightUpperLeg"][1], about((1, 0, 0), -40)) < 0.1
    # What turns the whole figure turns the hips alone.
    before = poses(armature)
    armature.rotation_euler = (0, 0, math.radians(90))
    armature.location = (2, 0, 0)
    after = poses(armature)
    assert angle(after["Hips"][1], about((0, 1, 0), -90)) < 0.1 and (after["Hips"][0] - Vector((-2, 1, 0))).length < 1e-5
    assert all(angle(after[bone][1], before[bone][1]) < 0.1 for bone in before if bone != "Hips")


def test_a_generated_human_has_all_bones(scene):  # noqa: F811
    armature = human(scene)
    found = live.humanoid(armature)
    assert len(found) == 22 and found["Hips"] == "DEF-spine" and found["LeftUpperArm"] == "DEF-upper_arm.L", found
    scene.frame_set(21)
    assert angle(poses(armature)["RightUpperArm"][1], Quaternion()) > 30
    assert len(live.datagram(live.pose_of(bpy.context, armature, found))) < 2048


def port():
    """A socket that listens on a port of its own."""
    listening = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    listening.bind(("127.0.0.1", 0))
    listening.settimeout(5)
    return listening, listening.getsockname()[1]


def test_the_pose_is_sent_while_one_scrubs(scene):  # noqa: F811
    armature = person({})
    for frame, degrees in (1, 0), (11, 60), (21, 120):
        turn_in_world(armature, "forearm.L", about((1, 0, 0), degrees))
        armature.pose.bones["forearm.L"].keyframe_insert("rotation_quaternion", frame=frame)
    listening, scene.pantin.port = port()
    # Without a window, the operator sends once.
    assert bpy.ops.pantin.live() == {"FINISHED"} and not scene.pantin.live
    assert len(read(listening.recv(4096))) == 6
    reports, ticks = [], SimpleNamespace(type="TIMER")
    operator = SimpleNamespace(
        sender=live.Sender(armature, scene.pantin.host, scene.pantin.port),
        timer=None,
        report=lambda kinds, text: reports.append(text),
    )
    manager = SimpleNamespace(event_timer_remove=lambda timer: None)
    context = SimpleNamespace(
        scene=scene, window_manager=manager, evaluated_depsgraph_get=bpy.context.evaluated_depsgraph_get
    )
    scene.pantin.live = True
    turns = []
    for frame in (1, 11, 21):
        scene.frame_set(frame)
        assert PANTIN_OT_live.modal(operator, context, ticks) == {"PASS_THROUGH"}
        turns.append(read(listening.recv(4096))["LeftLowerArm"][1])
    assert angle(turns[0], turns[1]) > 20 and angle(turns[1], turns[2]) > 20
    # All else is Blender's.
    assert PANTIN_OT_live.modal(operator, context, SimpleNamespace(type="LEFTMOUSE")) == {"PASS_THROUGH"}
    assert PANTIN_OT_live.modal(operator, context, SimpleNamespace(type="ESC")) == {"FINISHED"}
    assert reports == ["3 poses were sent"] and not scene.pantin.live
    # An armature that is gone ends it, too.
    operator.sender = live.Sender(armature, scene.pantin.host, scene.pantin.port)
    scene.pantin.live = True
    bpy.data.objects.remove(armature)
    assert PANTIN_OT_live.modal(operator, context, ticks) == {"FINISHED"}


@pytest.mark.skipif("PANTIN_TOOL" not in os.environ, reason="PANTIN_TOOL names no program")
def test_the_program_shows_what_is_sent(tmp_path):
    armature = person({})
    listening, free = port()
    listening.close()
    board, line = port()
    walk = os.path.join(os.environ["PANTIN_ROOT"], "motions/walk.ptn")
    command = [os.environ["PANTIN_TOOL"], "stream", walk, "--live", f"vmc:{free}", "--to", f"udp:127.0.0.1:{line}@115200"]
    sender, printed = live.Sender(armature, "127.0.0.1", free), ""
    with open(tmp_path / "log", "w") as log:
        program = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT)
    try:
        until = time.monotonic() + 30
        while "its poses are shown" not in printed and time.monotonic() < until:
            assert sender.send(bpy.context) and program.poll() is None, printed
            time.sleep(live.PERIOD)
            printed = (tmp_path / "log").read_text()
        assert "its poses are shown" in printed and "left out" not in printed, printed
        assert len(board.recv(4096)) > 8
    finally:
        program.kill()
        program.wait()
        sender.close()


def test_what_cannot_be_sent_is_named(scene):  # noqa: F811
    armature = rig()
    for bone in armature.data.bones:
        bone.name = f"part {bone.name}"
    with pytest.raises(RuntimeError, match="no bone of armature `Rig` is one of a humanoid"):
        bpy.ops.pantin.live()
    armature.data.bones["part head"].name = "head"
    scene.pantin.host = "nowhere.invalid"
    with pytest.raises(RuntimeError, match="nowhere.invalid: "):
        bpy.ops.pantin.live()


def modal_export(path):
    """An export as a window runs it, and what it reports."""
    reports, bar = [], []
    manager = SimpleNamespace(
        progress_update=bar.append, progress_end=lambda: bar.append("end"), event_timer_remove=lambda timer: None
    )
    workspace = SimpleNamespace(status_text_set=bar.append)
    context = SimpleNamespace(window_manager=manager, workspace=workspace, scene=bpy.context.scene)
    operator = SimpleNamespace(
        filepath=path,
        timer=None,
        report=lambda kinds, text: reports.append(text),
        REFUSALS=PANTIN_OT_export.REFUSALS,
        job=Job(conversion(bpy.context, lambda kinds, text: None, threaded=True)),
    )
    operator.finished = lambda context, clip: PANTIN_OT_export.finished(operator, context, clip)
    operator.stop = lambda context, outcome: PANTIN_OT_export.stop(operator, context, outcome)
    return operator, context, reports, bar


def test_a_conversion_shows_how_far_it_is(tmp_path):
    rig()
    at_once, in_steps = str(tmp_path / "once.ptn"), str(tmp_path / "steps.ptn")
    bpy.ops.pantin.export(filepath=at_once)
    bpy.context.scene.frame_set(7)
    operator, context, reports, bar = modal_export(in_steps)
    outcome = {"RUNNING_MODAL"}
    while outcome == {"RUNNING_MODAL"}:
        outcome = PANTIN_OT_export.modal(operator, context, SimpleNamespace(type="TIMER"))
        assert PANTIN_OT_export.modal(operator, context, SimpleNamespace(type="MOUSEMOVE")) == {"RUNNING_MODAL"}
    assert outcome == {"FINISHED"} and reports == [bpy.context.scene.pantin.result]
    assert open(at_once, "rb").read() == open(in_steps, "rb").read()
    numbers = [part for part in bar if isinstance(part, int)]
    assert numbers == sorted(numbers) and all(0 <= part <= 100 for part in numbers) and bar[-2:] == ["end", None]
    assert bpy.context.scene.frame_current == 7


def test_a_conversion_can_be_cancelled(tmp_path, monkeypatch):
    def endless(motion, bound, progress, **options):
        while True:
            progress(0.5)
            time.sleep(0.001)

    # One that does not end before it is cancelled.
    monkeypatch.setattr(pantin, "convert", endless)
    rig()
    bpy.context.scene.frame_set(9)
    path = tmp_path / "none.ptn"
    # While the scene is read, and while the clip is made.
    for part in (0.05, 0.6):
        operator, context, reports, bar = modal_export(str(path))
        work = operator.job._work
        while next(work) < part:
            pass
        assert PANTIN_OT_export.modal(operator, context, SimpleNamespace(type="ESC")) == {"CANCELLED"}
        assert reports == ["cancelled: nothing was written"] and bar == ["end", None]
        assert not path.exists() and bpy.context.scene.frame_current == 9


def test_a_refusal_ends_a_conversion_in_steps(tmp_path):
    armature = rig()
    armature.scale = (1, 1, 3)
    operator, context, reports, _ = modal_export(str(tmp_path / "none.ptn"))
    assert PANTIN_OT_export.modal(operator, context, SimpleNamespace(type="TIMER")) == {"CANCELLED"}
    assert len(reports) == 1 and "non-uniform scale" in reports[0]


def test_a_thread_ends_when_it_is_closed():
    seen = []

    def work(progress):
        try:
            while True:
                progress(0.5)
        except Cancelled:
            seen.append("cancelled")
            raise

    steps = in_thread(work)
    next(steps)
    steps.close()
    assert seen == ["cancelled"]
    with pytest.raises(pantin.PantinError):
        for _ in in_thread(lambda progress: pantin.Clip.open(os.devnull)):
            pass


# A head with two shape keys, written as glTF.
HEAD = """
import os, sys
import bpy
bpy.ops.mesh.primitive_uv_sphere_add(segments=12, ring_count=8)
head = bpy.context.object
for name in ("Basis", "smile", "blink"):
    key = head.shape_key_add(name=name)
    for number, point in enumerate(key.data):
        point.co.z += {"smile": 0.1, "blink": -0.05}.get(name, 0) * (number % 3)
bpy.ops.export_scene.gltf(filepath=sys.argv[1], use_selection=True, export_morph=True)
sys.stdout.flush()
os._exit(0)
"""


@pytest.mark.skipif("PANTIN_TOOL" not in os.environ, reason="PANTIN_TOOL names no program")
def test_a_mesh_with_shape_keys_becomes_a_face(tmp_path):
    path, model, names = (str(tmp_path / name) for name in ("head.glb", "head.model", "head.names"))
    # In a process of its own, which ends at once: some versions of the module crash as they end after an export of glTF.
    subprocess.run([sys.executable, "-c", HEAD, path], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([os.environ["PANTIN_TOOL"], "face", "model", path, "-o", model, "--names", names], check=True)
    with open(names) as file:
        assert {"smile", "blink"} <= set(file.read().split())
    assert 100 < os.path.getsize(model) < 20000
