"""The sidebar of the 3D view: one panel for each operation."""

import bpy

from . import classes, mimetra, operators, properties, settings

# Operations and parameters that users look for first; all others follow.
_FIRST = ("transfer", "regions")
_MAIN = ("k", "radius", "coverage", "full", "space", "source", "on")
_FEW = 8


class _Panel:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "mimetra"
    bl_options = {"DEFAULT_CLOSED"}
    operation = None


def _main_parameters(operation):
    """Parameters at the top of a panel: all of them if there are few."""
    parameters = properties.parameters_of(operation)
    if len(parameters) <= _FEW:
        return parameters
    return sorted((parameter for parameter in parameters if parameter.name in _MAIN),
                  key=lambda parameter: _MAIN.index(parameter.name))


def _is_main_input(operation, port):
    return (not port.optional or properties.is_object(operation, port)
            or port.kind is mimetra.Regions)


def _is_main_output(port):
    return port.kind is mimetra.Regions if port.optional else properties.is_written(port)


def _draw_parameter(layout, group, parameter):
    name = properties.property_name(parameter.name)
    if properties.is_optional_number(parameter):
        row = layout.row(align=True, heading=group.bl_rna.properties[name].name)
        row.prop(group, f"use_{name}")
        field = row.row(align=True)
        field.enabled = getattr(group, f"use_{name}")
        field.prop(group, name, text="")
    else:
        field = layout.row(align=True)
        field.prop(group, name)
    if parameter.kind == "length":
        field.prop(group, f"{name}_absolute", text="", icon="DRIVER_DISTANCE")


class _OperationPanel(_Panel):
    def draw(self, context):
        operation = self.operation
        group = settings.of(context.scene, operation)
        layout = _split(self.layout)
        active = properties.active_input(operation)
        if active:
            subject = context.active_object
            layout.label(text=f"{active.name.capitalize()}: {subject.name if subject else ''}",
                         icon="OBJECT_DATA")
        for port in operation.inputs:
            if port is not active and _is_main_input(operation, port):
                layout.prop(group, properties.property_name(port.name))
        for parameter in _main_parameters(operation):
            _draw_parameter(layout, group, parameter)
        for port in properties.outputs_of(operation):
            if _is_main_output(port):
                layout.prop(group, properties.property_name(port.name))
        run = self.layout.operator(operators.idname(operation))
        settings.copy(group, operation, run)


class _MorePanel(_Panel):
    def draw(self, context):
        operation = self.operation
        group = settings.of(context.scene, operation)
        layout = _split(self.layout)
        main = {parameter.name for parameter in _main_parameters(operation)}
        active = properties.active_input(operation)
        for port in operation.inputs:
            if port is not active and not _is_main_input(operation, port):
                layout.prop(group, properties.property_name(port.name))
        for parameter in properties.parameters_of(operation):
            if parameter.name not in main:
                _draw_parameter(layout, group, parameter)
        for port in properties.outputs_of(operation):
            if not _is_main_output(port) and (port.optional or properties.is_written(port)):
                layout.prop(group, properties.property_name(port.name))
        layout.prop(group, "manifest")
        if active:
            _draw_frames(layout, group)


def _split(layout):
    """Returns a column with names on the left."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    return layout.column()


def _draw_frames(layout, group):
    layout.prop(group, "use_frames")
    column = layout.column(align=True)
    column.enabled = group.use_frames
    column.prop(group, "frame_start")
    column.prop(group, "frame_end")
    layout.prop(group, "frame_step")
    layout.prop(group, "cache_format")
    layout.prop(group, "cache_folder")


def _add(base, identifier, label, operation, more):
    classes.register(type(identifier, (base, bpy.types.Panel), {
        "bl_idname": identifier, "bl_label": label, "operation": operation, **more}))


def in_order():
    """Operations in the order of their panels."""
    names = [*(name for name in _FIRST if name in mimetra.operations),
             *(name for name in mimetra.operations if name not in _FIRST)]
    return [mimetra.operations[name] for name in names]


def register(operation, order):
    identifier = f"MIMETRA_PT_{mimetra.python_name(operation.name)}"
    options = set() if order == 0 else {"DEFAULT_CLOSED"}
    _add(_OperationPanel, identifier, operation.name.replace("-", " ").capitalize(), operation,
         {"bl_order": order, "bl_options": options})
    _add(_MorePanel, f"{identifier}_more", "More", operation, {"bl_parent_id": identifier})
