"""Blender properties made of the operations table: parameters, inputs and outputs."""

import bpy
import numpy as np
from bpy.props import (BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty,
                       StringProperty)

from . import mimetra

# What an operation makes and Blender can show; all else goes into files.
SHOWN = (mimetra.Sequence, mimetra.Model, mimetra.Components, mimetra.Regions, mimetra.Table,
         mimetra.Pictures)
_OPEN = 2**31 - 1
_FIELD = "field:NAME"  # the choice of parameters that take a vertex field
_UNSET = "DEFAULT"  # of choices without one; names of the table have small letters
# Names that parameters cannot have: of properties below, and of Blender's.
_OWN = {"frame_start", "frame_end", "frame_step", "use_frames", "cache_format", "cache_folder",
        "manifest"}
_RESERVED = _OWN.union(*(
    [*dir(base), *base.bl_rna.properties.keys(), *base.bl_rna.functions.keys()]
    for base in (bpy.types.Operator, bpy.types.PropertyGroup)))


def property_name(name):
    """A name of the table as a property's."""
    made = mimetra.python_name(name)
    return made + "_" if made in _RESERVED else made


def _label(each):
    unit = getattr(each, "unit", "")
    return each.name.replace("-", " ").capitalize() + (f" [{unit}]" if unit else "")


def object_inputs(operation):
    """The inputs that are objects. A model for landmarks is read: it needs identities, which no
    object has."""
    with_landmarks = any(port.kind is mimetra.Landmarks for port in operation.inputs)
    kinds = (mimetra.Sequence,) if with_landmarks else (mimetra.Sequence, mimetra.Model)
    return [port for port in operation.inputs if port.kind in kinds]


def active_input(operation):
    """The input that is the active object; None where an operation has none of objects."""
    return next((port for port in object_inputs(operation) if not port.optional), None)


def is_object(operation, port):
    """True for inputs that are other objects."""
    return port in object_inputs(operation) and port is not active_input(operation)


def is_optional_number(parameter):
    """True where a number may be left out, so that it needs a switch beside it."""
    return parameter.kind in ("integer", "number", "length") and parameter.default is None


def parameters_of(operation):
    """The parameters of an operation; without those of reading where an object is what it reads."""
    reads = active_input(operation) is None
    return [parameter for parameter in operation.parameters if reads or not parameter.of_files]


def _limits(parameter, open_end):
    minimum = -open_end if parameter.minimum is None else parameter.minimum
    maximum = open_end if parameter.maximum is None else parameter.maximum
    return minimum, maximum


def _number(parameter, common):
    kind, end = (IntProperty, _OPEN) if parameter.kind == "integer" else (FloatProperty, 1e30)
    minimum, maximum = _limits(parameter, end)
    default = min(max(parameter.default or 0, minimum), maximum)
    if kind is FloatProperty:
        return kind(min=minimum, max=maximum, default=default, precision=4, **common)
    return kind(min=int(minimum), max=int(maximum), default=int(default), **common)


def _choice(parameter, common):
    items = [(choice, choice.capitalize(), "") for choice in parameter.choices]
    if parameter.default is None:
        items.insert(0, (_UNSET, "Default", ""))
    return EnumProperty(items=items, default=parameter.default or _UNSET, **common)


def _length(parameter, common):
    """A share of the diameter; the switch beside it makes it a length of the mesh."""
    return FloatProperty(default=_share(parameter.default), min=max(parameter.minimum or 0, 0),
                         soft_max=1, precision=3, **common)


def _share(default):
    """Of a length that has none, what is of use on a face when it is switched on."""
    return float(default) if default and not default.endswith("abs") else 0.1


def _path(parameter, common):
    if not parameter.choices:
        return StringProperty(subtype="FILE_PATH", **common)
    return StringProperty(default=parameter.default or "", search_options={"SUGGESTION"},
                          search=lambda _, context, text: _suggestions(parameter, context),
                          **common)


def _suggestions(parameter, context):
    """The words that stand beside paths; for a vertex field the active object's groups."""
    subject = context.active_object
    takes_groups = _FIELD in parameter.choices and subject and subject.type == "MESH"
    groups = [group.name for group in subject.vertex_groups] if takes_groups else []
    return [*groups, *parameter.choices]


def _properties_of(parameter, options):
    name = property_name(parameter.name)
    common = {"name": _label(parameter), "description": parameter.help, "options": options}
    if parameter.kind == "flag":
        return {name: BoolProperty(default=bool(parameter.default), **common)}
    if parameter.kind == "choice":
        return {name: _choice(parameter, common)}
    if parameter.kind == "length":
        switch = BoolProperty(name="Absolute", options=options,
                              description="In the unit of the mesh, not as a share of its"
                                          " diameter")
        return {name: _length(parameter, common), f"{name}_absolute": switch}
    if parameter.kind in ("integer", "number"):
        return {name: _number(parameter, common)}
    if parameter.kind == "path":
        return {name: _path(parameter, common)}
    default = parameter.default
    text = ",".join(map(str, default)) if isinstance(default, tuple) else default or ""
    return {name: StringProperty(default=text, **common)}


