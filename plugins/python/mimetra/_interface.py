"""The structs and functions of mimetra.h in ctypes, and the search for the library."""

import ctypes
import os
import pathlib
import sys
import weakref
from ctypes import CFUNCTYPE, POINTER, c_char_p, c_double, c_int32, c_int64, c_uint32, c_void_p

VERSION = 1
SEQUENCE, MODEL, COMPONENTS, REGIONS, TABLE, LANDMARKS, FIT, PICTURES, DOCUMENT = range(1, 10)
FLAG, INTEGER, INTEGER_LIST, NUMBER, LENGTH, CHOICE, TEXT, FILE = range(1, 9)
F64, F32, I32, U8, STRING = range(1, 6)
ON_VERTICES, ON_TRIANGLES = 1, 2
READING, WRITING = 1, 2
OPTIONAL, REPEATED, NAMED, WITH_FIELDS = 1, 2, 4, 8
WARNING = 1


class Struct(ctypes.Structure):
    """A struct that begins with its size."""

    def __init__(self, **values):
        super().__init__(struct_size=ctypes.sizeof(self), **values)


class Array(Struct):
    _fields_ = [("struct_size", c_uint32), ("type", c_int32), ("rank", c_int32),
                ("location", c_int32), ("shape", c_int64 * 4), ("name", c_char_p),
                ("values", c_void_p)]


class Port(Struct):
    _fields_ = [("struct_size", c_uint32), ("kind", c_int32), ("name", c_char_p),
                ("help", c_char_p), ("flags", c_uint32), ("reserved", c_uint32)]


class Parameter(Struct):
    _fields_ = [("struct_size", c_uint32), ("kind", c_int32), ("name", c_char_p),
                ("help", c_char_p), ("fallback", c_char_p), ("unit", c_char_p),
                ("minimum", c_double), ("maximum", c_double), ("choices", POINTER(c_char_p)),
                ("of_files", c_uint32), ("reserved", c_uint32)]


class Operation(Struct):
    _fields_ = [("struct_size", c_uint32), ("reserved", c_uint32), ("name", c_char_p),
                ("summary", c_char_p), ("inputs", POINTER(POINTER(Port))),
                ("outputs", POINTER(POINTER(Port))),
                ("parameters", POINTER(POINTER(Parameter))), ("examples", POINTER(c_char_p)),
                ("run", c_void_p), ("user", c_void_p)]


class Format(Struct):
    _fields_ = [("struct_size", c_uint32), ("kind", c_int32), ("name", c_char_p),
                ("extensions", POINTER(c_char_p)), ("parameters", POINTER(POINTER(Parameter))),
                ("read", c_void_p), ("write", c_void_p), ("user", c_void_p),
                ("flags", c_uint32), ("use", c_uint32)]


Progress = CFUNCTYPE(c_int32, c_double, c_void_p)
Log = CFUNCTYPE(None, c_int32, c_char_p, c_void_p)

_ARRAYS = POINTER(POINTER(Array))
_TEXTS = POINTER(c_char_p)
_HANDLE = POINTER(c_void_p)


def _function(result, *arguments):
    return CFUNCTYPE(result, *arguments)


