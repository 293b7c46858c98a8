"""From a scene to a motion: where the bones of an armature are at every frame, and what shape keys and properties have as values."""

import math

import numpy as np
import pantin
from mathutils import Matrix, Quaternion, Vector

# Columns of a matrix whose lengths differ by more than this part are a non-uniform scale, and one by more than the second is refused.
UNIFORM = 1e-4
STRETCHED = 0.05
# Cosine of the greatest angle between bones that point the same way.
ALONG = 0.99
# Name of the property of a bone with the rotation from the joint's axes to the bone's: w, x, y, z.
AXES = "pantin_axes"


class Refused(Exception):
    """Why a scene is no motion."""


def axes(bone):
    """The rotation from the joint's axes to the bone's: none, except for bones that an import made."""
    own = bone.get(AXES)
    return Quaternion(own) if own is not None else Quaternion()


def frame_range(scene, armature):
    """First and last frame of the active action, or of the scene where strips of the NLA play."""
    data = armature.animation_data
    if data is not None and data.action is not None:
        first, last = data.action.frame_range
        return math.floor(first), math.ceil(last)
    if data is not None and any(not track.mute and track.strips for track in data.nla_tracks):
        return scene.frame_start, scene.frame_end
    raise Refused(f"armature `{armature.name}` has no action")


def captured(context, armature, deforming_only=True, frames=None):
    """Yields the part that is done, from 0 to 1; then returns the motion of an armature over its action, or over a range of frames, and notes about
    it. The scene is at its frame again afterwards, also if this ends early."""
    scene = context.scene
    first, last = frames or frame_range(scene, armature)
    names, parents = bones(armature, deforming_only)
    stretched = {}
    leaves = [index for index in range(len(names)) if index not in parents]
    sources = scalars(scene, armature)
    rotations, translations, values = [], [], []
    now, now_part = scene.frame_current, scene.frame_subframe
    try:
        for frame in range(first, last + 1):
            scene.frame_set(frame)
            depsgraph = context.evaluated_depsgraph_get()
            worlds, tails = places(armature.evaluated_get(depsgraph), names, leaves, frame, stretched)
            turns, moves = local(worlds, parents)
            for index, tail in zip(leaves, tails):
                turns.append(Quaternion())
                moves.append(worlds[index][0].inverted() @ (tail - worlds[index][1]))
            rotations.append([tuple(turn) for turn in turns])
            translations.append([tuple(move) for move in moves])
            values.append([read(depsgraph) for _, read, _ in sources])
            yield (frame - first + 1) / (last - first + 1)
    finally:
        scene.frame_set(now, subframe=now_part)
    joints = [pantin.Joint(name, parent) for name, parent in zip(names, parents)]
    joints += [pantin.Joint("", index, end_site=True) for index in leaves]
    values = np.array(values, float).reshape(len(values), len(sources))
    given = {name: values[:, index] for index, (name, _, _) in enumerate(sources)}
    full_scales = {name: full_scale for name, _, full_scale in sources if full_scale}
    rate = scene.render.fps / scene.render.fps_base
    unit = 100 * scene.unit_settings.scale_length
    return pantin.Motion(joints, rotations, translations, given, full_scales, rate, unit, "z"), notes(stretched)


def notes(stretched):
    """What is left out of the motion: the greatest scale of each bone, with its frame."""
    if not stretched:
        return []
    name, (part, frame) = max(stretched.items(), key=lambda item: item[1][0])
    others = f" and of {len(stretched) - 1} other bones" if len(stretched) > 1 else ""
    return [f"the scales of bone `{name}`{others} are left out: at most {100 * part:.2f} %, at frame {frame}; all joints keep their places"]


def bones(armature, deforming_only):
    """Names of the bones that are joints, parents first, and indices of their parents."""
    kept = [bone for bone in armature.data.bones if bone.use_deform] if deforming_only else []
    kept = kept or list(armature.data.bones)
    if not kept:
        raise Refused(f"armature `{armature.name}` has no bones")
    above = hung(kept)
    depths = {}

    def depth(name):
        if name not in depths:
            depths[name] = 0 if above[name] is None else depth(above[name]) + 1
        return depths[name]

    names = sorted(above, key=depth)
    index = {name: number for number, name in enumerate(names)}
    return names, [None if above[name] is None else index[above[name]] for name in names]


def hung(kept):
    """For each of some bones the one on which it hangs, or None: the nearest bone above it that is kept or that one of them stands for, as it begins there and points
    the same way. In a generated rig the deforming bones of limbs hang on bones that deform nothing."""
    names = {bone.name for bone in kept}
    heads = {}
    for bone in kept:
        heads.setdefault(tuple(round(x, 4) for x in bone.head_local), []).append(bone)

    def candidates(bone):
        for above in bone.parent_recursive:
            if above.name in names:
                yield above.name
            else:
                for other in heads.get(tuple(round(x, 4) for x in above.head_local), []):
                    if other.vector.length and along(other, above):
                        yield other.name

    found = {}
    for bone in parents_first(kept):

        def hangs_on_it(name):
            while name is not None and name != bone.name:
                name = found.get(name)
            return name is not None

        found[bone.name] = next((name for name in candidates(bone) if not hangs_on_it(name)), None)
    return found


