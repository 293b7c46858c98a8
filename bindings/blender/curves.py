"""Curves of actions: Blender 4.4 put them into layers, and Blender 5.0 has no others."""


def curves(action, data):
    """The curves with which an action moves the owner of the animation data."""
    if not hasattr(action, "layers"):
        return list(action.fcurves)
    slot = data.action_slot
    bags = [strip.channelbag(slot) for layer in action.layers for strip in layer.strips] if slot else []
    return [curve for bag in bags if bag is not None for curve in bag.fcurves]


def assign(owner, action):
    """Makes an empty action that of an object or of shape keys; returns its collection of curves."""
    data = owner.animation_data or owner.animation_data_create()
    if not hasattr(action, "layers"):
        data.action = action
        return action.fcurves
    slot = action.slots.new(id_type=owner.id_type, name=owner.name)
    bag = action.layers.new("Layer").strips.new(type="KEYFRAME").channelbag(slot, ensure=True)
    data.action = action
    data.action_slot = slot
    return bag.fcurves


def write(collection, path, index, frames, values):
    """Adds a curve that runs straight between values at frames."""
    curve = collection.new(path, index=index)
    curve.keyframe_points.add(len(frames))
    flat = [number for pair in zip(frames, values) for number in pair]
    curve.keyframe_points.foreach_set("co", flat)
    for point in curve.keyframe_points:
        point.interpolation = "LINEAR"
    curve.update()
