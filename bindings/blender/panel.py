"""The panel in the tab Animation of the 3D view's sidebar."""

import bpy

from .operators import IMAGE, PANTIN_OT_export, PANTIN_OT_import, PANTIN_OT_live, PANTIN_OT_preview, settings_drawn


class PANTIN_PT_clip(bpy.types.Panel):
    """Bound, size and error of the clip, and the display's picture"""

    bl_label = "Pantin"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Animation"

    def draw(self, context):
        layout, settings = self.layout, context.scene.pantin
        settings_drawn(layout, context)
        layout.operator(PANTIN_OT_preview.bl_idname)
        image = bpy.data.images.get(IMAGE)
        if image is not None:
            layout.template_icon(icon_value=image.preview_ensure().icon_id, scale=8)
        for part in filter(None, settings.result.split("; ")):
            layout.label(text=part)
        layout.operator(PANTIN_OT_export.bl_idname)
        layout.operator(PANTIN_OT_import.bl_idname)
        layout.separator()
        layout.prop(settings, "host")
        layout.prop(settings, "port")
        layout.operator(PANTIN_OT_live.bl_idname, text="Stop" if settings.live else "Send Live", depress=settings.live)


CLASSES = (PANTIN_PT_clip,)
