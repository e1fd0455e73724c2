"""Blender properties made of the operations table: parameters, inputs and outputs."""

import bpy
import numpy as np
from bpy.props import (BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty,
                       StringProperty)

from . import mimetra

# Kinds of output that Blender can show. All others go into files.
SHOWN = (mimetra.Sequence, mimetra.Model, mimetra.Components, mimetra.Regions, mimetra.Table,
         mimetra.Pictures)
_OPEN = 2**31 - 1
_FIELD = "field:NAME"  # the choice of parameters that take a vertex field
_UNSET = "DEFAULT"  # default of choices without one; the table's names are in lower case
# Names that parameters cannot have: properties below, and Blender's own.
_OWN = {"frame_start", "frame_end", "frame_step", "use_frames", "cache_format", "cache_folder",
        "manifest"}
_RESERVED = _OWN.union(*(
    [*dir(base), *base.bl_rna.properties.keys(), *base.bl_rna.functions.keys()]
    for base in (bpy.types.Operator, bpy.types.PropertyGroup)))


def property_name(name):
    """Name of the property for a name of the table."""
    made = mimetra.python_name(name)
    return made + "_" if made in _RESERVED else made


def _label(each):
    unit = getattr(each, "unit", "")
    return each.name.replace("-", " ").capitalize() + (f" [{unit}]" if unit else "")


def object_inputs(operation):
    """Inputs that are objects. A model for landmarks is read from a file, because it needs
    identities, which objects do not have."""
    with_landmarks = any(port.kind is mimetra.Landmarks for port in operation.inputs)
    kinds = (mimetra.Sequence,) if with_landmarks else (mimetra.Sequence, mimetra.Model)
    return [port for port in operation.inputs if port.kind in kinds]


def active_input(operation):
    """Input that is the active object, or None if the operation takes no objects."""
    return next((port for port in object_inputs(operation) if not port.optional), None)


def is_object(operation, port):
    """Returns whether an input is an object other than the active one."""
    return port in object_inputs(operation) and port is not active_input(operation)


def is_optional_number(parameter):
    """Returns whether a number may be left out, so that it needs a switch beside it."""
    return parameter.kind in ("integer", "number", "length") and parameter.default is None


def parameters_of(operation):
    """Parameters of an operation. Leaves out the parameters of reading files if the operation works
    on the active object."""
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
    """Property of a length: a share of the diameter, or a length of the mesh if the switch beside
    it is on."""
    return FloatProperty(default=_share(parameter.default), min=max(parameter.minimum or 0, 0),
                         soft_max=1, precision=3, **common)


def _share(default):
    """Default share of the diameter. A length without a default gets a share that is useful on a
    face."""
    return float(default) if default and not default.endswith("abs") else 0.1


def _path(parameter, common):
    if not parameter.choices:
        return StringProperty(subtype="FILE_PATH", **common)
    return StringProperty(default=parameter.default or "", search_options={"SUGGESTION"},
                          search=lambda _, context, text: _suggestions(parameter, context),
                          **common)


def _suggestions(parameter, context):
    """Words that a path property also accepts. For a vertex field, includes the active object's
    vertex groups."""
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
    """Outputs that Blender has a place for. Documents are for other programs."""
    return [port for port in operation.outputs if port.kind is not mimetra.Document]


def is_written(port):
    """Returns whether an output can go into a file. Components do so only if a path is given."""
    return port.kind not in SHOWN or port.kind is mimetra.Components


def needs_path(port):
    """Returns whether an output is always made and can only go into a file."""
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
    """All properties of an operation. With `pointers`, objects are pointers, as in settings;
    otherwise their names."""
    # The panel's values apply, and not the values of an operator's last run.
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
    """Vertex groups that parameters name as fields. Returns all groups if none matches, so that the
    error message lists them."""
    prefix = _FIELD.removesuffix("NAME")
    naming = [value for value in values if isinstance(value, str) and prefix in value]
    named = tuple(group for group in groups if any(group in value for value in naming))
    return named if named or not naming else tuple(groups)


def value_of(parameter, properties, groups=()):
    """Value of a parameter for the library, or None if the user did not set it. A vertex group's
    name becomes its field."""
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
        return str(np.float32(value))  # the typed number, not its nearest double
    if value == _UNSET:
        return None
    if value in groups and _FIELD in parameter.choices:
        return _FIELD.replace("NAME", value)
    if isinstance(value, str):
        known = not value or value in parameter.choices or parameter.kind != "path"
        return (value if known else bpy.path.abspath(value)) or None
    return value
