"""The pose of an armature as VMC over OSC, for `pantin stream --live vmc:PORT`: it is sent while one scrubs, plays or poses."""

import re
import socket
import struct

from mathutils import Quaternion, Vector

from .capture import Refused

# Seconds from datagram to datagram. The receiver holds a pose for two seconds and then lets the figure rest, so that one that stays is sent again.
PERIOD = 1 / 30

# Bones of a humanoid, and the names that armatures have for them: without their side, in small letters, without dots and dashes.
NAMES = {
    "Hips": ("hips", "hip", "pelvis", "spine"),
    "Spine": ("spine", "spine001", "spine1"),
    "Chest": ("chest", "spine002", "spine2"),
    "UpperChest": ("upperchest", "spine003", "spine3"),
    "Neck": ("neck", "spine004"),
    "Head": ("head", "spine006"),
}
SIDED = {
    "Shoulder": ("shoulder", "clavicle"),
    "UpperArm": ("upperarm", "arm"),
    "LowerArm": ("lowerarm", "forearm"),
    "Hand": ("hand", "wrist"),
    "UpperLeg": ("upperleg", "thigh", "upleg"),
    "LowerLeg": ("lowerleg", "shin", "calf", "leg"),
    "Foot": ("foot", "ankle"),
    "Toes": ("toes", "toe", "toebase", "ball"),
}
# Each bone's parent in the protocol; of a missing one, the next above it.
PARENTS = {
    "Spine": "Hips",
    "Chest": "Spine",
    "UpperChest": "Chest",
    "Neck": "UpperChest",
    "Head": "Neck",
    "Shoulder": "UpperChest",
    "UpperArm": "Shoulder",
    "LowerArm": "UpperArm",
    "Hand": "LowerArm",
    "UpperLeg": "Hips",
    "LowerLeg": "UpperLeg",
    "Foot": "LowerLeg",
    "Toes": "Foot",
}
# Where limbs point in the protocol's rest pose: arms out to the figure's left, which is x, and legs down.
LIMBS = {"UpperArm": (1, 0, 0), "LowerArm": (1, 0, 0), "UpperLeg": (0, 0, -1), "LowerLeg": (0, 0, -1)}


def plain(name):
    """A bone's name without its side and what generators put before it, and the side: "Left", "Right" or ""."""
    name = re.sub(r"^(mixamorig\d*:|DEF-|Bip\d+[ _])", "", name)
    side = ""
    for pattern in (r"^(left|right)[ ._-]?", r"[ ._-](left|right)$", r"[ ._-](l|r)(?=$|[ ._-]\d+$)", r"^(l|r)[ ._-]"):
        found = re.search(pattern, name, re.IGNORECASE)
        if found:
            side = "Left" if found[1][0] in "lL" else "Right"
            name = name[: found.start()] + name[found.end() :]
            break
    return re.sub(r"[^a-z0-9]", "", name.lower()), side


def humanoid(armature):
    """The armature's bones by the humanoid's names, each by the first of its names that is there. Only bones that deform count, if any does: a generated rig
    has others with such names, which control it."""
    found = {}
    bones = [bone for bone in armature.data.bones if bone.use_deform] or armature.data.bones
    named = {}
    for bone in bones:
        named.setdefault(plain(bone.name), bone.name)
    for bone, names in NAMES.items():
        own = next((named[name, ""] for name in names if (name, "") in named and named[name, ""] not in found.values()), None)
        if own:
            found[bone] = own
    for side in ("Left", "Right"):
        for bone, names in SIDED.items():
            own = next((named[name, side] for name in names if (name, side) in named), None)
            if own:
                found[side + bone] = own
    if not found:
        raise Refused(f"no bone of armature `{armature.name}` is one of a humanoid by its name, such as hips, head or forearm.L")
    return found


def parent_of(bone, found):
    """The next bone above that the armature has, or None."""
    side = next((side for side in ("Left", "Right") if bone.startswith(side)), "")
    at = bone[len(side) :]
    while at in PARENTS:
        at = PARENTS[at]
        name = side + at if side and at in SIDED else at
        if name in found:
            return name
    return None


def turn_in_world(armature, bone, own):
    """By how much a bone is turned from the protocol's rest pose, about the world's axes. The armature looks along -y at rest, as Blender's do."""
    posed = (armature.matrix_world @ armature.pose.bones[own].matrix).to_quaternion()
    rest = armature.data.bones[own]
    turn = posed @ rest.matrix_local.to_quaternion().inverted()
    side = bone[:4] == "Left" or bone[:5] == "Right"
    limb = LIMBS.get(bone.replace("Left", "", 1).replace("Right", "", 1)) if side else None
    if limb is not None:
        out = Vector(limb)
        if bone.startswith("Right"):
            out.x = -out.x
        turn = turn @ out.rotation_difference(rest.tail_local - rest.head_local)
    return turn


def pose_of(context, armature, found):
    """Name, place in metres and turn of each bone as VMC sends them: turns against the bone above, in Unity's axes."""
    evaluated = armature.evaluated_get(context.evaluated_depsgraph_get())
    turns = {bone: turn_in_world(evaluated, bone, own) for bone, own in found.items()}
    metres = context.scene.unit_settings.scale_length
    for bone, turn in turns.items():
        above = parent_of(bone, found)
        own = turns[above].inverted() @ turn if above else turn
        place = Vector()
        if bone == "Hips":
            place = metres * (evaluated.matrix_world @ evaluated.pose.bones[found[bone]].head)
        yield bone, unity(place), unity_turn(own)


def unity(vector):
    """A place in Unity's axes: y up, z ahead, x to the figure's right."""
    x, y, z = vector
    return -x, z, -y


def unity_turn(turn):
    """The quaternion x, y, z, w in Unity's axes, which are left-handed: a turn goes the other way about what is mirrored."""
    w, x, y, z = turn
    return x, -z, y, w


def text(string):
    """A text of OSC: with a zero at its end, and zeros up to a multiple of four bytes."""
    data = string.encode() + b"\0"
    return data + b"\0" * (-len(data) % 4)


def message(bone, place, turn):
    """A message of OSC with a bone's pose."""
    return text("/VMC/Ext/Bone/Pos") + text(",sfffffff") + text(bone) + struct.pack(">7f", *place, *turn)


def datagram(poses):
    """A bundle of all bones, which the receiver takes at once: some 1,800 bytes for 22 of them."""
    data = b"#bundle\0" + bytes(7) + b"\1"
    for pose in poses:
        data += struct.pack(">i", len(message(*pose))) + message(*pose)
    return data


class Sender:
    """Sends the pose of an armature to a port."""

    def __init__(self, armature, host, port):
        self.name = armature.name
        self.found = humanoid(armature)
        self.to = (host, port)
        try:
            family = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0]
        except OSError as error:
            raise Refused(f"{host}: {error.strerror or error}") from None
        self.socket = socket.socket(family[0], socket.SOCK_DGRAM)
        self.to = family[4]
        self.sent = 0

    def send(self, context):
        """Sends the pose that the scene shows. Returns False if the armature is gone."""
        armature = context.scene.objects.get(self.name)
        if armature is None or any(own not in armature.pose.bones for own in self.found.values()):
            return False
        try:
            self.socket.sendto(datagram(pose_of(context, armature, self.found)), self.to)
            self.sent += 1
        except OSError:
            # Nobody listens yet, or the network is away: the next datagram may arrive.
            pass
        return True

    def close(self):
        self.socket.close()
