"""mimetra in Blender: its operations in the 3D view's sidebar."""

import logging

from . import classes, mimetra, operators, panel, settings

bl_info = {
    "name": "mimetra",
    "description": "Transfer facial performances by the regions that move",
    "author": "The mimetra authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > mimetra",
    "category": "Animation",
}


def _register(operation, order):
    """Registers an operation's classes and returns the class of its settings. If Blender refuses a
    class, leaves the operation out and returns None."""
    before = classes.count()
    try:
        operators.register(operation)
        group = settings.register(operation)
        panel.register(operation, order)
        return group
    except Exception as error:
        classes.unregister(before)
        logging.getLogger("mimetra").warning("%s: Blender does not take this operation: %s",
                                             operation.name, error)
        return None


def register():
    groups = {operation.name: _register(operation, order)
              for order, operation in enumerate(panel.in_order())}
    settings.register_all({name: group for name, group in groups.items() if group})


def unregister():
    settings.unregister_all()
    classes.unregister(0)
