"""Classes that the add-on has registered with Blender."""

import bpy

_registered = []


def register(made):
    bpy.utils.register_class(made)
    _registered.append(made)


def count():
    return len(_registered)


def unregister(count):
    """Unregisters all classes but the first `count`."""
    while len(_registered) > count:
        bpy.utils.unregister_class(_registered.pop())
