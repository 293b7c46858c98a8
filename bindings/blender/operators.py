"""What a user can do: export, preview, import."""

import warnings
from pathlib import Path

import bpy
import numpy as np
import pantin
from bpy_extras.io_utils import ExportHelper, ImportHelper

from .apply import apply
from .capture import Refused, capture, frame_range

# The picture that the panel shows.
IMAGE = "Pantin preview"
# Pixels of the picture for each of the display's.
MAGNIFIED = 4


class Settings(bpy.types.PropertyGroup):
    """How actions become clips, and what became of the last one."""

    bound: bpy.props.FloatProperty(
        name="Bound", description="Largest distance of any joint from where the action has it, in cm", default=0.5, min=0.001, soft_max=5
    )
    scalar_bound: bpy.props.FloatProperty(
        name="Weights", description="Largest error of shape keys and properties, in percent of full scale", default=2, min=0.01, max=50
    )
    effort: bpy.props.EnumProperty(
        name="Effort",
        description="Speed against size",
        items=[("fast", "Fast", ""), ("default", "Default", ""), ("best", "Best", "")],
        default="default",
    )
    deforming_only: bpy.props.BoolProperty(
        name="Deforming Bones Only", description="Leave out bones that deform nothing, such as those that control a rig", default=True
    )
    result: bpy.props.StringProperty(options={"SKIP_SAVE"})


def armature_of(context):
    """The active armature, or that of the active mesh."""
    active = context.object
    if active is not None and active.type == "MESH":
        active = active.find_armature()
    if active is None or active.type != "ARMATURE":
        raise Refused("no armature is active: select one with an action")
    return active


def settings_drawn(layout, context):
    """How a clip is made, in the panel and in the file dialog."""
    layout.use_property_split = True
    for name in ("bound", "scalar_bound", "effort", "deforming_only"):
        layout.prop(context.scene.pantin, name)


def events(scene, first, last):
    """The scene's markers within the motion, by frame and name."""
    markers = sorted(scene.timeline_markers, key=lambda marker: marker.frame)
    return [(marker.frame - first, marker.name) for marker in markers if first <= marker.frame <= last and marker.name]


def convert(context, report, frames=None):
    """A clip of the active action, or of a range of its frames. `report` shows what is odd about it, as that of an operator does."""
    settings = context.scene.pantin
    armature = armature_of(context)
    motion, left_out = capture(context, armature, settings.deforming_only, frames)
    for text in left_out:
        report({"WARNING"}, text)
    manager = context.window_manager
    manager.progress_begin(0, 1)
    try:
        options = {"max_scalar_error": settings.scalar_bound, "effort": settings.effort}
        options["events"] = events(context.scene, *(frames or frame_range(context.scene, armature)))
        with warnings.catch_warnings():
            # They are shown below, each time.
            warnings.simplefilter("ignore", pantin.ConversionWarning)
            clip = pantin.convert(motion, settings.bound, progress=manager.progress_update, **options)
    finally:
        manager.progress_end()
    measured = clip.report
    parts = [f"{clip.nbytes} bytes, {clip.frames} frames"]
    if clip.joints:
        parts.append(f"{measured['max_error_cm']:.3f} cm off at most ({measured['worst_joint']} at frame {measured['worst_frame']})")
    if clip.scalar_names:
        parts.append(f"weights {measured['max_scalar_error_percent']:.2f} % off at most")
    if frames is None:
        settings.result = "; ".join(parts)
    show_notes(clip, report)
    return clip


def show_notes(clip, report):
    """Reports all notes about a clip. Their hints name arguments of Python, which the panel has not."""
    for note in clip.report["notes"]:
        report({"WARNING" if note.severity == "warning" else "INFO"}, note.text)


def show(clip, frame):
    """The picture of a frame as the display shows it."""
    lit = np.flipud(clip.image(min(max(frame, 0), clip.frames - 1)))
    lit = lit.repeat(MAGNIFIED, axis=0).repeat(MAGNIFIED, axis=1)
    height, width = lit.shape
    image = bpy.data.images.get(IMAGE) or bpy.data.images.new(IMAGE, width, height)
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., :3] = lit[..., None]
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    return image


class Guarded:
    """An operator whose refusals are reports, not tracebacks."""

    def execute(self, context):
        try:
            message = self.run(context)
        except (Refused, pantin.PantinError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, message)
        return {"FINISHED"}


class OfAction:
    """An operator for the action of the active armature."""

    @classmethod
    def poll(cls, context):
        try:
            armature = armature_of(context)
            frame_range(context.scene, armature)
        except Refused as error:
            cls.poll_message_set(str(error))
            return False
        return True


class PANTIN_OT_export(Guarded, OfAction, bpy.types.Operator, ExportHelper):
    """Write the active action as a clip within the bound"""

    bl_idname = "pantin.export"
    bl_label = "Export Clip"
    filename_ext = ".ptn"
    filter_glob: bpy.props.StringProperty(default="*.ptn", options={"HIDDEN"})

    def invoke(self, context, event):
        data = armature_of(context).animation_data
        if not self.filepath and data.action is not None:
            self.filepath = f"{bpy.path.clean_name(data.action.name)}.ptn"
        return ExportHelper.invoke(self, context, event)

    def draw(self, context):
        settings_drawn(self.layout, context)

    def run(self, context):
        convert(context, self.report).save(self.filepath)
        return context.scene.pantin.result


class PANTIN_OT_preview(Guarded, OfAction, bpy.types.Operator):
    """Show the current frame as a display of 128x64 pixels shows it"""

    bl_idname = "pantin.preview"
    bl_label = "Preview"

    def run(self, context):
        now = context.scene.frame_current
        show(convert(context, self.report, (now, now)), 0)
        return f"frame {now}"


class PANTIN_OT_import(Guarded, bpy.types.Operator, ImportHelper):
    """Make a clip the action of the active armature, or of a new one"""

    bl_idname = "pantin.import_clip"
    bl_label = "Import Clip"
    bl_options = {"REGISTER", "UNDO"}
    filename_ext = ".ptn"
    filter_glob: bpy.props.StringProperty(default="*.ptn", options={"HIDDEN"})
    new_armature: bpy.props.BoolProperty(name="New Armature", description="Build an armature instead of using the active one")

    def run(self, context):
        clip = pantin.Clip.open(self.filepath)
        active = context.object
        armature = active if active is not None and active.type == "ARMATURE" and not self.new_armature else None
        armature, left = apply(context, clip, Path(self.filepath).stem, armature)
        if left:
            self.report({"WARNING"}, f"no bone, shape key or property is called {', '.join(left)}")
        return f"{clip.frames} frames for `{armature.name}`"


def export_entry(menu, _context):
    """The entry in File > Export."""
    menu.layout.operator(PANTIN_OT_export.bl_idname, text="Pantin Clip (.ptn)")


def import_entry(menu, _context):
    """The entry in File > Import."""
    menu.layout.operator(PANTIN_OT_import.bl_idname, text="Pantin Clip (.ptn)")


CLASSES = (Settings, PANTIN_OT_export, PANTIN_OT_preview, PANTIN_OT_import)
