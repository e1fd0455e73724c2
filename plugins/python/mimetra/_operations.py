"""One Python function for each operation of the library's table."""

import ctypes
import difflib
import inspect
import json
import keyword
import math
import os
import types

from . import _interface as c
from ._context import context, library
from ._data import CLASSES, Data, Model, Sequence, of_handle, text_of

_ANNOTATIONS = {c.FLAG: "bool", c.INTEGER: "int", c.INTEGER_LIST: "Iterable[int]",
                c.NUMBER: "float", c.LENGTH: "float | str", c.TEXT: "str",
                c.FILE: "str | PathLike[str]"}
_KINDS = {c.FLAG: "flag", c.INTEGER: "integer", c.INTEGER_LIST: "list of integers",
          c.NUMBER: "number", c.LENGTH: "length", c.CHOICE: "choice", c.TEXT: "text",
          c.FILE: "path"}

# Names that results have besides outputs, and functions besides the table's names.
_RESERVED = ("report", "summary", "manifest", "force")


class Input:
    """Something an operation works on."""

    def __init__(self, port):
        self.name = port.name.decode()
        self.help = port.help.decode()
        self.kind = CLASSES[port.kind]
        self.optional = bool(port.flags & c.OPTIONAL)
        self.repeated = bool(port.flags & c.REPEATED)
        self.named = bool(port.flags & c.NAMED)
        #: True for a sequence whose fields the operation uses.
        self.fields = bool(port.flags & c.WITH_FIELDS)


class Output(Input):
    """Something it makes."""


class Parameter:
    """A parameter: `default` as a Python value or None, `minimum` and `maximum` or None.

    `of_files` is true where it is about reading inputs that are given as text.
    """

    def __init__(self, described):
        self.name = described.name.decode()
        self.help = described.help.decode()
        self.kind = _KINDS[described.kind]
        self.unit = described.unit.decode() if described.unit else ""
        self.choices = [text.decode() for text in c.listed(described.choices)]
        ranged = described.maximum > described.minimum
        self.minimum = _finite(described.minimum) if ranged else None
        self.maximum = _finite(described.maximum) if ranged else None
        self.of_files = bool(described.of_files)
        self.default = _value(described.kind, described.fallback)
        self.annotation = (f"Literal[{', '.join(map(repr, self.choices))}]"
                           if described.kind == c.CHOICE else _ANNOTATIONS[described.kind])

    def described(self):
        """Line about the parameter in a docstring."""
        notes = [self.help]
        if self.choices:
            also = " or a path" if self.kind == "path" else ""
            notes.append(f"one of {', '.join(map(repr, self.choices))}{also}")
        if self.minimum is not None or self.maximum is not None:
            notes.append(_range(self.minimum, self.maximum))
        if self.kind == "length":
            notes.append("a share of the diameter, or text such as '12abs'")
        if self.unit:
            notes.append(f"[{self.unit}]")
        return "; ".join(notes)


class Operation:
    """An operation as the table declares it."""

    def __init__(self, described):
        self.name = described.name.decode()
        self.summary = described.summary.decode()
        self.inputs = [Input(each.contents) for each in c.listed(described.inputs)]
        self.outputs = [Output(each.contents) for each in c.listed(described.outputs)]
        parameters = [each.contents for each in c.listed(described.parameters)]
        self.parameters = [Parameter(each) for each in parameters if each.of_files != c.WRITING]
        #: Parameters of writing the outputs to files.
        self.writing = [Parameter(each) for each in parameters if each.of_files == c.WRITING]


class Result(types.SimpleNamespace):
    """What an operation made: its outputs by name, `report` (a dict) and `summary` (text)."""


def function_name(name):
    """Python name of an operation."""
    made = name.replace("-", "_")
    return made + "_" if keyword.iskeyword(made) else made


def python_name(name):
    """Python name of an input, output or parameter."""
    made = function_name(name)
    return made + "_" if made in _RESERVED else made


def _finite(number):
    return number if math.isfinite(number) else None


def _range(minimum, maximum):
    if maximum is None:
        return f"at least {_end(minimum)}"
    return f"at most {_end(maximum)}" if minimum is None else f"{_end(minimum)} to {_end(maximum)}"


