"""One Blender operator for each operation of the table."""

import contextlib
import logging
import os
import threading
import time

import bpy

from . import classes, keying, mimetra, properties, results, sources

# Shares of a run at which reading and computing end; showing comes last.
_READING, _COMPUTING = 0.3, 0.95
_STEP = 0.05  # seconds between checks of the user's keys


class _Warnings(logging.Handler):
    """Collects the library's warnings during a run."""

    def __init__(self):
        super().__init__(logging.WARNING)
        self.texts = []

    def emit(self, record):
        self.texts.append(record.getMessage())


def _part(steps, begin, end):
    """Yields the shares of some steps as part of a whole; returns their result."""
    while True:
        try:
            share = next(steps)
        except StopIteration as done:
            return done.value
        yield begin + (end - begin) * share


def _free(path, name):
    """Returns the path, if any. Throws OutputError if it exists already."""
    if path and os.path.exists(path):
        raise mimetra.OutputError(f"{path}: exists already; choose another name for {name}, or"
                                  " remove it")
    return path


def _computed(operation, inputs, options):
    """Yields the share done; returns the result. Closing the generator cancels the computation."""
    state = {"share": 0.0}
    cancelled = threading.Event()

    def watch(share):
        state["share"] = share
        return not cancelled.is_set()

    def compute():
        try:
            state["result"] = mimetra.run(operation.name, **inputs, **options, progress=watch)
        except Exception as error:
            state["error"] = error

    thread = threading.Thread(target=compute, name=f"mimetra {operation.name}")
    thread.start()
    try:
        while thread.is_alive():
            yield state["share"]
            thread.join(_STEP)
    finally:
        cancelled.set()
        thread.join()
    if "error" in state:
        raise state["error"]
    return state["result"]


def _is_animation(port):
    """Returns whether an output is a sequence shown by its poses, not by fields on its source."""
    return port.kind is mimetra.Sequence and not port.fields


