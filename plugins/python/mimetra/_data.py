"""Values of the toolkit as NumPy arrays."""

import ctypes
import os
import struct
import zlib
from typing import NamedTuple

import numpy as np

from . import _interface as c
from ._context import context, library
from ._errors import UsageError

_DTYPES = {c.F64: np.float64, c.F32: np.float32, c.I32: np.int32, c.U8: np.uint8}

# Types of arrays that do not contain floating-point numbers.
_KNOWN = {"face_sizes": c.I32, "corners": c.I32, "triangles": c.I32, "centers": c.I32,
          "landmarks": c.I32, "masks": c.U8, "pixels": c.U8, "expression_names": c.STRING,
          "identity_names": c.STRING, "weight_names": c.STRING, "names": c.STRING,
          "text": c.STRING}


class Faces(NamedTuple):
    """Polygons: how many corners each has (P), and the vertices at all corners (C)."""

    sizes: np.ndarray
    corners: np.ndarray


class Data:
    """A value that goes into operations and comes out of them: named arrays, which mimetra.h lists.

    `data["positions"]` or `data.positions` is one of them, `list(data)` are their names. They are
    views of the library's memory, which cannot be written to and live on without the value.
    """

    kind = 0

    @classmethod
    def load(cls, path, **settings):
        """Reads a value as the command reads an input of its kind.

        `settings` are the command's parameters of reading, such as frames="0:100" or fps=25.
        """
        handle = ctypes.c_void_p()
        own = context()
        with own.watched():
            own.check(library.load_data(own.handle, cls.kind, os.fspath(path).encode(),
                                        _settings(settings), ctypes.byref(handle)))
        return cls._of_handle(handle)

    def save(self, path, *, force=False, **settings):
        """Writes it by the path's extension, as the command does; `force` replaces what was written before.

        `settings` are the command's parameters of writing, such as format="obj".
        """
        own = context()
        with own.watched():
            own.check(library.save_data(own.handle, self._handle, os.fspath(path).encode(),
                                        _settings({"force": force, **settings})))

    def derive(self, **arrays):
        """The same value with these arrays in place of its own; what no array shows stays."""
        handle = ctypes.c_void_p()
        own = context()
        types = {name: array.type for name, array in self._arrays.items()}
        located = {name: array.location for name, array in self._arrays.items() if array.location}
        changes = [(name, _Field(values, located[name]) if name in located else values)
                   for name, values in arrays.items()]
        given, kept = _given(changes, {**_KNOWN, **types})
        own.check(library.derive_data(own.handle, self._handle, given, ctypes.byref(handle)))
        del kept
        return type(self)._of_handle(handle)

    @classmethod
    def _of_handle(cls, handle):
        data = cls.__new__(cls)
        data._own(handle)
        return data

    def _make(self, name, arrays, types=_KNOWN, fields=()):
        own = context()
        given, kept = _given([*arrays.items(), *fields], types)
        handle = ctypes.c_void_p()
        own.check(library.new_data(own.handle, self.kind, name.encode(), given,
                                   ctypes.byref(handle)))
        del kept
        self._own(handle)

    def _own(self, handle):
        self._handle = handle
        self._shown = None
        c.free_with(self, library.free_data, handle)

    def __copy__(self):
        """Itself, since values never change."""
        return self

    def __deepcopy__(self, _):
        return self

    def __reduce__(self):
        raise TypeError(f"a mimetra.{type(self).__name__} cannot be pickled; save it to a file, or"
                        " pickle its arrays")

    @property
    def name(self):
        """What it is called in messages."""
        return library.data_name(self._handle).decode()

    @property
    def json(self):
        """What its .json file holds, as text."""
        own = context()
        text = ctypes.c_char_p()
        own.check(library.data_json(own.handle, self._handle, ctypes.byref(text)))
        return text.value.decode()

    @property
    def faces(self):
        """Its polygons, to be given to other values."""
        return Faces(self["face_sizes"], self["corners"])

    @property
    def _arrays(self):
        if self._shown is None:
            own = context()
            arrays = ctypes.POINTER(ctypes.POINTER(c.Array))()
            own.check(library.data_arrays(own.handle, self._handle, ctypes.byref(arrays)))
            shown = {}
            for each in c.listed(arrays):
                # The first of two fields with the same name counts.
                shown.setdefault(each.contents.name.decode(), each.contents)
            self._shown = shown  # set at once, because other threads may read it
        return self._shown

    def __getitem__(self, name):
        if name not in self._arrays:
            raise KeyError(f"no array '{name}'; there are {', '.join(self._arrays)}")
        array = self._arrays[name]
        shape = tuple(array.shape[:array.rank])
        if array.type == c.STRING:
            texts = ctypes.cast(array.values, ctypes.POINTER(ctypes.c_char_p))
            return [text.decode() for text in texts[:shape[0]]]
        return np.asarray(_View(self, array.values, shape, _DTYPES[array.type]))

    def __getattr__(self, name):
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def location(self, name):
        """Where an array has its entries: "vertices", "triangles", or None."""
        return {c.ON_VERTICES: "vertices", c.ON_TRIANGLES: "triangles"}.get(
            self._arrays[name].location)

    def keys(self):
        return self._arrays.keys()

    def __iter__(self):
        return iter(self._arrays)

    def __len__(self):
        return len(self._arrays)

    def __contains__(self, name):
        return name in self._arrays

    def __dir__(self):
        return [*super().__dir__(), *self._arrays]

    def __repr__(self):
        shapes = (f"{name} {'x'.join(map(str, array.shape[:array.rank]))}"
                  for name, array in self._arrays.items())
        return f"<mimetra.{type(self).__name__} {self.name!r}: {', '.join(shapes)}>"