def _input_property(operation, port, options, pointers):
    common = {"name": _label(port), "description": port.help, "options": options}
    if is_object(operation, port):
        return (PointerProperty(type=bpy.types.Object, name=common["name"],
                                description=port.help, poll=lambda _, each: each.type == "MESH")
                if pointers else StringProperty(**common))
    if port.kind is mimetra.Regions:
        common["description"] = "Vertex groups whose names begin with this, as regions; or a file"
        return StringProperty(**common)
    return StringProperty(subtype="FILE_PATH", **common)


def outputs_of(operation):
    """Those that Blender has a place for: documents are for other programs."""
    return [port for port in operation.outputs if port.kind is not mimetra.Document]


def is_written(port):
    """True for outputs that go into files, those of components where a path is given."""
    return port.kind not in SHOWN or port.kind is mimetra.Components


def needs_path(port):
    """True for outputs that are always made, and can only go into files."""
    return not port.optional and port.kind not in SHOWN


def _output_property(port, options):
    common = {"name": _label(port), "options": options}
    if is_written(port):
        return StringProperty(subtype="FILE_PATH", description=f"Where to write: {port.help}",
                              **common)
    return BoolProperty(description=f"Make {_label(port).lower()} too", **common)


def _run_properties(options):
    ends = {"options": options}
    return {
        "frame_start": IntProperty(name="Start", description="First frame, if not the scene's",
                                   **ends),
        "frame_end": IntProperty(name="End", description="Last frame, if not the scene's", **ends),
        "frame_step": IntProperty(name="Step", description="Every so many frames", default=1,
                                  min=1, **ends),
        "cache_format": EnumProperty(
            name="Cache", options=options, default="PC2",
            items=[("PC2", "PC2", "Point cache of 3ds Max"), ("MDD", "MDD", "Of Lightwave")],
            description="Format of mesh caches"),
        "cache_folder": StringProperty(
            name="Folder", subtype="DIR_PATH", default="//mimetra", options=options,
            description="Folder of mesh caches; // is that of the saved file"),
        "manifest": StringProperty(
            name="Manifest", subtype="FILE_PATH", options=options,
            description="File for what ran: its options, inputs and report, for one Align the"
                        " motion that another gives back"),
    }


def annotations_of(operation, *, pointers):
    """All properties of an operation; `pointers` to objects in settings, their names otherwise."""
    # What an operator ran with before is not what the panel says now.
    options = set() if pointers else {"SKIP_SAVE"}
    made = _run_properties(options)
    if pointers:
        made["use_frames"] = BoolProperty(name="Own Frames", options=options,
                                          description="These frames instead of the scene's")
    for port in operation.inputs:
        if port is not active_input(operation):
            made[property_name(port.name)] = _input_property(operation, port, options, pointers)
    for parameter in parameters_of(operation):
        made.update(_properties_of(parameter, options))
        if pointers and is_optional_number(parameter):
            made[f"use_{property_name(parameter.name)}"] = BoolProperty(
                name="", description=f"Use {_label(parameter).lower()}")
    for port in outputs_of(operation):
        if port.optional or is_written(port):
            made[property_name(port.name)] = _output_property(port, options)
    return made


def groups_among(values, groups):
    """The vertex groups that parameters name as fields; all of them where a name is of none, whose
    message lists those that are there."""
    prefix = _FIELD.removesuffix("NAME")
    naming = [value for value in values if isinstance(value, str) and prefix in value]
    named = tuple(group for group in groups if any(group in value for value in naming))
    return named if named or not naming else tuple(groups)


def value_of(parameter, properties, groups=()):
    """A parameter for the library; None where the user left it as it is. The names of vertex
    groups stand for their fields."""
    name = property_name(parameter.name)
    absolute = parameter.kind == "length" and getattr(properties, f"{name}_absolute")
    if not properties.is_property_set(name):
        if not absolute:
            return None
        if parameter.default is None:
            raise mimetra.UsageError(f"{parameter.name}: is to be absolute, and no length is set;"
                                     " set one, or switch Absolute off")
    value = getattr(properties, name)
    if parameter.kind == "length":
        return f"{np.float32(value)}{'abs' if absolute else ''}"
    if isinstance(value, float):
        return str(np.float32(value))  # what was typed, not its nearest double
    if value == _UNSET:
        return None
    if value in groups and _FIELD in parameter.choices:
        return _FIELD.replace("NAME", value)
    if isinstance(value, str):
        known = not value or value in parameter.choices or parameter.kind != "path"
        return (value if known else bpy.path.abspath(value)) or None
    return value