def _end(number):
    """Text of the end of a range; whole numbers have no decimal point."""
    return str(int(number) if number == int(number) else number)


def _value(kind, fallback):
    """Default as a Python value."""
    if fallback is None:
        return None
    text = fallback.decode()
    if kind == c.FLAG:
        return text == "true"
    if kind == c.INTEGER_LIST:
        return tuple(int(each) for each in text.split(",") if each)
    return {c.INTEGER: int, c.NUMBER: float}.get(kind, str)(text)


class _Call:
    """One run of an operation."""

    def __init__(self, own, name):
        self.own = own
        self.handle = ctypes.c_void_p()
        own.check(library.new_call(own.handle, name.encode(), ctypes.byref(self.handle)))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        library.free_call(self.handle)

    def set(self, name, value):
        if value is not None:
            self.own.check(library.call_set(self.handle, name.encode(), text_of(value).encode()))

    def give(self, port, value):
        name = port.name.encode()
        if isinstance(value, (str, os.PathLike)):
            text = os.fspath(value).encode()
            self.own.check(library.call_read(self.handle, name, text))
            return
        if isinstance(value, tuple) and len(value) == 2 and port.kind in (Sequence, Model):
            value = port.kind(*value, name=port.name)
        if not isinstance(value, Data):
            arrays = ", positions and faces" if port.kind in (Sequence, Model) else ""
            raise TypeError(f"{port.name}: expected a mimetra.{port.kind.__name__}{arrays} or a path,"
                            f" found {type(value).__name__}")
        self.own.check(library.call_give(self.handle, name, value._handle))

    def ask(self, name, wish, force):
        """Requests an output, or the manifest (`name` None): True for a value, a path for files."""
        if isinstance(wish, (str, os.PathLike)) and os.fspath(wish):
            path = os.fspath(wish).encode()
            self.own.check(library.call_write(self.handle, name, path, bool(force)))
        elif wish is not None and (name is None or not isinstance(wish, bool)):
            raise TypeError(f"{name.decode() if name else 'manifest'}: expected a path, found"
                            f" {wish!r}")
        elif wish:
            self.own.check(library.call_want(self.handle, name))

    def output(self, name, index):
        handle = ctypes.c_void_p()
        self.own.check(library.call_output(self.handle, name, index, ctypes.byref(handle)))
        return of_handle(handle)

    def outputs(self, port, many):
        """Values of an output, or a single value if no list was given."""
        name = port.name.encode()
        count = library.call_output_count(self.handle, name)
        values = [self.output(name, index) for index in range(count)]
        if port.repeated and many:
            return values
        return values[0] if values else None


def _run(operation, given, *, progress, threads):
    """Runs an operation with values by their Python names."""
    own = context()
    many = False
    with _Call(own, operation.name) as call, own.watched(progress, threads):
        for port in operation.inputs:
            value = given.get(python_name(port.name))
            values = value if port.repeated and isinstance(value, list) else [value]
            many = many or port.repeated and isinstance(value, list)
            for each in values:
                if each is not None:
                    call.give(port, each)
        force = given.get("force")
        for port in operation.outputs:
            call.ask(port.name.encode(), given.get(python_name(port.name)), force)
        call.ask(None, given.get("manifest"), force)
        for parameter in operation.parameters + operation.writing:
            call.set(parameter.name, given.get(python_name(parameter.name)))
        own.check(library.call_run(call.handle))
        made = {python_name(port.name): call.outputs(port, many) for port in operation.outputs}
        report = library.call_report(call.handle).decode()
        summary = library.call_summary(call.handle).decode()
    return Result(**made, report=json.loads(report) if report else {}, summary=summary)


def _input_annotation(port):
    one = f"{port.kind.__name__} | str | PathLike[str]"
    if port.kind in (Sequence, Model):
        one += " | tuple[ArrayLike, ArrayLike]"
    if port.repeated:
        one += f" | list[{one}]"
    return one + (" | None" if port.optional else "")