class Interface(ctypes.Structure):
    """Table of functions. This module does not call the functions for operations written in C."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("version", c_uint32),
        ("toolkit_version", c_char_p),
        ("new_context", _function(c_int32, Log, c_void_p, _HANDLE)),
        ("free_context", _function(None, c_void_p)),
        ("message", _function(c_char_p, c_void_p)),
        ("set_progress", _function(c_int32, c_void_p, Progress, c_void_p)),
        ("set_threads", _function(c_int32, c_void_p, c_int32)),
        ("operations", _function(POINTER(POINTER(Operation)), c_void_p)),
        ("find_operation", _function(POINTER(Operation), c_void_p, c_char_p)),
        ("operations_json", _function(c_int32, c_void_p, _TEXTS)),
        ("new_data", _function(c_int32, c_void_p, c_int32, c_char_p, _ARRAYS, _HANDLE)),
        ("derive_data", _function(c_int32, c_void_p, c_void_p, _ARRAYS, _HANDLE)),
        ("load_data", _function(c_int32, c_void_p, c_int32, c_char_p, _TEXTS, _HANDLE)),
        ("save_data", _function(c_int32, c_void_p, c_void_p, c_char_p, _TEXTS)),
        ("free_data", _function(None, c_void_p)),
        ("data_kind", _function(c_int32, c_void_p)),
        ("data_name", _function(c_char_p, c_void_p)),
        ("data_arrays", _function(c_int32, c_void_p, c_void_p, POINTER(_ARRAYS))),
        ("data_array", _function(c_int32, c_void_p, c_void_p, c_char_p, _ARRAYS)),
        ("data_json", _function(c_int32, c_void_p, c_void_p, _TEXTS)),
        ("new_call", _function(c_int32, c_void_p, c_char_p, _HANDLE)),
        ("free_call", _function(None, c_void_p)),
        ("call_set", _function(c_int32, c_void_p, c_char_p, c_char_p)),
        ("call_give", _function(c_int32, c_void_p, c_char_p, c_void_p)),
        ("call_read", _function(c_int32, c_void_p, c_char_p, c_char_p)),
        ("call_want", _function(c_int32, c_void_p, c_char_p)),
        ("call_write", _function(c_int32, c_void_p, c_char_p, c_char_p, c_int32)),
        ("call_run", _function(c_int32, c_void_p)),
        ("call_output_count", _function(c_int32, c_void_p, c_char_p)),
        ("call_output", _function(c_int32, c_void_p, c_char_p, c_int32, _HANDLE)),
        ("call_report", _function(c_char_p, c_void_p)),
        ("call_summary", _function(c_char_p, c_void_p)),
        *[(name, c_void_p) for name in (
            "job_context", "job_input", "job_number", "job_text", "job_threads", "job_wants",
            "job_progress", "job_log", "job_fail", "job_output", "job_report")],
        ("formats", _function(POINTER(POINTER(Format)), c_void_p)),
    ]


def listed(pointers):
    """Entries of a list that ends with NULL; none for NULL."""
    entries = []
    while pointers and pointers[len(entries)]:
        entries.append(pointers[len(entries)])
    return entries


def free_with(owner, free, handle):
    """Frees a handle when its owner is deleted, but not when the interpreter ends. Until the
    process ends, arrays may view a value, and threads may be inside a context."""
    weakref.finalize(owner, free, handle).atexit = False


# The library that draws is preferred if it exists and finds VTK. Blender draws by itself.
_NAMES = ("libmimetra_pictures.so", "libmimetra_c.so")
if "bpy" in sys.modules:
    _NAMES = _NAMES[1:]


def _places():
    """Paths to try, in order: as the environment says, beside this module, in its installation, in
    the system."""
    named = os.environ.get("MIMETRA_LIBRARY")
    if named:
        return [named]
    here = pathlib.Path(__file__).resolve().parent
    places = [here / name for name in _NAMES]
    # Without a path, the loader takes the build of the system's library for the processor.
    installed = [] if here.is_relative_to("/usr/lib") else here.parents[:4]
    for name in _NAMES:
        for folder in installed:
            places += [folder / name, *sorted(folder.glob(f"*-linux-*/{name}"))]
    return ([str(place) for place in places if place.exists()]
            or [f"{name}.1" for name in _NAMES])


def _loaded():
    """First library that can be loaded, and its path."""
    for place in _places():
        try:
            return ctypes.CDLL(place), place
        except OSError as error:
            failure = error
    raise ImportError(f"{failure}; set MIMETRA_LIBRARY to the path of libmimetra_c.so")


def load():
    """Table of functions. Throws ImportError if there is no library, or if it is too old."""
    library, place = _loaded()
    library.mimetra_get_interface.restype = POINTER(Interface)
    library.mimetra_get_interface.argtypes = [c_uint32]
    table = library.mimetra_get_interface(VERSION)
    if not table or table.contents.struct_size < ctypes.sizeof(Interface):
        raise ImportError(f"{place}: expected a library that serves version {VERSION} of mimetra.h"
                          " as this module knows it; install both from one release")
    return table.contents