class Sequence(Data):
    """Poses of one mesh: positions F x N x 3, times F (seconds), rest N x 3, faces; and fields:
    `on_vertices` {name: N or N x c}, `on_triangles` {name: T or T x c}.

    `faces` are triangles T x 3, quads P x 4, a list of polygons, or the `.faces` of another value.
    """

    kind = c.SEQUENCE

    def __init__(self, positions, faces, times=None, rest=None, on_vertices=None,
                 on_triangles=None, name=""):
        fields = [(field, _Field(values, location))
                  for values_by_name, location in ((on_vertices, c.ON_VERTICES),
                                                   (on_triangles, c.ON_TRIANGLES))
                  for field, values in (values_by_name or {}).items()]
        self._make(name, {"positions": positions, **_faces(faces), "times": times, "rest": rest},
                   fields=fields)


class Model(Data):
    """A mesh with expressions: neutral N x 3, expressions D x N x 3 (displacements), their names.

    It may have identities I x N x 3 (displacements) besides, and perform by weights F x W at times
    F (seconds). `landmarks` L x 2 are pairs of a landmark's number and its vertex. Without
    expressions it is a mesh; with identities it stands for its mean where one person is wanted.
    """

    kind = c.MODEL

    def __init__(self, neutral, faces, expressions=None, expression_names=None, identities=None,
                 identity_names=None, weights=None, weight_names=None, times=None, landmarks=None,
                 name=""):
        self._make(name, {"neutral": neutral, **_faces(faces), "expressions": expressions,
                          "expression_names": expression_names, "identities": identities,
                          "identity_names": identity_names, "weights": weights,
                          "weight_names": weight_names, "times": times, "landmarks": landmarks})


class Components(Data):
    """Sparse components: displacements K x N x 3, centers K, weights F x K, support K x N."""

    kind = c.COMPONENTS

    def __init__(self, rest, triangles, displacements, centers, weights=None, support=None,
                 name=""):
        self._make(name, {"rest": rest, "triangles": triangles,
                          "displacements": displacements, "weights": weights,
                          "centers": centers, "support": support})


class Regions(Data):
    """Vertex sets: masks R x N, of booleans or 0 and 1."""

    kind = c.REGIONS

    def __init__(self, masks, faces, name=""):
        self._make(name, {"masks": masks, **_faces(faces)})


class Table(Data):
    """Columns {name: R}; NaN is an empty cell."""

    kind = c.TABLE

    def __init__(self, columns, name=""):
        self._make(name, columns, {})


class Landmarks(Data):
    """Points F x L x 2 in pixels, y down, NaN where not seen; their names, times, confidence."""

    kind = c.LANDMARKS

    def __init__(self, points, names, times=None, confidence=None, name=""):
        self._make(name, {"points": points, "names": names, "times": times,
                          "confidence": confidence})


class Fit(Data):
    """Fitted coefficients: alpha F x I, beta F x D, cameras F x 2 x 4, rms F."""

    kind = c.FIT


class Pictures(Data):
    """Pixels height x width x 3, uint8, sRGB, from the top left; of several pictures `pixels_0`,
    `pixels_1`, ...
    """

    kind = c.PICTURES

    def __init__(self, pixels, name=""):
        self._make(name, {"pixels": pixels})

    def _repr_png_(self):
        """PNG for notebooks; the first one of several pictures."""
        return _png(self[next(iter(self))])


class Document(Data):
    """A text that stands for itself, such as a page or a script."""

    kind = c.DOCUMENT

    def __init__(self, text, name=""):
        self._make(name, {"text": [text]})


CLASSES = {each.kind: each for each in Data.__subclasses__()}


def _png(pixels):
    """PNG file of pixels, height x width x 3."""
    height, width, _ = pixels.shape
    rows = np.zeros((height, 1 + 3 * width), np.uint8)  # each row begins with its filter type: none
    rows[:, 1:] = pixels.reshape(height, -1)

    def chunk(name, content):
        return (struct.pack(">I", len(content)) + name + content
                + struct.pack(">I", zlib.crc32(name + content)))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)  # 8 bits, RGB
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
            + chunk(b"IDAT", zlib.compress(rows.tobytes())) + chunk(b"IEND", b""))


