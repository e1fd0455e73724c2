"""Values of the panel's fields, stored in the scene."""

import bpy

from . import classes, properties


def of(scene, operation):
    """Settings of an operation."""
    return getattr(scene.mimetra, properties.property_name(operation.name))


def copy(settings, operation, operator):
    """Copies the values that the user set to an operator."""
    switches = {}
    for parameter in properties.parameters_of(operation):
        if properties.is_optional_number(parameter):
            name = properties.property_name(parameter.name)
            switches[name] = switches[f"{name}_absolute"] = f"use_{name}"
    for name in properties.annotations_of(operation, pointers=False):
        wanted = getattr(settings, switches[name]) if name in switches else \
            settings.is_property_set(name)
        if name in ("frame_start", "frame_end"):
            wanted = wanted and settings.use_frames
        value = getattr(settings, name)
        if isinstance(value, bpy.types.Object):
            value = value.name
        if wanted and value is not None:
            setattr(operator, name, value)


def register(operation):
    """Registers and returns the class of an operation's settings."""
    group = type(f"MimetraSettings_{properties.property_name(operation.name)}",
                 (bpy.types.PropertyGroup,),
                 {"__annotations__": properties.annotations_of(operation, pointers=True)})
    classes.register(group)
    return group


def register_all(groups):
    """Registers the settings of all operations; `groups` are their classes."""
    fields = {properties.property_name(name): bpy.props.PointerProperty(type=group)
              for name, group in groups.items()}
    root = type("MimetraSettings", (bpy.types.PropertyGroup,), {"__annotations__": fields})
    classes.register(root)
    bpy.types.Scene.mimetra = bpy.props.PointerProperty(type=root)


def unregister_all():
    del bpy.types.Scene.mimetra
