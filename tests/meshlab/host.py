"""What the tests of the MeshLab plugin share: the command's results, and meshlabserver's."""

import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

SAMPLES = pathlib.Path(__file__).parents[2] / "samples"
FRAMES = "0:120:10"
SELECTED = 0x20  # of MeshLab's flags of vertices and faces
OPERATIONS = {"Geodesic Support Map": "geodesic", "Regions of Interest": "regions",
              "Region Transfer": "transfer"}
# Made of the table alone.
OF_LAYERS = ["mimetra Info", "mimetra Check", "mimetra Align", "mimetra Decompose",
             "mimetra Evaluate", "mimetra Convert"]
SHOWN = ["sequence", "regions", "table"]
OF_FIELDS = ["speed"]
MOST_ROWS = 8
INPUTS = {"regions": ["sequence"], "transfer": ["source", "target"]}
FIRST = {"regions": ["k", "radius", "region", "coverage"],
         "transfer": ["k", "radius", "coverage", "full", "space", "source-rest"]}
READING = ["weights", "weight-scale", "topology", "frames", "fps"]
OF_FILES = [*READING, "format", "double", "single", "compress"]
PLY_TYPES = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4",
             "float": "f4", "double": "f8"}


def mimetra(*arguments):
    """Runs the command; what it prints on standard output."""
    done = subprocess.run([os.environ["MIMETRA"], *map(str, arguments)], check=True,
                          capture_output=True, text=True)
    return done.stdout


def operations():
    return {operation["name"]: operation
            for operation in json.loads(mimetra("operations", "--json"))["operations"]}


