"""mimetra in Blender: its operations in the 3D view's sidebar."""

from . import operators, panel, settings

bl_info = {
    "name": "mimetra",
    "description": "Transfer facial performances by the regions that move",
    "author": "The mimetra authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > mimetra",
    "category": "Animation",
}


def register():
    operators.register()
    settings.register()
    panel.register()


def unregister():
    panel.unregister()
    settings.unregister()
    operators.unregister()
