"""Imports the files that are named, each into an empty scene, and prints what Blender made of them as one line of JSON."""

import json
import sys

import bpy


def curves(action):
    """The number of animation curves: Blender 4.4 put them into layers."""
    if hasattr(action, "fcurves"):
        return len(action.fcurves)
    strips = [strip for layer in action.layers for strip in layer.strips]
    return sum(len(bag.fcurves) for strip in strips for bag in strip.channelbags)


report = []
for path in sys.argv[1:]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if path.endswith(".bvh"):
        bpy.ops.import_anim.bvh(filepath=path, update_scene_fps=True, update_scene_duration=True)
    else:
        bpy.ops.import_scene.gltf(filepath=path)
    armatures = [thing for thing in bpy.data.objects if thing.type == "ARMATURE"]
    report.append(
        {
            "armatures": len(armatures),
            "bones": sum(len(armature.data.bones) for armature in armatures),
            "actions": len(bpy.data.actions),
            "curves": sum(curves(action) for action in bpy.data.actions),
            # The first key is the shape at rest.
            "shapes": sum(len(keys.key_blocks) - 1 for keys in bpy.data.shape_keys),
        }
    )
print("PANTIN " + json.dumps(report))
