"""From a clip to actions of an armature and of shape keys."""

import bpy
from mathutils import Matrix, Quaternion, Vector

from .capture import AXES, Refused, affine, axes, meshes, parents_first
from .curves import assign, write

# Rotations that turn the direction which is up in a clip to Blender's z.
UPRIGHT = {
    "z": Quaternion(),
    "y": Quaternion((1, 0, 0), 1.5707963267948966),
    "x": Quaternion((0, 1, 0), -1.5707963267948966),
    "-x": Quaternion((0, 1, 0), 1.5707963267948966),
    "-y": Quaternion((1, 0, 0), -1.5707963267948966),
    "-z": Quaternion((1, 0, 0), 3.141592653589793),
}
# Locations below this, in the armature's unit, are none.
NOWHERE = 1e-7


def apply(context, clip, name, armature=None):
    """Makes the clip the action of an armature, a new one without `armature`; returns the armature and what the clip has without a counterpart."""
    scene = context.scene
    unit = 0.01 / scene.unit_settings.scale_length
    if armature is None:
        armature = build(context, clip, name, unit)
    frames = [scene.frame_start + frame * scene.render.fps / scene.render.fps_base / clip.rate for frame in range(clip.frames)]
    left, collection = animate(armature, clip, name, frames, unit)
    left += weights(scene, armature, clip, name, frames, collection)
    return armature, left


def bone_names(clip):
    """A name for the bone of each joint: of several with one name, Blender numbers the later ones."""
    names = []
    for joint in clip.joints:
        number, name = 0, joint.name
        while name in names:
            number += 1
            name = f"{joint.name}.{number:03}"
        names.append(name)
    return names


def worlds(clip, unit):
    """Matrices of all joints in the world, frame by frame."""
    upright = UPRIGHT[clip.up]
    rotations, translations = clip.rotations(), clip.translations() * unit
    for turns, moves in zip(rotations, translations):
        matrices = []
        for joint, turn, move in zip(clip.joints, turns, moves):
            own = affine(Quaternion(turn), Vector(move))
            above = upright.to_matrix().to_4x4() if joint.parent is None else matrices[joint.parent]
            matrices.append(above @ own)
        yield matrices


def animate(armature, clip, name, frames, unit):
    """Keys for the bones that are named as joints; returns the names of joints without a bone, and the action's curves."""
    index = {name: number for number, name in enumerate(bone_names(clip)) if not clip.joints[number].end_site}
    found = [bone for bone in parents_first(armature.data.bones)]
    keys = {bone.name: ([], []) for bone in found if bone.name in index}
    if index and not keys:
        raise Refused(f"no bone of armature `{armature.name}` is named as a joint of the clip; `{next(iter(index))}` is one")
    back = armature.matrix_world.inverted()
    for matrices in worlds(clip, unit):
        poses = {}
        for bone in found:
            above = {}
            if bone.parent is not None:
                above = {"parent_matrix": poses[bone.parent.name], "parent_matrix_local": bone.parent.matrix_local}
            if bone.name not in index:
                poses[bone.name] = bone.convert_local_to_pose(Matrix(), bone.matrix_local, **above)
                continue
            world = matrices[index[bone.name]] @ axes(bone).to_matrix().to_4x4()
            place, turn, _ = (back @ world).decompose()
            pose = affine(turn, place)
            basis = bone.convert_local_to_pose(pose, bone.matrix_local, **above, invert=True)
            location, rotation, _ = basis.decompose()
            places, turns = keys[bone.name]
            if turns:
                rotation.make_compatible(turns[-1])
            places.append(location)
            turns.append(rotation)
            poses[bone.name] = pose
    collection = assign(armature, bpy.data.actions.new(name))
    for bone_name, (places, turns) in keys.items():
        bone = armature.pose.bones[bone_name]
        bone.rotation_mode = "QUATERNION"
        bone.location, bone.scale = (0, 0, 0), (1, 1, 1)
        path = bone.path_from_id("rotation_quaternion")
        for part in range(4):
            write(collection, path, part, frames, [turn[part] for turn in turns])
        if max(place.length for place in places) > NOWHERE:
            path = bone.path_from_id("location")
            for part in range(3):
                write(collection, path, part, frames, [place[part] for place in places])
    return [joint for joint in index if joint not in keys], collection


def weights(scene, armature, clip, name, frames, collection):
    """Keys for shape keys and properties that are named as scalars; returns the names of scalars without one."""
    values = clip.scalars()
    left = dict(values)
    for mesh in meshes(scene, armature):
        keys = mesh.data.shape_keys
        own = {}
        for key in keys.key_blocks:
            of_mesh = f"{mesh.name}.{key.name}"
            channel = of_mesh if of_mesh in values else key.name
            if key != keys.reference_key and channel in values:
                own[key] = channel
        if own:
            collection = assign(keys, bpy.data.actions.new(f"{name} {mesh.name}"))
            for key, channel in own.items():
                write(collection, key.path_from_id("value"), 0, frames, values[channel])
                left.pop(channel, None)
    properties = [channel for channel in left if isinstance(armature.get(channel), (int, float))]
    for channel in properties:
        write(collection, f'["{channel}"]', 0, frames, left.pop(channel))
    return list(left)


def build(context, clip, name, unit):
    """An armature with a bone for each joint, from its head to its first child."""
    data = bpy.data.armatures.new(name)
    armature = bpy.data.objects.new(name, data)
    context.collection.objects.link(armature)
    for other in context.selected_objects:
        other.select_set(False)
    armature.select_set(True)
    context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    upright = UPRIGHT[clip.up]
    heads, made, names = [], {}, bone_names(clip)
    for joint in clip.joints:
        above = Vector() if joint.parent is None else heads[joint.parent]
        heads.append(above + upright @ Vector(joint.offset) * unit)
    for number, joint in enumerate(clip.joints):
        if joint.end_site:
            continue
        children = [heads[other] for other, child in enumerate(clip.joints) if child.parent == number]
        bone = data.edit_bones.new(names[number])
        ends = [child for child in children if (child - heads[number]).length > 1e-5]
        bone.head = heads[number]
        bone.tail = ends[0] if ends else heads[number] + upright @ Vector((0, 5 * unit, 0))
        bone.parent = None if joint.parent is None else made[joint.parent]
        made[number] = bone
    own = {bone.name: upright.inverted() @ bone.matrix.to_quaternion() for bone in made.values()}
    bpy.ops.object.mode_set(mode="OBJECT")
    for bone_name, turn in own.items():
        data.bones[bone_name][AXES] = tuple(turn)
    return armature
