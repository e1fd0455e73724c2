"""Filters in a pipeline: inputs that are switched, shared, or not readable; outputs in any order."""

import signal
import unittest

from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

from host import *

SECONDS_UNTIL_IT_HANGS = 120


class Continuous(VTKPythonAlgorithmBase):
    """A source of meshes at any time from 0 to 3."""

    def __init__(self):
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkPolyData")

    def RequestInformation(self, request, inputs, outputs):
        key = vtkStreamingDemandDrivenPipeline.TIME_RANGE()
        outputs.GetInformationObject(0).Set(key, [0, 3], 2)
        return 1

    def RequestData(self, request, inputs, outputs):
        vtkPolyData.GetData(outputs, 0).ShallowCopy(moving()[0])
        return 1


class Pipeline(HostTest):
    def setUp(self):
        # ParaView's loops do not return to Python; the signal ends the test all the same.
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        signal.alarm(SECONDS_UNTIL_IT_HANGS)
        self.addCleanup(signal.alarm, 0)

    def scaled(self, source, *scale):
        branch = simple.Transform(Input=source)
        branch.Transform = "Transform"
        branch.Transform.Scale = list(scale)
        return branch

    def still(self, size=6):
        source = simple.TrivialProducer()
        source.GetClientSideObject().SetOutput(mesh_of(*grid(size)))
        return source

    def two_branches(self, name, size=6):
        """Of one reader, which is newer than both, so that they changed at the same time."""
        source = self.series_of(name, moving(size=size))
        flat = self.scaled(source, 1, 1, 1)
        high = self.scaled(source, 1, 1, 3)
        for branch in [flat, high]:
            at(branch, 0)
        source.GetClientSideObject().Modified()
        return source, flat, high

    def transferred(self, source, target, times=range(4)):
        filter = simple.RegionTransfer(Input=source, Target=target, Full=1, Align="none")
        return [points(at(filter, time)) for time in times]

    def test_takes_another_branch_of_the_same_reader(self):
        _, flat, high = self.two_branches("branches")
        filter = simple.RegionsofInterest(Input=flat, K=3)
        moved = point_array(at(filter, 1), "displacement_length").max()
        filter.Input = high
        found = point_array(at(filter, 1), "displacement_length").max()
        np.testing.assert_allclose(found, 3 * moved, rtol=1e-6)

    def test_takes_a_smaller_branch_of_the_same_reader(self):
        source, flat, _ = self.two_branches("cut", size=20)
        clip = simple.Clip(Input=source, ClipType="Plane")
        clip.ClipType.Origin = [3.5, 0, 0]
        clip.ClipType.Normal = [1, 0, 0]
        small = simple.ExtractSurface(Input=clip)
        at(small, 0)
        source.GetClientSideObject().Modified()
        filter = simple.RegionsofInterest(Input=flat, K=3)
        at(filter, 1)
        filter.Input = small
        found, given = at(filter, 1), at(small, 1)
        self.assertLess(given.GetNumberOfPoints(), 400)
        self.assertEqual(len(point_array(found, "roi")), given.GetNumberOfPoints())
        self.assertEqual(len(cell_array(found, "in_L")), given.GetNumberOfCells())

    def test_takes_another_branch_as_the_target(self):
        source = self.series_of("source", moving())
        _, flat, high = self.two_branches("targets")
        filter = simple.RegionTransfer(Input=source, Target=flat, Full=1, Align="none")
        at(filter, 1)
        filter.Target = high
        self.assert_same(points(at(filter, 1)), self.transferred(source, high, [1])[0])

    def test_says_which_time_step_cannot_be_read(self):
        for i, mesh in enumerate(moving()):
            write_mesh(self.sample / f"lost_{i}.vtp", mesh)
        names = [str(self.sample / f"lost_{i}.vtp") for i in range(4)]
        series = simple.XMLPolyDataReader(FileName=names)
        series.UpdatePipelineInformation()
        os.remove(names[2])
        for name in ["RegionsofInterest", "SparseComponents"]:
            filter = getattr(simple, name)(Input=series, K=3)
            with self.subTest(filter=name), Messages() as messages:
                self.assertEqual(at(filter, 0).GetNumberOfCells(), 0)
                at(filter, 1)
                self.assertEqual(messages.text.count("time 2: cannot be read"), 1, messages.text)
        write_mesh(names[2], moving()[2])
        series.GetClientSideObject().Modified()
        self.assertEqual(len(point_array(at(simple.RegionsofInterest(Input=series, K=3), 0),
                                         "roi")), 36)

    def test_refuses_a_mesh_that_became_another_behind_its_back(self):
        series = self.series_of("replaced", moving())
        filter = simple.RegionsofInterest(Input=series, K=3)
        at(filter, 0)
        write_mesh(self.sample / "replaced_2.vtp", mesh_of(*grid(5)))
        with Messages() as messages:
            self.assertEqual(at(filter, 2).GetNumberOfPoints(), 0)
        self.assertIn("time 2: 25 vertices, expected 36 as at time 0", messages.text)

    def test_filters_after_region_transfer_see_its_time(self):
        write_mesh(self.sample / "still.vtp", mesh_of(*grid()))
        still = simple.mimetraSequence(FileName=str(self.sample / "still.vtp"))
        for target in [self.still(), still]:
            transfer = simple.RegionTransfer(Input=self.series_of("chain", moving()),
                                             Target=target, Full=1, Align="none")
            regions = simple.RegionsofInterest(Input=transfer, K=3)
            for time in [0, 1, 2, 3, 1]:
                shown = point_array(at(transfer, time), "displacement_length")
                self.assert_same(point_array(at(regions, time), "displacement_length"), shown)
            self.assertGreater(shown.max(), 0.5)

    def test_shows_the_same_mesh_where_the_table_is_asked_for_first(self):
        source = self.series_of("ports", moving())
        expected = self.transferred(source, self.still(), [2])[0]
        filter = simple.RegionTransfer(Input=source, Target=self.still(), Full=1, Align="none")
        self.assert_same(points(at(filter, 2)), expected)
        table = simple.PassArrays(Input=simple.OutputPort(filter, 1))
        filter.TriangleWeight = "area"
        filter.Align = "none"
        at(table, 2)
        self.assertEqual(points(at(filter, 2))[:, 2].argmax(), expected[:, 2].argmax())

    def test_is_its_own_target_whichever_time_is_shown_first(self):
        for first in [0, 3]:
            source = self.series_of("own", moving())
            shown = self.transferred(source, source, [first, 0, 1, 2, 3])[1:]
            for mesh, found in zip(moving(), shown, strict=True):
                np.testing.assert_allclose(found, points(mesh), atol=1e-9)

    def test_takes_a_branch_of_the_source_as_the_target(self):
        source = self.series_of("shared", moving())
        alone = self.scaled(self.series_of("alone", moving()), 2, 2, 2)
        branch = self.scaled(source, 2, 2, 2)
        expected = self.transferred(source, alone)
        for first in [0, 2, 3]:
            found = self.transferred(source, branch, [first, 0, 1, 2, 3])[1:]
            for mesh, same in zip(found, expected, strict=True):
                self.assert_same(mesh, same)

    def test_keeps_in_l_on_the_polygons_where_other_cells_come_and_go(self):
        meshes = moving()
        for frame, mesh in enumerate(meshes):
            vertices = vtkCellArray()
            for vertex in range(3 * frame):
                vertices.InsertNextCell(1, [vertex])
            mesh.SetVerts(vertices)
        filter = simple.RegionsofInterest(Input=self.series_of("verts", meshes), K=3)
        for time in [0, 1, 3, 0]:
            found = at(filter, time)
            in_l, roi = cell_array(found, "in_L"), point_array(found, "roi")
            self.assertEqual(list(in_l[:3 * time]), [0] * 3 * time)
            self.assertEqual(list(in_l[3 * time:]), [int(roi[quad].any()) for quad in grid()[1]])

    def test_asks_for_time_steps_where_the_input_is_continuous(self):
        source, filter = Continuous(), simple.RegionsofInterest(Input=self.still(), K=3)
        algorithm = filter.GetClientSideObject()
        algorithm.SetInputConnection(source.GetOutputPort())
        with Messages() as messages:
            algorithm.UpdateTimeStep(1)
        self.assertEqual(algorithm.GetOutputDataObject(0).GetNumberOfPoints(), 0)
        self.assertIn("expected time steps, found a range of time from 0 to 3; save it as a series "
                      "of files first", messages.text)



if __name__ == "__main__":
    run_tests()
