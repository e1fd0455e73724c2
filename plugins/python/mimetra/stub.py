"""Prints type hints of the module for editors and type checkers: python3 -m mimetra.stub."""

import inspect

import mimetra

_HEAD = '''\
from collections.abc import Callable, Iterable, Mapping
from os import PathLike
from types import SimpleNamespace
from typing import Any, Literal, NamedTuple

from numpy import ndarray
from numpy.typing import ArrayLike

__version__: str
operations: dict[str, Operation]
formats: list[Format]

class Faces(NamedTuple):
    sizes: ndarray
    corners: ndarray

class Format:
    name: str
    kind: type[Data]
    extensions: list[str]
    read: bool
    written: bool
    options: list[str]

class Operation:
    name: str
    summary: str
    inputs: list[Any]
    outputs: list[Any]
    parameters: list[Any]
    writing: list[Any]

class Result(SimpleNamespace):
    report: dict[str, Any]
    summary: str
    def __getattr__(self, name: str) -> Any: ...

class Data:
    name: str
    json: str
    faces: Faces
    @classmethod
    def load(cls, path: str | PathLike[str], **settings: Any) -> Any: ...
    def save(self, path: str | PathLike[str], *, force: bool = False, **settings: Any) -> None: ...
    def derive(self, **arrays: ArrayLike | None) -> Any: ...
    def location(self, name: str) -> str | None: ...
    def keys(self) -> Iterable[str]: ...
    def __iter__(self) -> Any: ...
    def __len__(self) -> int: ...
    def __contains__(self, name: object) -> bool: ...
    def __getitem__(self, name: str) -> Any: ...
    def __getattr__(self, name: str) -> Any: ...
'''


def _slot(slot):
    text = slot.name + (f": {slot.annotation}" if slot.annotation is not slot.empty else "")
    return text if slot.default is slot.empty else f"{text} = {slot.default!r}"


def _slots(signature):
    texts = []
    for slot in signature.parameters.values():
        if slot.kind == slot.KEYWORD_ONLY and "*" not in texts:
            texts.append("*")
        texts.append(_slot(slot))
    return ", ".join(texts)


def _value_class(made):
    """Constructor of a value class: names are text, faces anything with polygons, all else
    arrays."""
    lines = [f"class {made.__name__}(Data):"]
    if "__init__" not in vars(made):
        return lines + ["    ..."]
    texts = []
    for slot in list(inspect.signature(made.__init__).parameters.values())[1:]:
        kind = {"name": "str", "text": "str", "faces": "ArrayLike | Faces | Iterable[ArrayLike]",
                "columns": "Mapping[str, ArrayLike]"}.get(slot.name)
        if slot.name.endswith("names"):
            kind = "Iterable[str]"
        if slot.name.startswith("on_"):
            kind = "Mapping[str, ArrayLike]"
        kind = kind or "ArrayLike"
        none = " | None" if slot.default is None else ""
        texts.append(_slot(slot.replace(annotation=kind + none)))
    return lines + [f"    def __init__(self, {', '.join(texts)}) -> None: ..."]


def _error_class(made):
    return [f"class {made.__name__}({', '.join(base.__name__ for base in made.__bases__)}):",
            "    status: int"]


def text():
    """Text of the stub."""
    lines = [_HEAD]
    for made in mimetra.Data.__subclasses__():
        lines += [*_value_class(made), ""]
    for made in (mimetra.Error, *mimetra.Error.__subclasses__()):
        lines += [*_error_class(made), ""]
    lines += ["def run(name: str, /, *inputs: Any, **options: Any) -> Result: ..."]
    for name in mimetra.operations:
        function = getattr(mimetra, mimetra.function_name(name))
        signature = inspect.signature(function)
        lines.append(f"def {function.__name__}({_slots(signature)}) -> Result: ...")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(text(), end="")
