"""The add-on in Blender without a window: round trips, refusals, undo. `pantin_addon` is a copy of the add-on's folder."""

import math
import os

import bpy
import numpy as np
import pantin
import pytest

import pantin_addon


@pytest.fixture(autouse=True)
def scene():
    """An empty scene at 25 frames a second, with the add-on."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    pantin_addon.register()
    bpy.context.scene.render.fps = 25
    bpy.context.scene.pantin.effort = "fast"
    yield bpy.context.scene
    pantin_addon.unregister()


def rig(scale=1.0):
    """An armature of four bones whose action walks, waves and turns, on an object that is moved, turned and scaled."""
    data = bpy.data.armatures.new("Rig")
    armature = bpy.data.objects.new("Rig", data)
    bpy.context.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    armature.select_set(True)
    bpy.ops.object.mode_set(mode="EDIT")
    ends = {"hip": (0, 0, 0.9), "spine": (0, 0.1, 1.2), "head": (0, 0, 1.6), "arm": (0.5, 0, 1.2)}
    heads = {"hip": (0, 0, 0.6), "spine": (0, 0, 0.9), "head": (0, 0.1, 1.2), "arm": (0, 0.1, 1.2)}
    parents = {"spine": "hip", "head": "spine", "arm": "spine"}
    for name, end in ends.items():
        bone = data.edit_bones.new(name)
        bone.head, bone.tail = heads[name], end
        bone.parent = data.edit_bones[parents[name]] if name in parents else None
    bpy.ops.object.mode_set(mode="OBJECT")
    armature.location, armature.rotation_euler, armature.scale = (1, 2, 0), (0, 0, 0.7), (scale,) * 3
    for frame in range(1, 42, 5):
        t = frame / 25
        bones = armature.pose.bones
        bones["hip"].location = (0.3 * t, 0.02 * math.sin(9 * t), 0)
        bones["hip"].keyframe_insert("location", frame=frame)
        bones["spine"].rotation_mode = "XYZ"
        bones["spine"].rotation_euler = (0.3 * math.sin(5 * t), 0.4 * t, 0)
        bones["spine"].keyframe_insert("rotation_euler", frame=frame)
        bones["arm"].rotation_quaternion = (math.cos(t), 0, 0, math.sin(t))
        bones["arm"].keyframe_insert("rotation_quaternion", frame=frame)
    return armature


def tips(armature, frames):
    """Heads and tails of all bones in the world, in cm."""
    found = []
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        own = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
        ends = [end for bone in own.pose.bones for end in (bone.head, bone.tail)]
        found.append([own.matrix_world @ end for end in ends])
    return 100 * np.array(found)


def face(armature):
    """A mesh on the armature with two shape keys, one of which moves."""
    mesh = bpy.data.meshes.new("Face")
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
    thing = bpy.data.objects.new("Face", mesh)
    bpy.context.collection.objects.link(thing)
    thing.parent = armature
    for name in ("Basis", "smile", "blink"):
        thing.shape_key_add(name=name)
    for frame in range(1, 42, 8):
        key = mesh.shape_keys.key_blocks["smile"]
        key.value = 0.5 + 0.5 * math.sin(frame / 5)
        key.keyframe_insert("value", frame=frame)
    return thing


@pytest.mark.parametrize("scale", [1.0, 0.01])
def test_an_action_comes_back_within_the_bound(tmp_path, scale):
    armature = rig(scale)
    bpy.context.scene.pantin.bound = 0.2
    frames = range(1, 42)
    before = tips(armature, frames)
    path = str(tmp_path / "walk.ptn")
    assert bpy.ops.pantin.export(filepath=path) == {"FINISHED"}
    clip = pantin.Clip.open(path)
    assert [joint.name for joint in clip.joints if not joint.end_site] == ["hip", "spine", "head", "arm"]
    assert (clip.frames, clip.rate, clip.up) == (41, 25, "z")
    # What the action had is gone.
    armature.animation_data_clear()
    for bone in armature.pose.bones:
        bone.matrix_basis.identity()
    assert bpy.ops.pantin.import_clip(filepath=path) == {"FINISHED"}
    assert armature.animation_data.action.name == "walk"
    start = bpy.context.scene.frame_start
    errors = np.linalg.norm(tips(armature, range(start, start + 41)) - before, axis=2)
    assert 0 < errors.max() <= 0.2 + 1e-3, errors.max(axis=0)


def test_the_panel_shows_size_and_error(tmp_path):
    rig()
    path = tmp_path / "walk.ptn"
    bpy.ops.pantin.export(filepath=str(path))
    result = bpy.context.scene.pantin.result
    assert result.startswith(f"{path.stat().st_size} bytes, 41 frames; 0.") and "cm off at most (" in result


def test_shape_keys_come_back(tmp_path):
    armature = rig()
    thing = face(armature)
    keys = thing.data.shape_keys

    def smile(frame):
        bpy.context.scene.frame_set(frame)
        return keys.evaluated_get(bpy.context.evaluated_depsgraph_get()).key_blocks["smile"].value

    before = [smile(frame) for frame in range(1, 42)]
    bpy.context.view_layer.objects.active = armature
    path = str(tmp_path / "face.ptn")
    bpy.ops.pantin.export(filepath=path)
    assert pantin.Clip.open(path).scalar_names == ("smile", "blink")
    keys.animation_data_clear()
    keys.key_blocks["smile"].value = 0
    assert bpy.ops.pantin.import_clip(filepath=path) == {"FINISHED"}
    start = bpy.context.scene.frame_start
    errors = [abs(smile(start + frame) - value) for frame, value in enumerate(before)]
    assert max(errors) <= 0.02 + 1e-3 and max(before) - min(before) > 0.5


def test_properties_are_scalars(tmp_path):
    armature = rig()
    armature["servo"] = 0.0
    for frame in (1, 20, 41):
        armature["servo"] = frame / 10
        armature.keyframe_insert('["servo"]', frame=frame)
    path = str(tmp_path / "servo.ptn")
    bpy.ops.pantin.export(filepath=path)
    servo = pantin.Clip.open(path).scalars()["servo"]
    assert abs(servo[0] - 0.1) < 0.1 and abs(servo[40] - 4.1) < 0.1


def test_a_new_armature_is_built(tmp_path):
    armature = rig()
    bpy.context.scene.pantin.bound = 0.1
    before = tips(armature, range(1, 42))
    path = str(tmp_path / "walk.ptn")
    bpy.ops.pantin.export(filepath=path)
    bpy.ops.pantin.import_clip(filepath=path, new_armature=True)
    built = bpy.context.object
    assert built != armature and [bone.name for bone in built.data.bones] == ["hip", "spine", "head", "arm"]
    start = bpy.context.scene.frame_start
    heads = tips(built, range(start, start + 41))[:, ::2]
    assert np.linalg.norm(heads - before[:, ::2], axis=2).max() <= 0.1 + 1e-3
    # Exported again, its joints are those of the clip.
    again = str(tmp_path / "again.ptn")
    bpy.ops.pantin.export(filepath=again)
    one, other = pantin.Clip.open(path), pantin.Clip.open(again)
    ends = [index for index, joint in enumerate(one.joints) if not joint.end_site]
    assert np.linalg.norm(one.positions()[:, ends] - other.positions()[:, ends], axis=2).max() <= 0.1 + 1e-3


def test_our_walk_is_imported(tmp_path):
    path = os.path.join(os.environ["PANTIN_ROOT"], "motions/walk.ptn")
    bpy.context.scene.render.fps = 120
    assert bpy.ops.pantin.import_clip(filepath=path) == {"FINISHED"}
    clip, built = pantin.Clip.open(path), bpy.context.object
    joints = [index for index, joint in enumerate(clip.joints) if not joint.end_site]
    x, y, z = np.moveaxis(clip.positions()[:, joints], 2, 0)
    expected = np.stack([x, -z, y], axis=2)  # y is up in the clip, z in Blender
    order = [built.data.bones.find(clip.joints[index].name) for index in joints]
    start = bpy.context.scene.frame_start
    heads = tips(built, range(start, start + clip.frames))[:, ::2][:, order]
    assert np.linalg.norm(heads - expected, axis=2).max() < 1e-2


def test_strips_of_the_nla_are_exported(tmp_path):
    armature = rig()
    data = armature.animation_data
    action = data.action
    strip = data.nla_tracks.new().strips.new("walk", 11, action)
    data.action = None
    bpy.context.scene.frame_start, bpy.context.scene.frame_end = 11, 51
    expected = tips(armature, range(11, 52))[:, 0]
    path = str(tmp_path / "strip.ptn")
    bpy.ops.pantin.export(filepath=path)
    clip = pantin.Clip.open(path)
    assert strip.frame_end == 51 and clip.frames == 41
    assert np.linalg.norm(clip.positions()[:, 0] - expected, axis=1).max() <= 0.5 + 1e-3


def test_the_preview_is_the_display_s_picture():
    rig()
    bpy.context.scene.frame_set(20)
    assert bpy.ops.pantin.preview() == {"FINISHED"}
    image = bpy.data.images["Pantin preview"]
    assert tuple(image.size) == (512, 256)
    pixels = np.array(image.pixels[:]).reshape(256, 512, 4)[..., 0]
    assert set(np.unique(pixels)) == {0, 1} and 50 < pixels.sum() / 16 < 4000
    assert bpy.context.scene.frame_current == 20


def test_every_note_is_reported(monkeypatch):
    armature = rig()
    armature.data.bones["arm"].name = "IK_arm"
    odd = pantin.Note("joints", "warning", "something is odd", joint="arm", hint="another way (argument=)")

    def convert(*given, **options):
        clip = pantin_convert(*given, **options)
        clip.report["notes"].append(odd)
        return clip

    pantin_convert = pantin.convert
    monkeypatch.setattr(pantin, "convert", convert)
    seen = []
    clip = pantin_addon.operators.convert(bpy.context, lambda levels, text: seen.append((*levels, text)))
    assert len(seen) == len(clip.report["notes"]) and seen[-1] == ("WARNING", "something is odd")
    assert ("INFO", "the unit is 100 cm, as given") in seen
    assert any(text.startswith("helper bones are not bounded") for _, text in seen), seen
    # With the add-on's operators, nothing of it is an error.
    assert bpy.ops.pantin.preview() == {"FINISHED"}


def refused(match, **arguments):
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.pantin.export(**arguments)


def human(scene):
    """The human of Blender's own generator of rigs, which bows and waves."""
    import addon_utils

    addon_utils.enable("rigify", default_set=True)
    bpy.ops.object.armature_human_metarig_add()
    bpy.ops.pose.rigify_generate()
    armature = bpy.data.objects["rig"]
    bpy.ops.object.select_all(action="DESELECT")
    bpy.context.view_layer.objects.active = armature
    armature.select_set(True)
    bones = armature.pose.bones
    bones["upper_arm_parent.R"]["IK_FK"] = 1.0
    for frame, down, degrees in [(1, 0, 0), (11, -0.05, -60), (21, -0.1, -110), (31, 0, 0)]:
        bones["torso"].location = (0, 0, down)
        bones["torso"].keyframe_insert("location", frame=frame)
        bones["upper_arm_fk.R"].rotation_mode = "XYZ"
        bones["upper_arm_fk.R"].rotation_euler = (math.radians(degrees), 0, 0)
        bones["upper_arm_fk.R"].keyframe_insert("rotation_euler", frame=frame)
    return armature