class _Run:
    """Base of all operators; `_operation` is the operation in the table. Names without a leading
    underscore are Blender's own, because a parameter may have any other name."""

    _operation = None

    @classmethod
    def poll(cls, context):
        if not properties.active_input(cls._operation):
            return True
        subject = context.active_object
        if not subject or subject.type != "MESH":
            cls.poll_message_set("Select a mesh")
            return False
        if subject.mode != "OBJECT":
            cls.poll_message_set("Leave the mode of editing")
            return False
        return True

    def _frames(self, scene):
        """Requested frames, or the scene's."""
        start = self.frame_start if self.properties.is_property_set("frame_start") \
            else scene.frame_start
        end = self.frame_end if self.properties.is_property_set("frame_end") else scene.frame_end
        if end < start:
            raise mimetra.UsageError(f"frames: expected an end of at least {start}, found {end}")
        return list(range(start, end + 1, self.frame_step))

    def _object(self, port):
        """Object that an input names, or None."""
        name = getattr(self, properties.property_name(port.name))
        if not name:
            if port.optional:
                return None
            raise mimetra.UsageError(f"{self._operation.name}: expected an object as {port.name}:"
                                     f" {port.help}")
        subject = bpy.data.objects.get(name)
        if subject is None or subject.type != "MESH":
            raise mimetra.BadInput(f"{name}: expected a mesh object as {port.name}")
        return subject

    def _value(self, context, port, subject, frames):
        """Yields the share done; returns the value of an input, from an object or a path."""
        if port in properties.object_inputs(self._operation):
            if port.kind is mimetra.Model:
                return sources.model(subject)
            groups = self._groups(subject) if port.fields else ()
            return (yield from sources.sequence(context, subject, frames,
                                                groups=groups))
        text = getattr(self, properties.property_name(port.name))
        path = bpy.path.abspath(text)
        if port.kind is mimetra.Regions and text and not os.path.isfile(path):
            return sources.regions(subject, text)
        if not text and not port.optional:
            raise mimetra.UsageError(f"{self._operation.name}: expected a path as {port.name}:"
                                     f" {port.help}")
        return path or None

    def _groups(self, subject):
        """Vertex groups of an object that parameters name."""
        groups = subject.vertex_groups.keys()
        return properties.groups_among(
            [properties.value_of(parameter, self.properties, groups)
             for parameter in properties.parameters_of(self._operation)], groups)

    def _inputs(self, context, frames):
        """Yields the share done; returns the inputs by name, and their objects by name."""
        values, objects = {}, {}
        active = properties.active_input(self._operation)
        for port in self._operation.inputs:
            name = mimetra.python_name(port.name)
            if port is active:
                objects[name] = context.active_object
            elif properties.is_object(self._operation, port):
                objects[name] = self._object(port)
                if objects[name] is None:
                    continue
            subject = objects.get(name) or context.active_object
            values[name] = yield from self._value(context, port, subject, frames)
        return values, objects

    def _options(self, objects):
        """Parameters that the user set, and optional outputs to make."""
        options = {}
        active = properties.active_input(self._operation)
        source = objects.get(mimetra.python_name(active.name)) if active else None
        groups = source.vertex_groups.keys() if source else ()
        for parameter in properties.parameters_of(self._operation):
            value = properties.value_of(parameter, self.properties, groups)
            if value is not None:
                options[mimetra.python_name(parameter.name)] = value
        # The space 'vertex' gives no weights.
        keyed = None if options.get("space") == "vertex" else self._keyed(objects)
        outputs = properties.outputs_of(self._operation)
        for port in outputs:
            asked = getattr(self, properties.property_name(port.name), None)
            if properties.needs_path(port) and not asked:
                raise mimetra.UsageError(f"{self._operation.name}: expected a path for {port.name}:"
                                         f" {port.help}")
            path = self._path_of(port)
            if path or port.optional and (asked or (keyed and port.kind is mimetra.Table)):
                options[mimetra.python_name(port.name)] = _free(path, port.name) or True
        if self.manifest:
            options["manifest"] = _free(bpy.path.abspath(self.manifest), "the manifest")
        if keyed and any(port.kind is mimetra.Table for port in outputs):
            keying.check_can_be_keyed(keyed)
        return options

    def _keyed(self, objects):
        """Object whose shape keys may hold the result: the model among the inputs, or None."""
        for port in self._operation.inputs:
            subject = objects.get(mimetra.python_name(port.name))
            if port.kind is mimetra.Model and subject and sources.expression_keys(subject):
                return subject
        return None

    def _steps(self, context):
        """Yields the share of the work done. Changes nothing before its last step."""
        frames = self._frames(context.scene)
        values, objects = yield from _part(self._inputs(context, frames), 0, _READING)
        options = self._options(objects)
        steps = _computed(self._operation, values, options)
        result = yield from _part(steps, _READING, _COMPUTING)
        shown = results.Frames(context.scene, frames, self.cache_format, self.cache_folder)
        self._show(context, result, values, objects, shown)
        yield 1.0

    def _show(self, context, result, values, objects, frames):
        """Shows the outputs, on the target if there is one. Steps that may fail come before changes
        to the scene: checks of values, files, caches."""
        made = [(port, getattr(result, mimetra.python_name(port.name)))
                for port in properties.outputs_of(self._operation)]
        made = [(port, value) for port, value in made if value is not None]
        target = next((objects.get(mimetra.python_name(port.name))
                       for port in self._operation.inputs if port.kind is mimetra.Model), None)
        source = context.active_object if properties.active_input(self._operation) else None
        for port, value in made:
            is_shown_on_source = port.kind in (mimetra.Sequence, mimetra.Regions)
            if source and is_shown_on_source and not _is_animation(port):
                results.check_fits(value, source)
        made = [(port, value) for port, value in made if not self._path_of(port)]
        if target and self._show_on_target(made, values, target, frames):
            made = [each for each in made if not _is_animation(each[0])]
        made.sort(key=lambda each: (not _is_animation(each[0]),
                                    each[0].kind is not mimetra.Sequence))
        for port, value in made:
            self._show_value(context, port, value, source, frames)
        for note in frames.notes:
            self.report({"WARNING"}, note)
        if result.summary:
            results.show_text(f"mimetra {self._operation.name}", result.summary)
            self.report({"INFO"}, result.summary.strip())

    def _show_on_target(self, made, values, target, frames):
        """Shows the result by shape keys if they can hold it, else by a mesh cache. Returns False
        if the target has other faces or there is no sequence."""
        sequence = next((value for port, value in made if _is_animation(port)), None)
        if sequence is None or not results.has_faces_of(target, sequence):
            return False
        frames = frames.of(sequence["times"])
        model = next(value for value in values.values() if isinstance(value, mimetra.Model))
        for port, value in made:
            weights = port.kind is mimetra.Table and keying.keyed_weights(target, value)
            if weights and keying.holds(model, weights, sequence["positions"]):
                keying.set_keys(target, weights, frames)
                results.remove_mesh_cache(target)
                return True
        if model.keys() >= {"expressions"} and any(
                port.kind is mimetra.Table for port, _ in made):
            self.report({"INFO"}, f"{target.name}: moves as shape keys cannot; it got a mesh cache")
        path = results.write_mesh_cache(sequence, frames, target.name)
        results.play_mesh_cache(target, path, frames)
        return True

    def _show_value(self, context, port, value, source, frames):
        """Shows an output that the target does not take."""
        name = f"{source.name} {self._operation.name}" if source else self._operation.name
        if port.kind is mimetra.Sequence:
            if source and not _is_animation(port):
                results.show_fields(value, source)
            else:
                results.show_sequence(context, value, source, frames, name)
        elif port.kind is mimetra.Model:
            results.show_model(context, value, frames, name)
        elif port.kind is mimetra.Components:
            results.show_components(context, value, source, frames, name)
        elif port.kind is mimetra.Pictures:
            results.show_pictures(f"{name} {port.name}", value)
        elif port.kind is mimetra.Table:
            if not port.optional or getattr(self, properties.property_name(port.name)):
                results.show_text(f"{name} {port.name}.csv", results.csv_of(value))
        elif source:
            results.show_regions(value, source)

    def _path_of(self, port):
        """Path of an output that goes into a file; None for outputs that are shown."""
        path = properties.is_written(port) and getattr(self, properties.property_name(port.name))
        return bpy.path.abspath(path) if path else None

    @contextlib.contextmanager
    def _reported(self):
        """Reports the library's warnings in Blender."""
        warnings = _Warnings()
        logger = logging.getLogger("mimetra")
        logger.addHandler(warnings)
        try:
            yield
        finally:
            logger.removeHandler(warnings)
            for text in warnings.texts:
                self.report({"WARNING"}, text)

    def execute(self, context):
        manager = context.window_manager
        manager.progress_begin(0, 100)
        try:
            with self._reported():
                for share in self._steps(context):
                    manager.progress_update(100 * share)
        except mimetra.Error as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        finally:
            manager.progress_end()
        return {"FINISHED"}

    def invoke(self, context, event):
        if bpy.app.background or not context.window:
            return self.execute(context)
        self._running = self._watched_steps(context)
        self._timer = context.window_manager.event_timer_add(_STEP, window=context.window)
        context.window_manager.progress_begin(0, 100)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def _watched_steps(self, context):
        with self._reported():
            yield from self._steps(context)

    def modal(self, context, event):
        if event.type == "ESC":
            self._running.close()
            self.report({"WARNING"}, f"mimetra {self._operation.name}: cancelled")
            return self._end(context, {"CANCELLED"})
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        until = time.monotonic() + _STEP
        try:
            share = next(self._running)
            while time.monotonic() < until:
                share = next(self._running)
        except StopIteration:
            return self._end(context, {"FINISHED"})
        except mimetra.Error as error:
            self.report({"ERROR"}, str(error))
            return self._end(context, {"CANCELLED"})
        except Exception:
            self._end(context, {"CANCELLED"})
            raise
        context.window_manager.progress_update(100 * share)
        context.workspace.status_text_set(
            f"mimetra {self._operation.name}: {100 * share:.0f} %  (Esc cancels)")
        return {"RUNNING_MODAL"}

    def cancel(self, context):
        """Called when Blender quits or opens another file."""
        self._running.close()
        context.window_manager.event_timer_remove(self._timer)

    def _end(self, context, answer):
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
        return answer


def idname(operation):
    """Name of an operation's operator."""
    return f"mimetra.{mimetra.python_name(operation.name)}"


def register(operation):
    classes.register(type(
        f"MIMETRA_OT_{mimetra.python_name(operation.name)}", (_Run, bpy.types.Operator), {
            "bl_idname": idname(operation),
            "bl_label": operation.name.replace("-", " ").capitalize(),
            "bl_description": operation.summary,
            "bl_options": {"REGISTER", "UNDO"},
            "_operation": operation,
            "__annotations__": properties.annotations_of(operation, pointers=False)}))