def of_handle(handle):
    """Value of the library, in the class of its kind."""
    return CLASSES[library.data_kind(handle)]._of_handle(handle)


class _View:
    """Gives NumPy the memory of a value, and keeps the value alive while NumPy uses it."""

    def __init__(self, data, address, shape, dtype):
        self.data = data
        self.__array_interface__ = {"version": 3, "data": (address, True), "shape": shape,
                                    "typestr": np.dtype(dtype).str}


class _Field(NamedTuple):
    """Values of a field, and their location."""

    values: object
    location: int


def _faces(faces):
    """Arrays of faces, from any accepted form."""
    if isinstance(faces, Faces):
        return {"face_sizes": faces.sizes, "corners": faces.corners}
    if isinstance(faces, np.ndarray) and faces.ndim == 2 and faces.shape[1] == 3:
        return {"triangles": faces}
    if not np.iterable(faces):
        raise UsageError(f"faces: expected triangles T x 3 or a list of polygons, found {faces!r}")
    polygons = [np.asarray(polygon) for polygon in faces]
    if any(polygon.ndim != 1 for polygon in polygons):
        raise UsageError("faces: expected a list of polygons, each a list of vertices")
    return {"face_sizes": [len(polygon) for polygon in polygons],
            "corners": np.concatenate(polygons) if polygons else []}


def _integers(array, name):
    if array.size and array.dtype.kind not in "iu":
        raise UsageError(f"array '{name}': expected integers, found {array.dtype}")
    limits = np.iinfo(np.int32)
    if array.size and (array.min() < limits.min or array.max() > limits.max):
        raise UsageError(f"array '{name}': expected integers of 32 bits, found {array.min()} to"
                         f" {array.max()}")
    return array.astype(np.int32, copy=False)


def _bytes(array, name):
    if array.dtype not in (np.bool_, np.uint8):
        raise UsageError(f"array '{name}': expected booleans or uint8, found {array.dtype}")
    return array.view(np.uint8)


def _floats(array, name):
    if array.dtype.kind not in "biuf":
        raise UsageError(f"array '{name}': expected numbers, found {array.dtype}")
    return array if array.dtype == np.float32 else array.astype(np.float64, copy=False)


def _unmasked(values):
    """Array with NaN for masked values."""
    if isinstance(values, (list, tuple)) and any(map(np.ma.isMaskedArray, values)):
        values = np.ma.array(values)
    if np.ma.is_masked(values):
        values = values.astype(np.float64).filled(np.nan)
    return np.asarray(values)


def _taken(values, type, name):
    """Array that the library accepts, and the number of its type."""
    if type in (c.I32, c.U8) and np.ma.is_masked(values):
        raise UsageError(f"array '{name}': is masked, and whole numbers have nothing for what is"
                         " hidden; give all of it")
    try:
        array = _unmasked(values)
    except ValueError as error:
        raise UsageError(f"array '{name}': {error}") from None
    if not 1 <= array.ndim <= 4:
        raise UsageError(f"array '{name}': expected 1 to 4 dimensions, found {array.ndim}")
    convert = {c.I32: _integers, c.U8: _bytes}.get(type, _floats)
    array = np.ascontiguousarray(convert(array, name))
    return array, next(known for known, dtype in _DTYPES.items() if array.dtype == dtype)


def _described(name, values, type):
    """Struct that describes an array to the library, and the memory that must live as long."""
    shown = c.Array(name=name.encode(), type=type)
    if isinstance(values, _Field):
        shown.location = values.location
        values = _unmasked(values.values)
        type = c.I32 if values.dtype.kind in "biu" else c.F64
        values = values.astype(np.int32) if values.dtype == bool else values
    if type == c.STRING:
        kept = (ctypes.c_char_p * len(values))(*(str(text).encode() for text in values))
        shown.rank, shown.shape[0] = 1, len(values)
        shown.values = ctypes.cast(kept, ctypes.c_void_p)
    else:
        kept, shown.type = _taken(values, type, name)
        shown.rank = kept.ndim
        shown.shape[:kept.ndim] = kept.shape
        shown.values = kept.ctypes.data
    return shown, kept


def _given(arrays, types):
    """List of arrays for the library, and the memory that must live as long."""
    described = [_described(name, values, types.get(name, c.F64))
                 for name, values in arrays if values is not None]
    pointers = [ctypes.pointer(shown) for shown, _ in described]
    given = (ctypes.POINTER(c.Array) * (len(pointers) + 1))(*pointers)
    return given, described


def text_of(value):
    """Value of a parameter, as the command writes it."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (list, tuple, range, np.ndarray)):
        return ",".join(text_of(each) for each in value)
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    raise UsageError(f"expected a number, text, path or list of them, found {value!r}")


def _settings(settings):
    texts = [f"{name.replace('_', '-')}={text_of(value)}".encode()
             for name, value in settings.items() if value is not None]
    return (ctypes.c_char_p * (len(texts) + 1))(*texts)