def test_a_generated_human_hangs_together_and_is_where_it_was(scene, tmp_path):
    armature = human(scene)
    scene.pantin.bound = 1.0
    said = []
    clip = pantin_addon.operators.convert(bpy.context, lambda levels, text: said.append((*levels, text)))
    names = [joint.name for joint in clip.joints]
    assert all(joint.end_site or joint.name.startswith("DEF-") for joint in clip.joints), names
    above = {joint.name: names[joint.parent] for joint in clip.joints if joint.parent is not None and not joint.end_site}
    for name, parent in [("thigh.L", "spine"), ("shoulder.R", "spine.003"), ("upper_arm.R", "shoulder.R"), ("shin.L", "thigh.L.001")]:
        assert above[f"DEF-{name}"] == f"DEF-{parent}"
    assert [joint.name for joint in clip.joints if joint.parent is None] == ["DEF-spine"]
    warnings = [text for level, text in said if level == "WARNING"]
    assert any("the scales of bone `DEF-" in text and "are left out: at most" in text for text in warnings), said
    joints = [index for index, joint in enumerate(clip.joints) if not joint.end_site]
    for frame in range(1, 32):
        bpy.context.scene.frame_set(frame)
        own = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
        heads = 100 * np.array([own.matrix_world @ own.pose.bones[names[index]].head for index in joints])
        assert np.linalg.norm(clip.positions()[frame - 1, joints] - heads, axis=1).max() <= 1.0 + 1e-3


