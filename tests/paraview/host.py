"""What the tests of the ParaView plugin share: the command's results, and ParaView's."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkPoints, vtkStringOutputWindow
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkAppendPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

FRAMES = "0:120:10"


def mimetra(*arguments):
    """Runs the command; what it prints on standard output."""
    done = subprocess.run([os.environ["MIMETRA"], *map(str, arguments)], check=True,
                          capture_output=True, text=True)
    return done.stdout


def environment_of_its_own(**more):
    """For a program that is no process of the server that this test may run on."""
    kept = {name: value for name, value in os.environ.items()
            if not name.startswith(("OMPI_", "PMIX_", "PMI_"))}
    return {**kept, **more}


class Messages:
    """What ParaView shows in its output window, as long as the block lasts."""

    def __enter__(self):
        self.before = vtkOutputWindow.GetInstance()
        self.window = vtkStringOutputWindow()
        vtkOutputWindow.SetInstance(self.window)
        return self

    def __exit__(self, *_):
        vtkOutputWindow.SetInstance(self.before)

    @property
    def text(self):
        return self.window.GetOutput()


class Sample:
    """The built-in sample in a folder of its own, made once for all tests of a file."""

    def __init__(self):
        self.folder = tempfile.TemporaryDirectory(prefix="mimetra_paraview_")
        self.path = pathlib.Path(self.folder.name)
        self.head = self.path / "head"
        mimetra("sample", "-o", self.head)
        self.take = self.path / "take.npy"
        self.weights = self.head / "performance.csv"
        mimetra("convert", f"{self.head}@identity001=1", "--weights", self.weights, "--frames",
                FRAMES, "-o", self.take)

    def __truediv__(self, name):
        return self.path / name


def at(proxy, time=None, port=0):
    """The data of a source or filter at a time."""
    proxy.UpdatePipeline(*([] if time is None else [time]))
    data = proxy.GetClientSideObject().GetOutputDataObject(port)
    kept = data.NewInstance()
    kept.ShallowCopy(data)
    return kept


def points(mesh):
    return vtk_to_numpy(mesh.GetPoints().GetData())


def point_array(mesh, name):
    return vtk_to_numpy(mesh.GetPointData().GetArray(name))


def cell_array(mesh, name):
    return vtk_to_numpy(mesh.GetCellData().GetArray(name))


def polygons(mesh):
    return (vtk_to_numpy(mesh.GetPolys().GetOffsetsArray()),
            vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()))


def column(table, name):
    return vtk_to_numpy(table.GetColumnByName(name))


def decompositions(proxy):
    proxy.UpdatePropertyInformation()
    return proxy.GetProperty("Decompositions").GetElement(0)


def mesh_of(positions, cells):
    mesh = vtkPolyData()
    points = vtkPoints()
    points.SetData(numpy_to_vtk(positions, deep=True))
    mesh.SetPoints(points)
    array = vtkCellArray()
    for cell in cells:
        array.InsertNextCell(len(cell), cell)
    mesh.SetPolys(array)
    return mesh


def grid(size=6):
    """Positions and quads of a square."""
    rows, columns = np.mgrid[0:size, 0:size]
    positions = np.stack([columns.ravel(), rows.ravel(), 0 * rows.ravel()], axis=1).astype(float)
    first = (rows[:-1, :-1] * size + columns[:-1, :-1]).ravel()
    return positions, [[int(v), int(v) + 1, int(v) + size + 1, int(v) + size] for v in first]


def moving(frames=4, size=6):
    """A bump that goes over the square."""
    positions, quads = grid(size)
    bumps = [np.exp(-((positions - [f, 2, 0])**2).sum(1))[:, None] for f in range(frames)]
    return [mesh_of(positions + [0, 0, 1] * bump, quads) for bump in bumps]


def numbered(source):
    """With global ids of points and cells, in the order that one process knows, which are also the
    point data `number`, because blocks lose their ids if they are put together."""
    named = simple.GenerateGlobalIds(Input=source)
    return simple.Calculator(Input=named, Function="GlobalPointIds", ResultArrayName="number")


def distributed(source):
    return simple.ExtractSurface(Input=simple.RedistributeDataSet(Input=source))


def with_ghosts(source):
    return simple.GhostCellsGenerator(Input=distributed(source), BuildIfRequired=0,
                                      MinimumNumberOfGhosts=2)


def in_one(blocks):
    together = vtkAppendPolyData()
    leaves = blocks.NewIterator()
    while not leaves.IsDoneWithTraversal():
        together.AddInputData(leaves.GetCurrentDataObject())
        leaves.GoToNextItem()
    together.Update()
    return together.GetOutput()


def fetched(proxy, time=0):
    """The pieces of all processes, one after the other."""
    proxy.UpdatePipeline(time)
    data = servermanager.Fetch(proxy)
    return in_one(data) if data.IsA("vtkCompositeDataSet") else data


def write_mesh(path, mesh):
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(mesh)
    writer.SetDataModeToBinary()  # newer versions of libexpat let VTK read no appended data
    writer.Write()


def run_tests():
    """As unittest.main(), but what passes ends as scripts do: processes of a server end together."""
    if not unittest.main(exit=False).result.wasSuccessful():
        sys.exit(1)


class HostTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.sample = Sample()

    @classmethod
    def tearDownClass(cls):
        cls.sample.folder.cleanup()

    def tearDown(self):
        for source in reversed(list(simple.GetSources().values())):
            simple.Delete(source)

    def series_of(self, name, meshes):
        """A .pvd of meshes at the times 0, 1, ..."""
        entries = ""
        for i, mesh in enumerate(meshes):
            write_mesh(self.sample / f"{name}_{i}.vtp", mesh)
            entries += f'<DataSet timestep="{i}" part="0" file="{name}_{i}.vtp"/>'
        pvd = self.sample / f"{name}.pvd"
        pvd.write_text(f'<VTKFile type="Collection"><Collection>{entries}</Collection></VTKFile>')
        return simple.PVDReader(FileName=str(pvd))

    def assert_table(self, table, rows):
        """The rows of a CSV file, whose times are what charts know as Time."""
        self.assertEqual(table.GetNumberOfColumns(), len(rows[0]))
        for name in rows[0]:
            self.assert_same(column(table, "Time" if name == "time" else name),
                             np.array([float(row[name]) for row in rows]), name)

    def by_id(self, values, ids, count):
        """In the order of ids; what several processes have, they have alike."""
        unique, first, which = np.unique(ids, return_index=True, return_inverse=True)
        self.assertEqual(list(unique), list(range(count)))
        self.assertEqual(values.tobytes(), values[first][which].tobytes())
        return values[first]

    def assert_same(self, found, expected, what=""):
        """Equal bit for bit: NaN too, and of one type."""
        self.assertEqual(found.dtype, expected.dtype, what)
        self.assertEqual(found.shape, expected.shape, what)
        self.assertEqual(found.tobytes(), expected.tobytes(), what)
