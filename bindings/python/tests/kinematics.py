"""Forward kinematics of the tests' own, by numpy."""

import numpy as np


def matrices(quaternions):
    """Rotation matrices of quaternions w, x, y, z."""
    w, x, y, z = np.moveaxis(quaternions / np.linalg.norm(quaternions, axis=-1, keepdims=True), -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def places(parents, turns, translations):
    """Positions in the world of joints with these rotation matrices and positions in their parents."""
    world_turns, world = [], []
    for joint, parent in enumerate(parents):
        if parent is None:
            world_turns.append(turns[:, joint])
            world.append(translations[:, joint])
        else:
            world_turns.append(world_turns[parent] @ turns[:, joint])
            moved = (world_turns[parent] @ translations[:, joint, :, None])[..., 0]
            world.append(world[parent] + moved)
    return np.stack(world, axis=1)


def of_bvh(path):
    """Names and positions (frames, joints, 3) of a BVH file's joints and End Sites, in its unit."""
    words = path.read_text().split()
    names, parents, offsets, channels, stack, at = [], [], [], [], [], 1
    while words[at] != "MOTION":
        word = words[at]
        if word in ("ROOT", "JOINT", "End"):
            parents.append(stack[-1] if stack else None)
            names.append("" if word == "End" else words[at + 1])
            channels.append([])
            at += 2
        elif word == "{":
            stack.append(len(names) - 1)
            at += 1
        elif word == "}":
            stack.pop()
            at += 1
        elif word == "OFFSET":
            offsets.append([float(x) for x in words[at + 1 : at + 4]])
            at += 4
        else:
            assert word == "CHANNELS"
            count = int(words[at + 1])
            channels[-1] = words[at + 2 : at + 2 + count]
            at += 2 + count
    frames = int(words[at + 2])
    values = np.array(words[at + 6 :], float).reshape(frames, -1)
    turns = np.tile(np.eye(3), (frames, len(names), 1, 1))
    translations = np.tile(np.array(offsets), (frames, 1, 1))
    column = 0
    for joint, kinds in enumerate(channels):
        for kind in kinds:
            axis = "XYZ".index(kind[0])
            if kind.endswith("position"):
                translations[:, joint, axis] = values[:, column]
            else:
                half = np.radians(values[:, column]) / 2
                quaternion = np.zeros((frames, 4))
                quaternion[:, 0], quaternion[:, axis + 1] = np.cos(half), np.sin(half)
                turns[:, joint] = turns[:, joint] @ matrices(quaternion)
            column += 1
    return names, places(parents, turns, translations)