def text_of(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return ",".join(map(str, value))
    return "" if value is None else str(value)


def operation_of(filter):
    """What the table holds for a filter."""
    name = OPERATIONS.get(filter, filter.removeprefix("mimetra ").lower().replace(" ", "-"))
    return operations()[name]


def rows_of_layers(operation):
    """Paths of what is needed, the choice of a field, parameters, and everything else."""
    files = [input["name"] for input in operation["inputs"] if not input["optional"]]
    made = [output for output in operation.get("outputs", []) if not output["optional"]]
    files += [output["name"] for output in made if output["kind"] not in SHOWN]
    files += ["Field"] * (operation["name"] in OF_FIELDS)
    own = [parameter for parameter in operation["parameters"] if parameter["name"] not in OF_FILES]
    return [*[(name, "RichString", "") for name in files], *map(row_of, own[:MOST_ROWS]),
            ("Manifest", "RichString", ""), ("options", "RichString", "")]


def rows_of(filter):
    """The rows of a filter's dialog as (name, type, default), as the table declares them."""
    operation = operation_of(filter)
    if filter not in OPERATIONS:
        return rows_of_layers(operation)
    if operation["name"] == "geodesic":
        return [("source", "RichString", ""), ("quality", "RichEnum", "0"),
                *[row_of(parameter) for parameter in operation["parameters"]
                  if parameter["name"] not in ["source", *OF_FILES]]]
    rows = [(name, "RichString", "") for name in INPUTS[operation["name"]]]
    by_name = {parameter["name"]: parameter for parameter in operation["parameters"]}
    rows += [row_of(by_name[name]) for name in FIRST[operation["name"]]]
    return [*rows, ("options", "RichString", "")]


def row_of(parameter):
    kinds = {"flag": "RichBool", "integer": "RichInt", "number": "RichFloat", "choice": "RichEnum"}
    default = parameter["default"]
    kind = "RichString" if default is None else kinds.get(parameter["kind"], "RichString")
    if kind == "RichEnum":
        default = parameter["choices"].index(default)
    return parameter["name"], kind, text_of(default)


def filter_script(filter, **values):
    """A filter of a script. All rows must be there: MeshLab's assertions fail without."""
    element = ElementTree.Element("filter", name=filter)
    if filter not in OPERATIONS and not filter.startswith("mimetra "):
        for name, value in values.items():
            ElementTree.SubElement(element, "Param", name=name, type="RichString", value=value)
        return element
    rows = rows_of(filter)
    values = {name.replace("_", "-"): value for name, value in values.items()}
    assert set(values) <= {row[0] for row in rows}, values
    for name, kind, default in rows:
        value = text_of(values.get(name, default))
        ElementTree.SubElement(element, "Param", name=name, type=kind, value=value,
                               enum_cardinality="0")
    return element


def write_ply(path, points, faces):
    lines = ["ply", "format ascii 1.0", f"element vertex {len(points)}", "property float x",
             "property float y", "property float z", f"element face {len(faces)}",
             "property list uchar int vertex_indices", "end_header"]
    # The command reads all digits, MeshLab what fits into single precision: only such numbers.
    lines += [" ".join(repr(float(np.float32(x))) for x in point) for point in points]
    lines += [" ".join(map(str, [len(face), *face])) for face in faces]
    path.parent.mkdir(exist_ok=True)
    path.write_text("\n".join(lines) + "\n")
    return path


class Ply:
    """Vertices and faces of a binary PLY file."""

    def __init__(self, path):
        content = pathlib.Path(path).read_bytes()
        header, self.rest = content.split(b"end_header\n", 1)
        lines = [line.split() for line in header.decode().splitlines()]
        self.vertices = self.faces = None
        for i, line in enumerate(lines):
            if line[:2] == ["element", "vertex"]:
                self.read_vertices(int(line[2]), self.properties(lines[i + 1:]))
            if line[:2] == ["element", "face"]:
                self.read_faces(int(line[2]), self.properties(lines[i + 1:]))

    @staticmethod
    def properties(lines):
        count = next((i for i, line in enumerate(lines) if line[0] != "property"), len(lines))
        return [line[1:] for line in lines[:count]]

    def read_vertices(self, count, properties):
        kind = np.dtype([(name, "<" + PLY_TYPES[type]) for type, name in properties])
        self.vertices = np.frombuffer(self.rest, kind, count)
        self.rest = self.rest[kind.itemsize * count:]
        self.points = np.stack([self.vertices[axis] for axis in "xyz"], axis=1)

    def read_faces(self, count, properties):
        """Triangles, and their flags where they have some."""
        flags = [("flags", "<i4")] if ["int", "flags"] in properties else []
        kind = np.dtype([("size", "u1"), ("corners", "<i4", 3), *flags])
        self.faces = np.frombuffer(self.rest, kind, count)


class MeshLab:
    """A private copy of meshlabserver with the plugin."""

    def __init__(self, folder):
        libraries = pathlib.Path(os.environ["MESHLAB_LIBRARIES"])
        server = pathlib.Path(os.environ["MESHLABSERVER"])
        self.home = folder / "home"
        self.home.mkdir()
        # The server looks for its libraries beside its own folder, as they are installed.
        place = folder / "host" / libraries.relative_to(server.parent.parent)
        self.server = folder / "host" / "bin" / server.name
        self.server.parent.mkdir(parents=True)
        shutil.copy(server, self.server)
        (place / "plugins").mkdir(parents=True)
        shutil.copy(libraries / "libmeshlab-common.so", place)
        # PLY files, and selecting vertices; all of MeshLab's plugins take long to load.
        for plugin in ["libio_base.so", "libfilter_func.so"]:
            shutil.copy(libraries / "plugins" / plugin, place / "plugins")
        shutil.copy(os.environ["MIMETRA_PLUGIN"], place / "plugins")

    def run(self, *arguments):
        environment = {**os.environ, "HOME": str(self.home), "XDG_RUNTIME_DIR": str(self.home)}
        return subprocess.run([self.server, *map(str, arguments)], capture_output=True, text=True,
                              env=environment)


class HostTest(unittest.TestCase):
    """The built-in sample as a take of PLY files and a target, and MeshLab."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="mimetra_meshlab_")
        cls.path = pathlib.Path(cls.folder.name)
        cls.meshlab = MeshLab(cls.path)
        cls.head = cls.path / "head"
        mimetra("sample", "-o", cls.head)
        mimetra("convert", f"{cls.head}@identity001=1", "--weights", cls.head / "performance.csv",
                "--frames", FRAMES, "-o", cls.path / "take/")
        # Layers do not know the rest pose that `convert` keeps beside the folder.
        cls.rest = (cls.path / "take.rest.ply").rename(cls.path / "neutral.ply")
        (cls.path / "take.times.csv").unlink()  # layers have no times
        cls.take = sorted((cls.path / "take").glob("*.ply"))
        cls.model = f"{cls.head}@identity002=1"
        cls.target = cls.path / "target.ply"
        mimetra("convert", cls.model, "-o", cls.target)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def serve(self, layers, filters, outputs=()):
        """Opens files as layers, applies filters, writes layers: (path, number, what of it)."""
        written = []
        for name, layer, mask in outputs:
            of_it = ["-m", *mask.split()] if mask else []
            written += ["-o", self.path / name, "-l", layer, *of_it]
        return self.meshlab.run("-i", *layers, "-s", self.script_of(filters), *written)

    def script_of(self, filters):
        script = ElementTree.Element("FilterScript")
        script.extend(filters)
        path = self.path / "script.mlx"
        path.write_bytes(b"<!DOCTYPE FilterScript>\n" + ElementTree.tostring(script))
        return path

    def apply(self, layers, filters, outputs):
        """The written layers of a run that must go well."""
        done = self.serve(layers, filters, outputs)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return [Ply(self.path / name) for name, _, _ in outputs]

    def new_layers(self, layers, script, count):
        """The layers that come after those that were opened."""
        return self.apply(layers, [script],
                          [(f"new{i}.ply", len(layers) + i, "") for i in range(count)])

    def log(self, layers, *filters):
        """What a run that must go well prints."""
        done = self.serve(layers, filters)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def assert_refused(self, layers, filters, words):
        """The filter fails with these words, and the program goes on to its end."""
        done = self.serve(layers, filters)
        self.assertEqual(done.returncode, 255, done.stdout + done.stderr)
        self.assertIn(words, done.stdout)
        self.assertIn("Problem with filter", done.stdout)

    def assert_same(self, found, expected, what=""):
        """Equal bit for bit, and of one type."""
        self.assertEqual(found.dtype, expected.dtype, what)
        self.assertEqual(found.shape, expected.shape, what)
        self.assertEqual(found.tobytes(), expected.tobytes(), what)


class Fields:
    """What the command writes as .vtp."""

    def __init__(self, path):
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(path))
        reader.Update()
        self.mesh = reader.GetOutput()

    def on_vertices(self, name):
        return vtk_to_numpy(self.mesh.GetPointData().GetArray(name))
