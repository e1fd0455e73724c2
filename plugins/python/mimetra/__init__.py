"""The operations of mimetra on NumPy arrays.

    import mimetra

    take = mimetra.Sequence(positions, triangles)          # F x N x 3, T x 3
    result = mimetra.transfer(take, "actor/", k=30)        # as `mimetra transfer take actor/ -k 30`
    result.out.positions                                   # F x vertices of the actor x 3

Each operation of the library's table is a function here, those of plugins too: `help(mimetra)`
lists them, `operations` describes them, and `formats` the files that they read and write. Inputs
are values (Sequence, Model, Components, Regions, Table, Landmarks, Fit, Pictures, Document) or what
the command takes as text, which is read from files; where a sequence or model is expected,
(positions, faces) is one. Pictures show themselves in notebooks. What the library logs goes to
logging.getLogger("mimetra"). Functions may be called from several threads at once.
"""

from ._context import library as _library
from ._data import (Components, Data, Document, Faces, Fit, Landmarks, Model, Pictures, Regions,
                    Sequence, Table)
from ._errors import BadInput, Cancelled, Error, Mismatch, OutputError, UsageError
from ._operations import (Format, Operation, Result, all_formats, all_operations, function_of,
                          function_name, python_name)

__version__ = _library.toolkit_version.decode()
operations = all_operations()
formats = all_formats()
_functions = {function_name(name): function_of(operation)
              for name, operation in operations.items()}
__all__ = [
    "BadInput", "Cancelled", "Components", "Data", "Document", "Error", "Faces", "Fit", "Format",
    "Landmarks", "Mismatch", "Model", "Operation", "OutputError", "Pictures", "Regions", "Result",
    "Sequence", "Table", "UsageError", "formats", "operations", "run", *_functions]


def run(name, /, *inputs, **options):
    """Runs an operation by its name in the table."""
    if name not in operations:
        raise UsageError(f"no operation '{name}'; there are {', '.join(operations)}")
    return _functions[function_name(name)](*inputs, **options)


def __getattr__(name):
    missing = ("; pictures and pages need libmimetra_pictures.so beside libmimetra_c.so, and VTK"
               if name in ("render", "report") else "")
    raise AttributeError(f"module 'mimetra' has no attribute '{name}'{missing}")


globals().update({name: function for name, function in _functions.items()
                  if name not in globals()})