def _signature(operation):
    """Signature with required inputs in order, and everything else by name."""
    Slot = inspect.Parameter
    slots = []
    for port in operation.inputs:
        is_option = port.optional or port.named
        slots.append(Slot(python_name(port.name),
                          Slot.KEYWORD_ONLY if is_option else Slot.POSITIONAL_OR_KEYWORD,
                          default=None if port.optional else Slot.empty,
                          annotation=_input_annotation(port)))
    for parameter in operation.parameters + operation.writing:
        none = " | None" if parameter.default is None else ""
        slots.append(Slot(python_name(parameter.name), Slot.KEYWORD_ONLY,
                          default=parameter.default, annotation=parameter.annotation + none))
    for port in operation.outputs:
        slots.append(Slot(python_name(port.name), Slot.KEYWORD_ONLY, default=not port.optional,
                          annotation="bool | str | PathLike[str]"))
    slots.append(Slot("force", Slot.KEYWORD_ONLY, default=False, annotation="bool"))
    slots.append(Slot("manifest", Slot.KEYWORD_ONLY, default=None,
                      annotation="str | PathLike[str] | None"))
    slots.append(Slot("progress", Slot.KEYWORD_ONLY, default=None,
                      annotation="Callable[[float], bool | None] | None"))
    slots.append(Slot("threads", Slot.KEYWORD_ONLY, default=None, annotation="int | None"))
    slots.sort(key=lambda slot: slot.kind)
    return inspect.Signature(slots, return_annotation="Result")


def _suggestion(options, signature):
    """"; did you mean 'k'?" for the first unknown option, or nothing."""
    known = {name.lower(): name for name in signature.parameters}
    unknown = next((name for name in options if name not in signature.parameters), "")
    near = difflib.get_close_matches(unknown.lower(), known, n=1)
    return f"; did you mean '{known[near[0]]}'?" if near else ""


def _docstring(operation):
    lines = [operation.summary + ".", ""]
    lines += [f"    {python_name(port.name)}: {port.help}" for port in operation.inputs]
    lines += [f"    {python_name(parameter.name)}: {parameter.described()}"
              for parameter in operation.parameters + operation.writing]
    lines += [f"    {python_name(port.name)}: {'True to make this too, or ' if port.optional else ''}"
              f"a path to write it to: {port.help}" for port in operation.outputs]
    lines += ["    force: replace what an earlier run wrote at these paths",
              "    manifest: a file for the manifest of the run: its options, inputs and report",
              "    progress: called with the share of the work done; False as its answer cancels",
              "    threads: at most so many; None for all there are", ""]
    made = [f"{python_name(port.name)} (mimetra.{port.kind.__name__})"
            for port in operation.outputs]
    lines.append(f"Returns {', '.join([*made, 'report and summary'])}.")
    return "\n".join(lines)


def function_of(operation):
    """Python function of an operation."""
    signature = _signature(operation)

    def function(*arguments, **options):
        try:
            given = dict(signature.bind(*arguments, **options).arguments)
        except TypeError as error:
            raise TypeError(f"{function.__name__}() {error}{_suggestion(options, signature)}") from None
        return _run(operation, given, progress=given.pop("progress", None),
                    threads=given.pop("threads", None))

    function.__name__ = function.__qualname__ = function_name(operation.name)
    function.__module__ = "mimetra"
    function.__doc__ = _docstring(operation)
    function.__signature__ = signature
    function.__annotations__ = {slot.name: slot.annotation
                                for slot in signature.parameters.values()}
    function.operation = operation
    return function


def all_operations():
    """Operations of the table, by name."""
    return {described.name.decode(): Operation(described) for described in context().operations()}


class Format:
    """A format of files: the `kind` of value that it holds, as a class, what names of its files end
    in ("" stands for a folder, a pattern and the like, "*" for any file), whether it is `read` and
    `written`, and the names of its `options`."""

    def __init__(self, described):
        self.name = described.name.decode()
        self.kind = CLASSES[described.kind]
        self.extensions = [text.decode() for text in c.listed(described.extensions)]
        self.read = bool(described.use & c.READING)
        self.written = bool(described.use & c.WRITING)
        self.options = [each.contents.name.decode() for each in c.listed(described.parameters)]


def all_formats():
    """Formats of the table, in its order."""
    return [Format(described) for described in context().formats()]