def test_a_small_stretch_is_left_out_with_a_warning(tmp_path):
    armature = rig()
    armature.pose.bones["arm"].scale = (1, 1.01, 1)
    seen = []
    pantin_addon.operators.convert(bpy.context, lambda levels, text: seen.append((*levels, text)))
    assert seen[0] == ("WARNING", "the scales of bone `arm` are left out: at most 0.99 %, at frame 1; all joints keep their places")


def test_markers_are_events(scene, tmp_path):
    rig()
    for name, frame in [("late", 60), ("step", 11), ("start", 1)]:
        scene.timeline_markers.new(name, frame=frame)
    path = str(tmp_path / "marked.ptn")
    bpy.ops.pantin.export(filepath=path)
    assert pantin.Clip.open(path).events == [(0, "start"), (10, "step")]


def test_what_is_no_motion_is_named(tmp_path):
    path = str(tmp_path / "x.ptn")
    refused("no armature is active", filepath=path)
    armature = rig()
    armature.pose.bones["spine"].scale = (1, 2, 1)
    refused("bone `spine` has a non-uniform scale at frame 1: 1, 2, 1", filepath=path)
    armature.pose.bones["spine"].scale = (1, 1, 1)
    armature.scale = (1, 1, 3)
    refused("object `Rig` has a non-uniform scale", filepath=path)
    armature.scale = (1, 1, -1)
    refused("object `Rig` is mirrored", filepath=path)
    armature.scale = (1, 1, 1)
    armature.animation_data_clear()
    refused("armature `Rig` has no action", filepath=path)
    assert not (tmp_path / "x.ptn").exists()
    for bone in armature.data.bones:
        bone.name = f"my-{bone.name}"
    with pytest.raises(RuntimeError, match="no bone of armature `Rig`"):
        bpy.ops.pantin.import_clip(filepath=os.path.join(os.environ["PANTIN_ROOT"], "motions/walk.ptn"))
    (tmp_path / "odd.ptn").write_bytes(b"odd")
    with pytest.raises(RuntimeError, match="odd.ptn: "):
        bpy.ops.pantin.import_clip(filepath=str(tmp_path / "odd.ptn"))


def test_an_import_can_be_undone(tmp_path):
    rig()
    path = str(tmp_path / "walk.ptn")
    bpy.ops.pantin.export(filepath=path)
    bpy.context.preferences.edit.use_global_undo = True
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.pantin.import_clip(filepath=path, new_armature=True)
    bpy.ops.ed.undo_push(message="import")
    assert len(bpy.data.armatures) == 2 and "walk" in bpy.data.actions
    bpy.ops.ed.undo()
    assert len(bpy.data.armatures) == 1 and "walk" not in bpy.data.actions
    assert bpy.data.objects["Rig"].animation_data.action is not None
