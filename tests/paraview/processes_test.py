"""Filters on a server of several processes: what one process gives, or a refusal, never else."""

import unittest

from paraview import servermanager

from host import *

ERROR = "ERR"


def largest_piece(proxy):
    """How many points of the mesh the process has that has most of them."""
    ids = point_array(fetched(simple.ProcessIdScalars(Input=proxy)), "ProcessId")
    return np.bincount(ids.astype(int)).max()


class Processes(HostTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.target = cls.sample / "target.ply"
        mimetra("convert", f"{cls.sample.head}@identity002=1", "-o", cls.target)

    def take(self):
        return simple.mimetraSequence(FileName=str(self.sample.take))

    def assert_as_alone(self, alone, shared, names=(), on_cells=(), times=(0, 3)):
        """The outputs of a filter of the whole take, and of pieces with ids."""
        for time in times:
            expected, found = fetched(alone, time), fetched(shared, time)
            ids, count = point_array(found, "number"), expected.GetNumberOfPoints()
            self.assert_same(self.by_id(points(found), ids, count), points(expected))
            for name in names:
                values = self.by_id(point_array(found, name), ids, count)
                self.assert_same(values, point_array(expected, name), name)
            for name in on_cells:
                values = self.by_id(cell_array(found, name), cell_array(found, "GlobalCellIds"),
                                    expected.GetNumberOfCells())
                self.assert_same(values, cell_array(expected, name), name)

    def assert_refused(self, filter, words, time=0):
        with Messages() as messages:
            self.assertEqual(fetched(filter, time).GetNumberOfPoints(), 0)
        self.assertIn(words, messages.text)
        self.assertEqual(messages.text.count(ERROR), 1, messages.text)

    def test_pieces_are_really_on_several_processes(self):
        whole = fetched(self.take()).GetNumberOfPoints()
        self.assertEqual(largest_piece(self.take()), whole)
        self.assertLess(largest_piece(distributed(self.take())), 0.9 * whole)

    def test_transferred_meshes_are_those_of_one_process(self):
        def still():
            return simple.mimetraSequence(FileName=str(self.target))
        alone = simple.RegionTransfer(Input=self.take(), Target=still(), K=5)
        shared = simple.RegionTransfer(Input=distributed(numbered(self.take())), K=5,
                                       Target=distributed(numbered(still())))
        self.assert_as_alone(alone, shared, ["region", "roi", "displacement"], ["in_L"])
        model = f"{self.sample.head}@identity002=1"
        alone = simple.RegionTransfer(Input=self.take(), TargetFile=model, K=5)
        shared = simple.RegionTransfer(Input=distributed(numbered(self.take())), K=5,
                                       TargetFile=model)
        self.assert_as_alone(alone, shared, ["roi"])
        expected, found = at(alone, port=1), at(shared, port=1)
        self.assertGreater(expected.GetNumberOfColumns(), 1)
        for i in range(expected.GetNumberOfColumns()):
            name = expected.GetColumnName(i)
            self.assert_same(column(found, name), column(expected, name), name)

    def test_components_are_those_of_one_process(self):
        alone = simple.SparseComponents(Input=self.take(), K=3)
        shared = simple.SparseComponents(Input=distributed(numbered(self.take())), K=3)
        for k in range(3):
            blocks = [simple.ExtractSurface(Input=simple.ExtractBlock(
                Input=each, Selectors=[f"/Root/component_{k}"])) for each in [alone, shared]]
            self.assert_as_alone(*blocks, ["support", "displacement"], times=[0])

    def test_aligned_meshes_are_those_of_one_process(self):
        alone = simple.mimetraAlign(Input=self.take())
        self.assert_as_alone(alone, simple.mimetraAlign(Input=distributed(numbered(self.take()))))

    def test_reports_and_tables_are_those_of_one_process(self):
        for name in ["mimetraInfo", "mimetraCheck"]:
            alone, shared = (getattr(simple, name)(Input=source)
                             for source in [self.take(), distributed(numbered(self.take()))])
            expected, found = fetched(alone), fetched(shared)
            self.assertGreater(expected.GetNumberOfRows(), 1)
            for row in range(expected.GetNumberOfRows()):
                self.assertEqual(found.GetValue(row, 1).ToString(),
                                 expected.GetValue(row, 1).ToString())
        alone, shared = (simple.mimetraEvaluate(Input=source, TargetFile=str(self.sample.head),
                                                K="3,5")
                         for source in [self.take(), distributed(numbered(self.take()))])
        expected, found = fetched(alone), fetched(shared)
        self.assertGreater(expected.GetNumberOfRows(), 0)
        for i in range(expected.GetNumberOfColumns()):
            name = expected.GetColumnName(i)
            for row in range(expected.GetNumberOfRows()):
                if "second" not in name:
                    self.assertEqual(found.GetValueByName(row, name).ToString(),
                                     expected.GetValueByName(row, name).ToString(), name)

    def test_filters_go_on_from_pieces_of_pieces(self):
        def chain(source):
            return simple.GeodesicDistance(Input=simple.RegionsofInterest(
                Input=simple.mimetraAlign(Input=source), K=3))
        self.assert_as_alone(chain(self.take()), chain(distributed(numbered(self.take()))),
                             ["distance", "region"])

    def test_a_target_without_global_ids_is_refused(self):
        bare = distributed(self.series_of("bare", moving(size=20)))
        take = distributed(numbered(self.take()))
        self.assert_refused(simple.RegionTransfer(Input=take, Target=bare, K=5),
                            "process 0 has a piece of the target without global ids; apply the "
                            "filter Generate Global Ids before distributing it")

    def test_the_rest_pose_goes_with_its_points(self):
        alone = simple.RegionsofInterest(Input=self.take(), K=5)
        # These ids count the points in another order than the file.
        late = simple.GenerateGlobalIds(Input=distributed(numbered(self.take())))
        shared = simple.RegionsofInterest(Input=late, K=5)
        if servermanager.ActiveConnection.GetNumberOfDataPartitions() > 2:
            # ParaView cuts the moving mesh elsewhere over time, and ids of its pieces are others.
            self.assert_refused(shared, "all time steps need the same faces")
            return
        again = simple.RegionsofInterest(Input=distributed(shared), K=5)
        for time in [0, 3]:
            expected = point_array(fetched(alone, time), "displacement")
            for filter in [shared, again]:
                found = fetched(filter, time)
                ids = point_array(found, "number").astype(int)
                self.assertEqual(len(np.unique(ids)), len(expected))
                self.assert_same(point_array(found, "displacement"), expected[ids])

    def test_a_rest_pose_that_stayed_behind_is_refused(self):
        meshes = moving(size=20)
        for mesh in meshes:
            rest = numpy_to_vtk(points(meshes[0]), deep=True)
            rest.SetName("mimetra_rest")
            mesh.GetFieldData().AddArray(rest)
        series = self.series_of("with_rest", meshes)
        self.assertGreater(fetched(simple.RegionsofInterest(Input=series, K=2)
                                   ).GetNumberOfPoints(), 0)
        for pieces in [distributed(simple.GenerateGlobalIds(Input=series)),
                       simple.GenerateGlobalIds(Input=distributed(series))]:
            self.assert_refused(simple.RegionsofInterest(Input=pieces, K=2),
                                "the rest pose of the mesh is field data (mimetra_rest)")

    def strips(self, steps, shown="time", held="True"):
        """Of each process a strip of a bump that goes along all, with global ids; `steps`, the
        time of what comes out and whether anything does are Python, of the process `p`."""
        source = simple.ProgrammableSource(OutputDataSetType="vtkPolyData")
        begin = ("from vtkmodules.vtkParallelCore import vtkMultiProcessController as Controller\n"
                 "p = Controller.GetGlobalController().GetLocalProcessId()\n"
                 "row = 5 * Controller.GetGlobalController().GetNumberOfProcesses() + 1\n"
                 "executive = self.GetExecutive()\n"
                 "out = executive.GetOutputInformation(0)\n")
        source.ScriptRequestInformation = begin + (
            "out.Set(self.CAN_HANDLE_PIECE_REQUEST(), 1)\n"
            "out.Remove(executive.TIME_STEPS())\n"
            "out.Remove(executive.TIME_RANGE())\n"
            f"steps = [float(step) for step in {steps}]\n"
            "for step in steps: out.Append(executive.TIME_STEPS(), step)\n"
            "if steps: out.Set(executive.TIME_RANGE(), [steps[0], steps[-1]], 2)\n")
        source.Script = begin + (
            "import numpy as np\n"
            "from vtkmodules.vtkCommonCore import vtkIdTypeArray, vtkPoints\n"
            "from vtkmodules.vtkCommonDataModel import vtkCellArray\n"
            "asked = executive.UPDATE_TIME_STEP()\n"
            "time = out.Get(asked) if out.Has(asked) else 0.0\n"
            "mesh = self.GetPolyDataOutput()\n"
            f"mesh.GetInformation().Set(mesh.DATA_TIME_STEP(), float({shown}))\n"
            f"if not ({held}): return\n"
            "points, quads = vtkPoints(), vtkCellArray()\n"
            "ids, cell_ids = vtkIdTypeArray(), vtkIdTypeArray()\n"
            "ids.SetName('ids')\n"
            "cell_ids.SetName('ids')\n"
            "for i in range(30):\n"
            "    ids.InsertNextValue(i // 6 * row + 5 * p + i % 6)\n"
            "    x, y = 5.0 * p + i % 6, float(i // 6)\n"
            "    points.InsertNextPoint(x, y, np.exp(-(x - 2 - time)**2 - (y - 2)**2))\n"
            "    if i % 6 == 5 or i >= 24: continue\n"
            "    quads.InsertNextCell(4, [i, i + 1, i + 7, i + 6])\n"
            "    cell_ids.InsertNextValue(ids.GetValue(i))\n"
            "mesh.SetPoints(points)\n"
            "mesh.SetPolys(quads)\n"
            "mesh.GetPointData().SetGlobalIds(ids)\n"
            "mesh.GetCellData().SetGlobalIds(cell_ids)\n")
        return source

    def test_pieces_of_different_times_are_refused(self):
        fits = fetched(simple.RegionsofInterest(Input=self.strips("range(4)"), K=2), 3)
        self.assertGreaterEqual(fits.GetNumberOfPoints(), 55)
        for steps in ["range(4 if p == 0 else 2)", "range(4 if p == 0 else 0)",
                      "[0, 1, 2 + p, 5]"]:
            filter = simple.RegionsofInterest(Input=self.strips(steps), K=2)
            self.assert_refused(filter,
                                "process 1: its time steps are not those of process 0")
            for time in [1, 0]:
                self.assertEqual(fetched(filter, time).GetNumberOfPoints(), 0)
        late = self.strips("range(4)", shown="time if p == 0 or time < 1 else 1")
        filter = simple.RegionsofInterest(Input=late, K=2)
        self.assert_refused(filter, "process 1 has a piece of time 1, others of time 2")
        for time in [2, 1, 3]:
            self.assertEqual(fetched(filter, time).GetNumberOfPoints(), 0)

    def test_times_that_only_the_first_process_knows_are_shown_by_all(self):
        known = self.strips("range(4 if p == 0 else 0)", held="p == 0")
        filter = simple.RegionsofInterest(Input=known, K=2)
        for shown in [filter, distributed(filter)]:
            for time in [0, 3, 1]:
                found = points(fetched(shown, time))
                self.assertEqual(found[found[:, 2].argmax(), 0], 2 + time)

    def test_shows_the_time_of_the_pieces_with_points(self):
        source = self.strips("range(4)", shown="time if p == 1 else 0", held="p == 1")
        filter = simple.RegionsofInterest(Input=source, K=2)
        first = points(fetched(filter, 0))
        found = fetched(filter, 3)
        moved = (points(found) - first).astype(np.float32)
        self.assertGreater(np.abs(moved).max(), 0)
        self.assert_same(point_array(found, "displacement"), moved)

    def test_numbers_of_points_count_ids_that_have_gaps(self):
        some = simple.Threshold(Input=distributed(numbered(self.take())),
                                Scalars=["POINTS", "number"], LowerThreshold=50,
                                UpperThreshold=1e9)
        found = fetched(simple.GeodesicDistance(Input=simple.ExtractSurface(Input=some),
                                                Source="0"))
        ids = point_array(found, "number")
        self.assertGreaterEqual(ids.min(), 50)
        sources = ids[point_array(found, "distance") == 0]
        self.assertEqual(set(sources), {ids.min()})

    def test_pieces_that_one_process_was_given_are_refused_where_points_come_twice(self):
        together = simple.AggregateDataset(Input=distributed(numbered(self.take())),
                                           NumberOfTargetProcesses=1)
        self.assert_refused(simple.GeodesicDistance(Input=together, Source="100"),
                            "names two points of process ")

    def test_what_one_process_refuses_is_refused_once(self):
        self.assert_refused(simple.RegionsofInterest(Input=distributed(numbered(self.take())),
                                                     K=10**6), "components asked for")
        filter = simple.GeodesicDistance(Input=simple.RedistributeDataSet(Input=self.take()))
        self.assert_refused(filter, "found vtkUnstructuredGrid; apply Extract Surface")
        # And then it works.
        filter.Input = self.take()
        self.assertGreater(fetched(filter).GetNumberOfPoints(), 0)

    def test_a_sphere_is_measured_across_its_pieces(self):
        sphere = simple.Sphere(ThetaResolution=64, PhiResolution=64)
        self.assert_refused(simple.GeodesicDistance(Input=sphere), "without global ids")
        if servermanager.ActiveConnection.GetNumberOfDataPartitions() > 2:
            return  # the tolerance does not reach from the first process to the last
        named = simple.GeodesicDistance(Input=simple.GenerateGlobalIds(Input=sphere,
                                                                       Tolerance=1e-6))
        # As the test of one process: half the circumference.
        distance = point_array(fetched(named), "distance")
        self.assertAlmostEqual(distance.max(), np.pi / 2, delta=0.05 * np.pi / 2)

    def test_a_texture_seam_stays_open_or_is_refused(self):
        quads = [[0, 1, 2, 3], [4, 5, 6, 7]]
        positions = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0],
                     [1, 0, 0], [2, 0, 0], [2, 1, 0], [1, 1, 0]]
        seam = self.series_of("seam", [mesh_of(np.array(positions, dtype=float), quads)])
        self.assertEqual(fetched(simple.GeodesicDistance(Input=seam)).GetNumberOfPoints(), 8)
        # Generate Global Ids gives points at one position the same id.
        named = simple.GenerateGlobalIds(Input=seam)
        self.assert_refused(simple.GeodesicDistance(Input=named), "names two points of process 0")

    def test_empty_pieces_pass_silently(self):
        with Messages() as messages:
            for name in ["GeodesicDistance", "RegionsofInterest", "mimetraAlign"]:
                filter = getattr(simple, name)(Input=self.take())
                self.assertGreater(fetched(filter, 2).GetNumberOfPoints(), 0)
        self.assertNotIn(ERROR, messages.text)


if __name__ == "__main__":
    run_tests()