def along(bone, other):
    """Whether two bones point the same way at rest."""
    one, two = ((each.tail_local - each.head_local).normalized() for each in (bone, other))
    return one.dot(two) > ALONG


def parents_first(all_bones):
    """The bones in an order in which a parent stands before its children."""
    return sorted(all_bones, key=lambda bone: len(bone.parent_recursive))


def places(armature, names, leaves, frame, stretched):
    """Rotation and place of each bone in the world, and the tails of the leaves. `stretched` keeps the greatest scales that are left out."""
    world = armature.matrix_world
    check(world, f"object `{armature.name}`", frame)
    found, tails = [], []
    for name in names:
        bone = armature.pose.bones[name]
        matrix = world @ bone.matrix
        part = check(matrix, f"bone `{name}`", frame)
        # Of equal ones the first.
        if part > stretched.get(name, (0.0,))[0] + UNIFORM:
            stretched[name] = (part, frame)
        found.append((matrix.to_quaternion() @ axes(bone.bone).inverted(), matrix.translation.copy()))
    for index in leaves:
        tails.append(world @ armature.pose.bones[names[index]].tail)
    return found, tails


def check(matrix, what, frame):
    """By how much a matrix stretches or shears its axes, as a part. Refuses one that does it by more than 5 %, or mirrors."""
    columns = [Vector(column).xyz for column in matrix.to_3x3().col]
    lengths = [column.length for column in columns]
    if min(lengths) <= 0 or max(lengths) - min(lengths) > STRETCHED * max(lengths):
        shown = ", ".join(f"{length:.4g}" for length in lengths)
        raise Refused(f"{what} has a non-uniform scale at frame {frame}: {shown}")
    a, b, c = (column.normalized() for column in columns)
    sheared = max(abs(a.dot(b)), abs(b.dot(c)), abs(c.dot(a)))
    if sheared > STRETCHED:
        raise Refused(f"{what} is sheared at frame {frame}, by the non-uniform scale of what is above it")
    if matrix.to_3x3().determinant() < 0:
        raise Refused(f"{what} is mirrored at frame {frame}")
    return max(sheared, 1 - min(lengths) / max(lengths))


def local(worlds, parents):
    """Rotations and places in the parents."""
    turns, moves = [], []
    for (turn, place), parent in zip(worlds, parents):
        if parent is None:
            turns.append(turn)
            moves.append(place)
        else:
            back = worlds[parent][0].inverted()
            turns.append(back @ turn)
            moves.append(back @ (place - worlds[parent][1]))
    return turns, moves


def scalars(scene, armature):
    """What becomes scalars: a name, a function that reads the value, and the full scale or 0. Shape keys of the armature's meshes, then custom
    properties of the armature that are animated or driven."""
    found = []
    taken = set()

    def add(name, owner, read, full_scale):
        name = name if name not in taken else f"{owner}.{name}"
        taken.add(name)
        found.append((name, read, full_scale))

    for mesh in meshes(scene, armature):
        keys = mesh.data.shape_keys
        for key in keys.key_blocks:
            if key != keys.reference_key:
                most = max(1.0, abs(key.slider_min), abs(key.slider_max))
                add(key.name, mesh.name, lambda graph, keys=keys, name=key.name: keys.evaluated_get(graph).key_blocks[name].value, most)
    for path in animated_properties(armature):
        name = path[2:-2]
        add(name, armature.name, lambda graph, path=path: float(armature.evaluated_get(graph).path_resolve(path)), 0.0)
    return found


def meshes(scene, armature):
    """The meshes with shape keys that the armature carries or deforms."""
    for thing in scene.objects:
        if thing.type == "MESH" and thing.data.shape_keys is not None:
            deformed = any(change.type == "ARMATURE" and change.object == armature for change in thing.modifiers)
            if deformed or thing.parent == armature:
                yield thing


def animated_properties(armature):
    """Paths of the armature's own numeric properties that a curve or a driver changes: `["name"]`."""
    from .curves import curves

    data = armature.animation_data
    paths = [] if data is None else [curve.data_path for curve in data.drivers]
    if data is not None and data.action is not None:
        paths += [curve.data_path for curve in curves(data.action, data)]
    own = [path for path in paths if path.startswith('["') and path.endswith('"]') and "[" not in path[1:]]
    return [path for path in dict.fromkeys(own) if isinstance(armature.get(path[2:-2]), (int, float))]


def affine(turn, place):
    """The matrix of a rotation and a place."""
    return Matrix.LocRotScale(place, turn, None)
