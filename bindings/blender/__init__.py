"""Pantin in Blender: exports the active action as a clip, shows it as a display of 128x64 pixels does, and imports clips as actions."""

import bpy

from . import operators, panel

CLASSES = (*operators.CLASSES, *panel.CLASSES)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.pantin = bpy.props.PointerProperty(type=operators.Settings)
    bpy.types.TOPBAR_MT_file_export.append(operators.export_entry)
    bpy.types.TOPBAR_MT_file_import.append(operators.import_entry)


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(operators.import_entry)
    bpy.types.TOPBAR_MT_file_export.remove(operators.export_entry)
    del bpy.types.Scene.pantin
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
