"""What a user can do: export, preview, import."""

import warnings
from pathlib import Path

import bpy
import numpy as np
import pantin
from bpy_extras.io_utils import ExportHelper, ImportHelper

from .apply import apply
from .capture import Refused, captured, frame_range
from .job import Cancelled, Modal, in_thread
from .live import PERIOD, Sender

# The picture that the panel shows.
IMAGE = "Pantin preview"
# Pixels of the picture for each of the display's.
MAGNIFIED = 4
# The part of a conversion that reading the scene takes in the bar.
READING = 0.3


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
    host: bpy.props.StringProperty(name="Host", description="Where `pantin stream --live vmc:PORT` runs", default="127.0.0.1")
    port: bpy.props.IntProperty(name="Port", description="The port of `pantin stream --live vmc:PORT`", default=39539, min=1, max=65535)
    live: bpy.props.BoolProperty(options={"SKIP_SAVE", "HIDDEN"})


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


def conversion(context, report, frames=None, threaded=False):
    """Yields the part that is done, from 0 to 1; then returns a clip of the active action, or of a range of its frames. `report` shows what is odd about it,
    as that of an operator does. `threaded` converts in a thread, while the caller goes on."""
    settings = context.scene.pantin
    armature = armature_of(context)
    options = {"max_scalar_error": settings.scalar_bound, "effort": settings.effort}
    options["events"] = events(context.scene, *(frames or frame_range(context.scene, armature)))
    bound = settings.bound
    reading = captured(context, armature, settings.deforming_only, frames)
    try:
        while True:
            yield READING * next(reading)
    except StopIteration as end:
        motion, left_out = end.value
    finally:
        # If this ends early, the scene goes back to its frame.
        reading.close()
    for text in left_out:
        report({"WARNING"}, text)

    def made(progress=None):
        with warnings.catch_warnings():
            # They are shown below, each time.
            warnings.simplefilter("ignore", pantin.ConversionWarning)
            return pantin.convert(motion, bound, progress=progress, **options)

    if threaded:
        working = in_thread(made)
        try:
            while True:
                yield READING + (1 - READING) * next(working)
        except StopIteration as end:
            clip = end.value
        finally:
            working.close()
    else:
        clip = made()
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


def convert(context, report, frames=None):
    """The clip of `conversion`, at once."""
    work = conversion(context, report, frames)
    try:
        while True:
            next(work)
    except StopIteration as end:
        return end.value


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

    REFUSALS = (Refused, Cancelled, pantin.PantinError, OSError)

    def execute(self, context):
        try:
            message = self.run(context)
        except self.REFUSALS as error:
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


class PANTIN_OT_export(Guarded, OfAction, Modal, bpy.types.Operator, ExportHelper):
    """Write the active action as a clip within the bound. Esc cancels"""

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

    def execute(self, context):
        # Scripts, and Blender without a window, wait for the clip.
        if bpy.app.background or not self.options.is_invoke:
            return Guarded.execute(self, context)
        return self.start(context)

    def work(self, context):
        return conversion(context, self.report, threaded=True)

    def finished(self, context, clip):
        clip.save(self.filepath)
        return context.scene.pantin.result

    def run(self, context):
        return self.finished(context, convert(context, self.report))


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


class PANTIN_OT_live(Guarded, bpy.types.Operator):
    """Send the pose to `pantin stream --live` while you scrub, play or pose. The same button, or Esc, ends it"""

    bl_idname = "pantin.live"
    bl_label = "Send Live"

    @classmethod
    def poll(cls, context):
        try:
            armature_of(context)
        except Refused as error:
            cls.poll_message_set(str(error))
            return False
        return True

    def execute(self, context):
        settings = context.scene.pantin
        if settings.live:
            # The operator that sends sees it at its next tick.
            settings.live = False
            return {"FINISHED"}
        try:
            self.sender = Sender(armature_of(context), settings.host, settings.port)
        except self.REFUSALS as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if bpy.app.background:
            self.sender.send(context)
            self.sender.close()
            return {"FINISHED"}
        settings.live = True
        self.timer = context.window_manager.event_timer_add(PERIOD, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        """Sends at each tick of the timer; all events go on to Blender, so that one can work meanwhile."""
        settings = context.scene.pantin
        if event.type == "TIMER" and settings.live and self.sender.send(context):
            return {"PASS_THROUGH"}
        if event.type not in {"TIMER", "ESC"}:
            return {"PASS_THROUGH"}
        settings.live = False
        context.window_manager.event_timer_remove(self.timer)
        self.sender.close()
        self.report({"INFO"}, f"{self.sender.sent} poses were sent")
        return {"FINISHED"}


def export_entry(menu, _context):
    """The entry in File > Export."""
    menu.layout.operator(PANTIN_OT_export.bl_idname, text="Pantin Clip (.ptn)")


def import_entry(menu, _context):
    """The entry in File > Import."""
    menu.layout.operator(PANTIN_OT_import.bl_idname, text="Pantin Clip (.ptn)")


CLASSES = (Settings, PANTIN_OT_export, PANTIN_OT_preview, PANTIN_OT_import, PANTIN_OT_live)
